"""Curves of quantities of the nomenclature in their display units, and panels of them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from tribodyn.plot.theme.labels import axis_label, display_unit, displayed
from tribodyn.plot.theme.panels import Panel
from tribodyn.plot.theme.style import Trace, line, marked
from tribodyn.types import Array, Index

#: Axes that begin at zero, and that mark their zero.
FROM_ZERO, ZERO = {"rangemode": "tozero"}, {"zeroline": True}


def curve(quantity: str, x: Any, values: Any, name: str, color: str, **style: Any) -> Trace:
    """Curve of SI values of a quantity in its display unit."""
    return line(x, displayed(quantity, values), name, color, unit=display_unit(quantity), **style)


def points(quantity: str, x: Any, values: Any, name: str, color: str, **style: Any) -> Trace:
    """Marked SI values of a quantity in its display unit."""
    return marked(x, displayed(quantity, values), name, color, unit=display_unit(quantity), **style)


def curves(
    quantity: str,
    label: str | None,
    x: Any,
    rows: Iterable[tuple[Any, ...]],
    axis: dict[str, Any] | None = None,
    height: float = 1.0,
    **style: Any,
) -> Panel:
    """Panel with curves of a quantity over one axis; each row has name, values, colour, dash."""
    traces = [
        curve(quantity, x, values, name, color, dash=dash[0] if dash else "solid", **style)
        for name, values, color, *dash in rows
    ]
    return Panel(axis_label(quantity, label), traces, axis or {}, height)


def extremes(values: Array, most: int) -> Index:
    """Indices of the minimum and maximum of every group of samples, about ``most`` of them."""
    if values.size <= most:
        return np.arange(values.size)
    starts = np.arange(0, values.size, -(-2 * values.size // most))
    parts = np.split(values, starts[1:])
    ends = [(a + np.argmin(p), a + np.argmax(p)) for a, p in zip(starts, parts, strict=True)]
    return np.unique(np.array(ends).ravel())
