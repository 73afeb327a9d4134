"""The loaded tooth contact as curves: over the way of one tooth pair, or over all mesh cycles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.plot.labels import axis_label, displayed
from tribodyn.plot.sharing import further_changes
from tribodyn.plot.style import MUTED
from tribodyn.types import Array

#: Mesh cycles shown beyond both ends of what is loaded.
_MARGIN = 0.04
#: Part of the total force that counts as load.
_LOADED = 1e-6
#: Part of the way that a shade takes at least to be named.
_NAMED_SHADE = 0.03
#: Fill behind the places where a tip corner bears.
_SHADE = "rgba(107, 119, 133, 0.13)"


@dataclass(frozen=True)
class Life:
    """Least, mean and greatest value over all tooth pairs, from entry to exit."""

    age: Array  #: mesh cycles since a pair passed A, in order
    least: Array
    mean: Array
    greatest: Array

    @classmethod
    def of(cls, contact: Any, values: Array) -> Life:
        """Follow the tooth pairs of a loaded contact."""
        many = np.reshape(values, (-1, *np.shape(values)[-2:]))
        fraction = np.round(np.mod(contact.phase, 1.0), 9)
        phases, where = np.unique(fraction, return_inverse=True)
        groups = [many[:, where == group, :] for group in range(phases.size)]
        found = []
        for reduce in (np.min, np.mean, np.max):
            each = np.stack([reduce(group, axis=1) for group in groups], axis=1)
            found.append(np.moveaxis(each, 2, 1).reshape(many.shape[0], -1))
        age = (phases[:, None] + contact.number).T.ravel()
        order = np.argsort(age, kind="stable")
        age, found = age[order], [part[:, order] for part in found]
        if np.min(contact.number) == 0:
            # Without tip corners the load begins at A at once.
            age, found = np.append(0.0, age), [np.pad(part, ((0, 0), (1, 0))) for part in found]
        return cls(age, *found)


def rows(contact: Any, values: Array) -> list[Array]:
    """Split values by torque, whether there is one torque or several."""
    return list(np.reshape(values, (np.size(contact.torque), -1)))


def several_cycles(contact: Any) -> bool:
    """Whether the teeth differ, so that several mesh cycles pass before everything repeats."""
    return bool(np.max(contact.phase) >= 1.0)


def span(contact: Any) -> tuple[float, float]:
    """Ages between which some pair carries load, with a little margin."""
    shares = Life.of(contact, contact.load_share)
    loaded = shares.age[(shares.greatest > _LOADED).any(axis=0)]
    last = max(contact.gear_pair.transverse_contact_ratio, float(loaded.max()))
    return min(0.0, float(loaded.min())) - _MARGIN, last + _MARGIN


def roll_angle_of(pair: Any, age: Any) -> Array:
    """Roll angle of the driving gear at an age of a tooth pair."""
    contact = path_of_contact(pair)
    first = contact.A if pair.driver == "pinion" else pair.line_of_action_length - contact.A
    radius = first + np.asarray(age, dtype=float) * pair.base_pitch
    return np.asarray(radius / pair.driving.base_radius)


def roll_label(pair: Any) -> str:
    """Label of an axis of roll angles."""
    return axis_label("roll_angle", f"Roll angle of the driving gear ({pair.driver})")


def pair_letters(pair: Any) -> list[tuple[str, float]]:
    """Positions A to E and further changes of sharing, as roll angles in the display unit."""
    contact = path_of_contact(pair)
    ratio = contact.contact_ratio
    pitch_point = contact.direction * (contact.C - contact.A) / pair.base_pitch
    ages = {"A": 0.0, "B": ratio - 1.0, "C": pitch_point, "D": 1.0, "E": ratio}
    if not 0.0 <= pitch_point <= ratio:
        del ages["C"]
    ages |= further_changes(ratio)
    return [
        (name, float(displayed("roll_angle", roll_angle_of(pair, age))))
        for name, age in ages.items()
    ]


def whole_cycles(phase: Array, values: Array, period: int, repeats: int = 1) -> tuple[Array, Array]:
    """Repeat evenly spaced samples of a periodic curve, up to where the last cycle ends."""
    turns = [phase + period * number for number in range(repeats)]
    end = [phase[0] + period * repeats]
    return np.concatenate([*turns, end]), np.append(np.tile(values, repeats), values[0])


def mesh_marks(pair: Any, repeats: int) -> list[tuple[str, float]]:
    """Mesh phases at which a tooth pair reaches A, leaves at E or passes the pitch point."""
    contact = path_of_contact(pair)
    pitch_point = contact.direction * (contact.C - contact.A) / pair.base_pitch
    marks = [("A", 0.0), ("E", contact.contact_ratio % 1.0)]
    if 0.0 <= pitch_point <= contact.contact_ratio:
        marks.append(("C", pitch_point % 1.0))
    placed = [(name, at + cycle) for cycle in range(repeats) for name, at in marks]
    return [*placed, ("A", float(repeats))]


def corner_shades(pair: Any, first: float, last: float) -> dict[str, list[dict[str, Any]]]:
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
