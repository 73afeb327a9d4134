"""Splitting a step where a contact leaves its side of the dead zone.

The contact force has a kink there and, with damping, a jump. A step across it loses its order, so
the lane concerned repeats the step in parts, each with one force law, from crossing to crossing.
Rows are interpolated quadratically within the step.

The search: two places of the step enclose the instant; nobody is beyond its boundary at the near
one, somebody is at the far one. Every try replaces one of them, whichever contact it was meant for,
so that the search ends however many contacts cross together; those that do so to rounding change
their sides at one instant. A try is a step to that place with fixed steps, and the polynomial of
the step with adaptive ones. Eight numbers per contact and eight of the search itself are kept in
``room``.
"""

from __future__ import annotations

import math
from typing import Any

import numba as nb

from tribodyn.dynamics._engine.contact_forces import (
    I64,
    Law,
    compression,
    dead_zone,
    first_contact,
    is_dead_zone,
    next_contact,
    slots_of,
)
from tribodyn.dynamics._engine.lanes import first_lane
from tribodyn.dynamics._engine.method import INNER, ONCE, prepare, restart, step
from tribodyn.dynamics.equations import divergence, motion
from tribodyn.types import Array

quadratic_weights = nb.njit(**INNER)(motion.quadratic_weights)
most_splits = nb.njit(**INNER)(divergence.most_splits)

#: Numbers per contact, and those of the search behind them: see the slots.
WIDTH = 8
#: Slots of a contact: -1 without a dead zone, 1 if it begins on its boundary, else 0; its
#: compression and gap at the near place, at the far one, at the last try; what they change by in
#: the whole step.
KIND, NEAR, FAR, NOW, _CHANGE = 0, 1, 3, 5, 7
#: Slots of the search: near and far place, weights of their distances, which of them was replaced
#: last, its width some tries ago and how many, contact for which the last try was made.
_LOW, _HIGH, _LOW_WEIGHT, _HIGH_WEIGHT, _LAST, _WIDE, _TRIES, _LEADER = 0, 1, 2, 3, 4, 5, 6, 7

#: Every fourth try at the latest halves the search, so that 200 leave nothing of it.
MAX_TRIES = 240
#: Distances from the boundary over their change in the step: of the crossing, and of others there.
_THERE, _TOGETHER = 1e-14, 1e-12
#: Narrowest search, and time within which it is not told whether a contact leaves its boundary.
_NARROW, _STAY = 1e-15, 1e-6


@nb.njit(**INNER)
def _distance(room: Array, j: int, place: int, sides: int, w: Array) -> float:
    """Distance of a contact to its boundary; in the gap, to the one that it is beyond at last."""
    at = WIDTH * j
    d, gap, side = room[at + place], room[at + place + 1], w[sides + j]
    leaving = 1.0 if room[at + FAR] > 0.0 else -1.0
    return side * d - gap if side != 0.0 else gap - leaving * d


@nb.njit(**INNER)
def _is_beyond(room: Array, j: int, early: bool, sides: int, w: Array) -> bool:
    """Tell whether a contact is beyond its boundary at the last try, ``early`` after the start."""
    at = WIDTH * j
    if early and room[at + KIND] > 0.0:
        return False
    d, gap, side = room[at + NOW], room[at + NOW + 1], w[sides + j]
    beyond: bool = side * d - gap < 0.0 if side != 0.0 else abs(d) - gap > 0.0
    return room[at + KIND] >= 0.0 and beyond


@nb.njit(**INNER)
def _keep(room: Array, contacts: int, place: int) -> None:
    for j in range(contacts):
        for item in range(2):
            room[WIDTH * j + place + item] = room[WIDTH * j + NOW + item]


@nb.njit(**INNER)
def _leader(room: Array, contacts: int, start: float, sides: int, w: Array) -> tuple[Any, float]:
    """Contact that seems to cross first, and where; -1 if one is there from the beginning."""
    search = WIDTH * contacts
    low, high = room[search + _LOW], room[search + _HIGH]
    first: Any = I64(-1)
    place = high
    for j in range(contacts):
        after = _distance(room, j, I64(FAR), sides, w)
        kind = room[WIDTH * j + KIND]
        if kind < 0.0 or not after < 0.0 or (kind > 0.0 and high - start < _STAY):
            continue
        before = _distance(room, j, I64(NEAR), sides, w)
        if (kind > 0.0 and low == start) or before <= 0.0:
            return I64(-1), low
        near = room[search + _LOW_WEIGHT] * before
        at = low + (high - low) * near / (near - room[search + _HIGH_WEIGHT] * after)
        if first < 0 or at < place:
            first, place = I64(j), at
    return first, place


