"""Whether a computed motion is physics: the same computation with half the step has to agree."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from tribodyn.dynamics.equations.step_limit import LIMIT

if TYPE_CHECKING:
    from tribodyn.nonlinear.lyapunov import LyapunovExponents


Verdict = Literal["physical", "step-limited", "undecided"]

#: What a step-halving test can say.
VERDICTS: tuple[Verdict, ...] = ("physical", "step-limited", "undecided")

#: Rms values agree within this: of motions that repeat, and of those that do not.
_PERIODIC, _IRREGULAR = 0.01, 0.1
#: Largest exponents agree within this many standard errors of their difference, or this share, or
#: this share of the mesh frequency, which is how well an exponent of zero is known.
_ERRORS, _EXPONENT, _ZERO = 3.0, 0.05, 1e-3


def step_verdict(
    step_number: float, period: int, rms: float, refined_period: int, refined_rms: float
) -> Verdict:
    """Judge a motion by the same computation with shorter steps."""
    if step_number > LIMIT:
        return "step-limited"
    unsettled = period == 0 or refined_period == 0
    tolerance = _IRREGULAR if unsettled else _PERIODIC
    agrees = abs(rms - refined_rms) <= tolerance * max(abs(rms), abs(refined_rms))
    if period != refined_period:
        return "undecided" if unsettled and agrees else "step-limited"
    return "physical" if agrees else "undecided"


def exponent_verdict(found: LyapunovExponents, refined: LyapunovExponents) -> Verdict:
    """Judge Lyapunov exponents by those with shorter steps."""
    both_repeat = found.repeats > 0 and refined.repeats > 0
    if found.chaotic != refined.chaotic or (both_repeat and found.repeats != refined.repeats):
        return "step-limited"
    one, other = float(found.vibrating[0]), float(refined.vibrating[0])
    errors = (float(item.standard_error[0]) for item in (found, refined))
    spread = math.hypot(*(0.0 if math.isnan(error) else error for error in errors))
    allowed = max(
        _EXPONENT * max(abs(one), abs(other)), _ERRORS * spread, _ZERO * found.mesh_frequency
    )
    return "physical" if abs(one - other) <= allowed else "undecided"
