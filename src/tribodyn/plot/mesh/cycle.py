"""The mesh table as curves: two mesh cycles, the life of one tooth pair, and the events.

Everything here reads the mesh table alone, so that a table draws itself without its case.

"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.gear.path import mesh_marks, pair_ages, roll_angle_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable

#: Mesh cycles drawn, so that the transition from one cycle to the next is seen.
CYCLES = 2
#: How to come by what these figures draw.
RUN = "Call tribodyn.run(case) and draw what it returns."
TABLE = "Call tribodyn.run(case), whose result has one, or tribodyn.mesh.build."
#: Registers a figure of a run, and one of a mesh table.
run_drawing = partial(drawing, of="Result", made_by=RUN)
table_drawing = partial(drawing, of=("MeshTable", "Result.mesh"), made_by=TABLE)
Curve = tuple[Array, Array]


def cycles(phase: Array, values: Array, repeats: int = CYCLES) -> Curve:
    """Repeat one mesh cycle side by side."""
    shifted = [phase + cycle for cycle in range(repeats)]
    return np.concatenate(shifted), np.tile(values, repeats)


def pair_life(mesh: MeshTable, column: str) -> Curve:
    """Follow one tooth pair from where it enters to where it leaves."""
    values = getattr(mesh, column)
    ages = mesh.phase[:, None] + np.arange(values.shape[1])
    touching = mesh.in_contact.T
    return ages.T[touching], values.T[touching]


def closed_life(mesh: MeshTable, column: str) -> Curve:
    """Follow one tooth pair from zero and back to zero, so that the ends are drawn."""
    return closed(*pair_life(mesh, column))


def closed(age: Array, values: Array) -> Curve:
    """Begin and end a curve at zero."""
    return np.concatenate((age[:1], age, age[-1:])), np.concatenate(([0.0], values, [0.0]))


def between(phase: Array, values: Array, ends: tuple[float, float]) -> Curve:
    """Repeat a mesh cycle over the ages of a tooth pair between two ends."""
    numbers = range(int(np.floor(ends[0])), int(np.ceil(ends[1])))
    age = np.concatenate([phase + number for number in numbers])
    seen = (age >= ends[0]) & (age <= ends[1])
    return age[seen], np.tile(values, len(numbers))[seen]


def pair_lives(mesh: MeshTable, column: str) -> list[Curve]:
    """Follow every tooth pair that touches within the cycles drawn, from zero and back to zero."""
    age, values = closed_life(mesh, column)
    lives = []
    for start in range(1 - mesh.in_contact.shape[1], CYCLES):
        seen = (age + start >= 0.0) & (age + start <= CYCLES)
        lives.append((age[seen] + start, values[seen]))
    return lives


def driving_roll_angle(mesh: MeshTable) -> Array:
    """Roll angle of the driving gear along the life of one tooth pair."""
    return roll_angle_of(mesh.gear_pair, pair_life(mesh, "stiffness")[0])


def roll_angle_positions(mesh: MeshTable) -> dict[str, float]:
    """Roll angles of the driving gear at the positions A to E and further changes of sharing."""
    pair = mesh.gear_pair
    return {name: float(roll_angle_of(pair, age)) for name, age in pair_ages(pair).items()}


def mesh_events(mesh: MeshTable, repeats: int = CYCLES) -> list[tuple[str, float]]:
    """Name the phases at which a tooth pair enters, leaves or rolls without sliding.

    Without gears nothing is known of pairs: the beginnings of the mesh cycles are marked.
    """
    if getattr(mesh, "gears", mesh) is None:
        return [("cycle", float(cycle)) for cycle in range(repeats + 1)]
    return mesh_marks(mesh.gear_pair, repeats, "enters", "leaves")
