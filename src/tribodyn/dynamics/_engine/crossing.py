"""Splitting a step where a contact leaves its side of the dead zone.

The contact force has a kink there, and with damping a jump. A Runge-Kutta step across it loses
its order, so the lane concerned repeats the step in parts, each with one force law, from
crossing to crossing. Rows are interpolated quadratically within the step.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.dynamics._engine.contact_forces import (
    I64,
    INNER,
    compression,
    dead_zone,
    step,
)
from tribodyn.dynamics._engine.lanes import above, first_lane, store
from tribodyn.types import Array, Index

#: A step is split at most this often. More means a grazing contact, whose excursions within one
#: step are then too small to matter; the step is taken as it stands.
MAX_SPLITS = 16
#: A crossing is found within a dozen tries, or never.
MAX_TRIES = 200


@nb.njit(**INNER)
def set_sides(
    lanes: Any, code: Index, reads: Index, rows: Array, base: int, buffer: int, w: Array
) -> None:
    """Set the side of every dead zone from the compression of its contact."""
    side = 8 * code[0] + code[1]
    at, read, row = I64(4), buffer * code[3], base
    for j in range(code[1]):
        if code[at + 2] != 0:
            d = compression(lanes, code, reads, rows, at, read, row, w)
            gap = dead_zone(lanes, code, rows, row, w)
            store(w, side + j, above(d, gap) - above(0.0 - d, gap))
        row += 5 + code[at] + code[at + 1]
        read += code[at] + code[at + 1]
        at += 4


@nb.njit(**INNER)
def find_sides(code: Index, reads: Index, rows: Array, base: int, buffer: int, w: Array) -> None:
    """Set the side of every dead zone of one lane."""
    set_sides((0.0,), code, reads, rows, base, buffer, w)


@nb.njit(**INNER)
def _place(
    code: Index, reads: Index, rows: Array, base: int, buffer: int, w: Array, contact: int
) -> tuple[float, float]:
    """Compression and gap of one contact."""
    at, read, row = I64(4), buffer * code[3], base
    for _ in range(contact):
        row += 5 + code[at] + code[at + 1]
        read += code[at] + code[at + 1]
        at += 4
    d = first_lane(compression((0.0,), code, reads, rows, at, read, row, w))
    return d, first_lane(dead_zone((0.0,), code, rows, row, w))


@nb.njit(**INNER)
def _clearance(d: float, gap: float, side: float, leaving: float) -> float:
    """Distance to the boundary of a side; in the gap, to the boundary in direction ``leaving``."""
    return side * d - gap if side != 0.0 else gap - leaving * d


@nb.njit(**INNER)
def row_within(code: Index, rows: Array, base: int, tau: float, part: Array, node: int) -> None:
    """Interpolate the three rows of a step quadratically at the fraction ``tau``."""
    columns = code[2]
    left, middle = (1.0 - tau) * (1.0 - 2.0 * tau), 4.0 * tau * (1.0 - tau)
    right = tau * (2.0 * tau - 1.0)
    for column in range(columns):
        part[node * columns + column] = (
            left * rows[base + column]
            + middle * rows[base + columns + column]
            + right * rows[base + 2 * columns + column]
        )


@nb.njit(**INNER)
def _first_beyond(
    code: Index, reads: Index, part: Array, w: Array, known: int
) -> tuple[Any, float, float, float]:
    """Contact that seems to have left its side first: its number, direction, clearances."""
    found: Any = I64(-1)
    direction, g_start, g_end, least = 0.0, 0.0, 0.0, 2.0
    for j in range(code[1]):
        if j == known or code[4 + 4 * j + 2] == 0:
            continue
        side = w[8 * code[0] + code[1] + j]
        d, gap = _place(code, reads, part, 2 * code[2], I64(2), w, j)
        leaving = 1.0 if d > 0.0 else -1.0
        after = _clearance(d, gap, side, leaving)
        if after < 0.0:
            d, gap = _place(code, reads, part, I64(0), I64(0), w, j)
            before = _clearance(d, gap, side, leaving)
            at = before / (before - after) if before > 0.0 else 0.0
            if at < least:
                found, direction, g_start, g_end, least = j, leaving, before, after, at
    return found, direction, g_start, g_end


@nb.njit(**INNER)
def _note(code: Index, start: float, end: float, w: Array, parts: Array) -> None:
    """Add a part to the list of them: where it begins and ends, sides, state at both ends."""
    n, contacts = code[0], code[1]
    at = 1 + I64(parts[0]) * (2 + contacts + 4 * n)
    parts[0] += 1.0
    parts[at], parts[at + 1] = start, end
    at += 2
    for j in range(contacts):
        parts[at + j] = w[8 * n + contacts + j]
    at += contacts
    for i in range(2 * n):
        parts[at + i], parts[at + 2 * n + i] = w[i], w[4 * n + i]


@nb.njit(**INNER)
def split_step(
    code: Index,
    reads: Index,
    rows: Array,
    base: int,
    width: float,
    part: Array,
    w: Array,
    parts: Array,
) -> int:
    """March one lane by one step in parts; returns the number of crossings."""
    n, right, sides = code[0], 2 * code[2], 8 * code[0] + code[1]
    start, target, contact, splits, probe, tries = 0.0, 1.0, I64(-1), 0, 0, 0
    parts[0] = 0.0
    low = high = g_low = g_high = leaving = scale = 0.0
    while True:
        for node in range(3):
            row_within(code, rows, base, start + 0.5 * node * (target - start), part, I64(node))
        w[9 * n + 2 * code[1] + 1] = width * (target - start)
        step((0.0,), code, reads, part, I64(0), w)
        if contact >= 0:
            d, gap = _place(code, reads, part, right, I64(2), w, contact)
            g = _clearance(d, gap, w[sides + contact], leaving)
            done = target == start or abs(g) <= 1e-14 * scale or abs(high - low) < 1e-15
            # A motion beyond all bounds has no crossing to be found; the caller reports it.
            tries += 1
            done = done or tries > MAX_TRIES or not np.isfinite(g)
            if probe > 0 and not done:
                # A contact just made starts on its boundary, to rounding: look for a point inside.
                if g > 0.0:
                    low, g_low, probe = target, g, 0
                elif probe == 7:
                    target = start
                    continue
                else:
                    probe += 1
                    target = start + 0.125 * probe * (1.0 - start)
                    continue
            elif not done:
                if g * g_high < 0.0:
                    low, g_low = high, g_high
                else:
                    g_low *= 0.5
                high, g_high = target, g
            if not done:
                target = (low * g_high - high * g_low) / (g_high - g_low)
                continue
        other, direction, before, after = _first_beyond(code, reads, part, w, contact)
        if other >= 0 and splits < MAX_SPLITS and not (contact >= 0 and target == start):
            # Another contact crossed, earlier than the one just found if there was one.
            contact, leaving, scale, tries = other, direction, abs(before - after), 0
            low, g_low, high, g_high = start, before, target, after
            if before > 0.0:
                probe = 0
                target = (low * g_high - high * g_low) / (g_high - g_low)
            else:
                probe = 1
                target = start + 0.125 * (1.0 - start)
            continue
        _note(code, start, target, w, parts)
        if contact < 0:
            break
        for i in range(2 * n):
            w[i] = w[4 * n + i]
        if w[sides + contact] != 0.0:
            w[sides + contact] = 0.0
        else:
            w[sides + contact] = leaving
        start, target, contact, probe = target, 1.0, I64(-1), 0
        splits += 1
    if splits == MAX_SPLITS:
        find_sides(code, reads, part, right, I64(2), w)
    return splits
