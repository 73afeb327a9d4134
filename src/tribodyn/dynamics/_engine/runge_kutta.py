"""The classical Runge-Kutta scheme: one fourth-order step of all lanes."""

from __future__ import annotations

from typing import Any

import numba as nb
from numba.extending import overload

from tribodyn.dynamics._engine.contact_forces import (
    I64,
    INNER,
    Law,
    acceleration_of,
    all_forces,
    next_coordinate,
    slots_of,
)
from tribodyn.dynamics._engine.lanes import load, store
from tribodyn.dynamics._engine.method import (
    RungeKutta4,
    accept,
    is_method,
    own_slots,
    part_step,
    prepare,
    restart,
    step,
)
from tribodyn.types import Array


@nb.njit(**INNER)
def runge_kutta_step(lanes: Any, law: Law, base: int, w: Array) -> None:
    """March every lane by one step, from the state in buffer 0 to buffer 2."""
    s = slots_of(law.code)
    n, columns = s.n, law.code[2]
    h = load(lanes, w, s.h)
    sixth = (1.0 / 6.0) * h
    for stage in range(4):
        buffer, target = (0, 1, 2, 1)[stage], (1, 2, 1, 2)[stage]
        part = (0.5, 0.5, 1.0, 1.0)[stage]
        q, out = 2 * n * buffer, 2 * n * target
        here = all_forces(lanes, law, base + ((stage + 1) // 2) * columns, buffer, w)
        for i in range(n):
            a = acceleration_of(lanes, law, here, i, w)
            here = next_coordinate(law, here)
            q0, v0 = load(lanes, w, i), load(lanes, w, n + i)
            if stage < 3:
                dt = part * h
                store(w, out + i, q0 + dt * load(lanes, w, q + n + i))
                store(w, out + n + i, v0 + dt * a)
                if stage == 2:
                    a = a + load(lanes, w, s.second + i)
                store(w, (s.first, s.second, s.second)[stage] + i, a)
            else:
                start, inner = load(lanes, w, s.first + i), load(lanes, w, s.second + i)
                store(w, out + i, q0 + h * (v0 + sixth * (start + inner)))
                store(w, out + n + i, v0 + sixth * (start + 2.0 * inner + a))


@overload(own_slots)
def _own_slots(method, law):  # type: ignore[no-untyped-def]
    if is_method(method, RungeKutta4):
        return lambda method, law: (I64(0), I64(0))
    return None


@overload(prepare)
def _prepare(method, law, base, period, w):  # type: ignore[no-untyped-def]
    if is_method(method, RungeKutta4):
        return lambda method, law, base, period, w: None
    return None


@overload(restart)
def _restart(lanes, method, law, base, w):  # type: ignore[no-untyped-def]
    if is_method(method, RungeKutta4):
        return lambda lanes, method, law, base, w: None
    return None


@overload(step)
def _whole_step(lanes, method, law, number, base, w):  # type: ignore[no-untyped-def]
    if not is_method(method, RungeKutta4):
        return None

    def march(lanes, method, law, number, base, w):  # type: ignore[no-untyped-def]
        runge_kutta_step(lanes, law, base, w)
        return True

    return march


@overload(part_step)
def _part_step(method, law, w):  # type: ignore[no-untyped-def]
    if not is_method(method, RungeKutta4):
        return None

    def march(method, law, w):  # type: ignore[no-untyped-def]
        runge_kutta_step((0.0,), law, I64(0), w)
        return True

    return march


@nb.njit(**INNER)
def take_over(lanes: Any, n: int, w: Array) -> None:
    """Copy the state at the end of the step to its beginning."""
    for item in range(2 * n * len(lanes)):
        w[item] = w[4 * n * len(lanes) + item]


@overload(accept)
def _accept(lanes, method, law, w):  # type: ignore[no-untyped-def]
    if is_method(method, RungeKutta4):
        return lambda lanes, method, law, w: take_over(lanes, law.code[0], w)
    return None
