"""Bifurcation diagram of a case over one of its values, and its findings in sentences."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.checkpoints import Checkpoints
from tribodyn.errors import InputError, collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine.case import AnyCase
from tribodyn.study.studies.case_grid import (
    Moving,
    contact_without_speed,
    many_motions,
    moving_members,
    settling_periods,
    study_steps,
    varied,
)
from tribodyn.study.studies.needs import PARTS, kind_of, mesh_in_motion
from tribodyn.study.studies.runner import identity
from tribodyn.study.studies.study_axes import Axis, ends_of
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.nonlinear.bifurcation import Bifurcation


#: All values take the steps of the one that needs most while the counts differ by no more than this
#: factor, so that values of the same structure are integrated in one batch.
_MAX_STEP_RATIO = 2
#: Mesh cycles of statistics and transient of a pair, and least periods of the clock of a machine.
_LENGTHS = {"cycles": (64, 16), "transient": (300, 32)}
#: Most points of the motion that are stored by default.
_MOST_KEPT = 48


@with_old_names
def bifurcation(
    case: AnyCase,
    over: str = "operation.speed",
    between: tuple[Any, Any] | None = None,
    points: int = 300,
    *,
    mesh: str | None = None,
    steps: int | None = None,
    by: str = "",
    progress: Progress = SILENT,
    checkpoints: Checkpoints | None = None,
    **options: Any,
) -> Bifurcation:
    """Compute the bifurcation diagram of a case over one of its values.

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
    mesh : str, optional
        Mesh of a machine or a stage that is followed, where there are several. Its cycles are then
        the periods of the clock, after which all meshes come back.
    steps : int, optional
        Steps per mesh cycle; by default those of the case, else a quarter of those of a single run
        and at least 512. Every motion is judged by a repetition with half the step.
    by : str
        Name of the caller in messages; if set, a bare number for a dimension is refused as in a
        file.
    progress : Progress
        Receives the progress of the study; silent by default.
    checkpoints : tribodyn.checkpoints.Checkpoints, optional
        Stores each finished motion, and restores those that a killed process had finished.
    **options : object
        ``sweep``, ``cycles``, ``transient``, ``keep``, ``signal``, ``verdict``, ``exponents`` and
        ``keep_partial`` of :func:`tribodyn.analysis.bifurcation`. Of a machine cycles are periods
        of its clock, by default as many as have the mesh cycles of a pair, at least 16 and 32; the
        transient lasts until its slowest mode has decayed to 1e-9, 500 periods at most.

    Returns
    -------
    Bifurcation
        Its parameter is in the SI unit of the key.

    Raises
    ------
    InputError
        If the key is unknown or not a number, or a value is out of range.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> diagram = bifurcation(case, between=("1800 rpm", "2000 rpm"), points=2, transient=20)
    >>> diagram.parameter_name, diagram.parameter.round(1).tolist()
    ('operation.speed', [188.5, 209.4])
    """
    from tribodyn.analysis import bifurcation as compute

    name = mesh_in_motion("bifurcation", case, mesh)
    values = _values(case, over, between, points, by)
    named = {} if mesh is None else {"mesh": name}
    study = identity("bifurcation", case, [over, values.tolist()], steps=steps, **named, **options)
    checkpoints = (Checkpoints() if checkpoints is None else checkpoints).begin(study)
    with many_motions(case):
        members = _members(case, name, over, values, progress, checkpoints)
        options = _lengths(case, members, options)
        counts = [steps or each.steps for each in members]
        if members[0].system is members[-1].system and max(counts) <= _MAX_STEP_RATIO * min(counts):
            counts = [max(counts)] * len(counts)
        options.setdefault("signal", members[0].contact)
        diagram: Bifurcation = compute(
            [each.system for each in members],
            [each.frequency for each in members],
            parameter=values,
            parameter_name=over,
            parameter_unit=_unit(case, over),
            steps=counts,
            progress=progress,
            checkpoints=checkpoints,
            **options,
        )
    of_mesh = kind_of(case) in PARTS and options["signal"] == members[0].contact
    return replace(diagram, signal=f"mesh {name}") if of_mesh else diagram


def _lengths(case: AnyCase, members: list[Moving], options: Tree) -> Tree:
    """Options with the lengths of motions of a machine, in periods of its clock."""
    if case.lumped:
        return options
    fastest = max(case.machine().clock.cycles.values())
    lengths = {name: max(-(-count // fastest), least) for name, (count, least) in _LENGTHS.items()}
    if "transient" not in options:
        fast = max(members, key=lambda member: member.frequency)
        lengths["transient"] = max(lengths["transient"], settling_periods(fast))
    chosen = {**lengths, **options}
    return {"keep": min(_MOST_KEPT, chosen["cycles"]), **chosen}


def _members(
    case: AnyCase, mesh: str, over: str, values: Any, progress: Progress, checkpoints: Checkpoints
) -> list[Moving]:
    """Structure of every value; one shared structure if none differs."""
    if not case.lumped:
        return moving_members(case, over, values.tolist(), mesh, progress)
    changes = [{over: float(value)} for value in values]
    same = over == "operation.speed" and contact_without_speed(case)
    with collected():
        members = varied(case, changes[:1] if same else changes, progress, checkpoints)
    systems = [member.system for member in members]
    frequency = [member.mesh.mesh_frequency for member in members]
    cases = [member.case for member in members]
    if same:
        systems *= len(values)
        frequency = [frequency[0] * float(value) / float(values[0]) for value in values]
        cases = [case.replace(change) for change in changes]
    parts = zip(cases, systems, frequency, strict=True)
    return [Moving(system, beat, study_steps(each, system, beat)) for each, system, beat in parts]


def _values(case: AnyCase, over: str, between: tuple[Any, Any] | None, points: int, by: str) -> Any:
    """Return the values of the key in SI; both ends are checked like the key of the case."""
    if between is None or len(between) != 2 or int(points) != points or points < 2:
        why = "A diagram goes from one value to another in at least two points"
        remedy = 'Write, for example, between=("400 rpm", "3500 rpm")'
        raise InputError(f"between = {between}, points = {points}", "argument between", why, remedy)
    first, last = ends_of(case, over, between, by=by)
    return np.linspace(first, last, int(points))


def _unit(case: AnyCase, over: str) -> str:
    spec = case.option_of(over)
    return str(spec.unit) if spec is not None and spec.unit else "-"


#: A jump changes the rms by more than this share of it, and by more than this multiple of the
#: changes before and after it.
_JUMP, _STEEPER = 0.1, 3.0
#: Two motions at one value differ in rms by more than this share.
_DIFFERENT = 0.05


class Findings:
    """Findings of a bifurcation diagram: sentences, figures and a table."""

    def __init__(self, case: AnyCase, diagram: Bifurcation) -> None:
        spec = case.option_of(diagram.parameter_name)
        units = (spec.unit, spec.display_unit) if spec else ("", "")
        values = tuple(float(value) for value in diagram.parameter)
        self.diagram, self.axis = diagram, Axis(diagram.parameter_name, values, *units)

    def lead(self) -> str:
        """Describe the parameter and its range."""
        ends = f"from {self._at(0)} to {self._at(-1)}"
        return f"{len(self.axis.values)} values of {self.axis.key} {ends}"

    def sentences(self) -> list[str]:
        """Report verdicts, run-aways, step limit, periods, jumps and coexisting motions."""
        return [
            *self._counts(),
            *self._lost(),
            *self._limit(),
            *self._periods(),
            *self._jumps(),
            *self._two(),
        ]

    def figures(self) -> Tree:
        """Return the findings as values in SI."""
        onset = self._onset()
        return {
            "parameter": self.diagram.parameter_name,
            "unit": self.diagram.parameter_unit,
            "values": int(self.diagram.parameter.size),
            "finished": int(self.diagram.finished.sum()),
            "verdicts": self.diagram.verdicts(),
            "ran_away": int(self.diagram.ran_away.sum()),
            "step_limited_onset": None if onset is None else float(self.diagram.parameter[onset]),
            "omega_max_dt_at_onset": None
            if onset is None
            else float(self.diagram.step_number[onset]),
            "periods": [
                {"branch": b, "period": p, "from": float(v[0]), "to": float(v[-1])}
                for b, p, v in self._runs()
            ],
            "jumps": [
                {"branch": b, "between": [float(self.diagram.parameter[i]) for i in (n, n + 1)]}
                for b, n in self._leaps()
            ],
        }

    def rows(self) -> tuple[list[str], list[list[str]]]:
        """Return the diagram as a table."""
        diagram = self.diagram
        unit = f" [{self.axis.display_unit}]" if self.axis.display_unit else ""
        turns = "theta" in self.diagram.signal
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
        for number, value in enumerate(self.axis.display_values()):
            for branch, name in enumerate(diagram.branches):
                if diagram.finished[branch, number]:
                    period, rms = diagram.period[branch, number], diagram.rms[branch, number]
                    loss = diagram.contact_loss_share[branch, number]
                    lost = diagram.ran_away[branch, number]
                    size = f"{rms if turns else 1e6 * rms:.5g}"
                    cells.append(
                        [
                            f"{value:.6g}",
                            name,
                            str(period) if period else "none",
                            "ran away" if lost else size,
                            "" if lost else f"{loss:.3g}",
                            f"{diagram.step_number[number]:.3g}",
                            str(diagram.verdict[branch, number]),
                        ]
                    )
        return head, cells

    def _at(self, number: int) -> str:
        return self.axis.show(self.axis.values[number])

    def _counts(self) -> Iterator[str]:
        text = ", ".join(f"{count} {verdict}" for verdict, count in self.diagram.verdicts().items())
        done = int(self.diagram.finished.sum())
        unjudged = done - sum(self.diagram.verdicts().values())
        if unjudged:
            text = ", ".join(part for part in (text, f"{unjudged} not judged") if part)
        yield f"{done} motions: {text}"

    def _lost(self) -> Iterator[str]:
        for branch, name in enumerate(self.diagram.branches):
            places = np.flatnonzero(self.diagram.ran_away[branch])
            if places.size:
                lost = self.diagram.parameter[places]
                count = f"{places.size} motions" if places.size > 1 else "1 motion"
                yield f"{name}: {count} grew beyond all bounds {self._span(lost[0], lost[-1])}"

    def _onset(self) -> int | None:
        limited = np.any(self.diagram.verdict == "step-limited", axis=0)
        return int(np.argmax(limited)) if limited.any() else None

    def _limit(self) -> Iterator[str]:
        onset = self._onset()
        if onset is None:
            return
        diagram = self.diagram
        refined = diagram.refined_period[:, onset].max()
        yield (
            f"step-limited from {self._at(onset)} on: omega_max dt = "
            f"{diagram.step_number[onset]:.3g} with {diagram.steps[onset]} steps per mesh cycle; "
            f"with {diagram.refined_steps[onset]} steps the motion "
            + (f"has period {refined}" if refined else "does not repeat")
        )
        for branch, name in enumerate(diagram.branches):
            wild = (diagram.verdict[branch] == "step-limited") & (diagram.period[branch] != 1)
            wild &= diagram.refined_period[branch] == 1
            if wild.any():
                first = int(np.argmax(wild))
                yield (
                    f"{name}: the step turns period 1 into another motion from {self._at(first)} "
                    f"on, omega_max dt = {diagram.step_number[first]:.3g}"
                )

    def _runs(self) -> Iterator[tuple[str, int, Array]]:
        """Ranges of the same period, without step-limited motions and run-aways."""
        diagram = self.diagram
        for branch, name in enumerate(diagram.branches):
            settled = diagram.finished[branch] & (diagram.verdict[branch] != "step-limited")
            settled &= ~diagram.ran_away[branch]
            places = np.flatnonzero(settled)
            for period, group in groupby(places, key=lambda i, b=branch: int(diagram.period[b, i])):  # type: ignore[misc]
                yield name, period, diagram.parameter[list(group)]

    def _periods(self) -> Iterator[str]:
        for name, period, values in self._runs():
            text = f"period {period}" if period else "no period within 16 mesh cycles"
            yield f"{name}: {text} {self._span(values[0], values[-1])}"

    def _span(self, first: float, last: float) -> str:
        ends = [self.axis.show(value) for value in (first, last)]
        return f"at {ends[0]}" if first == last else f"from {ends[0]} to {ends[1]}"

    def _leaps(self) -> Iterator[tuple[str, int]]:
        diagram = self.diagram
        for branch, name in enumerate(diagram.branches):
            rms = np.where(diagram.verdict[branch] == "step-limited", np.nan, diagram.rms[branch])
            change = np.abs(np.diff(rms))
            neighbours = np.maximum(change[:-2], change[2:])
            larger = np.maximum(rms[1:], rms[:-1])[1:-1]
            steep = change[1:-1] > np.maximum(_JUMP * larger, _STEEPER * neighbours)
            # Without loss of contact only another period jumps; else it is a peak between points.
            loss, period = diagram.contact_loss_share[branch], diagram.period[branch]
            free = (loss[1:] > 0.0) | (loss[:-1] > 0.0) | (period[1:] != period[:-1])
            for place in np.flatnonzero(steep & free[1:-1]):
                yield name, int(place) + 1

    def _jumps(self) -> Iterator[str]:
        for name, place in self._leaps():
            before, after = self.diagram.rms[self.diagram.branches.index(name), place : place + 2]
            yield (
                f"{name}: the rms jumps between {self._at(place)} and {self._at(place + 1)}, "
                f"from {self._size(before)} to {self._size(after)}"
            )

    def _size(self, rms: float) -> str:
        """Format an rms of the signal, an angle or a displacement."""
        return f"{rms:.3g} rad" if "theta" in self.diagram.signal else f"{1e6 * rms:.3g} um"

    def _two(self) -> Iterator[str]:
        if len(self.diagram.branches) < 2:
            return
        up, down = self.diagram.rms[:2]
        places = np.flatnonzero(np.abs(up - down) > _DIFFERENT * np.fmax(up, down))
        for _, group in groupby(enumerate(places), key=lambda pair: pair[1] - pair[0]):
            numbers = [number for _, number in group]
            span = self._span(
                self.diagram.parameter[numbers[0]], self.diagram.parameter[numbers[-1]]
            )
            ends = numbers[0] == 0 or numbers[-1] == self.diagram.parameter.size - 1
            beyond = "; the range ends there, and they may go on beyond it" if ends else ""
            yield f"two motions are possible {span}: up and down differ{beyond}"
