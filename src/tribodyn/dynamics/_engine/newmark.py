"""Newmark's scheme: one step of all lanes.

``q1 = q + h v + h^2 [(1/2 - beta) a + beta a1]``, ``v1 = v + h [(1 - gamma) a + gamma a1]`` and
the law of motion at the right end of the step. The structure alone gives ``a1 = S^-1 b`` with
``S = 1 + gamma h C + beta h^2 K``, all divided by the mass matrix, one inverse per lane and width
of a step. The contact forces are the unknowns of Newton's method: compressions and rates depend on
them linearly, so that its matrix has the size of the number of contacts and is exact, friction
included. The acceleration is recomputed at every event and contact change: without that the scheme
is of first order. Source: Newmark (1959), A method of computation for structural dynamics.
"""

from __future__ import annotations

from typing import NamedTuple

import numba as nb

from tribodyn.compiled.jit import INNER
from tribodyn.dynamics._engine.contact_forces import (
    I64,
    Cursor,
    acceleration,
    compression_and_rate,
    contact_law,
    first_contact,
    friction_forces,
    friction_law,
    next_contact,
    next_coordinate,
    slots_of,
    sum_terms,
)
from tribodyn.dynamics._engine.lanes import (
    Lanes,
    any_above,
    entry,
    greatest,
    keep_apart,
    load,
    magnitude,
    quotient,
    store,
)
from tribodyn.dynamics._engine.method import (
    Law,
    Newmark,
    accept,
    for_method,
    own_slots,
    prepare,
    restart,
    step,
)
from tribodyn.dynamics._engine.midpoint import copy_slots, from_middle, to_middle
from tribodyn.dynamics._engine.runge_kutta import take_over
from tribodyn.types import Array, Index

#: Passes of Newton's method. Between contact changes two are enough, unless friction follows the
#: load.
PASSES = 25


class _Slots(NamedTuple):
    """Slots of the method."""

    now: int  #: acceleration at the beginning of the step
    new: int  #: and at its end
    guess: int  #: initial guess of the contact forces
    plain: int  #: compressions without contact forces
    rates: int  #: and their rates
    slope: int  #: derivative of every friction by its load
    push: int  #: accelerations per unit of each force
    effect: int  #: compressions and rates per unit of each force
    matrix: int  #: of Newton's method
    right: int  #: its right side
    spare: int  #: matrix that is inverted
    inverse: int  #: of every width of a step
    end: int


@nb.njit(forceinline=True, **INNER)
def _slots_of(code: Index) -> _Slots:
    s = slots_of(code)
    n, m = s.n, s.contacts
    frictions = s.end - s.friction
    guess = s.end + 2 * n
    slope = guess + 3 * m
    push = slope + frictions
    effect = push + (m + frictions) * n
    matrix = effect + 2 * m * (m + frictions)
    right = matrix + m * m
    spare = right + m
    inverse = spare + n * n
    return _Slots(
        s.end, s.end + n, guess, guess + m, guess + 2 * m, slope, push, effect, matrix, right,
        spare, inverse, inverse - s.end,
    )  # fmt: skip


@nb.njit(**INNER)
def _friction_terms(law: Law, base: int, buffer: int) -> Cursor:
    """Position of the first friction."""
    cursor = first_contact(law, base, buffer)
    for _ in range(law.code[1]):
        cursor = next_contact(law, cursor)
    return cursor


@nb.njit(forceinline=True, **INNER)
def _next_friction(law: Law, cursor: Cursor) -> Cursor:
    """Position of the next friction."""
    contacts, terms = law.code[cursor.at], law.code[cursor.at + 1]
    return Cursor(cursor.at + 2, cursor.read + contacts, cursor.row + 2 + terms)


@nb.njit(**INNER)
def _coordinate_terms(law: Law, base: int, buffer: int) -> Cursor:
    """Position of the terms of the first coordinate."""
    cursor = _friction_terms(law, base, buffer)
    count = law.code[cursor.at]
    cursor = Cursor(cursor.at + 1, cursor.read, cursor.row)
    for _ in range(count):
        cursor = _next_friction(law, cursor)
    return cursor


