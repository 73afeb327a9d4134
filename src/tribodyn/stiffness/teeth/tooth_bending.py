"""Bending, shear and axial compression of a tooth by the energy method on its true outline."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.splines import monotone_cubic
from tribodyn.errors import Argument, InputError, require_positive
from tribodyn.gear import Material, SpurGear, ToothForm, half_tooth
from tribodyn.types import Array


class LoadPoint(NamedTuple):
    """A load on a flank in the frame of the tooth, whose axis points outwards.

    Parameters
    ----------
    height : array [m]
        Height of the point along the tooth axis, from the gear centre.
    half_thickness : array [m]
        Distance of the point from the tooth axis.
    load_angle : array [rad]
        Angle between the load and the normal of the tooth axis.
    axis_height : array [m]
        Height at which the line of the load crosses the tooth axis.
    depth : array [m]
        Distance from the point to the tooth axis along the load.
    """

    height: Array
    half_thickness: Array
    load_angle: Array
    axis_height: Array
    depth: Array


def load_point(gear: SpurGear, curvature_radius: Array | float) -> LoadPoint:
    """Find the load on the tooth when the contact has a given radius of curvature.

    The load is tangent to the base circle, so its angle to the normal of the tooth axis is the
    roll angle, of a ring negative, less the half angle of the tooth on the base circle.

    Parameters
    ----------
    gear : SpurGear
        The loaded gear.
    curvature_radius : float or array [m]
        Radius of curvature of the flank at the contact: the distance from the base tangent
        point along the line of action.

    Returns
    -------
    LoadPoint
        Arrays of the shape of ``curvature_radius``.

    Raises
    ------
    InputError
        If the radius of curvature is not positive.

    Notes
    -----
    Valid on the involute. Source: involute geometry, ISO 21771.

    Examples
    --------
    The point is as far from the axis crossing as the depth says.

    >>> from tribodyn.gear import SpurGear
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02)
    >>> point = load_point(gear, 0.02)
    >>> fall = point.axis_height - point.height
    >>> bool(abs(np.hypot(point.half_thickness, fall) - point.depth) < 1e-15)
    True
    """
    require_positive("curvature_radius", curvature_radius, "m")
    rho = np.asarray(curvature_radius, dtype=float)
    base = gear.base_radius
    radius = np.hypot(base, rho)
    load_angle = gear.sign * rho / base - gear.base_half_angle
    off_axis = gear.sign * np.arctan2(rho, base) - load_angle
    half_thickness = radius * np.sin(off_axis)
    return LoadPoint(
        height=radius * np.cos(off_axis),
        half_thickness=half_thickness,
        load_angle=load_angle,
        axis_height=base / np.cos(load_angle),
        depth=half_thickness / np.cos(load_angle),
    )


#: A flank from the base circle itself begins at this part of its largest radius of curvature.
_LEAST_PART = 1e-3


def flank_nodes(gear: SpurGear, count: int = 30) -> Array:
    """Radii of curvature from the end of the fillet to the tip, closer together at both ends."""
    low, high = (
        gear.base_radius * gear.roll_angle(radius) for radius in (gear.form_radius, gear.tip_radius)
    )
    low = max(low, _LEAST_PART * high)
    share = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, count)))
    nodes = low + (high - low) * share
    nodes[-1] = high
    return nodes


#: Points of the outline of a tooth.
_OUTLINE_POINTS = 400
#: Shear correction of a rectangular section.
_SHEAR_FACTOR = 1.2
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


class ToothSection(NamedTuple):
    """Half of the section of a tooth over its axis, from the foot to the tip."""

    height: Array  #: along the tooth axis from the gear centre [m]
    half_thickness: Array  #: [m]

    @property
    def foot(self) -> tuple[float, float]:
        """Height and half thickness of the foot, where the fillet meets the root circle [m]."""
        return float(self.height[0]), float(self.half_thickness[0])

    @property
    def root_radius(self) -> float:
        """Radius of the root circle [m]."""
        return math.hypot(*self.foot)

    @property
    def root_half_angle(self) -> float:
        """Half of the angle that the foot takes on the root circle [rad]."""
        return math.atan2(self.half_thickness[0], self.height[0])


def tooth_section(gear: ToothForm) -> ToothSection:
    """Section of a tooth on as many points as its compliance needs (2e-6 of itself beyond)."""
    return ToothSection(*half_tooth(gear, _OUTLINE_POINTS))


class ToothBendingCompliance(NamedTuple):
    """Compliance of the tooth along the load, by kind of stress.

    Parameters
    ----------
    bending, shear, axial : array [m/N]
        Contributions, which add up.
    """

    bending: Array
    shear: Array
    axial: Array

    @property
    def total(self) -> Array:
        """Sum of the three [m/N]."""
        return self.bending + self.shear + self.axial


def tooth_bending_compliance(
    outline: tuple[Array, Array],
    height: Array | float,
    half_thickness: Array | float,
    load_angle: Array | float,
    face_width: float,
    material: Material,
) -> ToothBendingCompliance:
    """Compliance of a tooth as a beam of varying section, from its foot to the load point.

    With the load components ``cos a`` across and ``sin a`` along the tooth axis, the bending
    moment at height y is ``cos a (y_F - y) - sin a x_F``; the strain energies of bending, shear
    (factor 1.2) and axial compression give the compliance along the load.

    Parameters
    ----------
    outline : two arrays (m,) [m]
        Height along the tooth axis, increasing from the foot to the tip, and half thickness.
    height : float or array [m]
        Height ``y_F`` of the load point, within the outline.
    half_thickness : float or array [m]
        Distance ``x_F`` of the load point from the tooth axis.
    load_angle : float or array [rad]
        Angle ``a`` between the load and the normal of the tooth axis.
    face_width : float [m]
        Face width.
    material : Material
        Material of the gear.

    Returns
    -------
    ToothBendingCompliance
        Arrays [m/N] of the shape of the load point.

    Raises
    ------
    InputError
        If the outline does not rise, or the load point is not on it.

    Notes
    -----
    Plane stress. The outline between its points is a monotone cubic, the integration is exact to
    eighth order per interval. Source: the potential energy method, Yang and Lin (1987), J. Mech.
    Transm. Autom. Des. 109, 189-196, with shear and axial terms; here on the rack-generated
    outline down to the root circle.

    Examples
    --------
    A square bar of 1 mm by 1 mm, 10 mm long, loaded across: ``F L^3 / (3 E I)``.

    >>> from tribodyn.gear import Material, ToothForm, half_tooth
    >>> bar = (np.array([0.0, 0.01]), np.array([0.5e-3, 0.5e-3]))
    >>> found = tooth_bending_compliance(bar, 0.01, 0.0, 0.0, 1e-3, Material(200e9))
    >>> print(f"{float(found.bending) * 1e3:.4f} mm/N")
    0.0200 mm/N
    """
    knots, thickness = _checked(outline, height, face_width)
    y_load = np.asarray(height, dtype=float)
    section = monotone_cubic(knots, thickness)
    moments = _section_integrals(section, knots, y_load)
    across, along = np.cos(load_angle), np.sin(load_angle)
    # Moment as polynomial in the height above the foot: cos a (reach - s).
    reach = y_load - knots[0] - np.asarray(half_thickness) * np.tan(load_angle)
    flexure = reach**2 * moments[0] - 2.0 * reach * moments[1] + moments[2]
    modulus = material.youngs_modulus * face_width
    return ToothBendingCompliance(
        bending=across**2 * 1.5 / modulus * flexure,
        shear=_SHEAR_FACTOR * across**2 * moments[3] / (material.shear_modulus * face_width),
        axial=along**2 * moments[3] / modulus,
    )


def _section_integrals(section: Callable[[Array], Array], knots: Array, y_load: Array) -> Array:
    """Integrals of ``s^k / x^3`` (k = 0, 1, 2) and ``1 / (2 x)`` from the foot to each load."""

    def integrate(start: Array, stop: Array) -> Array:
        half = 0.5 * (stop - start)
        y = 0.5 * (stop + start) + half * _NODES.reshape(-1, *([1] * half.ndim))
        x = section(y)
        s = y - knots[0]
        integrands = np.stack([x**-3, s * x**-3, s**2 * x**-3, 0.5 / x])
        result: Array = half * np.tensordot(_WEIGHTS, integrands, axes=(0, 1))
        return result

    per_interval = integrate(knots[:-1], knots[1:])
    below = np.concatenate([np.zeros((4, 1)), np.cumsum(per_interval, axis=1)], axis=1)
    interval = np.clip(np.searchsorted(knots, y_load) - 1, 0, knots.size - 2)
    return np.asarray(below[:, interval] + integrate(knots[interval], y_load))


def _checked(
    outline: tuple[Array, Array], height: Array | float, face_width: float
) -> tuple[Array, Array]:
    require_positive("face_width", face_width, "m")
    knots, thickness = (np.asarray(coordinate, dtype=float) for coordinate in outline)
    require_positive("half thickness of the outline", thickness[:-1], "m")
    if np.any(np.diff(knots) <= 0.0):
        what = "the height of the tooth outline does not increase"
        why = "The beam runs from the foot to the tip"
        remedy = "Give the outline from the foot upwards without repeated points"
        raise InputError(what, Argument("outline"), why, remedy)
    tolerance = 1e-9 * (knots[-1] - knots[0])
    if np.min(height) < knots[0] - tolerance or np.max(height) > knots[-1] + tolerance:
        what = f"load at heights {np.min(height) * 1e3:.6g} to {np.max(height) * 1e3:.6g} mm"
        why = f"The tooth reaches from {knots[0] * 1e3:.6g} to {knots[-1] * 1e3:.6g} mm"
        raise InputError(what, Argument("height"), why, "Load the tooth on its flank")
    return knots, thickness


def beam_to_axis(
    outline: tuple[Array, Array], load: LoadPoint, material: Material
) -> ToothBendingCompliance:
    """Compliance of a tooth below the local compression, per unit face width [m^2/N].

    The local compression reaches from the flank along the load to the tooth axis. What bends,
    shears and compresses the tooth as a beam begins there. Plane stress. A load low on the flank
    of a gear of many teeth crosses the axis below the foot; it then spares a piece of the body as
    wide as the foot, whose shear and axial compression are negative contributions. Source: Weber
    and Banaschek (1953), integrals up to the tooth axis.

    >>> from tribodyn.gear import SpurGear
    >>> from tribodyn.stiffness import load_point
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02)
    >>> parts = beam_to_axis(tooth_section(gear), load_point(gear, 0.02), Material())
    >>> bool(parts.shear > parts.axial > 0.0)
    True
    """
    section = ToothSection(*outline)
    foot_height, foot_half_width = section.foot
    within = np.maximum(load.axis_height, foot_height)
    parts = tooth_bending_compliance(section, within, 0.0, load.load_angle, 1.0, material)
    # Zero, or the negative length of the beam over the width of the foot.
    spared = np.minimum(load.axis_height - foot_height, 0.0) / (2.0 * foot_half_width)
    return ToothBendingCompliance(
        bending=parts.bending,
        shear=parts.shear
        + _SHEAR_FACTOR * np.cos(load.load_angle) ** 2 / material.shear_modulus * spared,
        axial=parts.axial + np.sin(load.load_angle) ** 2 / material.youngs_modulus * spared,
    )
