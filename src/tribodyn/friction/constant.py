"""The same friction coefficient everywhere, or none."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import require_between
from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.model import REQUIRED, number
from tribodyn.types import Array


def constant(coefficient: float, shape: tuple[int, ...] = ()) -> Array:
    """Same friction coefficient everywhere (Coulomb).

    Parameters
    ----------
    coefficient : float
        Friction force over normal force, 0 to 1.
    shape : tuple of int
        Shape of the result.

    Returns
    -------
    float or array
        The coefficient in that shape.

    Raises
    ------
    InputError
        If the coefficient is outside 0 to 1.

    Valid as a mean over the path of contact; a lubricated gear has 0.02 to 0.12.
    Source: Coulomb (1781).

    Examples
    --------
    >>> constant(0.05, (2,)).tolist()
    [0.05, 0.05]
    """
    require_between("coefficient", coefficient, 0.0, 1.0)
    return np.full(shape, float(coefficient))[()]


_COEFFICIENT = number(
    REQUIRED, 0.0, 1.0, "lubricated steel lies below 0.2", of="friction_coefficient"
)


@LAWS.define(
    "constant",
    source="Coulomb (1781)",
    options={"coefficient": _COEFFICIENT},
    needs_oil=False,
    together=True,
    meaning="one friction coefficient everywhere",
)
def _constant(contact: TribologicalContact, *, coefficient: float) -> Array:
    return constant(coefficient, np.shape(contact.load_per_width))


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
    "none",
    source="the limit of smooth sliding",
    needs_oil=False,
    together=True,
    meaning="no friction at all",
)
def _none(contact: TribologicalContact) -> Array:
    return none(np.shape(contact.load_per_width))