@for_method(Newmark, prepare)
def _invert(method: Newmark, law: Law, base: int, duration: float, kind: int, w: Array) -> None:
    """Inverse of ``1 + gamma h C + beta h^2 K`` of one lane, by elimination with pivots."""
    keep_apart()
    n, spare = law.code[0], _slots_of(law.code).spare
    h = duration if kind < 0 else method.widths[kind] * duration
    inverse = _slots_of(law.code).inverse + max(kind, 0) * n * n
    for item in range(n * n):
        w[spare + item] = w[inverse + item] = 0.0
    cursor = _coordinate_terms(law, base, I64(0))
    for i in range(n):
        w[spare + i * n + i] += 1.0
        w[inverse + i * n + i] = 1.0
        for item in range(law.code[cursor.at]):
            slot, factor = law.reads[cursor.read + item], law.rows[cursor.row + item]
            if slot < n:
                w[spare + i * n + slot] -= method.beta * h * h * factor
            elif slot < 2 * n:
                w[spare + i * n + slot - n] -= method.gamma * h * factor
        cursor = next_coordinate(law, cursor)
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
def _without_contacts(
    lanes: Lanes, method: Newmark, law: Law, base: int, inverse: int, w: Array
) -> None:
    """State at the end of the step, compressions and rates without contact forces."""
    s, o = slots_of(law.code), _slots_of(law.code)
    n, h = s.n, load(lanes, w, s.h)
    zero = 0.0 * h
    early, slow = (0.5 - method.beta) * h * h, (1.0 - method.gamma) * h
    late, fast = method.beta * h * h, method.gamma * h
    for i in range(n):
        v, a = load(lanes, w, n + i), load(lanes, w, o.now + i)
        store(w, 4 * n + i, load(lanes, w, i) + h * v + early * a)
        store(w, 5 * n + i, v + slow * a)
    for j in range(s.contacts):
        store(w, o.guess + j, load(lanes, w, s.force + j))
        store(w, s.force + j, zero)
    for f in range(s.friction, s.end):
        store(w, f, zero)
    cursor = _coordinate_terms(law, base, I64(2))
    for i in range(n):
        start = load(lanes, w, s.load + i)
        b = sum_terms(lanes, law, start, law.code[cursor.at], cursor.read, cursor.row, w)
        store(w, s.second + i, b)
        cursor = next_coordinate(law, cursor)
    for i in range(n):
        a = zero
        for k in range(n):
            a = a + load(lanes, w, inverse + i * n + k) * load(lanes, w, s.second + k)
        store(w, o.new + i, a)
    for i in range(n):
        a = load(lanes, w, o.new + i)
        store(w, 4 * n + i, load(lanes, w, 4 * n + i) + late * a)
        store(w, 5 * n + i, load(lanes, w, 5 * n + i) + fast * a)
    cursor = first_contact(law, base, I64(2))
    for j in range(s.contacts):
        d, rate = compression_and_rate(lanes, law, s, cursor, w)
        store(w, o.plain + j, d)
        store(w, o.rates + j, rate)
        store(w, s.force + j, load(lanes, w, o.guess + j))
        cursor = next_contact(law, cursor)


@nb.njit(**INNER)
def _pushes(lanes: Lanes, law: Law, base: int, inverse: int, w: Array) -> None:
    """Accelerations per unit of each contact force and friction."""
    s, o = slots_of(law.code), _slots_of(law.code)
    n, zero = s.n, 0.0 * load(lanes, w, s.h)
    for item in range(o.push, o.effect):
        store(w, item, zero)
    cursor = _coordinate_terms(law, base, I64(0))
    for i in range(n):
        for item in range(law.code[cursor.at]):
            slot = law.reads[cursor.read + item]
            source = slot - s.force
            if slot >= s.friction:
                source = s.contacts + slot - s.friction
            elif slot < s.force or slot >= s.side:
                continue
            factor, at = entry(lanes, law.rows, cursor.row + item), o.push + source * n
            for k in range(n):
                a = load(lanes, w, at + k) + load(lanes, w, inverse + k * n + i) * factor
                store(w, at + k, a)
        cursor = next_coordinate(law, cursor)


