"""Modulation: envelope, its spectrum, sidebands of a carrier, the most impulsive band."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import Argument, ComputationError, InputError, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.angular_resampling import checked_signal, refuse_above_half
from tribodyn.signals.spectrum import SignalSpectrum, spectrum
from tribodyn.types import Array, ComplexArray


def envelope(
    signal: object, sampling_rate: float, *, band: tuple[float, float] | None = None
) -> Array:
    """Envelope of a signal, by the Hilbert transform of a band of it.

    Parameters
    ----------
    signal, sampling_rate
        As in :func:`spectrum` [Hz].
    band : tuple of two float, optional
        Lower and upper end of the band that carries the modulation [Hz]; the whole signal less
        its mean by default.

    Returns
    -------
    (n,) array
        Envelope, in the unit of the signal. The first and last few periods of the lower end of
        the band hold the transients of the filter.

    Raises
    ------
    InputError
        If the signal is not finite or too short, or the band is not below half the rate.

    Notes
    -----
    Modulus of the analytic signal (:func:`scipy.signal.hilbert`). The band is cut out by a
    Butterworth filter of order 4 that runs forwards and backwards: no delay, and half the
    amplitude at the ends of the band.

    Examples
    --------
    >>> time = np.arange(2000) / 1000.0
    >>> wave = (2.0 + np.cos(2 * np.pi * 5.0 * time)) * np.cos(2 * np.pi * 100.0 * time)
    >>> result = envelope(wave, 1000.0)
    >>> round(float(result.min()), 6), round(float(result.max()), 6)
    (1.0, 3.0)
    """
    from scipy.signal import butter, hilbert, sosfiltfilt

    values = checked_signal(signal, 32)
    require_positive("sampling_rate", sampling_rate, "Hz")
    if band is None:
        return np.asarray(np.abs(hilbert(values - values.mean())))
    low, high = band
    refuse_above_half(high, sampling_rate, "The upper end of the band", "argument band")
    if not 0.0 < low < high:
        what, why = f"a band from {low:g} to {high:g} Hz", "It must rise, from above zero"
        raise InputError(what, "argument band", why, "Give (low, high) in Hz")
    sections = butter(4, (low, high), btype="bandpass", fs=sampling_rate, output="sos")
    return np.asarray(np.abs(hilbert(sosfiltfilt(sections, values))))


def envelope_spectrum(
    signal: object,
    sampling_rate: float,
    *,
    band: tuple[float, float] | None = None,
    window: str = "flattop",
    unit: str = "",
) -> SignalSpectrum:
    """Amplitude spectrum of the envelope: the frequencies that modulate a carrier.

    Parameters
    ----------
    signal, sampling_rate, band
        As in :func:`envelope` [Hz].
    window, unit
        As in :func:`spectrum`.

    Returns
    -------
    SignalSpectrum
        The mean of the envelope is the line at zero; a line at the modulating frequency over it
        is the depth of the modulation.

    Raises
    ------
    InputError
        As :func:`envelope`.

    Examples
    --------
    >>> time = np.arange(2000) / 1000.0
    >>> wave = (2.0 + np.cos(2 * np.pi * 5.0 * time)) * np.cos(2 * np.pi * 100.0 * time)
    >>> result = envelope_spectrum(wave, 1000.0, window="hann")
    >>> result
    SignalSpectrum(1001 lines to 500 Hz, largest 1 at 5 Hz)
    >>> round(float(result.amplitude[0]), 6)
    2.0
    """
    hull = envelope(signal, sampling_rate, band=band)
    mean = float(hull.mean())
    result = spectrum(hull - mean, sampling_rate, window=window, unit=unit)
    # the mean would hide slow modulation under its main lobe; it comes back as its own line
    result.amplitude[0] = mean
    return result


#: Points over one period of the modulation.
_POINTS = 1024


@record
class Sidebands(Record):
    """Lines around a carrier, and what modulates it.

    Parameters
    ----------
    carrier : float
        Frequency of the carrier, for gears the mesh frequency or a multiple [Hz].
    modulation : float
        Frequency of the modulation, for gears the shaft frequency [Hz].
    number : (2 * count + 1,) array of int
        Number of each line, negative below the carrier, 0 for the carrier.
    frequency : (2 * count + 1,) array
        Frequency [Hz].
    amplitude : (2 * count + 1,) array
        Peak amplitude, in the unit of the signal.
    phase : (2 * count + 1,) array
        Phase of the cosine at the first sample [rad].
    amplitude_modulation : float
        Amplitude of the envelope over its mean, at the frequency of the modulation [-].
    phase_modulation : float
        Amplitude of the phase at that frequency [rad].
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    carrier: float
    modulation: float
    number: NDArray[np.int_] = quantity("number", axis=True)
    frequency: Array = quantity("number", unit="Hz", axis=True)
    amplitude: Array = quantity("number", unit="@unit")
    phase: Array
    amplitude_modulation: float = fact()
    phase_modulation: float = fact()
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        return (
            f"Sidebands({self.carrier:.6g} Hz with {self.number[-1]} on each side every "
            f"{self.modulation:.6g} Hz, amplitude modulation {self.amplitude_modulation:.4g}, "
            f"phase modulation {self.phase_modulation:.4g} rad)"
        )

    @property
    def frequency_swing(self) -> float:
        """Amplitude of the instantaneous frequency [Hz]: phase modulation times its frequency."""
        return self.phase_modulation * self.modulation

    @property
    def sideband_ratio(self) -> float:
        """Sum of the amplitudes of all sidebands over that of the carrier [-]."""
        carrier = self.amplitude[self.number == 0]
        return float(self.amplitude[self.number != 0].sum() / carrier[0])


