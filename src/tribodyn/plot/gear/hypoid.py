"""A hypoid pair: blank sections, the pair in space, ease-off and contact pattern."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.errors import quiet
from tribodyn.gear import hypoid_flanks
from tribodyn.plot.theme.colors import FILLS, INK, MUTED, PAIR_COLORS, PINION, WHEEL, translucent
from tribodyn.plot.theme.panels import Panel, Row, stack_rows
from tribodyn.plot.theme.style import Trace, axis, dots, figure, line, marked
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.gear import HypoidBlank, HypoidFlanks, ToothContact


def _section(blank: HypoidBlank, gear: str, cone: str) -> Array:
    """Axial positions and radii of toe and heel on a cone, normal to the pitch cone [mm]."""
    pitch = getattr(blank, f"pitch_angle_{gear}")
    angle, apex = getattr(blank, f"{cone}_angle_{gear}"), getattr(blank, f"{cone}_apex_{gear}")
    points = []
    for end in ("inner", "outer"):
        distance = getattr(blank, f"{end}_cone_distance_{gear}")
        place = distance * math.cos(pitch) - getattr(blank, f"pitch_apex_{gear}")
        radius = distance * math.sin(pitch)
        step = (place + apex) * math.sin(angle) - radius * math.cos(angle)
        step /= math.cos(angle - pitch)
        points.append((place - step * math.sin(pitch), radius + step * math.cos(pitch)))
    return 1e3 * np.array(points).T


def _panel(blank: HypoidBlank, gear: str, color: str) -> Row:
    tip, root, pitch = (_section(blank, gear, cone) for cone in ("face", "root", "pitch"))
    outline = np.hstack([tip, root[:, ::-1], tip[:, :1]])
    hand = blank.hand_pinion
    hand = hand if gear == "pinion" else {"left": "right", "right": "left"}[hand]
    tooth: Trace = line(outline[0], outline[1], f"{gear}, {hand}-handed", color, unit="mm")
    tooth |= {"fill": "toself", "fillcolor": FILLS[color]}
    mean = 0.5e3 * getattr(blank, f"mean_pitch_diameter_{gear}")
    place = 1e3 * getattr(blank, f"calculation_point_{gear}")
    traces = [
        tooth,
        line(pitch[0], pitch[1], "pitch cone", MUTED, unit="mm", dash="dash"),
        line([place], [mean], "calculation point", color, unit="mm") | {"mode": "markers"},
    ]
    label = f"Position along the axis of the {gear} from the crossing point [mm]"
    return Row(label, Panel("Radius [mm]", traces), {"scaleanchor": "y"})


@drawing(heading="Blanks", of="HypoidBlank", made_by="Call tribodyn.gear.hypoid_blank.")
def hypoid_blank(blank: HypoidBlank) -> Sketch:
    """Draw the sections of both blanks.

    Sections of the teeth in the axial plane of each gear: tip, root and pitch cone from toe to
    heel, to scale, with the clearance between the tip and the root of the mating gear.
    """
    rows = [_panel(blank, "pinion", PINION), _panel(blank, "wheel", WHEEL)]
    rows[1].axis["scaleanchor"] = "y2"
    title = (
        f"{blank.teeth_pinion} teeth against {blank.teeth_wheel}, offset "
        f"{blank.offset * 1e3:g} mm: spiral angles "
        f"{math.degrees(blank.mean_spiral_angle_pinion):.1f}° and "
        f"{math.degrees(blank.mean_spiral_angle_wheel):.1f}°"
    )
    return stack_rows(title, rows, {"hovermode": "closest"})


#: Most contact lines in the plot.
_LINES = 24
#: Preceding, current and following tooth pair.
_PAIRS = (-1, 0, 1)


def outline(contact: ToothContact) -> Trace:
    """Ends of all contact lines: the common flank of both gears."""
    ends = [
        np.concatenate([cells[:, 0], cells[::-1, -1], cells[:1, 0]]) * 1e3
        for cells in (contact.cell_along, contact.cell_across)
    ]
    return line(ends[0], ends[1], "common flank", MUTED, unit="mm", dash="dash")


def _lines(contact: ToothContact) -> Trace:
    every = slice(None, None, -(-len(contact.rotation) // _LINES))
    ends = []
    for cells in (contact.cell_along, contact.cell_across):
        gap = np.full((len(cells[every]), 1), np.nan)
        ends.append(1e3 * np.hstack([cells[every], gap]).ravel())
    trace = line(ends[0], ends[1], "contact lines", MUTED, unit="mm", width=0.7)
    return trace | {"hoverinfo": "skip", "hovertemplate": None}


def pattern(contact: ToothContact, label: str, color: str) -> Trace:
    """Outline of the marked parts of all contact lines."""
    inside = contact.marked & contact.leads[:, None]
    rows = np.flatnonzero(inside.any(axis=1))
    first = inside[rows].argmax(axis=1)
    last = inside.shape[1] - 1 - inside[rows, ::-1].argmax(axis=1)
    gap, thickness = contact.clearance, contact.marking_thickness
    shares = []
    for cell, step in ((first, -1), (last, 1)):
        # The compound ends between the last marked cell and the next.
        beyond = np.clip(cell + step, 0, gap.shape[1] - 1)
        rise = gap[rows, beyond] - gap[rows, cell]
        share = (thickness - gap[rows, cell]) / np.where(rise > 0.0, rise, np.inf)
        shares.append((cell, beyond, np.clip(share, 0.0, 1.0)))
    edge = []
    for cells in (contact.cell_along, contact.cell_across):
        starts, stops = (
            cells[rows, cell] + share * (cells[rows, beyond] - cells[rows, cell])
            for cell, beyond, share in shares
        )
        edge.append(1e3 * np.concatenate([starts, stops[::-1], starts[:1]]))
    area = line(edge[0], edge[1], label, color, unit="mm", width=1.0)
    return area | {"fill": "toself", "fillcolor": FILLS.get(color, translucent(color, 0.14))}


def _path(contact: ToothContact) -> list[Trace]:
    x, y = 1e3 * contact.along, 1e3 * contact.across
    leads = contact.leads
    path = line(x[leads], y[leads], "path of contact", WHEEL, unit="mm", width=2.5)
    edges = leads & contact.on_edge
    if not np.any(edges):
        return [path]
    return [path, marked(x[edges], y[edges], "edge contact", INK, 7, "x", unit="mm")]


def flank_rows(flank: list[Trace], error: Panel) -> list[Row]:
    """Rows with the flank of the wheel, to scale, and with its transmission error."""
    across = Panel("Across, towards the tip [mm]", flank, {"scaleanchor": "x"}, height=1.4)
    return [
        Row("Along the pitch cone of the wheel, towards the heel [mm]", across),
        Row("Rotation of the wheel from the calculation point [°]", error),
    ]


def _error(contact: ToothContact) -> Panel:
    """Transmission error of neighbouring pairs, shifted by a pitch each."""
    pitch = 360.0 / contact.flanks.blank.teeth_wheel
    turn, error = np.degrees(contact.rotation), 1e6 * contact.angular_transmission_error
    inner = ~contact.on_edge if np.any(~contact.on_edge) else np.ones(len(turn), bool)
    curves = []
    for pair in _PAIRS:
        name = "this pair" if pair == 0 else f"pair {'before' if pair < 0 else 'after'}"
        color, dash = (PINION, "solid") if pair == 0 else (PAIR_COLORS[pair], "dot")
        x = turn[inner] + pair * pitch
        curves.append(line(x, error[inner], name, color, unit="µrad", dash=dash))
    low = float(error[contact.leads].min())
    span = max(float(np.ptp(error[contact.leads])), 1e-3)
    return Panel("Wheel ahead [µrad]", curves, {"range": [low - 1.5 * span, low + 1.4 * span]})


@drawing(
    heading="Contact pattern",
    of=("ToothContact", "Result.hypoid_contact"),
    made_by="Call tribodyn.gear.tooth_contact.",
)
def hypoid_contact(contact: ToothContact) -> Sketch:
    """Draw contact pattern, path of contact and transmission error.

    Flank of the wheel with the contact pattern of the marking compound, the path of contact and the
    contact lines of the conjugate flanks. Below, the lead of the wheel for each pair; the pair with
    the uppermost curve is in contact. Curves end at edge contact.
    """
    label = f"marked at {contact.marking_thickness * 1e6:.3g} µm"
    marking = pattern(contact, label, PINION)
    flank = [outline(contact), _lines(contact), marking, *_path(contact)]
    rows = flank_rows(flank, _error(contact))
    title = (
        f"Transmission error of {contact.peak_to_peak * 1e6:.3g} µrad on the "
        f"{contact.flanks.side} flank, contact ratio {contact.contact_ratio:.2f}"
    )
    return stack_rows(title, rows, {"hovermode": "closest"})


#: Points of a flank along face and depth; points around a blank.
_POINTS, _ROUND = 11, 121
_MADE_BY = "Call tribodyn.gear.hypoid_flanks."
#: Axis of each gear in the frame of its points.
_AXES = {"pinion": 1, "wheel": 2}


def _rotated(points: Array, axis: int, angle: Array) -> Array:
    """Rotate points (..., 3) about a coordinate axis."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    cosine, sine = np.cos(angle), np.sin(angle)
    rotated = np.array(np.broadcast_to(points, (*np.broadcast(cosine, points[..., 0]).shape, 3)))
    rotated[..., first] = cosine * points[..., first] - sine * points[..., second]
    rotated[..., second] = sine * points[..., first] + cosine * points[..., second]
    return rotated


