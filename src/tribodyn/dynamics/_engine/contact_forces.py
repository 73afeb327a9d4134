"""The compiled equation of motion: contact forces, frictions and accelerations of all lanes.

Structure and contacts are data (:class:`~tribodyn.dynamics.equations.program.Program`); arithmetic
runs over lanes, the trajectories of an ensemble, which share the mesh phase and differ in mesh
period, load and state (:mod:`~tribodyn.dynamics._engine.lanes`). Everything that a lane owns lives
in slots of one work buffer. The readable law is :mod:`tribodyn.dynamics.equations.motion`.

``law`` holds the addresses of the arrays of the program, ``w`` is the work buffer, ``base`` the
address of a row in the table and ``buffer`` (0, 1, 2) the state buffer that is read. Lanes share
the rows or have their own: the type of ``law.rows`` tells, see
:func:`~tribodyn.dynamics._engine.lanes.entry`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numba as nb
import numpy as np

from tribodyn.dynamics._engine.lanes import (
    above,
    below,
    entry,
    greatest,
    least,
    load,
    negative_lanes,
    store,
)
from tribodyn.dynamics._engine.method import INNER
from tribodyn.dynamics.equations.program import Slots, lay_out
from tribodyn.types import Array, Index

#: Without it every literal integer argument makes the compiler translate the callee anew.
I64: Any = np.int64


class Law(NamedTuple):
    """Addresses of what the compiled law reads."""

    code: Any
    reads: Any
    rows: Any


_lay_out = nb.njit(forceinline=True, **INNER)(lay_out)


@nb.njit(forceinline=True, **INNER)
def slots_of(code: Index) -> Slots:
    """Where a lane keeps what in the work buffer."""
    slots: Slots = _lay_out(code[0], code[1], code[4 + 4 * code[1]])
    return slots


class Cursor(NamedTuple):
    """A place in the three arrays of the program."""

    at: int
    read: int
    row: int


@nb.njit(forceinline=True, **INNER)
def first_contact(law: Law, base: int, buffer: int) -> Cursor:
    """Where the contacts begin."""
    return Cursor(I64(4), I64(buffer * law.code[3]), I64(base))


@nb.njit(forceinline=True, **INNER)
def next_contact(law: Law, here: Cursor) -> Cursor:
    """Where the contact after this one begins."""
    terms = law.code[here.at] + law.code[here.at + 1]
    return Cursor(here.at + 4, here.read + terms, here.row + 5 + terms)


@nb.njit(forceinline=True, **INNER)
def is_dead_zone(law: Law, here: Cursor) -> bool:
    """Whether a contact has a dead zone."""
    dead: bool = law.code[here.at + 2] != 0
    return dead


@nb.njit(**INNER)
def sum_terms(lanes: Any, law: Law, first: Any, count: int, read: int, row: int, w: Array) -> Any:
    """``first`` plus the sum of factor times slot."""
    total = first
    for item in range(count):
        total = total + entry(lanes, law.rows, row + item) * load(lanes, w, law.reads[read + item])
    return total


@nb.njit(**INNER)
def compression(lanes: Any, law: Law, here: Cursor, error: int, w: Array) -> Any:
    """Compression of a contact; ``error`` is the slot of its factor."""
    first = entry(lanes, law.rows, here.row + 2) * (load(lanes, w, error) - 1.0)
    return sum_terms(lanes, law, first, law.code[here.at], here.read, here.row + 5, w)


@nb.njit(forceinline=True, **INNER)
def compression_and_rate(lanes: Any, law: Law, s: Slots, here: Cursor, w: Array) -> tuple[Any, Any]:
    """Compression of a contact and its rate, in one loop."""
    code, rows = law.code, law.rows
    beat, error = load(lanes, w, s.beat), load(lanes, w, s.error) - 1.0
    d = entry(lanes, rows, here.row + 2) * error
    rate = entry(lanes, rows, here.row + 3) * (error * beat)
    row, read = here.row + 5, here.read
    for item in range(code[here.at]):
        factor, slot = entry(lanes, rows, row + item), law.reads[read + item]
        d = d + factor * load(lanes, w, slot)
        rate = rate + factor * load(lanes, w, slot + s.n)
    row += code[here.at]
    read += code[here.at]
    for item in range(code[here.at + 1]):
        factor = entry(lanes, rows, row + item)
        rate = rate + factor * load(lanes, w, law.reads[read + item]) * beat
    return d, rate


@nb.njit(**INNER)
def dead_zone(lanes: Any, law: Law, here: Cursor, gap: int, w: Array) -> Any:
    """Half of the dead zone of a contact; ``gap`` is the slot of its factor."""
    return entry(lanes, law.rows, here.row + 4) * (1.0 + load(lanes, w, gap))


@nb.njit(forceinline=True, **INNER)
def contact_law(
    lanes: Any, law: Law, s: Slots, here: Cursor, j: int, d: Any, rate: Any, w: Array
) -> tuple[Any, Any, Any]:
    """Force of a contact on its side, and its derivatives by compression and rate.

    Stiffness, damping and dead zone differ between lanes, which costs some operations more.
    """
    code = law.code
    k = entry(lanes, law.rows, here.row) * (1.0 + load(lanes, w, s.stiffness))
    c = entry(lanes, law.rows, here.row + 1) * (1.0 + load(lanes, w, s.damping))
    if code[here.at + 2] == 0:
        return k * d + c * rate, k, c
    side = load(lanes, w, s.side + j)
    touch = side * side
    k = touch * k
    if code[here.at + 3] % 2 == 0:
        c = touch * c
    return k * (d - dead_zone(lanes, law, here, s.gap, w) * side) + c * rate, k, c


@nb.njit(forceinline=True, **INNER)
def friction_law(lanes: Any, law: Law, rub: int, here: Cursor, w: Array) -> tuple[Any, Any, Cursor]:
    """Force of a friction, its derivative by the load, and where the next friction begins."""
    code, rows = law.code, law.rows
    contacts, terms = code[here.at], code[here.at + 1]
    carried = load(lanes, w, law.reads[here.read])
    for item in range(1, contacts):
        carried = carried + load(lanes, w, law.reads[here.read + item])
    last = here.row + 1 + terms
    value, slope = entry(lanes, rows, last) + 0.0 * carried, 0.0 * carried
    if terms > 1:
        # The load over the nominal one, no more than the limit.
        limit = entry(lanes, rows, here.row + 1) + 0.0 * carried
        ratio = entry(lanes, rows, here.row) * greatest(carried, 0.0 - carried)
        x = least(ratio, limit)
        for item in range(1, terms):
            slope = slope * x + value
            value = value * x + entry(lanes, rows, last - item)
        slope = below(ratio, limit) * (x * slope)
    scale = 1.0 + load(lanes, w, rub)
    following = Cursor(here.at + 2, here.read + contacts, last + 1)
    return scale * carried * value, scale * (value + slope), following


@nb.njit(**INNER)
def friction_forces(lanes: Any, law: Law, here: Cursor, w: Array) -> Cursor:
    """Every friction that follows the load; returns where the coordinates' terms begin."""
    s = slots_of(law.code)
    friction, rub, count = s.friction, s.rub, law.code[here.at]
    here = Cursor(here.at + 1, here.read, here.row)
    for f in range(count):
        force, _, following = friction_law(lanes, law, rub, here, w)
        store(w, friction + f, force)
        here = following
    return here


