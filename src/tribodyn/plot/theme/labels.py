"""Axis labels, display units and rounded values, taken from the nomenclature."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import SupportsFloat

import numpy as np

from tribodyn.nomenclature import lookup
from tribodyn.types import Array
from tribodyn.units import convert

#: Units that take the prefixes kilo, mega and giga.
_PREFIXED = ("N", "W", "Hz", "Pa")
_SIGNS = (("^2", "²"), ("^3", "³"), ("*", "·"), ("um", "µm"), ("deg", "°"))


def readable(unit: str) -> str:
    """Write a unit with the signs used in print: µm, N·m, m/s²."""
    for plain, printed in _SIGNS:
        unit = unit.replace(plain, printed)
    return unit


def axis_label(name: str, label: str | None = None) -> str:
    """Label an axis with a quantity and its display unit."""
    label = quantity_label(name) if label is None else label
    return label_with(label, display_unit(name))


def label_with(label: str, unit: str) -> str:
    """Label with a unit as it is printed, if there is one."""
    return label if unit in ("", "-", "1") else f"{label} [{readable(unit)}]"


def quantity_label(name: str) -> str:
    """Label of a quantity from the nomenclature, without its unit."""
    return lookup(name).label.partition(" [")[0]


def display_unit(name: str) -> str:
    """Return the printed display unit of a quantity."""
    return readable(lookup(name).display_unit)


def displayed(name: str, values: object) -> Array:
    """Convert values from SI to the display unit of a quantity."""
    quantity = lookup(name)
    return np.asarray(values, dtype=float) * convert(1.0, quantity.unit, quantity.display_unit)


def rounded(name: str, value: SupportsFloat, digits: int = 3) -> str:
    """Format an SI value in its display unit for a title or a card."""
    return f"{significant(displayed(name, value), digits)} {display_unit(name)}".rstrip()


def significant(value: SupportsFloat, digits: int = 3) -> str:
    """Format a number with significant digits; the integer part is never rounded."""
    value = float(value)
    if value == 0.0:
        return "0"
    decimals = max(digits - 1 - math.floor(math.log10(abs(value))), 0)
    return f"{value:.{decimals}f}" if decimals <= digits + 3 else f"{value:.{digits - 1}e}"


def engineering(value: float, unit: str, digits: int = 5) -> tuple[str, str]:
    """Format a number and its unit with a prefix k, M or G in place of a power of ten."""
    power = 0
    while power < 3 and abs(value) >= 10.0**digits and unit.startswith(_PREFIXED):
        value, power = value / 1e3, power + 1
    text = significant(value, digits)
    if "." in text and "e" not in text:
        text = text.rstrip("0").rstrip(".")
    return text, ("", "k", "M", "G")[power] + unit


def scaled(values: object, unit: str) -> tuple[float, str]:
    """Return the factor and the unit in which values are plotted."""
    magnitudes = np.abs(np.asarray(values, dtype=float))
    magnitudes = magnitudes[np.isfinite(magnitudes)]
    largest = float(magnitudes.max(initial=0.0))
    if unit in ("", "-", "1") or largest >= 0.1 or largest == 0.0:
        return 1.0, unit
    return (1e3, f"m{unit}") if largest >= 1e-3 and unit != "m" else (1e6, f"µ{unit}")


def unit_of(name: str) -> str:
    """Unit of a coordinate by its name: rad for angles (theta), m otherwise."""
    return "rad" if "theta" in name else "m"


def listed(texts: Sequence[str]) -> str:
    """Join texts by commas, the last one by "and"."""
    return " and ".join(filter(None, (", ".join(texts[:-1]), *texts[-1:])))


def capitalized(name: str) -> str:
    """Write a name as words, the first with a capital."""
    label = name.replace("_", " ")
    return label[:1].upper() + label[1:]


def parameter_axis(name: str, values: object, unit: str) -> tuple[Array, str]:
    """Return the values of a parameter in their display unit and the label of the axis."""
    factor, display = scaled(values, unit)
    values_in_display_unit = factor * np.asarray(values, dtype=float)
    return values_in_display_unit, label_with(capitalized(name), display)
