"""A prescribed speed over time, and what a run-up marches on: grids and tables that follow it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.checks import require_whole
from tribodyn.dynamics.equations.grid import Grid, Nodes, evaluate_nodes, system_events
from tribodyn.dynamics.equations.program import Program, build_program
from tribodyn.dynamics.equations.step_limit import LIMIT, rate_on_grid
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_positive
from tribodyn.types import Array, Index

#: Pieces of a straight line that stand for a function of time.
_PIECES = 16384


@dataclass(frozen=True)
class SpeedProfile:
    """Mesh frequency over time as a chain of straight lines.

    Parameters
    ----------
    time : (k,) array
        Rising times of the corners [s].
    mesh_frequency : (k,) array
        Mesh frequency at the corners [Hz].

    Raises
    ------
    InputError
        If the times do not rise, or a mesh frequency is not positive.

    Notes
    -----
    On each piece the mesh phase is a parabola of time, so that time over phase and phase over time
    are exact.

    Examples
    --------
    >>> profile = SpeedProfile([0.0, 2.0], [100.0, 300.0])
    >>> profile
    SpeedProfile(2 s, 400 mesh cycles, 100 to 300 Hz)
    >>> float(profile.phase_at(1.0)), float(profile.time_at(150.0))
    (150.0, 1.0)
    """

    time: ArrayLike
    mesh_frequency: ArrayLike
    _phase: Array = field(default_factory=lambda: np.zeros(0), repr=False, compare=False)

    def __post_init__(self) -> None:
        time = np.atleast_1d(np.asarray(self.time, dtype=float))
        frequency = np.atleast_1d(np.asarray(self.mesh_frequency, dtype=float))
        if time.ndim != 1 or time.shape != frequency.shape or time.size < 2:
            raise InputError(
                f"times of the shape {time.shape} and mesh frequencies of the shape "
                f"{frequency.shape}",
                where="argument profile",
                why="A profile has at least two corners, each with its time and frequency",
                remedy="For example ([0.0, 10.0], [100.0, 800.0])",
            )
        remedy = "A standing gear makes no mesh cycles: begin and end at a low speed"
        require_positive("mesh_frequency", frequency, "Hz", remedy=remedy)
        if not np.all(np.isfinite(time)) or np.any(np.diff(time) <= 0.0):
            raise InputError(
                "the times of the profile do not rise",
                where="argument profile",
                why="Each corner comes after the one before",
                remedy="Give a sudden change of the speed a short time of its own",
            )
        time = time - time[0]
        mean = 0.5 * (frequency[1:] + frequency[:-1])
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "mesh_frequency", frequency)
        object.__setattr__(self, "_phase", np.append(0.0, np.cumsum(np.diff(time) * mean)))

    @property
    def duration(self) -> float:
        """Length [s]."""
        return float(np.asarray(self.time)[-1])

    @property
    def cycles(self) -> float:
        """Mesh cycles in it [-]."""
        return float(self._phase[-1])

    @property
    def lowest(self) -> float:
        """Lowest mesh frequency [Hz]."""
        return float(np.min(np.asarray(self.mesh_frequency)))

    @property
    def highest(self) -> float:
        """Highest mesh frequency [Hz]."""
        return float(np.max(np.asarray(self.mesh_frequency)))

    def _pieces(self, index: NDArray[np.intp]) -> tuple[Array, Array, Array, Array]:
        """Start time, start frequency, rate of change and start phase; level after the end."""
        time, frequency = np.asarray(self.time), np.asarray(self.mesh_frequency)
        rate = np.append(np.diff(frequency) / np.diff(time), 0.0)
        return time[index], frequency[index], rate[index], self._phase[index]

    def frequency_at(self, time: ArrayLike) -> Array:
        """Mesh frequency; after the end that of the end.

        Parameters
        ----------
        time : float or array
            Time from the beginning [s].

        Returns
        -------
        array [Hz]
        """
        return np.asarray(
            np.interp(
                np.asarray(time, float), np.asarray(self.time), np.asarray(self.mesh_frequency)
            )
        )

    def phase_at(self, time: ArrayLike) -> Array:
        """Mesh cycles made until a time.

        Parameters
        ----------
        time : float or array
            Time from the beginning [s].

        Returns
        -------
        array [-]
        """
        at = np.asarray(time, dtype=float)
        index = np.searchsorted(np.asarray(self.time), at, side="right") - 1
        start, frequency, rate, phase = self._pieces(np.maximum(index, 0))
        past = at - start
        return np.asarray(phase + past * (frequency + 0.5 * rate * past))

    def time_at(self, phase: ArrayLike) -> Array:
        """Time at which so many mesh cycles are made.

        Parameters
        ----------
        phase : float or array
            Mesh cycles from the beginning [-].

        Returns
        -------
        array [s]
        """
        at = np.asarray(phase, dtype=float)
        index = np.searchsorted(self._phase, at, side="right") - 1
        start, frequency, rate, first = self._pieces(np.maximum(index, 0))
        past = at - first
        # Rounding must not make a square negative where the speed falls to almost nothing.
        square = np.maximum(frequency**2 + 2.0 * rate * past, 0.0)
        return np.asarray(start + 2.0 * past / (frequency + np.sqrt(square)))

    def __repr__(self) -> str:
        """One line."""
        return (
            f"SpeedProfile({self.duration:.6g} s, {self.cycles:.6g} mesh cycles, "
            f"{self.lowest:.6g} to {self.highest:.6g} Hz)"
        )


def speed_ramp(
    low: float, high: float, duration: float, *, hold: float = 0.0, down: bool = False
) -> SpeedProfile:
    """Make a speed that rises evenly, stays, and falls as it rose.

    Parameters
    ----------
    low, high : float
        Mesh frequency at the beginning and at the end of the rise [Hz].
    duration : float
        Length of the rise, and of the fall [s].
    hold : float
        Time at the end of the rise [s].
    down : bool
        Whether the speed falls back.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> speed_ramp(100.0, 800.0, 5.0, hold=1.0, down=True)
    SpeedProfile(11 s, 5300 mesh cycles, 100 to 800 Hz)
    """
    require_positive("duration", duration, "s")
    if hold < 0.0:
        why = "A time is not negative"
        raise InputError(f"hold = {hold:g} s", "argument hold", why, "Give zero or more seconds")
    corners = [(0.0, low), (duration, high)]
    if hold > 0.0:
        corners.append((duration + hold, high))
    if down:
        corners.append((corners[-1][0] + duration, low))
    time, frequency = zip(*corners, strict=True)
    return SpeedProfile(time, frequency)


def read_profile(
    profile: SpeedProfile | tuple[ArrayLike, ArrayLike] | Callable[[Array], ArrayLike],
    duration: float | None = None,
) -> SpeedProfile:
    """Take a profile in any of its forms."""
    if isinstance(profile, SpeedProfile):
        return profile
    if callable(profile):
        if duration is None:
            what = "a function of time without its length"
            why = "A function does not tell when the run ends"
            raise InputError(what, "argument duration", why, "Give duration in seconds")
        require_positive("duration", duration, "s")
        time = np.linspace(0.0, duration, _PIECES + 1)
        return SpeedProfile(time, np.broadcast_to(np.asarray(profile(time), float), time.shape))
    try:
        corners, frequency = profile
    except (TypeError, ValueError) as error:
        what = "the profile is not a pair (time, mesh_frequency)"
        remedy = "Give ([0.0, 10.0], [100.0, 800.0]) or speed_ramp(100.0, 800.0, 10.0)"
        raise InputError(what, "argument profile", "A speed over time is needed", remedy) from error
    return SpeedProfile(np.asarray(corners, float), np.asarray(frequency, float))


#: ``omega_max * dt`` of the chosen steps; the damping that the integrator adds is then below 4e-5.
_FINE = 0.35
#: Fewest and most steps per mesh cycle, ratio between one grid and the next.
_FEWEST, _MOST, _LADDER = 256, 65536, 1.42


class Table(NamedTuple):
    """All systems on one grid."""

    grid: Grid
    nodes: tuple[Nodes, ...]
    programs: tuple[Program, ...]
    kept: Index  #: steps that begin at the samples
    slopes: Index  #: columns of the rows that are slopes over the mesh phase
    step_number: float  #: ``omega_max * dt`` at a mesh frequency of 1 Hz [-]


def systems_by_frequency(
    system: System | Mapping[float, System],
) -> tuple[Array, tuple[System, ...]]:
    """Take one system, or several over the mesh frequency."""
    if isinstance(system, System):
        return np.zeros(1), (system,)
    if not system:
        why = "The equations of motion belong to a system"
        remedy = "Give a System, or several by mesh frequency"
        raise InputError("no system", "argument system", why, remedy)
    frequency = np.array(sorted(system), dtype=float)
    require_positive("mesh_frequency", frequency, "Hz")
    found = tuple(system[each] for each in sorted(system))
    first = found[0]
    for at, other in zip(frequency, found, strict=True):
        same = other.size == first.size and len(other.contacts) == len(first.contacts)
        same = same and len(other.frictions) == len(first.frictions)
        same = same and all(
            np.allclose(getattr(other, name), getattr(first, name), rtol=1e-12, atol=0.0)
            for name in ("mass", "damping", "stiffness")
        )
        if not same or (other.balance is None) != (first.balance is None):
            raise InputError(
                f"the system at {at:g} Hz is another structure",
                where="argument system",
                why="Contacts, friction and loads may change with the speed; matrices, "
                "coordinates, the number of contacts and the balanced torque stay",
                remedy="Give systems of one structure",
            )
    return frequency, found


def blend_weight(known: Array, frequency: float) -> tuple[int, float]:
    """Find the two neighbouring systems at a speed."""
    last = known.size - 1
    if last == 0:
        return 0, 0.0
    left = min(max(int(np.searchsorted(known, frequency)) - 1, 0), last - 1)
    low, high = float(known[left]), float(known[left + 1])
    return left, min(max((frequency - low) / (high - low), 0.0), 1.0)


def sampled_grid(events: tuple[float, ...], steps: int, samples: int) -> Grid:
    """Divide the mesh cycle so that events and equally spaced samples are grid points."""
    jumps = np.array([*events, 1.0])
    marks = np.arange(1, samples) / samples
    apart = np.abs(marks[:, None] - jumps).min(axis=1) > 1e-9
    edges = np.sort(np.concatenate((jumps, marks[apart])))
    lengths = np.diff(edges)
    counts = np.maximum(np.ceil(lengths * steps - 1e-6).astype(np.int64), 1)
    within = np.concatenate([np.arange(count) for count in counts])
    width = np.repeat(lengths / counts, counts)
    left = np.repeat(edges[:-1], counts) + within * width
    segment = np.searchsorted(jumps, left + 0.5 * width, side="right") - 1
    first = np.zeros(left.size, dtype=np.bool_)
    first[np.flatnonzero(np.append(True, segment[1:] != segment[:-1]))] = True
    return Grid(left, width, first, jumps[segment], jumps[segment + 1])


class Tables:
    """Systems on grids that suit each speed, compiled where they are first needed."""

    def __init__(
        self, systems: tuple[System, ...], samples: int, lowest: float, steps: int | None
    ) -> None:
        self.systems, self.samples, self.fixed = systems, samples, steps
        events = sorted({event for system in systems for event in system_events(system)})
        near = [i for i in range(1, len(events)) if events[i] - events[i - 1] < 1e-9]
        self.events = tuple(event for i, event in enumerate(events) if i not in near)
        least = max(64, 2 * len(self.events))
        self.rate = max(rate_on_grid(system, least) for system in systems)
        self._made: dict[int, Table] = {}
        self._refuse(lowest)

    def _refuse(self, lowest: float) -> None:
        steps = self.fixed
        needed = self.rate / (LIMIT * lowest)
        if steps is not None:
            require_whole("steps", steps)
        if steps is not None and needed > steps:
            raise InputError(
                f"omega_max*dt = {LIMIT * needed / steps:.3f} with {steps} steps per mesh "
                f"cycle at {lowest:g} Hz and a fastest motion of {self.rate:.4g} rad/s",
                where="argument steps",
                why=f"The limit is {LIMIT}, and the lowest speed has the longest steps",
                remedy=f"Use at least {64 * int(np.ceil(needed / 64))} steps, or leave steps "
                "out: each speed then gets as many as it needs",
            )
        if needed > _MOST:
            raise InputError(
                f"{lowest:g} Hz needs {needed:.3g} steps per mesh cycle",
                where="argument profile",
                why=f"The fastest motion is {self.rate:.4g} rad/s; {_MOST} steps are the most",
                remedy=f"Begin at {self.rate / (LIMIT * _MOST):.3g} Hz or above; below it the "
                "load is carried statically",
            )

    def steps_at(self, frequency: float) -> int:
        """Steps per mesh cycle at a mesh frequency."""
        if self.fixed is not None:
            return int(self.fixed)
        needed = self.rate / (_FINE * frequency)
        level = np.ceil(np.log(max(needed / _FEWEST, 1.0)) / np.log(_LADDER) - 1e-9)
        return int(min(np.ceil(_FEWEST * _LADDER**level / 64.0) * 64, _MOST))

    def at(self, frequency: float) -> Table:
        """Tables for a mesh frequency."""
        steps = self.steps_at(frequency)
        if steps not in self._made:
            self._made[steps] = self._make(steps)
        return self._made[steps]

    def _make(self, steps: int) -> Table:
        grid = sampled_grid(self.events, steps, self.samples)
        nodes = [evaluate_nodes(system, grid) for system in self.systems]
        pairs = list(zip(self.systems, nodes, strict=True))
        programs = tuple(build_program(system, grid, node) for system, node in pairs)
        if len(programs) > 1:
            # A term that one speed has is kept at all.
            kept_terms = np.any([each.pattern for each in programs], axis=0)
            programs = tuple(
                build_program(system, grid, node, pattern=kept_terms) for system, node in pairs
            )
        if any(not np.array_equal(each.code, programs[0].code) for each in programs):
            raise InputError(
                "the systems differ in which terms there are",
                where="argument system",
                why="Rows of neighbouring speeds are blended term by term",
                remedy="Give every speed the same kinds of contacts: a gap everywhere or "
                "nowhere, loads that vary over the mesh cycle everywhere or nowhere",
            )
        marks = np.arange(self.samples) / self.samples
        kept = np.abs(grid.left[:, None] - marks).argmin(axis=0)
        number = self.rate * float(grid.width.max())
        return Table(grid, tuple(nodes), programs, kept, _slope_columns(programs[0]), number)


def _slope_columns(program: Program) -> Index:
    code, column, found = program.code, 0, []
    for j in range(int(code[1])):
        along, turning = int(code[4 + 4 * j]), int(code[5 + 4 * j])
        found.append(column + 3)
        found += range(column + 5 + along, column + 5 + along + turning)
        column += 5 + along + turning
    return np.array(found, dtype=np.int64)
