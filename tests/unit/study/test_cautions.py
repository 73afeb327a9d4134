"""Warnings about what runs but is hardly meant."""

from __future__ import annotations

import re
from typing import Any

import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.study import read_case
from tribodyn.study.case.provenance import derived_values
from tribodyn.study.pipeline.assembly import damping_of, system_of
from tribodyn.study.pipeline.cautions import case_cautions
from tribodyn.study.pipeline.motion import steps_of
from tribodyn.study.pipeline.tooth_contact import mesh_of


@pytest.fixture(scope="module")
def case() -> Any:
    return read_case(SOUND, "pair.toml").replace(
        {"dynamics.backlash": "0.05 mm", "solver.steps_per_mesh_cycle": 256}
    )


def _codes(case: Any) -> list[str]:
    return [warning.code for warning in case_cautions(case)]


def test_a_thin_rim_is_reported_where_the_body_counts(case: Any) -> None:
    bores = {"gears.pinion.bore_diameter": 62e-3, "gears.wheel.bore_diameter": 30e-3}
    thin = case.replace({**bores, "stiffness.model": "potential-energy"})
    assert thin.gear_pair.pinion.root_radius - 31e-3 < 4.5e-3
    assert "thin-rim" in _codes(thin)
    assert "thin-rim" not in _codes(thin.replace({"stiffness.reference": "rim"}))
    thick = thin.replace({"gears.pinion.bore_diameter": 30e-3})
    assert "thin-rim" not in _codes(thick)


@pytest.mark.parametrize(
    ("key", "value"),
    [("mass", "2.9 kg"), ("mass", "0.19 kg"), ("moment_of_inertia", "407 kg*cm^2")],
)
def test_inertias_far_from_the_solid_are_reported(case: Any, key: str, value: str) -> None:
    assert "mass-unlikely" in _codes(case.replace({f"gears.pinion.{key}": value}))


def test_inertias_near_the_solid_are_not(case: Any) -> None:
    nearly_solid = case.replace({"gears.pinion.mass": "0.7 kg", "gears.wheel.mass": "1.1 kg"})
    assert "mass-unlikely" not in _codes(nearly_solid)


def test_a_printed_inertia_has_more_room_than_one_of_the_user() -> None:
    case = td.load_case("fzg-roughness")
    key = "gears.pinion.moment_of_inertia"
    assert case.gears.pinion.moment_of_inertia == pytest.approx(407e-6)
    solid = derived_values(case.replace({key: None, "gears.pinion.mass": None}))[key]
    assert 407e-6 / solid == pytest.approx(0.706, abs=1e-3)
    assert "mass-unlikely" not in _codes(case)
    assert "mass-unlikely" in _codes(case.replace({key: "408 kg*mm^2"}))


def test_a_pressure_beyond_the_strength_of_steel_is_reported(case: Any) -> None:
    with pytest.warns(td.ModelWarning, match=r"hertz-pressure.*reaches 3\.\d+ GPa"):
        result = td.run(
            case.replace({"operation.torque": 2000.0, "solver.steps_per_mesh_cycle": 1024})
        )
    assert result.summary()["maximum_hertz_pressure"] > 3e9


def test_contact_loss_is_reported_with_its_share(case: Any) -> None:
    loose = {
        "dynamics.model": "torsional", "dynamics.mesh_damping_ratio": 0.01,
        "operation.torque": 20.0, "dynamics.transmission_error_amplitude": 10e-6,
        "solver.steps_per_mesh_cycle": 1024,
    }  # fmt: skip
    with pytest.warns(td.ModelWarning, match="contact-loss"):
        result = td.run(case.replace(loose))
    share = result.summary()["contact_loss_share"]
    assert 0.0 < share < 1.0
    message = next(each.message for each in result.warnings if each.code == "contact-loss")
    assert f"{share:.3g} of the mesh cycle" in message
    back = bool((result.response.fine.deflection[:, 0] < -result.half_backlash).any())
    assert ("the back flanks touch as well" in message) is back


def test_a_speed_too_low_for_any_number_of_steps_names_the_least(case: Any) -> None:
    slow = case.replace({"operation.speed": "0.01 rpm", "solver.steps_per_mesh_cycle": None})
    with pytest.raises(td.InputError, match=r"operation.speed: speed = 0\.01 rpm") as caught:
        td.run(slow)
    least_speed = re.search(r"least speed that works is ([\d.]+) rpm", str(caught.value))
    assert least_speed is not None
    least = float(least_speed.group(1))
    for speed, works in ((least, True), (0.9 * least, False)):
        changed = slow.replace({"operation.speed": f"{speed} rpm"})
        mesh = mesh_of(changed)
        system = system_of(changed, mesh, damping_of(changed, mesh))
        if works:
            assert steps_of(changed, system, mesh.mesh_frequency) <= 262144
        else:
            with pytest.raises(td.InputError, match="least speed"):
                steps_of(changed, system, mesh.mesh_frequency)
