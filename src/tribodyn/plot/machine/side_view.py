"""Side view of a machine, drawn to scale: its shafts in one plane, with gears and bearings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.machine.graph.mesh_checks import gear_hand
from tribodyn.plot.theme.labels import rounded
from tribodyn.plot.theme.style import FILLS, INK, MUTED, PAIR_COLORS, PINION, WHEEL, Trace, figure

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tribodyn.machine import Machine, Shaft

_MM = 1e3
#: Bearing width, and diameter over that of its seat, where no dimensions are given.
_WIDTH, _OUTER = 0.018, 2.0
#: Diameter of a shaft without sections over the smallest pitch diameter.
_THIN = 0.15
#: Width and height of the drawing, width of a character, and shifts of names [px].
_AREA, _CHARACTER, _SHIFTS = (620.0, 420.0), 7.0, (0, 15, -15, 30, -30)
#: Heights of the lines that show the inclination of the teeth, over the pitch radius.
_TEETH = (-0.66, -0.22, 0.22, 0.66)
_STEEL, _SEAT = "#c9d1d9", "#f3e3c3"


@dataclass(frozen=True)
class SideView:
    """Where shafts, gears and bearings are in the plane of the drawing [m]."""

    machine: Machine
    height: dict[str, float]  #: height of the axis of each shaft
    reach: dict[str, tuple[float, float]]  #: ends of each shaft along x

    @classmethod
    def of(cls, machine: Machine) -> SideView:
        """Unfold the axes into one plane; a second shaft from one axis goes to its other side."""
        places, graph = machine.placement, machine.graph
        children: dict[str, int] = {}

        def step(mesh: str, forward: bool, height: float) -> float:
            start, end = graph.edges[mesh] if forward else graph.edges[mesh][::-1]
            children[start] = children.get(start, 0) + 1
            distance = float(np.hypot(*np.subtract(places.shafts[end], places.shafts[start])[1:]))
            return height - distance * (1.0 if children[start] % 2 else -1.0)

        heights = graph.propagate(0.0, step)
        reach = {}
        for name, shaft in machine.shafts.items():
            parts = [places.gears[g][0] for g, gear in machine.gears.items() if gear.shaft == name]
            parts += [
                places.bearings[b][0] for b, at in machine.bearings.items() if at.shaft == name
            ]
            start = places.shafts[name][0]
            ends = [start, start + shaft.length] if shaft.sections else [min(parts), max(parts)]
            reach[name] = (ends[0], ends[1])
        return cls(machine, heights, reach)


def shaft_outline(shaft: Shaft, start: float) -> tuple[list[float], list[float]]:
    """Positions along x and radii of the outline of a shaft with sections [m]."""
    x, radius = [], []
    for begin, section in zip(shaft.ends, shaft.sections, strict=False):
        x += [start + begin, start + begin + section.length]
        radius += [0.5 * section.diameters(fraction)[0] for fraction in (0.0, 1.0)]
    return x, radius


def pitch_diameter(machine: Machine, gear: str) -> float:
    """Reference diameter of a gear in its first mesh, without a sign [m]."""
    meshes = (mesh for mesh in machine.meshes.values() if gear in mesh.gears)
    mesh = next(meshes, None)
    teeth = abs(machine.gears[gear].teeth)
    return 0.0 if mesh is None else float(teeth * mesh.transverse_module)


def _box(left: float, right: float, low: float, high: float, trace: dict[str, Any]) -> Trace:
    x, y = [left, right, right, left, left], [low, low, high, high, low]
    return {
        "type": "scatter",
        "mode": "lines",
        "x": _MM * np.array(x),
        "y": _MM * np.array(y),
        "fill": "toself",
        "hoveron": "fills",
        "hoverinfo": "text",
        "showlegend": False,
        **trace,
    }


def _drawn(color: str, fill: str, text: str) -> dict[str, Any]:
    return {"line": {"color": color, "width": 1.2}, "fillcolor": fill, "text": text}


def _shafts(view: SideView) -> Iterator[Trace]:
    machine = view.machine
    thin = min((pitch_diameter(machine, gear) for gear in machine.gears), default=0.02) * _THIN
    for name, shaft in machine.shafts.items():
        load, height = machine.kinematics.shafts[name], view.height[name]
        text = f"shaft {name}: {rounded('speed', load.speed)}, {rounded('torque', load.torque)}"
        left, right = view.reach[name]
        if not shaft.sections:
            middle = 0.5 * (left + right)
            half = max(0.5 * (right - left), 0.02)
            trace = _drawn(INK, _STEEL, f"{text}, rigid")
            low, high = height - 0.5 * thin, height + 0.5 * thin
            yield _box(middle - half, middle + half, low, high, trace)
            continue
        x, radius = shaft_outline(shaft, left)
        upper, lower = height + np.array(radius), height - np.array(radius)
        outline = _box(0.0, 0.0, 0.0, 0.0, _drawn(INK, _STEEL, text))
        outline["x"] = _MM * np.array([*x, *x[::-1], x[0]])
        outline["y"] = _MM * np.array([*upper, *lower[::-1], upper[0]])
        yield outline


def _gears(view: SideView) -> Iterator[Trace]:
    machine = view.machine
    for name, gear in machine.gears.items():
        x, half = machine.placement.gears[name][0], 0.5 * gear.face_width
        height, radius = view.height[gear.shaft], 0.5 * pitch_diameter(machine, name)
        drives = any(load.driver == name for load in machine.kinematics.meshes.values())
        color = PINION if drives else WHEEL
        text = f"{name}: {gear.teeth} teeth, diameter {rounded('reference_diameter', 2.0 * radius)}"
        helix = _helix(machine, name)
        if helix:
            text += f", {rounded('helix_angle', abs(helix))} {'right' if helix > 0.0 else 'left'}"
        trace = _drawn(color, FILLS[color], text)
        yield _box(x - half, x + half, height - radius, height + radius, trace)
        # Teeth of a right-hand gear descend along x on the side of the viewer.
        rise = -half * math.tan(helix)
        for part in _TEETH if helix else ():
            y = height + part * radius
            yield {
                "type": "scatter",
                "mode": "lines",
                "x": _MM * np.array([x - half, x + half]),
                "y": _MM * np.array([y - rise, y + rise]),
                "line": {"color": color, "width": 0.8},
                "hoverinfo": "skip",
                "showlegend": False,
            }


def _helix(machine: Machine, name: str) -> float:
    """Helix angle of a gear, negative of a left-hand one; zero of a spur gear."""
    mesh = next((each for each in machine.meshes.values() if name in each.gears), None)
    if mesh is None:
        return 0.0
    return mesh.helix_angle * (1.0 if gear_hand(name, machine.gears, mesh) == "right" else -1.0)


def _bearings(view: SideView) -> Iterator[Trace]:
    machine = view.machine
    for name, bearing in machine.bearings.items():
        shaft, height = machine.shafts[bearing.shaft], view.height[bearing.shaft]
        rolling = bearing.rolling
        width = getattr(rolling, "width", None) or _WIDTH
        seat = 0.5 * (getattr(rolling, "bore_diameter", None) or _seat(shaft, bearing.position))
        outer = 0.5 * (getattr(rolling, "outer_diameter", None) or 2.0 * _OUTER * seat)
        x = machine.placement.bearings[name][0]
        kind = "linear support" if rolling is None else type(rolling).__name__
        trace = _drawn(MUTED, _SEAT, f"bearing {name}: {kind}")
        for low, high in ((seat, outer), (-outer, -seat)):
            yield _box(x - 0.5 * width, x + 0.5 * width, height + low, height + high, trace)
            yield {
                "type": "scatter",
                "mode": "lines",
                "x": _MM * (x + 0.5 * width * np.array([-1.0, 1.0, np.nan, -1.0, 1.0])),
                "y": _MM * (height + np.array([low, high, np.nan, high, low])),
                "line": {"color": MUTED, "width": 1.0},
                "hoverinfo": "skip",
                "showlegend": False,
            }


def _seat(shaft: Shaft, position: float) -> float:
    """Diameter of the shaft under a bearing [m]."""
    for begin, section in zip(shaft.ends, shaft.sections, strict=False):
        if begin <= position <= begin + section.length + 1e-9:
            return float(section.diameters((position - begin) / section.length)[0])
    return 0.02


def _names(view: SideView) -> list[dict[str, Any]]:
    """Names of shafts at their left end, of bearings and gears above them."""
    machine, notes = view.machine, []

    def note(x: float, y: float, text: str, **more: Any) -> None:
        place = {"x": _MM * x, "y": _MM * y, "text": text, "showarrow": False}
        notes.append({**place, "font": {"size": 12, "color": INK}, **more})

    for name, (left, _) in view.reach.items():
        note(left, view.height[name], f"<b>{name}</b>", xanchor="right", xshift=-8)
    driving = {load.driver for load in machine.kinematics.meshes.values()}
    for name, gear in machine.gears.items():
        side = 1.0 if name in driving else -1.0
        y = view.height[gear.shaft] + side * 0.5 * pitch_diameter(machine, name)
        note(machine.placement.gears[name][0], y, name, yshift=9 * side)
    levels = _levels(view)
    for name, bearing in machine.bearings.items():
        x, height = machine.placement.bearings[name][0], view.height[bearing.shaft]
        note(x, height, name, font={"size": 12, "color": PAIR_COLORS[0]}, yshift=levels[name])
    return notes


def _levels(view: SideView) -> dict[str, int]:
    """Shift of the name of each bearing [px], so that long names of one shaft do not overlap."""
    machine = view.machine
    ends = np.array(list(view.reach.values()))
    across = 2.0 * max(view.height.values()) - 2.0 * min(view.height.values()) + 0.1
    scale = min(_AREA[0] / max(float(np.ptp(ends)), 0.1), _AREA[1] / across)
    # Right end of the last name of a level; the name of a shaft ends left of it.
    right_ends = {(name, 0): scale * left for name, (left, _) in view.reach.items()}
    levels = {}
    for name in sorted(machine.bearings, key=lambda each: machine.placement.bearings[each][0]):
        shaft, half = machine.bearings[name].shaft, 0.5 * _CHARACTER * (len(name) + 1)
        middle = scale * machine.placement.bearings[name][0]
        free = [s for s in _SHIFTS if middle - half >= right_ends.get((shaft, s), -np.inf)]
        levels[name] = free[0] if free else min(_SHIFTS, key=lambda s: right_ends[shaft, s])
        right_ends[shaft, levels[name]] = middle + half
    return levels


@drawing(
    "machine",
    heading="The machine",
    caption="To scale, with the axes unfolded into one plane: shafts with their sections, gears "
    "with their reference circles (blue: driving, orange: driven, an idler counts as driving), "
    "bearings with crosses; lines on helical gears are inclined like their teeth. Point "
    "at a part for its speed, torque or size.",
    of=("Machine", "MachineResult.machine"),
    made_by="Load a case with shafts, or build a tribodyn.machine.Machine.",
)
def machine(machine: Machine) -> Any:
    """Draw the shafts of a machine with gears and bearings, to scale."""
    view = SideView.of(machine)
    traces = [*_shafts(view), *_bearings(view), *_gears(view)]
    run, shafts = machine.operation, machine.kinematics.shafts
    ratio = abs(1.0 / float(shafts[run.output].ratio))
    title = (
        f"{rounded('speed', abs(run.speed))} and {rounded('torque', abs(run.torque))} in, "
        f"{rounded('speed', abs(shafts[run.output].speed))} out: ratio {ratio:.4g}"
    )
    layout = {
        "hovermode": "closest",
        "height": 520,
        "xaxis": {"title": {"text": "Along the shafts [mm]"}, "zeroline": False},
        "yaxis": {
            "title": {"text": "Across [mm]"},
            "scaleanchor": "x",
            "scaleratio": 1.0,
        },
        "annotations": _names(view),
    }
    return figure(title, traces, layout)
