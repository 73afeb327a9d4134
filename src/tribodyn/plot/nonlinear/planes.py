"""Phase portrait, Poincare section, Lyapunov exponents, basins, and maps over two parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.errors import InputError, no_such
from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.theme.colors import FILLS, MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import (
    axis_label,
    displayed,
    parameter_axis,
    scaled,
    significant,
    unit_of,
)
from tribodyn.plot.theme.panels import Panel, Row, stack, stack_rows
from tribodyn.plot.theme.style import Trace, axis, dots, heat, line, plane_figure

if TYPE_CHECKING:
    from tribodyn.analysis import (
        Basins,
        LyapunovExponents,
        ParameterMap,
        PhasePortrait,
        PoincareSection,
    )
    from tribodyn.types import Array

#: Number of exponents in the plot, largest first.
_MAX_CURVES = 3
_EXPONENT_COLORS = (PINION, WHEEL, PAIR_COLORS[0])
#: Most points of a curve.
_MAX_POINTS = 1500


@drawing(
    heading="Phase portrait",
    caption=lambda portrait: (
        f"Velocity over {'compression of a contact' if portrait.gap >= 0.0 else 'position'}. A "
        "periodic response is a closed curve; the dots are its states at mesh phase 0."
        + " Dashed lines are the limits of the backlash."
        * bool(portrait.gap > 0.0)
    ),
    of="PhasePortrait",
    made_by="Call tribodyn.analysis.phase_portrait(response) and its plot method.",
)
def phase_portrait(portrait: PhasePortrait) -> Sketch:
    """Draw the curve and its points at the mesh phase 0."""
    unit = unit_of(portrait.name)
    x_factor, x_unit = scaled(portrait.position, unit)
    y_factor, y_unit = scaled(portrait.velocity, f"{unit}/s")
    hover = f"%{{x:.5g}} {x_unit}, %{{y:.5g}} {y_unit}<extra></extra>"
    curve = (x_factor * portrait.position, y_factor * portrait.velocity)
    section = (x_factor * portrait.section_position, y_factor * portrait.section_velocity)
    width, size = (1.6, 9) if portrait.period else (0.6, 5)
    traces = [
        line(*curve, "motion", PINION, width=width, hovertemplate=hover),
        dots(*section, "mesh phase 0", {"color": WHEEL, "size": size}, hovertemplate=hover),
    ]
    ends = [side * portrait.gap for side in (-1.0, 1.0)]
    dashed = {"color": MUTED, "dash": "dash", "width": 1}
    upright = {"type": "line", "y0": 0, "y1": 1, "yref": "paper", "line": dashed}
    lines = [
        {**upright, "x0": x_factor * end, "x1": x_factor * end, "name": "backlash limit",
         "showlegend": end > 0.0}
        for end in ends
        if portrait.gap > 0.0 and (end > 0.0 or portrait.position.min() < 0.0)
    ]  # fmt: skip
    x_label = (
        "Compression of the contact" if portrait.gap >= 0.0 else portrait.name.replace("_", " ")
    )
    positions = np.append(portrait.position, [end for end in ends if lines and end > 0.0])
    place = f"{x_label} [{x_unit}]", _around(x_factor * positions)
    speed = f"its velocity [{y_unit}]", _around(y_factor * portrait.velocity)
    return _over_place(_portrait_title(portrait), traces, place, speed, shapes=lines)


def _over_place(
    title: str,
    traces: list[Trace],
    place: tuple[str, list[float]],
    speed: tuple[str, list[float]],
    **more: object,
) -> Sketch:
    """Figure of velocities over positions; each axis has a label and a range."""
    x, y = (axis(label, range=ends) for label, ends in (place, speed))
    return plane_figure(title, traces, x, y, height=560, **more)


def _around(values: Any) -> list[float]:
    """Range with a margin, so that the curve does not touch the frame."""
    low, high = float(np.min(values)), float(np.max(values))
    margin = 0.06 * (high - low) or 1.0
    return [low - margin, high + margin]


def _portrait_title(portrait: PhasePortrait) -> str:
    if portrait.verdict == "step-limited":
        return "The response depends on the time step and is not physical"
    if portrait.period == 1:
        return "Closed orbit with a period of one mesh cycle"
    if portrait.period:
        return f"Closed orbit with a period of {portrait.period} mesh cycles"
    return "The orbit does not close"


def _section_title(section: PoincareSection) -> str:
    if section.verdict == "step-limited":
        return "The response depends on the time step and is not physical"
    if section.period == 1:
        return "Period of one mesh cycle: one point"
    if section.period:
        return f"Period of {section.period} mesh cycles: as many points"
    return "No period of up to 16 mesh cycles"


def _window(values: Any, motion: float) -> list[float]:
    """Axis range that does not magnify the rounding errors of a periodic response."""
    middle = 0.5 * float(values.max() + values.min())
    half = max(0.6 * float(np.ptp(values)), 0.05 * motion, 1e-300)
    return [middle - half, middle + half]


@drawing(
    heading="Poincare section",
    of="PoincareSection",
    made_by="Call tribodyn.analysis.poincare(...) and its plot method.",
)
def poincare(section: PoincareSection, coordinate: int | str = 0) -> Sketch:
    """Draw the points of one coordinate in its phase plane.

    The state once per mesh cycle, at mesh phase 0. A periodic response has as many points as its
    period has mesh cycles, a quasi-periodic one a closed curve, a chaotic one a cloud with inner
    structure.

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
        raise InputError(no_such("coordinate", coordinate, names, "argument coordinate"))
    column = names.index(coordinate) if isinstance(coordinate, str) else coordinate
    name, place, speed = names[column], section.position[:, column], section.velocity[:, column]
    x_factor, x_unit = scaled(place, unit_of(name))
    y_factor, y_unit = scaled(speed, f"{unit_of(name)}/s")
    x, y = x_factor * place, y_factor * speed
    last = section.period or 0
    visible = slice(-last, None) if last else slice(None)
    name_in_legend = "last points" if last else "points"
    marker = {"size": 9 if last else 3.5, "color": PINION if last else TOTAL}
    hover = f"%{{x:.5g}} {x_unit}, %{{y:.5g}} {y_unit}<extra></extra>"
    trace = dots(x[visible], y[visible], name_in_legend, marker, hovertemplate=hover)
    along = f"{name.replace('_', ' ')} [{x_unit}]", _window(x[visible], float(np.abs(x).max()))
    across = f"its velocity [{y_unit}]", _window(y[visible], float(np.abs(y).max()))
    return _over_place(_section_title(section), [trace], along, across)


