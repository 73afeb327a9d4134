"""Numbers of any size on an axis: the unit takes a prefix, so that labels stay short."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.types import Array


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
