"""Marching a block of lanes by Newmark's scheme: steps, events, contact changes, record.

A step in which a contact leaves its side of the dead zone is repeated, for the lane concerned, in
parts from crossing to crossing. Each part has one force law, and the acceleration is found anew
where a part begins, as it is at every event: without that the scheme is of first order.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.dynamics.crossing_search import (
    NEAR,
    NOW,
    WIDTH,
    begin_search,
    change_sides,
    go_on,
    most_splits,
)
from tribodyn.dynamics.kernel import I64, INNER, JIT
from tribodyn.dynamics.lanes import address, first_lane, load
from tribodyn.dynamics.newmark_force import SINGLE, compression, row_length, slots
from tribodyn.dynamics.newmark_kernel import beyond, newmark_step, start_acceleration
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

#: Every file whose code or constants end up in the compiled kernel.
_OWN = ("newmark_lanes", "newmark_force", "newmark_kernel", "newmark_marching")
_SOURCES = ("lanes", "kernel", "crossing_search", *_OWN)
#: What the kernel returns from here on tells of a step that comes to no end.
UNPARTED = 1 << 40


@nb.njit(**INNER)
def _invert(
    n: int, law: Array, matrices: Array, h: float, inverse: int, spare: int, w: Array
) -> None:
    """Inverse of ``M + gamma h C + beta h^2 K`` of one lane, by elimination with pivots."""
    square = n * n
    for item in range(square):
        w[spare + item] = (
            matrices[item]
            + law[0] * h * matrices[square + item]
            + law[1] * h * h * matrices[2 * square + item]
        )
        w[inverse + item] = 0.0
    for i in range(n):
        w[inverse + i * n + i] = 1.0
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(w[spare + i * n + k]) > abs(w[spare + best * n + k]):
                best = i
        for part in (spare, inverse):
            for j in range(n):
                upper = w[part + k * n + j]
                w[part + k * n + j] = w[part + best * n + j]
                w[part + best * n + j] = upper
        pivot = 1.0 / w[spare + k * n + k]
        for j in range(n):
            w[spare + k * n + j] *= pivot
            w[inverse + k * n + j] *= pivot
        for i in range(n):
            factor = w[spare + i * n + k]
            if i != k and factor != 0.0:
                for j in range(n):
                    w[spare + i * n + j] -= factor * w[spare + k * n + j]
                    w[inverse + i * n + j] -= factor * w[inverse + k * n + j]


@nb.njit(**INNER)
def _find_sides(
    shape: tuple[int, int, int, int], dead: Index, rows: Array, row: int, q: int, w: Array
) -> None:
    """Set the side of every contact of one lane from its compression."""
    n, m = shape[0], shape[1]
    side, _, _, _, _, _, _, _, _, single = slots(shape)
    for j in range(m):
        w[side + j] = 1.0
        if dead[j] != 0:
            at = row + j * (5 + 3 * n)
            error = load((0.0,), w, single + 6)
            d = first_lane(compression((0.0,), n, rows, at, q, error, w))
            gap = w[single + 7] * rows[at + 4]
            w[side + j] = 1.0 if d > gap else (-1.0 if d < -gap else 0.0)


@nb.njit(**INNER)
def _row_within(columns: int, rows: Array, base: int, tau: float, part: Array, place: int) -> None:
    """Interpolate the three rows of a step quadratically at the fraction ``tau``."""
    left, middle = (1.0 - tau) * (1.0 - 2.0 * tau), 4.0 * tau * (1.0 - tau)
    right = tau * (2.0 * tau - 1.0)
    for column in range(columns):
        part[place + column] = (
            left * rows[base + column]
            + middle * rows[base + columns + column]
            + right * rows[base + 2 * columns + column]
        )


@nb.njit(**INNER)
def _measure(
    shape: tuple[int, int, int, int], dead: Index, part: Array, row: int, q: int, w: Array,
    room: Array, place: int,
) -> None:  # fmt: skip
    """Compression and gap of every contact with a dead zone, from ``place`` of its numbers."""
    n, m = shape[0], shape[1]
    _, _, _, _, _, _, _, _, _, single = slots(shape)
    error = load((0.0,), w, single + 6)
    for j in range(m):
        if dead[j] != 0:
            at = row + j * (5 + 3 * n)
            room[WIDTH * j + place] = first_lane(compression((0.0,), n, part, at, q, error, w))
            room[WIDTH * j + place + 1] = w[single + 7] * part[at + 4]


@nb.njit(**INNER)
def _try(
    shape: tuple[int, int, int, int], law: Array, structure: Any, matrices: Array, rows: Array,
    base: int, width: float, facts: Array, dead: Index, part: Array, w: Array, room: Array,
    start: float, target: float,
) -> bool:  # fmt: skip
    """March the part of a step from ``start`` to ``target`` with the sides at its beginning."""
    n, columns = shape[0], row_length(shape)
    _, _, _, _, _, _, _, _, _, single = slots(shape)
    inverse = single + SINGLE
    _row_within(columns, rows, base, target, part, columns)
    w[single] = width * (target - start)
    _invert(n, law, matrices, w[single], inverse, inverse + n * n, w)
    good: bool = newmark_step((0.0,), shape, law, structure, part, columns, facts, inverse, w)
    _measure(shape, dead, part, columns, 3 * n, w, room, I64(NOW))
    return good


@nb.njit(**INNER)
def _split_step(
    shape: tuple[int, int, int, int],
    law: Array,
    structure: Any,
    matrices: Array,
    rows: Array,
    base: int,
    width: float,
    facts: Array,
    dead: Index,
    part: Array,
    w: Array,
    room: Array,
) -> tuple[bool, Any]:
    """March one lane by one step in parts; returns whether all contact forces were found."""
    n, m = shape[0], shape[1]
    columns = row_length(shape)
    sides, _, _, _, _, _, _, _, _, _ = slots(shape)
    start, ok, contact = 0.0, True, I64(-1)
    for j in range(m):
        room[WIDTH * j] = 0.0 if dead[j] != 0 else -1.0
    _row_within(columns, rows, base, 0.0, part, I64(0))
    _measure(shape, dead, part, I64(0), I64(0), w, room, I64(NEAR))
    for _ in range(most_splits(m) + 1):
        good = _try(
            shape, law, structure, matrices, rows, base, width, facts, dead, part, w, room,
            start, 1.0,
        )  # fmt: skip
        ok = ok and good
        target = begin_search(room, m, start, 1.0, sides, w)
        if target < 0.0:
            return ok, I64(-1)
        there = False
        while not there:
            good = _try(
                shape, law, structure, matrices, rows, base, width, facts, dead, part, w, room,
                start, target,
            )  # fmt: skip
            ok = ok and good
            there, following = go_on(room, m, start, target, sides, w)
            if not there:
                target = following
        contact = change_sides(room, m, start, target, sides, w)
        for i in range(3 * n):
            w[i] = w[3 * n + i]
        for column in range(columns):
            part[column] = part[columns + column]
        start_acceleration((0.0,), shape, structure, part, I64(0), facts, w)
        start = target
    for i in range(2 * n):
        if not np.isfinite(w[i]):
            return ok, I64(-1)
    return ok, contact


def _build(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def newmark_block(
        lanes: Any,
        shape: tuple[int, int, int, int],
        law: Array,
        first: Index,
        columns: Index,
        factors: Array,
        matrices: Array,
        rows: Array,
        share: Array,
        kind: Index,
        restart: Any,
        dead: Index,
        facts: Array,
        work: Array,
        period: Array,
        load_: Array,
        state: Array,
        cycles: int,
        record: Array,
        place: int,
        count: int,
        stop: Index,
    ) -> int:
        """March every lane by ``cycles`` mesh cycles."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        n, m = shape[0], shape[1]
        width = len(lanes)
        side, _, _, _, _, _, _, _, _, single = slots(shape)
        inverse = single + SINGLE
        length = row_length(shape)
        kinds = 0
        for r in range(kind.size):
            kinds = max(kinds, kind[r] + 1)
        own = (inverse + kinds * n * n) * width
        one, part = address(work[own:]), address(work[own + inverse + 2 * n * n :])
        room = address(work[own + inverse + 2 * n * n + 2 * length :])
        w, rows, matrices, law = address(work), address(rows), address(matrices), address(law)
        structure = (
            address(first),
            address(columns),
            address(factors),
            address(work[work.size - n * n :]),
        )
        for i in range(n * n):
            structure[3][i] = matrices[3 * n * n + i]
        switching = False
        for j in range(m):
            switching = switching or dead[j] != 0
        for lane in range(width):
            for i in range(2 * n):
                w[i * width + lane] = state[lane, i]
            for i in range(n):
                w[(7 * n + i) * width + lane] = load_[lane, i]
            for j in range(m):
                w[(side + j) * width + lane] = 1.0
            w[(single + 1) * width + lane] = 1.0 / period[lane]
            w[(single + 2) * width + lane] = 0.0
            for item in range(SINGLE - 3):
                w[(single + 3 + item) * width + lane] = load_[lane, n + item]
        keep = record.shape[0] > 0
        point = 0
        for cycle in range(cycles):
            for r in range(share.size):
                if stop[0] != 0:
                    return STOPPED
                base = 3 * length * r
                for lane in range(width):
                    w[single * width + lane] = period[lane] * share[r]
                if keep:
                    for i in range(2 * n):
                        for lane in range(count):
                            record[point, i, place + lane] = w[i * width + lane]
                fresh = restart[r] or (r == 0 and cycle == 0)
                if fresh and switching:
                    for lane in range(width):
                        for slot in range(inverse):
                            one[slot] = w[slot * width + lane]
                        _find_sides(shape, dead, rows, base, I64(0), one)
                        for slot in range(side, side + m):
                            w[slot * width + lane] = one[slot]
                if fresh:
                    start_acceleration(lanes, shape, structure, rows, base, facts, w)
                right = base + 2 * length
                found = newmark_step(
                    lanes, shape, law, structure, rows, right, facts,
                    inverse + kind[r] * n * n, w,
                )  # fmt: skip
                if not found:
                    return 2 * point + 3
                if switching and beyond(lanes, shape, dead, rows, right, w):
                    for lane in range(width):
                        for slot in range(inverse):
                            one[slot] = w[slot * width + lane]
                        if beyond((0.0,), shape, dead, rows, right, one):
                            whole = one[single]
                            found, contact = _split_step(
                                shape, law, structure, matrices, rows, base, whole, facts, dead,
                                part, one, room,
                            )  # fmt: skip
                            if contact >= 0:
                                told: int = (point * m + contact) * width + lane
                                return UNPARTED + told
                            if not found:
                                return 2 * point + 3
                            for slot in range(3 * n, 6 * n):
                                w[slot * width + lane] = one[slot]
                            for slot in range(side, side + 2 * m):
                                w[slot * width + lane] = one[slot]
                for item in range(3 * n * width):
                    w[item] = w[3 * n * width + item]
                point += 1
            for item in range(2 * n * width):
                if not np.isfinite(w[item]):
                    return 2 * point
        for lane in range(width):
            for i in range(2 * n):
                state[lane, i] = w[i * width + lane]
        if keep:
            for i in range(2 * n):
                for lane in range(count):
                    record[point, i, place + lane] = w[i * width + lane]
        return -1

    return newmark_block


newmark_block = _build(source_digest(Path(__file__).parent, _SOURCES))
