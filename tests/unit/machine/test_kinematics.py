"""Speeds, torques and power of shafts and meshes, and the clock of a machine."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from machines import RPM, bearing_reactions, pair, split_path, two_stages

from tribodyn.errors import InputError
from tribodyn.machine import Gear, Machine, Mesh, Operation, Shaft


def test_two_stages_turn_and_carry_by_their_tooth_numbers() -> None:
    shafts = two_stages().kinematics.shafts
    assert shafts["middle"].ratio == Fraction(-27, 51)
    assert shafts["output"].ratio == Fraction(27 * 23, 51 * 34)
    assert shafts["output"].speed == pytest.approx(1234 * RPM * 27 * 23 / (51 * 34), rel=1e-12)
    assert shafts["middle"].torque == pytest.approx(456.0 * 51 / 27, rel=1e-12)
    assert shafts["output"].torque == pytest.approx(456.0 * 51 * 34 / (27 * 23), rel=1e-12)
    for shaft in shafts.values():
        assert shaft.power == pytest.approx(456.0 * 1234 * RPM, rel=1e-12)


def test_force_and_frequency_of_a_mesh_are_those_of_its_gears() -> None:
    machine = two_stages()
    second = machine.kinematics.meshes["second"]
    radius = 0.5 * 23 * 6.5e-3 / math.cos(math.radians(10)) * math.cos(math.radians(20.283559))
    assert second.force == pytest.approx(456.0 * 51 / 27 / radius, rel=1e-8)
    assert second.mesh_frequency == pytest.approx(1234 / 60 * 27 / 51 * 23, rel=1e-13)
    assert (second.driver, second.driven, second.shared) == ("z3", "z4", False)


def test_a_ring_turns_with_its_pinion() -> None:
    shafts = pair((21, -72)).kinematics.shafts
    assert shafts["output"].ratio == Fraction(21, 72)
    assert shafts["output"].torque == pytest.approx(100.0 * 72 / 21, rel=1e-12)


@pytest.mark.parametrize("speed", [50.0, -50.0, 0.0])
@pytest.mark.parametrize("torque", [100.0, -100.0])
def test_power_enters_where_the_torque_has_the_sign_of_the_speed(
    speed: float, torque: float
) -> None:
    machine = pair((20, 30), speed=speed, torque=torque)
    load = machine.kinematics.meshes["mesh"]
    assert load.driver == ("a" if torque > 0.0 else "b")
    assert load.power == pytest.approx(100.0 * abs(speed))
    assert machine.kinematics.shafts["output"].torque == pytest.approx(1.5 * torque)
    about_x = torque * (-1.0 if speed < 0.0 else 1.0)
    assert load.torque == pytest.approx((about_x, -1.5 * about_x))
    # what the mesh does to the first gear holds back the torque on it
    assert machine.gear_loads["a"][3] == pytest.approx(-about_x)
    assert machine.gear_loads["b"][3] == pytest.approx(load.torque[1])


def test_loops_share_their_torque_by_stiffness_and_say_so() -> None:
    machine = split_path()
    loads = machine.kinematics.meshes
    assert all(load.shared for load in loads.values())
    # one branch is three times as stiff as the other, in both of its meshes
    assert loads["u1"].power == pytest.approx(0.75 * 8000.0, rel=1e-12)
    assert loads["l2"].power == pytest.approx(0.25 * 8000.0, rel=1e-12)
    assert machine.kinematics.shafts["upper"].torque == pytest.approx(0.75 * 160.0, rel=1e-12)
    assert machine.kinematics.shafts["output"].torque == pytest.approx(320.0, rel=1e-12)


def test_shafts_and_meshes_balance_in_a_loop_with_a_branch() -> None:
    base = split_path()
    machine = split_path(
        shafts={**base.shafts, "pump": Shaft(), "end": Shaft()},
        gears={
            **base.gears,
            "p": Gear("pump", 0.1, 30, 0.02),
            "e1": Gear("output", 0.2, 25, 0.03),
            "e2": Gear("end", 0.2, 50, 0.03),
        },
        meshes={
            **base.meshes,
            "idle": Mesh(("bull", "p"), 4e-3),
            "last": Mesh(("e1", "e2"), 4e-3, angle=1.0),
        },
        operation=Operation("input", "end", speed=100.0, torque=80.0),
    )
    loads = machine.kinematics.meshes
    assert (loads["idle"].force, loads["idle"].driver, loads["idle"].shared) == (0.0, "bull", False)
    assert loads["last"].power == pytest.approx(8000.0, rel=1e-12)
    assert not loads["last"].shared
    torque = dict.fromkeys(machine.shafts, 0.0)
    for name, load in machine.gear_loads.items():
        torque[machine.gears[name].shaft] += load[3]
    assert torque.pop("input") == pytest.approx(-80.0)
    assert torque.pop("end") == pytest.approx(-640.0, rel=1e-12)
    assert machine.kinematics.shafts["end"].torque == pytest.approx(640.0, rel=1e-12)
    assert list(torque.values()) == pytest.approx([0.0] * 4, abs=1e-10)


def test_one_turn_of_the_middle_shaft_is_a_period_of_the_two_stages() -> None:
    clock = two_stages().clock
    assert dict(clock.cycles) == {"first": 51, "second": 23}
    assert clock.turns["middle"] == 1
    assert clock.frequency == pytest.approx(1234 / 60 * 27 / 51, rel=1e-12)


def test_common_divisors_shorten_the_period() -> None:
    gears = two_stages().gears
    machine = two_stages(
        gears={**gears, "z2": replace(gears["z2"], teeth=46)},
        meshes={
            "first": Mesh(("z1", "z2"), 4.5e-3, angle=1.0),
            "second": Mesh(("z3", "z4"), 6.5e-3),
        },
    )
    assert dict(machine.clock.cycles) == {"first": 2, "second": 1}
    assert machine.clock.turns["middle"] == Fraction(1, 23)


def test_a_clock_with_whole_turns_is_the_hunting_tooth_period() -> None:
    clock = pair((18, 27)).clock
    assert dict(clock.cycles) == {"mesh": 1}
    assert clock.with_whole_turns("input").cycles == {"mesh": 18}
    hunting = clock.with_whole_turns("input", "output")
    assert hunting.cycles == {"mesh": 54}  # 18*27/gcd(18, 27)
    assert hunting.turns == {"input": 3, "output": 2}
    assert hunting.frequency == pytest.approx(clock.frequency / 54, rel=1e-12)
    with pytest.raises(InputError, match=r'no shaft "outputs".*Did you mean "output"'):
        clock.with_whole_turns("outputs")


def test_bearing_loads_equal_mesh_forces_by_hand_statics() -> None:
    machine = two_stages()
    total = np.zeros(3)
    for shaft in machine.shafts:
        fixed, free = f"{shaft} left", f"{shaft} right"
        reactions = bearing_reactions(machine, shaft, fixed, free)
        total += sum(reactions.values())
        # moments about the free bearing, with the fixed one, vanish as well
        moment = np.cross([0.02 - 0.28, 0.0, 0.0], -reactions[fixed])
        for name, gear in machine.gears.items():
            if gear.shaft == shaft:
                load = machine.gear_loads[name]
                moment += load[3:] + np.cross([gear.node_position - 0.28, 0.0, 0.0], load[:3])
        assert moment[1:] == pytest.approx([0.0, 0.0], abs=1e-9)
    # every mesh pushes both of its shafts equally
    assert total == pytest.approx(np.zeros(3), abs=1e-9)


def test_machines_of_equal_parts_differ_by_their_names_only() -> None:
    machine = pair((20, 30))
    assert repr(machine) == "Machine(2 shafts, 2 gears, 1 mesh, 0 bearings)"
    assert isinstance(machine, Machine)


def test_an_idle_loop_is_unloaded_and_follows_the_input() -> None:
    base = split_path()
    # the power leaves outside the loop
    machine = split_path(
        shafts={**base.shafts, "side": Shaft()},
        gears={**base.gears, "s1": Gear("input", 0.2, 20, 0.03), "s2": Gear("side", 0.2, 33, 0.03)},
        meshes={**base.meshes, "out": Mesh(("s1", "s2"), 4e-3, angle=2.0)},
        operation=Operation("input", "side", speed=100.0, torque=80.0),
    )
    loads = machine.kinematics.meshes
    assert list(machine.kinematics.shafts) == list(machine.shafts)
    for name, driver in (("u1", "pinion"), ("l1", "pinion"), ("u2", "upper pinion")):
        assert (loads[name].force, loads[name].driver) == (0.0, driver)
    assert loads["out"].power == pytest.approx(8000.0)
