"""Flanks of generated and of face-hobbed wheels.

A generated wheel is the envelope of the cutter on a cradle that rolls with it: the cradle turns
about the normal of the wheel's root plane through its pitch apex, and the pitch cone rolls on it
along its generator through the calculation point. In face hobbing cutter and work turn together, so
that every blade group cuts the next tooth and traces are extended epicycloids.
"""

from __future__ import annotations

import math

import numpy as np

from tribodyn.gear.hypoid.blank import HypoidBlank
from tribodyn.gear.hypoid.envelope import Axes, Surface, cross, envelope, turned, turned_surface
from tribodyn.gear.hypoid.formate import FormateFlank
from tribodyn.types import Array

_WHEEL_AXIS = np.array([0.0, 0.0, 1.0])


class HobbedFlank(FormateFlank):
    """Flank that a face-hobbing cutter leaves on a wheel, or on the crown gear of a cradle."""

    def __init__(self, blank: HypoidBlank, side: str, *, on_crown: bool = False) -> None:
        super().__init__(blank, side)
        self.apex = np.array([0.0, 0.0, -blank.pitch_apex_wheel])
        self.work = self.axis if on_crown else _WHEEL_AXIS
        groups, teeth = blank.blade_groups, float(blank.teeth_wheel)
        if on_crown:
            teeth /= math.sin(blank.pitch_angle_wheel)
        # Cutter and work roll on each other like external gears, seen along the cutter's axis.
        rolling = -math.copysign(groups / teeth, float(self.work @ self.axis))
        #: Rotation of the flank about the work's axis over that of the cutter.
        self.turn = -rolling
        flat = (self.point - self.center) / blank.cutter_radius
        drag = rolling * cross(self.work, self.point - self.apex) @ flat / blank.cutter_radius
        # The blades move along the trace: the cutter is turned by its lead angle about the point.
        sine = drag / (cross(self.axis, self.trace) @ flat)
        arm = math.sqrt(1.0 - sine**2) * flat + sine * self.trace
        self.center = self.point - blank.cutter_radius * arm
        self._facing = 1.0
        self._facing = math.copysign(1.0, float(self.at(np.zeros(2)).normal @ self.normal))

    def at(self, parameters: Array) -> Surface:
        """Points for distances along the blade [m] and angles about the cutter's axis [rad]."""
        height, angle = parameters[..., 0], parameters[..., 1]
        cutter, work, ratio = self.axis, self.work, self.turn

        start = self.point - self.center + height[..., None] * self.generator
        arm = turned(start, cutter, angle)
        blade = turned(np.broadcast_to(self.generator, arm.shape), cutter, angle)
        about = self.center - self.apex + arm
        swing = cross(cutter, arm)
        speed = ratio * cross(work, about) + swing
        bends = (
            ratio * cross(work, blade) + cross(cutter, blade),
            ratio * cross(work, speed + swing) + cross(cutter, swing),
        )
        area = cross(blade, speed)
        size = np.linalg.norm(area, axis=-1)
        normal = area / size[..., None]
        turns = []
        for change in (cross(blade, bends[0]), cross(bends[0], speed) + cross(blade, bends[1])):
            along = np.einsum("...i,...i->...", normal, change)
            turns.append((change - along[..., None] * normal) / size[..., None])
        surface = Surface(
            about,
            self._facing * normal,
            np.stack([blade, speed], axis=-1),
            self._facing * np.stack(turns, axis=-1),
        )
        surface = turned_surface(surface, work, ratio * angle)
        return surface._replace(position=surface.position + self.apex)


class GeneratedFlank(FormateFlank):
    """Flank that a cutter on a cradle envelops on a rolling wheel."""

    def __init__(self, blank: HypoidBlank, side: str) -> None:
        super().__init__(blank, side)
        hobbed = blank.process == "face-hobbing"
        self.tool = HobbedFlank(blank, side, on_crown=True) if hobbed else FormateFlank(blank, side)
        self.apex = np.array([0.0, 0.0, -blank.pitch_apex_wheel])
        generator = self.point - self.apex
        # The pitch cone rolls along its generator: wheel less cradle turns about it.
        rolls = cross(self.axis, generator)
        roll = float(cross(_WHEEL_AXIS, generator) @ rolls / (rolls @ rolls))
        cradle = -math.copysign(1.0, roll) * self.axis
        side_way = cross(cradle, generator)
        side_way /= np.linalg.norm(side_way)
        #: Frame of the cradle: rows are its axes.
        self.frame = np.stack([cross(side_way, cradle), side_way, cradle])
        self.rolling = Axes(self.frame @ _WHEEL_AXIS, np.zeros(3), abs(roll))

    def at(self, parameters: Array) -> Surface:
        """Points that the tool's points with these parameters cut."""
        tool = self.tool.at(parameters)
        cut = envelope(_in_frame(tool, self.frame, self.apex), self.rolling)
        wheel = turned_surface(cut.pinion, self.rolling.axis, -cut.rotation / self.rolling.ratio)
        wheel = _in_frame(wheel, self.frame.T, np.zeros(3))
        return wheel._replace(position=wheel.position + self.apex)


def _in_frame(surface: Surface, frame: Array, origin: Array) -> Surface:
    """Surface in a frame whose axes are rows, about an origin."""
    return Surface(
        (surface.position - origin) @ frame.T,
        surface.normal @ frame.T,
        np.einsum("ij,...jk->...ik", frame, surface.tangents),
        np.einsum("ij,...jk->...ik", frame, surface.turns),
    )


def wheel_flank(blank: HypoidBlank, side: str) -> FormateFlank:
    """Flank of the wheel of a blank by its process."""
    if blank.wheel_generation == "generated":
        return GeneratedFlank(blank, side)
    if blank.process == "face-hobbing":
        return HobbedFlank(blank, side)
    return FormateFlank(blank, side)
