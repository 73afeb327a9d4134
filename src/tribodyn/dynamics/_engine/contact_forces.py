"""The compiled equation of motion: contact forces, frictions and accelerations of all lanes.

Structure and contacts are data (:class:`~tribodyn.dynamics.equations.program.Program`); arithmetic
runs over lanes, the trajectories of an ensemble, which share the mesh phase and differ in mesh
period, load and state (:mod:`~tribodyn.dynamics._engine.lanes`). All numbers of a lane are stored
in slots of one work buffer. The readable law is :mod:`tribodyn.dynamics.equations.motion`.

``law`` holds the addresses of the arrays of the program, ``w`` is the work buffer, ``base`` the
address of a row in the table and ``buffer`` (0, 1, 2) the state buffer that is read. Whether lanes
share the rows or each has its own follows from the type of ``law.rows``, see
:func:`~tribodyn.dynamics._engine.lanes.entry`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled.jit import INNER
from tribodyn.dynamics._engine.lanes import (
    Lanes,
    above,
    below,
    entry,
    greatest,
    least,
    load,
    negative_lanes,
    store,
)
from tribodyn.dynamics._engine.method import Law
from tribodyn.dynamics.equations.program import Slots, lay_out
from tribodyn.types import Array, Index

#: Converts literal integer arguments, for each of which the compiler would recompile the callee.
I64: Callable[..., int] = np.int64  # type: ignore[assignment]


_lay_out = nb.njit(forceinline=True, **INNER)(lay_out)


@nb.njit(forceinline=True, **INNER)
def slots_of(code: Index) -> Slots:
    """Layout of the work buffer of a lane."""
    slots: Slots = _lay_out(code[0], code[1], code[4 + 4 * code[1]])
    return slots


class Cursor(NamedTuple):
    """Position in the three arrays of the program."""

    at: int
    read: int
    row: int


@nb.njit(forceinline=True, **INNER)
def first_contact(law: Law, base: int, buffer: int) -> Cursor:
    """Position of the first contact."""
    return Cursor(I64(4), I64(buffer * law.code[3]), I64(base))


@nb.njit(forceinline=True, **INNER)
def next_contact(law: Law, cursor: Cursor) -> Cursor:
    """Position of the next contact."""
    terms = law.code[cursor.at] + law.code[cursor.at + 1]
    return Cursor(cursor.at + 4, cursor.read + terms, cursor.row + 5 + terms)


@nb.njit(forceinline=True, **INNER)
def is_dead_zone(law: Law, cursor: Cursor) -> bool:
    """Whether a contact has a dead zone."""
    dead: bool = law.code[cursor.at + 2] != 0
    return dead


@nb.njit(**INNER)
def sum_terms(
    lanes: Lanes, law: Law, first: float, count: int, read: int, row: int, w: Array
) -> float:
    """``first`` plus the sum of factor times slot."""
    total = first
    for item in range(count):
        total = total + entry(lanes, law.rows, row + item) * load(lanes, w, law.reads[read + item])
    return total


@nb.njit(**INNER)
def compression(lanes: Lanes, law: Law, cursor: Cursor, error: int, w: Array) -> float:
    """Compression of a contact; ``error`` is the slot of its factor."""
    first = entry(lanes, law.rows, cursor.row + 2) * (load(lanes, w, error) - 1.0)
    return sum_terms(lanes, law, first, law.code[cursor.at], cursor.read, cursor.row + 5, w)


@nb.njit(forceinline=True, **INNER)
def compression_and_rate(
    lanes: Lanes, law: Law, s: Slots, cursor: Cursor, w: Array
) -> tuple[float, float]:
    """Compression of a contact and its rate, in one loop."""
    code, rows = law.code, law.rows
    beat, error = load(lanes, w, s.beat), load(lanes, w, s.error) - 1.0
    d = entry(lanes, rows, cursor.row + 2) * error
    rate = entry(lanes, rows, cursor.row + 3) * (error * beat)
    row, read = cursor.row + 5, cursor.read
    for item in range(code[cursor.at]):
        factor, slot = entry(lanes, rows, row + item), law.reads[read + item]
        d = d + factor * load(lanes, w, slot)
        rate = rate + factor * load(lanes, w, slot + s.n)
    row += code[cursor.at]
    read += code[cursor.at]
    for item in range(code[cursor.at + 1]):
        factor = entry(lanes, rows, row + item)
        rate = rate + factor * load(lanes, w, law.reads[read + item]) * beat
    return d, rate


@nb.njit(**INNER)
def dead_zone(lanes: Lanes, law: Law, cursor: Cursor, gap: int, w: Array) -> float:
    """Half of the dead zone of a contact; ``gap`` is the slot of its factor."""
    return entry(lanes, law.rows, cursor.row + 4) * (1.0 + load(lanes, w, gap))


@nb.njit(forceinline=True, **INNER)
def contact_law(
    lanes: Lanes, law: Law, s: Slots, cursor: Cursor, j: int, d: float, rate: float, w: Array
) -> tuple[float, float, float]:
    """Force of a contact on its current side, and its derivatives by compression and rate.

    Stiffness, damping and dead zone may differ between lanes.
    """
    code = law.code
    k = entry(lanes, law.rows, cursor.row) * (1.0 + load(lanes, w, s.stiffness))
    c = entry(lanes, law.rows, cursor.row + 1) * (1.0 + load(lanes, w, s.damping))
    if code[cursor.at + 2] == 0:
        return k * d + c * rate, k, c
    side = load(lanes, w, s.side + j)
    touch = side * side
    k = touch * k
    if code[cursor.at + 3] % 2 == 0:
        c = touch * c
    return k * (d - dead_zone(lanes, law, cursor, s.gap, w) * side) + c * rate, k, c


@nb.njit(forceinline=True, **INNER)
def friction_law(
    lanes: Lanes, law: Law, rub: int, cursor: Cursor, w: Array
) -> tuple[float, float, Cursor]:
    """Force of a friction, its derivative by the load, and the position of the next friction."""
    code, rows = law.code, law.rows
    contacts, terms = code[cursor.at], code[cursor.at + 1]
    carried = load(lanes, w, law.reads[cursor.read])
    for item in range(1, contacts):
        carried = carried + load(lanes, w, law.reads[cursor.read + item])
    last = cursor.row + 1 + terms
    value, slope = entry(lanes, rows, last) + 0.0 * carried, 0.0 * carried
    if terms > 1:
        # Load over nominal load, clipped at the limit.
        limit = entry(lanes, rows, cursor.row + 1) + 0.0 * carried
        ratio = entry(lanes, rows, cursor.row) * greatest(carried, 0.0 - carried)
        x = least(ratio, limit)
        for item in range(1, terms):
            slope = slope * x + value
            value = value * x + entry(lanes, rows, last - item)
        slope = below(ratio, limit) * (x * slope)
    scale = 1.0 + load(lanes, w, rub)
    following = Cursor(cursor.at + 2, cursor.read + contacts, last + 1)
    return scale * carried * value, scale * (value + slope), following


@nb.njit(**INNER)
def friction_forces(lanes: Lanes, law: Law, cursor: Cursor, w: Array) -> Cursor:
    """Compute every load-dependent friction; returns the position of the coordinates' terms."""
    s = slots_of(law.code)
    friction, rub, count = s.friction, s.rub, law.code[cursor.at]
    cursor = Cursor(cursor.at + 1, cursor.read, cursor.row)
    for f in range(count):
        force, _, following = friction_law(lanes, law, rub, cursor, w)
        store(w, friction + f, force)
        cursor = following
    return cursor


