"""One Dormand-Prince step of all lanes, its error and its dense output.

Seven stages give a solution of fifth order and, by comparison with one of fourth, its error
(Dormand and Prince 1980). The last stage is the first of the next step. Between the ends the
position is the quintic Hermite interpolant of position, velocity and acceleration at both ends,
and the velocity is its derivative: of sixth and fifth order, hence no worse than the step.
The readable version is in ``tests/plain``.

On top of the slots of :class:`~tribodyn.dynamics.program.Program` every lane owns, from slot
``own``: accelerations and velocities of the seven stages, the mean velocity of the step, the
largest size of each state so far, its inverse tolerance, the error, the mesh period, clearances
of the contacts at five places of the step, marks of contacts that have just changed sides, and
clearances at one more place.
"""

from __future__ import annotations

import math
from typing import Any

import numba as nb
import numpy as np

from tribodyn.dynamics._engine.contact_forces import (
    I64,
    INNER,
    acceleration,
    compression,
    dead_zone,
)
from tribodyn.dynamics._engine.lanes import any_negative, greatest, load, store
from tribodyn.types import Array, Index

#: Places of the stages, their weights (the last row is the step itself) and those of the error.
NODES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
MATRIX = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
WEIGHT_ERROR = np.array(
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]
)


def own_slots(n: int, contacts: int) -> int:
    """Slots of a lane on top of those of the program."""
    return 19 * n + 2 + 13 * contacts


@nb.njit(**INNER)
def find_cell(cells: Any, cell: int, first: int, last: int, phase: float) -> int:
    """Cell of a phase within the segment from cell ``first`` to before ``last``."""
    edge = cells[0]
    while cell < last - 1 and phase > edge[cell + 1]:
        cell += 1
    while cell > first and phase < edge[cell]:
        cell -= 1
    return cell


@nb.njit(**INNER)
def fill_row(cells: Any, count: int, cell: int, phase: float, row: Array) -> None:
    """Evaluate the ``count`` varying factors of the row at a phase of the cell."""
    edge, degree, start, coefficients, varying = cells
    low, high = edge[cell], edge[cell + 1]
    x = ((phase - low) - (high - phase)) / (high - low)
    top, at = degree[cell], start[cell]
    for item in range(count):
        value = coefficients[at + top]
        for k in range(top):
            value = value * x + coefficients[at + top - 1 - k]
        row[varying[item]] = value
        at += top + 1


@nb.njit(**INNER)
def set_scale(
    width: int, n: int, own: int, rtol: float, atol: Array, w: Array, position: int
) -> None:
    """Take the state from slot ``position`` into the largest sizes and the inverse tolerances."""
    for i in range(2 * n):
        size, inverse = (own + 15 * n + i) * width, (own + 17 * n + i) * width
        for lane in range(width):
            now = abs(w[(position + i) * width + lane])
            if now > w[size + lane]:
                w[size + lane] = now
            w[inverse + lane] = 1.0 / (atol[i] + rtol * w[size + lane])


@nb.njit(**INNER)
def try_step(
    lanes: Any,
    code: Index,
    reads: Index,
    cells: Any,
    count: int,
    cell: int,
    last: int,
    phase: float,
    width: float,
    row: Array,
    own: int,
    w: Array,
) -> float:
    """Step every lane by ``width`` in phase, from buffer 0 to buffer 2; returns the worst error."""
    n, contacts = code[0], code[1]
    first, rate, mean = own, own + 7 * n, own + 14 * n
    period = load(lanes, w, own + 19 * n + 1)
    h = width * period
    store(w, 9 * n + 2 * contacts + 1, h)
    for i in range(n):
        store(w, rate + i, load(lanes, w, n + i))
    here = cell
    for s in range(1, 7):
        if s < 6:
            place = phase + NODES[s] * width
            here = find_cell(cells, here, cell, last, place)
            fill_row(cells, count, here, place, row)
        buffer = I64(2) if s == 6 else I64(1)
        target = 2 * n * buffer
        for i in range(n):
            dq, dv = MATRIX[s, 0] * load(lanes, w, rate + i), MATRIX[s, 0] * load(lanes, w, i + own)
            for j in range(1, s):
                factor = MATRIX[s, j]
                dq = dq + factor * load(lanes, w, rate + j * n + i)
                dv = dv + factor * load(lanes, w, first + j * n + i)
            v = load(lanes, w, n + i) + h * dv
            store(w, target + i, load(lanes, w, i) + h * dq)
            store(w, target + n + i, v)
            store(w, rate + s * n + i, v)
            if s == 6:
                store(w, mean + i, dq)
        acceleration(lanes, code, reads, row, I64(0), buffer, first + s * n, w)
    total = 0.0 * h
    for i in range(2 * n):
        stage = (rate if i < n else first - n) + i
        error = WEIGHT_ERROR[0] * load(lanes, w, stage)
        for j in range(2, 7):
            error = error + WEIGHT_ERROR[j] * load(lanes, w, stage + j * n)
        error = error * h * load(lanes, w, own + 17 * n + i)
        total = total + error * error
    store(w, own + 19 * n, total)
    worst = 0.0
    for lane in range(len(lanes)):
        value = w[(own + 19 * n) * len(lanes) + lane]
        if not np.isfinite(value):
            return np.inf
        worst = max(worst, value)
    return math.sqrt(worst)


