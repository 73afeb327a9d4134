"""Marching a block of lanes over whole mesh cycles: steps, crossings, record and statistics."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba as nb
import numpy as np
from numba import types
from numba.extending import overload

from tribodyn.compiled import source_digest
from tribodyn.dynamics.crossing import set_sides, split_step
from tribodyn.dynamics.crossing_search import WIDTH, most_splits
from tribodyn.dynamics.kernel import I64, INNER, JIT, left_side, step
from tribodyn.dynamics.lanes import address, open_rows
from tribodyn.dynamics.moments import gather, gather_parts
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

#: Every file whose code ends up in the compiled kernel.
_SOURCES = ("lanes", "kernel", "crossing_search", "crossing", "moments", "marching")
#: What :func:`march_block` returns from here on tells of a step that comes to no end.
UNPARTED = 1 << 40


@nb.njit(**INNER)
def _take(lane: int, width: int, slots: int, w: Array, single: Array) -> None:
    for slot in range(slots):
        single[slot] = w[slot * width + lane]


@nb.njit(**INNER)
def _put(lane: int, width: int, first: int, last: int, w: Array, single: Array) -> None:
    for slot in range(first, last):
        w[slot * width + lane] = single[slot]


def _own_rows(
    rows: Any, base: int, columns: int, width: int, lane: int, room: Any
) -> tuple[Any, int]:
    """Three rows of one lane, as an address and a base; gathered in ``room`` if need be."""
    return rows, base


@overload(_own_rows)
def _choose_rows(rows, base, columns, width, lane, room):  # type: ignore[no-untyped-def]
    if not isinstance(rows, types.BaseTuple):
        return lambda rows, base, columns, width, lane, room: (rows, base)

    def gathered(rows, base, columns, width, lane, room):  # type: ignore[no-untyped-def]
        table = rows[0]
        for item in range(3 * columns):
            room[item] = table[(base + item) * width + lane]
        return room, 0

    return gathered


@nb.njit(**INNER)
def _repair(
    lane: int,
    slots: int,
    lanes: Any,
    code: Index,
    reads: Index,
    rows: Array,
    base: int,
    w: Array,
    single: Array,
    part: Array,
    room: Array,
    parts: Array,
    search: Array,
) -> int:
    """Repeat the step in parts for a lane that crossed a boundary; returns as `split_step` does."""
    n, side, width = code[0], 8 * code[0] + code[1], len(lanes)
    h = 9 * n + 2 * code[1] + 1
    _take(lane, width, slots, w, single)
    own, start = _own_rows(rows, base, code[2], width, lane, room)
    whole = w[h * width + lane]
    contact: int = split_step(code, reads, own, start, whole, part, single, parts, search)
    _put(lane, width, 4 * n, 6 * n, w, single)
    _put(lane, width, side, side + code[1], w, single)
    return contact


def _room_aside(first: int, moments: Any, waves: int) -> Array:
    """Room for ``first`` numbers; with moments, also for those of every lane and some waves."""
    return np.empty(first + (0 if moments is None else moments.size + waves))


@overload(_room_aside)
def _choose_room(first, moments, waves):  # type: ignore[no-untyped-def]
    if isinstance(moments, types.NoneType):
        return lambda first, moments, waves: np.empty(first)
    return lambda first, moments, waves: np.empty(first + moments.size + waves)


@nb.njit(**INNER)
def _put_back(gone: int, width: int, moments: Array, kept: Array) -> None:
    """Replace the moments of split lanes, to which the whole step was added, by their own."""
    count = moments.size // width
    for lane in range(width):
        if (gone >> lane) & 1:
            own = address(kept[lane * count :])
            _put(lane, width, I64(0), count, address(moments), own)


@nb.njit(**INNER)
def _set_up(lanes: Any, code: Index, period: Array, load: Array, state: Array, w: Array) -> None:
    n, contacts, width = code[0], code[1], len(lanes)
    steady = 8 * n + 2 * contacts
    one = steady + n
    for lane in range(width):
        for i in range(2 * n):
            w[i * width + lane] = state[lane, i]
        for i in range(n):
            w[(steady + i) * width + lane] = load[lane, i]
        for j in range(contacts):
            w[(8 * n + contacts + j) * width + lane] = 1.0
        w[one * width + lane] = 1.0
        w[(one + 2) * width + lane] = 1.0 / period[lane]
        if load.shape[1] > n:
            # Factors of stiffness, damping, friction, error, gap and load: see `Slots`.
            for slot, item in ((6, 0), (7, 1), (8, 2), (5, 4)):
                w[(one + slot) * width + lane] = load[lane, n + item] - 1.0
            w[(one + 3) * width + lane] = 1.0 - load[lane, n + 3]
            w[one * width + lane] = load[lane, n + 5]


def _build(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def march_block(
        lanes: Any,
        code: Index,
        reads: Index,
        rows: Any,
        share: Array,
        restart: Any,
        work: Array,
        period: Array,
        load: Array,
        state: Array,
        cycles: int,
        record: Array,
        outputs: Array,
        waves: Array,
        harmonics: int,
        moments: Any,
        stop: Index,
    ) -> int:
        """March every lane by ``cycles`` mesh cycles."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        n, columns, width = code[0], code[2], len(lanes)
        h = 9 * n + 2 * code[1] + 1
        slots = h + 8 + code[4 + 4 * code[1]]
        single, part = address(work[slots * width :]), address(work[slots * (width + 1) :])
        room = address(work[slots * (width + 1) + 3 * columns :])
        w, code, reads, table = address(work), address(code), address(reads), open_rows(rows)
        # A list of the parts of a step, moments of the lanes that were split, waves of a part.
        listed = 1 + (most_splits(code[1]) + 1) * (2 + code[1] + 4 * n)
        most = listed + WIDTH * (code[1] + 1)
        kept = _room_aside(most, moments, 6 * harmonics)
        parts, search, wave = address(kept), address(kept[listed:]), address(waves)
        _set_up(lanes, code, period, load, state, w)
        switching = np.bool_(False)
        for j in range(code[1]):
            switching = switching or code[4 + 4 * j + 2] != 0
        keep = record.shape[0] > 0
        point = 0
        for _cycle in range(cycles):
            for r in range(share.size):
                if stop[0] != 0:
                    return STOPPED
                base = 3 * columns * r
                for lane in range(width):
                    w[h * width + lane] = period[lane] * share[r]
                if switching and restart[r]:
                    set_sides(lanes, code, reads, table, base, I64(0), w)
                if keep:
                    for i in range(2 * n):
                        for lane in range(width):
                            record[point, i, lane] = w[i * width + lane]
                step(lanes, code, reads, table, base, w)
                gone = I64(0)
                if switching:
                    gone = left_side(lanes, code, reads, table, base + 2 * columns, w)
                if gone != 0:
                    for lane in range(width):
                        if not (gone >> lane) & 1:
                            continue
                        contact = _repair(
                            lane,
                            slots,
                            lanes,
                            code,
                            reads,
                            table,
                            base,
                            w,
                            single,
                            part,
                            room,
                            parts,
                            search,
                        )
                        if contact >= 0:
                            place: int = (point * code[1] + contact) * width + lane
                            return UNPARTED + place
                        if moments is not None:
                            count = moments.size // width
                            own = address(kept[most + lane * count :])
                            _take(lane, width, count, address(moments), own)
                            own_rows, start = _own_rows(table, base, columns, width, lane, room)
                            gather_parts(
                                code,
                                reads,
                                own_rows,
                                start,
                                parts,
                                period[lane] * share[r],
                                part,
                                single,
                                outputs,
                                share[r] / cycles,
                                wave,
                                6 * harmonics * r,
                                harmonics,
                                address(kept[most + width * count :]),
                                own,
                            )
                if moments is not None:
                    for lane in range(width):
                        w[(h + 3) * width + lane] = 1.0 / w[h * width + lane]
                    gather(
                        lanes,
                        code,
                        reads,
                        table,
                        base,
                        switching,
                        w,
                        outputs,
                        share[r] / cycles,
                        wave,
                        6 * harmonics * r,
                        harmonics,
                        address(moments),
                    )
                    if gone != 0:
                        _put_back(gone, width, moments, kept[most:])
                for item in range(2 * n * width):
                    w[item] = w[4 * n * width + item]
                point += 1
            for item in range(2 * n * width):
                if not np.isfinite(w[item]):
                    return point
        # The address of the list of parts holds only as long as its owner is in use.
        kept[0] = 0.0
        for lane in range(width):
            for i in range(2 * n):
                state[lane, i] = w[i * width + lane]
        if keep:
            for i in range(2 * n):
                for lane in range(width):
                    record[point, i, lane] = w[i * width + lane]
        return -1

    return march_block


march_block = _build(source_digest(Path(__file__).parent, _SOURCES))
