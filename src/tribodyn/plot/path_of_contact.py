"""Speeds, radii of curvature and slide-to-roll ratio along the path of contact."""

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
from tribodyn.plot.sharing import load_sharing
from tribodyn.plot.style import PINION, TOTAL, WHEEL, Panel, line, stack

Rows = tuple[tuple[str, str, str, str], ...]

#: Column of the mesh table, name, colour and dash.
_SPEEDS: Rows = (
    ("sliding_speed", "sliding", WHEEL, "solid"),
    ("entrainment_speed", "entrainment", PINION, "solid"),
)
_RADII: Rows = (
    ("pinion_curvature_radius", "pinion", PINION, "dash"),
    ("wheel_curvature_radius", "wheel", WHEEL, "dash"),
    ("equivalent_radius", "equivalent", TOTAL, "solid"),
)


#: Marks the zero of an axis.
_ZERO = {"zeroline": True}


def _caption(result: Any) -> str:
    return (
        "What one tooth pair meets from A, where it enters, to E, where it leaves. At the pitch "
        "point C the surfaces roll without sliding; the sliding speed changes its sign there, and "
        f"so does the friction. {load_sharing(result.mesh.transverse_contact_ratio)}"
    )


@drawing("path_of_contact", heading="Along the path of contact", caption=_caption)
def path_of_contact(result: Any) -> Any:
    """Draw speeds, radii and slide-to-roll ratio over the roll angle of the driving gear.

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

    def curves(quantity: str, rows: Rows) -> list[dict[str, Any]]:
        unit = display_unit(quantity)
        lives = [displayed(quantity, pair_life(mesh, row[0])[1]) for row in rows]
        return [
            line(angle, life, name, color, unit=unit, dash=dash)
            for (_, name, color, dash), life in zip(rows, lives, strict=True)
        ]

    ratio = pair_life(mesh, "slide_to_roll_ratio")[1]
    fastest = np.max(np.abs(pair_life(mesh, "sliding_speed")[1]))
    return stack(
        f"The flanks slide on each other at up to {rounded('sliding_speed', float(fastest))}",
        roll_angle_label(mesh),
        [
            Panel(axis_label("sliding_speed", "Speed"), curves("sliding_speed", _SPEEDS), _ZERO),
            Panel(
                axis_label("curvature_radius", "Radius of curvature"),
                curves("curvature_radius", _RADII),
            ),
            Panel(
                axis_label("slide_to_roll_ratio"),
                [line(angle, ratio, "slide-to-roll", TOTAL)],
                _ZERO,
                height=0.8,
            ),
        ],
        event_lines(roll_angle_positions(mesh).items()),
    )
