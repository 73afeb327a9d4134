"""Integrate a block of lanes over mesh cycles: steps, crossings, record and statistics."""

from __future__ import annotations

import numba as nb
import numpy as np
from numba import types
from numba.extending import overload

from tribodyn.compiled.cache import cached_njit
from tribodyn.compiled.jit import INNER, JIT, ONCE
from tribodyn.dynamics._engine import newmark, runge_kutta  # noqa: F401  # their overloads
from tribodyn.dynamics._engine.contact_forces import (
    I64,
    acceleration,
    first_contact,
    is_dead_zone,
    left_side,
    next_contact,
    set_sides,
    slots_of,
)
from tribodyn.dynamics._engine.crossing import WIDTH, most_splits, split_step
from tribodyn.dynamics._engine.lanes import Lanes, address, ahead, load, on_line, store
from tribodyn.dynamics._engine.method import (
    Law,
    Method,
    accept,
    kernel_digest,
    own_slots,
    prepare,
    restart,
    step,
)
from tribodyn.dynamics._engine.midpoint import set_inverse, statistics_slots
from tribodyn.dynamics._engine.running_statistics import (
    Gathered,
    Place,
    add_nodes,
    gather,
    gather_parts,
)
from tribodyn.dynamics.equations.program import LaneRows, Program
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

#: Offsets of the codes that :func:`march_block` returns for a contact that opens and closes without
#: end, and for a step whose contact forces did not converge.
CHATTERING, UNCONVERGED = 1 << 40, 1 << 50


@nb.njit(**INNER)
def take_lane(lane: int, width: int, slots: int, w: Array, single: Array) -> None:
    """Copy the slots of one lane of a block."""
    for slot in range(slots):
        single[slot] = w[slot * width + lane]


@nb.njit(**INNER)
def put_lane(lane: int, width: int, first: int, last: int, w: Array, single: Array) -> None:
    """Copy slots of one lane back into the block."""
    for slot in range(first, last):
        w[slot * width + lane] = single[slot]


def _open_rows(rows: Array | LaneRows, three: Array) -> Array:
    """Rows for :func:`~tribodyn.dynamics._engine.lanes.entry`; a tuple if each lane has its own."""
    raise TypeError("chosen by type where it is compiled")


@overload(_open_rows, inline="always")
def _choose_table(rows, three):  # type: ignore[no-untyped-def]
    if isinstance(rows, types.BaseTuple):
        return lambda rows, three: (three,)
    return lambda rows, three: address(rows)


def _rows_at(lanes: Lanes, columns: int, rows: Array | LaneRows, step: int, three: Array) -> int:
    """Address of the rows of a step; steps have to be read in order from the first."""
    raise TypeError("chosen by type where it is compiled")


@overload(_rows_at, inline="always")
def _choose_place(lanes, columns, rows, step, three):  # type: ignore[no-untyped-def]
    if not isinstance(rows, types.BaseTuple):
        return lambda lanes, columns, rows, step, three: 3 * columns * step

    def put_rows(lanes, columns, rows, step, three):  # type: ignore[no-untyped-def]
        places, varying, count = address(rows.places), address(rows.varying), rows.places.size
        if step == 0:
            for item in range(3 * columns * len(lanes)):
                three[item] = rows.first[item % rows.first.size]
        two = (rows.nodes.size - 4) // 3  # 1 if every other step has another order of nodes
        first, place = rows.nodes[0] * (step >> two), 1 + 3 * (step & two)
        for node in range(3):
            row = (first + rows.nodes[place + node]) * count
            for item in range(count):
                store(three, node * columns + places[item], load(lanes, varying, row + item))
        return I64(0)

    return put_rows


def _rows_of_lane(law: Law, base: int, width: int, lane: int, gathered: Array) -> tuple[Law, int]:
    """Law of one lane and address of its rows; copied to ``gathered`` if each lane has its own."""
    raise TypeError("chosen by type where it is compiled")


@overload(_rows_of_lane, inline="always")
def _choose_rows(law, base, width, lane, gathered):  # type: ignore[no-untyped-def]
    if not isinstance(law.types[2], types.BaseTuple):
        return lambda law, base, width, lane, gathered: (law, base)

    def gather_rows(law, base, width, lane, gathered):  # type: ignore[no-untyped-def]
        table = law.rows[0]
        for item in range(3 * law.code[2]):
            gathered[item] = table[(base + item) * width + lane]
        return Law(law.code, law.reads, gathered), 0

    return gather_rows


