"""Split a step where a contact crosses a boundary of its dead zone.

The contact force has a kink there and, with damping, a jump. A step across it loses its order, so
the lane concerned repeats the step in parts, each with one force law, from crossing to crossing.
Rows are interpolated quadratically within the step.

The search brackets the crossing by two fractions of the step: at the near one no contact is beyond
its boundary, at the far one at least one is. Every trial replaces one end of the bracket, so that
the search ends however many contacts cross together; contacts that cross at the same instant to
rounding change their sides together. With fixed steps a trial integrates up to the fraction; with
adaptive steps it evaluates the polynomial of the step. ``scratch`` holds eight numbers per contact
and eight of the search.
"""

from __future__ import annotations

import math

import numba as nb

from tribodyn.compiled.jit import INNER, ONCE
from tribodyn.dynamics._engine.contact_forces import (
    I64,
    compression,
    dead_zone,
    first_contact,
    is_dead_zone,
    next_contact,
    slots_of,
)
from tribodyn.dynamics._engine.lanes import first_lane
from tribodyn.dynamics._engine.method import Law, Method, prepare, restart, step
from tribodyn.dynamics.equations import divergence, motion
from tribodyn.types import Array

quadratic_weights = nb.njit(**INNER)(motion.quadratic_weights)
most_splits = nb.njit(**INNER)(divergence.most_splits)

#: Numbers per contact; the search takes as many behind those of the contacts.
WIDTH = 8
#: Slots of a contact: kind (-1 without a dead zone, 1 if it begins on its boundary, else 0);
#: compression and gap at the near end, at the far end and at the last trial; their change over
#: the step.
KIND, NEAR, FAR, NOW, _CHANGE = 0, 1, 3, 5, 7
#: Slots of the search: near and far end, weights of their distances, end that was replaced last,
#: width some trials ago, number of trials, contact for which the last trial was made.
_LOW, _HIGH, _LOW_WEIGHT, _HIGH_WEIGHT, _LAST, _WIDE, _TRIES, _LEADER = 0, 1, 2, 3, 4, 5, 6, 7

#: Every fourth trial at the latest halves the bracket, so that 200 exhaust double precision.
MAX_TRIES = 240
#: Distance from the boundary over its change in the step that counts as on the boundary: of the
#: crossing contact, and of others that cross at the same instant.
_CONVERGED, _SIMULTANEOUS = 1e-14, 1e-12
#: Narrowest bracket, and time within which a contact that begins on its boundary is not judged.
_NARROW, _STAY = 1e-15, 1e-6


@nb.njit(**INNER)
def _distance(scratch: Array, j: int, place: int, sides: int, w: Array) -> float:
    """Distance of a contact to its boundary; in the gap, to the one on its side at ``FAR``."""
    at = WIDTH * j
    d, gap, side = scratch[at + place], scratch[at + place + 1], w[sides + j]
    leaving = 1.0 if scratch[at + FAR] > 0.0 else -1.0
    return side * d - gap if side != 0.0 else gap - leaving * d


@nb.njit(**INNER)
def _is_beyond(scratch: Array, j: int, early: bool, sides: int, w: Array) -> bool:
    """Whether a contact is beyond its boundary at the last trial, ``early`` after the start."""
    at = WIDTH * j
    if early and scratch[at + KIND] > 0.0:
        return False
    d, gap, side = scratch[at + NOW], scratch[at + NOW + 1], w[sides + j]
    beyond: bool = side * d - gap < 0.0 if side != 0.0 else abs(d) - gap > 0.0
    return scratch[at + KIND] >= 0.0 and beyond


@nb.njit(**INNER)
def _save_trial(scratch: Array, contacts: int, place: int) -> None:
    for j in range(contacts):
        for item in range(2):
            scratch[WIDTH * j + place + item] = scratch[WIDTH * j + NOW + item]


@nb.njit(**INNER)
def _leader(scratch: Array, contacts: int, start: float, sides: int, w: Array) -> tuple[int, float]:
    """Estimate which contact crosses first, and where; -1 if one starts on its boundary."""
    search = WIDTH * contacts
    low, high = scratch[search + _LOW], scratch[search + _HIGH]
    first = I64(-1)
    place = high
    for j in range(contacts):
        after = _distance(scratch, j, I64(FAR), sides, w)
        kind = scratch[WIDTH * j + KIND]
        if kind < 0.0 or not after < 0.0 or (kind > 0.0 and high - start < _STAY):
            continue
        before = _distance(scratch, j, I64(NEAR), sides, w)
        if (kind > 0.0 and low == start) or before <= 0.0:
            return I64(-1), low
        low_distance = scratch[search + _LOW_WEIGHT] * before
        at = low + (high - low) * low_distance / (
            low_distance - scratch[search + _HIGH_WEIGHT] * after
        )
        if first < 0 or at < place:
            first, place = I64(j), at
    return first, place


