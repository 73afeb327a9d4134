"""The response as curves: over two mesh cycles for a steady state, over time for a transient."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.look.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.look.panels import Panel, event_lines, stack
from tribodyn.plot.look.style import PAIR_COLORS, PINION, TOTAL, WHEEL, Trace, button_row, line
from tribodyn.plot.mesh.cycle import CYCLES, cycles, mesh_events
from tribodyn.study.pipeline import series
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import Result, ResultComparison

#: Samples that each part of a transient curve keeps; more would not be seen but fill the file.
_KEPT = 2000
#: Relative change of the vibration from one quarter of a run to the next that is called settled.
_SETTLED = 0.01
#: Difference of two neighbouring samples, relative to the range, that is drawn as a jump.
_JUMP = 1e-6


def no_translation(result: Result) -> str:
    """Tell why a result has no motion of the gear centres."""
    if series.centre_column(result.response.names, "pinion", "y") is not None:
        return ""
    return (
        "The model turns the gears only: their centres stay in place and no bearing is loaded. "
        'Choose dynamics.model = "spur-6dof" to let them move.'
    )


def _ends(values: Array) -> NDArray[np.intp]:
    """Of three samples a step, its left end, and its right end where a jump or the end follows."""
    left = np.arange(0, len(values), 3)
    right = left + 2
    apart = np.abs(values[right[:-1]] - values[left[1:]]) > _JUMP * np.ptp(values)
    return np.sort(np.concatenate((left, right[:-1][apart], right[-1:])))


def _extremes(values: Array) -> NDArray[np.intp]:
    """Indices of the least and greatest value of every group, so that thinning keeps peaks."""
    count = len(values)
    if count <= _KEPT:
        return np.arange(count)
    width = -(-2 * count // _KEPT)
    folded = np.append(values, np.full(-count % width, values[-1])).reshape(-1, width)
    picked = np.stack((folded.argmin(axis=1), folded.argmax(axis=1)), axis=1)
    starts = np.arange(len(folded))[:, None] * width
    return np.unique(np.minimum(picked + starts, count - 1))


class Motion:
    """The signals of a run and the horizontal axis on which they are drawn.

    Signals stand on the fine samples of the response: three a step, jumps on both sides.
    """

    def __init__(self, result: Result) -> None:
        self._result = result
        self._response = result.response
        self._mesh = result.mesh
        #: A steady state; the error of a transient has no meaning.
        self.periodic = series.is_steady(result.response)
        words = "Mesh cycles"
        self.label = axis_label("mesh_phase", words) if self.periodic else axis_label("time")
        #: Mesh cycles drawn of a steady state.
        self.shown = max(CYCLES, self._response.periods)
        self._measured = len(series.measured(self._response).phase)
        periods = self._response.periods
        counted = round(periods * self._measured / len(self._response.fine.phase))
        self.window = "" if self.periodic else f" in the last {counted} of {periods} mesh cycles"

    @property
    def mesh_force(self) -> Array:
        """Dynamic force along the line of action, all ramps of a force law together."""
        return series.mesh_force(self._response.fine)

    @property
    def transmission_error(self) -> Array:
        """Dynamic transmission error, counted from where perfect rigid driving flanks touch."""
        return series.transmission_error(self._result, self._response.fine)

    def of_gear(self, quantity: str, gear: str, axis: str) -> Array:
        """Acceleration of a gear's centre, or ``"bearing_force"``, its force on its support."""
        column = series.centre_column(self._response.names, gear, axis)
        if quantity == "acceleration":
            return np.asarray(self._response.fine.acceleration[:, column])
        assert column is not None  # Asked of gears whose centres move.
        return series.support_force(self._result.system, self._response.fine, column)

    def measured(self, values: Array) -> Array:
        """Keep the part of a signal over which the figures of a summary are taken."""
        return values[-self._measured :]

    def _last(self) -> int:
        """Samples before the last mesh cycles, those that the zoom of a transient shows."""
        count, periods = len(self._response.fine.phase), int(self._response.periods)
        return count - count // periods * min(CYCLES, periods)

    def settling(self, values: Array) -> str:
        """Say whether a transient has become steady, judged by its last two quarters."""
        if self.periodic:
            return ""
        periods, weight = self._response.periods, self._response.fine.weight
        quarter = len(values) // periods * (periods // 4)
        if not quarter:
            return "The run is too short to tell whether the motion has settled."

        def rms(part: slice) -> float:
            mean = np.average(values[part], weights=weight[part])
            return float(np.sqrt(np.average((values[part] - mean) ** 2, weights=weight[part])))

        before, after = rms(slice(-2 * quarter, -quarter)), rms(slice(-quarter, None))
        larger = max(before, after)
        change = abs(after - before) / larger if larger else 0.0
        percent = "less than 0.01" if change < 1e-4 else significant(100.0 * change, 2)
        verdict = "has settled" if change < _SETTLED else "has not settled"
        return (
            f"The motion {verdict}: from the third to the last quarter of the run the rms of its "
            f"alternating part changes by {percent} %."
        )

    def curve(self, name: str, values: Array) -> tuple[Array, Array]:
        """Place a signal on the axis."""
        shown, fine = displayed(name, values), self._response.fine
        if not self.periodic:
            last = self._last()
            early, late = _extremes(shown[:last]), last + _extremes(shown[last:])
            kept = np.concatenate((early, late))
            return displayed("time", fine.time)[kept], shown[kept]
        kept = _ends(shown)
        if self._response.periods > 1:
            return fine.phase[kept], shown[kept]
        return cycles(fine.phase[kept], shown[kept])

    def line(self, name: str, values: Array, words: str, color: str, **look: Any) -> Trace:
        """Draw a signal over the axis."""
        return line(*self.curve(name, values), words, color, unit=display_unit(name), **look)

    def figure(self, title: str, panels: list[Panel]) -> Sketch:
        """Stack panels over the axis; the title tells of what is measured."""
        return stack(f"{title}{self.window}", self.label, panels, self.layout())

    def layout(self) -> dict[str, Any]:
        """Marks of the events and range of the horizontal axis."""
        if self.periodic:
            events = event_lines(mesh_events(self._mesh, self.shown))
            return {**events, "xaxis": {"range": [0, self.shown]}}
        time = displayed("time", self._response.fine.time)
        views = [("whole run", float(time[0]))]
        if self._last():
            views.append((f"last {CYCLES} mesh cycles", float(time[self._last()])))
        end = float(time[-1])
        buttons = [(words, {"xaxis.range": [start, end]}) for words, start in views]
        return {"updatemenus": [button_row(buttons)], "xaxis": {"range": [views[0][1], end]}}


