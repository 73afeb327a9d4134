"""Time-synchronous average: separate what repeats with the shaft from what does not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.errors import ComputationError, InputError, require_positive
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.signals.angular_resampling import (
    angular_resampling,
    checked_rising,
    checked_signal,
    shaft_rotation,
)
from tribodyn.types import Array


@record
class SynchronousAverage(Record):
    """Mean revolution of a shaft.

    Parameters
    ----------
    angle : (n,) array
        Angle of the shaft from the first sample [rad].
    signal : (n,) array
        Mean over all revolutions, in the unit of the signal.
    scatter : (n,) array
        Standard error of the mean at each angle, in the unit of the signal.
    revolutions : int
        Number of revolutions averaged.
    teeth : int
        Number of teeth on the shaft, the order of the mesh.
    unit : str
        Unit of the signal.
    """

    angle: Array = quantity("angle", unit="rad", axis=True)
    signal: Array = quantity("angle", unit="@unit")
    scatter: Array = quantity("angle", unit="@unit")
    revolutions: int = fact()
    teeth: int = fact()
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        swing = float(np.ptp(self.signal))
        error = float(np.sqrt(np.mean(self.scatter**2)))
        return (
            (
                f"SynchronousAverage({self.revolutions} revolutions, {self.teeth} teeth, "
                f"peak to peak {swing:.4g} {self.unit}, standard error {error:.2g} {self.unit})"
            )
            .replace(" ,", ",")
            .replace(" )", ")")
        )

    def mesh_amplitudes(self, count: int = 5) -> Array:
        """Amplitudes of the mesh harmonics.

        Parameters
        ----------
        count : int
            Number of harmonics.

        Returns
        -------
        (count,) array
            Peak amplitudes, in the unit of the signal; zero above half the samples of a revolution.
        """
        lines = 2.0 * np.abs(np.fft.rfft(self.signal)) / self.signal.size
        orders = self.teeth * np.arange(1, count + 1)
        resolved = orders < self.signal.size / 2
        return np.where(resolved, lines[np.where(resolved, orders, 0)], 0.0)

    def residual(self, shaft_orders: int = 2) -> Array:
        """Mean revolution less its mean, the mesh harmonics and the lowest shaft orders.

        Parameters
        ----------
        shaft_orders : int
            Highest shaft order that is taken out; 0 leaves them.

        Returns
        -------
        (n,) array
            In the unit of the signal.
        """
        return self._without(shaft_orders, 0)

    def difference(self, shaft_orders: int = 2) -> Array:
        """Residual less the first sidebands of all mesh harmonics.

        Parameters
        ----------
        shaft_orders
            As for :meth:`residual`.

        Returns
        -------
        (n,) array
            In the unit of the signal.
        """
        return self._without(shaft_orders, 1)

    def _without(self, shaft_orders: int, sidebands: int) -> Array:
        lines = np.fft.rfft(self.signal)
        lines[: shaft_orders + 1] = 0.0
        for mesh in range(self.teeth, lines.size + sidebands, self.teeth):
            lines[max(mesh - sidebands, 0) : mesh + sidebands + 1] = 0.0
        return np.asarray(np.fft.irfft(lines, self.signal.size))

    def _parts(self) -> Parts:
        parts, units = super()._parts(), self._units("@unit")
        parts.variables["residual"] = ("angle", self.residual(), units)
        parts.variables["difference"] = ("angle", self.difference(), units)
        return parts


def time_synchronous_average(
    signal: Any,
    time: Any,
    *,
    teeth: int,
    rotation: Any = None,
    speed: Any = None,
    mesh_harmonics: int = 5,
    unit: str = "",
) -> SynchronousAverage:
    """Average a signal over the revolutions of a shaft.

    Parameters
    ----------
    signal, time
        As in :func:`tribodyn.analysis.order_map` [s].
    teeth : int
        Number of teeth of the gear on the shaft.
    rotation, speed
        As in :func:`tribodyn.analysis.order_map` [rad], [rad/s].
    mesh_harmonics : int
        Mesh harmonics that must come through.
    unit : str
        Unit of the signal, for display.

    Raises
    ------
    InputError
        If the record is not finite, does not rise, holds less than two revolutions or was
        sampled with less than twice the highest mesh harmonic.

    Notes
    -----
    The signal is resampled over the rotation (:func:`tribodyn.analysis.order_map` does the same)
    and the revolutions are averaged: what does not repeat falls with the square root of their
    number (S. Braun, Acustica 32 (1975) 69; P. D. McFadden, Mechanical Systems and Signal
    Processing 1 (1987) 83).

    Examples
    --------
    >>> time = np.linspace(0.0, 2.0, 20001)
    >>> turn = 2 * np.pi * 10.0 * time
    >>> wave = np.cos(16 * turn) + 0.2 * np.cos(7.3 * turn)
    >>> average = time_synchronous_average(wave, time, teeth=16, speed=2 * np.pi * 10.0)
    >>> average.revolutions, round(float(average.mesh_amplitudes(1)[0]), 3)
    (20, 1.0)
    """
    values = checked_signal(signal, 16)
    moments = checked_rising(time, values.size, "time", "s")
    require_positive("teeth", teeth)
    require_positive("mesh_harmonics", mesh_harmonics)
    angle = shaft_rotation(rotation, speed, moments)
    highest = teeth * mesh_harmonics + 2
    per_turn = 2 * int(np.ceil(1.3 * highest))
    resampled = angular_resampling(
        values, moments, angle, samples_per_revolution=per_turn, highest_order=float(highest)
    )
    count = resampled.signal.size // per_turn
    if count < 2:
        what = f"the record holds {resampled.signal.size / per_turn:.3g} revolutions"
        why = "An average needs two complete revolutions"
        raise InputError(what, "argument rotation", why, "Record longer")
    turns = resampled.signal[: count * per_turn].reshape(count, per_turn)
    return SynchronousAverage(
        2.0 * np.pi * np.arange(per_turn) / per_turn,
        turns.mean(axis=0),
        turns.std(axis=0, ddof=1) / np.sqrt(count),
        count,
        teeth,
        unit,
    )


@dataclass(frozen=True)
class ConditionIndicators:
    """Numbers that grow when teeth are damaged.

    Parameters
    ----------
    crest_factor : float
        Largest distance of the mean revolution from its mean over its alternating rms [-].
    kurtosis : float
        Of the mean revolution: fourth moment over the square of the second [-].
    fm0 : float
        Peak-to-peak value over the sum of the amplitudes of the mesh harmonics [-].
    fm4 : float
        Kurtosis of the difference signal [-]; 3 for noise, 1.5 for a sine.
    na4 : float
        Fourth moment of the residual over the square of the mean second moment of the residuals
        of this and all earlier records [-].
    """

    crest_factor: float
    kurtosis: float
    fm0: float
    fm4: float
    na4: float

    def __repr__(self) -> str:
        """One line."""
        return (
            f"ConditionIndicators(crest factor {self.crest_factor:.4g}, kurtosis "
            f"{self.kurtosis:.4g}, FM0 {self.fm0:.4g}, FM4 {self.fm4:.4g}, NA4 {self.na4:.4g})"
        )


def kurtosis(signal: Any) -> float:
    """Fourth central moment over the square of the second.

    Parameters
    ----------
    signal : (n,) array
        Signal in any unit.

    Returns
    -------
    float
        3 for a normal distribution, 1.5 for a sine, 1 for a square wave [-].

    Raises
    ------
    ComputationError
        If the signal does not change.

    Examples
    --------
    >>> round(kurtosis(np.cos(2 * np.pi * np.arange(64) / 64)), 12)
    1.5
    """
    values = checked_signal(signal, 4)
    away = values - values.mean()
    second = float(np.mean(away**2))
    if second <= (1e-14 * float(np.abs(values).max())) ** 2:
        what = "the kurtosis of a signal that does not change"
        why = "It is a moment over the variance, which is zero"
        raise ComputationError(what, why=why, remedy="Give a signal that changes")
    return float(np.mean(away**4)) / second**2


def condition_indicators(
    average: SynchronousAverage,
    *,
    earlier: Sequence[SynchronousAverage] = (),
    mesh_harmonics: int = 5,
) -> ConditionIndicators:
    """Condition indicators of a mean revolution.

    Parameters
    ----------
    average : SynchronousAverage
        Of the present record.
    earlier : sequence of SynchronousAverage
        Of all earlier records of the same gear, for NA4.
    mesh_harmonics : int
        Harmonics in the sum of FM0.

    Raises
    ------
    ComputationError
        If the mean revolution has nothing but mesh harmonics, or none of them.

    Notes
    -----
    FM0 and FM4 after R. M. Stewart, Some useful data analysis techniques for gearbox
    diagnostics, University of Southampton, 1977; NA4 after J. J. Zakrajsek, D. P. Townsend and
    H. J. Decker, NASA TM-105950, 1993. FM4 uses the difference signal (mesh harmonics, their
    first sidebands and the shaft orders 1 and 2 removed), NA4 the residual (sidebands retained).
    Without earlier records NA4 is the kurtosis of the residual.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = 2.0 * np.cos(16 * angle) + 0.1 * np.cos(21 * angle)
    >>> average = SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)
    >>> round(condition_indicators(average).fm4, 9)
    1.5
    """
    wave = average.signal
    away = wave - wave.mean()
    rms = float(np.sqrt(np.mean(away**2)))
    mesh = float(average.mesh_amplitudes(mesh_harmonics).sum())
    residual, difference = average.residual(), average.difference()
    least = 1e-12 * rms
    if rms == 0.0 or mesh <= least or min(residual.std(), difference.std()) <= least:
        raise ComputationError(
            "the mean revolution has "
            + ("no mesh harmonics" if mesh <= least else "nothing but mesh harmonics"),
            why="The indicators compare what is left over with the mesh harmonics",
            remedy="Check the number of teeth, and that the shaft is the one measured",
        )
    seconds = [np.var(record_average.residual()) for record_average in (*earlier, average)]
    fourth = float(np.mean((residual - residual.mean()) ** 4))
    return ConditionIndicators(
        float(np.abs(away).max()) / rms,
        kurtosis(wave),
        float(np.ptp(wave)) / mesh,
        kurtosis(difference),
        fourth / float(np.mean(seconds)) ** 2,
    )
