"""Stiffness of the oil film against that of the teeth along the path of contact."""

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
from tribodyn.plot.film import no_film
from tribodyn.plot.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.style import PAIR_COLORS, TOTAL, Panel, line, stack

#: Kinds of film stiffness that are in series with the teeth.
_SPRINGS = ("tangent", "secant")


def _caption(result: Any) -> str:
    kind = result.mesh.film_stiffness_kind
    if kind not in _SPRINGS:
        sum_of_source = "The film stiffness is the sum as one source prints it. "
        return (
            "Stiffness of the oil film of one tooth pair and of its teeth, on a logarithmic scale. "
            + (sum_of_source if kind == "seed" else "")
            + "In this case the film does not yield: the mesh has the stiffness of the teeth "
            'alone. Choose film.stiffness = "tangent" to put both in series.'
        )
    return (
        f"Stiffness of the oil film of one tooth pair ({kind}) and of its teeth, on a logarithmic "
        "scale. Both are springs in series: the softer one decides. Below, the teeth alone and "
        "the pair with its film."
    )


def _no_stiffness(result: Any) -> str:
    if result.mesh.film_stiffness is not None:
        return ""
    return no_film(result) or (
        f'The film model "{result.mesh.film_model}" gives no film stiffness. Choose film.model = '
        '"newton".'
    )


@drawing(
    "film_stiffness", heading="Stiffness of the oil film", caption=_caption, needs=_no_stiffness
)
def film_stiffness(result: Any) -> Any:
    """Draw the stiffness of film, teeth and pair over the roll angle.

    Parameters
    ----------
    result : Result or MeshTable
        Anything that has a mesh table with a film stiffness.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    mesh, unit = result.mesh, display_unit("film_stiffness")
    angle = driving_roll_angle(mesh)
    film, teeth, pair = (
        displayed(quantity, pair_life(mesh, column)[1])
        for column, quantity in (
            ("film_stiffness", "film_stiffness"),
            ("tooth_stiffness", "tooth_stiffness"),
            ("stiffness", "pair_stiffness"),
        )
    )
    teeth_curve = line(angle, teeth, "teeth", PAIR_COLORS[0], unit=unit, dash="dash")
    film_curve = line(angle, film, "oil film", PAIR_COLORS[2], unit=unit)
    panels = [
        Panel(
            axis_label("film_stiffness", "Stiffness"),
            [film_curve, teeth_curve],
            {"type": "log", "dtick": 1},
        )
    ]
    if mesh.film_stiffness_kind in _SPRINGS:
        pair_curve = line(angle, pair, "teeth and film", TOTAL, unit=unit)
        panels.append(Panel(axis_label("pair_stiffness"), [teeth_curve, pair_curve]))
    # Relieved flanks leave a pair without load where it comes in and where it leaves.
    loaded = (teeth > 0.0) & np.isfinite(film)
    ratio = film[loaded] / teeth[loaded]
    least, greatest = (significant(float(f(ratio))) for f in (np.min, np.max))
    return stack(
        f"The oil film is {least} to {greatest} times as stiff as the teeth",
        roll_angle_label(mesh),
        panels,
        event_lines(roll_angle_positions(mesh).items()),
    )
