"""No friction."""

from __future__ import annotations

import numpy as np

from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.types import Array


def none(shape: tuple[int, ...] = ()) -> Array:
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


@LAWS.define(
    "none", source="no paper", needs_oil=False, meaning="no friction: the frictionless limit"
)
def _law(contact: TribologicalContact) -> Array:
    return none(np.shape(contact.load_per_width))
