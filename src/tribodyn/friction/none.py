"""No friction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.friction.base import LAWS, FrictionLaw, TribologicalContact

__all__ = ["none"]


def none(shape: tuple[int, ...] = ()) -> NDArray[np.float64]:
    """No friction: a coefficient of zero.

    Parameters
    ----------
    shape : tuple of int
        Shape of the result.

    Returns
    -------
    float or array
        Zeros of that shape.

    Valid as a limit. Source: none needed.

    Examples
    --------
    >>> none((2,)).tolist()
    [0.0, 0.0]
    """
    return np.zeros(shape)[()]


def _law(contact: TribologicalContact) -> NDArray[np.float64]:
    return none(np.shape(contact.load_per_width))


LAWS.register("none")(FrictionLaw("none", "no friction", _law))
