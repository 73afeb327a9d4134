"""Speeds, torques and efficiency of planetary stages, against Willis by hand."""

from itertools import permutations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.machine import planetary_kinematics, planetary_positions

MEMBERS = ("sun", "ring", "carrier")
CHOICES = list(permutations(MEMBERS, 2))
STAGE = {"sun_teeth": 17, "ring_teeth": 61, "planet_teeth": 22}
LOSSES = {"sun_efficiency": 0.985, "ring_efficiency": 0.992}
ETA = 0.985 * 0.992


def test_printed_speeds_of_a_stage_with_a_held_ring():
    stage = planetary_kinematics(**STAGE, held="ring", input="sun", input_speed=1500.0)
    assert stage.output == "carrier"
    assert stage.speeds["carrier"] == pytest.approx(326.9231, abs=5e-5)
    assert stage.ratio == pytest.approx(4.588235, abs=5e-7)
    assert stage.relative_speeds["planet"] == pytest.approx(-906.4685, abs=5e-5)


def test_mesh_frequency_is_that_of_both_formulas():
    stage = planetary_kinematics(**STAGE, held="ring", input="sun", input_speed=157.0)
    turns = {name: speed / (2.0 * np.pi) for name, speed in stage.speeds.items()}
    assert stage.mesh_frequency == pytest.approx(17 * abs(turns["sun"] - turns["carrier"]))
    assert stage.mesh_frequency == pytest.approx(61 * abs(turns["carrier"] - turns["ring"]))


#: Ratio and efficiency by hand, with i = 61/17: VDI 2157 gives them for every choice.
I = 61 / 17  # noqa: E741
BY_HAND = {
    ("ring", "sun"): (1 + I, (1 + ETA * I) / (1 + I)),
    ("ring", "carrier"): (1 / (1 + I), (1 + I) / (1 + I / ETA)),
    ("sun", "ring"): (1 + 1 / I, (1 + ETA / I) / (1 + 1 / I)),
    ("sun", "carrier"): (1 / (1 + 1 / I), (1 + 1 / I) / (1 + 1 / (I * ETA))),
    ("carrier", "sun"): (-I, ETA),
    ("carrier", "ring"): (-1 / I, ETA),
}


@pytest.mark.parametrize(("held", "driver"), CHOICES)
def test_every_choice_of_held_and_driving_member(held, driver):
    stage = planetary_kinematics(
        **STAGE, **LOSSES, held=held, input=driver, input_speed=-120.0, input_torque=-30.0
    )
    ratio, efficiency = BY_HAND[held, driver]
    assert stage.ratio == pytest.approx(ratio, rel=1e-12)
    assert stage.efficiency == pytest.approx(efficiency, rel=1e-12)
    assert stage.speeds[held] == 0.0
    assert stage.torques[driver] == pytest.approx(-30.0)
    assert sum(stage.torques.values()) == pytest.approx(0.0, abs=1e-12)
    assert stage.power[driver] == pytest.approx(3600.0)
    assert -stage.power[stage.output] == pytest.approx(3600.0 * efficiency)
    sun, ring, carrier = (stage.speeds[member] for member in MEMBERS)
    assert (sun - carrier) / (ring - carrier) == pytest.approx(-I)
    from_sun = stage.torques["sun"] * stage.relative_speeds["sun"]
    assert stage.rolling_power == pytest.approx(abs(from_sun))
    lost = from_sun * (1.0 - ETA) if from_sun > 0.0 else -from_sun * (1.0 / ETA - 1.0)
    assert sum(stage.power.values()) == pytest.approx(lost)


def test_printed_efficiencies():
    for driver, printed in (("sun", 0.982107), ("carrier", 0.982017)):
        stage = planetary_kinematics(**STAGE, **LOSSES, held="ring", input=driver, input_speed=1.0)
        assert stage.efficiency == pytest.approx(printed, abs=5e-7)


def test_stages_in_a_row_pass_speed_and_torque_on():
    first = planetary_kinematics(
        **STAGE, **LOSSES, held="ring", input="sun", input_speed=150.0, input_torque=100.0
    )
    second = planetary_kinematics(
        sun_teeth=21, ring_teeth=75, held="ring", input="sun", sun_efficiency=0.99,
        input_speed=first.output_speed, input_torque=first.output_torque,
    )  # fmt: skip
    power = second.output_speed * second.output_torque
    assert power == pytest.approx(150.0 * 100.0 * first.efficiency * second.efficiency)
    assert 150.0 / second.output_speed == pytest.approx(78 / 17 * 96 / 21)


def test_equal_stepped_gears_are_single_planets():
    choice = {"held": "ring", "input": "sun", "input_speed": 10.0}
    single = planetary_kinematics(**STAGE, **choice)
    stepped = planetary_kinematics(
        sun_teeth=17, ring_teeth=61, planet_teeth=(22, 22), planet_type="stepped", **choice
    )
    assert stepped.speeds == pytest.approx(single.speeds)