@nb.njit(**INNER)
def _propose(room: Array, contacts: int, start: float, sides: int, w: Array) -> Any:
    """Next place to try; ``start`` itself ends the search there."""
    search = WIDTH * contacts
    low, high = room[search + _LOW], room[search + _HIGH]
    leader, target = _leader(room, contacts, start, sides, w)
    room[search + _LEADER] = leader
    room[search + _TRIES] += 1.0
    if leader < 0:
        # A contact begins on its boundary, to rounding: look for a place inside.
        return start if high - start < 2.0 * _STAY else low + 0.5 * (high - low)
    if room[search + _TRIES] % 4.0 == 0.0:
        if high - low > 0.5 * room[search + _WIDE]:
            target = low + 0.5 * (high - low)
        room[search + _WIDE] = high - low
    return target if low < target < high else low + 0.5 * (high - low)


@nb.njit(**INNER)
def begin_search(room: Array, contacts: int, start: float, end: float, sides: int, w: Array) -> Any:
    """First place to try between ``start`` and ``end``; -1 if all keep their sides."""
    search = WIDTH * contacts
    some = False
    for j in range(contacts):
        at = WIDTH * j
        gap, side = room[at + NEAR + 1], w[sides + j]
        d = side * room[at + NEAR] if side != 0.0 else -abs(room[at + NEAR])
        if room[at + KIND] == 0.0 and (d - gap if side != 0.0 else gap + d) <= 0.0:
            room[at + KIND] = 1.0
        some = some or _is_beyond(room, j, end - start < _STAY, sides, w)
        room[at + _CHANGE] = abs(room[at + NOW] - room[at + NEAR])
        room[at + _CHANGE] += abs(room[at + NOW + 1] - room[at + NEAR + 1])
    if not some:
        return -1.0
    _keep(room, contacts, I64(FAR))
    room[search + _LOW], room[search + _HIGH], room[search + _WIDE] = start, end, end - start
    room[search + _LOW_WEIGHT] = room[search + _HIGH_WEIGHT] = 1.0
    room[search + _LAST] = room[search + _TRIES] = 0.0
    return _propose(room, contacts, start, sides, w)


@nb.njit(**INNER)
def go_on(
    room: Array, contacts: int, start: float, target: float, sides: int, w: Array
) -> tuple[bool, float]:
    """Take a try at ``target``; returns whether it is the instant, else the next place to try."""
    search = WIDTH * contacts
    if target == start or room[search + _TRIES] > MAX_TRIES:
        return True, target
    some, alone = False, True
    for j in range(contacts):
        if _is_beyond(room, j, target - start < _STAY, sides, w):
            some = True
            limit = _TOGETHER * room[WIDTH * j + _CHANGE]
            alone = alone and _distance(room, j, I64(NOW), sides, w) >= -limit
    leader = I64(room[search + _LEADER])
    there = False
    if leader >= 0:
        g = _distance(room, leader, I64(NOW), sides, w)
        there = alone and abs(g) <= _THERE * room[WIDTH * leader + _CHANGE]
        # A motion beyond all bounds has no crossing to be found; the caller reports it.
        there = there or not math.isfinite(g)
    if there:
        return True, target
    kept, other = (_HIGH, _LOW) if some else (_LOW, _HIGH)
    room[search + kept] = target
    room[search + _LOW_WEIGHT + kept] = 1.0
    if room[search + _LAST] == 1.0 + kept:
        room[search + _LOW_WEIGHT + other] *= 0.5
    else:
        room[search + _LOW_WEIGHT + other] = 1.0
    room[search + _LAST] = 1.0 + kept
    _keep(room, contacts, I64(FAR if some else NEAR))
    if leader >= 0 and room[search + _HIGH] - room[search + _LOW] < _NARROW:
        return True, target
    return False, _propose(room, contacts, start, sides, w)


@nb.njit(**INNER)
def change_sides(
    room: Array, contacts: int, start: float, target: float, sides: int, w: Array
) -> Any:
    """Change the sides of all contacts that cross where the search ended; returns the first."""
    search = WIDTH * contacts
    narrow = room[search + _HIGH] - room[search + _LOW] < _NARROW
    first: Any = I64(-1)
    for j in range(contacts):
        at = WIDTH * j
        if room[at + KIND] < 0.0:
            continue
        if target == start:
            crosses = room[at + KIND] > 0.0
        else:
            limit = _TOGETHER * room[at + _CHANGE]
            crosses = narrow or _distance(room, j, I64(NOW), sides, w) <= limit
            crosses = crosses and not (room[at + KIND] > 0.0 and target - start < _STAY)
            crosses = crosses or j == I64(room[search + _LEADER])
        crosses = crosses and _distance(room, j, I64(FAR), sides, w) < 0.0
        room[at + KIND] = 1.0 if crosses else 0.0
        if crosses:
            first = j if first < 0 else first
            far = 1.0 if room[at + FAR] > 0.0 else -1.0
            w[sides + j] = 0.0 if w[sides + j] != 0.0 else far
    _keep(room, contacts, I64(NEAR))
    return first


