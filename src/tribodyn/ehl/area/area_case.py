"""Point and elliptical contacts as the user gives them, checked, and in the solver's scales.

Lines of the grid run along the axis on which the entrainment passes the contact faster; lengths
are in the half axis ``a`` of the dry contact along it, pressures in its greatest pressure, films
in ``a^2/R`` with the radius R along it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from tribodyn.contact.hertz import HertzEllipse, hertz_ellipse
from tribodyn.ehl.formulas.elliptic import nijenbanning_film
from tribodyn.ehl.solver.contact_case import (
    _HIGHEST_PRESSURE,
    LAWS,
    _check_growth,
    _check_lubricant,
    _scalar,
    contact_scales,
    positive_scalar,
    speed_and_modulus,
)
from tribodyn.errors import InputError, require_between, require_one_of
from tribodyn.lubricant import Lubricant
from tribodyn.types import Array

#: Numbers of Moes for which the solver was tested, with a margin.
_LOADS, _GREATEST_MATERIAL = (0.05, 2e4), 60.0
#: Ratio of the half axes that a grid of reasonable size resolves.
_SLENDEREST = 40.0


@dataclass(frozen=True, eq=False)
class PointCase:
    """A checked contact and its scales."""

    normal_force: float
    radius_x: float
    radius_y: float
    entrainment_speed: float
    entrainment_angle: float
    effective_modulus: float
    lubricant: Lubricant
    viscosity_law: str
    compressible: bool
    hertz: HertzEllipse
    moes_load: float
    moes_viscosity: float
    radius_ratio: float  #: radius along the entrainment over that across
    oil: Array = field(repr=False)
    density_ratio: float

    @property
    def swapped(self) -> bool:
        """Whether lines of the grid run along y."""
        a, b = self.hertz.first_semi_axis, self.hertz.second_semi_axis
        angle = self.entrainment_angle
        return bool(abs(math.sin(angle)) / b > abs(math.cos(angle)) / a)

    @property
    def axes(self) -> tuple[float, float]:
        """Half axes along the lines of the grid and across them [m]."""
        a, b = float(self.hertz.first_semi_axis), float(self.hertz.second_semi_axis)
        return (b, a) if self.swapped else (a, b)

    @property
    def radii(self) -> tuple[float, float]:
        """Radii along the lines of the grid and across them [m]."""
        radii = self.radius_x, self.radius_y
        return radii[::-1] if self.swapped else radii

    @property
    def direction(self) -> tuple[float, float]:
        """Size of the parts of the entrainment along the lines of the grid and across them."""
        parts = abs(math.cos(self.entrainment_angle)), abs(math.sin(self.entrainment_angle))
        parts = parts[::-1] if self.swapped else parts
        return tuple(0.0 if part < 1e-9 else part for part in parts)  # type: ignore[return-value]

    @property
    def film_unit(self) -> float:
        """Film ``a^2/R`` [m]."""
        return self.axes[0] ** 2 / self.radii[0]

    @property
    def lam(self) -> float:
        """``12 eta0 u R^2/(a^3 p_h)``."""
        viscous = 12.0 * self.lubricant.dynamic_viscosity * self.entrainment_speed
        a = self.axes[0]
        return viscous * self.radii[0] ** 2 / (a**3 * float(self.hertz.maximum_pressure))

    @property
    def elasticity(self) -> float:
        """Dimensionless film over the integral of ``P/r``."""
        pressure = float(self.hertz.maximum_pressure)
        return 2.0 * pressure * self.radii[0] / (math.pi * self.effective_modulus * self.axes[0])

    @property
    def film_estimate(self) -> float:
        """Central film of the regression, in the film unit."""
        numbers = self.moes_load, self.moes_viscosity, self.radius_ratio
        moes = nijenbanning_film(*(np.asarray(each, dtype=float) for each in numbers))
        viscous = 2.0 * self.lubricant.dynamic_viscosity * self.entrainment_speed
        radius = entrained_radius(self.radius_x, self.radius_y, self.entrainment_angle)
        film = float(moes) * radius * math.sqrt(viscous / (self.effective_modulus * radius))
        return film / self.film_unit


def entrained_radius(radius_x: float, radius_y: float, angle: float) -> float:
    """Radius of the gap in the direction of the entrainment."""
    return 1.0 / (math.cos(angle) ** 2 / radius_x + math.sin(angle) ** 2 / radius_y)


def point_case(
    normal_force: float,
    principal_radii: tuple[float, float],
    entrainment_speed: float,
    lubricant: Lubricant,
    effective_modulus: float,
    entrainment_angle: float,
    viscosity_law: str,
    compressible: bool,
) -> PointCase:
    """Check a contact in SI."""
    force = positive_scalar("normal_force", normal_force, "N", "1 kN is 1000 N")
    remedy = "8 mm are 8e-3 m; a contact without curvature is a line"
    radius_x, radius_y = (
        positive_scalar(name, radius, "m", remedy)
        for name, radius in zip(("radius_x", "radius_y"), principal_radii, strict=True)
    )
    radii = radius_x, radius_y
    speed, modulus = speed_and_modulus(entrainment_speed, effective_modulus)
    angle, turn = _scalar("entrainment_angle", entrainment_angle, "[rad]"), 2.0 * math.pi
    require_between("entrainment_angle", angle, -turn, turn, "rad", remedy="45 deg are 0.7854 rad")
    _check_lubricant(lubricant)
    law = require_one_of("viscosity_law", viscosity_law, LAWS)
    hertz = hertz_ellipse(force, *radii, modulus)
    pressure = float(hertz.maximum_pressure)
    require_between(
        "Hertz pressure", pressure, 0.0, _HIGHEST_PRESSURE, "Pa",
        remedy="It follows from normal_force, radii and effective_modulus: check their units",
    )  # fmt: skip
    a, b = float(hertz.first_semi_axis), float(hertz.second_semi_axis)
    _check_shape(a, b, radii)
    along = entrained_radius(*radii, angle)
    viscous = 2.0 * lubricant.dynamic_viscosity * speed / (modulus * along)
    load = force / (modulus * along**2) * viscous**-0.75
    alpha = 0.0 if law == "isoviscous" else lubricant.pressure_viscosity_coefficient
    material = alpha * modulus * viscous**0.25
    names = "normal_force, the radii and entrainment_speed"
    remedy = f"It follows from {names}: check their units"
    require_between("M", load, *_LOADS, remedy=remedy)
    require_between("L", material, 0.0, _GREATEST_MATERIAL, remedy=remedy)
    # The numbers of a line with the same growth alpha p_h: the oil knows the pressure alone.
    scales = contact_scales(
        2.0 * math.pi, alpha * pressure, pressure, lubricant.pressure_viscosity_coefficient,
        lubricant.roelands_index, law, compressible,
    )  # fmt: skip
    _check_growth(scales, pressure)
    across = entrained_radius(*radii, angle + 0.5 * math.pi)
    return PointCase(
        force, *radii, speed, angle, modulus, lubricant, scales.viscosity_law, bool(compressible),
        hertz, load, material, along / across, scales.oil, scales.density_ratio,
    )  # fmt: skip


def _check_shape(a: float, b: float, radii: tuple[float, float]) -> None:
    """Refuse contacts that are no half-spaces, or too slender for a grid."""
    if a > 0.5 * radii[0] or b > 0.5 * radii[1]:
        raise InputError(
            f"the dry contact is {2e3 * a:.4g} mm by {2e3 * b:.4g} mm wide on bodies with radii "
            f"of {1e3 * radii[0]:.4g} mm and {1e3 * radii[1]:.4g} mm",
            where="arguments normal_force, radius_x, radius_y",
            why="the contact must be narrow against the radii",
            remedy="Check the units: force in N, radii in m, modulus in Pa",
        )
    ratio = max(a / b, b / a)
    if ratio > _SLENDEREST:
        raise InputError(
            f"the dry contact is {ratio:.3g} times as long as wide",
            where="arguments radius_x, radius_y",
            why=f"the grid resolves ellipses up to {_SLENDEREST:g}",
            remedy="Use solve_line_contact with the load per length at mid length, or "
            "solve_finite_line_contact",
        )


@dataclass(frozen=True)
class Grid:
    """Uniform grid along the lines and across them, in half axes along the lines."""

    x: Array
    y: Array

    @property
    def steps(self) -> tuple[float, float]:
        """Widths of the intervals."""
        return float(self.x[1] - self.x[0]), float(self.y[1] - self.y[0])


def point_grid(case: PointCase, intervals: int) -> Grid:
    """Grid of a flooded contact; how far out it begins follows from the film."""
    ratio = case.axes[1] / case.axes[0]
    curvature = case.radii[0] / case.radii[1]
    ux, uy = case.direction
    film = case.film_estimate
    # Length over which the gap doubles, along the lines and across.
    sx = math.sqrt(2.0 * film)
    # Nearly rigid bodies: the film depends on all of the load, and much of it lies far out.
    far = 1.0 + min(film / 10.0, 1.0)
    sy = sx / math.sqrt(curvature)

    def before(half: float, s: float, u: float) -> float:
        """Distance of the inlet."""
        return half + max((0.6 + 0.6 * u) * half, (2.5 + 1.5 * u) * far * s)

    def behind(half: float, s: float, u: float) -> float:
        """Distance of the outlet."""
        return half + max((0.6 - 0.3 * u) * half, (2.5 - 1.7 * u) * far * s)

    hx = (before(1.0, sx, ux) + behind(1.0, sx, ux)) / intervals
    first = 2 * round(before(1.0, sx, ux) / (2.0 * hx))
    wide = before(ratio, sy, uy) + behind(ratio, sy, uy)
    rows = min(max(16 * math.ceil(wide / (hx * ratio**0.75) / 16.0), 32), 1024)
    hy = wide / rows
    middle = 2 * round(before(ratio, sy, uy) / (2.0 * hy))
    x: Array = hx * (np.arange(intervals + 1.0) - first)
    y: Array = hy * (np.arange(rows + 1.0) - middle)
    return Grid(x, y)
