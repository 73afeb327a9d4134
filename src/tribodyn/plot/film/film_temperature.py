"""Temperatures of a heated line contact: in the film, along both surfaces, and over time."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.film.dynamics import usual_films
from tribodyn.plot.film.line_contact import contact_scales, window
from tribodyn.plot.theme.curves import curves
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import Panel, event_lines, from_zero, stack
from tribodyn.plot.theme.style import MUTED, PAIR_COLORS, TOTAL, Trace, heat, line
from tribodyn.types import Array

#: Levels of the height, and height over the central film up to which it is drawn.
_LEVELS, _HIGHEST = 61, 1.8
_ZERO, _UNIT = 273.15, display_unit("temperature")


def _in_film(solution: Any, inside: Array, position: Array, film_scale: float) -> Trace:
    """Temperature over position and height, empty outside of the film."""
    top = _HIGHEST * solution.central_film
    height = np.linspace(0.0, top, _LEVELS)
    film, temperature = solution.film[inside], solution.film_temperature[inside] - _ZERO
    columns = [
        np.interp(height / thick, solution.height, column, right=np.nan)
        for thick, column in zip(film, temperature, strict=True)
    ]
    bar = {"title": {"text": _UNIT}, "len": 0.5, "y": 0.78, "thickness": 14}
    values, hover = np.array(columns).T, f"%{{z:.1f}} {_UNIT}"
    return heat(position, film_scale * height, values, "Inferno", hover, colorbar=bar)


def _temperatures(label: str, x: Any, oil: Any, surfaces: Any, name: str) -> Panel:
    """Panel with the temperatures of the oil and of both surfaces [K]."""
    rows = (
        (name, oil, TOTAL),
        *zip(("surface 1", "surface 2"), surfaces, PAIR_COLORS, strict=False),
    )
    traces = [line(x, values - _ZERO, name, color, unit=_UNIT) for name, values, color in rows]
    return Panel(axis_label("temperature", label), traces)


@drawing(
    "film_temperature",
    heading="Temperature of the film",
    caption="Temperature in the film over the position and the distance from surface 1, the inlet "
    "on the left; below it that of both surfaces and of the oil halfway between them.",
    of="ThermalLineContactSolution",
    made_by="Call tribodyn.ehl.solve_line_contact with thermal=True, then this figure.",
)
def film_temperature(solution: Any) -> Any:
    """Draw the temperatures of a heated line contact, the inlet on the left.

    Parameters
    ----------
    solution : ThermalLineContactSolution
        What :func:`tribodyn.ehl.solve_line_contact` returns with ``thermal``.

    Returns
    -------
    plotly.graph_objects.Figure
        Temperature in the film, and along both surfaces and halfway between them.
    """
    (scales,) = contact_scales([solution], dimensionless=False)
    first, last = window(solution)
    inside = (solution.position >= first) & (solution.position <= last)
    position = scales.position * solution.position[inside]
    middle = solution.film_temperature[inside, solution.height.size // 2]
    surfaces = [each[inside] for each in solution.surface_temperatures]
    hottest = float(solution.film_temperature.max()) - _ZERO
    surface = float(solution.surface_temperatures.max()) - _ZERO
    marks = event_lines([("centre", 0.0), ("outlet", scales.position * solution.outlet)])
    height = axis_label("film_thickness", "Height in the film")
    panels = [
        Panel(height, [_in_film(solution, inside, position, scales.film)]),
        _temperatures("Temperature", position, middle, surfaces, "middle of the film"),
    ]
    title = f"The film gets {hottest:.0f} {_UNIT} hot, its surfaces {surface:.0f} {_UNIT}"
    return stack(title, scales.position_label, panels, marks)


@drawing(
    "film_temperature_over_time",
    heading="Temperature of the film over time",
    caption="Film, highest temperature of the oil and of both surfaces, and friction of a contact "
    "over time.",
    of="ThermalTransientLineContact",
    made_by="Call tribodyn.ehl.solve_transient_line_contact with thermal=True and its plot method.",
)
def film_temperature_over_time(transient: Any) -> Any:
    """Draw film, temperatures and friction of a heated line contact over time.

    Parameters
    ----------
    transient : ThermalTransientLineContact
        What :func:`tribodyn.ehl.solve_transient_line_contact` returns with ``thermal``.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    time, oil = displayed("time", transient.time), transient.highest_film_temperature
    surfaces = transient.highest_surface_temperatures
    films = (
        ("film in the centre", transient.central_film, PAIR_COLORS[2]),
        ("film at its thinnest", transient.minimum_film, MUTED),
    )
    friction = line(time, transient.friction_coefficient, "friction", TOTAL, unit="1")
    panels = [
        curves("film_thickness", "Film", time, films, usual_films(transient.central_film)),
        _temperatures("Highest temperature", time, oil, surfaces, "oil"),
        from_zero(axis_label("friction_coefficient", "Friction"), [friction], height=0.6),
    ]
    hottest = int(np.argmax(oil))
    title = (
        f"The oil gets {oil[hottest] - _ZERO:.0f} {_UNIT} hot, after "
        f"{rounded('time', float(transient.time[hottest]))}"
    )
    return stack(title, axis_label("time"), panels)
