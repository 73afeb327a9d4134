"""Periodic orbits: the steady state computed directly, with a certified error.

The map of the state over the mesh cycles of one period has the orbit as its fixed point. Newton's
method with the full matrix of the map (the monodromy matrix, one lane per column) finds it: after
integrated cycles where dead zones allow several orbits, and after Anderson-accelerated iteration
where the motion does not settle. The same matrix gives the Floquet
multipliers and the error: the residual alone understates the distance to the orbit by a factor
1/(1 - rho), where rho is the largest multiplier.
"""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.nodes import halved_nodes
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.program import build_program
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.harmonic_balance import (
    STEP_LIMIT,
    TOLERANCE,
    harmonic_balance,
)
from tribodyn.dynamics.modal.modal_march import compile_motion
from tribodyn.dynamics.orbits.orbit_map import OrbitMap, newton_step
from tribodyn.dynamics.orbits.periods import find_any_orbit, shortest_period
from tribodyn.dynamics.orbits.search import OrbitPoint, find_orbit, finish_orbit, motion_size
from tribodyn.dynamics.time.engines import automatic_method
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import warn
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array

#: Steps per mesh cycle of the orbit by time integration.
_STEPS = 512


def steady_state(
    system: System,
    mesh_frequency: float,
    *,
    steps: int = _STEPS,
    periods: int | Literal["auto"] = 1,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    tolerance: float = TOLERANCE,
    progress: Progress = SILENT,
) -> Response:
    """Find the periodic orbit of a system that runs at constant speed.

    Parameters
    ----------
    system : System
    mesh_frequency : float
        Mesh frequency; of contacts with several cycles, the frequency of the clock [Hz].
    steps : int
        Steps per mesh cycle, of the contact with the most cycles. Harmonic balance takes 512, the
        default, as no choice, and as many as the accuracy needs.
    periods : int or "auto"
        Mesh cycles after which the motion repeats. With ``"auto"`` the motion from the start is
        followed, and the stable orbit of up to 8 mesh cycles that it approaches is returned.
    start : (position, velocity), optional
        Two (n,) arrays from which the search starts [m or rad, m/s or rad/s]; the static
        equilibrium at mean stiffness by default.
    tolerance : float
        Largest certified error of a converged orbit.
    progress : Progress
        Receives the progress of the search.

    Returns
    -------
    Response
        With ``steps * periods`` rows, ``error``, ``step_error``, ``converged``, ``stable``,
        ``floquet_multipliers`` and ``period``, the mesh cycles after which it repeats. A warning
        is issued when the orbit is not converged (``steady-state``) or not stable
        (``unstable-orbit``), when the orbit at half the step differs by more than 1 % of its size
        (``step-size``), or when the forces accelerate the whole drive (``unbalanced-drive``).

    Raises
    ------
    InputError
        If an argument is out of range, the step is too long or nothing can vibrate.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    With ``system.balance`` the size of the balancing torque is an unknown of the orbit and is
    returned in ``extra_force``; without it the forces are as prescribed and the mean acceleration
    of the whole drive is left out of the orbit. With dead zones the start decides which of several
    orbits is found. If the search ends on an unstable orbit, it is repeated from a point near it.
    Orbits of one period of systems with more than 24 coordinates are those of
    :func:`harmonic_balance`; ``engine`` of the response names the method.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase))
    >>> steady_state(System([[1.0]], [[0.2]], [[0.0]], [1.0], [pair]), 1.0).converged
    True
    """
    count = _whole_periods(periods)
    require_number("mesh_frequency", mesh_frequency)
    require_number("tolerance", tolerance)
    if count == 1 and automatic_method(system) == "modal":
        chosen = None if steps == _STEPS else steps
        options: dict[str, Any] = {"steps": chosen, "start": start, "tolerance": tolerance}
        return harmonic_balance(
            system, mesh_frequency, **options, stability=True, progress=progress
        )
    compiled = compile_motion(system, mesh_frequency, steps)
    mapping = OrbitMap(compiled, mesh_frequency, count or 1)
    state = static_start(compiled) if start is None else read_start(system, start)
    y = mapping.start(state)
    progress.start("Steady motion", None)
    if count is None:
        any_orbit = find_any_orbit(mapping, y, tolerance)
        mapping, orbit, recurrence = any_orbit.mapping, any_orbit.orbit, any_orbit.recurrence
        mapping.cycles = any_orbit.cycles
    else:
        orbit, recurrence = find_orbit(mapping, y, tolerance), np.zeros(0)
    progress.finish()
    return _finish(mapping, orbit, mesh_frequency, tolerance, recurrence)


def _whole_periods(periods: int | str) -> int | None:
    """Check the number of mesh cycles; None means "auto"."""
    if isinstance(periods, str) and periods == "auto":
        return None
    return require_whole("periods", periods, why='"auto", or')


