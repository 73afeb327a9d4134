"""A smooth curve through points without overshoot: the monotone piecewise cubic."""

from __future__ import annotations

from collections.abc import Callable

from tribodyn.types import Array


def monotone_cubic(x: Array, y: Array) -> Callable[[Array], Array]:
    """Lay a monotone piecewise cubic through points.

    Parameters
    ----------
    x : array (m,) [any unit]
        Strictly increasing, at least two values.
    y : array (m,) [any unit]
        Values.

    Returns
    -------
    callable
        The curve as a function of arrays of any shape.

    Notes
    -----
    Within the range of ``x``. Source: Fritsch and Carlson (1980), SIAM J. Numer. Anal. 17,
    238-246.

    Examples
    --------
    >>> curve = monotone_cubic(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0]))
    >>> float(curve(np.array(1.5)))
    1.0
    """
    from scipy.interpolate import PchipInterpolator

    curve: Callable[[Array], Array] = PchipInterpolator(x, y)  # type: ignore[no-untyped-call]
    return curve
