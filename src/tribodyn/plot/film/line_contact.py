"""Pressure and film of lubricated line contacts, compared with the dry pressure."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.drawing import Sketch, drawing
from tribodyn.errors import InputError
from tribodyn.plot.theme.colors import INK, MUTED, PAIR_COLORS, TOTAL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.theme.panels import Panel, event_lines, from_zero, stack
from tribodyn.plot.theme.style import Trace, line, marked
from tribodyn.types import Array

#: Upper limit of the film axis in multiples of the thickest central film.
_FILMS = 3.0
#: Pressure relative to the maximum at which the plotted part of a contact begins.
_NOTHING = 0.02
#: Most nodes of a curve, for a single contact and for each of several.
_MOST = 2000
_FEWER = 1000
_COLORS = (*PAIR_COLORS, INK)
#: Dashes with short gaps, so that no gap hides a pressure spike [px].
_DASHES = ("solid", "9px,3px", "9px,3px,2px,3px", "16px,3px", "3px,2px", "16px,3px,3px,3px")


@dataclass(frozen=True)
class Scales:
    """Factors and labels that turn the results of a contact into axis values."""

    position: float
    pressure: float
    film: float
    position_label: str
    pressure_label: str
    film_label: str
    pressure_unit: str
    film_unit: str

    def film_text(self, film: float, digits: int = 3) -> str:
        """Write a film with its unit."""
        return f"{significant(self.film * film, digits)} {self.film_unit}"

    def pressure_text(self, pressure: float) -> str:
        """Write a pressure with its unit."""
        return f"{significant(self.pressure * pressure)} {self.pressure_unit}"


def _unitless(solution: Any) -> Scales:
    b, p, h = solution.half_width, solution.hertz_pressure, solution.film_unit
    labels = ("Position [b]", "Pressure [p<sub>h</sub>]", "Film [b²/R]")
    return Scales(1.0 / b, 1.0 / p, 1.0 / h, *labels, "p<sub>h</sub>", "b²/R")


def _metric() -> Scales:
    names = {"half_width": "Position", "hertz_pressure": "Pressure", "film_thickness": "Film"}
    b, p, h = (float(displayed(name, 1.0)) for name in names)
    position, pressure, film = (axis_label(*each) for each in names.items())
    units = (display_unit("hertz_pressure"), display_unit("film_thickness"))
    return Scales(b, p, h, position, pressure, film, *units)


def contact_scales(solutions: Sequence[Any], dimensionless: bool) -> list[Scales]:
    """Choose the units for contacts that share their axes."""
    if not solutions:
        why, remedy = "The sequence is empty", "Give at least one solution of solve_line_contact"
        raise InputError("there is no contact to draw", "argument solutions", why, remedy)
    if not all(hasattr(solution, "lubricant") for solution in solutions):
        why = "Solutions of line contacts have pressure, film and lubricant"
        remedy = "Give what solve_line_contact returns"
        raise InputError("not every entry is a contact", "argument solutions", why, remedy)
    bare = [solution.lubricant is None for solution in solutions]
    if any(bare) and not all(bare) and not dimensionless:
        what = f"{sum(bare)} of {len(bare)} contacts have no unit, the others have"
        why = "solve_line_contact_moes gives numbers without unit, which fit no common axis"
        raise InputError(what, "argument solutions", why, "Set dimensionless=True")
    if dimensionless or all(bare):
        return [_unitless(solution) for solution in solutions]
    return [_metric()] * len(solutions)


def dry_pressure(solution: Any, points: int = 101) -> tuple[Array, Array]:
    """Pressure of Hertz in the dry contact, ``p = p_h sqrt(1 - (x/b)^2)``."""
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, points)
    pressure = np.maximum(np.cos(angle), 0.0)
    return solution.half_width * np.sin(angle), solution.hertz_pressure * pressure


def place_of_minimum(solution: Any) -> float:
    """Position of the least film between inlet and outlet."""
    filled = solution.position <= solution.outlet
    return float(solution.position[filled][np.argmin(solution.film[filled])])


def window(solution: Any) -> tuple[float, float]:
    """Range of the position axis that shows the loaded part of the contact."""
    position, pressure, half = solution.position, solution.pressure, solution.half_width
    loaded = position[pressure > _NOTHING * pressure.max()]
    left = max(float(loaded[0]) - 0.1 * half, float(position[0]))
    right = min(float(solution.outlet) + 0.4 * half, float(position[-1]))
    return min(left, -1.5 * half), max(right, 1.4 * half)


def film_height(solutions: Sequence[Any], scales: Sequence[Scales]) -> float:
    """Upper end of the film axis for several contacts, in its display unit."""
    pairs = zip(solutions, scales, strict=True)
    return float(_FILMS * max(scale.film * solution.central_film for solution, scale in pairs))


def thinned(solution: Any, points: int) -> NDArray[np.intp]:
    """Indices of nodes that preserve the shape and the extrema of pressure and film."""
    n = len(solution.position)
    if n <= points:
        return np.arange(n)
    # The open gap outside the film is not plotted.
    film = np.minimum(solution.film / solution.central_film, _FILMS) / _FILMS
    curves = np.stack((solution.pressure / solution.pressure.max(), film))
    bend = np.zeros(n)
    bend[1:-1] = np.max(np.abs(np.diff(curves, 2)), axis=0)
    density = np.sqrt(bend)
    density += 0.15 * np.mean(density) + 1e-300
    cumulative = np.concatenate(([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))))
    slopes = np.sign(np.diff(curves))
    turns = 1 + np.flatnonzero(np.any(slopes[:, 1:] != slopes[:, :-1], axis=0))
    turns = turns[np.argsort(bend[turns])[::-1][: points // 4]]
    even = np.linspace(0.0, cumulative[-1], points - len(turns) - 2)
    chosen = np.searchsorted(cumulative, even * (1.0 - 1e-15)).clip(0, n - 1)
    return np.unique(np.concatenate((chosen, turns, [0, n - 1])))


def curve(x: Any, y: Any, name: str, color: str, **more: Any) -> Trace:
    """Describe a curve with all its points: a pressure spike has few of them."""
    described = line(x, y, name, color, **more)
    described["line"]["simplify"] = False
    return described


def point(
    x: float, y: float, name: str, color: str, *, unit: str = "", symbol: str = "circle"
) -> Trace:
    """Describe one marked point with a name in the legend."""
    mark = marked([x], [y], name, color, 9, symbol, unit=unit)
    return {**mark, "marker": {**mark["marker"], "line": {"color": color, "width": 2}}}


def _profile(
    solution: Any, quantity: str, scales: Scales, points: int, name: str, color: str, **more: object
) -> Trace:
    """Curve of pressure or film over the position, thinned to ``points`` nodes."""
    nodes = thinned(solution, points)
    x = scales.position * solution.position[nodes]
    y = getattr(scales, quantity) * getattr(solution, quantity)[nodes]
    return curve(x, y, name, color, unit=getattr(scales, f"{quantity}_unit"), **more)


def _pressure(solution: Any, scales: Scales) -> list[Trace]:
    unit = scales.pressure_unit
    x, y = dry_pressure(solution)
    x, y = scales.position * x, scales.pressure * y
    traces = [
        _profile(solution, "pressure", scales, _MOST, "oil film", TOTAL),
        line(x, y, "dry (Hertz)", MUTED, unit=unit, dash="dash"),
    ]
    if solution.spike_position is not None:
        name = f"spike {scales.pressure_text(solution.spike_pressure)}<br>(rises with the grid)"
        x, y = scales.position * solution.spike_position, scales.pressure * solution.spike_pressure
        traces.append(point(x, y, name, PAIR_COLORS[1], unit=unit, symbol="diamond-open"))
    return traces


def _film(solution: Any, scales: Scales) -> list[Trace]:
    unit = scales.film_unit
    marks = (
        ("central", 0.0, solution.central_film, "circle-open"),
        ("minimum", place_of_minimum(solution), solution.minimum_film, "circle"),
    )
    places = [
        point(scales.position * x, scales.film * film, f"{name} {scales.film_text(film, 4)}",
              PAIR_COLORS[0], unit=unit, symbol=symbol)
        for name, x, film, symbol in marks
    ]  # fmt: skip
    return [_profile(solution, "film", scales, _MOST, "film", TOTAL), *places]


@drawing(
    heading="Pressure and film of a line contact",
    of="LineContactSolution",
    made_by="Call tribodyn.ehl.solve_line_contact and its plot method.",
)
def line_contact(solution: Any, *, dimensionless: bool = False) -> Sketch:
    """Draw pressure and film of a line contact over the position, the inlet on the left.

    Pressure and film over the position, the inlet on the left. The film narrows before its outlet;
    the dashed curve is the pressure of the dry contact under the same load.

    Parameters
    ----------
    solution : LineContactSolution
        What :func:`tribodyn.ehl.solve_line_contact` returns.
    dimensionless : bool
        Whether positions are drawn in half widths, pressures in Hertz pressures and films in
        ``b^2/R`` instead of um, GPa and um.

    Returns
    -------
    plotly.graph_objects.Figure
        Both curves with the pressure of the dry contact, the central and the minimum film, and
        the outlet, where the oil film ruptures. The view is the loaded part; zoom out for the
        entire domain.
    """
    (scales,) = contact_scales([solution], dimensionless)
    center, least = (
        scales.film_text(film) for film in (solution.central_film, solution.minimum_film)
    )
    view = {"range": [0.0, film_height([solution], [scales])]}
    marks = event_lines([("centre", 0.0), ("outlet", scales.position * solution.outlet)])
    panels = [
        from_zero(scales.pressure_label, _pressure(solution, scales)),
        Panel(scales.film_label, _film(solution, scales), view),
    ]
    title = f"The film is {center} thick in the centre and {least} at its thinnest"
    axis = {"range": list(scales.position * np.array(window(solution)))}
    return stack(title, scales.position_label, panels, {"xaxis": axis, **marks})


def _style(number: int) -> Trace:
    """Colour and dash of a contact; the first thirty combinations are unique."""
    return {"color": _COLORS[number % len(_COLORS)], "dash": _DASHES[number % len(_DASHES)]}


def _checked(solutions: Iterable[object], labels: Iterable[str]) -> tuple[list[Any], list[str]]:
    contacts, names = list(solutions), [str(label) for label in labels]
    if len(contacts) != len(names):
        what = f"{len(contacts)} contacts and {len(names)} labels"
        why = "Each contact has one name in the legend"
        raise InputError(what, "argument labels", why, "Give as many labels as solutions")
    return contacts, names


def _pressures(rows: Sequence[tuple[object, Scales, str]]) -> list[Trace]:
    traces = []
    for number, (solution, scales, name) in enumerate(rows):
        x, y = dry_pressure(solution)
        dry = curve(scales.position * x, scales.pressure * y, "dry", MUTED, dash="dot", width=1.2)
        first = {"name": "dry (Hertz)", "legendgroup": "dry", "showlegend": number == 0}
        # In dimensionless axes the dry pressure is the same for all contacts.
        if number == 0 or scales.pressure == rows[0][1].pressure:
            traces.append({**dry, **first, "hoverinfo": "skip", "hovertemplate": None})
        traces.append(_profile(solution, "pressure", scales, _FEWER, name, **_style(number)))
    return traces


def _films(rows: Sequence[tuple[Any, Scales, str]]) -> list[Trace]:
    traces, marks = [], []
    for number, (solution, scales, name) in enumerate(rows):
        style = _style(number)
        least = f"{name}: at least {scales.film_text(solution.minimum_film)}"
        traces.append(_profile(solution, "film", scales, _FEWER, least, **style))
        x, y = scales.position * place_of_minimum(solution), scales.film * solution.minimum_film
        mark = point(x, y, name, style["color"])
        marks.append({**mark, "showlegend": False, "hoverinfo": "skip", "hovertemplate": None})
    return traces + marks


def compare_line_contacts(
    solutions: Iterable[object], labels: Iterable[str], *, dimensionless: bool = False
) -> Any:
    """Draw pressure and film of several line contacts in the same axes.

    Parameters
    ----------
    solutions : iterable of LineContactSolution
        What :func:`tribodyn.ehl.solve_line_contact` returns, for example over the torque.
    labels : iterable of str
        Name of each contact in the legend.
    dimensionless : bool
        Whether every contact is scaled with its half width, Hertz pressure and ``b^2/R``: then
        shapes are compared, and the place of a spike relative to the contact.

    Returns
    -------
    plotly.graph_objects.Figure
        Dots mark the minimum films, thin dotted curves the dry pressures.

    Raises
    ------
    InputError
        If there is no contact, their number is not that of the labels, or some have units and
        others have not.
    """
    contacts, names = _checked(solutions, labels)
    scales = contact_scales(contacts, dimensionless)
    rows = list(zip(contacts, scales, names, strict=True))
    thinnest, units, name = min(rows, key=lambda row: row[1].film * row[0].minimum_film)
    ends = np.array(
        [[scale.position * end for end in window(contact)] for contact, scale, _ in rows]
    )
    height = {"range": [0.0, film_height(contacts, scales)]}
    panels = [
        from_zero(scales[0].pressure_label, _pressures(rows)),
        Panel(scales[0].film_label, _films(rows), height),
    ]
    title = f"The thinnest film, {units.film_text(thinnest.minimum_film)}, is that of {name}"
    layout = {"xaxis": {"range": [ends[:, 0].min(), ends[:, 1].max()]}}
    return stack(title, scales[0].position_label, panels, layout).figure()
