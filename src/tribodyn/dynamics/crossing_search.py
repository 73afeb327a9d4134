"""Search for the instant within a step at which the first contacts leave their sides.

Two places of the step enclose it: nobody is beyond its boundary at the near one, somebody is at
the far one. Every try replaces one of them, whichever contact it was meant for, so that the
search ends however many contacts cross together; those that do so to rounding change their sides
at one instant. Eight numbers per contact and eight of the search itself are kept in ``room``.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.dynamics.kernel import I64, INNER
from tribodyn.types import Array

#: Numbers per contact, and those of the search behind them: see the slots.
WIDTH = 8
#: Slots of a contact: -1 without a dead zone, 1 if it begins on its boundary, else 0; its
#: compression and gap at the near place, at the far one, at the last try; what they change by in
#: the whole step.
_KIND, NEAR, _FAR, NOW, _CHANGE = 0, 1, 3, 5, 7
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
def most_splits(contacts: int) -> int:
    """Changes of side that may part a step; what has more does not come to an end."""
    return 16 + 4 * contacts


@nb.njit(**INNER)
def _distance(room: Array, j: int, place: int, sides: int, w: Array) -> Any:
    """Distance of a contact to its boundary; in the gap, to the one that it is beyond at last."""
    at = WIDTH * j
    d, gap, side = room[at + place], room[at + place + 1], w[sides + j]
    leaving = 1.0 if room[at + _FAR] > 0.0 else -1.0
    return side * d - gap if side != 0.0 else gap - leaving * d


@nb.njit(**INNER)
def _is_beyond(room: Array, j: int, early: bool, sides: int, w: Array) -> bool:
    """Tell whether a contact is beyond its boundary at the last try, ``early`` after the start."""
    at = WIDTH * j
    if early and room[at + _KIND] > 0.0:
        return False
    d, gap, side = room[at + NOW], room[at + NOW + 1], w[sides + j]
    beyond: bool = side * d - gap < 0.0 if side != 0.0 else abs(d) - gap > 0.0
    return room[at + _KIND] >= 0.0 and beyond


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
        after = _distance(room, j, I64(_FAR), sides, w)
        kind = room[WIDTH * j + _KIND]
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
        if room[at + _KIND] == 0.0 and (d - gap if side != 0.0 else gap + d) <= 0.0:
            room[at + _KIND] = 1.0
        some = some or _is_beyond(room, j, end - start < _STAY, sides, w)
        room[at + _CHANGE] = abs(room[at + NOW] - room[at + NEAR])
        room[at + _CHANGE] += abs(room[at + NOW + 1] - room[at + NEAR + 1])
    if not some:
        return -1.0
    _keep(room, contacts, I64(_FAR))
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
        there = there or not np.isfinite(g)
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
    _keep(room, contacts, I64(_FAR if some else NEAR))
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
        if room[at + _KIND] < 0.0:
            continue
        if target == start:
            crosses = room[at + _KIND] > 0.0
        else:
            limit = _TOGETHER * room[at + _CHANGE]
            crosses = narrow or _distance(room, j, I64(NOW), sides, w) <= limit
            crosses = crosses and not (room[at + _KIND] > 0.0 and target - start < _STAY)
            crosses = crosses or j == I64(room[search + _LEADER])
        crosses = crosses and _distance(room, j, I64(_FAR), sides, w) < 0.0
        room[at + _KIND] = 1.0 if crosses else 0.0
        if crosses:
            first = j if first < 0 else first
            far = 1.0 if room[at + _FAR] > 0.0 else -1.0
            w[sides + j] = 0.0 if w[sides + j] != 0.0 else far
    _keep(room, contacts, I64(NEAR))
    return first
