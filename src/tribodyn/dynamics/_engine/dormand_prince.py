"""One Dormand-Prince step, its error, the polynomial of the step and the row at any mesh phase.

Seven stages give a solution of fifth order and, by comparison with one of fourth, its error
(Dormand and Prince 1980). The last stage is the first of the next step. Between the ends the
position is the quintic Hermite interpolant of position, velocity and acceleration at both ends,
and the velocity is its derivative: of sixth and fifth order, hence no worse than the step.
Every trajectory has steps of its own, so that no vectors of lanes appear: slots are plain numbers.
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
    slots_of,
)
from tribodyn.dynamics._engine.lanes import keep_apart
from tribodyn.dynamics._engine.method import INNER
from tribodyn.dynamics._engine.row_table import DENOMINATORS, POINTS
from tribodyn.dynamics.equations import motion
from tribodyn.types import Array, Index

quintic_place = nb.njit(**INNER)(motion.quintic_place)
quintic_speed = nb.njit(**INNER)(motion.quintic_speed)

#: A block of a single lane, for the functions of the law.
SINGLE = (0.0,)

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
    period = mean + 5 * n
    fresh = period + 1 + 10 * contacts
    return AdaptiveSlots(
        stage, stage + 6 * n, stage + 7 * n, mean, mean + n, mean + 3 * n, period, period + 1,
        fresh, fresh + contacts,
    )  # fmt: skip


class Rows(NamedTuple):
    """Addresses of the table between whose rows is interpolated."""

    events: Any
    first: Any
    varying: Any
    varies: int  #: how many columns vary
    columns: int
    values: Any
    weights: Any  #: of the nodes of an interpolation
    places: Any  #: of their rows in the values


class Trial(NamedTuple):
    """A step within the segment between two events."""

    segment: int
    phase: float  #: [-]
    width: float  #: [-]


@nb.njit(**INNER)
def fill_row(rows: Rows, segment: int, phase: float, row: Array) -> None:
    """Interpolate the varying factors of the row at a phase of the segment."""
    low, high = rows.events[segment], rows.events[segment + 1]
    begin, end = rows.first[segment], rows.first[segment + 1]
    last = 2 * (end - begin)
    points = min(I64(POINTS), last + 1)
    x = (phase - low) / (high - low) * last
    start = min(max(I64(x) - 2, 0), last + 1 - points)
    weights, at = rows.weights, rows.places
    for k in range(points):
        node = start + k
        step = min(node >> 1, end - begin - 1)
        at[k] = (3 * (begin + step) + node - 2 * step) * rows.columns
        weights[k] = DENOMINATORS[points, k]
        for j in range(points):
            if j != k:
                weights[k] *= x - (start + j)
    for k in range(points, POINTS):
        at[k], weights[k] = at[0], 0.0
    for item in range(rows.varies):
        column = rows.varying[item]
        total = 0.0
        for k in range(POINTS):
            total += weights[k] * rows.values[at[k] + column]
        row[column] = total


@nb.njit(**INNER)
def fill_within(rows: Rows, trial: Trial, theta: float, row: Array) -> None:
    """Interpolate the row at a fraction of a step."""
    fill_row(rows, trial.segment, trial.phase + theta * trial.width, row)


@nb.njit(**INNER)
def set_scale(code: Index, rtol: float, atol: Array, w: Array) -> None:
    """Update the largest size and the inverse tolerance of each state."""
    o = adaptive_slots(code)
    for i in range(2 * code[0]):
        w[o.size + i] = max(w[o.size + i], abs(w[i]))
        w[o.tolerance + i] = 1.0 / (atol[i] + rtol * w[o.size + i])


@nb.njit(**INNER)
def try_step(law: Law, rows: Rows, trial: Trial, w: Array) -> float:
    """Step from buffer 0 to buffer 2; returns the error over the tolerance."""
    keep_apart()
    s, o = slots_of(law.code), adaptive_slots(law.code)
    n, h = s.n, trial.width * w[o.period]
    w[s.h] = h
    for i in range(n):
        w[o.rate + i] = w[n + i]
    for stage in range(1, 7):
        if stage < 6:
            fill_within(rows, trial, NODES[stage], law.rows)
        buffer = I64(2) if stage == 6 else I64(1)
        target = 2 * n * buffer
        for i in range(n):
            dq, dv = 0.0, 0.0
            for j in range(stage):
                dq += MATRIX[stage, j] * w[o.rate + j * n + i]
                dv += MATRIX[stage, j] * w[o.stage + j * n + i]
            v = w[n + i] + h * dv
            w[target + i] = w[i] + h * dq
            w[target + n + i] = w[o.rate + stage * n + i] = v
            w[o.mean + i] = dq
        acceleration(SINGLE, law, I64(0), buffer, o.stage + stage * n, w)
    total = 0.0
    for i in range(2 * n):
        at = (o.rate if i < n else o.stage - n) + i
        error = 0.0
        for j in range(7):
            error += WEIGHT_ERROR[j] * w[at + j * n]
        total += (error * h * w[o.tolerance + i]) ** 2
    return math.sqrt(total) if math.isfinite(total) else math.inf


@nb.njit(**INNER)
def between(law: Law, theta: float, speed: bool, w: Array) -> None:
    """State at the fraction ``theta`` of the step, into buffer 1; velocities if ``speed``."""
    s, o = slots_of(law.code), adaptive_slots(law.code)
    n, h = s.n, w[s.h]
    b5, b1, b4, b2, b3 = quintic_place(theta)
    d5, d1, d4, d2, d3 = quintic_speed(theta)
    for i in range(n):
        v0, v1, mean = w[n + i], w[5 * n + i], w[o.mean + i]
        a0, a1 = w[o.stage + i], w[o.last + i]
        w[2 * n + i] = w[i] + h * (b5 * mean + b1 * v0 + b4 * v1 + h * (b2 * a0 + b3 * a1))
        if speed:
            w[3 * n + i] = d5 * mean + d1 * v0 + d4 * v1 + h * (d2 * a0 + d3 * a1)