def sidebands(
    signal: object,
    sampling_rate: float,
    carrier: float,
    modulation: float,
    *,
    count: int = 5,
    unit: str = "",
) -> Sidebands:
    """Compute the amplitudes of a carrier and its sidebands, and the modulation behind them.

    Parameters
    ----------
    signal, sampling_rate
        As in :func:`tribodyn.analysis.spectrum` [Hz].
    carrier : float
        Frequency of the carrier [Hz].
    modulation : float
        Frequency of the modulation [Hz].
    count : int
        Sidebands on each side.
    unit : str
        Unit of the signal, for display.

    Raises
    ------
    InputError
        If a sideband lies below zero or above half the rate, or the record is shorter than two
        periods of the modulation.
    ComputationError
        If nothing vibrates at the carrier.

    Notes
    -----
    The lines and the mean are fitted to the record by least squares, so that neither window nor
    leakage matters; strong lines elsewhere should be filtered off. The lines over the carrier's,
    summed over one period of the modulation, give its envelope and its phase, whose first
    harmonics are the two indices: amplitude modulation makes equal sidebands whose phases mirror
    each other, phase modulation opposite ones (P. D. McFadden, J. Vib. Acoust. 108 (1986) 165).
    ``count`` must hold all sidebands that matter: a phase modulation of 1 rad has four.

    Examples
    --------
    >>> time = np.arange(3000) / 3000.0
    >>> turn = 2 * np.pi * 7.3 * time
    >>> wave = (1 + 0.3 * np.cos(turn)) * np.cos(2 * np.pi * 400 * time + 0.2 * np.sin(turn + 1))
    >>> result = sidebands(wave, 3000.0, 400.0, 7.3)
    >>> round(result.amplitude_modulation, 5), round(result.phase_modulation, 5)
    (0.3, 0.2)
    """
    values = checked_signal(signal, 16)
    require_positive("count", count)
    require_positive("modulation", modulation, "Hz")
    highest = carrier + count * modulation
    refuse_above_half(highest, sampling_rate, f"Sideband {count}", "argument count")
    periods = values.size / sampling_rate * modulation
    if carrier - count * modulation <= 0.0 or periods < 2.0:
        low = carrier - count * modulation
        raise InputError(
            f"sideband -{count} is at {low:.6g} Hz, the record holds {periods:.3g} "
            "periods of the modulation",
            where="arguments carrier, modulation and count",
            why="All sidebands must lie above zero, and two periods are needed to separate them",
            remedy="Request fewer sidebands, or record longer",
        )
    number = np.arange(-count, count + 1)
    frequency = carrier + modulation * number.astype(np.float64)
    lines = _fitted(values, frequency / sampling_rate)
    size = np.abs(lines)
    if not size[count] > 1e-9 * max(float(size.max()), float(np.abs(values).max())):
        raise ComputationError(
            f"nothing vibrates at the carrier of {carrier:.6g} Hz",
            why="Modulation is relative to the amplitude of the carrier",
            remedy="Check the carrier against the peaks of tribodyn.analysis.spectrum",
        )
    shape = lines / lines[count]
    over = np.exp(2j * np.pi * np.outer(np.arange(_POINTS) / _POINTS, number)) @ shape
    hull, turn = np.abs(over), np.unwrap(np.angle(over))
    once = np.exp(-2j * np.pi * np.arange(_POINTS) / _POINTS) * 2.0 / _POINTS
    return Sidebands(
        carrier,
        modulation,
        number,
        frequency,
        size,
        np.angle(lines),
        float(np.abs(once @ hull) / hull.mean()),
        float(np.abs(once @ turn)),
        unit,
    )


