"""Misalignment of a hypoid pair: where its axes are not where they should be."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from tribodyn.checks import require_number
from tribodyn.errors import require_between
from tribodyn.types import Array


@dataclass(frozen=True, kw_only=True)
class Misalignment:
    """Displacements of both gears from their nominal places; none by default.

    Parameters
    ----------
    offset : float [m]
        By how much the offset is too large.
    pinion_axial : float [m]
        Displacement of the pinion along its axis, away from the crossing point.
    wheel_axial : float [m]
        Displacement of the wheel along its axis, away from the crossing point.
    shaft_angle : float [rad]
        By how much the shaft angle is too large.

    Raises
    ------
    InputError
        If a displacement is not finite or beyond 2 mm, or the angle beyond 0.02 rad.

    Notes
    -----
    The four values E, P, G and alpha of the usual E-P-G checks of bevel gears.

    Examples
    --------
    >>> Misalignment(pinion_axial=0.1e-3).wheel_axial
    0.0
    """

    offset: float = 0.0
    pinion_axial: float = 0.0
    wheel_axial: float = 0.0
    shaft_angle: float = 0.0

    def __post_init__(self) -> None:
        for each in fields(self):
            value = require_number(each.name, getattr(self, each.name))
            angle = each.name == "shaft_angle"
            most, unit = (0.02, "rad") if angle else (2e-3, "m")
            require_between(each.name, value, -most, most, unit, remedy="0.1 mm is 0.1e-3")
            object.__setattr__(self, each.name, value)


def pinion_motion(given: Misalignment, sense: float) -> tuple[Array, Array]:
    """Rotation of the pinion about the crossing point and its displacement; sense of its hand."""
    cosine, sine = math.cos(given.shaft_angle), math.sin(given.shaft_angle)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])
    return turn, np.array([-sense * given.offset, given.pinion_axial, 0.0])


def displaced_gap(given: Misalignment, position: Array, normal: Array, sense: float) -> Array:
    """Gap that the displacements leave where conjugate flanks would touch, to first order."""
    turn, shift = pinion_motion(given, sense)
    pinion = position @ (turn - np.eye(3)).T + shift
    wheel = np.array([0.0, 0.0, given.wheel_axial])
    return np.asarray(np.einsum("...i,...i->...", wheel - pinion, normal))
