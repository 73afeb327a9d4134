"""Phase portrait, Poincare section and Lyapunov exponents of one response."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.errors import InputError
from tribodyn.plot.theme.colors import FILLS, MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import scaled, unit_of
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import Trace, axis, dots, line, plane_figure

if TYPE_CHECKING:
    from tribodyn.analysis import LyapunovExponents, PhasePortrait, PoincareSection

#: Number of exponents in the plot, largest first.
_MAX_CURVES = 3
_COLORS = (PINION, WHEEL, PAIR_COLORS[0])
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
    caption="The state once per mesh cycle, at mesh phase 0. A periodic response has as "
    "many points as its period has mesh cycles, a quasi-periodic one a closed curve, a chaotic "
    "one a cloud with inner structure.",
    of="PoincareSection",
    made_by="Call tribodyn.analysis.poincare(...) and its plot method.",
)
def poincare(section: PoincareSection, coordinate: int | str = 0) -> Sketch:
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
        what, why = f'no coordinate is called "{coordinate}"', f"There are {', '.join(names)}"
        raise InputError(what, "argument coordinate", why, "Choose one of these")
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
        color = _COLORS[number]
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
