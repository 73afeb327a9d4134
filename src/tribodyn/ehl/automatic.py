"""How many nodes a contact gets: as stated, or until its film no longer changes."""

from __future__ import annotations

import math
from numbers import Real
from typing import Any

from tribodyn.errors import InputError, Problem

#: Nodes of a grid: fewest and most.
FEWEST, MOST = 65, 16385
#: Intervals of the coarsest grid at most, so that halving leads to a grid that is quickly solved.
_COARSEST = 255


def choose_nodes(nodes: Any) -> tuple[int, bool]:
    """Nodes of the finest grid, and whether coarser ones may do."""
    if isinstance(nodes, str) and nodes == "auto":
        return MOST, True
    if isinstance(nodes, bool) or not isinstance(nodes, Real) or not float(nodes).is_integer():
        raise InputError(
            Problem(
                what=f"nodes = {nodes!r}",
                where="argument nodes",
                why=f'it is "auto" or a whole number from {FEWEST} to {MOST}',
            )
        )
    count = int(float(nodes))
    near = 2 ** min(14, max(6, round(math.log2(max(count - 1, 1))))) + 1
    if not FEWEST <= count <= MOST:
        raise InputError(
            Problem(
                what=f"nodes = {count}",
                where="argument nodes",
                why=f"a grid has {FEWEST} to {MOST} nodes",
                remedy=f"Take nodes = {near}",
            )
        )
    intervals = count - 1
    while intervals % 2 == 0 and intervals > _COARSEST:
        intervals //= 2
    if intervals > _COARSEST:
        raise InputError(
            Problem(
                what=f"nodes = {count}, hence {count - 1} intervals",
                where="argument nodes",
                why=f"halving the intervals must lead to {_COARSEST} or fewer, and ends at "
                f"{intervals}",
                remedy=f"Take nodes = {near}, or another 2^k + 1",
            )
        )
    return count, False
