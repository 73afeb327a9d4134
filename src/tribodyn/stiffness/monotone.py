"""A smooth curve through points without overshoot: the monotone piecewise cubic."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

__all__ = ["monotone_cubic"]

FloatArray = NDArray[np.float64]


def monotone_cubic(x: FloatArray, y: FloatArray) -> Callable[[FloatArray], FloatArray]:
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

    curve: Callable[[FloatArray], FloatArray] = PchipInterpolator(x, y)  # type: ignore[no-untyped-call]
    return curve