def test_double_planets_by_hand():
    choice = {"held": "ring", "input": "sun", "input_speed": 1.0}
    stepped = planetary_kinematics(
        sun_teeth=20, ring_teeth=70, planet_teeth=(36, 14), planet_type="stepped", **choice
    )
    assert stepped.ratio == pytest.approx(1 + 36 * 70 / (20 * 14))
    meshed = planetary_kinematics(
        sun_teeth=30, ring_teeth=72, planet_teeth=(18, 20), planet_type="meshed",
        planet_efficiency=0.98, **choice,
    )  # fmt: skip
    assert meshed.ratio == pytest.approx(1 - 72 / 30)
    relative = meshed.relative_speeds
    assert relative["sun_planet"] * 18 == pytest.approx(-30 * relative["sun"])
    assert relative["ring_planet"] * 20 == pytest.approx(72 * relative["ring"])
    assert relative["ring_planet"] * 20 == pytest.approx(-18 * relative["sun_planet"])
    # Sun drives against the carrier: rolling power flows from the sun, T_r = -i0 eta T_s.
    assert meshed.torques["ring"] == pytest.approx(-72 / 30 * 0.98)


def test_a_stage_that_locks_itself_is_refused_with_its_powers():
    stage = {"sun_teeth": 70, "ring_teeth": 72, "planet_teeth": (18, 18), "planet_type": "meshed"}
    losses = {"sun_efficiency": 0.98, "ring_efficiency": 0.98, "planet_efficiency": 0.98}
    choice = {"held": "ring", "input_speed": 1.0}
    slowing = planetary_kinematics(**stage, **losses, **choice, input="carrier")
    i = 72 / 70  # power flows from the ring to the sun: T_r = -i/eta T_s
    assert slowing.efficiency == pytest.approx((i - 1) / (i / 0.98**3 - 1))
    with pytest.raises(InputError, match=r"locks itself.*% of its power.*rolling power"):
        planetary_kinematics(**stage, **losses, **choice, input="sun")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"input": "ring"}, 'input = "ring" is held.*"sun" or "carrier"'),
        ({"held": "planet"}, "held"),
        ({"ring_teeth": 15}, "ring_teeth = 15, and the sun has 17 teeth"),
        ({"sun_efficiency": 98.5}, "sun_efficiency.*98.5"),
        ({"input_torque": -1.0}, "brakes the input"),
        ({"planets": 4}, r"\(61 \+ 17\)/4 = 19.5 is not whole"),
        ({"planet_teeth": (22, 20)}, "A single planet has 1 gear"),
        ({"planet_type": "stepped"}, "A stepped planet has 2 gears"),
    ],
)
def test_wrong_input_is_refused_with_its_value(changes, message):
    with pytest.raises(InputError, match=message):
        planetary_kinematics(
            **{**STAGE, "held": "ring", "input": "sun", "input_speed": 1.0, **changes}
        )


def test_planets_that_do_not_fit_are_refused_with_what_fits():
    with pytest.raises(InputError, match=r"2, 3, 6 planets.*0, 92.3077, 180, 272.308 deg"):
        planetary_positions(sun_teeth=17, ring_teeth=61, planets=4)
    angles = np.radians([0.0, 92.3077, 180.0, 272.308])
    fit = planetary_positions(sun_teeth=17, ring_teeth=61, planets=4, angles=angles)
    assert fit.step == pytest.approx(2 * np.pi / 78)
    with pytest.raises(InputError, match=r"planet 2 at 94 deg.*0.367 of a pitch.*92.307692 deg"):
        planetary_positions(
            sun_teeth=17, ring_teeth=61, planets=4, angles=np.radians([0.0, 94.0, 180.0, 272.308])
        )


def test_neighbours_overlap_by_their_tip_circles():
    with pytest.raises(InputError, match=r"60 deg apart overlap by 4.5 modules.*24 modules"):
        planetary_positions(sun_teeth=17, ring_teeth=61, planets=6)
    size = {"center_distance": 0.078, "tip_diameter": 0.0966}
    fit = planetary_positions(sun_teeth=17, ring_teeth=61, planets=3, **size)
    assert fit.clearance == pytest.approx(2 * 0.078 * np.sin(np.pi / 3) - 0.0966)
    with pytest.raises(InputError, match=r"overlap by .* mm"):
        planetary_positions(
            sun_teeth=17, ring_teeth=61, planets=3, center_distance=0.078, tip_diameter=0.14
        )


def assembled(stage: dict, count: int) -> bool:
    """Whether equal double planets fit, by search over the turns of a planet in its place."""
    sun, ring, (first, second) = stage["sun_teeth"], stage["ring_teeth"], stage["planet_teeth"]
    turn = np.arange(first * second) / first - sun / count / first  # the sun side meshes
    miss = (ring / count - second * turn + 0.5) % 1.0 - 0.5
    return bool(np.abs(miss).min() < 1e-9)


@pytest.mark.parametrize("teeth", [(36, 14), (36, 15), (25, 15)])
def test_stepped_planets_are_assembled_where_their_teeth_fit(teeth):
    stage = {"sun_teeth": 20, "ring_teeth": 70, "planet_teeth": teeth}
    fits = []
    for count in range(1, 9):
        try:
            planetary_positions(**stage, planets=count, planet_type="stepped")
        except InputError:
            fits.append(False)
        else:
            fits.append(True)
    assert fits == [assembled(stage, count) for count in range(1, 9)]
    assert not all(fits)
