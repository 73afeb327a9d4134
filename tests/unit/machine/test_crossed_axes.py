"""Meshes on crossed axes: forces by closed form, balance in space, limits, mounting errors."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from known_hypoids import h1043
from tribodyn.dynamics import HypoidSupports, hypoid14, natural_modes, steady_state
from tribodyn.errors import InputError
from tribodyn.gear import EaseOff, HypoidBlank, Misalignment, hypoid_blank
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks
from tribodyn.gear.hypoid.tooth_contact import displaced_gap
from tribodyn.machine import (
    Bearing,
    Coupling,
    CrossedAxes,
    Gear,
    Housing,
    Machine,
    MachineStructure,
    Mesh,
    Operation,
    Section,
    Shaft,
    hypoid_machine,
    machine_structure,
    static_balance,
    system,
)

APEXES = [(1, 1), (1, -1), (-1, 1), (-1, -1)]
#: Mass, polar and transverse moment of inertia of pinion and wheel.
BODIES = {"p": (11.4, 0.0125, 0.05), "w": (49.5, 0.9, 0.5)}


def blank(hand: str = "left", **changes: Any) -> HypoidBlank:
    values = {"offset": 31.7e-3, "outer_pitch_diameter_wheel": 0.336, "face_width_wheel": 47.7e-3,
              "mean_spiral_angle_pinion": math.radians(46.0), "cutter_radius": 0.1143}  # fmt: skip
    return hypoid_blank(10, 43, **{**values, **changes}, hand_pinion=hand)


def machine(
    shape: HypoidBlank, apex: tuple[int, int], *, speed: float = 300.0, torque: float = 500.0,
    **parts: Any,
) -> Machine:  # fmt: skip
    """Pinion and wheel on shafts of 300 mm with two bearings each."""
    names = {"p": "in", "w": "out"}
    values: dict[str, Any] = {
        "shafts": {name: Shaft([Section(0.3, 0.05)]) for name in names.values()},
        "gears": {
            gear: Gear(shaft, 0.1, getattr(shape, f"teeth_{role}"), 0.045, *BODIES[gear])
            for (gear, shaft), role in zip(names.items(), ("pinion", "wheel"), strict=True)
        },
        "meshes": {"m": Mesh.hypoid(("p", "w"), shape, apex=apex, angle=0.7, stiffness=5e8)},
        "bearings": {
            f"{shaft}{place}": Bearing(shaft, place, 4e8, axial_stiffness=axial)
            for shaft in names.values()
            for place, axial in ((0.02, 0.0), (0.26, 2e8))
        },
        "operation": Operation("in", "out", speed=speed, torque=torque),
    }
    return Machine(**{**values, **parts})


DESIGNS: list[tuple[str, dict[str, Any]]] = [
    ("left", {}),
    ("right", {}),
    ("right", {"shaft_angle": math.radians(75.0), "offset": 15e-3}),
    ("left", {"shaft_angle": math.radians(98.0), "offset": 10e-3, "wheel_generation": "generated"}),
    ("right", {"process": "face-hobbing", "blade_groups": 13, "cutter_radius": 0.088}),
]


@pytest.mark.parametrize("apex", APEXES)
@pytest.mark.parametrize("design", DESIGNS)
@pytest.mark.parametrize("speed", [300.0, -300.0])
def test_forces_are_those_of_the_formulas_of_gleason(
    apex: tuple[int, int], design: tuple[str, dict[str, Any]], speed: float
) -> None:
    hand, changes = design
    shape = blank(hand, **changes)
    built = machine(shape, apex, speed=speed)
    line, load = built.directions["m"].direction, built.kinematics.meshes["m"]
    # Seen from the back towards the apex a left-hand pinion that turns counterclockwise is driven
    # on its concave flank: it turns against the direction from its teeth to the apex.
    concave = (speed * apex[0] < 0.0) == (hand == "right")
    pressure = getattr(shape, f"normal_pressure_angle_{'drive' if concave else 'coast'}")
    for gear, n, role, spiral in (
        (0, -line[:3], "pinion", 1.0 if concave else -1.0),
        (1, -line[6:9], "wheel", -1.0 if concave else 1.0),
    ):
        cone, helix = (getattr(shape, f"{k}_{role}") for k in ("pitch_angle", "mean_spiral_angle"))
        moment = -line[6 * gear + 3 : 6 * gear + 6]
        arm = np.array([-moment[2] / n[0], moment[1] / n[0]])
        radius = 0.5 * getattr(shape, f"mean_pitch_diameter_{role}")
        assert np.hypot(*arm) == pytest.approx(radius, rel=1e-10)
        tangential = math.cos(pressure) * math.cos(helix)
        over = tangential / math.cos(helix)
        lift, screw = math.tan(pressure), spiral * math.sin(helix)
        axial = over * (lift * math.sin(cone) + screw * math.cos(cone))  # away from the apex
        radial = over * (lift * math.cos(cone) - screw * math.sin(cone))  # towards the axis
        assert -apex[gear] * n[0] == pytest.approx(axial, abs=1e-10)
        assert -n[1:] @ arm / radius == pytest.approx(radial, abs=1e-10)
        assert abs(moment[0]) == pytest.approx(tangential * radius, abs=1e-10)
    first, second = load.torque
    assert load.force * line[3] == pytest.approx(first, rel=1e-12)
    assert load.force * line[9] == pytest.approx(-second, rel=1e-9)
    speeds = [built.kinematics.shafts[name].speed for name in ("in", "out")]
    assert first * speeds[0] == pytest.approx(500.0 * 300.0)
    assert second * speeds[1] == pytest.approx(first * speeds[0], rel=1e-12)
    assert abs(second / first) == pytest.approx(4.3)


@pytest.mark.parametrize("apex", APEXES)
@pytest.mark.parametrize("design", DESIGNS[1:4])
def test_bearings_torques_and_meshes_balance_in_space(
    apex: tuple[int, int], design: tuple[str, dict[str, Any]]
) -> None:
    built = machine(blank(design[0], **design[1]), apex)
    balance, place = static_balance(built), built.placement
    force, moment = np.zeros(3), np.zeros(3)
    for name, bearing in balance.bearings.items():
        axes = place.axes[built.bearings[name].shaft]
        push, turn = axes @ bearing.load[:3], axes @ bearing.load[3:]
        force += push
        moment += turn + np.cross(place.bearings[name], push)
    torques = place.axes["in"][:, 0] * 500.0 + place.axes["out"][:, 0] * balance.output_torque
    assert abs(balance.output_torque) == pytest.approx(2150.0, rel=1e-9)
    assert force == pytest.approx(np.zeros(3), abs=1e-6)
    assert moment == pytest.approx(torques, abs=1e-6)
    # The mesh gives no force and moment to the machine as a whole, wherever it is.
    loads = [(place.axes[built.gears[g].shaft], np.array(place.gears[g]), built.gear_loads[g])
             for g in ("p", "w")]  # fmt: skip
    assert sum(axes @ load[:3] for axes, _, load in loads) == pytest.approx(0.0, abs=1e-9)
    about = sum(axes @ load[3:] + np.cross(at, axes @ load[:3]) for axes, at, load in loads)
    assert about == pytest.approx(0.0, abs=1e-9)


def test_axes_cross_at_the_offset_and_a_small_one_tends_to_spiral_bevel_gears() -> None:
    built = machine(blank(), (1, -1)).placement
    a, b = (built.axes[name][:, 0] for name in ("in", "out"))
    between = np.subtract(built.shafts["out"], built.shafts["in"])
    assert between @ np.cross(a, b) == pytest.approx(31.7e-3 * np.sign(between @ np.cross(a, b)))
    assert a @ b == pytest.approx(0.0, abs=1e-15)
    lines = [
        machine(blank(offset=offset), (1, 1)).directions["m"].direction
        for offset in (0.0, 1e-5, 2e-5)
    ]
    # Methods 0 and 1 of ISO 23509 differ by 0.2 mm in the mean radius, and in nothing else.
    assert lines[1] == pytest.approx(lines[0], abs=2e-4)
    forces = [np.abs(line - lines[0])[[0, 1, 2, 6, 7, 8]].max() for line in lines[1:]]
    assert forces[1] < 1e-4
    assert forces[1] == pytest.approx(2.0 * forces[0], rel=1e-2)


def test_rigid_motions_in_space_load_neither_teeth_nor_bearings_on_a_housing() -> None:
    nodes = {name: tuple(range(6 * i, 6 * i + 6)) for i, name in enumerate("ab")}
    wheel = {
        "out0.02": Bearing("out", 0.02, 4e8, node="a"),
        "out0.26": Bearing("out", 0.26, 4e8, axial_stiffness=2e8, node="b"),
    }
    plain = machine(blank(), (1, -1))
    housing = Housing(mass=np.eye(12), stiffness=np.eye(12), nodes=nodes)
    built = machine(blank(), (1, -1), bearings={**plain.bearings, **wheel}, housing=housing)
    structure, place = MachineStructure(built), built.placement
    for shift, turn in zip(np.vstack([np.eye(3), np.zeros((3, 3))]), np.vstack([np.zeros((3, 3)),
                           np.eye(3)]), strict=True):  # fmt: skip

        def moved(point: Any, shift: Any = shift, turn: Any = turn) -> Any:
            return np.concatenate([shift + np.cross(turn, point), turn])

        motion = []
        for name, shaft in structure.shafts.items():
            axes, start = place.axes[name], np.array(place.shafts[name])
            for node in shaft.nodes:
                motion.append(np.kron(np.eye(2), axes.T) @ moved(start + node * axes[:, 0]))
        motion += [moved(place.bearings[name]) for name in wheel]
        values = np.concatenate(motion)
        assert structure.mesh("m") @ values == pytest.approx(0.0, abs=1e-12)
        for name in wheel:
            assert structure.bearing(name) @ values == pytest.approx(0.0, abs=1e-12)


def test_straight_bevel_gears_have_the_loads_of_a_printed_example() -> None:
    """Budynas and Nisbett, Shigley's Mechanical Engineering Design, example 13-8: 5 hp, 600 rpm."""
    inch, pound, speed = 0.0254, 4.4482216, 600 * math.pi / 30
    shape = hypoid_blank(15, 45, 0.0, 9 * inch, 1.309 * inch, 0.0, 0.1)
    built = machine(shape, (1, 1), speed=speed, torque=5 * 745.7 / speed)
    load = built.gear_loads["w"] / pound
    assert abs(load[1]) == pytest.approx(406.0, rel=2e-3)  # tangential, by the torque
    assert abs(load[2]) == pytest.approx(46.6, rel=5e-3)  # towards the axis
    assert load[0] == pytest.approx(-140.0, rel=5e-3)  # away from the apex
    assert built.directions["m"].sliding == pytest.approx(np.zeros(12))


