"""Stiffness of every tooth pair and of the whole mesh over two mesh cycles."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.cycle import CYCLES, cycles, mesh_events, pair_lives
from tribodyn.plot.events import event_lines
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.style import PAIR_COLORS, TOTAL, Panel, line, stack


@drawing(
    "mesh_stiffness",
    heading="Mesh stiffness",
    caption="The stiffness jumps whenever a tooth pair enters or leaves the contact. These jumps "
    "excite the vibration: the higher they are, the louder the gears. The coloured curves are "
    "the single tooth pairs that add up to the total.",
)
def mesh_stiffness(result: Any) -> Any:
    """Draw the stiffness of the tooth pairs and their sum.

    Parameters
    ----------
    result : Result or MeshTable
        Anything that has a mesh table.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    mesh, unit = result.mesh, display_unit("mesh_stiffness")
    phase, total = cycles(mesh.phase, displayed("mesh_stiffness", mesh.mesh_stiffness))
    traces = [line(phase, total, "all pairs", TOTAL, unit=unit)]
    for number, (at, pair) in enumerate(pair_lives(mesh, "stiffness"), start=1):
        color = PAIR_COLORS[(number - 1) % len(PAIR_COLORS)]
        shown = displayed("pair_stiffness", pair)
        traces.append(line(at, shown, f"tooth pair {number}", color, unit=unit, dash="dash"))
    least, greatest = (rounded("mesh_stiffness", f(mesh.mesh_stiffness)) for f in (np.min, np.max))
    return stack(
        f"The mesh stiffness swings between {least} and {greatest}",
        axis_label("mesh_phase", "Mesh cycles"),
        [Panel(axis_label("mesh_stiffness"), traces, {"rangemode": "tozero"}, height=1.3)],
        {**event_lines(mesh_events(mesh)), "xaxis": {"range": [0, CYCLES]}},
    )
