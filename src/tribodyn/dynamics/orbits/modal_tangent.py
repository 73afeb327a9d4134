"""Derivative of a motion in modal coordinates by its start, over one period of the clock.

Between two changes of side the disturbance of a motion obeys linear equations: each step of the
engine is exact for a parabola of the forces, which follow from the disturbance at three nodes.
Where a contact opens or closes its damping force jumps, and the disturbance with it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.motion import quadratic_weights
from tribodyn.dynamics.equations.nodes import carried_load, friction_tangent
from tribodyn.dynamics.modal.modal_march import ModalMotion
from tribodyn.types import Array, ComplexArray, Mask

#: Changes of side in a period that are logged at first; parts whose factors are computed together.
_LOGGED, _CHUNK = 1024, 256


class Tangent(NamedTuple):
    """A motion at the end of a period and its derivatives by the start."""

    state: Array  #: at the end (m,)
    products: Array  #: derivative of the state at the end of each section (sections, m, m)
    sums: Array  #: derivative of the integral of the forces over each section (sections, s, m)

    @property
    def matrix(self) -> Array:
        """Derivative of the state at the end of the period (m, m)."""
        matrix: Array = np.eye(self.state.size)
        for product in self.products:
            matrix = product @ matrix
        return matrix


class _Weights(NamedTuple):
    """Weights of a step: of modes and forces in modes and in motions at the contacts."""

    decay: ComplexArray  #: (m,)
    signals: Array  #: of real and imaginary parts of modes in motion and rate at nodes (2 m, 6 r)
    direct: Array  #: of forces at the nodes in motion and rate at the middle and end (4 r, 3 s)
    force: Array  #: of forces at the nodes in real and imaginary parts of modes (3 s, 2 m)


class _Part(NamedTuple):
    """A step or a part of one, with fixed sides."""

    step: int
    begin: float
    end: float
    side: Array  #: of the springs (contacts, springs)
    entries: range  #: of the log at its end


class ModalTangent:
    """Derivatives of the motions of one system under one force at one frequency."""

    def __init__(self, motion: ModalMotion, frequency: float, extra: Array) -> None:
        self.motion, self.frequency, self.extra = motion, frequency, extra
        self.modes, self.rows = motion.modes, motion.rows(frequency, extra)
        self.width = motion.compiled.grid.width / frequency
        self._known: dict[float, _Weights] = {}

    def at(self, state: Array, sections: int = 1) -> Tangent:
        """Integrate a period from a state (m,), and its derivatives over sections of the period."""
        log, nodes, end = self._marched(state)
        parts = list(self._parts(log))
        tangents = self._tangents(parts, nodes)
        ends = np.linspace(0, self.width.size, sections + 1).astype(np.int64)[1:]
        # Disturbances are rows: the parts of their modes are then as real numbers in a row too.
        first = np.ascontiguousarray(self.motion.split(np.eye(state.size)).T)
        z, sums = first.copy(), np.zeros((state.size, self.motion.input.shape[1]))
        square = (sections, state.size, state.size)
        tangent = Tangent(end, np.empty(square), np.empty((sections, *sums.T.shape)))
        number = 0
        for part, slopes, weights in zip(parts, tangents, self._weights(parts), strict=True):
            h = (part.end - part.begin) * float(self.width[part.step])
            forces = _advance(z, weights, slopes).reshape(len(z), 3, -1)
            sums = sums + h * (forces[:, 0] + 4.0 * forces[:, 1] + forces[:, 2]) / 6.0
            for entry in part.entries:
                impulse = self._impulse(log[entry], part, z)
                z, sums = z + impulse @ self.motion.input.T, sums + impulse
            if part.end == 1.0 and part.step + 1 == ends[number]:
                tangent.products[number], tangent.sums[number] = self.motion.joined(z.T), sums.T
                z, sums, number = first.copy(), 0.0 * sums, number + 1
        return tangent

    def _marched(self, state: Array) -> tuple[Array, Array, Array]:
        """Changes of side, motion and rate at the nodes (steps, 3, 2 r), and state at the end."""
        entries = _LOGGED
        while True:
            forces = self.frequency, 1, self.extra, False, entries
            ends, _, trace = self.motion.advance(state, *forces)
            if trace.report[5] <= entries:
                break
            entries = int(trace.report[5])
        first = (self.motion.output @ self.motion.split(state[:, None])).real[:, 0]
        begin = np.concatenate((first[None], trace.contacts[:-1, 1]))
        nodes = np.concatenate((begin[:, None], trace.contacts), axis=1)
        return trace.log[: int(trace.report[5])], nodes, ends[-1]

    def _parts(self, log: Array) -> Iterator[_Part]:
        """Parts of the period between changes of side."""
        side = np.ones(self.motion.contacts.dead.shape)
        steps, entry = log[:, 0].astype(np.int64), 0
        for step in range(self.width.size):
            begin = 0.0
            while entry < len(log) and steps[entry] == step:
                at, before = float(log[entry, 1]), side.copy()
                together = (steps[entry:] == step) & (log[entry:, 1] == at)
                same = entry + int(np.count_nonzero(together))
                for _, _, contact, spring, new in log[entry:same, :5]:
                    side[int(contact), int(spring)] = new
                if at > begin:
                    yield _Part(step, begin, at, before, range(entry, same))
                    begin = at
                entry = same
            if begin < 1.0:
                yield _Part(step, begin, 1.0, side.copy(), range(0))

    def _tangents(self, parts: list[_Part], nodes: Array) -> Array:
        """Forces per motion and rate at the nodes of parts, (parts, 3, s, 2 r)."""
        step = np.array([part.step for part in parts])
        fraction = np.array([(p.begin, 0.5 * (p.begin + p.end), p.end) for p in parts])
        at = _parabola(fraction)
        rows = np.einsum("pnk,pki->pni", at, self.rows[step])
        entries = self._entries(rows)
        side = np.stack([part.side for part in parts])[:, None]
        return self._slope(entries, side, np.einsum("pnk,pki->pni", at, nodes[step]))

    def _entries(self, rows: Array) -> list[Array]:
        """Entries of rows (..., row) by kind."""
        shapes = self.motion.shapes
        ends = np.cumsum([int(np.prod(shape)) for shape in shapes])[:-1]
        parts = np.split(rows, ends, axis=-1)
        return [
            part.reshape(*rows.shape[:-1], *shape)
            for part, shape in zip(parts, shapes, strict=True)
        ]

    def _slope(self, entries: list[Array], side: Array, nodes: Array) -> Array:
        """Minus forces per motion and rate, from motions and rates ``nodes`` (..., 2 r)."""
        spring, damper = self._springs(entries, side)
        along, turning = entries[5], entries[6]
        push = self._push(entries, spring, damper, side, nodes)
        place = spring[..., None] * along + damper[..., None] * turning
        each = np.concatenate((place, damper[..., None] * along), axis=-1)
        return np.asarray(self.modes.mean.T - np.swapaxes(push, -1, -2) @ each)

    def _springs(self, entries: list[Array], side: Array) -> tuple[Array, Array]:
        """Stiffness and damping of the contacts in force."""
        spring = (np.abs(side) * entries[0]).sum(axis=-1)
        touching = (side[..., 0] != 0.0) | (self.motion.contacts.damped_in_gap != 0.0)
        return spring, np.where(touching, entries[1], 0.0)

    def _push(
        self, entries: list[Array], spring: Array, damper: Array, side: Array, nodes: Array
    ) -> Array:
        """Generalized force per change of each contact force, with friction."""
        system, push = self.motion.compiled.system, entries[7]
        if not system.frictions:
            return push
        stiffness, _, error, slope, gap, along, turning = entries[:7]
        y, rate = np.split(nodes, 2, axis=-1)
        d = (along @ y[..., None])[..., 0] - error
        speed = (along @ rate[..., None] + turning @ y[..., None])[..., 0] - slope
        force = (np.abs(side) * stiffness * (d[..., None] - side * gap)).sum(axis=-1)
        load = carried_load(system, force + damper * speed)
        ratio = friction_tangent(system, entries[10], load)
        members = self.motion.contacts.members
        return np.asarray(push + np.einsum("...f,fj,...fs->...js", ratio, members, entries[9]))

    def _weights(self, parts: list[_Part]) -> Iterator[_Weights]:
        """Weights of parts of steps; those of whole steps are cached."""
        for first in range(0, len(parts), _CHUNK):
            chunk = parts[first : first + _CHUNK]
            width = np.array([(p.end - p.begin) * self.width[p.step] for p in chunk])
            keys = [round(float(h), 18) for h in width]
            new = [i for i, key in enumerate(keys) if key not in self._known]
            factors = dict(zip(new, _factors(self.modes.values, width[new]), strict=True))
            for i, (part, key) in enumerate(zip(chunk, keys, strict=True)):
                weights = self._known.get(key) or _step_weights(self.motion, factors[i])
                if part.end - part.begin == 1.0:
                    self._known[key] = weights
                yield weights

    def _impulse(self, entry: Array, part: _Part, z: ComplexArray) -> Array:
        """Forces of the delay of a disturbance where the first spring of a contact changes."""
        tau, contact, spring = float(entry[1]), int(entry[2]), int(entry[3])
        contacts = self.motion.contacts
        r, none = len(self.motion.output) // 2, np.zeros((len(z), self.motion.input.shape[1]))
        if spring or contacts.damped_in_gap[contact]:
            return none
        table = self.rows[part.step]
        entries = self._entries(_parabola(np.array(tau)) @ table)
        slope = np.array([4.0 * tau - 3.0, 4.0 - 8.0 * tau, 4.0 * tau - 1.0])
        gap_rate = (slope @ self._entries(table)[4][:, contact, 0]) / self.width[part.step]
        y, rate = entry[5 : 5 + r], entry[5 + r :]
        along, turning = entries[5][contact], entries[6][contact]
        speed = float(along @ rate + turning @ y - entries[3][contact])
        flank = 1.0 if float(along @ y) > entries[2][contact] else -1.0
        relative = speed - flank * float(gap_rate)
        if relative == 0.0:
            return none
        closing = 1.0 if part.side[contact, 0] == 0.0 else -1.0
        strength = closing * entries[1][contact] * speed / relative
        damped = self._springs(entries, part.side)
        push = self._push(entries, *damped, part.side, entry[5:])[contact]
        felt = (z @ (along @ self.motion.output[:r])).real
        return np.asarray(-strength * np.outer(felt, push))


def _parabola(tau: Array) -> Array:
    """Weights of three nodes at fractions of a step (..., 3)."""
    return np.stack(quadratic_weights(tau), axis=-1)


def _advance(z: ComplexArray, weights: _Weights, tangent: Array) -> Array:
    """Take disturbances of the modes (k, m) to the end of a part; those of the forces (k, 3 s)."""
    signals = z.view(float) @ weights.signals
    r2, s = tangent.shape[2], tangent.shape[1]
    first = signals[:, :r2] @ tangent[0].T
    later = np.zeros((2 * s, 2 * r2))
    later[:s, :r2], later[s:, r2:] = tangent[1], tangent[2]
    direct = later @ weights.direct
    right = later @ signals[:, r2:].T + direct[:, :s] @ first.T
    others = np.linalg.solve(np.eye(2 * s) - direct[:, s:], right)
    forces = np.concatenate((first, others.T), axis=1)
    z *= weights.decay
    parts = z.view(float)
    parts += forces @ weights.force
    return forces


def _step_weights(motion: ModalMotion, factors: ComplexArray) -> _Weights:
    """Weights of a step, as those of the engine, from its factors (8, m)."""
    output, size = motion.output, motion.input.shape[1]
    half, full = factors[0], factors[4]
    inner, force = (
        (factors[at : at + 3, None] * motion.input.T).reshape(3 * size, -1).view(float)
        for at in (1, 5)
    )
    signals = np.conj(np.concatenate((output, output * half, output * full))).view(float)
    direct = np.concatenate((signals[: len(output)] @ inner.T, signals[: len(output)] @ force.T))
    return _Weights(full, signals.T, direct, force)


def _factors(values: ComplexArray, width: Array) -> ComplexArray:
    """Factors of modes in steps (n,), at the middle and the end: of modes, forces (n, 8, m)."""
    h = width[:, None]
    factors = np.empty((width.size, 8, values.size), dtype=complex)
    factors[:, 0], (begin, middle, end) = _integrals(0.5 * h * values)
    factors[:, 1] = 0.5 * h * (begin - 1.5 * middle + end)
    factors[:, 2], factors[:, 3] = h * (middle - end), 0.5 * h * (end - 0.5 * middle)
    factors[:, 4], (first, second, third) = _integrals(h * values)
    factors[:, 5] = h * (first - 3.0 * second + 4.0 * third)
    factors[:, 6], factors[:, 7] = h * (4.0 * second - 8.0 * third), h * (4.0 * third - second)
    return factors


def _integrals(x: ComplexArray) -> tuple[ComplexArray, tuple[ComplexArray, ...]]:
    """``exp(x)`` and the integrals of ``exp((1 - s) x) s^k/k!`` for k = 0, 1, 2."""
    series, term = np.zeros_like(x), np.full_like(x, 1.0 / 6.0)
    for k in range(4, 22):
        series, term = series + term, term * x / k
    small: Mask = np.abs(x) < 1.0
    divisor = np.where(small, 1.0, x)
    second = 0.5 + x * series
    expanded = (1.0 + x * (1.0 + x * second), 1.0 + x * second, second, series)
    step = np.exp(x)
    first = (step - 1.0) / divisor
    far_second = (first - 1.0) / divisor
    far = (step, first, far_second, (far_second - 0.5) / divisor)
    exponential, *parts = (np.where(small, a, b) for a, b in zip(expanded, far, strict=True))
    return exponential, tuple(parts)
