"""Values, axis labels and units as engineers read them, taken from the nomenclature."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tribodyn.nomenclature import lookup
from tribodyn.types import Array
from tribodyn.units import convert

#: Units that are told in thousands and millions.
_PREFIXED = ("N", "W", "Hz", "Pa")
_SIGNS = (("^2", "²"), ("^3", "³"), ("*", "·"), ("um", "µm"), ("deg", "°"))


def readable(unit: str) -> str:
    """Write a unit the way it is printed."""
    for plain, printed in _SIGNS:
        unit = unit.replace(plain, printed)
    return unit


def axis_label(name: str, words: str | None = None) -> str:
    """Label an axis with a quantity and its display unit."""
    words = axis_words(name) if words is None else words
    unit = display_unit(name)
    return f"{words} [{unit}]" if unit else words


def axis_words(name: str) -> str:
    """Name a quantity in words, without its unit."""
    return lookup(name).label.partition(" [")[0]


def display_unit(name: str) -> str:
    """Return the printed display unit of a quantity."""
    return readable(lookup(name).display_unit)


def displayed(name: str, values: Any) -> Array:
    """Convert values from SI to the display unit of a quantity."""
    quantity = lookup(name)
    return np.asarray(values, dtype=float) * convert(1.0, quantity.unit, quantity.display_unit)


def rounded(name: str, value: float, digits: int = 3) -> str:
    """Write one SI value in its display unit for a title or a card."""
    return f"{significant(float(displayed(name, value)), digits)} {display_unit(name)}".rstrip()


def significant(value: float, digits: int = 3) -> str:
    """Write a number with some significant digits, but never with fewer than its whole part."""
    if value == 0.0:
        return "0"
    decimals = max(digits - 1 - math.floor(math.log10(abs(value))), 0)
    return f"{value:.{decimals}f}" if decimals <= digits + 3 else f"{value:.{digits - 1}e}"


def engineering(value: float, unit: str, digits: int = 5) -> tuple[str, str]:
    """Number and unit without a power of ten, a large one in thousands of its unit."""
    power = 0
    while power < 3 and abs(value) >= 10.0**digits and unit.startswith(_PREFIXED):
        value, power = value / 1e3, power + 1
    shown = significant(value, digits)
    if "." in shown and "e" not in shown:
        shown = shown.rstrip("0").rstrip(".")
    return shown, ("", "k", "M", "G")[power] + unit


def scaled(values: Any, unit: str) -> tuple[float, str]:
    """Factor and unit in which values are drawn."""
    found = np.abs(np.asarray(values, dtype=float))
    found = found[np.isfinite(found)]
    largest = float(found.max(initial=0.0))
    if unit in ("", "-", "1") or largest >= 0.1 or largest == 0.0:
        return 1.0, unit
    return (1e3, f"m{unit}") if largest >= 1e-3 and unit != "m" else (1e6, f"µ{unit}")


def unit_of(name: str) -> str:
    """Unit of a coordinate by its name: angles are called theta."""
    return "rad" if "theta" in name else "m"


def parameter_axis(name: str, values: Any, unit: str) -> tuple[Array, str]:
    """Values of a parameter as they are drawn, and the label of their axis."""
    words = name.replace("_", " ")
    words = words[:1].upper() + words[1:]
    factor, shown = scaled(values, unit)
    drawn = factor * np.asarray(values, dtype=float)
    return drawn, words if shown in ("", "-", "1") else f"{words} [{shown}]"
