"""A recorded signal, resampled over the rotation of a shaft (computed order tracking)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError, real_numbers, require_positive
from tribodyn.types import Array


def checked_signal(
    signal: object, least: int = 8, name: str = "signal", size: int | None = None
) -> Array:
    """Return a signal as floats; raise an InputError that names its first defect."""
    where = f"argument {name}"
    samples = np.asarray(signal if hasattr(signal, "dtype") else real_numbers(where, signal))
    if samples.dtype.kind not in "biuf":
        what = f"{name} holds {samples.dtype} values"
        remedy = "Pass real and imaginary parts separately, and text as numbers"
        raise InputError(what, where, "A recorded signal holds real numbers", remedy)
    values = samples.astype(float)
    if values.ndim != 1:
        what = f"{name} has the shape {values.shape}"
        why = "One recorded signal is a row of numbers, (n,)"
        raise InputError(what, where, why, "Pass each column of a record separately")
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        what = f"{name} is {values[bad[0]]} at sample {bad[0]} ({bad.size} such samples)"
        remedy = "Cut the record there, or fill short gaps by interpolation"
        raise InputError(what, where, "A spectrum needs every sample", remedy)
    if values.size < least:
        what = f"{name} has {values.size} samples"
        raise InputError(what, where, f"At least {least} are needed", "Record longer")
    if size is not None and values.size != size:
        what = f"{name} has {values.size} samples, the signal has {size}"
        why = "Each sample of the signal has its own value"
        raise InputError(what, where, why, f"Give {size} values")
    return values


def checked_rising(values: object, size: int, name: str, unit: str) -> Array:
    """Return times or rotation angles that rise from sample to sample."""
    rising = checked_signal(values, 2, name, size)
    falls = np.flatnonzero(np.diff(rising) <= 0.0)
    if falls.size:
        first = int(falls[0])
        raise InputError(
            f"{name} goes from {rising[first]:.6g} to {rising[first + 1]:.6g} {unit} "
            f"at sample {first + 1}",
            where=f"argument {name}",
            why="It must rise from sample to sample",
            remedy="Sort the record, drop repeated samples, or count the rotation without wrap",
        )
    return rising


def refuse_above_half(highest: float, sampling_rate: float, what: str, where: str) -> None:
    """Raise an error for a frequency above half the sampling rate (Nyquist)."""
    require_positive("sampling_rate", sampling_rate, "Hz")
    if not highest < 0.5 * sampling_rate:
        raise InputError(
            f"{what} is at {highest:.6g} Hz",
            where=where,
            why=f"Sampled with {sampling_rate:.6g} Hz, only frequencies below "
            f"{0.5 * sampling_rate:.6g} Hz can be resolved (Nyquist)",
            remedy="Sample faster, or request fewer orders",
        )


def window_values(window: str, length: int) -> Array:
    """Return a window of SciPy, periodic so that its lines fall on bins."""
    from scipy.signal import get_window

    try:
        return np.asarray(get_window(window, length, fftbins=True), dtype=float)
    except (ValueError, TypeError) as error:
        what = f"there is no window {window!r}"
        remedy = 'Take "flattop" for amplitudes, "hann" for noise, "boxcar" for none'
        raise InputError(what, "argument window", str(error), remedy) from error


def noise_bandwidth(weights: Array, sampling_rate: float) -> float:
    """Width of the ideal filter that passes as much noise as one line of a window [Hz]."""
    return sampling_rate * float(np.sum(weights**2) / weights.sum() ** 2)


#: Most samples over the rotation before the filter, and samples per period for cubic pieces.
_MOST = 20_000_000
_FINE = 16.0
#: Samples of the slower rate that the filter of a change of the rate reaches to each side.
REACH = 40


@dataclass(frozen=True)
class AngularSignal:
    """A signal at equal steps of the rotation.

    Parameters
    ----------
    rotation : (n,) array
        Rotation from the first sample of the record [rad], at whole steps of the rotation.
    signal : (n,) array
        Signal, in its unit.
    time : (n,) array
        Time of each sample [s].
    speed : (n,) array
        Rotational speed at each sample [rad/s].
    samples_per_revolution : int
        Samples in a revolution.
    """

    rotation: Array
    signal: Array
    time: Array
    speed: Array
    samples_per_revolution: int


def shaft_rotation(rotation: object, speed: object, time: Array) -> Array:
    """Return the rotation of a shaft, integrated from its speed if necessary [rad]."""
    if (rotation is None) == (speed is None):
        what = "neither or both of rotation and speed are given"
        why = "One of them is needed to follow the shaft"
        remedy = "Give the angle of the shaft at each sample, or its speed"
        raise InputError(what, "arguments rotation and speed", why, remedy)
    if rotation is not None:
        return checked_rising(rotation, time.size, "rotation", "rad")
    from scipy.interpolate import CubicSpline

    values = real_numbers(Argument("speed"), speed)
    if values.ndim == 0:
        values = np.full(time.size, float(values))
    values = checked_signal(values, 2, "speed", time.size)
    require_positive("speed", values, "rad/s", remedy="Cut the standstill off the record")
    return np.asarray(CubicSpline(time, values).antiderivative()(time))


def angular_resampling(
    signal: object,
    time: object,
    rotation: object,
    *,
    samples_per_revolution: int,
    highest_order: float | None = None,
) -> AngularSignal:
    """Resample a signal at equal steps of the rotation, without aliasing.

    Parameters
    ----------
    signal : (n,) array
        Signal over time, in any unit.
    time : (n,) array
        Time of each sample [s].
    rotation : (n,) array
        Rotation of the shaft at each sample [rad], counted on without wrap.
    samples_per_revolution : int
        Samples in a revolution of the result.
    highest_order : float, optional
        Highest order that must come through [-]; a third of the samples by default.

    Raises
    ------
    InputError
        If the record is not finite or does not rise, or was sampled too slowly for the order.

    Notes
    -----
    The signal is first sampled over the rotation as finely as it was over time where the shaft
    is slowest, on a cubic spline. There all orders up to half the samples of a revolution are
    retained and higher ones removed by a linear-phase filter over the rotation, whose edge thus
    follows the speed; only then is the signal decimated. A record sampled with fewer than
    16 samples per period of the highest order is refined first by band-limited interpolation,
    which needs equal steps of time. K. R. Fyfe and E. D. S. Munck, Mechanical Systems and Signal
    Processing 11 (1997) 187.

    Examples
    --------
    >>> time = np.linspace(0.0, 2.0, 4001)
    >>> rotation = 2 * np.pi * (5.0 * time + 5.0 * time**2)
    >>> wave = np.cos(7 * rotation)
    >>> resampled = angular_resampling(wave, time, rotation, samples_per_revolution=64)
    >>> middle = slice(200, 1700)
    >>> float(np.abs(resampled.signal - np.cos(7 * resampled.rotation))[middle].max()) < 1e-3
    True
    """
    from scipy.interpolate import CubicSpline

    values = checked_signal(signal, 16)
    moments = checked_rising(time, values.size, "time", "s")
    angle = checked_rising(rotation, values.size, "rotation", "rad")
    require_positive("samples_per_revolution", samples_per_revolution)
    top = samples_per_revolution / 3.0 if highest_order is None else highest_order
    turning = CubicSpline(moments, angle)
    step = np.diff(moments)
    pace = float(np.max(np.diff(angle) / step)) / (2.0 * np.pi)
    rate = 1.0 / float(step.max())
    refuse_above_half(
        top * pace, rate, f"Order {top:g} at the highest speed", "argument highest_order"
    )
    revolutions = (angle[-1] - angle[0]) / (2.0 * np.pi)
    slowest = float(np.min(np.diff(angle) / step)) / (2.0 * np.pi)
    factor = int(np.ceil(max(rate / slowest, samples_per_revolution) / samples_per_revolution))
    fine_samples = revolutions * factor * samples_per_revolution
    if fine_samples > _MOST:
        raise InputError(
            f"{fine_samples:.2g} samples over the rotation would be needed",
            where="argument rotation",
            why=f"The shaft turns as slowly as {slowest:.3g} revolutions per second, and "
            f"sampled with {rate:.3g} Hz the full bandwidth must be retained",
            remedy="Cut the slow part off, or sample more slowly",
        )
    fine_time, fine_signal = _refined(moments, values, top * pace)
    spacing = 2.0 * np.pi / (factor * samples_per_revolution)
    start = factor * spacing * np.ceil(angle[0] / (factor * spacing) - 1e-9)
    grid = start + spacing * np.arange(int((angle[-1] - start) / spacing + 1e-9) + 1)
    when = np.clip(_inverse(turning, moments, angle, grid), moments[0], moments[-1])
    even = CubicSpline(fine_time, fine_signal)(when)
    every_nth = slice(None, None, factor)
    return AngularSignal(
        grid[every_nth] - angle[0],
        decimated(even, factor),
        when[every_nth],
        np.asarray(turning(when[every_nth], 1)),
        samples_per_revolution,
    )


def _inverse(turning: Any, moments: Array, angle: Array, grid: Array) -> Array:
    """Return the time of each angle, by two Newton steps from linear interpolation [s]."""
    when = np.interp(grid, angle, moments)
    for _ in range(2):
        slope = turning(when, 1)
        step = np.divide(turning(when) - grid, slope, out=np.zeros_like(when), where=slope > 0.0)
        when = np.clip(when - step, moments[0], moments[-1])
    return np.asarray(when)


def _refined(moments: Array, values: Array, highest: float) -> tuple[Array, Array]:
    """Band-limited interpolation of an evenly sampled record on a finer grid of time."""
    step = np.diff(moments)
    even = step.max() - step.min() < 1e-6 * step.max()
    times = int(np.ceil(_FINE * highest * step.mean()))
    if times < 2 or not even:
        return moments, values
    fine = _resampled(values, times, 1)
    grid = moments[0] + step.mean() / times * np.arange(fine.size)
    inside = grid <= moments[-1] + 1e-9 * step.mean()
    return grid[inside], fine[inside]


def decimated(values: Array, factor: int) -> Array:
    """Decimate a signal after a zero-delay filter that removes what would alias."""
    return values if factor == 1 else _resampled(values, 1, factor)


def _resampled(values: Array, up: int, down: int) -> Array:
    from scipy.signal import firwin, resample_poly

    factor = max(up, down)
    taps = firwin(2 * REACH * factor + 1, 1.0 / factor, window=("kaiser", 8.0))
    return np.asarray(resample_poly(values, up, down, window=taps, padtype="line"))
