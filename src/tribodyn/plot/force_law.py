"""Force of the mesh over its deflection, at several places of the mesh cycle."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.cycle import positions
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.style import MUTED, PAIR_COLORS, TOTAL, Panel, line, stack

_COLORS = (TOTAL, *PAIR_COLORS)
#: Deflections of a curve, and how far it goes beyond the working load.
_POINTS, _BEYOND = 241, 1.3


def _phases(mesh: Any) -> list[tuple[str, float]]:
    """Phases in the middle between two events, and how many pairs are on the path there."""
    events = sorted({0.0, positions(mesh)["E"] % 1.0, 1.0})
    found = []
    for start, stop in pairwise(events):
        if stop - start > 1e-6:
            middle = 0.5 * (start + stop)
            pairs = int(np.count_nonzero(mesh.at("in_contact", middle)))
            words = "1 pair" if pairs == 1 else f"{pairs} pairs"
            # Shortly before the event a tip corner may carry.
            for phase in (middle, stop - 0.05 * (stop - start)):
                found.append((f"phase {significant(phase, 2)}: {words}", phase))
    return found


@drawing(
    "force_law",
    heading="Force law of the mesh",
    caption="Force over the approach of the gears at places of the mesh cycle. The curve bends "
    "upwards where the flanks flatten and where a further pair comes to bear; the marks are the "
    "working load. To the left of a curve's foot the flanks are apart.",
)
def force_law(result: Any) -> Any:
    """Draw the force on the mesh over its deflection for several mesh phases.

    Parameters
    ----------
    result : Result or MeshTable
        Anything that has a mesh table.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    mesh = result.mesh
    law, load = mesh.force_law, mesh.total_normal_force
    chosen = _phases(mesh)
    working = np.array([float(law.deflection(phase, load)) for _, phase in chosen])
    touch = np.array([float(law.first_touch(phase)) for _, phase in chosen])
    first, last = float(touch.min()), float(working.max())
    reach = last - first
    deflection = np.linspace(first - 0.08 * reach, first + _BEYOND * reach, _POINTS)
    newton, x = display_unit("normal_force"), displayed("deflection", deflection)
    traces = [
        line(
            x,
            displayed("normal_force", law.force(phase, deflection)),
            words,
            _COLORS[number % len(_COLORS)],
            unit=newton,
            dash="solid" if number % 2 == 0 else "dash",
        )
        for number, (words, phase) in enumerate(chosen)
    ]
    level = np.full(2, displayed("normal_force", load))
    traces.append(line(x[[0, -1]], level, "working load", MUTED, unit=newton, dash="dot", width=1))
    micro = display_unit("deflection")
    marks = {
        "type": "scatter",
        "mode": "markers",
        "x": displayed("deflection", working),
        "y": np.full(working.size, level[0]),
        "marker": {"color": [_COLORS[k % len(_COLORS)] for k in range(len(chosen))], "size": 9},
        "name": "deflection under it",
        "showlegend": False,
        "hovertemplate": f"%{{y:.4g}} {newton} at %{{x:.4g}} {micro}<extra>working load</extra>",
    }
    low, high = (rounded("deflection", float(at(working))) for at in (np.min, np.max))
    return stack(
        f"The working load of {rounded('normal_force', load)} deflects the mesh by {low} to {high}",
        axis_label("deflection", "Approach along the line of action"),
        [Panel(axis_label("normal_force"), [*traces, marks], {"rangemode": "tozero"}, 1.6)],
        {"hovermode": "closest"},
    )
