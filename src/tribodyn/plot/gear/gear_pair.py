"""The gear pair to scale, and the outlines of both gears, unloaded and deformed.

The origin of the frame is the pinion's axis. The wheel's axis lies on the horizontal axis, that
of a ring on its negative side, so that the teeth mesh at positive x. Points are complex numbers,
and outlines those of the transverse section.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.drawing import Sketch, drawing
from tribodyn.gear import Material, gear_outline
from tribodyn.plot.mesh.cycle import PAIRS, RUN
from tribodyn.plot.theme.colors import FILLS, INK, PAIR_COLORS, PINION, WHEEL
from tribodyn.plot.theme.labels import axis_label, displayed
from tribodyn.plot.theme.path import further_changes, sharing_sentence
from tribodyn.plot.theme.style import BARE, Trace, axis, figure, note, strokes
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.contact import PathOfContact
    from tribodyn.gear import SpurGear, SpurPair
    from tribodyn.gear.mesh_geometry import MeshGeometry
    from tribodyn.stiffness import LoadedContact

#: Points of each tooth, enough for a smooth trochoid.
_TOOTH_POINTS = 60
#: Least fraction of the total force that is plotted; teeth on each side of the middle tooth.
_LOADED, _TEETH = 1e-3, 2


def on_line_of_action(pair: MeshGeometry, path: object) -> Array:
    """Coordinates in the plane of positions on the line of action [m]."""
    angle, radius = pair.operating_pressure_angle, pair.pinion.base_radius
    along = np.asarray(path, dtype=float)
    x = radius * math.cos(angle) + along * math.sin(angle)
    y = -radius * math.sin(angle) + along * math.cos(angle)
    return np.array([x, y])


def wheel_center(pair: MeshGeometry) -> float:
    """Position of the wheel's axis on the horizontal axis [m]."""
    return pair.wheel.sign * pair.center_distance


def tooth_angles(pair: MeshGeometry, path: float) -> tuple[float, float]:
    """Angles of the pinion tooth and the wheel tooth that touch at a position [rad]."""
    x, y = on_line_of_action(pair, path)
    places = ((pair.pinion, x, y), (pair.wheel, x - wheel_center(pair), y))
    first, second = (
        math.atan2(v, u) - gear.sign * float(gear.half_tooth_angle(math.hypot(u, v)))
        for gear, u, v in places
    )
    return first, second


def placed_outline(
    gear: SpurGear, center: float, angle: float, points: int = _TOOTH_POINTS
) -> Array:
    """Outline of an entire gear about its centre."""
    x, y = gear_outline(gear, points)
    turned = (x + 1j * y) * cmath.exp(1j * (angle - math.pi / 2.0))
    return np.array([center + turned.real, turned.imag])


def circle(center: float, radius: float) -> Array:
    """Points of a circle about a point of the horizontal axis."""
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    return np.array([center + radius * np.cos(angle), radius * np.sin(angle)])


def rotation_arc(center: float, radius: float, sense: int) -> Array:
    """Points of an arc above a gear's axis, in the sense of rotation."""
    angle = 0.5 * np.pi + sense * np.linspace(-0.25 * np.pi, 0.25 * np.pi, 25)
    return np.array([center + radius * np.cos(angle), radius * np.sin(angle)])


@dataclass(frozen=True)
class Load:
    """Load on one tooth pair."""

    path: float  #: position on the line of action where perfect involutes touch [m]
    pinion_curvature_radius: float  #: [m]
    wheel_curvature_radius: float  #: [m]
    force: float  #: normal force [N]


@dataclass(frozen=True, eq=False)
class BentMesh:
    """Outlines and displacements of both gears near the contact at a mesh phase."""

    outline: dict[str, ComplexArray]  #: of ``"pinion"`` and ``"wheel"`` without load [m]
    displacement: dict[str, ComplexArray]  #: [m]
    contact: ComplexArray  #: contact points of the loaded pairs, undeformed [m]
    shift: ComplexArray  #: displacement of these points [m]
    loads: list[Load]  #: on these pairs


def loads_at(contact: LoadedContact, phase: int, torque: int = 0) -> list[Load]:
    """Loads of the tooth pairs that carry load at a mesh phase."""
    shape = contact.normal_force.shape
    force = contact.normal_force.reshape(-1, *shape[-2:])[torque, phase]
    return [
        Load(
            float(contact.path[phase, k]),
            float(contact.pinion_curvature_radius[phase, k]),
            float(contact.wheel_curvature_radius[phase, k]),
            float(force[k]),
        )
        for k in np.flatnonzero(force > _LOADED * force.sum())
    ]


