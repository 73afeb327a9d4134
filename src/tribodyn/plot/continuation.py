"""A branch of periodic orbits: vibration and largest multiplier over the parameter."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.labels import axis_label, displayed, rounded, significant
from tribodyn.plot.scaled import scaled, unit_of
from tribodyn.plot.style import MUTED, PAIR_COLORS, TOTAL, Panel, line, stack
from tribodyn.types import Array, Mask

_UNSTABLE = PAIR_COLORS[3]
#: Kind of special point: words, colour and symbol.
_MARKS = {
    "fold": ("fold", PAIR_COLORS[1], "circle"),
    "period-doubling": ("period doubling", PAIR_COLORS[0], "diamond"),
    "neimark-sacker": ("Neimark-Sacker", PAIR_COLORS[2], "square"),
    "branch-point": ("branch point", TOTAL, "x"),
    "grazing": ("contact begins to open", MUTED, "triangle-down"),
}


def _missing(result: Any) -> str:
    if hasattr(result, "special_points") and hasattr(result, "floquet_multipliers"):
        return ""
    return (
        "This figure shows a branch of periodic orbits. Call "
        "tribodyn.dynamics.continuation(...) and its plot method."
    )


def _parameter(branch: Any, values: Any) -> Array:
    known = branch.name in QUANTITIES
    return displayed(branch.name, values) if known else np.asarray(values, dtype=float)


def _signal(branch: Any) -> tuple[Array, list[float], str]:
    """Rms of the first signal and at the special points as they are drawn, and their unit."""
    factor, unit = scaled(branch.rms[:, 0], unit_of(branch.signals[0]))
    special = [float(factor * point.rms[0]) for point in branch.special_points]
    return factor * np.asarray(branch.rms[:, 0], dtype=float), special, unit


def _part(values: Array, keep: Mask) -> Array:
    """Values of the points kept and of their neighbours, so that the parts meet."""
    near = keep | np.roll(keep, 1) & (np.arange(keep.size) > 0)
    return np.where(near, values, np.nan)


def _parts(branch: Any, x: Array, y: Array, unit: str) -> list[dict[str, Any]]:
    stable = np.asarray(branch.stable, dtype=bool)
    drawn = [line(x, _part(y, stable), "stable", TOTAL, unit=unit)]
    if not stable.all():
        drawn.append(line(x, _part(y, ~stable), "unstable", _UNSTABLE, unit=unit, dash="dash"))
    return drawn


def _points(branch: Any, values: list[float], unit: str, legend: bool) -> list[dict[str, Any]]:
    drawn = []
    for kind, (words, color, symbol) in _MARKS.items():
        own = [n for n, point in enumerate(branch.special_points) if point.kind == kind]
        if not own:
            continue
        x = _parameter(branch, [branch.special_points[n].parameter for n in own])
        trace = line(x, [values[n] for n in own], words, color, unit=unit)
        del trace["line"]
        marker = {"size": 9, "symbol": symbol, "color": color}
        drawn.append({**trace, "mode": "markers", "marker": marker, "showlegend": legend})
    return drawn


def _told(branch: Any, value: float) -> str:
    known = branch.name in QUANTITIES
    return rounded(branch.name, value, 4) if known else f"{branch.name} {significant(value, 4)}"


def _title(branch: Any) -> str:
    folds = [_told(branch, fold.parameter) for fold in branch.special("fold")]
    if len(folds) > 2:
        return f"The branch turns back {len(folds)} times"
    if folds:
        return f"The branch turns back at {' and '.join(folds)}"
    if np.all(branch.stable):
        low, high = (_told(branch, edge(branch.parameter)) for edge in (np.min, np.max))
        return f"The motion is stable from {low} to {high}"
    lost = branch.parameter[int(np.argmin(branch.stable))]
    return f"The motion is not stable at {_told(branch, float(lost))}"


@drawing(
    "continuation",
    heading="Branch of periodic motions",
    caption="How strong the periodic motion is over the parameter. Dashed parts exist but are "
    "left at the slightest disturbance. Where the branch turns back, the motion jumps. Below: the "
    "largest Floquet multiplier, by which a disturbance grows in one period.",
    needs=_missing,
)
def continuation(branch: Any) -> Any:
    """Draw rms and largest multiplier of a branch over its parameter.

    Parameters
    ----------
    branch : Branch
        What :func:`tribodyn.dynamics.continuation` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    x = _parameter(branch, branch.parameter)
    rms, special, unit = _signal(branch)
    largest = np.abs(branch.floquet_multipliers[:, 0])
    critical = [float(np.abs(p.floquet_multipliers[0])) for p in branch.special_points]
    known = branch.name in QUANTITIES
    ends = [float(x.min()), float(x.max())]
    return stack(
        _title(branch),
        axis_label(branch.name) if known else branch.name,
        [
            Panel(
                f"Alternating rms of {branch.signals[0]} [{unit}]",
                [*_parts(branch, x, rms, unit), *_points(branch, special, unit, True)],
                {"rangemode": "tozero"},
                1.4,
            ),
            Panel(
                "Largest multiplier",
                [
                    *_parts(branch, x, largest, ""),
                    {**line(ends, [1.0, 1.0], "limit", MUTED, dash="dot"), "hoverinfo": "skip"},
                    *_points(branch, critical, "", False),
                ],
                {"rangemode": "tozero"},
            ),
        ],
        # A branch that turns back has several values at one place: each is told by itself.
        {"hovermode": "closest"},
    )