def _fitted(values: Array, cycles: Array) -> ComplexArray:
    """Complex amplitudes of cosines with so many cycles per sample, fitted with a mean."""
    sample = np.arange(values.size)
    waves = np.exp(2j * np.pi * np.outer(sample, cycles))
    columns = np.hstack([waves.real, -waves.imag, np.ones((values.size, 1))])
    weights = np.linalg.solve(columns.T @ columns, columns.T @ values)
    return np.asarray(weights[: cycles.size] + 1j * weights[cycles.size : -1])


#: Least independent samples of the envelope in a band, and roll-off on each side over its width.
_LEAST, _ROLL_OFF = 64, 0.125
#: Part of the record at each end that is faded and not judged: a tone that is cut off there rings.
_FADED = 0.05
#: Probability that noise alone has a significant band.
_FALSE_ALARM = 0.01
#: Distance of a wide band from zero and from half the sampling rate, over the rate.
_EDGE = 1e-3


@record
class Kurtogram(Record):
    """Spectral kurtosis of the bands of a filter bank.

    Parameters
    ----------
    splits : (m,) array of int
        Number of equal bands into which half the sampling rate is divided [-].
    centre : (m,) array
        Centre of each band [Hz].
    width : (m,) array
        Width of each band [Hz].
    kurtosis : (m,) array
        Spectral kurtosis: 0 for noise, negative for steady tones, positive for impacts [-].
    limit : (m,) array
        Kurtosis up to which a band may be noise [-].
    """

    splits: NDArray[np.int_] = quantity("band", unit="1")
    centre: Array = quantity("band", unit="Hz")
    width: Array = quantity("band", unit="Hz")
    kurtosis: Array = quantity("band", unit="1")
    limit: Array = quantity("band", unit="1")

    @property
    def best(self) -> int:
        """Index of the band with the largest kurtosis among those above the limit of noise."""
        excess = self.kurtosis / self.limit
        return int(np.argmax(self.kurtosis * (excess > 1.0) if excess.max() > 1.0 else excess))

    @property
    def significant(self) -> bool:
        """Whether that band is more impulsive than noise."""
        return bool(self.kurtosis[self.best] > self.limit[self.best])

    @property
    def band(self) -> tuple[float, float]:
        """Lower and upper end of that band, for the envelope [Hz]."""
        centre, width = float(self.centre[self.best]), float(self.width[self.best])
        half = float((self.width * self.splits)[0])
        margin = min(2.0 * _EDGE * half, _ROLL_OFF * width)
        low, high = centre - 0.5 * width, centre + 0.5 * width
        return max(low, margin), min(high, half - margin)

    def __repr__(self) -> str:
        """One line."""
        low, high = self.band
        size = self.kurtosis[self.best]
        noise = "" if self.significant else ", no more than noise"
        return f"Kurtogram({low:.5g} to {high:.5g} Hz, kurtosis {size:.4g}{noise})"