@pytest.mark.parametrize(("torque", "sign"), [(500.0, 1.0), (-500.0, -1.0)])
def test_friction_functions_act_over_all_coordinates_and_turn_with_the_driver(
    torque: float, sign: float
) -> None:
    law = flat_mesh()
    mesh = Mesh.hypoid(("p", "w"), h1043(), apex=(-1, 1), stiffness=5e8, friction=law)
    shafts = {name: Shaft() for name in ("in", "out")}
    whole = {name: Bearing(name, 0.1, 1e8, 1e8, 1e8) for name in shafts}
    moving = system(
        machine_structure(
            machine(
                h1043(), (-1, 1), torque=torque, shafts=shafts, meshes={"m": mesh}, bearings=whole
            )
        )
    )
    entry = moving.contacts[0].friction
    assert callable(entry)
    phase = np.array([0.1, 0.35])
    turns = [moving.names.index(f"{name}_theta_x") for name in ("in", "out")]
    # A driving wheel: the reversed pinion of the table has its axis and its sliding the other way.
    table = law.friction(phase if sign > 0.0 else -phase % 1.0)[:, [4, 10]]
    assert entry(phase)[:, turns] == pytest.approx(table, rel=1e-12)
    plain = SimpleNamespace(friction_sum=lambda p: 0.1 + 0.0 * p)
    flat = Mesh.hypoid(("p", "w"), h1043(), stiffness=5e8, friction=plain)
    plane = machine(h1043(), (1, 1), meshes={"m": flat})
    with pytest.raises(InputError, match=r"meshes\.m\.friction: .*components in space"):
        system(plane)