@nb.njit(**INNER)
def measure(law: Law, base: int, buffer: int, w: Array, room: Array, place: int) -> None:
    """Compression and gap of every contact with a dead zone, from ``place`` of its numbers."""
    s, here = slots_of(law.code), first_contact(law, base, buffer)
    for j in range(s.contacts):
        if is_dead_zone(law, here):
            room[WIDTH * j + place] = first_lane(compression((0.0,), law, here, s.error, w))
            room[WIDTH * j + place + 1] = first_lane(dead_zone((0.0,), law, here, s.gap, w))
        here = next_contact(law, here)


@nb.njit(**INNER)
def row_within(law: Law, base: int, tau: float, part: Array, node: int) -> None:
    """Interpolate the three rows of a step quadratically at the fraction ``tau``."""
    columns = law.code[2]
    left, middle, right = quadratic_weights(tau)
    for column in range(columns):
        part[node * columns + column] = (
            left * law.rows[base + column]
            + middle * law.rows[base + columns + column]
            + right * law.rows[base + 2 * columns + column]
        )


@nb.njit(**ONCE)
def _note(law: Law, start: float, end: float, w: Array, parts: Array) -> None:
    """Add a part to the list of them: where it begins and ends, sides, state at both ends."""
    n, contacts, side = law.code[0], law.code[1], slots_of(law.code).side
    at = 1 + I64(parts[0]) * (2 + contacts + 4 * n)
    parts[0] += 1.0
    parts[at], parts[at + 1] = start, end
    at += 2
    for j in range(contacts):
        parts[at + j] = w[side + j]
    at += contacts
    for i in range(2 * n):
        parts[at + i], parts[at + 2 * n + i] = w[i], w[4 * n + i]


@nb.njit(**ONCE)
def _try(
    method: Any,
    law: Law,
    base: int,
    width: float,
    part: Array,
    w: Array,
    room: Array,
    start: float,
    target: float,
) -> bool:
    """March the part of a step from ``start`` to ``target`` with the sides at its beginning."""
    for node in range(3):
        row_within(law, base, start + 0.5 * node * (target - start), part, I64(node))
    own = Law(law.code, law.reads, part)
    w[slots_of(law.code).h] = width * (target - start)
    prepare(method, own, 2 * law.code[2], width * (target - start), I64(-1), w)
    good: bool = step((0.0,), method, own, I64(-1), I64(0), w, None)
    measure(own, 2 * law.code[2], I64(2), w, room, I64(NOW))
    return good


@nb.njit(**ONCE)
def split_step(
    method: Any, law: Law, base: int, width: float, part: Array, w: Array, parts: Array, room: Array
) -> tuple[bool, int]:
    """March one lane by one step in parts; also returns -1, or a contact that comes to no end.

    The state in buffer 0 and the sides are those at the left end; the new state is left in
    buffer 2, and the sides are updated. The parts are left in ``parts``. The first number tells
    whether every part was found.
    """
    n, contacts, sides = law.code[0], law.code[1], slots_of(law.code).side
    start, contact, good = 0.0, I64(-1), True
    parts[0] = 0.0
    here = first_contact(law, base, I64(0))
    for j in range(contacts):
        room[WIDTH * j] = 0.0 if is_dead_zone(law, here) else -1.0
        here = next_contact(law, here)
    row_within(law, base, 0.0, part, I64(0))
    own = Law(law.code, law.reads, part)
    measure(own, I64(0), I64(0), w, room, I64(NEAR))
    target, searching, left = 1.0, False, most_splits(contacts) + 1
    while left > 0:
        good = _try(method, law, base, width, part, w, room, start, target) and good
        there, following = True, 0.0
        if searching:
            there, following = go_on(room, contacts, start, target, sides, w)
        else:
            following = begin_search(room, contacts, start, 1.0, sides, w)
            there, searching = following < 0.0, True
        if not there:
            target = following
            continue
        _note(law, start, target, w, parts)
        if following < 0.0:
            return good, I64(-1)
        contact = change_sides(room, contacts, start, target, sides, w)
        for i in range(2 * n):
            w[i] = w[4 * n + i]
        restart((0.0,), method, own, 2 * law.code[2], w)
        start, target, searching, left = target, 1.0, False, left - 1
    for i in range(2 * n):
        if not math.isfinite(w[i]):
            return good, I64(-1)
    return good, contact
