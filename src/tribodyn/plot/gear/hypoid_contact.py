"""Contact pattern of a hypoid pair with its path, and its transmission error."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.look.panels import Panel, Row, stack_rows
from tribodyn.plot.look.style import (
    FILLS,
    INK,
    MUTED,
    PAIR_COLORS,
    PINION,
    WHEEL,
    Trace,
    line,
    marked,
)

if TYPE_CHECKING:
    from tribodyn.gear import ToothContact

#: Contact lines that are drawn, at most.
_LINES = 24
#: Tooth pairs before and after the one that is followed.
_PAIRS = (-1, 0, 1)


def _outline(contact: ToothContact) -> Trace:
    """Ends of all contact lines: the flank that both gears share."""
    ends = [
        np.concatenate([cells[:, 0], cells[::-1, -1], cells[:1, 0]]) * 1e3
        for cells in (contact.cell_along, contact.cell_across)
    ]
    return line(ends[0], ends[1], "flank of both gears", MUTED, unit="mm", dash="dash")


def _lines(contact: ToothContact) -> Trace:
    every = slice(None, None, -(-len(contact.rotation) // _LINES))
    ends = []
    for cells in (contact.cell_along, contact.cell_across):
        gap = np.full((len(cells[every]), 1), np.nan)
        ends.append(1e3 * np.hstack([cells[every], gap]).ravel())
    trace = line(ends[0], ends[1], "contact lines", MUTED, unit="mm", width=0.7)
    return trace | {"hoverinfo": "skip", "hovertemplate": None}


def _pattern(contact: ToothContact) -> Trace:
    """Marked part of every line, joined from line to line."""
    inside = contact.marked & contact.leads[:, None]
    rows = np.flatnonzero(inside.any(axis=1))
    first = inside[rows].argmax(axis=1)
    last = inside.shape[1] - 1 - inside[rows, ::-1].argmax(axis=1)
    edge = [
        1e3
        * np.concatenate([cells[rows, first], cells[rows, last][::-1], cells[rows[:1], first[:1]]])
        for cells in (contact.cell_along, contact.cell_across)
    ]
    words = f"marked at {contact.marking_thickness * 1e6:.3g} µm"
    area = line(edge[0], edge[1], words, PINION, unit="mm", width=1.0)
    return area | {"fill": "toself", "fillcolor": FILLS[PINION]}


def _path(contact: ToothContact) -> list[Trace]:
    x, y = 1e3 * contact.along, 1e3 * contact.across
    leads = contact.leads
    path = line(x[leads], y[leads], "path of contact", WHEEL, unit="mm", width=2.5)
    edges = leads & contact.on_edge
    if not np.any(edges):
        return [path]
    return [path, marked(x[edges], y[edges], "edge contact", INK, size=7, symbol="x", unit="mm")]


def _error(contact: ToothContact) -> Panel:
    """Transmission error of neighbouring pairs, each a pitch after the one before."""
    pitch = 360.0 / contact.flanks.blank.teeth_wheel
    turn, error = np.degrees(contact.rotation), 1e6 * contact.angular_transmission_error
    inner = ~contact.on_edge if np.any(~contact.on_edge) else np.ones(len(turn), bool)
    curves = [
        line(
            turn[inner] + pair * pitch,
            error[inner],
            "this pair" if pair == 0 else f"pair {'before' if pair < 0 else 'after'}",
            PINION if pair == 0 else PAIR_COLORS[pair],
            unit="µrad",
            dash="solid" if pair == 0 else "dot",
        )
        for pair in _PAIRS
    ]
    low = float(error[contact.leads].min())
    span = max(float(np.ptp(error[contact.leads])), 1e-3)
    return Panel("Wheel ahead [µrad]", curves, {"range": [low - 1.5 * span, low + 1.4 * span]})


@drawing(
    "hypoid_contact",
    heading="Contact pattern",
    caption="The flank of the wheel: where the marking compound is squeezed away, the path of the "
    "contact over it, and the contact lines of the conjugate flanks. Below, how far each pair lets "
    "the wheel run ahead; the pair whose curve is on top touches. Curves end where edges touch.",
    of=("ToothContact", "Result.hypoid_contact"),
    made_by="tribodyn.gear.tooth_contact makes one.",
)
def hypoid_contact(contact: ToothContact) -> Any:
    """Draw contact pattern, path of contact and transmission error."""
    flank = [_outline(contact), _lines(contact), _pattern(contact), *_path(contact)]
    rows = [
        Row(
            "Along the pitch cone of the wheel, towards the heel [mm]",
            Panel("Across, towards the tip [mm]", flank, {"scaleanchor": "x"}, height=1.4),
        ),
        Row("Rotation of the wheel from the calculation point [°]", _error(contact)),
    ]
    title = (
        f"Transmission error of {contact.peak_to_peak * 1e6:.3g} µrad on the "
        f"{contact.flanks.side} flank, contact ratio {contact.contact_ratio:.2f}"
    )
    return stack_rows(title, rows, {"hovermode": "closest"})
