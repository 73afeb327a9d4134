"""Transmission error, stiffness and load sharing of a loaded tooth contact at rest."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.events import event_lines
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.loaded_life import (
    Life,
    needs_loaded_contact,
    pair_letters,
    roll_angle_of,
    roll_label,
    rows,
    several_cycles,
    span,
    whole_cycles,
)
from tribodyn.plot.style import Panel, line, stack
from tribodyn.plot.torques import named, torque_colors, torque_names
from tribodyn.types import Array

_QUANTITY = "static_transmission_error"
#: Width of lines over many mesh cycles or for more than a few torques [px].
_THIN, _FEW = 1.2, 8
#: Torques for which stiffness is drawn: its curves lie close to one another.
_STIFFNESSES = 4


def _title(contact: Any) -> str:
    """Answer: mean and swing of the transmission error."""
    names = torque_names(contact)
    swings = np.ravel(contact.peak_to_peak_transmission_error)
    if len(names) == 1:
        mean, swing = (
            rounded(_QUANTITY, float(value))
            for value in (np.mean(contact.transmission_error), swings[0])
        )
        return f"Under {names[0]} the transmission error is {mean} on average and varies by {swing}"
    low, high = (rounded(_QUANTITY, float(at(swings))) for at in (np.min, np.max))
    return f"From {names[0]} to {names[-1]} the transmission error varies by {low} to {high}"


def _over(contact: Any, values: Array) -> tuple[Array, Array]:
    """Values of the whole mesh over what the figure has as its horizontal axis."""
    if several_cycles(contact):
        return whole_cycles(contact.phase, values, contact.mesh_cycles)
    first, last = span(contact)
    cycles = range(int(np.floor(first)), int(np.ceil(last)))
    age = np.concatenate([contact.phase + cycle for cycle in cycles])
    seen = (age >= first) & (age <= last)
    angle = displayed("roll_angle", roll_angle_of(contact.gear_pair, age[seen]))
    return angle, np.tile(values, len(cycles))[seen]


def _curves(contact: Any, quantity: str, values: Array, **look: Any) -> list[dict[str, Any]]:
    """One curve for each torque."""
    colors, names = torque_colors(np.size(contact.torque)), torque_names(contact)
    known, traces = named(len(names)), []
    for color, name, shown, each in zip(colors, names, known, rows(contact, values), strict=True):
        x, y = _over(contact, displayed(quantity, each))
        trace = line(
            x,
            y,
            look.get("name", name),
            color,
            unit=display_unit(quantity),
            dash=look.get("dash", "solid"),
            width=_THIN if several_cycles(contact) or len(names) > _FEW else 2.0,
        )
        traces.append({**trace, "showlegend": shown and len(names) > 1})
    return traces


def _stiffness(contact: Any) -> list[dict[str, Any]]:
    """Secant solid, tangent dashed; the legend tells the dashes, not the torques again."""
    if several_cycles(contact):
        found = _curves(contact, "mesh_stiffness_secant", contact.mesh_stiffness_secant)
        return [{**trace, "showlegend": False} for trace in found]
    traces: list[dict[str, Any]] = []
    chosen = named(np.size(contact.torque), _STIFFNESSES)
    for kind, dash in (("secant", "solid"), ("tangent", "dash")):
        name = f"mesh_stiffness_{kind}"
        found = _curves(contact, name, getattr(contact, name), name=kind, dash=dash)
        kept = [trace for trace, shown in zip(found, chosen, strict=True) if shown]
        traces += [{**trace, "showlegend": number == 0} for number, trace in enumerate(kept)]
    return traces


def _shares(contact: Any) -> list[dict[str, Any]]:
    """Load share: of one tooth pair over its way, or of all pairs over the mesh cycles."""
    if several_cycles(contact):
        return _shares_over_cycles(contact)
    life = Life.of(contact, contact.load_share)
    first, last = span(contact)
    seen = (life.age >= first) & (life.age <= last)
    x = displayed("roll_angle", roll_angle_of(contact.gear_pair, life.age[seen]))
    colors, names = torque_colors(np.size(contact.torque)), torque_names(contact)
    return [
        {**line(x, share[seen], name, color), "showlegend": False}
        for color, name, share in zip(colors, names, life.mean, strict=True)
    ]


def _shares_over_cycles(contact: Any) -> list[dict[str, Any]]:
    """Share of the pair that carries most, for each torque."""
    greatest = np.max(contact.load_share, axis=-1)
    period = contact.mesh_cycles
    colors, names = torque_colors(np.size(contact.torque)), torque_names(contact)
    return [
        {
            **line(*whole_cycles(contact.phase, share, period), name, color, width=_THIN),
            "showlegend": False,
        }
        for color, name, share in zip(colors, names, rows(contact, greatest), strict=True)
    ]


@drawing(
    "loaded_contact",
    heading="Loaded tooth contact",
    caption="The transmission error is the way by which the loaded gears approach along the line "
    "of action; what varies in it excites the vibration. The tangent of the stiffness counts for "
    "small vibration about the load, the secant for the whole deflection. A pair that carries "
    "before A or after E does so on a tip corner.",
    needs=needs_loaded_contact,
)
def loaded_contact(contact: Any) -> Any:
    """Draw transmission error, stiffness and load sharing of a loaded tooth contact.

    Parameters
    ----------
    contact : LoadedContact
        What :func:`tribodyn.stiffness.loaded_contact` returns, for one torque or several.

    Returns
    -------
    plotly.graph_objects.Figure
        Over the roll angle of the driving gear, from where a pair begins to carry to where it
        ends; over all mesh cycles where the teeth differ.
    """
    hunting, pair = several_cycles(contact), contact.gear_pair
    stiffness = "Secant stiffness" if hunting else "Mesh stiffness"
    share = "Greatest load share" if hunting else "Load share of a pair"
    panels = [
        Panel(
            axis_label(_QUANTITY, "Transmission error"),
            _curves(contact, _QUANTITY, contact.transmission_error),
        ),
        Panel(axis_label("mesh_stiffness", stiffness), _stiffness(contact)),
        Panel(share, _shares(contact), {"range": [0.0, 1.05]}, 0.8),
    ]
    if hunting:
        label, layout = axis_label("mesh_phase", "Mesh cycles"), {}
        layout["xaxis"] = {"range": [0.0, contact.mesh_cycles]}
    else:
        ends = roll_angle_of(pair, np.array(span(contact)))
        label, layout = roll_label(pair), event_lines(pair_letters(pair))
        layout["xaxis"] = {"range": displayed("roll_angle", ends).tolist()}
    return stack(_title(contact), label, panels, layout)
