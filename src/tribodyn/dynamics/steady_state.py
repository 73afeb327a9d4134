"""Periodic orbits: the steady state found directly, with a certified error.

The map of the state over the mesh cycles of one period has the orbit as its fixed point.
Anderson-accelerated iteration comes close, Newton's method with the full matrix of the map (the
monodromy matrix, one marched lane per column) finishes. The same matrix gives the Floquet
multipliers and the error: the residual alone understates the distance to the orbit by a factor
1/(1 - rho), where rho is the largest multiplier.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.dynamics.march import compile_for
from tribodyn.dynamics.orbit_map import OrbitMap
from tribodyn.dynamics.orbit_search import OrbitPoint, find_orbit
from tribodyn.dynamics.response import Response, build_response
from tribodyn.dynamics.simulate import read_start
from tribodyn.dynamics.start import static_start
from tribodyn.dynamics.system import System
from tribodyn.errors import InputError, Problem, warn
from tribodyn.progress import SILENT, Progress

__all__ = ["TOLERANCE", "steady_state"]

#: An orbit whose certified error is above this is not converged.
TOLERANCE = 1e-8
#: States one period apart that differ by less than this part of the motion are the same.
_REPEATS = 1e-5


def steady_state(
    system: System,
    mesh_frequency: float,
    *,
    steps: int = 512,
    periods: int = 1,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    tolerance: float = TOLERANCE,
    progress: Progress = SILENT,
) -> Response:
    """Find the periodic orbit of a system that runs at constant speed.

    Parameters
    ----------
    system : System
    mesh_frequency : float
        Mesh frequency [Hz].
    steps : int
        Steps per mesh cycle.
    periods : int
        Mesh cycles after which the motion repeats.
    start : (position, velocity), optional
        Two (n,) arrays from which to look [m or rad, m/s or rad/s]; the static equilibrium at
        mean stiffness by default.
    tolerance : float
        Largest certified error of a converged orbit.
    progress : Progress
        Told about the search.

    Returns
    -------
    Response
        With ``steps * periods`` rows, ``error``, ``converged``, ``stable``,
        ``floquet_multipliers`` and ``period``, the mesh cycles after which it repeats. A warning
        is issued when the orbit is not converged (``steady-state``) or not stable
        (``unstable-orbit``).

    Raises
    ------
    InputError
        If an argument is out of range, the step is too long or nothing can vibrate.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    With ``system.balance`` the size of the balancing torque is an unknown of the orbit and is
    returned in ``extra_force``; without it every force is held and the mean acceleration of the
    whole drive is left out of the orbit. With dead zones the start decides which of several
    orbits is found. If the search ends on an unstable orbit, it is repeated from beside it.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase))
    >>> steady_state(System([[1.0]], [[0.2]], [[0.0]], [1.0], [pair]), 1.0).converged
    True
    """
    if int(periods) != periods or periods < 1:
        raise InputError(
            Problem(what=f"periods = {periods}", where="argument periods", why="Whole number >= 1")
        )
    compiled = compile_for(system, mesh_frequency, steps)
    mapping = OrbitMap(compiled, mesh_frequency, int(periods))
    state = static_start(compiled) if start is None else read_start(system, start)
    y = mapping.coordinates.reduce(state)
    if y.size == 0:
        raise InputError(
            Problem(
                what="no coordinate is held by a spring, a damper or a contact",
                where="System.stiffness",
                why="Nothing vibrates, so that no periodic orbit exists",
                remedy="Use simulate for a free motion",
            )
        )
    if mapping.balance is not None:
        y = np.append(y, 0.0)
    progress.start("Searching the steady state", None)
    orbit = find_orbit(mapping, y, tolerance)
    progress.finish()
    return _finish(mapping, orbit, mesh_frequency, tolerance)


def _finish(mapping: OrbitMap, orbit: OrbitPoint, frequency: float, tolerance: float) -> Response:
    error = max(orbit.error, float(np.finfo(float).eps))
    converged = bool(np.isfinite(error) and error <= tolerance)
    if not converged:
        warn(
            "steady-state",
            f"no periodic orbit of {mapping.periods} mesh cycle(s) was found: certified error "
            f"{error:.2e}, limit {tolerance:.0e}. The motion may repeat after more cycles or "
            "never: try periods = 2, 3, 4 or march over time",
            stacklevel=3,
        )
    elif np.abs(orbit.multipliers[0]) > 1.0:
        warn(
            "unstable-orbit",
            f"the orbit exists but a motion leaves it: largest multiplier "
            f"{np.abs(orbit.multipliers[0]):.6g}, limit 1. Try other starts, periods = 2, 3, 4, "
            "or march over time",
            stacklevel=3,
        )
    states, extra = mapping.record(orbit.point)
    return build_response(
        mapping.compiled,
        frequency,
        states,
        extra,
        error=error,
        converged=converged,
        floquet_multipliers=orbit.multipliers,
        cycles_used=mapping.cycles,
        period=_shortest(mapping, states),
    )


def _shortest(mapping: OrbitMap, states: NDArray[np.float64]) -> int:
    """Mesh cycles after which a recorded orbit repeats: a divisor of those recorded."""
    steps, whole = mapping.compiled.grid.steps, mapping.periods
    reduced = mapping.coordinates.reduce(states[: whole * steps : steps])
    size = max(float(np.linalg.norm(mapping.coordinates.reduce(states), axis=1).max()), 1e-300)
    for count in range(1, whole):
        apart = np.linalg.norm(np.roll(reduced, count, axis=0) - reduced, axis=1).max()
        if whole % count == 0 and apart <= _REPEATS * size:
            return count
    return whole
