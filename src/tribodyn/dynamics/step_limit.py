"""The largest step that the integrator can follow.

The classical Runge-Kutta scheme is stable on the imaginary axis up to ``|lambda| h = 2.83``.
Beyond it the computed motion explodes or, with a dead zone, wanders: a published route to chaos
is nothing but this. Steps are refused above 2.7.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tribodyn.dynamics.grid import Grid
from tribodyn.dynamics.program import Nodes, compile_system
from tribodyn.dynamics.system import System
from tribodyn.errors import InputError, Problem

__all__ = ["LIMIT", "largest_rate", "recommended_steps", "refuse_unstable_step"]

#: Highest ``omega_max * dt``; the exact limit of the scheme on the imaginary axis is 2.828.
LIMIT = 2.7

#: Rows of the table that are examined at most.
_SAMPLES = 32
#: ``omega_max * dt`` at which figures of a spur gear pair are good to about 1e-6.
_ACCURATE = 0.2
#: Range of the recommended steps; the limit of 2.7 still holds above it.
_FEWEST, _MOST = 1024, 65536


def largest_rate(system: System, nodes: Nodes) -> float:
    """Largest modulus of an eigenvalue of the motion with all contacts closed.

    Parameters
    ----------
    system : System
    nodes : Nodes
        The system on its grid.

    Returns
    -------
    float
        In rad/s.

    Examples
    --------
    >>> from tribodyn.dynamics.program import compile_system
    >>> system = System([[4.0]], [[0.0]], [[1.0]], [0.0])
    >>> round(largest_rate(system, compile_system(system, 8)[1]), 6)
    0.5
    """
    size = system.size
    rows, stages = _stiffest_rows(nodes.stiffness.sum(axis=-1))
    along, push = nodes.direction[rows, stages], nodes.force_direction[rows, stages]
    outer = np.einsum("mji,mjk->mjik", push, along)
    stiffness = np.einsum("mj,mjik->mik", nodes.stiffness[rows, stages], outer)
    damping = np.einsum("mj,mjik->mik", nodes.damping[rows, stages], outer)
    inverse = np.linalg.inv(np.asarray(system.mass))
    spring = inverse @ (stiffness + np.asarray(system.stiffness))
    damper = inverse @ (damping + np.asarray(system.damping))
    # Displacements in units of velocity over the largest stiffness rate: without it the matrix
    # mixes entries of 1 and 1e12 and the eigenvalues lose digits.
    scale = max(float(np.sqrt(np.abs(spring).max())), 1e-30)
    state = np.zeros((rows.size, 2 * size, 2 * size))
    state[:, :size, size:] = scale * np.eye(size)
    state[:, size:, :size] = -spring / scale
    state[:, size:, size:] = -damper
    return float(np.abs(np.linalg.eigvals(state)).max())


def _stiffest_rows(total: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of the table to examine, spread over the cycle, each where its step is stiffest."""
    spread = np.linspace(0, total.shape[0] - 1, _SAMPLES).astype(np.int64)
    rows = np.unique(np.append(spread, total.max(axis=1).argmax()))
    return rows, total[rows].argmax(axis=1)


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

    Examples
    --------
    >>> recommended_steps(System([[1.0]], [[0.0]], [[4e8]], [0.0]), 50.0)
    2048
    """
    _, nodes, _ = compile_system(system, _FEWEST)
    needed = largest_rate(system, nodes) / (_ACCURATE * mesh_frequency)
    return int(min(max(2 ** math.ceil(math.log2(max(needed, 1.0))), _FEWEST), _MOST))


def refuse_unstable_step(system: System, nodes: Nodes, grid: Grid, mesh_frequency: float) -> float:
    """Return ``omega_max * dt`` of the widest step, or refuse it.

    Parameters
    ----------
    system : System
    nodes : Nodes
    grid : Grid
    mesh_frequency : float
        Mesh frequency [Hz].

    Returns
    -------
    float
        ``omega_max * dt`` [-].

    Raises
    ------
    InputError
        If it exceeds 2.7; the message gives the number of steps that is needed.
    """
    rate = largest_rate(system, nodes)
    number = rate * float(grid.width.max()) / mesh_frequency
    if number > LIMIT:
        needed = int(np.ceil(grid.steps * number / LIMIT / 64.0)) * 64
        raise InputError(
            Problem(
                what=f"omega_max*dt = {number:.3f} with {grid.steps} steps per mesh cycle at "
                f"{mesh_frequency:g} Hz and a fastest motion of {rate:.4g} rad/s",
                where="argument steps",
                why=f"The limit is {LIMIT}; above 2.83 the Runge-Kutta scheme is unstable and "
                "its result is not physics",
                remedy=f"Use at least {needed} steps per mesh cycle",
            )
        )
    return number
