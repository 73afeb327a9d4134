"""The part of a flank that the mate touches, and how much of it a relief takes by default."""

from __future__ import annotations

import math
from typing import NamedTuple

from tribodyn.gear.mesh_geometry import MeshGeometry

#: Contact ratio by which a whole number may be missed.
_ROUNDING = 1e-9


class FlankRange(NamedTuple):
    """Used part of a flank, in radii of curvature of the involute.

    Parameters
    ----------
    lowest : float [m]
        Where the mate's tip touches.
    highest : float [m]
        The tip.
    """

    lowest: float
    highest: float

    @property
    def length(self) -> float:
        """Roll length of the used flank, the length of the path of contact [m]."""
        return self.highest - self.lowest


def flank_ranges(mesh: MeshGeometry) -> tuple[FlankRange, FlankRange]:
    """Used flanks of both gears.

    Parameters
    ----------
    mesh : MeshGeometry or SpurPair
        The gears in mesh.

    Returns
    -------
    tuple of FlankRange
        Pinion and wheel.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> pinion, wheel = flank_ranges(pair)
    >>> math.isclose(pinion.length, wheel.length)
    True
    """
    (first, last), length = mesh.path_limits, mesh.line_of_action_length
    return FlankRange(first, last), FlankRange(length - last, length - first)


def default_relief_length(mesh: MeshGeometry) -> float:
    """Length of a relief that nobody stated: to where the number of tooth pairs changes.

    Parameters
    ----------
    mesh : MeshGeometry or SpurPair
        The gears in mesh.

    Returns
    -------
    float
        Roll length [m]: (contact ratio - 1) base pitches up to a contact ratio of 2, and what
        exceeds the next lower whole number above it.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> round(default_relief_length(pair) / pair.base_pitch, 3)
    0.605
    """
    ratio = mesh.transverse_contact_ratio
    return (ratio - math.ceil(ratio - _ROUNDING) + 1.0) * mesh.base_pitch
