"""The gear loss factor: by integration, and in the closed form of Ohlendorf."""

from __future__ import annotations

import math
from collections.abc import Callable

from tribodyn.contact import gear_loss_factor as integrated
from tribodyn.contact import path_of_contact
from tribodyn.errors import warn
from tribodyn.gear import SpurPair
from tribodyn.types import Array


def gear_loss_factor(pair: SpurPair, load_share: Callable[[Array], Array] | None = None) -> float:
    """Gear loss factor H_V: lost part of the power over the mean friction coefficient.

    Parameters
    ----------
    pair : SpurPair
        The pair.
    load_share : callable, optional
        Load share of a tooth pair as a function of its ``path`` in m; equal sharing by default.

    Returns
    -------
    float
        H_V, 1/p_b times the integral of share times sliding over the path of contact.

    Raises
    ------
    ComputationError
        If the share is not finite somewhere.

    Valid wherever the pitch point lies. Source: Ohlendorf (1958), the integral.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> round(gear_loss_factor(pair), 4)
    0.1791
    """
    return integrated(pair, load_share)


def ohlendorf_loss_factor(pair: SpurPair) -> float:
    """Gear loss factor H_V in the closed form of Ohlendorf.

    ``H_V = pi (u + 1)/(z_1 u) (1 - eps + eps_1^2 + eps_2^2)`` with the contact ratio eps and its
    parts before and after the pitch point.

    Parameters
    ----------
    pair : SpurPair
        The pair.

    Returns
    -------
    float
        H_V for equal sharing, exact where the pitch point lies among the positions of single
        contact.

    Warns
    -----
    ModelWarning
        Code ``loss-factor`` where it lies elsewhere, or the contact ratio is not between 1 and 2:
        the form is wrong there.

    Source: Ohlendorf, Diss. TH Munich (1958).

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> round(ohlendorf_loss_factor(pair), 4)
    0.1791
    """
    path = path_of_contact(pair)
    approach = path.direction * (path.C - path.A) / pair.base_pitch
    recess = path.contact_ratio - approach
    factor = 1.0 - path.contact_ratio + approach**2 + recess**2
    if not (path.contact_ratio <= 2.0 and path.contact_ratio - 1.0 <= approach <= 1.0):
        zone = "" if path.contact_ratio <= 2.0 else f" of {path.contact_ratio:.3f}"
        warn(
            "loss-factor",
            f"ohlendorf: the pitch point lies {approach:.3f} base pitches after the entry, and "
            f"a single pair carries the load from {path.contact_ratio - 1.0:.3f} to 1.000 of a "
            f"contact ratio{zone}: the closed form does not hold there. Take gear_loss_factor, "
            "which integrates.",
        )
    ratio = pair.ratio
    return math.pi * (ratio + 1.0) / (pair.pinion.teeth * ratio) * factor
