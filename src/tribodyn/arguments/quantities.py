"""Numbers in the unit of a parameter, from objects that carry a unit of their own.

Objects are recognised by their attributes, since no unit library is imported: ``magnitude`` and
``units`` (pint, quantities), ``value`` and ``unit`` (astropy), ``value`` and ``units`` (unyt).
NumPy drops their units without an error.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from typing import Any

import numpy as np

#: Common types of values, which have no unit.
PLAIN = frozenset((float, int, bool, str, bytes, type(None), complex, np.float64, np.int64))

_SEVERAL = (list, tuple, set, frozenset)


class ValueRefusedError(TypeError):
    """The type is right but the value is not; the message says which values are accepted."""


class UnitRefusedError(ValueRefusedError):
    """A quantity is not of the unit that is wanted."""


def quantity_in(value: Any) -> Any:
    """Object with a unit that a value is, or that a labelled array holds; None without a unit."""
    if type(value) in PLAIN or type(value).__module__.partition(".")[0] == "tribodyn":
        return None
    with contextlib.suppress(Exception):  # attributes of foreign objects may raise anything
        for item in (value, getattr(value, "data", None)):
            has_unit = hasattr(item, "units") or hasattr(item, "unit")
            if has_unit and (hasattr(item, "magnitude") or hasattr(item, "value")):
                return item
    return None


def unit_text(quantity: Any) -> str:
    """Unit of an object, as its library writes it."""
    unit = str(quantity.units if hasattr(quantity, "units") else quantity.unit)
    return "1" if unit in ("", "dimensionless") else unit


def _counts_angles(quantity: Any, converted: Any, unit: str) -> bool:
    """Whether two quantities have one power of the radian, which pint takes for the number 1."""
    if hasattr(quantity, "to_root_units"):
        return angle_power(quantity) == angle_power(converted)
    if "rad" not in unit and unit not in ("Hz", "1/s", ""):
        return True
    try:
        _convert(quantity, f"({unit or '1'})*rad")
    except Exception:
        return True
    return False  # the library cannot tell them apart


def angle_power(quantity: Any) -> float:
    """Power of the radian in the unit of a quantity of pint."""
    return float(dict(quantity.to_root_units().unit_items()).get("radian", 0))


def _convert(quantity: Any, unit: str) -> Any:
    unit = unit.replace("^", "**")
    return quantity.to(unit) if hasattr(quantity, "to") else quantity.rescale(unit)


def magnitude(value: Any, unit: str | None) -> Any:
    """Number or array that an object with a unit is in ``unit``; None where none is known."""
    quantity = quantity_in(value)
    if unit is None:
        raise UnitRefusedError("Wanted: a value without a unit")
    text = f"Wanted: a quantity in {unit}" if unit else "Wanted: a pure number"
    refused = UnitRefusedError(f"{text}, but its unit is {unit_text(quantity)}")
    try:
        converted = _convert(quantity, unit)
        equal = _counts_angles(quantity, converted, unit)
    except Exception as error:  # each library raises errors of its own
        raise refused from error
    if not equal:
        why = "angles and rotational speeds are kinds of their own"
        raise UnitRefusedError(f"{refused}; {why}")
    return converted.magnitude if hasattr(converted, "magnitude") else converted.value


def without_units(value: Any, unit: str | None, inside: bool = True) -> Any:
    """Value with all quantities as numbers in ``unit``, those ``inside`` of mappings too."""
    kind = type(value)
    if kind in PLAIN or (kind is np.ndarray and value.dtype.kind != "O"):
        return value
    if quantity_in(value) is not None:
        return magnitude(value, unit)
    if isinstance(value, Mapping):
        entries = dict(value) if inside else {}  # a data set makes new arrays at each access
        new = {key: without_units(item, unit) for key, item in entries.items()}
        return new if any(new[key] is not entries[key] for key in new) else value
    if kind is np.ndarray:
        has_units = any(quantity_in(item) is not None for item in value.flat)
        return np.array(without_units(value.tolist(), unit)) if has_units else value
    if not isinstance(value, _SEVERAL) or PLAIN.issuperset(map(type, value)):
        return value
    items = [without_units(item, unit, inside) for item in value]
    if all(new is old for new, old in zip(items, value, strict=True)):
        return value
    return kind(*items) if hasattr(kind, "_fields") else kind(items)


def is_plain(value: Any) -> bool:
    """Quick check that neither a value nor what it holds has a unit."""
    kind = type(value)
    if kind in PLAIN:
        return True
    if kind is np.ndarray:
        return bool(value.dtype.kind != "O")
    return not isinstance(value, (*_SEVERAL, Mapping)) and quantity_in(value) is None