@pytest.mark.parametrize("speed", [300.0, -300.0])
def test_friction_opposes_the_sliding_of_the_flanks(speed: float) -> None:
    shape = blank("right")
    built = machine(shape, (-1, 1), speed=speed)
    sliding = np.asarray(built.directions["m"].sliding)
    speeds = [built.kinematics.shafts[name].speed for name in ("in", "out")]
    offset, spiral = shape.offset_angle_pitch, shape.mean_spiral_angle_wheel
    amount = 150.0 * shape.mean_pitch_diameter_pinion * math.sin(offset) / math.cos(spiral)
    assert sliding[3] * speeds[0] + sliding[9] * speeds[1] == pytest.approx(amount, rel=1e-9)
    assert built.directions["m"].direction[:3] @ sliding[:3] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("hand", ["left", "right"])
@pytest.mark.parametrize("apex", APEXES)
def test_displacements_of_the_gears_are_mounting_errors(hand: str, apex: tuple[int, int]) -> None:
    shape = blank(hand)
    pair = Mesh.hypoid(("p", "w"), shape, apex=apex, angle=0.4).crossing
    moved = np.random.default_rng(3).normal(size=(2, 6)) * [*3 * [3e-6], *3 * [3e-5]]
    errors = pair.misalignment(moved)
    flanks = ConjugateFlanks(shape, "drive", EaseOff())
    touch = flanks.touch(np.array([[0.0, 0.0], [-0.015, -2e-3], [0.015, 2e-3], [0.01, -4e-3]]))
    position, normal = touch.contact.wheel[:2]
    sense = 1.0 if hand == "left" else -1.0
    gap = displaced_gap(errors, position, normal, flanks.axes.axis, sense)
    ways = [
        motion[:3] @ frame + np.cross(motion[3:] @ frame, position - node)
        for motion, frame, node in zip(moved, pair.frames, pair.nodes, strict=True)
    ]
    direct = np.einsum("ij,ij->i", ways[1] - ways[0], normal)
    # What is left is a rotation of the gears about their axes.
    rest = (direct - gap) / touch.lever
    assert rest == pytest.approx(rest[0], abs=2e-9)
    assert np.ptp(direct / touch.lever) > 1e-6


