"""Values, axis labels and units as engineers read them, taken from the nomenclature."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.nomenclature import lookup
from tribodyn.units import convert

__all__ = [
    "axis_label",
    "axis_words",
    "display_unit",
    "displayed",
    "readable",
    "rounded",
    "significant",
]

_SIGNS = (("^2", "²"), ("^3", "³"), ("*", "·"), ("um", "µm"), ("deg", "°"))


def readable(unit: str) -> str:
    """Write a unit the way it is printed.

    Parameters
    ----------
    unit : str
        Unit in plain characters.

    Returns
    -------
    str

    Examples
    --------
    >>> readable("kg*mm^2"), readable("um")
    ('kg·mm²', 'µm')
    """
    for plain, printed in _SIGNS:
        unit = unit.replace(plain, printed)
    return unit


def axis_label(name: str, words: str | None = None) -> str:
    """Label an axis with a quantity and its display unit.

    Parameters
    ----------
    name : str
        Name in the nomenclature.
    words : str, optional
        Words to print instead of the name.

    Returns
    -------
    str

    Examples
    --------
    >>> axis_label("pair_stiffness"), axis_label("pair_stiffness", "Stiffness")
    ('Pair stiffness [N/µm]', 'Stiffness [N/µm]')
    """
    words = axis_words(name) if words is None else words
    unit = display_unit(name)
    return f"{words} [{unit}]" if unit else words


def axis_words(name: str) -> str:
    """Name a quantity in words, without its unit.

    Parameters
    ----------
    name : str
        Name in the nomenclature.

    Returns
    -------
    str

    Examples
    --------
    >>> axis_words("bearing_force")
    'Bearing force'
    """
    return lookup(name).label.partition(" [")[0]


def display_unit(name: str) -> str:
    """Return the printed display unit of a quantity.

    Parameters
    ----------
    name : str
        Name in the nomenclature.

    Returns
    -------
    str

    Examples
    --------
    >>> display_unit("deflection")
    'µm'
    """
    return readable(lookup(name).display_unit)


def displayed(name: str, values: Any) -> NDArray[np.float64]:
    """Convert values from SI to the display unit of a quantity.

    Parameters
    ----------
    name : str
        Name in the nomenclature.
    values : float or array
        Values in the SI unit of the quantity.

    Returns
    -------
    array
        Values in its display unit, of the same shape.

    Examples
    --------
    >>> float(displayed("deflection", 2e-6))
    2.0
    """
    quantity = lookup(name)
    return np.asarray(values, dtype=float) * convert(1.0, quantity.unit, quantity.display_unit)


def rounded(name: str, value: float, digits: int = 3) -> str:
    """Write one SI value in its display unit for a title or a card.

    Parameters
    ----------
    name : str
        Name in the nomenclature.
    value : float
        Value in the SI unit of the quantity.
    digits : int
        Significant digits; digits before the decimal point are never cut.

    Returns
    -------
    str

    Examples
    --------
    >>> rounded("mesh_force", 2660.44), rounded("deflection", 1.11197e-5)
    ('2660 N', '11.1 µm')
    """
    return f"{significant(float(displayed(name, value)), digits)} {display_unit(name)}".rstrip()


def significant(value: float, digits: int = 3) -> str:
    """Write a number with some significant digits, but never with fewer than its whole part.

    Parameters
    ----------
    value : float
        Any number.
    digits : int
        Significant digits.

    Returns
    -------
    str

    Examples
    --------
    >>> significant(12345.6), significant(0.051234), significant(3.2e-9)
    ('12346', '0.0512', '3.20e-09')
    """
    if value == 0.0:
        return "0"
    decimals = max(digits - 1 - math.floor(math.log10(abs(value))), 0)
    return f"{value:.{decimals}f}" if decimals <= digits + 3 else f"{value:.{digits - 1}e}"
