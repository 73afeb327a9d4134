"""The compiled kernel: one fourth-order Runge-Kutta step of all lanes in mesh phase.

Structure and contacts are data (:class:`~tribodyn.dynamics.program.Program`); arithmetic runs
over lanes, the trajectories of an ensemble, which share the mesh phase and differ in mesh
period, load and state (:mod:`~tribodyn.dynamics.lanes`). Everything that a lane owns lives in
slots of one work buffer. Replaces, and is tested against, the readable
equations.motion.

``code``, ``reads`` and ``rows`` are those of the program, ``w`` is the work buffer, ``base`` the
address of a row in ``rows`` and ``buffer`` (0, 1, 2) the state buffer that is read. Lanes share
the rows or have their own: the type of ``rows`` tells, see :func:`~tribodyn.dynamics.lanes.entry`.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.dynamics._engine.lanes import (
    entry,
    greatest,
    least,
    load,
    negative_lanes,
    store,
)
from tribodyn.types import Array, Index

#: Without it every literal integer argument makes the compiler translate the callee anew.
I64 = np.int64

#: NaN stays detectable: neither "nnan" nor "ninf". Only the outermost kernel is cached on disk.
JIT: dict[str, Any] = {
    "nogil": True,
    "fastmath": {"contract", "nsz"},
    "error_model": "numpy",
}

#: For what only compiled functions call: no entry from Python has to be compiled.
INNER: dict[str, Any] = {**JIT, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


@nb.njit(**INNER)
def _sum_terms(
    lanes: Any, first: Any, count: int, reads: Index, read: int, rows: Array, row: int, w: Array
) -> Any:
    """``first`` plus the sum of factor times slot."""
    total = first
    for item in range(count):
        total = total + entry(lanes, rows, row + item) * load(lanes, w, reads[read + item])
    return total


@nb.njit(**INNER)
def compression(
    lanes: Any, code: Index, reads: Index, rows: Array, at: int, read: int, row: int, w: Array
) -> Any:
    """Compression of the contact whose description begins at ``at``, ``read`` and ``row``."""
    error = load(lanes, w, 9 * code[0] + 2 * code[1] + 3) - 1.0
    first = entry(lanes, rows, row + 2) * error
    return _sum_terms(lanes, first, code[at], reads, read, rows, row + 5, w)


@nb.njit(**INNER)
def dead_zone(lanes: Any, code: Index, rows: Array, row: int, w: Array) -> Any:
    """Half of the dead zone of the contact whose rows begin at ``row``."""
    return entry(lanes, rows, row + 4) * (1.0 + load(lanes, w, 9 * code[0] + 2 * code[1] + 5))


@nb.njit(**INNER)
def _scaled_force(
    lanes: Any, code: Index, rows: Array, at: int, row: int, j: int, d: Any, rate: Any, w: Array
) -> Any:
    """Force of a contact whose stiffness, damping and dead zone differ between lanes."""
    n, contacts = code[0], code[1]
    one = 9 * n + 2 * contacts
    k = entry(lanes, rows, row) * (1.0 + load(lanes, w, one + 6))
    damper = entry(lanes, rows, row + 1) * (1.0 + load(lanes, w, one + 7)) * rate
    if code[at + 2] == 0:
        return k * d + damper
    sign = load(lanes, w, 8 * n + contacts + j)
    spring = sign * sign * (k * (d - dead_zone(lanes, code, rows, row, w) * sign))
    if code[at + 3] == 2:
        damper = sign * sign * damper
    return spring + damper


@nb.njit(forceinline=True, **INNER)
def contact_forces(
    lanes: Any, code: Index, reads: Index, rows: Array, base: int, buffer: int, w: Array
) -> tuple[Any, Any, Any]:
    """Force of every contact; returns where the frictions begin in code, reads, rows."""
    n, contacts = code[0], code[1]
    one = 9 * n + 2 * contacts
    beat, error = load(lanes, w, one + 2), load(lanes, w, one + 3) - 1.0
    at, read, row = I64(4), buffer * code[3], base
    for j in range(contacts):
        # The compression as in `compression`, in one loop with its rate.
        d = entry(lanes, rows, row + 2) * error
        rate = entry(lanes, rows, row + 3) * (error * beat)
        first = row
        row += 5
        for item in range(code[at]):
            factor, slot = entry(lanes, rows, row + item), reads[read + item]
            d = d + factor * load(lanes, w, slot)
            rate = rate + factor * load(lanes, w, slot + n)
        row += code[at]
        read += code[at]
        for item in range(code[at + 1]):
            factor = entry(lanes, rows, row + item)
            rate = rate + factor * load(lanes, w, reads[read + item]) * beat
        row += code[at + 1]
        read += code[at + 1]
        if code[at + 3] >= 2:
            store(w, 8 * n + j, _scaled_force(lanes, code, rows, at, first, j, d, rate, w))
        else:
            k, c = entry(lanes, rows, first), entry(lanes, rows, first + 1)
            if code[at + 2] == 0:
                store(w, 8 * n + j, k * d + c * rate)
            else:
                sign = load(lanes, w, 8 * n + contacts + j)
                spring = sign * sign * (k * (d - entry(lanes, rows, first + 4) * sign))
                if code[at + 3] == 0:
                    store(w, 8 * n + j, spring + sign * sign * (c * rate))
                else:
                    store(w, 8 * n + j, spring + c * rate)
        at += 4
    return at, read, row


@nb.njit(**INNER)
def friction_forces(
    lanes: Any, code: Index, reads: Index, rows: Array, at: int, read: int, row: int, w: Array
) -> tuple[Any, Any, Any]:
    """Every friction that follows the load; returns where the coordinates' terms begin."""
    one = 9 * code[0] + 2 * code[1]
    count = code[at]
    at += 1
    for f in range(count):
        contacts, terms = code[at], code[at + 1]
        at += 2
        force = load(lanes, w, reads[read])
        for item in range(1, contacts):
            force = force + load(lanes, w, reads[read + item])
        read += contacts
        last = row + 1 + terms
        total = entry(lanes, rows, last) + 0.0 * force
        if terms > 1:
            # The load over the nominal one, no more than the limit.
            x = entry(lanes, rows, row) * greatest(force, 0.0 - force)
            x = least(x, entry(lanes, rows, row + 1) + 0.0 * force)
            for item in range(1, terms):
                total = total * x + entry(lanes, rows, last - item)
        store(w, one + 9 + f, (1.0 + load(lanes, w, one + 8)) * force * total)
        row = last + 1
    return at, read, row


