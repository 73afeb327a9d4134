"""Curves of a mesh table: two mesh cycles, the engagement of a tooth pair, and events.

This module needs the mesh table alone, so that a table can be plotted without its case.

"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.mesh import face_lines
from tribodyn.plot.theme.labels import display_unit, displayed
from tribodyn.plot.theme.path import mesh_marks, number_word, pair_ages, roll_angle_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable

#: Number of mesh cycles in a plot, which shows the transition between cycles.
CYCLES = 2
#: How to create the results that these figures draw.
RUN = "Call tribodyn.run(case) and plot its result."
TABLE = "Call tribodyn.run(case), whose result has one, or tribodyn.mesh.build."
#: Classes that have a cylindrical pair.
PAIRS = ("CylindricalPair", "Result.case.gear_pair", "MeshTable.gear_pair",
         "LoadedContact.gear_pair")  # fmt: skip
#: Registers a figure of a run, and one of a mesh table.
run_drawing = partial(drawing, of="Result", made_by=RUN)
table_drawing = partial(drawing, of=("MeshTable", "Result.mesh"), made_by=TABLE)
Curve = tuple[Array, Array]


def cycles(phase: Array, values: Array, repeats: int = CYCLES) -> Curve:
    """Repeat a mesh cycle."""
    shifted = [phase + cycle for cycle in range(repeats)]
    return np.concatenate(shifted), np.tile(values, repeats)


def pair_life(mesh: MeshTable, column: str, *, in_middle: bool = False) -> Curve:
    """Age and values of a column for a tooth pair from entry to exit, or that in mid face."""
    values, in_contact = face_lines.pair_column(mesh, column, in_middle=in_middle)
    ages = mesh.phase[:, None] + np.arange(values.shape[1]) - face_lines.middle_delay(mesh)
    touching = in_contact.T
    return ages.T[touching], values.T[touching]


def closed_life(mesh: MeshTable, column: str) -> Curve:
    """Age and values for a tooth pair, with a zero added at both ends."""
    return closed(*pair_life(mesh, column))


def closed(age: Array, values: Array) -> Curve:
    """Add a zero value at both ends of a curve."""
    return np.concatenate((age[:1], age, age[-1:])), np.concatenate(([0.0], values, [0.0]))


def between(phase: Array, values: Array, ends: tuple[float, float]) -> Curve:
    """Repeat a mesh cycle over the ages between two limits."""
    numbers = range(int(np.floor(ends[0])), int(np.ceil(ends[1])))
    age = np.concatenate([phase + number for number in numbers])
    inside = (age >= ends[0]) & (age <= ends[1])
    return age[inside], np.tile(values, len(numbers))[inside]


def pair_lives(mesh: MeshTable, column: str) -> list[Curve]:
    """Curves of all tooth pairs in contact within the plotted cycles, with zeros at both ends."""
    age, values = closed_life(mesh, column)
    lives = []
    for start in range(-math.floor(age[-1]), CYCLES + math.ceil(-age[0])):
        inside = (age + start >= 0.0) & (age + start <= CYCLES)
        lives.append((age[inside] + start, values[inside]))
    return lives


def driving_roll_angle(mesh: MeshTable) -> Array:
    """Roll angle of the driving gear over the engagement of a tooth pair [rad]."""
    age, path = pair_life(mesh, "path")
    if mesh.face_position is None:
        return roll_angle_of(mesh.gear_pair, age)
    pair = mesh.gear_pair
    return np.asarray(pair.driving_radius(path) / pair.driving.base_radius)


def roll_angle_positions(mesh: MeshTable) -> dict[str, float]:
    """Roll angles of the driving gear at A to E and at further changes of load sharing [rad]."""
    pair = mesh.gear_pair
    return {name: float(roll_angle_of(pair, age)) for name, age in pair_ages(pair).items()}


def mesh_events(mesh: MeshTable, repeats: int = CYCLES) -> list[tuple[str, float]]:
    """Name the phases at which a tooth pair enters, leaves or rolls without sliding.

    Tables without gears have no pair data: the starts of the mesh cycles are marked.
    """
    if getattr(mesh, "gears", mesh) is None:
        return [("cycle", float(cycle)) for cycle in range(repeats + 1)]
    return mesh_marks(mesh.gear_pair, repeats, "enters", "leaves")


#: Least load share of the oil film outside the tooth contact that is reported.
_NOTABLE = 0.01
#: Fraction of the mesh cycle that counts as rounding error.
_BRIEF = 1e-6


def sharing_under_load(mesh: MeshTable, *, ends: bool = False) -> str:
    """Sentences on the number of pairs that share the load, and on their limits if ``ends``."""
    ages = face_lines.loaded_ages(mesh, face_lines.teeth_shares(mesh))
    shares = face_lines.sharing_parts(ages)
    parts = {number: part for number, part in shares.items() if part > _BRIEF}
    phrases = [
        f"{number_word(number)} pair{'s carry' if number > 1 else ' carries'} "
        + (f"during {100.0 * part:.3g} % of the mesh cycle" if len(parts) > 1 else "all the time")
        for number, part in parts.items()
    ]
    share = f"Under this load {' and '.join(phrases)}."
    return " ".join(filter(None, (share, _carrying_ends(mesh), _beyond(mesh)))) if ends else share


def _carrying_ends(mesh: MeshTable) -> str:
    """Sentence on where a pair begins and ceases to carry load, relative to A and E."""
    if mesh.gears is None:
        return ""
    ages = face_lines.loaded_ages(mesh, face_lines.teeth_shares(mesh))
    first, last = ages[0][0], ages[-1][1]
    if mesh.face_position is not None:
        return (
            f"A pair carries during {last - first:.4g} mesh cycles: from the entry of its line of "
            "contact at one end of the face to its exit at the other."
        )
    angles = displayed("roll_angle", roll_angle_of(mesh.gear_pair, np.array([first, last])))
    unit = display_unit("roll_angle")
    begins = _compared(first, 0.0, "A", f" ({angles[0]:.4g} {unit})")
    ends = _compared(last, mesh.transverse_contact_ratio, "E", f" ({angles[1]:.4g} {unit})")
    pauses = f", after {len(ages) - 1} pauses," if len(ages) > 1 else ""
    return f"A pair begins to carry {begins} and ceases{pauses} {ends}."


def _compared(age: float, geometric: float, letter: str, angle: str) -> str:
    """Location of a limit of the load, relative to an end of the path of contact."""
    if abs(age - geometric) < 1e-4:
        return f"at {letter}"
    return f"{'before' if age < geometric else 'after'} {letter}{angle}"


def _beyond(mesh: MeshTable) -> str:
    """Sentence on the load of the oil film between flanks that do not touch without oil."""
    teeth = mesh.tooth_load_share
    if teeth is None:
        return ""
    most = float(np.max(mesh.load_share, where=teeth == 0.0, initial=0.0))
    if most < _NOTABLE:
        return ""
    return (
        f"In addition the oil film carries up to {100.0 * most:.2g} % of the load between flanks "
        "that do not touch without oil."
    )


def stiffness_jump(mesh: MeshTable) -> float:
    """Largest step of the mesh stiffness at an event of the mesh cycle [N/m]."""
    starts = np.array([segment.start for segment in mesh.segments])
    ends = np.roll([segment.stop - 1 for segment in mesh.segments], 1)
    return float(np.max(np.abs(mesh.mesh_stiffness[starts] - mesh.mesh_stiffness[ends])))
