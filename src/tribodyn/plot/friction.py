"""Friction coefficient of a tooth pair, and the friction force of the whole mesh."""

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
from tribodyn.plot.style import PAIR_COLORS, TOTAL, WHEEL, Panel, line, stack


def _caption(result: Any) -> str:
    return (
        "The friction coefficient of one tooth pair from its entry to its exit, and the friction "
        "force that it causes under the static load. The force turns round where the sliding does, "
        "at the pitch point C. Its other steps come from the load. "
        + load_sharing(result.mesh.transverse_contact_ratio)
    )


def _frictionless(result: Any) -> str:
    if np.any(result.mesh.friction_coefficient):
        return ""
    return (
        "No friction acts between the flanks: the friction coefficient is zero. Choose a law, for "
        'example friction.law = "xu-2007".'
    )


@drawing("friction", heading="Friction", caption=_caption, needs=_frictionless)
def friction(result: Any) -> Any:
    """Draw friction coefficient and friction force of a tooth pair over the roll angle.

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
    coefficient = pair_life(mesh, "friction_coefficient")[1]
    load = pair_life(mesh, "normal_force")[1]
    force = coefficient * load * pair_life(mesh, "sliding_direction")[1]
    unit = display_unit("friction_force")
    shown = displayed("friction_force", force), displayed("normal_force", load)
    friction_curve = line(angle, shown[0], "friction force", WHEEL, unit=unit)
    load_curve = line(angle, shown[1], "normal force", TOTAL, unit=unit)
    mean = rounded("friction_coefficient", mesh.mean_friction_coefficient)
    return stack(
        f"The friction coefficient is {mean} as the mean over the mesh cycle, weighted with the "
        "load shares",
        roll_angle_label(mesh),
        [
            Panel(
                axis_label("friction_coefficient"),
                [line(angle, coefficient, "friction coefficient", PAIR_COLORS[0])],
                {"rangemode": "tozero"},
            ),
            Panel(axis_label("friction_force"), [friction_curve], {"zeroline": True}),
            Panel(axis_label("normal_force"), [load_curve], {"rangemode": "tozero"}, height=0.8),
        ],
        event_lines(roll_angle_positions(mesh).items()),
    )
