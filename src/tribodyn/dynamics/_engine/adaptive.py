"""Integrate a block of lanes with adaptive steps; the lane with the largest error sets the step.

Steps end at events, where rows, sides and accelerations are recomputed. A lane in which a contact
leaves its side repeats the step alone: up to the crossing on the polynomial of the step, where the
contact changes its side, and on from there.
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
    Cells,
    Trial,
    adaptive_slots,
    between,
    fill_row,
    fill_within,
    find_cell,
    may_cross,
    set_scale,
    try_step,
)
from tribodyn.dynamics._engine.lanes import address, ahead
from tribodyn.dynamics._engine.marching import has_dead_zones, put_lane, set_up, take_lane
from tribodyn.dynamics._engine.method import INNER, JIT, ONCE, kernel_digest
from tribodyn.dynamics._engine.phase_table import PhaseTable
from tribodyn.dynamics._engine.runge_kutta import take_over
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

#: Changes of side of one lane within this much mesh phase; more is chatter, and is reported.
MAX_CHANGES, CHATTER = 64, 1e-6
#: Narrowest step in phase that may be rejected.
NARROWEST = 1e-13


class MarchOutput(NamedTuple):
    """Output of the integration."""

    points: Array  #: mesh phases to record at, from 0
    record: Array  #: receives the states there and at the end; empty to record nothing
    trail: Array  #: receives the steps of a single lane; empty to store none
    #: Steps, rejections, crossings, widest step, reason of a failure (0 none, 1 step too narrow,
    #: 2 chatter, -2 stopped), its phase, lane and contact, steps in the trail, cycle.
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
def _record_points(
    lanes: Any,
    law: Law,
    trial: Trial,
    output: MarchOutput,
    point: int,
    shift: int,
    lane: int,
    w: Array,
) -> int:
    """Record the states at the output points of a step without its end; returns the next point."""
    n = law.code[0]
    if output.record.shape[0] > 0:
        while point < output.points.size and output.points[point] < trial.phase + trial.width:
            theta = max((output.points[point] - trial.phase) / trial.width, 0.0)
            between(lanes, law, theta, True, w)
            for i in range(2 * n):
                for item in range(len(lanes)):
                    value = w[(2 * n + i) * len(lanes) + item]
                    output.record[shift + point, i, lane + item] = value
            point += 1
    return point


@nb.njit(**INNER)
def _append_to_trail(law: Law, trial: Trial, output: MarchOutput, w: Array) -> None:
    """Append the step of a single lane to the trail: all that its polynomial needs."""
    n, o, report, trail = law.code[0], adaptive_slots(law.code), output.report, output.trail
    report[0] += 1.0
    report[3] = max(report[3], trial.width)
    row = int(report[8])
    if row < trail.shape[0]:
        trail[row, 0], trail[row, 1] = trial.phase, trial.width
        for i in range(n):
            trail[row, 2 + i], trail[row, 2 + n + i] = w[i], w[n + i]
            trail[row, 2 + 2 * n + i] = w[o.stage + i]
            trail[row, 2 + 3 * n + i] = w[o.mean + i]
            trail[row, 2 + 4 * n + i] = w[5 * n + i]
            trail[row, 2 + 5 * n + i] = w[o.last + i]
    report[8] += 1.0


@nb.njit(**INNER)
def _measure_at(
    law: Law, cells: Cells, trial: Trial, theta: float, scratch: Array, place: int, w: Array
) -> None:
    """Compressions and gaps at a fraction of the step, on its polynomial."""
    fill_within(cells, trial, theta, trial.cell, law.rows)
    between((0.0,), law, theta, False, w)
    measure(law, I64(0), I64(1), w, scratch, place)


@nb.njit(**INNER)
def _turns_negative(a: float, b: float, c: float) -> bool:
    """Whether the parabola through three distances falls below zero between them."""
    bend = a - 2.0 * b + c
    return bend > 0.0 and abs(c - a) < 2.0 * bend and 8.0 * b * bend < (c - a) ** 2


@nb.njit(**INNER)
def _leaves(lane: int, width: int, law: Law, w: Array) -> bool:
    """Whether a distance of one lane may be negative within the step, from its five places."""
    table, stride = adaptive_slots(law.code).table, 2 * law.code[1]
    cursor = first_contact(law, I64(0), I64(0))
    for j in range(law.code[1]):
        dead = is_dead_zone(law, cursor)
        cursor = next_contact(law, cursor)
        for item in range(2 * j, 2 * j + 2 if dead else 2 * j):
            a, b = w[(table + item) * width + lane], w[(table + item + stride) * width + lane]
            if b < 0.0:
                return True
            for m in range(2, 5):
                c = w[(table + item + m * stride) * width + lane]
                if c < 0.0 or _turns_negative(a, b, c):
                    return True
                a, b = b, c
    return False


@nb.njit(**ONCE)
def _enclose(law: Law, cells: Cells, trial: Trial, scratch: Array, w: Array) -> tuple[float, float]:
    """Bracket the first departure of a contact from its side; an upper end of 2 means none."""
    s, o, contacts = slots_of(law.code), adaptive_slots(law.code), law.code[1]
    stride, low, high = 2 * contacts, 0.0, 2.0
    cursor = first_contact(law, I64(0), I64(0))
    for j in range(contacts):
        dead = is_dead_zone(law, cursor)
        cursor = next_contact(law, cursor)
        for item in range(2 * j, 2 * j + 2 if dead else 2 * j):
            if w[s.side + j] != 0.0 and item % 2 == 1:
                continue
            at = o.table + item
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
                    _measure_at(law, cells, trial, lowest, scratch, I64(NOW), w)
                    d, gap, side = (
                        scratch[WIDTH * j + NOW],
                        scratch[WIDTH * j + NOW + 1],
                        w[s.side + j],
                    )
                    away = side * d - gap if side != 0.0 else gap - (d if item % 2 == 0 else -d)
                    if away < 0.0:
                        if lowest < high:
                            low, high = 0.25 * (m if lowest > 0.25 * m else m - 1), lowest
                        break
    return low, high


@nb.njit(**ONCE)
def _first_crossing(
    law: Law, cells: Cells, trial: Trial, scratch: Array, w: Array
) -> tuple[float, float]:
    """Start of the search, and fraction at which the first contacts leave (2 if none does)."""
    s, o, contacts = slots_of(law.code), adaptive_slots(law.code), law.code[1]
    low, high = _enclose(law, cells, trial, scratch, w)
    if high > 1.0:
        return low, 2.0
    cursor = first_contact(law, I64(0), I64(0))
    for j in range(contacts):
        kind = 1.0 if w[o.fresh + j] != 0.0 and low == 0.0 else 0.0
        scratch[WIDTH * j + KIND] = kind if is_dead_zone(law, cursor) else -1.0
        cursor = next_contact(law, cursor)
    _measure_at(law, cells, trial, low, scratch, I64(NEAR), w)
    _measure_at(law, cells, trial, high, scratch, I64(NOW), w)
    target = begin_search(scratch, contacts, low, high, s.side, w)
    if target < 0.0:
        return low, 2.0
    converged = False
    while not converged:
        _measure_at(law, cells, trial, target, scratch, I64(NOW), w)
        converged, following = continue_search(scratch, contacts, low, target, s.side, w)
        if not converged:
            target = following
    return low, target


@nb.njit(**INNER)
def _begin_anew(lanes: Any, law: Law, cells: Cells, cell: int, phase: float, w: Array) -> None:
    """Row and accelerations at the beginning of a step, where forces may have jumped."""
    fill_row(cells, cell, phase, law.rows)
    acceleration(lanes, law, I64(0), I64(0), adaptive_slots(law.code).stage, w)


@nb.njit(**INNER)
def _change_sides(law: Law, start: float, target: float, scratch: Array, w: Array) -> int:
    """Change the sides of the contacts that cross; returns the first of them."""
    s, o = slots_of(law.code), adaptive_slots(law.code)
    contact: int = change_sides(scratch, s.contacts, start, target, s.side, w)
    for j in range(s.contacts):
        w[o.fresh + j] = 1.0 if scratch[WIDTH * j + KIND] > 0.0 else 0.0
    return contact


@nb.njit(**INNER)
def _accept(lanes: Any, law: Law, w: Array) -> None:
    """Copy the end of the step to the start of the next."""
    n, o, width = law.code[0], adaptive_slots(law.code), len(lanes)
    take_over(lanes, n, w)
    for item in range(n * width):
        w[o.stage * width + item] = w[o.last * width + item]


@nb.njit(**ONCE)
def _advance_lane(
    law: Law, cells: Cells, segment: Trial, end: float, tolerance: Any, output: MarchOutput,
    point: int, shift: int, lane: int, scratch: Array, w: Array,
) -> None:  # fmt: skip
    """Integrate one lane over a step of the block, from crossing to crossing, in buffer 0."""
    single_lane, report = (0.0,), output.report
    o, contacts = adaptive_slots(law.code), law.code[1]
    phase, cell = segment.phase, segment.cell
    width, before, changes, counted = end - phase, 1.0, 0, phase
    for j in range(contacts):
        w[o.fresh + j] = 0.0
    cut, plan, low, theta = False, width, 0.0, 2.0
    while phase < end:
        if not cut:
            width = min(width, end - phase)
        trial = Trial(cell, segment.last, phase, width)
        error = try_step(single_lane, law, cells, trial, w)
        if not error <= 1.0 and not cut:
            report[1] += 1.0
            if width < NARROWEST:
                report[4], report[5], report[6] = 1.0, phase, lane
                return
            width *= _shrink(error)
            continue
        if not cut and may_cross(single_lane, law, cells, trial, w):
            low, theta = _first_crossing(law, cells, trial, scratch, w)
            if theta <= 1.0:
                if phase - counted > CHATTER:
                    counted, changes = phase, 0
                changes += 1
                report[2] += 1.0
                if theta * width > 1e-15:
                    # Repeat the step up to the crossing: fifth order instead of its polynomial.
                    cut, plan, width = True, width, theta * width
                else:
                    contact = _change_sides(law, low, theta, scratch, w)
                    _begin_anew(single_lane, law, cells, cell, phase, w)
                    if changes > MAX_CHANGES:
                        report[4], report[5], report[6], report[7] = 2.0, phase, lane, contact
                        return
                continue
        point = _record_points(single_lane, law, trial, output, point, shift, lane, w)
        _append_to_trail(law, trial, output, w)
        phase = end if width >= end - phase else phase + width
        cell = find_cell(cells, cell, cell, segment.last, phase)
        _accept(single_lane, law, w)
        for j in range(contacts):
            w[o.fresh + j] = 0.0
        set_scale(1, law.code, tolerance[0], tolerance[1], w)
        if cut:
            contact = _change_sides(law, low, theta, scratch, w)
            if changes > MAX_CHANGES:
                report[4], report[5], report[6], report[7] = 2.0, phase, lane, contact
                return
            _begin_anew(single_lane, law, cells, cell, phase, w)
            width, cut = plan, False
        else:
            width *= _growth(error, before)
            before = error


def _build(digest: str) -> Any:
    @cached_njit(**JIT)
    def march_adaptive_block(
        lanes: Any,
        table: PhaseTable,
        period: Array,
        load_: Array,
        state: Array,
        memory: Array,
        rtol: float,
        atol_: Array,
        cycles: int,
        output: MarchOutput,
        stop: Index,
    ) -> Array:
        """Integrate every lane over ``cycles`` mesh cycles; returns the slots of a failed lane.

        ``memory`` holds the next step and the last error, and the largest size of each state.
        """
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        program, report, points, block = table.program, output.report, output.points, len(lanes)
        code, events, first = address(program.code), table.events, table.first
        s, o = slots_of(code), adaptive_slots(code)
        n, contacts, slots = s.n, s.contacts, s.end + o.end
        work = np.zeros(slots * (block + 1))
        row_buffer = np.empty(table.constant.size + WIDTH * (contacts + 1))
        for column in range(table.constant.size):
            row_buffer[column] = table.constant[column]
        law = Law(code, address(program.reads), address(row_buffer))
        scratch, w = ahead(law.rows, table.constant.size), address(work)
        single, atol = ahead(w, slots * block), address(atol_)
        edge, degree, start = address(table.edge), address(table.degree), address(table.start)
        coefficients, varying = address(table.coefficients), address(table.varying)
        cells = Cells(edge, degree, start, coefficients, varying, table.varying.size)
        set_up(block, code, period, load_, state, w)
        for lane in range(block):
            w[o.period * block + lane] = period[lane]
            for i in range(2 * n):
                w[(o.size + i) * block + lane] = memory[2 + i * block + lane]
        set_scale(block, code, rtol, atol, w)
        switching = has_dead_zones(law)
        plan, before = memory[0], memory[1]
        for cycle in range(cycles):
            point, shift = I64(0), cycle * points.size
            report[9] = cycle
            for segment in range(first.size - 1):
                phase, end = events[segment], events[segment + 1]
                cell, last = first[segment], first[segment + 1]
                restarts = True
                while phase < end:
                    if stop[0] != 0:
                        report[4] = STOPPED
                        return work
                    if restarts:
                        if switching and phase == events[segment]:
                            fill_row(cells, cell, phase, law.rows)
                            set_sides(lanes, law, I64(0), I64(0), w)
                        _begin_anew(lanes, law, cells, cell, phase, w)
                        restarts = False
                    remaining = end - phase
                    width = plan
                    if plan >= remaining:
                        width = remaining
                    elif plan > 0.5 * remaining:
                        width = 0.5 * remaining
                    trial = Trial(cell, last, phase, width)
                    error = try_step(lanes, law, cells, trial, w)
                    if not error <= 1.0:
                        report[1] += 1.0
                        if width < NARROWEST:
                            report[4], report[5] = 1.0, phase
                            for lane in range(block):
                                if not w[o.error * block + lane] <= 1.0:
                                    report[6] = lane
                            take_lane(I64(report[6]), block, slots, w, single)
                            return work[slots * block :]
                        plan = width * _shrink(error)
                        continue
                    goal = end if width >= remaining else phase + width
                    crossing = switching and may_cross(lanes, law, cells, trial, w)
                    old_point = point
                    repeats_alone = crossing and block == 1 and _leaves(I64(0), I64(1), law, w)
                    if not repeats_alone:
                        point = _record_points(lanes, law, trial, output, point, shift, I64(0), w)
                        _append_to_trail(law, trial, output, w)
                    if crossing:
                        for lane in range(block):
                            if not _leaves(lane, block, law, w):
                                continue
                            take_lane(lane, block, slots, w, single)
                            _advance_lane(
                                law, cells, trial, goal, (rtol, atol), output, old_point,
                                shift, lane, scratch, single,
                            )  # fmt: skip
                            if report[4] != 0.0:
                                return work[slots * block :]
                            for i in range(2 * n):
                                w[(4 * n + i) * block + lane] = single[i]
                            put_lane(lane, block, s.side, s.load, w, single)
                            restarts = True
                        if repeats_alone:
                            while point < points.size and points[point] < goal:
                                point += 1
                    phase = goal
                    cell = find_cell(cells, cell, cell, last, phase)
                    _accept(lanes, law, w)
                    set_scale(block, code, rtol, atol, w)
                    if width == plan:
                        plan = width * _growth(error, before)
                        before = error
                    else:
                        plan = max(plan, width * _growth(error, before))
        memory[0], memory[1] = plan, before
        for lane in range(block):
            for i in range(2 * n):
                state[lane, i] = w[i * block + lane]
                memory[2 + i * block + lane] = w[(o.size + i) * block + lane]
        if output.record.shape[0] > 0:
            for i in range(2 * n):
                for lane in range(block):
                    output.record[cycles * points.size, i, lane] = state[lane, i]
        # The address holds only as long as its owner is in use.
        report[0] += 0.0 * row_buffer[0]
        return work

    return march_adaptive_block


march_adaptive_block = announced(_build(kernel_digest()), "the adaptive engine", "half a minute")
