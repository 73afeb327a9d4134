"""One lane from phase to phase, with steps that end where a contact changes its side.

The contact force has a kink at the boundary of a dead zone and, with damping, a jump. A step is
tried with one force law; where its dense output leaves the side of a contact, the step is
repeated up to there, the contact changes its side, and the motion goes on.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.dynamics._engine.contact_forces import I64, INNER, acceleration
from tribodyn.dynamics._engine.dormand_prince import (
    between,
    clearances,
    fill_row,
    find_cell,
    may_cross,
    set_scale,
    try_step,
)
from tribodyn.dynamics._engine.lanes import load
from tribodyn.types import Array, Index

#: Changes of side of one lane within this much mesh phase; more is chatter, and is reported.
MAX_CHANGES, CHATTER = 64, 1e-6
#: Narrowest step in phase that may be rejected.
NARROWEST = 1e-13
#: Halvings in the search for a point on the new side of a contact that has just changed.
_PROBES = 30


@nb.njit(**INNER)
def growth(error: float, before: float) -> float:
    """Factor for the next step from the errors of this step and the one before."""
    factor = 0.9 * max(error, 1e-10) ** -0.17 * max(before, 1e-4) ** 0.04
    return float(min(max(factor, 0.2), 5.0))


@nb.njit(**INNER)
def keep_points(
    lanes: Any,
    n: int,
    contacts: int,
    own: int,
    phase: float,
    width: float,
    points: Array,
    next_point: int,
    shift: int,
    lane: int,
    record: Any,
    w: Array,
) -> int:
    """Record the grid points from ``phase`` to before its end; returns the next one."""
    if record.shape[0] > 0:
        h = load(lanes, w, 9 * n + 2 * contacts + 1)
        while next_point < points.size and points[next_point] < phase + width:
            theta = max((points[next_point] - phase) / width, 0.0)
            between(lanes, n, own, theta, h, True, w)
            for i in range(2 * n):
                for item in range(len(lanes)):
                    value = w[(2 * n + i) * len(lanes) + item]
                    record[shift + next_point, i, lane + item] = value
            next_point += 1
    return next_point


@nb.njit(**INNER)
def keep_step(
    n: int, own: int, phase: float, width: float, trail: Any, report: Array, w: Array
) -> None:
    """Append the step of a single lane to the trail: all that its dense output needs."""
    report[0] += 1.0
    report[3] = max(report[3], width)
    row = int(report[8])
    if row < trail.shape[0]:
        trail[row, 0], trail[row, 1] = phase, width
        for i in range(n):
            trail[row, 2 + i], trail[row, 2 + n + i] = w[i], w[n + i]
            trail[row, 2 + 2 * n + i] = w[own + i]
            trail[row, 2 + 3 * n + i] = w[own + 14 * n + i]
            trail[row, 2 + 4 * n + i] = w[5 * n + i]
            trail[row, 2 + 5 * n + i] = w[own + 6 * n + i]
    report[8] += 1.0


@nb.njit(**INNER)
def _clearance(
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
    item: int,
    theta: float,
    w: Array,
) -> float:
    """Distance ``item`` at the fraction ``theta`` of the step."""
    n, contacts = code[0], code[1]
    place = phase + theta * width
    fill_row(cells, count, find_cell(cells, cell, cell, last, place), place, row)
    between((0.0,), n, own, theta, load((0.0,), w, 9 * n + 2 * contacts + 1), False, w)
    slot = own + 19 * n + 2 + 11 * contacts
    clearances((0.0,), code, reads, row, I64(1), slot, w)
    return float(w[slot + item])


@nb.njit(**INNER)
def _leaving(
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
    item: int,
    fresh: bool,
    w: Array,
) -> float:
    """Fraction of the step at which distance ``item`` becomes negative, 2 if it does not."""
    n, contacts = code[0], code[1]
    table, stride = own + 19 * n + 2 + item, 2 * contacts
    low, high = 0.0, -1.0
    if w[table] < 0.0 and w[table + stride] < 0.0 and not fresh:
        return 0.0
    for m in range(1, 5):
        b = w[table + m * stride]
        if b < 0.0:
            low, high = 0.25 * (m - 1), 0.25 * m
            break
        if m < 4:
            a, c = w[table + (m - 1) * stride], w[table + (m + 1) * stride]
            bend = a - 2.0 * b + c
            if bend > 0.0 and abs(c - a) < 2.0 * bend and 8.0 * b * bend < (c - a) ** 2:
                lowest = 0.25 * m + 0.125 * (a - c) / bend
                d = _clearance(
                    code, reads, cells, count, cell, last, phase, width, row, own, item, lowest, w
                )
                if d < 0.0:
                    low, high = 0.25 * (m if lowest > 0.25 * m else m - 1), lowest
                    break
    if high < 0.0:
        return 2.0
    start, at, probes, task = low, low, 0, 0
    g_low = g_high = old = 0.0
    # First a point on the side (the start of a fresh contact is on the boundary, to rounding),
    # then the far end, then the Illinois method between them.
    while True:
        g = _clearance(code, reads, cells, count, cell, last, phase, width, row, own, item, at, w)
        if task == 0:
            if g > 0.0 and not (fresh and at == 0.0):
                low, g_low, task, at = at, g, 1, high
            elif probes == _PROBES:
                return start
            else:
                probes += 1
                at = start + (high - start) * 0.5**probes
        elif task == 1:
            if g >= 0.0:
                return 2.0
            g_high, task, old = g, 2, g
            at = (low * g_high - high * g_low) / (g_high - g_low)
        else:
            if g == 0.0 or high - low < 1e-13 or probes > _PROBES + 60:
                return at
            probes += 1
            if g > 0.0:
                low, g_low = at, g
                if old > 0.0:
                    g_high *= 0.5
            else:
                high, g_high = at, g
                if old < 0.0:
                    g_low *= 0.5
            old = g
            at = (low * g_high - high * g_low) / (g_high - g_low)
            if abs(g) < 1e-15 * max(g_low, -g_high):
                return at


@nb.njit(**INNER)
def _first_to_leave(
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
) -> tuple[Any, float]:
    """Distance that becomes negative first, and at which fraction of the step; -1 if none."""
    n, contacts = code[0], code[1]
    side, fresh = 8 * n + contacts, own + 19 * n + 2 + 10 * contacts
    found, place = I64(-1), 2.0
    for item in range(2 * contacts):
        j = item // 2
        flank = w[side + j]
        if code[4 + 4 * j + 2] == 0 or (flank != 0.0 and item % 2 == 1):
            continue
        own_fresh = w[fresh + j] != 0.0
        if flank == 0.0:
            own_fresh = w[fresh + j] == (1.0 if item % 2 == 0 else -1.0)
        theta = _leaving(
            code, reads, cells, count, cell, last, phase, width, row, own, item, own_fresh, w
        )
        if theta < place:
            found, place = I64(item), theta
    return found, place


@nb.njit(**INNER)
def _change_side(n: int, contacts: int, own: int, item: int, w: Array) -> None:
    side, fresh = 8 * n + contacts + item // 2, own + 19 * n + 2 + 10 * contacts + item // 2
    if w[side] != 0.0:
        w[fresh] = w[side]
        w[side] = 0.0
    else:
        w[side] = 1.0 if item % 2 == 0 else -1.0
        w[fresh] = w[side]


@nb.njit(**INNER)
def advance_lane(
    code: Index,
    reads: Index,
    cells: Any,
    count: int,
    cell: int,
    last: int,
    start: float,
    end: float,
    row: Array,
    own: int,
    rtol: float,
    atol: Array,
    points: Array,
    next_point: int,
    shift: int,
    lane: int,
    record: Any,
    trail: Any,
    report: Array,
    w: Array,
) -> None:
    """March one lane from its state in buffer 0 to its state in buffer 0 at the phase ``end``."""
    one = (0.0,)
    n, contacts = code[0], code[1]
    fresh = own + 19 * n + 2 + 10 * contacts
    phase, width, before, changes, counted = start, end - start, 1.0, 0, start
    for j in range(contacts):
        w[fresh + j] = 0.0
    cut, plan, crossing = False, width, I64(-1)
    while phase < end:
        if not cut:
            width = min(width, end - phase)
        error = try_step(one, code, reads, cells, count, cell, last, phase, width, row, own, w)
        if not error <= 1.0 and not cut:
            report[1] += 1.0
            if width < NARROWEST:
                report[4], report[5], report[6] = 1.0, phase, lane
                return
            width *= 0.2 if not np.isfinite(error) else max(0.2, 0.9 * error**-0.2)
            continue
        item = I64(-1)
        if not cut and may_cross(
            one, code, reads, cells, count, cell, last, phase, width, row, own, w
        ):
            item, theta = _first_to_leave(
                code, reads, cells, count, cell, last, phase, width, row, own, w
            )
            if item >= 0:
                if phase - counted > CHATTER:
                    counted, changes = phase, 0
                changes += 1
                report[2] += 1.0
                if changes > MAX_CHANGES:
                    report[4], report[5], report[6], report[7] = 2.0, phase, lane, item // 2
                    return
                if theta * width > 1e-15:
                    # Repeat the step up to the crossing: fifth order instead of the dense output.
                    cut, plan, width, crossing = True, width, theta * width, item
                    continue
                _change_side(n, contacts, own, item, w)
                fill_row(cells, count, cell, phase, row)
                acceleration(one, code, reads, row, I64(0), I64(0), own, w)
                continue
        next_point = keep_points(
            one, n, contacts, own, phase, width, points, next_point, shift, lane, record, w
        )
        keep_step(n, own, phase, width, trail, report, w)
        phase = end if width >= end - phase else phase + width
        cell = find_cell(cells, cell, cell, last, phase)
        for i in range(2 * n):
            w[i] = w[4 * n + i]
        for i in range(n):
            w[own + i] = w[own + 6 * n + i]
        for j in range(contacts):
            w[fresh + j] = 0.0
        set_scale(1, n, own, rtol, atol, w, 0)
        if cut:
            _change_side(n, contacts, own, crossing, w)
            fill_row(cells, count, cell, phase, row)
            acceleration(one, code, reads, row, I64(0), I64(0), own, w)
            width, cut = plan, False
        else:
            width *= growth(error, before)
            before = error
