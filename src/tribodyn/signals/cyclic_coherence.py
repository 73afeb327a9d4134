"""Cyclic spectral coherence: which carriers are modulated at which frequencies."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.angular_resampling import checked_signal, window_values
from tribodyn.types import Array

#: Probability that noise exceeds the threshold at one point.
_FALSE_ALARM = 0.01
#: Least periods of a cyclic frequency in the record, and independent blocks.
_PERIODS, _BLOCKS = 4.0, 8.0
#: Coherence, over that of noise, from which the mean power that leaks to a low cyclic frequency is
#: subtracted.
_LEAKAGE = 0.05


@record
class CyclicCoherence(Record):
    """Squared coherence between lines that lie a cyclic frequency apart.

    Parameters
    ----------
    frequency : (k,) array
        Frequency midway between the two lines, that of the carrier [Hz].
    cyclic_frequency : (m,) array
        Distance of the two lines, the frequency of the modulation [Hz].
    coherence : (k, m) array
        Squared modulus of the cyclic spectral coherence, from 0 to 1 [-]; 0 where one of the lines
        lies below the second or above the last but one of the spectrum of a block.
    threshold : float
        Coherence that noise exceeds at 1 % of the points [-].
    blocks : float
        Number of independent blocks behind it [-].
    spread : float
        Number of carriers over that of independent ones among many of them [-].
    """

    ARRAY = "coherence"

    frequency: Array = quantity("frequency", unit="Hz", axis=True)
    cyclic_frequency: Array = quantity("cyclic_frequency", unit="Hz", axis=True)
    coherence: Array = quantity("frequency", "cyclic_frequency", unit="1")
    threshold: float = fact()
    blocks: float = fact()
    spread: float = 1.0

    def strongest(self) -> tuple[float, float, float]:
        """Point with the largest coherence.

        Returns
        -------
        tuple of three float
            Frequency [Hz], cyclic frequency [Hz] and squared coherence there [-].
        """
        row, column = np.unravel_index(int(np.argmax(self.coherence)), self.coherence.shape)
        return (
            float(self.frequency[row]),
            float(self.cyclic_frequency[column]),
            float(self.coherence[row, column]),
        )

    def enhanced_envelope_spectrum(self, band: tuple[float, float] | None = None) -> Array:
        """Mean squared coherence over the carriers, for each cyclic frequency.

        Parameters
        ----------
        band : tuple of two float, optional
            Carriers of the mean [Hz]; all by default.

        Returns
        -------
        (m,) array
            Mean over the carriers [-]; about one over ``blocks`` for noise.

        Raises
        ------
        InputError
            If no carrier lies in the band.
        """
        values = self._carriers(band)
        return np.asarray(values.sum(axis=0) / np.maximum((values > 0.0).sum(axis=0), 1))

    def noise_limit(
        self, band: tuple[float, float] | None = None, *, false_alarm: float = 0.05
    ) -> float:
        """Level that the largest mean coherence of noise exceeds with a stated probability.

        Parameters
        ----------
        band : tuple of two float, optional
            As for :meth:`enhanced_envelope_spectrum` [Hz].
        false_alarm : float
            Share of records of noise in which any of the cyclic frequencies exceeds it [-].

        Returns
        -------
        float
            Limit [-].

        Raises
        ------
        InputError
            If no carrier lies in the band, or the probability is not between 0 and 1.

        Notes
        -----
        The squared coherence of noise over K blocks exceeds x with the probability
        (1 - x)^(K - 1), that is, it has a beta distribution. The mean over m carriers, with
        1 + (m - 1)/``spread`` independent ones, has about the beta distribution of the same mean
        and variance, and the largest of all cyclic frequencies the product of these distributions.
        Frequencies closer than half of one over the duration depend on each other: the limit is
        then too high.

        Examples
        --------
        >>> noise = np.random.default_rng(0).standard_normal(20000)
        >>> result = cyclic_coherence(noise, 5000.0, np.arange(20.0, 40.0, 0.5))
        >>> bool(result.enhanced_envelope_spectrum().max() < result.noise_limit())
        True
        """
        from scipy.optimize import brentq
        from scipy.stats import beta

        require_between("false_alarm", false_alarm, 1e-12, 1.0 - 1e-12)
        carriers = (self._carriers(band) > 0.0).sum(axis=0)
        sizes, repeats = np.unique(carriers[carriers > 0], return_counts=True)
        if not sizes.size:
            return 1.0
        independent = 1.0 + (sizes - 1.0) / self.spread
        total = independent * (self.blocks + 1.0) - 1.0
        first = total / self.blocks

        def excess(level: float) -> float:
            below = beta.logcdf(level, first, total - first)
            return float(repeats @ below) - float(np.log1p(-false_alarm))

        return float(brentq(excess, 1e-3 / self.blocks, 1.0, xtol=1e-9))

    def _carriers(self, band: tuple[float, float] | None) -> Array:
        """Coherence of the carriers in a band; all by default."""
        low, high = band or (0.0, np.inf)
        inside = (self.frequency >= low) & (self.frequency <= high)
        if not inside.any():
            what = f"a band from {low:g} to {high:g} Hz"
            last, step = self.frequency[-1], self.frequency[1] - self.frequency[0]
            why = f"The carriers go from 0 to {last:g} Hz in steps of {step:g} Hz"
            raise InputError(what, Argument("band"), why, "Give a wider band (low, high) in Hz")
        return self.coherence[inside]

    def __repr__(self) -> str:
        """One line."""
        carrier, modulation, size = self.strongest()
        return (
            f"CyclicCoherence({size:.3g} at {carrier:.5g} Hz modulated with {modulation:.5g} Hz, "
            f"noise below {self.threshold:.2g})"
        )


def cyclic_coherence(
    signal: object,
    sampling_rate: float,
    cyclic_frequencies: object,
    *,
    block_length: int = 256,
    overlap: float = 0.75,
    window: str = "hann",
) -> CyclicCoherence:
    """Cyclic spectral coherence by the averaged cyclic periodogram.

    Parameters
    ----------
    signal, sampling_rate
        As in :func:`tribodyn.analysis.spectrum` [Hz].
    cyclic_frequencies : (m,) array
        Frequencies of the modulation [Hz], rising. A modulation shows within one over the duration
        of the record: steps of half of that leave none out.
    block_length : int
        Samples of a block, which set the resolution of the carrier [-].
    overlap : float
        Part of a block that it shares with the next [-].
    window : str
        Window of :func:`scipy.signal.get_window`.

    Raises
    ------
    InputError
        If the record holds less than eight independent blocks or four periods of a cyclic
        frequency, or one of these is not below the sampling rate.

    Notes
    -----
    gamma(f, a) = <X(f + a/2) X*(f - a/2)> over the root of <|X(f + a/2)|^2> <|X(f - a/2)|^2>, with
    means over the blocks: J. Antoni, Mechanical Systems and Signal Processing 21 (2007) 597. Random
    impacts of a bearing, whose lines vanish in the spectrum, are coherent at multiples of their
    rate; a deterministic gear signal is too, and is taken out before by
    :func:`tribodyn.analysis.lifter` or a mean revolution. The mean over the carriers is the
    enhanced envelope spectrum.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> time = np.arange(20000) / 5000.0
    >>> noise = rng.standard_normal(20000) * (1.0 + np.cos(2 * np.pi * 40.0 * time))
    >>> result = cyclic_coherence(noise, 5000.0, [30.0, 40.0, 50.0])
    >>> [round(each, 1) for each in result.enhanced_envelope_spectrum().tolist()]
    [0.0, 0.5, 0.0]
    """
    values = checked_signal(signal, 64)
    require_positive("sampling_rate", sampling_rate, "Hz")
    alpha = checked_signal(cyclic_frequencies, 1, "cyclic_frequencies")
    require_between("block_length", block_length, 16, values.size, "samples")
    require_between("overlap", overlap, 0.0, 0.95)
    _check_cyclic(alpha, values.size, sampling_rate)
    weights = window_values(window, block_length)
    step = max(block_length - round(overlap * block_length), 1)
    count = 1 + (values.size - block_length) // step
    independent, spread = _independent(weights, step, count)
    if independent < _BLOCKS:
        what = f"{independent:.3g} independent blocks of {block_length} samples"
        why = f"At least {_BLOCKS:g} separate a coherence from noise"
        raise InputError(
            what, Argument("block_length"), why, "Record longer, or shorten the blocks"
        )
    from scipy.fft import fft

    half = block_length // 2
    frequency = np.arange(half + 1) * sampling_rate / block_length
    coherence = np.zeros((half + 1, alpha.size))
    # Single precision is enough for a mean over blocks, and twice as fast.
    centred = ((values - values.mean()) / (np.std(values) or 1.0)).astype(np.float32)
    weights = weights.astype(np.float32)
    # The signal is real: the line at f - a/2 is the conjugate of the mirrored one.
    mirror = -np.arange(half + 1)
    sample, block_starts = np.arange(block_length), np.arange(0, values.size, block_length)
    for column, each in enumerate(alpha):
        turns = -1j * np.pi * each / sampling_rate
        turning = np.outer(np.exp(turns * block_starts), np.exp(turns * sample)).reshape(-1)
        turning = turning[: values.size].astype(np.complex64)
        blocks = np.lib.stride_tricks.sliding_window_view(centred * turning, block_length)[::step]
        above = fft(blocks * weights, axis=1, overwrite_x=True)
        phase = turning[: count * step : step] ** 2
        leakage = phase.conj() * phase.mean()
        leakage *= np.abs(phase.mean()) ** 2 >= _LEAKAGE / independent
        products = above[:, : half + 1] * above[:, mirror]
        cross = np.abs((1.0 - leakage) @ products / count) ** 2
        power = np.mean(above.real**2 + above.imag**2, axis=0)
        power = power[: half + 1] * power[mirror]
        # Next to its mirror image a line of noise is coherent with itself.
        edge = 0.5 * each + frequency[1]
        inside = (frequency >= edge) & (frequency <= 0.5 * sampling_rate - edge) & (power > 0.0)
        coherence[inside, column] = np.minimum(cross[inside] / power[inside], 1.0)
    threshold = 1.0 - _FALSE_ALARM ** (1.0 / (independent - 1.0))
    return CyclicCoherence(frequency, alpha, coherence, threshold, independent, spread)


def _check_cyclic(alpha: Array, samples: int, rate: float) -> None:
    """Raise an error for cyclic frequencies that fall, or that the record cannot show."""
    least = _PERIODS * rate / samples
    falls = alpha.size > 1 and float(np.diff(alpha).min()) <= 0.0
    if falls or not least <= alpha[0] or not alpha[-1] < rate:
        what = f"cyclic frequencies from {alpha.min():g} to {alpha.max():g} Hz"
        why = (
            f"They must rise, from {least:.3g} Hz, four periods in the record, to below the "
            f"sampling rate of {rate:g} Hz"
        )
        raise InputError(what, Argument("cyclic_frequencies"), why, "Sort them, or record longer")


def _independent(weights: Array, step: int, count: int) -> tuple[float, float]:
    """Number of independent blocks among overlapping ones, and of lines for an independent one."""
    size = weights.size
    lags = range(0, min(size, count * step), step)
    # Squared correlation of lines of two blocks, over the distance of the lines and the lag.
    shared = (
        np.array(
            [np.abs(np.fft.fft(weights[lag:] * weights[: size - lag], size)) ** 2 for lag in lags]
        )
        / float(weights @ weights) ** 2
    )
    by_distance = 2.0 * shared.sum(axis=0) - shared[0]
    return count / float(by_distance[0]), float(np.sum((by_distance / by_distance[0]) ** 2))
