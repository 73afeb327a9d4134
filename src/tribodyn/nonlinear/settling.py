"""Whether a motion repeats after several mesh cycles, or turns while it settles to fewer."""

from __future__ import annotations

import numpy as np

from tribodyn.types import Array

#: Part of the change after fewer cycles that is left whole periods later, where it settles.
_FALLS = 0.999


def still_settles(states: Array, earlier: Array, apart: int, period: int) -> bool:
    """Tell whether a motion comes nearer after fewer cycles than whole periods ago."""
    back = period * -(-apart // period) - apart
    for fewer in range(1, period):
        if period % fewer == 0:
            new = states[-1] - states[-1 - fewer]
            old = earlier[-1 - back] - earlier[-1 - back - fewer]
            if np.linalg.norm(new) < _FALLS * np.linalg.norm(old):
                return True
    return False
