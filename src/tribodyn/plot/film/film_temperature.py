"""Temperatures of a heated line contact: in the film, along both surfaces, and over time."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.film.line_contact import contact_scales, window
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import Panel, event_lines, from_zero, stack
from tribodyn.plot.theme.style import MUTED, PAIR_COLORS, TOTAL, Trace, line
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
    return {
        "type": "heatmap",
        "x": position,
        "y": film_scale * height,
        "z": np.array(columns).T,
        "colorscale": "Inferno",
        "colorbar": {"title": {"text": _UNIT}, "len": 0.5, "y": 0.78, "thickness": 14},
        "hovertemplate": f"%{{z:.1f}} {_UNIT}<extra></extra>",
    }


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
    middle = solution.film_temperature[:, solution.height.size // 2]
    curves = [
        line(position, values[inside] - _ZERO, name, color, unit=_UNIT)
        for values, name, color in (
            (middle, "middle of the film", TOTAL),
            (solution.surface_temperatures[0], "surface 1", PAIR_COLORS[0]),
            (solution.surface_temperatures[1], "surface 2", PAIR_COLORS[1]),
        )
    ]
    hottest = float(solution.film_temperature.max()) - _ZERO
    surface = float(solution.surface_temperatures.max()) - _ZERO
    marks = event_lines([("centre", 0.0), ("outlet", scales.position * solution.outlet)])
    return stack(
        f"The film gets {hottest:.0f} {_UNIT} hot, its surfaces {surface:.0f} {_UNIT}",
        scales.position_label,
        [
            Panel(
                axis_label("film_thickness", "Height in the film"),
                [_in_film(solution, inside, position, scales.film)],
            ),
            Panel(axis_label("temperature", "Temperature"), curves),
        ],
        marks,
    )


@drawing(
    "film_temperature_over_time",
    heading="Temperature of the film over time",
    caption="Film, highest temperature of the oil and of both surfaces, and friction of a contact "
    "whose load, radius and speeds change.",
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
    time, film = displayed("time", transient.time), "film_thickness"
    rows = [
        (transient.highest_film_temperature, "oil", TOTAL),
        (transient.highest_surface_temperatures[0], "surface 1", PAIR_COLORS[0]),
        (transient.highest_surface_temperatures[1], "surface 2", PAIR_COLORS[1]),
    ]
    hottest = int(np.argmax(rows[0][0]))
    friction = line(time, transient.friction_coefficient, "friction", TOTAL, unit="1")
    films = [
        line(time, displayed(film, values), name, color, unit=display_unit(film))
        for values, name, color in (
            (transient.central_film, "film in the centre", PAIR_COLORS[2]),
            (transient.minimum_film, "film at its thinnest", MUTED),
        )
    ]
    thick = displayed(film, transient.central_film)
    view = {"range": [0.0, float(min(1.05 * np.max(thick), 4.0 * np.median(thick)))]}
    return stack(
        f"The oil gets {rows[0][0][hottest] - _ZERO:.0f} {_UNIT} hot, after "
        f"{rounded('time', float(transient.time[hottest]))}",
        axis_label("time"),
        [
            Panel(axis_label(film, "Film"), films, view),
            Panel(
                axis_label("temperature", "Highest temperature"),
                [line(time, t - _ZERO, name, color, unit=_UNIT) for t, name, color in rows],
            ),
            from_zero(axis_label("friction_coefficient", "Friction"), [friction], height=0.6),
        ],
    )
