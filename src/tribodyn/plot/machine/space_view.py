"""View of a machine in space: parts to scale, what flows through them, and how they vibrate."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.machine.orders import gains
from tribodyn.plot.machine.side_view import (
    SEAT_COLOR,
    STEEL_COLOR,
    SideView,
    bearing_ring,
    bearing_text,
    cone,
    gear_color,
    gear_text,
    helix,
    pitch_diameter,
    shaft_text,
)
from tribodyn.plot.theme.colors import GRID, INK, PAIR_COLORS
from tribodyn.plot.theme.labels import rounded, significant
from tribodyn.plot.theme.panels import ROUNDING
from tribodyn.plot.theme.style import Trace, choice, figure
from tribodyn.study.machine.modes import energy_shares, modes_in_reach
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine import Machine, MachineModes

_MM = 1e3
#: Corners of a circle, modes that can be chosen, shares in their titles, and their largest drawn
#: displacement over the size of the machine.
_CORNERS, _MOST, _SHARES, _SIZE = 48, 12, 3, 0.06
#: Points along a shaft and along a tooth, width of a line that carries all the power [px], and
#: opacity of the parts behind such lines.
_POINTS, _TOOTH, _WIDTH, _FAINT = 25, 5, 14.0, 0.15
_TURN = np.linspace(0.0, 2.0 * np.pi, _CORNERS + 1)
#: Unit circle across an axis (2, corners).
_CIRCLE = np.array([np.cos(_TURN), np.sin(_TURN)])


class _Space:
    """Points on the shafts of a machine in space [mm]."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine

    def place(self, shaft: str, along: Any, across: Array) -> Array:
        """Points (n, 3) at positions along a shaft and displacements across it (2, n) [m]."""
        places = self.machine.placement
        parts = [np.broadcast_to(along, across.shape[1:]), *across]
        points = np.add(places.shafts[shaft], np.array(parts).T @ places.axes[shaft].T)
        return np.asarray(_MM * points)

    def on_axis(self, shaft: str, along: float) -> Array:
        """Point (3,) on the axis of a shaft."""
        return np.asarray(self.place(shaft, along, np.zeros((2, 1)))[0])

    def from_axis(self, shaft: str, gear: str) -> tuple[float, float]:
        """Position of the middle of a gear along a shaft, and its distance from the axis [m]."""
        places = self.machine.placement
        x, *across = np.subtract(places.gears[gear], places.shafts[shaft]) @ places.axes[shaft]
        return float(x), float(np.hypot(*across))


def _surface(
    space: _Space, shaft: str, x: Sequence[float], radius: Sequence[float], color: str, text: str
) -> Trace:
    """Body of revolution around a shaft, by the corners of its outline [m]."""
    rows = [space.place(shaft, at, r * _CIRCLE) for at, r in zip(x, radius, strict=True)]
    width, corner = _CIRCLE.shape[1], np.arange(_CORNERS)
    first = np.concatenate([row * width + corner for row in range(len(rows) - 1)])
    # Two triangles between each pair of neighbours on two circles.
    i, j, k = (np.concatenate(part) for part in (
        (first, first + 1), (first + 1, first + width + 1), (first + width, first + width)
    ))  # fmt: skip
    corners = np.concatenate(rows).T
    return {
        "type": "mesh3d", **dict(zip("xyz", corners.astype(np.float32), strict=True)),
        "i": i, "j": j, "k": k, "color": color, "flatshading": True, "hoverinfo": "text",
        "text": text, "lighting": {"ambient": 0.6, "diffuse": 0.6, "specular": 0.1},
    }  # fmt: skip


def _strokes(rows: Sequence[Array], color: str, width: float, text: str = "") -> Trace:
    """Lines through the points of each row (n, 3)."""
    gap = np.full((1, 3), np.nan)
    x, y, z = np.concatenate([part for row in rows for part in (row, gap)]).T.astype(np.float32)
    hover = {"hoverinfo": "text", "text": text} if text else {"hoverinfo": "skip"}
    style = {"line": {"color": color, "width": width}, "showlegend": False, **hover}
    return {"type": "scatter3d", "mode": "lines", "x": x, "y": y, "z": z, **style}


def _parts(space: _Space) -> Iterator[Trace]:
    """Shafts, bearings and gears with the lines of their teeth."""
    machine, view = space.machine, SideView.of(space.machine)
    for name in machine.shafts:
        x, radius = view.outline(name)
        outline = [x[0], *x, x[-1]], [0.0, *radius, 0.0]
        yield _surface(space, name, *outline, STEEL_COLOR, shaft_text(machine, name))
    for name, bearing in machine.bearings.items():
        left, right, inner, outer = bearing_ring(machine, name)
        box = [left, right, right, left, left], [inner, inner, outer, outer, inner]
        yield _surface(space, bearing.shaft, *box, SEAT_COLOR, bearing_text(machine, name))
    for name, gear in machine.gears.items():
        color, (outline, teeth) = gear_color(machine, name), _gear(machine, name)
        yield _surface(space, gear.shaft, *outline, color, gear_text(machine, name))
        pitch = 2.0 * np.pi / abs(gear.teeth)
        angle = np.add.outer(pitch * np.arange(abs(gear.teeth)), teeth[2])
        rows = [space.place(gear.shaft, teeth[0], teeth[1] * _unit(each)) for each in angle]
        yield _strokes(rows, INK, 1.5)