def _bent_outline(
    gear: SpurGear,
    center: float,
    angle: float,
    loads: list[tuple[int, float, float]],
    reference: str,
) -> tuple[ComplexArray, ComplexArray]:
    """Outline and displacement of a gear whose tooth 0 points in the direction ``angle``."""
    from tribodyn.stiffness.fe2d import deformed_gear

    # Models without a reference are plotted as if fixed at the bore.
    support = "rim" if reference == "rim" or gear.bore_diameter == 0.0 else "bore"
    middle = gear.base_radius * gear.roll_angle(0.5 * (gear.form_radius + gear.tip_radius))
    # Unloaded teeth are included, so that every phase shows the same teeth.
    loaded_teeth = {tooth for tooth, _, _ in loads}
    unloaded = [(k, middle, 0.0) for k in range(1 - _TEETH, _TEETH) if k not in loaded_teeth]
    outline, moved = deformed_gear(gear, Material(), [*loads, *unloaded], reference=support)
    # deformed_gear loads the right flank; this frame the left one of teeth that point outwards.
    turn, mirror = cmath.exp(1j * (angle - 0.5 * math.pi)), -gear.sign
    across, shift = mirror * outline[0], mirror * moved[0]
    return center + turn * (across + 1j * outline[1]), turn * (shift + 1j * moved[1])


def _contact_point(
    gear: SpurGear, center: float, angle: float, tooth: int, radius: float
) -> complex:
    """Point on the loaded flank of a gear with a radius of curvature."""
    distance = math.hypot(gear.base_radius, radius)
    distance = gear.sign * min(gear.sign * distance, gear.sign * gear.tip_radius)
    direction = angle + 2.0 * math.pi * tooth / abs(gear.teeth)
    half = gear.sign * float(gear.half_tooth_angle(distance))
    return center + cmath.rect(distance, direction + half)


def bent_mesh(contact: LoadedContact, phase: int, torque: int = 0) -> BentMesh:
    """Deform both gears by the loads of a mesh phase."""
    pair, loads = contact.gear_pair, loads_at(contact, phase, torque)
    path = path_of_contact(pair)
    middle = 0.5 * (path.A + path.E)
    anchor = float(contact.path[phase, np.argmin(np.abs(contact.path[phase] - middle))])
    steps = [round((load.path - anchor) / pair.base_pitch) for load in loads]
    width, centers = pair.common_face_width, {"pinion": 0.0, "wheel": wheel_center(pair)}
    outline = {}
    moved = {}
    angles = dict(zip(("pinion", "wheel"), tooth_angles(pair, anchor), strict=True))
    places: dict[str, list[complex]] = {}
    shifts: dict[str, list[complex]] = {}
    for name, sense in (("pinion", 1), ("wheel", -pair.wheel.sign)):
        radii = [abs(getattr(load, f"{name}_curvature_radius")) for load in loads]
        # Teeth are numbered towards larger radii of curvature of this gear.
        tooth_loads = [
            (sense * step, radius, load.force / width)
            for step, radius, load in zip(steps, radii, loads, strict=True)
        ]
        placement = getattr(pair, name), centers[name], angles[name]
        outline[name], moved[name] = _bent_outline(*placement, tooth_loads, contact.reference)
        places[name] = [_contact_point(*placement, *tooth_load[:2]) for tooth_load in tooth_loads]
        nearest = [int(np.argmin(np.abs(outline[name] - place))) for place in places[name]]
        shifts[name] = [complex(moved[name][at]) for at in nearest]
    normal = cmath.rect(1.0, 0.5 * math.pi - pair.operating_pressure_angle)
    forces = np.array([load.force for load in loads])
    approach = (np.array(shifts["wheel"]) - np.array(shifts["pinion"])) * normal.conjugate()
    driver, driving = pair.driver, pair.driving
    turn = float(np.average(approach.real, weights=forces)) / (driving.sign * driving.base_radius)
    moved[driver] = moved[driver] + 1j * turn * (outline[driver] - centers[driver])
    driven = "wheel" if driver == "pinion" else "pinion"
    return BentMesh(outline, moved, np.array(places[driven]), np.array(shifts[driven]), loads)


