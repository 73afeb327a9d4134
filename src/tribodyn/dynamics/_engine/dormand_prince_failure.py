"""What is said of an adaptive march that ends early: when, which state, and why that may be."""

from __future__ import annotations

from typing import NoReturn

import numpy as np

from tribodyn.dynamics.equations.divergence import probable_cause
from tribodyn.dynamics.equations.grid import system_events
from tribodyn.dynamics.equations.program import compile_system
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import ComputationError, Problem
from tribodyn.types import Array

_SAMPLE = 64


def report_failure(
    report: Array,
    period: float,
    state: Array,
    scale: Array,
    system: System,
    factors: Array,
    lane: int,
) -> NoReturn:
    """Raise the error that tells when and where a march ended."""
    cycle, phase = int(report[9]), float(report[5])
    n = system.size
    where = f"time {(cycle + phase) * period:.6g} s, mesh cycle {cycle + 1}, phase {phase:.6g}"
    where += f", trajectory {lane}" if lane >= 0 else ""
    if report[4] == 2.0:
        raise ComputationError(
            Problem(
                what=f"contact {int(report[7])} opens and closes more than 64 times within a "
                "millionth of a mesh cycle",
                where=where,
                why="It chatters: its damping, error or direction throws it back at once, or its "
                "flanks are far too hard or too near each other",
                remedy="Look for negative damping, and for an error or a gap that jumps "
                "at a phase that is not an event",
            )
        )
    size = np.abs(state) / np.maximum(scale, 1e-300)
    worst = int(np.argmax(np.where(np.isfinite(state), size, np.inf)))
    name = system.names[worst % n]
    kind = "position" if worst < n else "velocity"
    if not np.isfinite(state[worst]) or size[worst] > 1e9:
        steps = max(_SAMPLE, 2 * len(system_events(system)))
        _, nodes, _ = compile_system(system, steps)
        cause, remedy = probable_cause(system, nodes, 0.0, factors)
        raise ComputationError(
            Problem(
                what=f"the motion grew beyond all bounds: the {kind} of {name} is "
                f"{state[worst]:.3g}",
                where=where,
                why=f"{cause}. Steps are as short as accuracy needs, so it is not they",
                remedy=remedy,
            )
        )
    raise ComputationError(
        Problem(
            what=f"no step meets the tolerance: {name} moves fastest, its {kind} is "
            f"{state[worst]:.3g}",
            where=where,
            why="An entry is not smooth there, or rounding exceeds the tolerance",
            remedy="Give the phase as an event, or a larger rtol or atol",
        )
    )
