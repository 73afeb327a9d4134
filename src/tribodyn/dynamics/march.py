"""From a compiled system to marched lanes: blocks, threads, and a step that is stable."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.dynamics.grid import Grid
from tribodyn.dynamics.program import Nodes, Program, compile_system, lane_load
from tribodyn.dynamics.step_limit import refuse_unstable_step
from tribodyn.dynamics.system import System
from tribodyn.errors import ComputationError, InputError, Problem, require_positive

__all__ = ["Compiled", "compile_for", "march"]

Array = NDArray[np.float64]

#: Lanes of one block. A single lane keeps everything in scalar registers.
_WIDTHS = (1, 16, 64)


@dataclass(frozen=True)
class Compiled:
    """A system on its grid, checked for one highest step size.

    Parameters
    ----------
    system : System
    grid : Grid
    nodes : Nodes
    program : Program
    step_number : float
        ``omega_max * dt`` of the slowest mesh frequency [-].
    """

    system: System
    grid: Grid
    nodes: Nodes
    program: Program
    step_number: float


def compile_for(system: System, mesh_frequency: ArrayLike, steps: int) -> Compiled:
    """Compile a system and refuse a step that the integrator cannot follow.

    Parameters
    ----------
    system : System
    mesh_frequency : float or (lanes,) array
        Mesh frequency [Hz].
    steps : int
        Steps per mesh cycle.

    Returns
    -------
    Compiled

    Raises
    ------
    InputError
        If an argument is out of range or ``omega_max * dt`` exceeds 2.7.

    Examples
    --------
    >>> system = System([[1.0]], [[0.0]], [[1.0]], [0.0])
    >>> round(compile_for(system, 1.0, 64).step_number, 6)
    0.015625
    """
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    if int(steps) != steps or steps < 1:
        raise InputError(
            Problem(what=f"steps = {steps}", where="argument steps", why="A whole number >= 1")
        )
    grid, nodes, program = compile_system(system, int(steps))
    slowest = float(np.min(np.asarray(mesh_frequency, dtype=float)))
    number = refuse_unstable_step(system, nodes, grid, slowest)
    return Compiled(system, grid, nodes, program, number)


def march(
    compiled: Compiled,
    period: Array,
    state: Array,
    cycles: int,
    *,
    extra_force: Array | None = None,
    record: Array | None = None,
    outputs: Array | None = None,
    waves: Array | None = None,
    moments: Array | None = None,
    width: int | None = None,
    threads: int | None = None,
) -> Array:
    """March lanes by whole mesh cycles; returns their new state.

    Parameters
    ----------
    compiled : Compiled
    period : (lanes,) array
        Mesh period [s].
    state : (lanes, 2 n) array
        Position and velocity.
    cycles : int
        Mesh cycles.
    extra_force : (lanes, n) array, optional
        Constant generalized force on top of the system's [N or N*m].
    record : (steps * cycles + 1, 2 n, lanes) array, optional
        Receives every state; single block only.
    outputs : (m, 2 n) array, optional
        Linear outputs for the statistics.
    waves : (steps, 3, harmonics, 2) array, optional
        Cosine and sine at the nodes; needed with ``moments``.
    moments : (signals, lanes) array, optional
        Every lane holds the moments before the first step; receives the statistics.
    width : int, optional
        Lanes per block; chosen by the number of lanes by default.
    threads : int, optional
        Blocks marched at a time; the number of processors by default.

    Returns
    -------
    (lanes, 2 n) array

    Raises
    ------
    ComputationError
        If a state grows beyond all bounds.
    """
    lanes, double = state.shape
    width = width or _choose_width(lanes)
    extra = np.zeros((lanes, double // 2)) if extra_force is None else extra_force
    load = lane_load(compiled.program, compiled.system, extra)
    new = np.empty_like(state)
    fresh = None if moments is None else moments[:, 0].copy()

    def block(first: int) -> int:
        # Lanes past the end repeat the last one, so that a block is always full.
        index = np.minimum(np.arange(first, first + width), lanes - 1)
        part = np.ascontiguousarray(state[index])
        own = None if fresh is None else np.repeat(fresh, width)
        failed = _march_block(
            compiled, period[index], load[index], part, cycles, record, outputs, waves, own
        )
        count = min(width, lanes - first)
        new[first : first + count] = part[:count]
        if own is not None and moments is not None:
            moments[:, first : first + count] = own.reshape(-1, width)[:, :count]
        return failed

    starts = range(0, lanes, width)
    threads = threads or os.cpu_count() or 1
    if len(starts) == 1 or threads == 1:
        failures = [block(first) for first in starts]
    else:
        with ThreadPoolExecutor(threads) as pool:
            failures = list(pool.map(block, starts))
    worst = max(failures)
    if worst >= 0:
        _report_divergence(compiled, worst)
    return new


def _choose_width(lanes: int) -> int:
    return _WIDTHS[0] if lanes < 4 else _WIDTHS[1] if lanes <= 32 else _WIDTHS[2]


def _march_block(
    compiled: Compiled,
    period: Array,
    load: Array,
    state: Array,
    cycles: int,
    record: Array | None,
    outputs: Array | None,
    waves: Array | None,
    moments: Array | None,
) -> int:
    from tribodyn.dynamics.marching import march_block

    program = compiled.program
    width, double = state.shape
    keep = np.zeros((0, double, width)) if record is None else record
    table = np.zeros(0) if waves is None else np.ascontiguousarray(waves).reshape(-1)
    linear = np.zeros((0, double)) if outputs is None else outputs
    harmonics = 0 if waves is None else waves.shape[2]
    work = np.zeros(program.slots.count * (width + 1) + 3 * int(program.code[2]))
    return int(
        march_block(
            (0.0,) * width, program.code, program.reads, program.rows, program.width,
            program.restart, work, np.ascontiguousarray(period), np.ascontiguousarray(load), state,
            cycles, keep, linear, table, harmonics, moments,
        )
    )  # fmt: skip


def _report_divergence(compiled: Compiled, step: int) -> None:
    steps = compiled.grid.steps
    raise ComputationError(
        Problem(
            what=f"the motion grew beyond all bounds within {step / steps:.1f} mesh cycles",
            why=f"omega_max*dt = {compiled.step_number:.3g} is within the stability limit of the "
            "integrator, so the system itself is unstable",
            remedy="Look for negative stiffness or damping, or friction that feeds energy in",
        )
    )
