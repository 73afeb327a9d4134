"""Kurtogram: the frequency band in which a signal is most impulsive."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import Argument, InputError, require_positive
from tribodyn.record import Record, quantity, record
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.types import Array, ComplexArray

#: Least independent samples of the envelope in a band, and roll-off on each side over its width.
_LEAST, _ROLL_OFF = 64, 0.125
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
    of short filters, so that they have no delay and the edges of all levels are equally sharp. K of
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
    values = checked_signal(signal, 4 * _LEAST)
    require_positive("sampling_rate", sampling_rate, "Hz")
    most = int(np.log2(values.size / (2 * _LEAST)))
    depth = most if levels is None else levels
    require_positive("levels", depth)
    if depth > most:
        what, why = f"levels = {depth}", f"{values.size} samples allow {most}"
        raise InputError(what, Argument("levels"), why, "Record longer, or take fewer levels")
    lines = np.fft.rfft(values - values.mean())
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
    return Kurtogram(splits, half * place, half / splits, size, _limits(splits, values.size))


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
