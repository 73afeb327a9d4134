"""The solid tooth of a hypoid or spiral bevel gear: its flanks, fillets and body as nodes.

Places are measured on the gear itself: along its pitch cone from the calculation point towards the
heel and up from it, with the angle about the axis counted from the loaded flank into the tooth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.gear import HypoidFlanks
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks
from tribodyn.gear.hypoid.ease_off import working_depth
from tribodyn.gear.hypoid.flank import SIDES
from tribodyn.types import Array

#: Grid of points of a flank, how far it goes beyond it, and degrees along and up of the fit.
_GRID, _WIDER, _DEGREES = 17, 0.05, (6, 4)
#: Share of half a root that a fillet may take.
_ROOT_SHARE = 0.85


class Cone(NamedTuple):
    """Cones of a gear, lengths in mean normal modules."""

    distance: float  #: mean cone distance
    pitch: float  #: half angle of the pitch cone [rad]
    tip: tuple[float, float]  #: half angle of the tip cone and its apex beyond that of the pitch
    root: tuple[float, float]
    ends: tuple[float, float]  #: places of toe and heel along the pitch cone

    def at(self, along: Array, up: Array) -> tuple[Array, Array]:
        """Radius and distance from the pitch apex along the axis."""
        sine, cosine = math.sin(self.pitch), math.cos(self.pitch)
        reach = self.distance + along
        return reach * sine + up * cosine, reach * cosine - up * sine

    def places(self, radius: Array, axial: Array) -> tuple[Array, Array]:
        """Places (along, up) of points with radius and distance from the pitch apex."""
        sine, cosine = math.sin(self.pitch), math.cos(self.pitch)
        return radius * sine + axial * cosine - self.distance, radius * cosine - axial * sine

    def height(self, cone: tuple[float, float], along: Array) -> Array:
        """Place up the pitch cone of another cone about the same axis."""
        angle, apex = cone
        sine, cosine = math.sin(self.pitch), math.cos(self.pitch)
        reach = self.distance + along
        over = (reach * cosine + apex) * math.tan(angle) - reach * sine
        return np.asarray(over / (cosine + sine * math.tan(angle)))


@dataclass(frozen=True, eq=False)
class FlankFit:
    """Angle of a flank about the axis as a polynomial of its places."""

    scale: Array  #: middle and half range (2, 2) of the places along and up
    coefficients: Array

    @classmethod
    def through(cls, along: Array, up: Array, angle: Array) -> FlankFit:
        """Fit to points."""
        places: Array = np.stack([along, up])
        low, high = places.min(axis=1), places.max(axis=1)
        scale: Array = np.stack([0.5 * (low + high), 0.5 * (high - low)])
        x, y = (places - scale[0][:, None]) / scale[1][:, None]
        terms = np.polynomial.legendre.legvander2d(x, y, _DEGREES)
        solution = np.linalg.lstsq(terms, angle, rcond=None)[0]
        return cls(
            scale, np.asarray(solution.reshape(_DEGREES[0] + 1, _DEGREES[1] + 1), dtype=float)
        )

    def __call__(self, along: Array, up: Array, slope: int | None = None) -> Array:
        """Angle, or its slope along (0) or up (1)."""
        x = (along - self.scale[0, 0]) / self.scale[1, 0]
        y = (up - self.scale[0, 1]) / self.scale[1, 1]
        coefficients, over = np.asarray(self.coefficients), 1.0
        if slope is not None:
            coefficients = np.asarray(np.polynomial.legendre.legder(coefficients, axis=slope))
            over = self.scale[1, slope]
        return np.asarray(np.polynomial.legendre.legval2d(x, y, coefficients) / over)


def gear_cone(flanks: HypoidFlanks, gear: str) -> Cone:
    """Cones of a gear of a pair."""
    blank, unit = flanks.blank, flanks.blank.mean_normal_module

    def of(name: str) -> float:
        return float(getattr(blank, f"{name}_{gear}"))

    mean, apex = of("mean_cone_distance"), of("pitch_apex")
    tip, root = (
        (of(f"{name}_angle"), (of(f"{name}_apex") - apex) / unit) for name in ("face", "root")
    )
    ends = [(of(f"{name}_cone_distance") - mean) / unit for name in ("inner", "outer")]
    return Cone(mean / unit, of("pitch_angle"), tip, root, (ends[0], ends[1]))


def _flank_points(flanks: HypoidFlanks, gear: str, side: str) -> tuple[Array, Array]:
    """Points and normals out of the pinion of one side, with the axis of the gear as z."""
    surfaces = ConjugateFlanks(flanks.blank, side, flanks.ease_off)
    share = np.linspace(-_WIDER, 1.0 + _WIDER, _GRID)
    blank = flanks.blank
    inner = blank.inner_cone_distance_wheel - blank.mean_cone_distance_wheel
    along = inner + share * blank.face_width_wheel
    (low, _), (high, _) = working_depth(blank, along)
    across = low[:, None] + share * (high - low)[:, None]
    places = np.stack(np.broadcast_arrays(along[:, None], across), axis=-1).reshape(-1, 2)
    places = np.concatenate([places, np.zeros((1, 2))])  # the calculation point is the last
    parameters = surfaces.wheel.parameters(places)
    if gear == "wheel":
        position, normal = surfaces.wheel.at(parameters)[:2]
    else:
        axis = surfaces.axes.axis
        frame = np.stack([[1.0, 0.0, 0.0], np.cross(axis, [1.0, 0.0, 0.0]), axis])
        position, normal = (each @ frame.T for each in surfaces.pinion_at(parameters))
    certain = np.isfinite(position).all(axis=1)
    return position[certain], normal[certain]


@dataclass(frozen=True, eq=False)
class BevelTooth:
    """One tooth of a gear of a pair, lengths in mean normal modules."""

    flanks: HypoidFlanks
    gear: str

    @cached_property
    def cone(self) -> Cone:
        """Cones of the gear."""
        return gear_cone(self.flanks, self.gear)

    @property
    def count(self) -> int:
        """Number of teeth."""
        return int(getattr(self.flanks.blank, f"teeth_{self.gear}"))

    @property
    def pitch(self) -> float:
        """Angle from tooth to tooth [rad]."""
        return 2.0 * math.pi / self.count

    @cached_property
    def _sides(self) -> tuple[float, FlankFit, FlankFit]:
        """Sense about the axis in which angles grow, and both flanks, the loaded one first."""
        blank, cone = self.flanks.blank, self.cone
        unit, apex = blank.mean_normal_module, getattr(blank, f"pitch_apex_{self.gear}")
        fits, sense = [], 0.0
        for side in sorted(SIDES, key=lambda name: name != self.flanks.side):
            position, normal = _flank_points(self.flanks, self.gear, side)
            radius = np.hypot(position[:, 0], position[:, 1])
            angle = np.arctan2(position[:, 1], position[:, 0])
            if not sense:  # into the tooth: along the normal on the wheel, against it on the pinion
                inwards = position[-1, 0] * normal[-1, 1] - position[-1, 1] * normal[-1, 0]
                sense = math.copysign(1.0, inwards) * (1.0 if self.gear == "wheel" else -1.0)
            angle = sense * (angle - angle[-1])
            angle -= 2.0 * math.pi * np.round(angle / (2.0 * math.pi))
            places = cone.places(radius / unit, (position[:, 2] + apex) / unit)
            fits.append(FlankFit.through(*places, angle))
        thickness = getattr(blank, f"mean_normal_thickness_{self.gear}") / unit
        spiral = getattr(blank, f"mean_spiral_angle_{self.gear}")
        mean_radius = cone.distance * math.sin(cone.pitch)
        fits[1].coefficients[0, 0] += thickness / (mean_radius * math.cos(spiral))
        return sense, fits[0], fits[1]

    @property
    def sense(self) -> float:
        """1 where angles of the tooth grow with those about the axis of the gear, else -1."""
        return self._sides[0]

    @property
    def fits(self) -> tuple[FlankFit, FlankFit]:
        """Loaded flank and the other one."""
        return self._sides[1:]

    def points(self, along: Array, up: Array, angle: Array) -> Array:
        """Points (..., 3) with the axis of the gear as z; mirrored where the sense is negative."""
        radius, axial = self.cone.at(along, up)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), axial], axis=-1)

    def tangents(self, along: Array, up: Array) -> Array:
        """Derivatives (..., 3, 2) of the loaded flank along and up."""
        flank, cone = self.fits[0], self.cone
        angle, radius = flank(along, up), cone.at(along, up)[0]
        columns = []
        for slope in (0, 1):
            rise, fall = math.sin(cone.pitch), math.cos(cone.pitch)
            outwards, axial = (rise, fall) if slope == 0 else (fall, -rise)
            turn = radius * flank(along, up, slope)
            columns.append(
                np.stack(
                    [
                        outwards * np.cos(angle) - turn * np.sin(angle),
                        outwards * np.sin(angle) + turn * np.cos(angle),
                        np.full_like(angle, axial),
                    ],
                    axis=-1,
                )
            )
        return np.stack(columns, axis=-1)

    def fillets(self, along: Array, largest: float) -> tuple[Array, Array]:
        """Corners (sides, stations, 3, 2) of both fillets' arcs, and cosines of half their turn."""
        # The corners are on the flank, where flank and root would meet, and on the root.
        root = self.cone.height(self.cone.root, along)
        radius = self.cone.at(along, root)[0]
        leans, feet, scales = [], [], []
        for fit, inwards in zip(self.fits, (1.0, -1.0), strict=True):
            lean = fit(along, root + 0.25, 1) * inwards
            spiral = radius * fit(along, root + 0.25, 0)
            scale = radius / np.hypot(1.0, spiral)  # across the tooth per angle
            leans.append(np.arctan(scale * lean))
            feet.append(fit(along, root + 0.25) - inwards * 0.25 * lean)
            scales.append(scale)
        half_root = 0.5 * (self.pitch - (feet[1] - feet[0]))
        turn = 0.5 * math.pi - np.array(leans)
        reach = np.tan(0.5 * turn)
        most = float((half_root * np.array(scales) / reach).min()) * _ROOT_SHARE
        if most <= 0.02:
            raise ComputationError(
                f"the {self.gear} has no room between the feet of its teeth",
                why="Flanks and root cone leave no root land at one end of the face",
                remedy='Choose the stiffness model "line", or give thinner teeth',
            )
        length = min(largest, most) * reach
        corners = []
        for k, (fit, inwards) in enumerate(zip(self.fits, (1.0, -1.0), strict=True)):
            high = root + length[k] * np.cos(leans[k])
            begin = np.stack([fit(along, high), high], axis=-1)
            slope = fit(along, high, 1)
            corner = np.stack([begin[:, 0] - slope * (high - root), root], axis=-1)
            end = np.stack([corner[:, 0] - inwards * length[k] / scales[k], root], axis=-1)
            corners.append(np.stack([begin, corner, end], axis=1))
        return np.array(corners), np.cos(0.5 * turn)
