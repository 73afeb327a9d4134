"""Motions with small disturbances that are made orthogonal again before they become parallel."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.motion import sides
from tribodyn.dynamics.equations.orbit_coordinates import OrbitCoordinates, orbit_coordinates
from tribodyn.dynamics.orbits.modal_tangent import ModalTangent
from tribodyn.dynamics.orbits.orbit_map import engine_scaling
from tribodyn.nonlinear.lyapunov_tangent import TangentTables, carry_over_crossings
from tribodyn.progress import Progress
from tribodyn.types import Array, Mask

#: Largest number of stored values while disturbances are integrated.
_MOST_VALUES = 6_000_000
#: Mesh cycles of the transient over which disturbances already turn into their directions, and
#: those whose matrices are compared to see whether they repeat.
ALIGN, _COMPARED = 200, 32
#: Difference of matrices that repeat for good, and of the states of a motion that does.
_EXACTLY, _CLOSED = 1e-10, 1e-11
#: Logarithm of the growths of disturbances that need not be apart, and mesh cycles in which those
#: of a motion that repeats are apart, or else their growth is averaged.
_TOGETHER, _TURNS = 14.0, 64


class Carrier:
    """A motion with its orthogonal disturbances."""

    def __init__(self, tables: Any, state: Array, extra: Array) -> None:
        self.tables = tables
        self.extra = extra
        self.state = state[None, :]
        k = tables.size
        self.frame = np.linalg.qr(np.random.default_rng(0).standard_normal((k, k)))[0]
        braked = tables.coordinates.braked
        #: Directions of the speeds of braked free rotations, and how far disturbances lie in them.
        self.braked = np.vstack((np.zeros((k - len(braked), braked.shape[1])), braked))
        self.share = np.zeros(k)
        self.length = self.elapsed = 0
        self.period = 0  #: cycles after which the motion repeats, once that is known
        self.last: deque[Array] = deque(maxlen=_COMPARED)
        #: Frame at the beginning of the last cycles, and how it grew in each.
        self.frames: deque[tuple[Array, Array]] = deque(maxlen=PERIODS)

    def settle(self, cycles: int, progress: Progress) -> int:
        """March without disturbances; returns the cycles that are left for them to turn in."""
        left = min(cycles, ALIGN)
        for first in range(0, cycles - left, ALIGN):
            self.march(min(ALIGN, cycles - left - first))
        progress.advance(cycles - left)
        return left

    def march(self, cycles: int, record: Array | None = None) -> None:
        """Advance the motion without disturbances."""
        frequency = self.tables.mesh_frequency
        state = march(
            self.tables.compiled,
            np.array([1.0 / frequency]),
            self.state,
            cycles,
            extra_force=self.extra[None, :],
            record=record,
            elapsed=self.elapsed,
        )
        self.elapsed += cycles
        # The free rotation runs away and nothing depends on it.
        coordinates = self.tables.coordinates
        self.state = coordinates.expand(coordinates.reduce(state))

    def carry(self, cycles: int, progress: Progress) -> tuple[Array, Array]:
        """Growth of every disturbance and mean trace in each mesh cycle [1/s]."""
        k, done = self.tables.size, 0
        growth, divergence, share = np.zeros((cycles, k)), np.zeros(cycles), np.zeros(k)
        while done < cycles:
            first = done
            for products, trace in self._cycles(cycles - first):
                frame = self.frame
                for product in products:
                    self.frame, upper = np.linalg.qr(product @ self.frame)
                    growth[done] += np.log(np.abs(np.diag(upper)))
                share += share_in(self.braked, self.frame)
                self.frames.append((frame, growth[done]))
                self.last.append(products.copy())
                divergence[done], done = trace, done + 1
            progress.advance(done - first)
            if self.ended(done):
                break
        self.share = share / max(1, done)
        frequency = self.tables.mesh_frequency
        return growth[:done] * frequency, divergence[:done] * frequency

    def ended(self, done: int) -> bool:
        """Whether further mesh cycles than those ``done`` show nothing new."""
        return False

    def _cycles(self, cycles: int) -> Iterator[tuple[Array, float]]:
        """Products of the matrices of some mesh cycles at most, and the integral of the trace."""
        k, steps = self.tables.size, self.tables.compiled.grid.steps
        chunk = max(1, _MOST_VALUES // (steps * (k * k + self.state.shape[1])))
        count = min(chunk, cycles)
        record = np.empty((count * steps + 1, self.state.shape[1], 1))
        self.march(count, record)
        matrices, traces = self._matrices(record[:, :, 0])
        matrices = matrices.reshape(count, steps, k, k)
        self.length = self.length or safe_length(matrices[0])
        yield from zip(
            grouped_products(matrices, self.length),
            traces.reshape(count, steps).sum(axis=1),
            strict=True,
        )

    def _matrices(self, states: Array) -> tuple[Array, Array]:
        """Matrix of every step along recorded states, and the integral of the trace."""
        tables, nodes = self.tables, self.tables.compiled.nodes
        size, steps = self.extra.size, tables.compiled.grid.steps
        place = states[:, :size].reshape(-1, size)

        def sides_at(q: Array, node: int) -> Array:
            q = q.reshape(-1, steps, size)
            d = np.einsum("rji,cri->crj", nodes.direction[:, node], q) - nodes.error[:, node]
            side = sides(d, nodes.gap[:, node], tables.dead)
            return side.reshape(len(q) * steps, d.shape[-1])

        left, right = sides_at(place[:-1], 0), sides_at(place[1:], 2)
        number = np.tile(np.arange(steps), len(left) // steps)
        crossed = np.any(left != right, axis=1)
        touching = left != 0.0
        matrices = np.empty((len(left), tables.size, tables.size))
        traces = np.empty(len(left))
        patterns = touching @ 2.0 ** np.arange(touching.shape[1])
        for pattern, first in zip(*np.unique(patterns, return_index=True), strict=True):
            which = np.flatnonzero(~crossed & (patterns == pattern))
            step_tables = tables.whole_steps(touching[first])
            matrices[which] = step_tables[0][number[which]]
            traces[which] = step_tables[1][number[which]]
        which = np.flatnonzero(crossed)
        if which.size:
            matrices[which], traces[which] = carry_over_crossings(
                tables, self.extra, number[which], states[which], left[which]
            )
        return matrices, traces


class ModalTables(NamedTuple):
    """A system that is integrated in modal coordinates."""

    compiled: Compiled
    mesh_frequency: float
    coordinates: OrbitCoordinates

    @property
    def size(self) -> int:
        """Number of reduced coordinates."""
        return int(self.coordinates.reducing.shape[1])


class ModalCarrier(Carrier):
    """A motion in modal coordinates with its orthogonal disturbances."""

    def __init__(self, tables: ModalTables, state: Array, extra: Array) -> None:
        super().__init__(tables, state, extra)
        compiled, frequency = tables.compiled, tables.mesh_frequency
        self._tangent = ModalTangent(compiled.engine.motion, frequency, np.array(extra))
        self._scale = engine_scaling(compiled, tables.coordinates)
        fastest = float(np.abs(compiled.engine.motion.modes.values.real).max())
        most = max(1, compiled.grid.steps // 2)
        self._sections = min(most, math.ceil(fastest / frequency / math.log(SPREAD)))
        self._place: Array | None = None

    def settle(self, cycles: int, progress: Progress) -> int:
        """March until the motion repeats; if it does not, as far as other motions."""
        begin, reduce = self.state, self.tables.coordinates.reduce
        states = deque([reduce(begin)[0]], maxlen=PERIODS + 1)
        for cycle in range(cycles):
            self.march(1)
            states.append(reduce(self.state)[0])
            distance = np.linalg.norm(np.array(states) - states[-1], axis=1)[-2::-1]
            if distance.min() <= _CLOSED * np.linalg.norm(states[-1]):
                self.period = 1 + int(np.argmax(distance <= _CLOSED * np.linalg.norm(states[-1])))
                progress.advance(cycle + 1)
                return cycles
        self.state, self.elapsed = begin, 0
        return super().settle(cycles, progress)

    def ended(self, done: int) -> bool:
        """Whether further mesh cycles than those ``done`` show nothing new."""
        period = self.period
        if period:
            if len(self.last) < 2 * period:
                return False
            gain = np.sum([gain for _, gain in list(self.frames)[-period:]], axis=0)
            turn = self.frames[-period][0].T @ self.frame
            together = [np.ptp(gain[a:b]) <= _TOGETHER for a, b in pairwise(edges_of(turn))]
            return all(together) or done >= _TURNS
        # Motions that still approach may repeat after several periods by chance, less closely.
        full = len(self.last) == self.last.maxlen
        return full and repeats_after(self.last)[1] <= _EXACTLY

    def _cycles(self, cycles: int) -> Iterator[tuple[Array, float]]:
        if self.period and len(self.last) == 2 * self.period and not repeats_after(self.last)[0]:
            self.period = 0  # what grazes a contact repeats, and its disturbances do not
        if self.period and len(self.last) >= 2 * self.period:
            products = self.last[-self.period]
        else:
            if self._place is None:
                motion = self.tables.compiled.engine.motion
                self._place = motion.state(*np.split(self.state[0], 2))[0]
            tangent = self._tangent.at(self._place, self._sections)
            self._place = tangent.state
            products = np.asarray(np.linalg.solve(self._scale, tangent.products @ self._scale))
        yield products, float(np.linalg.slogdet(products)[1].sum())


def carrier_of(compiled: Compiled, mesh_frequency: float, state: Array, extra: Array) -> Carrier:
    """Carrier of the disturbances of a motion."""
    if compiled.engine is None:
        return Carrier(TangentTables(compiled, mesh_frequency), state, extra)
    coordinates = orbit_coordinates(compiled, mesh_frequency)
    return ModalCarrier(ModalTables(compiled, mesh_frequency, coordinates), state, extra)


#: Mesh cycles after which matrices may repeat, and how closely.
PERIODS, _REPEATS = 16, 1e-8
#: Blocks of the frame are apart when they exchange less than this.
_APART = 1e-10
#: A product whose singular values differ by more loses the small disturbances to rounding.
SPREAD = 1e6


def share_in(directions: Array, disturbances: Array) -> Array:
    """Part of the square of each disturbance (k, m) along orthonormal directions (k, b)."""
    inside = np.abs(directions.T @ disturbances) ** 2
    return np.asarray(inside.sum(axis=0) / (np.abs(disturbances) ** 2).sum(axis=0))


def repeats_after(cycles: Sequence[Array]) -> tuple[int, float]:
    """Return the number of mesh cycles after which the matrices repeat, and the difference."""
    matrices = np.asarray(cycles)
    size = np.linalg.norm(matrices, axis=(-2, -1))
    for period in range(1, min(PERIODS, len(matrices) // 2) + 1):
        distance = (
            np.linalg.norm(matrices[period:] - matrices[:-period], axis=(-2, -1)) / size[period:]
        )
        if distance.max() <= _REPEATS:
            return period, float(distance.max())
    return 0, float("nan")


def edges_of(turn: Array) -> list[int]:
    """Edges of the blocks of a frame that exchange nothing, by how it turns (k, k)."""
    size = turn.shape[0]
    return [0, *(i for i in range(1, size) if np.abs(turn[i:, :i]).max() < _APART), size]


def floquet_growth(
    cycles: Sequence[Array], frame: Array, directions: Array
) -> tuple[Array, Array, Mask]:
    """Growth of disturbances over one period, in the order of the frame; shares in directions."""
    # The mask marks those whose growth is known: others differ too much, and are not apart.
    old, uppers = frame, []
    for product in (product for groups in cycles for product in groups):
        frame, upper = np.linalg.qr(product @ frame)
        uppers.append(upper)
    turn = old.T @ frame
    gain = np.log(np.abs([np.diag(upper) for upper in uppers])).sum(axis=0)
    growth, share, separated = gain.copy(), np.zeros(len(turn)), np.ones(len(turn), dtype=bool)
    for first, last in pairwise(edges_of(turn)):
        block, scale = np.eye(last - first), 0.0
        for upper in uppers:
            block = upper[first:last, first:last] @ block
            norm = float(np.linalg.norm(block))
            block, scale = block / norm, scale + float(np.log(norm))
        values, vectors = np.linalg.eig(turn[first:last, first:last] @ block)
        order = np.argsort(-np.abs(values), kind="stable")
        share[first:last] = share_in(directions, old[:, first:last] @ vectors[:, order])
        separated[first:last] = np.ptp(gain[first:last]) <= 1.5 * _TOGETHER
        if separated[first]:
            growth[first:last] = np.log(np.abs(values[order])) + scale
    return growth, share, separated


def _pairwise(matrices: Array) -> Array:
    """Products of neighbours (cycles, steps, k, k), the later step on the left."""
    if matrices.shape[1] % 2:
        unit = np.broadcast_to(np.eye(matrices.shape[-1]), (len(matrices), 1, *matrices.shape[2:]))
        matrices = np.concatenate((matrices, unit), axis=1)
    return np.asarray(matrices[:, 1::2] @ matrices[:, ::2])


def safe_length(matrices: Array) -> int:
    """Steps that may be multiplied before disturbances are made orthogonal again."""
    product, length = matrices[None], 1
    while product.shape[1] > 1:
        longer = _pairwise(product)
        if not np.all(np.linalg.cond(longer) <= SPREAD):
            break
        product, length = longer, 2 * length
    return length


def grouped_products(matrices: Array, length: int) -> Array:
    """Products of every ``length`` steps of every mesh cycle."""
    while length > 1:
        matrices, length = _pairwise(matrices), length // 2
    return matrices
