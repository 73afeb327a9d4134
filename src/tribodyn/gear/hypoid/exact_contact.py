"""Exact contact of both flanks: one point in common, with one normal, at given rotations."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks
from tribodyn.gear.hypoid.envelope import turned
from tribodyn.gear.hypoid.formate import hand_sense
from tribodyn.gear.hypoid.misalignment import Misalignment, pinion_motion
from tribodyn.types import Array

#: Steps of Newton's method; units of a length [m] and of a rotation [rad]; step of differences.
_STEPS, _LENGTH, _ROTATION, _DIFFERENCE = 40, 1e-3, 1e-3, 1e-4
#: Error of position and normal that counts as none, and the one that is refused, over the unit.
_NONE, _REFUSED = 2e-12, 1e-9
#: Singular values below this share are those of flanks that touch along a line.
_LINE = 1e-10


class ExactContact(NamedTuple):
    """Contacts of two flanks."""

    wheel_rotation: Array  #: (n,)
    position: Array  #: (n, 3) in the fixed frame
    normal: Array  #: (n, 3)
    places: Array  #: (n, 2) along and across the wheel's pitch cone
    residual: Array  #: (n,) greatest error of position [m]


def exact_contact(
    flanks: ConjugateFlanks, rotation: Array, guess: Array, misalignment: Misalignment
) -> ExactContact:
    """Solve five equations for each rotation of the pinion, from a guess (n, 5).

    Unknowns are the parameters of the pinion's and of the wheel's flank, and the wheel's rotation.
    """
    swing = flanks.blank.cutter_radius
    unit = np.array([_LENGTH, _LENGTH / swing, _LENGTH, _LENGTH / swing, _ROTATION])
    turn, shift = pinion_motion(misalignment, hand_sense(flanks.blank))
    axes, wheel_axis = flanks.axes, np.array([0.0, 0.0, 1.0])

    def bodies(unknown: Array) -> tuple[Array, Array, Array, Array]:
        position, normal = flanks.pinion_at(unknown[..., :2])
        angle = np.broadcast_to(rotation, unknown.shape[:-1])
        place = (turned(position, axes.axis, angle) + axes.origin) @ turn.T + shift
        facing = turned(normal, axes.axis, angle) @ turn.T
        surface = flanks.wheel.at(unknown[..., 2:4])
        mate, mate_normal = (turned(each, wheel_axis, -unknown[..., 4]) for each in surface[:2])
        mate = mate + misalignment.wheel_axial * wheel_axis
        return place, facing, mate, mate_normal

    first = bodies(guess)[3]
    helper = np.where(np.abs(first[:, :1]) < 0.9, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    one = np.cross(first, helper)
    basis = np.stack([one, np.cross(first, one)], axis=-2)

    def error(unknown: Array) -> Array:
        place, facing, mate, mate_normal = bodies(unknown)
        turns = np.einsum("nij,...nj->...ni", basis, facing - mate_normal)
        return np.concatenate([(place - mate) / _LENGTH, turns], axis=-1)

    found = guess.copy()
    steps = _DIFFERENCE * unit * np.eye(5)
    for _ in range(_STEPS):
        fault = error(found)
        slope = error(found + steps[:, None]) - error(found - steps[:, None])
        matrix = np.moveaxis(slope, 0, -1) / (2.0 * _DIFFERENCE)
        change = np.einsum("nij,nj->ni", np.linalg.pinv(matrix, rcond=_LINE), fault)
        found = found - unit * change
        if np.max(np.abs(fault), initial=0.0) < _NONE:
            break
    left = np.max(np.abs(error(found)), axis=-1)
    if not np.all(left < _REFUSED):
        worst = int(np.argmax(np.where(np.isfinite(left), left, np.inf)))
        raise ComputationError(
            f"at a rotation of the pinion of {rotation[worst]:.4g} rad the flanks stay "
            f"{left[worst] * _LENGTH * 1e6:.3g} um apart",
            why="The misalignment or the ease-off moves the contact off the surfaces",
            remedy="Give less of it, or take the analysis by the ease-off",
        )
    _, _, mate, normal = bodies(found)
    places, _ = flanks.wheel.projected(flanks.wheel.at(found[:, 2:4]))
    return ExactContact(found[:, 4], mate, normal, places, left * _LENGTH)
