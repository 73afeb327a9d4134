"""Ensembles: many trajectories (lanes) that differ in frequency, load, start and parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.adaptive_engine import Tolerance
from tribodyn.dynamics._engine.blocks import Backend
from tribodyn.dynamics._engine.statistics import PLAIN_MOMENTS, Statistics
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.engines import Method, Setting, prepare
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import InputError
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, ComplexArray


@dataclass(frozen=True)
class LaneStatistics:
    """Statistics of one kind of signal.

    Parameters
    ----------
    mean, rms, minimum, maximum : (lanes, signals) array
        In the unit of the signal; ``rms`` includes the mean.
    harmonics : (lanes, signals, count) complex array
        Amplitudes of the mesh harmonics 1, 2, ...; empty if none were computed.
    """

    mean: Array
    rms: Array
    minimum: Array
    maximum: Array
    harmonics: ComplexArray = field(repr=False)

    @property
    def alternating_rms(self) -> Array:
        """Rms of the alternating part, (lanes, signals)."""
        return np.asarray(np.sqrt(np.maximum(self.rms**2 - self.mean**2, 0.0)))


@dataclass(frozen=True)
class Ensemble:
    """End states and statistics of many trajectories.

    Parameters
    ----------
    mesh_frequency : (lanes,) array
        Mesh frequency [Hz].
    position, velocity : (lanes, n) array
        State after the last mesh cycle [m or rad, m/s or rad/s].
    deflection, contact_force, acceleration, output : LaneStatistics
        Statistics over the last ``averaged`` mesh cycles [m, N, m/s^2 or rad/s^2, output unit].
    contact_loss_share : (lanes, contacts) array
        Part of that time off the driving flank [-].
    averaged : int
        Mesh cycles over which the statistics were computed.
    """

    mesh_frequency: Array
    position: Array
    velocity: Array
    deflection: LaneStatistics = field(repr=False)
    contact_force: LaneStatistics = field(repr=False)
    acceleration: LaneStatistics = field(repr=False)
    output: LaneStatistics = field(repr=False)
    contact_loss_share: Array = field(repr=False)
    averaged: int

    def __repr__(self) -> str:
        """One line."""
        low, high = self.mesh_frequency.min(), self.mesh_frequency.max()
        return (
            f"Ensemble({self.mesh_frequency.size} trajectories, mesh frequency {low:.6g} to "
            f"{high:.6g} Hz, statistics over {self.averaged} mesh cycles)"
        )


def lane_statistics(rows: Array, harmonics: ComplexArray | None = None) -> LaneStatistics:
    """Statistics of the moments (signals, 5 or more, lanes) of one kind of signal."""
    none = np.zeros((rows.shape[2], rows.shape[0], 0), dtype=complex)
    mean, square, low, high = (rows[:, k].T for k in range(4))
    rms = np.sqrt(np.maximum(square, 0.0))
    return LaneStatistics(mean, rms, low, high, none if harmonics is None else harmonics)


def simulate_ensemble(
    system: System | Sequence[System],
    mesh_frequency: ArrayLike,
    cycles: int,
    start: tuple[ArrayLike, ArrayLike],
    *,
    steps: int = 512,
    extra_force: ArrayLike | None = None,
    parameters: LaneParameters | None = None,
    averaged: int = 1,
    harmonics: int = 5,
    outputs: ArrayLike | None = None,
    threads: int | None = None,
    progress: Progress = SILENT,
    method: Method = "rk4",
    rtol: float | None = None,
    atol: Tolerance | None = None,
    gamma: float | None = None,
    beta: float | None = None,
    preset: str | None = None,
    backend: Backend | None = None,
) -> Ensemble:
    """Integrate many trajectories and compute their statistics without storing time series.

    Parameters
    ----------
    system : System or sequence of System
        One for all lanes, or one for each, all with the same number of coordinates, contacts and
        frictions.
    mesh_frequency : float or (lanes,) array
        Mesh frequency of each lane [Hz]. A single number applies to all lanes of the systems or
        the parameters.
    cycles : int
        Whole mesh cycles of each lane.
    start : (position, velocity)
        (n,) or (lanes, n) arrays [m or rad, m/s or rad/s].
    steps : int
        Steps per mesh cycle.
    extra_force : (lanes, n) array, optional
        Constant generalized force on top of the system's [N or N*m].
    parameters : LaneParameters, optional
        Factors by which each lane scales its system.
    averaged : int
        Number of the last mesh cycles over which statistics are computed.
    harmonics : int
        Mesh harmonics of deflection and contact force.
    outputs : (m, 2 n) array, optional
        Linear outputs of (position, velocity), for example bearing forces [N/m, N*s/m].
    threads : int, optional
        Number of blocks of lanes integrated at a time; the number of processors by default.
    progress : Progress
        Receives the progress over the mesh cycles.
    method, rtol, atol, gamma, beta, preset
        As in :func:`simulate` [m or rad, m/s or rad/s].
    backend : "cpu" or "cuda", optional
        For "rk4": the processor. An NVIDIA graphics processor runs one thread for each trajectory,
        which pays off for thousands of trajectories.

    Raises
    ------
    InputError
        If shapes disagree, an argument is out of range or belongs to another method, or the step is
        too long.
    ComputationError
        If a motion grows beyond all bounds.

    Examples
    --------
    >>> free = System([[1.0]], [[0.0]], [[4.0]], [0.0])
    >>> simulate_ensemble(free, [1.0, 2.0], 2, ([1.0], [0.0]), steps=64)
    Ensemble(2 trajectories, mesh frequency 1 to 2 Hz, statistics over 1 mesh cycles)
    """
    frequency = _frequencies(system, mesh_frequency, parameters)
    if not 0 <= averaged <= cycles:
        what = f"averaged = {averaged} with cycles = {cycles}"
        why = "Statistics cover at most all mesh cycles"
        raise InputError(what, "argument averaged", why, f"Give a number from 1 to {cycles}")
    options = {"rtol": rtol, "atol": atol, "gamma": gamma, "beta": beta, "preset": preset}
    options |= {"backend": backend}
    lanes, size = frequency.size, (system if isinstance(system, System) else system[0]).size
    extra = np.zeros((lanes, size)) if extra_force is None else np.asarray(extra_force, float)
    extra = np.ascontiguousarray(np.broadcast_to(extra, (lanes, size)))
    setting = Setting(system, frequency, cycles, steps, extra, parameters)
    marcher = prepare(method, setting, **options)
    state = read_start(marcher.compiled.system, start, lanes)
    compiled = marcher.compiled
    linear = np.zeros((0, 2 * size)) if outputs is None else np.array(outputs, float, ndmin=2)
    if linear.shape[1:] != (2 * size,):
        why = f"Each output is a row of {2 * size} factors of position and velocity"
        what = f"outputs have the shape {linear.shape}"
        raise InputError(what, "argument outputs", why, f"Give the shape (m, {2 * size})")
    statistics = Statistics.of(compiled, linear, lanes, harmonics)
    progress.start("Mesh cycles", cycles)
    early = cycles - averaged
    for count, gathered, elapsed in ((early, None, 0), (averaged, statistics, early)):
        if count:
            state = marcher.march(
                state, count, statistics=gathered, threads=threads, elapsed=elapsed
            )
            progress.advance(count)
    progress.finish()
    return _collect(frequency, state, statistics, averaged)


def _frequencies(
    system: System | Sequence[System], mesh_frequency: ArrayLike, parameters: LaneParameters | None
) -> Array:
    """Mesh frequency of every lane."""
    frequency = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    counts = {
        "mesh_frequency": frequency.size,
        "parameters": 1 if parameters is None else parameters.count,
        "system": 1 if isinstance(system, System) else len(system),
    }
    lanes = max(counts.values())
    odd = [name for name, count in counts.items() if count not in (1, lanes)]
    if frequency.ndim != 1 or odd:
        name = odd[0] if odd else "mesh_frequency"
        what = f"{name} is for {counts[name]} lanes, others are for {lanes}"
        why = "Each argument has one value for all lanes, or one for each lane"
        raise InputError(what, f"argument {name}", why, "Give one value, or one for each lane")
    return np.array(np.broadcast_to(frequency, (lanes,)))


def _collect(frequency: Array, state: Array, gathered: Statistics, averaged: int) -> Ensemble:
    tall, short, size = gathered.of_contacts, gathered.others, state.shape[1] // 2
    parts = 2.0 * (tall[:, PLAIN_MOMENTS::2] - 1j * tall[:, PLAIN_MOMENTS + 1 :: 2])
    waves = np.asarray(np.moveaxis(parts, -1, 0), dtype=complex)
    pressed, forces = slice(gathered.contacts), slice(gathered.contacts, None)
    return Ensemble(
        mesh_frequency=frequency,
        position=state[:, :size],
        velocity=state[:, size:],
        deflection=lane_statistics(tall[pressed], waves[:, pressed]),
        contact_force=lane_statistics(tall[forces], waves[:, forces]),
        acceleration=lane_statistics(short[:size]),
        output=lane_statistics(short[size:]),
        contact_loss_share=tall[forces, 4].T,
        averaged=averaged,
    )
