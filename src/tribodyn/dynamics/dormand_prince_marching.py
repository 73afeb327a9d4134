"""Marching a block of lanes adaptively: the worst lane sets the step in mesh phase.

Steps end at events, where rows, sides and accelerations are taken anew. A lane in which a contact
leaves its side repeats the step alone.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.dynamics.crossing import find_sides
from tribodyn.dynamics.dormand_prince_crossing import (
    NARROWEST,
    advance_lane,
    growth,
    keep_points,
    keep_step,
)
from tribodyn.dynamics.dormand_prince_kernel import (
    fill_row,
    find_cell,
    may_cross,
    set_scale,
    try_step,
)
from tribodyn.dynamics.kernel import I64, INNER, JIT, acceleration
from tribodyn.dynamics.lanes import address
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

#: Every file whose code ends up in the compiled kernel.
_SOURCES = (
    "lanes",
    "kernel",
    "crossing",
    "dormand_prince_kernel",
    "dormand_prince_crossing",
    "dormand_prince_marching",
)


@nb.njit(**INNER)
def _leaves(lane: int, width: int, n: int, contacts: int, code: Index, own: int, w: Array) -> bool:
    """Whether a distance of one lane may be negative within the step, from its five places."""
    table, stride = own + 19 * n + 2, 2 * contacts
    for item in range(stride):
        if code[4 + 4 * (item // 2) + 2] == 0:
            continue
        a, b = w[(table + item) * width + lane], w[(table + item + stride) * width + lane]
        if b < 0.0:
            return True
        for m in range(2, 5):
            c = w[(table + item + m * stride) * width + lane]
            bend = a - 2.0 * b + c
            if c < 0.0:
                return True
            if bend > 0.0 and abs(c - a) < 2.0 * bend and 8.0 * b * bend < (c - a) ** 2:
                return True
            a, b = b, c
    return False


@nb.njit(**INNER)
def _set_up(
    width: int, code: Index, own: int, period: Array, load: Array, state: Array, memory: Array,
    w: Array,
) -> None:  # fmt: skip
    n, contacts = code[0], code[1]
    steady = 8 * n + 2 * contacts
    for lane in range(width):
        for i in range(2 * n):
            w[i * width + lane] = state[lane, i]
            w[(own + 15 * n + i) * width + lane] = memory[2 + i * width + lane]
        for i in range(n):
            w[(steady + i) * width + lane] = load[lane, i]
        for j in range(contacts):
            w[(8 * n + contacts + j) * width + lane] = 1.0
        w[(steady + n + 2) * width + lane] = 1.0 / period[lane]
        w[(own + 19 * n + 1) * width + lane] = period[lane]
        # Factors of stiffness, damping, friction, error, gap and load: see `Slots`.
        for slot, item in ((6, 0), (7, 1), (8, 2), (5, 4)):
            w[(steady + n + slot) * width + lane] = load[lane, n + item] - 1.0
        w[(steady + n + 3) * width + lane] = 1.0 - load[lane, n + 3]
        w[(steady + n) * width + lane] = load[lane, n + 5]


@nb.njit(**INNER)
def _sides_of_lanes(
    width: int, code: Index, reads: Index, row: Array, slots: int, w: Array, single: Array
) -> None:
    side = 8 * code[0] + code[1]
    for lane in range(width):
        for slot in range(slots):
            single[slot] = w[slot * width + lane]
        find_sides(code, reads, row, I64(0), I64(0), single)
        for j in range(code[1]):
            w[(side + j) * width + lane] = single[side + j]


def _build(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def march_adaptive_block(
        lanes: Any,
        code: Index,
        reads: Index,
        constant: Array,
        edge: Array,
        degree: Index,
        start: Index,
        coefficients: Array,
        varying: Index,
        events: Array,
        first: Index,
        work: Array,
        own: int,
        slots: int,
        period: Array,
        load: Array,
        state: Array,
        memory: Array,
        rtol: float,
        atol: Array,
        cycles: int,
        points: Array,
        record: Array,
        trail: Array,
        report: Array,
        stop: Index,
    ) -> None:
        """March every lane by ``cycles`` mesh cycles."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        n, contacts, width_of_block = code[0], code[1], len(lanes)
        count = varying.size
        single = address(work[slots * width_of_block :])
        row = address(work[slots * (width_of_block + 1) :])
        for column in range(constant.size):
            row[column] = constant[column]
        w, code, reads, atol = address(work), address(code), address(reads), address(atol)
        cells = (
            address(edge),
            address(degree),
            address(start),
            address(coefficients),
            address(varying),
        )
        _set_up(width_of_block, code, own, period, load, state, memory, w)
        set_scale(width_of_block, n, own, rtol, atol, w, 0)
        switching = False
        for j in range(contacts):
            switching = switching or code[4 + 4 * j + 2] != 0
        plan, before = memory[0], memory[1]
        for cycle in range(cycles):
            next_point, shift = I64(0), cycle * points.size
            report[9] = cycle
            for segment in range(first.size - 1):
                phase, end = events[segment], events[segment + 1]
                cell, last = first[segment], first[segment + 1]
                anew = True
                while phase < end:
                    if stop[0] != 0:
                        report[4] = STOPPED
                        return
                    if anew:
                        fill_row(cells, count, cell, phase, row)
                        if switching and phase == events[segment]:
                            _sides_of_lanes(width_of_block, code, reads, row, own, w, single)
                        acceleration(lanes, code, reads, row, I64(0), I64(0), own, w)
                        anew = False
                    rest = end - phase
                    width = plan
                    if plan >= rest:
                        width = rest
                    elif plan > 0.5 * rest:
                        width = 0.5 * rest
                    error = try_step(
                        lanes, code, reads, cells, count, cell, last, phase, width, row, own, w
                    )
                    if not error <= 1.0:
                        report[1] += 1.0
                        if width < NARROWEST:
                            report[4], report[5] = 1.0, phase
                            for lane in range(width_of_block):
                                value = w[(own + 19 * n) * width_of_block + lane]
                                if not value <= 1.0:
                                    report[6] = lane
                            return
                        factor = 0.2
                        if np.isfinite(error):
                            factor = max(0.2, 0.9 * error**-0.2)
                        plan = width * factor
                        continue
                    goal = end if width >= rest else phase + width
                    crossing = switching and may_cross(
                        lanes, code, reads, cells, count, cell, last, phase, width, row, own, w
                    )
                    alone = False
                    old_point = next_point
                    if crossing and width_of_block == 1:
                        alone = _leaves(0, 1, n, contacts, code, own, w)
                    if not alone:
                        next_point = keep_points(
                            lanes, n, contacts, own, phase, width, points, next_point, shift,
                            I64(0), record, w,
                        )  # fmt: skip
                        keep_step(n, own, phase, width, trail, report, w)
                    if crossing:
                        for lane in range(width_of_block):
                            if not _leaves(lane, width_of_block, n, contacts, code, own, w):
                                continue
                            for slot in range(slots):
                                single[slot] = w[slot * width_of_block + lane]
                            advance_lane(
                                code, reads, cells, count, cell, last, phase, goal, row, own,
                                rtol, atol, points, old_point, shift, lane, record, trail,
                                report, single,
                            )  # fmt: skip
                            if report[4] != 0.0:
                                return
                            for i in range(2 * n):
                                w[(4 * n + i) * width_of_block + lane] = single[i]
                            for j in range(contacts):
                                side = 8 * n + contacts + j
                                w[side * width_of_block + lane] = single[side]
                            anew = True
                        if alone:
                            while next_point < points.size and points[next_point] < goal:
                                next_point += 1
                    phase = goal
                    cell = find_cell(cells, cell, cell, last, phase)
                    for item in range(2 * n * width_of_block):
                        w[item] = w[4 * n * width_of_block + item]
                    if not anew:
                        for item in range(n * width_of_block):
                            w[own * width_of_block + item] = w[
                                (own + 6 * n) * width_of_block + item
                            ]
                    set_scale(width_of_block, n, own, rtol, atol, w, 0)
                    if width == plan:
                        plan = width * growth(error, before)
                        before = error
                    else:
                        plan = max(plan, width * growth(error, before))
        memory[0], memory[1] = plan, before
        for lane in range(width_of_block):
            for i in range(2 * n):
                state[lane, i] = w[i * width_of_block + lane]
                memory[2 + i * width_of_block + lane] = w[
                    (own + 15 * n + i) * width_of_block + lane
                ]
        if record.shape[0] > 0:
            for i in range(2 * n):
                for lane in range(width_of_block):
                    record[cycles * points.size, i, lane] = state[lane, i]

    return march_adaptive_block


march_adaptive_block = _build(source_digest(Path(__file__).parent, _SOURCES))
