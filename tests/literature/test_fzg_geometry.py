"""Printed geometry: FZG types A and C, and the gear stages of two published gearbox models."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from references.friction_table import TABLE
from tribodyn.contact import effective_modulus, gear_loss_factor, hertz_line, path_of_contact
from tribodyn.gear import (
    Material,
    SpurPair,
    operating_pressure_angle,
    spur_pair,
    zero_backlash_center_distance,
)

SHIFTS = {"A": (0.8635, -0.5103), "C": (0.1817, 0.1715)}


def fzg(kind: str, driver: str = "pinion") -> SpurPair:
    pinion, wheel = SHIFTS[kind]
    return spur_pair(
        pinion_teeth=16,
        wheel_teeth=24,
        normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0),
        center_distance=91.5e-3,
        pinion_profile_shift_coefficient=pinion,
        wheel_profile_shift_coefficient=wheel,
        pinion_face_width=20e-3,
        driver=driver,
    )


def test_fzg_a_circles() -> None:
    pair = fzg("A")
    assert pair.tip_shortening_coefficient == pytest.approx(0.019867, abs=5e-7)
    assert pair.pinion.tip_diameter == pytest.approx(88.593e-3, abs=5e-7)
    assert pair.wheel.tip_diameter == pytest.approx(112.228e-3, abs=5.1e-7)
    assert pair.pinion.base_radius == pytest.approx(33.828934e-3, abs=5e-10)
    assert pair.wheel.base_radius == pytest.approx(50.743402e-3, abs=5e-10)
    assert pair.operating_pressure_angle == pytest.approx(0.391631, abs=5e-7)
    assert pair.transverse_contact_ratio == pytest.approx(1.326952, abs=5e-7)


def test_fzg_a_roll_angles_with_the_pinion_driving() -> None:
    contact = path_of_contact(fzg("A"))
    printed = {"A": 0.324239, "C": 0.412963, "B": 0.452633, "D": 0.716938, "E": 0.845332}
    assert contact.roll_angles == pytest.approx(printed, abs=1e-6)
    assert contact.A < contact.C < contact.B < contact.D < contact.E


def test_fzg_a_pitch_point_is_in_the_last_zone_with_the_wheel_driving() -> None:
    angles = path_of_contact(fzg("A", "wheel")).roll_angles
    assert angles["A"] < angles["B"] < angles["D"] < angles["C"] < angles["E"]


def test_fzg_a_wheel_has_a_harmless_undercut() -> None:
    pair = fzg("A")
    assert pair.wheel.undercut
    assert not pair.pinion.undercut
    least = pair.line_of_action_length - pair.path_limits[1]
    used = math.hypot(pair.wheel.base_radius, least)
    assert pair.wheel.base_radius < pair.wheel.form_radius < used


def test_fzg_c_tip_diameters() -> None:
    pair = fzg("C")
    assert pair.pinion.tip_diameter == pytest.approx(82.46e-3, abs=5e-6)
    assert pair.wheel.tip_diameter == pytest.approx(118.36e-3, abs=5e-6)


@pytest.mark.parametrize("kind", SHIFTS)
def test_fzg_shifts_leave_no_play(kind: str) -> None:
    pair = fzg(kind)
    assert abs(pair.geometric_backlash) < 1e-4 * pair.pinion.normal_module
    assert pair.backlash == 0.0


@pytest.mark.parametrize("row", TABLE)
def test_fzg_a_speeds_and_pressures(row: tuple[float, ...]) -> None:
    """90 N m and 900 rpm on the pinion, 20 mm wide, E' = 230.769 GPa."""
    roll, share, sliding, entrainment, slide_to_roll, radius, pressure = row[:7]
    pair = fzg("A")
    force = 90.0 / pair.pinion.base_radius
    assert force == pytest.approx(2660.44, abs=5e-3)
    contact = path_of_contact(pair)
    motion = contact.kinematics(roll * pair.pinion.base_radius, 30.0 * math.pi)
    assert motion.sliding_speed == pytest.approx(sliding, abs=4e-6)
    assert motion.entrainment_speed == pytest.approx(entrainment, abs=1e-6)
    assert motion.slide_to_roll_ratio == pytest.approx(slide_to_roll, abs=3e-6)
    assert motion.sliding_direction == math.copysign(1.0, sliding)
    assert motion.equivalent_radius * 1e3 == pytest.approx(radius, abs=1.1e-5)
    steel = Material(210e9, 0.3)
    modulus = effective_modulus(steel, steel)
    assert modulus == pytest.approx(2.30769e11, rel=2e-6)
    load = share * force / pair.common_face_width
    hertz = hertz_line(load, motion.equivalent_radius, modulus)
    assert hertz.maximum_pressure / 1e9 == pytest.approx(pressure, abs=1e-6)


