"""All dimensions of both blanks from their pitch cones: ISO 23509, clause 7."""

from __future__ import annotations

import math
from typing import NamedTuple

from tribodyn.errors import Argument, InputError
from tribodyn.gear.hypoid.pitch_cones import PitchCones, PitchInput, pitch_cones


class _Depths(NamedTuple):
    """Depths in the calculation point and taper of the wheel; pairs are (pinion, wheel)."""

    module: float
    addendum: tuple[float, float]
    dedendum: tuple[float, float]
    working: float
    clearance: float
    taper: tuple[float, float]  #: addendum and dedendum angle of the wheel


def dimensions(pitch_input: PitchInput, values: dict[str, float]) -> dict[str, float]:
    """Dimensions of both blanks by the names of their fields."""
    cones = pitch_cones(pitch_input)
    return _Dimensions(pitch_input, cones, _depths(pitch_input, cones, values)).named(values)


def _depths(pitch_input: PitchInput, cones: PitchCones, values: dict[str, float]) -> _Depths:
    """Depths from factors of data type II, clauses 7.4 to 7.6."""
    distance, pitch = cones.cone_distance[1], cones.pitch_angle[1]
    diameter = 2.0 * distance * math.sin(pitch)
    module = diameter * math.cos(cones.spiral_angle[1]) / pitch_input.teeth_wheel
    working = values["depth_factor"] * module
    clearance = values["clearance_factor"] * working
    wheel = values["addendum_factor_wheel"] * working
    addendum = (working - wheel, wheel)
    dedendum = (addendum[1] + clearance, addendum[0] + clearance)
    standard = (math.atan(dedendum[0] / distance), math.atan(dedendum[1] / distance))
    if pitch_input.blade_groups:  # face hobbing cuts a uniform depth
        standard = (0.0, 0.0)
    taper = (
        values.get("addendum_angle_wheel", standard[0]),
        values.get("dedendum_angle_wheel", standard[1]),
    )
    return _Depths(module, addendum, dedendum, working, clearance, taper)