def _tooth(sides: list[HypoidFlanks], gear: str) -> Array:
    """Surface (length, points, 3) of a tooth from root to root over its tip."""
    blank, axis = sides[0].blank, _AXES[gear]
    middle = len(sides[0].along) // 2
    position, outward = (each[middle, middle] for each in sides[0].points(gear))
    thickness = getattr(blank, f"mean_normal_thickness_{gear}")
    spiral, diameter = (
        getattr(blank, f"{name}_{gear}") for name in ("mean_spiral_angle", "mean_pitch_diameter")
    )
    angle = 2.0 * thickness / (math.cos(spiral) * diameter)
    # The opposite flank lies against the outward normal of this flank.
    turning = np.cross(np.eye(3)[axis], position) @ outward
    back = _rotated(sides[1].points(gear)[0], axis, np.array(-math.copysign(angle, turning)))
    front = sides[0].points(gear)[0]
    if gear == "pinion":  # the tip of the pinion is at the root of the wheel
        front, back = front[:, ::-1], back[:, ::-1]
    return np.concatenate([front, back[:, ::-1]], axis=1)


def _teeth(sides: list[HypoidFlanks], gear: str, color: str) -> Trace:
    """All teeth of a gear as one mesh of triangles, in mm."""
    skin, count = _tooth(sides, gear), getattr(sides[0].blank, f"teeth_{gear}")
    angles = 2.0 * np.pi / count * np.arange(count)
    points = 1e3 * _rotated(skin[None], _AXES[gear], angles[:, None, None])
    numbers = np.arange(points[..., 0].size).reshape(points.shape[:-1])
    a, b = numbers[:, :-1, :-1].ravel(), numbers[:, 1:, :-1].ravel()
    c, d = numbers[:, 1:, 1:].ravel(), numbers[:, :-1, 1:].ravel()
    i, j, k = np.hstack([[a, b, c], [a, c, d]])
    if _faces_inwards(skin):
        j, k = k, j
    x, y, z = _in_fixed_frame(points.reshape(-1, 3), sides[0], gear).T
    light = {"ambient": 0.6, "diffuse": 0.7, "specular": 0.1}
    light |= {"facenormalsepsilon": 0.0, "vertexnormalsepsilon": 0.0}
    lamp = {"x": -1e4, "y": 2e4, "z": -3e4}
    return {
        "type": "mesh3d", "x": x, "y": y, "z": z, "i": i, "j": j, "k": k, "color": color,
        "flatshading": False, "name": gear, "showlegend": True, "hoverinfo": "name",
        "lighting": light, "lightposition": lamp,
    }  # fmt: skip


