"""The middle of a step, and the data of a step that the statistics need.

The state in the middle is the cubic Hermite interpolant of the two ends.
"""

from __future__ import annotations

import numba as nb

from tribodyn.compiled.jit import INNER
from tribodyn.dynamics._engine.contact_forces import I64, set_sides, slots_of
from tribodyn.dynamics._engine.lanes import Lanes, load, store
from tribodyn.dynamics._engine.method import Law
from tribodyn.dynamics.equations import motion
from tribodyn.types import Array

cubic_middle = nb.njit(**INNER)(motion.cubic_middle)


@nb.njit(**INNER)
def set_inverse(lanes: Lanes, law: Law, share: float, w: Array) -> None:
    """Set the inverse of the duration of a step, which is a share of the mesh cycle."""
    s = slots_of(law.code)
    store(w, s.inverse, (1.0 / share) * load(lanes, w, s.beat))


@nb.njit(**INNER)
def statistics_slots(contacts: int) -> int:
    """Count of slots that a step stores for the statistics.

    Forces at the left end, sides in the middle and at the ends, and the weight of the left end as
    right end of the previous step.
    """
    return 3 * contacts + 1


@nb.njit(**INNER)
def copy_slots(lanes: Lanes, source: int, target: int, count: int, w: Array) -> None:
    """Copy slots of all lanes."""
    for item in range(count):
        store(w, target + item, load(lanes, w, source + item))


@nb.njit(**INNER)
def to_middle(lanes: Lanes, law: Law, row: int, statistics_slot: int, w: Array) -> None:
    """Write the state in the middle between buffers 0 and 2 to buffer 1, and set its sides."""
    s = slots_of(law.code)
    n, h, inverse = s.n, load(lanes, w, s.h), load(lanes, w, s.inverse)
    for i in range(n):
        q0, v0 = load(lanes, w, i), load(lanes, w, n + i)
        q1, v1 = load(lanes, w, 4 * n + i), load(lanes, w, 5 * n + i)
        q, v = cubic_middle(h, inverse, q0, v0, q1, v1)
        store(w, 2 * n + i, q)
        store(w, 3 * n + i, v)
    if statistics_slot > 0:
        copy_slots(lanes, s.side, statistics_slot + 2 * s.contacts, s.contacts, w)
        set_sides(lanes, law, row, I64(1), w)


@nb.njit(**INNER)
def from_middle(lanes: Lanes, law: Law, statistics_slot: int, w: Array) -> None:
    """Store the sides in the middle of the step, and restore those at its ends."""
    s = slots_of(law.code)
    copy_slots(lanes, s.side, statistics_slot + s.contacts, s.contacts, w)
    copy_slots(lanes, statistics_slot + 2 * s.contacts, s.side, s.contacts, w)
