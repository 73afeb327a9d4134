"""Temperatures of a heated line contact: in the film, along both surfaces and in the middle."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.film.line_contact import contact_scales, window
from tribodyn.plot.theme.labels import axis_label, display_unit
from tribodyn.plot.theme.panels import Panel, event_lines, stack
from tribodyn.plot.theme.style import PAIR_COLORS, TOTAL, Trace, line
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
