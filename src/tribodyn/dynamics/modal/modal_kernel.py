"""Compiled time integration in modal coordinates, with exact steps of every linear mode.

A step in which a contact opens or closes ends there and goes on with the new side. The crossing is
searched with parts of the step, each of which is solved like a step: first where the polynomial
through clearances and their rates at the nodes vanishes, then by Newton's method.
"""

from __future__ import annotations

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.compiled.jit import INNER, JIT
from tribodyn.dynamics.modal.modal_step import (
    accept,
    begin_step,
    fill_direct,
    fill_modes,
    settle,
    try_part,
)
from tribodyn.dynamics.modal.modal_tables import (
    CHATTER,
    GROWING,
    UNSETTLED,
    Buffers,
    Contacts,
    Modes,
    Trace,
    Weights,
)
from tribodyn.types import Array, Index

_DIGEST = source_digest(__file__.rpartition("/")[0], ["modal_kernel", "modal_step", "modal_tables"])

#: Changes of side in a step, trials and bisections of a crossing.
_CHANGES, _TRIALS, _BISECTIONS = 64, 60, 48
#: Clearance at a crossing over the size of the motion: where the force jumps, and where it bends,
#: which the square of the clearance changes.
_TOUCHING, _BENDING = 1e-13, 1e-9
#: Motion at the contacts beyond which it grows without bounds [kg^0.5 m].
_LARGEST = 1e60


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
def _closing(contacts: Contacts, w: Buffers, node: int, j: int, k: int, h: float) -> float:
    """Rate of this clearance [m/s]; the nodes are those of ``h`` seconds."""
    count, springs = contacts.dead.shape
    at, x = count * (springs + 3) + j * springs + k, 0.5 * node
    widens = (4.0 * x - 3.0) * w.rows[0, at] + (4.0 - 8.0 * x) * w.rows[1, at]
    widens = (widens + (4.0 * x - 1.0) * w.rows[2, at]) / h
    d, rate, side = w.deflection[node, j], w.rate[node, j], w.side[j, k]
    flank = side if side != 0.0 else (-1.0 if d > 0.0 else 1.0)
    closing: float = flank * rate + (widens if side == 0.0 else -widens)
    return closing


@nb.njit(**INNER)
def _allowed(contacts: Contacts, j: int, k: int) -> float:
    """Clearance at which a spring changes its side, over the size of the motion."""
    return _TOUCHING if k == 0 and contacts.damped_in_gap[j] == 0.0 else _BENDING


@nb.njit(**INNER)
def _beyond(contacts: Contacts, w: Buffers, node: int, reach: float, worst: Index) -> bool:
    """Whether a spring is beyond the edge of its side, at a node; if so, the farthest one."""
    least = 0.0
    for j in range(contacts.dead.shape[0]):
        for k in range(contacts.dead.shape[1]):
            clear = _clear(contacts, w, node, j, k) + _allowed(contacts, j, k) * reach
            if clear < least:
                least = clear
                worst[0], worst[1] = j, k
    return least < 0.0


@nb.njit(**INNER)
def _crossing(contacts: Contacts, w: Buffers, spring: Index, high: float, h: float) -> float:
    """Fraction of ``h`` seconds, up to ``high``, where a spring crosses by clearances and rates."""
    j, k = spring[0], spring[1]
    first, middle = _clear(contacts, w, 0, j, k), _clear(contacts, w, 1, j, k)
    last = _clear(contacts, w, 2, j, k)
    # Divided differences of the polynomial through values and slopes at 0, 1/2 and 1.
    a = h * _closing(contacts, w, 0, j, k, h)
    c, e = h * _closing(contacts, w, 1, j, k, h), h * _closing(contacts, w, 2, j, k, h)
    b, d = 2.0 * (middle - first), 2.0 * (last - middle)
    second, third = 2.0 * (b - a), 4.0 * (c - 2.0 * b + a)
    inner = 2.0 * (d - 2.0 * c + b)
    fourth = inner - third
    fifth = 4.0 * (e - 2.0 * d + c) - 2.0 * inner + third
    low = high - 0.5 if first > 0.0 and (high < 1.0 or middle > 0.0) else 0.0
    for _ in range(_BISECTIONS):
        x = 0.5 * (low + high)
        y = x - 0.5
        bend = second + y * (third + y * (fourth + (x - 1.0) * fifth))
        if first + x * (a + x * bend) > 0.0:
            low = x
        else:
            high = x
    return 0.5 * (low + high)


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
def _change_sides(
    contacts: Contacts, w: Buffers, at: float, h: float, worst: Index, start: Array, reach: float,
    trace: Trace,
) -> None:  # fmt: skip
    """Give the spring that crosses, and those that cross with it, their other sides."""
    for j in range(contacts.dead.shape[0]):
        for k in range(contacts.dead.shape[1]):
            change = j == worst[0] and k == worst[1]
            if not change and contacts.dead[j, k]:
                in_reach = _clear(contacts, w, 2, j, k) <= 2.0 * _allowed(contacts, j, k) * reach
                change = in_reach and _closing(contacts, w, 2, j, k, h) < 0.0
            if change:
                away = 1.0 if w.deflection[2, j] > 0.0 else -1.0
                _change(trace, at, j, k, 0.0 if w.side[j, k] != 0.0 else away, start, w)
                trace.report[3] += 1.0


