"""Pitch cones of a hypoid pair on axes that cross at any angle: Method 1 of ISO 23509."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError
from tribodyn.gear.curves import bisect
from tribodyn.types import Array, Mask

#: Pinion offset angles in the axial plane that are searched [rad], and how many.
_LEAST, _MOST, _SEARCHED = 1e-7, 1.5, 2000


class PitchInput(NamedTuple):
    """Input data of the pitch cones, in SI."""

    teeth_pinion: int
    teeth_wheel: int
    offset: float
    outer_pitch_diameter_wheel: float
    face_width_wheel: float
    mean_spiral_angle_pinion: float
    cutter_radius: float
    shaft_angle: float = 0.5 * math.pi
    blade_groups: int = 0  #: of a face-hobbing cutter; zero for face milling

    @property
    def ratio(self) -> float:
        """Teeth of the wheel over those of the pinion."""
        return self.teeth_wheel / self.teeth_pinion

    @property
    def opening(self) -> float:
        """Shaft angle beyond a right angle."""
        return self.shaft_angle - 0.5 * math.pi

    @property
    def first_pitch_angle(self) -> float:
        """Approximate pitch angle of the wheel; it fixes the mean radius."""
        slope = 1.2 * (1.0 - self.ratio * math.sin(self.opening))
        return math.atan2(self.ratio * math.cos(self.opening), slope)

    @property
    def mean_radius_wheel(self) -> float:
        """Radius of the calculation point about the wheel's axis."""
        width = self.face_width_wheel * math.sin(self.first_pitch_angle)
        return 0.5 * (self.outer_pitch_diameter_wheel - width)


class PitchCones(NamedTuple):
    """The two pitch cones that touch in the calculation point; pairs are (pinion, wheel)."""

    pitch_angle: tuple[float, float]
    spiral_angle: tuple[float, float]
    cone_distance: tuple[float, float]
    offset_angle: float  #: in the pitch plane
    limit_pressure_angle: float
    limit_curvature: float  #: of the tooth trace; that of the cut one without offset


def pitch_cones(pitch_input: PitchInput) -> PitchCones:
    """Cones whose limit curvature is that of the trace; the spiral bevel pair without offset."""
    _require_outer_cones(pitch_input)
    if pitch_input.offset == 0.0:
        return _spiral_bevel(pitch_input)
    _require_reach(pitch_input)
    sense = math.copysign(1.0, pitch_input.offset)
    angle = sense * np.geomspace(_LEAST, _MOST, _SEARCHED)
    cones = _cones_at(angle, pitch_input)
    valid = _possible(cones)
    excess = _excess(cones, pitch_input)
    cut = valid & np.isfinite(excess)
    crossing = cut[1:] & cut[:-1] & (excess[1:] * excess[:-1] <= 0.0)
    if not np.any(crossing):
        raise _no_cones(pitch_input, np.asarray(cones.limit_curvature)[valid])
    # The smallest offset angle belongs to the cones that roll best on each other.
    first = int(np.argmax(crossing))
    sign = math.copysign(1.0, excess[first])
    root = bisect(
        lambda x: sign * float(_excess(_cones_at(x, pitch_input), pitch_input)),
        *angle[first : first + 2],
    )
    solution = _cones_at(root, pitch_input)
    pairs = [(float(pinion), float(wheel)) for pinion, wheel in solution[:3]]
    return PitchCones(pairs[0], pairs[1], pairs[2], *(float(value) for value in solution[3:]))


def trace_curvature(
    pitch_input: PitchInput, pitch: ArrayLike, spiral: ArrayLike, distance: ArrayLike
) -> Array:
    """Curvature of the trace of a circle or an extended epicycloid on the crown gear [1/m]."""
    radius, groups = pitch_input.cutter_radius, pitch_input.blade_groups
    if not groups:
        return np.asarray(1.0 / radius)
    cone, angle, mean = (np.asarray(each) for each in (pitch, spiral, distance))
    with np.errstate(all="ignore"):
        share = groups * np.sin(cone) / pitch_input.teeth_wheel
        across = mean * np.cos(angle)
        lead = np.arcsin(share * across / radius)
        centre = np.sqrt(mean**2 + radius**2 - 2.0 * mean * radius * np.sin(angle - lead))
        slope = np.tan(np.arccos(across * (1.0 + share) / centre))
        bent = slope / (1.0 + np.tan(lead) * (np.tan(angle) + slope))
        return np.asarray(1.0 / (across * (np.tan(angle) + bent)))


