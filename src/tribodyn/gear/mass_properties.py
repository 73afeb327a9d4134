"""The material of a gear, and mass and moment of inertia from its true section."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.errors import require_between, require_positive
from tribodyn.gear.cylindrical_gear import SpurGear
from tribodyn.gear.tooth_form import ToothForm


@dataclass(frozen=True)
class Material:
    """Isotropic linear elastic material; the defaults are case-hardening steel.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus [Pa].
    poissons_ratio : float
        Poisson's ratio, 0 to 0.499.
    density : float
        Density [kg/m^3].

    Raises
    ------
    InputError
        If a value is not finite, not positive or outside its limits.

    Examples
    --------
    >>> round(Material().shear_modulus / 1e9, 3)
    79.231
    """

    youngs_modulus: float = 206e9
    poissons_ratio: float = 0.3
    density: float = 7800.0

    def __post_init__(self) -> None:
        require_positive("youngs_modulus", self.youngs_modulus, "Pa")
        require_between("poissons_ratio", self.poissons_ratio, 0.0, 0.499)
        require_positive("density", self.density, "kg/m^3")

    @cached_property
    def shear_modulus(self) -> float:
        """Shear modulus E / (2 (1 + nu)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)


@dataclass(frozen=True)
class MassProperties:
    """Mass and polar moment of inertia of a gear.

    Parameters
    ----------
    mass : float
        Mass [kg].
    moment_of_inertia : float
        Polar moment of inertia about the gear axis [kg*m^2].
    """

    mass: float
    moment_of_inertia: float


def section_moments(form: ToothForm) -> tuple[float, float]:
    """Area and polar moment of area of the toothed section: no bore; of a ring the space inside.

    Parameters
    ----------
    form : ToothForm or SpurGear
        Gear whose section is wanted.

    Returns
    -------
    tuple of float
        Area [m^2] and polar moment of area about the axis [m^4].

    Notes
    -----
    The root disc, plus over the tooth height the integral of the half tooth angle over the
    squared radius; for a ring, whose hole is the section, less that integral. Gauss-Legendre
    quadrature on fillet and involute apart, where the integrands are smooth, so that the error is
    that of rounding. Source: polar area integral.

    Examples
    --------
    >>> form = ToothForm(teeth=40, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                  profile_shift_coefficient=0.0, tip_diameter=84e-3)
    >>> area, _ = section_moments(form)
    >>> round(area / (math.pi * form.reference_radius**2), 3)
    0.993
    """
    curve, start = form.trochoid, form.form_normal_angle
    middle, half = 0.5 * (math.pi / 2.0 + start), 0.5 * (math.pi / 2.0 - start)
    angle = middle + half * _NODES
    # The fillet leaves the root circle with a falling normal angle, hence the sign.
    fillet_weight = -half * _WEIGHTS * curve.squared_radius_slope(angle)
    fillet_radius, fillet_half = curve.radius(angle), curve.half_tooth_angle(angle)

    low, high = form.roll_angle(form.form_radius), form.roll_angle(form.tip_radius)
    roll = 0.5 * (high + low) + 0.5 * (high - low) * _NODES
    flank_weight = (high - low) * _WEIGHTS * roll * form.base_radius**2
    flank_radius = form.base_radius * np.hypot(1.0, roll)
    flank_half = form.base_half_angle - form.sign * (roll - np.arctan(roll))

    tooth_area = fillet_weight @ fillet_half + flank_weight @ flank_half
    tooth_polar = fillet_weight @ (fillet_half * fillet_radius**2) + flank_weight @ (
        flank_half * flank_radius**2
    )
    area = math.pi * form.root_radius**2 + abs(form.teeth) * float(tooth_area)
    polar = 0.5 * math.pi * form.root_radius**4 + abs(form.teeth) * float(tooth_polar)
    return area, polar


def mass_properties(gear: SpurGear, density: float) -> MassProperties:
    """Mass and moment of inertia: those given with the gear, else those of the solid.

    Parameters
    ----------
    gear : SpurGear
        Gear; its ``mass`` and ``moment_of_inertia``, where given, are returned as they are.
    density : float
        Density [kg/m^3].

    Raises
    ------
    InputError
        If the density is not positive.

    Notes
    -----
    The solid is the toothed section less the bore, of a ring the disc of its rim less the hole,
    over the face width: a helix changes neither. Source: polar area
    integral, see :func:`section_moments`.

    Examples
    --------
    >>> gear = SpurGear(teeth=40, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                 profile_shift_coefficient=0.0, tip_diameter=84e-3, face_width=10e-3)
    >>> round(mass_properties(gear, 7800.0).mass, 3)
    0.39
    """
    require_positive("density", density, "kg/m^3")
    area, polar = section_moments(gear)
    rim = gear.rim_radius
    line_density = gear.sign * density * gear.face_width
    mass = line_density * (area - math.pi * rim**2)
    inertia = line_density * (polar - 0.5 * math.pi * rim**4)
    return MassProperties(
        mass=mass if gear.mass is None else gear.mass,
        moment_of_inertia=inertia if gear.moment_of_inertia is None else gear.moment_of_inertia,
    )