#: Circles of each gear: name and dash.
_CIRCLES = (("tip", "dot"), ("pitch", "dashdot"), ("base", "dash"))
_HOLE: Trace = {"fill": "toself", "fillcolor": "white", "showlegend": False}
#: Distance of the letters from the line of action, and between letters [px].
_OFFSET, _SPACING = 34, 17


def _curve(points: Array, name: str, color: str, **more: Any) -> Trace:
    x, y = displayed("center_distance", points)
    return strokes(x, y, color, name=name, **more)


def _gears_and_centers(pair: SpurPair) -> tuple[tuple[SpurGear, str, float, str], ...]:
    """Both gears with name, centre position and colour."""
    places = zip(pair.gears.items(), (0.0, wheel_center(pair)), (PINION, WHEEL), strict=True)
    return tuple((gear, name, center, color) for (name, gear), center, color in places)


def _sense(pair: SpurPair, name: str) -> int:
    """Sense in which a gear turns: the driver of an external pair to the left."""
    if pair.is_internal:
        return 1 if pair.driver == "pinion" else -1
    return 1 if pair.driver == name else -1


def _gears(pair: SpurPair, touching: float) -> list[Trace]:
    traces = []
    positions = list(zip(_gears_and_centers(pair), tooth_angles(pair, touching), strict=True))
    # A ring is a disc with a white hole, on which the pinion is drawn.
    for (gear, name, center, color), angle in positions[:: pair.wheel.sign]:
        role = "drives" if pair.driver == name else "is driven"
        name = "ring" if gear.is_ring else name
        label = f"{name}, {abs(gear.teeth)} teeth, {role}"
        outline = placed_outline(gear, center, angle)
        if gear.is_ring:
            rim = circle(center, gear.rim_radius)
            traces.append(_curve(rim, label, color, fill="toself", fillcolor=FILLS[color]))
            traces.append(_curve(outline, "teeth", color, **_HOLE))
            continue
        traces.append(_curve(outline, label, color, fill="toself", fillcolor=FILLS[color]))
        if gear.bore_diameter > 0.0:
            bore = circle(center, 0.5 * gear.bore_diameter)
            traces.append(_curve(bore, "bore", color, **_HOLE))
    return traces


def _circles(pair: SpurPair) -> list[Trace]:
    cosine = np.cos(pair.operating_pressure_angle)
    traces = []
    for gear, _, center, color in _gears_and_centers(pair):
        radii = (gear.tip_radius, gear.base_radius / cosine, gear.base_radius)
        for (name, dash), radius in zip(_CIRCLES, radii, strict=True):
            style: Trace = {"line": {"color": color, "width": 1, "dash": dash}}
            style |= {"legendgroup": name, "showlegend": center == 0.0}
            traces.append(_curve(circle(center, radius), f"{name} circles", color, **style))
    return traces


def _arrows(pair: SpurPair) -> list[Trace]:
    """Arcs with an arrow head in the sense of rotation of each gear."""
    traces = []
    for gear, name, center, color in _gears_and_centers(pair):
        radius = 0.8 * gear.root_radius
        radius = 0.5 * (gear.root_radius + gear.rim_radius) if gear.is_ring else radius
        arc = rotation_arc(center, radius, _sense(pair, name))
        head = [0] * (arc.shape[1] - 1) + [15]
        marker = {"symbol": "arrow", "angleref": "previous", "size": head, "opacity": 1}
        more = {"mode": "lines+markers", "marker": {**marker, "color": color}}
        line = {"color": color, "width": 3}
        traces.append(_curve(arc, "sense of rotation", color, line=line, showlegend=False, **more))
    return traces


def _roles(pair: SpurPair) -> list[Trace]:
    """Labels below the gears: drives or driven."""
    roles = []
    for gear, name, center, color in _gears_and_centers(pair):
        bottom = -1e3 * (gear.rim_radius if gear.is_ring else gear.tip_radius)
        text = "drives" if pair.driver == name else "driven"
        roles.append(note(1e3 * center, bottom, text, yanchor="top", size=12, color=color))
    return roles


def _letters(pair: SpurPair, path: PathOfContact) -> dict[str, float]:
    """Marked positions on the line of action, in ascending order."""
    letters = {name: getattr(path, name) for name in "ABCDE"}
    for name, age in further_changes(path.contact_ratio).items():
        letters[name] = path.A + path.direction * age * pair.base_pitch
    return dict(sorted(letters.items(), key=lambda each: each[1]))