@nb.njit(**INNER)
def _propose(scratch: Array, contacts: int, start: float, sides: int, w: Array) -> float:
    """Next fraction to try; a return of ``start`` ends the search at the start."""
    search = WIDTH * contacts
    low, high = scratch[search + _LOW], scratch[search + _HIGH]
    leader, target = _leader(scratch, contacts, start, sides, w)
    scratch[search + _LEADER] = leader
    scratch[search + _TRIES] += 1.0
    if leader < 0:
        # A contact begins on its boundary, to rounding: try a fraction inside.
        return start if high - start < 2.0 * _STAY else low + 0.5 * (high - low)
    if scratch[search + _TRIES] % 4.0 == 0.0:
        if high - low > 0.5 * scratch[search + _WIDE]:
            target = low + 0.5 * (high - low)
        scratch[search + _WIDE] = high - low
    return target if low < target < high else low + 0.5 * (high - low)


@nb.njit(**INNER)
def begin_search(
    scratch: Array, contacts: int, start: float, end: float, sides: int, w: Array
) -> float:
    """First fraction to try between ``start`` and ``end``; -1 if no contact changes its side."""
    search = WIDTH * contacts
    any_beyond = False
    for j in range(contacts):
        at = WIDTH * j
        gap, side = scratch[at + NEAR + 1], w[sides + j]
        d = side * scratch[at + NEAR] if side != 0.0 else -abs(scratch[at + NEAR])
        if scratch[at + KIND] == 0.0 and (d - gap if side != 0.0 else gap + d) <= 0.0:
            scratch[at + KIND] = 1.0
        any_beyond = any_beyond or _is_beyond(scratch, j, end - start < _STAY, sides, w)
        scratch[at + _CHANGE] = abs(scratch[at + NOW] - scratch[at + NEAR])
        scratch[at + _CHANGE] += abs(scratch[at + NOW + 1] - scratch[at + NEAR + 1])
    if not any_beyond:
        return -1.0
    _save_trial(scratch, contacts, I64(FAR))
    scratch[search + _LOW], scratch[search + _HIGH], scratch[search + _WIDE] = (
        start,
        end,
        end - start,
    )
    scratch[search + _LOW_WEIGHT] = scratch[search + _HIGH_WEIGHT] = 1.0
    scratch[search + _LAST] = scratch[search + _TRIES] = 0.0
    return _propose(scratch, contacts, start, sides, w)


@nb.njit(**INNER)
def continue_search(
    scratch: Array, contacts: int, start: float, target: float, sides: int, w: Array
) -> tuple[bool, float]:
    """Evaluate the trial at ``target``; returns whether it converged, and the next fraction."""
    search = WIDTH * contacts
    if target == start or scratch[search + _TRIES] > MAX_TRIES:
        return True, target
    any_beyond, all_at_boundary = False, True
    for j in range(contacts):
        if _is_beyond(scratch, j, target - start < _STAY, sides, w):
            any_beyond = True
            limit = _SIMULTANEOUS * scratch[WIDTH * j + _CHANGE]
            all_at_boundary = (
                all_at_boundary and _distance(scratch, j, I64(NOW), sides, w) >= -limit
            )
    leader = I64(scratch[search + _LEADER])
    converged = False
    if leader >= 0:
        g = _distance(scratch, leader, I64(NOW), sides, w)
        converged = all_at_boundary and abs(g) <= _CONVERGED * scratch[WIDTH * leader + _CHANGE]
        # A motion that is not finite has no crossing; the caller reports it.
        converged = converged or not math.isfinite(g)
    if converged:
        return True, target
    replaced, other = (_HIGH, _LOW) if any_beyond else (_LOW, _HIGH)
    scratch[search + replaced] = target
    scratch[search + _LOW_WEIGHT + replaced] = 1.0
    if scratch[search + _LAST] == 1.0 + replaced:
        scratch[search + _LOW_WEIGHT + other] *= 0.5
    else:
        scratch[search + _LOW_WEIGHT + other] = 1.0
    scratch[search + _LAST] = 1.0 + replaced
    _save_trial(scratch, contacts, I64(FAR if any_beyond else NEAR))
    if leader >= 0 and scratch[search + _HIGH] - scratch[search + _LOW] < _NARROW:
        return True, target
    return False, _propose(scratch, contacts, start, sides, w)


