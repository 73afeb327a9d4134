"""Vibration along the line of action against vibration across it.

Friction hardly changes the motion along the line of action but drives the motion across it. The
ratio of the two therefore grows with the roughness of the flanks: an indicator of surface
damage that one direction alone does not give.
"""

from __future__ import annotations

from tribodyn.dynamics.time.response import FineSamples
from tribodyn.signals.indicators import alternating_rms
from tribodyn.types import Array


def line_of_action_indicator(samples: FineSamples, along: Array, across: Array) -> float:
    """Alternating rms across the line of action over that along it.

    Parameters
    ----------
    samples : FineSamples
        ``response.fine``.
    along, across : (3 * steps,) array
        The same quantity in the two directions, in any unit, for example [N].

    Returns
    -------
    float
        Zero without friction; infinite if nothing vibrates along the line of action.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(line_of_action_indicator(samples, wave, 0.25 * wave), 6)
    0.25
    """
    base = float(alternating_rms(samples, along))
    other = float(alternating_rms(samples, across))
    if base == 0.0:
        return float("inf") if other > 0.0 else 0.0
    return other / base
