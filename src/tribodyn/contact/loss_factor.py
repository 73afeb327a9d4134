"""The gear loss factor: sliding work of the teeth over transmitted work, at unit friction."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.contact.path import PathOfContact, path_of_contact
from tribodyn.errors import Argument, ComputationError
from tribodyn.gear import SpurPair
from tribodyn.types import Array

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


def _travel_breaks(contact: PathOfContact) -> Array:
    """Travel from A, in base pitches, at which load share or sliding may change abruptly."""
    ratio, whole = contact.contact_ratio, np.arange(contact.pairs + 1)
    pitch_point = contact.direction * (contact.C - contact.A) / contact.pair.base_pitch
    breaks = np.concatenate([whole, ratio - whole, [pitch_point, ratio]])
    return np.unique(np.clip(breaks, 0.0, ratio))


def equal_share(contact: PathOfContact, path: Array) -> Array:
    """Load share of a tooth pair when all pairs in contact carry the same.

    Parameters
    ----------
    contact : PathOfContact
        Path of contact.
    path : array
        Positions of one pair on the path of contact [m], any shape.

    Returns
    -------
    array
        One over the number of pairs in contact at that moment, same shape.

    Notes
    -----
    Source: counting the positions that lie whole base pitches away on the path of contact.

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
    _, in_contact = contact.pair_paths((travel / contact.pair.base_pitch).ravel())
    share: Array = 1.0 / in_contact.sum(axis=1).reshape(travel.shape)
    return share


def gear_loss_factor(pair: SpurPair, share: Callable[[Array], Array] | None = None) -> float:
    """Gear loss factor H_V by integration over the path of contact.

    Parameters
    ----------
    pair : SpurPair
        The pair.
    share : callable, optional
        Load share of a tooth pair as a function of its ``path`` [m]; equal sharing by default.

    Returns
    -------
    float
        H_V = 1/p_b times the integral from A to E of share |v_s| / v_b, where v_b is the speed
        of the base circles. Mean friction coefficient times H_V is the lost part of the power.

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
        raise ComputationError(
            "the load share is not finite on the path of contact",
            where=Argument("share"),
            remedy="Return a finite share for every path between A and E",
        )
    motion = contact.kinematics(path, 1.0)
    return float(weight @ (values * np.abs(motion.sliding_speed))) / pair.pinion.base_radius