def kurtogram(signal: object, sampling_rate: float, *, levels: int | None = None) -> Kurtogram:
    """Spectral kurtosis over centre and width of frequency bands.

    Parameters
    ----------
    signal, sampling_rate
        As in :func:`tribodyn.analysis.spectrum` [Hz].
    levels : int, optional
        Times that the bands are halved [-]; by default until 64 samples of the envelope are left.

    Returns
    -------
    Kurtogram
        Its ``band`` is the one for :func:`tribodyn.analysis.envelope_spectrum`.

    Raises
    ------
    InputError
        If the signal is not finite or too short for the levels.

    Notes
    -----
    Fast kurtogram of J. Antoni, Mechanical Systems and Signal Processing 21 (2007) 108: 1, 2, 3, 4,
    6, 8, 12 ... equal bands, and of each the kurtosis K = <|c|^4> / <|c|^2>^2 - 2 of its complex
    envelope c. The bands are cut out of one Fourier transform with smooth edges instead of a tree
    of short filters, so that they have no delay and the edges of all levels are equally sharp. The
    first and last twentieth of the record are faded and left out of K, where a tone that does not
    fit the record would ring as an impact does in the bands beside it. K of
    noise scatters by 2 over the root of the number of independent samples, so that the largest of
    many narrow bands is large by chance: ``best`` is the largest above the limit of noise.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> wave = rng.standard_normal(20000)
    >>> time = np.arange(400) / 10000.0
    >>> for start in range(0, 19000, 1000):
    ...     wave[start : start + 400] += 6 * np.exp(-300 * time) * np.sin(2 * np.pi * 3200 * time)
    >>> low, high = kurtogram(wave, 10000.0).band
    >>> bool(low < 3200.0 < high)
    True
    """
    from scipy.signal.windows import tukey

    values = checked_signal(signal, 4 * _LEAST)
    require_positive("sampling_rate", sampling_rate, "Hz")
    most = int(np.log2(values.size / (2 * _LEAST)))
    depth = most if levels is None else levels
    require_positive("levels", depth)
    if depth > most:
        what, why = f"levels = {depth}", f"{values.size} samples allow {most}"
        raise InputError(what, Argument("levels"), why, "Record longer, or take fewer levels")
    lines = np.fft.rfft((values - values.mean()) * tukey(values.size, 2.0 * _FADED))
    if not lines.any():
        what, why = "the signal is constant", "Nothing in it can be impulsive"
        raise InputError(what, Argument("signal"), why, "Look at the channel")
    counts = sorted({2**k for k in range(depth + 1)} | {3 * 2**k for k in range(depth - 1)})
    rows = [
        (split, (band + 0.5) / split, _spectral_kurtosis(lines, split, band))
        for split in counts
        for band in range(split)
    ]
    splits, place, size = (np.array(column) for column in zip(*rows, strict=True))
    half = 0.5 * sampling_rate
    judged = round((1.0 - 2.0 * _FADED) * values.size)
    return Kurtogram(splits, half * place, half / splits, size, _limits(splits, judged))


def _spectral_kurtosis(lines: ComplexArray, split: int, band: int) -> float:
    """Kurtosis of the complex envelope of one of equal bands."""
    width = (lines.size - 1) / split
    roll = _ROLL_OFF * width
    low, high = band * width, (band + 1) * width
    first, last = max(int(np.ceil(low - roll)), 1), min(int(high + roll), lines.size - 1)
    number = np.arange(first, last + 1)
    inside = np.minimum(number - low, high - number)
    edge = np.clip(0.5 + 0.5 * inside / max(roll, 1.0), 0.0, 1.0)
    power = np.abs(np.fft.ifft(lines[first : last + 1] * np.sin(0.5 * np.pi * edge))) ** 2
    ends = int(np.ceil(_FADED * power.size))
    power = power[ends : power.size - ends]
    mean = float(power.mean())
    return float(np.mean(power**2)) / mean**2 - 2.0 if mean > 0.0 else 0.0


def _limits(splits: Array, samples: int) -> Array:
    """Kurtosis that noise exceeds in none of all bands, but for the false alarms."""
    from scipy.stats import norm

    # The ratio of the moments of exponentially distributed powers is close to log-normal; the cubic
    # term was fitted to its simulated quantiles, from 64 to 4096 samples and down to 1e-5.
    root = np.sqrt(0.5 * samples / splits)
    quantile = float(norm.isf(_FALSE_ALARM / splits.size))
    reach = quantile + 0.026 * quantile**3 * np.minimum(1.0, 16.0 / root)
    return np.asarray(2.0 * np.expm1(reach / root))
