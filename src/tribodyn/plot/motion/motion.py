"""Signals of a run or of a structure, and differences of results and of printed values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from tribodyn.drawing import Sketch, drawing
from tribodyn.nomenclature import GEARS
from tribodyn.plot.mesh.cycle import CYCLES, cycles, mesh_events
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import (
    axis_label,
    display_unit,
    displayed,
    readable,
    scaled,
    significant,
    unit_of,
)
from tribodyn.plot.theme.panels import Panel, event_lines, extremes, stack
from tribodyn.plot.theme.style import Trace, button_row, dots, line
from tribodyn.study.pipeline import response_series
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.cases import PaperComparison
    from tribodyn.dynamics import AdaptiveSolution, Response
    from tribodyn.study import PairResult, ResultComparison

#: Most samples in each part of a transient curve; more would only enlarge the file.
_MAX_SAMPLES = 2000
#: A run has settled if its rms changes by less than this fraction from quarter to quarter.
_SETTLED = 0.01
#: Difference of two neighbouring samples, relative to the range, that is drawn as a jump.
_JUMP = 1e-6


def no_translation(result: PairResult) -> str:
    """Reason why a result has no motion of the gear centres; empty if it has."""
    if response_series.centre_column(result.response.names, GEARS[0], "y") is not None:
        return ""
    return (
        "The gears of this model only rotate: their centres are fixed and no bearing is loaded. "
        'Choose dynamics.model = "spur-6dof" to let them move.'
    )


def _ends(values: Array) -> NDArray[np.intp]:
    """Indices of the left end of every step, and of its right end before a jump and at the end."""
    left = np.arange(0, len(values), 3)
    right = left + 2
    jumps = np.abs(values[right[:-1]] - values[left[1:]]) > _JUMP * np.ptp(values)
    return np.sort(np.concatenate((left, right[:-1][jumps], right[-1:])))


class Motion:
    """The signals of a run and the horizontal axis on which they are drawn.

    Signals use the fine samples of the response: three per step, with both sides of a jump.
    """

    def __init__(self, result: PairResult) -> None:
        self._result = result
        self._response = result.response
        self._mesh = result.mesh
        #: Whether the response is a steady state.
        self.periodic = response_series.is_steady(result.response)
        label = "Mesh cycles"
        self.label = axis_label("mesh_phase", label) if self.periodic else axis_label("time")
        #: Number of mesh cycles in the plot of a steady state.
        self.shown = max(CYCLES, self._response.periods)
        self._measured = len(response_series.measured(self._response).phase)
        periods = self._response.periods
        last = round(periods * self._measured / len(self._response.fine.phase))
        self.window = "" if self.periodic else f" in the last {last} of {periods} mesh cycles"

    @property
    def mesh_force(self) -> Array:
        """Dynamic force along the line of action, summed over the ramps of the force law."""
        return response_series.mesh_force(self._response.fine)

    @property
    def transmission_error(self) -> Array:
        """Dynamic transmission error, zero where perfect rigid driving flanks touch."""
        return response_series.transmission_error(self._result, self._response.fine)

    def of_gear(self, quantity: str, gear: str, axis: str) -> Array:
        """Acceleration of a gear centre, or its force on the support (``"bearing_force"``)."""
        column = response_series.centre_column(self._response.names, gear, axis)
        if quantity == "acceleration":
            return np.asarray(self._response.fine.acceleration[:, column])
        assert column is not None  # callers check that the gear centres move
        return response_series.support_force(self._result.system, self._response.fine, column)

    def measured(self, values: Array) -> Array:
        """Return the part of a signal over which summary figures are evaluated."""
        return values[-self._measured :]

    def _last(self) -> int:
        """Index of the first sample of the last mesh cycles, the zoom of a transient."""
        count, periods = len(self._response.fine.phase), int(self._response.periods)
        return count - count // periods * min(CYCLES, periods)

    def settling(self, values: Array) -> str:
        """Report whether a transient has settled, judged by the rms of its last two quarters."""
        if self.periodic:
            return ""
        periods, weight = self._response.periods, self._response.fine.weight
        quarter = len(values) // periods * (periods // 4)
        if not quarter:
            return "The run is too short to judge whether the response has settled."

        def rms(part: slice) -> float:
            mean = np.average(values[part], weights=weight[part])
            return float(np.sqrt(np.average((values[part] - mean) ** 2, weights=weight[part])))

        before, after = rms(slice(-2 * quarter, -quarter)), rms(slice(-quarter, None))
        larger = max(before, after)
        change = abs(after - before) / larger if larger else 0.0
        percent = "less than 0.01" if change < 1e-4 else significant(100.0 * change, 2)
        verdict = "has settled" if change < _SETTLED else "has not settled"
        return (
            f"The response {verdict}: from the third to the last quarter of the run the rms of its "
            f"alternating part changes by {percent} %."
        )

    def curve(self, name: str, values: Array) -> tuple[Array, Array]:
        """Return the horizontal and vertical values of a signal in display units."""
        displayed_values, fine = displayed(name, values), self._response.fine
        if not self.periodic:
            last = self._last()
            early = extremes(displayed_values[:last], _MAX_SAMPLES)
            late = last + extremes(displayed_values[last:], _MAX_SAMPLES)
            samples = np.concatenate((early, late))
            return displayed("time", fine.time)[samples], displayed_values[samples]
        samples = _ends(displayed_values)
        if self._response.periods > 1:
            return fine.phase[samples], displayed_values[samples]
        return cycles(fine.phase[samples], displayed_values[samples])

    def line(self, name: str, values: Array, label: str, color: str, **style: Any) -> Trace:
        """Describe the curve of a signal."""
        return line(*self.curve(name, values), label, color, unit=display_unit(name), **style)

    def figure(self, title: str, panels: list[Panel]) -> Sketch:
        """Stack panels over the axis; the title names the evaluated mesh cycles."""
        return stack(f"{title}{self.window}", self.label, panels, self.layout())

    def layout(self) -> Trace:
        """Event marks, range of the horizontal axis and zoom buttons."""
        if self.periodic:
            events = event_lines(mesh_events(self._mesh, self.shown))
            return {**events, "xaxis": {"range": [0, self.shown]}}
        time = displayed("time", self._response.fine.time)
        views = [("entire run", float(time[0]))]
        if self._last():
            views.append((f"last {CYCLES} mesh cycles", float(time[self._last()])))
        end = float(time[-1])
        buttons = [(label, {"xaxis.range": [start, end]}) for label, start in views]
        return {"updatemenus": [button_row(buttons)], "xaxis": {"range": [views[0][1], end]}}


_PART_COLORS = (TOTAL, PINION, WHEEL, *PAIR_COLORS)
_DASHES = ("solid", "dash", "dot")


def _motions(comparison: ResultComparison) -> list[Motion]:
    pairs = [each for each in comparison.results if each._COMPARISON == "result_comparison"]
    return [Motion(cast("PairResult", each)) for each in pairs]


def _axis_mismatch(comparison: ResultComparison) -> str:
    """Reason why the responses cannot share an axis; empty if they can."""
    if not _motions(comparison):
        return "It compares machines; draw it by machine_comparison."
    if len({motion.label for motion in _motions(comparison)}) == 1:
        return ""
    return "Steady states and transients have different axes: compare results of the same kind"


@drawing(
    heading="Comparison of results",
    missing=_axis_mismatch,
    of="ResultComparison",
    made_by="tribodyn.compare_results",
)
def result_comparison(comparison: ResultComparison) -> Sketch:
    """Draw transmission error and mesh force of all results in the same axes.

    Transmission error and mesh force of each result; the table of the comparison lists the
    differences of their cases.
    """
    motions = _motions(comparison)
    panels: list[Panel] = []
    names = {"dynamic_transmission_error": "transmission_error", "mesh_force": "mesh_force"}
    for quantity, name in names.items():
        traces = [
            motion.line(quantity, getattr(motion, name), title, _PART_COLORS[i % len(_PART_COLORS)],
                        width=1.8, dash=_DASHES[i // len(_PART_COLORS)], showlegend=not panels)
            for i, (motion, title) in enumerate(zip(motions, comparison.names, strict=True))
        ]  # fmt: skip
        panels.append(Panel(axis_label(quantity), traces))
    changed = ", ".join(comparison.values) or "nothing"
    layout = motions[0].layout()
    if any(each.case.gears != comparison.results[0].case.gears for each in comparison.results):
        # The marks depend on the gears.
        layout = {k: v for k, v in layout.items() if k not in ("shapes", "annotations")}
    return stack(f"Changed: {changed}", motions[0].label, panels, layout)


_COLORS = (PINION, WHEEL, *PAIR_COLORS, TOTAL, MUTED)
#: Most curves of a panel, and most points of a curve.
_CURVES, _POINTS = 8, 4000


def _panel(quantity: str, unit: str, time: Array, columns: dict[str, Array]) -> list[Panel]:
    """Panel with the columns of one quantity over the time; empty without columns."""
    chosen = dict(list(columns.items())[:_CURVES])
    if not chosen:
        return []
    factor, display_unit = scaled(np.stack(list(chosen.values())), unit)
    curves: list[Trace] = []
    for color, (name, values) in zip(_COLORS, chosen.items(), strict=False):
        at, style = extremes(values, _POINTS), Trace(unit=readable(display_unit), width=1.4)
        label = name.replace("_", " ")
        curves.append(line(time[at], factor * values[at], label, color, **style))
    left_out = len(columns) - len(chosen)
    more = f"<br>(and {left_out} more)" if left_out else ""
    return [Panel(f"{quantity} [{readable(display_unit)}]{more}", curves)]


def _coordinates(names: tuple[str, ...], values: Array, kind: str) -> dict[str, Array]:
    """Columns of translations, or of rotations."""
    return {n: values[:, k] for k, n in enumerate(names) if unit_of(n) == kind}


def _milliseconds(time: Array) -> tuple[Array, str]:
    return (1e3 * time, "Time [ms]") if time[-1] < 1.0 else (time, "Time [s]")


@drawing(
    heading="Response of the structure",
    of="Response",
    made_by="Call tribodyn.dynamics.simulate or steady_state and its plot method.",
)
def response(motion: Response) -> Sketch:
    """Draw contact forces, compressions and accelerations over the time.

    Force and compression of every contact, and the accelerations of the coordinates. The force is
    zero where the contact is lost: there the compression lies within the backlash.
    """
    time, label = _milliseconds(motion.time)
    force = motion.contact_force
    contacts = [f"contact {number + 1}" for number in range(force.shape[1])]

    def by_contact(values: Array) -> dict[str, Array]:
        return {name: values[:, k] for k, name in enumerate(contacts)}

    names = tuple(motion.names)
    panels = [
        *_panel("Contact force", "N", time, by_contact(force)),
        *_panel("Compression", "m", time, by_contact(motion.deflection)),
        *_panel("Acceleration", "m/s^2", time, _coordinates(names, motion.acceleration, "m")),
        *_panel("Angular acceleration", "rad/s^2", time,
                _coordinates(names, motion.acceleration, "rad")),
    ]  # fmt: skip
    kind = "Steady motion" if motion.floquet_multipliers.size else "Transient"
    cycles = "1 mesh cycle" if motion.periods == 1 else f"{motion.periods} mesh cycles"
    title = f"{kind} over {cycles} at {significant(motion.mesh_frequency)} Hz"
    if force.size:
        ends = (significant(force.min()), significant(force.max()))
        title += f": contact force {ends[0]} to {ends[1]} N"
    return stack(title, label, panels)


@drawing(
    heading="Adaptive time integration",
    of="AdaptiveSolution",
    made_by="Call tribodyn.dynamics.solve_adaptive and its plot method.",
)
def adaptive_solution(solution: AdaptiveSolution) -> Sketch:
    """Draw positions and step lengths over the time.

    Positions at the ends of the accepted steps, and the length of every step: steps are short where
    a contact changes its side and at mesh events.
    """
    time, label = _milliseconds(solution.time)
    names = tuple(solution.names)
    steps = np.diff(solution.time, prepend=solution.time[0])
    steps[0] = steps[1] if steps.size > 1 else 0.0
    panels = [
        *_panel("Position", "m", time, _coordinates(names, solution.position, "m")),
        *_panel("Rotation", "rad", time, _coordinates(names, solution.position, "rad")),
        *_panel("Step", "s", time, {"step": steps}),
    ]
    title = (
        f"{solution.steps} steps at a relative tolerance of {solution.rtol:.1g}, "
        f"{solution.rejections} repeated, {solution.crossings} changes of side"
    )
    return stack(title, label, panels)


#: Smallest deviation on the logarithmic axis [%]; smaller ones are plotted there.
_LEAST = 1e-3
_VERDICT_COLORS = {"value": PINION, "trend": MUTED, "cannot-reproduce": WHEEL}


def _no_numbers(comparison: PaperComparison) -> str:
    if any(row["deviation"] is not None for row in comparison.rows):
        return ""
    return "No row of these tables has both a printed and a computed value."


def _symbol(percent: float) -> str:
    if abs(percent) <= _LEAST:
        return "circle"
    return "triangle-up" if percent > 0.0 else "triangle-down"


@drawing(
    heading="Printed and computed values",
    of="PaperComparison",
    made_by="Call tribodyn.cases.compare_with_paper(name) and its plot method.",
    missing=_no_numbers,
)
def paper_comparison(comparison: PaperComparison) -> Sketch:
    """Draw the deviation of every printed number on a logarithmic scale.

    Absolute deviation from every printed value, in the order of the tables; triangles point up
    where the computed value is larger. Rows that print a word or a range have no mark. The table of
    the report lists the numbers and the reasons.
    """
    rows = [row for row in comparison.rows if row["deviation"] is not None]
    traces: list[Trace] = []
    for verdict, color in _VERDICT_COLORS.items():
        chosen = [(number, row) for number, row in enumerate(rows, 1) if row["verdict"] == verdict]
        if not chosen:
            continue
        percent = np.array([100.0 * row["deviation"] for _, row in chosen])
        names = [
            f"{row['table']}, {row['row']}: printed {row['printed']:.5g}, computed "
            f"{row['computed']:.5g}, {each:+.3g} %"
            for (_, row), each in zip(chosen, percent, strict=True)
        ]
        x, y = np.array([number for number, _ in chosen]), np.maximum(np.abs(percent), _LEAST)
        marker = {"color": color, "size": 8, "symbol": [_symbol(each) for each in percent]}
        facts: Trace = {"customdata": names, "hovertemplate": "%{customdata}<extra></extra>"}
        traces.append(dots(x, y, verdict, marker, showlegend=True, **facts))
    inside = sum(abs(row["deviation"]) <= 0.01 for row in rows)
    return stack(
        f"{inside} of {len(rows)} printed values agree within 1 %",
        "Printed value, in the order of the tables",
        [Panel("Deviation [%]", traces, {"type": "log", "dtick": 1}, 1.6)],
        {"hovermode": "closest"},
    )
