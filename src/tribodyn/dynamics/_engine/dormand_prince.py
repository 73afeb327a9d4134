"""One Dormand-Prince step, its error, the polynomial of the step and the row at any mesh phase.

Seven stages give a solution of fifth order and, by comparison with one of fourth, its error
(Dormand and Prince 1980). The last stage is the first of the next step. Between the ends the
position is the quintic Hermite interpolant of position, velocity and acceleration at both ends,
and the velocity is its derivative: of sixth and fifth order, hence no worse than the step.
The lanes of a block step at the same time, each from its phase over its width with its row, so that
no lane depends on the others. The readable version is in ``tests/plain``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numba as nb
import numpy as np

from tribodyn.compiled.jit import INNER
from tribodyn.dynamics._engine.contact_forces import I64, acceleration, slots_of
from tribodyn.dynamics._engine.lanes import (
    Lanes,
    ahead,
    greatest,
    keep_apart,
    load,
    magnitude,
    quotient,
    store,
)
from tribodyn.dynamics._engine.method import Law
from tribodyn.dynamics._engine.row_table import POINTS
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
    allowed: int  #: absolute tolerance of each state, then the relative one
    tolerance: int  #: inverse tolerance of each state
    error: int  #: square of the error of the step over the tolerance
    table: int  #: distances of every contact at five places of the step
    fresh: int  #: marks of contacts that have just changed their sides
    row: int  #: factors at the phase of the stage
    end: int


@nb.njit(forceinline=True, **INNER)
def adaptive_slots(code: Index) -> AdaptiveSlots:
    """Layout of the slots of the method."""
    s = slots_of(code)
    n, stage, contacts = s.n, s.end, s.contacts
    mean = stage + 14 * n
    error = mean + 7 * n + 1
    fresh = error + 1 + 10 * contacts
    row = fresh + contacts
    return AdaptiveSlots(
        stage, stage + 6 * n, stage + 7 * n, mean, mean + n, mean + 3 * n, mean + 5 * n + 1, error,
        error + 1, fresh, row, row + code[2],
    )  # fmt: skip


class Course(Protocol):
    """A trajectory during its integration, and what is reported of it."""

    row: int  #: first factor in the rows
    first: int  #: first segment of the table, and the one behind the last
    last: int
    varying: int  #: first of the columns that vary
    columns: int  #: how many vary
    origin: int  #: first power of the table
    period: float  #: [s]
    cycle: int
    segment: int
    begin: float  #: phase of its event [-]
    intervals: int  #: their number, and how many there are per phase
    rate: float
    powers: int  #: first power of the segment
    phase: float  #: where it is [-]
    width: float  #: of its step [-]
    cut: int  #: 1 if the step ends at a crossing
    new_error: float  #: error of the step over the tolerance
    plan: float  #: width of the next step, and error of the last one
    error: float
    low: float  #: fractions of the step between which the crossing is searched; 2: none
    theta: float
    changes: int  #: of side since the phase ``counted``
    counted: float
    point: int  #: next output point
    widest: float
    steps: int
    rejections: int
    crossings: int
    reason: int  #: of a failure: 1 step too narrow, 2 chatter
    contact: int  #: that chatters


#: The same as a record of an array.
COURSE = np.dtype(
    [
        (name, np.int64 if kind == "int" else np.float64)
        for name, kind in Course.__annotations__.items()
    ]
)


#: The courses of the trajectories of a block.
Courses = Sequence[Course]


class Rows(NamedTuple):
    """Addresses of the tables of all trajectories."""

    events: Array
    first: Index
    varying: Index
    powers: Array


@nb.njit(**INNER)
def fill_row(rows: Rows, course: Course, phase: float, width: int, row: Array) -> None:
    """Evaluate the varying factors of the row of one of ``width`` lanes at a phase."""
    keep_apart()
    x = (phase - course.begin) * course.rate
    interval = min(max(I64(x), 0), course.intervals - 1)
    x -= interval
    columns, at = course.columns, course.powers + interval * POINTS * course.columns
    for item in range(columns):
        total = rows.powers[at + item]
        for k in range(1, POINTS):
            total = total * x + rows.powers[at + k * columns + item]
        row[rows.varying[course.varying + item] * width] = total


@nb.njit(**INNER)
def fill_lanes(
    lanes: Lanes,
    law: Law,
    rows: Rows,
    courses: Courses,
    theta: float,
    w: Array,
) -> None:
    """Interpolate the rows of all lanes with a step at a fraction of it."""
    width, row = len(lanes), adaptive_slots(law.code).row
    for lane in range(width):
        if courses[lane].width > 0.0:
            at = courses[lane].phase + theta * courses[lane].width
            fill_row(rows, courses[lane], at, width, ahead(w, row * width + lane))


@nb.njit(**INNER)
def set_scale(lanes: Lanes, code: Index, w: Array) -> None:
    """Update the largest size and the inverse tolerance of each state."""
    o = adaptive_slots(code)
    relative = load(lanes, w, o.tolerance - 1)
    for i in range(2 * code[0]):
        size = greatest(load(lanes, w, o.size + i), magnitude(load(lanes, w, i)))
        store(w, o.size + i, size)
        allowed = load(lanes, w, o.allowed + i) + relative * size
        store(w, o.tolerance + i, quotient(0.0 * size + 1.0, allowed))


@nb.njit(**INNER)
def try_step(lanes: Lanes, law: Law, rows: Rows, courses: Courses, w: Array) -> None:
    """Step from buffer 0 to buffer 2, and its error."""
    keep_apart()
    s, o = slots_of(law.code), adaptive_slots(law.code)
    n, h = s.n, load(lanes, w, s.h)
    zero = 0.0 * h
    for i in range(n):
        store(w, o.rate + i, load(lanes, w, n + i))
    for stage in range(1, 7):
        if stage < 6:
            fill_lanes(lanes, law, rows, courses, NODES[stage], w)
        buffer = I64(2) if stage == 6 else I64(1)
        target = 2 * n * buffer
        for i in range(n):
            dq, dv = zero, zero
            for j in range(stage):
                dq = dq + MATRIX[stage, j] * load(lanes, w, o.rate + j * n + i)
                dv = dv + MATRIX[stage, j] * load(lanes, w, o.stage + j * n + i)
            v = load(lanes, w, n + i) + h * dv
            store(w, target + i, load(lanes, w, i) + h * dq)
            store(w, target + n + i, v)
            store(w, o.rate + stage * n + i, v)
            store(w, o.mean + i, dq)
        acceleration(lanes, law, I64(0), buffer, o.stage + stage * n, w)
    total = zero
    for i in range(2 * n):
        at = (o.rate if i < n else o.stage - n) + i
        error = zero
        for j in range(7):
            error = error + WEIGHT_ERROR[j] * load(lanes, w, at + j * n)
        error = error * h * load(lanes, w, o.tolerance + i)
        total = total + error * error
    store(w, o.error, total)


@nb.njit(**INNER)
def between(lanes: Lanes, law: Law, theta: float, speed: bool, w: Array) -> None:
    """State at the fraction ``theta`` of the step, into buffer 1; velocities if ``speed``."""
    s, o = slots_of(law.code), adaptive_slots(law.code)
    n, h = s.n, load(lanes, w, s.h)
    b5, b1, b4, b2, b3 = quintic_place(theta)
    d5, d1, d4, d2, d3 = quintic_speed(theta)
    for i in range(n):
        v0, v1 = load(lanes, w, n + i), load(lanes, w, 5 * n + i)
        mean = load(lanes, w, o.mean + i)
        a0, a1 = load(lanes, w, o.stage + i), load(lanes, w, o.last + i)
        q = b5 * mean + b1 * v0 + b4 * v1 + h * (b2 * a0 + b3 * a1)
        store(w, 2 * n + i, load(lanes, w, i) + h * q)
        if speed:
            store(w, 3 * n + i, d5 * mean + d1 * v0 + d4 * v1 + h * (d2 * a0 + d3 * a1))
