"""Convergence of the Lyapunov exponents: running means with their standard errors."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.style import FILLS, MUTED, PAIR_COLORS, PINION, WHEEL, Panel, line, stack

#: Exponents that are drawn at most; the largest decides.
_DRAWN = 3
_COLORS = (PINION, WHEEL, PAIR_COLORS[0])
#: Points of a curve at most.
_KEPT = 1500


def _missing(result: Any) -> str:
    if hasattr(result, "growth") and hasattr(result, "standard_error"):
        return ""
    return (
        "This figure shows Lyapunov exponents. Call tribodyn.analysis.lyapunov_exponents(...) and "
        "its plot method."
    )


def _title(found: Any) -> str:
    value, error = found.vibrating[0], found.standard_error[0]
    words = f"{value:.4g} 1/s, standard error {error:.1g} 1/s"
    if found.verdict == "step-limited":
        return f"Made by the step, not by physics: the largest exponent is {words}"
    if found.chaotic:
        return f"Chaotic: the largest exponent is {words}"
    return f"Not chaotic: the largest exponent is {words}"


@drawing(
    "lyapunov",
    heading="Lyapunov exponents",
    caption="Mean growth of a small disturbance up to each mesh cycle. The band is the standard "
    "error of a mean over so many cycles, the dotted line the result. A largest exponent that "
    "stays above zero means chaos.",
    needs=_missing,
)
def lyapunov(found: Any) -> Any:
    """Draw the running means of the largest exponents.

    Parameters
    ----------
    found : LyapunovExponents
        What :func:`tribodyn.analysis.lyapunov_exponents` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    cycles = len(found.growth)
    count = np.arange(1, cycles + 1)
    kept = np.unique(np.linspace(0, cycles - 1, min(cycles, _KEPT)).astype(int))
    means = np.cumsum(found.growth, axis=0) / count[:, None]
    order = np.argsort(-means[-1])[:_DRAWN]
    errors = np.delete(found.standard_error, np.flatnonzero(found.exponents == 0.0)[: found.free])
    traces: list[dict[str, Any]] = []
    x = count[kept]
    for number, column in enumerate(order):
        color = _COLORS[number]
        mean = means[kept, column]
        band = errors[number] * np.sqrt(cycles / x)
        fill = FILLS.get(color, "rgba(0, 158, 115, 0.14)")
        traces.append({
            "type": "scatter", "x": np.append(x, x[::-1]), "mode": "lines", "fill": "toself",
            "y": np.append(mean + band, (mean - band)[::-1]), "fillcolor": fill,
            "line": {"width": 0}, "hoverinfo": "skip", "showlegend": False,
        })  # fmt: skip
        traces.append(line(x, mean, f"exponent {number + 1}", color, unit="1/s"))
        level = np.full(2, found.vibrating[number])
        dotted = line(x[[0, -1]], level, "result", color, dash="dot", width=1.0)
        traces.append({**dotted, "showlegend": False})
    zero = line(x[[0, -1]], [0.0, 0.0], "zero", MUTED, width=1.0)
    traces.append({**zero, "showlegend": False, "hoverinfo": "skip"})
    late = means[kept][x >= max(1, cycles // 50)][:, order]
    span = np.append(late.ravel(), 0.0)
    margin = 0.1 * float(np.ptp(span)) or 1.0
    limits = {"range": [float(span.min()) - margin, float(span.max()) + margin]}
    panel = Panel("Exponent [1/s]", traces, limits, height=1.6)
    return stack(_title(found), "Mesh cycles", [panel])
