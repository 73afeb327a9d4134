"""Peaks of a spectrum between its lines, from the known transform of the window."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from tribodyn.signals.spectrum_input import window_values
from tribodyn.types import Array, ComplexArray

#: Long windows have the transform of this one, as a function of the distance in bins.
_LONGEST = 2048


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
    """

    frequency: float
    amplitude: float
    phase: float | None = None

    def __repr__(self) -> str:
        """One line."""
        return f"Peak({self.frequency:.6g} Hz, {self.amplitude:.4g})"


@lru_cache(maxsize=32)
def window_gain(window: str, length: int) -> tuple[Array, ComplexArray]:
    """Transform of a window over the distance from its centre."""
    weights = window_values(window, min(length, _LONGEST))
    offset = np.linspace(-599.5, 599.5, 1200, dtype=np.float64) / 300.0
    turns = np.exp(-2j * np.pi * offset[:, None] * np.arange(weights.size) / weights.size)
    return offset, np.asarray(turns @ weights / weights.sum(), dtype=np.complex128)


def interpolated_peaks(
    frequency: Array,
    amplitude: Array,
    phase: Array | None,
    window: str,
    length: int,
    count: int,
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
    peaks = []
    for top in tops:
        before, middle, after = amplitude[top - 1 : top + 2]
        away = 0.0
        if max(before, after) > 1e-9 * middle and min(before, after) > 0.0:
            away = float(np.interp(np.log(after / before), slope, offset[span]))
        away = float(np.clip(away, -0.5, 0.5))
        turned = None
        if phase is not None:
            turn = np.interp(-away, offset, np.unwrap(np.angle(gain)))
            turned = float(np.angle(np.exp(1j * (phase[top] - turn))))
        peaks.append(
            Peak(
                float(frequency[top] + away * (frequency[1] - frequency[0])),
                float(middle / np.interp(-away, offset, size)),
                turned,
            )
        )
    return peaks
