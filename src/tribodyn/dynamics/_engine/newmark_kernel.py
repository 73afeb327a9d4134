"""One Newmark step of all lanes, compiled.

``q1 = q + h v + h^2 [(1/2 - beta) a + beta a1]``, ``v1 = v + h [(1 - gamma) a + gamma a1]`` and
the law of motion at the right end of the step. The structure alone gives ``a1 = S^-1 b`` with
``S = M + gamma h C + beta h^2 K``, one inverse per lane and step width. The contact forces are
the unknowns of Newton's method: compressions and rates depend on them linearly, so that its
matrix has the size of the number of contacts and is exact, friction included. Source: Newmark
(1959), A method of computation for structural dynamics. Replaces, and is tested against, the
readable version of ``tests/plain``.

``shape`` holds coordinates, contacts, frictions that follow their load and the coefficients of
each, ``law`` gamma, beta and the tolerance, ``rows`` the row table, ``row`` the address of one
row in it, ``facts`` the numbers of contacts and frictions that do not vary, ``w`` the work buffer
(:mod:`~tribodyn.dynamics.newmark_force`).
"""

from __future__ import annotations

from typing import Any

import numba as nb

from tribodyn.dynamics._engine.contact_forces import INNER
from tribodyn.dynamics._engine.lanes import greatest, load, store
from tribodyn.dynamics._engine.newmark_force import (
    compression,
    contact_law,
    frictions_of,
    rate_of,
    row_length,
    slots,
)
from tribodyn.dynamics._engine.newmark_lanes import (
    any_above,
    any_negative,
    magnitude,
    quotient,
)
from tribodyn.types import Array, Index

#: Passes of Newton's method. Between contact changes two are enough, unless friction follows the
#: load.
PASSES = 25


@nb.njit(**INNER)
def _balance(
    lanes: Any,
    shape: tuple[int, int, int, int],
    structure: Any,
    rows: Array,
    row: int,
    q: int,
    w: Array,
) -> None:
    """Forces without those of the contacts into the sum."""
    n = shape[0]
    first, columns, factors, _ = structure
    force = row + row_length(shape) - n
    scale = load(lanes, w, slots(shape)[9] + 8)
    for i in range(n):
        total = load(lanes, w, 7 * n + i) + scale * rows[force + i]
        for item in range(first[i], first[i + 1]):
            total = total - factors[item] * load(lanes, w, q + columns[item])
        store(w, 6 * n + i, total)


@nb.njit(**INNER)
def start_acceleration(
    lanes: Any,
    shape: tuple[int, int, int, int],
    structure: Any,
    rows: Array,
    row: int,
    facts: Array,
    w: Array,
) -> None:
    """Acceleration at the left end of a step that begins at an event or a contact change."""
    n, m, frictions, coefficients = shape
    side, forces, _, _, place, _, _, _, _, single = slots(shape)
    beat, zero = load(lanes, w, single + 1), load(lanes, w, single + 2)
    stiff, damp = load(lanes, w, single + 3), load(lanes, w, single + 4)
    error, wide = load(lanes, w, single + 6), load(lanes, w, single + 7)
    _balance(lanes, shape, structure, rows, row, 0, w)
    for j in range(m):
        at = row + j * (5 + 3 * n)
        d = compression(lanes, n, rows, at, 0, error, w)
        rate = rate_of(lanes, n, rows, at, 0, beat, error, w)
        force, _, _ = contact_law(
            load(lanes, w, side + j), stiff * rows[at], damp * rows[at + 1], wide * rows[at + 4],
            facts[j], d, rate,
        )  # fmt: skip
        store(w, forces + j, force)
        for i in range(n):
            store(w, 6 * n + i, load(lanes, w, 6 * n + i) - rows[at + 5 + 2 * n + i] * force)
    frictions_of(lanes, shape, facts, rows, row, w)
    for f in range(frictions):
        at, force = row + m * (5 + 3 * n) + f * (n + coefficients), load(lanes, w, place + f)
        for i in range(n):
            store(w, 6 * n + i, load(lanes, w, 6 * n + i) - rows[at + i] * force)
    inverse_mass = structure[3]
    for i in range(n):
        total = zero
        for k in range(n):
            total = total + inverse_mass[i * n + k] * load(lanes, w, 6 * n + k)
        store(w, 2 * n + i, total)


