"""Part of the load on one tooth pair of a run over its way through the mesh."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.cycle import pair_life, positions
from tribodyn.plot.events import event_lines
from tribodyn.plot.labels import display_unit, displayed, rounded
from tribodyn.plot.loaded_life import corner_shades, pair_letters, roll_angle_of, roll_label
from tribodyn.plot.style import TOTAL, Panel, line, stack
from tribodyn.types import Array

#: Part of the total force that counts as load on a tip corner.
_LOADED = 1e-6


def whole_life(mesh: Any) -> tuple[Array, Array]:
    """Follow the load share of one tooth pair, tip corners before A and after E included."""
    age, share = pair_life(mesh, "load_share")
    ratio = positions(mesh)["E"]
    before, after = mesh.corner_share.T
    coming = before > _LOADED
    gone = mesh.phase + np.ceil(ratio - mesh.phase - 1e-9)
    # At the knot where the pair is at E itself there are both sides of the event.
    order = np.argsort(gone, kind="stable")
    order = order[after[order] > _LOADED]
    return (
        np.concatenate((mesh.phase[coming] - 1.0, age, gone[order])),
        np.concatenate((before[coming], share, after[order])),
    )


def _closed(age: Array, share: Array) -> tuple[Array, Array]:
    """From zero and back to zero, so that the ends are drawn."""
    ends = np.concatenate((age[:1], age, age[-1:]))
    return ends, np.concatenate(([0.0], share, [0.0]))


def _caption(result: Any) -> str:
    words = "How much of the load one tooth pair carries from where it comes in to where it leaves."
    if np.any(result.mesh.corner_share > _LOADED):
        return (
            f"{words} The loaded teeth bend: where the background is grey, before A or after E, a "
            "tip corner bears."
        )
    return words


@drawing("load_sharing", heading="Load sharing", caption=_caption)
def load_sharing(result: Any) -> Any:
    """Draw the load on one tooth pair over the roll angle of the driving gear.

    Parameters
    ----------
    result : Result or MeshTable
        Anything that has a mesh table.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    mesh = result.mesh
    pair = mesh.gear_pair
    age, share = _closed(*whole_life(mesh))
    x = displayed("roll_angle", roll_angle_of(pair, age))
    newton = display_unit("normal_force")
    hover = f"%{{y:.4g}} (%{{customdata:.4g}} {newton})<extra>load share</extra>"
    trace = {
        **line(x, share, "load share", TOTAL),
        "customdata": displayed("normal_force", share * mesh.total_normal_force),
        "hovertemplate": hover,
    }
    layout = event_lines(pair_letters(pair))
    for kind, found in corner_shades(pair, float(age[0]), float(age[-1])).items():
        layout[kind] = [*found, *layout[kind]]
    most = float(np.max(share)) * mesh.total_normal_force
    return stack(
        f"A tooth pair carries up to {rounded('normal_force', most)}, "
        f"{100.0 * float(np.max(share)):.3g} % of the load",
        roll_label(pair),
        [Panel("Load share of a pair", [trace], {"range": [0.0, 1.05]}, 1.3)],
        layout,
    )
