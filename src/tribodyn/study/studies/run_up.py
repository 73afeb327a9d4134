"""Run-up and speed sweep of a case: prescribed acceleration, or a series of steady motions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.dynamics import harmonic_balance
from tribodyn.errors import ComputationError, InputError, collected, warn
from tribodyn.interrupt import single_blas_thread
from tribodyn.nomenclature import GEARS
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.sections import Operation
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.case.values import FaultError, Plain, read_value
from tribodyn.study.faults.clock import MOST_CYCLES, PairTurns, varies_over_turns
from tribodyn.study.faults.turning import refuse_long_period
from tribodyn.study.first_use import compile_in_parallel
from tribodyn.study.machine.run import run_load
from tribodyn.study.pipeline.assembly import rotation_of
from tribodyn.study.pipeline.motion import by_engine
from tribodyn.study.planetary.common import common_lines, line_labels
from tribodyn.study.studies.case_grid import Member, results_under, varied
from tribodyn.study.studies.levels import MachineLevels, levels_of
from tribodyn.study.studies.study_axes import read_axes
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import RunUp, SpeedSweep, System
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase, MachineCase
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.result import LoadResult
    from tribodyn.types import Array


_SPEED = "operation.speed"
#: Most periods of a run-up whose levels are computed, and speeds of one over phases.
_RECORDED, _STEADY = 400, 31
#: Change of the speed from one period of the clock to the next that causes a warning.
_COARSE = 0.02


def run_up(
    case: AnyCase,
    between: tuple[object, object] | None = None,
    duration: float = 10.0,
    *,
    down: bool = False,
    hold: float = 0.0,
    tables: int = 4,
    samples: int = 128,
    steps: int | None = None,
    progress: Progress = SILENT,
) -> RunUp | MachineLevels:
    """Simulate a case while its speed rises at a constant rate and optionally falls again.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    between : tuple
        Lowest and highest value of ``operation.speed``: floats in rad/s, or text with a unit.
    duration : float
        Length of the rise, and of the fall [s].
    down : bool
        Whether the speed falls again at the same rate.
    hold : float
        Time at the highest speed [s].
    tables : int
        Number of speeds, evenly spaced in the logarithm, at which the tooth contact is computed;
        film and friction are interpolated linearly between them.
    samples : int
        Samples of each mesh cycle that are stored.
    steps : int, optional
        Steps per mesh cycle at all speeds; by default each speed has as many as it needs.
    progress : Progress
        Receives the progress of the study; silent by default.

    Returns
    -------
    RunUp or MachineLevels
        Its speed is that of the gear whose speed the case gives. Outputs are the forces of the
        supports, where there are any. The inertia of the prescribed acceleration loads the teeth.
        Faults of the case follow the angle of the shafts, over whole turns. The rotation that a
        ripple causes moves the mesh phase; between two ``tables`` it is interpolated.
        A machine has the levels of each period of its clock, without this inertia; its teeth, film
        and gyroscopic moments are those of the mean speed (``tables``, ``samples`` and ``steps``
        are of pairs).

    Raises
    ------
    InputError
        If a speed is not positive, or the case cannot be computed there.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> run_up(case, ("3000 rpm", "3300 rpm"), 0.1, tables=2)
    RunUp(0.1 s, 84 mesh cycles, mesh frequency 800 to 880 Hz, 6 coordinates, 128 samples per cycle)
    """
    from tribodyn.dynamics import run_up as compute
    from tribodyn.dynamics import speed_ramp

    low, high = _ends(between)
    if not case.lumped:
        ends = (low, high)
        return parts_run_up(case, ends, duration, down=down, hold=hold, progress=progress)
    count = int(tables)
    if count != tables or count < 1:
        what = f"tables = {tables}"
        raise InputError(what, "argument tables", "A whole number >= 1", "Give 1 or more")
    speeds = np.geomspace(low, high, count) if count > 1 else np.array([np.sqrt(low * high)])
    with locate_errors(case), collected(), compile_in_parallel(case, "run-up"):
        if varies_over_turns(case):
            _check_faults(case)
        members, per_speed = _members(case, speeds, progress)
        systems, cycles = _turning_systems(case, members)
        first = next(iter(systems.values()))
        rotation = rotation_of(case, first.names)
        profile = speed_ramp(low * per_speed, high * per_speed, duration, hold=hold, down=down)
        return compute(
            systems if count > 1 else first,
            profile,
            teeth=round(2.0 * np.pi * per_speed),
            cycles=cycles,
            samples=samples,
            steps=steps or case.solver.steps_per_mesh_cycle,
            outputs=supports(first),
            rotation=None if rotation is None else per_speed * rotation,
            progress=progress,
        )


def speed_systems(
    case: PairCase, speeds: object, progress: Progress = SILENT
) -> tuple[dict[float, System], float]:
    """Build the structure of a case at each speed, by mesh frequency."""
    members, per_speed = _members(case, speeds, progress)
    return {member.mesh.mesh_frequency: member.system for member in members}, per_speed


def _members(case: PairCase, speeds: Any, progress: Progress) -> tuple[list[Member], float]:
    """The case at each speed, and its mesh frequency over the speed."""
    members = varied(case, [{_SPEED: float(speed)} for speed in speeds], progress)
    return members, members[-1].mesh.mesh_frequency / float(speeds[-1])


def _turning_systems(case: PairCase, members: list[Member]) -> tuple[dict[float, System], int]:
    """Structures at each speed by mesh frequency, and the mesh cycles of their clock."""
    if not varies_over_turns(case):
        return {member.mesh.mesh_frequency: member.system for member in members}, 1
    from tribodyn.dynamics.equations.ramps import split_ramps
    from tribodyn.study.faults.motion import driven_system, turning_mesh_of
    from tribodyn.study.pipeline.assembly import damping_of

    turns = PairTurns.of(case)
    mesh = turning_mesh_of(case, members[-1].mesh, turns.faults)
    systems = {}
    for each in members:
        damping = damping_of(each.case, each.mesh)
        driven = driven_system(each.case, each.mesh, damping, turns, mesh)
        systems[each.mesh.mesh_frequency] = split_ramps(driven.system)
    return systems, driven.cycles


def _check_faults(case: PairCase) -> None:
    """Refuse faults that do not repeat with the turns, and periods that are too long."""
    from tribodyn.faults import RandomLoad
    from tribodyn.study.faults.section import excitations

    for name, excitation in excitations(case).items():
        if isinstance(excitation, RandomLoad):
            what, why = "a random load in a run-up", "It repeats in time, a run-up in the angle"
            remedy = f"Set faults.{name} aside for the run-up"
            raise InputError(what, f"faults.{name}", why, remedy)
    turns = PairTurns.of(case)
    remedy = "Give faults of one gear, or orders that repeat after fewer turns"
    refuse_long_period(turns.cycles, turns.seconds, MOST_CYCLES, remedy)


def _ends(between: tuple[object, object] | None) -> tuple[float, float]:
    """Return the lowest and highest speed in SI, checked like the key of the case."""
    if between is None or len(between) != 2:
        why = "A run-up goes from one speed to another"
        remedy = 'Write, for example, between=("400 rpm", "3500 rpm")'
        raise InputError(f"between = {between}", "argument between", why, remedy)
    low, high = (_speed(end, between) for end in between)
    if not low < high:
        what, remedy = f"between = {between}", "Exchange them; down=True adds the run-down"
        raise InputError(what, "argument between", "The first speed is the lowest", remedy)
    return low, high


def _speed(end: Any, between: tuple[Any, Any]) -> float:
    """Read an end speed of a run-up in SI."""
    spec = dict(Operation.specs())["speed"]
    try:
        return float(read_value(spec, "speed", Plain(end)))
    except FaultError as fault:
        problem = fault.problem
    why = problem.why.replace("Allowed:", "Speeds of a run-up lie within")
    remedy = problem.remedy
    if why != problem.why and end is between[0]:
        remedy = 'Begin the run-up above standstill, for example at "30 rpm"'
    raise InputError(replace(problem, where="argument between", why=why, remedy=remedy))


def supports(system: System) -> Tree:
    """Forces on the supports of the gears as rows over positions and velocities."""
    rows = {}
    for column, name in enumerate(system.names):
        row_pair = (np.asarray(system.stiffness)[column], np.asarray(system.damping)[column])
        if np.any(row_pair[0]) and name.startswith(tuple(f"{gear}_" for gear in GEARS)):
            rows[f"bearing_force_{name}"] = np.concatenate(row_pair)
    return rows


def speed_sweep(
    case: AnyCase,
    between: tuple[Any, Any],
    points: int = 60,
    *,
    tables: int = 4,
    progress: Progress = SILENT,
    **options: Any,
) -> SpeedSweep | MachineLevels:
    """Follow the steady motion of a case over its speed, up and down, with its jumps.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    between : tuple
        Lowest and highest value of ``operation.speed``: floats in rad/s, or text with a unit.
    points : int
        Speeds, evenly spaced, the ends included.
    tables, progress
        As :func:`run_up` takes them.
    **options : object
        ``directions``, ``steps``, ``periods``, ``patience`` and ``tolerance`` of
        :func:`tribodyn.dynamics.speed_sweep`.

    Returns
    -------
    SpeedSweep or MachineLevels
        Its speed is that of the gear whose speed the case gives; bearing forces are outputs. A
        machine has the levels of the motion at every speed, upwards only, each with its own teeth;
        ``tables`` and the options are of pairs.

    Raises
    ------
    InputError
        If a speed is out of range, or the case cannot be computed there.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    >>> response = speed_sweep(case, ("2000 rpm", "2100 rpm"), 2, tables=1)
    >>> (response.speed * 30 / np.pi).round(6).tolist()
    [2000.0, 2100.0]
    """
    from tribodyn.dynamics import speed_sweep as compute

    if int(tables) != tables or tables < 1:
        raise InputError(
            f"tables = {tables}", "argument tables", "A whole number >= 1", remedy="Give 1 or more"
        )
    (axis,) = read_axes(case, {_SPEED: (*between, points)})
    speeds = np.array(axis.values, dtype=float)
    if not case.lumped:
        return parts_speed_sweep(case, speeds, progress)
    nodes = np.geomspace(speeds[0], speeds[-1], tables) if tables > 1 else [speeds.mean()]
    with locate_errors(case), collected():
        systems, per_speed = speed_systems(case, nodes, progress)
        first = next(iter(systems.values()))
        return compute(
            systems if tables > 1 else first,
            per_speed * speeds,
            teeth=round(2.0 * np.pi * per_speed),
            outputs=supports(first),
            progress=progress,
            **options,
        )


def parts_speed_sweep(
    case: MachineCase, speeds: Array, progress: Progress = SILENT
) -> MachineLevels:
    """Levels of the steady motions of a machine or stage over the speed of its input [rad/s]."""
    progress.start("Speeds", speeds.size)
    failed: list[str] = []
    middle: list[LoadResult] = []

    def motions() -> Iterator[MachineMotion | None]:
        changes = [{"operation.speed": float(n)} for n in speeds]
        for result, _ in results_under(case, changes, progress):
            if isinstance(result, InputError | ComputationError):
                failed.append(str(result))
                yield None
            else:
                failed.append("")
                if not middle or len(failed) <= speeds.size // 2:
                    middle[:] = [result]
                yield result.signals_along(result.response)
            progress.advance()

    try:
        levels = levels_of(motions(), speeds)
    except ComputationError as error:
        raise ComputationError(replace(error.problems[0], why=failed[0])) from None
    progress.finish()
    return replace(_levels_of_result(levels, middle[0]), failed=np.array(failed, dtype=object))


def parts_run_up(
    case: MachineCase,
    ends: tuple[float, float],
    duration: float,
    *,
    down: bool = False,
    hold: float = 0.0,
    progress: Progress = SILENT,
) -> MachineLevels:
    """Levels of a machine or stage along a run-up between speeds of its input [rad/s]."""
    # The speed rises from period to period; teeth and gyroscopic moments are of the mean speed.
    from tribodyn.dynamics.running_up.run_up_march import periods_at

    middle = case.replace({"operation.speed": float(np.sqrt(ends[0] * ends[1]))})
    with collected(), single_blas_thread():
        result = run_load(middle, middle.operating_point, progress, [])
    if result.system.phases:
        span = duration + hold + duration * down
        time = np.linspace(0.0, span, _STEADY)
        corners = [0.0, duration, duration + hold, span]
        speed = np.interp(time, corners, [ends[0], ends[1], ends[1], ends[0] if down else ends[1]])
        motions_over = _steady_motions(result, case.solver.engine, speed, progress)
        levels = levels_of(motions_over, speed, time=time)
        return _levels_of_result(levels, result)
    per_speed = result.clock_frequency / middle.operating_point.speed
    speed, time = _periods(per_speed, ends, duration, hold, down)
    with collected(), single_blas_thread():
        steps = result.steps
        start = harmonic_balance(result.system, float(per_speed * speed[0]), steps=steps)
        every = -(-speed.size // _RECORDED)
        progress.start("Periods of the run-up", speed.size)

        def motions() -> Iterator[MachineMotion]:
            frequency = (per_speed * speed).tolist()
            for response in periods_at(result.system, frequency, start, steps, every):
                if response is not None:
                    yield result.signals_along(response)
                progress.advance()

        levels = levels_of(motions(), speed[::every], time=time[::every])
        progress.finish()
    return _levels_of_result(levels, result)


def _steady_motions(
    result: LoadResult, engine: str, speeds: Array, progress: Progress
) -> Iterator[MachineMotion]:
    """Motions over phases at the speeds of a run-up, which is slow compared with their decay."""
    response: Any = None
    middle = result.load.speed
    progress.start("Speeds of the run-up", speeds.size)
    for speed in speeds:
        frequency = np.array(result.machine.phases.frequency) * abs(speed / middle)
        with collected(), single_blas_thread():
            response = harmonic_balance(result.system, frequency, start=response)
            response = by_engine(engine, response)
        yield result.signals_along(response)
        progress.advance()
    progress.finish()


def _levels_of_result(levels: MachineLevels, result: LoadResult) -> MachineLevels:
    """Levels with the modes of a result, and what its meshes excite."""
    labels = line_labels(result.machine)
    orders = tuple(o._replace(mesh=labels.get(o.mesh, o.mesh)) for o in result.mesh_orders)
    common = common_lines(levels, result.machine)
    return replace(levels, modes=result.modes, mesh_orders=orders, **common)  # type: ignore[arg-type]


def _periods(
    per_speed: float, ends: tuple[float, float], duration: float, hold: float, down: bool
) -> tuple[Array, Array]:
    """Speed and time in the middle of each period of the clock; the last one is completed."""
    corners = np.cumsum([0.0, duration, hold, duration * down])
    speeds = [ends[0], ends[1], ends[1], ends[0] if down else ends[1]]
    times, rows, now = [], [], 0.0
    while now < corners[-1]:
        period = 1.0 / (per_speed * float(np.interp(now, corners, speeds)))
        middle = now + 0.5 * period
        rows.append(float(np.interp(middle, corners, speeds)))
        times.append(middle)
        now += 1.0 / (per_speed * rows[-1])
    change = np.abs(np.diff(rows)).max(initial=0.0) / ends[0]
    if change > _COARSE:
        warn(
            "run-up-steps",
            f"the speed changes by {100.0 * change:.2g} % from one period of the clock to the next "
            f"({1.0 / (per_speed * ends[0]):.3g} s at the lowest speed), limit "
            f"{100.0 * _COARSE:g} %. Let it rise more slowly",
        )
    return np.array(rows), np.array(times)
