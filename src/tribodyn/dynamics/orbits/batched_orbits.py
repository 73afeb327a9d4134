"""Steady motions of a batch of systems with the same structure, as operating maps need them.

While the flanks stay in contact the equations are linear: one integration of the start and of a
disturbance of every coordinate gives the orbit, a second one its motion and error, and others at
half the step the step error. That is what :func:`tribodyn.dynamics.steady_state` does for one
system. In all other cases there is no result, and the caller computes the system alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.memory import Memory, new_memory, reused_memory
from tribodyn.dynamics._engine.blocks import WIDTH
from tribodyn.dynamics.equations.balanced import balanced_position
from tribodyn.dynamics.equations.batched_tables import (
    batch_rates,
    coarsen_nodes,
    evaluate_batch,
    group_by_structure,
    rows_of_system,
)
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.grid import build_grid, system_events
from tribodyn.dynamics.equations.nodes import Nodes, halved_grid
from tribodyn.dynamics.equations.orbit_coordinates import (
    Balance,
    OrbitCoordinates,
    orbit_coordinates,
)
from tribodyn.dynamics.equations.step_limit import LIMIT
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.harmonic_balance import STEP_LIMIT, TOLERANCE
from tribodyn.dynamics.orbits.orbit_map import image_of, take_drift_out
from tribodyn.dynamics.orbits.periods import BatchedLanes, march_cycle
from tribodyn.dynamics.orbits.search import APART, GONE, HORIZON, NEWTON_LIMIT
from tribodyn.dynamics.orbits.steady_state import CLOSE, OTHER, ROUNDS
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.errors import InputError, collected
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Steps of all systems of a batch, and the fewest systems of a batch: rows of more do not fit into
#: the cache, and fewer are integrated one by one.
_STEPS, _FEWEST = 16384, 8


def orbits_in_touch(
    systems: Sequence[System], mesh_frequency: Array, steps: int
) -> list[Callable[[], Response] | None]:
    """Steady motions of one mesh cycle without loss of contact; None if there is none.

    Each result is a function that samples its motion, as the samples of all exceed the cache.
    """
    responses: list[Callable[[], Response] | None] = [None] * len(systems)
    size, groups = max(_FEWEST, _STEPS // steps), group_by_structure(systems)
    parts = (group[at : at + size] for group in groups for at in range(0, len(group), size))
    for numbers in parts:
        with collected() as warnings:
            try:
                batch = [systems[i] for i in numbers]
                group = SystemBatch(batch, mesh_frequency[numbers], steps, reused_memory)
                orbits = _responses(group)
            except InputError:  # reported when the caller computes each system alone
                continue
        if not warnings:
            for number, orbit in zip(numbers, orbits, strict=True):
                responses[number] = orbit
    return responses


#: A motion (rows, items, lanes) of the system with a number, and its last states (lanes, 2 n).
_Motion = tuple[int, Array, Array]


class SystemBatch:
    """Maps of a batch of systems over one mesh cycle, each at its mesh frequency."""

    def __init__(
        self,
        systems: Sequence[System],
        beat: Array,
        steps: int,
        memory: Memory = new_memory,
    ) -> None:
        self.systems, self.system, self.beat = systems, systems[0], beat
        grid = build_grid(system_events(self.system), steps)
        fine = halved_grid(grid)
        nodes = evaluate_batch(systems, fine, memory)
        self.halved = BatchedLanes.of(self.system, fine, nodes, memory)
        self.full_steps = self.halved.coarsened(grid)
        self.grid, self.nodes = grid, coarsen_nodes(nodes, grid)
        self.step_numbers = self._step_numbers()
        shared = orbit_coordinates(self.compiled(0), 1.0)
        rate = shared.rate * beat[:, None, None]
        self.coordinates: OrbitCoordinates = replace(shared, rate=rate)
        self.balance = Balance.of(self.system, shared)

    def compiled(self, number: int) -> Compiled:
        """One of the systems, without its rows, which only the integration reads."""
        step_number, nodes = float(self.step_numbers[number]), rows_of_system(self.nodes, number)
        program = self.full_steps.program
        program = program._replace(constant_load=program.constant_load[number])
        return Compiled(self.systems[number], self.grid, nodes, program, step_number)

    def _step_numbers(self) -> Array:
        """Products ``omega_max * dt`` of the widest steps."""
        cached_rates = [system._rates.get(self.grid.steps, np.nan) for system in self.systems]
        incomplete = not np.isfinite(cached_rates).all()
        rates = batch_rates(self.systems, self.nodes) if incomplete else np.array(cached_rates)
        return np.asarray(rates * float(self.grid.width.max()) / self.beat)

    def start(self) -> Array:
        """Points (p, 1, k) at rest under the mean loads."""
        nodes = self.nodes
        place = balanced_position(self.system, nodes, nodes.stiffness, nodes.force_direction)
        y = self.coordinates.reduce(np.concatenate((place, 0.0 * place), axis=-1)[:, None])
        return y if self.balance is None else np.concatenate((y, 0.0 * y[..., :1]), axis=-1)

    def extra(self, points: Array) -> Array:
        """Balancing force (p, lanes, n) of points."""
        if self.balance is None:
            return np.zeros((*points.shape[:-1], self.system.size))
        return np.asarray(points[..., -1:] * self.beat[:, None, None] * self.balance.force)

    def march_points(self, points: Array, keep: Callable[[int, Array], None]) -> Array:
        """Images of many points (p, lanes, k) of each system; ``keep`` receives the positions."""

        def motions(period: Array, load: Array, state: Array) -> Iterator[_Motion]:
            lanes, size = state.shape[1], self.system.size
            parts = [slice(first, first + WIDTH) for first in range(0, lanes, WIDTH)]
            for number, program in enumerate(self.full_steps.each_alone()):
                states, times = state[number], np.full(lanes, period[number])
                records: list[Array] = []
                for at in parts:
                    lane_arrays = program, program.rows, times[at], load[number, at], states[at]
                    shape = self.grid.steps + 1, size, len(states[at])
                    records.append(self.full_steps.memory(f"record {len(records)}", shape))
                    states[at] = march_cycle(*lane_arrays, records[-1])
                record = records[0] if len(parts) == 1 else np.concatenate(records, axis=-1)
                yield number, record, states

        return self._images(points, motions, keep)

    def march(
        self, on: BatchedLanes, points: Array, which: Index, keep: Callable[[int, Array], None]
    ) -> Array:
        """Images of a point (p, 1, k) of some systems; ``keep`` receives the states."""

        def motions(period: Array, load: Array, state: Array) -> Iterator[_Motion]:
            for number, record in on.march(period, load[:, 0], state, which):
                yield number, record, record[-1].T

        return self._images(points, motions, keep)

    def _images(
        self,
        points: Array,
        motions: Callable[[Array, Array, Array], Iterator[_Motion]],
        keep: Callable[[int, Array], None],
    ) -> Array:
        """Images of points (p, lanes, k), integrated by ``motions``."""
        y = points if self.balance is None else points[..., :-1]
        state, pushed = self.coordinates.expand(y), self.extra(points) @ self.system.inverse_mass.T
        load = self.full_steps.program.constant_load[:, None] + pushed
        for number, record, end in motions(1.0 / self.beat, load, state):
            keep(number, record)
            state[number] = end
        return image_of(self.coordinates, self.balance, points, state)


def _keep_in(states: Array, every: int = 1) -> Callable[[int, Array], None]:
    """Function that takes the rows of a motion (rows, 2 n, 1) of a system into ``states``."""

    def keep(number: int, record: Array) -> None:
        states[number] = record[::every, :, 0]

    return keep


class _Touch(NamedTuple):
    """Clearance of the flanks of motions from separation, at the ends of all steps (p, rows)."""

    clearance: Array  #: clearance, the lesser of both sides of an event [m]
    flank: Array  #: side of the play (p, 1): 1 or -1

    @classmethod
    def of(cls, nodes: Nodes, along: Array) -> _Touch:
        """Clearance of motions whose displacement along the line of action is known."""
        ends = np.stack((along[:, :-1], along[:, 1:]), axis=-1) - nodes.error[:, :, ::2, 0]
        flank = np.where(ends[:, :1, 0] < 0.0, -1.0, 1.0)
        clear = flank[..., None] * ends - nodes.gap[:, :, ::2, 0]
        clearance = np.pad(clear[..., 0], ((0, 0), (0, 1)), constant_values=np.inf)
        clearance[:, 1:] = np.minimum(clearance[:, 1:], clear[..., 1])
        return cls(clearance, flank)

    @property
    def in_touch(self) -> Mask:
        """Whether the flanks of a motion never separate."""
        return np.asarray(np.all(self.clearance > 0.0, axis=1))

    def stays(self, rates: Array, matrix: Array, distance: Array) -> Mask:
        """Whether motions near orbits approach them in contact; ``rates`` (p, k, rows)."""
        least, in_touch = self.clearance.min(axis=1), self.in_touch
        steepest = np.sqrt(np.einsum("pkr,pkr->pr", rates, rates).max(axis=1))
        first = np.abs(distance[:, None] @ rates)[:, 0].max(axis=1)
        going = in_touch.copy()
        for _ in range(HORIZON):
            size = steepest * np.linalg.norm(distance, axis=1)
            close = going & (size > least)
            going &= close | (size > GONE * first)
            for number in np.flatnonzero(close):
                moved = distance[number] @ rates[number]
                in_touch[number] = np.all(self.clearance[number] + moved > 0.0)
                going[number] = in_touch[number] and np.abs(moved).max() > GONE * first[number]
            if not going.any():
                break
            distance = _times(matrix, distance)
        return in_touch


def _times(matrix: Array, vector: Array) -> Array:
    return np.asarray((matrix @ vector[..., None])[..., 0])


def _greatest(rows: Array) -> Array:
    """Greatest size of the vectors (p, rows, k) of each."""
    return np.asarray(np.sqrt(np.einsum("prk,prk->pr", rows, rows).max(axis=1)))


class _Cycles(NamedTuple):
    """Mesh cycles from a point of each system, with the distance to its orbit."""

    point: Array  #: (p, 1, k)
    states: Array  #: (p, rows, 2 n), without drift
    reduced: Array  #: (p, rows, e + v)
    scale: Array  #: size of the motion
    way: Array  #: Newton step to the orbit (p, k)
    error: Array  #: certified; infinite for systems that were not requested

    @classmethod
    def of(
        cls, group: SystemBatch, point: Array, which: Index, slope: Array, inverse: Array
    ) -> _Cycles:
        """Cycles of some systems; ``slope`` is one minus the matrix of each map (p, k, k)."""
        states = np.empty((len(point), group.grid.steps + 1, 2 * group.system.size))
        states[np.delete(np.arange(len(point)), which)] = 0.0

        image = group.march(group.full_steps, point, which, _keep_in(states))
        residual = (image - point)[:, 0]
        way = _times(inverse, residual)
        distance = np.linalg.norm(way, axis=1)
        distance += np.linalg.norm(residual - _times(slope, way), axis=1)
        phase = np.append(group.nodes.phase[0, :, 0], 1.0)
        take_drift_out(group.coordinates, phase[:, None] / group.beat[:, None, None], states)
        reduced = group.coordinates.reduce(states)
        scale, error = _greatest(reduced), np.full(len(point), np.inf)
        error[which] = distance[which] / scale[which]
        return cls(point, states, reduced, scale, way, error)

    def take(self, other: _Cycles, which: Mask) -> None:
        """Replace the cycles of some systems by those of ``other``."""
        for values, new in zip(self, other, strict=True):
            values[which] = new[which]


class _Orbits(NamedTuple):
    """Orbits of a batch; those that are not ``good`` are invalid."""

    inverse: Array  #: of one minus the matrix of the map, (p, k, k)
    cycles: _Cycles
    marched: Index  #: integrated cycles of each
    multipliers: ComplexArray
    good: Mask


def _orbits(group: SystemBatch) -> _Orbits:
    y, nodes, every = group.start(), group.nodes, np.arange(len(group.systems))
    count, steps, size = len(every), group.grid.steps, group.system.size
    k = y.shape[-1]
    step = APART * np.linalg.norm(y, axis=-1, keepdims=True)
    along = group.full_steps.memory("along", (count, k + 1, steps + 1))
    direction = nodes.direction[0, 0, 0, 0]
    used = np.flatnonzero(direction)

    def store_displacement(number: int, record: Array) -> None:
        # All lanes, as they are contiguous, though the last ones only fill the block.
        total = direction[used[0]] * record[:, used[0]]
        for i in used[1:]:
            total += direction[i] * record[:, i]
        along[number] = total[:, : k + 1].T

    points = y + step * np.eye(-(-(k + 1) // WIDTH) * WIDTH, k, -1)
    image = group.march_points(points, store_displacement)[:, : k + 1]
    # Motions that end have no map: replace it by any other, as they are not good.
    ended = ~np.isfinite(image).all(axis=(1, 2))
    image[ended] = y[ended]
    matrix = np.swapaxes(image[:, 1:] - image[:, :1], 1, 2) / step
    slope = np.eye(k) - matrix
    inverse = np.linalg.pinv(slope)
    touch = _Touch.of(nodes, along[:, 0])
    rates = along[:, 1:]
    rates -= along[:, :1]
    rates *= touch.flank[..., None] / step
    good = touch.in_touch & np.all(touch.clearance + step[:, 0] * rates.min(axis=1) > 0.0, axis=1)
    point = y + _times(inverse, (image[:, :1] - y)[:, 0])[:, None]
    cycles, marched = _Cycles.of(group, point, every, slope, inverse), np.full(count, 2)
    left = good.copy()
    for _ in range(NEWTON_LIMIT):
        left &= cycles.error > 0.01 * TOLERANCE
        if not left.any():
            break
        again = cycles.point + cycles.way[:, None]
        trial = _Cycles.of(group, again, np.flatnonzero(left), slope, inverse)
        marched[left] += 1
        left &= trial.error < 0.5 * cycles.error
        cycles.take(trial, left)
    state_matrix = matrix if group.balance is None else matrix[:, :-1, :-1]
    values = np.linalg.eigvals(state_matrix).astype(complex)
    order = np.argsort(-np.abs(values), axis=1, kind="stable")
    multipliers = np.take_along_axis(values, order, axis=1)
    good &= (cycles.error <= TOLERANCE) & (np.abs(multipliers[:, 0]) < 1.0)
    touch = _Touch.of(nodes, cycles.states[..., :size] @ direction)
    good &= touch.stays(rates, matrix, (y - cycles.point)[:, 0])
    return _Orbits(inverse, cycles, marched, multipliers, good)


def _step_errors(group: SystemBatch, orbits: _Orbits) -> Array:
    """Distance of each orbit to that at half the step over its size; NaN without convergence."""
    cycles = orbits.cycles
    at, left = cycles.point.copy(), np.flatnonzero(orbits.good)
    fine, moved = np.full_like(cycles.reduced, np.nan), np.zeros_like(cycles.point)
    states, way = group.full_steps.memory("states", cycles.states.shape), np.full(len(at), np.inf)
    states[~orbits.good] = 0.0

    for _ in range(ROUNDS):
        if not left.size:
            break
        image = group.march(group.halved, at, left, _keep_in(states, 2))
        step = _times(orbits.inverse, (image - at)[:, 0])[:, None]
        last, way = way, np.linalg.norm(step[:, 0], axis=1)
        far = np.linalg.norm((at + step - cycles.point)[:, 0], axis=1)
        left = left[((way < 0.5 * last) & (far <= OTHER * cycles.scale))[left]]
        at[left] += step[left]
        close = ((way <= CLOSE * far) | (way <= 1e-9 * cycles.scale))[left]
        if close.any():
            moved[left[close]] = step[left[close]]
            fine[left[close]] = group.coordinates.reduce(states)[left[close]]
        left = left[~close]
    ended = np.flatnonzero(~np.isnan(fine[:, 0, 0]))

    # The remaining distance shifts both motions by the same amount.
    group.march(group.full_steps, cycles.point + moved, ended, _keep_in(states))
    fine += group.coordinates.reduce(states) - cycles.reduced
    return _greatest(fine - cycles.reduced) / _greatest(fine)


def _responses(group: SystemBatch) -> list[Callable[[], Response] | None]:
    orbits = _orbits(group)
    cost, cycles = _step_errors(group, orbits), orbits.cycles
    extra = group.extra(cycles.point)[:, 0]

    def response(number: int) -> Response:
        return build_response(
            group.compiled(number),
            float(group.beat[number]),
            cycles.states[number],
            extra[number],
            error=max(float(cycles.error[number]), float(np.finfo(float).eps)),
            step_error=float(cost[number]),
            converged=True,
            floquet_multipliers=orbits.multipliers[number],
            cycles_used=int(orbits.marched[number]),
            search_cycles=1,
            period=1,
        )

    good = orbits.good & (cost <= STEP_LIMIT) & (group.step_numbers <= LIMIT)
    return [partial(response, number) if good[number] else None for number in range(len(good))]
