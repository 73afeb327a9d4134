"""The mesh table as curves: two mesh cycles, the life of one tooth pair, and the events.

Everything here reads the mesh table alone, so that a table draws itself without its case.

"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.mesh.loaded_intervals import loaded_ages, sharing_parts, teeth_shares
from tribodyn.plot.gear.path import mesh_marks, number_word, pair_ages, roll_angle_of
from tribodyn.plot.look.labels import display_unit, displayed
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


#: Load share of an oil film beyond the contact of the teeth that is reported.
_NOTABLE = 0.01
#: Part of the mesh cycle that is rounding.
_BRIEF = 1e-6


def sharing_under_load(mesh: MeshTable, *, ends: bool = False) -> str:
    """State how many tooth pairs share the load for how long, and between which ends if wanted."""
    ages = loaded_ages(mesh, teeth_shares(mesh))
    parts = {number: part for number, part in sharing_parts(ages).items() if part > _BRIEF}
    phrases = [
        f"{number_word(number)} pair{'s carry' if number > 1 else ' carries'} "
        + (f"during {100.0 * part:.3g} % of the mesh cycle" if len(parts) > 1 else "all the time")
        for number, part in parts.items()
    ]
    share = f"Under this load {' and '.join(phrases)}."
    return " ".join(filter(None, (share, _carrying_ends(mesh), _beyond(mesh)))) if ends else share


def _carrying_ends(mesh: MeshTable) -> str:
    """Roll angles between which a pair carries, compared with A and E."""
    if mesh.gears is None:
        return ""
    ages = loaded_ages(mesh, teeth_shares(mesh))
    first, last = ages[0][0], ages[-1][1]
    angles = displayed("roll_angle", roll_angle_of(mesh.gear_pair, np.array([first, last])))
    unit = display_unit("roll_angle")
    begins = _compared(first, 0.0, "A", f" ({angles[0]:.4g} {unit})")
    ends = _compared(last, mesh.transverse_contact_ratio, "E", f" ({angles[1]:.4g} {unit})")
    pauses = f", after {len(ages) - 1} pauses," if len(ages) > 1 else ""
    return f"A pair begins to carry {begins} and ceases{pauses} {ends}."


def _compared(age: float, geometric: float, letter: str, angle: str) -> str:
    """Where a pair begins or ceases to carry, compared with the end of the path."""
    if abs(age - geometric) < 1e-4:
        return f"at {letter}"
    return f"{'before' if age < geometric else 'after'} {letter}{angle}"


def _beyond(mesh: MeshTable) -> str:
    """What the oil film carries between flanks that the teeth alone would keep apart."""
    teeth = mesh.tooth_load_share
    if teeth is None:
        return ""
    most = float(np.max(mesh.load_share, where=teeth == 0.0, initial=0.0))
    if most < _NOTABLE:
        return ""
    return (
        f"Beyond, the oil film carries up to {100.0 * most:.2g} % of the load between flanks that "
        "the teeth alone would not close."
    )


def stiffness_jump(mesh: MeshTable) -> float:
    """Greatest step of the mesh stiffness at an event of the mesh cycle [N/m]."""
    starts = np.array([segment.start for segment in mesh.segments])
    ends = np.roll([segment.stop - 1 for segment in mesh.segments], 1)
    return float(np.max(np.abs(mesh.mesh_stiffness[starts] - mesh.mesh_stiffness[ends])))
