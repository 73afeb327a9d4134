"""Contacts of helical teeth in space: place and direction of the load over path and face."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from machines import DEGREE, pair

from tribodyn.gear import Material, cylindrical_pair, flank_gap
from tribodyn.lubricant import Lubricant
from tribodyn.machine import Machine, Mesh, Operation, Shaft, face_laws, static_balance
from tribodyn.machine.gear import Gear
from tribodyn.machine.plane_law import SPATIAL, pair_coordinates, with_exchanged_gears
from tribodyn.machine.static.face_law import LoadCenterLaw, load_lever
from tribodyn.mesh import MeshTable, build
from tribodyn.mesh.gears import spatial_columns

ANGLE, WIDTH = 15 * DEGREE, 0.02


def teeth(
    hand: str = "right", driver: str = "pinion", misalignment: float = 0.0, wheel_teeth: int = 72
) -> MeshTable:
    """Mesh table of 21 and 72 teeth with the face width of the machine."""
    gears = cylindrical_pair(
        pinion_teeth=21,
        wheel_teeth=wheel_teeth,
        normal_module=2e-3,
        normal_pressure_angle=20 * DEGREE,
        helix_angle=ANGLE,
        hand=hand,
        pinion_face_width=WIDTH,
        driver=driver,
        misalignment=misalignment,
    )
    return build(
        gears,
        material=Material(),
        stiffness_model="iso6336",
        lubricant=Lubricant(0.08, 880.0, 2e-8),
        friction_law="constant",
        friction_options={"coefficient": 0.05},
        composite_roughness=0.0,
        pinion_speed=50.0,
        pinion_torque=100.0,
        steps=32,
    )


def in_space(table: MeshTable, machine: Machine, name: str = "direction") -> np.ndarray:
    """Directions (n, 12) of a table over both gear nodes; its pinion is the first gear."""
    drives = table.driver == "pinion"
    onto = pair_coordinates(machine.directions["mesh"], SPATIAL, first_drives=drives)
    return spatial_columns(table)[name] @ onto


CASES = [(hand, torque, speed) for hand in ("right", "left") for torque in (100.0, -100.0)
         for speed in (50.0, -50.0)]  # fmt: skip


@pytest.fixture(scope="module")
def tables() -> dict[tuple[str, str], MeshTable]:
    return {(h, d): teeth(h, d) for h in ("right", "left") for d in ("pinion", "wheel")}


@pytest.fixture(scope="module")
def rings() -> dict[tuple[str, str], MeshTable]:
    """The same with a ring of 72 teeth."""
    sides = (("right", "pinion"), ("left", "wheel"))
    return {side: teeth(*side, wheel_teeth=-72) for side in sides}


@pytest.mark.parametrize(
    ("hand", "torque", "speed", "count"),
    [(*case, 72) for case in CASES]
    + [("right", 100.0, 50.0, -72), ("right", 100.0, -50.0, -72), ("left", -100.0, 50.0, -72)],
)
def test_force_is_that_of_the_pitch_point_at_another_place(
    tables, rings, hand, torque, speed, count
) -> None:
    machine = pair((21, count), hand=hand, torque=torque, speed=speed, helix_angle=ANGLE, angle=0.7)
    side = hand, "pinion" if torque > 0.0 else "wheel"
    table = (tables if count > 0 else rings)[side]
    line, rows = machine.directions["mesh"], in_space(table, machine)
    for first, sign in ((0, 1.0), (6, -1.0)):
        assert rows[:, first : first + 3] == pytest.approx(
            np.tile(sign * line.normal, (len(rows), 1)), abs=1e-12
        )
    # About the axis the lever is the base radius; across the plane of action it moves.
    turn = np.cross([1.0, 0.0, 0.0], line.normal)
    moved = (rows[:, 3:6] - line.direction[3:6]) @ turn
    assert rows[:, 3:6] == pytest.approx(line.direction[3:6] + np.outer(moved, turn), abs=1e-12)
    assert np.ptp(moved) > 1e-4
    # Rigid motions of both gears do not compress, wherever the load is.
    second = np.array(machine.placement.gears["b"])
    for axis in np.eye(3):
        tilted = [0, 0, 0, *axis, *np.cross(axis, second), *axis]
        assert rows @ tilted == pytest.approx(0.0, abs=1e-12)
        rubbing = in_space(table, machine, "friction")
        assert rubbing @ tilted == pytest.approx(0.0, abs=1e-9)
        assert rubbing @ [*axis, 0, 0, 0, *axis, 0, 0, 0] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("hand", "torque", "speed"), CASES)
def test_lines_of_contact_lie_in_the_flanks(tables, hand, torque, speed) -> None:
    """Points of one line in space differ by a vector across the normal of the flanks."""
    machine = pair((21, 72), hand=hand, torque=torque, speed=speed, helix_angle=ANGLE, angle=0.7)
    drives = torque > 0.0
    table, line = tables[hand, "pinion" if drives else "wheel"], machine.directions["mesh"]
    towards = np.array([0.0, *line.normal[1:]]) * (1.0 if drives else -1.0)
    slices = np.unique(table.face_position).size
    one_pair = slice(slices, 2 * slices)
    path = table.path[5, one_pair] * (1.0 if drives else -1.0)
    step = np.outer(np.diff(table.face_position[one_pair]), [line.senses[0], 0.0, 0.0])
    step += np.outer(np.diff(path), towards)
    inside = table.in_contact[5, one_pair]
    in_contact = inside[1:] & inside[:-1]
    middle = in_contact & np.roll(in_contact, 1) & np.roll(in_contact, -1)
    assert middle[1:-1].sum() > 3
    assert step[1:-1][middle[1:-1]] @ line.normal == pytest.approx(0.0, abs=1e-12)


def test_misalignment_presses_where_its_moment_has_a_lever(tables) -> None:
    """Work of a tilt: the gap that it makes, over the loads, is the moment of the load."""
    for driver in ("pinion", "wheel"):
        for hand in ("right", "left"):
            table = tables[hand, driver]
            tilted = teeth(hand, driver, misalignment=1e-6).gear_pair
            torque = 100.0 if driver == "pinion" else -100.0
            machine = pair((21, 72), hand=hand, torque=torque, helix_angle=ANGLE)
            line, rows = machine.directions["mesh"], in_space(table, machine)
            turn = np.cross([1.0, 0.0, 0.0], line.normal)
            levers = (rows[:, 3:6] - line.direction[3:6]) @ turn
            gap = flank_gap(
                tilted,
                table.pinion_curvature_radius,
                table.wheel_curvature_radius,
                np.broadcast_to(table.face_position, table.path.shape),
            )
            by_gap = (table.load_share * gap).sum(axis=1) / 1e-6 * WIDTH
            assert levers * line.senses[0] == pytest.approx(by_gap, abs=1e-9)


def loaded(table: MeshTable, **changes: Any) -> Machine:
    """A machine of one helical mesh with the contacts of a table."""
    from tribodyn.dynamics import Contact

    functions = table.functions()
    contact = Contact(functions.spatial_direction, functions.stiffness)
    mesh = {"hand": table.gear_pair.hand, "helix_angle": ANGLE, "contacts": (contact,)}
    return pair((21, 72), stiffness=functions.stiffness, **{**mesh, **changes})


def test_balance_has_the_moment_of_the_load_at_its_misalignment(tables) -> None:
    table = tables["right", "pinion"]
    machine = loaded(table)
    law = face_laws(machine, {"mesh": 2e-6})["mesh"]
    assert isinstance(law, LoadCenterLaw)
    rows = in_space(table, machine)
    turn = np.cross([1.0, 0.0, 0.0], machine.directions["mesh"].normal)
    levers = (rows[:, 3:6] - machine.directions["mesh"].direction[3:6]) @ turn
    assert law.lever == pytest.approx(float(table.grid.mean(levers)), abs=2e-6)
    force, moment, tangent = law(1e-5, 2e-6 / WIDTH)
    assert force == pytest.approx(law.stiffness * 1e-5)
    assert moment == pytest.approx(force * load_lever(machine, "mesh"))
    # The derivatives are those of force and moment, and they are symmetric: there is an energy.
    step = np.array([1e-9, 1e-9 / WIDTH])
    for column, change in enumerate(np.diag(step)):
        ahead = law(1e-5 + change[0], 2e-6 / WIDTH + change[1])
        slope = (np.array(ahead[:2]) - [force, moment]) / step[column]
        assert slope == pytest.approx(np.asarray(tangent)[:, column], rel=1e-4, abs=1.0)
    assert np.asarray(tangent) == pytest.approx(np.asarray(tangent).T)
    balance = static_balance(machine, laws={"mesh": law})
    assert balance.meshes["mesh"].force == pytest.approx(table.total_normal_force)


def test_contacts_of_exchanged_gears_are_those_of_the_same_machine(tables) -> None:
    """The wheel as first gear: the same forces on the same gears."""
    table = tables["right", "pinion"]
    machine = loaded(table, angle=0.4)
    mesh = machine.meshes["mesh"]
    turned = Mesh(
        gears=("b", "a"),
        normal_module=mesh.normal_module,
        helix_angle=ANGLE,
        hand="left",
        angle=0.4 + math.pi,
        stiffness=mesh.stiffness,
        contacts=mesh.contacts,
    )
    other = Machine(
        shafts={"input": Shaft(), "output": Shaft()},
        gears={"a": Gear("input", 0.0, 21, WIDTH), "b": Gear("output", 0.0, 72, WIDTH)},
        meshes={"mesh": with_exchanged_gears(turned, internal=False)},
        operation=Operation("input", "output", speed=50.0, torque=100.0),
    )
    phase, rows = np.array([0.1, 0.6]), []
    for each in (machine, other):
        line, mesh = each.directions["mesh"], each.meshes["mesh"]
        onto = pair_coordinates(line, SPATIAL, first_drives=mesh.gears[0] == "a")
        rows.append(mesh.contacts[0].direction(phase) @ onto)
    assert np.roll(rows[1], 6, axis=1) == pytest.approx(rows[0], abs=1e-12)