@nb.njit(**INNER)
def _without_contacts(
    lanes: Any,
    shape: tuple[int, int, int, int],
    law: Array,
    structure: Any,
    rows: Array,
    row: int,
    inverse: int,
    w: Array,
) -> None:
    """State at the end of the step, compressions and rates, if no contact pushed."""
    n, m, _, _ = shape
    _, _, plain, rates, _, _, _, _, _, single = slots(shape)
    h, beat = load(lanes, w, single), load(lanes, w, single + 1)
    zero, error = load(lanes, w, single + 2), load(lanes, w, single + 6)
    early, slow = (0.5 - law[1]) * h * h, (1.0 - law[0]) * h
    for i in range(n):
        v, a = load(lanes, w, n + i), load(lanes, w, 2 * n + i)
        store(w, 3 * n + i, load(lanes, w, i) + h * v + early * a)
        store(w, 4 * n + i, v + slow * a)
    _balance(lanes, shape, structure, rows, row, 3 * n, w)
    late, fast = law[1] * h * h, law[0] * h
    for i in range(n):
        a = zero
        for k in range(n):
            a = a + load(lanes, w, inverse + i * n + k) * load(lanes, w, 6 * n + k)
        store(w, 5 * n + i, a)
    for i in range(n):
        a = load(lanes, w, 5 * n + i)
        store(w, 3 * n + i, load(lanes, w, 3 * n + i) + late * a)
        store(w, 4 * n + i, load(lanes, w, 4 * n + i) + fast * a)
    for j in range(m):
        at = row + j * (5 + 3 * n)
        store(w, plain + j, compression(lanes, n, rows, at, 3 * n, error, w))
        store(w, rates + j, rate_of(lanes, n, rows, at, 3 * n, beat, error, w))


@nb.njit(**INNER)
def _effects(
    lanes: Any,
    shape: tuple[int, int, int, int],
    law: Array,
    rows: Array,
    row: int,
    inverse: int,
    w: Array,
) -> None:
    """What a unit of each contact force and friction does to motion, compressions and rates."""
    n, m, frictions, coefficients = shape
    _, _, _, _, _, push, effect, _, _, single = slots(shape)
    h, beat = load(lanes, w, single), load(lanes, w, single + 1)
    zero = load(lanes, w, single + 2)
    late, fast = law[1] * h * h, law[0] * h
    sources = m + frictions
    for j in range(sources):
        at = row + j * (5 + 3 * n) + 5 + 2 * n
        if j >= m:
            at = row + m * (5 + 3 * n) + (j - m) * (n + coefficients)
        for i in range(n):
            a = zero
            for k in range(n):
                if rows[at + k] != 0.0:
                    a = a - load(lanes, w, inverse + i * n + k) * rows[at + k]
            store(w, push + j * n + i, a)
    for i in range(m):
        at = row + i * (5 + 3 * n) + 5
        for j in range(sources):
            along, turned = zero, zero
            for k in range(n):
                a = load(lanes, w, push + j * n + k)
                along = along + rows[at + k] * a
                turned = turned + rows[at + n + k] * a
            store(w, effect + i * sources + j, late * along)
            store(w, effect + (m + i) * sources + j, fast * along + beat * late * turned)


@nb.njit(**INNER)
def _solve(lanes: Any, m: int, matrix: int, right: int, w: Array) -> None:
    """Solve for the corrections of the contact forces by elimination."""
    for k in range(m):
        for i in range(k + 1, m):
            part = quotient(load(lanes, w, matrix + i * m + k), load(lanes, w, matrix + k * m + k))
            for j in range(k + 1, m):
                old = load(lanes, w, matrix + i * m + j)
                store(w, matrix + i * m + j, old - part * load(lanes, w, matrix + k * m + j))
            store(w, right + i, load(lanes, w, right + i) - part * load(lanes, w, right + k))
    for back in range(m):
        i = m - 1 - back
        total = load(lanes, w, right + i)
        for j in range(i + 1, m):
            total = total - load(lanes, w, matrix + i * m + j) * load(lanes, w, right + j)
        store(w, right + i, quotient(total, load(lanes, w, matrix + i * m + i)))