def _unit(angle: Array) -> Array:
    """Unit vectors across an axis (2, n)."""
    return np.array([np.cos(angle), np.sin(angle)])


def _gear(machine: Machine, name: str) -> tuple[tuple[list[float], list[float]], Array]:
    """Outline of the reference body of a gear [m]; position, radius and angle along a tooth."""
    gear, bevel = machine.gears[name], cone(machine, name)
    if bevel is not None:
        x, radius = [float(at) for at in bevel[0][:2]], [float(r) for r in bevel[1][:2]]
    else:
        half = 0.5 * gear.face_width
        x = [gear.node_position - half, gear.node_position + half]
        radius = [0.5 * pitch_diameter(machine, name)] * 2
    if gear.teeth < 0:  # a ring, whose rim is drawn two and a half modules thick
        rim = radius[0] * (1.0 + 5.0 / abs(gear.teeth))
        outline = [x[0], x[1], x[1], x[0], x[0]], [radius[0], radius[1], rim, rim, radius[0]]
    else:
        outline = [x[0], *x, x[1]], [0.0, *radius, 0.0]
    rise = (x[1] - x[0]) * math.tan(helix(machine, name)) / max(radius)
    # Lines lie just outside the body, or just inside a ring, to be seen.
    shift = 0.995 if gear.teeth < 0 else 1.005
    ends = np.array([x, [shift * r for r in radius], [-0.5 * rise, 0.5 * rise]])
    return outline, np.linspace(ends[:, 0], ends[:, 1], _TOOTH).T


def _power(space: _Space) -> Iterator[Trace]:
    """Lines of the power through meshes and along shafts, as wide as its part of the input."""
    machine, flow, view = space.machine, space.machine.kinematics, SideView.of(space.machine)
    run = machine.operation
    total = run.torque * run.speed
    exchanged: dict[str, list[tuple[float, float]]] = {name: [] for name in machine.shafts}
    arms: dict[tuple[str, str], float] = {}
    for name, mesh in machine.meshes.items():
        powers = gains(machine, flow, name)
        middles = []
        for gear in (machine.gears[each] for each in mesh.gears):
            middles.append(space.on_axis(gear.shaft, gear.node_position))
            exchanged[gear.shaft].append((gear.node_position, powers[gear.shaft]))
        power = max(abs(powers[machine.gears[each].shaft]) for each in mesh.gears)
        yield _flow(f"mesh {name}", middles, PAIR_COLORS[0], power, total)
        if carrier := mesh.carrier:
            distance = {each: space.from_axis(carrier, each)[1] for each in mesh.gears}
            planet = max(mesh.gears, key=distance.__getitem__)
            arms[carrier, planet] = arms.get((carrier, planet), 0.0) + powers[carrier]
    for (carrier, planet), power in arms.items():
        gear, half_width = machine.gears[planet], 0.5 * machine.gears[planet].face_width
        along = space.from_axis(carrier, planet)[0] + half_width
        exchanged[carrier].append((along, power))
        ends = [
            space.on_axis(carrier, along),
            space.on_axis(gear.shaft, gear.node_position + half_width),
        ]
        yield _flow(f"carrier {carrier}", ends, INK, abs(power), total)
    for name, torque in flow.couplings.items():
        first, second = machine.couplings[name].shafts
        power = torque * flow.shafts[first].speed
        nearest = min(
            ((a, b) for a in view.outline(first)[0] for b in view.outline(second)[0]),
            key=lambda ends: float(np.ptp(
                [space.on_axis(first, ends[0]), space.on_axis(second, ends[1])], axis=0
            ).max()),
        )  # fmt: skip
        exchanged[first].append((nearest[0], -power))
        exchanged[second].append((nearest[1], power))
    for shaft, power in ((run.input, total), (run.output, -total)):
        # The end of the shaft that is farther from its other parts.
        places = [at for at, _ in exchanged[shaft]] or [0.0]
        x = view.outline(shaft)[0]
        end = max((x[0], x[-1]), key=lambda at: min(abs(at - each) for each in places))
        exchanged[shaft].append((end, power))
    for name, parts in exchanged.items():
        passing = 0.0
        for (start, gain), (end, _) in pairwise(sorted(parts)):
            passing += gain
            ends = [space.on_axis(name, at) for at in (start, end)]
            if end > start and abs(passing) > ROUNDING * abs(total):
                yield _flow(f"shaft {name}", ends, INK, abs(passing), total)


def _flow(part: str, ends: Sequence[Array], color: str, power: float, total: float) -> Trace:
    """Line of a power between two points."""
    width = _WIDTH * min(power / abs(total), 2.0)
    return _strokes([np.array(ends)], color, width, f"{part}: {rounded('power', power)}")


