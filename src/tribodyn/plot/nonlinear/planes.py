"""Planes of two parameters or of two coordinates of the start, coloured by the motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.look.labels import parameter_axis, scaled, significant, unit_of
from tribodyn.plot.look.panels import Panel, Row, stack_rows
from tribodyn.plot.look.style import PAIR_COLORS, PINION, WHEEL, figure

if TYPE_CHECKING:
    from tribodyn.analysis import Basins, ParameterMap

#: Colours of the attractors in the order of their shares; more of them begin anew.
_COLORS = (PINION, PAIR_COLORS[3], PAIR_COLORS[0], PAIR_COLORS[1], PAIR_COLORS[2], WHEEL)
_NOWHERE = "#d5dae0"
#: Words and colours of the periods; the last one is for motions without bounds.
_PERIODS = (
    ("1", "#eef3f7"), ("2", PINION), ("3", PAIR_COLORS[0]), ("4", PAIR_COLORS[2]),
    ("5 to 16", PAIR_COLORS[3]), ("none", WHEEL), ("ran away", "#8a94a0"),
)  # fmt: skip
#: From little to much.
_SCALE = [[0.0, "#f7fbff"], [0.35, "#9ecae1"], [0.7, "#3182bd"], [1.0, "#08306b"]]
#: Part of the motions whose rms the colours tell apart where the rest lies far beyond.
_USUAL = 0.98


def _name(found: Basins, number: int, factor: float, unit: str) -> str:
    each = found.attractors[number]
    kind = f"period {each.period}" if each.period else "does not repeat"
    size = significant(factor * each.rms)
    return f"{kind}, rms {size} {unit}: {100.0 * each.share:.1f} %"


def _plane(found: Basins, x: Any, y: Any) -> dict[str, Any]:
    """Heat map of the numbers of the attractors, in steps of one colour each."""
    count = len(found.attractors)
    colors = [_NOWHERE, *(_COLORS[n % len(_COLORS)] for n in range(count))]
    edges = np.linspace(0.0, 1.0, len(colors) + 1)
    scale = [[float(e), c] for n, c in enumerate(colors) for e in edges[n : n + 2]]
    words = ["no attractor", *(f"attractor {n + 1}" for n in range(count))]
    label = np.clip(found.attractor, -1, None).T
    return {
        "type": "heatmap",
        "x": x,
        "y": y,
        "z": label,
        "zmin": -1.5,
        "zmax": count - 0.5,
        "colorscale": scale,
        "showscale": False,
        "opacity": 0.85,
        "text": np.array(words)[label + 1],
        "hovertemplate": "%{x:.4g}, %{y:.4g}: %{text}<extra></extra>",
        "showlegend": False,
    }


def _component(found: Basins, number: int, name: str) -> Any:
    """Component of the states of an attractor; ``found`` has names of coordinates only."""
    each = found.attractors[number]
    base, velocity = name.removesuffix("_velocity"), name.endswith("_velocity")
    column = found.names.index(base)
    return (each.velocity if velocity else each.position)[:, column]


@drawing(
    "basins",
    heading="Basins of attraction",
    caption="Every start of the plane has the colour of the motion that it comes to; crosses "
    "are the states of these motions at the mesh phase 0. Where colours mix finely, the motion "
    "cannot be foretold from the start.",
    of="Basins",
    made_by="Call tribodyn.analysis.basins(...) and its plot method.",
)
def basins(found: Basins) -> Any:
    """Draw the plane of starts.

    Parameters
    ----------
    found : Basins
        What :func:`tribodyn.analysis.basins` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    one, two = found.coordinates
    x, x_label = parameter_axis(one, found.first, found.units[0])
    y, y_label = parameter_axis(two, found.second, found.units[1])
    factors = [
        float(d[-1] / v[-1]) if v[-1] else 1.0 for d, v in ((x, found.first), (y, found.second))
    ]
    factor, unit = scaled([each.rms for each in found.attractors], unit_of(found.signal))
    traces = [_plane(found, x, y)]
    for number in range(len(found.attractors)):
        color = _COLORS[number % len(_COLORS)]
        traces.append({
            "type": "scatter", "mode": "markers",
            "x": factors[0] * _component(found, number, one),
            "y": factors[1] * _component(found, number, two),
            "name": _name(found, number, factor, unit),
            "marker": {
                "symbol": "x", "size": 11, "color": color,
                "line": {"color": "white", "width": 1.5},
            },
        })  # fmt: skip
    if found.unresolved:
        words = f"no attractor: {100.0 * found.unresolved:.2g} %"
        traces.append({
            "type": "scatter", "mode": "markers", "x": [None], "y": [None], "name": words,
            "marker": {"symbol": "square", "size": 11, "color": _NOWHERE},
        })  # fmt: skip
    layout = {
        "xaxis": {"title": {"text": x_label}, "range": [float(x[0]), float(x[-1])]},
        "yaxis": {"title": {"text": y_label}, "range": [float(y[0]), float(y[-1])]},
        "hovermode": "closest",
        "height": 620,
        "legend": {"orientation": "h", "x": 0.0, "y": -0.14, "yanchor": "top"},
    }  # fmt: skip
    return figure(_basin_title(found), traces, layout)


def _basin_title(found: Basins) -> str:
    count = len(found.attractors)
    if not count:
        return "No start comes to a motion that repeats"
    if count == 1:
        return "All starts come to the same motion"
    first = found.attractors[0]
    factor, unit = scaled([each.rms for each in found.attractors], unit_of(found.signal))
    return (
        f"{count} motions are possible; {100.0 * first.share:.0f} % of the starts come to the one "
        f"of {significant(factor * first.rms)} {unit} rms"
    )


def _class(found: ParameterMap) -> Any:
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


def _periods(found: ParameterMap, x: Any, y: Any) -> dict[str, Any]:
    edges = np.linspace(0.0, 1.0, len(_PERIODS) + 1)
    scale = [[float(e), c] for n, (_, c) in enumerate(_PERIODS) for e in edges[n : n + 2]]
    ticks = {"tickvals": list(range(len(_PERIODS))), "ticktext": [word for word, _ in _PERIODS]}
    return _heat(
        x, y, _class(found), "period %{customdata[0]}, %{customdata[1]}", zmin=-0.5,
        zmax=len(_PERIODS) - 0.5, colorscale=scale, colorbar=ticks,
        customdata=np.dstack((found.period.T, found.verdict.T)),
    )  # fmt: skip


def _map_title(found: ParameterMap) -> str:
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
    of="ParameterMap",
    made_by="Call tribodyn.analysis.parameter_map(...) and its plot method.",
)
def parameter_map(found: ParameterMap) -> Any:
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
    made = stack_rows(_map_title(found), rows, {"hovermode": "closest"})
    for number, (words, _) in enumerate(maps):
        low, high = made.layout[f"yaxis{number + 1 if number else ''}"].domain
        bar = made.data[number].colorbar
        bar.update(
            y=0.5 * (low + high), len=high - low, thickness=14, x=1.01, xanchor="left",
            title={"text": words, "side": "right", "font": {"size": 13}}, outlinewidth=0,
        )  # fmt: skip
    return made