@nb.njit(**INNER)
def _iterate(
    lanes: Any,
    shape: tuple[int, int, int, int],
    tolerance: float,
    rows: Array,
    row: int,
    facts: Array,
    w: Array,
) -> bool:
    """Find the contact forces by Newton's method; False if the passes are not enough."""
    n, m, frictions, _ = shape
    side, forces, plain, rates, place, _, effect, matrix, right, single = slots(shape)
    zero = load(lanes, w, single + 2)
    stiff, damp = load(lanes, w, single + 3), load(lanes, w, single + 4)
    wide = load(lanes, w, single + 7)
    sources = m + frictions
    for _ in range(PASSES):
        size = zero
        frictions_of(lanes, shape, facts, rows, row, w)
        for i in range(m):
            at = row + i * (5 + 3 * n)
            d, rate = load(lanes, w, plain + i), load(lanes, w, rates + i)
            start, change = d, rate
            for j in range(sources):
                force = load(lanes, w, forces + j if j < m else place + j - m)
                d = d + load(lanes, w, effect + i * sources + j) * force
                rate = rate + load(lanes, w, effect + (m + i) * sources + j) * force
            force, by_compression, by_rate = contact_law(
                load(lanes, w, side + i), stiff * rows[at], damp * rows[at + 1],
                wide * rows[at + 4], facts[i], d, rate,
            )  # fmt: skip
            old = load(lanes, w, forces + i)
            store(w, right + i, force - old)
            size = greatest(size, magnitude(old) + magnitude(force))
            size = greatest(size, magnitude(by_compression * start) + magnitude(by_rate * change))
            for j in range(m):
                by_d = load(lanes, w, effect + i * sources + j)
                by_r = load(lanes, w, effect + (m + i) * sources + j)
                for f in range(frictions):
                    if facts[m + f * (2 + m) + 2 + j] != 0.0:
                        rise = load(lanes, w, place + frictions + f)
                        by_d = by_d + load(lanes, w, effect + i * sources + m + f) * rise
                        by_r = by_r + load(lanes, w, effect + (m + i) * sources + m + f) * rise
                one = 1.0 if i == j else 0.0
                store(w, matrix + i * m + j, one - (by_compression * by_d + by_rate * by_r))
        _solve(lanes, m, matrix, right, w)
        found = True
        for i in range(m):
            correction = load(lanes, w, right + i)
            store(w, forces + i, load(lanes, w, forces + i) + correction)
            found = found and not any_above(magnitude(correction), tolerance * size)
        if found:
            return True
    return False


@nb.njit(**INNER)
def newmark_step(
    lanes: Any,
    shape: tuple[int, int, int, int],
    law: Array,
    structure: Any,
    rows: Array,
    row: int,
    facts: Array,
    inverse: int,
    w: Array,
) -> bool:
    """March every lane by one step; ``row`` is the row at its end, every contact keeps its side."""
    n, m, frictions, _ = shape
    _, forces, _, _, place, push, _, _, _, single = slots(shape)
    _without_contacts(lanes, shape, law, structure, rows, row, inverse, w)
    if m == 0:
        return True
    _effects(lanes, shape, law, rows, row, inverse, w)
    found: bool = _iterate(lanes, shape, law[2], rows, row, facts, w)
    frictions_of(lanes, shape, facts, rows, row, w)
    h = load(lanes, w, single)
    late, fast = law[1] * h * h, law[0] * h
    for i in range(n):
        a = load(lanes, w, push + i) * load(lanes, w, forces)
        for j in range(1, m + frictions):
            force = load(lanes, w, forces + j if j < m else place + j - m)
            a = a + load(lanes, w, push + j * n + i) * force
        store(w, 5 * n + i, load(lanes, w, 5 * n + i) + a)
        store(w, 3 * n + i, load(lanes, w, 3 * n + i) + late * a)
        store(w, 4 * n + i, load(lanes, w, 4 * n + i) + fast * a)
    return found


@nb.njit(**INNER)
def beyond(
    lanes: Any, shape: tuple[int, int, int, int], dead: Index, rows: Array, row: int, w: Array
) -> bool:
    """Tell whether a lane's new state is off the side of a dead zone that it was on."""
    n, m, _, _ = shape
    side, _, _, _, _, _, _, _, _, single = slots(shape)
    error, wide = load(lanes, w, single + 6), load(lanes, w, single + 7)
    for j in range(m):
        if dead[j] != 0:
            at = row + j * (5 + 3 * n)
            d = compression(lanes, n, rows, at, 3 * n, error, w)
            gap, sign = wide * rows[at + 4], load(lanes, w, side + j)
            touch = sign * sign
            inside, free = touch * (sign * d - gap), 1.0 - touch
            if any_negative(inside + free * (gap - d)) or any_negative(inside + free * (gap + d)):
                return True
    return False