def _mode(space: _Space, modes: MachineModes, number: int) -> Iterator[Trace]:
    """Displaced axes of the shafts and reference circles of the gears in a mode."""
    machine, structure, view = space.machine, modes.structure, SideView.of(space.machine)
    shape = modes.shape[number]
    axes, circles, largest = [], [], 0.0
    for name, shaft in machine.shafts.items():
        along = np.linspace(*view.reach[name], _POINTS if shaft.sections else 2)
        moved = np.array([(structure.at(name, float(at)) @ shape).real for at in along]).T
        axes.append((name, along, np.zeros((2, len(along))), moved))
    for name, gear in machine.gears.items():
        radius, motion = 0.5 * pitch_diameter(machine, name), (structure.gear(name) @ shape).real
        arms = radius * np.concatenate([np.zeros((2, 1)), _CIRCLE], axis=1)
        lever = np.array([np.zeros(arms.shape[1]), *arms]).T
        moved = motion[:3] + np.cross(motion[3:], lever)
        turning = np.repeat(motion[3:, None], arms.shape[1], axis=1)
        along = np.full(arms.shape[1], gear.node_position)
        circles.append((gear.shaft, along, arms, np.concatenate([moved.T, turning])))
    for *_, moved in (*axes, *circles):
        largest = max(largest, float(np.abs(moved[:3]).max()))
    places = np.array(list(machine.placement.gears.values()))
    scale = _SIZE * max(float(np.ptp(places, axis=0).max()), view.height, 0.1) / (largest or 1.0)
    for parts, color, width in ((axes, INK, 4.0), (circles, PAIR_COLORS[0], 3.0)):
        yield _strokes(
            [
                space.place(shaft, along + scale * moved[0], arms + scale * moved[1:3])
                for shaft, along, arms, moved in parts
            ],
            color,
            width,
        )


@drawing(
    heading="The machine in space",
    of=("MachineModes", "MachineResult.modes", "Machine"),
    made_by="Run a case with shafts, or build a tribodyn.machine.Machine.",
)
def machine_space(machine: Machine | MachineModes) -> Sketch:
    """Draw the machine in space, with the flow of power and its natural modes to choose from.

    To scale; drag to turn it. Shafts, bearings and gears with their reference bodies and the lines
    of their teeth (blue: driving, orange: driven). Choose the flow of power, drawn as lines as wide
    as their part of the power at the input, or a natural mode: axes of shafts (dark) and reference
    circles of gears, displaced from where they are at rest.
    """
    structure = getattr(machine, "structure", None)
    modes = None if structure is None else cast("MachineModes", machine)
    space = _Space(cast("Machine", machine) if structure is None else structure.machine)
    parts, choices = list(_parts(space)), [("The machine", "The machine, to scale", list[Trace]())]
    power = list(_power(space))
    run = space.machine.operation
    text = f"Flow of power: {rounded('power', abs(run.torque * run.speed))} in"
    choices += [("Flow of power", text, power)] if run.speed and run.torque else []
    if modes is not None:
        for number in range(min(modes_in_reach(modes), _MOST, len(modes.frequency))):
            label = f"{number + 1}: {significant(modes.frequency[number], 4)} Hz"
            title = f"Mode {label}: {', '.join(energy_shares(modes, number).split(', ')[:_SHARES])}"
            choices.append((label, title, list(_mode(space, modes, number))))
    faint = [{**part, "opacity": _FAINT, "hoverinfo": "skip"} for part in parts]
    traces = [*parts, *({**part, "visible": False} for part in faint)]
    counts = [len(more) for *_, more in choices]
    visible = []
    for place, (*_, more) in enumerate(choices):
        flags = [not more] * len(parts) + [bool(more)] * len(parts)
        for other, count in enumerate(counts):
            flags += [other == place] * count
        visible.append(flags)
        traces += [{**each, "visible": False} for each in more]
    ends = {"showbackground": False, "gridcolor": GRID, "zeroline": False}
    scene: Trace = {f"{name}axis": {"title": {"text": f"{name} [mm]"}, **ends} for name in "xyz"}
    # A long machine is as much longer than the mean of its sides, and is seen from further away.
    sides = [
        max(np.nanmax(p[n]) for p in parts) - min(np.nanmin(p[n]) for p in parts) for n in "xyz"
    ]
    away = max(1.0, 0.9 * max(sides) / float(np.prod(sides)) ** (1 / 3))
    eye = {"x": -1.5 * away, "y": -1.3 * away, "z": 0.9 * away}
    scene |= {"aspectmode": "data", "camera": {"eye": eye, "center": {"x": 0, "y": 0, "z": -0.25}}}
    menu = choice([label for label, *_ in choices], [title for _, title, _ in choices], visible, 0)
    layout: Trace = {"height": 560, "scene": scene, "hovermode": "closest", "updatemenus": [menu]}
    layout |= {"margin": {"l": 10, "r": 10, "t": 74, "b": 10}, "uirevision": "turned by the user"}
    return figure(choices[0][1], traces, layout)
