"""Statistics of every lane, gathered while marching, so that no time series is stored.

Each step contributes with Simpson's rule: both ends and the middle, where the state is the cubic
Hermite interpolant of the two ends. A lane in which a contact opens or closes within the step
contributes with every part of it by itself, as the damping force jumps there. The signals and their
order are those of :mod:`tribodyn.dynamics._engine.statistics`.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numba as nb
import numpy as np

from tribodyn.dynamics._engine.contact_forces import (
    I64,
    Law,
    acceleration,
    compression,
    first_contact,
    next_contact,
    set_sides,
    slots_of,
)
from tribodyn.dynamics._engine.crossing import row_within
from tribodyn.dynamics._engine.lanes import greatest, least, load, store
from tribodyn.dynamics._engine.method import INNER, ONCE
from tribodyn.dynamics._engine.statistics import PLAIN_MOMENTS
from tribodyn.dynamics.equations import motion
from tribodyn.types import Array

cubic_middle = nb.njit(**INNER)(motion.cubic_middle)

#: Shorter parts of a step are left out: their rate of change would be nothing but rounding.
_SHORTEST = 1e-7


class Gathered(NamedTuple):
    """What statistics are gathered; in kernels with addresses instead of arrays."""

    outputs: Array  #: linear outputs of the state
    waves: Any  #: cosine and sine of every harmonic at the three nodes of every step
    harmonics: int
    moments: Any  #: of all lanes, or of one


@nb.njit(**INNER)
def _middle(lanes: Any, law: Law, w: Array) -> None:
    """Interpolant of buffers 0 and 2 at the middle of the step, into buffer 1."""
    s = slots_of(law.code)
    n, h, inverse = s.n, load(lanes, w, s.h), load(lanes, w, s.inverse)
    for i in range(n):
        q0, v0 = load(lanes, w, i), load(lanes, w, n + i)
        q1, v1 = load(lanes, w, 4 * n + i), load(lanes, w, 5 * n + i)
        q, v = cubic_middle(h, inverse, q0, v0, q1, v1)
        store(w, 2 * n + i, q)
        store(w, 3 * n + i, v)


@nb.njit(**INNER)
def _add(lanes: Any, value: Any, weight: float, at: int, m: Array) -> Any:
    """Add to the plain moments of a signal; returns the value times its weight."""
    weighted = weight * value
    store(m, at, load(lanes, m, at) + weighted)
    store(m, at + 1, load(lanes, m, at + 1) + weighted * value)
    store(m, at + 2, least(load(lanes, m, at + 2), value))
    store(m, at + 3, greatest(load(lanes, m, at + 3), value))
    return weighted


@nb.njit(**INNER)
def _add_waves(lanes: Any, weighted: Any, at: int, wave: int, into: Gathered) -> None:
    """Add to the harmonics of a signal of a contact."""
    for item in range(2 * into.harmonics):
        slot = at + PLAIN_MOMENTS + item
        part = into.waves[wave + item] * weighted
        store(into.moments, slot, load(lanes, into.moments, slot) + part)


@nb.njit(**INNER)
def gather(
    lanes: Any, law: Law, row: int, switching: bool, share: float, wave: int, into: Gathered, w: Any
) -> None:
    """Add one step, whose ends are in buffers 0 and 2, to the moments."""
    s, columns, m = slots_of(law.code), law.code[2], into.moments
    n, contacts, outputs = s.n, s.contacts, into.outputs
    long = PLAIN_MOMENTS + 2 * into.harmonics
    _middle(lanes, law, w)
    for node in range(3):
        at, phase = row + node * columns, wave + node * 2 * into.harmonics
        weight = (4.0 / 6.0 if node == 1 else 1.0 / 6.0) * share
        if switching:
            set_sides(lanes, law, at, node, w)
        acceleration(lanes, law, at, node, s.first, w)
        here = first_contact(law, at, node)
        for j in range(contacts):
            d = compression(lanes, law, here, s.error, w)
            weighted = _add(lanes, d, weight, j * long, m)
            _add_waves(lanes, weighted, j * long, phase, into)
            slot = (contacts + j) * long
            weighted = _add(lanes, load(lanes, w, s.force + j), weight, slot, m)
            _add_waves(lanes, weighted, slot, phase, into)
            off = weight * (1.0 - greatest(load(lanes, w, s.side + j), 0.0 * d))
            store(m, slot + 4, load(lanes, m, slot + 4) + off)
            here = next_contact(law, here)
        signal = 2 * contacts * long
        for i in range(n):
            _add(lanes, load(lanes, w, s.first + i), weight, signal, m)
            signal += PLAIN_MOMENTS
        for o in range(outputs.shape[0]):
            y = 0.0 * load(lanes, w, 0)
            for i in range(2 * n):
                if outputs[o, i] != 0.0:
                    y = y + outputs[o, i] * load(lanes, w, 2 * n * node + i)
            _add(lanes, y, weight, signal, m)
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


@nb.njit(**ONCE)
def gather_parts(
    law: Law, base: int, parts: Array, width: float, part: Array, share: float, wave: int,
    near: Array, into: Gathered, w: Array,
) -> None:  # fmt: skip
    """Add one step of one lane, part by part as :func:`split_step` left them in ``parts``."""
    s, own = slots_of(law.code), Law(law.code, law.reads, part)
    here = Gathered(into.outputs, near, into.harmonics, into.moments)
    n, contacts, at = s.n, s.contacts, I64(1)
    for _ in range(I64(parts[0])):
        start, end = parts[at], parts[at + 1]
        at += 2
        if end - start > _SHORTEST:
            for j in range(contacts):
                w[s.side + j] = parts[at + j]
            for i in range(2 * n):
                w[i] = parts[at + contacts + i]
                w[4 * n + i] = parts[at + contacts + 2 * n + i]
            for node in range(3):
                tau = start + 0.5 * node * (end - start)
                row_within(law, base, tau, part, I64(node))
                _waves_within(into.waves, wave, into.harmonics, tau, near, I64(node))
            w[s.h] = width * (end - start)
            w[s.inverse] = 1.0 / w[s.h]
            gather((0.0,), own, I64(0), np.bool_(False), share * (end - start), I64(0), here, w)
        at += contacts + 4 * n
