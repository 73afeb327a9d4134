"""Single-sided spectrum of a recorded signal, with the gains of the window taken out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.angular_resampling import (
    checked_signal,
    noise_bandwidth,
    refuse_above_half,
    window_values,
)
from tribodyn.types import Array, ComplexArray, Mask

#: Products of lines and samples that are summed directly.
_DIRECT = 2**20


def sum_of_lines(
    frequency: Array, amplitude: ComplexArray, start: float, step: float, count: int
) -> Array:
    """Sum of ``Re(amplitude_k exp(2 pi i frequency_k t))`` on even times, exact to 1e-11."""
    from tribodyn.signals.uneven_transform import uneven_transform

    turns = frequency * step % 1.0
    shifted = amplitude * np.exp(2j * np.pi * (frequency * start % 1.0))
    if turns.size * count <= _DIRECT:
        waves = np.exp(2j * np.pi * np.multiply.outer(np.arange(count), turns))
        return np.asarray((waves @ shifted).real)
    cosines, sines = (uneven_transform(each, turns, count) for each in (shifted.real, shifted.imag))
    return np.asarray(cosines.real + sines.imag)


_SCALINGS = ("amplitude", "power", "density")
#: Long windows have the transform of this one, as a function of the distance in bins.
_LONGEST = 2048


def spectrum(
    signal: object,
    sampling_rate: float,
    *,
    window: str = "flattop",
    scaling: Literal["amplitude", "power", "density"] = "amplitude",
    block_length: int | None = None,
    overlap: float = 0.5,
    unit: str = "",
) -> SignalSpectrum:
    """Single-sided spectrum of equally spaced samples.

    Parameters
    ----------
    signal : (n,) array
        Equally spaced samples, in any unit.
    sampling_rate : float
        Samples per second [Hz].
    window : str
        Window of :func:`scipy.signal.get_window`; ``"flattop"`` gives the amplitude of a sine
        between two lines too, ``"hann"`` suits noise and close lines, ``"boxcar"`` is none.
    scaling : {"amplitude", "power", "density"}
        ``"amplitude"``: peak amplitude, ``"power"``: mean square, ``"density"``: mean square per
        hertz.
    block_length : int, optional
        Samples of a block; the mean squares of the blocks are averaged (Welch). The whole signal
        is one block by default.
    overlap : float
        Part of a block that it shares with the next [-].
    unit : str
        Unit of the signal, for display.

    Returns
    -------
    SignalSpectrum
        Its line at frequency zero is the mean of the signal.

    Raises
    ------
    InputError
        If the signal is not finite or too short, or an argument is out of its range.

    Notes
    -----
    A line of amplitude A on a bin has the amplitude A, the mean square A^2/2 and, over the noise
    bandwidth of the window, the density A^2/2/B. Between two bins the amplitude is low by up to
    15.1 % with ``"hann"``, 36.3 % with ``"boxcar"`` and 0.12 % with ``"flattop"``; the peaks of
    :meth:`SignalSpectrum.peaks` take that out. The density with ``"boxcar"`` obeys Parseval's
    theorem exactly: its sum times the spacing is the mean square of the signal. P. D. Welch, IEEE
    Trans. Audio Electroacoust. 15 (1967) 70; G. Heinzel, A. Ruediger and R. Schilling, Spectrum
    and spectral density estimation by the discrete Fourier transform, 2002.

    Examples
    --------
    >>> time = np.arange(1000) / 1000.0
    >>> wave = 1.0 + 3.0 * np.cos(2 * np.pi * 50.3 * time + 0.4)
    >>> spectrum(wave, 1000.0, unit="m/s^2")
    SignalSpectrum(501 lines to 500 Hz, largest 3.001 m/s^2 at 50 Hz)
    >>> spectrum(wave, 1000.0, window="hann").peaks(1)
    [Peak(50.3 Hz, 3)]
    """
    values = checked_signal(signal)
    require_positive("sampling_rate", sampling_rate, "Hz")
    if scaling not in _SCALINGS:
        what = f"there is no scaling {scaling!r}"
        why = "Spectra of different scaling are not compared"
        raise InputError(what, "argument scaling", why, f"Take one of {', '.join(_SCALINGS)}")
    length = values.size if block_length is None else block_length
    require_between("block_length", length, 8, values.size, "samples")
    require_between("overlap", overlap, 0.0, 0.95)
    weights = window_values(window, length)
    step = max(length - round(overlap * length), 1)
    starts = range(0, values.size - length + 1, step)
    lines = np.zeros(length // 2 + 1, dtype=complex)
    square = np.zeros(length // 2 + 1)
    for start in starts:
        lines = np.fft.rfft(weights * values[start : start + length]) / weights.sum()
        square += np.abs(lines) ** 2 / len(starts)
    single = _single_sided(length)
    bandwidth = noise_bandwidth(weights, sampling_rate)
    size = {
        "amplitude": np.where(single, 2.0, 1.0) * np.sqrt(square),
        "power": np.where(single, 2.0, 1.0) * square,
        "density": np.where(single, 2.0, 1.0) * square / bandwidth,
    }[scaling]
    return SignalSpectrum(
        np.asarray(np.fft.rfftfreq(length, 1.0 / sampling_rate), dtype=np.float64),
        size,
        np.angle(lines) if len(starts) == 1 else None,
        scaling=scaling,
        window=window,
        noise_bandwidth=bandwidth,
        averages=len(starts),
        window_length=length,
        unit=unit,
    )


def _single_sided(length: int) -> Mask:
    """Return a mask of the lines that combine a positive and a negative frequency."""
    pair = np.ones(length // 2 + 1, dtype=bool)
    pair[0] = False
    if length % 2 == 0:
        pair[-1] = False
    return pair


#: Frequencies of the mains [Hz], and how near a peak has to be, over its frequency.
_MAINS, _MAINS_NEAR = (50.0, 60.0), 0.02


def mains_of(frequency: float, tolerance: float = _MAINS_NEAR) -> float:
    """50 or 60 where a frequency is that of the mains or twice it [Hz]; 0 elsewhere."""
    for mains in _MAINS:
        for times in (1.0, 2.0):
            if abs(frequency / (times * mains) - 1.0) <= tolerance:
                return mains
    return 0.0


@dataclass(frozen=True)
class Peak:
    """One peak of a spectrum.

    Parameters
    ----------
    frequency : float
        Frequency [Hz].
    amplitude : float
        Peak amplitude, in the unit of the signal.
    phase : float or None
        Phase of the cosine at the first sample [rad]; None if the spectrum is an average.
    shaft_order : int
        Multiple of the rotation of a shaft that it belongs to [-]; 0 where none is known.
    """

    frequency: float
    amplitude: float
    phase: float | None = None
    shaft_order: int = 0

    @property
    def mains(self) -> float:
        """50 or 60 where it lies within 0.5 % of the mains or twice them [Hz]; 0 elsewhere.

        Such a peak of a recording may be electrical; one that belongs to a shaft is not doubted.
        """
        return 0.0 if self.shaft_order else mains_of(self.frequency, 0.005)

    def __repr__(self) -> str:
        """One line."""
        mains = f", mains of {self.mains:g} Hz?" if self.mains else ""
        return f"Peak({self.frequency:.6g} Hz, {self.amplitude:.4g}{mains})"


def _with_shaft_orders(peaks: Sequence[Peak], rotation: float, error: float) -> list[Peak]:
    """Peaks with their orders of a shaft, whose rotation [Hz] is known within a relative error."""
    orders = [round(peak.frequency / rotation) for peak in peaks]
    return [
        replace(peak, shaft_order=order)
        if abs(peak.frequency / rotation - order) <= min(max(0.005, error * order), 0.05)
        else peak
        for peak, order in zip(peaks, orders, strict=True)
    ]


def _nearest_mains_line(frequency: float) -> float:
    """Mains frequency that a peak at the mains or at twice the mains indicates [Hz]."""
    return frequency if frequency < 1.5 * mains_of(frequency) else 0.5 * frequency


@lru_cache(maxsize=32)
def window_gain(window: str, length: int) -> tuple[Array, ComplexArray]:
    """Transform of a window over the distance from its centre."""
    weights = window_values(window, min(length, _LONGEST))
    offset = np.linspace(-599.5, 599.5, 1200, dtype=np.float64) / 300.0
    turns = np.exp(-2j * np.pi * offset[:, None] * np.arange(weights.size) / weights.size)
    return offset, np.asarray(turns @ weights / weights.sum(), dtype=np.complex128)


def interpolated_peaks(
    frequency: Array, amplitude: Array, phase: Array | None, window: str, length: int, count: int
) -> list[Peak]:
    """Largest local maxima, each as the sine that would make its three lines."""
    inner = np.arange(1, amplitude.size - 1)
    high = (amplitude[inner] >= amplitude[inner - 1]) & (amplitude[inner] > amplitude[inner + 1])
    tops = inner[high]
    tops = tops[np.argsort(amplitude[tops])[::-1][:count]]
    offset, gain = window_gain(window, length)
    size = np.abs(gain)
    span = np.abs(offset) < 0.75
    right, left = (np.interp(move - offset[span], offset, size) for move in (1.0, -1.0))
    with np.errstate(divide="ignore"):
        slope = np.log(right) - np.log(left)
    before, middle, after = (amplitude[tops + move] for move in (-1, 0, 1))
    away = np.zeros(tops.size)
    between = (np.maximum(before, after) > 1e-9 * middle) & (np.minimum(before, after) > 0.0)
    away[between] = np.interp(np.log(after[between] / before[between]), slope, offset[span])
    away = np.clip(away, -0.5, 0.5)
    places = frequency[tops] + away * (frequency[1] - frequency[0])
    sizes = middle / np.interp(-away, offset, size)
    turns: list[float | None] = [None] * tops.size
    if phase is not None:
        turn = np.interp(-away, offset, np.unwrap(np.angle(gain)))
        turns = np.angle(np.exp(1j * (phase[tops] - turn))).tolist()
    return [Peak(*each) for each in zip(places.tolist(), sizes.tolist(), turns, strict=True)]


@record
class SignalSpectrum(Record):
    """Single-sided spectrum of a recorded signal.

    Parameters
    ----------
    frequency : (k,) array
        Frequency [Hz].
    amplitude : (k,) array
        Peak amplitude in the unit of the signal, or what ``scaling`` says.
    phase : (k,) array or None
        Phase of the cosine at the first sample [rad]; None for an average.
    scaling : str
        ``"amplitude"``, ``"power"`` (mean square) or ``"density"`` (mean square per hertz).
    window : str
        Name of the window.
    noise_bandwidth : float
        Width of the ideal filter that passes as much noise as one line [Hz].
    averages : int
        Number of blocks.
    window_length : int
        Samples of one block.
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    frequency: Array = quantity("frequency", unit="Hz", axis=True)
    amplitude: Array = quantity("frequency", unit="@value_unit")
    phase: Array | None = None
    scaling: str = "amplitude"
    window: str = fact(default="boxcar")
    noise_bandwidth: float = fact(default=0.0)
    averages: int = fact(default=1)
    window_length: int = 0
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        start = 1 if self.frequency[0] == 0.0 else 0
        top = start + int(np.argmax(self.amplitude[start:]))
        return (
            f"SignalSpectrum({self.frequency.size} lines to {self.frequency[-1]:.6g} Hz, largest "
            f"{self.amplitude[top]:.4g} {self.value_unit} at {self.frequency[top]:.6g} Hz)"
        ).replace("  ", " ")

    @property
    def value_unit(self) -> str:
        """Unit of the values: of the signal, its square, or its square per hertz."""
        square = f"({self.unit})^2" if self.unit else ""
        density = f"{square}/Hz" if square else "1/Hz"
        return {"amplitude": self.unit, "power": square, "density": density}[self.scaling]

    def peaks(self, count: int = 5, *, speed: float | None = None) -> list[Peak]:
        """Largest peaks, with the frequency and the amplitude between the lines.

        Parameters
        ----------
        count : int
            Most peaks to return.
        speed : float, optional
            Speed of a shaft [rad/s], to tell its orders from lines of the mains.

        Returns
        -------
        list of Peak
            From the largest down.

        Raises
        ------
        InputError
            If the values are no amplitudes of the lines of a whole block.

        Notes
        -----
        The three lines of a peak are those that one sine makes through the window: exact for a
        sine alone, and good while the next one is further away than the main lobe. Without the
        speed, three peaks or more at other multiples of the frequency of the mains than the first
        two, most of the peaks in all, are taken as orders of a shaft that turns as fast.
        """
        require_positive("count", count)
        if speed is not None:
            require_positive("speed", speed, "rad/s")
        if self.scaling != "amplitude" or not self.window_length:
            what = f"peaks of a spectrum with the scaling {self.scaling}"
            why = "They are interpolated on amplitudes over the lines of a whole block"
            remedy = 'Use scaling="amplitude" of tribodyn.analysis.spectrum'
            raise InputError(what, "SignalSpectrum.peaks", why, remedy)
        peaks = interpolated_peaks(
            self.frequency, self.amplitude, self.phase, self.window, self.window_length, count
        )
        if speed is not None:
            return _with_shaft_orders(peaks, speed / (2.0 * np.pi), 0.005)
        for rotation in [_nearest_mains_line(peak.frequency) for peak in peaks if peak.mains]:
            in_series = _with_shaft_orders(peaks, rotation, 3e-4)
            orders = np.array([peak.shaft_order for peak in in_series])
            if np.sum(orders > 2) >= 3 and 2 * np.sum(orders > 0) > orders.size:
                return in_series
        return peaks

    def _array_name(self) -> str:
        return self.scaling