class _Dimensions:
    """Clause 7 of ISO 23509; pairs are (pinion, wheel)."""

    def __init__(self, pitch_input: PitchInput, cones: PitchCones, depths: _Depths) -> None:
        self.pitch_input, self.cones, self.depths = pitch_input, cones, depths
        pitch, distance = cones.pitch_angle, cones.cone_distance
        self.diameter = (
            2.0 * distance[0] * math.sin(pitch[0]),
            2.0 * distance[1] * math.sin(pitch[1]),
        )
        spread = self.diameter[0] * math.cos(pitch[1]) / math.cos(pitch[0])
        self.axial = math.asin(2.0 * pitch_input.offset / (self.diameter[1] + spread))
        # The normal of the calculation point meets both axes.
        opening = pitch_input.opening
        level = 0.5 * spread * math.tan(pitch[1])
        level -= 0.5 * (self.diameter[1] + spread) * math.cos(self.axial) * math.tan(opening)
        radial = 0.5 * self.diameter[1] * math.cos(self.axial)
        self.place = (radial * math.cos(opening) - level * math.sin(opening), level)
        self.pitch_apex = (
            distance[0] * math.cos(pitch[0]) - self.place[0],
            distance[1] * math.cos(pitch[1]) - self.place[1],
        )
        self.face, self.root = [0.0, pitch[1] + depths.taper[0]], [0.0, pitch[1] - depths.taper[1]]
        _require_cones(self.face[1], self.root[1])
        self.at_root = self._offset_angle(self.root[1], depths.taper[1])
        self.at_face = self._offset_angle(self.face[1], depths.taper[0])
        self.face[0] = self._mating(self.root[1], self.at_root)
        self.root[0] = self._mating(self.face[1], self.at_face)
        _require_cones(self.face[0], self.root[0])
        self.face_apex, self.root_apex = self._apices()
        self.outer, self.inner = self._ends()

    def _offset_angle(self, cone: float, angle: float) -> float:
        """Offset angle of the pinion in the root or the tip plane of the wheel."""
        distance = self.cones.cone_distance[1] * math.cos(angle)
        reach, offset = distance - self.pitch_apex[1] * math.cos(cone), self.pitch_input.offset
        if reach > 0.0:
            lean = math.atan(offset * math.tan(self.pitch_input.opening) * math.cos(cone) / reach)
            sine = offset * math.sin(cone) * math.cos(lean) / reach
            if abs(sine) < 1.0:
                return math.asin(sine) - lean
        what = f"offset = {self.pitch_input.offset * 1e3:.6g} mm"
        why = "The pinion passes the tip or root cone of the wheel"
        raise InputError(what, Argument("offset"), why, "Reduce the offset")

    def _mating(self, cone: float, angle: float) -> float:
        """Half angle of the pinion's cone that a cone of the wheel touches at an offset angle."""
        opening = self.pitch_input.opening
        across = math.cos(cone) * math.cos(angle) * math.cos(opening)
        return math.asin(across + math.sin(cone) * math.sin(opening))

    def _apices(self) -> tuple[tuple[float, float], tuple[float, float]]:
        depths, offset = self.depths, self.pitch_input.offset
        distance, apex = self.cones.cone_distance[1], self.pitch_apex[1]
        up, down = depths.taper
        face = distance * math.sin(up) - depths.addendum[1] * math.cos(up)
        root = distance * math.sin(down) - depths.dedendum[1] * math.cos(down)
        face_wheel = apex - face / math.sin(self.face[1])
        root_wheel = apex + root / math.sin(self.root[1])
        face_pinion, root_pinion = (
            (offset * math.sin(angle) * math.cos(cone) - mate * math.sin(cone) - depths.clearance)
            / math.sin(cone_angle)
            for angle, cone, mate, cone_angle in (
                (self.at_root, self.root[1], root_wheel, self.face[0]),
                (self.at_face, self.face[1], face_wheel, self.root[0]),
            )
        )
        return (face_pinion, face_wheel), (root_pinion, root_wheel)

    def _ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Outer and inner cone distances; the pinion's face covers that of the wheel."""
        pitch_input, depths, cones = self.pitch_input, self.depths, self.cones
        pitch, width, ratio = cones.pitch_angle, pitch_input.face_width_wheel, pitch_input.ratio
        outer = 0.5 * pitch_input.outer_pitch_diameter_wheel / math.sin(pitch[1])
        share = (outer - cones.cone_distance[1]) / width
        turn, slope = cones.offset_angle, math.cos(pitch[1])
        lean = math.atan2(
            math.sin(turn) * slope, ratio * math.cos(pitch[0]) + slope * math.cos(turn)
        )
        along = width * math.cos(lean) / math.cos(turn - lean)
        more = depths.working * math.sin(abs(self.at_root)) * (1.0 - 1.0 / ratio)
        angle = self.face[0] - pitch[0]
        step = along / math.cos(angle) * math.cos(self.face[0])
        sink = (depths.dedendum[1] - depths.clearance) * math.sin(pitch[0])
        tip = depths.addendum[0] * math.sin(pitch[0])
        beyond = (share * step + more - sink + tip) / math.cos(self.face[0]) * math.cos(angle)
        before = (1.0 - share) * step + more + sink - tip
        before /= math.cos(pitch[0]) - math.tan(angle) * math.sin(pitch[0])
        ends = (
            (cones.cone_distance[0] + beyond, outer),
            (cones.cone_distance[0] - before, outer - width),
        )
        if min(ends[1]) > 0.0:
            return ends
        what, where = f"face_width_wheel = {width * 1e3:.6g} mm", Argument("face_width_wheel")
        why = "The teeth reach the apex of the pitch cone of the pinion or of the wheel"
        raise InputError(what, where, why, "Reduce the face width")

    def _spirals(self, distance: tuple[float, float]) -> tuple[float, float]:
        """Spiral angles at an end, of a trace cut on the crown gear, clause 7.9."""
        cones, pitch_input = self.cones, self.pitch_input
        mean, turn, radius = cones.cone_distance[1], cones.offset_angle, pitch_input.cutter_radius
        spiral = cones.spiral_angle[1]
        share = pitch_input.blade_groups * math.sin(cones.pitch_angle[1]) / pitch_input.teeth_wheel
        sine = share * mean * math.cos(spiral) / radius
        lead = math.asin(sine) if abs(sine) < 1.0 else math.nan
        # Distances from the apex of the crown gear: to the cutter, and to the centre of motion.
        cutter = math.sqrt(mean**2 + radius**2 - 2.0 * mean * radius * math.sin(spiral - lead))
        motion = cutter / (1.0 + share)
        step = distance[0] - cones.cone_distance[0]
        # The place of the pinion's end on the crown gear of the wheel.
        on_wheel = math.sqrt(mean**2 + step**2 + 2.0 * mean * step * math.cos(turn))
        angles = []
        for place in (on_wheel, distance[1]):
            cosine = (place**2 + cutter**2 - radius**2) / (2.0 * place * cutter)
            if not abs(cosine) < 1.0:
                what = f"cutter_radius = {radius * 1e3:.6g} mm"
                why = "The circle of the cutter does not reach both ends of the teeth"
                remedy = "Choose a larger cutter or a smaller face width"
                raise InputError(what, Argument("cutter_radius"), why, remedy)
            across = motion * math.sqrt(1.0 - cosine**2)
            angles.append(math.atan2(place - motion * cosine, across))
        return angles[0] + math.asin(mean * math.sin(turn) / on_wheel), angles[1]

    def _thickness(self, values: dict[str, float], pressure: float) -> tuple[float, float]:
        """Mean normal circular thicknesses, clause 7.10."""
        module, distance = self.depths.module, self.cones.cone_distance[1]
        shift = 0.5 * (self.depths.addendum[0] - self.depths.addendum[1]) * math.tan(pressure)
        play = values["outer_backlash"] * distance * math.cos(self.cones.spiral_angle[1])
        play /= 4.0 * self.outer[1]
        extra = 0.5 * values["thickness_factor"] * module
        half = 0.5 * math.pi * module - 2.0 * play
        thickness = half + 2.0 * (extra + shift), half - 2.0 * (extra + shift)
        if min(thickness) > 0.0:
            return thickness
        what = f"thickness_factor = {values['thickness_factor']:.6g}"
        why = f"It leaves a tooth of {min(thickness) * 1e3:.4g} mm in the calculation point"
        raise InputError(what, Argument("thickness_factor"), why, "Share the thickness more evenly")

    def named(self, values: dict[str, float]) -> dict[str, float]:
        """All dimensions by their names."""
        pitch_input, depths, cones = self.pitch_input, self.depths, self.cones
        change = values["limit_pressure_angle_factor"] * cones.limit_pressure_angle
        drive = values["pressure_angle_drive"] + change
        coast = values["pressure_angle_coast"] - change
        pitch, distance = cones.pitch_angle, cones.cone_distance
        step = [self.outer[0] - distance[0], self.outer[1] - distance[1]]
        tip = [
            depths.addendum[0] + step[0] * math.tan(self.face[0] - pitch[0]),
            depths.addendum[1] + step[1] * math.tan(depths.taper[0]),
        ]
        pairs = {
            "teeth": (pitch_input.teeth_pinion, pitch_input.teeth_wheel),
            "face_width": (self.outer[0] - self.inner[0], pitch_input.face_width_wheel),
            "pitch_angle": pitch,
            "face_angle": self.face,
            "root_angle": self.root,
            "mean_spiral_angle": cones.spiral_angle,
            "outer_spiral_angle": self._spirals(self.outer),
            "inner_spiral_angle": self._spirals(self.inner),
            "mean_cone_distance": distance,
            "outer_cone_distance": self.outer,
            "inner_cone_distance": self.inner,
            "mean_pitch_diameter": self.diameter,
            "outer_tip_diameter": [
                2.0 * (self.outer[i] * math.sin(pitch[i]) + tip[i] * math.cos(pitch[i]))
                for i in (0, 1)
            ],
            "mean_addendum": depths.addendum,
            "mean_dedendum": depths.dedendum,
            "mean_normal_thickness": self._thickness(values, 0.5 * (drive + coast)),
            "calculation_point": self.place,
            "crown": [
                self.place[i] + step[i] * math.cos(pitch[i]) - tip[i] * math.sin(pitch[i])
                for i in (0, 1)
            ],
            "pitch_apex": self.pitch_apex,
            "face_apex": self.face_apex,
            "root_apex": self.root_apex,
        }
        named = {
            f"{name}_{gear}": value
            for name, members in pairs.items()
            for gear, value in zip(("pinion", "wheel"), members, strict=True)
        }
        return named | {
            "offset": pitch_input.offset,
            "shaft_angle": pitch_input.shaft_angle,
            "cutter_radius": pitch_input.cutter_radius,
            "offset_angle_axial": self.axial,
            "offset_angle_pitch": cones.offset_angle,
            "limit_pressure_angle": cones.limit_pressure_angle,
            "limit_curvature": cones.limit_curvature,
            "normal_pressure_angle_drive": drive,
            "normal_pressure_angle_coast": coast,
            "mean_normal_module": depths.module,
            "clearance": depths.clearance,
        }


def _require_cones(face: float, root: float) -> None:
    if root > 0.0 and face < 0.5 * math.pi:
        return
    raise InputError(
        f"tip and root cones have {math.degrees(face):.4g} and {math.degrees(root):.4g} deg",
        Argument("addendum_angle_wheel" if root > 0.0 else "dedendum_angle_wheel"),
        "A cone opens by more than 0 and less than 90 deg",
        "Give smaller addendum and dedendum angles, or a smaller depth",
    )