@nb.njit(**INNER)
def acceleration(
    lanes: Any, code: Index, reads: Index, rows: Array, base: int, buffer: int, out: int, w: Array
) -> None:
    """All forces, and the acceleration of every coordinate into the slots from ``out``."""
    n = code[0]
    steady = 8 * n + 2 * code[1]
    at, read, row = contact_forces(lanes, code, reads, rows, base, buffer, w)
    if code[at] > 0:
        at, read, row = friction_forces(lanes, code, reads, rows, at, read, row, w)
    else:
        at += 1
    for i in range(n):
        start = load(lanes, w, steady + i)
        store(w, out + i, _sum_terms(lanes, start, code[at], reads, read, rows, row, w))
        row += code[at]
        read += code[at]
        at += 1


@nb.njit(**INNER)
def step(lanes: Any, code: Index, reads: Index, rows: Array, base: int, w: Array) -> None:
    """March every lane by one step, from the state in buffer 0 to buffer 2."""
    n, contacts, columns = code[0], code[1], code[2]
    first, middle, steady = 6 * n, 7 * n, 8 * n + 2 * contacts
    h = load(lanes, w, 9 * n + 2 * contacts + 1)
    sixth = (1.0 / 6.0) * h
    for s in range(4):
        buffer, target = (0, 1, 2, 1)[s], (1, 2, 1, 2)[s]
        part = (0.5, 0.5, 1.0, 1.0)[s]
        here, out = 2 * n * buffer, 2 * n * target
        at, read, row = contact_forces(
            lanes, code, reads, rows, base + ((s + 1) // 2) * columns, buffer, w
        )
        if code[at] > 0:
            at, read, row = friction_forces(lanes, code, reads, rows, at, read, row, w)
        else:
            at += 1
        for i in range(n):
            start = load(lanes, w, steady + i)
            a = _sum_terms(lanes, start, code[at], reads, read, rows, row, w)
            row += code[at]
            read += code[at]
            at += 1
            q0, v0 = load(lanes, w, i), load(lanes, w, n + i)
            if s < 3:
                dt = part * h
                store(w, out + i, q0 + dt * load(lanes, w, here + n + i))
                store(w, out + n + i, v0 + dt * a)
                if s == 2:
                    a = a + load(lanes, w, middle + i)
                store(w, (first, middle, middle)[s] + i, a)
            else:
                start, inner = load(lanes, w, first + i), load(lanes, w, middle + i)
                store(w, out + i, q0 + h * (v0 + sixth * (start + inner)))
                store(w, out + n + i, v0 + sixth * (start + 2.0 * inner + a))


@nb.njit(**INNER)
def left_side(lanes: Any, code: Index, reads: Index, rows: Array, base: int, w: Array) -> Any:
    """Bits of the lanes whose new state (buffer 2) is off the side of a dead zone they were on."""
    n, contacts = code[0], code[1]
    at, read, row = I64(4), 2 * code[3], base
    gone = I64(0)
    for j in range(contacts):
        if code[at + 2] != 0:
            d = compression(lanes, code, reads, rows, at, read, row, w)
            gap = dead_zone(lanes, code, rows, row, w)
            sign = load(lanes, w, 8 * n + contacts + j)
            touch = sign * sign
            inside, free = touch * (sign * d - gap), 1.0 - touch
            gone |= negative_lanes(inside + free * (gap - d))
            gone |= negative_lanes(inside + free * (gap + d))
        row += 5 + code[at] + code[at + 1]
        read += code[at] + code[at + 1]
        at += 4
    return gone
