"""Splitting a step where a contact leaves its side of the dead zone.

The contact force has a kink there, and with damping a jump. A Runge-Kutta step across it loses
its order, so the lane concerned repeats the step in parts, each with one force law, from
crossing to crossing. Rows are interpolated quadratically within the step.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.dynamics.crossing_search import (
    NEAR,
    NOW,
    WIDTH,
    begin_search,
    change_sides,
    go_on,
    most_splits,
)
from tribodyn.dynamics.kernel import I64, INNER, compression, dead_zone, step
from tribodyn.dynamics.lanes import above, first_lane, store
from tribodyn.types import Array, Index


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
def _measure(
    code: Index, reads: Index, rows: Array, base: int, buffer: int, w: Array, room: Array,
    place: int,
) -> None:  # fmt: skip
    """Compression and gap of every contact with a dead zone, from ``place`` of its numbers."""
    at, read, row = I64(4), buffer * code[3], base
    for j in range(code[1]):
        if code[at + 2] != 0:
            d = compression((0.0,), code, reads, rows, at, read, row, w)
            room[WIDTH * j + place] = first_lane(d)
            room[WIDTH * j + place + 1] = first_lane(dead_zone((0.0,), code, rows, row, w))
        row += 5 + code[at] + code[at + 1]
        read += code[at] + code[at + 1]
        at += 4


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
def _try(
    code: Index, reads: Index, rows: Array, base: int, width: float, part: Array, w: Array,
    room: Array, start: float, target: float,
) -> None:  # fmt: skip
    """March the part of a step from ``start`` to ``target`` with the sides at its beginning."""
    for node in range(3):
        row_within(code, rows, base, start + 0.5 * node * (target - start), part, I64(node))
    w[9 * code[0] + 2 * code[1] + 1] = width * (target - start)
    step((0.0,), code, reads, part, I64(0), w)
    _measure(code, reads, part, 2 * code[2], I64(2), w, room, I64(NOW))


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
    room: Array,
) -> Any:
    """March one lane by one step in parts; returns -1, or a contact that comes to no end."""
    n, contacts, sides = code[0], code[1], 8 * code[0] + code[1]
    start, contact = 0.0, I64(-1)
    parts[0] = 0.0
    for j in range(contacts):
        room[WIDTH * j] = 0.0 if code[4 + 4 * j + 2] != 0 else -1.0
    row_within(code, rows, base, 0.0, part, I64(0))
    _measure(code, reads, part, I64(0), I64(0), w, room, I64(NEAR))
    for _ in range(most_splits(contacts) + 1):
        _try(code, reads, rows, base, width, part, w, room, start, 1.0)
        target = begin_search(room, contacts, start, 1.0, sides, w)
        if target < 0.0:
            _note(code, start, 1.0, w, parts)
            return I64(-1)
        there = False
        while not there:
            _try(code, reads, rows, base, width, part, w, room, start, target)
            there, following = go_on(room, contacts, start, target, sides, w)
            if not there:
                target = following
        _note(code, start, target, w, parts)
        contact = change_sides(room, contacts, start, target, sides, w)
        for i in range(2 * n):
            w[i] = w[4 * n + i]
        start = target
    for i in range(2 * n):
        if not np.isfinite(w[i]):
            return I64(-1)
    return contact
