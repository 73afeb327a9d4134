"""The engines by name: what they need to begin, and how they march lanes on.

``ENGINES`` holds them under the names of case files; :func:`engine_of` also knows the shorter
``method`` of :func:`~tribodyn.dynamics.simulate`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any, Literal, NamedTuple, Protocol

import numpy as np

from tribodyn.dynamics._engine.adaptive_engine import AdaptiveLanes, adaptive_engine
from tribodyn.dynamics._engine.blocks import BlockRecord, Statistics, march
from tribodyn.dynamics._engine.method import Newmark, RungeKutta4
from tribodyn.dynamics._engine.tolerance import Tolerance
from tribodyn.dynamics.equations.compiled import Compiled, Member, compile_lanes
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.newmark import compile_newmark, newmark_law, newmark_method
from tribodyn.dynamics.time.recorded import RecordedLanes, add_moments
from tribodyn.errors import InputError
from tribodyn.interrupt import in_threads
from tribodyn.types import Array, Index

#: Ways to march over time.
Method = Literal["rk4", "dormand-prince", "newmark"]


class Setting(NamedTuple):
    """What is to be marched."""

    systems: System | Sequence[System]
    frequency: Array  #: mesh frequency of every lane [Hz]
    cycles: int
    steps: int
    extra_force: Array  #: of every lane (lanes, n)
    parameters: LaneParameters | None = None


class Marcher(Protocol):
    """Lanes that march on from call to call."""

    @property
    def compiled(self) -> Compiled:
        """The systems on their grid."""

    def march(
        self,
        state: Array,
        cycles: int,
        *,
        record: Array | None = None,
        statistics: Statistics | None = None,
        threads: int | None = None,
        elapsed: int = 0,
    ) -> Array:
        """March by some mesh cycles, after ``elapsed`` others; returns the new state."""


class FixedMarcher:
    """Lanes that march in the steps of the grid."""

    def __init__(self, setting: Setting, compiled: Compiled, method: RungeKutta4 | Newmark) -> None:
        self.setting, self.compiled, self.method = setting, compiled, method

    def march(self, state: Array, cycles: int, **options: Any) -> Array:
        """March by some mesh cycles."""
        setting = self.setting
        return march(
            self.compiled, 1.0 / setting.frequency, state, cycles, method=self.method,
            extra_force=setting.extra_force, parameters=setting.parameters, **options,
        )  # fmt: skip


class AdaptiveMarcher:
    """Lanes that march in steps of their own length; the grid is that of the samples."""

    def __init__(
        self, setting: Setting, compiled: Compiled, rtol: float, atol: Tolerance | None
    ) -> None:
        lanes = setting.frequency.size
        self.setting, self._compiled, self._widest = setting, compiled, 0.0
        scales = np.ones((lanes, 6))
        if setting.parameters is not None:
            scales = setting.parameters.table(lanes)
        self.scales = scales
        self.groups: list[tuple[Member, AdaptiveLanes]] = []
        for member in compiled.each(lanes):
            own = member.lanes
            engine = adaptive_engine(
                member.system, setting.frequency[own], setting.cycles, rtol=rtol, atol=atol,
                parameters=setting.parameters,
            )  # fmt: skip
            group = AdaptiveLanes(
                engine, 1.0 / setting.frequency[own], extra_force=setting.extra_force[own],
                scales=scales[own], numbers=own if lanes > 1 else None,
            )  # fmt: skip
            self.groups.append((member, group))

    @property
    def compiled(self) -> Compiled:
        """The systems on the grid of the samples, with the widest step so far."""
        rate, slowest = self.groups[0][1].engine.rate, float(self.setting.frequency.min())
        return replace(self._compiled, step_number=rate * self._widest / slowest)

    def march(
        self,
        state: Array,
        cycles: int,
        *,
        record: Array | None = None,
        statistics: Statistics | None = None,
        threads: int | None = None,
        elapsed: int = 0,
    ) -> Array:
        """March by some mesh cycles; with statistics, cycle by cycle with records of each block."""
        new, empty = np.empty_like(state), np.zeros((0, 2 + 3 * state.shape[1]))
        points = self._compiled.grid.left

        def march_lanes(task: tuple[Member, AdaptiveLanes, int]) -> float:
            member, group, place = task
            block = group.blocks[place]
            lanes, part = member.lanes[block.lanes], state[member.lanes[block.index]]
            if statistics is None:
                kept = BlockRecord(record, lanes, block.index.size)
                report = group.march_block(place, part, cycles, points, kept.states, empty, elapsed)
                kept.put()
            else:
                cycle = np.empty((points.size + 1, state.shape[1], block.index.size))
                for number in range(elapsed, elapsed + cycles):
                    report = group.march_block(place, part, 1, points, cycle, empty, number)
                    self._gather(member, lanes, cycle[:, :, : block.count], statistics, cycles)
            new[lanes] = part[: block.count]
            return float(report[3])

        tasks = [
            (member, group, place)
            for member, group in self.groups
            for place in range(len(group.blocks))
        ]
        count = threads or os.cpu_count() or 1
        self._widest = max([self._widest, *in_threads(march_lanes, tasks, count)])
        return new

    def _gather(
        self, member: Member, lanes: Index, record: Array, statistics: Statistics, cycles: int
    ) -> None:
        setting, moments = self.setting, statistics.moments[:, lanes]
        recorded = RecordedLanes(
            member, self._compiled.grid, 1.0 / setting.frequency[lanes],
            setting.extra_force[lanes], self.scales[lanes], record,
        )  # fmt: skip
        add_moments(recorded, statistics.outputs, statistics.waves, 1.0 / cycles, moments)
        statistics.moments[:, lanes] = moments


class Engine(NamedTuple):
    """One way to march over time."""

    method: Method  #: its name as an argument
    options: tuple[str, ...]  #: arguments that belong to it alone
    prepare: Callable[..., Marcher]  #: of a :class:`Setting` and the options


def _runge_kutta(setting: Setting) -> Marcher:
    compiled = compile_lanes(setting.systems, setting.frequency, setting.steps, setting.parameters)
    return FixedMarcher(setting, compiled, RungeKutta4())


def _dormand_prince(
    setting: Setting, rtol: float | None = None, atol: Tolerance | None = None
) -> Marcher:
    compiled = _any_step(setting)
    return AdaptiveMarcher(setting, compiled, 1e-6 if rtol is None else rtol, atol)


def _newmark(
    setting: Setting,
    gamma: float | None = None,
    beta: float | None = None,
    preset: str | None = None,
) -> Marcher:
    gamma, beta = newmark_law(gamma, beta, preset)
    if isinstance(setting.systems, System) and setting.frequency.size == 1:
        compiled = compile_newmark(
            setting.systems, setting.frequency, setting.steps, gamma=gamma, beta=beta
        )
    else:
        compiled = _any_step(setting)
    period, parameters = 1.0 / setting.frequency, setting.parameters
    method = newmark_method(compiled, period, gamma, beta, parameters=parameters)
    return FixedMarcher(setting, compiled, method)


def _any_step(setting: Setting) -> Compiled:
    return compile_lanes(
        setting.systems, setting.frequency, setting.steps, setting.parameters, any_step=True
    )


#: Engines under their names in case files.
ENGINES: Mapping[str, Engine] = MappingProxyType(
    {
        "runge-kutta-4": Engine("rk4", (), _runge_kutta),
        "dormand-prince": Engine("dormand-prince", ("rtol", "atol"), _dormand_prince),
        "newmark": Engine("newmark", ("gamma", "beta", "preset"), _newmark),
    }
)


def prepare(method: str, setting: Setting, **options: Any) -> Marcher:
    """Begin to march with the engine called ``method``; options of another are refused."""
    engine = next((each for name, each in ENGINES.items() if method in (name, each.method)), None)
    if engine is None:
        raise InputError(
            f'method = "{method}"',
            where="argument method",
            why="It is one of " + ", ".join(f'"{each.method}"' for each in ENGINES.values()),
        )
    given = {name: value for name, value in options.items() if value is not None}
    for name in given:
        owner = next(each.method for each in ENGINES.values() if name in each.options)
        if owner != engine.method:
            raise InputError(
                f'{name} = {given[name]} with method = "{method}"',
                where=f"argument {name}",
                why=f'It belongs to "{owner}"',
                remedy=f'Leave it out, or give method = "{owner}"',
            )
    return engine.prepare(setting, **given)


def march_adaptive(
    compiled: Compiled,
    period: Array,
    state: Array,
    cycles: int,
    *,
    rtol: float = 1e-6,
    atol: Tolerance | None = None,
    extra_force: Array | None = None,
    parameters: LaneParameters | None = None,
    record: Array | None = None,
    threads: int | None = None,
) -> Array:
    """March lanes of a compiled system in adaptive steps; returns their new state."""
    frequency = 1.0 / np.asarray(period, dtype=float)
    extra = np.zeros((frequency.size, compiled.system.size)) if extra_force is None else extra_force
    setting = Setting(compiled.system, frequency, cycles, compiled.grid.steps, extra, parameters)
    marcher = AdaptiveMarcher(setting, compiled, rtol, atol)
    return marcher.march(state, cycles, record=record, threads=threads)
