"""Time-synchronous average: separate what repeats with the shaft from what does not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import InputError, require_positive
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.signals.angular_resampling import (
    REACH,
    angular_resampling,
    checked_rising,
    checked_signal,
    shaft_rotation,
)
from tribodyn.types import Array


def locked_variance(variances: Sequence[float], *, z: float = 3.09) -> tuple[float, int]:
    """Mean variance of residuals up to the record at which damage begins.

    Parameters
    ----------
    variances : sequence of float
        Of the residuals of all records in their order, the present one last.
    z : float
        Quantile of the normal distribution; 3.09 is that of 99.9 % [-].

    Returns
    -------
    (float, int)
        Mean of the variances before the lock, in the unit of the signal squared, and their number.

    Notes
    -----
    The mean is locked before the first variance above ``L = mean + z sigma / sqrt(n)`` with mean
    and standard deviation of the n variances before it, at least two: Decker, Handschuh and
    Zakrajsek, NASA TM-106553, 1994, as printed by M. Lebold et al., Review of vibration analysis
    methods for gearbox diagnostics and prognostics, 54th meeting of the MFPT, 2000. The limit is
    narrow: a lock by chance leaves a mean of sound records and does no harm.

    Examples
    --------
    >>> locked_variance([1.0, 1.2, 1.1, 4.0, 1.1])
    (1.1, 3)
    """
    values = np.asarray(variances, dtype=float)
    for count in range(2, values.size):
        before = values[:count]
        limit = before.mean() + z * before.std(ddof=1) / np.sqrt(count)
        if values[count] > limit:
            return float(before.mean()), count
    return float(values.mean()), values.size


#: Revolutions from which the ends of the record are left out, so that two remain everywhere.
_TRIMMED = 4
#: Pitches that are added to the place of a yielding tooth, so that its number is the nearest one.
_LATE = 0.1
#: Largest difference over its standard error from which it is no chance.
_CLEAR = 5.0


@record
class SynchronousAverage(Record):
    """Mean revolution of a shaft.

    Parameters
    ----------
    angle : (n,) array
        Angle of the shaft [rad], zero where its rotation is: at the first pulse of a tachometer,
        and at the first sample where only the speed is known.
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
    difference_error : (n,) array, optional
        Standard error of the difference at each angle, in the unit of the signal.
    """

    angle: Array = quantity("angle", unit="rad", axis=True)
    signal: Array = quantity("angle", unit="@unit")
    scatter: Array = quantity("angle", unit="@unit")
    revolutions: int = fact()
    teeth: int = fact()
    unit: str = ""
    difference_error: Array | None = None

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

    def regular(self, shaft_orders: int = 2) -> Array:
        """Mesh harmonics and their first sidebands, which a sound gear has too.

        Parameters
        ----------
        shaft_orders
            As for :meth:`residual`; they are in neither signal.

        Returns
        -------
        (n,) array
            In the unit of the signal.
        """
        low = self._lines_to(shaft_orders)
        return np.asarray(self.signal - low - self.difference(shaft_orders))

    @property
    def difference_is_clear(self) -> bool:
        """Whether the largest difference exceeds five times its standard error, if it is known.

        That is the larger one of the mean over the turn and of the mean over this tooth pitch.
        """
        if self.difference_error is None:
            return True
        square = self.difference_error**2
        local = np.mean(square[self._local_pitch() % square.size])
        error = np.sqrt(max(float(np.mean(square)), float(local)))
        return bool(np.abs(self.difference()).max() > _CLEAR * error)

    def local_place(self) -> tuple[float, int]:
        """Where the difference is largest, and the tooth whose contact that is.

        Returns
        -------
        angle : float
            Centre of the tooth pitch in which the difference has most energy [rad].
        tooth : int
            In the order of contact, from 1 for the tooth whose contact begins at angle zero.

        Notes
        -----
        The contact of tooth k begins at k - 1 pitches and lasts 1.2 to 2 of them. A tooth that
        yields shows most where it carries alone: 0.4 to 1.3 pitches after the begin.
        """
        place, size = self._local_pitch(), self.angle.size
        energy = self.difference()[place % size] ** 2
        centre = float(place @ energy) / max(float(energy.sum()), 1e-300)
        pitches = (centre / size * self.teeth) % self.teeth
        tooth = (round(pitches + _LATE) - 1) % self.teeth + 1
        return 2.0 * np.pi * pitches / self.teeth, tooth

    def _local_pitch(self) -> NDArray[np.int_]:
        """Indices of the tooth pitch in which the difference has most energy, without wrap."""
        energy = self.difference() ** 2
        width = max(round(energy.size / self.teeth), 1)
        around = np.append(energy, energy[: width - 1])
        sums = np.convolve(around, np.ones(width), "valid")
        return np.arange(width) + int(np.argmax(sums))

    def _lines_to(self, order: int) -> Array:
        """Mean and shaft orders up to one."""
        lines = np.fft.rfft(self.signal)
        lines[order + 1 :] = 0.0
        return np.asarray(np.fft.irfft(lines, self.signal.size))

    def _without(self, shaft_orders: int, sidebands: int) -> Array:
        return _without_mesh(self.signal, self.teeth, shaft_orders, sidebands)

    def _parts(self) -> Parts:
        parts, units = super()._parts(), self._units("@unit")
        parts.variables["residual"] = ("angle", self.residual(), units)
        parts.variables["difference"] = ("angle", self.difference(), units)
        return parts


def _without_mesh(signal: Array, teeth: int, shaft_orders: int, sidebands: int) -> Array:
    """Revolutions (..., n) less shaft orders, mesh harmonics and some of their sidebands."""
    lines = np.fft.rfft(signal)
    lines[..., : shaft_orders + 1] = 0.0
    for mesh in range(teeth, lines.shape[-1] + sidebands, teeth):
        lines[..., max(mesh - sidebands, 0) : mesh + sidebands + 1] = 0.0
    return np.asarray(np.fft.irfft(lines, signal.shape[-1]))


def time_synchronous_average(
    signal: object,
    time: object,
    *,
    teeth: int,
    rotation: object = None,
    speed: object = None,
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
    number. From four revolutions on, samples that the filters reach from beyond both ends of the
    record do not count. S. Braun, Acustica 32 (1975) 69; P. D. McFadden, Mechanical Systems and
    Signal Processing 1 (1987) 83.

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
    clean = np.ones(turns.shape)
    if count >= _TRIMMED:
        within = [angle[REACH] - angle[0], angle[-1] - angle[-1 - REACH]]
        lead, tail = (REACH + int(np.ceil(turned * per_turn / (2.0 * np.pi))) for turned in within)
        clean[0, : min(lead, per_turn)] = 0.0
        last = resampled.signal.size - tail - (count - 1) * per_turn
        clean[-1, max(min(last, per_turn), 0) :] = 0.0
    number = clean.sum(axis=0)
    mean = (clean * turns).sum(axis=0) / number
    variance = (clean * (turns - mean) ** 2).sum(axis=0) / (number - 1.0)
    inner = slice(1, -1) if count > _TRIMMED else slice(None)
    averages = _without_mesh(turns[inner], teeth, 2, 1)
    error = np.sqrt(averages.var(axis=0, ddof=1) / count)
    begin = round((angle[0] + resampled.rotation[0]) * per_turn / (2.0 * np.pi))
    return SynchronousAverage(
        2.0 * np.pi * np.arange(per_turn) / per_turn,
        np.roll(mean, begin),
        np.roll(np.sqrt(variance / number), begin),
        count,
        teeth,
        unit,
        np.roll(error, begin),
    )
