"""One Dormand-Prince step of all lanes, its error and the polynomial of the step.

Seven stages give a solution of fifth order and, by comparison with one of fourth, its error
(Dormand and Prince 1980). The last stage is the first of the next step. Between the ends the
position is the quintic Hermite interpolant of position, velocity and acceleration at both ends,
and the velocity is its derivative: of sixth and fifth order, hence no worse than the step.
The readable version is in ``tests/plain``.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numba as nb
import numpy as np

from tribodyn.dynamics._engine.contact_forces import (
    I64,
    Law,
    acceleration,
    clearances,
    first_contact,
    is_dead_zone,
    next_contact,
    slots_of,
)
from tribodyn.dynamics._engine.lanes import any_negative, greatest, keep_apart, load, store
from tribodyn.dynamics._engine.method import INNER
from tribodyn.dynamics.equations import motion
from tribodyn.types import Array, Index

quintic_place = nb.njit(**INNER)(motion.quintic_place)
quintic_speed = nb.njit(**INNER)(motion.quintic_speed)

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


class AdaptiveSlots(NamedTuple):
    """Slots of the method, behind those of the law."""

    stage: int  #: accelerations of the seven stages
    last: int  #: of them that of the last
    rate: int  #: velocities of the seven stages
    mean: int  #: mean velocity of the step
    size: int  #: largest size of each state so far
    tolerance: int  #: inverse tolerance of each state
    error: int
    period: int  #: [s]
    table: int  #: distances of every contact at five places of the step
    fresh: int  #: marks of contacts that have just changed their sides
    end: int


@nb.njit(forceinline=True, **INNER)
def adaptive_slots(code: Index) -> AdaptiveSlots:
    """Layout of the slots of the method."""
    s = slots_of(code)
    n, stage, contacts = s.n, s.end, s.contacts
    mean = stage + 14 * n
    error = mean + 5 * n
    table = error + 2
    fresh = table + 10 * contacts
    return AdaptiveSlots(
        stage, stage + 6 * n, stage + 7 * n, mean, mean + n, mean + 3 * n, error, error + 1, table,
        fresh, fresh + contacts - stage,
    )  # fmt: skip


class Cells(NamedTuple):
    """Addresses of the polynomials of the row over the mesh phase."""

    edge: Any
    degree: Any
    start: Any
    coefficients: Any
    varying: Any
    varies: int  #: how many factors vary


class Trial(NamedTuple):
    """A step within a segment between two events."""

    cell: int  #: cell of its beginning
    last: int  #: cell behind those of the segment
    phase: float  #: [-]
    width: float  #: [-]


@nb.njit(**INNER)
def find_cell(cells: Cells, cell: int, first: int, last: int, phase: float) -> int:
    """Cell of a phase within the segment from cell ``first`` to before ``last``."""
    while cell < last - 1 and phase > cells.edge[cell + 1]:
        cell += 1
    while cell > first and phase < cells.edge[cell]:
        cell -= 1
    return cell


@nb.njit(**INNER)
def fill_row(cells: Cells, cell: int, phase: float, row: Array) -> None:
    """Evaluate the varying factors of the row at a phase of the cell."""
    low, high = cells.edge[cell], cells.edge[cell + 1]
    x = ((phase - low) - (high - phase)) / (high - low)
    top, at = cells.degree[cell], cells.start[cell]
    for item in range(cells.varies):
        value = cells.coefficients[at + top]
        for k in range(top):
            value = value * x + cells.coefficients[at + top - 1 - k]
        row[cells.varying[item]] = value
        at += top + 1


@nb.njit(**INNER)
def fill_within(cells: Cells, trial: Trial, theta: float, cell: int, row: Array) -> int:
    """Evaluate the row at a fraction of a step; returns its cell."""
    phase = trial.phase + theta * trial.width
    cell = find_cell(cells, cell, trial.cell, trial.last, phase)
    fill_row(cells, cell, phase, row)
    return cell


@nb.njit(**INNER)
def set_scale(width: int, code: Index, rtol: float, atol: Array, w: Array) -> None:
    """Update the largest size and the inverse tolerance of each state."""
    n, o = code[0], adaptive_slots(code)
    for i in range(2 * n):
        size, inverse = (o.size + i) * width, (o.tolerance + i) * width
        for lane in range(width):
            now = abs(w[i * width + lane])
            if now > w[size + lane]:
                w[size + lane] = now
            w[inverse + lane] = 1.0 / (atol[i] + rtol * w[size + lane])


@nb.njit(**INNER)
def try_step(lanes: Any, law: Law, cells: Cells, trial: Trial, w: Array) -> float:
    """Step every lane, from buffer 0 to buffer 2; returns the worst error over the tolerance."""
    keep_apart()
    s, o = slots_of(law.code), adaptive_slots(law.code)
    n = s.n
    h = trial.width * load(lanes, w, o.period)
    store(w, s.h, h)
    for i in range(n):
        store(w, o.rate + i, load(lanes, w, n + i))
    cell = trial.cell
    for stage in range(1, 7):
        if stage < 6:
            cell = fill_within(cells, trial, NODES[stage], cell, law.rows)
        buffer = I64(2) if stage == 6 else I64(1)
        target = 2 * n * buffer
        for i in range(n):
            dq = MATRIX[stage, 0] * load(lanes, w, o.rate + i)
            dv = MATRIX[stage, 0] * load(lanes, w, o.stage + i)
            for j in range(1, stage):
                factor = MATRIX[stage, j]
                dq = dq + factor * load(lanes, w, o.rate + j * n + i)
                dv = dv + factor * load(lanes, w, o.stage + j * n + i)
            v = load(lanes, w, n + i) + h * dv
            store(w, target + i, load(lanes, w, i) + h * dq)
            store(w, target + n + i, v)
            store(w, o.rate + stage * n + i, v)
            if stage == 6:
                store(w, o.mean + i, dq)
        acceleration(lanes, law, I64(0), buffer, o.stage + stage * n, w)
    total = 0.0 * h
    for i in range(2 * n):
        at = (o.rate if i < n else o.stage - n) + i
        error = WEIGHT_ERROR[0] * load(lanes, w, at)
        for j in range(2, 7):
            error = error + WEIGHT_ERROR[j] * load(lanes, w, at + j * n)
        error = error * h * load(lanes, w, o.tolerance + i)
        total = total + error * error
    store(w, o.error, total)
    worst = 0.0
    for lane in range(len(lanes)):
        value = w[o.error * len(lanes) + lane]
        if not np.isfinite(value):
            return np.inf
        worst = max(worst, value)
    return math.sqrt(worst)


@nb.njit(**INNER)
def between(lanes: Any, law: Law, theta: float, speed: bool, w: Array) -> None:
    """State at the fraction ``theta`` of the step, into buffer 1; velocities if ``speed``."""
    slots, o = slots_of(law.code), adaptive_slots(law.code)
    n, h = slots.n, load(lanes, w, slots.h)
    b5, b1, b4, b2, b3 = quintic_place(theta)
    d5, d1, d4, d2, d3 = quintic_speed(theta)
    for i in range(n):
        v0, v1 = load(lanes, w, n + i), load(lanes, w, 5 * n + i)
        a0, a1 = load(lanes, w, o.stage + i), load(lanes, w, o.last + i)
        mean = load(lanes, w, o.mean + i)
        q = b5 * mean + b1 * v0 + b4 * v1 + h * (b2 * a0 + b3 * a1)
        store(w, 2 * n + i, load(lanes, w, i) + h * q)
        if speed:
            store(w, 3 * n + i, d5 * mean + d1 * v0 + d4 * v1 + h * (d2 * a0 + d3 * a1))


@nb.njit(**INNER)
def _distances(lanes: Any, law: Law, buffer: int, slot: int, w: Array) -> None:
    """Distances of every contact to the boundaries of its side, two slots each from ``slot``."""
    s, cursor = slots_of(law.code), first_contact(law, I64(0), buffer)
    for j in range(s.contacts):
        if is_dead_zone(law, cursor):
            upper, lower = clearances(lanes, law, s, cursor, j, w)
            store(w, slot + 2 * j, upper)
            store(w, slot + 2 * j + 1, lower)
        cursor = next_contact(law, cursor)


@nb.njit(**INNER)
def may_cross(lanes: Any, law: Law, cells: Cells, trial: Trial, w: Array) -> bool:
    """Whether a contact of any lane may have left its side within the last trial step."""
    keep_apart()
    contacts, table = law.code[1], adaptive_slots(law.code).table
    cell = trial.cell
    for m in range(5):
        theta = 0.25 * m
        cell = fill_within(cells, trial, theta, cell, law.rows)
        if 0 < m < 4:
            between(lanes, law, theta, False, w)
        buffer = I64(0) if m == 0 else (I64(2) if m == 4 else I64(1))
        _distances(lanes, law, buffer, table + 2 * contacts * m, w)
    crossing = False
    cursor = first_contact(law, I64(0), I64(0))
    for j in range(contacts):
        dead = is_dead_zone(law, cursor)
        cursor = next_contact(law, cursor)
        if not dead:
            continue
        for slot in range(table + 2 * j, table + 2 * j + 2):
            before = load(lanes, w, slot)
            now = load(lanes, w, slot + 2 * contacts)
            for m in range(2, 5):
                after = load(lanes, w, slot + 2 * contacts * m)
                slope = after - before
                reach = greatest(slope, 0.0 * slope - slope)
                if any_negative(now - 0.25 * reach) or any_negative(after):
                    crossing = True
                before, now = now, after
    return crossing
