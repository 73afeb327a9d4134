"""Contact outside of the path of contact: how far the corner of a tip is from the mating flank.

Before a pair enters contact, and after it has left, the corner of a tip is close to the flank of
the mate, off the line of action. Loaded teeth bend, and the corner then touches before the path
of contact begins and after it ends.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between
from tribodyn.gear import MeshGeometry, ToothForm
from tribodyn.types import Array, Mask

#: Flank missing above the form circle, over the module, that a pair is allowed to lack.
_ROUNDING = 1e-6


class ExtendedContact(NamedTuple):
    """Where the teeth of a pair would touch, on the path of contact and beyond its ends.

    Parameters
    ----------
    separation : array [m]
        Approach along the line of action that brings the teeth into touch; zero on the path of
        contact, infinite where they cannot touch.
    pinion_curvature_radius : array [m]
        Radius of curvature of the pinion's flank where it is touched.
    wheel_curvature_radius : array [m]
        Radius of curvature of the wheel's flank where it is touched.
    possible : array of bool
        Whether involute is touched; false where a corner would meet a fillet or nothing.
    """

    separation: Array
    pinion_curvature_radius: Array
    wheel_curvature_radius: Array
    possible: Mask


class _Corner(NamedTuple):
    """A corner against a flank: gap, radius of curvature where it touches, and if it can."""

    separation: Array
    mate_curvature_radius: Array
    possible: Mask


def _curvature(gear: ToothForm, radius: float) -> float:
    """Radius of curvature of the flank, negative for a ring."""
    return gear.sign * gear.roll_angle(radius) * gear.base_radius


def _corner(gear: ToothForm, mate: ToothForm, length: float, reach: Array) -> _Corner:
    """Corner of a gear's tip against its mate, with the gear's base tangent point as origin."""
    tip = _curvature(gear, gear.tip_radius)
    # Radii of a ring are negative, so that the formulas are those of an external pair.
    base, mate_base = gear.sign * gear.base_radius, mate.sign * mate.base_radius
    turned = (reach - tip) / base
    cosine, sine = np.cos(turned), np.sin(turned)
    along = tip * cosine + base * sine - length
    across = base + mate_base - (base * cosine - tip * sine)
    radius = np.hypot(along, across)
    touched = mate.sign * np.sqrt(np.maximum(radius**2 - mate_base**2, 0.0))
    # Difference of the polar angles about the mate's axis: its involute less the corner.
    sign = mate.sign
    flank = (reach - length + touched) / mate_base - np.arctan2(sign * touched, sign * mate_base)
    separation = mate_base * (flank - np.arctan2(sign * along, sign * across))
    low = _curvature(mate, mate.form_radius) - _ROUNDING * mate.normal_module
    high = _curvature(mate, mate.tip_radius)
    possible = (touched >= low) & (touched <= high) & (turned < np.pi / 2.0)
    return _Corner(separation, touched, possible)


def extended_contact(pair: MeshGeometry, path: ArrayLike) -> ExtendedContact:
    """Separation of the teeth of a pair anywhere on the line of action.

    Parameters
    ----------
    pair : MeshGeometry
        Both gears in mesh, without modifications.
    path : float or array [m]
        Where the involutes would touch if they did not end: the distance from the pinion's base
        tangent point. It follows the rotation of the gears beyond both ends of the path of
        contact.

    Returns
    -------
    ExtendedContact
        Arrays of the shape of ``path``.

    Raises
    ------
    InputError
        If a position is not finite.

    Notes
    -----
    Beyond the far end the pinion's tip touches the wheel, before the near end the wheel's tip the
    pinion, whichever drives. The corner turns about its own axis by ``(path - tip) / r_b``; its
    distance from the mate's axis gives the point of the mate's involute that it meets, and the
    difference of their polar angles times the mate's base radius is the separation. It begins at
    the ends of the path of contact as ``rho L x^2 / (2 r_b^2 rho_mate)`` with the distance x from
    the end, the length L of the line of action, and rho and r_b of the gear whose corner it is.
    Source: rotation geometry of the involute, ISO 21771; the effect is that of Lin, Wang, Oswald
    and Coy (1994), there by iteration.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3,
    ...                  normal_pressure_angle=math.radians(20.0), center_distance=91.5e-3,
    ...                  pinion_profile_shift_coefficient=0.8635,
    ...                  wheel_profile_shift_coefficient=-0.5103, pinion_face_width=20e-3)
    >>> low, high = pair.path_limits
    >>> off = 0.05 * pair.base_pitch
    >>> [round(float(gap) * 1e6, 1) for gap in extended_contact(pair, [low - off, low, high + off])
    ...     .separation]
    [6.8, 0.0, 28.6]
    """
    require_between("path", path, -np.inf, np.inf, "m")
    place = np.asarray(path, dtype=float)
    length, (low, high) = pair.line_of_action_length, pair.path_limits
    exit_ = _corner(pair.pinion, pair.wheel, length, np.maximum(place, high))
    entry = _corner(pair.wheel, pair.pinion, length, np.maximum(length - place, length - low))
    before, after = place < low, place > high
    possible = np.where(after, exit_.possible, np.where(before, entry.possible, True))
    gap = np.where(after, exit_.separation, np.where(before, entry.separation, 0.0))
    pinion = np.where(after, high, np.where(before, entry.mate_curvature_radius, place))
    wheel = np.where(
        before, length - low, np.where(after, exit_.mate_curvature_radius, length - place)
    )
    separation = np.where(possible, np.maximum(gap, 0.0), np.inf)
    return ExtendedContact(separation, pinion, wheel, possible)
