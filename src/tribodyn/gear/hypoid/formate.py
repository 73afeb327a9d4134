"""Flank of a Formate wheel: the cone that a face-mill cutter leaves when it plunges."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.gear.hypoid.blank import HypoidBlank
from tribodyn.gear.hypoid.envelope import Axes, Surface, cross, solved, turned
from tribodyn.types import Array

#: Steps of Newton's method, and the greatest error left [m].
_STEPS, _CLOSE = 30, 1e-13


def pair_axes(blank: HypoidBlank) -> Axes:
    """Axes of the pair in the frame of :mod:`envelope`; at a right angle the pinion's is y."""
    sense = hand_sense(blank)
    origin = np.array([-sense * blank.offset, 0.0, 0.0])
    opening = blank.shaft_angle - 0.5 * math.pi
    axis = np.array([0.0, math.cos(opening), -math.sin(opening)])
    return Axes(axis, origin, 1.0 / blank.ratio)


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
        self.point[2] = blank.calculation_point_wheel
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
        parameters = np.asarray(places) @ np.linalg.inv(slope[0]).T
        with np.errstate(invalid="ignore", over="ignore"):
            for _ in range(_STEPS):
                position, slope = self.projected(self.at(parameters))
                error = np.asarray(places) - position
                if np.nanmax(np.abs(error), initial=0.0) < _CLOSE:
                    break
                parameters = parameters + solved(slope, error)
        lost = np.max(np.abs(error), axis=-1) > 1e3 * _CLOSE
        return np.where(lost[..., None], np.nan, parameters)
