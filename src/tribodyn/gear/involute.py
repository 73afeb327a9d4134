"""The involute function and its inverse."""

from __future__ import annotations

import math

from tribodyn.errors import ComputationError, require_between


def involute(angle: float) -> float:
    """Involute function tan(angle) - angle.

    Parameters
    ----------
    angle : float
        Pressure angle [rad], 0 to below pi/2.

    Returns
    -------
    float
        Involute polar angle [rad].

    Notes
    -----
    Source: ISO 21771, involute function.

    Examples
    --------
    >>> round(involute(math.radians(20.0)), 9)
    0.014904384
    """
    return math.tan(angle) - angle


def inverse_involute(value: float) -> float:
    """Pressure angle whose involute function is ``value``."""
    require_between("value", value, 0.0, 1000.0, "rad")
    if value == 0.0:
        return 0.0
    angle = min(math.cbrt(3.0 * value), math.atan(value + math.pi / 2.0))
    for _ in range(60):
        step = (involute(angle) - value) / math.tan(angle) ** 2
        if step <= 1e-16:  # descending no more: rounding is reached
            return angle
        angle -= step
    raise ComputationError(f"no pressure angle found for the involute function {value!r}")