def _step_message(mapping: OrbitMap, cost: float) -> str:
    steps, number = mapping.compiled.grid.steps, mapping.compiled.step_number
    finding = (
        f"the motion differs from that at half the step by {100.0 * cost:.2g} % of its size"
        if np.isfinite(cost)
        else "this motion does not exist at half the step"
    )
    return (
        f"{finding}, limit {100.0 * STEP_LIMIT:g} %: {steps} steps per mesh cycle, omega_max*dt = "
        f"{number:.3g}. Use {2 * steps} steps or more"
    )


def _advice(mapping: OrbitMap, recurrence: Array) -> str:
    """Diagnosis and remedy where no stable orbit was found."""
    if np.isinf(recurrence).any():
        return "The motion itself was integrated further and grows without bounds"
    if recurrence.size:
        listed = ", ".join(f"{value:.1e}" for value in recurrence)
        return (
            f"The motion itself was integrated further: its distance from itself 1 to "
            f"{recurrence.size} mesh cycles earlier is {listed} of its size. It has a longer "
            "period, is quasi-periodic or chaotic: check with tribodyn.analysis.lyapunov_exponents"
        )
    if mapping.affine:
        return "The system is linear, so its motion grows without bounds"
    return (
        'Try periods = "auto" and other starts; if no orbit of up to 8 mesh cycles is stable, '
        "simulate over time, and check for chaos with tribodyn.analysis.lyapunov_exponents"
    )


def _finish(
    mapping: OrbitMap, orbit: OrbitPoint, frequency: float, tolerance: float, recurrence: Array
) -> Response:
    error = max(orbit.error, float(np.finfo(float).eps))
    converged = bool(np.isfinite(error) and error <= tolerance)
    if not converged:
        warn(
            "steady-state",
            f"no periodic orbit of {mapping.periods} mesh cycle(s) was found: certified error "
            f"{error:.2e}, limit {tolerance:.0e}. {_advice(mapping, recurrence)}",
            stacklevel=3,
        )
    elif np.abs(orbit.multipliers[0]) > 1.0:
        warn(
            "unstable-orbit",
            f"the orbit is unstable: largest Floquet multiplier "
            f"{np.abs(orbit.multipliers[0]):.6g}, limit 1. {_advice(mapping, recurrence)}",
            stacklevel=3,
        )
    states, extra = mapping.without_drift(orbit.states.copy()), mapping.split(orbit.point)[1][0]
    cost = step_error(mapping, orbit) if converged else float("nan")
    if cost > STEP_LIMIT:
        warn("step-size", _step_message(mapping, cost), stacklevel=3)
    return build_response(
        mapping.compiled,
        frequency,
        states,
        extra,
        error=error,
        step_error=cost,
        converged=converged,
        floquet_multipliers=orbit.multipliers,
        cycles_used=mapping.cycles,
        search_cycles=orbit.search,
        period=shortest_period(mapping, states),
    )


#: Iterations with the matrix of the coarse orbit, and the largest part of the way of the last one.
ROUNDS, CLOSE = 6, 0.02
#: An orbit this far away, over its size, is another one.
OTHER = 0.5


def step_error(mapping: OrbitMap, orbit: OrbitPoint) -> float:
    """Largest distance of an orbit to that at half the step, over its size; infinite if none."""
    # The scheme is of fourth order: the orbit at half the step is sixteen times as near to that of
    # the equations, and so near to this one that few periods lead to it.
    fine = copy(mapping)
    system = mapping.compiled.system
    grid, nodes = halved_nodes(system, mapping.compiled.grid, mapping.compiled.nodes)
    fine.compiled = replace(
        mapping.compiled,
        grid=grid,
        nodes=nodes,
        program=build_program(system, grid, nodes),
        parameters=None,
        step_number=0.5 * mapping.compiled.step_number,
    )
    point, way = orbit.point, np.inf
    for _ in range(ROUNDS):
        image, states = fine.follow(point)
        step = newton_step(orbit.matrix, image - point)[0]
        last, way = way, float(np.linalg.norm(step))
        moved = float(np.linalg.norm(point + step - orbit.point))
        if not way < 0.5 * last or moved > OTHER * orbit.scale:
            break
        point = point + step
        if way <= CLOSE * moved or way <= 1e-9 * orbit.scale:
            if orbit.linear:  # The remaining distance shifts both motions by the same amount.
                offset = orbit.slopes.reshape(-1, step.size) @ step
                return _distance(mapping, orbit, states[::2] + offset.reshape(orbit.states.shape))
            return _distance(mapping, orbit, fine.follow(point)[1][::2])
    fine_orbit = finish_orbit(fine, orbit.point, 1e-6)
    same = np.linalg.norm(fine_orbit.point - orbit.point) <= OTHER * orbit.scale
    if not (same and fine_orbit.error <= 1e-6):
        return float("inf")
    return _distance(mapping, orbit, fine_orbit.states[::2])


def _distance(mapping: OrbitMap, orbit: OrbitPoint, states: Array) -> float:
    """Largest distance at the ends of the full steps, without free motions of the drive."""
    size = motion_size(mapping, states)
    coarse, fine = (mapping.coordinates.reduce(part) for part in (orbit.states, states))
    return float(np.linalg.norm(fine - coarse, axis=1).max()) / size
