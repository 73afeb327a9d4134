"""Where planets can be assembled, and how close neighbours are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import (
    Argument,
    InputError,
    real_numbers,
    require_between,
    require_one_of,
    require_positive,
)
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array

PlanetType = Literal["single", "stepped", "meshed"]

#: Part of a pitch by which the teeth may miss at the angle of a planet: angles are rounded.
_MISFIT = 0.02


@dataclass(frozen=True)
class PlanetTeeth:
    """Numbers of teeth of a stage."""

    sun: int
    ring: int  #: positive
    planets: tuple[int, ...]  #: gears of a planet, that at the sun first; empty where unknown
    type: PlanetType

    @property
    def basic_ratio(self) -> float:
        """Speed of the sun over that of the ring, both relative to the carrier."""
        ratio = self.ring / self.sun
        if self.type == "stepped":
            return -ratio * self.planets[0] / self.planets[1]
        return ratio if self.type == "meshed" else -ratio

    @property
    def positions(self) -> int:
        """Number of equally spaced angles at which one more planet can be assembled."""
        if self.type == "stepped":
            first, second = self.planets
            return (self.sun * second + self.ring * first) // math.gcd(first, second)
        return self.ring - self.sun if self.type == "meshed" else self.ring + self.sun

    @property
    def positions_formula(self) -> str:
        """How ``positions`` follows from the numbers of teeth."""
        if self.type == "stepped":
            first, second = self.planets
            return f"({self.sun}*{second} + {self.ring}*{first})/gcd({first}, {second})"
        return f"{self.ring} {'-' if self.type == 'meshed' else '+'} {self.sun}"


def read_teeth(
    sun_teeth: int,
    ring_teeth: int,
    planet_teeth: int | tuple[int, int] | None = None,
    planet_type: PlanetType = "single",
) -> PlanetTeeth:
    """Check the numbers of teeth of a stage."""
    sun = require_whole("sun_teeth", sun_teeth, 3)
    ring = require_whole("ring_teeth", abs(ring_teeth), 4)
    require_one_of("planet_type", planet_type, ("single", "stepped", "meshed"))
    if ring <= sun:
        why = "The ring surrounds the sun and the planets"
        what = f"ring_teeth = {ring}, and the sun has {sun} teeth"
        raise InputError(what, Argument("ring_teeth"), why, "Give a ring with more teeth")
    listed = () if planet_teeth is None else np.atleast_1d(planet_teeth).tolist()
    planets = tuple(require_whole("planet_teeth", teeth, 3) for teeth in listed)
    wanted = 1 if planet_type == "single" else 2
    if len(planets) != wanted and (planets or wanted == 2):
        what = f"planet_teeth = {planet_teeth} for {planet_type} planets"
        why = f"A {planet_type} planet has {wanted} gear{'s' * (wanted - 1)}"
        remedy = "Give the numbers of teeth, that of the gear at the sun first"
        raise InputError(what, Argument("planet_teeth"), why, remedy)
    if planet_type == "single" and planets and planets[0] >= ring:
        what = f"planet_teeth = {planets[0]}, and the ring has {ring} teeth"
        why = "The planets are inside the ring"
        raise InputError(what, Argument("planet_teeth"), why, "Give planets with fewer teeth")
    return PlanetTeeth(sun, ring, planets, planet_type)


def read_angles(planets: int, angles: ArrayLike | None) -> Array:
    """Angles of the planets, equally spaced by default [rad]."""
    count = require_whole("planets", planets)
    if angles is None:
        return 2.0 * np.pi * np.arange(count) / count
    values = real_numbers(Argument("angles"), angles, "angles in rad")
    if values.shape != (count,):
        what = f"angles has the shape {values.shape} for {count} planets"
        remedy = "Give an angle in rad for each planet"
        raise InputError(what, Argument("angles"), "Every planet has one angle", remedy)
    remedy = "Give radians: 120 deg is 2.0944"
    require_between("angles", values, -4.0 * np.pi, 4.0 * np.pi, "rad", remedy=remedy)
    return np.array(values, dtype=float)


def refuse_misfit(teeth: PlanetTeeth, planets: int, angles: ArrayLike | None) -> Array:
    """Angles of the planets; raise where the teeth of a planet do not enter both gaps."""
    at = read_angles(planets, angles)
    count, step = teeth.positions, 360.0 / teeth.positions
    if angles is None:
        if count % planets:
            fitting = [n for n in range(2, 13) if count % n == 0]
            possible = f"{', '.join(map(str, fitting))} planets" if fitting else "unequal spacing"
            fitting_angles = np.unique(np.round(np.degrees(at) / step)) * step
            raise InputError(
                f"({teeth.positions_formula})/{planets} = {count / planets:.6g} is not whole: "
                f"{planets} planets at equal spacing do not fit",
                Argument("planets"),
                f"Planets can be assembled at multiples of {step:.6g} deg",
                f"At equal spacing it takes {possible}; {planets} planets fit at the angles "
                f"{', '.join(f'{angle:.6g}' for angle in fitting_angles)} deg",
            )
        return at
    pitches = (at - at[0]) * count / (2.0 * np.pi)
    misfit = np.abs(pitches - np.round(pitches))
    if misfit.max() > _MISFIT:
        i = int(misfit.argmax())
        nearest = np.degrees(at[0]) + round(float(pitches[i])) * step
        raise InputError(
            f"planet {i + 1} at {np.degrees(at[i]):.6g} deg does not fit: its teeth miss by "
            f"{misfit[i]:.3g} of a pitch",
            Argument("angles"),
            f"Planets can be assembled at multiples of 360 deg/({teeth.positions_formula}) = "
            f"{step:.6g} deg from the first",
            f"The nearest angle is {nearest:.8g} deg, {math.radians(nearest):.8g} rad",
        )
    return at


@dataclass(frozen=True, eq=False)
class PlanetaryPositions:
    """Positions of the planets of a stage.

    Parameters
    ----------
    angles : (N,) array
        Angles of the planets about the sun [rad].
    step : float
        Planets can be assembled at its multiples from the first one [rad].
    clearance : float
        Least distance between the tip circles of neighbours [m], or in modules without
        ``center_distance``; None for one planet, for stepped planets without ``tip_diameter``,
        and for meshed ones.
    """

    angles: Array
    step: float
    clearance: float | None


def planetary_positions(
    *,
    sun_teeth: int,
    ring_teeth: int,
    planets: int,
    angles: ArrayLike | None = None,
    planet_teeth: int | tuple[int, int] | None = None,
    planet_type: PlanetType = "single",
    center_distance: float | None = None,
    tip_diameter: float | None = None,
) -> PlanetaryPositions:
    """Check that the planets of a stage can be assembled and do not touch each other.

    Parameters
    ----------
    sun_teeth, ring_teeth : int
        Numbers of teeth; that of the ring with or without its minus sign.
    planets : int
        Number of planets, or of pairs of planets that mesh with each other.
    angles : (N,) array, optional
        Angles of the planets about the sun [rad]; equally spaced by default.
    planet_teeth : int or (int, int), optional
        Teeth of a planet; of double planets the gear at the sun first. Half the difference
        of ring and sun by default.
    planet_type : {"single", "stepped", "meshed"}
        Planets with one gear, with two gears on one shaft, or pairs that mesh with each other.
    center_distance, tip_diameter : float, optional
        Distance from sun to planet axis, and largest tip diameter of a planet [m]; by default
        those of gears without profile shift, in modules.

    Raises
    ------
    InputError
        If planets do not fit between sun and ring at their angles, or their tip circles overlap.

    Notes
    -----
    One more planet can be assembled at the multiples of ``2 pi/(z_s + z_r)``; of
    ``2 pi/(z_r - z_s)`` for meshed planets and of ``2 pi gcd(z_1, z_2)/(z_s z_2 + z_r z_1)`` for
    equal stepped ones.

    Examples
    --------
    >>> positions = planetary_positions(sun_teeth=17, ring_teeth=61, planets=3)
    >>> round(positions.clearance, 4)
    9.775
    """
    teeth = read_teeth(sun_teeth, ring_teeth, planet_teeth, planet_type)
    at = refuse_misfit(teeth, require_whole("planets", planets), angles)
    for name, value in (("center_distance", center_distance), ("tip_diameter", tip_diameter)):
        if value is not None:
            require_positive(name, value, "m")
    if (center_distance is None) != (tip_diameter is None):
        missing = "tip_diameter" if tip_diameter is None else "center_distance"
        why = "The clearance between neighbours follows from both"
        raise InputError(f"{missing} is missing", Argument(missing), why, "Give both, or none")
    size: tuple[float, float, str, float] | None = None
    if center_distance is not None and tip_diameter is not None and planet_type != "meshed":
        size = center_distance, tip_diameter, "mm", 1e3
    elif planet_type == "single":
        mate = teeth.planets[0] if teeth.planets else (teeth.ring - teeth.sun) / 2
        size = (teeth.sun + mate) / 2, mate + 2.0, "modules", 1.0
    clearance = None
    if size and at.size > 1:
        clearance = _clearance(at, *size, "planets" if angles is None else "angles")
    return PlanetaryPositions(at, 2.0 * np.pi / teeth.positions, clearance)


def _clearance(
    angles: Array, distance: float, tip: float, unit: str, factor: float, where: str
) -> float:
    """Least distance between the tip circles of neighbours; raise where they overlap."""
    ordered = np.sort(angles % (2.0 * np.pi))
    gap = float(np.diff(ordered, append=ordered[0] + 2.0 * np.pi).min())
    axis_distance = 2.0 * distance * math.sin(min(gap, np.pi) / 2.0)
    if axis_distance <= tip:
        raise InputError(
            f"neighbouring planets {np.degrees(gap):.6g} deg apart overlap by "
            f"{(tip - axis_distance) * factor:.4g} {unit}: their axes are "
            f"{axis_distance * factor:.5g} {unit} apart, their tip diameter is "
            f"{tip * factor:.5g} {unit}",
            Argument(where),
            "Tip circles of neighbours must not overlap",
            "Take fewer or smaller planets, or a greater angle between them",
        )
    return axis_distance - tip


def refuse_touching_pairs(axes: Array, tips: list[float], sun: float) -> None:
    """Refuse planets of pairs (2, N) that touch the sun or planets of other pairs."""
    names = [f"{side} {i + 1}" for side in ("planet", "ring planet") for i in range(axes.shape[1])]
    points, radii = np.append(axes, 0.0), np.append(np.repeat(tips, axes.shape[1]), sun) * 0.5
    names.append("sun")
    count, last = axes.shape[1], points.size - 1
    gaps = [
        (float(abs(points[i] - points[j]) - radii[i] - radii[j]), names[j], names[i])
        for i in range(points.size)
        for j in range(count if i == last else 0, i)
        if i == last or j + count != i  # mates of a pair, and the sun with the planets at it, mesh
    ]
    gap, first, second = min(gaps)
    if gap <= 0.0:
        raise InputError(
            f"{first} and {second} overlap by {-gap * 1e3:.4g} mm",
            Argument("planets"),
            "Tip circles of gears that do not mesh must not overlap",
            "Take fewer or smaller planets, or other centre distances",
        )
