"""Conjugate of a wheel flank: the envelope that it leaves on a pinion, in closed form.

The wheel turns about the z axis of the fixed frame with the velocity (0, 0, -ratio), while the
pinion turns with the unit velocity ``axis`` about a line through ``origin``. Normals point out of
the pinion into the wheel. Rotations are zero where the calculation point touches.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.types import Array


class Axes(NamedTuple):
    """Axes of both gears and their ratio."""

    axis: Array  #: unit angular velocity of the pinion
    origin: Array  #: a point of the pinion's axis
    ratio: float  #: teeth of the pinion over those of the wheel

    @property
    def relative(self) -> Array:
        """Angular velocity of the pinion relative to the wheel."""
        return np.asarray(self.axis + np.array([0.0, 0.0, self.ratio]))

    def sliding(self, position: Array) -> Array:
        """Velocity of the pinion less that of the wheel for a unit velocity of the pinion."""
        return np.asarray(cross(self.relative, position) - cross(self.axis, self.origin))


class Surface(NamedTuple):
    """Points of a flank with their derivatives by two parameters in the last axis."""

    position: Array  #: (..., 3)
    normal: Array  #: (..., 3)
    tangents: Array  #: (..., 3, 2)
    turns: Array  #: derivatives of the normal


class Envelope(NamedTuple):
    """Where points of a wheel flank touch their conjugate, in the fixed frame at that moment."""

    rotation: Array  #: of the wheel about its velocity, NaN where the point never touches
    wheel: Surface
    pinion: Surface  #: position about the pinion's origin
    slope: Array  #: (..., 2) derivatives of the rotation by the parameters of the flank


def cross(left: Array, right: Array) -> Array:
    """Cross product of vectors in the last axis; of small arrays much faster than numpy's."""
    (a, b, c), (x, y, z) = (tuple(each[..., i] for i in range(3)) for each in (left, right))
    return np.stack([b * z - c * y, c * x - a * z, a * y - b * x], axis=-1)


def turned(vector: Array, axis: Array, angle: Array) -> Array:
    """Turn vectors about a unit axis: Rodrigues."""
    angle = np.asarray(angle)[..., None]
    along = (vector @ axis)[..., None] * axis
    return np.asarray(
        along + np.cos(angle) * (vector - along) + np.sin(angle) * cross(axis, vector)
    )


def turned_surface(surface: Surface, axis: Array, angle: Array) -> Surface:
    """Turn a flank with its derivatives."""
    column_angle = np.asarray(angle)[..., None]
    columns = [
        np.swapaxes(turned(np.swapaxes(each, -1, -2), axis, column_angle), -1, -2)
        for each in (surface.tangents, surface.turns)
    ]
    position, normal = (turned(each, axis, angle) for each in surface[:2])
    return Surface(position, normal, columns[0], columns[1])


_WHEEL_AXIS = np.array([0.0, 0.0, 1.0])


def contact_rotation(surface: Surface, axes: Axes) -> Array:
    """Rotation of the wheel at which points touch, the one nearest to zero; NaN if never.

    The normal velocity is linear in cosine and sine of the rotation.
    """
    moment = cross(surface.position, surface.normal)
    drift = cross(axes.axis, axes.origin)

    def part(about: Array) -> Array:
        return np.asarray(moment @ (about * axes.relative) - surface.normal @ (about * drift))

    across, along = np.array([1.0, 1.0, 0.0]), _WHEEL_AXIS
    cosine = part(across)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    sine = moment @ (turn @ axes.relative) - surface.normal @ (turn @ drift)
    size = np.hypot(cosine, sine)
    with np.errstate(invalid="ignore", divide="ignore"):
        lag = np.arccos(-part(along) / size)
    middle = np.arctan2(sine, cosine)
    roots = np.stack([middle + lag, middle - lag])
    roots -= 2.0 * np.pi * np.round(roots / (2.0 * np.pi))
    return np.asarray(np.where(np.abs(roots[0]) < np.abs(roots[1]), roots[0], roots[1]))


def envelope(surface: Surface, axes: Axes) -> Envelope:
    """Touch every point of a wheel flank with the pinion that it envelops."""
    rotation = contact_rotation(surface, axes)
    wheel = turned_surface(surface, _WHEEL_AXIS, -rotation)
    position, normal, tangents, turns = wheel
    drift = cross(axes.axis, axes.origin)

    def meshing(moment: Array, direction: Array) -> Array:
        return np.asarray(moment @ axes.relative - direction @ drift)

    rate = -meshing(cross(_WHEEL_AXIS, cross(position, normal)), cross(_WHEEL_AXIS, normal))
    slope = np.stack(
        [
            -meshing(
                cross(tangents[..., i], normal) + cross(position, turns[..., i]), turns[..., i]
            )
            / rate
            for i in (0, 1)
        ],
        axis=-1,
    )
    per_turn = slope[..., None, :] / axes.ratio
    pinion = Surface(
        position - axes.origin,
        normal,
        tangents - axes.sliding(position)[..., None] * per_turn,
        turns - cross(axes.relative, normal)[..., None] * per_turn,
    )
    return Envelope(rotation, wheel, pinion, slope)


class Curvature(NamedTuple):
    """Separation of conjugate flanks around their contact."""

    line: Array  #: (..., 3) unit direction of the contact line
    across: Array  #: (..., 3) unit direction across it
    tensor: Array  #: (..., 2, 2) gap = tensor / 2, along and across the line
    regularity: Array  #: area of the pinion over that of the wheel; undercut where not positive
    gradient: Array  #: rotation of the wheel per length across the line


def relative_curvature(contact: Envelope) -> Curvature:
    """Curvature of the gap about each contact, undercut and the speed of the contact line."""
    wheel, pinion, slope = contact.wheel, contact.pinion, contact.slope
    direction = wheel.tangents[..., 1] * slope[..., :1] - wheel.tangents[..., 0] * slope[..., 1:]
    line = direction / np.linalg.norm(direction, axis=-1, keepdims=True)
    across = cross(wheel.normal, line)
    basis = np.stack([line, across], axis=-2)
    shapes, areas = [], []
    for surface in (pinion, wheel):
        steps = basis @ surface.tangents
        areas.append(steps[..., 0, 0] * steps[..., 1, 1] - steps[..., 0, 1] * steps[..., 1, 0])
        shapes.append(basis @ surface.turns @ _inverse(steps, areas[-1]))
    inverse = _inverse(basis @ wheel.tangents, areas[1])
    gradient = np.einsum("...i,...i->...", slope, inverse[..., 1])
    return Curvature(line, across, shapes[0] - shapes[1], areas[0] / areas[1], gradient)


def _inverse(matrix: Array, determinant: Array) -> Array:
    """Inverse of 2 x 2 matrices; not finite where one is singular."""
    swapped = np.stack(
        [
            np.stack([matrix[..., 1, 1], -matrix[..., 0, 1]], axis=-1),
            np.stack([-matrix[..., 1, 0], matrix[..., 0, 0]], axis=-1),
        ],
        axis=-2,
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(swapped / determinant[..., None, None])


def solved(matrix: Array, right: Array) -> Array:
    """Solution (..., 2) of 2 x 2 systems; not finite where one is singular."""
    (a, b), (c, d) = (np.moveaxis(row, -1, 0) for row in np.moveaxis(matrix, -2, 0))
    x, y = np.moveaxis(right, -1, 0)
    numerators = np.stack([d * x - b * y, a * y - c * x], axis=-1)
    return np.asarray(numerators / (a * d - b * c)[..., None])
