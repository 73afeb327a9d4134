"""Indicators of a signal that keep the order of the integrator: mean, rms, peaks.

All take signals on the fine samples of a response, (3 * steps, ...): both ends and the middle of
every step. Between these three samples a signal is a parabola, so that peaks are not missed.
"""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics.time.response import FineSamples
from tribodyn.types import Array


def mean(samples: FineSamples, signal: Array) -> Array:
    """Mean over time.

    Parameters
    ----------
    samples : FineSamples
        ``response.fine``.
    signal : (3 * steps, ...) array
        Signal in any unit.

    Returns
    -------
    array
        Shape ``signal.shape[1:]``, in the unit of the signal.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(float(mean(samples, wave)), 6)
    3.0
    """
    return samples.mean(signal)


def rms(samples: FineSamples, signal: Array) -> Array:
    """Root mean square, mean included.

    Parameters
    ----------
    samples : FineSamples
        ``response.fine``.
    signal : (3 * steps, ...) array
        Signal in any unit.

    Returns
    -------
    array
        Shape ``signal.shape[1:]``, in the unit of the signal.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(float(rms(samples, wave) ** 2), 6)
    11.0
    """
    return np.asarray(np.sqrt(samples.mean(signal**2)))


def alternating_rms(samples: FineSamples, signal: Array) -> Array:
    """Root mean square of the signal less its mean.

    Parameters
    ----------
    samples : FineSamples
        ``response.fine``.
    signal : (3 * steps, ...) array
        Signal in any unit.

    Returns
    -------
    array
        Shape ``signal.shape[1:]``, in the unit of the signal.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(float(alternating_rms(samples, wave) ** 2), 6)
    2.0
    """
    return rms(samples, signal - samples.mean(signal))


def extremes(signal: Array) -> tuple[Array, Array]:
    """Least and largest value, with the peaks between the samples.

    Parameters
    ----------
    signal : (3 * steps, ...) array
        Signal on fine samples, in any unit.

    Returns
    -------
    tuple of two arrays
        Shape ``signal.shape[1:]``, in the unit of the signal.

    Notes
    -----
    Vertex of the parabola through the three samples of each step, where it lies in the step.

    Examples
    --------
    >>> t = np.array([0.0, 0.5, 1.0])
    >>> low, high = extremes(1.0 - (t - 0.6) ** 2)
    >>> round(float(high), 12)
    1.0
    """
    left, middle, right = np.moveaxis(signal.reshape(-1, 3, *signal.shape[1:]), 1, 0)
    slope, bend = right - left, left - 2.0 * middle + right
    inside = np.abs(slope) < 2.0 * np.abs(bend)
    vertex = np.where(inside, middle - slope**2 / (8.0 * np.where(inside, bend, 1.0)), middle)
    values = np.concatenate((signal, vertex))
    return values.min(axis=0), values.max(axis=0)


def peak_to_peak(signal: Array) -> Array:
    """Largest less least value.

    Parameters
    ----------
    signal : (3 * steps, ...) array
        Signal on fine samples, in any unit.

    Returns
    -------
    array
        Shape ``signal.shape[1:]``, in the unit of the signal.

    Examples
    --------
    >>> float(peak_to_peak(np.array([0.0, 1.0, 2.0])))
    2.0
    """
    low, high = extremes(signal)
    return np.asarray(high - low)


def crest_factor(samples: FineSamples, signal: Array) -> Array:
    """Largest distance from the mean over the rms of the alternating part.

    Parameters
    ----------
    samples : FineSamples
        ``response.fine``.
    signal : (3 * steps, ...) array
        Signal in any unit.

    Returns
    -------
    array
        Shape ``signal.shape[1:]``; zero for a constant signal.

    Examples
    --------
    >>> from tribodyn.dynamics import System, simulate
    >>> free = System([[1.0]], [[0.0]], [[0.0]], [0.0])
    >>> samples = simulate(free, 1.0, 1, ([0.0], [0.0]), steps=256).fine
    >>> wave = 3.0 + 2.0 * np.cos(2 * np.pi * samples.phase)
    >>> round(float(crest_factor(samples, wave) ** 2), 6)
    2.0
    """
    alternating = signal - samples.mean(signal)
    low, high = extremes(alternating)
    size, peak = rms(samples, alternating), np.maximum(high, -low)
    moves = size > 1e-12 * np.abs(signal).max(axis=0)
    return np.asarray(np.divide(peak, size, out=np.zeros_like(peak), where=moves))
