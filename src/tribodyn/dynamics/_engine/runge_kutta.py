"""The classical Runge-Kutta scheme: one fourth-order step of all lanes."""

from __future__ import annotations

import numba as nb

from tribodyn.compiled.jit import INNER
from tribodyn.dynamics._engine.contact_forces import (
    I64,
    all_forces,
    next_coordinate,
    slots_of,
    sum_terms,
)
from tribodyn.dynamics._engine.lanes import Lanes, keep_apart, load, store
from tribodyn.dynamics._engine.method import (
    Law,
    RungeKutta4,
    accept,
    for_method,
    own_slots,
    prepare,
    restart,
    step,
)
from tribodyn.dynamics._engine.midpoint import copy_slots, from_middle, to_middle
from tribodyn.types import Array


@nb.njit(**INNER)
def take_over(lanes: Lanes, n: int, w: Array) -> None:
    """Copy the state at the end of the step to its beginning."""
    for item in range(2 * n * len(lanes)):
        w[item] = w[4 * n * len(lanes) + item]


@for_method(RungeKutta4, own_slots)
def _own_slots(method: RungeKutta4, law: Law) -> tuple[int, int, int]:
    return I64(0), I64(0), I64(0)


@for_method(RungeKutta4, prepare)
def _prepare(
    method: RungeKutta4, law: Law, base: int, duration: float, kind: int, w: Array
) -> None:
    pass


@for_method(RungeKutta4, restart)
def _restart(lanes: Lanes, method: RungeKutta4, law: Law, base: int, w: Array) -> None:
    pass


@for_method(RungeKutta4, step)
def runge_kutta_step(
    lanes: Lanes,
    method: RungeKutta4,
    law: Law,
    number: int,
    base: int,
    w: Array,
    statistics_slot: int | None,
) -> bool:
    """Integrate every lane over one step, from the state in buffer 0 to buffer 2."""
    keep_apart()
    s = slots_of(law.code)
    n, columns = s.n, law.code[2]
    h = load(lanes, w, s.h)
    sixth = (1.0 / 6.0) * h
    # A loop that the compiler cannot unroll is compiled in a quarter of the time.
    for stage in range(method.stages if statistics_slot is None else method.stages + 1):
        buffer, target = stage if stage < 3 else I64(1), 1 + stage % 2
        part = 0.5 if stage < 2 else 1.0
        q, out, row = 2 * n * buffer, 2 * n * target, (stage + 1) // 2
        if statistics_slot is not None:
            if stage == 1:
                copy_slots(lanes, s.force, statistics_slot, s.contacts, w)
            if stage == 4:
                row = I64(1)
                to_middle(lanes, law, base + columns, statistics_slot, w)
        cursor = all_forces(lanes, law, base + row * columns, buffer, w)
        for i in range(n):
            start = load(lanes, w, s.load + i)
            a = sum_terms(lanes, law, start, law.code[cursor.at], cursor.read, cursor.row, w)
            cursor = next_coordinate(law, cursor)
            q0, v0 = load(lanes, w, i), load(lanes, w, n + i)
            if stage < 3:
                dt = part * h
                store(w, out + i, q0 + dt * load(lanes, w, q + n + i))
                store(w, out + n + i, v0 + dt * a)
                if stage == 2:
                    a = a + load(lanes, w, s.second + i)
                store(w, (s.first if stage == 0 else s.second) + i, a)
            elif statistics_slot is not None and stage == 4:
                store(w, s.second + i, a)
            else:
                start, inner = load(lanes, w, s.first + i), load(lanes, w, s.second + i)
                store(w, out + i, q0 + h * (v0 + sixth * (start + inner)))
                store(w, out + n + i, v0 + sixth * (start + 2.0 * inner + a))
    if statistics_slot is not None:
        from_middle(lanes, law, statistics_slot, w)
    return True


@for_method(RungeKutta4, accept)
def _accept(lanes: Lanes, method: RungeKutta4, law: Law, w: Array) -> None:
    take_over(lanes, law.code[0], w)
