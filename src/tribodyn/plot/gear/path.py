"""The way of a tooth pair through the mesh: its positions A to E, and how many pairs share."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.contact.path import pitch_point_age
from tribodyn.plot.look.labels import axis_label, displayed
from tribodyn.plot.look.style import MUTED, Trace
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh.gears import Gears

#: Part of the way that a shade takes at least to be named.
_NAMED_SHADE = 0.03
#: Fill behind the places where a tip corner bears.
_SHADE = "rgba(107, 119, 133, 0.13)"
_WORDS = {1: "one", 2: "two", 3: "three", 4: "four", 5: "five"}


def roll_angle_of(pair: Gears, age: Any) -> Array:
    """Roll angle of the driving gear at an age of a tooth pair."""
    contact = path_of_contact(pair)
    first = contact.A if pair.driver == "pinion" else pair.line_of_action_length - contact.A
    radius = first + np.asarray(age, dtype=float) * pair.base_pitch
    return np.asarray(radius / pair.driving.base_radius)


def roll_label(pair: Gears) -> str:
    """Label of an axis of roll angles."""
    return axis_label("roll_angle", f"Roll angle of the driving gear ({pair.driver})")


def pair_ages(pair: Gears) -> dict[str, float]:
    """Ages at which a tooth pair passes the positions A to E and further changes of sharing."""
    contact = path_of_contact(pair)
    ratio = contact.contact_ratio
    pitch_point = float(pitch_point_age(contact))
    ages = {"A": 0.0, "B": ratio - 1.0, "C": pitch_point, "D": 1.0, "E": ratio}
    return ages | further_changes(ratio)


def pair_letters(pair: Gears) -> list[tuple[str, float]]:
    """Positions A to E and further changes of sharing, as roll angles in the display unit."""
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
    placed = [(name, at + cycle) for cycle in range(repeats) for name, at in marks]
    return [*placed, (enters, float(repeats))]


def corner_shades(pair: Gears, first: float, last: float) -> dict[str, list[Trace]]:
    """Shade and name the places before A and after E, where a tip corner bears."""
    shapes, notes = [], []
    for start, stop in ((first, 0.0), (pair.transverse_contact_ratio, last)):
        if stop <= start:
            continue
        x = displayed("roll_angle", roll_angle_of(pair, np.array([start, stop])))
        common = {"xref": "x", "yref": "paper"}
        rectangle = {"x0": float(x[0]), "x1": float(x[1]), "y0": 0, "y1": 1}
        fill = {"fillcolor": _SHADE, "line": {"width": 0}, "layer": "below"}
        shapes.append({"type": "rect", **common, **rectangle, **fill})
        if stop - start < _NAMED_SHADE * (last - first):
            continue
        words = {"text": "tip corner", "textangle": -90, "font": {"size": 11, "color": MUTED}}
        place = {"x": float(x.mean()), "y": 0.98, "yanchor": "top", "showarrow": False}
        notes.append({**words, **place, **common})
    return {"shapes": shapes, "annotations": notes}


def further_changes(contact_ratio: float) -> dict[str, float]:
    """Ages of a tooth pair at which the number of pairs changes, besides A, B, D and E."""
    found = {}
    for number in range(2, math.ceil(contact_ratio)):
        found[f"D{number}"] = float(number)
        found[f"B{number}"] = contact_ratio - number
    return found


def sharing_words(contact_ratio: float) -> str:
    """State in one sentence how many tooth pairs are between A and E where: geometry alone."""
    least = math.floor(contact_ratio)
    if least == contact_ratio:
        return f"The number of pairs between A and E is the same everywhere: {least}."
    if least == 1:
        return "Before B and after D two pairs are between A and E, in the middle one is alone."
    few, many = (number_word(number) for number in (least, least + 1))
    return (
        f"{few.capitalize()} or {many} pairs are between A and E everywhere; their number changes "
        "at the marks other than C: another pair enters at each D and leaves at each B."
    )


def number_word(number: int) -> str:
    """A small number in letters."""
    return _WORDS.get(number, str(number))
