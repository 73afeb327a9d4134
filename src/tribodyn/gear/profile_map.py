"""A measured deviation of a flank, over its profile and its width."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

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
    """Deviation of a flank as a measuring chart has it: an excess of material is positive.

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
    A flank that stands 2 um proud at the tip.

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
        """Number of places along the profile."""
        return len(self.position)

    def _curvature(self, place: float, base_radius: float) -> float:
        if self.coordinate == "roll_length":
            return place
        return math.sqrt(max(0.25 * place**2 - base_radius**2, 0.0))

    def at(
        self, curvature_radius: ArrayLike, face_position: ArrayLike, *, base_radius: float
    ) -> Array:
        """Excess of material; beyond the map the value at its edge.

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
    known = {"coordinate": COORDINATES, "interpolation": tuple(INTERPOLATIONS)}
    return [
        _problem(
            f'{name} = "{getattr(chart, name)}" of profile_map',
            f"Allowed: {', '.join(allowed)}",
            "Choose one of these",
        )
        for name, allowed in known.items()
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
            problems.append(_problem(what, "Every place comes once, in order", "Sort the places"))
    values = np.asarray(chart.deviation)
    bad = ~np.isfinite(values) | (np.abs(values) > LARGEST_AMOUNT)
    if np.any(bad):
        worst = float(values[bad][0])
        what = f"a deviation of profile_map is {worst * 1e6:.6g} um"
        why = f"It must be finite and within {LARGEST_AMOUNT * 1e6:g} um"
        problems.append(_problem(what, why, "Check the unit; measure what is missing"))
    return problems
