"""Newmark's scheme on the event-aligned grid: average acceleration by default.

Second order where the other engines have four or more, but stable at any step where ``2 beta >=
gamma >= 1/2``: for stiff supports whose own motion does not matter, and for comparison with
published results.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.blocks import Compiled
from tribodyn.dynamics._engine.newmark_engine import newmark_engine
from tribodyn.dynamics._engine.newmark_limit import refuse_newmark
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.program import compile_system
from tribodyn.dynamics.equations.step_limit import largest_rate
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.types import Array

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

#: Below this tolerance the iteration would chase rounding.
_FINEST = 1e-14


def newmark_law(
    gamma: float | None = None, beta: float | None = None, preset: str | None = None
) -> tuple[float, float]:
    """Parameters of the scheme, given or by name."""
    if preset is None:
        return 0.5 if gamma is None else gamma, 0.25 if beta is None else beta
    if preset not in NEWMARK_PRESETS or gamma is not None or beta is not None:
        beside = "" if gamma is None and beta is None else " with gamma or beta"
        raise InputError(
            Problem(
                what=f'preset = "{preset}"{beside}',
                where="argument preset",
                why="It names both parameters and is one of "
                + ", ".join(f'"{name}"' for name in NEWMARK_PRESETS),
            )
        )
    return NEWMARK_PRESETS[preset]


def compile_newmark(
    system: System,
    mesh_frequency: ArrayLike,
    steps: int,
    *,
    gamma: float = 0.5,
    beta: float = 0.25,
) -> Compiled:
    """Compile a system for :func:`march_newmark`: no step is too long for a stable scheme."""
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    if int(steps) != steps or steps < 1:
        raise InputError(
            Problem(what=f"steps = {steps}", where="argument steps", why="A whole number >= 1")
        )
    grid, nodes, program = compile_system(system, int(steps))
    slowest = float(np.min(np.asarray(mesh_frequency, dtype=float)))
    number = largest_rate(system, nodes) * float(grid.width.max()) / slowest
    compiled = Compiled(system, grid, nodes, program, number)
    refuse_newmark(compiled, np.array([1.0 / slowest]), gamma, beta)
    return compiled


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
    parameters: LaneParameters | None = None,
    record: Array | None = None,
    threads: int | None = None,
    elapsed: int = 0,
) -> Array:
    """March lanes by whole mesh cycles with Newmark's scheme; returns their new state.

    Parameters
    ----------
    compiled : Compiled
        From :func:`compile_newmark`, or ``compile_for`` or ``compile_lanes`` of the Runge-Kutta
        engine.
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
    parameters : LaneParameters, optional
        Factors by which each lane scales its system.
    record : (steps * cycles + 1, 2 n, lanes) array, optional
        Receives every state.
    threads : int, optional
        Blocks marched at a time; the number of processors by default.
    elapsed : int
        Mesh cycles marched before, for the report of a motion that grows beyond all bounds.

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
    refuse_newmark(compiled, period, gamma, beta, parameters)
    require_positive("tolerance", tolerance)
    engine = newmark_engine(compiled, np.array([gamma, beta, max(tolerance, _FINEST)]), parameters)
    return engine.march(
        period, state, cycles, extra_force=extra_force, record=record, threads=threads,
        elapsed=elapsed,
        scales=None if parameters is None else parameters.table(period.size),
    )  # fmt: skip