@nb.njit(**INNER)
def between(lanes: Any, n: int, own: int, theta: float, h: Any, speed: bool, w: Array) -> None:
    """State at the fraction ``theta`` of the step, into buffer 1; without ``speed`` positions."""
    s = theta
    s2, s3 = s * s, s * s * s
    b5 = s3 * (10.0 - s * (15.0 - 6.0 * s))
    b1 = s - s3 * (6.0 - s * (8.0 - 3.0 * s))
    b4 = -s3 * (4.0 - s * (7.0 - 3.0 * s))
    b2 = 0.5 * s2 - s3 * (1.5 - s * (1.5 - 0.5 * s))
    b3 = s3 * (0.5 - s * (1.0 - 0.5 * s))
    d5 = s2 * (30.0 - s * (60.0 - 30.0 * s))
    d1 = 1.0 - s2 * (18.0 - s * (32.0 - 15.0 * s))
    d4 = -s2 * (12.0 - s * (28.0 - 15.0 * s))
    d2 = s - s2 * (4.5 - s * (6.0 - 2.5 * s))
    d3 = s2 * (1.5 - s * (4.0 - 2.5 * s))
    for i in range(n):
        v0, v1 = load(lanes, w, n + i), load(lanes, w, 5 * n + i)
        a0, a1 = load(lanes, w, own + i), load(lanes, w, own + 6 * n + i)
        mean = load(lanes, w, own + 14 * n + i)
        q = b5 * mean + b1 * v0 + b4 * v1 + h * (b2 * a0 + b3 * a1)
        store(w, 2 * n + i, load(lanes, w, i) + h * q)
        if speed:
            store(w, 3 * n + i, d5 * mean + d1 * v0 + d4 * v1 + h * (d2 * a0 + d3 * a1))


@nb.njit(**INNER)
def clearances(
    lanes: Any, code: Index, reads: Index, row: Array, buffer: int, slot: int, w: Array
) -> None:
    """Distances of every contact to the boundaries of its side, two slots each from ``slot``."""
    n, contacts = code[0], code[1]
    at, read, here = I64(4), buffer * code[3], I64(0)
    for j in range(contacts):
        if code[at + 2] != 0:
            d = compression(lanes, code, reads, row, at, read, here, w)
            gap = dead_zone(lanes, code, row, here, w)
            sign = load(lanes, w, 8 * n + contacts + j)
            touch = sign * sign
            inside, free = touch * (sign * d - gap), 1.0 - touch
            store(w, slot + 2 * j, inside + free * (gap - d))
            store(w, slot + 2 * j + 1, inside + free * (gap + d))
        here += 5 + code[at] + code[at + 1]
        read += code[at] + code[at + 1]
        at += 4


@nb.njit(**INNER)
def may_cross(
    lanes: Any,
    code: Index,
    reads: Index,
    cells: Any,
    count: int,
    cell: int,
    last: int,
    phase: float,
    width: float,
    row: Array,
    own: int,
    w: Array,
) -> bool:
    """Tell whether a contact of any lane may have left its side within the step just tried."""
    n, contacts = code[0], code[1]
    h, table = load(lanes, w, 9 * n + 2 * contacts + 1), own + 19 * n + 2
    here = cell
    for m in range(5):
        theta = 0.25 * m
        here = find_cell(cells, here, cell, last, phase + theta * width)
        fill_row(cells, count, here, phase + theta * width, row)
        if 0 < m < 4:
            between(lanes, n, own, theta, h, False, w)
        buffer = I64(0) if m == 0 else (I64(2) if m == 4 else I64(1))
        clearances(lanes, code, reads, row, buffer, table + 2 * contacts * m, w)
    found = False
    for j in range(contacts):
        if code[4 + 4 * j + 2] == 0:
            continue
        for slot in range(table + 2 * j, table + 2 * j + 2):
            before = load(lanes, w, slot)
            here_now = load(lanes, w, slot + 2 * contacts)
            for m in range(2, 5):
                after = load(lanes, w, slot + 2 * contacts * m)
                slope = after - before
                reach = greatest(slope, 0.0 * slope - slope)
                if any_negative(here_now - 0.25 * reach) or any_negative(after):
                    found = True
                before, here_now = here_now, after
    return found