def _excess(cones: PitchCones, pitch_input: PitchInput) -> Array:
    """Limit curvature of cones less that of the trace of their teeth."""
    wheel = (each[1] for each in (cones.pitch_angle, cones.spiral_angle, cones.cone_distance))
    return np.asarray(cones.limit_curvature - trace_curvature(pitch_input, *wheel))


def limit_pressure_tangent(
    pitch: tuple[Array, Array], spiral: tuple[Array, Array], distance: tuple[Array, Array]
) -> Array:
    """Tangent of the limit pressure angle times the cosine of the offset angle, ISO 23509."""
    slip = distance[0] * np.sin(spiral[0]) - distance[1] * np.sin(spiral[1])
    taper = [np.tan(angle) for angle in pitch]
    return np.asarray(
        -taper[0] * taper[1] * slip / (distance[0] * taper[0] + distance[1] * taper[1])
    )


def _cones_at(offset_angle: ArrayLike, pitch_input: PitchInput) -> PitchCones:
    """Cones for pinion offset angles in the axial plane: clause 6.3.2; NaN where there are none."""
    eta, ratio, offset = np.asarray(offset_angle), pitch_input.ratio, pitch_input.offset
    radius, wanted = pitch_input.mean_radius_wheel, math.tan(pitch_input.mean_spiral_angle_pinion)
    turn, lean = math.cos(pitch_input.opening), math.tan(pitch_input.opening)
    start = math.asin(offset * math.sin(pitch_input.first_pitch_angle) / radius)
    enlargement = wanted * math.sin(start) + math.cos(start)
    pinion_radius = radius * enlargement / ratio
    with np.errstate(all="ignore"):
        wheel_angle = np.arcsin((offset - pinion_radius * np.sin(eta)) / radius)
        pitch = np.arctan(np.sin(eta) / (np.tan(wheel_angle) * turn) + np.cos(eta) * lean)
        plane = np.arcsin(np.sin(wheel_angle) * turn / np.cos(pitch))
        spiral = np.arctan((enlargement - np.cos(plane)) / np.sin(plane))
        growth = np.sin(plane) * (wanted - np.tan(spiral))
        more = radius * growth / ratio
        wheel_angle = np.arcsin(np.sin(wheel_angle) - more * np.sin(eta) / radius)
        pitch = np.arctan(np.sin(eta) / (np.tan(wheel_angle) * turn) + np.cos(eta) * lean)
        plane = np.arcsin(np.sin(wheel_angle) * turn / np.cos(pitch))
        spiral = np.arctan((enlargement + growth - np.cos(plane)) / np.sin(plane))
        other = np.sin(wheel_angle) / (np.tan(eta) * turn) + np.cos(wheel_angle) * lean
        pitches = (pitch, np.arctan(other))
        spirals = (spiral, spiral - plane)
        distances = ((pinion_radius + more) / np.sin(pitch), radius / np.sin(pitches[1]))
        tangent = limit_pressure_tangent(pitches, spirals, distances) / np.cos(plane)
        limit = np.arctan(tangent)
        slopes = [np.tan(angle) for angle in spirals]
        leaning = sum(
            slope / (distance * np.tan(angle))
            for slope, distance, angle in zip(slopes, distances, pitches, strict=True)
        )
        widths = [d * np.cos(angle) for d, angle in zip(distances, spirals, strict=True)]
        bent = 1.0 / widths[0] - 1.0 / widths[1] - tangent * leaning
        curvature = np.cos(limit) * bent / (slopes[0] - slopes[1])
    return PitchCones(pitches, spirals, distances, plane, limit, curvature)  # type: ignore[arg-type]


