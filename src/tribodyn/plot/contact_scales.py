"""Pressure and film of a line contact as they are drawn: units, dry pressure, window, thinning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import InputError, Problem
from tribodyn.plot.labels import axis_label, display_unit, displayed, significant
from tribodyn.types import Array

#: Films are drawn up to this many times the thickest central film: beyond lies the open gap.
_FILMS = 3.0
#: Pressure, relative to the greatest, from which on a contact is drawn.
_NOTHING = 0.02


@dataclass(frozen=True)
class Scales:
    """How the curves of one contact become numbers on the axes."""

    position: float
    pressure: float
    film: float
    position_label: str
    pressure_label: str
    film_label: str
    pressure_unit: str
    film_unit: str

    def film_text(self, film: float, digits: int = 3) -> str:
        """Write a film with its unit."""
        return f"{significant(self.film * film, digits)} {self.film_unit}"

    def pressure_text(self, pressure: float, digits: int = 3) -> str:
        """Write a pressure with its unit."""
        return f"{significant(self.pressure * pressure, digits)} {self.pressure_unit}"


def _unitless(solution: Any) -> Scales:
    return Scales(
        1.0 / solution.half_width,
        1.0 / solution.hertz_pressure,
        1.0 / solution.film_unit,
        "Position [b]",
        "Pressure [p<sub>h</sub>]",
        "Film [b²/R]",
        "p<sub>h</sub>",
        "b²/R",
    )


def _metric() -> Scales:
    position, pressure, film = "half_width", "hertz_pressure", "film_thickness"
    return Scales(
        float(displayed(position, 1.0)),
        float(displayed(pressure, 1.0)),
        float(displayed(film, 1.0)),
        axis_label(position, "Position"),
        axis_label(pressure, "Pressure"),
        axis_label(film, "Film"),
        display_unit(pressure),
        display_unit(film),
    )


def contact_scales(solutions: Sequence[Any], dimensionless: bool) -> list[Scales]:
    """Choose the units for contacts that share their axes."""
    if not solutions:
        raise InputError(
            Problem(
                what="there is no contact to draw",
                where="argument solutions",
                why="The sequence is empty",
                remedy="Give at least one solution of solve_line_contact",
            )
        )
    bare = [solution.lubricant is None for solution in solutions]
    if any(bare) and not all(bare) and not dimensionless:
        raise InputError(
            Problem(
                what=f"{sum(bare)} of {len(bare)} contacts have no unit, the others have",
                where="argument solutions",
                why="solve_line_contact_moes gives numbers without unit, which fit no common axis",
                remedy="Set dimensionless=True",
            )
        )
    if dimensionless or all(bare):
        return [_unitless(solution) for solution in solutions]
    return [_metric()] * len(solutions)


def dry_pressure(solution: Any, points: int = 101) -> tuple[Array, Array]:
    """Pressure of Hertz in the dry contact.

    Parameters
    ----------
    solution : LineContactSolution
        A solved contact.
    points : int
        Number of points.

    Returns
    -------
    tuple of array
        Position and pressure in the units of the solution, closer together at the ends.

    Source: Hertz (1881), ``p = p_h sqrt(1 - (x/b)^2)``.
    """
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, points)
    pressure = np.maximum(np.cos(angle), 0.0)
    return solution.half_width * np.sin(angle), solution.hertz_pressure * pressure


def place_of_minimum(solution: Any) -> float:
    """Position of the least film between inlet and outlet."""
    filled = solution.position <= solution.outlet
    return float(solution.position[filled][np.argmin(solution.film[filled])])


def window(solution: Any) -> tuple[float, float]:
    """Part of the axis in which something happens."""
    position, pressure, half = solution.position, solution.pressure, solution.half_width
    loaded = position[pressure > _NOTHING * pressure.max()]
    left = max(float(loaded[0]) - 0.1 * half, float(position[0]))
    right = min(float(solution.outlet) + 0.4 * half, float(position[-1]))
    return min(left, -1.5 * half), max(right, 1.4 * half)


def film_height(solutions: Sequence[Any], scales: Sequence[Scales]) -> float:
    """Upper end of an axis for the films of some contacts, in its display unit."""
    thickest = (s.film * one.central_film for one, s in zip(solutions, scales, strict=True))
    return float(_FILMS * max(thickest))


def thinned(solution: Any, points: int) -> NDArray[np.intp]:
    """Choose nodes that keep the shape of both curves, among them every extremum."""
    n = len(solution.position)
    if n <= points:
        return np.arange(n)
    curves = np.stack((
        solution.pressure / solution.pressure.max(),
        # the open gap beside the film is not in the picture
        np.minimum(solution.film / solution.central_film, _FILMS) / _FILMS,
    ))  # fmt: skip
    bend = np.zeros(n)
    bend[1:-1] = np.max(np.abs(np.diff(curves, 2)), axis=0)
    density = np.sqrt(bend)
    density += 0.15 * np.mean(density) + 1e-300
    reached = np.concatenate(([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))))
    slopes = np.sign(np.diff(curves))
    turns = 1 + np.flatnonzero(np.any(slopes[:, 1:] != slopes[:, :-1], axis=0))
    turns = turns[np.argsort(bend[turns])[::-1][: points // 4]]
    even = np.linspace(0.0, reached[-1], points - len(turns) - 2)
    chosen = np.searchsorted(reached, even * (1.0 - 1e-15)).clip(0, n - 1)
    return np.unique(np.concatenate((chosen, turns, [0, n - 1])))
