"""The material of a gear, and mass and moment of inertia from its true section."""

from __future__ import annotations

import math
from collections.abc import Iterable
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


#: Gauss-Legendre points of the fillet and of the flank.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)
#: Points along a cone; exact for the fourth power of a linear radius.
_CONE_NODES, _CONE_WEIGHTS = np.polynomial.legendre.leggauss(3)

#: Begin and end of a round hole from the mid face, and its radii there [m].
Hole = tuple[float, float, float, float]


@dataclass(frozen=True)
class MassProperties:
    """Mass and moments of inertia of a gear.

    Parameters
    ----------
    mass : float
        Mass [kg].
    moment_of_inertia : float
        Polar moment of inertia about the gear axis [kg*m^2].
    transverse_moment_of_inertia : float
        Moment of inertia about an axis in the mid plane [kg*m^2].
    """

    mass: float
    moment_of_inertia: float
    transverse_moment_of_inertia: float = 0.0

    def with_values(
        self,
        mass: float | None = None,
        moment_of_inertia: float | None = None,
        transverse_moment_of_inertia: float | None = None,
    ) -> MassProperties:
        """Replace prescribed values; a mass scales the moments of inertia that are not prescribed.

        Parameters
        ----------
        mass : float, optional
            Mass [kg].
        moment_of_inertia, transverse_moment_of_inertia : float, optional
            Moments of inertia [kg*m^2].

        Returns
        -------
        MassProperties
        """
        scale = 1.0 if mass is None else mass / self.mass
        polar, transverse = moment_of_inertia, transverse_moment_of_inertia
        return MassProperties(
            self.mass if mass is None else mass,
            scale * self.moment_of_inertia if polar is None else polar,
            scale * self.transverse_moment_of_inertia if transverse is None else transverse,
        )


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


def body_properties(
    section: tuple[float, float], face_width: float, density: float, holes: Iterable[Hole] = ()
) -> MassProperties:
    """Mass and moments of inertia of a section over the face width, less coaxial round holes."""
    area, polar = section
    moments = np.array([area, polar, 0.5 * polar + area * face_width**2 / 12.0]) * face_width
    for start, end, first, last in holes:
        x = 0.5 * (start + end) + 0.5 * (end - start) * _CONE_NODES
        weight = 0.5 * (end - start) * _CONE_WEIGHTS * math.pi
        r = first + (last - first) * (x - start) / (end - start)
        moments -= np.stack([r**2, 0.5 * r**4, 0.25 * r**4 + x**2 * r**2]) @ weight
    return MassProperties(*(density * moments).tolist())


def ring_section(hole: tuple[float, float], radius: float) -> tuple[float, float]:
    """Area and polar moment of area of a disc of a radius with a toothed or round hole."""
    return math.pi * radius**2 - hole[0], 0.5 * math.pi * radius**4 - hole[1]


def mass_properties(
    gear: SpurGear, density: float, holes: Iterable[Hole] | None = None
) -> MassProperties:
    """Mass and moments of inertia: those given with the gear, else those of the solid.

    Parameters
    ----------
    gear : SpurGear
        Gear; its ``mass`` and ``moment_of_inertia``, where given, are returned as they are.
    density : float
        Density [kg/m^3].
    holes : iterable of (float, float, float, float), optional
        Begin and end of each coaxial hole from the mid face, and its radii there [m]; by default
        the bore.

    Raises
    ------
    InputError
        If the density is not positive.

    Notes
    -----
    The solid is the toothed section less the bore, of a ring the disc of its rim less the hole,
    over the face width: a helix changes neither. A mass that is given alone scales the moments of
    inertia of the solid. Source: polar area integral, see :func:`section_moments`.

    Examples
    --------
    >>> gear = SpurGear(teeth=40, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                 profile_shift_coefficient=0.0, tip_diameter=84e-3, face_width=10e-3)
    >>> round(mass_properties(gear, 7800.0).mass, 3)
    0.39
    """
    require_positive("density", density, "kg/m^3")
    section = section_moments(gear)
    if gear.is_ring:
        section, holes = ring_section(section, gear.rim_radius), ()
    elif holes is None:
        half, bore = 0.5 * gear.face_width, gear.rim_radius
        holes = [(-half, half, bore, bore)]
    solid = body_properties(section, gear.face_width, density, holes)
    return solid.with_values(gear.mass, gear.moment_of_inertia)
