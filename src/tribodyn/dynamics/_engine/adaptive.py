"""Integrate one trajectory with adaptive steps, from event to event and from crossing to crossing.

Steps end at events, where row, sides and accelerations are recomputed. A step in which a contact
leaves its side is repeated up to the crossing, which the polynomial of the step locates; there the
contact changes its side. The steps of a trajectory follow from it alone, so that it is the same in
any ensemble and on any number of threads.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled import announced
from tribodyn.compiled.cache import cached_njit
from tribodyn.dynamics._engine.contact_forces import (
    I64,
    Law,
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
    SINGLE,
    Rows,
    Trial,
    adaptive_slots,
    between,
    fill_row,
    fill_within,
    set_scale,
    try_step,
)
from tribodyn.dynamics._engine.lanes import address, first_lane
from tribodyn.dynamics._engine.marching import has_dead_zones, set_up
from tribodyn.dynamics._engine.method import INNER, JIT, ONCE, kernel_digest
from tribodyn.dynamics._engine.row_table import POINTS, RowTable
from tribodyn.dynamics._engine.runge_kutta import take_over
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

#: Changes of side within this much mesh phase; more is chatter, and is reported.
MAX_CHANGES, CHATTER = 64, 1e-6
#: Narrowest step in phase that may be rejected, and narrowest part of one up to a crossing.
NARROWEST, _SHORTEST = 1e-13, 1e-15


class MarchOutput(NamedTuple):
    """Output of the integration."""

    points: Array  #: mesh phases to record at, from 0
    record: Array  #: receives the states there and at the end; empty to record nothing
    trail: Array  #: receives the steps; empty to store none
    #: Steps, rejections, crossings, widest step, reason of a failure (0 none, 1 step too narrow,
    #: 2 chatter, -2 stopped), its phase, its contact, steps in the trail, cycle.
    report: Array


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
def _record_points(
    law: Law, trial: Trial, output: MarchOutput, point: int, shift: int, w: Array
) -> int:
    """Record the states at the output points of a step without its end; returns the next point."""
    n, points = law.code[0], output.points
    if output.record.shape[0] == 0:
        return point
    while point < points.size and points[point] < trial.phase + trial.width:
        between(law, max((points[point] - trial.phase) / trial.width, 0.0), True, w)
        for i in range(2 * n):
            output.record[shift + point, i] = w[2 * n + i]
        point += 1
    return point


@nb.njit(**INNER)
def _append_to_trail(law: Law, trial: Trial, output: MarchOutput, w: Array) -> None:
    """Append a step to the trail: all that its polynomial needs."""
    n, o, report, trail = law.code[0], adaptive_slots(law.code), output.report, output.trail
    report[0] += 1.0
    report[3] = max(report[3], trial.width)
    row = int(report[7])
    if row < trail.shape[0]:
        trail[row, 0], trail[row, 1] = trial.phase, trial.width
        for i in range(n):
            trail[row, 2 + i], trail[row, 2 + n + i] = w[i], w[n + i]
            trail[row, 2 + 2 * n + i] = w[o.stage + i]
            trail[row, 2 + 3 * n + i] = w[o.mean + i]
            trail[row, 2 + 4 * n + i] = w[5 * n + i]
            trail[row, 2 + 5 * n + i] = w[o.last + i]
    report[7] += 1.0


@nb.njit(**INNER)
def _measure_at(
    law: Law, rows: Rows, trial: Trial, theta: float, scratch: Array, place: int, w: Array
) -> None:
    """Compressions and gaps at a fraction of the step, on its polynomial."""
    fill_within(rows, trial, theta, law.rows)
    between(law, theta, False, w)
    measure(law, I64(0), I64(1), w, scratch, place)


@nb.njit(**INNER)
def _tabulate_distances(law: Law, rows: Rows, trial: Trial, w: Array) -> None:
    """Distances of every contact to both boundaries of its side, at five places of the step."""
    keep = slots_of(law.code)
    for m in range(5):
        fill_within(rows, trial, 0.25 * m, law.rows)
        between(law, 0.25 * m, False, w)
        slot = adaptive_slots(law.code).table + 2 * keep.contacts * m
        cursor = first_contact(law, I64(0), I64(1))
        for j in range(keep.contacts):
            if is_dead_zone(law, cursor):
                upper, lower = clearances(SINGLE, law, keep, cursor, j, w)
                w[slot + 2 * j], w[slot + 2 * j + 1] = first_lane(upper), first_lane(lower)
            cursor = next_contact(law, cursor)


@nb.njit(**INNER)
def _turns_negative(a: float, b: float, c: float) -> bool:
    """Whether the parabola through three distances falls below zero between them."""
    bend = a - 2.0 * b + c
    return bend > 0.0 and abs(c - a) < 2.0 * bend and 8.0 * b * bend < (c - a) ** 2


@nb.njit(**INNER)
def _lowest_is_beyond(
    law: Law, rows: Rows, trial: Trial, theta: float, item: int, scratch: Array, w: Array
) -> bool:
    """Whether a contact is beyond a boundary at a fraction where its distance is least."""
    _measure_at(law, rows, trial, theta, scratch, I64(NOW), w)
    j = item // 2
    d, gap = scratch[WIDTH * j + NOW], scratch[WIDTH * j + NOW + 1]
    side = w[slots_of(law.code).side + j]
    beyond: bool = (side * d - gap if side != 0.0 else gap - (d if item % 2 == 0 else -d)) < 0.0
    return beyond


@nb.njit(**ONCE)
def _enclose(law: Law, rows: Rows, trial: Trial, scratch: Array, w: Array) -> tuple[float, float]:
    """Bracket the first departure of a contact from its side; an upper end of 2 means none."""
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
                    if _lowest_is_beyond(law, rows, trial, lowest, item, scratch, w):
                        if lowest < high:
                            low, high = 0.25 * (m if lowest > 0.25 * m else m - 1), lowest
                        break
    return low, high


@nb.njit(**ONCE)
def _first_crossing(
    law: Law, rows: Rows, trial: Trial, scratch: Array, w: Array
) -> tuple[float, float]:
    """Start of the search, and fraction at which the first contacts leave (2 if none does)."""
    s, o, contacts = slots_of(law.code), adaptive_slots(law.code), law.code[1]
    _tabulate_distances(law, rows, trial, w)
    low, high = _enclose(law, rows, trial, scratch, w)
    if high > 1.0:
        return low, 2.0
    cursor = first_contact(law, I64(0), I64(0))
    for j in range(contacts):
        kind = 1.0 if w[o.fresh + j] != 0.0 and low == 0.0 else 0.0
        scratch[WIDTH * j + KIND] = kind if is_dead_zone(law, cursor) else -1.0
        cursor = next_contact(law, cursor)
    _measure_at(law, rows, trial, low, scratch, I64(NEAR), w)
    _measure_at(law, rows, trial, high, scratch, I64(NOW), w)
    target = begin_search(scratch, contacts, low, high, s.side, w)
    if target < 0.0:
        return low, 2.0
    converged = False
    while not converged:
        _measure_at(law, rows, trial, target, scratch, I64(NOW), w)
        converged, following = continue_search(scratch, contacts, low, target, s.side, w)
        if not converged:
            target = following
    return low, target


@nb.njit(**INNER)
def _begin_anew(law: Law, rows: Rows, segment: int, phase: float, w: Array) -> None:
    """Row and accelerations at the beginning of a step, where forces may have jumped."""
    fill_row(rows, segment, phase, law.rows)
    acceleration(SINGLE, law, I64(0), I64(0), adaptive_slots(law.code).stage, w)


@nb.njit(**INNER)
def _change_sides(law: Law, low: float, theta: float, scratch: Array, w: Array) -> int:
    """Change the sides of the contacts that cross; returns the first of them."""
    s, o = slots_of(law.code), adaptive_slots(law.code)
    contact: int = change_sides(scratch, s.contacts, low, theta, s.side, w)
    for j in range(s.contacts):
        w[o.fresh + j] = 1.0 if scratch[WIDTH * j + KIND] > 0.0 else 0.0
    return contact


@nb.njit(**INNER)
def _accept(law: Law, w: Array) -> None:
    """Copy the end of the step to the start of the next."""
    n, o = law.code[0], adaptive_slots(law.code)
    take_over(SINGLE, n, w)
    for i in range(n):
        w[o.stage + i] = w[o.last + i]
    for j in range(law.code[1]):
        w[o.fresh + j] = 0.0


@nb.njit(**ONCE)
def _march_segment(
    law: Law, rows: Rows, segment: int, tolerance: Any, memory: Array, output: MarchOutput,
    point: int, stop: Index, scratch: Array, w: Array,
) -> int:  # fmt: skip
    """Integrate from an event to the next; returns the next output point, or -1 on a failure."""
    report, cycle = output.report, I64(output.report[8])
    switching, shift = has_dead_zones(law), cycle * output.points.size
    phase, end = rows.events[segment], rows.events[segment + 1]
    fill_row(rows, segment, phase, law.rows)
    set_sides(SINGLE, law, I64(0), I64(0), w)
    _begin_anew(law, rows, segment, phase, w)
    changes, counted, width, low, theta = 0, phase, 0.0, 0.0, 2.0
    for j in range(law.code[1]):
        w[adaptive_slots(law.code).fresh + j] = 0.0
    while phase < end:
        if stop[0] != 0:
            report[4] = STOPPED
            return -1
        # Repeat the step up to the crossing: fifth order instead of its polynomial.
        cut = theta <= 1.0
        width = theta * width if cut else _planned_width(memory[0], end - phase)
        trial = Trial(segment, phase, width)
        error = try_step(law, rows, trial, w)
        if not error <= 1.0 and not cut:
            report[1] += 1.0
            if width < NARROWEST:
                report[4], report[5] = 1.0, phase
                return -1
            memory[0] = width * _shrink(error)
            continue
        if switching and not cut:
            low, theta = _first_crossing(law, rows, trial, scratch, w)
            if theta * width > _SHORTEST and theta <= 1.0:
                continue
        if theta > 1.0 or cut:
            point = _record_points(law, trial, output, point, shift, w)
            _append_to_trail(law, trial, output, w)
            phase = end if width >= end - phase else phase + width
            _accept(law, w)
            set_scale(law.code, tolerance[0], tolerance[1], w)
        if theta <= 1.0:
            contact = _change_sides(law, low, theta, scratch, w)
            _begin_anew(law, rows, segment, phase, w)
            theta = 2.0
            if phase - counted > CHATTER:
                counted, changes = phase, 0
            changes += 1
            report[2] += 1.0
            if changes > MAX_CHANGES:
                report[4], report[5], report[6] = 2.0, phase, contact
                return -1
        elif width == memory[0]:
            memory[0] = width * _growth(error, memory[1])
            memory[1] = error
        else:
            memory[0] = max(memory[0], width * _growth(error, memory[1]))
    return point


def _build(digest: str) -> Any:
    @cached_njit(**JIT)
    def march_adaptive(
        table: RowTable,
        period: Array,
        load: Array,
        state: Array,
        memory: Array,
        rtol: float,
        atol: Array,
        cycles: int,
        output: MarchOutput,
        stop: Index,
    ) -> None:
        """Integrate one trajectory over ``cycles`` mesh cycles; after a failure to its step.

        ``period`` (1,), ``load`` (1, n) or with factors (1, n + 6) and ``state`` (1, 2 n) are those
        of a lane; ``memory`` holds the next step and the last error, and the largest size of each
        state.
        """
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        program, size = table.program, state.shape[1]
        columns = program.code[2]
        row, weights, places = (
            program.rows[:columns].copy(),
            np.empty(POINTS),
            np.empty(POINTS, I64),
        )
        law = Law(address(program.code), address(program.reads), address(row))
        rows = Rows(
            address(table.events), address(table.first), address(table.varying),
            table.varying.size, columns, address(program.rows), address(weights), address(places),
        )  # fmt: skip
        s, o = slots_of(law.code), adaptive_slots(law.code)
        work, search = np.zeros(o.end), np.zeros(WIDTH * (s.contacts + 1))
        w, scratch = address(work), address(search)
        set_up(1, law.code, period, load, state, w)
        w[o.period] = period[0]
        for i in range(size):
            w[o.size + i] = memory[2 + i]
        tolerance = rtol, address(atol)
        set_scale(law.code, rtol, tolerance[1], w)
        for cycle in range(cycles):
            point, segment, output.report[8] = I64(0), I64(0), cycle
            while point >= 0 and segment < table.first.size - 1:
                point = _march_segment(
                    law, rows, segment, tolerance, memory, output, point, stop, scratch, w
                )
                segment += 1
            if point < 0:
                break
        for i in range(size):
            state[0, i], memory[2 + i] = w[i], w[o.size + i]
            if output.record.shape[0] > 0:
                output.record[cycles * output.points.size, i] = w[i]
        # The addresses hold only as long as their owners are in use.
        output.report[0] += 0.0 * (row[0] + work[0] + search[0] + weights[0] + places[0])

    return march_adaptive


march_adaptive = announced(_build(kernel_digest()), "the adaptive engine", "ten seconds")
