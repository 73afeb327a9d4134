"""Motion over time from a given start."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.dynamics.march import compile_for, march
from tribodyn.dynamics.response import Response, build_response
from tribodyn.dynamics.system import System
from tribodyn.errors import InputError, Problem
from tribodyn.progress import SILENT, Progress

__all__ = ["read_start", "simulate"]

Array = NDArray[np.float64]

#: Mesh cycles marched between two reports of progress.
_CHUNK = 64


def read_start(system: System, start: tuple[ArrayLike, ArrayLike]) -> Array:
    """Check a start and return it as one state.

    Parameters
    ----------
    system : System
    start : (position, velocity)
        Two (n,) arrays.

    Returns
    -------
    (2 n,) array

    Raises
    ------
    InputError
        If the shapes are wrong or a value is not finite.

    Examples
    --------
    >>> read_start(System([[1.0]], [[0.0]], [[1.0]], [0.0]), ([1.0], [0.0]))
    array([1., 0.])
    """
    try:
        parts = [np.broadcast_to(np.asarray(part, dtype=float), (system.size,)) for part in start]
        state = np.concatenate(parts)
    except (TypeError, ValueError) as error:
        raise InputError(
            Problem(
                what="start is not a pair (position, velocity)",
                where="argument start",
                why=f"Each of the two has the shape ({system.size},)",
            )
        ) from error
    if state.size != 2 * system.size or not np.all(np.isfinite(state)):
        raise InputError(
            Problem(
                what="start holds NaN or infinity, or is not a pair (position, velocity)",
                where="argument start",
                why=f"Each of the two has the shape ({system.size},)",
            )
        )
    return state


def simulate(
    system: System,
    mesh_frequency: float,
    cycles: int,
    start: tuple[ArrayLike, ArrayLike],
    *,
    steps: int = 512,
    extra_force: ArrayLike | None = None,
    progress: Progress = SILENT,
) -> Response:
    """March a system over time, every force held as given.

    Parameters
    ----------
    system : System
    mesh_frequency : float
        Mesh frequency [Hz].
    cycles : int
        Whole mesh cycles.
    start : (position, velocity)
        Two (n,) arrays [m or rad, m/s or rad/s].
    steps : int
        Steps per mesh cycle.
    extra_force : (n,) array, optional
        Constant generalized force on top of the system's [N or N*m].
    progress : Progress
        Told about every 64 cycles.

    Returns
    -------
    Response
        With ``cycles * steps`` rows.

    Raises
    ------
    InputError
        If an argument is out of range or the step is too long.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    Classical fourth-order Runge-Kutta steps on the event-aligned grid; a step in which a contact
    opens or closes is split there.

    Examples
    --------
    >>> free = System([[1.0]], [[0.0]], [[4.0]], [0.0])
    >>> motion = simulate(free, 1.0, 1, ([1.0], [0.0]), steps=256)
    >>> bool(abs(motion.position[128, 0] - np.cos(1.0)) < 1e-9)
    True
    """
    if int(cycles) != cycles or cycles < 1:
        raise InputError(
            Problem(what=f"cycles = {cycles}", where="argument cycles", why="A whole number >= 1")
        )
    compiled = compile_for(system, mesh_frequency, steps)
    extra = np.zeros(system.size) if extra_force is None else np.asarray(extra_force, dtype=float)
    state = read_start(system, start)[None, :]
    record = np.empty((cycles * steps + 1, 2 * system.size, 1))
    period = np.array([1.0 / mesh_frequency])
    progress.start("Marching over time", cycles)
    for first in range(0, cycles, _CHUNK):
        count = min(_CHUNK, cycles - first)
        part = record[first * steps : (first + count) * steps + 1]
        state = march(compiled, period, state, count, extra_force=extra[None, :], record=part)
        progress.advance(count)
    progress.finish()
    return build_response(compiled, mesh_frequency, record[:, :, 0], extra)
