"""Motion in adaptive steps, with dense output at any time."""

from __future__ import annotations

from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.adaptive_engine import Tolerance, adaptive_lanes, lane_groups
from tribodyn.dynamics.equations.motion import quintic_place, quintic_speed
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.time.simulate import read_force, read_start
from tribodyn.errors import InputError, require_positive
from tribodyn.interrupt import in_threads
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array

#: Initial capacity for the steps of a mesh cycle.
_ROOM = 4096


@record
class AdaptiveSolution(Record):
    """Motion of a system in accepted steps; call it with times for the dense output.

    Steps end at events of the mesh cycle and where a contact changes its side.

    Parameters
    ----------
    time : (steps + 1,) array
        Ends of the steps, beginning with 0 [s].
    phase : (steps + 1,) array
        Mesh phase counted from the start [cycles].
    state : (steps + 1, 2 n) array
        Position and velocity [m or rad, m/s or rad/s].
    names : tuple of str
        Names of the coordinates.
    mesh_frequency : float
        Mesh frequency [Hz].
    rtol : float
        Relative tolerance [-].
    atol : (2 n,) array
        Absolute tolerance of each state [m or rad, m/s or rad/s].
    rejections : int
        Steps that were repeated because their error was too large.
    crossings : int
        Changes of side of contacts.
    table_error : float
        Mean deviation of the entries between events from their polynomials, over their size [-].
    """

    time: Array = quantity("time", unit="s", axis=True)
    phase: Array = quantity("time", unit="1", axis=True)
    state: Array
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    mesh_frequency: float = fact()
    rtol: float = fact()
    atol: Array
    rejections: int = fact()
    crossings: int = fact()
    table_error: float
    _trail: Array = field(repr=False)

    @property
    def steps(self) -> int:
        """Number of accepted steps."""
        return self.time.size - 1

    @property
    def position(self) -> Array:
        """Positions at the ends of the steps, (steps + 1, n) [m or rad]."""
        return self.state[:, : self.state.shape[1] // 2]

    @property
    def velocity(self) -> Array:
        """Velocities at the ends of the steps, (steps + 1, n) [m/s or rad/s]."""
        return self.state[:, self.state.shape[1] // 2 :]

    def __call__(self, time: ArrayLike) -> Array:
        """State at any time of the motion.

        Parameters
        ----------
        time : float or (...) array
            Time from 0 to the end of the motion [s].

        Returns
        -------
        (..., 2 n) array
            Position and velocity: the quintic Hermite interpolant of the step and its derivative.

        Raises
        ------
        InputError
            If a time lies outside the motion.
        """
        times = np.asarray(time, dtype=float)
        outside = ~((times >= -1e-12 * self.time[-1]) & (times <= (1.0 + 1e-12) * self.time[-1]))
        if np.any(outside):
            what = f"time = {times[outside].flat[0]:.6g} s"
            why = f"The motion goes from 0 to {self.time[-1]:.6g} s"
            raise InputError(what, "argument time", why, "Give times within the motion")
        phase = times.reshape(-1) * self.mesh_frequency
        step = np.clip(np.searchsorted(self.phase, phase, side="right") - 1, 0, self.steps - 1)
        part = self._trail[step]
        theta = np.clip((phase - self.phase[step]) / part[:, 1], 0.0, 1.0)
        n = self.state.shape[1] // 2
        states = _hermite(part[:, 2:].reshape(-1, 6, n), part[:, 1] / self.mesh_frequency, theta)
        return states.reshape(*times.shape, 2 * n)

    def __repr__(self) -> str:
        """One line."""
        return (
            f"AdaptiveSolution({self.phase[-1]:g} mesh cycles at {self.mesh_frequency:.6g} Hz, "
            f"{len(self.names)} coordinates, {self.steps} steps, {self.rejections} rejected, "
            f"{self.crossings} crossings, rtol {self.rtol:.1e})"
        )

    def _parts(self) -> Parts:
        parts, axes = super()._parts(), ("time", "coordinate")
        parts.variables["position"] = (axes, self.position, {"units": "m or rad"})
        parts.variables["velocity"] = (axes, self.velocity, {"units": "m/s or rad/s"})
        return parts


def _hermite(parts: Array, h: Array, theta: Array) -> Array:
    """Quintic Hermite interpolant of steps ``h`` and its derivative at the fractions ``theta``."""
    q0, v0, a0, mean, v1, a1 = (parts[:, k] for k in range(6))
    s, h = theta[:, None], h[:, None]
    (b5, b1, b4, b2, b3), (d5, d1, d4, d2, d3) = quintic_place(s), quintic_speed(s)
    position = q0 + h * (b5 * mean + b1 * v0 + b4 * v1 + h * (b2 * a0 + b3 * a1))
    velocity = d5 * mean + d1 * v0 + d4 * v1 + h * (d2 * a0 + d3 * a1)
    return np.hstack((position, velocity))


def solve_adaptive(
    system: System,
    mesh_frequency: float,
    cycles: int,
    start: tuple[ArrayLike, ArrayLike],
    rtol: float = 1e-6,
    atol: Tolerance | None = None,
    *,
    extra_force: ArrayLike | None = None,
) -> AdaptiveSolution:
    """Integrate a system over time in steps as short as a tolerance needs.

    Parameters
    ----------
    system, mesh_frequency, cycles, start
        As in :func:`simulate` [Hz], [m or rad, m/s or rad/s].
    rtol : float
        Error over the largest size so far of each state [-].
    atol : float, (position, velocity) or (2 n,) array, optional
        Error allowed on top of that [m or rad, m/s or rad/s]; by default 0.001 ``rtol`` times the
        size of the static state.
    extra_force
        As in :func:`simulate` [N or N*m].

    Raises
    ------
    InputError
        If an argument is out of range, or an entry jumps at a phase that is not an event.
    ComputationError
        If the motion grows beyond all bounds, or a contact chatters.

    Notes
    -----
    Dormand and Prince (1980), fifth order with an error of fourth order, PI step control. Steps end
    at events and, found on the dense output, where a contact changes its side.

    Examples
    --------
    >>> free = System([[1.0]], [[0.0]], [[4.0]], [0.0])
    >>> motion = solve_adaptive(free, 1.0, 3, ([1.0], [0.0]), rtol=1e-8)
    >>> bool(abs(motion(2.5)[0] - np.cos(5.0)) < 3e-8)
    True
    """
    require_number("mesh_frequency", mesh_frequency)
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    require_number("rtol", rtol)
    require_whole("cycles", cycles)
    state = read_start(system, start)
    extra, frequency = read_force(system, extra_force), np.array([float(mesh_frequency)])
    systems = [(system, np.arange(1))]
    (lane,) = adaptive_lanes(systems, frequency, cycles, extra[None, :], rtol, atol)
    trails, capacity, counts, n = [], _ROOM, np.zeros(2, dtype=np.int64), system.size

    (group,) = lane_groups([lane], 1)

    def march(task: tuple[Array, Array, int]) -> Any:
        state, trail, elapsed = task
        return group.march(state[None], 1, np.zeros(1), elapsed, trail=trail[None])[0]

    for cycle in range(cycles):
        memory, begin = lane.memory, state
        while True:
            trail, state = np.zeros((capacity, 2 + 6 * n)), begin.copy()
            # In a thread, so that an interruption stops it.
            (course,) = in_threads(march, [(state, trail, cycle)], 1)
            if course.steps <= capacity:
                break
            capacity, lane.memory = 2 * int(course.steps), memory
        trail[:, 0] += cycle
        trails.append(trail[: course.steps])
        counts += course.rejections, course.crossings
    trail = np.concatenate(trails)
    phase = np.append(trail[:, 0], float(cycles))
    return AdaptiveSolution(
        time=phase / mesh_frequency,
        phase=phase,
        state=np.concatenate((trail[:, 2 : 2 + 2 * n], state[None])),
        names=tuple(system.names),
        mesh_frequency=float(mesh_frequency),
        rtol=lane.rtol,
        atol=lane.atol,
        rejections=int(counts[0]),
        crossings=int(counts[1]),
        table_error=lane.table.error,
        _trail=trail,
    )
