"""Oil film thickness along the path of contact, against the roughness."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.plot.cycle import (
    driving_roll_angle,
    pair_life,
    roll_angle_label,
    roll_angle_positions,
)
from tribodyn.plot.events import event_lines
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.registry import drawing
from tribodyn.plot.style import MUTED, PAIR_COLORS, TOTAL, Panel, line, stack

__all__ = ["film"]

#: Column of the mesh table, name in the legend, and colour.
_FILMS = (
    ("central_film", "in the centre", PAIR_COLORS[2]),
    ("minimum_film", "at its thinnest", TOTAL),
)


def _columns(mesh: Any) -> list[tuple[str, str, str]]:
    return [row for row in _FILMS if getattr(mesh, row[0], None) is not None]


def _no_film(result: Any) -> str:
    if _columns(result.mesh):
        return ""
    return 'No film model was chosen, so no oil film was computed. Choose film.model = "moes".'


@drawing(
    "film",
    heading="Oil film",
    caption="Thickness of the oil film between the flanks. Where it comes near the composite "
    "roughness, the highest asperities touch.",
    missing=_no_film,
)
def film(result: Any) -> Any:
    """Draw the film thickness of one tooth pair over the roll angle of the driving gear.

    Parameters
    ----------
    result : Result or MeshTable
        Anything that has a mesh table.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    mesh = result.mesh
    angle = driving_roll_angle(mesh)
    unit = display_unit("film_thickness")
    columns = [(row, pair_life(mesh, row[0])[1]) for row in _columns(mesh)]
    traces = [
        line(angle, displayed("film_thickness", values), name, color, unit=unit)
        for (_, name, color), values in columns
    ]
    roughness = np.full_like(angle, mesh.composite_roughness)
    traces.append(
        line(
            angle,
            displayed("film_thickness", roughness),
            "roughness",
            MUTED,
            unit=unit,
            dash="dot",
        )
    )
    (_, place, _), thinnest = columns[-1]
    least = rounded("film_thickness", float(np.min(thinnest)))
    return stack(
        f"The oil film {place} is never below {least}",
        roll_angle_label(mesh),
        [Panel(axis_label("film_thickness"), traces, {"rangemode": "tozero"}, height=1.3)],
        event_lines(roll_angle_positions(mesh).items()),
    )
