"""Levels of a machine over its speed or over another value, with the modes that meshes meet."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.motion.sweeps import axis_text, value_text
from tribodyn.plot.theme.colors import COLORS, MUTED
from tribodyn.plot.theme.labels import axis_label, displayed, listed, rounded
from tribodyn.plot.theme.panels import FROM_ZERO, Panel, Row, curves, event_lines, stack, stack_rows
from tribodyn.plot.theme.style import Trace, marked
from tribodyn.study.pipeline.summary_figures import in_words
from tribodyn.study.studies.sweep_result import OF_PARTS, level_keys

if TYPE_CHECKING:
    from tribodyn.study.result_comparison import ResultComparison
    from tribodyn.study.studies.levels import MachineLevels, Resonance
    from tribodyn.study.studies.sweep_result import Sweep
    from tribodyn.study.uncertain.ensemble import MachineEnsemble
    from tribodyn.types import Array

#: Quantity and label of each panel.
_PANELS = (
    ("mesh_force", "Mesh force, rms"),
    ("dynamic_transmission_error", "Transmission error,<br>peak to peak"),
    ("bearing_force", "Radial bearing<br>force, rms"),
    ("acceleration", "Housing, rms"),
    ("mesh_load_factor", "Load factor<br>of the planets"),
)
#: Least distance of two named speeds over the range.
_APART = 0.06
#: Harmonics of a mesh by dash.
_DASHES = ("solid", "dash", "dot", "dashdot")


def _panels(x: Array, levels: Iterable[tuple[Sequence[str], Array]]) -> list[Panel]:
    """One panel for each kind of level, with a curve for each part that has it."""
    panels = []
    for (quantity, label), (names, values) in zip(_PANELS, levels, strict=False):
        if not len(names):
            continue
        rows = [(name, values[:, k], COLORS[k % len(COLORS)]) for k, name in enumerate(names)]
        panels.append(curves(quantity, label, x, rows, FROM_ZERO))
    return panels


def levels_text(*parts: Sequence[str]) -> str:
    """Sentence that lists the levels of those kinds of parts that a machine has."""
    names = ("mesh forces (rms)", "transmission errors (peak to peak)",
             "radial bearing forces (rms)", "accelerations of the housing (rms)",
             "load factors of the planets")  # fmt: skip
    listed = _listed(names, parts)
    return f"Levels without the mean: {listed}." if listed else "No level was computed."


def _of_all(*parts: Sequence[str]) -> str:
    return _listed(("meshes", "bearings", "points of the housing"), parts)


def _listed(names: Sequence[str], parts: Sequence[Sequence[str]]) -> str:
    return listed([name for name, part in zip(names, parts, strict=False) if len(part)])


def _swept(study: Sweep) -> str:
    parts = [level_keys(study.figures, figure) for figure in OF_PARTS]
    caption = levels_text(*parts)
    if study.axes[0].key == "operation.speed":
        caption += (
            " Dotted lines are where a harmonic of a mesh meets a natural mode that strains it."
        )
    return caption + " Crosses are values that failed." * any(map(bool, study.failed))


def _compared(comparison: ResultComparison) -> str:
    keys = dict.fromkeys(key for result in comparison.results for key in result.summary())
    kinds = {quantity: names for quantity, _, names, _ in _by_kind(keys)}
    parts = [kinds.get(quantity, []) for quantity, _ in _PANELS]
    return f"{levels_text(*parts)} At the operating point, one bar for each result."


def _marks(met: Iterable[Resonance], x: Array | None = None) -> Trace:
    """Vertical lines where a mesh meets a mode; of those too near to be named the strongest."""
    places: list[tuple[str, float]] = []
    for each in met:
        place = float(displayed("speed", each.speed))
        if x is None or all(abs(place - other) > _APART * np.ptp(x) for _, other in places):
            places.append((f"{each.mesh} x{each.harmonic}: mode {each.mode}", place))
    return {**event_lines(places), "hovermode": "closest"}


def _title(levels: Iterable[tuple[Sequence[str], Array]], x: Sequence[str]) -> str:
    """Where the housing, or what there is, vibrates most."""
    texts = ("Mesh", "The transmission error of mesh", "Bearing", "The housing at", "Stage")
    rows = zip(texts, _PANELS, levels, strict=False)
    present = [row for row in rows if np.any(np.isfinite(row[2][1]))]
    if not present:
        return "No value has a motion"
    text, (quantity, _), (names, values) = present[-1]
    at, part = np.unravel_index(int(np.nanargmax(values)), values.shape)
    greatest = rounded(quantity, values[at, part])
    return f"{text} {names[int(part)]} has the largest level at {x[int(at)]}: {greatest}"


@drawing(
    heading="Levels over the speed",
    caption=lambda study: (
        levels_text(study.mesh, study.mesh, study.bearing, study.node)
        + " Dotted lines are speeds at which a harmonic of a mesh meets a natural mode that "
        "strains this mesh: the few with the largest amplitudes at the "
        f"{'bearings' if study.bearing else 'meshes'}." * bool(study.resonances)
    ),
    of="MachineLevels",
    made_by="Call tribodyn.speed_sweep or tribodyn.run_up with a machine.",
)
def machine_levels(study: MachineLevels) -> Sketch:
    """Draw the levels of all parts over the speed of the input."""
    x = displayed("speed", study.speed)
    levels = [
        (study.mesh, study.mesh_force),
        (study.mesh, study.transmission_error),
        (study.bearing, study.bearing_force),
        (study.node, study.acceleration),
    ]
    title = _title(levels, [rounded("speed", speed) for speed in study.speed])
    label = axis_label("speed", "Speed of the input")
    return stack(title, label, _panels(x, levels), _marks(study.resonances, x))


@drawing(
    heading="Which mesh causes the level",
    caption=lambda study: (
        "Amplitudes at the harmonics of each mesh over the speed, in the colour of the mesh: the "
        f"root of the sum of the squares over all {_of_all(study.mesh, study.bearing, study.node)}."
    ),
    of="MachineLevels",
    made_by="Call tribodyn.speed_sweep or tribodyn.run_up with a machine.",
)
def machine_level_lines(study: MachineLevels) -> Sketch:
    """Draw the amplitudes at the mesh harmonics over the speed of the input."""
    x, panels, largest = displayed("speed", study.speed), [], ""
    sources = list(dict.fromkeys(name.rpartition(" x ")[0] for name in study.line))
    signals = (
        ("mesh_force", "Mesh forces", study.mesh_force_line),
        ("bearing_force", "Radial bearing<br>forces", study.bearing_force_line),
        ("acceleration", "Housing", study.acceleration_line),
    )
    for quantity, label, values in signals:
        if not values.shape[2]:
            continue
        total, rows = np.sqrt((values**2).sum(axis=2)), []
        for k, name in enumerate(study.line):
            mesh, _, harmonic = name.rpartition(" x ")
            dash = _DASHES[(int(harmonic) - 1) % len(_DASHES)]
            rows.append((name, total[:, k], COLORS[sources.index(mesh) % len(COLORS)], dash))
        panels.append(curves(quantity, label, x, rows, FROM_ZERO, width=1.6))
        if np.any(np.isfinite(total)):
            at, top = np.unravel_index(int(np.nanargmax(total)), total.shape)
            largest = (
                f"{label.replace('<br>', ' ')}: the largest line is {study.line[int(top)]} at "
                f"{rounded('speed', study.speed[at])}"
            )
    label = axis_label("speed", "Speed of the input")
    return stack(largest or "No speed has a motion", label, panels, _marks(study.resonances, x))


def _lack(study: Sweep) -> str:
    if study.case.lumped:
        return "It is the sweep of a pair of gears; draw one of its figures."
    if len(study.axes) > 1:
        return "It has several keys; draw one of its figures."
    return "" if study.axes[0].numeric else "Its values are no numbers; draw one of its figures."


@drawing(
    heading="Levels of the parts",
    caption=_swept,
    missing=_lack,
    of="Sweep",
    made_by='Call tribodyn.sweep(machine, "operation.speed", ("400 rpm", "3500 rpm"), 60).',
)
def machine_sweep(study: Sweep) -> Sketch:
    """Draw the levels of all parts of a machine over the value that varies."""
    (axis,) = study.axes
    x, levels = axis.display_values(), []
    for figure in OF_PARTS:
        names = level_keys(study.figures, figure)
        parts = [name.partition(".")[2].rpartition(".")[0] for name in names]
        columns = np.stack([study[name] for name in names], axis=1) if names else np.zeros((1, 0))
        levels.append((parts, columns))
    panels = _panels(x, levels)
    lost = np.array([bool(text) for text in study.failed])
    if lost.any() and panels:
        cross = marked(x[lost], np.zeros(lost.sum()), "failed", MUTED, 8, "x")
        first = panels[0]
        panels[0] = Panel(first.label, [*first.traces, cross], first.axis)
    marks = _marks(_met(study) if axis.key == "operation.speed" else (), x)
    title = _title(levels, [value_text(axis, value) for value in axis.values])
    return stack(title, axis_text(axis), panels, marks)


def _met(study: Sweep) -> list[Resonance]:
    """Resonances within the speeds of a sweep, with the teeth at the operating point."""
    from tribodyn.errors import TribodynError, quiet
    from tribodyn.study.studies.levels import resonances
    from tribodyn.study.studies.modes import modes_at_rest

    speeds = [abs(float(value)) for value in study.axes[0].values]
    try:
        with quiet():
            modes, orders = modes_at_rest(study.case)
    except TribodynError:  # a sweep may start from a case that cannot be computed itself
        return []
    return resonances(modes.frequency, orders, (min(speeds), max(speeds)))


def _not_of_machines(comparison: ResultComparison) -> str:
    machines = all(not each.case.lumped for each in comparison.results)
    return "" if machines else "It compares pairs of gears; draw it by result_comparison."


@drawing(
    heading="Levels of the parts",
    caption=_compared,
    missing=_not_of_machines,
    of="ResultComparison",
    made_by="tribodyn.compare_results",
)
def machine_comparison(comparison: ResultComparison) -> Sketch:
    """Draw the levels of all parts of several machines as bars."""
    summaries = [result.summary() for result in comparison.results]
    keys = dict.fromkeys(key for summary in summaries for key in summary)
    rows = []
    for quantity, label, names, parts in _by_kind(keys):
        traces: list[Trace] = []
        for number, (title, summary) in enumerate(zip(comparison.names, summaries, strict=True)):
            values = np.array([summary.get(name, np.nan) for name in names])
            bar = {"type": "bar", "x": parts, "y": displayed(quantity, values), "name": title}
            traces.append({**bar, "marker": {"color": COLORS[number % len(COLORS)]}})
        rows.append(Row("", Panel(axis_label(quantity, label), traces, FROM_ZERO)))
    first, last = summaries[0], summaries[-1]
    shared = [n for *_, names, _ in _by_kind(keys) for n in names if first.get(n) and n in last]
    title = "No level differs"
    if shared:
        name = max(shared, key=lambda each: abs(last[each] / first[each] - 1.0))
        change = 100.0 * (last[name] / first[name] - 1.0)
        ends = f"from {comparison.names[0]} to {comparison.names[-1]}"
        title = f"{in_words(name)}: {change:+.3g} % {ends}"
    return stack_rows(title, rows, {"barmode": "group"})


def _by_kind(keys: Iterable[str]) -> Iterator[tuple[str, str, list[str], list[str]]]:
    """Quantity, label, keys of the summary and names of parts of each kind of level."""
    for (quantity, label), figure in zip(_PANELS, OF_PARTS, strict=True):
        names = level_keys((k for k in keys if not k.startswith("load_cases.")), figure)
        if names:
            parts = [name.partition(".")[2].rpartition(".")[0] for name in names]
            yield quantity, label, names, parts


@drawing(
    heading="Spread of the levels",
    of="MachineEnsemble",
    made_by="Call tribodyn.ensemble(machine, {...}, seed=1) and its plot method.",
)
def machine_ensemble(study: MachineEnsemble) -> Sketch:
    """Draw the levels of all parts with the interval of the variants.

    Levels of the parts at the median of all inputs; the bars over them hold 95 % of the variants.
    """
    columns, rows, widest = study.figures(), [], (0.0, "No level varies")
    for number, (quantity, label, names, parts) in enumerate(_by_kind(columns)):
        middle = np.array([columns[name][0] for name in names])
        low, high = np.quantile([columns[name][1:] for name in names], (0.025, 0.975), axis=1)
        values = [displayed(quantity, each) for each in (middle, low, high)]
        color, name = COLORS[number % len(COLORS)], "median of all inputs"
        marks = marked(parts, values[0], name, color, 9)
        bars = {"array": values[2] - values[0], "arrayminus": values[0] - values[1]}
        marks["error_y"] = {"type": "data", "symmetric": False, "width": 8, **bars}
        rows.append(Row("", Panel(axis_label(quantity, label), [marks], FROM_ZERO)))
        for name, centre, a, b in zip(names, middle, low, high, strict=True):
            text = f"{in_words(name)}: 95 % of the variants from {rounded(quantity, a)}"
            text = f"{text} to {rounded(quantity, b)}"
            widest = max(widest, (float((b - a) / centre) if centre else 0.0, text))
    return stack_rows(widest[1], rows, {"hovermode": "closest"})
