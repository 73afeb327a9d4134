"""Envelope of a modulated vibration and its spectrum."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import InputError, require_positive
from tribodyn.signals.recorded_signal import checked_signal, refuse_above_half
from tribodyn.signals.spectrum import SignalSpectrum, spectrum
from tribodyn.types import Array


def envelope(
    signal: Any, sampling_rate: float, *, band: tuple[float, float] | None = None
) -> Array:
    """Envelope of a signal, by the Hilbert transform of a band of it.

    Parameters
    ----------
    signal : (n,) array
        Equally spaced samples, in any unit.
    sampling_rate : float
        Samples per second [Hz].
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
    >>> made = envelope(wave, 1000.0)
    >>> round(float(made.min()), 6), round(float(made.max()), 6)
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
        raise InputError(
            f"a band from {low:g} to {high:g} Hz",
            where="argument band",
            why="It must rise, from above zero",
        )
    sections = butter(4, (low, high), btype="bandpass", fs=sampling_rate, output="sos")
    return np.asarray(np.abs(hilbert(sosfiltfilt(sections, values))))


def envelope_spectrum(
    signal: Any,
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
        As :func:`envelope` takes them [Hz].
    window, unit
        As :func:`spectrum` takes them.

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
    >>> made = envelope_spectrum(wave, 1000.0, window="hann")
    >>> made
    SignalSpectrum(1001 lines to 500 Hz, largest 1 at 5 Hz)
    >>> round(float(made.amplitude[0]), 6)
    2.0
    """
    hull = envelope(signal, sampling_rate, band=band)
    mean = float(hull.mean())
    made = spectrum(hull - mean, sampling_rate, window=window, unit=unit)
    # the mean would hide slow modulation under its main lobe; it comes back as its own line
    made.amplitude[0] = mean
    return made
