"""Spectrogram: the amplitude over time and frequency."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import require_between, require_positive
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.recorded_signal import checked_signal, window_values
from tribodyn.types import Array


@record
class Spectrogram(Record):
    """Amplitude over frequency and time.

    Parameters
    ----------
    frequency : (k,) array
        Frequency [Hz].
    time : (m,) array
        Middle of each block from the first sample [s].
    amplitude : (k, m) array
        Peak amplitude, in the unit of the signal.
    block_duration : float
        Duration of one block [s].
    sampling_rate : float
        Samples per second [Hz].
    noise_bandwidth : float
        Width of the ideal filter that passes as much noise as one line [Hz].
    unit : str
        Unit of the signal.
    """

    ARRAY = "amplitude"

    frequency: Array = quantity("frequency", unit="Hz", axis=True)
    time: Array = quantity("time", unit="s", axis=True)
    amplitude: Array = quantity("frequency", "time", unit="@unit")
    block_duration: float = fact()
    sampling_rate: float
    noise_bandwidth: float
    unit: str = ""

    def __repr__(self) -> str:
        """One line."""
        line, block = self.strongest()
        return (
            f"Spectrogram({self.time.size} blocks of {self.block_duration:.4g} s, to "
            f"{self.frequency[-1]:.6g} Hz, largest {self.amplitude[line, block]:.4g} {self.unit} "
            f"at {self.frequency[line]:.6g} Hz and {self.time[block]:.4g} s)"
        ).replace("  ", " ")

    def strongest(self) -> tuple[int, int]:
        """Return where the amplitude is largest, the mean left out.

        Returns
        -------
        tuple of two int
            Index of the frequency and of the time.
        """
        place = int(np.argmax(self.amplitude[1:]))
        line, block = divmod(place, self.time.size)
        return line + 1, block

    def rms(self) -> Array:
        """Root mean square of each block, mean included.

        Returns
        -------
        (m,) array
            In the unit of the signal; samples count with the square of the window (Parseval).
        """
        square = 0.5 * self.amplitude**2
        square[0] *= 2.0
        if np.isclose(self.frequency[-1], 0.5 * self.sampling_rate, rtol=1e-9):
            square[-1] *= 2.0
        return np.asarray(np.sqrt(square.sum(axis=0) * self.frequency[1] / self.noise_bandwidth))


def spectrogram(
    signal: Any,
    sampling_rate: float,
    *,
    block_length: int | None = None,
    overlap: float = 0.75,
    window: str = "hann",
    unit: str = "",
) -> Spectrogram:
    """Amplitude spectra of short blocks, one after the other.

    Parameters
    ----------
    signal, sampling_rate
        As :func:`tribodyn.analysis.spectrum` takes them [Hz].
    block_length : int, optional
        Samples of a block; by default about the square root of eight times their number. Longer
        blocks tell closer frequencies apart and blur what changes faster.
    overlap, window, unit
        As :func:`tribodyn.analysis.spectrum` takes them [-].

    Returns
    -------
    Spectrogram
        Only blocks that lie wholly within the record, so that no amplitude falls at its ends.

    Raises
    ------
    InputError
        If the signal is not finite or too short, or an argument is out of its range.

    Examples
    --------
    >>> time = np.arange(4000) / 1000.0
    >>> wave = np.where(time < 2.0, 0.5, 3.0) * np.cos(2 * np.pi * 125.0 * time)
    >>> made = spectrogram(wave, 1000.0, block_length=200, unit="um")
    >>> made.time.size, round(float(made.time[0]), 6), round(float(made.time[-1]), 6)
    (77, 0.1, 3.9)
    >>> line, _ = made.strongest()
    >>> round(float(made.frequency[line]), 6), round(float(made.amplitude[line].max()), 6)
    (125.0, 3.0)
    """
    values = checked_signal(signal, 16)
    require_positive("sampling_rate", sampling_rate, "Hz")
    length = round(np.sqrt(8.0 * values.size)) if block_length is None else block_length
    require_between("block_length", length, 8, values.size, "samples")
    require_between("overlap", overlap, 0.0, 0.95)
    hop = max(length - round(overlap * length), 1)
    # A block number p is centred on the sample p * hop; keep those inside the record.
    first, last = _inside(values.size, length, hop)
    if last < first:
        hop, first, last = length // 2, 1, 1
    weights = window_values(window, length)
    from scipy.signal import ShortTimeFFT

    transform = ShortTimeFFT(
        weights, hop, sampling_rate, fft_mode="onesided2X", scale_to="magnitude", phase_shift=None
    )
    lines = transform.stft(values, p0=first, p1=last + 1)
    return Spectrogram(
        np.asarray(transform.f),
        np.arange(first, last + 1) * hop / sampling_rate,
        np.abs(lines),
        length / sampling_rate,
        sampling_rate,
        sampling_rate * float(np.sum(weights**2) / weights.sum() ** 2),
        unit,
    )


def _inside(size: int, length: int, hop: int) -> tuple[int, int]:
    """First and last block that lie within the record."""
    half = length // 2
    return -(-half // hop), (size - (length - half)) // hop
