"""Newmark's scheme on the event-aligned grid: average acceleration by default.

Second order where the other engines have four or more, but stable at any step where ``2 beta >=
gamma >= 1/2``: for stiff supports whose own motion does not matter, and for comparison with
published results.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.dynamics.march import Compiled
from tribodyn.dynamics.newmark_tables import NewmarkTables, newmark_tables
from tribodyn.dynamics.program import Nodes, compile_system
from tribodyn.dynamics.step_limit import largest_rate
from tribodyn.dynamics.system import System
from tribodyn.errors import ComputationError, InputError, Problem, require_positive

__all__ = ["NEWMARK_PRESETS", "compile_newmark", "march_newmark"]

Array = NDArray[np.float64]

#: Named pairs (gamma, beta). "seed" is what a source prints as "lambda = beta = 0.5" if that is
#: taken in the notation used here; in the notation where it means average acceleration it is
#: "average acceleration".
NEWMARK_PRESETS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "average acceleration": (0.5, 0.25),
        "linear acceleration": (0.5, 1.0 / 6.0),
        "central difference": (0.5, 0.0),
        "seed": (0.5, 0.5),
    }
)

#: Lanes of one block.
_WIDTHS = (1, 16)
#: Below this tolerance the iteration would chase rounding.
_FINEST = 1e-14
#: A state above this has grown beyond all bounds; contact forces are then not to blame.
_HUGE = 1e100


def compile_newmark(
    system: System,
    mesh_frequency: ArrayLike,
    steps: int,
    *,
    gamma: float = 0.5,
    beta: float = 0.25,
) -> Compiled:
    """Compile a system for :func:`march_newmark`: no step is too long for a stable scheme.

    Parameters
    ----------
    system : System
    mesh_frequency : float or (lanes,) array
        Mesh frequency [Hz].
    steps : int
        Steps per mesh cycle.
    gamma, beta : float
        Parameters of the scheme [-].

    Returns
    -------
    Compiled
        Its ``step_number`` states ``omega_max * dt``, however large.

    Raises
    ------
    InputError
        If an argument is out of range, or the scheme is only conditionally stable and the step is
        beyond its limit.

    Examples
    --------
    >>> stiff = System([[1.0]], [[0.0]], [[1e8]], [0.0])
    >>> round(compile_newmark(stiff, 1.0, 64).step_number, 3)
    156.25
    """
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    if int(steps) != steps or steps < 1:
        raise InputError(
            Problem(what=f"steps = {steps}", where="argument steps", why="A whole number >= 1")
        )
    grid, nodes, program = compile_system(system, int(steps))
    slowest = float(np.min(np.asarray(mesh_frequency, dtype=float)))
    number = largest_rate(system, nodes) * float(grid.width.max()) / slowest
    compiled = Compiled(system, grid, nodes, program, number)
    _refuse(compiled, 1.0 / slowest, gamma, beta)
    return compiled


def _undamped_rate(system: System, nodes: Nodes) -> float:
    """Highest natural frequency with all contacts closed [rad/s]."""
    still = replace(system, damping=np.zeros((system.size, system.size)))
    return largest_rate(still, nodes._replace(damping=np.zeros_like(nodes.damping)))


def _refuse(compiled: Compiled, longest: float, gamma: float, beta: float) -> None:
    """Refuse parameters, or a step that is beyond the limit of a conditionally stable scheme."""
    if not (np.isfinite(gamma) and np.isfinite(beta) and gamma >= 0.5 and beta >= 0.0):
        raise InputError(
            Problem(
                what=f"gamma = {gamma:g}, beta = {beta:g}",
                where="arguments gamma, beta",
                why="With gamma < 1/2 the scheme feeds energy in at any step; beta < 0 has no "
                "meaning",
                remedy="Average acceleration is gamma = 0.5, beta = 0.25",
            )
        )
    if compiled.members:
        raise InputError(
            Problem(
                what=f"{len(compiled.members)} different systems",
                where="argument compiled",
                why="Newmark's scheme marches lanes of one system",
                remedy="Compile each system by itself",
            )
        )
    if 2.0 * beta >= gamma:
        return
    limit = 1.0 / math.sqrt(0.5 * gamma - beta)
    grid = compiled.grid
    rate = _undamped_rate(compiled.system, compiled.nodes)
    number = rate * float(grid.width.max()) * longest
    if number > limit:
        needed = int(np.ceil(grid.steps * number / limit / 64.0)) * 64
        raise InputError(
            Problem(
                what=f"omega*dt = {number:.4g} with {grid.steps} steps per mesh cycle at "
                f"{1.0 / longest:g} Hz and a highest natural frequency of {rate:.4g} rad/s",
                where="argument steps",
                why=f"With gamma = {gamma:g} and beta = {beta:g} the limit is "
                f"1/sqrt(gamma/2 - beta) = {limit:.4g}; any step is stable only with 2 beta >= "
                "gamma",
                remedy=f"Use at least {needed} steps per mesh cycle, or gamma = 0.5, beta = 0.25",
            )
        )


def march_newmark(
    compiled: Compiled,
    period: Array,
    state: Array,
    cycles: int,
    *,
    gamma: float = 0.5,
    beta: float = 0.25,
    tolerance: float = 1e-12,
    extra_force: Array | None = None,
    record: Array | None = None,
    threads: int | None = None,
) -> Array:
    """March lanes by whole mesh cycles with Newmark's scheme; returns their new state.

    Parameters
    ----------
    compiled : Compiled
        From :func:`compile_newmark`, or ``compile_for`` of the Runge-Kutta engine.
    period : (lanes,) array
        Mesh period [s].
    state : (lanes, 2 n) array
        Position and velocity.
    cycles : int
        Mesh cycles.
    gamma, beta : float
        Parameters of the scheme [-]; :data:`NEWMARK_PRESETS` names some.
    tolerance : float
        Largest last correction of the contact forces, relative to them [-].
    extra_force : (lanes, n) array, optional
        Constant generalized force on top of the system's [N or N*m].
    record : (steps * cycles + 1, 2 n, lanes) array, optional
        Receives every state.
    threads : int, optional
        Blocks marched at a time; the number of processors by default.

    Returns
    -------
    (lanes, 2 n) array

    Raises
    ------
    InputError
        If gamma, beta or the tolerance are out of range, or the step is beyond the limit
        ``omega * dt = 1/sqrt(gamma/2 - beta)`` of a scheme with ``2 beta < gamma``.
    ComputationError
        If a state grows beyond all bounds or the contact forces are not found; with the time, and
        the coordinate that moved most.

    Notes
    -----
    The acceleration is found anew at every event and contact change, and a step in which a contact
    opens or closes is split there: the scheme keeps its second order. Between contact changes the
    equations of one step are linear and the second pass of Newton's method confirms the first.
    ``gamma > 1/2`` adds damping and leaves first order. Source: Newmark (1959); Hughes (1987),
    The finite element method, section 9.1, for the limits.

    Examples
    --------
    >>> free = System([[1.0]], [[0.0]], [[4.0]], [0.0])
    >>> compiled = compile_newmark(free, 1.0, 512)
    >>> end = march_newmark(compiled, np.array([1.0]), np.array([[1.0, 0.0]]), 1)
    >>> bool(abs(end[0, 0] - np.cos(2.0)) < 1e-5)
    True
    """
    period = np.asarray(period, dtype=float)
    _refuse(compiled, float(period.max()), gamma, beta)
    require_positive("tolerance", tolerance)
    law = np.array([gamma, beta, max(tolerance, _FINEST)])
    lanes = state.shape[0]
    width = _WIDTHS[0] if lanes < 4 else _WIDTHS[1]
    extra = np.zeros((lanes, state.shape[1] // 2)) if extra_force is None else extra_force
    tables = newmark_tables(compiled)
    new = np.empty_like(state)
    kept = record
    if record is None or not record.flags.c_contiguous:
        kept = np.empty((0, state.shape[1], 1) if record is None else record.shape)

    def block(first: int) -> int:
        # Lanes past the end repeat the last one, so that a block is always full.
        index = np.minimum(np.arange(first, first + width), lanes - 1)
        part, count = np.ascontiguousarray(state[index]), min(width, lanes - first)
        failed = _march_block(
            compiled, tables, law, period[index], extra[index], part, cycles, kept, (first, count)
        )
        new[first : first + count] = part[:count]
        return failed

    starts = range(0, lanes, width)
    threads = threads or os.cpu_count() or 1
    if len(starts) == 1 or threads == 1:
        failures = [block(first) for first in starts]
    else:
        with ThreadPoolExecutor(threads) as pool:
            failures = list(pool.map(block, starts))
    for first, failed in zip(starts, failures, strict=True):
        if failed >= 0:
            chosen = slice(first, first + width)
            _report(compiled, tables, law, period[chosen], extra[chosen], state[chosen], cycles)
    if record is not None and kept is not record:
        record[...] = kept
    return new


def _march_block(
    compiled: Compiled,
    tables: NewmarkTables,
    law: Array,
    period: Array,
    extra: Array,
    state: Array,
    cycles: int,
    record: Array | None,
    place: tuple[int, int],
) -> int:
    from tribodyn.dynamics.newmark_marching import newmark_block

    (n, m, f, c), width, kinds = tables.shape, state.shape[0], tables.widths.size
    sources = m + f
    inner = 8 * n + 5 * m + 2 * f + sources * n + 2 * m * sources + m * m + 3
    length = m * (5 + 3 * n) + f * (n + c) + n
    mass, damping, stiffness = (
        part.reshape(n, n) for part in tables.matrices[: 3 * n * n].reshape(3, n * n)
    )
    h = (tables.widths[:, None] * period)[:, :, None, None]
    effective = np.linalg.inv(mass + law[0] * h * damping + law[1] * h * h * stiffness)
    work = np.zeros((inner + kinds * n * n) * width + inner + 2 * n * n + 2 * length + n * n)
    shared = work[inner * width : (inner + kinds * n * n) * width]
    shared[:] = np.moveaxis(effective, 1, -1).reshape(-1)
    keep = np.zeros((0, 2 * n, 1)) if record is None else record
    grid = compiled.grid
    return int(
        newmark_block(
            (0.0,) * width, tables.shape, law, *tables.structure, tables.matrices, tables.rows,
            grid.width, tables.kind, grid.after_event, tables.dead, tables.facts, work,
            np.ascontiguousarray(period), np.ascontiguousarray(extra, dtype=float), state, cycles,
            keep, *place,
        )
    )  # fmt: skip


def _report(
    compiled: Compiled,
    tables: NewmarkTables,
    law: Array,
    period: Array,
    extra: Array,
    state: Array,
    cycles: int,
) -> None:
    """Find the lane that failed, when, and which coordinate moved most; raise."""
    grid, n = compiled.grid, compiled.system.size
    steps = grid.steps
    for lane in range(period.size):
        own = slice(lane, lane + 1)

        def march(part: Array, count: int, record: Array | None, own: slice = own) -> int:
            return _march_block(
                compiled, tables, law, period[own], extra[own], part, count, record, (0, 1)
            )

        failed = march(state[own].copy(), cycles, None)
        if failed < 0:
            continue
        before, part = max((failed // 2 - 1) // steps, 0), state[own].copy()
        march(part, before, None)
        record = np.zeros((steps + 1, 2 * n, 1))
        march(part, 1, record)
        done = failed // 2 - before * steps
        finite = np.isfinite(record[:done, :, 0]).all(axis=1)
        step = done if finite.all() else int(np.argmin(finite))
        with np.errstate(over="ignore", invalid="ignore"):
            energy = np.diag(compiled.system.mass) * record[max(step - 1, 0), n:, 0] ** 2
        name = compiled.system.names[int(np.argmax(energy))]
        time = (before + float(np.append(grid.left, 1.0)[step])) * float(period[lane])
        small = bool(finite.all()) and float(np.abs(record[:done]).max()) < _HUGE
        raise ComputationError(_failure(compiled, law, failed % 2 == 1 and small, time, name))


def _failure(compiled: Compiled, law: Array, unfound: bool, time: float, name: str) -> Problem:
    if unfound:
        return Problem(
            what=f"the contact forces of the step that ends at {time:.6g} s were not found",
            why=f"Newton's method did not come below the tolerance of {law[2]:.0e} within 25 "
            f"passes, at omega_max*dt = {compiled.step_number:.3g}",
            remedy="Take more steps per mesh cycle or a larger tolerance, and look for a contact "
            "stiffness or damping below zero, which can make the equations of a step singular",
        )
    return Problem(
        what=f"the motion grew beyond all bounds at about {time:.6g} s, most of all {name}",
        why=f"gamma = {law[0]:g}, beta = {law[1]:g} are stable at omega_max*dt = "
        f"{compiled.step_number:.3g}, so the system itself is unstable or singular",
        remedy="Look for negative stiffness or damping, or friction that feeds energy in",
    )
