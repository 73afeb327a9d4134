"""Statistics of every lane, accumulated during the integration without storing time series.

Each step contributes with Simpson's rule: both ends and the middle. The end of one step is the
beginning of the next, which evaluates it anyway, so that only the middle and the ends at events
are evaluated for the statistics; see :mod:`tribodyn.dynamics._engine.midpoint`. A step in which a
contact opens or closes contributes part by part, as the damping force jumps there. The signals and
their order are those of
:mod:`tribodyn.dynamics._engine.statistics`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled.jit import INNER, ONCE
from tribodyn.dynamics._engine.contact_forces import (
    I64,
    acceleration,
    compression,
    first_contact,
    is_dead_zone,
    next_contact,
    set_sides,
    slots_of,
)
from tribodyn.dynamics._engine.crossing import row_within
from tribodyn.dynamics._engine.lanes import Lanes, greatest, least, load, store
from tribodyn.dynamics._engine.method import Law
from tribodyn.dynamics._engine.midpoint import to_middle
from tribodyn.dynamics._engine.statistics import PLAIN_MOMENTS
from tribodyn.types import Array

#: Shorter parts of a step are left out: their rate of change would be mere rounding.
_SHORTEST = 1e-7


class Gathered(NamedTuple):
    """Sums that are accumulated; in kernels with addresses instead of arrays."""

    outputs: Array  #: linear outputs of the state
    waves: Array  #: cosine and sine of every harmonic at the three nodes of every step
    harmonics: int
    moments: Array  #: of all lanes, or of one


class Place(NamedTuple):
    """A step whose signals are added."""

    row: int  #: of its left end in the table
    wave: int  #: of its left end in the cosines and sines
    share: float  #: of the accumulated time
    statistics_slot: int  #: first slot of the data that the step stored


@nb.njit(**INNER)
def _add(lanes: Lanes, left: float, right: float, weights: Array, at: int, m: Array) -> None:
    """Add two values to the plain moments of a signal."""
    heavy, weighted = weights[0] * left, weights[1] * right
    store(m, at, load(lanes, m, at) + heavy + weighted)
    store(m, at + 1, load(lanes, m, at + 1) + heavy * left + weighted * right)
    store(m, at + 2, least(load(lanes, m, at + 2), least(left, right)))
    store(m, at + 3, greatest(load(lanes, m, at + 3), greatest(left, right)))


@nb.njit(**INNER)
def add_nodes(lanes: Lanes, law: Law, place: Place, kind: int, into: Gathered, w: Array) -> None:
    """Add the signals at one or two nodes of a step to the moments.

    Kind 0 is the left end, as right end of the previous step only; 1 the left end as end of both
    steps, and the middle, as the step stored them; 2 the right end; from 3 on a single node.
    """
    s, m, zero = slots_of(law.code), into.moments, 0.0 * load(lanes, w, 0)
    waves, from_step, with_middle = 2 * into.harmonics, kind < 2, kind == 1
    first_node = I64(0) if from_step else I64(2) if kind == 2 else kind - 3
    second_node = I64(1) if with_middle else first_node
    heavy = zero + (4.0 / 6.0 if kind == 4 else 0.0 if kind == 0 else 1.0 / 6.0) * place.share
    if from_step:
        heavy = heavy + load(lanes, w, place.statistics_slot + 3 * s.contacts)
    weights = heavy, zero + (4.0 / 6.0 * place.share if with_middle else 0.0)
    force = place.statistics_slot if from_step else s.force
    far_force, far_side = (
        (s.force, place.statistics_slot + s.contacts) if with_middle else (force, s.side)
    )
    far = s.second if with_middle else s.first
    first = first_contact(law, place.row + first_node * law.code[2], first_node)
    second = first_contact(law, place.row + second_node * law.code[2], second_node)
    for j in range(s.contacts):
        slot = j * (PLAIN_MOMENTS + waves)
        left = compression(lanes, law, first, s.error, w)
        right = compression(lanes, law, second, s.error, w)
        for signal in range(2):
            if signal == 1:
                slot += s.contacts * (PLAIN_MOMENTS + waves)
                left, right = load(lanes, w, force + j), load(lanes, w, far_force + j)
            _add(lanes, left, right, weights, slot, m)
            left, right = weights[0] * left, weights[1] * right
            for item in range(waves):
                at, wave = slot + PLAIN_MOMENTS + item, place.wave + item
                part = into.waves[wave + first_node * waves] * left
                part = part + into.waves[wave + second_node * waves] * right
                store(m, at, load(lanes, m, at) + part)
        if is_dead_zone(law, first):
            off = weights[0] * (1.0 - greatest(load(lanes, w, s.side + j), zero))
            off = off + weights[1] * (1.0 - greatest(load(lanes, w, far_side + j), zero))
            store(m, slot + 4, load(lanes, m, slot + 4) + off)
        first, second = next_contact(law, first), next_contact(law, second)
    slot = 2 * s.contacts * (PLAIN_MOMENTS + waves)
    for i in range(s.n):
        left, right = load(lanes, w, s.first + i), load(lanes, w, far + i)
        _add(lanes, left, right, weights, slot, m)
        slot += PLAIN_MOMENTS
    for o in range(into.outputs.shape[0]):
        left = right = zero
        for i in range(2 * s.n):
            if into.outputs[o, i] != 0.0:
                left = left + into.outputs[o, i] * load(lanes, w, 2 * s.n * first_node + i)
                right = right + into.outputs[o, i] * load(lanes, w, 2 * s.n * second_node + i)
        _add(lanes, left, right, weights, slot, m)
        slot += PLAIN_MOMENTS


@nb.njit(**INNER)
def gather(lanes: Lanes, law: Law, switching: bool, place: Place, into: Gathered, w: Array) -> None:
    """Add one step, whose ends are in buffers 0 and 2, to the moments, node by node."""
    to_middle(lanes, law, place.row + law.code[2], I64(0), w)
    for node in range(3):
        row = place.row + node * law.code[2]
        if switching:
            set_sides(lanes, law, row, node, w)
        acceleration(lanes, law, row, node, slots_of(law.code).first, w)
        add_nodes(lanes, law, place, 3 + node, into, w)


@nb.njit(**INNER)
def _waves_within(
    waves: Array, wave: int, harmonics: int, tau: float, part_waves: Array, node: int
) -> None:
    """Write cosine and sine of every harmonic at a fraction of a step to ``part_waves``."""
    for item in range(0, 2 * harmonics, 2):
        c0, s0 = waves[wave + item], waves[wave + item + 1]
        half = wave + 2 * harmonics + item
        c1, s1 = waves[half], waves[half + 1]
        angle = math.atan2(s0, c0) + 2.0 * tau * math.atan2(s1 * c0 - c1 * s0, c1 * c0 + s1 * s0)
        part_waves[2 * harmonics * node + item] = math.cos(angle)
        part_waves[2 * harmonics * node + item + 1] = math.sin(angle)


@nb.njit(**ONCE)
def gather_parts(
    law: Law, step: Place, parts: Array, width: float, part: Array, part_waves: Array,
    into: Gathered, w: Array,
) -> None:  # fmt: skip
    """Add one step of one lane, part by part as :func:`split_step` listed them in ``parts``."""
    s, part_law = slots_of(law.code), Law(law.code, law.reads, part)
    part_sums = Gathered(into.outputs, part_waves, into.harmonics, into.moments)
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
                row_within(law, step.row, tau, part, I64(node))
                _waves_within(into.waves, step.wave, into.harmonics, tau, part_waves, I64(node))
            w[s.h] = width * (end - start)
            w[s.inverse] = 1.0 / w[s.h]
            part_location = Place(I64(0), I64(0), step.share * (end - start), I64(0))
            gather((0.0,), part_law, np.bool_(False), part_location, part_sums, w)
        at += contacts + 4 * n
