"""The largest step that the integrator can follow.

The classical Runge-Kutta scheme is stable on the imaginary axis up to ``|lambda| h = 2.83``.
Beyond it the computed motion diverges or, with a dead zone, is irregular: a published route to
chaos is this artefact. Steps are refused above 2.7.
"""

from __future__ import annotations

import math

import numpy as np

from tribodyn.dynamics.equations.grid import Grid, RowEvaluator, build_grid, system_events
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.nodes import Nodes, evaluate_nodes, nominal_push
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_positive
from tribodyn.nomenclature import require_number
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Highest ``omega_max * dt``; the exact limit of the scheme on the imaginary axis is 2.828.
LIMIT = 2.7

#: Rows of the table that are examined at most, and lanes.
_SAMPLES, _LANES = 32, 256
#: Squarings after which the norm of a power selects the relevant matrices, squarings after which it
#: selects a first candidate, and its rounding.
_SQUARINGS, _FIRST, _ROUNDING = 12, 4, 1e-9
#: Factors of stiffness, damping and friction of an unscaled system.
_PLAIN = (1.0, 1.0, 1.0)
_UNSCALED = np.array([_PLAIN])
#: ``omega_max * dt`` at which figures of a spur gear pair are good to about 1e-6.
_ACCURATE = 0.2
#: Range of the recommended steps; the limit of 2.7 still holds above it.
FEWEST, MOST = 1024, 65536


def largest_rate(system: System, nodes: Nodes, factors: tuple[float, ...] = _PLAIN) -> float:
    """Largest modulus of an eigenvalue of the motion with all contacts closed."""
    places = examined_rows(nodes.stiffness.sum(axis=-1))
    return float(rates_at(system, nodes, places, np.array([factors])).max())


def rates_at(
    system: System, nodes: Nodes, places: tuple[Index, ...], factors: Array = _UNSCALED
) -> Array:
    """Largest modulus of an eigenvalue at ``places``, for each row of ``factors`` (f, 3).

    All rows of factors share the places, or each has one; a batch has a leading axis.
    """
    along, push = nodes.direction[places], nodes.force_direction[places]
    if system.frictions:
        push = nominal_push(system, Nodes(*(part[places] for part in nodes)))
    spring, damper, rub = (column[:, None, None, None] for column in factors.T)
    outer = np.einsum("...mji,...mjk->...mjik", along + rub * (push - along), along)
    stiffness = np.einsum("...mj,...mjik->...mik", nodes.stiffness[places], outer)
    damping = np.einsum("...mj,...mjik->...mik", nodes.damping[places], outer)
    inverse = system.inverse_mass
    elastic = inverse @ (spring * stiffness + np.asarray(system.stiffness))
    viscous = inverse @ (damper * damping + system.rate_matrix)
    return _spectral_radius(_state_matrix(elastic, viscous))


def state_roots(elastic: Array, viscous: Array) -> ComplexArray:
    """Eigenvalues of ``q'' = -elastic q - viscous q'``, for matrices (..., n, n)."""
    return np.asarray(np.linalg.eigvals(_state_matrix(elastic, viscous)), dtype=complex)


def _state_matrix(elastic: Array, viscous: Array) -> Array:
    size = elastic.shape[-1]
    # Displacements are scaled by the largest stiffness rate: otherwise the matrix mixes entries of
    # 1 and 1e12 and the eigenvalues lose digits.
    axes = tuple(range(-min(elastic.ndim, 3), 0))
    scale = np.maximum(np.sqrt(np.abs(elastic).max(axis=axes, keepdims=True)), 1e-30)
    state = np.zeros((*elastic.shape[:-2], 2 * size, 2 * size))
    state[..., :size, size:] = scale * np.eye(size)
    state[..., size:, :size] = -elastic / scale
    state[..., size:, size:] = -viscous
    return state


