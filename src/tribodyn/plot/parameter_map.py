"""Period, rms and contact loss over two parameters."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.scaled import parameter_axis, scaled, unit_of
from tribodyn.plot.separate import Row, separate
from tribodyn.plot.style import PAIR_COLORS, PINION, WHEEL, Panel

#: Words and colours of the periods; the last one is for motions without bounds.
_PERIODS = (
    ("1", "#eef3f7"), ("2", PINION), ("3", PAIR_COLORS[0]), ("4", PAIR_COLORS[2]),
    ("5 to 16", PAIR_COLORS[3]), ("none", WHEEL), ("ran away", "#8a94a0"),
)  # fmt: skip
#: From little to much.
_SCALE = [[0.0, "#f7fbff"], [0.35, "#9ecae1"], [0.7, "#3182bd"], [1.0, "#08306b"]]

#: Part of the motions whose rms the colours tell apart where the rest lies far beyond.
_USUAL = 0.98


def _missing(result: Any) -> str:
    if hasattr(result, "contact_loss_share") and hasattr(result, "units"):
        return ""
    return (
        "This figure shows motions over two parameters. Call "
        "tribodyn.analysis.parameter_map(...) and its plot method."
    )


def _class(found: Any) -> Any:
    """Number of the colour of every motion; NaN where there is none yet."""
    period = found.period
    number = np.select(
        [~np.isfinite(found.rms), period == 0, period > 4], [6.0, 5.0, 4.0], period - 1.0
    )
    return np.where(found.finished, number, np.nan)


def _heat(x: Any, y: Any, z: Any, words: str, **more: Any) -> dict[str, Any]:
    return {
        "type": "heatmap", "x": x, "y": y, "z": np.asarray(z).T, "colorscale": _SCALE,
        "hovertemplate": f"%{{x:.5g}}, %{{y:.4g}}: {words}<extra></extra>", "showlegend": False,
        **more,
    }  # fmt: skip


def _range(rms: Any) -> dict[str, float]:
    """Ends of the colours: a few motions far beyond the others do not take them all."""
    seen = rms[np.isfinite(rms)]
    if not seen.size:
        return {}
    most, usual = float(seen.max()), float(np.quantile(seen, _USUAL))
    return {"zmin": 0.0, "zmax": usual} if 0.0 < 2.0 * usual < most else {}


def _periods(found: Any, x: Any, y: Any) -> dict[str, Any]:
    edges = np.linspace(0.0, 1.0, len(_PERIODS) + 1)
    scale = [[float(e), c] for n, (_, c) in enumerate(_PERIODS) for e in edges[n : n + 2]]
    ticks = {"tickvals": list(range(len(_PERIODS))), "ticktext": [word for word, _ in _PERIODS]}
    return _heat(
        x, y, _class(found), "period %{customdata[0]}, %{customdata[1]}", zmin=-0.5,
        zmax=len(_PERIODS) - 0.5, colorscale=scale, colorbar=ticks,
        customdata=np.dstack((found.period.T, found.verdict.T)),
    )  # fmt: skip


def _title(found: Any) -> str:
    if lost := int(found.ran_away.sum()):
        verb = "grows" if lost == 1 else "grow"
        return f"{lost} of {found.rms.size} motions {verb} beyond all bounds"
    seen = found.finished & np.isfinite(found.rms)
    if not seen.any():
        return "No motion is finished"
    irregular = float(np.mean(found.period[seen] != 1))
    loss = float(np.mean(found.contact_loss_share[seen] > 0.0))
    if irregular == 0.0 and loss == 0.0:
        return "Every motion repeats with the mesh, and the teeth never part"
    if irregular == 0.0:
        return f"The teeth part in {100.0 * loss:.0f} % of the map; all of it repeats with the mesh"
    return (
        f"The teeth part in {100.0 * loss:.0f} % of the map, and {100.0 * irregular:.0f} % does "
        "not repeat with the mesh"
    )


@drawing(
    "parameter_map",
    heading="Map over two parameters",
    caption="After how many mesh cycles the motion repeats, how much the mesh vibrates and how "
    "long the teeth are apart, over two parameters. Each motion starts by itself: where several "
    "exist, another start may show another one.",
    needs=_missing,
)
def parameter_map(found: Any) -> Any:
    """Draw period, rms and contact loss.

    Parameters
    ----------
    found : ParameterMap
        What :func:`tribodyn.analysis.parameter_map` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    x, x_label = parameter_axis(found.names[0], found.first, found.units[0])
    y, y_label = parameter_axis(found.names[1], found.second, found.units[1])
    factor, unit = scaled(found.rms, unit_of(found.signal))
    loss, rms = 100.0 * found.contact_loss_share, factor * found.rms
    maps = [
        ("Period [mesh cycles]", _periods(found, x, y)),
        (f"Rms [{unit}]", _heat(x, y, rms, f"rms %{{z:.4g}} {unit}", **_range(rms))),
        ("Contact loss [%]", _heat(x, y, loss, "apart for %{z:.3g} % of the time")),
    ]
    rows = [Row(x_label, Panel(y_label, [trace], height=1.25)) for _, trace in maps]
    made = separate(_title(found), rows, {"hovermode": "closest"})
    for number, (words, _) in enumerate(maps):
        low, high = made.layout[f"yaxis{number + 1 if number else ''}"].domain
        bar = made.data[number].colorbar
        bar.update(
            y=0.5 * (low + high), len=high - low, thickness=14, x=1.01, xanchor="left",
            title={"text": words, "side": "right", "font": {"size": 13}}, outlinewidth=0,
        )  # fmt: skip
    return made