@nb.njit(**INNER)
def _divide(
    modes: Modes, contacts: Contacts, table: Array, width: float, weights: Weights, w: Buffers,
    start: Array, scale: float, reach: float, trace: Trace, sums: Array,
) -> int:  # fmt: skip
    """A solved step in which contacts open or close; returns the reason of a failure."""
    r2 = modes.output.shape[2]
    tau, worst = 0.0, np.zeros(2, dtype=np.int64)
    for change in range(_CHANGES):
        h = (1.0 - tau) * width
        if change and not try_part(modes, contacts, table, tau, 1.0, h, weights, w, start, scale):
            return UNSETTLED
        crossed = 0.5 if _beyond(contacts, w, 1, reach, worst) else 1.0
        if crossed == 1.0 and not _beyond(contacts, w, 2, reach, worst):
            accept(modes, weights, w, h, sums)
            start[:] = w.motion[r2:]
            return 0
        at = tau + (1.0 - tau) * _crossing(contacts, w, worst, crossed, h)
        low, high = tau, tau + (1.0 - tau) * crossed
        for _ in range(_TRIALS):
            h = (at - tau) * width
            if not try_part(modes, contacts, table, tau, at, h, weights, w, start, scale):
                return UNSETTLED
            beyond = _beyond(contacts, w, 2, reach, worst)
            clear = _clear(contacts, w, 2, worst[0], worst[1])
            in_reach = clear <= _allowed(contacts, worst[0], worst[1]) * reach
            if (in_reach and not beyond) or high - low < 1e-14:
                break
            low, high = (low, at) if beyond else (at, high)
            at -= clear / (width * _closing(contacts, w, 2, worst[0], worst[1], h))
            if not low < at < high:
                at = 0.5 * (low + high)
        accept(modes, weights, w, h, sums)
        start[:] = w.motion[r2:]
        tau = at
        _change_sides(contacts, w, at, h, worst, start, reach, trace)
        if 1.0 - tau < 1e-13:
            return 0
    trace.report[2] = worst[0]
    return CHATTER


@cached_njit(_DIGEST, "the modal engine", "half a minute", **JIT)
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
    s, r2, m = modes.input.shape[1], modes.output.shape[2], modes.values.size
    (count, springs), steps, length = contacts.dead.shape, table.shape[0], table.shape[2]
    of_modes = np.empty((widths.size + 1, 2, 4, 2, m))
    direct = np.empty((widths.size, 2 * s, 2 * r2))
    for k in range(widths.size):
        fill_modes(modes.values, widths[k], of_modes[k])
        fill_direct(modes, Weights(of_modes[k], direct[k]))
    partial = Weights(of_modes[widths.size], np.empty((0, 2 * r2)))
    w = Buffers(
        z, np.empty((3, length)), np.empty((3, s)), np.empty((3, 2, m)), np.empty((4, 2, m)),
        np.empty(2 * r2), np.empty(2 * r2), np.empty(2 * r2), np.empty(count),
        np.ones((count, springs)), np.empty((3, count)), np.empty((3, count)),
    )  # fmt: skip
    sums, worst = np.zeros((2, s)), np.zeros(2, dtype=np.int64)
    switching, scale, reach = False, 0.0, 0.0
    for o in range(r2 // 2):
        scale = max(scale, abs(start[o]))
    for j in range(count):
        for k in range(springs):
            switching |= contacts.dead[j, k] != 0
    recorded = trace.modes.shape[0] > 0
    if recorded:
        trace.modes[0], trace.sums[0] = w.z, sums
    for cycle in range(cycles):
        for step in range(steps):
            weights = Weights(of_modes[kind[step]], direct[kind[step]])
            width = widths[kind[step]]
            w.rows[:] = table[step]
            trace.report[1] = cycle * steps + step
            begin_step(modes, contacts, w, start)
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
                begin_step(modes, contacts, w, start)
            iterations = settle(modes, contacts, weights, w, scale)
            trace.report[4] += iterations
            failure = 0 if iterations else UNSETTLED
            crossing = (
                iterations > 0
                and switching
                and (_beyond(contacts, w, 1, reach, worst) or _beyond(contacts, w, 2, reach, worst))
            )
            trace.contacts[step, 0] = w.motion[:r2]
            if crossing:
                failure = _divide(
                    modes, contacts, table[step], width, partial, w, start, scale, reach,
                    trace, sums,
                )  # fmt: skip
            elif not failure:
                accept(modes, weights, w, width, sums)
                start[:] = w.motion[r2:]
            trace.contacts[step, 1] = start
            for o in range(r2 // 2):
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
