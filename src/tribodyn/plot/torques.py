"""Curves for several torques: their names, and colours from the least to the greatest."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.plot.labels import display_unit, displayed
from tribodyn.plot.style import TOTAL
from tribodyn.types import Array

#: Colours from the least to the greatest torque; between them they are mixed.
_ANCHORS = ("#0d0887", "#7e03a8", "#cc4778", "#f0893e")
#: Names of torques in a legend; further ones are told by the pointer.
_NAMED = 8


def torque_names(contact: Any) -> list[str]:
    """Name of each torque with its unit."""
    return torque_texts(np.ravel(contact.torque))


def torque_texts(torques: Array) -> list[str]:
    """Write torques with as many digits as tell them apart."""
    unit = display_unit("torque")
    return [f"{torque:.4g} {unit}" for torque in displayed("torque", torques)]


def torque_colors(count: int) -> list[str]:
    """Colours of curves that belong to rising torques."""
    if count == 1:
        return [TOTAL]
    anchors = np.array([[int(each[k : k + 2], 16) for k in (1, 3, 5)] for each in _ANCHORS])
    places = np.linspace(0.0, len(_ANCHORS) - 1.0, count)
    mixed = [np.interp(places, range(len(_ANCHORS)), anchors[:, k]) for k in range(3)]
    return ["#" + "".join(f"{round(part):02x}" for part in each) for each in np.transpose(mixed)]


def named(count: int, most: int = _NAMED) -> list[bool]:
    """Which of many torques are named in a legend: all of few, first, last and some of many."""
    chosen = np.linspace(0, count - 1, min(count, most)).round().astype(int)
    return [number in set(chosen.tolist()) for number in range(count)]
