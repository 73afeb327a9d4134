"""Poincare section: states of a motion once per mesh cycle in the phase plane."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.errors import InputError, Problem
from tribodyn.plot.scaled import scaled, unit_of
from tribodyn.plot.style import PINION, TOTAL, figure


def _missing(result: Any) -> str:
    if hasattr(result, "names") and hasattr(result, "velocity") and hasattr(result, "deflection"):
        return ""
    return "This figure shows a section. Call tribodyn.analysis.poincare(...) and its plot method."


def _title(section: Any) -> str:
    if section.verdict == "step-limited":
        return "The motion is made by the step, not by physics"
    if section.period == 1:
        return "The motion repeats with the mesh: one point"
    if section.period:
        return f"The motion repeats after {section.period} mesh cycles: as many points"
    return "The motion does not repeat within 16 mesh cycles"


def _window(values: Any, motion: float) -> list[float]:
    """Range of an axis that does not blow up the rounding of a motion that repeats."""
    middle = 0.5 * float(values.max() + values.min())
    half = max(0.6 * float(np.ptp(values)), 0.05 * motion, 1e-300)
    return [middle - half, middle + half]


@drawing(
    "poincare",
    heading="Poincare section",
    caption="The state once per mesh cycle, at the mesh phase 0. A motion that repeats shows as "
    "many points as it takes mesh cycles to do so, a quasi-periodic one a closed curve, a chaotic "
    "one a cloud with inner structure.",
    needs=_missing,
)
def poincare(section: Any, coordinate: int | str = 0) -> Any:
    """Draw the points of one coordinate in its phase plane.

    Parameters
    ----------
    section : PoincareSection
        What :func:`tribodyn.analysis.poincare` returns.
    coordinate : int or str
        Number or name of the coordinate.

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        If no coordinate has this name.
    """
    names = tuple(section.names)
    if isinstance(coordinate, str) and coordinate not in names:
        what, remedy = f'no coordinate is called "{coordinate}"', f"Choose from: {', '.join(names)}"
        raise InputError(Problem(what, "argument coordinate", "", remedy))
    column = names.index(coordinate) if isinstance(coordinate, str) else coordinate
    name, place, speed = names[column], section.position[:, column], section.velocity[:, column]
    x_factor, x_unit = scaled(place, unit_of(name))
    y_factor, y_unit = scaled(speed, f"{unit_of(name)}/s")
    x, y = x_factor * place, y_factor * speed
    last = section.period or 0
    shown = slice(-last, None) if last else slice(None)
    words = "last points" if last else "points"
    trace = {
        "type": "scatter", "mode": "markers", "x": x[shown], "y": y[shown], "name": words,
        "marker": {"size": 9 if last else 3.5, "color": PINION if last else TOTAL},
        "hovertemplate": f"%{{x:.5g}} {x_unit}, %{{y:.5g}} {y_unit}<extra></extra>",
    }  # fmt: skip
    layout = {
        "xaxis": {
            "title": {"text": f"{name.replace('_', ' ')} [{x_unit}]"},
            "range": _window(x[shown], float(np.abs(x).max())),
        },
        "yaxis": {
            "title": {"text": f"its velocity [{y_unit}]"},
            "range": _window(y[shown], float(np.abs(y).max())),
        },
        "hovermode": "closest",
        "height": 560,
    }
    return figure(_title(section), [trace], layout)
