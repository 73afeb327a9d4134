"""Run-ups: a prescribed speed, the time at which each phase is reached, and the result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.drawing import draw
from tribodyn.dynamics.time.ensemble import LaneStatistics
from tribodyn.errors import InputError, no_such, require_positive
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, Index, Mask

if TYPE_CHECKING:
    from tribodyn.dynamics.linear.natural_modes import NaturalModes


#: Linear pieces that approximate a function of time.
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
            what = "the times of the profile do not rise"
            why = "Each corner is later than the previous one"
            remedy = "Spread a sudden change of the speed over a short time"
            raise InputError(what, "argument profile", why, remedy)
        time = time - time[0]
        mean = 0.5 * (frequency[1:] + frequency[:-1])
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "mesh_frequency", frequency)
        object.__setattr__(self, "_phase", np.append(0.0, np.cumsum(np.diff(time) * mean)))

    def times(self, factor: float) -> SpeedProfile:
        """The profile with all frequencies times a factor.

        Parameters
        ----------
        factor : float
            Above zero [1].

        Returns
        -------
        SpeedProfile
        """
        if factor == 1.0:
            return self
        return SpeedProfile(self.time, np.asarray(self.mesh_frequency) * factor)

    @property
    def duration(self) -> float:
        """Length [s]."""
        return float(np.asarray(self.time)[-1])

    @property
    def cycles(self) -> float:
        """Number of mesh cycles [-]."""
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
        """Start time, start frequency, rate of change and start phase; constant after the end."""
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
        """Mesh cycles completed until a time.

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
        """Time at which a number of mesh cycles is completed.

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
        # Rounding must not make the square negative where the speed falls to almost zero.
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
    """Speed profile that rises linearly, and optionally stays and falls at the same rate.

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
    """Convert a profile from any of its forms."""
    if isinstance(profile, SpeedProfile):
        return profile
    if callable(profile):
        if duration is None:
            what = "duration is missing for a profile that is a function of time"
            why = "A function does not define when the run ends"
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


@dataclass(frozen=True)
class CycleStatistics:
    """Figures of every mesh cycle of a run-up, exact to the order of the integrator."""

    time: Array  #: [Hz]
    mesh_frequency: Array  #: [Hz]
    rate: Array  #: mean change of the mesh frequency [Hz/s]
    deflection: LaneStatistics = field(repr=False)  #: [m, N, m/s^2 or rad/s^2, as given]
    contact_force: LaneStatistics = field(repr=False)  #: [m, N, m/s^2 or rad/s^2, as given]
    acceleration: LaneStatistics = field(repr=False)  #: [m, N, m/s^2 or rad/s^2, as given]
    output: LaneStatistics = field(repr=False)  #: [m, N, m/s^2 or rad/s^2, as given]
    contact_loss_share: Array = field(repr=False)  #: part of the cycle off the driving flank [-]
    extra_force: Array = field(repr=False)  #: [N or N*m]
    steps: Index = field(repr=False)  #: integration steps
    #: Contacts of which the teeth are apart where they are open: the last to open of each mesh.
    last_to_open: Mask = field(repr=False)

    def __repr__(self) -> str:
        """One line."""
        return f"CycleStatistics({self.time.size} mesh cycles)"


