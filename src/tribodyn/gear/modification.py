"""Modifications and deviations of the flanks of a gear from the involute."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.types import Array

#: What the profile of a map may be measured over.
COORDINATES = ("roll_length", "diameter")
#: How a map may be read between its points, and the degree of the splines.
INTERPOLATIONS = {"linear": 1, "cubic": 3}
#: Amount of a modification or deviation beyond which a unit is wrong [m].
LARGEST_AMOUNT = 0.5e-3


@dataclass(frozen=True)
class ProfileMap:
    """Measured deviation of a flank as on a chart: excess material is positive.

    Parameters
    ----------
    position : tuple of float [m]
        Places along the profile, increasing, at least two: roll length, which is the radius of
        curvature of the involute, or diameter.
    face_position : tuple of float [m]
        Places along the face from its middle, increasing; one alone holds over the whole width.
    deviation : tuple of tuple of float [m]
        Excess of material along the normal, one row for each ``position``.
    coordinate : str
        ``"roll_length"`` or ``"diameter"``.
    interpolation : str
        ``"linear"`` or ``"cubic"`` in both directions.

    Raises
    ------
    InputError
        If the shape is wrong, places do not increase, or a value is not finite or above 0.5 mm.

    Notes
    -----
    The sign is that of ISO 1328-1 and ISO/TR 10064-1: on the chart a flank with too much material
    lies on the positive side.

    Examples
    --------
    A flank with 2 um of excess material at the tip.

    >>> chart = ProfileMap((10e-3, 20e-3), (0.0,), ((0.0,), (2e-6,)))
    >>> round(float(chart.at(15e-3, 0.0, base_radius=40e-3)) * 1e6, 9)
    1.0
    """

    position: tuple[float, ...]
    face_position: tuple[float, ...]
    deviation: tuple[tuple[float, ...], ...] = field(repr=False)
    coordinate: str = "roll_length"
    interpolation: str = "linear"

    def __post_init__(self) -> None:
        problems = _name_problems(self)
        try:
            object.__setattr__(self, "position", _floats(self.position))
            object.__setattr__(self, "face_position", _floats(self.face_position))
            object.__setattr__(self, "deviation", tuple(_floats(row) for row in self.deviation))
        except (TypeError, ValueError) as error:
            why = "It is made of lists of numbers"
            raise InputError(_problem(f"profile_map: {error}", why)) from None
        problems += _shape_problems(self) or _value_problems(self)
        if problems:
            raise InputError(problems)

    def limits(self, base_radius: float) -> tuple[float, float]:
        """Ends of the map along the profile.

        Parameters
        ----------
        base_radius : float [m]
            Radius of the base circle of the gear.

        Returns
        -------
        tuple of float [m]
            Radii of curvature at the first and last place.
        """
        low, high = (
            self._curvature(place, base_radius) for place in self.position[:: len(self) - 1]
        )
        return low, high

    def __len__(self) -> int:
        """Number of points along the profile."""
        return len(self.position)

    def _curvature(self, place: float, base_radius: float) -> float:
        if self.coordinate == "roll_length":
            return place
        return math.sqrt(max(0.25 * place**2 - base_radius**2, 0.0))

    def at(
        self, curvature_radius: ArrayLike, face_position: ArrayLike, *, base_radius: float
    ) -> Array:
        """Excess material; beyond the map the value at its edge.

        Parameters
        ----------
        curvature_radius : float or array [m]
            Radius of curvature of the flank.
        face_position : float or array [m]
            Place along the face from its middle, broadcast against the other.
        base_radius : float [m]
            Radius of the base circle of the gear.

        Returns
        -------
        array [m]
            The broadcast shape.
        """
        from scipy.interpolate import RectBivariateSpline

        radius, face = np.broadcast_arrays(
            np.asarray(curvature_radius, dtype=float), np.asarray(face_position, dtype=float)
        )
        place = radius if self.coordinate == "roll_length" else 2.0 * np.hypot(radius, base_radius)
        across, table = np.asarray(self.face_position), np.asarray(self.deviation)
        if across.size == 1:
            across, table = across + np.array([-1.0, 1.0]), np.repeat(table, 2, axis=1)
            face = np.full(face.shape, self.face_position[0])
        degree = INTERPOLATIONS[self.interpolation]
        spline = RectBivariateSpline(
            self.position,
            across,
            table,
            kx=min(degree, len(self) - 1),
            ky=min(degree, across.size - 1),
        )
        place = np.clip(place, self.position[0], self.position[-1])
        face = np.clip(face, across[0], across[-1])
        return np.asarray(spline(place, face, grid=False))


def _floats(values: Sequence[float]) -> tuple[float, ...]:
    return tuple(float(value) for value in values)


def _problem(what: str, why: str, remedy: str = "Correct the map") -> Problem:
    return Problem(what, Argument("profile_map"), why, remedy)


def _name_problems(chart: ProfileMap) -> list[Problem]:
    allowed_names = {"coordinate": COORDINATES, "interpolation": tuple(INTERPOLATIONS)}
    return [
        _problem(
            f'{name} = "{getattr(chart, name)}" of profile_map',
            f"Allowed: {', '.join(allowed)}",
            "Choose one of these",
        )
        for name, allowed in allowed_names.items()
        if getattr(chart, name) not in allowed
    ]


def _shape_problems(chart: ProfileMap) -> list[Problem]:
    rows, columns = len(chart.position), len(chart.face_position)
    widths = sorted({len(row) for row in chart.deviation})
    if rows >= 2 and columns >= 1 and len(chart.deviation) == rows and widths == [columns]:
        return []
    shape = f"{len(chart.deviation)} rows of {' or '.join(map(str, widths)) or 'no'} values"
    what = (
        f"profile_map has {shape} for {rows} places along the profile and {columns} along the face"
    )
    why = "It needs two or more places along the profile, and one value for each pair of places"
    return [_problem(what, why, "Complete the map, or take the odd points out")]


def _value_problems(chart: ProfileMap) -> list[Problem]:
    problems = []
    for name in ("position", "face_position"):
        places = np.asarray(getattr(chart, name))
        if not np.all(np.isfinite(places)) or np.any(np.diff(places) <= 0.0):
            what = f"{name} of profile_map is not finite and increasing"
            problems.append(
                _problem(what, "Positions must be distinct and in order", "Sort the places")
            )
    values = np.asarray(chart.deviation)
    bad = ~np.isfinite(values) | (np.abs(values) > LARGEST_AMOUNT)
    if np.any(bad):
        worst = float(values[bad][0])
        what = f"a deviation of profile_map is {worst * 1e6:.6g} um"
        why = f"It must be finite and within {LARGEST_AMOUNT * 1e6:g} um"
        problems.append(_problem(what, why, "Check the unit; measure what is missing"))
    return problems


#: How a relief may fall to zero.
SHAPES = ("linear", "parabolic")
#: Run-out beyond which a unit is wrong [m].
LARGEST_RUN_OUT = 1e-3

#: Sum of the single pitch deviations round a gear that is rounding of their figures [m].
_CLOSURE = 1e-6
_PITCHES = ("single_pitch_deviation", "cumulative_pitch_deviation")
#: Limits of the amounts: material that is taken away, and what may be missing or in excess [m].
_LIMITS = {
    **dict.fromkeys(
        ("tip_relief", "root_relief", "end_relief", "wear_depth"), (0.0, LARGEST_AMOUNT)
    ),
    **dict.fromkeys(
        ("profile_crowning", "profile_slope", "crowning", "lead_slope", "flank_twist", *_PITCHES),
        (-LARGEST_AMOUNT, LARGEST_AMOUNT),
    ),
    "run_out": (0.0, LARGEST_RUN_OUT),
}


@dataclass(frozen=True, kw_only=True)
class FlankModification:
    """Modifications and deviations of the loaded flanks of a gear; nothing by default.

    Amounts are measured along the transverse line of action, to which the flank of a spur gear is
    normal; what takes material away is positive. Lengths are measured along the line of action
    (roll length), or along the face.

    Parameters
    ----------
    tip_relief : float [m]
        Material taken away at the tip.
    tip_relief_length : float [m], optional
        Distance from the tip inwards over which the relief falls to zero; by default as far as
        more than the least number of tooth pairs is in contact.
    tip_relief_shape : str
        ``"linear"`` or ``"parabolic"``.
    root_relief : float [m]
        Material taken away at the lowest point that the mate touches.
    root_relief_length : float [m], optional
        Distance from that point outwards; the default is that of the tip.
    root_relief_shape : str
        ``"linear"`` or ``"parabolic"``.
    profile_crowning : float [m]
        Material taken away at both ends of the used flank against its middle, as a parabola.
    profile_slope : float [m]
        Material taken away at the tip, growing in proportion from the lowest point.
    crowning : float [m]
        Material taken away at both ends of the face against its middle, as a parabola.
    lead_slope : float [m]
        Material taken away at the end of the face where ``face_position`` is positive, more than
        at the other end; the middle stays.
    end_relief : float [m]
        Material taken away at both ends of the face.
    end_relief_length : float [m], optional
        Distance from each end of the face over which it falls to zero; by default a tenth of the
        face width.
    end_relief_shape : str
        ``"linear"`` or ``"parabolic"``.
    flank_twist : float [m]
        Slope over the face at the tip less that at the lowest used point.
    single_pitch_deviation : tuple of float [m]
        Deviation of the pitch from the flank before to each flank, one for each tooth in the order
        in which they come into contact; too long is positive. They sum to zero.
    cumulative_pitch_deviation : tuple of float [m]
        Instead of the former: distance by which each flank is ahead in that order.
    run_out : float [m]
        Run-out F_r of the toothing: twice its eccentricity.
    run_out_phase : float [rad]
        Rotation, from where tooth 0 comes into contact, at which the flanks stand out most.
    wear_depth : float or tuple of float [m]
        Depth of wear: one value for the whole flank, or values at equal distances of roll length
        from the lowest point to the tip.
    profile_map : ProfileMap, optional
        Measured deviation of the flank.

    Raises
    ------
    InputError
        Listing every value that is out of range, in its shape or in its meaning.

    Notes
    -----
    Names and signs after ISO 21771 (modifications), ISO 1328-1 (deviations of pitch) and
    ISO 1328-2 (run-out). A chart that gives pitches along the reference circle is brought to the
    line of action by the cosine of the pressure angle.

    Examples
    --------
    >>> FlankModification(tip_relief=10e-6, crowning=5e-6)
    FlankModification(tip_relief 10 um, crowning 5 um)
    """

    tip_relief: float = 0.0
    tip_relief_length: float | None = None
    tip_relief_shape: str = "linear"
    root_relief: float = 0.0
    root_relief_length: float | None = None
    root_relief_shape: str = "linear"
    profile_crowning: float = 0.0
    profile_slope: float = 0.0
    crowning: float = 0.0
    lead_slope: float = 0.0
    end_relief: float = 0.0
    end_relief_length: float | None = None
    end_relief_shape: str = "linear"
    flank_twist: float = 0.0
    single_pitch_deviation: tuple[float, ...] = ()
    cumulative_pitch_deviation: tuple[float, ...] = ()
    run_out: float = 0.0
    run_out_phase: float = 0.0
    wear_depth: float | tuple[float, ...] = 0.0
    profile_map: ProfileMap | None = None

    def __post_init__(self) -> None:
        for name in (*_PITCHES, "wear_depth"):
            value = getattr(self, name)
            if not isinstance(value, (str, float, int)):
                object.__setattr__(self, name, _floats(value))
        if self.wear_depth == ():
            object.__setattr__(self, "wear_depth", 0.0)
        problems = [
            problem
            for name, limits in _LIMITS.items()
            for problem in amount_problems(name, getattr(self, name), *limits)
        ]
        if not math.isfinite(self.run_out_phase):
            what, why = f"run_out_phase = {self.run_out_phase}", "An angle is finite"
            problems.append(Problem(what, Argument("run_out_phase"), why, "Give it in radians"))
        for name in ("tip_relief", "root_relief", "end_relief"):
            problems += self._relief_problems(name)
        problems = problems or self._pitch_problems()
        if problems:
            raise InputError(problems)

    @cached_property
    def changes_profile(self) -> bool:
        """Whether the gap depends on the position along the profile."""
        shaped = (self.tip_relief, self.root_relief, self.profile_crowning, self.profile_slope)
        return (
            any((*shaped, self.flank_twist))
            or _any(self.wear_depth)
            or self.profile_map is not None
        )

    @cached_property
    def changes_lead(self) -> bool:
        """Whether the gap depends on the position along the face width."""
        chart = self.profile_map
        mapped = chart is not None and len(chart.face_position) > 1
        shaped = (self.crowning, self.lead_slope, self.end_relief, self.flank_twist)
        return any(shaped) or mapped

    @cached_property
    def changes_pitch(self) -> bool:
        """Whether the teeth deviate from even spacing."""
        return any(self.single_pitch_deviation) or any(self.cumulative_pitch_deviation)

    @cached_property
    def teeth_differ(self) -> bool:
        """Whether the gap differs from tooth to tooth."""
        return self.changes_pitch or self.run_out != 0.0

    @cached_property
    def changes_anything(self) -> bool:
        """Whether the flanks differ from ideally placed involutes."""
        return self.changes_profile or self.changes_lead or self.teeth_differ

    def tooth_problems(self, teeth: int) -> list[Problem]:
        """Problems of lists whose length does not match the number of teeth.

        Parameters
        ----------
        teeth : int
            Number of teeth.

        Returns
        -------
        list of Problem
        """
        return [
            Problem(
                what=f"{name} has {len(getattr(self, name))} entries",
                where=Argument(f"modification.{name}"),
                why=f"The gear has {teeth} teeth, and each tooth has its own",
                remedy=f"Give {teeth} values",
            )
            for name in _PITCHES
            if getattr(self, name) and len(getattr(self, name)) != teeth
        ]

    def _relief_problems(self, name: str) -> list[Problem]:
        problems = []
        length, shape = getattr(self, f"{name}_length"), getattr(self, f"{name}_shape")
        if length is not None and not (math.isfinite(length) and length > 0.0):
            what, where = f"{name}_length = {length * 1e3:.6g} mm", Argument(f"{name}_length")
            why = "A length is finite and greater than zero"
            problems.append(Problem(what, where, why, f"Set {name} to zero for no relief"))
        if shape not in SHAPES:
            what, where = f'{name}_shape = "{shape}"', Argument(f"{name}_shape")
            why = f"Allowed: {', '.join(SHAPES)}"
            problems.append(Problem(what, where, why, "Choose one of these"))
        return problems

    def _pitch_problems(self) -> list[Problem]:
        single, where = self.single_pitch_deviation, Argument("single_pitch_deviation")
        if single and self.cumulative_pitch_deviation:
            what = "single_pitch_deviation and cumulative_pitch_deviation are both given"
            why, remedy = "Both define the same quantity", "Keep one of them"
        elif abs(sum(single)) > _CLOSURE:
            what = f"the single pitch deviations sum to {sum(single) * 1e6:.6g} um"
            why = "Round the gear all pitches together make one turn, so that they sum to zero"
            remedy = "Subtract their mean, or give cumulative_pitch_deviation"
        else:
            return []
        return [Problem(what, where, why, remedy)]

    def __repr__(self) -> str:
        """Modifications other than the defaults, with units."""
        values = [(field, getattr(self, field.name)) for field in fields(self)]
        texts = (
            _field_text(field.name, value) for field, value in values if value != field.default
        )
        return f"FlankModification({', '.join(texts)})"


def amount_problems(name: str, value: object, low: float, high: float) -> list[Problem]:
    """Problem of the first value that is not a number within the limits."""
    for item in value if isinstance(value, tuple) else (value,):
        number = isinstance(item, (int, float))
        if number and math.isfinite(item) and low <= item <= high:
            continue
        quantity = f"{item * 1e6:.6g} um" if number else repr(item)
        why = f"{name} must be finite and from {low * 1e6:g} to {high * 1e6:g} um"
        return [Problem(f"{name} = {quantity}", Argument(name), why, "Check value and unit")]
    return []


def _any(value: float | tuple[float, ...]) -> bool:
    return any(value) if isinstance(value, tuple) else value != 0.0


def _field_text(name: str, value: Any) -> str:
    if isinstance(value, tuple):
        return f"{name} {min(value) * 1e6:.4g} to {max(value) * 1e6:.4g} um"
    if isinstance(value, ProfileMap):
        return f"{name} of {len(value)} x {len(value.face_position)} points"
    if isinstance(value, str):
        return f"{name} {value}"
    if name == "run_out_phase":
        return f"{name} {value:.4g} rad"
    return (
        f"{name} {value * 1e3:.4g} mm"
        if name.endswith("_length")
        else f"{name} {value * 1e6:.4g} um"
    )
