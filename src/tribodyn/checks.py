"""Arguments that are quantities of the nomenclature: finite, positive, as arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_positive
from tribodyn.nomenclature import QUANTITIES
from tribodyn.types import Array

#: What to do about a value that is not positive.
_REMEDIES = {
    "load_per_width": "1 N/mm is 1000 N/m",
    "entrainment_speed": "A film needs a rolling motion: give half the sum of the surface speeds",
    "eyring_stress": "5 MPa is 5e6 Pa",
}


def positive(**quantities: ArrayLike) -> list[Array]:
    """Arrays of quantities, each called by its name; refused unless finite and positive."""
    arrays = [np.asarray(value, dtype=float) for value in quantities.values()]
    for name, array in zip(quantities, arrays, strict=True):
        if not np.all((array > 0.0) & (array < np.inf)):
            require_positive(name, array, QUANTITIES[name].unit, remedy=_REMEDIES.get(name, ""))
    return arrays


def one_or_more(**quantities: ArrayLike) -> list[Array]:
    """Lists of quantities of which one value or several are given, all of them positive."""
    lists = [np.atleast_1d(values) for values in positive(**quantities)]
    for name, values in zip(quantities, lists, strict=True):
        if values.ndim != 1 or values.size == 0:
            raise InputError(
                f"{name} has the shape {values.shape}",
                where=Argument(name),
                why="It is one value or a list of values",
                remedy="Give each value once; several quantities are combined, each with each",
            )
    return lists
