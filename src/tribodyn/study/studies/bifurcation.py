"""The motion of a case over one of its values: jumps, doubled periods, chaos; and what it says."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.checkpoints import Members
from tribodyn.errors import InputError, collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.derive import placed
from tribodyn.study.case.provenance import spec_of
from tribodyn.study.first_use import compiled_beside
from tribodyn.study.studies.axes import Axis, ends_of
from tribodyn.study.studies.grid import contact_without_speed, identity, varied
from tribodyn.study.studies.structure import study_steps
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.nonlinear.bifurcation import Bifurcation
    from tribodyn.study.case.case import Case


#: Steps of all values are those of the slowest where these are no more than this times as many;
#: values of one structure are then marched side by side.
_ALIKE = 2


def bifurcation(
    case: Case,
    over: str = "operation.speed",
    between: tuple[Any, Any] | None = None,
    points: int = 300,
    *,
    steps: int | None = None,
    by: str = "",
    progress: Progress = SILENT,
    members: Members | None = None,
    **options: Any,
) -> Bifurcation:
    """Follow the motion of a case over one of its values.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    over : str
        Dotted key of the value that varies.
    between : tuple
        Its two ends: floats in SI, or text with a unit.
    points : int
        Values, evenly spaced, the ends included.
    steps : int, optional
        Steps per mesh cycle; those of the case, else a quarter of what a single run takes and at
        least 512. Every motion is judged by a repetition with half the step.
    by : str
        What asks, for messages; then a bare number for a dimension is refused as in a file.
    progress : Progress
        Told how far the study has come; silent by default.
    members : tribodyn.checkpoints.Members, optional
        Keeps what is finished as it comes, and has what a killed process finished.
    **options : object
        ``sweep``, ``cycles``, ``transient``, ``keep``, ``signal``, ``verdict``, ``exponents`` and
        ``keep_partial`` of :func:`tribodyn.analysis.bifurcation`.

    Returns
    -------
    Bifurcation
        Its parameter is in the unit of the key, SI.

    Raises
    ------
    InputError
        If the key is unknown or not a number, or a value is out of range.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> found = bifurcation(case, between=("1800 rpm", "2000 rpm"), points=2, transient=20)
    >>> found.parameter_name, found.parameter.round(1).tolist()
    ('operation.speed', [188.5, 209.4])
    """
    from tribodyn.analysis import bifurcation as compute

    values = _values(case, over, between, points, by)
    told = identity("bifurcation", case, [over, values.tolist()], steps=steps, **options)
    members = (Members() if members is None else members).begin(told)
    with compiled_beside(case, "bifurcation"):
        systems, frequency, counts = _systems(case, over, values, steps, progress, members)
        return compute(
            systems,
            frequency,
            parameter=values,
            parameter_name=over,
            parameter_unit=_unit(case, over),
            steps=counts,
            progress=progress,
            members=members,
            **options,
        )


def _systems(
    case: Case, over: str, values: Any, steps: int | None, progress: Progress, kept: Members
) -> tuple[list[System], list[float], list[int]]:
    """Structure, mesh frequency and steps of every value; one structure where none differs."""
    same = over == "operation.speed" and contact_without_speed(case)
    changes = [{over: float(value)} for value in values]
    with placed(case), collected():
        members = varied(case, changes[:1] if same else changes, progress, kept)
        systems = [member.system for member in members]
        frequency = [member.mesh.mesh_frequency for member in members]
        cases = [member.case for member in members]
        if same:
            systems *= len(values)
            frequency = [frequency[0] * float(value) / float(values[0]) for value in values]
            cases = [case.replace(change) for change in changes]
        counts = [
            steps or study_steps(*member) for member in zip(cases, systems, frequency, strict=True)
        ]
    if same and max(counts) <= _ALIKE * min(counts):
        counts = [max(counts)] * len(counts)
    return systems, frequency, counts


def _values(case: Case, over: str, between: tuple[Any, Any] | None, points: int, by: str) -> Any:
    """Values of the key in SI; the two ends are checked like the key of the case."""
    if between is None or len(between) != 2 or int(points) != points or points < 2:
        why = "A diagram goes from one value to another in at least two points"
        remedy = 'Write, for example, between=("400 rpm", "3500 rpm")'
        raise InputError(f"between = {between}, points = {points}", "argument between", why, remedy)
    first, last = ends_of(case, over, between, by=by)
    return np.linspace(first, last, int(points))


def _unit(case: Case, over: str) -> str:
    spec = spec_of(case, over)
    return str(spec.unit) if spec is not None and spec.unit else "-"


#: A jump changes the rms by more than this part of it, and by more than this times as much as
#: the changes before and after it.
_JUMP, _BESIDE = 0.1, 3.0
#: Two motions at one value differ by more than this part in rms.
_APART = 0.05


class Findings:
    """What a diagram says."""

    def __init__(self, case: Case, found: Bifurcation) -> None:
        spec = spec_of(case, found.parameter_name)
        units = (spec.unit, spec.display_unit) if spec else ("", "")
        values = tuple(float(value) for value in found.parameter)
        self.found, self.axis = found, Axis(found.parameter_name, values, *units)

    def lead(self) -> str:
        """Tell what varies."""
        ends = f"from {self._at(0)} to {self._at(-1)}"
        return f"{len(self.axis.values)} values of {self.axis.key} {ends}"

    def sentences(self) -> list[str]:
        """Tell verdicts, run-aways, step limit, periods, jumps, and where two motions exist."""
        return [
            *self._counts(),
            *self._lost(),
            *self._limit(),
            *self._periods(),
            *self._jumps(),
            *self._two(),
        ]

    def figures(self) -> dict[str, Any]:
        """Return the same for a program, in SI."""
        onset = self._onset()
        return {
            "parameter": self.found.parameter_name,
            "unit": self.found.parameter_unit,
            "values": int(self.found.parameter.size),
            "finished": int(self.found.finished.sum()),
            "verdicts": self.found.verdicts(),
            "ran_away": int(self.found.ran_away.sum()),
            "step_limited_onset": None if onset is None else float(self.found.parameter[onset]),
            "omega_max_dt_at_onset": None
            if onset is None
            else float(self.found.step_number[onset]),
            "periods": [
                {"branch": b, "period": p, "from": float(v[0]), "to": float(v[-1])}
                for b, p, v in self._runs()
            ],
            "jumps": [
                {"branch": b, "between": [float(self.found.parameter[i]) for i in (n, n + 1)]}
                for b, n in self._leaps()
            ],
        }

    def rows(self) -> tuple[list[str], list[list[str]]]:
        """Return the diagram as a table."""
        found = self.found
        unit = f" [{self.axis.display_unit}]" if self.axis.display_unit else ""
        turns = "theta" in self.found.signal
        head = [
            f"{self.axis.name.replace('_', ' ')}{unit}",
            "branch",
            "period",
            "rms [rad]" if turns else "rms [um]",
            "off the flank",
            "omega_max dt",
            "verdict",
        ]
        cells = []
        for number, value in enumerate(self.axis.shown()):
            for branch, name in enumerate(found.branches):
                if found.finished[branch, number]:
                    period, rms = found.period[branch, number], found.rms[branch, number]
                    loss = found.contact_loss_share[branch, number]
                    lost = found.ran_away[branch, number]
                    size = f"{rms if turns else 1e6 * rms:.5g}"
                    cells.append(
                        [
                            f"{value:.6g}",
                            name,
                            str(period) if period else "none",
                            "ran away" if lost else size,
                            "" if lost else f"{loss:.3g}",
                            f"{found.step_number[number]:.3g}",
                            str(found.verdict[branch, number]),
                        ]
                    )
        return head, cells

    def _at(self, number: int) -> str:
        return self.axis.show(self.axis.values[number])

    def _counts(self) -> Iterator[str]:
        words = ", ".join(f"{count} {word}" for word, count in self.found.verdicts().items())
        done = int(self.found.finished.sum())
        unjudged = done - sum(self.found.verdicts().values())
        if unjudged:
            words = ", ".join(part for part in (words, f"{unjudged} not judged") if part)
        yield f"{done} motions: {words}"

    def _lost(self) -> Iterator[str]:
        for branch, name in enumerate(self.found.branches):
            places = np.flatnonzero(self.found.ran_away[branch])
            if places.size:
                lost = self.found.parameter[places]
                many = f"{places.size} motions" if places.size > 1 else "1 motion"
                yield f"{name}: {many} grew beyond all bounds {self._span(lost[0], lost[-1])}"

    def _onset(self) -> int | None:
        limited = np.any(self.found.verdict == "step-limited", axis=0)
        return int(np.argmax(limited)) if limited.any() else None

    def _limit(self) -> Iterator[str]:
        onset = self._onset()
        if onset is None:
            return
        found = self.found
        refined = found.refined_period[:, onset].max()
        yield (
            f"step-limited from {self._at(onset)} on: omega_max dt = "
            f"{found.step_number[onset]:.3g} with {found.steps[onset]} steps per mesh cycle; with "
            f"{found.refined_steps[onset]} steps the motion "
            + (f"has period {refined}" if refined else "does not repeat")
        )
        for branch, name in enumerate(found.branches):
            wild = (found.verdict[branch] == "step-limited") & (found.period[branch] != 1)
            wild &= found.refined_period[branch] == 1
            if wild.any():
                first = int(np.argmax(wild))
                yield (
                    f"{name}: the step turns period 1 into another motion from {self._at(first)} "
                    f"on, omega_max dt = {found.step_number[first]:.3g}"
                )

    def _runs(self) -> Iterator[tuple[str, int, Array]]:
        """Stretches of the same period, step-limited motions and runaways left out."""
        found = self.found
        for branch, name in enumerate(found.branches):
            kept = found.finished[branch] & (found.verdict[branch] != "step-limited")
            kept &= ~found.ran_away[branch]
            places = np.flatnonzero(kept)
            for period, group in groupby(places, key=lambda i, b=branch: int(found.period[b, i])):  # type: ignore[misc]
                yield name, period, found.parameter[list(group)]

    def _periods(self) -> Iterator[str]:
        for name, period, values in self._runs():
            words = f"period {period}" if period else "no period within 16 mesh cycles"
            yield f"{name}: {words} {self._span(values[0], values[-1])}"

    def _span(self, first: float, last: float) -> str:
        ends = [self.axis.show(value) for value in (first, last)]
        return f"at {ends[0]}" if first == last else f"from {ends[0]} to {ends[1]}"

    def _leaps(self) -> Iterator[tuple[str, int]]:
        found = self.found
        for branch, name in enumerate(found.branches):
            rms = np.where(found.verdict[branch] == "step-limited", np.nan, found.rms[branch])
            change = np.abs(np.diff(rms))
            beside = np.maximum(change[:-2], change[2:])
            larger = np.maximum(rms[1:], rms[:-1])[1:-1]
            steep = change[1:-1] > np.maximum(_JUMP * larger, _BESIDE * beside)
            # Without loss of contact only another period jumps; else it is a peak between points.
            loss, period = found.contact_loss_share[branch], found.period[branch]
            free = (loss[1:] > 0.0) | (loss[:-1] > 0.0) | (period[1:] != period[:-1])
            for place in np.flatnonzero(steep & free[1:-1]):
                yield name, int(place) + 1

    def _jumps(self) -> Iterator[str]:
        for name, place in self._leaps():
            before, after = self.found.rms[self.found.branches.index(name), place : place + 2]
            yield (
                f"{name}: the rms jumps between {self._at(place)} and {self._at(place + 1)}, "
                f"from {self._size(before)} to {self._size(after)}"
            )

    def _size(self, rms: float) -> str:
        """Write a size of the signal, which turns or moves."""
        return f"{rms:.3g} rad" if "theta" in self.found.signal else f"{1e6 * rms:.3g} um"

    def _two(self) -> Iterator[str]:
        if len(self.found.branches) < 2:
            return
        up, down = self.found.rms[:2]
        both = np.flatnonzero(np.abs(up - down) > _APART * np.fmax(up, down))
        for _, group in groupby(enumerate(both), key=lambda pair: pair[1] - pair[0]):
            at = [place for _, place in group]
            span = self._span(self.found.parameter[at[0]], self.found.parameter[at[-1]])
            ends = at[0] == 0 or at[-1] == self.found.parameter.size - 1
            beyond = "; the range ends there, and they may go on beyond it" if ends else ""
            yield f"two motions are possible {span}: up and down differ{beyond}"