_COLORS = (TOTAL, PINION, WHEEL, *PAIR_COLORS)
_DASHES = ("solid", "dash", "dot")


def _unlike(found: ResultComparison) -> str:
    """Say why the motions share no axis."""
    if len({Motion(each).label for each in found.results}) == 1:
        return ""
    return "Steady motions and motions over time share no axis: compare those of one kind"


@drawing(
    "result_comparison",
    heading="Results beside each other",
    caption="Transmission error and mesh force of each result; what differs in their cases stands "
    "in the table of the comparison.",
    missing=_unlike,
    of="ResultComparison",
    made_by="tribodyn.compare_results",
)
def result_comparison(found: ResultComparison) -> Any:
    """Draw transmission error and mesh force of all results over each other."""
    motions = [Motion(each) for each in found.results]
    panels: list[Panel] = []
    names = {"dynamic_transmission_error": "transmission_error", "mesh_force": "mesh_force"}
    for quantity, name in names.items():
        traces = [
            motion.line(
                quantity,
                getattr(motion, name),
                title,
                _COLORS[i % len(_COLORS)],
                width=1.8,
                dash=_DASHES[i // len(_COLORS)],
            )
            for i, (motion, title) in enumerate(zip(motions, found.names, strict=True))
        ]
        shown = [{**trace, "showlegend": not panels} for trace in traces]
        panels.append(Panel(axis_label(quantity), shown))
    changed = ", ".join(found.values) or "nothing"
    layout = motions[0].layout()
    if any(each.case.gears != found.results[0].case.gears for each in found.results):
        # Pairs of other gears enter and leave elsewhere.
        layout = {k: v for k, v in layout.items() if k not in ("shapes", "annotations")}
    return stack(f"What changes: {changed}", motions[0].label, panels, layout)
