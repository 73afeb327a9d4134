"""One side of a hypoid pair: the Formate flank of the wheel, and the pinion flank it envelops."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.gear.hypoid.blank import HypoidBlank
from tribodyn.gear.hypoid.ease_off import EaseOff, eased_gap
from tribodyn.types import Array

#: Steps of Newton's method, and the greatest error left [m].
_STEPS, _CLOSE = 30, 1e-13


def pair_axes(blank: HypoidBlank) -> Axes:
    """Axes of the pair in the frame of :mod:`envelope`: y is the pinion's axis, z the wheel's."""
    sense = hand_sense(blank)
    origin = np.array([-sense * blank.offset, 0.0, 0.0])
    return Axes(np.array([0.0, 1.0, 0.0]), origin, 1.0 / blank.ratio)


def hand_sense(blank: HypoidBlank) -> float:
    """1 for a left-handed pinion, -1 for its mirror image in the plane x = 0."""
    return 1.0 if blank.hand_pinion == "left" else -1.0


class FormateFlank:
    """One side of the teeth of a Formate wheel, through the calculation point."""

    def __init__(self, blank: HypoidBlank, side: str) -> None:
        self.blank = blank
        sense = hand_sense(blank)
        angle = sense * blank.offset_angle_axial
        radius = 0.5 * blank.mean_pitch_diameter_wheel
        outward = np.array([-math.sin(angle), math.cos(angle), 0.0])
        self.point = radius * outward
        self.point[1:] = blank.calculation_point_pinion, blank.calculation_point_wheel
        normals = [
            math.cos(cone) * outward - math.sin(cone) * np.array([0.0, 0.0, 1.0])
            for cone in (blank.pitch_angle_wheel, blank.root_angle_wheel)
        ]
        pitch = blank.pitch_angle_wheel
        along = math.sin(pitch) * outward + np.array([0.0, 0.0, math.cos(pitch)])
        spiral = blank.mean_spiral_angle_wheel
        self.trace = math.cos(spiral) * along
        self.trace -= sense * math.sin(spiral) * cross(normals[0], along)
        # The pinion pushes the drive flank towards the apex, the coast flank away from it.
        drive = side == "drive"
        pressure = getattr(blank, f"normal_pressure_angle_{side}")
        push = cross(self.trace, normals[0])
        push *= -math.copysign(1.0, push @ along) * (1.0 if drive else -1.0)
        self.normal = math.cos(pressure) * push - math.sin(pressure) * normals[0]
        self.axis = normals[1]
        self.blade_angle = math.asin(-self.normal @ self.axis)
        flat = self.normal - (self.normal @ self.axis) * self.axis
        flat /= np.linalg.norm(flat)
        self.center = self.point + (1.0 if drive else -1.0) * blank.cutter_radius * flat
        self.generator = math.cos(self.blade_angle) * self.axis + math.sin(self.blade_angle) * flat

    def at(self, parameters: Array) -> Surface:
        """Points for distances along the blade [m] and angles about the cutter's axis [rad]."""
        height, angle = parameters[..., 0], parameters[..., 1]
        arm = self.point - self.center + height[..., None] * self.generator
        swing = turned(arm, self.axis, angle)
        normal = turned(np.broadcast_to(self.normal, arm.shape), self.axis, angle)
        blade = turned(np.broadcast_to(self.generator, arm.shape), self.axis, angle)
        tangents = np.stack([blade, cross(self.axis, swing)], axis=-1)
        turns = np.stack([np.zeros_like(normal), cross(self.axis, normal)], axis=-1)
        return Surface(self.center + swing, normal, tangents, turns)

    def projected(self, surface: Surface) -> tuple[Array, Array]:
        """Places (along, across) the pitch cone and their derivatives by the parameters."""
        pitch, apex = self.blank.pitch_angle_wheel, self.blank.pitch_apex_wheel
        x, y, z = np.moveaxis(surface.position, -1, 0)
        radius = np.hypot(x, y)
        turn = np.array([[math.sin(pitch), math.cos(pitch)], [math.cos(pitch), -math.sin(pitch)]])
        places = np.stack([radius, z + apex], axis=-1) @ turn.T
        places[..., 0] -= self.blank.mean_cone_distance_wheel
        outward = np.stack([x / radius, y / radius, np.zeros_like(x)], axis=-1)
        steps = np.stack(
            [np.einsum("...i,...ij->...j", outward, surface.tangents), surface.tangents[..., 2, :]],
            axis=-2,
        )
        return places, turn @ steps

    def parameters(self, places: Array) -> Array:
        """Parameters of points at (along, across) the pitch cone; NaN where the flank has none."""
        _, slope = self.projected(self.at(np.zeros((1, 2))))
        found = np.asarray(places) @ np.linalg.inv(slope[0]).T
        with np.errstate(invalid="ignore", over="ignore"):
            for _ in range(_STEPS):
                here, slope = self.projected(self.at(found))
                error = np.asarray(places) - here
                if np.nanmax(np.abs(error), initial=0.0) < _CLOSE:
                    break
                found = found + solved(slope, error)
        lost = np.max(np.abs(error), axis=-1) > 1e3 * _CLOSE
        return np.where(lost[..., None], np.nan, found)


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

    def to_pinion(self, vector: Array, rotation: Array) -> Array:
        """Vector of the fixed frame in a pinion that has turned."""
        return turned(vector, self.axis, -rotation)


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


