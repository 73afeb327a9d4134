"""Signals of a run over two mesh cycles (steady state) or over time (transient)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from tribodyn.drawing import Sketch, drawing
from tribodyn.nomenclature import GEARS
from tribodyn.plot.mesh.cycle import CYCLES, cycles, mesh_events
from tribodyn.plot.theme.colors import PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.theme.panels import Panel, event_lines, extremes, stack
from tribodyn.plot.theme.style import Trace, button_row, line
from tribodyn.study.pipeline import response_series
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import Result, ResultComparison

#: Most samples in each part of a transient curve; more would only enlarge the file.
_MAX_SAMPLES = 2000
#: A run has settled if its rms changes by less than this fraction from quarter to quarter.
_SETTLED = 0.01
#: Difference of two neighbouring samples, relative to the range, that is drawn as a jump.
_JUMP = 1e-6


def no_translation(result: Result) -> str:
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

    def __init__(self, result: Result) -> None:
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


_COLORS = (TOTAL, PINION, WHEEL, *PAIR_COLORS)
_DASHES = ("solid", "dash", "dot")


def _motions(comparison: ResultComparison) -> list[Motion]:
    pairs = [each for each in comparison.results if each._COMPARISON == "result_comparison"]
    return [Motion(cast("Result", each)) for each in pairs]


def _axis_mismatch(comparison: ResultComparison) -> str:
    """Reason why the responses cannot share an axis; empty if they can."""
    if not _motions(comparison):
        return "It compares machines; draw it by machine_comparison."
    if len({motion.label for motion in _motions(comparison)}) == 1:
        return ""
    return "Steady states and transients have different axes: compare results of the same kind"


@drawing(
    heading="Comparison of results",
    caption="Transmission error and mesh force of each result; the table of the comparison lists "
    "the differences of their cases.",
    missing=_axis_mismatch,
    of="ResultComparison",
    made_by="tribodyn.compare_results",
)
def result_comparison(comparison: ResultComparison) -> Sketch:
    """Draw transmission error and mesh force of all results in the same axes."""
    motions = _motions(comparison)
    panels: list[Panel] = []
    names = {"dynamic_transmission_error": "transmission_error", "mesh_force": "mesh_force"}
    for quantity, name in names.items():
        traces = [
            motion.line(quantity, getattr(motion, name), title, _COLORS[i % len(_COLORS)],
                        width=1.8, dash=_DASHES[i // len(_COLORS)], showlegend=not panels)
            for i, (motion, title) in enumerate(zip(motions, comparison.names, strict=True))
        ]  # fmt: skip
        panels.append(Panel(axis_label(quantity), traces))
    changed = ", ".join(comparison.values) or "nothing"
    layout = motions[0].layout()
    if any(each.case.gears != comparison.results[0].case.gears for each in comparison.results):
        # The marks depend on the gears.
        layout = {k: v for k, v in layout.items() if k not in ("shapes", "annotations")}
    return stack(f"Changed: {changed}", motions[0].label, panels, layout)
