"""Deformation of the teeth in mesh, exaggerated, with the loads as arrows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.gear.gear_pair import BentMesh, bent_mesh, on_line_of_action, wheel_center
from tribodyn.plot.mesh.loaded_contact import several_cycles, torque_names
from tribodyn.plot.theme.colors import FILLS, INK, MUTED, PINION, WHEEL
from tribodyn.plot.theme.labels import axis_label, displayed, rounded, significant
from tribodyn.plot.theme.style import ABOVE, BARE, Trace, animated, axis, figure, player, strokes
from tribodyn.types import ComplexArray

if TYPE_CHECKING:
    from tribodyn.gear import SpurPair
    from tribodyn.stiffness import LoadedContact

#: Mesh phases of the slider.
_FRAMES = 8
#: Plotted size of the largest displacement, and length of the longest force arrow [modules].
_LARGEST_DISPLACEMENT, _ARROW = 0.25, 1.3
#: Half width and half height of the window [modules], height [px], time of a phase [ms].
_WINDOW, _HEIGHT, _FRAME = (3.6, 2.9), 760, 500
_GEARS = (("pinion", PINION), ("wheel", WHEEL))


def _exaggeration(meshes: Sequence[BentMesh], module: float) -> float:
    """Round magnification (1, 2 or 5 times a power of ten) that makes displacements visible."""
    largest = max(
        float(np.abs(mesh.displacement[name]).max()) for mesh in meshes for name, _ in _GEARS
    )
    target = _LARGEST_DISPLACEMENT * module / largest
    power = 10.0 ** math.floor(math.log10(target))
    return power * max(digit for digit in (1.0, 2.0, 5.0) if digit * power <= target)


def _trace(points: ComplexArray, name: str, **more: Any) -> Trace:
    # Single precision halves the size of the figure.
    x, y = displayed("center_distance", np.array([points.real, points.imag])).astype(np.float32)
    return strokes(x, y, INK, name=name, **more)


def _gears(pair: SpurPair, mesh: BentMesh, factor: float) -> list[Trace]:
    """Grey outlines without load and filled, coloured outlines under load."""
    traces = []
    for name, color in _GEARS:
        outline = mesh.outline[name]
        bent = outline + factor * mesh.displacement[name]
        center = 0.0 if name == "pinion" else wheel_center(pair)
        # Close the section towards the axis, far below the teeth; that of a ring outwards.
        far = 1.3 if name == "wheel" and pair.is_internal else 0.2
        axial = center + far * (bent[[-1, 0]] - center)
        closed = np.concatenate((bent, axial, bent[:1]))
        fill: Trace = {"fill": "toself", "fillcolor": FILLS[color]}
        fill["line"] = {"color": color, "width": 1.8}
        traces.append(_trace(closed, f"{name}, loaded", **fill))
    for name, _ in _GEARS:
        grey: Trace = {"line": {"color": MUTED, "width": 0.9}, "legendgroup": "rest"}
        grey["showlegend"] = name == "pinion"
        traces.append(_trace(mesh.outline[name], "without load", **grey))
    return traces


def _arrows(contact: LoadedContact, mesh: BentMesh, factor: float, greatest: float) -> list[Trace]:
    """Force on the driven gear at each contact, along the line of action, and its value."""
    pair = contact.gear_pair
    along = np.diff(on_line_of_action(pair, np.array([0.0, 1.0])))[:, 0]
    sense = 1.0 if pair.driver == "pinion" else -1.0
    direction = sense * complex(*along)
    heads = mesh.contact + factor * mesh.shift
    points, sizes, tails, force_labels = [], [], [], []
    for head, load in zip(heads, mesh.loads, strict=True):
        tail = head - direction * _ARROW * pair.pinion.normal_module * load.force / greatest
        points += [tail, head, complex(math.nan, math.nan)]
        sizes += [0, 13, 0]
        tails.append(tail)
        force_labels.append(f"<b>{rounded('normal_force', load.force)}</b>")
    marker = {"symbol": "arrow", "angleref": "previous", "size": sizes, "opacity": 1, "color": INK}
    style = {"mode": "lines+markers", "marker": marker, "line": {"color": INK, "width": 2.5}}
    side = "bottom center" if direction.imag > 0.0 else "top center"
    label = {"mode": "text", "text": force_labels, "textposition": side, "textfont": {"color": INK}}
    return [
        _trace(np.array(points), "force on the driven gear", **style),
        _trace(np.array(tails), "values", showlegend=False, **label),
    ]


def _player(labels: Sequence[str]) -> Trace:
    slider = {"x": 0.16, "len": 0.84, "y": -0.1}
    return player(labels, _FRAME, redraw=True, slider=slider, buttons=-0.12)


def _window(contact: LoadedContact) -> Trace:
    """Axes of equal scale around the middle of the path of contact."""
    pair = contact.gear_pair
    ends = on_line_of_action(pair, np.array(pair.path_limits))
    # High enough for the path of contact and the arrows.
    half_height = 0.5 * abs(ends[1, 1] - ends[1, 0]) + _ARROW * pair.pinion.normal_module
    scale = max(1.0, half_height / (_WINDOW[1] * pair.pinion.normal_module))
    middle = displayed("center_distance", ends.mean(axis=1))
    half = displayed("center_distance", scale * np.array(_WINDOW) * pair.pinion.normal_module)
    x, y = (
        axis(axis_label("center_distance", name), range=[float(at - reach), float(at + reach)])
        for name, at, reach in zip("xy", middle, half, strict=True)
    )
    return {"xaxis": {**x, **BARE}, "yaxis": {**y, "scaleanchor": "x", **BARE}}


def _chosen(contact: LoadedContact, phase: float | None) -> list[int]:
    """Indices of the plotted phases."""
    if phase is not None:
        period = contact.mesh_cycles if several_cycles(contact) else 1
        distance = np.abs((contact.phase - phase + 0.5 * period) % period - 0.5 * period)
        return [int(np.argmin(distance))]
    first = np.flatnonzero(contact.phase < 1.0)
    places = np.linspace(0, first.size, min(_FRAMES, first.size), endpoint=False)
    return [int(place) for place in places]


@drawing(
    heading="Deformation of the teeth",
    of="LoadedContact",
    made_by="Call tribodyn.loaded_contact(case) and its plot method.",
)
def mesh_deformation(
    contact: LoadedContact, *, phase: float | None = None, torque: int = -1
) -> Sketch:
    """Draw the teeth in mesh with exaggerated deformation, and their loads.

    Teeth in mesh: grey without load, coloured with the deformation under load, exaggerated. The
    arrows are the forces on the driven gear. The bores are fixed, and the driving gear is rotated
    until the flanks touch.

    Parameters
    ----------
    contact : LoadedContact
        What :func:`tribodyn.stiffness.loaded_contact` returns. Finite elements compute
        the deformation, whatever model the loads come from.
    phase : float, optional
        Mesh phase; by default a slider over the mesh cycle.
    torque : int
        Index of the torque.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    pair, chosen = contact.gear_pair, _chosen(contact, phase)
    torque %= int(np.size(contact.torque))
    meshes = [bent_mesh(contact, at, torque) for at in chosen]
    factor = _exaggeration(meshes, pair.pinion.normal_module)
    greatest = max(load.force for mesh in meshes for load in mesh.loads)
    frames = [
        [*_gears(pair, mesh, factor), *_arrows(contact, mesh, factor, greatest)] for mesh in meshes
    ]
    errors = np.reshape(contact.transmission_error, (-1, contact.phase.size))[torque]
    labels = [
        f"Mesh phase {significant(contact.phase[at], 2)}: transmission error "
        f"{rounded('static_transmission_error', errors[at])}"
        for at in chosen
    ]
    several, load = len(frames) > 1, torque_names(contact.torque)[torque]
    sketch = figure(
        f"Deformation under {load}, magnified {factor:g} times",
        frames[0],
        {
            **_window(contact),
            **(_player(labels) if several else {}),
            "height": _HEIGHT,
            "hovermode": False,
            "margin": {"l": 70, "r": 24, "t": 74, "b": 150 if several else 58},
            "legend": ABOVE,
        },
    )
    return animated(sketch, frames) if several else sketch