def _names(pair: SpurPair, path: PathOfContact, axes: tuple[str, str]) -> list[Trace]:
    """Letters in a column next to the line of action, each with a leader to its position."""
    letters = _letters(pair, path)
    x, y = displayed("center_distance", on_line_of_action(pair, np.array(list(letters.values()))))
    middle = 0.5 * (len(letters) - 1)
    leader: Trace = {"xref": axes[0], "yref": axes[1], "ax": _OFFSET, "arrowhead": 0}
    leader |= {"arrowwidth": 1, "arrowcolor": INK, "font": {"size": 13, "color": INK}}
    leader |= {"bgcolor": "rgba(255, 255, 255, 0.8)", "borderpad": 0}
    # The points rise along the line too, so that this is the least spacing.
    return [
        {**leader, "x": x[k], "y": y[k], "text": name, "ay": _SPACING * (middle - k)}
        for k, name in enumerate(letters)
    ]


def _contact_line(pair: SpurPair, path: PathOfContact) -> list[Trace]:
    tangents = 0.0, pair.line_of_action_length
    if pair.is_internal:  # Both tangent points lie before the path of contact.
        tangents = tangents[1], pair.path_limits[1]
    tangent = on_line_of_action(pair, np.array(tangents))
    active = on_line_of_action(pair, np.array([path.A, path.E]))
    letters = _letters(pair, path)
    marks = on_line_of_action(pair, np.array(list(letters.values())))
    color, edge = PAIR_COLORS[0], {"color": INK, "width": 1.5}
    marker = {"color": "white", "size": 8, "line": edge}
    return [
        _curve(tangent, "line of action", INK, line={"color": INK, "width": 1}),
        _curve(active, "path of contact", color, line={"color": color, "width": 5}),
        _curve(marks, "positions A to E", INK, mode="markers", marker=marker, hoverinfo="text",
               hovertext=[f"{name}: {1e3 * at:.3f} mm" for name, at in letters.items()]),
    ]  # fmt: skip


def _window(pair: SpurPair, path: PathOfContact) -> Trace:
    """Axes: the entire pair on the left, the path of contact enlarged on the right."""
    ends = displayed("center_distance", on_line_of_action(pair, np.array([path.A, path.E])))
    middle = ends.mean(axis=1)
    half = 0.75 * float(np.hypot(*(ends[:, 1] - ends[:, 0])))
    x, y = (axis(axis_label("center_distance", name), **BARE) for name in "xy")
    zoom = [[at - half, at + half] for at in middle]
    return {
        "xaxis": {**x, "domain": [0.0, 0.62], "constrain": "domain"},
        "yaxis": {**y, "scaleanchor": "x", "constrain": "domain"},
        "xaxis2": {**x, "domain": [0.7, 1.0], "anchor": "y2", "range": zoom[0]},
        "yaxis2": {**BARE, "anchor": "x2", "scaleanchor": "x2", "range": zoom[1]},
    }


def _caption(pair: SpurPair) -> str:
    ratio = path_of_contact(pair).contact_ratio
    return (
        "Both gears to scale, with a pair of flanks in contact. Right: the mesh zone enlarged. A "
        "tooth pair of perfect rigid flanks enters at A and leaves at E. "
        f"{sharing_sentence(ratio)} C is the pitch point, where flanks roll without sliding. The "
        "arrows show how the gears turn."
    )


@drawing(heading="The gear pair", caption=_caption, of=PAIRS, made_by=RUN)
def gear_pair(pair: SpurPair) -> Sketch:
    """Draw both gears in mesh with their circles and the path of contact."""
    path = path_of_contact(pair)
    traces = [*_gears(pair, 0.5 * (path.B + path.D)), *_circles(pair), *_contact_line(pair, path)]
    enlarged = [{**trace, "xaxis": "x2", "yaxis": "y2", "showlegend": False} for trace in traces]
    names = [*_names(pair, path, ("x", "y")), *_names(pair, path, ("x2", "y2"))]
    layout = {
        "annotations": [*_roles(pair), *names],
        **_window(pair, path),
        "height": 560,
        "hovermode": "closest",
        "legend": {"orientation": "h", "y": -0.16, "yanchor": "top", "x": 0.0},
    }
    teeth, mate = (gear.teeth for gear in pair.gears.values())
    section = " in the transverse section" if pair.helix_angle else ""
    title = (
        f"{teeth} teeth against {abs(mate)}{' of a ring' if mate < 0 else ''}{section}: on average "
        f"{path.contact_ratio:.2f} tooth pairs are between A and E"
    )
    return figure(title, [*traces, *_arrows(pair), *enlarged], layout)