@nb.njit(**INNER)
def change_sides(
    scratch: Array, contacts: int, start: float, target: float, sides: int, w: Array
) -> int:
    """Change the sides of all contacts that cross at ``target``; returns the first of them."""
    search = WIDTH * contacts
    narrow = scratch[search + _HIGH] - scratch[search + _LOW] < _NARROW
    first = I64(-1)
    for j in range(contacts):
        at = WIDTH * j
        if scratch[at + KIND] < 0.0:
            continue
        if target == start:
            crosses = scratch[at + KIND] > 0.0
        else:
            limit = _SIMULTANEOUS * scratch[at + _CHANGE]
            crosses = narrow or _distance(scratch, j, I64(NOW), sides, w) <= limit
            crosses = crosses and not (scratch[at + KIND] > 0.0 and target - start < _STAY)
            crosses = crosses or j == I64(scratch[search + _LEADER])
        crosses = crosses and _distance(scratch, j, I64(FAR), sides, w) < 0.0
        scratch[at + KIND] = 1.0 if crosses else 0.0
        if crosses:
            first = j if first < 0 else first
            far = 1.0 if scratch[at + FAR] > 0.0 else -1.0
            w[sides + j] = 0.0 if w[sides + j] != 0.0 else far
    _save_trial(scratch, contacts, I64(NEAR))
    return first


@nb.njit(**INNER)
def measure(law: Law, base: int, buffer: int, w: Array, scratch: Array, place: int) -> None:
    """Store compression and gap of every contact with a dead zone from its slot ``place`` on."""
    s, cursor = slots_of(law.code), first_contact(law, base, buffer)
    for j in range(s.contacts):
        if is_dead_zone(law, cursor):
            scratch[WIDTH * j + place] = first_lane(compression((0.0,), law, cursor, s.error, w))
            scratch[WIDTH * j + place + 1] = first_lane(dead_zone((0.0,), law, cursor, s.gap, w))
        cursor = next_contact(law, cursor)


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
def _append_part(law: Law, start: float, end: float, w: Array, parts: Array) -> None:
    """Append a part of the step to ``parts``: start and end, sides, state at both ends."""
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
def _try_part(
    method: Method,
    law: Law,
    base: int,
    width: float,
    part: Array,
    w: Array,
    scratch: Array,
    start: float,
    target: float,
) -> bool:
    """Integrate a step from ``start`` to ``target`` with the sides at its start."""
    for node in range(3):
        row_within(law, base, start + 0.5 * node * (target - start), part, I64(node))
    part_law = Law(law.code, law.reads, part)
    w[slots_of(law.code).h] = width * (target - start)
    prepare(method, part_law, 2 * law.code[2], width * (target - start), I64(-1), w)
    good: bool = step((0.0,), method, part_law, I64(-1), I64(0), w, None)
    measure(part_law, 2 * law.code[2], I64(2), w, scratch, I64(NOW))
    return good


@nb.njit(**ONCE)
def split_step(
    method: Method,
    law: Law,
    base: int,
    width: float,
    part: Array,
    w: Array,
    parts: Array,
    scratch: Array,
) -> tuple[bool, int]:
    """Integrate one lane over one step in parts, from crossing to crossing.

    Buffer 0 and the sides hold the left end; the new state is written to buffer 2, the sides are
    updated, and the parts are appended to ``parts``. Returns whether every part converged, and -1
    or a contact that opens and closes without end.
    """
    n, contacts, sides = law.code[0], law.code[1], slots_of(law.code).side
    start, contact, good = 0.0, I64(-1), True
    parts[0] = 0.0
    cursor = first_contact(law, base, I64(0))
    for j in range(contacts):
        scratch[WIDTH * j] = 0.0 if is_dead_zone(law, cursor) else -1.0
        cursor = next_contact(law, cursor)
    row_within(law, base, 0.0, part, I64(0))
    part_law = Law(law.code, law.reads, part)
    measure(part_law, I64(0), I64(0), w, scratch, I64(NEAR))
    target, searching, left = 1.0, False, most_splits(contacts) + 1
    while left > 0:
        good = _try_part(method, law, base, width, part, w, scratch, start, target) and good
        converged, following = True, 0.0
        if searching:
            converged, following = continue_search(scratch, contacts, start, target, sides, w)
        else:
            following = begin_search(scratch, contacts, start, 1.0, sides, w)
            converged, searching = following < 0.0, True
        if not converged:
            target = following
            continue
        _append_part(law, start, target, w, parts)
        if following < 0.0:
            return good, I64(-1)
        contact = change_sides(scratch, contacts, start, target, sides, w)
        for i in range(2 * n):
            w[i] = w[4 * n + i]
        restart((0.0,), method, part_law, 2 * law.code[2], w)
        start, target, searching, left = target, 1.0, False, left - 1
    for i in range(2 * n):
        if not math.isfinite(w[i]):
            return good, I64(-1)
    return good, contact
