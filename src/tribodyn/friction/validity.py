"""One warning for all quantities that leave the range of a law."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import warn

__all__ = ["Range", "warn_outside"]


class Range(NamedTuple):
    """A quantity with the range in which a law was fitted.

    Parameters
    ----------
    name : str
        Name of the quantity.
    value : array
        Value in any unit, named below.
    low, high : float
        In the same unit. Inclusive limits.
    unit : str
        Unit of value and limits.
    """

    name: str
    value: NDArray[np.float64]
    low: float
    high: float
    unit: str = ""


def warn_outside(law: str, ranges: Iterable[Range], remedy: str) -> None:
    """Warn once, naming every quantity outside of its range with all that it runs through.

    Parameters
    ----------
    law : str
        Name of the law.
    ranges : iterable of Range
        Quantities to look at.
    remedy : str
        What the user can do.

    Warns
    -----
    ModelWarning
        Code ``friction-range``.

    Source: the range that each law states.

    Examples
    --------
    >>> warn_outside("xu-2007", [Range("hertz_pressure", np.array(1.0), 0.5, 2.5, "GPa")], "")
    """
    faults = [_told(quantity) for quantity in ranges if _leaves(quantity)]
    if faults:
        warn("friction-range", f"{law}: {'; '.join(faults)}. {remedy}", stacklevel=3)


def _leaves(quantity: Range) -> bool:
    low, high = float(np.min(quantity.value)), float(np.max(quantity.value))
    return not quantity.low <= low <= high <= quantity.high


def _told(quantity: Range) -> str:
    """Write the whole range of a quantity and the one of the law."""
    low, high = f"{np.min(quantity.value):.4g}", f"{np.max(quantity.value):.4g}"
    values = low if low == high else f"{low} to {high}"
    limits = f"{quantity.low:g} to {quantity.high:g}"
    if quantity.high == np.inf:
        limits = f"{quantity.low:g} or more"
    unit = f" {quantity.unit}" if quantity.unit else ""
    return f"{quantity.name} {values}{unit}, fitted for {limits}{unit}"
