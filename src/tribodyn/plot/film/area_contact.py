"""Point contacts and rollers: maps of pressure and film over the contact, cuts along and across."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.theme.labels import display_unit, displayed, significant
from tribodyn.plot.theme.panels import Panel, Row, from_zero, stack, stack_rows
from tribodyn.plot.theme.style import INK, MUTED, PINION, TOTAL, WHEEL, Trace, line
from tribodyn.types import Array

_COLORS = [[0.0, "#f2f6fa"], [0.5, "#56B4E9"], [0.75, PINION], [1.0, WHEEL]]
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
    return {
        "type": "heatmap",
        "x": x[::step_x],
        "y": y[::step_y],
        "z": values[::step_y, ::step_x],
        "colorscale": _COLORS,
        "colorbar": {"title": {"text": unit}, "thickness": 14, "y": bar[0], "len": bar[1]},
        "hovertemplate": f"%{{x:.4g}}, %{{y:.4g}}: %{{z:.4g}} {unit}<extra></extra>",
        "showlegend": False,
        "hoverongaps": False,
        "name": unit,
    }


def _levels(heat: Trace, top: float) -> Trace:
    """Lines of equal film on its map."""
    levels = {"start": 0.0, "end": top, "size": top / _LINES, "coloring": "none"}
    lines = {"type": "contour", "contours": levels, "line": {"color": INK, "width": 0.8}}
    plain = {"showscale": False, "showlegend": False, "hoverinfo": "skip", "name": "film"}
    return {**{name: heat[name] for name in ("x", "y", "z")}, **lines, **plain}


@drawing(
    "point_contact",
    heading="Pressure and film of a point contact",
    caption="Pressure and film over the contact, and both along the entrainment through its "
    "middle. The film narrows at the outlet and at the sides; the dashed ellipse and curve are the "
    "dry contact of Hertz.",
    of="PointContactSolution",
    made_by="Call tribodyn.ehl.solve_point_contact and its plot method.",
)
def point_contact(solution: Any) -> Any:
    """Draw maps of pressure and film, and a cut through the middle along the x axis."""
    x, y, pressure, film = _metric(solution)
    a, b = (
        float(displayed("half_width", half))
        for half in (solution.semi_axis_x, solution.semi_axis_y)
    )
    top = float(displayed("film_thickness", _FILMS * solution.central_film))
    view = [
        (max(x[0], -2.0 * a), min(x[-1], 1.6 * a)), (max(y[0], -1.6 * b), min(y[-1], 1.6 * b)),
    ]  # fmt: skip
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    ellipse = line(a * np.cos(angle), b * np.sin(angle), "dry contact", MUTED, dash="dash")
    ellipse |= {"showlegend": False, "hoverinfo": "skip", "hovertemplate": None}
    film = np.where(film < top, film, np.nan)
    films = _map(x, y, film, display_unit("film_thickness"), (0.5, 0.3))
    units = (
        display_unit("half_width"),
        display_unit("hertz_pressure"),
        display_unit("film_thickness"),
    )
    middle = int(np.argmin(np.abs(solution.y)))
    inside = np.clip(x / a, -1.0, 1.0)
    dry = float(displayed("hertz_pressure", solution.hertz_pressure)) * np.sqrt(1.0 - inside**2)
    pressed = _map(x, y, pressure, units[1], (0.87, 0.26))
    labels = f"x [{units[0]}]", f"y [{units[0]}]"
    cut = [
        line(x, pressure[middle], f"pressure [{units[1]}]", TOTAL, unit=units[1]),
        line(x, dry, f"dry (Hertz) [{units[1]}]", MUTED, unit=units[1], dash="dash"),
        line(x, film[middle], f"film [{units[2]}]", WHEEL, unit=units[2]),
    ]
    central, least = (
        f"{significant(float(displayed('film_thickness', each)))} {units[2]}"
        for each in (solution.central_film, solution.minimum_film)
    )
    ahead = {"range": list(view[0])}
    rows = [
        Row(labels[0], Panel(labels[1], [pressed, ellipse], {"range": list(view[1])}, 1.5), ahead),
        Row(labels[0], Panel(labels[1], [films, _levels(films, top), ellipse],
                             {"range": list(view[1])}, 1.5), ahead),
        Row(labels[0], from_zero("Cut through the middle", cut), ahead),
    ]  # fmt: skip
    title = f"The film is {central} thick in the middle and {least} at its thinnest"
    return stack_rows(title, rows, {"hovermode": "closest"})


@drawing(
    "finite_line_contact",
    heading="Pressure and film along a roller",
    caption="Greatest pressure and least film at each position along the roller, and the load per "
    "length. The dashed lines are the infinite line under the load at mid length.",
    of="FiniteLineSolution",
    made_by="Call tribodyn.ehl.solve_finite_line_contact and its plot method.",
)
def finite_line_contact(solution: Any) -> Any:
    """Draw pressure, film and load along a roller."""
    y = np.asarray(displayed("face_width", solution.y))
    ends = y[[0, -1]]
    pressure, film = display_unit("hertz_pressure"), display_unit("film_thickness")
    ridge = displayed("hertz_pressure", solution.ridge_pressure)
    least = np.asarray(displayed("film_thickness", solution.ridge_film))
    top = float(displayed("film_thickness", _FILMS * solution.central_film))
    least = np.where(least < top, least, np.nan)
    line_pressure, line_film = (
        np.full(2, float(displayed(name, value)))
        for name, value in (
            ("hertz_pressure", solution.line_maximum_pressure),
            ("film_thickness", solution.line_minimum_film),
        )
    )
    load = 1e-3 * solution.load_per_length
    mean = np.full(2, 1e-3 * solution.normal_force / solution.length)
    panels = [
        from_zero(f"Greatest pressure [{pressure}]", [
            line(y, ridge, "roller", TOTAL, unit=pressure),
            line(ends, line_pressure, "infinite line", MUTED, unit=pressure, dash="dash"),
        ]),
        from_zero(f"Least film [{film}]", [
            line(y, least, "roller", TOTAL, unit=film),
            line(ends, line_film, "infinite line", MUTED, unit=film, dash="dash"),
        ]),
        from_zero("Load per length [N/mm]", [
            line(y, load, "roller", TOTAL, unit="N/mm"),
            line(ends, mean, "mean", MUTED, unit="N/mm", dash="dash"),
        ]),
    ]  # fmt: skip
    title = f"The ends carry {solution.edge_pressure_ratio:.2f} times the pressure of the middle"
    return stack(title, f"Along the roller [{display_unit('face_width')}]", panels).figure()


@drawing(
    "area_friction",
    heading="Friction over the width of a contact",
    caption="Friction force per width and rise of the mean film temperature on each line along the "
    "entrainment, over the position across it.",
    of="AreaFriction",
    made_by="Call the friction method of tribodyn.ehl.solve_point_contact(...).",
)
def area_friction(friction: Any) -> Any:
    """Draw friction and film temperature over the position across the entrainment."""
    position = np.asarray(displayed("face_width", friction.position))
    force = 1e-3 * friction.force_per_width
    rise = friction.temperature_rise
    panels = [
        from_zero("Friction [N/mm]", [line(position, force, "friction", TOTAL, unit="N/mm")]),
        from_zero("Temperature rise [K]", [line(position, rise, "film", WHEEL, unit="K")]),
    ]
    title = f"Friction coefficient {friction.coefficient:.4f}"
    label = f"Across the entrainment [{display_unit('face_width')}]"
    return stack(title, label, panels).figure()
