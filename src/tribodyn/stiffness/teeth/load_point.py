"""Where the normal force meets a tooth, and the places along a flank that are tabulated."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.errors import require_positive
from tribodyn.gear import SpurGear
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
    roll angle less the half angle of the tooth on the base circle.

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
    load_angle = rho / base - gear.base_half_angle
    off_axis = np.arctan2(rho, base) - load_angle
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
