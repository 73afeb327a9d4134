"""Bifurcation diagrams: motions over a parameter, each with a test of its step."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from time import process_time
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.aliases import with_old_names
from tribodyn.checkpoints import Checkpoints
from tribodyn.compiled import announce
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.step_limit import LIMIT
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.simulate import read_start, simulate
from tribodyn.errors import ComputationError, InputError, require_one_of, require_positive
from tribodyn.nonlinear.bifurcation_sweep import march_sweeps
from tribodyn.nonlinear.lyapunov import lyapunov_exponents
from tribodyn.nonlinear.survey import (
    Outcomes,
    Points,
    Survey,
    Surveyed,
    march_points,
    signal_name,
)
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts, fact, quantity, record
from tribodyn.types import Array, Index, Mask

Sweep = Literal["up", "down", "both", "independent"]

_BRANCHES: dict[str, tuple[str, ...]] = {
    "up": ("up",),
    "down": ("down",),
    "both": ("up", "down"),
    "independent": ("independent",),
}


#: Mesh cycles over which disturbances turn into their directions.
_TURN_IN = 20


#: Total number of steps above which the expected duration is announced (seconds to minutes).
_MANY = 2e7
#: Least duration that is announced [min].
_LONG = 0.5


@with_old_names
def bifurcation(
    systems: System | Sequence[System],
    mesh_frequency: ArrayLike,
    *,
    parameter: ArrayLike | None = None,
    parameter_name: str = "mesh_frequency",
    parameter_unit: str = "Hz",
    sweep: Sweep = "up",
    cycles: int = 64,
    transient: int = 300,
    keep: int = 48,
    steps: ArrayLike = 512,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    signal: int | str = 0,
    verdict: bool = True,
    exponents: int = 0,
    keep_partial: bool = False,
    progress: Progress = SILENT,
    checkpoints: Checkpoints | None = None,
) -> Bifurcation:
    """Follow the motion of a system over a parameter.

    Parameters
    ----------
    systems : System or sequence of System
        One system over many mesh frequencies, or one system for each value of the parameter.
    mesh_frequency : float or (points,) array
        Mesh frequency [Hz].
    parameter : (points,) array, optional
        Values of the parameter [unit of ``parameter_unit``]; the mesh frequency by default.
    parameter_name, parameter_unit : str
        What it is.
    sweep : "up", "down", "both" or "independent"
        Each value from the last state of the one before, in the order given (up) or against it
        (down), or all of them from the same start.
    cycles : int
        Mesh cycles of the statistics at each value.
    transient : int
        Mesh cycles before, fewer where the motion repeats after 1 to 8 of them; the distance to
        the motion that repeats exactly is then certified to be less than 1e-7 of its size.
    keep : int
        Number of last mesh cycles whose points are stored.
    steps : int or (points,) array
        Steps per mesh cycle [-].
    start : (position, velocity), optional
        Two (n,) arrays [m or rad, m/s or rad/s]; the static equilibrium at mean stiffness by
        default.
    signal : int or str
        Number of the contact whose compression is evaluated, or name of a coordinate.
    verdict : bool
        Repeat every motion with half the step or less, and judge.
    exponents : int
        Mesh cycles for the largest Lyapunov exponent of each motion; 0 to leave it out.
    keep_partial : bool
        Return what is finished when interrupted (Ctrl-C): other values are NaN, see ``finished``.
    progress : Progress
        Receives the number of finished motions; silent by default.
    checkpoints : tribodyn.checkpoints.Checkpoints, optional
        Stores every motion when it is finished, and restores those of an interrupted process.

    Returns
    -------
    Bifurcation
        A step beyond the limit of the integrator is not refused: such motions are marked
        ``"step-limited"``, and so are all whose period changes with half the step.

    Raises
    ------
    InputError
        If an argument is out of range or shapes disagree.
    KeyboardInterrupt
        On an interruption (Ctrl-C), unless ``keep_partial``.

    Notes
    -----
    A sweep over the mesh frequency of one system is integrated in stretches, in one batch. Every
    stretch is then entered from the end of the one before until it meets the motions that are
    there, so that jumps lie where marching one value after the other puts them. Motions that do
    not repeat count as the same. The repetition with shorter steps begins on the motion itself.

    The exponent is that of the motion with ``refined_steps`` where the step is beyond the limit.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda p: 1.0 + 0.2 * np.cos(2 * np.pi * p), gap=1.0)
    >>> system = System([[1.0]], [[0.1]], [[0.0]], [0.5], [pair])
    >>> diagram = bifurcation(system, np.array([0.7, 0.8]) / (2 * np.pi), steps=64)
    >>> diagram.period.tolist(), diagram.verdicts()
    ([[1, 1]], {'physical': 2})
    """
    require_one_of("sweep", sweep, _BRANCHES)
    values = _read_values(systems, mesh_frequency, steps)
    parameter_values = _read_parameter(parameter, values)
    name = signal_name(values.systems[0], signal)
    survey = _read_survey(
        Survey(
            transient,
            cycles,
            keep,
            signal if values.systems[0].contacts else name,
            keep_partial,
            checkpoints=Checkpoints() if checkpoints is None else checkpoints,
        )
    )
    first = None if start is None else read_start(values.systems[0], start)
    branches = _BRANCHES[sweep]
    _announce(values, transient, (transient + cycles) * len(branches) * (3 if verdict else 1))
    progress.start("Motions", values.count * len(branches) * (1 + bool(verdict)))
    rows = _rows(values, branches, first, survey, progress)
    finer = values.refined(_refined_steps(values))
    fine = [_begin(values, row, keep) for row in rows]
    if verdict and not survey.stop.is_set():
        judged = ((new, row.finished) for row, new in zip(rows, fine, strict=True))
        march_points(finer, survey, *judged, progress=progress)
    largest = np.full((len(rows), values.count), np.nan)
    if exponents and not survey.stop.is_set():
        largest = _largest_exponents(values, finer, rows, fine, exponents)
    progress.finish()
    return _diagram(
        values,
        finer,
        rows,
        fine,
        parameter=parameter_values,
        parameter_name=parameter_name,
        parameter_unit=parameter_unit,
        branches=branches,
        signal=name,
        largest_exponent=largest,
    )


def _begin(values: Points, row: Outcomes, keep: int) -> Outcomes:
    """Initial states of the repetition: the motion itself, unless its step is too long."""
    fine = Outcomes(values.count, keep, values.size, f"{row.name} finer")
    sound = (values.step_number <= LIMIT) & np.all(np.isfinite(row.last), axis=1)
    fine.first[:] = np.where(sound[:, None], row.last, row.first)
    return fine


def _diagram(
    values: Points, finer: Points, rows: list[Outcomes], fine: list[Outcomes], **facts: Any
) -> Bifurcation:
    """Judge every motion and combine them into a diagram."""

    def stack_rows(name: str, of: list[Outcomes]) -> Any:
        return np.array([getattr(row, name) for row in of])

    verdicts = [
        [row.verdict(i, values.step_number[i], new) for i in range(values.count)]
        for row, new in zip(rows, fine, strict=True)
    ]
    return Bifurcation(
        mesh_frequency=values.mesh_frequency,
        section=stack_rows("section", rows),
        period=stack_rows("period", rows),
        rms=stack_rows("rms", rows),
        contact_loss_share=stack_rows("contact_loss_share", rows),
        step_number=values.step_number,
        steps=values.steps,
        verdict=np.array(verdicts, dtype="<U12"),
        refined_period=stack_rows("period", fine),
        refined_rms=stack_rows("rms", fine),
        refined_steps=finer.steps,
        finished=stack_rows("finished", rows),
        **facts,
    )


def _read_parameter(parameter: ArrayLike | None, values: Points) -> Array:
    axis = values.mesh_frequency if parameter is None else np.asarray(parameter, dtype=float)
    if axis.shape not in ((), (values.count,)):
        what = f"parameter has the shape {axis.shape}, and there are {values.count} values"
        why = "Each value of the parameter has a place on the axis"
        raise InputError(what, "argument parameter", why, "Give one finite value for each system")
    return np.broadcast_to(axis, (values.count,)).copy()


def _read_values(
    systems: System | Sequence[System], mesh_frequency: ArrayLike, steps: ArrayLike
) -> Points:
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    system_list = [systems] if isinstance(systems, System) else list(systems)
    try:
        shapes = np.broadcast_shapes(np.shape(mesh_frequency), np.shape(steps), (len(system_list),))
        (count,) = shapes
    except ValueError as error:
        raise InputError(
            f"{len(system_list)} systems, {np.shape(mesh_frequency)} mesh frequencies and "
            f"{np.shape(steps)} steps",
            where="argument systems",
            why="Each is one, or one for each value of the parameter",
            remedy="Give one of each, or one of each for every value",
        ) from error
    if not system_list or np.any(np.asarray(steps) < 1):
        what = "no system" if not system_list else f"steps = {np.min(np.asarray(steps))}"
        why = "There is one time grid for each value"
        remedy = "Give one number of steps, or one for each value"
        raise InputError(
            what, "argument systems" if not system_list else "argument steps", why, remedy
        )
    frequency = np.broadcast_to(np.asarray(mesh_frequency, dtype=float), (count,)).copy()
    step_counts = np.broadcast_to(np.asarray(steps).astype(np.int64), (count,)).copy()
    return Points(
        system_list * count if len(system_list) == 1 else system_list, frequency, step_counts
    )


def _read_survey(survey: Survey) -> Survey:
    if not 2 <= survey.keep <= survey.cycles or survey.transient < 0:
        what = f"keep = {survey.keep}, cycles = {survey.cycles}, transient = {survey.transient}"
        why = "At least two points are stored, and no more than cycles"
        raise InputError(what, "argument keep", why, "Lower keep, or raise cycles")
    return survey


def period_seconds(compiled: Compiled, frequency: float) -> float:
    """Seconds in which one period of one motion is followed, measured without other programs."""
    system, rest_state = compiled.system, static_start(compiled)

    def march(periods: int) -> None:
        if compiled.engine is not None:
            compiled.engine.march(np.array([1.0 / frequency]), rest_state[None], periods)
        else:
            start = rest_state[: system.size], rest_state[system.size :]
            simulate(system, frequency, 1, start, steps=compiled.grid.steps)

    march(0)  # the first time compiles
    begin = process_time()
    march(1)
    return process_time() - begin


def _announce(values: Points, transient: int, cycles: int) -> None:
    """Announce the duration of a long computation, estimated from one period."""
    frequency = float(values.mesh_frequency[0])
    compiled = values.compiled(values.groups[0])
    steps = compiled.grid.steps * values.count * cycles
    if compiled.engine is None and steps < _MANY:
        return

    with suppress(ComputationError):
        minutes = values.count * cycles * period_seconds(compiled, frequency) / 60.0
        if minutes > _LONG:
            announce(
                f"following {values.count} motions with {compiled.grid.steps} steps in each "
                f"period, up to {transient} periods until each repeats, {minutes:.2g} min at most; "
                "fewer values or steps, a shorter transient or constant stiffness of the teeth "
                "take less"
            )


def _rows(
    values: Points,
    branches: tuple[str, ...],
    first: Array | None,
    survey: Survey,
    progress: Progress,
) -> list[Outcomes]:
    """Motions of every branch."""
    if branches != ("independent",):
        return march_sweeps(values, first, survey, branches, progress)
    row = Outcomes(values.count, survey.keep, values.size, branches[0])
    if first is not None:
        row.first[:] = first
    march_points(values, survey, (row, None), progress=progress)
    return [row]


def _refined_steps(values: Points) -> Index:
    """Twice the steps, or as often doubled as it takes to be stable with a margin of two."""
    halvings = np.ceil(np.log2(np.maximum(2.0 * values.step_number / LIMIT, 2.0)))
    halvings = np.where(values.step_number > LIMIT, halvings, 1.0)
    return np.asarray(values.steps * 2 ** halvings.astype(np.int64))


def _largest_exponents(
    values: Points, finer: Points, rows: list[Outcomes], fine: list[Outcomes], cycles: int
) -> Array:
    """Largest exponents of all motions; of the refined ones where the step is beyond the limit."""
    limited = values.step_number > LIMIT
    used = np.where(limited, finer.steps, values.steps)
    branches = []
    for row, new in zip(rows, fine, strict=True):
        refined = limited & new.finished
        last = np.where(refined[:, None], new.last, row.last)
        force = np.where(refined[:, None], new.force, row.force)
        branches.append(_exponents(values, used, last, force, cycles))
    return np.array(branches)


def _exponents(values: Points, steps: Index, last: Array, force: Array, cycles: int) -> list[float]:
    """Largest exponents; NaN for a motion that grew beyond all bounds or a step too long."""
    exponents = []
    for number, state in enumerate(last):
        largest = float("nan")
        if np.all(np.isfinite(state)):
            half = state.size // 2
            with suppress(InputError):
                largest = lyapunov_exponents(
                    values.systems[number],
                    float(values.mesh_frequency[number]),
                    start=(state[:half], state[half:]),
                    cycles=cycles,
                    transient=_TURN_IN,
                    steps=int(steps[number]),
                    extra_force=force[number],
                    verdict=False,
                ).largest
        exponents.append(float(largest))
    return exponents


@record
class Bifurcation(Surveyed):
    """Motions over a parameter; the first axis of every result is the branch.

    Parameters
    ----------
    parameter : (points,) array
        Values of the parameter, in the unit of ``parameter_unit``.
    parameter_name, parameter_unit : str
        What it is.
    mesh_frequency : (points,) array
        Mesh frequency [Hz].
    branches : tuple of str
        ``"up"``, ``"down"`` or ``"independent"``.
    signal : str
        Name of the evaluated contact or coordinate.
    section : (branches, points, keep) array
        It once per mesh cycle, at the mesh phase 0 [m or rad].
    period : (branches, points) int array
        Mesh cycles after which the motion repeats; 0 if it does not repeat within 16.
    rms : (branches, points) array
        Its alternating rms [m or rad]; NaN for a motion that grew beyond all bounds.
    contact_loss_share : (branches, points) array
        Part of the time off the driving flank [-].
    step_number : (points,) array
        ``omega_max * dt`` [-].
    steps : (points,) int array
        Steps per mesh cycle.
    verdict : (branches, points) str array
        ``"physical"``, ``"step-limited"``, ``"undecided"``; empty if not requested.
    refined_period : (branches, points) int array
        Period of the same computation with ``refined_steps`` steps.
    refined_rms : (branches, points) array
        Rms of the same computation [m or rad].
    refined_steps : (points,) int array
        Twice the steps, or more where that is not yet stable.
    largest_exponent : (branches, points) array
        Largest Lyapunov exponent [1/s]; NaN if not requested.
    finished : (branches, points) bool array
        Which motions are there; all of them unless the work was interrupted. The others have NaN,
        period 0 and an empty verdict.
    """

    parameter: Array = quantity("value", unit="@parameter_unit")
    parameter_name: str = fact()
    parameter_unit: str
    mesh_frequency: Array = quantity("value", unit="Hz")
    branches: tuple[str, ...] = quantity("branch", axis=True, name="branch")
    signal: str = fact()
    section: Array = quantity("branch", "value", "mesh_cycle", unit="m or rad")
    period: Index = quantity("branch", "value", unit="1")
    rms: Array = quantity("branch", "value", unit="m or rad")
    contact_loss_share: Array = quantity("branch", "value", unit="1")
    step_number: Array = quantity("value", unit="1")
    steps: Index = quantity("value", unit="1")
    verdict: NDArray[np.str_] = quantity("branch", "value")
    refined_period: Index = quantity("branch", "value", unit="1")
    refined_rms: Array = quantity("branch", "value", unit="m or rad")
    refined_steps: Index = quantity("value", unit="1")
    largest_exponent: Array = quantity("branch", "value", unit="1/s")
    finished: Mask = quantity("branch", "value")

    def __repr__(self) -> str:
        """One line."""
        low, high = self.parameter.min(), self.parameter.max()
        return (
            f"Bifurcation({self.parameter.size} values of {self.parameter_name} from {low:.6g} to "
            f"{high:.6g} {self.parameter_unit}, {' and '.join(self.branches)}{self._ending()})"
        )

    def _parts(self) -> Parts:
        parts = super()._parts()
        parts.variables["parameter"] = ("value", self.parameter, {"units": self.parameter_unit})
        return parts
