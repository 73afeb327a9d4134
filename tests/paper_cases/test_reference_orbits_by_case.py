"""The exact periodic orbits of the reference pair, built from a case file."""

from __future__ import annotations

from typing import Any

import pytest

import tribodyn as td
from references.gear_pair_orbits import ACROSS, HARMONICS, MULTIPLIER, ORBITS
from tribodyn.study import read_case

_CASE = """
title = "Reference orbit"
[gears]
normal_module = "4.5 mm"
normal_pressure_angle = "20 deg"
center_distance = "91.5 mm"
driver = "pinion"
[gears.pinion]
teeth = 16
profile_shift_coefficient = 0.8635
face_width = "20 mm"
mass = "0.676 kg"
moment_of_inertia = "407 kg*mm^2"
[gears.wheel]
teeth = 24
profile_shift_coefficient = -0.5103
mass = "1.084 kg"
moment_of_inertia = "1168 kg*mm^2"
[operation]
speed = "900 rpm"
torque = "90 N*m"
torque_balance = "both"
[stiffness]
model = "rectangular"
pair_stiffness = "2e8 N/m"
[friction]
law = "constant"
coefficient = 0.0
[dynamics]
model = "spur-6dof"
bearing_stiffness = "3.5e9 N/m"
bearing_damping = "4e3 N*s/m"
mesh_damping = "900 N*s/m"
backlash = "0 mm"
[solver]
steps_per_mesh_cycle = 2048
"""

_FIGURES = (
    "mean_dynamic_transmission_error",
    "peak_to_peak_dynamic_transmission_error",
    "mean_mesh_force",
    "rms_mesh_force",
    "peak_mesh_force",
    "rms_acceleration_loa_pinion",
    "dynamic_transmission_error_harmonic_1",
    "dynamic_transmission_error_harmonic_2",
    "dynamic_transmission_error_harmonic_3",
)

#: In SI: micrometres above are metres in a summary.
_SCALE = (1e-6, 1e-6, 1.0, 1.0, 1.0, 1.0)


def _printed(friction: float) -> dict[str, float]:
    """Figures of the periodic orbit as tests/references/gear_pair_orbits.py finds them."""
    orbit = [s * value for s, value in zip(_SCALE, ORBITS[friction], strict=True)]
    harmonics = [1e-6 * value for value in HARMONICS[friction]]
    return dict(zip(_FIGURES, (*orbit, *harmonics), strict=True))


@pytest.fixture(scope="module", params=sorted(ORBITS))
def orbit(request: pytest.FixtureRequest) -> tuple[float, Any]:
    friction = request.param
    case = read_case(_CASE).replace({"friction.coefficient": friction})
    with pytest.warns(td.ModelWarning):
        return friction, td.run(case)


@pytest.mark.parametrize("name", _FIGURES)
def test_printed_figures(orbit: tuple[float, Any], name: str) -> None:
    friction, result = orbit
    printed = _printed(friction)[name]
    # The figures are printed to seven digits, the third harmonic to five.
    digits = 1e-5 if printed > 1e-6 else 1e-5 + 5e-13 / printed
    assert result.summary()[name] == pytest.approx(printed, rel=digits)


def test_friction_figures(orbit: tuple[float, Any]) -> None:
    friction, result = orbit
    figures = result.summary()
    if friction == 0.0:
        assert figures["rms_acceleration_oloa_pinion"] == pytest.approx(0.0, abs=1e-9)
        assert figures["rms_friction_force"] == 0.0
        return
    # 48 natural oscillations across the line of action in one cycle: 2048 steps follow each with
    # 43, which leaves 2.3e-5; 4096 steps leave 5e-6.
    assert figures["rms_acceleration_oloa_pinion"] == pytest.approx(
        ACROSS["acceleration"], rel=3e-5
    )
    assert figures["rms_bearing_force_oloa_pinion"] == pytest.approx(ACROSS["bearing_x"], rel=1e-5)
    assert figures["rms_bearing_force_loa_pinion"] == pytest.approx(ACROSS["bearing_y"], rel=1e-5)
    assert figures["rms_friction_force"] == pytest.approx(ACROSS["friction"], rel=1e-5)
    multiplier = abs(result.response.floquet_multipliers[0])
    assert multiplier == pytest.approx(MULTIPLIER, abs=5e-7)


def test_orbit_is_certified(orbit: tuple[float, Any]) -> None:
    _, result = orbit
    assert result.response.converged
    assert result.summary()["steady_state_error"] < 1e-8
    assert result.summary()["contact_loss_share"] == 0.0