@nb.njit(**ONCE)
def set_up(width: int, code: Index, period: Array, load: Array, state: Array, w: Array) -> None:
    """Fill the slots of all lanes: state, load and factors."""
    s = slots_of(code)
    n = s.n
    for lane in range(width):
        for i in range(2 * n):
            w[i * width + lane] = state[lane, i]
        for i in range(n):
            w[(s.load + i) * width + lane] = load[lane, i]
        for j in range(s.contacts):
            w[(s.side + j) * width + lane] = 1.0
        w[s.force_scale * width + lane] = 1.0
        w[s.beat * width + lane] = 1.0 / period[lane]
        if load.shape[1] > n:
            w[s.stiffness * width + lane] = load[lane, n] - 1.0
            w[s.damping * width + lane] = load[lane, n + 1] - 1.0
            w[s.rub * width + lane] = load[lane, n + 2] - 1.0
            w[s.error * width + lane] = 1.0 - load[lane, n + 3]
            w[s.gap * width + lane] = load[lane, n + 4] - 1.0
            w[s.force_scale * width + lane] = load[lane, n + 5]


@nb.njit(**ONCE)
def has_dead_zones(law: Law) -> bool:
    """Whether any contact has a dead zone."""
    cursor = first_contact(law, I64(0), I64(0))
    any_dead_zone: bool = np.bool_(False)  # type: ignore[assignment]
    for _ in range(law.code[1]):
        any_dead_zone = any_dead_zone or is_dead_zone(law, cursor)
        cursor = next_contact(law, cursor)
    return any_dead_zone


def _statistics_slot_of(gathered: Gathered | None, slot: int) -> int:
    """Slot where a step stores its data for the statistics, or None."""
    raise TypeError("chosen by type where it is compiled")


@overload(_statistics_slot_of, inline="always")
def _choose_statistics_slot(gathered, slot):  # type: ignore[no-untyped-def]
    if isinstance(gathered, types.NoneType):
        return lambda gathered, slot: None
    return lambda gathered, slot: slot


