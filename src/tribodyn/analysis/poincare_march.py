"""States of a motion once per mesh cycle: marching, their period, and what half the step says."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribodyn.analysis.verdict import Verdict, step_verdict
from tribodyn.dynamics.coordinates import orbit_coordinates
from tribodyn.dynamics.march import Compiled, compile_for, march
from tribodyn.dynamics.system import System
from tribodyn.errors import ComputationError

__all__ = ["MarchedSection", "alternating_rms", "judge_section", "march_section", "repeat_period"]

Array = NDArray[np.float64]

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
    """What a march gives.

    Parameters
    ----------
    states : (cycles, 2 n) array
        Position and velocity at the mesh phase 0 [m or rad, m/s or rad/s].
    reduced : (cycles, k) array
        The same without free motions.
    rms : float
        Alternating rms of the compression of contact 0, or of coordinate 0 where there is no
        contact [m or rad]; NaN where it was not asked.
    """

    states: Array
    reduced: Array
    rms: float


def alternating_rms(signal: Array, weight: Array) -> float:
    """Alternating rms of a signal; zero for rounding.

    Parameters
    ----------
    signal : (samples,) array
        Any signal.
    weight : (samples,) array
        Its weights, which need not add up to one [-].

    Returns
    -------
    float
        In the unit of the signal.

    Examples
    --------
    >>> alternating_rms(np.array([3.0, 1.0]), np.array([1.0, 1.0]))
    1.0
    """
    weight = weight / weight.sum()
    mean = float(weight @ signal)
    rms = float(np.sqrt(weight @ (signal - mean) ** 2))
    return 0.0 if rms < _REST * float(np.abs(signal).max(initial=0.0)) else rms


def repeat_period(points: Array) -> int:
    """Tell after how many points a sequence repeats.

    Parameters
    ----------
    points : (m, k) array
        Points in the order of time [any one unit].

    Returns
    -------
    int
        1 to 16, and at most half of the points; 0 if it does not repeat.

    Notes
    -----
    Points are the same within 1e-5 of their size, or within 1e-3 as long as they approach each
    other.

    Examples
    --------
    >>> repeat_period(np.array([[1.0], [2.0]] * 8))
    2
    """
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
    """March a system and keep its state once per mesh cycle.

    Parameters
    ----------
    compiled : Compiled
    mesh_frequency : float
        Mesh frequency [Hz].
    state : (2 n,) array
        Position and velocity at the start [m or rad, m/s or rad/s].
    force : (n,) array
        Constant generalized force on top of the system's [N or N*m].
    cycles, transient : int
        Mesh cycles to keep, and before.
    with_rms : bool
        Whether to find the rms.

    Returns
    -------
    MarchedSection

    Raises
    ------
    ComputationError
        If the motion grows beyond all bounds.
    """
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
    """Judge a section by one with shorter steps.

    Parameters
    ----------
    system : System
    mesh_frequency : float
        Mesh frequency [Hz].
    state : (2 n,) array
        Position and velocity at the start [m or rad, m/s or rad/s].
    force : (n,) array
        Constant generalized force on top of the system's [N or N*m].
    steps : int
        Shorter steps per mesh cycle.
    transient, cycles : int
        Mesh cycles before, and those to look at.
    known : tuple of float, int and float
        ``omega_max * dt`` [-], period and rms with the longer steps.

    Returns
    -------
    "physical", "step-limited" or "undecided"
    """
    compiled = compile_for(system, mesh_frequency, steps)
    try:
        found = march_section(compiled, mesh_frequency, state, force, cycles, transient, True)
    except ComputationError:
        return "step-limited"
    number, period, rms = known
    return step_verdict(number, period, rms, repeat_period(found.reduced), found.rms)