def _exponent_title(spectrum: LyapunovExponents) -> str:
    value, error = spectrum.largest, spectrum.largest_error
    exponent = f"{value:.4g} 1/s, standard error {error:.1g} 1/s"
    if spectrum.verdict == "step-limited":
        return f"Dependent on the time step, not physical: the largest exponent is {exponent}"
    if spectrum.chaotic:
        return f"Chaotic: the largest exponent is {exponent}"
    return f"Not chaotic: the largest exponent is {exponent}"


@drawing(
    heading="Lyapunov exponents",
    caption=lambda spectrum: (
        "Mean growth rate of a small disturbance up to each mesh cycle. The band is the standard "
        "error of the mean over these cycles, the dotted line the result. A largest exponent that "
        "stays above zero means chaos."
        + " Free rotation of the drive train is not vibration: its exponents are left out."
        * bool(np.any(spectrum.free_rotation))
    ),
    of="LyapunovExponents",
    made_by="Call tribodyn.analysis.lyapunov_exponents(...) and its plot method.",
)
def lyapunov(spectrum: LyapunovExponents) -> Sketch:
    """Draw the running means of the largest exponents."""
    cycles = len(spectrum.growth)
    count = np.arange(1, cycles + 1)
    samples = np.unique(np.linspace(0, cycles - 1, min(cycles, _MAX_POINTS)).astype(int))
    rotation = spectrum.free_rotation
    means = np.cumsum(spectrum.vibrating_growth, axis=0) / count[:, None]
    order = np.argsort(-means[-1])[:_MAX_CURVES]
    errors = spectrum.standard_error[~rotation]
    traces: list[Trace] = []
    x = count[samples]
    for number, column in enumerate(order):
        color = _EXPONENT_COLORS[number]
        mean = means[samples, column]
        band = errors[number] * np.sqrt(cycles / x)
        fill = FILLS.get(color, "rgba(0, 158, 115, 0.14)")
        traces.append({
            "type": "scatter", "x": np.append(x, x[::-1]), "mode": "lines", "fill": "toself",
            "y": np.append(mean + band, (mean - band)[::-1]), "fillcolor": fill,
            "line": {"width": 0}, "hoverinfo": "skip", "showlegend": False,
        })  # fmt: skip
        traces.append(line(x, mean, f"exponent {number + 1}", color, unit="1/s"))
        level = np.full(2, spectrum.vibrating[number])
        dotted = line(x[[0, -1]], level, "result", color, dash="dot", width=1.0)
        traces.append({**dotted, "showlegend": False})
    zero = line(x[[0, -1]], [0.0, 0.0], "zero", MUTED, width=1.0)
    traces.append({**zero, "showlegend": False, "hoverinfo": "skip"})
    for number, value in enumerate(spectrum.exponents[rotation]):
        name = "free rotation, left out"
        mark = line(x[[0, -1]], [value, value], name, MUTED, unit="1/s", dash="dash", width=1.6)
        traces.append({**mark, "showlegend": number == 0})
    late = means[samples][x >= max(1, cycles // 50)][:, order]
    span = np.append(late.ravel(), 0.0)
    margin = 0.1 * float(np.ptp(span)) or 1.0
    limits = {"range": [float(span.min()) - margin, float(span.max()) + margin]}
    panel = Panel("Exponent [1/s]", traces, limits, height=1.6)
    return stack(_exponent_title(spectrum), "Mesh cycles", [panel])


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
    of="Basins",
    made_by="Call tribodyn.analysis.basins(...) and its plot method.",
)
def basins(plane: Basins) -> Sketch:
    """Draw the plane of initial states coloured by attractor.

    The colour of an initial state is that of the attractor that it reaches; crosses are the states
    of the attractors at mesh phase 0. Where colours mix finely, the attractor cannot be predicted
    from the initial state.
    """
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
    of="ParameterMap",
    made_by="Call tribodyn.analysis.parameter_map(...) and its plot method.",
)
def parameter_map(survey: ParameterMap) -> Sketch:
    """Draw period, rms and contact loss.

    Period of the response in mesh cycles, rms of the vibration and duration of the loss of contact,
    over two parameters. The runs are independent: where several responses coexist, another initial
    state may lead to another one.
    """
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
