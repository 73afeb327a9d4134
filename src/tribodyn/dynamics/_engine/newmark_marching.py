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
from tribodyn.dynamics._engine.contact_forces import I64, INNER, JIT
from tribodyn.dynamics._engine.crossing import MAX_SPLITS, MAX_TRIES
from tribodyn.dynamics._engine.lanes import address, first_lane, load
from tribodyn.dynamics._engine.newmark_force import SINGLE, compression, row_length, slots
from tribodyn.dynamics._engine.newmark_kernel import (
    beyond,
    newmark_step,
    start_acceleration,
)
from tribodyn.types import Array, Index

#: Every file whose code or constants end up in the compiled kernel.
_OWN = ("newmark_lanes", "newmark_force", "newmark_kernel", "newmark_marching")
_SOURCES = ("lanes", "contact_forces", "crossing", *_OWN)


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
def _clearance(
    n: int, part: Array, at: int, q: int, side: float, leaving: float, single: int, w: Array
) -> float:
    """Distance to the boundary of a side; in the gap, to the boundary in direction ``leaving``."""
    error, gap = load((0.0,), w, single + 6), w[single + 7] * part[at + 4]
    d = first_lane(compression((0.0,), n, part, at, q, error, w))
    away: float = side * d - gap if side != 0.0 else gap - leaving * d
    return away


@nb.njit(**INNER)
def _first_beyond(
    shape: tuple[int, int, int, int], dead: Index, part: Array, right: int, known: int, w: Array
) -> tuple[Any, float, float, float]:
    """Contact that seems to have left its side first: its number, direction, clearances."""
    n, m = shape[0], shape[1]
    sides, _, _, _, _, _, _, _, _, single = slots(shape)
    found: Any = I64(-1)
    direction, g_start, g_end, least = 0.0, 0.0, 0.0, 2.0
    for j in range(m):
        if j == known or dead[j] == 0:
            continue
        at, side = j * (5 + 3 * n), w[sides + j]
        error = load((0.0,), w, single + 6)
        d = first_lane(compression((0.0,), n, part, right + at, 3 * n, error, w))
        leaving = 1.0 if d > 0.0 else -1.0
        after = _clearance(n, part, right + at, 3 * n, side, leaving, single, w)
        if after < 0.0:
            before = _clearance(n, part, at, 0, side, leaving, single, w)
            share = before / (before - after) if before > 0.0 else 0.0
            if share < least:
                found, direction, g_start, g_end, least = j, leaving, before, after, share
    return found, direction, g_start, g_end


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
) -> bool:
    """March one lane by one step in parts; returns False if contact forces were not found."""
    n = shape[0]
    columns = row_length(shape)
    sides, _, _, _, _, _, _, _, _, single = slots(shape)
    inverse = single + SINGLE
    spare = inverse + n * n
    start, target, contact, splits, probe, tries = 0.0, 1.0, I64(-1), 0, 0, 0
    low = high = g_low = g_high = leaving = scale = 0.0
    ok = True
    _row_within(columns, rows, base, 0.0, part, I64(0))
    while True:
        _row_within(columns, rows, base, target, part, columns)
        w[single] = width * (target - start)
        _invert(n, law, matrices, w[single], inverse, spare, w)
        good = newmark_step((0.0,), shape, law, structure, part, columns, facts, inverse, w)
        ok = ok and good
        if contact >= 0:
            at = columns + contact * (5 + 3 * n)
            g = _clearance(n, part, at, 3 * n, w[sides + contact], leaving, single, w)
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
        other, direction, before, after = _first_beyond(shape, dead, part, columns, contact, w)
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
        if contact < 0:
            break
        for i in range(3 * n):
            w[i] = w[3 * n + i]
        if w[sides + contact] != 0.0:
            w[sides + contact] = 0.0
        else:
            w[sides + contact] = leaving
        for column in range(columns):
            part[column] = part[columns + column]
        start_acceleration((0.0,), shape, structure, part, I64(0), facts, w)
        start, target, contact, probe = target, 1.0, I64(-1), 0
        splits += 1
    if splits == MAX_SPLITS:
        _find_sides(shape, dead, part, columns, 3 * n, w)
    return ok


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
                            found = _split_step(
                                shape, law, structure, matrices, rows, base, whole, facts, dead,
                                part, one,
                            )  # fmt: skip
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
