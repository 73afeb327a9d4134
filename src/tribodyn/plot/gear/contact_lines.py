"""Teeth of the pinion in space, with the lines of contact that move over their flanks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.drawing import Sketch, drawing
from tribodyn.gear import tooth_outline
from tribodyn.plot.mesh.cycle import PAIRS, RUN
from tribodyn.plot.theme.colors import INK, MUTED, PINION, WHEEL
from tribodyn.plot.theme.labels import rounded, significant
from tribodyn.plot.theme.style import ABOVE, Trace, animated, figure, player
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.gear import CylindricalPair

#: Points of a tooth, sections over the face, and phases of the mesh cycle.
_POINTS, _SECTIONS, _FRAMES = 61, 15, 24
#: Duration of a frame [ms].
_DURATION = 120
#: Sense of the helix: a right-hand tooth turns ahead along the axis.
_SENSES = {"right": 1.0, "left": -1.0}


def _in_space(pair: CylindricalPair, face: Array, radius: Array, angle: Array) -> Array:
    """Points [mm] along the axis and across it, for angles in the section at mid face."""
    gear, pairs = pair.pinion, path_of_contact(pair).pairs
    twist = _SENSES[pair.hand] * face * math.tan(gear.helix_angle) / gear.reference_radius
    # The middle one of the teeth in contact points upwards.
    turned = angle + twist + math.pi * (0.5 - (pairs - 1) / gear.teeth)
    along, radius = np.broadcast_arrays(face, radius)
    return np.asarray(1e3 * np.array([along, radius * np.cos(turned), radius * np.sin(turned)]))


def _flank_angle(pair: CylindricalPair, tooth: int, radius: Array) -> Array:
    """Angle of a point on the flank that touches: the front of a driving pinion's tooth."""
    gear, contact = pair.pinion, path_of_contact(pair)
    half = [gear.half_tooth_angle(max(float(r), gear.base_radius)) for r in radius]
    return 2.0 * math.pi * tooth / gear.teeth + contact.direction * np.array(half)


def line_points(pair: CylindricalPair, phase: float) -> list[Array]:
    """Points of each line of contact on the flanks of the pinion [mm], shape (3, points)."""
    contact, width = path_of_contact(pair), pair.common_face_width
    tangent, lines = math.tan(pair.base_helix_angle), []
    for tooth in range(contact.pairs):
        travel, ends = (phase + tooth) * pair.base_pitch, np.array([0.0, width])
        if tangent > 0.0:
            ends = np.clip(ends, (travel - contact.length) / tangent, travel / tangent)
        if ends[1] > ends[0] and travel - ends[1] * tangent < contact.length:
            entry = np.linspace(ends[0], ends[1], _SECTIONS)
            path = contact.A + contact.direction * (travel - entry * tangent)
            radius = np.hypot(pair.pinion.base_radius, path)
            face = _SENSES[pair.hand] * (0.5 * width - entry)
            lines.append(_in_space(pair, face, radius, _flank_angle(pair, tooth, radius)))
    return lines


def _tooth(pair: CylindricalPair, tooth: int) -> Trace:
    """Skin of a tooth over the common face."""
    half = 0.5 * pair.common_face_width
    x, y = tooth_outline(pair.pinion, _POINTS)
    face = np.linspace(-half, half, _SECTIONS)[:, None]
    angle = 2.0 * math.pi * tooth / pair.pinion.teeth + np.arctan2(-x, y)
    points = _in_space(pair, face, np.hypot(x, y), angle)
    color = [[0.0, PINION], [1.0, PINION]]
    light = {"ambient": 0.75, "diffuse": 0.5, "specular": 0.05}
    style = {"showscale": False, "colorscale": color, "opacity": 0.7, "lighting": light}
    skin = dict(zip("xyz", points, strict=True))
    return {"type": "surface", **skin, **style, "hoverinfo": "skip"}


def _curves(lines: list[Array], name: str, color: str, width: float) -> Trace:
    """Curves in space as one trace, with gaps between them."""
    gap = np.full((3, 1), np.nan)
    points = np.hstack([part for curve in lines for part in (curve, gap)] or [gap])
    style = {"name": name, "line": {"color": color, "width": width}, "hoverinfo": "name"}
    return {"type": "scatter3d", "mode": "lines", **dict(zip("xyz", points, strict=True)), **style}


def _ends(pair: CylindricalPair, teeth: range) -> list[Array]:
    """Ends of the path of contact over the face, on each tooth."""
    half, curves = 0.5 * pair.common_face_width, []
    for path in pair.path_limits:
        radius = np.full(2 * _SECTIONS, math.hypot(pair.pinion.base_radius, path))
        face = np.linspace(-half, half, radius.size)
        curves += [
            _in_space(pair, face, radius, _flank_angle(pair, tooth, radius)) for tooth in teeth
        ]
    return curves


def _label(pair: CylindricalPair, phase: float) -> str:
    length = rounded("contact_line_length", pair.contact_line_length(phase))
    count = len(line_points(pair, phase))
    return f"Mesh phase {significant(phase, 2)}: {length} of contact on {count} tooth pairs"


def _straight(pair: CylindricalPair) -> str:
    """Reason why spur gears are not drawn."""
    if pair.helix_angle:
        return ""
    return "The lines of contact of spur gears lie straight along the face."


@drawing(
    heading="Lines of contact",
    caption="Teeth of the pinion with the lines along which the wheel touches them. On a helical "
    "gear a line enters at a corner of the flank and leaves at the opposite one. The thin lines "
    "are the ends of the path of contact; the slider turns the gears through a mesh cycle.",
    of=PAIRS,
    missing=_straight,
    made_by=RUN,
)
def contact_lines(pair: CylindricalPair) -> Sketch:
    """Draw the flanks of the pinion in space with the moving lines of contact."""
    teeth = range(-1, path_of_contact(pair).pairs + 1)
    phases = np.arange(_FRAMES) / _FRAMES
    moving = [_curves(line_points(pair, phase), "lines of contact", WHEEL, 9) for phase in phases]
    still = [
        *(_tooth(pair, tooth) for tooth in teeth),
        _curves(_ends(pair, teeth), "ends of the path of contact", MUTED, 2),
    ]
    axes = {"xaxis": "Along the face [mm]", "yaxis": "y [mm]", "zaxis": "z [mm]"}
    side = -1.0 if pair.driver == "pinion" else 1.0
    slider = {"x": 0.16, "len": 0.84, "y": -0.02}
    labels = [_label(pair, float(phase)) for phase in phases]
    camera = {"eye": {"x": 0.95, "y": 1.75 * side, "z": 1.2}, "center": {"z": -0.15}}
    titles = {k: {"title": {"text": text, "font": {"color": INK}}} for k, text in axes.items()}
    layout = {
        "scene": {**titles, "aspectmode": "data", "camera": camera},
        "height": 640,
        "hovermode": "closest",
        "margin": {"l": 20, "r": 20, "t": 60, "b": 110},
        "legend": ABOVE,
        **player(labels, _DURATION, redraw=True, slider=slider, buttons=-0.04),
    }
    least, greatest = (
        rounded("contact_line_length", length)
        for length in (pair.least_contact_line_length, pair.greatest_contact_line_length)
    )
    title = f"{least} to {greatest} of contact lines over the mesh cycle"
    sketch = figure(title, [*still, moving[0]], layout)
    return animated(sketch, [[trace] for trace in moving], [len(still)])
