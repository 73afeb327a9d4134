"""A narrow band of a spectrum on close lines (zoom FFT)."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.signals.spectrum_input import checked_signal, refuse_above_half, window_values
from tribodyn.signals.spectrum_result import SignalSpectrum


def zoom_spectrum(
    signal: Any,
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
    signal : (n,) array
        Equally spaced samples, in any unit.
    sampling_rate : float
        Samples per second [Hz].
    lowest, highest : float
        Ends of the band [Hz].
    points : int
        Number of lines.
    window : str
        Window of :func:`scipy.signal.get_window`.
    unit : str
        Unit of the signal, for display.

    Returns
    -------
    SignalSpectrum

    Raises
    ------
    InputError
        If the signal is not finite or too short, or the band is not below half the rate.

    Notes
    -----
    Chirp transform (:func:`scipy.signal.zoom_fft`). Close lines draw the peak of the window in
    full, which leaves no scalloping; two sines are told apart only if they differ by more than
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
        raise InputError(
            Problem(
                what=f"a band from {lowest:g} to {highest:g} Hz on {points} lines",
                where="arguments lowest, highest and points",
                why="It must rise from above zero and have two lines or more",
            )
        )
    weights = window_values(window, values.size)
    lines = zoom_fft(weights * values, [lowest, highest], m=points, fs=sampling_rate, endpoint=True)
    lines = 2.0 * np.asarray(lines) / weights.sum()
    return SignalSpectrum(
        np.linspace(lowest, highest, points),
        np.abs(lines),
        np.angle(lines),
        window=window,
        noise_bandwidth=sampling_rate * float(np.sum(weights**2) / weights.sum() ** 2),
        unit=unit,
    )
