"""Torque and speed of a shaft that vary over its turns, and random loads."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array, ComplexArray

#: Most turns of a shaft after which its orders repeat.
_MOST_TURNS = 1000


class Shaft(NamedTuple):
    """A shaft during one period of the clock."""

    turns: Fraction  #: of the shaft in the period
    period: float  #: [s]
    inertia: float  #: of all that turns with the drive, reduced to this shaft [kg*m^2]


@dataclass(frozen=True, kw_only=True)
class ShaftExcitation:
    """What drives or loads a shaft and varies with time.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear whose shaft it acts on; in a machine the name of the shaft.
    """

    gear: str = "pinion"

    @property
    def _turns(self) -> Fraction:
        """Turns of the shaft after which it repeats; 0 where it repeats with any clock."""
        return Fraction(0)

    @property
    def _duration(self) -> float:
        """Least length of the period of the clock [s]."""
        return 0.0

    def _torque(self, shaft: Shaft) -> ComplexArray:
        """Peak amplitudes (k,) of the torque in the running sense at the harmonics of the clock."""
        return np.zeros(1, dtype=complex)


@dataclass(frozen=True, kw_only=True)
class _Orders(ShaftExcitation):
    """A series ``amplitude cos(order theta + phase)`` over the angle of the shaft."""

    orders: tuple[float, ...]
    phases: tuple[float, ...] = ()

    _sizes = ""
    _unit = ""
    _most = math.inf

    def __post_init__(self) -> None:
        for name in ("orders", self._sizes, "phases"):
            object.__setattr__(self, name, _numbers(getattr(self, name)))
        if not self.phases:
            object.__setattr__(self, "phases", (0.0,) * len(self.orders))
        if not self.orders:
            why, remedy = "Each order has an amplitude", "Give for example orders = (2.0,)"
            raise InputError("no order is given", Argument("orders"), why, remedy)
        require_between("orders", self.orders, 1e-3, 1e5, "")
        require_between(self._sizes, getattr(self, self._sizes), 0.0, self._most, self._unit)
        require_between("phases", self.phases, -2.0 * math.pi, 2.0 * math.pi, "rad")
        for name in (self._sizes, "phases"):
            if len(getattr(self, name)) != len(self.orders):
                what = f"{len(getattr(self, name))} {name} for {len(self.orders)} orders"
                why = "Each order has its own"
                raise InputError(what, Argument(name), why, "Give lists of the same length")
        for order in self.orders:
            if not math.isclose(_fraction(order), order, rel_tol=1e-9):
                what = f"order {order:.10g} does not repeat within {_MOST_TURNS} turns"
                nearest = _fraction(order)
                why = "The motion is computed over whole turns after which all repeats"
                remedy = f"The nearest order that does is {nearest} = {float(nearest):.10g}"
                raise InputError(what, Argument("orders"), why, remedy)

    @property
    def _turns(self) -> Fraction:
        """Turns of the shaft after which all orders repeat."""
        orders = [_fraction(order) for order in self.orders]
        return Fraction(
            math.lcm(*(order.denominator for order in orders)),
            math.gcd(*(order.numerator for order in orders)),
        )

    def _lines(self, shaft: Shaft) -> ComplexArray:
        """Peak amplitudes (k,) of the series."""
        at = [int(_fraction(order) * shaft.turns) for order in self.orders]
        lines = np.zeros(max(at) + 1, dtype=complex)
        for line, size, phase in zip(at, getattr(self, self._sizes), self.phases, strict=True):
            lines[line] += size * np.exp(1j * phase)
        return lines


@dataclass(frozen=True, kw_only=True)
class TorqueRipple(_Orders):
    """Torque that varies over the angle of a shaft: orders of an engine, cogging of a motor.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear on whose shaft the torque acts, at the input or at the output.
    orders : tuple of float
        Periods in a turn of the shaft; halves and other fractions extend the clock [1].
    torques : tuple of float
        Amplitude of each order [N*m].
    phases : tuple of float
        Phase of each order where tooth 1 comes into contact; zero by default [rad].

    Raises
    ------
    InputError
        If a value is out of range, the lists differ in length, or an order does not repeat within
        1000 turns.

    Notes
    -----
    The torque ``torque cos(order theta + phase)`` is positive in the running sense of the shaft
    and is added to the mean torque there. ``theta`` is the mean rotation of the shaft.

    Examples
    --------
    >>> TorqueRipple(gear="pinion", orders=(2.0, 4.0), torques=(20.0, 5.0)).phases
    (0.0, 0.0)
    """

    torques: tuple[float, ...]

    _sizes = "torques"
    _unit = "N*m"
    _most = 1e7

    def _torque(self, shaft: Shaft) -> ComplexArray:
        """The series itself."""
        return self._lines(shaft)


@dataclass(frozen=True, kw_only=True)
class SpeedFluctuation(_Orders):
    """Speed of a shaft that varies over its angle, as a universal joint or an engine makes it.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear whose shaft is driven so.
    orders : tuple of float
        Periods in a turn of the shaft [1].
    fluctuations : tuple of float
        Amplitude of each order over the mean speed [1].
    phases : tuple of float
        Phase of each order where tooth 1 comes into contact; zero by default [rad].

    Raises
    ------
    InputError
        As :class:`TorqueRipple`, or if a fluctuation exceeds 0.2.

    Notes
    -----
    The speed of the whole drive is ``Omega (1 + fluctuation cos(order Omega t + phase))``. The
    torque that this takes acts on the named shaft, and the mesh phase follows the rotation.

    Examples
    --------
    >>> SpeedFluctuation(orders=(2.0,), fluctuations=(0.01,)).orders
    (2.0,)
    """

    fluctuations: tuple[float, ...]

    _sizes = "fluctuations"
    _most = 0.2

    def _torque(self, shaft: Shaft) -> ComplexArray:
        """Torque that accelerates the drive as its speed demands."""
        lines = self._lines(shaft)
        rate = 2.0 * np.pi * np.arange(lines.size) / shaft.period
        mean = 2.0 * np.pi * float(shaft.turns) / shaft.period
        return np.asarray(1j * rate * shaft.inertia * mean * lines)


@dataclass(frozen=True, kw_only=True)
class RandomLoad(ShaftExcitation):
    """Random torque with a power spectral density, drawn anew for each seed.

    Parameters
    ----------
    gear : "pinion" or "wheel"
        Gear on whose shaft the torque acts.
    frequencies : tuple of float
        Rising frequencies of the corners of the density [Hz].
    densities : tuple of float
        One-sided power spectral density there, linear in between, zero outside [N^2*m^2/Hz].
    duration : float
        Length after which the draw repeats, at least [s].
    seed : int
        Number of the draw.

    Raises
    ------
    InputError
        If a value is out of range or the band holds no line of this duration.

    Notes
    -----
    A stationary Gaussian process: independent normal amplitudes at all harmonics of the period, so
    that the draw repeats without a jump and the motion under it is periodic. Its mean square
    scatters from draw to draw as that of a recording of this length.

    Examples
    --------
    >>> load = RandomLoad.of_rms(12.0, (20.0, 200.0), gear="wheel", duration=0.5)
    >>> round(load.densities[0], 3)
    0.8
    """

    frequencies: tuple[float, ...]
    densities: tuple[float, ...]
    duration: float = 1.0
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("frequencies", "densities"):
            object.__setattr__(self, name, _numbers(getattr(self, name)))
        require_positive("duration", self.duration, "s")
        object.__setattr__(self, "seed", require_whole("seed", self.seed, 0))
        _check_band(self.frequencies)
        require_between("densities", self.densities, 0.0, 1e12, "N^2*m^2/Hz")
        if len(self.densities) != len(self.frequencies):
            what = f"{len(self.densities)} densities for {len(self.frequencies)} frequencies"
            why, remedy = "Each corner of the density has both", "Give lists of the same length"
            raise InputError(what, Argument("densities"), why, remedy)
        if (self.frequencies[-1] - self.frequencies[0]) * self.duration < 1.0:
            band = f"{self.frequencies[0]:g} to {self.frequencies[-1]:g} Hz"
            why = f"The lines of {self.duration:g} s are {1.0 / self.duration:g} Hz apart"
            remedy = "Give a longer duration or a wider band"
            raise InputError(f"the band {band} has no line", Argument("duration"), why, remedy)

    @classmethod
    def of_rms(
        cls,
        torque: float,
        band: Iterable[float],
        *,
        gear: str = "pinion",
        duration: float = 1.0,
        seed: int = 0,
    ) -> RandomLoad:
        """White noise of a band.

        Parameters
        ----------
        torque : float
            Root mean square [N*m].
        band : (float, float)
            Its ends [Hz].
        gear : "pinion" or "wheel"
            Shaft on which it acts.
        duration : float
            Time after which the draw repeats [s].
        seed : int
            Of the draw.

        Raises
        ------
        InputError
            If a value is out of range.

        Examples
        --------
        >>> RandomLoad.of_rms(3.0, (10.0, 100.0)).densities
        (0.1, 0.1)
        """
        ends = _numbers(band)
        require_between("torque", torque, 0.0, 1e6, "N*m")
        _check_band(ends)
        if len(ends) != 2:
            what = f"{len(ends)} frequencies with an rms torque"
            why, remedy = "White noise has two ends", "Give two frequencies, or densities"
            raise InputError(what, Argument("frequencies"), why, remedy)
        density = torque**2 / (ends[1] - ends[0])
        return cls(
            gear=gear, frequencies=ends, densities=(density, density), duration=duration, seed=seed
        )

    @property
    def _duration(self) -> float:
        """Least period."""
        return self.duration

    def density(self, frequency: Array) -> Array:
        """One-sided power spectral density.

        Parameters
        ----------
        frequency : array [Hz]
            Frequencies.

        Returns
        -------
        array [N^2*m^2/Hz]
        """
        return np.interp(frequency, self.frequencies, self.densities, left=0.0, right=0.0)

    def _torque(self, shaft: Shaft) -> ComplexArray:
        """Normal amplitudes of all harmonics of the period in the band."""
        count = int(self.frequencies[-1] * shaft.period + 1e-9) + 1
        size = np.sqrt(self.density(np.arange(count) / shaft.period) / shaft.period)
        size[0] = 0.0
        draw = np.random.default_rng(self.seed).standard_normal((2, count))
        return np.asarray(size * (draw[0] + 1j * draw[1]))


def _numbers(values: Iterable[float] | float) -> tuple[float, ...]:
    return tuple(float(value) for value in np.atleast_1d(np.asarray(values, dtype=float)))


def _check_band(frequencies: tuple[float, ...]) -> None:
    require_between("frequencies", frequencies, 0.0, 1e5, "Hz")
    if len(frequencies) < 2 or any(np.diff(frequencies) <= 0.0):
        what = f"frequencies = {list(frequencies)} Hz"
        why, remedy = "A band has at least two frequencies, rising", "Give for example 20 and 200"
        raise InputError(what, Argument("frequencies"), why, remedy)


def _fraction(order: float) -> Fraction:
    return Fraction(order).limit_denominator(_MOST_TURNS)
