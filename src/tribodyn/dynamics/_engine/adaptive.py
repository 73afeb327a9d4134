"""Integrate trajectories with adaptive steps, from event to event and from crossing to crossing.

Steps end at events, where row, sides and accelerations are recomputed. A step in which a contact
leaves its side is repeated up to the crossing, which the polynomial of the step locates; there the
contact changes its side. The lanes of a block step together, each with its own control, and a lane
whose trajectory ends takes the next of the queue. The steps of a trajectory follow from it alone,
so that it is the same in any ensemble and on any number of threads.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled.cache import cached_njit
from tribodyn.compiled.jit import INNER, JIT, ONCE
from tribodyn.dynamics._engine.contact_forces import (
    I64,
    acceleration,
    clearances,
    first_contact,
    is_dead_zone,
    next_contact,
    set_sides,
    slots_of,
)
from tribodyn.dynamics._engine.crossing import (
    KIND,
    NEAR,
    NOW,
    WIDTH,
    begin_search,
    change_sides,
    continue_search,
    measure,
)
from tribodyn.dynamics._engine.dormand_prince import (
    COURSE,
    SINGLE,
    Course,
    Courses,
    Rows,
    adaptive_slots,
    between,
    fill_lanes,
    fill_row,
    set_scale,
    try_step,
)
from tribodyn.dynamics._engine.lanes import Lanes, address, ahead, keep_apart, on_line, store
from tribodyn.dynamics._engine.marching import has_dead_zones, put_lane, set_up, take_lane
from tribodyn.dynamics._engine.method import Law, kernel_digest
from tribodyn.dynamics._engine.row_table import POINTS
from tribodyn.dynamics.equations.divergence import CHATTERS
from tribodyn.dynamics.equations.program import Program
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

#: Changes of side within this much mesh phase; more is chatter, and is reported.
MAX_CHANGES, CHATTER = 64, 1e-6
#: Narrowest step in phase that may be rejected, and narrowest part of one up to a crossing.
NARROWEST, _SHORTEST = 1e-13, 1e-15


class JoinedTables(NamedTuple):
    """Row tables of all trajectories, one behind the other; a course says which part is its."""

    rows: Array
    events: Array
    first: Index
    varying: Index
    powers: Array


class Output(NamedTuple):
    """Output of the integration, for each trajectory."""

    points: Array  #: mesh phases to record at, from 0
    record: Array  #: receives the states there and at the end; empty to record nothing
    trail: Array  #: receives the steps; empty to store none


class Block(NamedTuple):
    """Lanes that step together, and one of them taken out of the block."""

    width: int
    law: Law  #: of all lanes
    alone: Law  #: of the one taken out
    rows: Rows
    w: Array  #: slots of all lanes
    single: Array  #: and of the one
    search: Array  #: numbers of the search for a crossing, of every lane


@nb.njit(**INNER)
def _growth(error: float, before: float) -> float:
    """Factor for the next step from the errors of this step and the one before."""
    factor = 0.9 * max(error, 1e-10) ** -0.17 * max(before, 1e-4) ** 0.04
    return float(min(max(factor, 0.2), 5.0))


@nb.njit(**INNER)
def _shrink(error: float) -> float:
    """Factor for the next step after one that was rejected."""
    return max(0.2, 0.9 * error**-0.2) if np.isfinite(error) else 0.2


@nb.njit(**INNER)
def _planned_width(plan: float, remaining: float) -> float:
    """Width of the next step; two equal ones rather than a long and a tiny one before an event."""
    if plan >= remaining:
        return remaining
    return 0.5 * remaining if plan > 0.5 * remaining else plan


@nb.njit(**INNER)
def _take(block: Block, lane: int) -> None:
    """Take a lane out of the block."""
    end = adaptive_slots(block.law.code).end
    take_lane(lane, block.width, end, block.w, block.single)


@nb.njit(**INNER)
def _put(block: Block, lane: int) -> None:
    """Put a lane back into the block."""
    end = adaptive_slots(block.law.code).end
    put_lane(lane, block.width, I64(0), end, block.w, block.single)


@nb.njit(**INNER)
def _measure_at(block: Block, course: Course, theta: float, scratch: Array, place: int) -> None:
    """Compressions and gaps at a fraction of the step, on its polynomial."""
    law, w = block.alone, block.single
    fill_row(block.rows, course, course.phase + theta * course.width, I64(1), law.rows[0])
    between(SINGLE, law, theta, False, w)
    measure(law, I64(0), I64(1), w, scratch, place)


@nb.njit(**ONCE)
def _tabulate_distances(lanes: Lanes, block: Block, courses: Courses) -> None:
    """Distances of every contact to both boundaries of its side, at five places of the step."""
    law, w = block.law, block.w
    keep = slots_of(law.code)
    for m in range(5):
        fill_lanes(lanes, law, block.rows, courses, 0.25 * m, w)
        between(lanes, law, 0.25 * m, False, w)
        slot = adaptive_slots(law.code).table + 2 * keep.contacts * m
        cursor = first_contact(law, I64(0), I64(1))
        for j in range(keep.contacts):
            if is_dead_zone(law, cursor):
                upper, lower = clearances(lanes, law, keep, cursor, j, w)
                store(w, slot + 2 * j, upper)
                store(w, slot + 2 * j + 1, lower)
            cursor = next_contact(law, cursor)


@nb.njit(**INNER)
def _turns_negative(a: float, b: float, c: float) -> bool:
    """Whether the parabola through three distances falls below zero between them."""
    bend = a - 2.0 * b + c
    return bend > 0.0 and abs(c - a) < 2.0 * bend and 8.0 * b * bend < (c - a) ** 2


@nb.njit(**INNER)
def _may_leave(code: Index, width: int, w: Array) -> bool:
    """Whether a tabulated distance of a lane, or a parabola through three, is below zero."""
    table, stride = adaptive_slots(code).table, 2 * code[1]
    for at in range(table, table + stride):
        for m in range(1, 5):
            a, b = w[(at + (m - 1) * stride) * width], w[(at + m * stride) * width]
            if b < 0.0 or (m < 4 and _turns_negative(a, b, w[(at + (m + 1) * stride) * width])):
                return True
    return False


@nb.njit(**INNER)
def _lowest_is_beyond(
    block: Block, course: Course, theta: float, item: int, scratch: Array
) -> bool:
    """Whether a contact is beyond a boundary at a fraction where its distance is least."""
    _measure_at(block, course, theta, scratch, I64(NOW))
    j = item // 2
    d, gap = scratch[WIDTH * j + NOW], scratch[WIDTH * j + NOW + 1]
    side = block.single[slots_of(block.law.code).side + j]
    beyond: bool = (side * d - gap if side != 0.0 else gap - (d if item % 2 == 0 else -d)) < 0.0
    return beyond


@nb.njit(**ONCE)
def _enclose(block: Block, course: Course, scratch: Array) -> tuple[float, float]:
    """Bracket the first departure of a contact from its side; an upper end of 2 means none."""
    law, w = block.alone, block.single
    s, contacts = slots_of(law.code), law.code[1]
    table, stride, low, high = adaptive_slots(law.code).table, 2 * contacts, 0.0, 2.0
    cursor = first_contact(law, I64(0), I64(0))
    for j in range(contacts):
        dead = is_dead_zone(law, cursor)
        cursor = next_contact(law, cursor)
        for item in range(2 * j, 2 * j + 2 if dead else 2 * j):
            if w[s.side + j] != 0.0 and item % 2 == 1:
                continue
            at = table + item
            for m in range(1, 5):
                b = w[at + m * stride]
                if 0.25 * (m - 1) >= high:
                    break
                if b < 0.0:
                    if 0.25 * m < high:
                        low, high = 0.25 * (m - 1), 0.25 * m
                    break
                if m == 4:
                    break
                a, c = w[at + (m - 1) * stride], w[at + (m + 1) * stride]
                if _turns_negative(a, b, c):
                    lowest = 0.25 * m + 0.125 * (a - c) / (a - 2.0 * b + c)
                    if _lowest_is_beyond(block, course, lowest, item, scratch):
                        if lowest < high:
                            low, high = 0.25 * (m if lowest > 0.25 * m else m - 1), lowest
                        break
    return low, high


@nb.njit(**ONCE)
def _first_crossing(block: Block, course: Course, scratch: Array) -> None:
    """Set start of the search, and fraction at which the first contacts leave (2 if none does)."""
    law, w = block.alone, block.single
    s, o, contacts = slots_of(law.code), adaptive_slots(law.code), law.code[1]
    low, high = _enclose(block, course, scratch)
    course.low, course.theta = low, 2.0
    if high > 1.0:
        return
    cursor = first_contact(law, I64(0), I64(0))
    for j in range(contacts):
        kind = 1.0 if w[o.fresh + j] != 0.0 and low == 0.0 else 0.0
        scratch[WIDTH * j + KIND] = kind if is_dead_zone(law, cursor) else -1.0
        cursor = next_contact(law, cursor)
    _measure_at(block, course, low, scratch, I64(NEAR))
    _measure_at(block, course, high, scratch, I64(NOW))
    target = begin_search(scratch, contacts, low, high, s.side, w)
    if target < 0.0:
        return
    converged = False
    while not converged:
        _measure_at(block, course, target, scratch, I64(NOW))
        converged, following = continue_search(scratch, contacts, low, target, s.side, w)
        if not converged:
            target = following
    course.theta = target


@nb.njit(**INNER)
def _begin_anew(block: Block, course: Course, at_event: bool) -> None:
    """Row and accelerations at the beginning of a step, where forces may have jumped."""
    keep_apart()
    law, w = block.alone, block.single
    fill_row(block.rows, course, course.phase, I64(1), law.rows[0])
    if at_event:
        set_sides(SINGLE, law, I64(0), I64(0), w)
    acceleration(SINGLE, law, I64(0), I64(0), adaptive_slots(law.code).stage, w)


@nb.njit(**ONCE)
def _begin_segment(block: Block, course: Course) -> None:
    """Begin at an event, with the lane taken out of the block."""
    rows, segment = block.rows, course.segment
    course.phase = course.begin = course.counted = rows.events[segment]
    course.intervals = rows.first[segment + 1] - rows.first[segment]
    course.rate = course.intervals / (rows.events[segment + 1] - course.begin)
    course.powers = course.origin + rows.first[segment] * POINTS * course.columns
    course.changes, course.cut, course.theta = 0, 0, 2.0
    _begin_anew(block, course, True)
    for j in range(block.law.code[1]):
        block.single[adaptive_slots(block.law.code).fresh + j] = 0.0


@nb.njit(**INNER)
def _plan_step(block: Block, course: Course, lane: int) -> None:
    """Set the width of the next step, or of the part of the last one up to a crossing."""
    # Repeat the step up to the crossing: fifth order instead of its polynomial.
    keep_apart()
    s, width = slots_of(block.law.code), block.width
    course.cut = 1 if course.theta <= 1.0 else 0
    if course.cut:
        course.width = course.theta * course.width
    else:
        end = block.rows.events[course.segment + 1]
        course.width = _planned_width(course.plan, end - course.phase)
    block.w[s.h * width + lane] = course.width * course.period


@nb.njit(**INNER)
def _store_step(block: Block, course: Course, lane: int, output: Output, number: int) -> None:
    """Record the states at the output points of a step without its end, and what it was."""
    code, width, points = block.law.code, block.width, output.points
    n, o, end = code[0], adaptive_slots(code), course.phase + course.width
    at = course.cycle * points.size
    if output.record.shape[1] > 0 and course.point < points.size and points[course.point] < end:
        _take(block, lane)
        while course.point < points.size and points[course.point] < end:
            theta = max((points[course.point] - course.phase) / course.width, 0.0)
            between(SINGLE, block.alone, theta, True, block.single)
            for i in range(2 * n):
                output.record[number, at + course.point, i] = block.single[2 * n + i]
            course.point += 1
    if course.steps < output.trail.shape[1]:
        trail, w = output.trail[number, course.steps], ahead(block.w, lane)
        trail[0], trail[1] = course.phase, course.width
        for i in range(n):
            trail[2 + i], trail[2 + n + i] = w[i * width], w[(n + i) * width]
            trail[2 + 2 * n + i] = w[(o.stage + i) * width]
            trail[2 + 3 * n + i] = w[(o.mean + i) * width]
            trail[2 + 4 * n + i] = w[(5 * n + i) * width]
            trail[2 + 5 * n + i] = w[(o.last + i) * width]
    course.steps += 1
    course.widest = max(course.widest, course.width)


@nb.njit(**INNER)
def _accept(block: Block, course: Course, lane: int) -> None:
    """Copy the end of the step to the start of the next."""
    n, o, width = block.law.code[0], adaptive_slots(block.law.code), block.width
    w, end = ahead(block.w, lane), block.rows.events[course.segment + 1]
    for i in range(2 * n):
        w[i * width] = w[(4 * n + i) * width]
    for i in range(n):
        w[(o.stage + i) * width] = w[(o.last + i) * width]
    for j in range(block.law.code[1]):
        w[(o.fresh + j) * width] = 0.0
    course.phase = end if course.width >= end - course.phase else course.phase + course.width


@nb.njit(**ONCE)
def _change_sides(block: Block, course: Course, scratch: Array) -> None:
    """Change the sides of the contacts that cross."""
    w, s, o = block.single, slots_of(block.law.code), adaptive_slots(block.law.code)
    contact = change_sides(scratch, s.contacts, course.low, course.theta, s.side, w)
    for j in range(s.contacts):
        w[o.fresh + j] = 1.0 if scratch[WIDTH * j + KIND] > 0.0 else 0.0
    _begin_anew(block, course, False)
    course.theta = 2.0
    if course.phase - course.counted > CHATTER:
        course.counted, course.changes = course.phase, 0
    course.changes += 1
    course.crossings += 1
    if course.changes > MAX_CHANGES:
        course.reason, course.contact = CHATTERS, contact


@nb.njit(**ONCE)
def _end_step(
    block: Block, course: Course, lane: int, switching: bool, output: Output, number: int
) -> None:
    """Accept or reject the step of a lane, up to the crossing in it."""
    scratch = ahead(block.search, lane * WIDTH * (block.law.code[1] + 1))
    cut, error = course.cut, course.new_error
    if not error <= 1.0 and not cut:
        course.rejections += 1
        course.reason = 1 if course.width < NARROWEST else 0
        course.plan = course.width * _shrink(error)
        return
    if switching and not cut and _may_leave(block.law.code, block.width, ahead(block.w, lane)):
        _take(block, lane)
        _first_crossing(block, course, scratch)
        if course.theta <= 1.0 and course.theta * course.width > _SHORTEST:
            return
    crossing = course.theta <= 1.0
    if cut or not crossing:
        _store_step(block, course, lane, output, number)
        _accept(block, course, lane)
    if crossing:
        _take(block, lane)
        _change_sides(block, course, scratch)
        _put(block, lane)
    elif course.width == course.plan:
        course.plan = course.width * _growth(error, course.error)
        course.error = error
    else:
        course.plan = max(course.plan, course.width * _growth(error, course.error))


@nb.njit(**ONCE)
def _end_segment(block: Block, course: Course, lane: int, cycles: int) -> None:
    """Begin the next segment, unless it was the last of the last cycle."""
    if course.phase < block.rows.events[course.segment + 1]:
        return
    course.segment += 1
    if course.segment == course.last:
        course.segment, course.point = course.first, 0
        course.cycle += 1
    if course.cycle < cycles:
        _take(block, lane)
        _begin_segment(block, course)
        _put(block, lane)


@cached_njit(kernel_digest(), "the adaptive engine", "ten seconds", **JIT)
def march_adaptive(
    lanes: Lanes,
    program: Program,
    tables: JoinedTables,
    load: Array,
    states: tuple[Array, Array],
    tolerance: Array,
    queue: np.recarray,
    cycles: int,
    output: Output,
    stop: Index,
) -> int:
    """Integrate trajectories over ``cycles`` mesh cycles; after a failure to its step.

    ``load`` (c, n + 6) is that of each with its factors; ``states`` the states (c, 2 n) and
    the largest size of each so far, both overwritten; ``tolerance`` (c, 2 n + 1) absolute
    ones and the relative one; ``queue`` (c,) the courses. Returns :data:`STOPPED` after an
    interruption, else 0.
    """
    width, code, columns = len(lanes), program.code, program.code[2]
    n, s, o = code[0], slots_of(code), adaptive_slots(code)
    scratch_size = WIDTH * (s.contacts + 1)
    work = np.zeros(o.end * (width + 1) + 8)
    search = np.zeros(scratch_size * width)
    w = on_line(address(work))
    single = ahead(w, o.end * width)
    rows = Rows(
        address(tables.events), address(tables.first), address(tables.varying),
        address(tables.powers),
    )  # fmt: skip
    law = Law(address(code), address(program.reads), (ahead(w, o.row * width),))
    alone = Law(law.code, law.reads, (ahead(single, o.row),))
    block = Block(width, law, alone, rows, w, single, address(search))
    switching = has_dead_zones(alone)
    courses, number, following = np.zeros(width, COURSE), np.full(width, -1), 0
    while stop[0] == 0:
        active = 0
        for lane in range(width):
            course = courses[lane]
            if number[lane] < 0 and following < queue.size:
                c = following
                courses[lane], number[lane] = queue[c], c
                for slot in range(o.end):
                    single[slot] = 0.0
                set_up(1, law.code, queue.period[c:], load[c:], states[0][c:], single)
                for i in range(2 * n):
                    single[o.size + i] = states[1][c, i]
                for i in range(2 * n + 1):
                    single[o.allowed + i] = tolerance[c, i]
                for column in range(columns):
                    single[o.row + column] = tables.rows[course.row + column]
                set_scale(SINGLE, law.code, single)
                _begin_segment(block, course)
                _put(block, lane)
                following += 1
            if number[lane] >= 0:
                active += 1
                _plan_step(block, course, lane)
        if active == 0:
            break
        try_step(lanes, law, rows, courses, w)
        for lane in range(width):
            total = w[o.error * width + lane]
            courses[lane].new_error = math.sqrt(total) if math.isfinite(total) else math.inf
        if switching:
            _tabulate_distances(lanes, block, courses)
        for lane in range(width):
            c, course = number[lane], courses[lane]
            if c < 0:
                continue
            _end_step(block, course, lane, switching, output, c)
            if course.reason == 0:
                _end_segment(block, course, lane, cycles)
            if course.reason != 0 or course.cycle == cycles:
                _take(block, lane)
                for i in range(2 * n):
                    states[0][c, i] = single[i]
                    states[1][c, i] = max(single[o.size + i], abs(single[i]))
                    if output.record.shape[1] > 0:
                        output.record[c, cycles * output.points.size, i] = single[i]
                queue[c] = course
                course.width, number[lane], w[s.h * width + lane] = 0.0, -1, 0.0
        set_scale(lanes, law.code, w)
    # The addresses hold only as long as their owners are in use.
    search[0] = work[0]
    return STOPPED if stop[0] != 0 else 0
