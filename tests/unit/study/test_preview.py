"""What an engineer checks first: pitch line, oil, losses, resonance, the standard's stiffness."""

from __future__ import annotations

from math import cos, pi, radians, sqrt
from typing import Any

import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.study import read_case
from tribodyn.study.pipeline.preview import operating_figures, standard_figures

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_TORSIONAL = {
    "dynamics.model": "torsional",
    "dynamics.bearing_stiffness": None,
    "stiffness.pair_stiffness": None,
    "stiffness.model": "fourier",
    "stiffness.mean_stiffness": "3e8 N/m",
}


def _sound(**changes: Any) -> Any:
    return read_case(SOUND, "pair.toml").replace(
        {
            "solver.steps_per_mesh_cycle": 256,
            **{k.replace("__", "."): v for k, v in changes.items()},
        }
    )


def test_the_rig_of_the_standard_has_its_pitch_line_velocity() -> None:
    # DIN ISO 14635-1, A/8.3/90: 2170 rpm of the motor on the wheel's shaft are 8.3 m/s
    case = td.load_case("fzg-roughness").replace(
        {"operation.speed_of": "pinion", "operation.speed": f"{2170 * 24 / 16} rpm"}
    )
    wheel = td.load_case("fzg-roughness").replace(
        {"operation.speed_of": "pinion", "operation.speed": "2170 rpm"}
    )
    assert operating_figures(wheel)["pitch_line_velocity"] == pytest.approx(8.3, abs=0.03)
    figures = operating_figures(case)
    power = figures["tangential_force"] * figures["pitch_line_velocity"]
    assert power == pytest.approx(figures["input_power"], rel=1e-12)


def test_the_oil_is_reported_at_its_temperature() -> None:
    # ISO VG 150 has 150 mm^2/s at 40 degC
    case = _sound().replace({"lubricant.name": "ISO VG 150", "lubricant.temperature": "40 degC"})
    figures = operating_figures(case)
    kinematic = figures["oil_viscosity"] / figures["oil_density"]
    assert kinematic == pytest.approx(150e-6, rel=0.02)
    assert figures["oil_temperature"] == pytest.approx(313.15)


def test_two_inertias_on_one_spring_meet_the_mesh_where_they_must() -> None:
    case = _sound(**_TORSIONAL)
    figures = td.run(case).summary()
    pinion, wheel = (
        figures[f"moment_of_inertia_{gear}"] / figures[f"base_radius_{gear}"] ** 2
        for gear in ("pinion", "wheel")
    )
    expected = sqrt(3e8 * (1.0 / pinion + 1.0 / wheel)) / (2.0 * pi)
    assert figures["mesh_natural_frequency"] == pytest.approx(expected, rel=1e-9)
    assert figures["natural_frequency_1"] == figures["mesh_natural_frequency"]
    assert "natural_frequency_2" not in figures
    speed = 60.0 * expected / case.gears.pinion.teeth
    assert figures["resonance_speed"] * 60.0 / (2.0 * pi) == pytest.approx(speed, rel=1e-9)
    ratio = case.pinion_speed / figures["resonance_speed"]
    assert figures["resonance_ratio"] == pytest.approx(ratio, rel=1e-12)


def test_losses_are_those_of_the_loss_factor() -> None:
    # equal load shares and one coefficient: P_loss = mu H_V P for small mu
    figures = td.run(_sound(friction__coefficient=5e-4)).summary()
    assert 1.0 - figures["efficiency"] == pytest.approx(
        5e-4 * figures["gear_loss_factor"], rel=1e-3
    )
    figures = td.run(_sound(friction__coefficient=0.05)).summary()
    load = td.run(_sound(friction__coefficient=0.05, operation__torque_balance="load")).summary()
    more = load["input_power"] - figures["input_power"]
    assert more == pytest.approx(load["mean_friction_power"], rel=1e-9)
    assert load["efficiency"] * load["input_power"] == pytest.approx(figures["input_power"])
    assert td.run(_sound(friction__coefficient=0.0)).summary()["efficiency"] == 1.0


def test_dynamic_factors_count_from_the_force_at_rest_with_friction() -> None:
    figures = td.run(_sound()).summary()
    for name in ("peak", "rms"):
        ratio = figures[f"{name}_mesh_force"] / figures["mean_mesh_force"]
        assert figures[f"dynamic_factor_{name}"] == pytest.approx(ratio, rel=1e-12)
        assert figures[f"dynamic_factor_{name}"] > 1.0
    smooth = td.run(_sound(friction__law="none", friction__coefficient=None)).summary()
    assert smooth["mean_mesh_force"] == pytest.approx(smooth["static_mesh_force"], rel=1e-4)
    assert figures["line_load"] == pytest.approx(
        figures["static_mesh_force"] / figures["common_face_width"]
    )


@pytest.fixture(scope="module")
def pair() -> Any:
    return td.load_case("fzg-roughness").replace(
        {"gears.pinion.teeth": 25, "gears.wheel.teeth": 57, "gears.normal_module": "3 mm",
         "gears.center_distance": None, "gears.pinion.profile_shift_coefficient": None,
         "gears.wheel.profile_shift_coefficient": None, "gears.pinion.tip_diameter": None,
         "gears.wheel.tip_diameter": None, "gears.pinion.face_width": "30 mm",
         "gears.wheel.face_width": "30 mm", "gears.pinion.bore_diameter": "30 mm",
         "gears.wheel.bore_diameter": "30 mm", "operation.torque": "120 N*m",
         "operation.speed_of": "pinion", "stiffness.model": "analytic"}
    )  # fmt: skip


def test_stiffness_of_the_standard_by_hand(pair: Any) -> None:
    # ISO 6336-1, method B: q' of 25/57 teeth without shift; h_fP* = 1.25
    flexibility = 0.04723 + 0.15551 / 25 + 0.25791 / 57
    single = 0.8 / flexibility * (1.0 + 0.5 * (1.2 - 1.25))
    contact_ratio = pair.gear_pair.transverse_contact_ratio
    assert contact_ratio == pytest.approx(1.69412, abs=1e-5)
    mean = 30.0 * single * (0.75 * contact_ratio + 0.25)  # N/um; 106.7 N/mm are above 100 N/mm
    assert 120.0 / (0.0375 * cos(radians(20.0))) * cos(radians(20.0)) / 30.0 > 100.0
    assert standard_figures(pair)["iso_mesh_stiffness"] == pytest.approx(mean * 1e6, rel=1e-6)
    assert mean == pytest.approx(613.7, abs=0.1)


def test_outside_of_its_polynomial_the_standard_is_not_used(pair: Any) -> None:
    shifted = pair.replace({"gears.wheel.profile_shift_coefficient": 0.3})
    assert "iso_mesh_stiffness" not in standard_figures(shifted)


def test_share_of_the_bodies_is_the_difference_of_bore_and_rim(pair: Any) -> None:
    share = standard_figures(pair)["gear_body_share"]
    bore, rim = (
        td.loaded_contact(pair.replace({"stiffness.reference": reference}), phases=32)
        for reference in ("bore", "rim")
    )
    left = float(rim.deflection.mean() / bore.deflection.mean())
    assert share == pytest.approx(1.0 - left, rel=1e-9)
    assert 0.1 < share < 0.6
    assert "gear_body_share" not in standard_figures(pair.replace({"stiffness.reference": "rim"}))
    uneven = pair.replace({"gears.wheel.modification.run_out": "20 um"})
    assert standard_figures(uneven)["gear_body_share"] == pytest.approx(share, rel=1e-9)
