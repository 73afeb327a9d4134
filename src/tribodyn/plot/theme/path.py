"""Positions A to E on the path of contact, and the number of pairs in contact."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.contact.path import pitch_point_age
from tribodyn.plot.theme.colors import MUTED
from tribodyn.plot.theme.labels import axis_label, displayed
from tribodyn.plot.theme.style import Trace, note
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh.gears import Gears

#: Least fraction of the axis at which a shaded range has a label.
_NAMED_SHADE = 0.03
#: Fill behind ranges of tip-corner contact.
_SHADE = "rgba(107, 119, 133, 0.13)"
_NUMBER_WORDS = {1: "one", 2: "two", 3: "three", 4: "four", 5: "five"}


def roll_angle_of(pair: Gears, age: object) -> Array:
    """Roll angle of the driving gear at an age of a tooth pair."""
    contact = path_of_contact(pair)
    radius = pair.driving_radius(contact.A) + np.asarray(age, dtype=float) * pair.base_pitch
    return np.asarray(radius / pair.driving.base_radius)


def roll_label(pair: Gears) -> str:
    """Label of an axis of roll angles."""
    return axis_label("roll_angle", f"Roll angle of the driving gear ({pair.driver})")


def pair_ages(pair: Gears) -> dict[str, float]:
    """Ages (mesh cycles after A) at the positions A to E and further changes of load sharing."""
    contact = path_of_contact(pair)
    ratio = contact.contact_ratio
    pitch_point = float(pitch_point_age(contact))
    ages = {"A": 0.0, "B": ratio - 1.0, "C": pitch_point, "D": 1.0, "E": ratio}
    return ages | further_changes(ratio)


def pair_letters(pair: Gears) -> list[tuple[str, float]]:
    """Positions A to E and further changes of load sharing, as roll angles in display units."""
    ages = pair_ages(pair)
    if not 0.0 <= ages["C"] <= ages["E"]:
        del ages["C"]
    return [
        (name, float(displayed("roll_angle", roll_angle_of(pair, age))))
        for name, age in ages.items()
    ]


def mesh_marks(
    pair: Gears, repeats: int, enters: str = "A", leaves: str = "E"
) -> list[tuple[str, float]]:
    """Mesh phases at which a tooth pair reaches A, leaves at E or passes the pitch point."""
    ages = pair_ages(pair)
    marks = [(enters, 0.0), (leaves, ages["E"] % 1.0)]
    if 0.0 <= ages["C"] < ages["E"]:
        marks.append(("C", ages["C"] % 1.0))
    repeated = [(name, at + cycle) for cycle in range(repeats) for name, at in marks]
    return [*repeated, (enters, float(repeats))]


def corner_shades(pair: Gears, first: float, last: float) -> dict[str, list[Trace]]:
    """Shade and label the ranges before A and after E, where a tip corner or a part carries."""
    shapes, notes = [], []
    text = "part of the face" if pair.overlap_ratio else "tip corner"
    for start, stop in ((first, 0.0), (pair.transverse_contact_ratio, last)):
        if stop <= start:
            continue
        x = displayed("roll_angle", roll_angle_of(pair, np.array([start, stop])))
        common = Trace(xref="x", yref="paper")
        rectangle = {"x0": float(x[0]), "x1": float(x[1]), "y0": 0, "y1": 1, "layer": "below"}
        fill = {"fillcolor": _SHADE, "line": {"width": 0}}
        shapes.append({"type": "rect", **common, **rectangle, **fill})
        if stop - start < _NAMED_SHADE * (last - first):
            continue
        style: Trace = {"size": 11, "color": MUTED, "textangle": -90, "yanchor": "top"}
        notes.append(note(float(x.mean()), 0.98, text, **style, **common))
    return {"shapes": shapes, "annotations": notes}


def further_changes(contact_ratio: float) -> dict[str, float]:
    """Ages other than A, B, D and E at which the number of pairs in contact changes."""
    ages = {}
    for number in range(2, math.ceil(contact_ratio)):
        ages[f"D{number}"] = float(number)
        ages[f"B{number}"] = contact_ratio - number
    return ages


def sharing_sentence(contact_ratio: float) -> str:
    """Sentence on the number of tooth pairs between A and E, from the geometry alone."""
    least = math.floor(contact_ratio)
    if least == contact_ratio:
        return f"The number of pairs between A and E is the same everywhere: {least}."
    if least == 1:
        return "Before B and after D two pairs are between A and E; in between one pair is alone."
    fewer, more = (number_word(number) for number in (least, least + 1))
    return (
        f"{fewer.capitalize()} or {more} pairs are between A and E everywhere; their number "
        "changes at the marks other than C: another pair enters at each D and leaves at each B."
    )


def number_word(number: int) -> str:
    """Spell out a small number."""
    return _NUMBER_WORDS.get(number, str(number))
