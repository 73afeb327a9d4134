"""Whether a computed motion is physics: the same computation with half the step has to agree."""

from __future__ import annotations

from typing import Literal

from tribodyn.dynamics.step_limit import LIMIT

__all__ = ["VERDICTS", "Verdict", "step_verdict"]

Verdict = Literal["physical", "step-limited", "undecided"]

#: What a step-halving test can say.
VERDICTS: tuple[Verdict, ...] = ("physical", "step-limited", "undecided")

#: Rms values agree within this: of motions that repeat, and of those that do not.
_PERIODIC, _IRREGULAR = 0.01, 0.1


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
