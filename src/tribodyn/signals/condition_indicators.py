"""All condition indicators of a mean revolution at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tribodyn.signals.gear_indicators import (
    energy_ratio,
    fm0,
    fm4,
    kurtosis,
    m6a,
    m8a,
    mesh_sum,
    na4,
    na4_star,
    nb4,
    sideband_index,
    sideband_level_factor,
    variance,
)
from tribodyn.signals.synchronous_average import SynchronousAverage


@dataclass(frozen=True)
class ConditionIndicators:
    """Numbers that grow when teeth are damaged; those that were not computed are NaN.

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
    m6a, m8a : float
        Sixth and eighth standardized moment of the difference signal [-]; 15 and 105 for noise.
    nb4 : float
        NA4 of the envelope of the strongest mesh harmonic [-].
    energy_ratio : float
        Rms of the difference over that of the mesh harmonics with their first sidebands [-].
    sideband_index : float
        Mean amplitude of the first sidebands of the mesh frequency, in the unit of the signal.
    sideband_level_factor : float
        Sum of their amplitudes over the alternating rms of the mean revolution [-].
    na4_star : float
        NA4 with the mean of the records before damage began, where there are earlier ones [-].
    """

    crest_factor: float
    kurtosis: float
    fm0: float
    fm4: float
    na4: float
    m6a: float = float("nan")
    m8a: float = float("nan")
    nb4: float = float("nan")
    energy_ratio: float = float("nan")
    sideband_index: float = float("nan")
    sideband_level_factor: float = float("nan")
    na4_star: float = float("nan")

    def __repr__(self) -> str:
        """One line."""
        return (
            f"ConditionIndicators(crest factor {self.crest_factor:.4g}, kurtosis "
            f"{self.kurtosis:.4g}, FM0 {self.fm0:.4g}, FM4 {self.fm4:.4g}, NA4 {self.na4:.4g}, "
            f"NB4 {self.nb4:.4g}, energy ratio {self.energy_ratio:.4g})"
        )


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
        Of all earlier records of the same gear in their order, for NA4, NA4* and NB4.
    mesh_harmonics : int
        Harmonics in the sum of FM0.

    Raises
    ------
    ComputationError
        If the mean revolution has nothing but mesh harmonics, or none of them.

    Notes
    -----
    Each indicator is a function of its name on this page, with definition and source.

    Examples
    --------
    >>> angle = 2 * np.pi * np.arange(320) / 320
    >>> wave = 2.0 * np.cos(16 * angle) + 0.1 * np.cos(21 * angle)
    >>> average = SynchronousAverage(angle, wave, 0.0 * angle, 50, 16)
    >>> round(condition_indicators(average).fm4, 9)
    1.5
    """
    away = average.signal - average.signal.mean()
    mesh_sum(average, mesh_harmonics)
    return ConditionIndicators(
        crest_factor=float(np.abs(away).max()) / float(np.sqrt(variance(average))),
        kurtosis=kurtosis(average.signal),
        fm0=fm0(average, mesh_harmonics=mesh_harmonics),
        fm4=fm4(average),
        na4=na4(average, earlier=earlier),
        m6a=m6a(average),
        m8a=m8a(average),
        nb4=nb4(average, earlier=earlier),
        energy_ratio=energy_ratio(average),
        sideband_index=sideband_index(average),
        sideband_level_factor=sideband_level_factor(average),
        na4_star=na4_star(average, earlier=earlier) if earlier else float("nan"),
    )
