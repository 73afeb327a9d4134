"""A system whose shafts are driven by torques and speeds that vary over the turns."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_one_of, require_positive
from tribodyn.faults.excitation import Shaft, ShaftExcitation, SpeedFluctuation
from tribodyn.types import Array, ComplexArray, Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import System

#: Lines of a series that is summed at each place, and points of a spline for its highest line.
_SUMMED, _POINTS = 64, 64
#: Largest change of the mesh frequency over its mean for which its mean defines the motion.
_FLUCTUATION = 0.3
#: Part of the forces of a rotation that springs and dampers may have in a free drive.
_FREE = 1e-9


class Series:
    """A periodic function of the clock from its peak amplitudes (k,) or (k, n)."""

    #: It jumps nowhere.
    event_phases: tuple[float, ...] = ()

    def __init__(self, lines: ComplexArray) -> None:
        self.lines = lines
        self._spline: Callable[[Array], Array] | None = None

    def derivative(self, count: int = 1) -> Series:
        """Derivative by the clock."""
        order = 2j * np.pi * np.arange(len(self.lines))
        return Series((self.lines.T * order**count).T)

    def __call__(self, clock: Array | float) -> Array:
        """Values at phases of the clock, (p,) or (p, n)."""
        place = np.asarray(clock, dtype=float)
        used = np.flatnonzero(self.lines.reshape(len(self.lines), -1).any(axis=1))
        if used.size <= _SUMMED:
            turned = np.exp(2j * np.pi * np.multiply.outer(place, used))
            return np.asarray((turned @ self.lines[used]).real)
        if self._spline is None:
            from scipy.interpolate import CubicSpline

            points = _POINTS * len(self.lines)
            halves = np.concatenate([2.0 * self.lines[:1], self.lines[1:]])
            values = np.fft.irfft(0.5 * points * halves, points, axis=0)
            ends = np.arange(points + 1) / points
            self._spline = CubicSpline(ends, [*values, values[0]], bc_type="periodic")
        return np.asarray(self._spline(place % 1.0))


class PhaseSeries:
    """Sum of periodic functions, each of a sum of the phases."""

    def __init__(self, parts: Sequence[tuple[tuple[int, ...], Series]]) -> None:
        self.parts = [(np.array(cycles), series) for cycles, series in parts]
        #: Highest number of each phase.
        self.orders = np.max(
            [np.abs(cycles) * (len(each.lines) - 1) for cycles, each in self.parts], axis=0
        )

    def values(self, points: Array) -> Array:
        """Values at points (p, phases), (p,) or (p, n)."""
        return np.asarray(sum(each(points @ cycles) for cycles, each in self.parts))

    __call__: Callable[..., Any] = values


class Lead(PhaseSeries):
    """Time by which an unsteady rotation is ahead of its mean [s], and its slopes."""

    def __call__(self, points: Array) -> tuple[Array, Array]:  # type: ignore[override]
        """Time (p,) at points (p, phases), zero at the start, and its slopes (p, phases)."""
        slopes = [
            np.multiply.outer(each.derivative()(points @ cycles), cycles)
            for cycles, each in self.parts
        ]
        ahead = self.values(points) - self.values(np.zeros((1, points.shape[1])))
        return ahead, np.asarray(sum(slopes))


class _Warped:
    """An entry over a clock that runs unevenly: a function of the even one."""

    def __init__(self, function: Any, clock: _UnevenClock) -> None:
        self.function, self.clock = function, clock
        self.cycles = getattr(function, "cycles", 1)

    def __call__(self, clock: Array) -> Any:
        """Values at phases of the even clock."""
        return self.function(self.clock.place(clock) % 1.0)

    def __getattr__(self, name: str) -> Any:
        if name == "event_phases":
            return self.clock.times(self.function.event_phases)
        raise AttributeError(name)


class _UnevenClock:
    """Place of the mesh over the even clock: ``c + lead(c) - lead(0)``."""

    def __init__(self, lead: Series) -> None:
        self.lead, self.rate = lead, lead.derivative()
        self.start = float(lead(0.0))

    def place(self, clock: Array) -> Array:
        """Place that the mesh has reached."""
        return np.asarray(clock + self.lead(clock) - self.start)

    def times(self, events: Sequence[float]) -> tuple[float, ...]:
        """Phases of the even clock at which the mesh reaches its events, sorted."""
        places = np.asarray(events, dtype=float)
        clock = places.copy()
        for _ in range(60):
            step = (self.place(clock) - places) / (1.0 + self.rate(clock))
            clock = clock - step
            if np.abs(step).max(initial=0.0) < 1e-15:
                break
        return tuple(np.unique(clock % 1.0 % 1.0).tolist())


class DrivenSystem(NamedTuple):
    """A system with its excitation.

    Parameters
    ----------
    system : System
        Over a clock of all mesh cycles.
    cycles : int
        Mesh cycles of the clock.
    lead : callable
        Mesh cycles by which the rotation of the drive is ahead of its mean; takes the clock.
    rotation : (n,) array
        Change of the coordinates in a mesh cycle of the drive [rad]; zero where it cannot turn.
    """

    system: System
    cycles: int
    lead: Series
    rotation: Array


def clock_cycles(
    cycles: int,
    excitations: Sequence[ShaftExcitation],
    teeth: Mapping[str, int | Fraction],
    mesh_frequency: float,
) -> int:
    """Mesh cycles until gears and excitations repeat.

    Parameters
    ----------
    cycles : int
        Mesh cycles after which the gears repeat.
    excitations : sequence of ShaftExcitation
        What varies over the shafts.
    teeth : mapping of str to int or Fraction
        Mesh cycles in a turn of each shaft: of a pair the numbers of teeth of ``"pinion"`` and
        ``"wheel"``.
    mesh_frequency : float
        Mesh cycles per second [Hz].

    Returns
    -------
    int

    Raises
    ------
    InputError
        If an excitation acts on another shaft.

    Examples
    --------
    A half order of an engine repeats after two turns.

    >>> from tribodyn.faults import TorqueRipple
    >>> ripple = TorqueRipple(gear="pinion", orders=(0.5, 1.0), torques=(5.0, 9.0))
    >>> clock_cycles(24, [ripple], {"pinion": 16, "wheel": 24}, 800.0)
    96
    """
    for each in excitations:
        require_one_of("gear", each.gear, tuple(teeth))
        if each._turns:
            cycles = math.lcm(cycles, Fraction(teeth[each.gear] * each._turns).numerator)
    duration = max((each._duration for each in excitations), default=0.0)
    return cycles * max(math.ceil(duration * mesh_frequency / cycles - 1e-9), 1)


def drive(
    system: System,
    cycles: int,
    excitations: Sequence[ShaftExcitation],
    *,
    mesh_frequency: float,
    teeth: Mapping[str, int | Fraction],
    coordinates: Mapping[str, int | Array],
    rotation: ArrayLike | None,
    fixed_phase: bool = False,
) -> DrivenSystem:
    """Let torques and speeds of the shafts vary.

    Parameters
    ----------
    system : System
        Its clock is ``cycles`` mesh cycles long.
    cycles : int
        Mesh cycles after which its teeth repeat.
    excitations : sequence of ShaftExcitation
        What varies over the shafts.
    mesh_frequency : float
        Mean mesh cycles per second [Hz].
    teeth : mapping of str to int or Fraction
        Mesh cycles in a turn of each shaft: of a pair the numbers of teeth of ``"pinion"`` and
        ``"wheel"``.
    coordinates : mapping of str to int or (n,) array
        Number of the coordinate on which the torque of each shaft acts, or its force on all
        coordinates per unit of torque.
    rotation : (n,) array, optional
        Change of the coordinates in a mesh cycle [rad].
    fixed_phase : bool
        Whether the mesh phase is that of the mean speed and its prescribed fluctuation alone, and
        does not follow the rotation that torques cause.

    Returns
    -------
    DrivenSystem

    Raises
    ------
    InputError
        If the speed would fluctuate by more than 30 %, or a speed is prescribed for a drive that
        cannot turn freely.

    Notes
    -----
    The torque is split: one part accelerates the whole drive as a rigid body by ``theta'' =
    T/J``, whose fluctuating rotation moves the mesh phase and is ``lead``; the rest, with the
    inertia forces of that acceleration, loads the elastic structure and leaves the mean rotation
    alone. The angle of a ripple is that of the mean rotation.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact, System
    >>> from tribodyn.faults import TorqueRipple
    >>> pair = System(np.eye(2), np.zeros((2, 2)), np.zeros((2, 2)), [3.0, -3.0],
    ...     [Contact([1.0, -1.0], 50.0, damping=0.3)])
    >>> ripple = TorqueRipple(gear="pinion", orders=(1.0,), torques=(0.1,))
    >>> driven = drive(pair, 1, [ripple], mesh_frequency=2.0, teeth={"pinion": 4, "wheel": 4},
    ...     coordinates={"pinion": 0, "wheel": 1}, rotation=[1.5, 1.5])
    >>> driven.cycles, np.round(driven.system.force(np.array([0.0])), 6).tolist()
    (4, [[3.05, -3.05]])
    """
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    total = clock_cycles(cycles, excitations, teeth, mesh_frequency)
    period, mass = total / mesh_frequency, np.asarray(system.mass)
    turning = _free_rotation(system, rotation, excitations)
    lead = moving = np.zeros(1, dtype=complex)  # of the drive, and of its mesh
    force = np.zeros((1, system.size), dtype=complex)
    for each in excitations:
        at, turns = coordinates[each.gear], Fraction(total) / teeth[each.gear]
        row = np.eye(system.size)[at] if isinstance(at, int) else at
        push, ahead_by = _lines_of(each, (turns, period), row, turning, mass)
        force, lead = _sum(force, push), _sum(lead, ahead_by)
        if isinstance(each, SpeedFluctuation) or not fixed_phase:
            moving = _sum(moving, ahead_by)
    ahead = Series(lead)
    _refuse_large(Series(moving), total)
    steady = system.force
    if callable(steady):
        raise InputError("the force varies", "System.force", "It is the mean load", "Give numbers")
    force[0] += np.asarray(steady, dtype=float)
    driven = _on_longer_clock(system, total // cycles)
    driven = replace(driven, force=Series(force) if len(force) > 1 else force[0].real)
    if np.abs(moving).max() > 1e-13:
        driven = _on_uneven_clock(
            driven, _UnevenClock(Series(np.asarray(moving / total, dtype=complex)))
        )
    return DrivenSystem(driven, total, ahead, turning)


def drive_over_phases(
    system: System,
    driven: Sequence[tuple[ShaftExcitation, tuple[int, ...], float, Array]],
    rotation: Array,
) -> tuple[System, Lead | None]:
    """Let torques and speeds vary over phases of their own; the time by which they lead it."""
    # For each excitation: cycles over each phase, turns of its shaft per second, and the force on
    # the coordinates per torque; the rotation is the speed of the coordinates [rad/s].
    turning = _free_rotation(system, rotation, [each for each, *_ in driven])
    mass, forces, leads, change = np.asarray(system.mass), [], [], 0.0
    for each, cycles, speed, row in driven:
        turns, period = repeats_after(each, speed)
        push, ahead = _lines_of(each, (turns, period), row, turning, mass)
        forces.append((cycles, Series(push)))
        leads.append((cycles, Series(ahead)))
        at = np.arange(4 * len(ahead)) / (4 * len(ahead))
        change += float(np.abs(leads[-1][1].derivative()(at)).max()) / period
    _refuse_fluctuation(change)
    none = (0,) * len(driven[0][1])
    steady = Series(np.asarray(system.force, dtype=float)[None].astype(complex))
    lead = Lead(leads) if change > 1e-13 else None
    return replace(system, force=PhaseSeries([*forces, (none, steady)]), lead=lead), lead


def repeats_after(each: ShaftExcitation, speed: float) -> tuple[Fraction, float]:
    """Turns of a shaft with these turns per second, and time, after which it varies anew [s]."""
    turns = each._turns or Fraction(each._duration * speed)
    return turns, float(turns) / speed if each._turns else each._duration


def _lines_of(
    each: ShaftExcitation, clock: tuple[Fraction, float], row: Array, turning: Array, mass: Array
) -> tuple[ComplexArray, ComplexArray]:
    """Force (k, n), and rotations by which the drive is ahead (k,), over turns and a period."""
    turned, inertia = float(turning @ row), float(turning @ mass @ turning)
    torque = each._torque(Shaft(*clock, inertia / turned**2 if inertia else 0.0))
    acceleration = torque * (turned / inertia if inertia else 0.0)
    push = np.multiply.outer(torque, row)
    rate = 2.0 * np.pi * np.maximum(np.arange(torque.size), 1) / clock[1]
    force = push - np.multiply.outer(acceleration, mass @ turning)
    return np.asarray(force, dtype=complex), np.asarray(-acceleration / rate**2, dtype=complex)


def _free_rotation(
    system: System, rotation: ArrayLike | None, excitations: Sequence[ShaftExcitation]
) -> Array:
    """Rotation of the drive in a mesh cycle; zero where springs or dampers hold it."""
    turning = np.zeros(system.size) if rotation is None else np.asarray(rotation, dtype=float)
    forces = np.concatenate([np.asarray(system.stiffness) @ turning, system.rate_matrix @ turning])
    size = np.abs(system.stiffness).max() + np.abs(system.rate_matrix).max()
    if np.abs(forces).max() > _FREE * size * np.abs(turning).max():
        turning = np.zeros(system.size)
    if not turning.any() and any(isinstance(each, SpeedFluctuation) for each in excitations):
        why = "A prescribed speed turns the whole drive, which has no springs to the ground"
        raise InputError(
            "the drive cannot turn freely", "argument excitations", why, "Give a torque ripple"
        )
    return turning


def _sum(first: ComplexArray, second: Array | ComplexArray) -> ComplexArray:
    """Sum of two series of lines, of which one may be longer."""
    total = np.zeros((max(len(first), len(second)), *first.shape[1:]), dtype=complex)
    total[: len(first)] += first
    total[: len(second)] += second
    return total


def _refuse_large(lead: Series, cycles: int) -> None:
    """Refuse excitations under which the mean speed says little."""
    change = lead.derivative()(np.arange(4 * len(lead.lines)) / (4 * len(lead.lines))) / cycles
    _refuse_fluctuation(float(np.abs(change).max()))


def _refuse_fluctuation(largest: float) -> None:
    if largest > _FLUCTUATION:
        raise InputError(
            f"the speed of the drive fluctuates by {100.0 * largest:.3g} % of its mean",
            "argument excitations",
            f"Up to {100.0 * _FLUCTUATION:g} % the motion is one about a mean speed; the drive has "
            "little inertia for such a torque at this speed",
            "Lower the amplitudes, raise the speed, or add the inertia of the machines on the "
            "shafts to the moments of inertia",
        )


def _on_longer_clock(system: System, periods: int) -> System:
    """The system over several of its periods."""
    from tribodyn.dynamics.equations.phases import on_one_clock

    if periods == 1:
        return system
    contacts = [
        replace(
            each,
            cycles=periods * each.cycles,
            turning_error=[turned.error for turned in each.turning],
            turning_cycles=[(periods * turned.cycles[0],) for turned in each.turning],
        )
        for each in on_one_clock(system)
    ]
    return replace(system, contacts=contacts)


def _on_uneven_clock(system: System, clock: _UnevenClock) -> System:
    """The system with its contacts and frictions over the uneven clock."""
    parts: Tree = {"contacts": [], "frictions": []}
    for name, clocked in (
        ("contacts", system.clocked_contacts),
        ("frictions", system.clocked_frictions),
    ):
        for part in clocked:
            entries = {key: value for key, value in vars(part).items() if callable(value)}
            warped = {key: _Warped(value, clock) for key, value in entries.items()}
            changed: Tree = {"events": clock.times(part.events), **warped}
            parts[name].append(replace(part, **changed))
    return replace(system, **parts)