def flat_mesh(friction: float = 0.03) -> Any:
    """Contact of a pair in space that varies over the mesh cycle."""
    row = np.array([-.6333, .7608, -.1415, .0519, .0264771, -.0897,
                    .6333, -.1415, -.7608, -.0519, -.11385, -.0220])  # fmt: skip
    rubs = np.array([.3, .5, .2, -.01, .004, .02, -.3, .2, -.5, .01, -.002, -.01])  # fmt: skip

    def wave(phase: Any, part: float) -> Any:
        return 1.0 + part * np.cos(2.0 * np.pi * np.asarray(phase))

    return SimpleNamespace(
        stiffness=lambda p: 5.7e8 * wave(p, 0.15),
        direction=lambda p: np.multiply.outer(wave(p, 0.01), row),
        friction=lambda p: friction * np.multiply.outer(wave(p, 0.2), rubs),
        error=lambda p: 2e-6 * wave(p, 0.5),
        event_phases=(0.0,),
    )


GEARS: dict[str, Any] = {"mass": (11.4, 49.5), "moment_of_inertia": (0.0125, 0.9)}


@pytest.mark.parametrize("side", ["drive", "coast"])
def test_the_structure_of_fourteen_coordinates_is_a_machine(side: str) -> None:
    contact: dict[str, Any] = {"mesh_damping": 3000.0, "backlash": 150e-6}
    pair = hypoid14(flat_mesh(), torque=(500.0, 2150.0), **GEARS, **contact)
    built = hypoid_machine(
        flat_mesh(), h1043(), speed=314.0, torque=500.0, side=side, **GEARS, **contact
    )
    moving = system(machine_structure(built, damping_ratio=0.0))
    assert np.abs(moving.gyroscopic).max() == pytest.approx(0.9 * 314.0 * 10 / 43, rel=1e-9)
    same = replace(moving, gyroscopic=None)
    frequencies = [natural_modes(each).frequency for each in (pair, same)]
    assert len(same.names) == 14
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-9, abs=1e-3)
    beat = 314.0 * 10 / (2.0 * np.pi)
    first, second = (steady_state(each, beat) for each in (pair, same))
    assert second.contact_force == pytest.approx(first.contact_force, rel=1e-9)
    assert second.deflection == pytest.approx(first.deflection, rel=1e-9)
    # x along the axis of a gear is its y there; engine and load turn alike
    for name, other in (("pinion_y", "pinion_x"), ("load_theta", "load_theta_x")):
        a = first.position[:, first.names.index(name)]
        b = second.position[:, second.names.index(other)]
        assert np.abs(b) == pytest.approx(np.abs(a), rel=1e-7, abs=1e-12)


