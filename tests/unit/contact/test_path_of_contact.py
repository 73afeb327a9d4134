"""Positions, events and motion on the path of contact, for either driving gear."""

import math
from typing import Any

import numpy as np
import pytest

from tribodyn.contact import PathOfContact, path_of_contact
from tribodyn.errors import InputError
from tribodyn.gear import BasicRack, spur_pair

TALL = BasicRack(1.35, 1.6, 0.25)
PAIRS: dict[str, dict[str, Any]] = {
    "pitch point in the first double zone": {
        "pinion_teeth": 16,
        "wheel_teeth": 24,
        "center_distance": 91.5e-3,
        "normal_module": 4.5e-3,
        "pinion_profile_shift_coefficient": 0.8635,
        "wheel_profile_shift_coefficient": -0.5103,
    },
    "pitch point in the single zone": {"pinion_teeth": 20, "wheel_teeth": 30},
    "pitch point before the path of contact": {
        "pinion_teeth": 40,
        "wheel_teeth": 60,
        "pinion_profile_shift_coefficient": 1.1,
        "wheel_profile_shift_coefficient": -1.1,
    },
    "contact ratio above two": {
        "pinion_teeth": 60,
        "wheel_teeth": 80,
        "normal_pressure_angle": math.radians(17.5),
        "pinion_rack": TALL,
        "wheel_rack": TALL,
    },
    "contact ratio above three": {
        "pinion_teeth": 150,
        "wheel_teeth": 200,
        "normal_pressure_angle": math.radians(10.0),
    },
}
PLAIN = "pitch point in the single zone"
both_drivers = pytest.mark.parametrize("driver", ["pinion", "wheel"])
all_pairs = pytest.mark.parametrize("name", PAIRS)


def contact_of(name: str, driver: str = "pinion", **changes: Any) -> PathOfContact:
    defaults = {
        "normal_module": 4e-3,
        "normal_pressure_angle": math.radians(20.0),
        "pinion_face_width": 20e-3,
    }
    return path_of_contact(spur_pair(**{**defaults, **PAIRS[name], **changes}, driver=driver))


@all_pairs
def test_samples_agree_with_their_names(name: str) -> None:
    contact = contact_of(name)
    first_double = contact.A < contact.C < contact.B
    single = contact.B < contact.C < contact.D
    samples = {
        "pitch point in the first double zone": first_double,
        "pitch point in the single zone": single,
        "pitch point before the path of contact": contact.C < contact.A,
        "contact ratio above two": contact.pairs == 3,
        "contact ratio above three": contact.pairs == 4,
    }
    assert samples[name]


@all_pairs
def test_swapping_the_driver_mirrors_the_path(name: str) -> None:
    forward, backward = contact_of(name), contact_of(name, "wheel")
    assert (backward.A, backward.E) == (forward.E, forward.A)
    assert backward.C == forward.C
    assert math.isclose(backward.B, forward.D, rel_tol=1e-14)
    assert math.isclose(backward.D, forward.B, rel_tol=1e-14)
    assert (forward.direction, backward.direction) == (1, -1)


@all_pairs
@both_drivers
def test_points_are_one_base_pitch_apart_in_time_order(name: str, driver: str) -> None:
    contact = contact_of(name, driver)
    pitch, sense = contact.pair.base_pitch, contact.direction
    assert sense * (contact.E - contact.A) == pytest.approx(contact.length)
    assert sense * (contact.E - contact.B) == pytest.approx(pitch)
    assert sense * (contact.D - contact.A) == pytest.approx(pitch)


@all_pairs
@both_drivers
def test_roll_angles_belong_to_the_driving_gear(name: str, driver: str) -> None:
    contact = contact_of(name, driver)
    gear, angles = contact.pair.driving, contact.roll_angles
    assert list(angles) == list("ABCDE")
    assert angles["A"] < angles["E"]
    assert angles["E"] == pytest.approx(gear.roll_angle(gear.tip_radius), rel=1e-13)
    alpha = contact.pair.operating_pressure_angle
    assert angles["C"] == pytest.approx(math.tan(alpha), rel=1e-13)
    step = 2.0 * math.pi / gear.teeth
    assert angles["D"] - angles["A"] == pytest.approx(step, rel=1e-12)


@all_pairs
@both_drivers
def test_events_split_the_cycle_where_contact_changes(name: str, driver: str) -> None:
    contact = contact_of(name, driver)
    events = contact.event_phases()
    assert events[0] == 0.0
    assert list(events) == sorted(set(events))
    assert events[-1] < 1.0
    phase = np.linspace(0.0, 1.0, 1001)[:-1] + 5e-4
    path, touching = contact.pair_paths(phase)
    state = np.where(touching, 1 + (path > contact.C), 0)
    changed = phase[1:][np.any(np.diff(state, axis=0) != 0, axis=1)] - 5e-4
    inner = [event for event in events if event > 0.0]
    assert changed == pytest.approx(inner, abs=6e-4)


def test_pitch_point_off_the_path_is_no_event() -> None:
    assert len(contact_of("pitch point before the path of contact").event_phases()) == 2


