"""Compiled time integration in modal coordinates, with exact steps of every linear mode.

Each mode obeys ``z' = lambda z + b u`` with the forces ``u`` at the contacts, which are a parabola
over the step through its beginning, middle and end: the step is exact for this parabola, and the
forces at its middle and end follow from the motion of the contacts there by fixed-point iteration.
A step in which a contact opens or closes ends there and goes on with the new side.

All entries of a node of the grid are one row: stiffnesses of the springs of every contact, its
damping, error, rate of the error, gaps of its springs, then directions of compression, their rates,
of push, then the load, the directions of frictions and their coefficients. The springs of a contact
are the first one and its ramps, as many as the contact with the most has; each has its side.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled import announced, source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.dynamics._engine.method import INNER, JIT
from tribodyn.types import Array, ComplexArray, Index

#: Fixed-point iterations of a step, changes of side in a step, bisections of a crossing.
_ITERATIONS, _CHANGES, _BISECTIONS = 60, 64, 60
#: Last change of the motion at the contacts, and clearance at a crossing, over their size.
_FIXED, _TOUCHING = 1e-14, 1e-13
#: Motion at the contacts beyond which it grows without bounds [kg^0.5 m].
_LARGEST = 1e60
#: Reasons of a failure.
UNSETTLED, CHATTER, GROWING = 1, 2, 3


class Modes(NamedTuple):
    """Modes with one of each conjugate pair."""

    values: ComplexArray  #: (m,) [rad/s]
    input: ComplexArray  #: (m, s)
    output: ComplexArray  #: (r, m), doubled for pairs
    stiffness: Array  #: mean contact stiffness and damping that the modes include (s, r)
    damping: Array


class Contacts(NamedTuple):
    """Contacts and frictions that do not vary."""

    dead: Index  #: whether each spring has a dead zone (contacts, springs)
    damped_in_gap: Array
    members: Array  #: contacts that each friction follows (f, contacts)
    load: Array  #: of each friction (f,)
    limit: Array


class Weights(NamedTuple):
    """Weights of one step: of modes and forces in modes and in motions at the contacts."""

    decay: Array  #: real and imaginary part of the factor of each mode (2, m)
    force: Array  #: of forces at the three nodes in each mode (2, 3 s, m)
    motion: Array  #: of modes in position and rate at the middle and the end (2, m, 4 r)
    direct: Array  #: of forces in the same (4 r, 3 s)


class Buffers(NamedTuple):
    """Work space of a step."""

    z: Array  #: modes (2, m)
    rows: Array  #: entries at the three nodes (3, row)
    u: Array  #: forces at the three nodes (3 s,)
    base: Array
    motion: Array  #: (4 r,)
    last: Array
    contact: Array  #: contact forces
    side: Array  #: of the springs (contacts, springs)
    deflection: Array  #: at the three nodes (3, contacts)


class Trace(NamedTuple):
    """Output of an integration."""

    modes: Array  #: (rows, 2, m); empty to record nothing
    sums: Array  #: integral and double integral of the forces (rows, 2, s)
    contacts: Array  #: motion and rate at middle and end of last steps (steps, 2, 2 r)
    report: Array  #: reason of a failure, step, contact; changes of side, iterations; log entries
    #: changes of side: step, fraction, contact, spring, side, motion and rate (entries, 5 + 2 r)
    log: Array


@nb.njit(**INNER)
def _exponentials(x: complex) -> tuple[complex, complex, complex, complex]:
    """``exp(x)`` and the integrals of ``exp((1 - s) x) s^k/k!`` for k = 0, 1, 2."""
    if abs(x) < 1.0:
        third, term = 0.0 * x, 1.0 / 6.0 + 0.0 * x
        for k in range(4, 22):
            third += term
            term *= x / k
        second = 0.5 + x * third
        first = 1.0 + x * second
        return 1.0 + x * first, first, second, third
    full_step = np.exp(x)
    first = (full_step - 1.0) / x
    second = (first - 1.0) / x
    return full_step, first, second, (second - 0.5) / x


@nb.njit(**INNER)
def _fill_weights(modes: Modes, h: float, weights: Weights) -> None:
    """Weights of a step of ``h`` seconds."""
    s, r = modes.input.shape[1], modes.output.shape[0]
    weights.direct[:] = 0.0
    for m in range(modes.values.size):
        value = modes.values[m]
        full_step, first, second, third = _exponentials(value * h)
        half, begin, middle, end = _exponentials(0.5 * value * h)
        weights.decay[0, m], weights.decay[1, m] = full_step.real, full_step.imag
        full = (
            h * (first - 3.0 * second + 4.0 * third),
            h * (4.0 * second - 8.0 * third),
            h * (4.0 * third - second),
        )
        part = (
            0.5 * h * (begin - 1.5 * middle + end),
            h * (middle - end),
            0.5 * h * (end - 0.5 * middle),
        )
        for o in range(r):
            place = modes.output[o, m]
            rate = place * value
            for k, factor in (
                (0, place * half),
                (r, rate * half),
                (2 * r, place * full_step),
                (3 * r, rate * full_step),
            ):
                weights.motion[0, m, k + o], weights.motion[1, m, k + o] = factor.real, -factor.imag
            for node in range(3):
                for i in range(s):
                    b = modes.input[m, i]
                    at = node * s + i
                    weights.direct[o, at] += (place * part[node] * b).real
                    weights.direct[r + o, at] += (rate * part[node] * b).real
                    weights.direct[2 * r + o, at] += (place * full[node] * b).real
                    weights.direct[3 * r + o, at] += (rate * full[node] * b).real
        for node in range(3):
            for i in range(s):
                pushed = full[node] * modes.input[m, i]
                weights.force[0, node * s + i, m] = pushed.real
                weights.force[1, node * s + i, m] = pushed.imag


@nb.njit(**INNER)
def _law(
    modes: Modes, contacts: Contacts, row: Array, motion: Array, at: int, w: Buffers, node: int
) -> None:
    """Forces on the closed structure at a node, from the motion at ``at`` and its rate."""
    s, r = modes.input.shape[1], modes.output.shape[0]
    (count, springs), frictions = contacts.dead.shape, contacts.load.size
    damping = count * springs
    error, gap = damping + count, damping + 3 * count
    along = gap + count * springs
    slope = along + r * count
    push = slope + r * count
    load = push + s * count
    rub = load + s
    coefficients = rub + frictions * s
    terms = (row.size - coefficients) // max(frictions, 1)
    first = node * s
    for i in range(s):
        total = row[load + i]
        for o in range(r):
            total += (
                modes.stiffness[i, o] * motion[at + o] + modes.damping[i, o] * motion[at + r + o]
            )
        w.u[first + i] = total
    for j in range(count):
        d, rate = -row[error + j], -row[error + count + j]
        for o in range(r):
            direction = row[along + j * r + o]
            d += direction * motion[at + o]
            rate += direction * motion[at + r + o] + row[slope + j * r + o] * motion[at + o]
        force = 0.0
        for k in range(springs):
            side = w.side[j, k]
            force += abs(side) * row[j * springs + k] * (d - side * row[gap + j * springs + k])
        if w.side[j, 0] != 0.0 or contacts.damped_in_gap[j] != 0.0:
            force += row[damping + j] * rate
        w.contact[j] = force
        w.deflection[node, j] = d
        for i in range(s):
            w.u[first + i] -= row[push + j * s + i] * force
    for f in range(frictions):
        carried = 0.0
        for j in range(count):
            carried += contacts.members[f, j] * w.contact[j]
        x = min(abs(carried) / contacts.load[f], contacts.limit[f])
        ratio = 0.0
        for k in range(terms - 1, -1, -1):
            ratio = ratio * x + row[coefficients + f * terms + k]
        for i in range(s):
            w.u[first + i] -= row[rub + f * s + i] * ratio * carried


@nb.njit(**INNER)
def _interpolate(rows: Array, tau: float, out: Array) -> None:
    """Row at a fraction of a step, on the parabola through its three nodes."""
    left, right = (1.0 - tau) * (1.0 - 2.0 * tau), tau * (2.0 * tau - 1.0)
    middle = 4.0 * tau * (1.0 - tau)
    for i in range(out.size):
        out[i] = left * rows[0, i] + middle * rows[1, i] + right * rows[2, i]


@nb.njit(**INNER)
def _settle(modes: Modes, contacts: Contacts, weights: Weights, w: Buffers, scale: float) -> int:
    """Forces at the middle and end of a step with fixed sides; number of iterations, 0 for none."""
    s, r = modes.input.shape[1], modes.output.shape[0]
    w.base[:] = 0.0
    for m in range(modes.values.size):
        real, imaginary = w.z[0, m], w.z[1, m]
        for o in range(4 * r):
            w.base[o] += weights.motion[0, m, o] * real + weights.motion[1, m, o] * imaginary
    for o in range(4 * r):
        for i in range(s):
            w.base[o] += weights.direct[o, i] * w.u[i]
        w.last[o] = np.inf
    for count in range(1, _ITERATIONS + 1):
        change = 0.0
        for o in range(4 * r):
            total = w.base[o]
            for i in range(s, 3 * s):
                total += weights.direct[o, i] * w.u[i]
            w.motion[o] = total
            if o % (2 * r) < r:
                change = max(change, abs(total - w.last[o]))
            w.last[o] = total
        _law(modes, contacts, w.rows[1], w.motion, 0, w, 1)
        _law(modes, contacts, w.rows[2], w.motion, 2 * r, w, 2)
        if change <= _FIXED * scale:
            return count
    return count if change <= 1e-11 * scale else 0


@nb.njit(**INNER)
def _clear(contacts: Contacts, w: Buffers, node: int, j: int, k: int) -> float:
    """Clearance of a spring from the edge of its side, at a node; infinite without dead zone."""
    count, springs = contacts.dead.shape
    if not contacts.dead[j, k]:
        return np.inf
    d, side = w.deflection[node, j], w.side[j, k]
    gap = w.rows[node, count * (springs + 3) + j * springs + k]
    clear: float = side * d - gap if side != 0.0 else gap - abs(d)
    return clear


@nb.njit(**INNER)
def _clearance(contacts: Contacts, w: Buffers, node: int, worst: Index) -> float:
    """Least clearance of a spring from the edge of its side, at a node."""
    least = np.inf
    for j in range(contacts.dead.shape[0]):
        for k in range(contacts.dead.shape[1]):
            clear = _clear(contacts, w, node, j, k)
            if clear < least:
                least = clear
                worst[0], worst[1] = j, k
    return least


@nb.njit(**INNER)
def _accept(modes: Modes, weights: Weights, w: Buffers, h: float, sums: Array) -> None:
    """Advance modes and integrals of the forces by a step."""
    s, count = modes.input.shape[1], modes.values.size
    for m in range(count):
        real, imaginary = w.z[0, m], w.z[1, m]
        w.z[0, m] = weights.decay[0, m] * real - weights.decay[1, m] * imaginary
        w.z[1, m] = weights.decay[0, m] * imaginary + weights.decay[1, m] * real
    for i in range(3 * s):
        force = w.u[i]
        for m in range(count):
            w.z[0, m] += weights.force[0, i, m] * force
            w.z[1, m] += weights.force[1, i, m] * force
    for i in range(s):
        sums[1, i] += h * sums[0, i] + h * h * (w.u[i] + 2.0 * w.u[s + i]) / 6.0
        sums[0, i] += h * (w.u[i] + 4.0 * w.u[s + i] + w.u[2 * s + i]) / 6.0


@nb.njit(**INNER)
def _begin(modes: Modes, contacts: Contacts, w: Buffers, start: Array) -> None:
    """Forces at the beginning of a step, repeated as a first guess at its other nodes."""
    s = modes.input.shape[1]
    _law(modes, contacts, w.rows[0], start, 0, w, 0)
    for i in range(s):
        w.u[s + i] = w.u[i]
        w.u[2 * s + i] = w.u[i]


@nb.njit(**INNER)
def _try(
    modes: Modes, contacts: Contacts, table: Array, begin: float, end: float, h: float,
    weights: Weights, w: Buffers, start: Array, scale: float,
) -> int:  # fmt: skip
    """Part of a step from fraction to fraction, ``h`` seconds long, with fixed sides."""
    _fill_weights(modes, h, weights)
    _interpolate(table, begin, w.rows[0])
    _interpolate(table, 0.5 * (begin + end), w.rows[1])
    _interpolate(table, end, w.rows[2])
    _begin(modes, contacts, w, start)
    return int(_settle(modes, contacts, weights, w, scale))


@nb.njit(**INNER)
def _crossing(contacts: Contacts, w: Buffers, spring: Index, tau: float) -> tuple[float, float]:
    """Fraction at which a spring crosses on the parabola through three nodes, and its slope."""
    j, k = spring[0], spring[1]
    first, middle = _clear(contacts, w, 0, j, k), _clear(contacts, w, 1, j, k)
    last = _clear(contacts, w, 2, j, k)
    square = 2.0 * first - 4.0 * middle + 2.0 * last
    line = -3.0 * first + 4.0 * middle - last
    root = np.sqrt(max(line * line - 4.0 * square * first, 0.0))
    # The smaller root; the slope there is that of the falling side.
    x = 2.0 * first / (root - line) if first > 0.0 and root > line else -1.0
    return tau + x * (1.0 - tau), -max(root, 1e-300) / (1.0 - tau)


@nb.njit(**INNER)
def _change(
    trace: Trace, tau: float, j: int, k: int, side: float, start: Array, w: Buffers
) -> None:
    """Give a spring another side, at a fraction of the step of the report."""
    w.side[j, k] = side
    entry = int(trace.report[5])
    if entry < trace.log.shape[0]:
        row = trace.log[entry]
        row[0], row[1], row[2], row[3], row[4] = trace.report[1], tau, j, k, side
        row[5:] = start
    trace.report[5] += 1.0


@nb.njit(**INNER)
def _divide(
    modes: Modes, contacts: Contacts, table: Array, width: float, weights: Weights, w: Buffers,
    start: Array, scale: float, reach: float, trace: Trace, sums: Array,
) -> int:  # fmt: skip
    """A step in which contacts open or close; returns the reason of a failure."""
    r = modes.output.shape[0]
    tau, worst = 0.0, np.zeros(2, dtype=np.int64)
    for _ in range(_CHANGES):
        if not _try(
            modes, contacts, table, tau, 1.0, (1.0 - tau) * width, weights, w, start, scale
        ):
            return UNSETTLED
        middle, last = _clearance(contacts, w, 1, worst), _clearance(contacts, w, 2, worst)
        edge = -_TOUCHING * reach
        if middle >= edge and last >= edge:
            _accept(modes, weights, w, (1.0 - tau) * width, sums)
            start[:] = w.motion[2 * r :]
            return 0
        low, high = tau, 0.5 * (1.0 + tau) if middle < edge else 1.0
        if middle < edge:
            _clearance(contacts, w, 1, worst)
        at, slope = _crossing(contacts, w, worst, tau)
        if not low < at < high:
            at = 0.5 * (low + high)
        # Secants within the bracket, the first one along the parabola.
        previous, before = -1.0, 0.0
        for _ in range(_BISECTIONS):
            if not _try(
                modes, contacts, table, tau, at, (at - tau) * width, weights, w, start, scale
            ):
                return UNSETTLED
            clear = _clearance(contacts, w, 2, worst)
            if abs(clear) <= _TOUCHING * reach or high - low < 1e-14:
                break
            low, high = (at, high) if clear > 0.0 else (low, at)
            if previous >= 0.0 and (clear - before) * (at - previous) < 0.0:
                slope = (clear - before) / (at - previous)
            previous, before = at, clear
            at -= clear / slope
            if not low < at < high:
                at = 0.5 * (low + high)
        _accept(modes, weights, w, (at - tau) * width, sums)
        start[:] = w.motion[2 * r :]
        tau = at
        for j in range(contacts.dead.shape[0]):
            for k in range(contacts.dead.shape[1]):
                last = j == worst[0] and k == worst[1]
                if last or _clear(contacts, w, 2, j, k) <= 2.0 * _TOUCHING * reach:
                    away = 1.0 if w.deflection[2, j] > 0.0 else -1.0
                    _change(trace, at, j, k, 0.0 if w.side[j, k] != 0.0 else away, start, w)
                    trace.report[3] += 1.0
        if 1.0 - tau < 1e-13:
            return 0
    trace.report[2] = worst[0]
    return CHATTER


def _build(digest: str) -> Any:
    @cached_njit(**JIT)
    def march_modes(
        modes: Modes,
        contacts: Contacts,
        table: Array,
        widths: Array,
        kind: Index,
        restart: Index,
        start: Array,
        z: Array,
        cycles: int,
        trace: Trace,
    ) -> Array:
        """Integrate modes (2, m) over periods of the clock; returns the sums of the forces."""
        # table (steps, 3, row): entries; widths [s], of which kind (steps,) selects one; restart
        # (steps,): steps after an event; start (2 r,): motion at the contacts and its rate.
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        s, r, m = modes.input.shape[1], modes.output.shape[0], modes.values.size
        (count, springs), steps, length = contacts.dead.shape, table.shape[0], table.shape[2]
        wide = widths.size + 1
        decay, force = np.empty((wide, 2, m)), np.empty((wide, 2, 3 * s, m))
        motion, direct = np.empty((wide, 2, m, 4 * r)), np.empty((wide, 4 * r, 3 * s))
        for k in range(widths.size):
            _fill_weights(modes, widths[k], Weights(decay[k], force[k], motion[k], direct[k]))
        partial = Weights(decay[wide - 1], force[wide - 1], motion[wide - 1], direct[wide - 1])
        w = Buffers(
            z, np.empty((3, length)), np.empty(3 * s), np.empty(4 * r), np.empty(4 * r),
            np.empty(4 * r), np.empty(count), np.ones((count, springs)), np.empty((3, count)),
        )  # fmt: skip
        sums, worst = np.zeros((2, s)), np.zeros(2, dtype=np.int64)
        switching, scale, reach = False, 0.0, 0.0
        for o in range(r):
            scale = max(scale, abs(start[o]))
        for j in range(count):
            for k in range(springs):
                switching |= contacts.dead[j, k] != 0
        recorded = trace.modes.shape[0] > 0
        if recorded:
            trace.modes[0], trace.sums[0] = w.z, sums
        for cycle in range(cycles):
            for step in range(steps):
                weights = Weights(
                    decay[kind[step]], force[kind[step]], motion[kind[step]], direct[kind[step]]
                )
                width = widths[kind[step]]
                w.rows[:] = table[step]
                trace.report[1] = cycle * steps + step
                _begin(modes, contacts, w, start)
                if switching and restart[step]:
                    for j in range(count):
                        d = w.deflection[0, j]
                        reach = max(reach, abs(d), w.rows[0, (springs + 3) * count + j * springs])
                        for k in range(springs):
                            gap = w.rows[0, (springs + 3) * count + j * springs + k]
                            if contacts.dead[j, k]:
                                side = 1.0 if d > gap else (-1.0 if d < -gap else 0.0)
                                if side != w.side[j, k]:
                                    _change(trace, 0.0, j, k, side, start, w)
                    _begin(modes, contacts, w, start)
                iterations = _settle(modes, contacts, weights, w, scale)
                trace.report[4] += iterations
                failure = 0 if iterations else UNSETTLED
                if iterations and switching:
                    edge = -_TOUCHING * reach
                    crossing = _clearance(contacts, w, 1, worst) < edge
                    crossing |= _clearance(contacts, w, 2, worst) < edge
                else:
                    crossing = False
                trace.contacts[step, 0] = w.motion[: 2 * r]
                if crossing:
                    failure = _divide(
                        modes, contacts, table[step], width, partial, w, start, scale, reach,
                        trace, sums,
                    )  # fmt: skip
                elif not failure:
                    _accept(modes, weights, w, width, sums)
                    start[:] = w.motion[2 * r :]
                trace.contacts[step, 1] = start
                for o in range(r):
                    scale = max(scale, abs(start[o]))
                if not scale < _LARGEST:
                    failure = GROWING
                if failure:
                    trace.report[0] = failure
                    return sums
                if recorded:
                    row = cycle * steps + step + 1
                    trace.modes[row], trace.sums[row] = w.z, sums
        return sums

    return march_modes


def _digest() -> str:
    from pathlib import Path

    return source_digest(Path(__file__).parent, ["modal_kernel"])


march_modes = announced(_build(_digest()), "the modal engine", "half a minute")
