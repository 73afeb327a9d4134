"""Natural modes of a machine drawn on its shafts, and its Campbell diagram."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.machine.side_view import SideView, joined_names, shaft_outline
from tribodyn.plot.motion.linear import crossing_dots, natural_lines
from tribodyn.plot.theme.colors import COLORS, GRID, MUTED, PAIR_COLORS, PINION, WHEEL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import Panel, event_lines, stack
from tribodyn.plot.theme.style import Trace, axis, choice, line, plane_figure, strokes
from tribodyn.study.machine.modes import energy_shares, modes_in_reach
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.machine import MachineModes, MachineStructure
    from tribodyn.study.machine.modes import MachineCampbell, Meeting

#: Modes that can be chosen, points along a shaft, and largest drawn displacement over the height.
_MOST, _POINTS, _SIZE = 16, 41, 0.12
#: Directions drawn on a shaft: label, row of the displacement, colour, dash.
_DRAWN = (("y", 1, PINION, "solid"), ("z", 2, WHEEL, "dash"), ("x", 0, PAIR_COLORS[0], "dot"))


def _outlines(view: SideView) -> list[Trace]:
    traces = []
    for name, shaft in view.machine.shafts.items():
        ends = list(view.reach[name])
        x, radius = shaft_outline(shaft) if shaft.sections else (ends, [0.0, 0.0])
        points = view.place(name, [*x, *x[::-1]], [*radius, *(-r for r in radius[::-1])])
        fill: Trace = {"fill": "toself", "fillcolor": GRID, "showlegend": False}
        traces.append(strokes(*points, MUTED, 0.5, **fill))
    return traces


def _points(structure: MachineStructure) -> dict[str, tuple[Array, Array]]:
    """Positions on each shaft (p,), and their displacement per coordinate (p, 6, n)."""
    points = {}
    for name, shaft in structure.machine.shafts.items():
        at = np.linspace(0.0, shaft.length, _POINTS if shaft.sections else 1)
        points[name] = at, np.array([structure.at(name, float(place)) for place in at])
    return points


def _deflection(
    view: SideView, points: dict[str, tuple[Array, Array]], shape: ComplexArray, height: float
) -> list[Trace]:
    """Curves of a mode along every shaft, in the phase of its largest displacement."""
    curves: dict[str, tuple[list[float], list[float]]] = {name: ([], []) for name, *_ in _DRAWN}
    parts = [(name, at, motion @ shape) for name, (at, motion) in points.items()]
    largest = max(float(np.abs(moved[:, :3]).max()) for *_, moved in parts) or 1.0
    for name, at, moved in parts:
        for label, row, *_ in _DRAWN:
            x, y = curves[label]
            shift = _SIZE * height * moved[:, row].real / largest
            places = view.place(name, at, shift)
            x += [*places[0].tolist(), np.nan]
            y += [*places[1].tolist(), np.nan]
    return [
        {**line(*curves[label], f"along {label}", color, dash=dash), "hoverinfo": "skip"}
        for label, _, color, dash in _DRAWN
    ]


def _rigid(modes: MachineModes) -> str:
    shafts = modes.structure.machine.shafts.values()
    return "" if any(shaft.sections for shaft in shafts) else "All shafts are rigid points."


@drawing(
    heading="Natural modes on the shafts",
    missing=_rigid,
    of=("MachineModes", "MachineResult.modes"),
    made_by="Run a case with shafts, or call tribodyn.machine.machine_modes.",
)
def machine_modes(modes: MachineModes) -> Sketch:
    """Draw the natural modes of a machine on its shafts, one at a time.

    Choose a mode: its displacement along y, z and x is drawn as a distance from the axis of each
    shaft, to one scale. The title lists where its strain energy is; meshes excite the modes that
    strain them.
    """
    structure = modes.structure
    view = SideView.of(structure.machine)
    reach = modes_in_reach(modes)
    count = min(max(reach, 1), _MOST, len(modes.frequency))
    height = view.height or 0.2
    outlines, order = _outlines(view), range(count)
    first, points = int(np.argmax(modes.share_by_kind()["meshes"][:count])), _points(structure)
    traces = [
        {**trace, "visible": number == first}
        for number in order
        for trace in _deflection(view, points, modes.shape[number], height)
    ]
    labels = [f"{k + 1}: {significant(modes.frequency[k], 4)} Hz" for k in order]
    titles = [f"{label}: {energy_shares(modes, k)}" for k, label in enumerate(labels)]
    visible = [
        [True] * len(outlines) + [k == number for k in order for _ in _DRAWN] for number in order
    ]
    x = axis("Along the shafts [mm]", constrain="domain")
    y = axis("Across [mm]", scaleanchor="x", constrain="domain")
    menus = [choice(labels, titles, visible, first)]
    title = (
        f"{first + 1}: {rounded('frequency', modes.frequency[first], 4)}: "
        f"{energy_shares(modes, first)}"
    )
    layout: Trace = {"height": 520, "hovermode": False, "updatemenus": menus}
    return plane_figure(title, [*outlines, *traces], x, y, **layout)


def _equal_orders(diagram: MachineCampbell) -> dict[str, int]:
    """Lines of the diagram by name; those of equal order, as of all meshes of a stage, are one."""
    groups: dict[tuple[str, str, float], dict[str, int]] = {}
    for number, (text, order) in enumerate(zip(diagram.excitation, diagram.order, strict=True)):
        kind, _, part = text.partition(" ")
        name, times, harmonic = part.partition(" x ")
        key = kind, times + harmonic, round(float(order), 9)
        groups.setdefault(key, {})[name] = number
    lines = {}
    for (kind, suffix, _), numbers in groups.items():
        stages = {name.rpartition("_")[0] for name in numbers}
        of_stage = kind == "mesh" and len(numbers) > 1 and len(stages) == 1
        label = (of_stage and stages.pop()) or joined_names(list(numbers))
        lines[f"{kind} {label}{suffix}"] = min(numbers.values())
    return lines


def _excitations(diagram: MachineCampbell, speed: Array, hertz: Array) -> list[Trace]:
    """Lines of the mesh harmonics in the colour of the mesh, and of the turning of the shafts."""
    equal, traces, unit = _equal_orders(diagram), list[Trace](), display_unit("frequency")
    groups = {name: name.rpartition(" x ")[0] or name for name in equal}
    colors = dict(zip(dict.fromkeys(groups.values()), cycle(COLORS), strict=False))
    named: set[str] = set()
    for name, number in equal.items():
        mesh = " x " in name
        group = groups[name] if mesh else "turning shafts"
        color, dash = (colors[groups[name]], "solid") if mesh else (MUTED, "dot")
        trace = line(speed, hertz[number], group, color, unit=unit, dash=dash)
        if mesh:
            text = [""] * (len(speed) - 1) + [name.removeprefix("mesh ")]
            trace |= {"mode": "lines+text", "text": text, "textposition": "middle right"}
        trace |= {"legendgroup": group, "showlegend": group not in named, "cliponaxis": False}
        traces.append(trace)
        named.add(group)
    return traces


def _crossings(met: Sequence[Meeting]) -> Trace:
    texts = [
        f"{each.excitation} meets mode {each.mode + 1}, {100.0 * each.share:.2g} % of its strain"
        for each in met
    ]
    speed = displayed("speed", np.array([each.speed for each in met]))
    hertz = displayed("frequency", np.array([each.frequency for each in met]))
    return crossing_dots(speed, hertz, [each.share for each in met], texts)


@drawing(
    heading="Campbell diagram of the machine",
    of=("MachineCampbell", "MachineResult.campbell"),
    made_by="Run a case with shafts, or tribodyn modes.",
)
def machine_campbell(diagram: MachineCampbell) -> Sketch:
    """Draw natural frequencies and labelled excitations over the speed of the input.

    Natural frequencies and what excites them over the speed of the input: the harmonics of each
    mesh in its colour, and the turning of the shafts (dotted). Dark, numbered modes are met by a
    mesh that strains them, at the dots; the larger the dot, the larger the part of the strain
    energy that lies in the mesh. Light modes are not met, or not strained.
    """
    speed = displayed("speed", diagram.speed)
    hertz = displayed("frequency", np.multiply.outer(diagram.order, diagram.speed) / (2.0 * np.pi))
    top, met = float(hertz.max()), diagram.meetings()
    traces = natural_lines(speed, diagram.frequency, 1, {each.mode for each in met}, top)
    traces += _excitations(diagram, speed, hertz)
    title = "No mesh meets a natural frequency that it strains in this range of speeds"
    if met:
        traces.append(_crossings(met))
        title = (
            f"{met[0].excitation} meets {rounded('frequency', met[0].frequency, 4)} at "
            f"{rounded('speed', met[0].speed)}, nearest to the operating speed"
        )
    marks = [("operation", float(displayed("speed", diagram.operating_speed)))]
    panel = Panel(axis_label("frequency"), traces, {"range": [0.0, 1.02 * top]}, height=2.0)
    end = float(speed[-1])  # with room for the names at the ends of the lines
    layout = {"hovermode": "closest", "xaxis": {"range": [-0.03 * end, 1.12 * end]}}
    label = axis_label("speed", "Speed of the input")
    return stack(title, label, [panel], {**layout, **event_lines(marks)})
