"""Integrate one trajectory by one thread: the same steps, crossings and statistics as in a block.

:mod:`tribodyn.dynamics._engine.generated.cuda` compiles this module for the graphics processor,
together with all functions that it calls. There the functions of the engine work on numbers
instead of vectors of lanes: the first functions below replace those of
:mod:`tribodyn.dynamics._engine.lanes`.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numba import cuda
from numba.extending import register_jitable

from tribodyn.dynamics._engine.contact_forces import I64, set_sides, slots_of
from tribodyn.dynamics._engine.crossing import split_step
from tribodyn.dynamics._engine.lanes import Lanes
from tribodyn.dynamics._engine.marching import (
    CHATTERING,
    has_dead_zones,
    put_lane,
    set_up,
    take_lane,
)
from tribodyn.dynamics._engine.method import Law, Method
from tribodyn.dynamics._engine.runge_kutta import take_over
from tribodyn.dynamics._engine.running_statistics import Gathered, Place, gather, gather_parts
from tribodyn.types import Array, Index, Mask

#: Constants and functions of one structure, set before compilation.
SLOTS, COLUMNS, ENDS = 0, 0, (0, 0, 0, 0)
step: Callable[..., bool] = NotImplemented
left_side: Callable[..., int] = NotImplemented


def load(lanes: Lanes, w: Array, slot: int) -> float:
    """The number in a slot."""
    return w[slot]


def store(w: Array, slot: int, value: float) -> None:
    """Write a number into a slot."""
    w[slot] = value


def entry(lanes: Lanes, rows: Array, item: int) -> float:
    """One item of a row table."""
    return rows[item]


def first_lane(value: float) -> float:
    """The number itself."""
    return value


def least(left: float, right: float) -> float:
    """Smaller of two numbers."""
    return left if left < right else right


def greatest(left: float, right: float) -> float:
    """Larger of two numbers."""
    return left if left > right else right


def above(left: float, right: float) -> float:
    """1 where the left number is above the right one, else 0."""
    return 1.0 if left > right else 0.0


def below(left: float, right: float) -> float:
    """1 where the left number is below the right one, else 0."""
    return 1.0 if left < right else 0.0


def prepare(method: Method, law: Law, base: int, duration: float, kind: int, w: Array) -> None:
    """Do nothing: the method has no slots."""


def restart(lanes: Lanes, method: Method, law: Law, base: int, w: Array) -> None:
    """Do nothing: the method has no slots."""


@register_jitable
def march_thread(
    code: Index, reads: Index, tables: Array, share: Array, again: Mask, member: Index,
    period: Array, load: Array, state: Array, cycles: int, marched: int, lane_slots: Array,
    scratches: Array, record: Array, outputs: Array, waves: Array, harmonics: int, moments: Array,
    weight: float, ended: Index,
) -> None:  # fmt: skip
    """Integrate one lane over ``cycles`` mesh cycles, after the first call from ``lane_slots`` on.

    ``marched`` counts the previous steps; ``ended`` receives the code of ``march_block``.
    """
    lane = cuda.grid(1)
    if lane >= period.size or ended[lane] >= 0:
        return
    w = cuda.local.array(SLOTS, np.float64)
    for slot in range(SLOTS):
        w[slot] = lane_slots[slot, lane] if marched > 0 else 0.0
    law, next_lane, scratch = Law(code, reads, tables[member[lane]]), lane + 1, scratches[lane]
    if marched == 0:
        set_up(1, code, period[lane:next_lane], load[lane:next_lane], state[lane:next_lane], w)
    single, part, search, parts, part_waves = (
        scratch[:SLOTS], scratch[ENDS[0] : ENDS[1]], scratch[ENDS[1] : ENDS[2]],
        scratch[ENDS[2] : ENDS[3]], scratch[ENDS[3] :],
    )  # fmt: skip
    gathered = Gathered(outputs, waves, harmonics, moments[:, lane])
    s = slots_of(code)
    switching, gathering, point = has_dead_zones(law), moments.shape[0] > 0, 0
    for _cycle in range(cycles):
        for r in range(share.size):
            base = 3 * COLUMNS * r
            w[s.h] = period[lane] * share[r]
            if switching and (again[r] or marched + point == 0):
                set_sides((0.0,), law, base, I64(0), w)
            if record.shape[0] > 0:
                for item in range(state.shape[1]):
                    record[point, item, lane] = w[item]
            step((0.0,), 0, law, r, base, w, None)
            split = switching and left_side((0.0,), law, base + 2 * COLUMNS, w)
            location = Place(base, 6 * harmonics * r, weight * share[r], I64(0))
            if split:
                take_lane(0, 1, SLOTS, w, single)
                _, contact = split_step(0, law, base, w[s.h], part, single, parts, search)
                if contact >= 0:
                    ended[lane] = CHATTERING + (marched + point) * s.contacts + contact
                    return
                put_lane(0, 1, 4 * s.n, 6 * s.n, w, single)
                put_lane(0, 1, s.side, s.side + s.contacts, w, single)
                if gathering:
                    gather_parts(law, location, parts, w[s.h], part, part_waves, gathered, single)
                    set_sides((0.0,), law, base + 2 * COLUMNS, I64(2), w)
            elif gathering:
                w[s.inverse] = 1.0 / w[s.h]
                gather((0.0,), law, switching, location, gathered, w)
            take_over((0.0,), s.n, w)
            point += 1
        for item in range(state.shape[1]):
            if not math.isfinite(w[item]):
                ended[lane] = marched + point
                return
    if record.shape[0] > 0:
        for item in range(state.shape[1]):
            record[point, item, lane] = w[item]
    for slot in range(SLOTS):
        lane_slots[slot, lane] = w[slot]