@nb.njit(forceinline=True, **INNER)
def all_forces(lanes: Any, law: Law, base: int, buffer: int, w: Array) -> Cursor:
    """Contact forces and frictions; returns where the coordinates' terms begin."""
    s, code, rows = slots_of(law.code), law.code, law.rows
    here = first_contact(law, base, buffer)
    for j in range(s.contacts):
        d, rate = compression_and_rate(lanes, law, s, here, w)
        if code[here.at + 3] >= 2:
            store(w, s.force + j, contact_law(lanes, law, s, here, j, d, rate, w)[0])
        else:
            k, c = entry(lanes, rows, here.row), entry(lanes, rows, here.row + 1)
            if code[here.at + 2] == 0:
                store(w, s.force + j, k * d + c * rate)
            else:
                side = load(lanes, w, s.side + j)
                spring = side * side * (k * (d - entry(lanes, rows, here.row + 4) * side))
                if code[here.at + 3] == 0:
                    store(w, s.force + j, spring + side * side * (c * rate))
                else:
                    store(w, s.force + j, spring + c * rate)
        here = next_contact(law, here)
    if code[here.at] > 0:
        return friction_forces(lanes, law, here, w)
    return Cursor(here.at + 1, here.read, here.row)


@nb.njit(forceinline=True, **INNER)
def next_coordinate(law: Law, here: Cursor) -> Cursor:
    """Where the terms of the next coordinate begin."""
    count = law.code[here.at]
    return Cursor(here.at + 1, here.read + count, here.row + count)


@nb.njit(**INNER)
def acceleration(lanes: Any, law: Law, base: int, buffer: int, out: int, w: Array) -> None:
    """All forces, and the acceleration of every coordinate into the slots from ``out``."""
    n, steady = law.code[0], slots_of(law.code).load
    here = all_forces(lanes, law, base, buffer, w)
    for i in range(n):
        start = load(lanes, w, steady + i)
        a = sum_terms(lanes, law, start, law.code[here.at], here.read, here.row, w)
        store(w, out + i, a)
        here = next_coordinate(law, here)


@nb.njit(**INNER)
def set_sides(lanes: Any, law: Law, base: int, buffer: int, w: Array) -> None:
    """Set the side of every dead zone from the compression of its contact."""
    s, here = slots_of(law.code), first_contact(law, base, buffer)
    for j in range(s.contacts):
        if is_dead_zone(law, here):
            d = compression(lanes, law, here, s.error, w)
            gap = dead_zone(lanes, law, here, s.gap, w)
            store(w, s.side + j, above(d, gap) - above(0.0 - d, gap))
        here = next_contact(law, here)


@nb.njit(forceinline=True, **INNER)
def clearances(lanes: Any, law: Law, s: Slots, here: Cursor, j: int, w: Array) -> tuple[Any, Any]:
    """Distances of a contact to both boundaries of its side, which may be one."""
    d = compression(lanes, law, here, s.error, w)
    gap = dead_zone(lanes, law, here, s.gap, w)
    side = load(lanes, w, s.side + j)
    touch = side * side
    inside, free = touch * (side * d - gap), 1.0 - touch
    return inside + free * (gap - d), inside + free * (gap + d)


@nb.njit(**INNER)
def left_side(lanes: Any, law: Law, base: int, w: Array) -> Any:
    """Bits of the lanes whose new state (buffer 2) is off the side of a dead zone they were on."""
    s, here = slots_of(law.code), first_contact(law, base, I64(2))
    gone = I64(0)
    for j in range(s.contacts):
        if is_dead_zone(law, here):
            near, far = clearances(lanes, law, s, here, j, w)
            gone |= negative_lanes(near)
            gone |= negative_lanes(far)
        here = next_contact(law, here)
    return gone
