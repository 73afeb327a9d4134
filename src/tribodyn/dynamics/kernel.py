"""The compiled kernel: one fourth-order Runge-Kutta step of all lanes in mesh phase.

Structure and contacts are data (:class:`~tribodyn.dynamics.program.Program`); arithmetic runs
over lanes, the trajectories of an ensemble, which share the mesh phase and differ in mesh
period, load and state (:mod:`~tribodyn.dynamics.lanes`). Everything that a lane owns lives in
slots of one work buffer. Replaces, and is tested against, the readable
:mod:`tribodyn.dynamics.plain`.

``code``, ``reads`` and ``rows`` are those of the program, ``w`` is the work buffer, ``base`` the
address of a row in ``rows`` and ``buffer`` (0, 1, 2) the state buffer that is read.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np
from numpy.typing import NDArray

from tribodyn.dynamics.lanes import any_negative, load, store

__all__ = [
    "I64",
    "INNER",
    "JIT",
    "acceleration",
    "compression",
    "contact_forces",
    "left_side",
    "step",
]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

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
        total = total + rows[row + item] * load(lanes, w, reads[read + item])
    return total


@nb.njit(**INNER)
def compression(
    lanes: Any, code: Index, reads: Index, rows: Array, at: int, read: int, row: int, w: Array
) -> Any:
    """Compression of the contact whose description begins at ``at``, ``read`` and ``row``."""
    zero = load(lanes, w, 9 * code[0] + 2 * code[1] + 3)
    return _sum_terms(lanes, zero - rows[row + 2], code[at], reads, read, rows, row + 5, w)


@nb.njit(**INNER)
def contact_forces(
    lanes: Any, code: Index, reads: Index, rows: Array, base: int, buffer: int, w: Array
) -> tuple[Any, Any, Any]:
    """Force of every contact; returns where the coordinates' terms begin in code, reads, rows."""
    n, contacts = code[0], code[1]
    one = 9 * n + 2 * contacts
    beat, zero = load(lanes, w, one + 2), load(lanes, w, one + 3)
    at, read, row = I64(4), buffer * code[3], base
    for j in range(contacts):
        # The compression as in `compression`, in one loop with its rate.
        d, rate = zero - rows[row + 2], zero - rows[row + 3] * beat
        for item in range(code[at]):
            factor, slot = rows[row + 5 + item], reads[read + item]
            d = d + factor * load(lanes, w, slot)
            rate = rate + factor * load(lanes, w, slot + n)
        k, c, gap = rows[row], rows[row + 1], rows[row + 4]
        row += 5 + code[at]
        read += code[at]
        for item in range(code[at + 1]):
            rate = rate + rows[row + item] * load(lanes, w, reads[read + item]) * beat
        row += code[at + 1]
        read += code[at + 1]
        if code[at + 2] == 0:
            store(w, 8 * n + j, k * d + c * rate)
        else:
            sign = load(lanes, w, 8 * n + contacts + j)
            spring = sign * sign * (k * (d - gap * sign))
            if code[at + 3] == 0:
                store(w, 8 * n + j, spring + sign * sign * (c * rate))
            else:
                store(w, 8 * n + j, spring + c * rate)
        at += 4
    return at, read, row


@nb.njit(**INNER)
def acceleration(
    lanes: Any, code: Index, reads: Index, rows: Array, base: int, buffer: int, out: int, w: Array
) -> None:
    """Contact forces, and the acceleration of every coordinate into the slots from ``out``."""
    n = code[0]
    steady = 8 * n + 2 * code[1]
    at, read, row = contact_forces(lanes, code, reads, rows, base, buffer, w)
    for i in range(n):
        start = load(lanes, w, steady + i)
        store(w, out + i, _sum_terms(lanes, start, code[at], reads, read, rows, row, w))
        row += code[at]
        read += code[at]
        at += 1


@nb.njit(**INNER)
def step(lanes: Any, code: Index, reads: Index, rows: Array, base: int, w: Array) -> None:
    """March every lane by one step, from the state in buffer 0 to buffer 2.

    Classical Runge-Kutta scheme for ``q' = v``, ``v' = a``; ``rows`` holds the left, middle and
    right row of the step from ``base``.
    """
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
def left_side(lanes: Any, code: Index, reads: Index, rows: Array, base: int, w: Array) -> bool:
    """Tell whether a lane's new state (buffer 2) is off the side of a dead zone that it was on."""
    n, contacts = code[0], code[1]
    at, read, row = I64(4), 2 * code[3], base
    for j in range(contacts):
        if code[at + 2] != 0:
            d = compression(lanes, code, reads, rows, at, read, row, w)
            gap = rows[row + 4]
            sign = load(lanes, w, 8 * n + contacts + j)
            touch = sign * sign
            inside, free = touch * (sign * d - gap), 1.0 - touch
            if any_negative(inside + free * (gap - d)) or any_negative(inside + free * (gap + d)):
                return True
        row += 5 + code[at] + code[at + 1]
        read += code[at] + code[at + 1]
        at += 4
    return False
