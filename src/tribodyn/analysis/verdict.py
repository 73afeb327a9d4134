"""Whether a computed motion is physics: the same computation with half the step has to agree."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from tribodyn.dynamics.step_limit import LIMIT

if TYPE_CHECKING:
    from tribodyn.analysis.lyapunov import LyapunovExponents

__all__ = ["VERDICTS", "Verdict", "exponent_verdict", "step_verdict"]

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
    """Judge a motion by the same computation with shorter steps.

    Parameters
    ----------
    step_number : float
        ``omega_max * dt`` of the motion [-].
    period : int
        Mesh cycles after which the motion repeats; 0 if it does not.
    rms : float
        Its alternating rms [any unit]; NaN for a motion that grew beyond all bounds.
    refined_period : int
        Period with shorter steps.
    refined_rms : float
        Alternating rms with shorter steps [same unit].

    Returns
    -------
    "physical", "step-limited" or "undecided"
        Step-limited beyond ``omega_max * dt`` = 2.7, or if the period changes; physical if period
        and rms agree; undecided if only the rms differs, as beside a jump between two motions, or
        if one of the two has not come to repeat yet but has the same rms.

    Notes
    -----
    The rms of motions that repeat agrees within 1 %, that of others, which is known from a sample
    only, within 10 %.

    Examples
    --------
    >>> step_verdict(0.2, 1, 0.31, 1, 0.31)
    'physical'
    >>> step_verdict(3.1, 0, 0.9, 1, 0.31)
    'step-limited'
    """
    if step_number > LIMIT:
        return "step-limited"
    unsettled = period == 0 or refined_period == 0
    tolerance = _IRREGULAR if unsettled else _PERIODIC
    agrees = abs(rms - refined_rms) <= tolerance * max(abs(rms), abs(refined_rms))
    if period != refined_period:
        return "undecided" if unsettled and agrees else "step-limited"
    return "physical" if agrees else "undecided"


def exponent_verdict(found: LyapunovExponents, refined: LyapunovExponents) -> Verdict:
    """Judge Lyapunov exponents by those with shorter steps.

    Parameters
    ----------
    found, refined : LyapunovExponents
        As asked for, and with half the step.

    Returns
    -------
    "physical", "step-limited" or "undecided"
        Step-limited if only one of the two motions is chaotic, or both repeat, but after different
        numbers of mesh cycles; physical if the largest exponents agree within 5 % or three standard
        errors of their difference; else undecided.
    """
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
