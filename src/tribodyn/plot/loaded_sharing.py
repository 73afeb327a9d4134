"""Force on one tooth pair over its way through the mesh, tip corners included."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.events import event_lines
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.loaded_life import (
    Life,
    corner_shades,
    needs_loaded_contact,
    pair_letters,
    roll_angle_of,
    roll_label,
    span,
)
from tribodyn.plot.style import Panel, line, stack
from tribodyn.plot.torques import named, torque_colors, torque_names
from tribodyn.types import Array, Mask

#: Part of the greatest force that counts as load, and difference of teeth that is drawn.
_LOADED, _DIFFERENT = 1e-6, 1e-3


def _caption(contact: Any) -> str:
    driving = contact.gear_pair.driver
    driven = "wheel" if driving == "pinion" else "pinion"
    return (
        "A pair takes over load as it comes in and hands it on before it leaves. Where the "
        f"background is grey a tip corner bears off the line of action: before A that of the "
        f"{driven}, after E that of the {driving}. High forces there press hard and call for "
        "tip relief. Where teeth differ, the band goes from the least to the most loaded pair."
    )


def _band(x: Array, least: Array, greatest: Array, color: str) -> dict[str, Any]:
    """Fill between the least and the most loaded pair."""
    return {
        "type": "scatter",
        "mode": "lines",
        "x": np.concatenate((x, x[::-1])),
        "y": np.concatenate((greatest, least[::-1])),
        "fill": "toself",
        "fillcolor": color,
        "opacity": 0.25,
        "line": {"width": 0, "color": color},
        "hoverinfo": "skip",
        "showlegend": False,
    }


def _traces(contact: Any, life: Life, seen: Mask) -> list[dict[str, Any]]:
    x = displayed("roll_angle", roll_angle_of(contact.gear_pair, life.age[seen]))
    newton, names = display_unit("normal_force"), torque_names(contact)
    traces = []
    for row, (name, color, shown) in enumerate(
        zip(names, torque_colors(len(names)), named(len(names)), strict=True)
    ):
        least, mean, most = (
            displayed("normal_force", part[row][seen])
            for part in (life.least, life.mean, life.greatest)
        )
        if np.max(most - least) > _DIFFERENT * np.max(most):
            traces.append(_band(x, least, most, color))
        trace = line(x, mean, name, color, unit=newton)
        traces.append({**trace, "showlegend": shown and len(names) > 1})
    return traces


@drawing("loaded_sharing", heading="Load sharing", caption=_caption, needs=needs_loaded_contact)
def loaded_sharing(contact: Any) -> Any:
    """Draw the force on one tooth pair from where it begins to carry to where it ends.

    Parameters
    ----------
    contact : LoadedContact
        What :func:`tribodyn.stiffness.loaded_contact` returns, for one torque or several.

    Returns
    -------
    plotly.graph_objects.Figure
        One curve for each torque; where the teeth differ the mean of all pairs and a band.
    """
    pair, (first, last) = contact.gear_pair, span(contact)
    life = Life.of(contact, contact.normal_force)
    seen = (life.age >= first) & (life.age <= last)
    peak = life.greatest.max()
    loaded = life.age[(life.greatest > _LOADED * peak).any(axis=0)]
    layout = event_lines(pair_letters(pair))
    for kind, found in corner_shades(pair, float(loaded.min()), float(loaded.max())).items():
        layout[kind] = [*found, *layout[kind]]
    layout["xaxis"] = {
        "range": displayed("roll_angle", roll_angle_of(pair, np.array([first, last]))).tolist()
    }
    return stack(
        f"A tooth pair carries up to {rounded('normal_force', float(peak))}",
        roll_label(pair),
        [
            Panel(
                axis_label("normal_force", "Force on a tooth pair"),
                _traces(contact, life, seen),
                {"rangemode": "tozero"},
                1.6,
            )
        ],
        layout,
    )