@record
class RunUp(Record):
    """Motion while the speed changes as prescribed, sampled equally in the mesh phase.

    Parameters
    ----------
    time : (m,) array
        Time [s].
    phase : (m,) array
        Mesh cycles from the beginning [-].
    mesh_frequency : (m,) array
        Mesh frequency [Hz].
    position, velocity, acceleration : (m, n) array
        Coordinates and their derivatives [m or rad, ...], without the free rotation's drift.
    deflection, contact_force : (m, contacts) array
        Compression [m] and force [N] of the contacts.
    output : (m, o) array
        Further outputs [``output_unit``].
    names, output_names : tuple of str
        Names of the coordinates and of the outputs.
    output_unit : str
        Unit of the outputs.
    samples : int
        Samples of a mesh cycle.
    teeth : int
        Mesh cycles per revolution of the shaft whose speed is reported.
    cycles : CycleStatistics
        Figures of every mesh cycle.
    profile : SpeedProfile
        The prescribed speed.
    step_number : float
        Largest ``omega_max * dt`` [-].
    modes : NaturalModes, optional
        Natural modes of the system in the middle of the speed range; None without any.
    """

    time: Array = quantity("time", unit="s", axis=True)
    phase: Array = quantity("time", unit="1", axis=True)
    mesh_frequency: Array = quantity("time", unit="Hz", axis=True)
    position: Array = quantity("time", "coordinate", unit="m or rad")
    velocity: Array = quantity("time", "coordinate", unit="m/s or rad/s")
    acceleration: Array = quantity("time", "coordinate", unit="m/s^2 or rad/s^2")
    deflection: Array = quantity("time", "contact", unit="m")
    contact_force: Array = quantity("time", "contact", unit="N")
    output: Array = quantity("time", "output_name", unit="@output_unit")
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    output_names: tuple[str, ...] = quantity("output_name", axis=True, name="output_name")
    output_unit: str
    samples: int = fact()
    teeth: int = fact()
    cycles: CycleStatistics
    profile: SpeedProfile
    step_number: float = fact(name="omega_max_dt")
    modes: NaturalModes | None = field(default=None, repr=False)

    @property
    def speed(self) -> Array:
        """Speed of the shaft at the samples, (m,) [rad/s]."""
        return 2.0 * np.pi * self.mesh_frequency / self.teeth

    @property
    def rotation(self) -> Array:
        """Angle of the shaft at the samples, (m,) [rad]."""
        return 2.0 * np.pi * self.phase / self.teeth

    def signal(self, name: str) -> tuple[Array, str]:
        """Return one signal by its name.

        Parameters
        ----------
        name : str
            ``"deflection"`` (first contact), ``"contact_force"`` (sum of all contacts), the name
            of a coordinate (its acceleration) or of an output.

        Returns
        -------
        tuple of (m,) array and str
            The samples and their unit.

        Raises
        ------
        InputError
            If there is no such signal.
        """
        if name == "deflection" and self.deflection.shape[1]:
            return self.deflection[:, 0], "m"
        if name == "contact_force" and self.contact_force.shape[1]:
            return np.asarray(self.contact_force.sum(axis=1)), "N"
        if name in self.names:
            unit = "rad/s^2" if "theta" in name else "m/s^2"
            return self.acceleration[:, self.names.index(name)], unit
        if name in self.output_names:
            return self.output[:, self.output_names.index(name)], self.output_unit
        signals = ("deflection", "contact_force", *self.names, *self.output_names)
        raise InputError(no_such("signal", name, signals, "argument signal"))

    def __repr__(self) -> str:
        """One line."""
        beat = np.asarray(self.profile.mesh_frequency)
        loss = self.cycles.contact_loss_share[:, self.cycles.last_to_open]
        lost = float(np.max(loss, initial=0.0))
        top, count = self.profile.highest, len(self.names)
        back = f" and back to {beat[-1]:.6g}" if beat[-1] < top else ""
        return (
            f"RunUp({self.profile.duration:.6g} s, {self.cycles.time.size} mesh cycles, mesh "
            f"frequency {beat[0]:.6g} to {top:.6g}{back} Hz, "
            f"{count} coordinate{'s' if count > 1 else ''}, "
            f"{self.samples} samples per cycle{', teeth separate' if lost > 0.0 else ''})"
        )

    def plot_map(self) -> Any:
        """Draw amplitudes over speed and frequency, with mesh orders and natural modes.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, "run_up_map")

    def _units(self, unit: str | None) -> dict[str, str]:
        return {"units": self.output_unit} if unit == "@output_unit" else super()._units(unit)

    def _parts(self) -> Parts:
        variables, coordinates, _ = parts = super()._parts()
        cycles, cycle = self.cycles, "mesh_cycle"
        for name in ("acceleration", "deflection", "contact_force", "output"):
            (_, kind), _, units = variables[name]
            for figure in ("mean", "rms", "minimum", "maximum"):
                values = getattr(getattr(cycles, name), figure)
                variables[f"{name}_{figure}"] = ((cycle, kind), values, units)
        loss, force = cycles.contact_loss_share, cycles.extra_force
        variables["contact_loss_share"] = ((cycle, "contact"), loss, {"units": "1"})
        variables["extra_force"] = ((cycle, "coordinate"), force, {"units": "N or N*m"})
        coordinates["speed"] = ("time", self.speed, {"units": "rad/s"})
        coordinates["cycle_time"] = (cycle, cycles.time, {"units": "s"})
        coordinates["cycle_mesh_frequency"] = (cycle, cycles.mesh_frequency, {"units": "Hz"})
        return parts
