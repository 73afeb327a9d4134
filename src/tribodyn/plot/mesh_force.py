"""The dynamic force along the line of action against the static one."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot import signals
from tribodyn.plot.labels import axis_label, display_unit, rounded
from tribodyn.plot.motion import Motion
from tribodyn.plot.style import MUTED, TOTAL, Panel, line, stack
from tribodyn.study.pipeline import record


def _below_zero(result: Any) -> str:
    """Explain a negative force, which the driving flanks alone could not bear."""
    fine = result.response.fine
    if np.min(signals.mesh_force(result)) >= 0.0:
        return ""
    if result.half_backlash == 0.0:
        return "Where it is negative, a mesh with play would part: this case has no backlash."
    if np.any(record.compression(fine) < -record.first_touch(result.system, fine)):
        return "Where it is negative, the play is used up and the back flanks touch."
    return "Where it is negative, the damping of the contact pulls just before the flanks part."


def _caption(result: Any) -> str:
    friction = (
        "Friction carries a part of the torque, so the mean of the dynamic force differs from the "
        "static one."
    )
    sentences = (
        "The force between the gears while they run, against the force that the torque alone "
        "would cause. Where the curve stays at zero, the flanks have lost contact.",
        friction if np.any(result.mesh.friction_coefficient) else "",
        _below_zero(result),
        Motion(result).settling(signals.mesh_force(result)),
    )
    return " ".join(filter(None, sentences))


@drawing("mesh_force", heading="Mesh force", caption=_caption)
def mesh_force(result: Any) -> Any:
    """Draw the dynamic and the static mesh force.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    motion, unit = Motion(result), display_unit("mesh_force")
    force = signals.mesh_force(result)
    static = np.full_like(force, result.mesh.total_normal_force)
    traces = [
        line(*motion.curve("mesh_force", force), "dynamic", TOTAL, unit=unit),
        line(*motion.curve("mesh_force", static), "static", MUTED, unit=unit, dash="dash"),
    ]
    low, high = (rounded("mesh_force", float(f(motion.measured(force)))) for f in (np.min, np.max))
    return stack(
        f"The mesh force swings between {low} and {high}{motion.window}",
        motion.label,
        [Panel(axis_label("mesh_force"), traces, {"rangemode": "tozero"}, height=1.3)],
        motion.layout(),
    )
