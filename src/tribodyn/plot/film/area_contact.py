"""Point contacts and rollers: maps of pressure and film over the contact, cuts along and across."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.theme.colors import HEAT, MUTED, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import Panel, Row, curve, from_zero, stack, stack_rows
from tribodyn.plot.theme.style import Trace, heat, line, over_map
from tribodyn.types import Array

#: Film over the central one up to which the map distinguishes it, and lines of equal film.
_FILMS, _LINES = 2.5, 12
#: Most nodes of a map along each axis.
_MOST = 160


def _metric(solution: Any) -> tuple[Array, Array, Array, Array]:
    """Positions, pressure and film in display units; the film only where it is near the contact."""
    x, y = (np.asarray(displayed("half_width", each)) for each in (solution.x, solution.y))
    pressure = np.asarray(displayed("hertz_pressure", solution.pressure))
    film = np.asarray(displayed("film_thickness", solution.film))
    return x, y, pressure, film


def _map(x: Array, y: Array, values: Array, unit: str, bar: tuple[float, float]) -> Trace:
    """Map of values; ``bar`` is centre and length of the colour bar."""
    step_x, step_y = (max(1, -(-each.size // _MOST)) for each in (x, y))
    scale = {"title": {"text": unit}, "thickness": 14, "y": bar[0], "len": bar[1]}
    more = {"colorbar": scale, "hoverongaps": False, "name": unit}
    hover = f"%{{x:.4g}}, %{{y:.4g}}: %{{z:.4g}} {unit}"
    return heat(x[::step_x], y[::step_y], values[::step_y, ::step_x], HEAT, hover, **more)


def _levels(heat: Trace, top: float) -> Trace:
    """Lines of equal film on its map."""
    levels = {"start": 0.0, "end": top, "size": top / _LINES, "coloring": "none"}
    return over_map(heat, levels, 0.8, "film")


@drawing(
    heading="Pressure and film of a point contact",
    of="PointContactSolution",
    made_by="Call tribodyn.ehl.solve_point_contact and its plot method.",
)
def point_contact(solution: Any) -> Sketch:
    """Draw maps of pressure and film, and a cut through the middle along the x axis.

    Pressure and film over the contact, and both along the entrainment through its middle. The film
    narrows at the outlet and at the sides; the dashed ellipse and curve are the dry contact of
    Hertz.
    """
    x, y, pressure, film = _metric(solution)
    a, b = displayed("half_width", [solution.semi_axis_x, solution.semi_axis_y]).tolist()
    top = float(displayed("film_thickness", _FILMS * solution.central_film))
    ahead = {"range": [max(x[0], -2.0 * a), min(x[-1], 1.6 * a)]}
    aside = {"range": [max(y[0], -1.6 * b), min(y[-1], 1.6 * b)]}
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    quiet: Trace = {"dash": "dash", "showlegend": False, "hoverinfo": "skip", "hovertemplate": None}
    ellipse = line(a * np.cos(angle), b * np.sin(angle), "dry contact", MUTED, **quiet)
    width, gpa, micro = map(display_unit, ("half_width", "hertz_pressure", "film_thickness"))
    films = _map(x, y, np.where(film < top, film, np.nan), micro, (0.5, 0.3))
    middle = int(np.argmin(np.abs(solution.y)))
    dry = displayed("hertz_pressure", solution.hertz_pressure)
    dry = dry * np.sqrt(1.0 - np.clip(x / a, -1.0, 1.0) ** 2)
    pressed = _map(x, y, pressure, gpa, (0.87, 0.26))
    film = np.where(film < top, film, np.nan)
    cut = [
        line(x, pressure[middle], f"pressure [{gpa}]", TOTAL, unit=gpa),
        line(x, dry, f"dry (Hertz) [{gpa}]", MUTED, unit=gpa, dash="dash"),
        line(x, film[middle], f"film [{micro}]", WHEEL, unit=micro),
    ]
    along, across = f"x [{width}]", f"y [{width}]"
    rows = [
        Row(along, Panel(across, [pressed, ellipse], aside, 1.5), ahead),
        Row(along, Panel(across, [films, _levels(films, top), ellipse], aside, 1.5), ahead),
        Row(along, from_zero("Cut through the middle", cut), ahead),
    ]
    films_named = (solution.central_film, solution.minimum_film)
    central, least = (rounded("film_thickness", each) for each in films_named)
    title = f"The film is {central} thick in the middle and {least} at its thinnest"
    return stack_rows(title, rows, {"hovermode": "closest"})


@drawing(
    heading="Pressure and film along a roller",
    of="FiniteLineSolution",
    made_by="Call tribodyn.ehl.solve_finite_line_contact and its plot method.",
)
def finite_line_contact(solution: Any) -> Sketch:
    """Draw pressure, film and load along a roller.

    Greatest pressure and least film at each position along the roller, and the load per length. The
    dashed lines are the infinite line under the load at mid length.
    """
    y = displayed("face_width", solution.y)
    film = np.asarray(solution.ridge_film)
    film = np.where(film < _FILMS * solution.central_film, film, np.nan)
    panels = [
        _along(y, "hertz_pressure", "Greatest pressure", solution.ridge_pressure,
               solution.line_maximum_pressure),
        _along(y, "film_thickness", "Least film", film, solution.line_minimum_film),
        _along(y, "load_per_width", "Load per length", solution.load_per_length,
               solution.normal_force / solution.length, "mean"),
    ]  # fmt: skip
    title = f"The ends carry {solution.edge_pressure_ratio:.2f} times the pressure of the middle"
    return stack(title, f"Along the roller [{display_unit('face_width')}]", panels)


def _along(
    y: Array, quantity: str, label: str, values: object, level: float, name: str = "infinite line"
) -> Panel:
    """Panel with values along the roller and a level to compare with."""
    roller = curve(quantity, y, values, "roller", TOTAL)
    dashed = curve(quantity, y[[0, -1]], [level] * 2, name, MUTED, dash="dash")
    return from_zero(axis_label(quantity, label), [roller, dashed])


@drawing(
    heading="Friction over the width of a contact",
    of="AreaFriction",
    made_by="Call the friction method of tribodyn.ehl.solve_point_contact(...).",
)
def area_friction(friction: Any) -> Sketch:
    """Draw friction and film temperature over the position across the entrainment.

    Friction force per width and rise of the mean film temperature on each line along the
    entrainment, over the position across it.
    """
    position = displayed("face_width", friction.position)
    force, rise = 1e-3 * friction.force_per_width, friction.temperature_rise
    panels = [
        from_zero("Friction [N/mm]", [line(position, force, "friction", TOTAL, unit="N/mm")]),
        from_zero("Temperature rise [K]", [line(position, rise, "film", WHEEL, unit="K")]),
    ]
    title = f"Friction coefficient {friction.coefficient:.4f}"
    label = f"Across the entrainment [{display_unit('face_width')}]"
    return stack(title, label, panels)