def _spectral_radius(matrices: Array) -> Array:
    """Largest modulus of an eigenvalue of any of the matrices (..., m, n, n).

    The root of the norm of a power is a close upper bound. Matrices whose bound is below the
    modulus of another one are left out.

    Source: Gelfand (1941), Mat. Sbornik 9, 3-24: the root of the norm tends to the largest modulus.
    """
    blocks = _blocks(np.any(matrices, axis=tuple(range(matrices.ndim - 2))))
    if len(blocks) > 1:
        radii = [_spectral_radius(matrices[..., block[:, None], block]) for block in blocks]
        return np.asarray(np.max(radii, axis=0))
    if np.all(matrices == matrices[..., :1, :, :]):
        matrices = matrices[..., :1, :, :]
    lead, (count, size) = matrices.shape[:-3], matrices.shape[-3:-1]
    every = matrices.reshape(-1, size, size)
    left, largest = np.arange(len(every)), np.zeros(len(every) // count)
    power, bound = every.copy(), np.ones(len(every))
    for squaring in range(_SQUARINGS + 1):
        power = power if squaring == 0 else power @ power
        flat = power.reshape(-1, size * size)
        norm = np.sqrt(np.einsum("pi,pi->p", flat, flat))
        bound *= norm ** (0.5**squaring)
        power /= np.maximum(norm, np.finfo(float).tiny)[:, None, None]
        if squaring == _FIRST:
            first = bound.reshape(-1, count).argmax(axis=1) + count * np.arange(largest.size)
            largest = _modulus(every[first])
            bound[first] = 0.0
        if squaring >= _FIRST:
            relevant = bound > (1.0 - _ROUNDING) * largest[left // count]
            if not relevant.all():
                left, power, bound = left[relevant], power[relevant], bound[relevant]
    np.maximum.at(largest, left // count, _modulus(every[left]))
    return largest.reshape(lead)


def _blocks(pattern: Mask) -> list[Index]:
    """Indices of the diagonal blocks of a block triangular matrix, which have its eigenvalues."""
    count = len(pattern)
    connected = (np.eye(count, dtype=bool) | pattern).astype(float)
    for _ in range(count.bit_length()):  # twice as many steps along the couplings every time
        connected = (connected @ connected > 0.0).astype(float)
    _, block = np.unique((connected > 0.0) & (connected.T > 0.0), axis=0, return_inverse=True)
    return [np.flatnonzero(block == number) for number in range(block.max(initial=-1) + 1)]


def _modulus(matrices: Array) -> Array:
    return np.asarray(np.abs(np.linalg.eigvals(matrices)).max(axis=-1, initial=0.0))


def examined_rows(total: Array) -> tuple[Index, Index]:
    """Rows of tables (..., steps, 3) to examine, and the stiffest node of each."""
    spread = np.linspace(0, total.shape[-2] - 1, _SAMPLES).astype(np.int64)
    stiffest = total.reshape(*total.shape[:-2], -1).argmax(axis=-1)[..., None] // total.shape[-1]
    spread = np.broadcast_to(spread, (*stiffest.shape[:-1], _SAMPLES))
    rows = np.sort(np.concatenate((spread, stiffest), axis=-1), axis=-1)
    return rows, np.take_along_axis(total, rows[..., None], axis=-2).argmax(axis=-1)


def recommended_steps(system: System, mesh_frequency: float) -> int:
    """Steps per mesh cycle that follow the fastest motion of a system accurately.

    Parameters
    ----------
    system : System
    mesh_frequency : float
        Mesh frequency [Hz].

    Returns
    -------
    int
        A power of two from 1024 to 65536, with ``omega_max * dt <= 0.2`` where that is enough.

    Raises
    ------
    InputError
        If the mesh frequency is not a positive number.

    Examples
    --------
    >>> recommended_steps(System([[1.0]], [[0.0]], [[4e8]], [0.0]), 50.0)
    2048
    """
    require_number("mesh_frequency", mesh_frequency)
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    return accurate_steps(rate_on_grid(system), mesh_frequency * system.cycles)


def rate_on_grid(system: System, steps: int = FEWEST) -> float:
    """Largest modulus of an eigenvalue on a grid of ``steps`` steps; cached."""
    if steps in system._rates:
        return system._rates[steps]
    grid = build_grid(system_events(system), steps * system.cycles)
    evaluator, total = RowEvaluator(grid, checks=False), np.zeros((grid.steps, 3))
    for j, contact in enumerate(system.clocked_contacts):
        total += evaluator.values(f"contacts[{j}].stiffness", contact.stiffness)[..., 0]
    # All other entries are needed on the examined rows only.
    rows, stages = examined_rows(total)
    nodes, places = evaluate_nodes(system, grid.rows(rows)), (np.arange(rows.size), stages)
    system._rates[steps] = float(rates_at(system, nodes, places)[0])
    return system._rates[steps]


def needed_steps(rate: float, mesh_frequency: float) -> float:
    """Steps per mesh cycle that follow a motion accurately."""
    return rate / (_ACCURATE * mesh_frequency)


def accurate_steps(rate: float, mesh_frequency: float) -> int:
    """The same as a power of two that is not too large."""
    needed = needed_steps(rate, mesh_frequency)
    return int(min(max(2 ** math.ceil(math.log2(max(needed, 1.0))), FEWEST), MOST))


def refuse_rate(
    system: System, grid: Grid, mesh_frequency: float, rate: float, lane: str = ""
) -> float:
    """Return ``omega_max * dt`` of the widest step, or refuse it."""
    number = rate * float(grid.width.max()) / mesh_frequency
    if number > LIMIT:
        steps = grid.steps // system.cycles
        needed = int(np.ceil(steps * number / LIMIT / 64.0)) * 64
        raise InputError(
            f"omega_max*dt = {number:.3f} with {steps} steps per mesh cycle at "
            f"{mesh_frequency * system.cycles:g} Hz and a fastest motion of {rate:.4g} rad/s{lane}",
            "argument steps",
            f"The limit is {LIMIT}; above 2.83 Runge-Kutta is unstable, its result not physics",
            f"Use at least {needed} steps per mesh cycle",
        )
    return number


def refuse_steps(system: System, mesh_frequency: float, steps: int) -> None:
    """Refuse steps as the compiled system does, without its tables."""
    grid = build_grid(system_events(system), steps * system.cycles)
    refuse_rate(system, grid, mesh_frequency, rate_on_grid(system, steps))


def refuse_unstable_lanes(
    system: System,
    nodes: Nodes,
    grid: Grid,
    mesh_frequency: Array,
    parameters: LaneParameters | None,
    lanes: Index | None = None,
) -> float:
    """Return the largest ``omega_max * dt`` of lanes that scale a system, or refuse it."""
    table, beat = _every_lane(mesh_frequency, parameters, lanes)
    longest = float(grid.width.max())
    # Often a lane with the largest factors of all and the lowest frequency is within the limit.
    least = largest_rate(system, nodes, tuple(table.max(axis=0))) * longest / float(beat.min())
    if least <= LIMIT:
        return least
    keys = (table[:, 0] / beat**2, table[:, 1] / beat)
    likely = np.unique(np.concatenate([np.argsort(-key)[:_LANES] for key in keys]))
    rows, stages = examined_rows(nodes.stiffness.sum(axis=-1))
    stiffest = np.array([int(nodes.stiffness.sum(axis=-1)[rows, stages].argmax())])
    rates = rates_at(system, nodes, (rows[stiffest], stages[stiffest]), table[likely])
    worst = int(likely[np.argmax(rates / beat[likely])])
    names = ("stiffness_scale", "damping_scale", "friction_scale")
    factors = dict(zip(names, table[worst].tolist(), strict=True))
    scaled = [f"{name} = {value:g}" for name, value in factors.items() if value != 1.0]
    number = worst if lanes is None else int(lanes[worst])
    who = f" in lane {number}" + (f" ({', '.join(scaled)})" if scaled else "")
    rate = largest_rate(system, nodes, tuple(factors.values()))
    return refuse_rate(system, grid, float(beat[worst]), rate, who)


def _every_lane(
    mesh_frequency: Array, parameters: LaneParameters | None, lanes: Index | None
) -> tuple[Array, Array]:
    """Factors (m, 3) and mesh frequency (m,) of the lanes concerned."""
    beat = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    if beat.size == 1 and parameters is not None:
        beat = np.broadcast_to(beat, (parameters.count,))
    table = np.ones((beat.size, 3)) if parameters is None else parameters.table(beat.size)[:, :3]
    return (table, beat) if lanes is None else (table[lanes], beat[lanes])
