"""Condition indicators of gears: FM0, FM4, NA4, crest factor and kurtosis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.errors import ComputationError, Problem
from tribodyn.signals.spectrum_input import checked_signal
from tribodyn.signals.synchronous_average import SynchronousAverage


@dataclass(frozen=True)
class ConditionIndicators:
    """Numbers that grow when teeth are damaged.

    Parameters
    ----------
    crest_factor : float
        Largest distance of the mean revolution from its mean over its alternating rms [-].
    kurtosis : float
        Of the mean revolution: fourth moment over the square of the second [-].
    fm0 : float
        Peak-to-peak value over the sum of the amplitudes of the mesh harmonics [-].
    fm4 : float
        Kurtosis of the difference signal [-]; 3 for noise, 1.5 for a sine.
    na4 : float
        Fourth moment of the residual over the square of the mean second moment of the residuals
        of this and all earlier records [-].
    """

    crest_factor: float
    kurtosis: float
    fm0: float
    fm4: float
    na4: float

    def __repr__(self) -> str:
        """One line."""
        return (
            f"ConditionIndicators(crest factor {self.crest_factor:.4g}, kurtosis "
            f"{self.kurtosis:.4g}, FM0 {self.fm0:.4g}, FM4 {self.fm4:.4g}, NA4 {self.na4:.4g})"
        )


def kurtosis(signal: Any) -> float:
    """Fourth central moment over the square of the second.

    Parameters
    ----------
    signal : (n,) array
        Signal in any unit.

    Returns
    -------
    float
        3 for a normal distribution, 1.5 for a sine, 1 for a square wave [-].

    Raises
    ------
    ComputationError
        If the signal does not change.

    Examples
    --------
    >>> round(kurtosis(np.cos(2 * np.pi * np.arange(64) / 64)), 12)
    1.5
    """
    values = checked_signal(signal, 4)
    away = values - values.mean()
    second = float(np.mean(away**2))
    if second <= (1e-14 * float(np.abs(values).max())) ** 2:
        raise ComputationError(
            Problem(
                what="the kurtosis of a signal that does not change",
                why="It is a moment over the variance, which is zero",
            )
        )
    return float(np.mean(away**4)) / second**2


def condition_indicators(
    average: SynchronousAverage,
    *,
    earlier: Sequence[SynchronousAverage] = (),
    mesh_harmonics: int = 5,
) -> ConditionIndicators:
    """Condition indicators of a mean revolution.

    Parameters
    ----------
    average : SynchronousAverage
        Of the present record.
    earlier : sequence of SynchronousAverage
        Of all earlier records of the same gear, for NA4.
    mesh_harmonics : int
        Harmonics in the sum of FM0.

    Returns
    -------
    ConditionIndicators

    Raises
    ------
    ComputationError
        If the mean revolution has nothing but mesh harmonics, or none of them.

    Notes
    -----
    FM0 and FM4 after R. M. Stewart, Some useful data analysis techniques for gearbox
    diagnostics, University of Southampton, 1977; NA4 after J. J. Zakrajsek, D. P. Townsend and
    H. J. Decker, NASA TM-105950, 1993. FM4 uses the difference signal (mesh harmonics, their
    first sidebands and the shaft orders 1 and 2 removed), NA4 the residual (sidebands kept).
    Without earlier records NA4 is the kurtosis of the residual.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = 2.0 * np.cos(16 * angle) + 0.1 * np.cos(21 * angle)
    >>> made = SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)
    >>> round(condition_indicators(made).fm4, 9)
    1.5
    """
    wave = average.signal
    away = wave - wave.mean()
    rms = float(np.sqrt(np.mean(away**2)))
    mesh = float(average.mesh_amplitudes(mesh_harmonics).sum())
    residual, difference = average.residual(), average.difference()
    least = 1e-12 * rms
    if rms == 0.0 or mesh <= least or min(residual.std(), difference.std()) <= least:
        raise ComputationError(
            Problem(
                what="the mean revolution has "
                + ("no mesh harmonics" if mesh <= least else "nothing but mesh harmonics"),
                why="The indicators compare what is left over with the mesh harmonics",
                remedy="Check the number of teeth, and that the shaft is the one measured",
            )
        )
    seconds = [np.var(one.residual()) for one in (*earlier, average)]
    fourth = float(np.mean((residual - residual.mean()) ** 4))
    return ConditionIndicators(
        float(np.abs(away).max()) / rms,
        kurtosis(wave),
        float(np.ptp(wave)) / mesh,
        kurtosis(difference),
        fourth / float(np.mean(seconds)) ** 2,
    )