def piecewise_loss_factor(roll: dict[str, float], teeth: int, ratio: float) -> float:
    """Loss factor from five roll angles with C between A and B, each zone integrated by hand."""
    pitch = 2.0 * math.pi / teeth
    a, b, d, e = (abs(roll[name] - roll["C"]) / pitch for name in "ABDE")
    approach_and_recess = 0.5 * (a**2 / 2.0 + b**2 / 2.0)
    single = (d**2 - b**2) / 2.0
    last = 0.5 * (e**2 - d**2) / 2.0
    return (1.0 + 1.0 / ratio) * pitch * (approach_and_recess + single + last)


def ohlendorf(roll: dict[str, float], teeth: int, ratio: float) -> float:
    pitch = 2.0 * math.pi / teeth
    approach, recess = (abs(roll[name] - roll["C"]) / pitch for name in "AE")
    bracket = 1.0 - (roll["E"] - roll["A"]) / pitch + approach**2 + recess**2
    return math.pi * (ratio + 1.0) / (teeth * ratio) * bracket


def test_fzg_a_loss_factor_is_not_the_closed_form() -> None:
    """From the printed roll angles alone: 0.3031 zone by zone, 0.3064 by the closed form."""
    printed = {"A": 0.324239, "C": 0.412963, "B": 0.452633, "D": 0.716938, "E": 0.845332}
    by_hand = piecewise_loss_factor(printed, 16, 1.5)
    assert by_hand == pytest.approx(0.303076, abs=2e-6)
    assert ohlendorf(printed, 16, 1.5) == pytest.approx(0.3064, abs=5e-5)
    for driver in ("pinion", "wheel"):
        assert gear_loss_factor(fzg("A", driver)) == pytest.approx(by_hand, rel=1e-5)


def test_fzg_c_loss_factor_is_the_closed_form() -> None:
    pair = fzg("C")
    closed = ohlendorf(path_of_contact(pair).roll_angles, 16, 1.5)
    assert gear_loss_factor(pair) == pytest.approx(closed, rel=1e-12)
    assert closed == pytest.approx(0.1950, abs=5e-5)


#: teeth sum, module [mm], helix angle [deg], shift sum, centre distance [mm], operating angle [deg]
HELICAL_STAGES = [
    (78, 4.5, 21.0, 0.46283, 190.0, 22.8062, 187.9859),
    (57, 6.5, 10.0, 0.30148, 190.0, 21.7751, 188.1078),
]


@pytest.mark.parametrize("stage", HELICAL_STAGES)
def test_industrial_gearbox_in_the_transverse_section(stage: tuple[float, ...]) -> None:
    """Helical stages obey the spur formulas in the transverse section."""
    teeth, module, helix, shift, distance, angle, reference = stage
    cosine = math.cos(math.radians(helix))
    transverse_module = module * 1e-3 / cosine
    transverse_angle = math.atan(math.tan(math.radians(20.0)) / cosine)
    assert 0.5 * teeth * transverse_module * 1e3 == pytest.approx(reference, abs=5e-5)
    # The rack displacement is one and the same length; in units of the transverse module it
    # shrinks by the cosine.
    computed = zero_backlash_center_distance(
        int(teeth), transverse_module, transverse_angle, shift * cosine
    )
    assert computed * 1e3 == pytest.approx(distance, abs=1e-4)
    operating = operating_pressure_angle(
        int(teeth), transverse_module, transverse_angle, distance * 1e-3
    )
    assert math.degrees(operating) == pytest.approx(angle, abs=5e-5)


def test_planetary_sun_and_planet() -> None:
    pair = spur_pair(
        pinion_teeth=17,
        wheel_teeth=22,
        normal_module=4e-3,
        normal_pressure_angle=math.radians(20.0),
        pinion_face_width=50e-3,
    )
    assert pair.center_distance == pytest.approx(78e-3, rel=1e-14)
    # Contact ratio of unshifted gears from the tip circles, as any textbook has it.
    lengths: Callable[[int], float] = lambda z: math.sqrt(  # noqa: E731
        (4e-3 * (z / 2.0 + 1.0)) ** 2 - (2e-3 * z * math.cos(math.radians(20.0))) ** 2
    )
    path = lengths(17) + lengths(22) - 78e-3 * math.sin(math.radians(20.0))
    base_pitch = math.pi * 4e-3 * math.cos(math.radians(20.0))
    assert pair.transverse_contact_ratio == pytest.approx(path / base_pitch, rel=1e-12)
    assert np.isclose(pair.backlash, 0.0, atol=1e-15)
