"""Side view of a machine, drawn to scale: its shafts in one plane, with gears and bearings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.machine.graph.part_checks import gear_hand
from tribodyn.plot.theme.colors import FILLS, INK, MUTED, PAIR_COLORS, PINION, WHEEL
from tribodyn.plot.theme.labels import rounded
from tribodyn.plot.theme.style import Trace, axis, note, plane_figure, strokes

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tribodyn.machine import Machine, Mesh, Shaft
    from tribodyn.types import Array

_MM = 1e3
#: Bearing width, and diameter over that of its seat, where no dimensions are given.
_WIDTH, _OUTER = 0.018, 2.0
#: Diameter of a shaft without sections over the smallest pitch diameter.
_THIN = 0.15
#: Width and height of the drawing, width of a character, and shifts of names [px].
_AREA, _CHARACTER, _SHIFTS = (620.0, 420.0), 7.0, (0, 15, -15, 30, -30)
#: Heights of the lines that show the inclination of the teeth, over the pitch radius.
_TEETH = (-0.66, -0.22, 0.22, 0.66)
#: Part of the direction of an axis from which on it is drawn upright.
_UPRIGHT = 0.7
#: Distance of names that are drawn as one [px], and that along the axis of names of shafts.
_NEAR = (4.0, 70.0)
#: Room right of the last part, over the length of the machine; names give it on the left.
_MARGIN = 0.04
STEEL_COLOR, SEAT_COLOR = "#c9d1d9", "#f3e3c3"


class Axis(NamedTuple):
    """Axis of a shaft in the drawing: where it begins [m], and its direction."""

    start: Array
    along: Array

    @property
    def across(self) -> Array:
        """Direction across the axis."""
        return np.array([-self.along[1], self.along[0]])


@dataclass(frozen=True)
class SideView:
    """Where shafts, gears and bearings are in the plane of the drawing [m]."""

    machine: Machine
    axes: dict[str, Axis]
    reach: dict[str, tuple[float, float]]  #: positions of the ends of each shaft

    @classmethod
    def of(cls, machine: Machine) -> SideView:
        """Unfold the axes into one plane; a second shaft from one axis goes to its other side."""
        children: dict[str, int] = {}

        def step(link: str, forward: bool, axis: Axis) -> Axis:
            ends = machine.graph.edges[link]
            start, end = ends if forward else ends[::-1]
            mesh = machine.meshes.get(link)
            if mesh is not None and mesh.crossing is not None:
                return _crossed_axis(machine, mesh, forward, axis)
            places = machine.placement
            shift = np.subtract(places.shafts[end], places.shafts[start]) @ places.axes[start]
            children[start] = children.get(start, 0) + (mesh is not None)
            distance = float(np.hypot(*shift[1:])) * (1.0 if children[start] % 2 else -1.0)
            return Axis(axis.start + shift[0] * axis.along - distance * axis.across, axis.along)

        axes = machine.graph.propagate(Axis(np.zeros(2), np.array([1.0, 0.0])), step)
        reach = {}
        for name, shaft in machine.shafts.items():
            parts = [gear.node_position for gear in machine.gears.values() if gear.shaft == name]
            parts += [at.position for at in machine.bearings.values() if at.shaft == name]
            parts = parts or [0.0]
            reach[name] = (0.0, shaft.length) if shaft.sections else (min(parts), max(parts))
        return cls(machine, axes, reach)

    def place(self, shaft: str, position: object, across: object) -> tuple[Array, Array]:
        """Where points of a shaft are in the drawing [mm]."""
        axis = self.axes[shaft]
        points = np.multiply.outer(axis.along, np.asarray(position, dtype=float))
        points = points + np.multiply.outer(axis.across, np.asarray(across, dtype=float))
        x, y = _MM * (points.T + axis.start).T
        return x, y

    @property
    def thin(self) -> float:
        """Diameter of a shaft without sections [m]."""
        gears = self.machine.gears
        return min((pitch_diameter(self.machine, gear) for gear in gears), default=0.02) * _THIN

    def outline(self, name: str) -> tuple[list[float], list[float]]:
        """Positions and radii of a shaft, of one without sections too [m]."""
        shaft = self.machine.shafts[name]
        if shaft.sections:
            return shaft_outline(shaft)
        left, right = self.reach[name]
        middle, half = 0.5 * (left + right), max(0.5 * (right - left), 0.02)
        return [middle - half, middle + half], [0.5 * self.thin] * 2

    @property
    def height(self) -> float:
        """Distance of the lowest from the highest point of an axis [m]."""
        ends = [self.place(name, self.reach[name], 0.0)[1] for name in self.axes]
        return float(np.ptp(ends)) / _MM


def _crossed_axis(machine: Machine, mesh: Mesh, forward: bool, axis: Axis) -> Axis:
    """Axis that crosses another one, seen along their common perpendicular."""
    pair = mesh.crossing
    assert pair is not None
    # Positions of the crossing point on both shafts.
    positions = [
        machine.gears[gear].node_position + float((point - node) @ frame[0])
        for gear, point, node, frame in zip(
            mesh.gears, pair.crossing, pair.nodes, pair.frames, strict=True
        )
    ]
    first, second = positions if forward else positions[::-1]
    cosine = float(pair.turn[0, 0])
    sine = math.sqrt(max(1.0 - cosine**2, 0.0)) * pair.apex[1 if forward else 0]
    along = cosine * axis.along + sine * axis.across
    return Axis(axis.start + first * axis.along - second * along, along)


def shaft_outline(shaft: Shaft) -> tuple[list[float], list[float]]:
    """Positions and radii of the outline of a shaft with sections [m]."""
    x, radius = [], []
    for begin, section in zip(shaft.ends, shaft.sections, strict=False):
        x += [begin, begin + section.length]
        radius += [0.5 * section.diameters(fraction)[0] for fraction in (0.0, 1.0)]
    return x, radius


def pitch_diameter(machine: Machine, gear: str) -> float:
    """Reference diameter of a gear in its first mesh, without a sign [m]; the mean of a cone."""
    meshes = (mesh for mesh in machine.meshes.values() if gear in mesh.gears)
    mesh = next(meshes, None)
    if mesh is not None and mesh.crossing is not None:
        return 2.0 * mesh.crossing.working_radii[mesh.gears.index(gear)]
    teeth = abs(machine.gears[gear].teeth)
    return 0.0 if mesh is None else float(teeth * mesh.transverse_module)


def _area(points: tuple[Array, Array], color: str, fill: str, text: str) -> Trace:
    """Filled outline with a text."""
    hover: Trace = {"hoveron": "fills", "hoverinfo": "text", "text": text, "showlegend": False}
    return strokes(*points, color, fill="toself", fillcolor=fill, **hover)


def _box(left: float, right: float, low: float, high: float) -> tuple[list[float], list[float]]:
    """Positions and heights of the corners of a rectangle."""
    return [left, right, right, left, left], [low, low, high, high, low]


def shaft_text(machine: Machine, name: str) -> str:
    """Name, speed and torque of a shaft."""
    load = machine.kinematics.shafts[name]
    text = f"shaft {name}: {rounded('speed', load.speed)}, {rounded('torque', load.torque)}"
    return text if machine.shafts[name].sections else f"{text}, rigid"


def _shafts(view: SideView) -> Iterator[Trace]:
    for name in view.machine.shafts:
        x, radius = view.outline(name)
        outline = [*x, *x[::-1], x[0]], [*radius, *(-r for r in radius[::-1]), radius[0]]
        text = shaft_text(view.machine, name)
        yield _area(view.place(name, *outline), INK, STEEL_COLOR, text)


def gear_color(machine: Machine, name: str) -> str:
    """Colour of a gear that drives, or of one that is driven."""
    drives = any(load.driver == name for load in machine.kinematics.meshes.values())
    return PINION if drives else WHEEL


def gear_text(machine: Machine, name: str) -> str:
    """Name, teeth, diameter and inclination of the teeth of a gear."""
    diameter = rounded("reference_diameter", pitch_diameter(machine, name))
    text = f"{name}: {machine.gears[name].teeth} teeth, diameter {diameter}"
    angle = helix(machine, name)
    hand = "right" if angle > 0.0 else "left"
    return f"{text}, {rounded('helix_angle', abs(angle))} {hand}" if angle else text


def _gears(view: SideView) -> Iterator[Trace]:
    machine = view.machine
    for name, gear in machine.gears.items():
        x, half = gear.node_position, 0.5 * gear.face_width
        radius, angle = 0.5 * pitch_diameter(machine, name), helix(machine, name)
        color = gear_color(machine, name)
        outline = cone(machine, name) or _box(x - half, x + half, -radius, radius)
        place = view.place(gear.shaft, *outline)
        yield _area(place, color, FILLS[color], gear_text(machine, name))
        # Teeth of a right-hand gear descend along x on the side of the viewer.
        rise = -half * math.tan(angle)
        for part in _TEETH if angle else ():
            y = part * radius
            ends = [x - half, x + half], [y - rise, y + rise]
            yield strokes(*view.place(gear.shaft, *ends), color, 0.8, showlegend=False)


def cone(machine: Machine, name: str) -> tuple[list[float], list[float]] | None:
    """Pitch cone of a bevel gear; None of a cylindrical gear."""
    meshes = (mesh for mesh in machine.meshes.values() if name in mesh.gears)
    mesh = next(meshes, None)
    if mesh is None or mesh.crossing is None:
        return None
    number, pair = mesh.gears.index(name), mesh.crossing
    role = ("pinion", "wheel")[number]
    angle = getattr(pair.blank, f"pitch_angle_{role}")
    mean = getattr(pair.blank, f"mean_cone_distance_{role}")
    inner, outer = (
        getattr(pair.blank, f"{end}_cone_distance_{role}") - mean for end in ("inner", "outer")
    )
    apex_offset = float((pair.crossing[number] - pair.nodes[number]) @ pair.frames[number][0])
    distance = getattr(pair.blank, f"calculation_point_{role}")
    middle = machine.gears[name].node_position + apex_offset - pair.apex[number] * distance
    x = [middle - pair.apex[number] * d * math.cos(angle) for d in (inner, outer)]
    radius = [pair.working_radii[number] + d * math.sin(angle) for d in (inner, outer)]
    corners = [radius[0], radius[1], -radius[1], -radius[0], radius[0]]
    return [x[0], x[1], x[1], x[0], x[0]], corners


def helix(machine: Machine, name: str) -> float:
    """Helix angle of a gear, negative of a left-hand one; zero of a spur gear."""
    mesh = next((each for each in machine.meshes.values() if name in each.gears), None)
    if mesh is None:
        return 0.0
    return mesh.helix_angle * (1.0 if gear_hand(name, machine.gears, mesh) == "right" else -1.0)


def bearing_text(machine: Machine, name: str) -> str:
    """Name and kind of a bearing."""
    rolling = machine.bearings[name].rolling
    kind = "linear support" if rolling is None else type(rolling).__name__
    return f"bearing {name}: {kind}"


def bearing_ring(machine: Machine, name: str) -> tuple[float, float, float, float]:
    """Ends of a bearing along its shaft, and its inner and outer radius [m]."""
    bearing = machine.bearings[name]
    shaft, x, rolling = machine.shafts[bearing.shaft], bearing.position, bearing.rolling
    width = getattr(rolling, "width", None) or _WIDTH
    seat = 0.5 * (getattr(rolling, "bore_diameter", None) or _seat(shaft, x))
    outer = 0.5 * (getattr(rolling, "outer_diameter", None) or 2.0 * _OUTER * seat)
    return x - 0.5 * width, x + 0.5 * width, seat, outer


def _bearings(view: SideView) -> Iterator[Trace]:
    machine = view.machine
    for name, bearing in machine.bearings.items():
        left, right, seat, outer = bearing_ring(machine, name)
        for low, high in ((seat, outer), (-outer, -seat)):
            ring = view.place(bearing.shaft, *_box(left, right, low, high))
            yield _area(ring, MUTED, SEAT_COLOR, bearing_text(machine, name))
            cross = [left, right, np.nan, left, right], [low, high, np.nan, high, low]
            yield strokes(*view.place(bearing.shaft, *cross), MUTED, 1.0, showlegend=False)


def _seat(shaft: Shaft, position: float) -> float:
    """Diameter of the shaft under a bearing [m]."""
    for begin, section in zip(shaft.ends, shaft.sections, strict=False):
        if begin <= position <= begin + section.length + 1e-9:
            return float(section.diameters((position - begin) / section.length)[0])
    return 0.02


def _names(view: SideView) -> list[Trace]:
    """Names of shafts at their left end, of bearings and gears above them."""
    machine, notes = view.machine, []

    def name_at(shaft: str, position: float, across: float, text: str, **more: Any) -> None:
        x, y = view.place(shaft, position, across)
        notes.append(note(float(x), float(y), text, **more))

    for name, ends in view.reach.items():
        upright = abs(view.axes[name].along[1]) > _UPRIGHT
        end = ends[0] if view.axes[name].along[1 if upright else 0] > 0.0 else ends[1]
        offset: Trace = {"yshift": -12} if upright else {"xanchor": "right", "xshift": -8}
        name_at(name, end, 0.0, f"<b>{name}</b>", **offset)
    driving = {load.driver for load in machine.kinematics.meshes.values()}
    for name, gear in machine.gears.items():
        side = 1.0 if name in driving else -1.0
        upright = abs(view.axes[gear.shaft].along[1]) > _UPRIGHT
        offset = {"xshift": 12 * side} if upright else {"yshift": 9 * side}
        across = side * 0.5 * pitch_diameter(machine, name)
        across *= -np.sign(view.axes[gear.shaft].along[1]) if upright else 1.0
        name_at(gear.shaft, gear.node_position, across, name, **offset)
    levels = _levels(view)
    for name, bearing in machine.bearings.items():
        style: Trace = {"color": PAIR_COLORS[0], "yshift": levels[name]}
        name_at(bearing.shaft, bearing.position, 0.0, name, **style)
    return _without_overlap(notes, _scale(view) / _MM)


def _without_overlap(notes: list[Trace], scale: float) -> list[Trace]:
    """Names with those of parts in the same place joined, such as planets behind each other."""
    joined: list[tuple[Trace, list[str]]] = []
    for name in notes:
        style = {key: value for key, value in name.items() if key not in ("x", "y", "text")}
        reach = _NEAR[1] if "xanchor" in name else _NEAR[0]
        for other, texts in joined:
            overlaps = abs(name["x"] - other["x"]) * scale < reach
            overlaps &= abs(name["y"] - other["y"]) * scale < _NEAR[0]
            if overlaps and style == {key: other.get(key) for key in style}:
                other["x"] = min(other["x"], name["x"])
                texts.append(name["text"])
                break
        else:
            joined.append((name, [name["text"]]))
    return [{**name, "text": joined_names(texts)} for name, texts in joined]


def joined_names(names: Sequence[str]) -> str:
    """Names in a list: ``pin1, pin3, low`` becomes ``pin1, 3, low``."""
    groups: dict[str, list[str]] = {}
    for name in (name.removeprefix("<b>").removesuffix("</b>") for name in names):
        stem = name.rstrip("0123456789")
        groups.setdefault(stem, []).append(name.removeprefix(stem))
    text = ", ".join(f"{stem}{', '.join(numbers)}" for stem, numbers in groups.items())
    return f"<b>{text}</b>" if names[0].startswith("<b>") else text


def _scale(view: SideView) -> float:
    """Pixels of a metre in the drawing."""
    ends = np.array([view.place(name, view.reach[name], 0.0)[0] for name in view.axes]) / _MM
    across = 2.0 * view.height + 0.1
    return float(min(_AREA[0] / max(float(np.ptp(ends)), 0.1), _AREA[1] / across))


def _levels(view: SideView) -> dict[str, int]:
    """Shift of the name of each bearing [px], so that long names of one shaft do not overlap."""
    machine, scale = view.machine, _scale(view)
    ends = np.array([view.place(name, view.reach[name], 0.0)[0] for name in view.axes]) / _MM
    # Right end of the last name of a level; the name of a shaft ends left of it.
    right_ends = {
        (name, 0): scale * float(x.min()) for name, x in zip(view.axes, ends, strict=True)
    }
    middles = {
        name: scale / _MM * float(view.place(bearing.shaft, bearing.position, 0.0)[0])
        for name, bearing in machine.bearings.items()
    }
    levels = {}
    for name, middle in sorted(middles.items(), key=lambda each: each[1]):
        shaft, half = machine.bearings[name].shaft, 0.5 * _CHARACTER * (len(name) + 1)
        if abs(view.axes[shaft].along[1]) > _UPRIGHT:
            levels[name] = 0
            continue
        free = [s for s in _SHIFTS if middle - half >= right_ends.get((shaft, s), -np.inf)]
        levels[name] = free[0] if free else min(_SHIFTS, key=lambda s: right_ends[shaft, s])
        right_ends[shaft, levels[name]] = middle + half
    return levels


@drawing(
    heading="The machine",
    of=("Machine", "MachineResult.machine"),
    made_by="Load a case with shafts, or build a tribodyn.machine.Machine.",
)
def machine(machine: Machine) -> Sketch:
    """Draw the shafts of a machine with gears and bearings, to scale.

    To scale, with the axes unfolded into one plane; axes that cross are seen along their common
    perpendicular. Shafts with their sections, gears with their reference circles (blue: driving,
    orange: driven, an idler counts as driving), bevel gears with their pitch cones, bearings with
    crosses; lines on helical gears are inclined like their teeth. Point at a part for its speed,
    torque or size.
    """
    view = SideView.of(machine)
    traces = [*_shafts(view), *_bearings(view), *_gears(view)]
    run, shafts = machine.operation, machine.kinematics.shafts
    ratio = abs(1.0 / float(shafts[run.output].ratio))
    title = (
        f"{rounded('speed', abs(run.speed))} and {rounded('torque', abs(run.torque))} in, "
        f"{rounded('speed', abs(shafts[run.output].speed))} out: ratio {ratio:.4g}"
    )
    places = np.concatenate([np.asarray(trace["x"], dtype=float) for trace in traces])
    right_end = np.nanmax(places) + _MARGIN * np.ptp(places[np.isfinite(places)])
    traces.append(strokes([right_end], [0.0], INK, showlegend=False))
    x = axis("Along the shafts [mm]", zeroline=False, constrain="domain")
    y = axis("Across [mm]", scaleanchor="x", scaleratio=1.0)
    return plane_figure(title, traces, x, y, height=520, annotations=_names(view))