def shafted(diameter: float, positions: Mapping[str, float]) -> Any:
    """Structure with a pinion on a shaft whose bearing is at its crossing point."""
    shape, supports = h1043(), HypoidSupports(bearing_damping_ratio=0.0)
    at = positions["pinion"] + shape.calculation_point_pinion
    bearing = Bearing("pinion", at, 4e8, axial_stiffness=2e8, tilting_stiffness=5e6)
    return machine_structure(
        hypoid_machine(
            flat_mesh(0.0), shape, speed=314.0, torque=500.0, supports=supports,
            shafts={"pinion": Shaft([Section(0.3, diameter)])}, positions=positions,
            bearings={"P": bearing}, **GEARS,
        ),
        damping_ratio=0.0,
    )  # fmt: skip


def test_a_flexible_pinion_shaft_lowers_the_frequencies_of_a_stiff_one() -> None:
    shape, places = h1043(), {"pinion": 0.05}
    rigid = hypoid_machine(
        flat_mesh(0.0), shape, speed=314.0, torque=500.0,
        positions={"pinion": 0.0},
        bearings={"P": Bearing("pinion", shape.calculation_point_pinion, 4e8, axial_stiffness=2e8,
                               tilting_stiffness=5e6)}, **GEARS,
    )  # fmt: skip
    thick, thin = shafted(0.06, places), shafted(0.04, places)
    reference = natural_modes(replace(system(machine_structure(rigid)), gyroscopic=None))
    lowest = [
        natural_modes(replace(system(each), gyroscopic=None)).frequency[1:6]
        for each in (thin, thick)
    ]
    assert np.all(lowest[0] < lowest[1] * (1.0 + 1e-9))
    assert np.all(lowest[1] < reference.frequency[1:6] * (1.0 + 1e-6))
    assert static_balance(thin.machine).meshes["hypoid"].mounting != Misalignment()


def test_faults_of_crossed_meshes_name_the_part() -> None:
    shape = blank()
    gears = dict(machine(shape, (1, 1)).gears)
    with pytest.raises(InputError, match=r"meshes\.m\.gears: gear p has 11 teeth.*blank has 10"):
        machine(shape, (1, 1), gears={**gears, "p": Gear("in", 0.1, 11, 0.05)})
    twice = {name: Mesh.hypoid(("p", "w"), shape, stiffness=1e8) for name in ("m", "n")}
    with pytest.raises(InputError, match="same gears"):
        machine(shape, (1, 1), meshes=twice)
    with pytest.raises(InputError, match=r"apex = \(1, 0\)"):
        CrossedAxes(shape, apex=(1, 0))
    with pytest.raises(InputError, match="reference"):
        CrossedAxes(shape, reference="apex")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r'couplings\.c\.shafts: there is no shaft "x"'):
        machine(shape, (1, 1), couplings={"c": Coupling(("x", "in"), 1e5)})
    with pytest.raises(InputError, match=r"couplings\.m: a mesh is called"):
        machine(shape, (1, 1), couplings={"m": Coupling(("out", "in"), 1e5)})
