"""States of a motion once per mesh cycle: marching, their period, and what half the step says."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import Compiled, compile_for
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.coordinates import orbit_coordinates
from tribodyn.errors import ComputationError
from tribodyn.nonlinear.verdict import Verdict, step_verdict
from tribodyn.types import Array

#: Mesh cycles after which a motion may repeat.
_PERIODS = 16
#: Points that differ by less than this, relative to their size, are the same.
_SAME = 1e-5
#: Points that still approach each other are the same when this near.
_NEARLY = 1e-3
_CALMS_DOWN = 0.5
#: Points beyond this are on their way beyond all bounds.
_HUGE = 1e100
#: An rms below this share of the largest compression is that of a motion at rest.
_REST = 1e-9


class MarchedSection(NamedTuple):
    """What a march gives."""

    states: Array  #: position and velocity at the mesh phase 0 [m or rad, m/s or rad/s]
    reduced: Array  #: the same without free motions
    rms: float  #: [m or rad]


def alternating_rms(signal: Array, weight: Array) -> float:
    """Alternating rms of a signal; zero for rounding."""
    weight = weight / weight.sum()
    mean = float(weight @ signal)
    rms = float(np.sqrt(weight @ (signal - mean) ** 2))
    return 0.0 if rms < _REST * float(np.abs(signal).max(initial=0.0)) else rms


def repeat_period(points: Array) -> int:
    """Tell after how many points a sequence repeats."""
    largest = float(np.abs(points).max(initial=0.0))
    if not largest < _HUGE:
        return 0
    size = float(np.linalg.norm(points, axis=1).max(initial=0.0)) or 1.0
    for period in range(1, min(_PERIODS, len(points) // 2) + 1):
        apart = np.linalg.norm(points[period:] - points[:-period], axis=1) / size
        third = max(1, len(apart) // 3)
        first, last = float(apart[:third].max()), float(apart[-third:].max())
        if last <= _SAME or (last <= _NEARLY and last <= _CALMS_DOWN * first):
            return period
    return 0


def march_section(
    compiled: Compiled, mesh_frequency: float, state: Array, force: Array, cycles: int,
    transient: int, with_rms: bool,
) -> MarchedSection:  # fmt: skip
    """March a system and keep its state once per mesh cycle."""
    size, steps, nodes = compiled.system.size, compiled.grid.steps, compiled.nodes
    coordinates = orbit_coordinates(compiled, mesh_frequency)
    period, now = np.array([1.0 / mesh_frequency]), state[None, :]
    states = np.empty((cycles, 2 * size))
    record = np.empty((steps + 1, 2 * size, 1)) if with_rms else None
    signal = np.empty((cycles, steps))
    for cycle in range(-transient, cycles):
        if cycle >= 0:
            states[cycle] = now[0]
        kept = record if cycle >= 0 else None
        now = march(compiled, period, now, 1, extra_force=force[None, :], record=kept,
                    elapsed=cycle + transient)  # fmt: skip
        now = coordinates.expand(coordinates.reduce(now))
        if kept is not None:
            place = kept[:-1, :size, 0]
            signal[cycle] = place[:, 0]
            if compiled.system.contacts:
                signal[cycle] = np.einsum("ri,ri->r", nodes.direction[:, 0, 0], place)
                signal[cycle] -= nodes.error[:, 0, 0]
    rms = float("nan")
    if with_rms:
        rms = alternating_rms(signal.reshape(-1), np.tile(compiled.grid.width, cycles))
    return MarchedSection(states, coordinates.reduce(states), rms)


def judge_section(
    system: System,
    mesh_frequency: float,
    state: Array,
    force: Array,
    steps: int,
    transient: int,
    cycles: int,
    known: tuple[float, int, float],
) -> Verdict:
    """Judge a section by one with shorter steps."""
    compiled = compile_for(system, mesh_frequency, steps)
    try:
        found = march_section(compiled, mesh_frequency, state, force, cycles, transient, True)
    except ComputationError:
        return "step-limited"
    number, period, rms = known
    return step_verdict(number, period, rms, repeat_period(found.reduced), found.rms)
