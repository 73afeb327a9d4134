"""The involute function and its inverse."""

from __future__ import annotations

import math

from tribodyn.errors import ComputationError, require_between

__all__ = ["inverse_involute", "involute"]


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
    """Pressure angle whose involute function is ``value``.

    Parameters
    ----------
    value : float
        Involute polar angle [rad], 0 to 1000.

    Returns
    -------
    float
        Pressure angle [rad].

    Raises
    ------
    InputError
        If the value is negative or not finite.

    Notes
    -----
    Newton's method from above. The function is convex and both starting bounds,
    ``(3 value)^(1/3)`` and ``atan(value + pi/2)``, lie above the root, so that the iteration
    descends monotonically and cannot fail.

    Examples
    --------
    >>> round(math.degrees(inverse_involute(0.014904383867)), 6)
    20.0
    """
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