@nb.njit(forceinline=True, **INNER)
def all_forces(lanes: Lanes, law: Law, base: int, buffer: int, w: Array) -> Cursor:
    """Compute contact forces and frictions; returns the position of the coordinates' terms."""
    s, code, rows = slots_of(law.code), law.code, law.rows
    cursor = first_contact(law, base, buffer)
    for j in range(s.contacts):
        d, rate = compression_and_rate(lanes, law, s, cursor, w)
        if code[cursor.at + 3] >= 2:
            store(w, s.force + j, contact_law(lanes, law, s, cursor, j, d, rate, w)[0])
        else:
            k, c = entry(lanes, rows, cursor.row), entry(lanes, rows, cursor.row + 1)
            if code[cursor.at + 2] == 0:
                store(w, s.force + j, k * d + c * rate)
            else:
                side = load(lanes, w, s.side + j)
                spring = side * side * (k * (d - entry(lanes, rows, cursor.row + 4) * side))
                if code[cursor.at + 3] == 0:
                    store(w, s.force + j, spring + side * side * (c * rate))
                else:
                    store(w, s.force + j, spring + c * rate)
        cursor = next_contact(law, cursor)
    if code[cursor.at] > 0:
        return friction_forces(lanes, law, cursor, w)
    return Cursor(cursor.at + 1, cursor.read, cursor.row)