def cross(one: Array, other: Array) -> Array:
    """Cross product of vectors in the last axis; of small arrays much faster than numpy's."""
    (a, b, c), (x, y, z) = (tuple(each[..., i] for i in range(3)) for each in (one, other))
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
    both = np.asarray(angle)[..., None]
    columns = [
        np.swapaxes(turned(np.swapaxes(each, -1, -2), axis, both), -1, -2)
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
                cross(tangents[..., i], normal) + cross(position, turns[..., i]),
                turns[..., i],
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
    """How conjugate flanks part from each other about their contact."""

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
    found = np.stack([d * x - b * y, a * y - c * x], axis=-1)
    return np.asarray(found / (a * d - b * c)[..., None])


class Touch(NamedTuple):
    """Conjugate contact at places on the wheel, in the fixed frame."""

    places: Array  #: (..., 2) along and across the wheel's pitch cone
    contact: Envelope
    sliding: Array  #: (..., 3) of the pinion over the wheel, for a unit speed of the pinion
    lever: Array  #: of the normal about the wheel's axis, positive

    @property
    def curvature(self) -> Curvature:
        """Curvature of the gap about each contact."""
        return relative_curvature(self.contact)

    def at(self, chosen: tuple[slice, ...]) -> Touch:
        """Some of the places."""
        contact = self.contact
        wheel, pinion = (
            Surface(*(values[chosen] for values in each))
            for each in (contact.wheel, contact.pinion)
        )
        touch = Envelope(contact.rotation[chosen], wheel, pinion, contact.slope[chosen])
        return Touch(self.places[chosen], touch, self.sliding[chosen], self.lever[chosen])


class ConjugateFlanks:
    """Drive or coast side of a pair; points are counted by the parameters of the wheel flank."""

    def __init__(self, blank: HypoidBlank, side: str, ease_off: EaseOff) -> None:
        self.blank, self.ease_off = blank, ease_off
        self.wheel, self.axes = FormateFlank(blank, side), pair_axes(blank)
        moment = cross(self.wheel.point, self.wheel.normal)
        #: 1 where the rotations grow while the pinion drives, else -1.
        self.sense = -math.copysign(1.0, moment[2])

    def touch(self, places: Array) -> Touch:
        """Touch the wheel at places; NaN where it has no flank or never touches."""
        return self.touch_at(self.wheel.at(self.wheel.parameters(places)))

    def touch_at(self, surface: Surface) -> Touch:
        """Touch the wheel at points of its flank."""
        places, _ = self.wheel.projected(surface)
        contact = envelope(surface, self.axes)
        position, normal = contact.wheel[:2]
        return Touch(
            places,
            contact,
            self.axes.sliding(position),
            -self.sense * cross(position, normal)[..., 2],
        )

    def margins(self, touch: Touch) -> Array:
        """Room (..., 4) to tip of wheel and pinion, to toe and heel; negative outside."""
        blank = self.blank
        along, across = np.moveaxis(touch.places, -1, 0)
        up = math.tan(blank.face_angle_wheel - blank.pitch_angle_wheel)
        x, place, z = np.moveaxis(touch.contact.pinion.position, -1, 0)
        radius, pitch = np.hypot(x, z), blank.pitch_angle_pinion
        distance = radius * math.sin(pitch) + (place + blank.pitch_apex_pinion) * math.cos(pitch)
        tip = (place + blank.face_apex_pinion) * math.tan(blank.face_angle_pinion)
        mean = blank.mean_cone_distance_wheel
        toe = along - (blank.inner_cone_distance_wheel - mean)
        heel = blank.outer_cone_distance_wheel - mean - along
        return np.stack(
            [
                blank.mean_addendum_wheel + along * up - across,
                tip - radius,
                np.minimum(toe, distance - blank.inner_cone_distance_pinion),
                np.minimum(heel, blank.outer_cone_distance_pinion - distance),
            ],
            axis=-1,
        )

    def pinion_at(self, parameters: Array) -> tuple[Array, Array]:
        """Position about the pinion's origin and normal of the eased pinion flank at rest."""
        flank = self.wheel.at(parameters)
        contact = envelope(flank, self.axes)
        places, steps = self.wheel.projected(flank)
        gap, slope = eased_gap(self.ease_off, self.blank, places)
        pinion = turned_surface(contact.pinion, self.axes.axis, -contact.rotation / self.axes.ratio)
        gap_slope = np.einsum("...i,...ij->...j", slope, steps)
        tangents = (
            pinion.tangents
            - pinion.normal[..., :, None] * gap_slope[..., None, :]
            - gap[..., None, None] * pinion.turns
        )
        normal = cross(tangents[..., 0], tangents[..., 1])
        # A pinion that is undercut is run through backwards; its normal keeps its sense.
        normal *= np.sign(np.einsum("...i,...i->...", normal, pinion.normal))[..., None]
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        return pinion.position - gap[..., None] * pinion.normal, normal
