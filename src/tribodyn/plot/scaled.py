"""Numbers of any size on an axis: the unit takes a prefix, so that labels stay short."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["parameter_axis", "scaled", "unit_of"]

Array = NDArray[np.float64]


def scaled(values: Any, unit: str) -> tuple[float, str]:
    """Factor and unit in which values are drawn.

    Parameters
    ----------
    values : array
        Values in ``unit``; NaN is left out of account.
    unit : str
        SI unit without a prefix.

    Returns
    -------
    tuple of float and str

    Examples
    --------
    >>> scaled([2e-6, 5e-5], "m"), scaled([0.3], "m/s")
    ((1000000.0, 'µm'), (1.0, 'm/s'))
    """
    found = np.abs(np.asarray(values, dtype=float))
    found = found[np.isfinite(found)]
    largest = float(found.max(initial=0.0))
    if unit in ("", "-", "1") or largest >= 0.1 or largest == 0.0:
        return 1.0, unit
    return (1e3, f"m{unit}") if largest >= 1e-3 and unit != "m" else (1e6, f"µ{unit}")


def unit_of(name: str) -> str:
    """Unit of a coordinate by its name: angles are called theta.

    Parameters
    ----------
    name : str
        Name of a coordinate or contact.

    Returns
    -------
    str

    Examples
    --------
    >>> unit_of("pinion_theta"), unit_of("contact 0")
    ('rad', 'm')
    """
    return "rad" if "theta" in name else "m"


def parameter_axis(name: str, values: Any, unit: str) -> tuple[Array, str]:
    """Values of a parameter as they are drawn, and the label of their axis.

    Parameters
    ----------
    name : str
        Name of the parameter.
    values : array
        Values in ``unit``.
    unit : str
        Their unit.

    Returns
    -------
    tuple of array and str

    Examples
    --------
    >>> parameter_axis("force_scale", [0.5, 1.0], "-")[1], parameter_axis("x", [1e-5], "m")[1]
    ('Force scale', 'X [µm]')
    """
    words = name.replace("_", " ")
    words = words[:1].upper() + words[1:]
    factor, shown = scaled(values, unit)
    drawn = factor * np.asarray(values, dtype=float)
    return drawn, words if shown in ("", "-", "1") else f"{words} [{shown}]"