@nb.njit(**INNER)
def _effects(lanes: Lanes, method: Newmark, law: Law, base: int, w: Array) -> None:
    """Compressions and their rates per unit of each contact force and friction."""
    s, o = slots_of(law.code), _slots_of(law.code)
    n, m, sources = s.n, s.contacts, s.contacts + s.end - s.friction
    h, beat = load(lanes, w, s.h), load(lanes, w, s.beat)
    late, fast = method.beta * h * h, method.gamma * h
    cursor = first_contact(law, base, I64(0))
    for i in range(m):
        for j in range(sources):
            along, turned, push = 0.0 * h, 0.0 * h, o.push + j * n
            count = law.code[cursor.at]
            for item in range(count):
                a = load(lanes, w, push + law.reads[cursor.read + item])
                along = along + entry(lanes, law.rows, cursor.row + 5 + item) * a
            for item in range(count, count + law.code[cursor.at + 1]):
                a = load(lanes, w, push + law.reads[cursor.read + item])
                turned = turned + entry(lanes, law.rows, cursor.row + 5 + item) * a
            store(w, o.effect + i * sources + j, late * along)
            store(w, o.effect + (m + i) * sources + j, fast * along + beat * late * turned)
        cursor = next_contact(law, cursor)


@nb.njit(**INNER)
def _solve(lanes: Lanes, m: int, matrix: int, right: int, w: Array) -> None:
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
def _slopes(lanes: Lanes, law: Law, cursor: Cursor, w: Array) -> None:
    """Every friction and its derivative by the load."""
    s, o = slots_of(law.code), _slots_of(law.code)
    cursor = Cursor(cursor.at + 1, cursor.read, cursor.row)
    for f in range(s.end - s.friction):
        force, slope, following = friction_law(lanes, law, s.rub, cursor, w)
        store(w, s.friction + f, force)
        store(w, o.slope + f, slope)
        cursor = following


@nb.njit(**INNER)
def _row_of_newton(
    lanes: Lanes, law: Law, i: int, rubbing: Cursor, k: float, c: float, w: Array
) -> None:
    """Row of Newton's matrix for contact ``i`` with the tangents ``k`` and ``c`` of its force."""
    s, o = slots_of(law.code), _slots_of(law.code)
    m, frictions = s.contacts, s.end - s.friction
    by_d, by_rate = o.effect + i * (m + frictions), o.effect + (m + i) * (m + frictions)
    for j in range(m):
        d, rate = load(lanes, w, by_d + j), load(lanes, w, by_rate + j)
        cursor = Cursor(rubbing.at + 1, rubbing.read, rubbing.row)
        for f in range(frictions):
            for item in range(law.code[cursor.at]):
                if law.reads[cursor.read + item] == s.force + j:
                    slope = load(lanes, w, o.slope + f)
                    d = d + load(lanes, w, by_d + m + f) * slope
                    rate = rate + load(lanes, w, by_rate + m + f) * slope
            cursor = _next_friction(law, cursor)
        unit = 1.0 if i == j else 0.0
        store(w, o.matrix + i * m + j, unit - (k * d + c * rate))


