"""Motion over time from a start, with any of the engines."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.aliases import with_old_names
from tribodyn.dynamics._engine.adaptive_engine import Tolerance
from tribodyn.dynamics._engine.blocks import Backend
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.engines import Method, Setting, automatic_method, engine_name, prepare
from tribodyn.dynamics.time.response import Response, build_response, later
from tribodyn.errors import Argument, InputError, real_numbers, require_positive
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array

#: Mesh cycles between two reports of progress.
_CHUNK = 64


def read_start(
    system: System, start: tuple[ArrayLike, ArrayLike], lanes: int | None = None
) -> Array:
    """Check a start and return it as one state (2 n,), or as the states of all lanes."""
    size, several = system.size, f" or ({lanes}, {system.size})" if lanes else ""
    try:
        parts = [np.broadcast_to(np.asarray(part, float), (lanes or 1, size)) for part in start]
        state = np.ascontiguousarray(np.concatenate(parts, axis=1))
    except (TypeError, ValueError):
        state = np.zeros((0, 0))
    if state.shape != (lanes or 1, 2 * size) or not np.all(np.isfinite(state)):
        what = "start holds NaN or infinity, or is not a pair (position, velocity)"
        why = f"Each of the two has the shape ({size},){several}"
        raise InputError(what, "argument start", why, "Give (position, velocity), both finite")
    return state if lanes else state[0]


def read_force(system: System, extra_force: ArrayLike | None) -> Array:
    """Check an extra force; None means zero."""
    if extra_force is None:
        return np.zeros(system.size)
    force = real_numbers(Argument("extra_force"), extra_force)
    if force.shape != (system.size,) or not np.all(np.isfinite(force)):
        what = f"extra_force has the shape {force.shape}, or holds NaN or infinity"
        why = f"One finite force for each coordinate: ({system.size},)"
        remedy = "Give one finite force for each coordinate"
        raise InputError(what, Argument("extra_force"), why, remedy)
    return force


@with_old_names
def simulate(
    system: System,
    mesh_frequency: float,
    cycles: int,
    start: tuple[ArrayLike, ArrayLike],
    *,
    steps: int = 512,
    extra_force: ArrayLike | None = None,
    recorded_cycles: int | None = None,
    progress: Progress = SILENT,
    method: Method | None = None,
    rtol: float | None = None,
    atol: Tolerance | None = None,
    gamma: float | None = None,
    beta: float | None = None,
    preset: str | None = None,
    backend: Backend | None = None,
) -> Response:
    """Integrate a system over time with prescribed forces.

    Parameters
    ----------
    system : System
    mesh_frequency : float
        Mesh frequency; of contacts with several cycles, the frequency of the clock [Hz].
    cycles : int
        Whole mesh cycles.
    start : (position, velocity)
        Two (n,) arrays [m or rad, m/s or rad/s].
    steps : int
        Steps per mesh cycle; with "dormand-prince" rows of the response per mesh cycle.
    extra_force : (n,) array, optional
        Constant generalized force on top of the system's [N or N*m].
    recorded_cycles : int, optional
        Number of the last mesh cycles that are recorded; all of them by default.
    progress : Progress
        Receives the progress every 64 cycles.
    method : "rk4", "dormand-prince", "newmark" or "modal", optional
        Classical Runge-Kutta steps; adaptive steps of Dormand and Prince; Newmark's scheme; exact
        steps of every linear mode. "rk4" by default, "modal" above 24 coordinates.
    rtol : float, optional
        For "dormand-prince": error over the largest size so far of each state, 1e-6 by default [-].
    atol : float, (position, velocity) or (2 n,) array, optional
        For "dormand-prince": error allowed on top of that [m or rad, m/s or rad/s]; by default
        0.001 ``rtol`` times the size of the static state.
    gamma, beta : float, optional
        For "newmark": its parameters, 1/2 and 1/4 (average acceleration) by default [-].
    preset : str, optional
        For "newmark": "average acceleration", "linear acceleration", "central difference" or "seed"
        (1/2, 1/2) instead of the two numbers.
    backend : "cpu" or "cuda", optional
        For "rk4": the processor; see :func:`simulate_ensemble`.

    Returns
    -------
    Response
        With ``cycles * steps`` rows, or ``recorded_cycles * steps``.

    Raises
    ------
    InputError
        If an argument is out of range or belongs to another method, or the step is too long.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    All methods use the event-aligned grid: events are ends of steps, and a step in which a contact
    opens or closes is split there. The rows of "dormand-prince" are its dense output; the accuracy
    of means and harmonics of the response depends on ``steps``.

    Examples
    --------
    >>> free = System([[1.0]], [[0.0]], [[4.0]], [0.0])
    >>> motion = simulate(free, 1.0, 1, ([1.0], [0.0]), steps=256)
    >>> bool(abs(motion.position[128, 0] - np.cos(1.0)) < 1e-9)
    True
    """
    require_whole("cycles", cycles)
    require_number("mesh_frequency", mesh_frequency)
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    extra = read_force(system, extra_force)
    state = read_start(system, start)[None, :]
    frequency = np.array([float(mesh_frequency)])
    setting = Setting(system, frequency, cycles, steps, extra[None, :])
    options = {"rtol": rtol, "atol": atol, "gamma": gamma, "beta": beta, "preset": preset}
    chosen = automatic_method(system) if method is None and backend is None else method or "rk4"
    marcher = prepare(chosen, setting, **options, backend=backend)
    if recorded_cycles is None:
        recorded_cycles = cycles
    skipped = cycles - min(require_whole("recorded_cycles", recorded_cycles), cycles)
    rows = marcher.compiled.grid.steps
    record = np.empty(((cycles - skipped) * rows + 1, 2 * system.size, 1))
    progress.start("Mesh cycles", cycles)
    elapsed = 0
    while elapsed < cycles:
        count = min(_CHUNK, (skipped if elapsed < skipped else cycles) - elapsed)
        first = (elapsed - skipped) * rows
        part = record[first : first + count * rows + 1] if elapsed >= skipped else None
        state = marcher.march(state, count, record=part, elapsed=elapsed)
        elapsed += count
        progress.advance(count)
    progress.finish()
    progress.start("Forces along the motion")
    name, states = engine_name(chosen), record[:, :, 0]
    response = build_response(marcher.compiled, mesh_frequency, states, extra, engine=name)
    progress.finish()
    return later(response, skipped / mesh_frequency)
