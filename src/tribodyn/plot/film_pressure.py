"""Greatest pressure in the oil film along the path of contact, beside that of the dry contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.cycle import (
    driving_roll_angle,
    pair_life,
    roll_angle_label,
    roll_angle_positions,
)
from tribodyn.plot.events import event_lines
from tribodyn.plot.film import no_film
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.sharing import load_sharing
from tribodyn.plot.style import PAIR_COLORS, TOTAL, Panel, line, stack


def _caption(result: Any) -> str:
    return (
        "The greatest pressure in the oil film of one tooth pair from its entry to its exit, and "
        "the pressure of the dry contact under the same load. The film exceeds it where a spike "
        "stands at its outlet, and stays below it where a thick film spreads the load. A spike is "
        "narrower than the grid: its height is a lower bound, and uneven by some percent. "
        + load_sharing(result.mesh.transverse_contact_ratio)
    )


def _no_pressure(result: Any) -> str:
    if result.mesh.film_pressure is not None:
        return ""
    return no_film(result) or (
        f'The film model "{result.mesh.film_model}" is a formula for the thickness: it knows no '
        'pressure. Choose film.model = "newton".'
    )


@drawing("film_pressure", heading="Pressure in the oil film", caption=_caption, needs=_no_pressure)
def film_pressure(result: Any) -> Any:
    """Draw the greatest film pressure of one tooth pair over the roll angle.

    Parameters
    ----------
    result : Result or MeshTable
        Anything that has a mesh table with a solved film.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    mesh, unit = result.mesh, display_unit("film_pressure")
    angle = driving_roll_angle(mesh)
    film, dry = (pair_life(mesh, name)[1] for name in ("film_pressure", "hertz_pressure"))
    traces = [
        line(angle, displayed("film_pressure", film), "in the oil film", TOTAL, unit=unit),
        line(
            angle,
            displayed("hertz_pressure", dry),
            "dry contact",
            PAIR_COLORS[3],
            unit=unit,
            dash="dash",
        ),
    ]
    return stack(
        f"The pressure in the oil film reaches {rounded('film_pressure', float(np.nanmax(film)))}",
        roll_angle_label(mesh),
        [Panel(axis_label("film_pressure"), traces, {"rangemode": "tozero"}, height=1.3)],
        event_lines(roll_angle_positions(mesh).items()),
    )
