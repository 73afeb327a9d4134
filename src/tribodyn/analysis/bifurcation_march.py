"""The motions behind a bifurcation diagram: one after the other, or many side by side."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tribodyn.analysis.poincare import repeat_period
from tribodyn.dynamics.coordinates import orbit_coordinates
from tribodyn.dynamics.march import Compiled, march
from tribodyn.dynamics.orbit_map import OrbitMap
from tribodyn.dynamics.program import compile_system
from tribodyn.dynamics.start import static_start
from tribodyn.dynamics.step_limit import largest_rate
from tribodyn.dynamics.system import System
from tribodyn.errors import ComputationError
from tribodyn.progress import Progress

__all__ = ["Plan", "Point", "Values", "compile_unchecked", "march_points", "march_sweep"]

Array = NDArray[np.float64]

#: Statistics of a signal without harmonics: mean, mean square, minimum, maximum, share off flank.
_PLAIN = 5
#: Parts of the transient after which the balancing torque is adjusted.
_ADJUSTMENTS = 12
#: Mesh cycles between two looks at whether all motions repeat, and how closely they then do.
_PART = 16
_SETTLED = 1e-9


@dataclass(frozen=True)
class Plan:
    """What to do at every value of the parameter.

    Parameters
    ----------
    transient, cycles, keep : int
        Mesh cycles before, those of the statistics, and the last of them whose points are kept.
        Motions that repeat after every cycle to 1e-9 are marched no longer than that takes.
    signal : int or str
        Contact whose compression is looked at, or name of a coordinate.
    """

    transient: int
    cycles: int
    keep: int
    signal: int | str


@dataclass(frozen=True)
class Point:
    """What came of one value of the parameter.

    Parameters
    ----------
    points : (keep,) array
        The signal once per mesh cycle [m or rad].
    period : int
        Mesh cycles after which the motion repeats; 0 if it does not.
    rms : float
        Alternating rms of the signal [m or rad].
    contact_loss_share : float
        Part of the time off the driving flank [-].
    first, last : (2 n,) array
        State at the beginning and at the end [mixed].
    extra_force : (n,) array
        Generalized force that balanced the drive [N or N*m].
    """

    points: Array
    period: int
    rms: float
    contact_loss_share: float
    first: Array
    last: Array
    extra_force: Array


def compile_unchecked(system: System, mesh_frequency: float, steps: int) -> Compiled:
    """Compile a system without refusing a long step; whoever calls has to look at its number.

    Parameters
    ----------
    system : System
        The structure and its contacts.
    mesh_frequency : float
        Mesh frequency [Hz].
    steps : int
        Steps per mesh cycle.

    Returns
    -------
    Compiled
        With ``step_number``, which may exceed the limit of the integrator.

    Examples
    --------
    >>> compile_unchecked(System([[1.0]], [[0.0]], [[1e4]], [0.0]), 1.0, 20).step_number
    5.0
    """
    grid, nodes, program = compile_system(system, steps)
    number = largest_rate(system, nodes) * float(grid.width.max()) / mesh_frequency
    return Compiled(system, grid, nodes, program, number)


class Values:
    """Systems, mesh frequencies and steps of all values of the parameter.

    Parameters
    ----------
    systems : sequence of System
        One for each value.
    mesh_frequency : (points,) array
        Mesh frequency [Hz].
    steps : (points,) int array
        Steps per mesh cycle.
    """

    def __init__(
        self, systems: Sequence[System], mesh_frequency: Array, steps: NDArray[np.int64]
    ) -> None:
        self.systems, self.mesh_frequency, self.steps = list(systems), mesh_frequency, steps
        self.count = len(self.systems)
        same = all(item is self.systems[0] for item in self.systems)
        self.shared: Compiled | None = None
        if same and np.all(steps == steps[0]):
            slowest = float(mesh_frequency.min())
            self.shared = compile_unchecked(self.systems[0], slowest, int(steps[0]))
        self.step_number = np.zeros(self.count)
        if self.shared is not None:
            self.step_number = self.shared.step_number * mesh_frequency.min() / mesh_frequency

    def at(self, number: int) -> Compiled:
        """Compile the system of one value, and note its ``omega_max * dt``.

        Parameters
        ----------
        number : int
            Which value.

        Returns
        -------
        Compiled
        """
        if self.shared is not None:
            return self.shared
        beat, steps = float(self.mesh_frequency[number]), int(self.steps[number])
        found = compile_unchecked(self.systems[number], beat, steps)
        self.step_number[number] = found.step_number
        return found


class _Group:
    """Motions of one system side by side, which differ in mesh frequency and start."""

    def __init__(self, compiled: Compiled, frequency: Array, plan: Plan, threads: int) -> None:
        self.compiled, self.plan, self.threads = compiled, plan, threads
        self.frequency = frequency
        self.coordinates = orbit_coordinates(compiled, float(frequency.min()))
        system = compiled.system
        self.extra = np.zeros((frequency.size, system.size))
        self.balance = None
        if system.balance is not None:
            self.balance = OrbitMap(compiled, float(frequency.min()), 1).balance
        self.scale = float(np.abs(compiled.nodes.force).max(initial=0.0))
        self.outputs = np.zeros((1, 2 * system.size))
        if isinstance(plan.signal, str):
            self.outputs[0, tuple(system.names).index(plan.signal)] = 1.0

    def march(self, state: Array, cycles: int, moments: Array | None = None) -> Array:
        """March by whole mesh cycles; the free rotation, on which nothing depends, is left out."""
        state = march(
            self.compiled, 1.0 / self.frequency, state, cycles, extra_force=self.extra,
            outputs=self.outputs, moments=moments, threads=self.threads,
        )  # fmt: skip
        if self.balance is not None and moments is None:
            direction, force, _ = self.balance
            gained = self.coordinates.free_velocity(state) @ direction
            self.extra -= np.outer(gained * self.frequency / cycles, force)
        return self.coordinates.expand(self.coordinates.reduce(state))

    def settle(self, state: Array) -> tuple[Array, bool]:
        """March over the transient; stops early, and says so, if all lanes repeat every cycle."""
        left = self.plan.transient
        part = max(_PART, left // _ADJUSTMENTS)
        while left > 0:
            here = min(part, left)
            if here > 1:
                state = self.march(state, here - 1)
            old, force = self.coordinates.reduce(state), self.extra.copy()
            state = self.march(state, 1)
            left -= here
            with np.errstate(over="ignore", invalid="ignore"):
                change = np.abs(self.coordinates.reduce(state) - old).max(axis=1)
            steady = change <= _SETTLED * np.abs(old).max(axis=1)
            force_change = np.abs(self.extra - force).max(initial=0.0)
            if np.all(steady) and force_change <= _SETTLED * self.scale:
                return state, True
        return state, False

    def signal(self, state: Array) -> Array:
        """Compression of the contact, or the coordinate, at the mesh phase 0, (lanes,)."""
        if isinstance(self.plan.signal, str):
            return np.asarray(state @ self.outputs[0])
        nodes, j = self.compiled.nodes, self.plan.signal
        place = state[:, : self.extra.shape[1]]
        return np.asarray(place @ nodes.direction[0, 0, j] - nodes.error[0, 0, j])

    def run(self, first: Array) -> list[Point]:
        """March all lanes; raises ComputationError if one of them grows beyond all bounds."""
        plan, lanes, size = self.plan, len(first), self.extra.shape[1]
        contacts = len(self.compiled.system.contacts)
        state, settled = self.settle(first)
        total = np.zeros((3, lanes))
        cycles = 1 if settled else plan.cycles
        points, reduced = np.empty((cycles, lanes)), []
        for cycle in range(cycles):
            points[cycle] = self.signal(state)
            reduced.append(self.coordinates.reduce(state))
            moments = np.zeros((2 * contacts + size + 1, _PLAIN, lanes))
            moments[:, 2], moments[:, 3] = np.inf, -np.inf
            flat = moments.reshape(-1, lanes)
            state = self.march(state, 1, flat)
            row = -1 if isinstance(plan.signal, str) else plan.signal
            here = flat.reshape(moments.shape)
            total[:2] += here[row, :2] / cycles
            if contacts:
                loss = contacts + (plan.signal if isinstance(plan.signal, int) else 0)
                total[2] += here[loss, 4] / cycles
        rms = np.sqrt(np.maximum(total[1] - total[0] ** 2, 0.0))
        if settled:
            points = np.repeat(points, plan.keep, axis=0)
        history = np.stack(reduced[-plan.keep :])
        return [
            Point(
                points[-plan.keep :, lane].copy(),
                1 if settled else repeat_period(history[:, lane]),
                float(rms[lane]),
                float(total[2, lane]),
                first[lane],
                state[lane],
                self.extra[lane],
            )
            for lane in range(lanes)
        ]


def _lost(plan: Plan, first: Array) -> Point:
    """What is left of a motion that grew beyond all bounds."""
    nan, size = float("nan"), first.size
    none = np.full(plan.keep, nan)
    return Point(none, 0, nan, nan, first, np.full(size, nan), np.zeros(size // 2))


def _one(compiled: Compiled, frequency: float, plan: Plan, first: Array) -> Point:
    try:
        return _Group(compiled, np.array([frequency]), plan, 1).run(first[None, :])[0]
    except ComputationError:
        return _lost(plan, first)


def march_points(
    values: Values, first: Sequence[Array] | None, plan: Plan, progress: Progress
) -> list[Point]:
    """March every value of the parameter from a start of its own.

    Parameters
    ----------
    values : Values
        Systems; lanes side by side where nothing but the mesh frequency varies.
    first : sequence of (2 n,) array, optional
        Starts [mixed]; the static equilibrium by default.
    plan : Plan
        What to do.
    progress : Progress
        Told about the points.

    Returns
    -------
    list of Point
    """
    threads = os.cpu_count() or 1
    if values.shared is not None and values.count > 1:
        begin = [static_start(values.at(i)) if first is None else first[i] for i in _all(values)]
        group = _Group(values.shared, values.mesh_frequency, plan, threads)
        try:
            found = group.run(np.array(begin))
        except ComputationError:
            found = []  # One lane was lost; the others are marched by themselves.
        if found:
            progress.advance(len(found))
            return found

    def point(number: int) -> Point:
        compiled = values.at(number)
        begin = static_start(compiled) if first is None else first[number]
        return _one(compiled, float(values.mesh_frequency[number]), plan, begin)

    found = []
    with ThreadPoolExecutor(threads) as pool:
        for item in pool.map(point, _all(values)):
            found.append(item)
            progress.advance()
    return found


def _all(values: Values) -> range:
    return range(values.count)


def march_sweep(
    values: Values, first: Array | None, plan: Plan, progress: Progress, *, down: bool
) -> list[Point]:
    """March the values of the parameter one after the other, each from the end of the last.

    Parameters
    ----------
    values : Values
        Systems.
    first : (2 n,) array, optional
        Start of the first value [mixed]; the static equilibrium by default.
    plan : Plan
        What to do.
    progress : Progress
        Told about the points.
    down : bool
        From the last value to the first.

    Returns
    -------
    list of Point
        In the order of the values. A motion that grew beyond all bounds is followed by a start at
        rest.
    """
    state, found = first, []
    for number in _all(values)[::-1] if down else _all(values):
        compiled = values.at(number)
        begin = static_start(compiled) if state is None else state
        found.append(_one(compiled, float(values.mesh_frequency[number]), plan, begin))
        last = found[-1].last
        state = last if np.all(np.isfinite(last)) else None
        progress.advance()
    return found[::-1] if down else found
