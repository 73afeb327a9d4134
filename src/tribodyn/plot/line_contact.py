"""Pressure and film of one lubricated line contact, against the dry pressure."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.contact_scales import (
    Scales,
    contact_scales,
    dry_pressure,
    film_height,
    place_of_minimum,
    thinned,
    window,
)
from tribodyn.plot.events import event_lines
from tribodyn.plot.style import MUTED, PAIR_COLORS, TOTAL, Panel, line, stack

#: Nodes beyond this number are not seen on a screen.
_POINTS = 2000


def curve(x: Any, y: Any, name: str, color: str, **more: Any) -> dict[str, Any]:
    """Describe a curve that is drawn through all of its points, for a spike is few of them."""
    described = line(x, y, name, color, **more)
    described["line"]["simplify"] = False
    return described


def point(
    x: float, y: float, name: str, color: str, *, unit: str = "", symbol: str = "circle"
) -> dict[str, Any]:
    """Describe one marked point with a name in the legend."""
    described = line([x], [y], name, color, unit=unit)
    del described["line"]
    edge = {"color": color, "width": 2}
    marker = {"size": 9, "symbol": symbol, "color": color, "line": edge}
    return {**described, "mode": "markers", "marker": marker}


def _pressure(solution: Any, kept: Any, scales: Scales) -> list[dict[str, Any]]:
    unit = scales.pressure_unit
    x, y = dry_pressure(solution)
    traces = [
        curve(
            scales.position * solution.position[kept],
            scales.pressure * solution.pressure[kept],
            "oil film",
            TOTAL,
            unit=unit,
        ),
        line(
            scales.position * x, scales.pressure * y, "dry (Hertz)", MUTED, unit=unit, dash="dash"
        ),
    ]
    if solution.spike_position is not None:
        traces.append(
            point(
                scales.position * solution.spike_position,
                scales.pressure * solution.spike_pressure,
                f"spike {scales.pressure_text(solution.spike_pressure)}<br>(rises with the grid)",
                PAIR_COLORS[1],
                unit=unit,
                symbol="diamond-open",
            )
        )
    return traces


def _film(solution: Any, kept: Any, scales: Scales) -> list[dict[str, Any]]:
    unit = scales.film_unit
    marks = (
        ("central", 0.0, solution.central_film, "circle-open"),
        ("minimum", place_of_minimum(solution), solution.minimum_film, "circle"),
    )
    return [
        curve(
            scales.position * solution.position[kept],
            scales.film * solution.film[kept],
            "film",
            TOTAL,
            unit=unit,
        ),
        *(
            point(
                scales.position * x,
                scales.film * film,
                f"{name} {scales.film_text(film, 4)}",
                PAIR_COLORS[0],
                unit=unit,
                symbol=symbol,
            )
            for name, x, film, symbol in marks
        ),
    ]


@drawing(
    "line_contact",
    heading="Pressure and film of a line contact",
    caption="Pressure and film over the place, the inlet on the left. The film narrows before its "
    "outlet; the dashed curve is the pressure of the dry contact under the same load.",
    of="LineContactSolution",
    made_by="Call tribodyn.ehl.solve_line_contact and its plot method.",
)
def line_contact(solution: Any, *, dimensionless: bool = False) -> Any:
    """Draw pressure and film of a line contact over the position, the inlet on the left.

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
        the outlet, where the oil parts. The view is the loaded part; the wider domain is found
        by zooming out.
    """
    (scales,) = contact_scales([solution], dimensionless)
    kept = thinned(solution, _POINTS)
    center, least = (
        scales.film_text(film) for film in (solution.central_film, solution.minimum_film)
    )
    view = {"range": [0.0, film_height([solution], [scales])]}
    marks = event_lines([("centre", 0.0), ("outlet", scales.position * solution.outlet)])
    return stack(
        f"The film is {center} thick in the centre and {least} at its thinnest",
        scales.position_label,
        [
            Panel(
                scales.pressure_label,
                _pressure(solution, kept, scales),
                {"rangemode": "tozero"},
            ),
            Panel(scales.film_label, _film(solution, kept, scales), view),
        ],
        {"xaxis": {"range": list(scales.position * np.array(window(solution)))}, **marks},
    )
