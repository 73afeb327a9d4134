"""Stiffness of the loaded mesh over the way of one tooth pair, with the positions A to E."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.cycle import pair_life
from tribodyn.plot.events import event_lines
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.loaded_life import pair_letters, roll_angle_of, roll_label
from tribodyn.plot.style import MUTED, PAIR_COLORS, TOTAL, Panel, line, stack
from tribodyn.types import Array

_PAIR = "one tooth pair"
#: Mesh cycles shown before A and after E.
_MARGIN = 0.12


def _pairs(mesh: Any, ends: tuple[float, float]) -> list[tuple[str, Array, Array]]:
    """Stiffness of the pair between A and E, and of those before and after it."""
    age, stiffness = pair_life(mesh, "stiffness")
    age = np.concatenate((age[:1], age, age[-1:]))
    stiffness = np.concatenate(([0.0], stiffness, [0.0]))
    found = []
    for shift in range(-len(mesh.path[0]), len(mesh.path[0]) + 1):
        seen = (age + shift >= ends[0]) & (age + shift <= ends[1])
        if np.count_nonzero(seen) > 1:
            name = _PAIR if shift == 0 else "its neighbours"
            found.append((name, age[seen] + shift, stiffness[seen]))
    return sorted(found, key=lambda each: each[0] != _PAIR)


def _total(mesh: Any, values: Array, ends: tuple[float, float]) -> tuple[Array, Array]:
    """Repeat a column of the whole mesh over the ages that are shown."""
    cycles = range(int(np.floor(ends[0])), int(np.ceil(ends[1])))
    age = np.concatenate([mesh.phase + cycle for cycle in cycles])
    seen = (age >= ends[0]) & (age <= ends[1])
    return age[seen], np.tile(values, len(cycles))[seen]


@drawing(
    "static_stiffness",
    heading="Stiffness over the roll angle",
    caption="The secant is the load over the whole deflection, the tangent what counts for small "
    "vibration about the load. The part of each tooth pair is its share of the secant.",
)
def static_stiffness(result: Any) -> Any:
    """Draw secant and tangent stiffness of the mesh and the part of each tooth pair.

    Parameters
    ----------
    result : Result or MeshTable
        Anything that has a mesh table.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    mesh = result.mesh
    pair, unit = mesh.gear_pair, display_unit("mesh_stiffness")
    ends = (-_MARGIN, mesh.transverse_contact_ratio + _MARGIN)

    def curve(age: Array, values: Array, name: str, color: str, dash: str) -> dict[str, Any]:
        x = displayed("roll_angle", roll_angle_of(pair, age))
        return line(x, displayed("mesh_stiffness", values), name, color, unit=unit, dash=dash)

    traces = [
        curve(*_total(mesh, mesh.mesh_stiffness, ends), "all pairs, secant", TOTAL, "solid"),
        curve(*_total(mesh, mesh.mesh_stiffness_tangent, ends), "all pairs, tangent", TOTAL, "dot"),
    ]
    named: set[str] = set()
    for name, age, stiffness in _pairs(mesh, ends):
        color = PAIR_COLORS[0] if name == _PAIR else MUTED
        trace = curve(age, stiffness, name, color, "dash")
        traces.append({**trace, "showlegend": name not in named})
        named.add(name)
    means = (mesh.mean_mesh_stiffness, mesh.mean_mesh_stiffness_tangent)
    secant, tangent = (rounded("mesh_stiffness", mean) for mean in means)
    x = displayed("roll_angle", roll_angle_of(pair, np.array(ends)))
    return stack(
        f"The mean stiffness is {secant} as a secant and {tangent} as a tangent",
        roll_label(pair),
        [Panel(axis_label("mesh_stiffness"), traces, {"rangemode": "tozero"}, 1.5)],
        {**event_lines(pair_letters(pair)), "xaxis": {"range": x.tolist()}},
    )
