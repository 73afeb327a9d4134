"""One definition of the static transmission error of spur and hypoid gears, and dynamic factors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import collected
from tribodyn.gear import tooth_contact
from tribodyn.mesh import MeshTable
from tribodyn.study.mesh_inputs import mesh_inputs
from tribodyn.study.pipeline.tooth_contact import (
    hypoid_loaded_contact_of,
    loaded_contact,
    mesh_of,
)

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

#: Changes of the built-in hypoid case: other teeth and ease-off, and the other side of the teeth.
PAIRS: dict[str, dict[str, Any]] = {
    "built in": {},
    "11 x 39": {
        "gears.pinion.teeth": 11,
        "gears.wheel.teeth": 39,
        "gears.ease_off.lengthwise_crowning": 40e-6,
        "gears.ease_off.profile_crowning": 12e-6,
    },
    "coast": {"gears.side": "coast"},
}
RELIEVED: dict[str, Any] = {
    "stiffness.model": "analytic",
    "gears.pinion.modification.tip_relief": "15 um",
    "gears.wheel.modification.tip_relief": "20 um",
}


def hypoid(**changes: Any) -> Any:
    changes = {name.replace("__", "."): value for name, value in changes.items()}
    return td.load_case("hypoid-mixed-ehl").replace({"friction.law": "none", **changes})


def relieved(**changes: Any) -> Any:
    changes = {name.replace("__", "."): value for name, value in changes.items()}
    return td.load_case("fzg-roughness").replace({**RELIEVED, **changes})


def mesh(case: Any, **options: Any) -> MeshTable:
    with collected():
        return mesh_of(case, **options)


@pytest.mark.parametrize("changes", PAIRS.values(), ids=PAIRS)
def test_a_hypoid_table_has_the_lag_of_its_loaded_contact(changes: dict[str, Any]) -> None:
    case = hypoid(**changes)
    loaded, table = (
        hypoid_loaded_contact_of(mesh_inputs(case), steps=16, cells=16),
        mesh(case, rehearsal=True),
    )
    assert table.transmission_error_at_rest == pytest.approx(
        loaded.wheel_lever * loaded.loaded_rotation, rel=1e-12
    )
    # It is no deflection: that alone varies by more, as it bridges the gaps of the flanks.
    deflection = loaded.mesh_force / loaded.mesh_stiffness
    assert np.ptp(deflection) > 1.2 * np.ptp(table.transmission_error_at_rest)
    assert table.transmission_error_at_rest == pytest.approx(
        loaded.unloaded_transmission_error + deflection, rel=1e-12
    )


@pytest.mark.parametrize("changes", PAIRS.values(), ids=PAIRS)
def test_without_load_and_rigid_it_is_that_of_the_tooth_contact(changes: dict[str, Any]) -> None:
    case, stiffness = hypoid(**changes), 14e9
    free = tooth_contact(case.hypoid_flanks, rotations_per_pitch=24, cells=9)
    for rigid in (
        case.replace({"operation.torque": 1e-3}),
        case.replace({"operation.torque": 0.07, "gears.line_stiffness": 70.0 * stiffness}),
    ):
        table = mesh(rigid)
        turned = table.transmission_error_at_rest / np.abs(table.direction[:, 10])
        assert np.ptp(turned) == pytest.approx(free.peak_to_peak, rel=0.015)
        # The wheel lags: where it is least ahead of the ratio the table has its greatest value.
        lag = -free.angular_transmission_error[free.leads]
        assert turned.max() == pytest.approx(lag.max(), rel=0.08)
        assert turned.min() >= -1e-12


def test_the_load_counts_over_the_stiffness_alone() -> None:
    mesh_table = mesh(hypoid(operation__torque=50.0), rehearsal=True)
    stiffness = hypoid().gears.line_stiffness
    other = mesh(
        hypoid(operation__torque=800.0, gears__line_stiffness=16.0 * stiffness), rehearsal=True
    )
    assert other.transmission_error_at_rest == pytest.approx(
        mesh_table.transmission_error_at_rest, rel=1e-9
    )


@pytest.mark.parametrize("kind", ["spur", "hypoid"])
def test_force_and_displacement_at_rest_belong_together(kind: str) -> None:
    table = mesh(hypoid() if kind == "hypoid" else relieved(), rehearsal=kind == "hypoid")
    unloaded = table.unloaded_transmission_error
    assert (unloaded is None) == (kind == "spur")
    lever = np.abs(np.broadcast_to(table.direction, (table.phase.size, table.direction.shape[-1])))
    force = table.pinion_torque / lever[:, 4 if kind == "hypoid" else 2]
    law, lag = table.force_law, table.transmission_error_at_rest
    for k in range(1, table.phase.size - 1, 7):
        pressed = lag[k] - (0.0 if unloaded is None else unloaded[k])
        assert law.force(table.phase[k], pressed) == pytest.approx(force[k], rel=3e-3)
    # More load, more lag: the same sign for both kinds.
    more = mesh(
        (hypoid if kind == "hypoid" else relieved)(operation__torque=1.2 * table.pinion_torque
                                                   if kind == "hypoid" else "200 N*m"),
        rehearsal=kind == "hypoid",
    )  # fmt: skip
    assert np.all(more.transmission_error_at_rest > lag)


def test_of_spur_gears_it_is_that_of_the_loaded_contact() -> None:
    case = relieved()
    table = mesh(case)
    assert np.array_equal(table.transmission_error_at_rest, table.static_transmission_error)
    phases = np.linspace(0.013, 0.977, 41)
    contact = loaded_contact(case, phases=phases)
    wanted = np.asarray(contact.transmission_error)
    assert table.at("transmission_error_at_rest", phases) == pytest.approx(wanted, rel=3e-3)
    # Without load nothing but the relief is left, which is a lag, too.
    light = loaded_contact(case, torque=1e-3, phases=phases)
    rigid = contact.unloaded_transmission_error
    assert rigid.max() > 1e-6 > 0.0 <= rigid.min()
    assert np.asarray(light.transmission_error) == pytest.approx(rigid, abs=5e-9)


@pytest.fixture(scope="module")
def slow_hypoid() -> Any:
    # So slow that the mesh follows its static balance.
    case = td.load_case("hypoid-mixed-ehl").replace(
        {**PAIRS["11 x 39"], "dynamics.model": "torsional", "friction.law": "constant",
         "friction.coefficient": 0.08, "operation.speed": "60 rpm"}
    )  # fmt: skip
    with collected():
        return td.run(case)


def test_summary_figures_and_series_have_the_same_definition(slow_hypoid: Any) -> None:
    figures, table = slow_hypoid.summary(), slow_hypoid.mesh
    lag = table.transmission_error_at_rest
    name = "static_transmission_error"
    assert figures[f"peak_to_peak_{name}"] == pytest.approx(np.ptp(lag), rel=1e-12)
    assert figures[f"mean_{name}"] == pytest.approx(table.grid.mean(lag), rel=1e-12)
    assert figures[f"{name}_harmonic_1"] == pytest.approx(
        table.harmonics("transmission_error_at_rest", 1)[0], rel=1e-12
    )
    series = slow_hypoid.to_xarray()[name].values
    assert float(np.ptp(series)) == pytest.approx(np.ptp(lag), rel=1e-3)
    figure = slow_hypoid.plot_static_transmission_error()
    assert f"{1e6 * np.ptp(lag):.3g}" in figure.layout.title.text
    # Slow gears lag as at rest, but for the part of the torque that friction carries.
    ratio = figures["mean_mesh_force"] / figures["static_mesh_force"]
    assert figures["mean_dynamic_transmission_error"] == pytest.approx(
        figures[f"mean_{name}"], rel=1.5 * abs(1.0 - ratio)
    )
    assert figures["mean_dynamic_transmission_error"] < figures[f"mean_{name}"]


def test_slow_gears_have_the_dynamic_factor_of_their_static_balance(slow_hypoid: Any) -> None:
    result, table, figures = slow_hypoid, slow_hypoid.mesh, slow_hypoid.summary()
    # Both discs turn together: N follows from the torques and the levers of force and friction.
    body = result.summary()
    inertia = np.array([body["moment_of_inertia_pinion"], body["moment_of_inertia_wheel"]])
    torque = np.asarray(result.system.force) + result.response.extra_force
    lever, rubs = table.direction[:, [4, 10]], table.friction[:, [4, 10]]
    force = (lever * torque / inertia).sum(1) / (lever * (lever + rubs) / inertia).sum(1)
    mean = table.grid.mean(force)
    assert figures["mean_mesh_force"] == pytest.approx(mean, rel=1e-4)
    assert figures["dynamic_factor_peak"] == pytest.approx(force.max() / mean, rel=2e-3)
    assert 1.0 < figures["dynamic_factor_peak"] < 1.02
    assert figures["dynamic_factor_rms"] == pytest.approx(1.0, abs=1e-4)
    # Over the force of the torque alone it would be a factor below one.
    assert figures["peak_mesh_force"] < 0.99 * figures["static_mesh_force"]


def test_a_prescribed_error_is_a_part_of_it() -> None:
    case = td.load_case("fzg-stiffness").replace(
        {"dynamics.transmission_error_amplitude": "3 um", "dynamics.transmission_error_phase": 0.4}
    )
    plain, result = td.run("fzg-stiffness").summary(), td.run(case)
    figures, name = result.summary(), "static_transmission_error"
    # Its stiffness is uniform: what is left is the cosine.
    assert figures[f"mean_{name}"] == pytest.approx(plain[f"mean_{name}"], rel=1e-9)
    assert figures[f"peak_to_peak_{name}"] == pytest.approx(6e-6, rel=1e-3)
    assert figures[f"{name}_harmonic_1"] == pytest.approx(3e-6, rel=1e-6)
    assert "6.00 µm" in result.plot_static_transmission_error().layout.title.text


def test_a_table_of_another_program_preserves_it(tmp_path: Any) -> None:
    case = hypoid()
    table = mesh(case, rehearsal=True)
    table.to_csv(tmp_path / "mesh.csv")
    text = """
        gears = { kind = "table", table = "mesh.csv", driver = "pinion", \
pinion = { teeth = 10, moment_of_inertia = "0.0125 kg*m^2" }, \
wheel = { teeth = 43, moment_of_inertia = "0.9 kg*m^2" } }
        operation = { speed = "3000 rpm", torque = "500 N*m" }
        friction = { law = "none" }
        dynamics = { model = "torsional" }
    """
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    again = mesh(td.load_case(tmp_path / "case.toml"))
    assert again.at("transmission_error_at_rest", table.phase[1:-1]) == pytest.approx(
        table.transmission_error_at_rest[1:-1], rel=2e-3
    )
