"""Motion of the structure of a case: engine, steps, steady state or transient."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import (
    ComputationError,
    InputError,
    ModelWarning,
    Problem,
    collected,
    warn,
)
from tribodyn.nomenclature import GEARS
from tribodyn.progress import Progress
from tribodyn.study.case.provenance import effective
from tribodyn.study.case.sections import AUTO, BALANCE, Solver
from tribodyn.study.case.to_models import mesh_law_of
from tribodyn.study.pipeline.cautions import tension_cautions
from tribodyn.study.pipeline.tooth_contact import repeat
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.study.case.pair import PairCase


#: Engine whose periodic orbits are solved directly.
_ORBITS = "runge-kutta-4"
#: Steps per mesh cycle of harmonic balance that is tried, and step error with which it is taken.
_TRIED, _FINE = 256, 1e-4
#: Change of the compression from one period to the next, over its size, that counts as none.
_REPEATS = 1e-8
#: Periods between two checks of that change, and largest number of mesh cycles.
_CYCLES_PER_CHECK, _MOST_CYCLES = 32, 4096
#: Steps of a transient that are stored in memory.
_MOST_ROWS = 2**19
#: Steps per mesh cycle of the motion of slow gears, and step error at which they suffice.
_BALANCED, _SETTLED = (2**11, 2**13, 2**15, 2**17), 1e-3
#: Why an automatic engine does not march slow gears.
_SLOW = "the gears are too slow to be marched"
#: Mesh cycles after which a steady motion may repeat.
_PERIODS = (1, 2, 3, 4)


def motion_of(
    case: PairCase, system: System, mesh_frequency: float, progress: Progress
) -> Response:
    """Compute the motion of a case."""
    from tribodyn.dynamics._engine.blocks import marching_on

    slow = slow_cautions(case, system, mesh_frequency)
    with marching_on(engine_arguments(case).get("backend")):
        if slow:
            steps_of(case, system, mesh_frequency)  # refuses those that no steps follow
            repeat(slow)
            response = _slow_motion(system, mesh_frequency, progress)
            response = replace(response, reason=_SLOW if case.solver.engine == AUTO else "")
        elif case.solver.method == "steady":
            response = _steady(case, system, mesh_frequency, progress)
        else:
            steps = steps_of(case, system, mesh_frequency)
            response = _transient(case, system, mesh_frequency, steps, progress)
            response = replace(response, reason=march_reason(case))
    if case.backlash == 0.0:
        force = response.contact_force.sum(axis=1)
        repeat(tension_cautions(force, linear=mesh_law_of(case) != "force-law"))
    return response


def motions_of(
    points: Sequence[tuple[PairCase, System, float]],
) -> list[Callable[[], Response] | None]:
    """Find motions of cases in batches; None for those that must be computed separately."""
    from tribodyn.dynamics.equations.batched_tables import cache_rates, group_by_structure
    from tribodyn.dynamics.orbits.batched_orbits import orbits_in_touch

    for group in group_by_structure([system for _, system, _ in points]):
        with suppress(InputError), collected():
            cache_rates([points[number][1] for number in group])
    by_steps: dict[int, list[int]] = {}
    for number, (case, system, frequency) in enumerate(points):
        if _solves_orbits(case) and not slow_cautions(case, system, frequency):
            with suppress(InputError), collected():  # its separate run reports the error
                by_steps.setdefault(steps_of(case, system, frequency), []).append(number)
    samplers: list[Callable[[], Response] | None] = [None] * len(points)
    for steps, numbers in by_steps.items():
        systems, frequencies = zip(*(points[number][1:] for number in numbers), strict=True)
        orbits = orbits_in_touch(systems, np.array(frequencies), steps)
        for number, orbit in zip(numbers, orbits, strict=True):
            samplers[number] = orbit
    return samplers


def _transient(
    case: PairCase, system: System, mesh_frequency: float, steps: int, progress: Progress
) -> Response:
    """Simulate from the static equilibrium; a balancing torque is that of the steady state."""
    from tribodyn.dynamics import simulate, steady_state
    from tribodyn.dynamics.equations.compiled import compile_for
    from tribodyn.dynamics.equations.orbit_coordinates import static_start

    cycles = effective(case)["solver.cycles"]
    extra = None
    if system.balance is not None:
        with collected():
            extra = steady_state(system, mesh_frequency, steps=steps).extra_force
    state = static_start(compile_for(system, mesh_frequency, steps))
    start = (state[: system.size], state[system.size :])
    stored_cycles = max(1, _MOST_ROWS // steps)
    if stored_cycles < cycles:
        warn(
            "transient-kept",
            f"the last {stored_cycles} of {cycles} mesh cycles with {steps} steps are stored; the "
            f"summary covers {stored_cycles - stored_cycles // 2} of them. A shorter run is stored "
            "completely",
        )
    return simulate(
        system,
        mesh_frequency,
        cycles,
        start,
        steps=steps,
        extra_force=extra,
        recorded_cycles=stored_cycles,
        progress=progress,
        **engine_arguments(case),
    )


def engine_arguments(case: PairCase) -> Tree:
    """Engine of a case and its options, as arguments of :func:`tribodyn.dynamics.simulate`."""
    from tribodyn.dynamics import ENGINES

    engine, values = ENGINES[case.solver.engine], effective(case)
    return engine.arguments({name: values[f"solver.{name}"] for name in engine.options})


def _solves_orbits(case: PairCase, *engines: str) -> bool:
    """Whether the orbit itself is the motion of a case, by default with its engine."""
    steady = case.solver.method == "steady" and case.solver.engine in (_ORBITS, *engines)
    return steady and engine_arguments(case).get("backend") in (None, "cpu")


def slow_cautions(
    case: PairCase, system: System, mesh_frequency: float
) -> tuple[ModelWarning, ...]:
    """Return a warning on gears so slow that their motion is not integrated over time."""
    from tribodyn.dynamics.equations.step_limit import MOST, needed_steps, rate_on_grid

    needed = needed_steps(rate_on_grid(system), mesh_frequency)
    if needed <= MOST or case.solver.steps_per_mesh_cycle or not _solves_orbits(case, AUTO):
        return ()
    text = (
        f"operation.speed = {_speed(case.operation.speed)} is so low that an integration over time "
        f"needs {needed:.3g} steps per mesh cycle; an automatic choice takes at most {MOST}. The "
        "motion is found by harmonic balance, without Floquet multipliers. For an integration "
        f"give solver.{_STEPS}"
    )
    return (ModelWarning("slow-speed", text),)


def _slow_motion(system: System, mesh_frequency: float, progress: Progress) -> Response:
    """Motion by harmonic balance with as many steps as slow gears need."""
    from tribodyn.dynamics import harmonic_balance

    motion = None
    for steps in _BALANCED:
        with collected() as model_warnings:
            motion = harmonic_balance(system, mesh_frequency, steps=steps, progress=progress)
        if motion.step_error <= _SETTLED:
            break
    repeat(model_warnings)
    assert motion is not None
    return motion


def march_reason(case: PairCase) -> str:
    """Why an automatic engine marches, as far as the case shows it; empty if it may not."""
    if case.solver.engine != AUTO:
        return ""
    if case.solver.method != "steady":
        return "a motion over time is marched"
    if (law := mesh_law_of(case)) != "force-law":
        return f'one spring with mesh_law = "{law}" is marched faster'
    return ""


def by_engine(engine: str, response: Response) -> Response:
    """The motion, if harmonic balance has found it or the engine leaves the march to stand in."""
    if engine == AUTO or response.converged:
        return response
    why = "Harmonic balance finds motions that repeat; a march stands in for others"
    remedy = f'Set engine = "{AUTO}", or add damping'
    what = f"no periodic motion was found: error {response.error:.2e}"
    raise ComputationError(Problem(what, "solver.engine", why, remedy))


def engine_remark(case: PairCase) -> str:
    """What an automatic engine does, before the motion is computed."""
    if reason := march_reason(case):
        return f'engine = "auto" marches: {reason}.'
    return (
        'engine = "auto" takes harmonic balance if it finds a stable motion of teeth in touch '
        f"with a step error of at most {_FINE:g}, and marches otherwise."
    )


def may_balance(case: PairCase) -> bool:
    """Whether harmonic balance comes first."""
    return case.solver.engine == BALANCE or (case.solver.engine == AUTO and not march_reason(case))


def _steady(case: PairCase, system: System, mesh_frequency: float, progress: Progress) -> Response:
    """Periodic motion by the engine of a case."""
    reason, engine = march_reason(case), case.solver.engine
    if may_balance(case):
        with collected() as model_warnings:
            response, reason = _balanced(case, system, mesh_frequency, progress)
        if response is not None:
            repeat(model_warnings)
            return replace(response, reason=reason)
    steps = steps_of(case, system, mesh_frequency)
    response = _orbit(system, mesh_frequency, steps, progress)
    if engine not in (_ORBITS, AUTO):
        response = _marched_orbit(case, system, response, steps, progress)
    return replace(response, reason=reason)


def _balanced(
    case: PairCase, system: System, mesh_frequency: float, progress: Progress
) -> tuple[Response | None, str]:
    """Motion by harmonic balance, or None if it is not fit, and why."""
    from tribodyn.dynamics import harmonic_balance

    engine, steps = case.solver.engine, case.solver.steps_per_mesh_cycle
    if engine == AUTO:
        steps = steps or _TRIED
    response = harmonic_balance(
        system, mesh_frequency, steps=steps, stability=True, progress=progress
    )
    if not response.stable:
        multipliers = np.abs(response.floquet_multipliers)
        value = f"largest multiplier {multipliers.max():.4g}" if multipliers.size else "none found"
        reason = f"no stable motion repeats after a mesh cycle: {value}"
        if engine == BALANCE:
            why = "Harmonic balance finds motions of one mesh cycle"
            remedy = f'Choose engine = "{AUTO}" or "{_ORBITS}", or add damping'
            raise ComputationError(Problem(reason, "solver.engine", why, remedy))
        return None, reason
    if engine == BALANCE:
        return response, ""
    error = f"{response.step_error:.1e} of the motion"
    if not response.step_error <= _FINE:
        return None, f"harmonic balance errs by {error} with {steps} steps, limit {_FINE:.0e}"
    if np.any(response.contact_force.sum(axis=1) <= 0.0):
        return None, "the teeth part, so that several motions may exist"
    return response, f"it is faster with a force law and errs by {error}"


def _orbit(system: System, mesh_frequency: float, steps: int, progress: Progress) -> Response:
    """Return the first stable orbit among those of one to four mesh cycles."""
    from tribodyn.dynamics import steady_state

    for periods in _PERIODS:
        with collected() as model_warnings:
            orbit = steady_state(
                system, mesh_frequency, steps=steps, periods=periods, progress=progress
            )
        if orbit.converged and orbit.stable:
            repeat(model_warnings)
            if periods > 1:
                warn("subharmonic", f"the motion repeats only after {periods} mesh cycles")
            return orbit
    raise ComputationError(_lost(orbit))


def _marched_orbit(
    case: PairCase, system: System, orbit: Response, steps: int, progress: Progress
) -> Response:
    """Continue from an orbit with the engine of the case until its motion repeats."""
    from tribodyn.dynamics import simulate

    frequency, cycles = orbit.mesh_frequency, orbit.periods
    extra = orbit.extra_force if orbit.extra_force.size else None
    state, change, marched = (orbit.position[0], orbit.velocity[0]), np.inf, 0
    while marched < _MOST_CYCLES:
        motion = simulate(
            system,
            frequency,
            _CYCLES_PER_CHECK * cycles,
            state,
            steps=steps,
            extra_force=extra,
            progress=progress,
            **engine_arguments(case),
        )
        marched += _CYCLES_PER_CHECK * cycles
        last, before = motion.deflection[-cycles * steps :], motion.deflection[: -cycles * steps]
        size = float(np.abs(last).max())
        change = float(np.abs(last - before[-cycles * steps :]).max()) / size
        state = (motion.position[-cycles * steps], motion.velocity[-cycles * steps])
        if change < _REPEATS:
            break
    else:
        raise ComputationError(_restless(case, marched, change))
    last_cycles = simulate(
        system, frequency, cycles, state, steps=steps, extra_force=extra, **engine_arguments(case)
    )
    return replace(
        last_cycles,
        error=change,
        converged=True,
        floquet_multipliers=orbit.floquet_multipliers,
        cycles_used=orbit.cycles_used + marched,
        search_cycles=orbit.search_cycles,
        period=orbit.period,
        extra_force=orbit.extra_force,
    )


def _restless(case: PairCase, cycles: int, change: float) -> Problem:
    engine = case.solver.engine
    return Problem(
        f'the motion still changes by {change:.2e} of its size after {cycles} mesh cycles of "'
        f'{engine}"',
        "solver.engine",
        "This engine continues from the Runge-Kutta orbit until its motion repeats",
        f'Take the orbit itself with engine = "{_ORBITS}", add damping, or choose method = '
        '"transient"',
    )


def _lost(orbit: Response) -> Problem:
    multiplier = abs(orbit.floquet_multipliers[0]) if orbit.floquet_multipliers.size else 0.0
    return Problem(
        f"no stable motion repeats within {_PERIODS[-1]} mesh cycles: error {orbit.error:.2e}, "
        f"largest multiplier {multiplier:.4g}",
        "solver.method",
        "The motion repeats after more cycles, or never",
        'Look at it over time with solver.method = "transient", or add damping',
    )


_STEPS = "steps_per_mesh_cycle"
#: Margin of the least speed that is recommended.
_MARGIN = 1.05


def steps_of(case: PairCase, system: System, mesh_frequency: float) -> int:
    """Return the requested steps per mesh cycle, or those that resolve the fastest motion."""
    from tribodyn.dynamics.equations.step_limit import LIMIT, accurate_steps, rate_on_grid

    spec = Solver.spec(_STEPS)
    high = spec.high if spec else float("inf")
    rate = rate_on_grid(system)
    needed = rate / (LIMIT * mesh_frequency)
    if needed > high:
        raise InputError(_too_slow(case, needed, high))
    return case.solver.steps_per_mesh_cycle or accurate_steps(rate, mesh_frequency)


def _too_slow(case: PairCase, needed: float, high: float) -> Problem:
    speed = case.operation.speed
    return Problem(
        f"speed = {_speed(speed)} needs {needed:.3g} steps per mesh cycle",
        f"argument {GEARS[0]}_speed",
        f"The structure vibrates so fast within one slow mesh cycle; {high:.0f} steps are the most",
        f"The least speed that works is {_speed(_MARGIN * speed * needed / high)}; slower gears "
        "carry their load statically",
    )


def _speed(speed: float) -> str:
    from tribodyn import units

    return f"{units.convert(speed, 'rad/s', 'rpm'):.3g} rpm"
