"""Statistics of every lane, gathered while marching, so that no time series is stored.

Each step contributes with Simpson's rule: both ends and the middle, where the state is the cubic
Hermite interpolant of the two ends. A lane in which a contact opens or closes within the step
contributes with every part of it by itself, as the damping force jumps there. Signals are, in this
order: compression of every contact, force of every contact, acceleration of every coordinate, and
linear outputs of the state.
"""

from __future__ import annotations

import math
from typing import Any

import numba as nb
import numpy as np

from tribodyn.dynamics._engine.contact_forces import I64, INNER, acceleration, compression
from tribodyn.dynamics._engine.crossing import row_within, set_sides
from tribodyn.dynamics._engine.lanes import greatest, least, load, store
from tribodyn.types import Array, Index

#: Per signal: mean, mean square, minimum, maximum, share of the time off the driving flank.
#: Signals of the contacts are followed by a cosine and a sine part per harmonic.
PLAIN_MOMENTS = 5
#: Shorter parts of a step are left out: their rate of change would be nothing but rounding.
_SHORTEST = 1e-7


@nb.njit(**INNER)
def _middle(lanes: Any, code: Index, w: Array) -> None:
    """Hermite interpolant of buffers 0 and 2 at the middle of the step, into buffer 1."""
    n = code[0]
    h = load(lanes, w, 9 * n + 2 * code[1] + 1)
    inverse = load(lanes, w, 9 * n + 2 * code[1] + 4)
    for i in range(n):
        q0, v0 = load(lanes, w, i), load(lanes, w, n + i)
        q1, v1 = load(lanes, w, 4 * n + i), load(lanes, w, 5 * n + i)
        store(w, 2 * n + i, 0.5 * (q0 + q1) + 0.125 * h * (v0 - v1))
        store(w, 3 * n + i, 1.5 * inverse * (q1 - q0) - 0.25 * (v0 + v1))


@nb.njit(**INNER)
def _add(
    lanes: Any,
    value: Any,
    weight: float,
    at: int,
    waves: Array,
    wave: int,
    harmonics: int,
    m: Array,
) -> None:
    weighted = weight * value
    store(m, at, load(lanes, m, at) + weighted)
    store(m, at + 1, load(lanes, m, at + 1) + weighted * value)
    store(m, at + 2, least(load(lanes, m, at + 2), value))
    store(m, at + 3, greatest(load(lanes, m, at + 3), value))
    for item in range(2 * harmonics):
        slot = at + PLAIN_MOMENTS + item
        store(m, slot, load(lanes, m, slot) + waves[wave + item] * weighted)


@nb.njit(**INNER)
def gather(
    lanes: Any,
    code: Index,
    reads: Index,
    rows: Array,
    base: int,
    switching: bool,
    w: Array,
    outputs: Array,
    share: float,
    waves: Array,
    wave: int,
    harmonics: int,
    m: Array,
) -> None:
    """Add one step, whose ends are in buffers 0 and 2, to the moments ``m``."""
    n, contacts, columns = code[0], code[1], code[2]
    long = PLAIN_MOMENTS + 2 * harmonics
    _middle(lanes, code, w)
    for node in range(3):
        buffer, row = (0, 1, 2)[node], base + node * columns
        weight = (1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0)[node] * share
        phase = wave + node * 2 * harmonics
        if switching:
            set_sides(lanes, code, reads, rows, row, buffer, w)
        acceleration(lanes, code, reads, rows, row, buffer, 6 * n, w)
        at, read, here = I64(4), buffer * code[3], row
        for j in range(contacts):
            d = compression(lanes, code, reads, rows, at, read, here, w)
            _add(lanes, d, weight, j * long, waves, phase, harmonics, m)
            force = load(lanes, w, 8 * n + j)
            _add(lanes, force, weight, (contacts + j) * long, waves, phase, harmonics, m)
            off = weight * (1.0 - greatest(load(lanes, w, 8 * n + contacts + j), 0.0 * d))
            slot = (contacts + j) * long + 4
            store(m, slot, load(lanes, m, slot) + off)
            here += 5 + code[at] + code[at + 1]
            read += code[at] + code[at + 1]
            at += 4
        signal = 2 * contacts * long
        for i in range(n):
            a = load(lanes, w, 6 * n + i)
            _add(lanes, a, weight, signal, waves, phase, 0, m)
            signal += PLAIN_MOMENTS
        for o in range(outputs.shape[0]):
            y = 0.0 * load(lanes, w, 0)
            for i in range(2 * n):
                if outputs[o, i] != 0.0:
                    y = y + outputs[o, i] * load(lanes, w, 2 * n * buffer + i)
            _add(lanes, y, weight, signal, waves, phase, 0, m)
            signal += PLAIN_MOMENTS


@nb.njit(**INNER)
def _waves_within(
    waves: Array, wave: int, harmonics: int, tau: float, near: Array, node: int
) -> None:
    """Cosine and sine of every harmonic at the fraction ``tau`` of a step, into ``near``."""
    for item in range(0, 2 * harmonics, 2):
        c0, s0 = waves[wave + item], waves[wave + item + 1]
        half = wave + 2 * harmonics + item
        c1, s1 = waves[half], waves[half + 1]
        angle = math.atan2(s0, c0) + 2.0 * tau * math.atan2(s1 * c0 - c1 * s0, c1 * c0 + s1 * s0)
        near[2 * harmonics * node + item] = math.cos(angle)
        near[2 * harmonics * node + item + 1] = math.sin(angle)


@nb.njit(**INNER)
def gather_parts(
    code: Index,
    reads: Index,
    rows: Array,
    base: int,
    parts: Array,
    width: float,
    part: Array,
    w: Array,
    outputs: Array,
    share: float,
    waves: Array,
    wave: int,
    harmonics: int,
    near: Array,
    m: Array,
) -> None:
    """Add one step of one lane, part by part as :func:`split_step` left them in ``parts``."""
    n, contacts = code[0], code[1]
    one, at = 9 * n + 2 * contacts, I64(1)
    for _ in range(I64(parts[0])):
        start, end = parts[at], parts[at + 1]
        at += 2
        if end - start > _SHORTEST:
            for j in range(contacts):
                w[8 * n + contacts + j] = parts[at + j]
            for i in range(2 * n):
                w[i] = parts[at + contacts + i]
                w[4 * n + i] = parts[at + contacts + 2 * n + i]
            for node in range(3):
                tau = start + 0.5 * node * (end - start)
                row_within(code, rows, base, tau, part, I64(node))
                _waves_within(waves, wave, harmonics, tau, near, I64(node))
            w[one + 1] = width * (end - start)
            w[one + 4] = 1.0 / w[one + 1]
            here = share * (end - start)
            gather(
                (0.0,),
                code,
                reads,
                part,
                I64(0),
                np.bool_(False),
                w,
                outputs,
                here,
                near,
                I64(0),
                harmonics,
                m,
            )
        at += contacts + 4 * n
