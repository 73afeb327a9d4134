"""What is measured on every orbit of a branch: rms, ranges, forces, contact loss."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.dynamics.orbits.start import _lowest_of_each_law
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array


@dataclass(frozen=True)
class OrbitFigures:
    """Figures of one orbit."""

    mesh_frequency: float  #: mesh frequency [Hz]
    position: Array  #: [m or rad, m/s or rad/s]
    velocity: Array  #: [m or rad, m/s or rad/s]
    mean: Array
    rms: Array
    peak_to_peak: Array
    peak_force: Array  #: largest force [N]
    contact_loss: Array  #: part of the time off the driving flank [-]
    clearance: Array  #: least compression beyond the gap [m]
    opening: float  #: the least clearance of those contacts that can open [m]


def signal_names(system: System, wanted: Sequence[str] | None) -> tuple[str, ...]:
    """Names of the signals to measure."""
    count = len(system.contacts)
    known = ("deflection",)[:count] + tuple(f"deflection {j}" for j in range(1, count))
    if wanted is None:
        return known[:1] or tuple(system.names)
    for name in wanted:
        if name not in (*known, *system.names):
            raise InputError(
                Problem(
                    what=f'no signal is called "{name}"',
                    where="argument signals",
                    why=f"Known: {', '.join((*known, *system.names))}",
                )
            )
    return tuple(wanted)


def _signal(response: Response, name: str) -> Array:
    if name in response.names:
        return response.fine.position[:, response.index(name)]
    return response.fine.deflection[:, int(name.partition(" ")[2] or 0)]


def _extremes(signal: Array) -> tuple[Array, Array]:
    """Least and greatest value of (3 s, ...) of the parabolas through the samples of each step."""
    left, middle, right = np.moveaxis(signal.reshape(-1, 3, *signal.shape[1:]), 1, 0)
    bend, rise = left - 2.0 * middle + right, 0.5 * (right - left)
    with np.errstate(divide="ignore", invalid="ignore"):
        place = np.where(bend != 0.0, -rise / bend, 0.0)
    inner = np.where(np.abs(place) < 1.0, middle + 0.5 * rise * place, middle)
    every = np.concatenate((left, middle, right, inner))
    return every.min(axis=0), every.max(axis=0)


def measure(mapping: OrbitMap, y: Array, signals: Sequence[str]) -> OrbitFigures:
    """Record one orbit and measure it."""
    states, extra = mapping.record(y)
    frequency = 1.0 / mapping.period
    response = build_response(mapping.compiled, frequency, states, extra)
    fine, nodes = response.fine, mapping.compiled.nodes
    values = np.stack([_signal(response, name) for name in signals], axis=1)
    mean = fine.mean(values)
    low, high = _extremes(values)
    count = nodes.gap.shape[2]
    gap = np.tile(nodes.gap, (response.periods, 1, 1))
    beyond = fine.deflection - gap.reshape(fine.deflection.shape)
    dead = np.any(nodes.gap > 0.0, axis=(0, 1))
    clearance = _extremes(beyond)[0] if count else np.zeros(0)
    able = dead & _lowest_of_each_law(nodes) if count else dead
    return OrbitFigures(
        mesh_frequency=frequency,
        position=states[0, : response.position.shape[1]].copy(),
        velocity=response.velocity[0].copy(),
        mean=mean,
        rms=np.sqrt(fine.mean((values - mean) ** 2)),
        peak_to_peak=high - low,
        peak_force=_extremes(fine.contact_force)[1] if count else np.zeros(0),
        contact_loss=fine.mean(1.0 * ((beyond <= 0.0) & dead)),
        clearance=clearance,
        opening=float(clearance[able].min()) if able.any() else float("nan"),
    )