def _faces_inwards(skin: Array) -> bool:
    """Whether the triangles of a tooth face inwards; plotly lights outer faces only."""
    middle = skin.shape[0] // 2
    top = skin[middle : middle + 2, skin.shape[1] // 2 - 1 : skin.shape[1] // 2 + 1]
    facing = np.cross(top[1, 0] - top[0, 0], top[1, 1] - top[0, 0])
    out = skin[middle, skin.shape[1] // 2] - skin[middle, 0]
    return bool(facing @ out < 0.0)


def _in_fixed_frame(points: Array, flanks: HypoidFlanks, gear: str) -> Array:
    """Points of a gear [mm] in the fixed frame, where the axis of the wheel is z."""
    if gear == "wheel":
        return points
    opening = flanks.blank.shaft_angle - 0.5 * math.pi
    return _rotated(points, 0, np.array(-opening)) + 1e3 * flanks.conjugate.axes.origin


def _body(flanks: HypoidFlanks, gear: str) -> Trace:
    """Gear body within the root cone."""
    axis, (along, radius) = _AXES[gear], _section(flanks.blank, gear, "root")
    # The pinion is solid, the wheel a ring.
    ends = [(0, 0.0), (0, 1.0), (1, 1.0), (1, 0.0)]
    rows = []
    for end, share in ends if gear == "pinion" else ends[1:3]:
        place = np.zeros(3)
        place[axis], place[(axis + 1) % 3] = along[end], share * radius[end]
        rows.append(_rotated(place, axis, np.linspace(0.0, 2.0 * np.pi, _ROUND)))
    x, y, z = np.moveaxis(_in_fixed_frame(np.array(rows), flanks, gear), -1, 0)
    plain = {"showscale": False, "colorscale": [[0.0, MUTED], [1.0, MUTED]], "hoverinfo": "skip"}
    return {"type": "surface", "x": x, "y": y, "z": z, **plain}


def _scene(eye: tuple[float, float, float], **axes: str) -> Trace:
    labels = {f"{name}axis": {"title": {"text": text}} for name, text in axes.items()}
    return {"camera": {"eye": dict(zip("xyz", eye, strict=True))}, **labels}


@drawing(
    heading="The pair in space", of=("HypoidFlanks", "Result.case.hypoid_flanks"), made_by=_MADE_BY
)
def hypoid_pair(flanks: HypoidFlanks) -> Sketch:
    """Draw both gears in mesh.

    Both gears in mesh at the calculation point, to scale, on their root cones. Rotate the view with
    the mouse.
    """
    order = (flanks.side, "coast" if flanks.side == "drive" else "drive")
    with quiet():
        sides = [
            hypoid_flanks(flanks.blank, side, flanks.ease_off, points=_POINTS) for side in order
        ]
    traces = []
    for gear, color in (("pinion", PINION), ("wheel", WHEEL)):
        traces += [_teeth(sides, gear, color), _body(flanks, gear)]
    blank = flanks.blank
    title = (
        f"{blank.teeth_pinion} teeth against {blank.teeth_wheel}, "
        f"offset {blank.offset * 1e3:g} mm, pinion {blank.hand_pinion}-handed"
    )
    # The teeth of the wheel point against its axis: view from below.
    scene = _scene((-1.75, 1.4, -1.55), x="x [mm]", y="y [mm]", z="z [mm]")
    scene["camera"] |= {"up": {"x": 0.0, "y": 0.0, "z": -1.0}}
    layout = {"scene": {**scene, "aspectmode": "data"}, "height": 680, "hovermode": "closest"}
    return figure(title, traces, layout)


@drawing(heading="Ease-off", of=("HypoidFlanks", "Result.case.hypoid_flanks"), made_by=_MADE_BY)
def ease_off(flanks: HypoidFlanks) -> Sketch:
    """Draw the ease-off over the flank.

    Gap between the pinion flank and the conjugate flank, over the flank of the wheel: along its
    pitch cone towards the heel, across it towards the tip. Dots lie on both flanks; the flanks
    first touch where the gap is zero.
    """
    x = np.broadcast_to(flanks.along[:, None], flanks.across.shape) * 1e3
    y, gap = flanks.across * 1e3, flanks.gap * 1e6
    colors = [[0.0, "#f2f6fa"], [1.0, PINION]]
    hover = "along %{x:.4g} mm, across %{y:.4g} mm: %{z:.4g} µm<extra></extra>"
    surface: Trace = {"type": "surface", "x": x, "y": y, "z": gap, "name": "ease-off"}
    surface |= {"colorscale": colors, "hovertemplate": hover}
    surface["colorbar"] = axis("Gap [µm]", thickness=14)
    inside, marker = flanks.active, {"size": 1.6, "color": INK}
    points = dots(x[inside], y[inside], "on both flanks", marker, hoverinfo="skip")
    points |= {"type": "scatter3d", "z": gap[inside]}
    most = float(np.max(gap[inside], initial=0.0))
    title = f"Ease-off of up to {most:.3g} µm on the {flanks.side} flank"
    scene = _scene((-1.65, -1.9, 1.15), x="Along [mm]", y="Across [mm]", z="Gap [µm]")
    scene |= {"aspectmode": "manual", "aspectratio": {"x": 1.5, "y": 0.9, "z": 0.6}}
    return figure(title, [surface, points], {"scene": scene, "height": 620, "hovermode": "closest"})
