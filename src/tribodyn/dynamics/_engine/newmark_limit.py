"""What Newmark's scheme refuses: parameters that make no sense, and steps beyond its limit."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tribodyn.dynamics._engine.blocks import Compiled, Member
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.step_limit import largest_rate
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array


def refuse_newmark(
    compiled: Compiled,
    period: Array,
    gamma: float,
    beta: float,
    parameters: LaneParameters | None = None,
) -> None:
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
    if 2.0 * beta >= gamma:
        return
    scales = np.ones((period.size, 6)) if parameters is None else parameters.table(period.size)
    whole = Member(compiled.system, compiled.nodes, np.arange(period.size))
    for one in compiled.members or (whole,):
        for lane in _outermost(scales[one.lanes, 0], period[one.lanes]):
            number = int(one.lanes[lane])
            _refuse_step(
                compiled, one, float(period[number]), gamma, beta, tuple(scales[number, :3]),
                f" in lane {number}" if period.size > 1 else "",
            )  # fmt: skip


def _outermost(stiffness: Array, period: Array) -> list[int]:
    """Lanes such that no other is both stiffer and slower."""
    found: list[int] = []
    for lane in np.lexsort((-stiffness, -period)):
        if not found or stiffness[lane] > stiffness[found[-1]]:
            found.append(int(lane))
    return found


def _undamped_rate(system: System, nodes: Nodes, factors: tuple[float, ...]) -> float:
    """Highest natural frequency with all contacts closed [rad/s]."""
    still = replace(system, damping=np.zeros((system.size, system.size)))
    bare = nodes._replace(damping=np.zeros_like(nodes.damping))
    return largest_rate(still, bare, factors)


def _refuse_step(
    compiled: Compiled,
    one: Member,
    period: float,
    gamma: float,
    beta: float,
    factors: tuple[float, ...],
    who: str,
) -> None:
    limit = 1.0 / math.sqrt(0.5 * gamma - beta)
    grid = compiled.grid
    rate = _undamped_rate(one.system, one.nodes, factors)
    number = rate * float(grid.width.max()) * period
    if number > limit:
        needed = int(np.ceil(grid.steps * number / limit / 64.0)) * 64
        raise InputError(
            Problem(
                what=f"omega*dt = {number:.4g} with {grid.steps} steps per mesh cycle at "
                f"{1.0 / period:g} Hz and a highest natural frequency of {rate:.4g} rad/s{who}",
                where="argument steps",
                why=f"With gamma = {gamma:g} and beta = {beta:g} the limit is "
                f"1/sqrt(gamma/2 - beta) = {limit:.4g}; any step is stable only with 2 beta >= "
                "gamma",
                remedy=f"Use at least {needed} steps per mesh cycle, or gamma = 0.5, beta = 0.25",
            )
        )