@nb.njit(forceinline=True, **INNER)
def next_coordinate(law: Law, cursor: Cursor) -> Cursor:
    """Position of the terms of the next coordinate."""
    count = law.code[cursor.at]
    return Cursor(cursor.at + 1, cursor.read + count, cursor.row + count)


@nb.njit(**INNER)
def acceleration(lanes: Lanes, law: Law, base: int, buffer: int, out: int, w: Array) -> None:
    """Compute all forces, and write the acceleration of every coordinate from slot ``out`` on."""
    n, steady = law.code[0], slots_of(law.code).load
    cursor = all_forces(lanes, law, base, buffer, w)
    for i in range(n):
        start = load(lanes, w, steady + i)
        a = sum_terms(lanes, law, start, law.code[cursor.at], cursor.read, cursor.row, w)
        store(w, out + i, a)
        cursor = next_coordinate(law, cursor)


@nb.njit(**INNER)
def set_sides(lanes: Lanes, law: Law, base: int, buffer: int, w: Array) -> None:
    """Set the side of every dead zone from the compression of its contact."""
    s, cursor = slots_of(law.code), first_contact(law, base, buffer)
    for j in range(s.contacts):
        if is_dead_zone(law, cursor):
            d = compression(lanes, law, cursor, s.error, w)
            gap = dead_zone(lanes, law, cursor, s.gap, w)
            store(w, s.side + j, above(d, gap) - above(0.0 - d, gap))
        cursor = next_contact(law, cursor)


@nb.njit(forceinline=True, **INNER)
def clearances(
    lanes: Lanes, law: Law, s: Slots, cursor: Cursor, j: int, w: Array
) -> tuple[float, float]:
    """Distances of a contact to the upper and lower boundary of its side; equal in contact."""
    d = compression(lanes, law, cursor, s.error, w)
    gap = dead_zone(lanes, law, cursor, s.gap, w)
    side = load(lanes, w, s.side + j)
    touch = side * side
    inside, free = touch * (side * d - gap), 1.0 - touch
    return inside + free * (gap - d), inside + free * (gap + d)


@nb.njit(**INNER)
def left_side(lanes: Lanes, law: Law, base: int, w: Array) -> int:
    """Bits of the lanes in which a contact has left its side in the new state (buffer 2)."""
    s, cursor = slots_of(law.code), first_contact(law, base, I64(2))
    crossed = I64(0)
    for j in range(s.contacts):
        if is_dead_zone(law, cursor):
            upper, lower = clearances(lanes, law, s, cursor, j, w)
            crossed |= negative_lanes(upper)
            crossed |= negative_lanes(lower)
        cursor = next_contact(law, cursor)
    return crossed
