"""One warning for all quantities that leave the range of a law."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from tribodyn.errors import warn
from tribodyn.types import Array


class Range(NamedTuple):
    """A quantity with the range in which a law was fitted."""

    name: str  #: name of the quantity
    value: Array  #: value in any unit, named below
    low: float
    high: float
    unit: str = ""  #: unit of value and limits


def warn_outside(law: str, ranges: Iterable[Range], remedy: str) -> None:
    """Warn once, naming every quantity outside of its range with all that it runs through."""
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