def _possible(cones: PitchCones) -> Mask:
    """Whether cones open towards each other and their teeth are inclined by less than 90 deg."""
    finite = np.isfinite(cones.limit_curvature)
    angles = (*cones.pitch_angle, *cones.spiral_angle)
    acute = [(angle > 0.0) & (angle < 0.5 * math.pi) for angle in angles]
    return np.asarray(np.all([finite, *acute, *(d > 0.0 for d in cones.cone_distance)], axis=0))


def _spiral_bevel(pitch_input: PitchInput) -> PitchCones:
    """Rolling cones with a common apex: Method 0, clause 6.2."""
    shaft = pitch_input.shaft_angle
    pinion = math.atan2(math.sin(shaft), pitch_input.ratio + math.cos(shaft))
    wheel = shaft - pinion
    distance = 0.5 * pitch_input.outer_pitch_diameter_wheel / math.sin(wheel)
    distance -= 0.5 * pitch_input.face_width_wheel
    spiral = pitch_input.mean_spiral_angle_pinion
    curvature = float(trace_curvature(pitch_input, wheel, spiral, distance))
    return PitchCones((pinion, wheel), (spiral,) * 2, (distance,) * 2, 0.0, 0.0, curvature)


def _require_outer_cones(pitch_input: PitchInput) -> None:
    """Refuse a shaft angle at which the wheel would be a crown gear or an internal one."""
    most = 0.5 * math.pi + math.asin(1.0 / pitch_input.ratio)
    if pitch_input.shaft_angle < most - math.radians(1.0):
        return
    raise InputError(
        f"shaft_angle = {math.degrees(pitch_input.shaft_angle):.6g} deg",
        Argument("shaft_angle"),
        f"From {math.degrees(most) - 1.0:.4g} deg on the wheel of this ratio is a crown gear or an "
        "internal one",
        "Reduce the shaft angle or the ratio",
    )


def _require_reach(pitch_input: PitchInput) -> None:
    reach = pitch_input.mean_radius_wheel / math.sin(pitch_input.first_pitch_angle)
    if abs(pitch_input.offset) < reach:
        return
    raise InputError(
        f"offset = {pitch_input.offset * 1e3:.6g} mm",
        Argument("offset"),
        f"The pinion passes the wheel: its axis is further off than {reach * 1e3:.6g} mm",
        "Reduce the offset or enlarge the wheel; usual are 5 to 20 % of its outer pitch diameter",
    )


def _no_cones(pitch_input: PitchInput, curvature: Array) -> InputError:
    spiral = math.degrees(pitch_input.mean_spiral_angle_pinion)
    design = f"offset {pitch_input.offset * 1e3:.6g} mm and a spiral angle of {spiral:.4g} deg"
    if not curvature.size:
        return InputError(
            f"no pitch cones touch with {design}",
            Argument("offset"),
            "Every position of the calculation point leaves a cone angle or a spiral angle outside "
            "0 to 90 deg",
            "Reduce the offset, or give a larger spiral angle of the pinion",
        )
    if pitch_input.blade_groups:
        return InputError(
            f"cutter_radius = {pitch_input.cutter_radius * 1e3:.6g} mm with "
            f"{pitch_input.blade_groups} blade groups",
            Argument("cutter_radius"),
            f"With {design} no pitch cones have the curvature of its teeth (ISO 23509, Method 1)",
            "Change the cutter radius, the blade groups, the offset or the spiral angle",
        )
    low, high = float(np.min(curvature)), float(np.max(curvature))
    limits = f"from {1e3 / high:.4g} mm" if high > 0.0 else "no positive radius"
    limits += f" to {1e3 / low:.4g} mm" if low > 0.0 else " up" if high > 0.0 else ""
    what = f"cutter_radius = {pitch_input.cutter_radius * 1e3:.6g} mm"
    why = f"With {design} the limit curvature of the teeth allows {limits} (ISO 23509, Method 1)"
    remedy = "Choose a cutter in this range, or change offset or spiral angle"
    return InputError(what, Argument("cutter_radius"), why, remedy)