@nb.njit(**INNER)
def _iterate(lanes: Lanes, tolerance: float, law: Law, base: int, w: Array) -> bool:
    """Solve for the contact forces by Newton's method; returns False without convergence."""
    s, o = slots_of(law.code), _slots_of(law.code)
    m, frictions = s.contacts, s.end - s.friction
    sources, rubbing = m + frictions, _friction_terms(law, base, I64(2))
    for _ in range(PASSES):
        size = 0.0 * load(lanes, w, s.h)
        _slopes(lanes, law, rubbing, w)
        cursor = first_contact(law, base, I64(2))
        for i in range(m):
            start, change = load(lanes, w, o.plain + i), load(lanes, w, o.rates + i)
            d, rate = start, change
            for j in range(sources):
                force = load(lanes, w, s.force + j if j < m else s.friction + j - m)
                d = d + load(lanes, w, o.effect + i * sources + j) * force
                rate = rate + load(lanes, w, o.effect + (m + i) * sources + j) * force
            force, k, c = contact_law(lanes, law, s, cursor, i, d, rate, w)
            old = load(lanes, w, s.force + i)
            store(w, o.right + i, force - old)
            size = greatest(size, magnitude(old) + magnitude(force))
            size = greatest(size, magnitude(k * start) + magnitude(c * change))
            _row_of_newton(lanes, law, i, rubbing, k, c, w)
            cursor = next_contact(law, cursor)
        _solve(lanes, m, o.matrix, o.right, w)
        converged = True
        for i in range(m):
            correction = load(lanes, w, o.right + i)
            store(w, s.force + i, load(lanes, w, s.force + i) + correction)
            converged = converged and not any_above(magnitude(correction), tolerance * size)
        if converged:
            return True
    return False


@nb.njit(**INNER)
def _step(lanes: Lanes, method: Newmark, law: Law, number: int, base: int, w: Array) -> bool:
    """Integrate every lane over one step; ``base`` is the row at its end."""
    keep_apart()
    s, o = slots_of(law.code), _slots_of(law.code)
    n, m = s.n, s.contacts
    inverse = o.inverse + (method.kind[number] if number >= 0 else I64(0)) * n * n
    _without_contacts(lanes, method, law, base, inverse, w)
    if m == 0:
        return True
    _pushes(lanes, law, base, inverse, w)
    _effects(lanes, method, law, base, w)
    converged: bool = _iterate(lanes, method.tolerance, law, base, w)
    friction_forces(lanes, law, _friction_terms(law, base, I64(2)), w)
    h = load(lanes, w, s.h)
    late, fast = method.beta * h * h, method.gamma * h
    for i in range(n):
        a = load(lanes, w, o.push + i) * load(lanes, w, s.force)
        for j in range(1, m + s.end - s.friction):
            force = load(lanes, w, s.force + j if j < m else s.friction + j - m)
            a = a + load(lanes, w, o.push + j * n + i) * force
        store(w, o.new + i, load(lanes, w, o.new + i) + a)
        store(w, 4 * n + i, load(lanes, w, 4 * n + i) + late * a)
        store(w, 5 * n + i, load(lanes, w, 5 * n + i) + fast * a)
    return converged


@for_method(Newmark, step)
def newmark_step(
    lanes: Lanes,
    method: Newmark,
    law: Law,
    number: int,
    base: int,
    w: Array,
    statistics_slot: int | None,
) -> bool:
    """Integrate every lane over one step with the sides at its start."""
    s, columns = slots_of(law.code), law.code[2]
    if statistics_slot is not None:
        acceleration(lanes, law, base, I64(0), s.first, w)
        copy_slots(lanes, s.force, statistics_slot, s.contacts, w)
    # The row at the end of the step is read.
    converged: bool = _step(lanes, method, law, number, base + 2 * columns, w)
    if statistics_slot is not None:
        to_middle(lanes, law, base + columns, statistics_slot, w)
        acceleration(lanes, law, base + columns, I64(1), s.second, w)
        from_middle(lanes, law, statistics_slot, w)
    return converged


@for_method(Newmark, own_slots)
def _own_slots(method: Newmark, law: Law) -> tuple[int, int, int]:
    n, kinds = law.code[0], method.widths.size
    return _slots_of(law.code).end + kinds * n * n, 2 * n, kinds


@for_method(Newmark, restart)
def _restart(lanes: Lanes, method: Newmark, law: Law, base: int, w: Array) -> None:
    acceleration(lanes, law, base, I64(0), _slots_of(law.code).now, w)


@for_method(Newmark, accept)
def _accept(lanes: Lanes, method: Newmark, law: Law, w: Array) -> None:
    n, o = law.code[0], _slots_of(law.code)
    take_over(lanes, n, w)
    for i in range(n):
        store(w, o.now + i, load(lanes, w, o.new + i))