@all_pairs
@both_drivers
def test_pairs_in_contact_add_up_to_the_contact_ratio(name: str, driver: str) -> None:
    contact = contact_of(name, driver)
    count = 20000
    phase = (np.arange(count) + 0.5) / count
    path, touching = contact.pair_paths(phase)
    assert path.shape == touching.shape == (count, contact.pairs)
    assert touching.sum() / count == pytest.approx(contact.contact_ratio, abs=1.0 / count)
    low, high = sorted((contact.A, contact.E))
    assert np.array_equal(touching, (path >= low) & (path <= high))


@both_drivers
def test_events_are_one_sided(driver: str) -> None:
    contact = contact_of(PLAIN, driver)
    leaving = contact.contact_ratio % 1.0
    phases = [0.0, leaving, 1.0]
    path, after = contact.pair_paths(phases)
    assert after.tolist() == [[True, True], [True, False], [True, True]]
    assert path[0, 0] == path[2, 0] == contact.A
    path, before = contact.pair_paths(phases, side="left")
    assert before.tolist() == [[True, False], [True, True], [True, False]]
    assert path[0, 0] == pytest.approx(contact.D)
    assert path[1, 1] == pytest.approx(contact.E)
    with pytest.raises(InputError, match="side"):
        contact.pair_paths(phases, side="both")


def test_phase_counts_modulo_one() -> None:
    contact = contact_of(PLAIN)
    inside, _ = contact.pair_paths([0.25])
    later, _ = contact.pair_paths([3.25])
    assert later == pytest.approx(inside)
    with pytest.raises(InputError, match="phase"):
        contact.pair_paths([math.nan])


@both_drivers
def test_pitch_event_hits_the_pitch_point_with_a_sign_on_each_side(driver: str) -> None:
    contact = contact_of("pitch point in the first double zone", driver)
    phase = contact.direction * (contact.C - contact.A) / contact.pair.base_pitch % 1.0
    assert min(abs(event - phase) for event in contact.event_phases()) < 1e-15
    path, _ = contact.pair_paths([phase])
    index = int(np.argmin(np.abs(path[0] - contact.C)))
    at = path[0, index]
    assert contact.kinematics(at, 100.0).sliding_speed == 0.0
    assert contact.sliding_direction(at) == 0.0
    assert contact.sliding_direction(at, "left") == -contact.direction
    assert contact.sliding_direction(at, "right") == contact.direction
    with pytest.raises(InputError, match="side"):
        contact.sliding_direction(at, "middle")


@all_pairs
@both_drivers
def test_sliding_has_the_sign_of_the_speed_difference(name: str, driver: str) -> None:
    contact = contact_of(name, driver)
    path = np.linspace(contact.A, contact.E, 12)
    motion = contact.kinematics(path, 100.0)
    ratio = contact.pair.wheel.teeth / contact.pair.pinion.teeth
    pinion = 100.0 * path
    wheel = 100.0 / ratio * (contact.pair.line_of_action_length - path)
    assert motion.pinion_surface_speed == pytest.approx(pinion, rel=1e-14)
    assert motion.wheel_surface_speed == pytest.approx(wheel, rel=1e-14)
    assert motion.sliding_speed == pytest.approx(pinion - wheel, abs=1e-12)
    assert motion.entrainment_speed == pytest.approx((pinion + wheel) / 2.0, rel=1e-13)
    assert np.array_equal(motion.sliding_direction, np.sign(pinion - wheel))
    slide_to_roll = 2.0 * (pinion - wheel) / (pinion + wheel)
    assert motion.slide_to_roll_ratio == pytest.approx(slide_to_roll, abs=1e-12)
    radius = 1.0 / (1.0 / path + 1.0 / (contact.pair.line_of_action_length - path))
    assert motion.equivalent_radius == pytest.approx(radius, rel=1e-13)


@both_drivers
def test_contact_moves_at_the_speed_of_the_base_circles(driver: str) -> None:
    """The rate of change of a curvature radius is the base circle speed of that gear."""
    contact = contact_of(PLAIN, driver)
    speed, step = 100.0, 1e-4
    cycle = 2.0 * math.pi / (contact.pair.pinion.teeth * speed)
    path, _ = contact.pair_paths([0.3, 0.3 + step])
    rate = (path[1, 0] - path[0, 0]) / (step * cycle)
    expected = contact.direction * speed * contact.pair.pinion.base_radius
    assert rate == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan])
def test_speed_must_be_positive(speed: float) -> None:
    contact = contact_of(PLAIN)
    with pytest.raises(InputError, match="pinion_speed"):
        contact.kinematics(contact.C, speed)


def test_whole_contact_ratio_has_no_extra_pair() -> None:
    """A tip turned so that the contact ratio is two to rounding: leaving and entering merge."""
    name = "contact ratio above two"
    wide = contact_of(name)
    excess = (wide.contact_ratio - 2.0) * wide.pair.base_pitch
    pinion = wide.pair.pinion
    reach = pinion.roll_angle(pinion.tip_radius) * pinion.base_radius - excess
    tip = 2.0 * math.hypot(pinion.base_radius, reach)
    contact = contact_of(name, pinion_tip_diameter=tip)
    assert contact.contact_ratio == pytest.approx(2.0, abs=1e-13)
    assert contact.pairs == 2
    assert len(contact.event_phases()) == 2
    for side in ("left", "right"):
        _, touching = contact.pair_paths([0.0], side)
        assert touching.tolist() == [[True, True]]
