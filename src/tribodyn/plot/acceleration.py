"""Accelerations of both gears along the line of action and across it."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot import signals
from tribodyn.plot.both_gears import motion_panels, no_translation
from tribodyn.plot.labels import rounded
from tribodyn.plot.motion import Motion
from tribodyn.plot.style import stack


def _caption(result: Any) -> str:
    return (
        "How the two gear centres shake. Along the line of action the jumps of the stiffness act, "
        "across it only friction does: without friction the lower panel is flat. "
        + Motion(result).settling(signals.acceleration(result, "pinion", "y"))
    ).rstrip()


@drawing(
    "acceleration",
    heading="Accelerations",
    caption=_caption,
    needs=no_translation,
)
def acceleration(result: Any) -> Any:
    """Draw the accelerations of the gear centres.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    motion = Motion(result)
    strongest = np.max(np.abs(motion.measured(signals.acceleration(result, "pinion", "y"))))
    return stack(
        f"The pinion shakes with up to {rounded('acceleration', strongest)} along the line of "
        f"action{motion.window}",
        motion.label,
        motion_panels(result, "acceleration", signals.acceleration),
        motion.layout(),
    )
