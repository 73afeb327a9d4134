"""Oil film thickness along the path of contact, and its ratio to the roughness."""

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
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.style import MUTED, PAIR_COLORS, TOTAL, Panel, line, stack
from tribodyn.types import Array

#: Column of the mesh table, name in the legend, and colour.
_FILMS = (
    ("central_film", "in the centre", PAIR_COLORS[2]),
    ("minimum_film", "at its thinnest", TOTAL),
)
#: Film over the usual one above which both are not seen on one linear scale.
_VERY_THICK = 10.0


def _columns(mesh: Any) -> list[tuple[str, str, str]]:
    return [row for row in _FILMS if getattr(mesh, row[0], None) is not None]


def no_film(result: Any) -> str:
    """Say why a result has no oil film."""
    if _columns(result.mesh):
        return ""
    return 'No film model was chosen, so no oil film was computed. Choose film.model = "newton".'


def _thickness(mesh: Any, angle: Any) -> Panel:
    unit = display_unit("film_thickness")
    traces = [
        line(angle, displayed("film_thickness", pair_life(mesh, row)[1]), name, color, unit=unit)
        for row, name, color in _columns(mesh)
    ]
    roughness = displayed("film_thickness", np.full_like(angle, mesh.composite_roughness))
    traces.append(line(angle, roughness, "roughness", MUTED, unit=unit, dash="dot"))
    films = [pair_life(mesh, row)[1] for row, _, _ in _columns(mesh)]
    return Panel(axis_label("film_thickness"), traces, _axis(films), height=1.3)


def _axis(films: list[Array]) -> dict[str, Any]:
    """From zero, or logarithmic where a pair that hardly carries has a very thick film."""
    thickest = max(float(np.nanmax(film)) for film in films)
    usual = float(np.nanmedian(films[0]))
    return (
        {"type": "log", "dtick": 1} if thickest > _VERY_THICK * usual else {"rangemode": "tozero"}
    )


def _ratio(mesh: Any, angle: Any) -> list[Panel]:
    """Panel of the film ratio; none for ideal flanks."""
    if mesh.film_ratio is None:
        return []
    traces = [
        line(angle, pair_life(mesh, "film_ratio")[1], "film ratio", TOTAL),
        line(angle, np.ones_like(angle), "mixed below", MUTED, dash="dot"),
    ]
    axis = _axis([pair_life(mesh, "film_ratio")[1]])
    return [Panel(axis_label("film_ratio"), traces, axis, height=0.8)]


@drawing(
    "film",
    heading="Oil film",
    caption="Thickness of the oil film between the flanks, and its ratio to the composite "
    "roughness. Where the ratio comes near one, the highest asperities touch.",
    needs=no_film,
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
    name, place, _ = _columns(mesh)[-1]
    least = rounded("film_thickness", float(np.nanmin(pair_life(mesh, name)[1])))
    return stack(
        f"The oil film {place} is never below {least}",
        roll_angle_label(mesh),
        [_thickness(mesh, angle), *_ratio(mesh, angle)],
        event_lines(roll_angle_positions(mesh).items()),
    )
