"""Planes of two parameters or of two coordinates of the start, coloured by the motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.look.labels import (
    axis_label,
    displayed,
    parameter_axis,
    scaled,
    significant,
    unit_of,
)
from tribodyn.plot.look.panels import Panel, Row, stack_rows
from tribodyn.plot.look.style import PAIR_COLORS, PINION, WHEEL, figure

if TYPE_CHECKING:
    from tribodyn.analysis import Basins, ParameterMap
    from tribodyn.types import Array

#: Colours of the attractors in the order of their shares; more of them begin anew.
_COLORS = (PINION, PAIR_COLORS[3], PAIR_COLORS[0], PAIR_COLORS[1], PAIR_COLORS[2], WHEEL)
_NOWHERE = "#d5dae0"
#: Words and colours of the periods; the last one is for motions without bounds.
_PERIODS = (
    ("1", "#eef3f7"),
    ("2", PINION),
    ("3", PAIR_COLORS[0]),
    ("4", PAIR_COLORS[2]),
    ("5 to 16", PAIR_COLORS[3]),
    ("none", WHEEL),
    ("ran away", "#8a94a0"),
)
#: From little to much.
_SCALE = [[0.0, "#f7fbff"], [0.35, "#9ecae1"], [0.7, "#3182bd"], [1.0, "#08306b"]]
#: Part of the motions whose rms the colours tell apart where the rest lies far beyond.
_USUAL = 0.98


def _name(plane: Basins, number: int, factor: float, unit: str) -> str:
    each = plane.attractors[number]
    kind = f"period {each.period}" if each.period else "does not repeat"
    size = significant(factor * each.rms)
    return f"{kind}, rms {size} {unit}: {100.0 * each.share:.1f} %"


def _stepped(colors: Sequence[str]) -> list[list[Any]]:
    """Scale of colours in steps of one colour each."""
    edges = np.linspace(0.0, 1.0, len(colors) + 1)
    return [[float(e), c] for n, c in enumerate(colors) for e in edges[n : n + 2]]


def _plane(plane: Basins, x: Any, y: Any) -> dict[str, Any]:
    """Heat map of the numbers of the attractors, in steps of one colour each."""
    count = len(plane.attractors)
    colors = [_NOWHERE, *(_COLORS[n % len(_COLORS)] for n in range(count))]
    scale = _stepped(colors)
    words = ["no attractor", *(f"attractor {n + 1}" for n in range(count))]
    label = np.clip(plane.attractor, -1, None).T
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


def _component(plane: Basins, number: int, axis: int) -> Any:
    """Component of the states of an attractor along an axis of the plane."""
    each, name = plane.attractors[number], plane.coordinates[axis]
    if each.section is not None:
        return each.section[:, axis]
    base, velocity = name.removesuffix("_velocity"), name.endswith("_velocity")
    column = plane.names.index(base)
    return (each.velocity if velocity else each.position)[:, column]


def _plane_axis(name: str, values: Any, unit: str) -> tuple[Array, str]:
    """Values along an axis as they are drawn, and its label."""
    if name in QUANTITIES:
        return displayed(name, values), axis_label(name)
    return parameter_axis(name, values, unit)


def _ratio(drawn: Array, values: Any) -> float:
    """Factor between the values of an axis and what is drawn."""
    largest = int(np.argmax(np.abs(values)))
    return float(drawn[largest] / values[largest]) if values[largest] else 1.0


@drawing(
    "basins",
    heading="Basins of attraction",
    caption="Every start of the plane has the colour of the motion that it comes to; crosses "
    "are the states of these motions at the mesh phase 0. Where colours mix finely, the motion "
    "cannot be foretold from the start.",
    of="Basins",
    made_by="Call tribodyn.analysis.basins(...) and its plot method.",
)
def basins(plane: Basins) -> Any:
    """Draw the plane of starts."""
    one, two = plane.coordinates
    x, x_label = _plane_axis(one, plane.first, plane.units[0])
    y, y_label = _plane_axis(two, plane.second, plane.units[1])
    factors = [_ratio(d, v) for d, v in ((x, plane.first), (y, plane.second))]
    factor, unit = scaled([each.rms for each in plane.attractors], unit_of(plane.signal))
    traces = [_plane(plane, x, y)]
    for number in range(len(plane.attractors)):
        color = _COLORS[number % len(_COLORS)]
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "x": factors[0] * _component(plane, number, 0),
                "y": factors[1] * _component(plane, number, 1),
                "name": _name(plane, number, factor, unit),
                "marker": {
                    "symbol": "x",
                    "size": 11,
                    "color": color,
                    "line": {"color": "white", "width": 1.5},
                },
            }
        )
    if plane.unresolved:
        words = f"no attractor: {100.0 * plane.unresolved:.2g} %"
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "x": [None],
                "y": [None],
                "name": words,
                "marker": {"symbol": "square", "size": 11, "color": _NOWHERE},
            }
        )
    layout = {
        "xaxis": {"title": {"text": x_label}, "range": [float(x[0]), float(x[-1])]},
        "yaxis": {"title": {"text": y_label}, "range": [float(y[0]), float(y[-1])]},
        "hovermode": "closest",
        "height": 620,
        "legend": {"orientation": "h", "x": 0.0, "y": -0.14, "yanchor": "top"},
    }
    return figure(_basin_title(plane), traces, layout)


def _basin_title(plane: Basins) -> str:
    count = len(plane.attractors)
    if not count:
        return "No start comes to a motion that repeats"
    if count == 1:
        return "All starts come to the same motion"
    first = plane.attractors[0]
    factor, unit = scaled([each.rms for each in plane.attractors], unit_of(plane.signal))
    return (
        f"{count} motions are possible; {100.0 * first.share:.0f} % of the starts come to the one "
        f"of {significant(factor * first.rms)} {unit} rms"
    )


def _class(survey: ParameterMap) -> Any:
    """Number of the colour of every motion; NaN where there is none yet."""
    period = survey.period
    number = np.select(
        [~np.isfinite(survey.rms), period == 0, period > 4], [6.0, 5.0, 4.0], period - 1.0
    )
    return np.where(survey.finished, number, np.nan)


def _heat(x: Any, y: Any, z: Any, words: str, **more: Any) -> dict[str, Any]:
    return {
        "type": "heatmap",
        "x": x,
        "y": y,
        "z": np.asarray(z).T,
        "colorscale": _SCALE,
        "hovertemplate": f"%{{x:.5g}}, %{{y:.4g}}: {words}<extra></extra>",
        "showlegend": False,
        **more,
    }


def _range(rms: Any) -> dict[str, float]:
    """Ends of the colours: a few motions far beyond the others do not take them all."""
    seen = rms[np.isfinite(rms)]
    if not seen.size:
        return {}
    most, usual = float(seen.max()), float(np.quantile(seen, _USUAL))
    return {"zmin": 0.0, "zmax": usual} if 0.0 < 2.0 * usual < most else {}


def _periods(survey: ParameterMap, x: Any, y: Any) -> dict[str, Any]:
    scale = _stepped([color for _, color in _PERIODS])
    ticks = {"tickvals": list(range(len(_PERIODS))), "ticktext": [word for word, _ in _PERIODS]}
    return _heat(
        x,
        y,
        _class(survey),
        "period %{customdata[0]}, %{customdata[1]}",
        zmin=-0.5,
        zmax=len(_PERIODS) - 0.5,
        colorscale=scale,
        colorbar=ticks,
        customdata=np.dstack((survey.period.T, survey.verdict.T)),
    )


def _map_title(survey: ParameterMap) -> str:
    if lost := int(survey.ran_away.sum()):
        verb = "grows" if lost == 1 else "grow"
        return f"{lost} of {survey.rms.size} motions {verb} beyond all bounds"
    seen = survey.finished & np.isfinite(survey.rms)
    if not seen.any():
        return "No motion is finished"
    irregular = float(np.mean(survey.period[seen] != 1))
    loss = float(np.mean(survey.contact_loss_share[seen] > 0.0))
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
def parameter_map(survey: ParameterMap) -> Any:
    """Draw period, rms and contact loss."""
    x, x_label = parameter_axis(survey.names[0], survey.first, survey.units[0])
    y, y_label = parameter_axis(survey.names[1], survey.second, survey.units[1])
    factor, unit = scaled(survey.rms, unit_of(survey.signal))
    loss, rms = 100.0 * survey.contact_loss_share, factor * survey.rms
    maps = [
        ("Period [mesh cycles]", _periods(survey, x, y)),
        (f"Rms [{unit}]", _heat(x, y, rms, f"rms %{{z:.4g}} {unit}", **_range(rms))),
        ("Contact loss [%]", _heat(x, y, loss, "apart for %{z:.3g} % of the time")),
    ]
    rows = [Row(x_label, Panel(y_label, [trace], height=1.25)) for _, trace in maps]
    made = stack_rows(_map_title(survey), rows, {"hovermode": "closest"})
    for number, (words, _) in enumerate(maps):
        low, high = made.layout[f"yaxis{number + 1 if number else ''}"]["domain"]
        made.data[number]["colorbar"] = {
            **made.data[number].get("colorbar", {}),
            "y": 0.5 * (low + high),
            "len": high - low,
            "thickness": 14,
            "x": 1.01,
            "xanchor": "left",
            "title": {"text": words, "side": "right", "font": {"size": 13}},
            "outlinewidth": 0,
        }
    return made
