"""Steady motions of many systems alike, side by side, as operating maps ask for them.

While the flanks stay in touch the equations are linear: one march of the start and of a disturbance
of every coordinate gives the orbit, a second one its motion and error, and others at half the step
what the step costs. That is what :func:`tribodyn.dynamics.steady_state` does for one system. Where
anything else happens there is no answer here, and the system is looked at by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.workspace import Memory, new_memory, reused_memory
from tribodyn.dynamics._engine.blocks import WIDTH
from tribodyn.dynamics.equations.alike import (
    evaluate_alike,
    every_other,
    groups_alike,
    rates_alike,
    rows_of,
)
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.grid import build_grid, system_events
from tribodyn.dynamics.equations.nodes import Nodes, halved_grid
from tribodyn.dynamics.equations.step_limit import LIMIT
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.alike_lanes import AlikeLanes, march_cycle
from tribodyn.dynamics.orbits.coordinates import (
    OrbitCoordinates,
    balanced_position,
    orbit_coordinates,
)
from tribodyn.dynamics.orbits.orbit_map import Balance, take_drift_out
from tribodyn.dynamics.orbits.search import APART, GONE, HORIZON, NEWTON_LIMIT
from tribodyn.dynamics.orbits.steady_state import CLOSE, OTHER, ROUNDS, STEP_LIMIT, TOLERANCE
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.errors import InputError, collected
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Steps of all systems that are found together, and the fewest systems that are: rows of more are
#: far from the core, and fewer march one by one.
_STEPS, _FEWEST = 16384, 8


def orbits_in_touch(
    systems: Sequence[System], mesh_frequency: Array, steps: int
) -> list[Callable[[], Response] | None]:
    """Steady motions of one mesh cycle in which no flanks part; None where there is none such.

    Each is sampled where it is called for, as the samples of all would leave the nearest memory.
    """
    found: list[Callable[[], Response] | None] = [None] * len(systems)
    size, groups = max(_FEWEST, _STEPS // steps), groups_alike(systems)
    parts = (group[at : at + size] for group in groups for at in range(0, len(group), size))
    for numbers in parts:
        with collected() as told:
            try:
                alike = [systems[i] for i in numbers]
                group = _Group(alike, mesh_frequency[numbers], steps, reused_memory)
                orbits = _responses(group)
            except InputError:  # which is told where each is looked at by itself
                continue
        if not told:
            for number, orbit in zip(numbers, orbits, strict=True):
                found[number] = orbit
    return found


#: A motion (rows, items, lanes) of the system with a number, and its last states (lanes, 2 n).
_Motion = tuple[int, Array, Array]


class _Group:
    """Maps of systems alike over one mesh cycle, each at its own mesh frequency."""

    def __init__(
        self,
        systems: Sequence[System],
        beat: Array,
        steps: int,
        room: Memory = new_memory,
    ) -> None:
        self.systems, self.system, self.beat = systems, systems[0], beat
        grid = build_grid(system_events(self.system), steps)
        fine = halved_grid(grid)
        nodes = evaluate_alike(systems, fine, room)
        self.halved = AlikeLanes.of(self.system, fine, nodes, room)
        self.whole = self.halved.every_other(grid)
        self.grid, self.nodes = grid, every_other(nodes, grid)
        self.step_numbers = self._step_numbers()
        shared = orbit_coordinates(self.compiled(0), 1.0)
        rate = shared.rate * beat[:, None, None]
        self.coordinates: OrbitCoordinates = replace(shared, rate=rate)
        self.balance = Balance.of(self.system, shared)

    def compiled(self, number: int) -> Compiled:
        """One of the systems, without its rows, which nothing but a march reads."""
        step_number, nodes = float(self.step_numbers[number]), rows_of(self.nodes, number)
        program = self.whole.program
        program = program._replace(constant_load=program.constant_load[number])
        return Compiled(self.systems[number], self.grid, nodes, program, step_number)

    def _step_numbers(self) -> Array:
        """Products ``omega_max * dt`` of the widest steps."""
        known = [system._rates.get(self.grid.steps, np.nan) for system in self.systems]
        looked = not np.isfinite(known).all()
        rates = rates_alike(self.systems, self.nodes) if looked else np.array(known)
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

    def beside(self, points: Array, keep: Callable[[int, Array], None]) -> Array:
        """Images of many points (p, lanes, k) of each system; ``keep`` has their places first."""

        def motions(period: Array, load: Array, state: Array) -> Iterator[_Motion]:
            lanes, size = state.shape[1], self.system.size
            parts = [slice(first, first + WIDTH) for first in range(0, lanes, WIDTH)]
            for number, program in enumerate(self.whole.each_alone()):
                own, times = state[number], np.full(lanes, period[number])
                records: list[Array] = []
                for at in parts:
                    given = program, program.rows, times[at], load[number, at], own[at]
                    shape = self.grid.steps + 1, size, len(own[at])
                    records.append(self.whole.room(f"record {len(records)}", shape))
                    own[at] = march_cycle(*given, records[-1])
                record = records[0] if len(parts) == 1 else np.concatenate(records, axis=-1)
                yield number, record, own

        return self._images(points, motions, keep)

    def march(
        self, on: AlikeLanes, points: Array, which: Index, keep: Callable[[int, Array], None]
    ) -> Array:
        """Images of a point (p, 1, k) of some systems; ``keep`` has its states first."""

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
        """Images of points (p, lanes, k) whose states are marched from states (p, lanes, 2 n)."""
        y = points if self.balance is None else points[..., :-1]
        state, pushed = self.coordinates.expand(y), self.extra(points) @ self.system.inverse_mass.T
        load = self.whole.program.constant_load[:, None] + pushed
        for number, record, end in motions(1.0 / self.beat, load, state):
            keep(number, record)
            state[number] = end
        image = self.coordinates.reduce(state)
        if self.balance is None:
            return image
        gained = self.coordinates.free_velocity(state) @ self.balance.direction
        return np.concatenate((image, points[..., -1:] - gained[..., None]), axis=-1)


class _Touch(NamedTuple):
    """How far the flanks of motions are from parting, at the ends of all steps (p, rows)."""

    room: Array  #: clearance, the lesser of both sides of an event [m]
    flank: Array  #: side of the play (p, 1): 1 or -1

    @classmethod
    def of(cls, nodes: Nodes, along: Array) -> _Touch:
        """Clearance of motions whose displacement along the line of action is known."""
        ends = np.stack((along[:, :-1], along[:, 1:]), axis=-1) - nodes.error[:, :, ::2, 0]
        flank = np.where(ends[:, :1, 0] < 0.0, -1.0, 1.0)
        clear = flank[..., None] * ends - nodes.gap[:, :, ::2, 0]
        room = np.pad(clear[..., 0], ((0, 0), (0, 1)), constant_values=np.inf)
        room[:, 1:] = np.minimum(room[:, 1:], clear[..., 1])
        return cls(room, flank)

    @property
    def kept(self) -> Mask:
        """Whether the flanks of a motion never part."""
        return np.asarray(np.all(self.room > 0.0, axis=1))

    def stays(self, rates: Array, matrix: Array, distance: Array) -> Mask:
        """Whether motions beside orbits reach them without parting; ``rates`` (p, k, rows)."""
        least, kept = self.room.min(axis=1), self.kept
        steepest = np.sqrt(np.einsum("pkr,pkr->pr", rates, rates).max(axis=1))
        first = np.abs(distance[:, None] @ rates)[:, 0].max(axis=1)
        going = kept.copy()
        for _ in range(HORIZON):
            size = steepest * np.linalg.norm(distance, axis=1)
            near = going & (size > least)
            going &= near | (size > GONE * first)
            for number in np.flatnonzero(near):
                moved = distance[number] @ rates[number]
                kept[number] = np.all(self.room[number] + moved > 0.0)
                going[number] = kept[number] and np.abs(moved).max() > GONE * first[number]
            if not going.any():
                break
            distance = _times(matrix, distance)
        return kept


def _times(matrix: Array, vector: Array) -> Array:
    return np.asarray((matrix @ vector[..., None])[..., 0])


def _greatest(rows: Array) -> Array:
    """Greatest size of the vectors (p, rows, k) of each."""
    return np.asarray(np.sqrt(np.einsum("prk,prk->pr", rows, rows).max(axis=1)))


class _Cycles(NamedTuple):
    """Mesh cycles from a point of each system, as distances to the orbits tell; rows of all."""

    point: Array  #: (p, 1, k)
    states: Array  #: (p, rows, 2 n), without drift
    reduced: Array  #: (p, rows, e + v)
    scale: Array  #: size of the motion
    way: Array  #: Newton step to the orbit (p, k)
    error: Array  #: certified; infinite of systems that were not asked for

    @classmethod
    def of(cls, group: _Group, point: Array, which: Index, slope: Array, inverse: Array) -> _Cycles:
        """Cycles of some systems; ``slope`` is one less the matrix of each map (p, k, k)."""
        states = np.empty((len(point), group.grid.steps + 1, 2 * group.system.size))
        states[np.delete(np.arange(len(point)), which)] = 0.0

        def motion(number: int, record: Array) -> None:
            states[number] = record[..., 0]

        residual = (group.march(group.whole, point, which, motion) - point)[:, 0]
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
        """Put the cycles of some systems in place of these."""
        for own, new in zip(self, other, strict=True):
            own[which] = new[which]


class _Orbits(NamedTuple):
    """Orbits of a group; those that are not ``good`` mean nothing."""

    inverse: Array  #: of one less the matrix of the map, (p, k, k)
    cycles: _Cycles
    marched: Index  #: cycles marched to find each
    multipliers: ComplexArray
    good: Mask


def _orbits(group: _Group) -> _Orbits:
    y, nodes, every = group.start(), group.nodes, np.arange(len(group.systems))
    count, steps, size = len(every), group.grid.steps, group.system.size
    k = y.shape[-1]
    step = APART * np.linalg.norm(y, axis=-1, keepdims=True)
    along = group.whole.room("along", (count, k + 1, steps + 1))
    direction = nodes.direction[0, 0, 0, 0]
    used = np.flatnonzero(direction)

    def beside(number: int, record: Array) -> None:
        # All lanes, which lie side by side, though the last ones are only there to fill the block.
        total = direction[used[0]] * record[:, used[0]]
        for i in used[1:]:
            total += direction[i] * record[:, i]
        along[number] = total[:, : k + 1].T

    points = y + step * np.eye(-(-(k + 1) // WIDTH) * WIDTH, k, -1)
    image = group.beside(points, beside)[:, : k + 1]
    # Of motions that end there is no map: any other will do, as they are not good.
    ended = ~np.isfinite(image).all(axis=(1, 2))
    image[ended] = y[ended]
    matrix = np.swapaxes(image[:, 1:] - image[:, :1], 1, 2) / step
    slope = np.eye(k) - matrix
    inverse = np.linalg.pinv(slope)
    touch = _Touch.of(nodes, along[:, 0])
    rates = along[:, 1:]
    rates -= along[:, :1]
    rates *= touch.flank[..., None] / step
    good = touch.kept & np.all(touch.room + step[:, 0] * rates.min(axis=1) > 0.0, axis=1)
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
    held = matrix if group.balance is None else matrix[:, :-1, :-1]
    values = np.linalg.eigvals(held).astype(complex)
    order = np.argsort(-np.abs(values), axis=1, kind="stable")
    multipliers = np.take_along_axis(values, order, axis=1)
    good &= (cycles.error <= TOLERANCE) & (np.abs(multipliers[:, 0]) < 1.0)
    touch = _Touch.of(nodes, cycles.states[..., :size] @ direction)
    good &= touch.stays(rates, matrix, (y - cycles.point)[:, 0])
    return _Orbits(inverse, cycles, marched, multipliers, good)


def _step_errors(group: _Group, orbits: _Orbits) -> Array:
    """Distance of each orbit to that at half the step over its size; NaN where it was not found."""
    known = orbits.cycles
    at, left = known.point.copy(), np.flatnonzero(orbits.good)
    fine, moved = np.full_like(known.reduced, np.nan), np.zeros_like(known.point)
    states, way = group.whole.room("states", known.states.shape), np.full(len(at), np.inf)
    states[~orbits.good] = 0.0

    def every_other(number: int, record: Array) -> None:
        states[number] = record[::2, :, 0]

    for _ in range(ROUNDS):
        if not left.size:
            break
        image = group.march(group.halved, at, left, every_other)
        step = _times(orbits.inverse, (image - at)[:, 0])[:, None]
        last, way = way, np.linalg.norm(step[:, 0], axis=1)
        far = np.linalg.norm((at + step - known.point)[:, 0], axis=1)
        left = left[((way < 0.5 * last) & (far <= OTHER * known.scale))[left]]
        at[left] += step[left]
        near = ((way <= CLOSE * far) | (way <= 1e-9 * known.scale))[left]
        if near.any():
            moved[left[near]] = step[left[near]]
            fine[left[near]] = group.coordinates.reduce(states)[left[near]]
        left = left[~near]
    ended = np.flatnonzero(~np.isnan(fine[:, 0, 0]))

    def coarse(number: int, record: Array) -> None:
        states[number] = record[..., 0]

    # What is left of the way moves both motions alike.
    group.march(group.whole, known.point + moved, ended, coarse)
    fine += group.coordinates.reduce(states) - known.reduced
    return _greatest(fine - known.reduced) / _greatest(fine)


def _responses(group: _Group) -> list[Callable[[], Response] | None]:
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
