"""Whether a motion repeats after several mesh cycles, or turns while it settles to fewer."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["still_settles"]

Array = NDArray[np.float64]

#: Part of the change after fewer cycles that is left whole periods later, where it settles.
_FALLS = 0.999


def still_settles(states: Array, earlier: Array, apart: int, period: int) -> bool:
    """Tell whether a motion comes nearer after fewer cycles than whole periods ago.

    Parameters
    ----------
    states, earlier : (9, k) array
        States of the last 8 mesh cycles, and the same ``apart`` cycles before [any unit]; NaN
        where they are not known.
    apart : int
        Mesh cycles between both, at least 9 and at most 16.
    period : int
        Mesh cycles after which the motion seems to repeat, at most 8.

    Returns
    -------
    bool
        For a true period the change after fewer cycles stays as it is.

    Examples
    --------
    >>> turns = 0.99 ** np.arange(25) * np.exp(2j * np.pi * np.arange(25) / 6)
    >>> states = np.stack((turns.real, turns.imag), axis=1)
    >>> still_settles(states[16:], states[:9], 16, 6)
    True
    """
    back = period * -(-apart // period) - apart
    for fewer in range(1, period):
        if period % fewer == 0:
            new = states[-1] - states[-1 - fewer]
            old = earlier[-1 - back] - earlier[-1 - back - fewer]
            if np.linalg.norm(new) < _FALLS * np.linalg.norm(old):
                return True
    return False
