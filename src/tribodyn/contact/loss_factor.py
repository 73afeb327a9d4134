"""Load shares by counting lines of contact, and the gear loss factor that follows."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from tribodyn.contact.path import PathOfContact, path_of_contact, pitch_point_age
from tribodyn.errors import Argument, ComputationError
from tribodyn.gear import CylindricalPair
from tribodyn.types import Array

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


def _travel_breaks(contact: PathOfContact) -> Array:
    """Travel from A, in base pitches, at which load share or sliding may change abruptly."""
    ratio, integers = contact.contact_ratio, np.arange(contact.pairs + 1)
    breaks = np.concatenate([integers, ratio - integers, [pitch_point_age(contact), ratio]])
    if overlap := contact.pair.overlap_ratio:
        breaks = np.concatenate(
            [breaks, integers - overlap % 1.0, ratio + overlap % 1.0 - integers]
        )
    return np.unique(np.clip(breaks, 0.0, ratio))


def equal_share(contact: PathOfContact, path: Array) -> Array:
    """Load share of a tooth pair where all lines of contact carry the same per length.

    Parameters
    ----------
    contact : PathOfContact
        Path of contact.
    path : array
        Positions of one pair on the path of contact [m], any shape.

    Returns
    -------
    array
        One over the number of pairs in contact at that moment, same shape. For a helical pair its
        slices pass this place one after another, and this is the sum of what they carry there.

    Notes
    -----
    Source: counting the positions that lie whole base pitches away on the path of contact; for
    helical pairs the integral of face width over total length of the lines.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> contact = path_of_contact(pair)
    >>> equal_share(contact, np.array([contact.A, 0.5 * (contact.B + contact.D)]))
    array([0.5, 1. ])
    """
    travel = contact.direction * (np.asarray(path, dtype=float) - contact.A)
    if contact.pair.overlap_ratio > 0.0:
        return _helical_share(contact, travel / contact.pair.base_pitch)
    _, in_contact = contact.pair_paths((travel / contact.pair.base_pitch).ravel())
    share: Array = 1.0 / in_contact.sum(axis=1).reshape(travel.shape)
    return share


def _helical_share(contact: PathOfContact, age: Array) -> Array:
    """Sum over the face of the load of a pair ``age`` cycles old, by equal load per length."""
    pair, kinks = contact.pair, np.array([*contact.event_phases(), 1.0])
    length = pair.contact_line_length(kinks)
    first, last = length[:-1], length[1:]

    def mean_inverse(first: Array, last: Array) -> Array:
        """Mean of one over a length that changes linearly between two values."""
        rise = last / first - 1.0
        flat = np.abs(rise) < 1e-4
        safe = np.where(flat, 1.0, rise)
        series = 1.0 - 0.5 * rise * (1.0 - rise * 2.0 / 3.0)
        return np.where(flat, series, np.log1p(safe) / safe) / first

    sums = np.concatenate([[0.0], np.cumsum(np.diff(kinks) * mean_inverse(first, last))])

    def integral(phase: Array) -> Array:
        turns = np.floor(phase)
        fraction = phase - turns
        start = np.clip(np.searchsorted(kinks, fraction, side="right") - 1, 0, first.size - 1)
        inside = mean_inverse(first[start], pair.contact_line_length(fraction))
        return np.asarray(turns * sums[-1] + sums[start] + (fraction - kinks[start]) * inside)

    line = pair.common_face_width / (math.cos(pair.base_helix_angle) * pair.overlap_ratio)
    return np.asarray(line * (integral(age + pair.overlap_ratio) - integral(age)))


def gear_loss_factor(pair: CylindricalPair, share: Callable[[Array], Array] | None = None) -> float:
    """Gear loss factor H_V by integration over the path of contact.

    Parameters
    ----------
    pair : CylindricalPair
        The pair.
    share : callable, optional
        Load share of a tooth pair as a function of its ``path`` [m]; equal sharing by default.

    Returns
    -------
    float
        H_V = 1/(p_b cos(beta_b)) times the integral from A to E of share |v_s| / v_b, where v_b is
        the speed of the base circles. Mean friction coefficient times H_V is the lost part of the
        power.

    Raises
    ------
    ComputationError
        If the share is not finite somewhere.

    Notes
    -----
    Gauss-Legendre quadrature between the moments where the number of pairs or the sense of
    sliding changes: exact for equal sharing. It holds wherever the pitch point lies. The closed
    form of Ohlendorf needs it among the positions of single contact. Source: Ohlendorf (1958),
    the integral before its evaluation.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> round(gear_loss_factor(pair), 4)
    0.1791
    """
    contact = path_of_contact(pair)
    breaks = _travel_breaks(contact)
    middle, half = 0.5 * (breaks[1:] + breaks[:-1]), 0.5 * np.diff(breaks)
    travel = (middle[:, None] + half[:, None] * _NODES).ravel()
    weight = (half[:, None] * _WEIGHTS).ravel()
    path = contact.A + contact.direction * travel * pair.base_pitch
    values = equal_share(contact, path) if share is None else np.asarray(share(path), dtype=float)
    if not np.all(np.isfinite(values)):
        what = "the load share is not finite on the path of contact"
        why = "Film and friction of a pair are computed under its share of the load"
        remedy = "Return a finite share for every path between A and E"
        raise ComputationError(what, Argument("share"), why, remedy)
    motion = contact.kinematics(path, 1.0)
    lost = float(weight @ (values * np.abs(motion.sliding_speed))) / pair.pinion.base_radius
    return lost / math.cos(pair.base_helix_angle)
