"""Newmark's scheme on the event-aligned grid: average acceleration by default.

Second order where the other engines have four or more, but stable at any step where ``2 beta >=
gamma >= 1/2``: for stiff supports whose motion is irrelevant, and for comparison with
published results. The acceleration is recomputed at every event and contact change, and a step in
which a contact opens or closes is split there: the scheme keeps its second order. ``gamma > 1/2``
adds damping and leaves first order. Source: Newmark (1959); Hughes (1987), The finite element
method, section 9.1, for the limits.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from tribodyn.dynamics._engine.method import Newmark
from tribodyn.dynamics.equations.compiled import Compiled, Member
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.step_limit import largest_rate
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_positive
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

#: Smallest tolerance of the iteration: rounding limits it.
_FINEST = 1e-14


def newmark_law(
    gamma: float | None = None, beta: float | None = None, preset: str | None = None
) -> tuple[float, float]:
    """Parameters of the scheme, from numbers or by the name of a preset."""
    if preset is None:
        return 0.5 if gamma is None else gamma, 0.25 if beta is None else beta
    if preset not in NEWMARK_PRESETS or gamma is not None or beta is not None:
        conflict = "" if gamma is None and beta is None else " with gamma or beta"
        raise InputError(
            f'preset = "{preset}"{conflict}',
            where="argument preset",
            why="It defines both parameters and is one of "
            + ", ".join(f'"{name}"' for name in NEWMARK_PRESETS),
            remedy="Choose one of these, and omit gamma and beta",
        )
    return NEWMARK_PRESETS[preset]


def newmark_method(
    compiled: Compiled,
    period: Array,
    gamma: float,
    beta: float,
    tolerance: float = 1e-12,
    parameters: LaneParameters | None = None,
) -> Newmark:
    """Set up the method for :func:`~tribodyn.dynamics._engine.blocks.march`.

    Refuses parameters, and steps beyond the limit of a conditionally stable scheme.
    """
    if not (np.isfinite(gamma) and np.isfinite(beta) and gamma >= 0.5 and beta >= 0.0):
        what = f"gamma = {gamma:g}, beta = {beta:g}"
        why = "With gamma < 1/2 the scheme is unstable at any step; beta is not negative"
        remedy = "Use for example gamma = 0.5, beta = 0.25 (average acceleration)"
        raise InputError(what, "arguments gamma, beta", why, remedy)
    require_positive("tolerance", tolerance)
    method = Newmark.on(compiled.grid, gamma, beta, max(tolerance, _FINEST))
    scales = np.ones((period.size, 6)) if parameters is None else parameters.table(period.size)
    for member in compiled.each(period.size) if 2.0 * beta < gamma else ():
        for lane in _outermost(scales[member.lanes, 0], period[member.lanes]):
            number = int(member.lanes[lane])
            who = f" in lane {number}" if period.size > 1 else ""
            at = float(period[number]), tuple(scales[number, :3]), who
            _refuse_step(method, compiled.grid, member, *at)
    return method


def _outermost(stiffness: Array, period: Array) -> list[int]:
    """Lanes for which no other lane is both stiffer and slower."""
    outermost: list[int] = []
    for lane in np.lexsort((-stiffness, -period)):
        if not outermost or stiffness[lane] > stiffness[outermost[-1]]:
            outermost.append(int(lane))
    return outermost


def _undamped_rate(system: System, nodes: Nodes, factors: tuple[float, ...]) -> float:
    """Highest natural frequency with all contacts closed [rad/s]."""
    still = replace(system, damping=np.zeros((system.size, system.size)))
    bare = nodes._replace(damping=np.zeros_like(nodes.damping))
    return largest_rate(still, bare, factors)


def _refuse_step(
    method: Newmark, grid: Grid, member: Member, period: float, factors: tuple[float, ...], who: str
) -> None:
    gamma, beta = method.gamma, method.beta
    limit = 1.0 / math.sqrt(0.5 * gamma - beta)
    rate = _undamped_rate(member.system, member.nodes, factors)
    number = rate * float(grid.width.max()) * period
    if number > limit:
        steps = grid.steps // member.system.cycles
        needed = int(np.ceil(steps * number / limit / 64.0)) * 64
        raise InputError(
            f"omega*dt = {number:.4g} with {steps} steps per mesh cycle at "
            f"{member.system.cycles / period:g} Hz and a highest natural frequency of "
            f"{rate:.4g} rad/s{who}",
            where="argument steps",
            why=f"With gamma = {gamma:g} and beta = {beta:g} the limit is "
            f"1/sqrt(gamma/2 - beta) = {limit:.4g}; any step is stable only with 2 beta >= "
            "gamma",
            remedy=f"Use at least {needed} steps per mesh cycle, or gamma = 0.5, beta = 0.25",
        )
