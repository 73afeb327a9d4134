"""Basins of attraction, and maps of the response over two parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.theme.colors import PAIR_COLORS, PINION, WHEEL
from tribodyn.plot.theme.labels import (
    axis_label,
    displayed,
    parameter_axis,
    scaled,
    significant,
    unit_of,
)
from tribodyn.plot.theme.panels import Panel, Row, stack_rows
from tribodyn.plot.theme.style import Trace, axis, dots, heat, plane_figure

if TYPE_CHECKING:
    from tribodyn.analysis import Basins, ParameterMap
    from tribodyn.types import Array

#: Colours of the attractors in the order of their shares, repeated if there are more.
_COLORS = (PINION, PAIR_COLORS[3], PAIR_COLORS[0], PAIR_COLORS[1], PAIR_COLORS[2], WHEEL)
_NOWHERE = "#d5dae0"
#: Labels and colours of the periods; the last is for unbounded responses.
_PERIODS = (
    ("1", "#eef3f7"),
    ("2", PINION),
    ("3", PAIR_COLORS[0]),
    ("4", PAIR_COLORS[2]),
    ("5 to 16", PAIR_COLORS[3]),
    ("none", WHEEL),
    ("ran away", "#8a94a0"),
)
#: Colours from small to large values.
_SCALE = [[0.0, "#f7fbff"], [0.35, "#9ecae1"], [0.7, "#3182bd"], [1.0, "#08306b"]]
#: Quantile of the rms at which the colour scale ends if outliers are far above it.
_USUAL = 0.98


def _name(plane: Basins, number: int, factor: float, unit: str) -> str:
    each = plane.attractors[number]
    kind = f"period {each.period}" if each.period else "not periodic"
    size = significant(factor * each.rms)
    return f"{kind}, rms {size} {unit}: {100.0 * each.share:.1f} %"


def _stepped(colors: Sequence[str]) -> list[list[Any]]:
    """Stepwise colour scale."""
    edges = np.linspace(0.0, 1.0, len(colors) + 1)
    return [[float(e), c] for n, c in enumerate(colors) for e in edges[n : n + 2]]


def _plane(plane: Basins, x: object, y: object) -> Trace:
    """Heat map of the attractor numbers with a stepwise colour scale."""
    count = len(plane.attractors)
    colors = [_NOWHERE, *(_COLORS[n % len(_COLORS)] for n in range(count))]
    scale = _stepped(colors)
    texts = ["no attractor", *(f"attractor {n + 1}" for n in range(count))]
    label = np.clip(plane.attractor, -1, None).T
    names = np.array(texts)[label + 1]
    hover, ends = "%{x:.4g}, %{y:.4g}: %{text}", {"zmin": -1.5, "zmax": count - 0.5}
    return heat(x, y, label, scale, hover, showscale=False, opacity=0.85, text=names, **ends)


def _component(plane: Basins, number: int, axis: int) -> Any:
    """Values of a coordinate or velocity of the plane at the states of an attractor."""
    each, name = plane.attractors[number], plane.coordinates[axis]
    if each.section is not None:
        return each.section[:, axis]
    base, velocity = name.removesuffix("_velocity"), name.endswith("_velocity")
    column = plane.names.index(base)
    return (each.velocity if velocity else each.position)[:, column]


def _states(x: object, y: object, name: str, **marker: object) -> Trace:
    """Marks of states with a name in the legend."""
    return dots(x, y, name, {"size": 11, **marker})


def _plane_axis(name: str, values: object, unit: str) -> tuple[Array, str]:
    """Values along an axis in its display unit, and its label."""
    if name in QUANTITIES:
        return displayed(name, values), axis_label(name)
    return parameter_axis(name, values, unit)


def _display_factor(displayed_values: Array, values: Any) -> float:
    """Factor from the SI values of an axis to their display unit."""
    largest = int(np.argmax(np.abs(values)))
    return float(displayed_values[largest] / values[largest]) if values[largest] else 1.0


@drawing(
    heading="Basins of attraction",
    caption="The colour of an initial state is that of the attractor that it reaches; crosses "
    "are the states of the attractors at mesh phase 0. Where colours mix finely, the attractor "
    "cannot be predicted from the initial state.",
    of="Basins",
    made_by="Call tribodyn.analysis.basins(...) and its plot method.",
)
def basins(plane: Basins) -> Sketch:
    """Draw the plane of initial states coloured by attractor."""
    first, second = plane.coordinates
    x, x_label = _plane_axis(first, plane.first, plane.units[0])
    y, y_label = _plane_axis(second, plane.second, plane.units[1])
    factors = [_display_factor(d, v) for d, v in ((x, plane.first), (y, plane.second))]
    factor, unit = scaled([each.rms for each in plane.attractors], unit_of(plane.signal))
    traces = [_plane(plane, x, y)]
    for number in range(len(plane.attractors)):
        x_states, y_states = (factors[k] * _component(plane, number, k) for k in (0, 1))
        marker: Trace = {"symbol": "x", "line": {"color": "white", "width": 1.5}}
        marker["color"] = _COLORS[number % len(_COLORS)]
        traces.append(_states(x_states, y_states, _name(plane, number, factor, unit), **marker))
    if plane.unresolved:
        name = f"no attractor: {100.0 * plane.unresolved:.2g} %"
        traces.append(_states([None], [None], name, symbol="square", color=_NOWHERE))
    x_axis, y_axis = (
        axis(label, range=[float(at[0]), float(at[-1])])
        for label, at in ((x_label, x), (y_label, y))
    )
    below = {"orientation": "h", "x": 0.0, "y": -0.14, "yanchor": "top"}
    return plane_figure(_basin_title(plane), traces, x_axis, y_axis, height=620, legend=below)


def _basin_title(plane: Basins) -> str:
    count = len(plane.attractors)
    if not count:
        return "No initial state reaches a periodic orbit"
    if count == 1 and not plane.unresolved:
        return "All initial states reach the same attractor"
    if count == 1:
        share = f"{100.0 * plane.attractors[0].share:.3g} % of the initial states"
        return f"{share} reach the same attractor, the others none"
    first = plane.attractors[0]
    factor, unit = scaled([each.rms for each in plane.attractors], unit_of(plane.signal))
    return (
        f"{count} attractors coexist; {100.0 * first.share:.0f} % of the initial states reach the "
        f"one of {significant(factor * first.rms)} {unit} rms"
    )


def _class(survey: ParameterMap) -> Any:
    """Number of the colour of every motion; NaN where there is none yet."""
    period = survey.period
    number = np.select(
        [~np.isfinite(survey.rms), period == 0, period > 4], [6.0, 5.0, 4.0], period - 1.0
    )
    return np.where(survey.finished, number, np.nan)


def _heat(x: object, y: object, z: object, hover: str, **more: object) -> Trace:
    colors = more.pop("colorscale", _SCALE)
    return heat(x, y, np.asarray(z).T, colors, f"%{{x:.5g}}, %{{y:.4g}}: {hover}", **more)


def _range(rms: Any) -> dict[str, float]:
    """Range of the colour scale, limited to the usual values if outliers are far above."""
    finite = rms[np.isfinite(rms)]
    if not finite.size:
        return {}
    largest, usual = float(finite.max()), float(np.quantile(finite, _USUAL))
    return {"zmin": 0.0, "zmax": usual} if 0.0 < 2.0 * usual < largest else {}


def _periods(survey: ParameterMap, x: object, y: object) -> Trace:
    scale = _stepped([color for _, color in _PERIODS])
    ticks = {"tickvals": list(range(len(_PERIODS))), "ticktext": [text for text, _ in _PERIODS]}
    facts = np.dstack((survey.period.T, survey.verdict.T))
    more = {"zmin": -0.5, "zmax": len(_PERIODS) - 0.5, "colorscale": scale, "colorbar": ticks}
    hover = "period %{customdata[0]}, %{customdata[1]}"
    return _heat(x, y, _class(survey), hover, customdata=facts, **more)


def _map_title(survey: ParameterMap) -> str:
    if lost := int(survey.ran_away.sum()):
        verb = "grows" if lost == 1 else "grow"
        return f"{lost} of {survey.rms.size} responses {verb} without bound"
    finished = survey.finished & np.isfinite(survey.rms)
    if not finished.any():
        return "No run is finished"
    irregular = float(np.mean(survey.period[finished] != 1))
    loss = float(np.mean(survey.contact_loss_share[finished] > 0.0))
    if irregular == 0.0 and loss == 0.0:
        return "Every response has a period of one mesh cycle, without loss of contact"
    if irregular == 0.0:
        return f"Loss of contact in {100.0 * loss:.0f} % of the map; all periods are one mesh cycle"
    return (
        f"Loss of contact in {100.0 * loss:.0f} % of the map; {100.0 * irregular:.0f} % have no "
        "period of one mesh cycle"
    )


@drawing(
    heading="Map over two parameters",
    caption="Period of the response in mesh cycles, rms of the vibration and duration of the loss "
    "of contact, over two parameters. The runs are independent: where several "
    "responses coexist, another initial state may lead to another one.",
    of="ParameterMap",
    made_by="Call tribodyn.analysis.parameter_map(...) and its plot method.",
)
def parameter_map(survey: ParameterMap) -> Sketch:
    """Draw period, rms and contact loss."""
    x, x_label = parameter_axis(survey.names[0], survey.first, survey.units[0])
    y, y_label = parameter_axis(survey.names[1], survey.second, survey.units[1])
    factor, unit = scaled(survey.rms, unit_of(survey.signal))
    loss, rms = 100.0 * survey.contact_loss_share, factor * survey.rms
    maps = [
        ("Period [mesh cycles]", _periods(survey, x, y)),
        (f"Rms [{unit}]", _heat(x, y, rms, f"rms %{{z:.4g}} {unit}", **_range(rms))),
        ("Contact loss [%]", _heat(x, y, loss, "contact lost for %{z:.3g} % of the time")),
    ]
    rows = [Row(x_label, Panel(y_label, [trace], height=1.25)) for _, trace in maps]
    sketch = stack_rows(_map_title(survey), rows, {"hovermode": "closest"})
    for number, (colorbar_title, _) in enumerate(maps):
        low, high = sketch.layout[f"yaxis{number + 1 if number else ''}"]["domain"]
        place = {"y": 0.5 * (low + high), "len": high - low, "x": 1.01, "xanchor": "left"}
        title = {"text": colorbar_title, "side": "right", "font": {"size": 13}}
        bar = {**place, "thickness": 14, "title": title, "outlinewidth": 0}
        sketch.data[number]["colorbar"] = {**sketch.data[number].get("colorbar", {}), **bar}
    return sketch
