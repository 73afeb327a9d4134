"""The dynamic transmission error against the quasi-static one."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot import signals
from tribodyn.plot.cycle import cycles
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.motion import Motion, is_periodic
from tribodyn.plot.style import MUTED, TOTAL, Panel, line, stack


def _caption(result: Any) -> str:
    sentences = [
        "How far the driven gear lags behind its ideal place, measured on the line of action."
    ]
    if not is_periodic(result):
        sentences.append(Motion(result).settling(signals.transmission_error(result)))
    elif np.any(result.mesh.friction_coefficient):
        sentences.append(
            "The dashed curve is the lag at a very slow speed without friction. What varies about "
            "it is vibration; an offset of the mean comes from the friction, which carries a part "
            "of the torque."
        )
    else:
        sentences.append(
            "The dashed curve is the lag at a very slow speed; what the running gears add to it "
            "is vibration."
        )
    return " ".join(sentences)


@drawing("transmission_error", heading="Transmission error", caption=_caption)
def transmission_error(result: Any) -> Any:
    """Draw the dynamic transmission error and, for a steady state, the quasi-static one.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    motion, unit = Motion(result), display_unit("dynamic_transmission_error")
    moving = signals.transmission_error(result)
    traces = [
        line(*motion.curve("dynamic_transmission_error", moving), "dynamic", TOTAL, unit=unit)
    ]
    if motion.periodic:
        mesh = result.mesh
        static = mesh.static_transmission_error + result.static_error(mesh.phase)
        phase, shown = cycles(mesh.phase, displayed("transmission_error", static), motion.shown)
        traces.append(line(phase, shown, "quasi-static", MUTED, unit=unit, dash="dash"))
    swing = rounded("dynamic_transmission_error", float(np.ptp(motion.measured(moving))))
    return stack(
        f"The transmission error varies by {swing} peak to peak{motion.window}",
        motion.label,
        [Panel(axis_label("dynamic_transmission_error"), traces, height=1.3)],
        motion.layout(),
    )
