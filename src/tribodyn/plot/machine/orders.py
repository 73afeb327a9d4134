"""Forces and power of a machine, orders by mesh, and the kinematic frequencies of a case."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.machine.side_view import joined_names
from tribodyn.plot.theme.colors import COLORS, INK, MUTED, translucent
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import ROUNDING, Panel, from_zero, stack
from tribodyn.plot.theme.style import (
    Trace,
    axis,
    figure,
    line,
    marked,
    plane_figure,
    sankey,
    stems,
    strokes,
)
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine import Machine, PowerFlow
    from tribodyn.study.frequencies import KinematicFrequencies
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.result import MachineResult


_HARMONICS = 10
#: Strongest lines of a part that are searched, parts with the largest swing, lines of other causes
#: than one mesh, and the distance of those that are named, over the highest mesh frequency.
_STRONGEST, _SEARCHED, _NAMED, _APART = 60, 6, 5, 2.2


def _lines(motion: MachineMotion, quantity: str, amplitudes: Array) -> list[Trace]:
    """Lines at the orders of the meshes: one trace for each mesh, and one for common orders."""
    orders = motion.mesh_orders(_HARMONICS)
    groups: dict[str, list[int]] = {name: [] for name in motion.mesh}
    groups["several meshes"] = []
    labels = {}
    for place, meshes in enumerate(orders.values()):
        group = meshes[0][0] if len(meshes) == 1 else "several meshes"
        groups[group].append(place)
        labels[place] = ", ".join(f"{name} harmonic {number}" for name, number in meshes)
    exact = [motion.line_frequency(meshes) for meshes in orders.values()]
    hertz = displayed("frequency", np.array(exact))
    values, unit = displayed(quantity, amplitudes), display_unit(quantity)
    traces = []
    for number, (name, places) in enumerate(groups.items()):
        if not places:
            continue
        color = INK if name == "several meshes" else COLORS[number % len(COLORS)]
        x, y = hertz[places], values[places]
        traces.append(strokes(*stems(x, y), color, 2, showlegend=False))
        facts = [labels[place] for place in places]
        hover = f"%{{y:.4g}} {unit} at %{{x:.6g}} {display_unit('frequency')}, "
        style: Trace = {"hovertemplate": f"{hover}%{{customdata}}<extra></extra>"}
        traces.append(marked(x, y, name, color, 6, customdata=facts, **style))
    return traces


def _combinations(motion: MachineMotion, quantity: str, signal: Array) -> list[Trace]:
    """Largest lines in one part that are no harmonic of a mesh, with their causes."""
    if motion.phase_turns is None:
        return []  # on one clock an order has no cause of its own
    columns = signal.reshape(len(signal), -1)
    largest: dict[str, tuple[float, float]] = {}
    for column in np.argsort(-np.ptp(columns, axis=0), kind="stable")[:_SEARCHED]:
        for each in motion.lines(columns[:, column], _STRONGEST):
            if each.cause.partition(" x ")[2] not in motion.mesh:
                before = largest.get(each.cause, (0.0, 0.0))
                largest[each.cause] = max(before, (abs(each.amplitude), each.frequency))
    chosen = sorted(largest, key=lambda cause: -largest[cause][0])[:_NAMED]
    if not chosen:
        return []
    amplitudes, frequencies = np.array([largest[cause] for cause in chosen]).T
    x, y = displayed("frequency", frequencies), displayed(quantity, amplitudes)
    hover = f"%{{y:.4g}} {display_unit(quantity)} at %{{x:.6g}} {display_unit('frequency')}"
    points = marked(
        x, y, "several phases", MUTED, 6, symbol="diamond", text=chosen, showlegend=False,
        textposition="top center", hovertemplate=f"{hover}, %{{text}}<extra></extra>",
    )  # fmt: skip
    distance, labelled = _APART * motion.mesh_frequency.max(), list[int]()
    for place, at in enumerate(frequencies):
        if all(abs(at - frequencies[other]) > distance for other in labelled):
            labelled.append(place)
    labels = {"x": x[labelled], "y": y[labelled], "text": [chosen[n] for n in labelled]}
    texts = {**points, **labels, "mode": "text", "cliponaxis": False, "hoverinfo": "skip"}
    return [strokes(*stems(x, y), MUTED, 1, showlegend=False), points, texts]


def _total(motion: MachineMotion, signal: Array) -> Array:
    """Amplitudes over all directions and parts at the orders of the meshes."""
    waves = np.abs(motion.harmonics(signal, np.array(list(motion.mesh_orders(_HARMONICS)))))
    return np.asarray(np.sqrt((waves**2).reshape(len(waves), -1).sum(axis=1)))


def _caption(motion: MachineMotion) -> str:
    kinds = [
        kind for kind, names in (("bearings", motion.bearing), ("housing", motion.node)) if names
    ]
    below = (
        f" Below, what reaches {' and '.join(kinds)}: the root of the sum of the squares over all "
        "of them and over all directions."
    )
    return (
        "Amplitudes at the mesh harmonics: the alternating forces of the meshes."
        + below * bool(kinds)
        + " The colour names the mesh whose harmonic lies at that frequency."
        * (len(motion.mesh) > 1)
        + " Diamonds are the largest lines in one part that are no harmonic of a mesh; pointing at "
        "one shows its cause." * (motion.phase_turns is not None)
    )


@drawing(
    heading="Which mesh causes which line",
    caption=_caption,
    of=("MachineMotion", "MachineResult.motion"),
    made_by="Run a case with shafts: tribodyn.run.",
)
def machine_orders(motion: MachineMotion) -> Sketch:
    """Draw the lines of mesh forces, bearing forces and housing accelerations."""
    signals = [
        ("mesh_force", "Mesh forces", motion.mesh_force),
        ("bearing_force", "Bearing forces", motion.bearing_force[..., :3]),
        ("acceleration", "Housing", motion.acceleration),
    ]
    rows = [
        (q, label, _above_rounding(_total(motion, signal), signal), signal)
        for q, label, signal in signals
        if signal.shape[1]
    ]
    panels = [
        from_zero(
            axis_label(quantity, label),
            [*_lines(motion, quantity, values), *_combinations(motion, quantity, signal)],
        )
        for quantity, label, values, signal in rows
    ]
    quantity, label, values, _ = rows[-1]
    orders = motion.mesh_orders(_HARMONICS)
    top = int(np.argmax(values))
    meshes = list(orders.values())[top]
    harmonics: dict[int, list[str]] = {}
    for name, number in meshes:
        harmonics.setdefault(number, []).append(name)
    cause = " and ".join(
        f"harmonic {number} of mesh {joined_names(names)}" for number, names in harmonics.items()
    )
    title = (
        f"{label}: the largest line, {rounded(quantity, values[top])}, is {cause} at "
        f"{rounded('frequency', motion.line_frequency(meshes))}"
    )
    if not values[top]:
        title = f"{label}: no line at a mesh harmonic"
    return stack(title, axis_label("frequency"), panels, {"hovermode": "closest"})


def _above_rounding(amplitudes: Array, signal: Array) -> Array:
    """Amplitudes of a signal without those that are rounding of its size."""
    return np.where(amplitudes > ROUNDING * np.abs(signal).max(), amplitudes, 0.0)


#: Most samples of a period, most meshes and most bearings that are drawn, height of a panel.
_SAMPLES, _PARTS, _HEIGHT = 30_000, 8, 0.42


def _force_caption(motion: MachineMotion) -> str:
    groups = (("meshes", motion.mesh), ("bearings", motion.bearing))
    left_out = [
        f"{len(names) - _PARTS} of {len(names)} {kind}"
        for kind, names in groups
        if len(names) > _PARTS
    ]
    omitted = f" Left out: {' and '.join(left_out)} with smaller variations." if left_out else ""
    bearings = ", and the radial force on each bearing" if motion.bearing else ""
    return (
        f"Force of each mesh along its line of action{bearings}, without its mean, each to its own "
        "scale; those that vary most come first. " + _period(motion) + omitted
    )


def _period(motion: MachineMotion) -> str:
    if motion.phase_turns is None:
        return "The record is one period, after which the whole motion repeats."
    return (
        "The meshes have no common period: the record comes near all positions that they take to "
        "each other."
    )


def _panels(
    motion: MachineMotion, quantity: str, names: Sequence[str], force: Array
) -> list[Panel]:
    """Alternating force of each part to its own scale, the largest swing first."""
    unit, mean, swing = display_unit(quantity), motion.mean(force), np.ptp(force, axis=0)
    kind = "Mesh" if quantity == "mesh_force" else "Bearing"
    panels, largest = [], np.abs(mean).max(initial=0.0)
    for i in np.argsort(-swing, kind="stable")[:_PARTS]:
        values = displayed(quantity, force[:_SAMPLES, i] - mean[i])
        trace = line(motion.clock[:_SAMPLES], values, names[i], COLORS[i % len(COLORS)], unit=unit)
        varies, level = swing[i] > ROUNDING * largest, rounded(quantity, mean[i])
        size = rounded(quantity, swing[i])
        text = f"{size} peak to peak about {level}" if varies else f"constant, {level}"
        note, axis = f"{kind} {names[i]}: {text}", {"nticks": 4, "zeroline": True}
        of_mean = float(displayed(quantity, largest))
        panels.append(Panel(f"[{unit}]", [trace], axis, _HEIGHT, of_mean, note))
    return panels


@drawing(
    heading="Forces over a period",
    caption=_force_caption,
    of=("MachineMotion", "MachineResult.motion"),
    made_by="Run a case with shafts: tribodyn.run.",
)
def machine_forces(motion: MachineMotion) -> Sketch:
    """Draw the alternating forces of meshes and on bearings over one period of the clock."""
    panels = [
        *_panels(motion, "mesh_force", motion.mesh, motion.mesh_force),
        *_panels(motion, "bearing_force", motion.bearing, motion.radial_force),
    ]
    swing, mean = np.ptp(motion.mesh_force, axis=0), motion.mean(motion.mesh_force)
    worst = int(np.argmax(swing))
    title = (
        f"The force of mesh {motion.mesh[worst]} varies most: "
        f"{rounded('mesh_force', swing[worst])} peak to peak about a mean of "
        f"{rounded('mesh_force', mean[worst])}"
    )
    if swing[worst] <= ROUNDING * np.abs(mean).max():
        title = "No mesh force varies"
    part = f", its first {motion.clock[_SAMPLES]:.2%}" if motion.clock.size > _SAMPLES else ""
    name = "Phase of the clock" if motion.phase_turns is None else "Part of the record"
    label = f"{name}, 1 = {1e3 / motion.frequency:.4g} ms{part}"
    return stack(title, label, panels)


@drawing(
    heading="Frequencies of the parts",
    of="KinematicFrequencies",
    made_by="Take those of a case: tribodyn.kinematic_frequencies.",
)
def kinematic_frequencies(lines: KinematicFrequencies) -> Sketch:
    """Draw the frequencies of the parts, one row for each.

    Each mark is a frequency at which a part repeats: turns of shafts (f), gear meshes (GMF) with
    sidebands, hunting teeth (HTF), assembly phases (APF), defects of bearings (BPFO, BPFI, BSF,
    FTF), passing planets (PPF) and damaged teeth of a stage (TF).
    """
    rows = list(dict.fromkeys(lines.part))
    traces = []
    for number, part in enumerate(rows):
        index = [k for k, name in enumerate(lines.part) if name == part]
        first = {float(lines.frequency[k]): k for k in reversed(index)}
        named = [k in first.values() and "GMF " not in lines.symbol[k] for k in index]
        text = [lines.symbol[k] * labelled for k, labelled in zip(index, named, strict=True)]
        meanings = [f"{lines.symbol[k]}, {lines.meaning[k]}" for k in index]
        style: Trace = {"textposition": "top center", "customdata": meanings, "showlegend": False}
        style["hovertemplate"] = "%{x:.6g} Hz: %{customdata}<extra></extra>"
        place = (lines.frequency[index], [part] * len(index), part, COLORS[number % len(COLORS)])
        trace = marked(*place, 8, "line-ns-open", text=text, **style)
        traces.append({**trace, "mode": "markers+text"})
    title = f"{len(rows)} parts, input at {lines.input_frequency:.4g} Hz"
    x, y = axis("Frequency [Hz]", type="log"), {"autorange": "reversed", "type": "category"}
    return plane_figure(title, traces, x, y, height=160 + 52 * len(rows))


@drawing(
    heading="Flow of power", of="MachineResult", made_by="Run a case with shafts: tribodyn.run."
)
def machine_power(result: MachineResult) -> Sketch:
    """Draw the power that flows through shafts and meshes, and what is lost.

    From the input through shafts and meshes to the output; the width is the power. What the
    friction of computed teeth takes away leaves at each mesh.
    """
    machine, lost = result.machine, result.operation.friction_power
    run, flow, figures = machine.operation, result.operation.power_flow, result.operation.figures
    names = [f"shaft {name}" for name in machine.shafts]
    names += [f"mesh {name}" for name in machine.meshes] + ["input", "output", "friction"]
    links: list[tuple[str, str, float, str]] = []
    power = figures["machine.input_power"]
    leaving = power - sum(lost.values())
    start, end = (run.input, run.output)[:: 1 if run.torque >= 0.0 else -1]
    links.append(("input", f"shaft {start}", power, MUTED))
    for place, name in enumerate(machine.meshes):
        color = COLORS[place % len(COLORS)]
        for shaft, gain in gains(machine, flow, name).items():
            if gain < 0.0:
                links.append((f"shaft {shaft}", f"mesh {name}", -gain, color))
            elif gain > 0.0:
                links.append((f"mesh {name}", f"shaft {shaft}", gain, color))
        if friction := lost.get(name):
            links.append((f"mesh {name}", "friction", friction, color))
    for name, torque in flow.couplings.items():
        ends = machine.couplings[name].shafts
        passing = torque * flow.shafts[ends[0]].speed
        giving, taking = ends if passing > 0.0 else ends[::-1]
        links.append((f"shaft {giving}", f"shaft {taking}", abs(passing), MUTED))
    links.append((f"shaft {end}", "output", leaving, MUTED))
    number = {name: place for place, name in enumerate(names)}
    trace = sankey(
        [(number[a], number[b], value, translucent(color, 0.45)) for a, b, value, color in links],
        "%{source.label} to %{target.label}: %{value:.6g} W",
        "%{label}: %{value:.6g} W",
        label=names, color=MUTED, pad=18, thickness=14,
    )  # fmt: skip
    share = figures.get("machine.efficiency", 1.0)
    efficiency = f", efficiency {100.0 * share:.4g} %" if share < 1.0 else ""
    title = f"{rounded('power', power)} in, {rounded('power', leaving)} out{efficiency}"
    return figure(title, [trace], {"height": 360, "hovermode": "closest"})


def gains(machine: Machine, flow: PowerFlow, name: str) -> dict[str, float]:
    """Power that a mesh gives to its shafts and to its carrier; negative where it takes it."""
    mesh, (first, second) = machine.meshes[name], flow.meshes[name].torque
    shafts = [machine.gears[gear].shaft for gear in mesh.gears]
    torques = dict(zip(shafts, (-first, second), strict=True))
    if mesh.carrier:
        torques[mesh.carrier] = first - second
    return {shaft: torque * flow.shafts[shaft].speed for shaft, torque in torques.items()}
