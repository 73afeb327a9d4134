"""Run-up and run-down: the motion while the speed changes as prescribed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.statistics import PLAIN_MOMENTS
from tribodyn.dynamics.equations.nodes import lowest_of_each_law
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.linear.natural_modes import NaturalModes, natural_modes
from tribodyn.dynamics.orbits.steady_state import steady_state
from tribodyn.dynamics.running_up.run_up_march import CycleMarcher, Pace, Samples
from tribodyn.dynamics.running_up.run_up_result import (
    CycleStatistics,
    RunUp,
    SpeedProfile,
    read_profile,
)
from tribodyn.dynamics.running_up.run_up_tables import Table, Tables, systems_by_frequency
from tribodyn.dynamics.time.ensemble import lane_statistics
from tribodyn.dynamics.time.simulate import read_start
from tribodyn.errors import ComputationError, InputError, quiet, require_positive
from tribodyn.nomenclature import require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array

#: Mesh cycles whose pace is computed at a time.
_CHUNK = 64


def run_up(
    system: System | Mapping[float, System],
    profile: SpeedProfile | tuple[ArrayLike, ArrayLike] | Callable[[Array], ArrayLike],
    *,
    duration: float | None = None,
    teeth: int = 1,
    cycles: int = 1,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    steps: int | None = None,
    samples: int = 128,
    outputs: Mapping[str, ArrayLike] | None = None,
    output_unit: str = "N",
    rotation: ArrayLike | None = None,
    progress: Progress = SILENT,
) -> RunUp:
    """Integrate a system while its speed changes as prescribed.

    Parameters
    ----------
    system : System or mapping of float to System
        One system, or several by mesh frequency [Hz] where friction, stiffness or loads change
        with the speed: between two of them the rows are interpolated linearly.
    profile : SpeedProfile, (time, mesh_frequency) or function
        Mesh frequency [Hz] over time [s]: :func:`speed_ramp`, corners of straight lines, or a
        vectorized function of time.
    duration : float, optional
        Length of the run [s], for a function of time.
    teeth : int
        Mesh cycles per revolution of the shaft whose speed is reported.
    cycles : int
        Mesh cycles of a period of the system's clock, where its teeth differ. Statistics of each
        mesh cycle are then those of its period.
    start : (position, velocity), optional
        Two (n,) arrays [m or rad, m/s or rad/s]; the steady state at the first speed by default.
    steps : int, optional
        Steps per mesh cycle at all speeds; by default each speed has as many as it needs
        (``omega_max * dt`` up to 0.35, at least 256).
    samples : int
        Equally spaced samples of each mesh cycle that are recorded. Content above mesh order
        ``samples / 2`` is aliased.
    outputs : mapping of str to (2 n,) array, optional
        Further linear outputs of (position, velocity), for example bearing forces [N/m, N*s/m].
    output_unit : str
        Their unit.
    rotation : (n,) array, optional
        Derivative of the coordinates with respect to the angle of the shaft [rad/rad]. With it the
        inertia of the prescribed acceleration loads the structure.
    progress : Progress
        Receives the progress over the mesh cycles.

    Raises
    ------
    InputError
        If an argument is out of range, the lowest speed is not positive or the step too long.
    ComputationError
        If the motion grows beyond all bounds.

    Notes
    -----
    The motion is integrated over the mesh phase, so that events are grid points at every speed:
    each step takes exactly the time in which the prescribed speed passes its width. The classical
    Runge-Kutta scheme keeps its fourth order, and steps in which a contact opens or closes are
    split as at constant speed.

    The mean motion is prescribed. Where friction unbalances the torques, ``system.balance`` defines
    the torque that compensates the velocity which the drive gained in the last cycles (a weak servo
    of eight cycles, whose mean at a constant speed is that of :func:`steady_state`). Without it
    the mean acceleration of the whole drive is left out.

    The last mesh cycle is completed at the last speed.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact
    >>> pair = Contact([1.0], stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase))
    >>> system = System([[1.0]], [[0.2]], [[0.0]], [1.0], [pair])
    >>> run_up(system, ([0.0, 40.0], [0.2, 0.8]), samples=16)
    RunUp(40 s, 20 mesh cycles, mesh frequency 0.2 to 0.8 Hz, 1 coordinate, 16 samples per cycle)
    """
    of_mesh = read_profile(profile, duration)
    require_positive("teeth", teeth)
    require_whole("samples", samples, 2)
    cycles = require_whole("cycles", cycles)
    path = of_mesh.times(1.0 / cycles)
    frequency, systems = systems_by_frequency(system)
    frequency, first = frequency / cycles, systems[0]
    every = None if steps is None else steps * cycles // first.cycles
    tables = Tables(systems, int(samples) * cycles, path.lowest, every)
    linear = read_outputs(outputs, first)
    inertia = _inertia(first, rotation, int(teeth) / cycles)
    marcher = CycleMarcher(tables, frequency, path.lowest, linear, inertia)
    state = _begin(marcher, path, start)
    count = max(math.ceil(path.cycles - 1e-9), 1)
    collector = Samples(systems, frequency, count, int(samples) * cycles)
    progress.start("Mesh cycles of the run-up" if cycles == 1 else "Turns of the run-up", count)
    figures = _march(marcher, path, count, state, collector, progress)
    progress.finish()
    series = collector.series(linear)
    series |= {name: cycles * series[name] for name in ("phase", "mesh_frequency")}
    return RunUp(
        **series,
        names=tuple(first.names),
        output_names=tuple(outputs or ()),
        output_unit=output_unit,
        samples=int(samples),
        teeth=int(teeth),
        cycles=_statistics(of_mesh, count, *figures[:3], marcher.tables.at(path.lowest), cycles),
        profile=of_mesh,
        step_number=figures[3],
        modes=_modes(systems[len(systems) // 2]),
    )


def _march(
    marcher: CycleMarcher,
    path: SpeedProfile,
    count: int,
    state: Array,
    collector: Samples,
    progress: Progress,
) -> tuple[Array, Array, list[int], float]:
    """Integrate all cycles: their moments, extra forces and steps, and the largest step number."""
    moments, extras, used, largest = [], [], [], 0.0
    for table, begin, end in _chunks(marcher.tables, path, count):
        pace = Pace.over(path, table, begin, end - begin)
        record = np.empty((table.grid.steps + 1, state.size, 1))
        period = pace.time[:, -1] - pace.time[:, 0]
        rate = np.diff(path.frequency_at(pace.time[:, [0, -1]]))[:, 0] / period
        chunk = np.empty((end - begin, table.sample_steps.size, state.size))
        ends = np.empty((end - begin, state.size))
        for number in range(end - begin):
            program = marcher.program(table, pace, number, 1.0 / period[number])
            state = marcher.without_free_motion(state)
            marcher.time = float(pace.time[number, 0])
            state, cycle_moments, extra = marcher.cycle(
                program, period[number], rate[number], state, record
            )
            chunk[number], ends[number] = record[table.sample_steps, :, 0], state
            moments.append(cycle_moments)
            extras.append(extra)
        used += [table.grid.steps] * (end - begin)
        largest = max(largest, table.step_number * float(period.max()))
        time = pace.time[:, table.sample_steps]
        _take_drift(marcher, chunk, ends, (time - pace.time[:, :1]) / period[:, None], period)
        weights = [marcher.weights(1.0 / each) for each in period]
        collector.add(
            table, begin, time, path.frequency_at(time), chunk, weights, extras[begin:end]
        )
        progress.advance(end - begin)
    return np.array(moments).T, np.array(extras), used, largest


def _modes(system: System) -> NaturalModes | None:
    try:
        return natural_modes(system)
    except (InputError, ComputationError):
        return None


def read_outputs(outputs: Mapping[str, ArrayLike] | None, system: System) -> Array:
    """Check linear outputs of the state."""
    rows = [np.asarray(row, dtype=float) for row in (outputs or {}).values()]
    for name, row in zip(outputs or {}, rows, strict=True):
        if row.shape != (2 * system.size,):
            what = f"the output {name} has the shape {row.shape}"
            why = f"It is a row over positions and velocities, ({2 * system.size},)"
            remedy = "Give one factor for each position, then one for each velocity"
            raise InputError(what, "argument outputs", why, remedy)
    return np.array(rows) if rows else np.zeros((0, 2 * system.size))


def _inertia(system: System, rotation: ArrayLike | None, teeth: float) -> Array:
    """Generalized force against a mesh frequency that rises by 1 Hz/s."""
    if rotation is None:
        return np.zeros(system.size)
    turning = np.asarray(rotation, dtype=float)
    if turning.shape != (system.size,):
        what = f"rotation has the shape {turning.shape}, not ({system.size},)"
        why = "It is the rotation of each coordinate per rotation of the shaft"
        raise InputError(what, "argument rotation", why, "Give one number for each coordinate")
    return np.asarray(-np.asarray(system.mass) @ turning * (2.0 * np.pi / teeth))


def _begin(
    marcher: CycleMarcher, path: SpeedProfile, start: tuple[ArrayLike, ArrayLike] | None
) -> Array:
    """State at the start; the marcher takes over the balancing torque of a steady state."""
    beat = float(path.frequency_at(0.0))
    left, part = marcher.weights(beat)
    system = marcher.systems[left + round(part)]
    if start is not None:
        return read_start(system, start)
    with quiet():
        # A start that is not periodic is acceptable.
        orbit = steady_state(system, beat, steps=marcher.tables.steps_at(beat))
    if orbit.converged and marcher.balance is not None:
        marcher.hold(orbit.extra_force)
    return np.concatenate((orbit.position[0], orbit.velocity[0]))


def _chunks(tables: Tables, path: SpeedProfile, count: int) -> Any:
    """Yield runs of mesh cycles on one grid: table, first cycle, one past the last."""
    time = path.time_at(np.arange(count + 1))
    ends = path.frequency_at(time)
    slowest = np.minimum(ends[1:], ends[:-1])
    corners = np.asarray(path.time)[1:-1]
    inside = np.searchsorted(time, corners, side="right") - 1
    lows = path.frequency_at(corners)
    np.minimum.at(slowest, np.minimum(inside, count - 1), lows)
    needed = np.array([tables.steps_at(float(each)) for each in slowest])
    begin = 0
    while begin < count:
        end = begin + 1
        while end < count and end - begin < _CHUNK and needed[end] == needed[begin]:
            end += 1
        yield tables.at(float(slowest[begin])), begin, end
        begin = end


def _take_drift(
    marcher: CycleMarcher, states: Array, ends: Array, passed: Array, period: Array
) -> None:
    """Remove mean acceleration and mean speed of every cycle from the free motion."""
    size = marcher.size
    rise = (ends[:, size:] @ marcher.free)[:, None]
    travel = (ends[:, :size] @ marcher.free)[:, None] - 0.5 * period[:, None, None] * rise
    part, duration = passed[:, :, None], period[:, None, None]
    states[..., :size] -= part * travel + 0.5 * part**2 * duration * rise
    states[..., size:] -= travel / duration + part * rise


def _statistics(
    path: SpeedProfile,
    count: int,
    moments: Array,
    extras: Array,
    steps: list[int],
    table: Table,
    cycles: int,
) -> CycleStatistics:
    # Figures of a period of the clock are those of all of its mesh cycles.
    time = path.time_at(np.arange(count * cycles + 1))
    period = np.diff(time)
    rows = np.repeat(moments, cycles, axis=-1).reshape(-1, PLAIN_MOMENTS, count * cycles)
    nodes = table.nodes[0]
    contacts, size = nodes.direction.shape[2:]
    stiff = nodes.stiffness.any(axis=(0, 1))
    return CycleStatistics(
        time=0.5 * (time[1:] + time[:-1]),
        mesh_frequency=1.0 / period,
        rate=np.diff(path.frequency_at(time)) / period,
        deflection=lane_statistics(rows[:contacts]),
        contact_force=lane_statistics(rows[contacts : 2 * contacts]),
        acceleration=lane_statistics(rows[2 * contacts : 2 * contacts + size]),
        output=lane_statistics(rows[2 * contacts + size :]),
        contact_loss_share=rows[contacts : 2 * contacts, 4].T,
        extra_force=np.repeat(extras, cycles, axis=0),
        steps=np.repeat(np.array(steps, dtype=np.int64) // cycles, cycles),
        last_to_open=lowest_of_each_law(nodes) & stiff,
    )