#: Local maxima that are searched for distinct peaks, distance of two over the frequency and in
#: lines, and share of the largest below which there may be rounding only.
_CANDIDATES, _NEAR, _LOBE, _LEAST = 200, 0.005, 12, 1e-4


def distinct_peaks(lines: SignalSpectrum, count: int) -> list[Peak]:
    """Largest peaks above zero that do not belong to one line that a changing speed smears."""
    candidates = [peak for peak in lines.peaks(_CANDIDATES) if peak.frequency > 0.0]
    least = _LEAST * max((peak.amplitude for peak in candidates), default=0.0)
    lobe_width = _LOBE * float(lines.frequency[1] - lines.frequency[0])
    peaks: list[Peak] = []
    for peak in candidates:
        least_distance = max(_NEAR * peak.frequency, lobe_width)
        if peak.amplitude > least and all(
            abs(peak.frequency - larger.frequency) > least_distance for larger in peaks
        ):
            peaks.append(peak)
        if len(peaks) == count:
            break
    return peaks


def zoom_spectrum(
    signal: object,
    sampling_rate: float,
    lowest: float,
    highest: float,
    *,
    points: int = 1001,
    window: str = "hann",
    unit: str = "",
) -> SignalSpectrum:
    """Amplitude spectrum of a narrow band on any number of lines.

    Parameters
    ----------
    signal, sampling_rate
        As in :func:`spectrum` [Hz].
    lowest, highest : float
        Ends of the band [Hz].
    points : int
        Number of lines.
    window, unit
        As in :func:`spectrum`.

    Raises
    ------
    InputError
        If the signal is not finite or too short, or the band is not below half the rate.

    Notes
    -----
    Chirp transform (:func:`scipy.signal.zoom_fft`). Close lines draw the peak of the window in
    full, which leaves no scalloping; two sines are resolved only if they differ by more than
    the main lobe, a few times the inverse of the duration.

    Examples
    --------
    >>> wave = 3.0 * np.cos(2 * np.pi * 50.37 * np.arange(1000) / 1000.0)
    >>> zoom_spectrum(wave, 1000.0, 48.0, 52.0, points=401, unit="N")
    SignalSpectrum(401 lines to 52 Hz, largest 3 N at 50.37 Hz)
    """
    from scipy.signal import zoom_fft

    values = checked_signal(signal)
    refuse_above_half(highest, sampling_rate, "The upper end of the band", "argument highest")
    if not 0.0 < lowest < highest or points < 2:
        what = f"a band from {lowest:g} to {highest:g} Hz on {points} lines"
        why = "It must rise from above zero and have two lines or more"
        remedy = "Give a rising band and at least two points"
        raise InputError(what, "arguments lowest, highest and points", why, remedy)
    weights = window_values(window, values.size)
    lines = zoom_fft(weights * values, [lowest, highest], m=points, fs=sampling_rate, endpoint=True)
    lines = 2.0 * np.asarray(lines) / weights.sum()
    return SignalSpectrum(
        np.linspace(lowest, highest, points),
        np.abs(lines),
        np.angle(lines),
        window=window,
        noise_bandwidth=noise_bandwidth(weights, sampling_rate),
        unit=unit,
    )
