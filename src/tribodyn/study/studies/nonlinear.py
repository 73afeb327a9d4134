"""Nonlinear motions of a case: Lyapunov exponents, basins of attraction, branches of orbits."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.compiled import announce
from tribodyn.dynamics.orbits.solution_branch import of_contact
from tribodyn.dynamics.orbits.system_family import family_of
from tribodyn.errors import Argument, InputError
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine.case import AnyCase
from tribodyn.study.studies.case_grid import (
    Moving,
    contact_without_speed,
    many_motions,
    moving,
    moving_at,
    of_one_size,
    settling_periods,
)
from tribodyn.study.studies.needs import mesh_in_motion, require, require_short
from tribodyn.study.studies.study_axes import ends_of

if TYPE_CHECKING:
    from tribodyn.analysis import Basins, LyapunovExponents
    from tribodyn.dynamics import Branch

#: Half width of the plane of initial states, relative to the static deflection of the mesh.
_WIDE = 5.0
#: Values of each coordinate of the starts of a pair, least ones of a machine.
_STARTS, _LEAST = 41, 3
#: Seconds that the starts of a machine take by default, steps of each over those of one motion, and
#: seconds of a step for each coordinate: a usual figure, so that all processors follow as many.
_PATIENCE, _FOLLOWED, _STEP = 120.0, 3, 4e-8


def lyapunov_exponents(
    case: AnyCase,
    *,
    cycles: int | None = None,
    transient: int = 300,
    steps: int | None = None,
    verdict: bool = True,
    progress: Progress = SILENT,
) -> LyapunovExponents:
    """Find the Lyapunov exponents of the motion of a case: whether it is chaos.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`. The motion starts at its static equilibrium.
    cycles : int, optional
        Mesh cycles over which to average, of a machine periods of its clock: by default as in
        :func:`tribodyn.analysis.lyapunov_exponents`.
    transient : int
        Those that are simulated before.
    steps : int, optional
        Steps per mesh cycle; by default those of the case, else a quarter of those of a single run
        and at least 512.
    verdict : bool
        Whether to compute them again with half the step.
    progress : Progress
        Receives the number of mesh cycles; silent by default.

    Returns
    -------
    LyapunovExponents

    Raises
    ------
    InputError
        If an argument is out of range, or the friction follows the load with more than one
        coefficient.
    ComputationError
        If the motion grows beyond all bounds.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"friction.law": "none"})
    >>> exponents = lyapunov_exponents(case, cycles=40, transient=40, verdict=False)
    >>> exponents.chaotic, exponents.rotating
    (False, ('pinion_theta', 'wheel_theta'))
    """
    from tribodyn.analysis import lyapunov_exponents as compute

    require("lyapunov", case)
    with many_motions(case):
        _require_short("lyapunov", case, steps=steps)
        progress.start("Tooth contact")
        structure = moving(case)
        progress.finish()
        return compute(
            structure.system,
            structure.frequency,
            cycles=cycles,
            transient=transient,
            steps=steps or structure.steps,
            verdict=verdict,
            progress=progress,
        )


def basins(
    case: AnyCase,
    transmission_error: tuple[Any, Any] | None = None,
    rate: tuple[Any, Any] | None = None,
    *,
    points: int | Sequence[int] | None = None,
    mesh: str | None = None,
    cycles: int = 400,
    steps: int | None = None,
    verdict: bool = True,
    keep_partial: bool = False,
    progress: Progress = SILENT,
) -> Basins:
    """Find the steady motion that each disturbed initial state of a case leads to.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    transmission_error : tuple, optional
        Range of the dynamic transmission error at the start, counted from where the driving flank
        first touches: floats in m, or text such as ``"-50 um"``. By default five times the static
        deflection of the mesh to both sides of the static equilibrium.
    rate : tuple, optional
        Range of its rate: floats in m/s, or text such as ``"2e5 um/s"``. By default what a free
        vibration as large as the other range reaches.
    points : int or two int, optional
        Values of each: 41 by default, of a machine as many as take about two minutes.
    mesh : str, optional
        Mesh of a machine or a stage whose transmission error it is, where there are several.
    cycles : int
        Largest number of mesh cycles for a start to approach its steady motion.
    steps : int, optional
        As of :func:`lyapunov_exponents`.
    verdict : bool
        Repeat everything with half the step, and judge.
    keep_partial : bool
        Return the finished starts when interrupted (Ctrl-C), see ``finished``.
    progress : Progress
        Receives the number of finished starts; silent by default.

    Returns
    -------
    Basins
        Its coordinates are the transmission error and its rate; all other coordinates start at the
        static equilibrium, and free rotations get no momentum.

    Raises
    ------
    InputError
        If an argument is out of range, or nine starts of a machine take much more than two minutes
        and ``points`` is not given.
    """
    from tribodyn.analysis import basins as compute
    from tribodyn.nonlinear.basins import MESH_PLANE

    name = mesh_in_motion("basins", case, mesh)
    ends = [
        None if ends_of_range is None else _read_ends(name, ends_of_range, unit)
        for name, ends_of_range, unit in (
            ("transmission_error", transmission_error, "m"),
            ("rate", rate, "m/s"),
        )
    ]
    with many_motions(case):
        if points is None:
            points = _STARTS if case.lumped else _starts(case, name, cycles, steps)
        counts = (points, points) if isinstance(points, int) else tuple(points)
        progress.start("Tooth contact")
        structure = moving(case, name)
        progress.finish()
        structure = structure._replace(steps=steps or structure.steps)
        default_ends = _plane_about_equilibrium(structure)
        first, second = (chosen or other for chosen, other in zip(ends, default_ends, strict=True))
        return compute(
            structure.system,
            structure.frequency,
            between=(first, second),
            coordinates=MESH_PLANE,
            points=counts,  # type: ignore[arg-type]
            cycles=cycles,
            steps=structure.steps,
            signal=structure.contact,
            verdict=verdict,
            keep_partial=keep_partial,
            progress=progress,
        )


def _require_short(study: str, case: AnyCase, name: str | None = None, *, steps: Any) -> None:
    """Refuse a machine whose motion is too long for a study, before its teeth are computed."""
    if not case.lumped:
        rehearsed = moving(case, name, rehearsal=True)
        period = (steps or rehearsed.steps) * rehearsed.system.cycles
        require_short(study, period, rehearsed.system.size)


def _starts(case: AnyCase, name: str, cycles: int, steps: int | None) -> int:
    """Values of each coordinate whose motions take no longer than one waits for, with a notice.

    The motions are those of a rehearsal, so that the teeth are computed only if they are followed.
    """
    rehearsed = moving(case, name, rehearsal=True)
    rehearsed = rehearsed._replace(steps=steps or rehearsed.steps)
    system, periods = rehearsed.system, min(cycles, settling_periods(rehearsed))
    seconds = _FOLLOWED * periods * _STEP * rehearsed.steps * system.cycles * system.size
    count = min(int(np.sqrt(_PATIENCE / seconds)), _STARTS)
    if count >= _LEAST:
        announce(
            f"following {count} x {count} starts over about {periods} periods until they settle, "
            f"{count**2 * seconds / 60.0:.2g} min; points (--points) asks for others"
        )
        return count
    least = _LEAST**2 * seconds / 60.0
    what = f"{_LEAST} x {_LEAST} starts take {least:.2g} min"
    why = (
        f"Each settles over about {periods} periods of the clock, {rehearsed.system.cycles} cycles"
    )
    remedy = f"Give points = {_LEAST} (--points {_LEAST}) to wait, or more damping or fewer cycles"
    raise InputError(what, Argument("points"), f"{why} of its meshes each", remedy)


def _read_ends(name: str, ends: Sequence[Any], unit: str) -> tuple[float, float]:
    from tribodyn.units import UnitProblemError, parse

    remedy = 'Write, for example, ("-50 um", "50 um")' if unit == "m" else 'Write ("0 um/s", ...)'
    try:
        low, high = (parse(end, unit) if isinstance(end, str) else float(end) for end in ends)
    except (UnitProblemError, TypeError, ValueError) as error:
        raise InputError(f"{name} = {ends}", f"argument {name}", str(error), remedy) from None
    if not (np.isfinite(low) and np.isfinite(high) and low < high):
        why = "A range goes from the smaller value to the larger"
        raise InputError(f"{name} = {ends}", f"argument {name}", why, remedy)
    return low, high


def _plane_about_equilibrium(structure: Moving) -> tuple[tuple[float, float], tuple[float, float]]:
    """Ranges of transmission error and rate about the static equilibrium."""
    from tribodyn.dynamics.equations.orbit_coordinates import static_start
    from tribodyn.dynamics.modal.modal_march import compile_motion
    from tribodyn.nonlinear.basins import MESH_PLANE, start_plane

    system, frequency, steps, contact = structure
    compiled = compile_motion(system, frequency, steps)
    plane = start_plane(compiled, frequency, MESH_PLANE, contact)
    equilibrium = plane.section(static_start(compiled))
    nodes, along = compiled.nodes, compiled.nodes.direction[0, 0, contact]
    # The teeth of a pair are one contact or several; those of a mesh of a machine are one.
    every = (
        nodes.stiffness.sum(axis=-1) if compiled.engine is None else nodes.stiffness[..., contact]
    )
    stiffness = float(np.einsum("rs,rs->", nodes.weight, every))
    mass = 1.0 / float(along @ np.linalg.solve(np.asarray(system.mass), along))
    width = _WIDE * abs(float(equilibrium[0]))
    swing = width * float(np.sqrt(stiffness / mass))
    return (float(equilibrium[0]) - width, float(equilibrium[0]) + width), (-swing, swing)


def continuation(
    case: AnyCase,
    over: str = "operation.speed",
    between: tuple[object, object] | None = None,
    *,
    mesh: str | None = None,
    periods: int = 1,
    steps: int | None = None,
    longest_step: float = 0.02,
    points: int = 2000,
    by: str = "",
    progress: Progress = SILENT,
) -> Branch:
    """Follow the periodic motion of a case over one of its values, stable or not.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    over : str
        Dotted key of the value that varies.
    between : tuple
        Its two ends: floats in SI, or text with a unit. The branch begins at the first.
    mesh : str, optional
        Mesh of a machine or a stage whose compression and force are measured, where there are
        several.
    periods : int
        Mesh cycles after which the motion repeats; of a machine periods of its clock.
    steps : int, optional
        As of :func:`lyapunov_exponents`, at the end with the slower mesh.
    longest_step : float
        Longest step relative to the range [-]; shorter ones separate neighbouring special points.
    points : int
        Largest number of points.
    by : str
        Name of the caller in messages; if set, a bare number for a dimension is refused as in a
        file.
    progress : Progress
        Receives the number of points; silent by default.

    Returns
    -------
    Branch
        Its parameter is in the SI unit of the key.

    Raises
    ------
    InputError
        If the key is unknown or not a number, or a value is out of range.
    ComputationError
        If no first orbit is found.

    Warns
    -----
    ModelWarning
        ``steady-state`` if the branch ends where it cannot be followed further.
    """
    from tribodyn.dynamics import continuation as compute

    name = mesh_in_motion("continuation", case, mesh)
    if between is None or len(between) != 2:
        remedy = 'Write, for example, between=("400 rpm", "3500 rpm")'
        why = "A branch goes from one value to another"
        raise InputError(f"between = {between}", "argument between", why, remedy)
    first, last = ends_of(case, over, between, by=by)
    if first == last:
        why, remedy = "A branch goes from one value to another", "Give two different ones"
        raise InputError(f"{over} goes from {between[0]} to {between[1]}", by or "argument between",
                         why, remedy)  # fmt: skip
    pair = case if case.lumped else None
    with many_motions(case):
        _require_short("continuation", case.replace({over: float(first)}), name, steps=steps)
        every = partial(moving_at, of_one_size(case, over, (first, last)), over, name)
        start = every(first)
        count = steps or max(start.steps, every(last).steps)
        same = over == "operation.speed" and pair is not None and contact_without_speed(pair)
        smooth = None if pair is not None else family_of(every, (first, last), count)

        def at(value: float) -> tuple[Any, float]:
            if same:
                return start.system, start.frequency * value / first
            if smooth is not None:
                return smooth(value)
            each = every(value)
            return each.system, each.frequency

        progress.start("Branch")
        branch = compute(
            at,
            parameter=over,
            between=(first, last),
            periods=periods,
            steps=count,
            longest_step=longest_step,
            points=points,
            signals=None if pair is not None else [_deflection(start.contact)],
            progress=progress,
        )
    return branch if pair is not None else of_contact(branch, start.contact)


def _deflection(contact: int) -> str:
    """Name of the compression of a contact in a branch."""
    return f"deflection {contact}" if contact else "deflection"