@cached_njit(kernel_digest(), "the engine", "a quarter of a minute", **JIT)
def march_block(
    lanes: Lanes,
    method: Method,
    program: Program,
    rows: Array | LaneRows,
    period: Array,
    load: Array,
    state: Array,
    cycles: int,
    record: Array,
    gathered: Gathered | None,
    stop: Index,
) -> int:
    """Integrate every lane over ``cycles`` mesh cycles.

    The record (points, items, lanes) receives as many items of the states as fit into it.
    Returns -1 on success, :data:`STOPPED` after an interruption, the step (counted from the
    start) after which a state is not finite, :data:`CHATTERING` plus
    ``(step * contacts + contact) * lanes + lane``, or :data:`UNCONVERGED` plus the step.
    """
    share, again = program.width, program.restart
    columns, width = program.code[2], len(lanes)
    row_buffer = np.empty(3 * columns * width + 8)  # of lanes with rows of their own
    three = on_line(address(row_buffer))
    law = Law(address(program.code), address(program.reads), _open_rows(rows, three))
    s, n = slots_of(law.code), law.code[0]
    method_slots, persistent_slots, kinds = own_slots(method, law)
    # The data of a step for the statistics follow the slots of the method.
    statistics_slot = _statistics_slot_of(gathered, s.end + method_slots)
    slots = s.end + method_slots + (0 if statistics_slot is None else statistics_slots(s.contacts))
    # Slots of all lanes, moments, slots of one lane, rows of a part of a step, rows of a lane.
    count, waves = 0, 0
    if gathered is not None:
        count, waves = gathered.moments.size // width, 2 * gathered.harmonics
    work = np.zeros((slots + count) * width + slots + 6 * columns + 8)
    w = on_line(address(work))
    moments = ahead(w, slots * width)
    single = ahead(moments, count * width)
    part = ahead(single, slots)
    lane_rows = ahead(part, 3 * columns)
    # Parts of a step, search, moments of lanes with a split step, cosines and sines of a part.
    parts_size = 1 + (most_splits(s.contacts) + 1) * (2 + s.contacts + 4 * n)
    search_end = parts_size + WIDTH * (s.contacts + 1)
    scratch = np.empty(search_end + count * width + 3 * waves)
    parts = address(scratch)
    search, split_moments = ahead(parts, parts_size), ahead(parts, search_end)
    set_up(width, law.code, period, load, state, w)
    base = _rows_at(lanes, columns, rows, I64(0), three)
    for lane in range(width if method_slots > 0 else 0):
        take_lane(lane, width, slots, w, single)
        lane_law, first = _rows_of_lane(law, base, width, lane, lane_rows)
        for kind in range(kinds):
            prepare(method, lane_law, first, period[lane], kind, single)
        put_lane(lane, width, s.end, slots, w, single)
    if gathered is not None:
        sums = Gathered(gathered.outputs, address(gathered.waves), gathered.harmonics, moments)
        for item in range(gathered.moments.size):
            moments[item] = gathered.moments[item]
    switching = has_dead_zones(law)
    recording, recorded, states = record.shape[0] > 0, address(record), 2 * n * width
    record_items = record.shape[1] * width
    point = 0
    for _cycle in range(cycles):
        for r in range(share.size):
            if stop[0] != 0:
                return STOPPED
            base = _rows_at(lanes, columns, rows, r, three)
            for lane in range(width):
                w[s.h * width + lane] = period[lane] * share[r]
            if gathered is not None:
                set_inverse(lanes, law, share[r], w)
            if again[r] or point == 0:
                if switching:
                    set_sides(lanes, law, base, I64(0), w)
                restart(lanes, method, law, base, w)
            if recording:
                for item in range(record_items):
                    recorded[point * record_items + item] = w[item]
            if not step(lanes, method, law, r, base, w, statistics_slot):
                return UNCONVERGED + point + 1
            crossed = I64(0)
            if switching:
                crossed = left_side(lanes, law, base + 2 * columns, w)
            if crossed != 0:
                for lane in range(width):
                    if not (crossed >> lane) & 1:
                        continue
                    take_lane(lane, width, slots, w, single)
                    lane_law, first = _rows_of_lane(law, base, width, lane, lane_rows)
                    duration = period[lane] * share[r]
                    if gathered is not None:
                        lane_moments = ahead(split_moments, lane * count)
                        take_lane(lane, width, count, sums.moments, lane_moments)
                        lane_sums = Gathered(sums.outputs, sums.waves, sums.harmonics, lane_moments)
                        location = Place(first, 3 * waves * r, share[r] / cycles, statistics_slot)
                        add_nodes((0.0,), lane_law, location, I64(0), lane_sums, single)
                    good, contact = split_step(
                        method, lane_law, first, duration, part, single, parts, search
                    )
                    if contact >= 0:
                        return CHATTERING + (point * s.contacts + contact) * width + lane
                    if not good:
                        return UNCONVERGED + point + 1
                    put_lane(lane, width, 4 * n, 6 * n, w, single)
                    put_lane(lane, width, s.force, s.side + s.contacts, w, single)
                    put_lane(lane, width, s.end, s.end + persistent_slots, w, single)
                    if gathered is not None:
                        part_waves = ahead(split_moments, count * width)
                        gather_parts(
                            lane_law,
                            location,
                            parts,
                            duration,
                            part,
                            part_waves,
                            lane_sums,
                            single,
                        )
            if gathered is not None:
                location, pending = (
                    Place(base, 3 * waves * r, share[r] / cycles, statistics_slot),
                    1.0,
                )
                add_nodes(lanes, law, location, I64(1), sums, w)
                if r + 1 == share.size or again[r + 1]:
                    acceleration(lanes, law, base + 2 * columns, I64(2), s.first, w)
                    add_nodes(lanes, law, location, I64(2), sums, w)
                    pending = 0.0
                for lane in range(width):
                    at = (statistics_slot + 3 * s.contacts) * width + lane
                    w[at] = pending * location.share / 6.0
                    # The unsplit step was added to lanes with a split step: restore theirs.
                    if (crossed >> lane) & 1:
                        lane_moments = ahead(split_moments, lane * count)
                        put_lane(lane, width, I64(0), count, sums.moments, lane_moments)
                        w[at] = 0.0
            accept(lanes, method, law, w)
            point += 1
        for item in range(states):
            if not np.isfinite(w[item]):
                return point
    if gathered is not None:
        for item in range(gathered.moments.size):
            gathered.moments[item] = moments[item]
    for lane in range(width):
        for i in range(2 * n):
            state[lane, i] = w[i * width + lane]
    if recording:
        for item in range(record_items):
            recorded[point * record_items + item] = w[item]
    # Addresses are valid only while the arrays are in use: nothing is read after this.
    scratch[0] = work[0] + row_buffer[0]
    return -1


@cached_njit(kernel_digest(), "statistics of adaptive steps", "three seconds", **JIT)
def gather_record(
    lanes: Lanes,
    program: Program,
    period: Array,
    load: Array,
    record: Array,
    cycles: int,
    gathered: Gathered,
) -> None:
    """Add a mesh cycle of a block, recorded at the step ends of the grid, to its moments."""
    share, width, waves = program.width, len(lanes), gathered.harmonics
    law = Law(address(program.code), address(program.reads), address(program.rows))
    s, n, columns = slots_of(law.code), law.code[0], law.code[2]
    work = np.zeros(s.end * width)
    w, states = address(work), address(record)
    set_up(width, law.code, period, load, record[0].T, w)
    moments = address(gathered.moments)
    sums = Gathered(gathered.outputs, address(gathered.waves), waves, moments)
    switching = has_dead_zones(law)
    for r in range(share.size):
        for lane in range(width):
            w[s.h * width + lane] = period[lane] * share[r]
            w[s.inverse * width + lane] = 1.0 / w[s.h * width + lane]
        for item in range(2 * n * width):
            w[item] = states[2 * n * width * r + item]
            w[4 * n * width + item] = states[2 * n * width * (r + 1) + item]
        location = Place(3 * columns * r, 6 * waves * r, share[r] / cycles, I64(0))
        gather(lanes, law, switching, location, sums, w)
    # Addresses are valid only while the array is in use.
    work[0] = 0.0
