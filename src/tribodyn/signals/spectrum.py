"""Single-sided spectrum of a recorded signal, with the gains of the window taken out."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from tribodyn.errors import InputError, Problem, require_between, require_positive
from tribodyn.signals.spectrum_input import checked_signal, window_values
from tribodyn.signals.spectrum_result import SignalSpectrum
from tribodyn.types import Mask

_SCALINGS = ("amplitude", "power", "density")


def spectrum(
    signal: Any,
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
        raise InputError(
            Problem(
                what=f"there is no scaling {scaling!r}",
                where="argument scaling",
                remedy=f"Take one of {', '.join(_SCALINGS)}",
            )
        )
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
    bandwidth = sampling_rate * float(np.sum(weights**2) / weights.sum() ** 2)
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
    """Lines that stand for a pair of a positive and a negative frequency."""
    pair = np.ones(length // 2 + 1, dtype=bool)
    pair[0] = False
    if length % 2 == 0:
        pair[-1] = False
    return pair
