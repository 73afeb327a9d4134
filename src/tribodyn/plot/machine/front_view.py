"""Natural modes of a planetary stage in front view."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.theme.labels import significant
from tribodyn.plot.theme.style import MUTED, PAIR_COLORS, PINION, WHEEL, Trace, figure, translucent
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine import PlanetaryModes

#: Colour of each type of mode.
COLORS = {
    "rotational": PINION,
    "translational": WHEEL,
    "planet": PAIR_COLORS[0],
    "mixed": PAIR_COLORS[1],
}
#: Colour of the stage at rest.
_REST = translucent(MUTED, 0.4)
#: Largest displacement over the radius of the pins, largest radius of a planet, points of a circle.
_SIZE, _PLANET, _POINTS = 0.16, 0.4, 72
_TURN = np.linspace(0.0, 2.0 * np.pi, _POINTS + 1)


def _outlines(angles: Array, motion: Array) -> tuple[list[float], list[float]]:
    """Pitch circles with a mark each, and the arms of the carrier, displaced by a motion."""
    gaps = np.diff(np.sort(angles), append=np.sort(angles)[0] + 2.0 * np.pi)
    planet = min(_PLANET, 0.9 * np.sin(min(float(gaps.min()), np.pi) / 2.0))
    carrier, ring, sun = motion[:9].reshape(3, 3)
    pins = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    bodies = [(np.zeros(2), 1.0 - planet, sun), (np.zeros(2), 1.0 + planet, ring)]
    bodies += [(p, planet, m) for p, m in zip(pins, motion[9:].reshape(-1, 3), strict=True)]
    x: list[float] = []
    y: list[float] = []
    for at, radius, (dx, dy, turn) in bodies:
        # A mark inside the rim of a gear, and outside that of the ring.
        start = 1.0 if radius > 1.0 else 0.6
        end = 1.08 if radius > 1.0 else 1.0
        mark = radius * np.exp(1j * turn / radius) * np.array([start, end])
        circle = radius * np.exp(1j * _TURN)
        points = np.concatenate([circle, [np.nan], mark, [np.nan]]) + complex(*at) + dx + 1j * dy
        x += points.real.tolist()
        y += points.imag.tolist()
    turned = np.exp(1j * (angles + carrier[2])) + carrier[0] + 1j * carrier[1]
    for pin in turned:
        x += [carrier[0], pin.real, np.nan]
        y += [carrier[1], pin.imag, np.nan]
    return x, y


def _trace(angles: Array, motion: Array, color: str, width: float, visible: bool) -> Trace:
    x, y = _outlines(angles, motion)
    style: Trace = {"type": "scatter", "mode": "lines", "hoverinfo": "skip", "showlegend": False}
    return {**style, "x": x, "y": y, "line": {"color": color, "width": width}, "visible": visible}


@drawing(
    "planetary_modes",
    heading="Natural modes of the planetary stage",
    caption="Choose a mode: pitch circles of sun, ring and planets and the arms of the carrier, at "
    "rest (grey) and displaced, in the colour of the type of the mode. A mark on each gear shows "
    "its rotation. The displacements have one scale; the radii are schematic.",
    of=("PlanetaryModes",),
    made_by="Call tribodyn.machine.planetary_modes on a plane model.",
)
def planetary_modes(modes: PlanetaryModes) -> Any:
    """Draw the natural modes of a planetary stage, one at a time."""
    angles = np.asarray(modes.angles)
    count = modes.frequency.size
    labels = [
        f"{i + 1}: {significant(float(modes.frequency[i]), 5)} Hz, {modes.types[i]}"
        for i in range(count)
    ]
    first = next((i for i in range(count) if modes.frequency[i] > 0.0), 0)
    traces = [_trace(angles, np.zeros(len(modes.names)), _REST, 2.0, True)]
    for i in range(count):
        motion = np.real(modes.shape[i])
        motion = _SIZE * motion / np.abs(motion).max()
        traces.append(_trace(angles, motion, COLORS[modes.types[i]], 1.6, i == first))
    buttons = [
        {
            "label": label,
            "method": "update",
            "args": [{"visible": [True, *(k == i for k in range(count))]}, {"title.text": label}],
        }
        for i, label in enumerate(labels)
    ]
    menu = {"buttons": buttons, "active": first, "x": 1.0, "xanchor": "right", "y": 1.12}
    axis = {"visible": False, "range": [-1.7, 1.7]}
    layout = {
        "height": 620,
        "hovermode": False,
        "updatemenus": [{**menu, "yanchor": "top", "bgcolor": "white", "bordercolor": MUTED}],
        "xaxis": axis,
        "yaxis": {**axis, "scaleanchor": "x"},
    }
    return figure(labels[first], traces, layout)
