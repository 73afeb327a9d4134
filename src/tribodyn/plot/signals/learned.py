"""Response of case variants with bands, and the accuracy of a surrogate model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.theme.labels import label_with, readable, scaled, significant
from tribodyn.plot.theme.panels import Panel, Row, stack_rows
from tribodyn.plot.theme.style import (
    MUTED,
    PAIR_COLORS,
    PINION,
    TOTAL,
    WHEEL,
    Trace,
    between,
    line,
    marked,
)
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import CaseEnsemble
    from tribodyn.surrogate import Surrogate

_COLORS = (PINION, WHEEL, *PAIR_COLORS)
#: Most points per target, harmonics of the spectrum, and fraction of the variants in the band.
_POINTS, _HARMONICS, _SHARE = 2000, 12, 0.95
_LIGHT, _DARK = "rgba(0, 114, 178, 0.16)", "rgba(0, 114, 178, 0.45)"


def _curve(result: CaseEnsemble, signal: str, x: Array) -> tuple[list[Trace], str]:
    """Mean over the variants, its confidence band and the band of the variants."""
    band, spread = result.band(signal), result.spread(signal, _SHARE)
    factor, unit = scaled(band.mean, band.unit)
    name, (low, high) = f"{band.level:.0%} band of the mean", spread
    traces = [
        *between(x, factor * low, factor * high, f"{_SHARE:.0%} of the variants", _LIGHT),
        *between(x, factor * band.low, factor * band.high, name, _DARK),
        line(x, factor * band.mean, "mean", TOTAL, unit=unit),
    ]
    return traces, unit


def _lines(result: CaseEnsemble) -> tuple[list[Trace], str]:
    """Mesh harmonics with both bands as error bars."""
    band = result.band("mesh_force", harmonics=_HARMONICS)
    spread = result.spread("mesh_force", _SHARE, _HARMONICS)
    factor, unit = scaled(band.mean, band.unit)
    order, traces = np.arange(1, _HARMONICS + 1), []
    for low, high, name, color, width in (
        (*spread, f"{_SHARE:.0%} of the variants", MUTED, 8),
        (band.low, band.high, f"{band.level:.0%} band of the mean", PINION, 4),
    ):
        points = marked(order, factor * band.mean, name, color, size=6, symbol="circle", unit=unit)
        bars = {"array": factor * (high - band.mean), "arrayminus": factor * (band.mean - low)}
        points["error_y"] = {"type": "data", "width": width, "color": color, **bars}
        traces.append(points)
    return traces, unit


@drawing(
    "ensemble",
    heading="Spread of the response",
    caption="Effect of uncertain inputs: the light band holds 95 % of the "
    "variants, the dark band is the confidence band of their mean. Over the time of a mesh cycle, "
    "over its phase, and by mesh harmonic.",
    of="CaseEnsemble",
    made_by="Call tribodyn.ensemble(case, {...}, seed=1) and its plot method.",
)
def ensemble(result: CaseEnsemble) -> Any:
    """Draw force over time, transmission error over the phase, and the spectrum, with bands."""
    time = 1e3 * result.phase / float(np.mean(result.mesh_frequency))
    force, newton = _curve(result, "mesh_force", time)
    error, metre = _curve(result, "dynamic_transmission_error", result.phase)
    lines, unit = _lines(result)
    peak = result.mesh_force.max(axis=1)
    rows = [
        Row("Time [ms]", Panel(f"Mesh force [{newton}]", force)),
        Row("Mesh phase", Panel(f"Transmission error [{metre}]", error)),
        Row("Mesh harmonic", Panel(f"Amplitude of the force [{unit}]", lines)),
    ]
    low, high = np.quantile(peak, (0.5 - 0.5 * _SHARE, 0.5 + 0.5 * _SHARE))
    title = (
        f"{_SHARE:.0%} of {peak.size} variants peak between {significant(float(low))} and "
        f"{significant(float(high))} N"
    )
    return stack_rows(title, rows)


@drawing(
    "surrogate",
    heading="Surrogate against computation",
    caption="Predictions over computed values for rows that were not used in training. "
    "Points on the line are exact; a new prediction lies between the dotted lines with the stated "
    "probability.",
    of="Surrogate",
    made_by="Call tribodyn.surrogate.train(data, ...) and its plot method.",
)
def surrogate(result: Surrogate) -> Any:
    """Draw predictions over computed values of the held-out rows, one panel per target."""
    rows, qualities = [], []
    for number, name in enumerate(result.targets):
        true, predicted = result.true[number], result.predicted[number]
        factor, unit = scaled(true, readable(str(result.target_unit[number])))
        chosen = np.linspace(0, true.size - 1, min(true.size, _POINTS)).round().astype(int)
        color = _COLORS[number % len(_COLORS)]
        ends = factor * np.array([true.min(), true.max()])
        half = factor * float(result.band[number])
        place, style = (factor * true[chosen], factor * predicted[chosen]), Trace(symbol="circle")
        points = marked(*place, "held-out rows", color, size=4, unit=unit, **style)
        traces = [points, line(ends, ends, "exact", TOTAL, width=1.2)]
        if np.isfinite(half):
            for sign, in_legend in ((1.0, True), (-1.0, False)):
                edge = line(ends, ends + sign * half, f"{result.level:.0%} band", MUTED, dash="dot")
                traces.append({**edge, "showlegend": in_legend})
        label = label_with(str(name).replace("_", " "), unit)
        rows.append(Row(f"Computed {label}", Panel("Predicted", traces)))
        qualities.append(
            f"{str(name).replace('_', ' ')} {result.errors[str(name)].determination:.4f}"
        )
    title = f"R² over {result.true.shape[1]} held-out rows: {', '.join(qualities[:3])}"
    return stack_rows(title, rows, {"hovermode": "closest"})
