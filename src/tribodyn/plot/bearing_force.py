"""Forces of both gears on their bearings, along the line of action and across it."""

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
        "The mean force loads the bearings; what varies around it shakes the housing and is heard. "
        "Along the line of action the bearings carry the mesh force, across it the friction. "
        + Motion(result).settling(signals.bearing_force(result, "pinion", "y"))
    ).rstrip()


@drawing(
    "bearing_force",
    heading="Bearing forces",
    caption=_caption,
    needs=no_translation,
)
def bearing_force(result: Any) -> Any:
    """Draw the forces of both gears on their bearings.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    motion = Motion(result)
    swing = np.ptp(motion.measured(signals.bearing_force(result, "pinion", "y")))
    return stack(
        f"The force on the pinion's bearing varies by {rounded('bearing_force', swing)} peak to "
        f"peak along the line of action{motion.window}",
        motion.label,
        motion_panels(result, "bearing_force", signals.bearing_force),
        motion.layout(),
    )
