"""Variance of residuals of sound teeth among records of which the later ones may be damaged."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def locked_variance(variances: Sequence[float], *, z: float = 3.09) -> tuple[float, int]:
    """Mean variance of residuals up to the record at which damage begins.

    Parameters
    ----------
    variances : sequence of float
        Of the residuals of all records in their order, the present one last.
    z : float
        Quantile of the normal distribution; 3.09 is that of 99.9 % [-].

    Returns
    -------
    (float, int)
        Mean of the variances before the lock, in the unit of the signal squared, and their number.

    Notes
    -----
    The mean is locked before the first variance above ``L = mean + z sigma / sqrt(n)`` with mean
    and standard deviation of the n variances before it, at least two: Decker, Handschuh and
    Zakrajsek, NASA TM-106553, 1994, as printed by M. Lebold et al., Review of vibration analysis
    methods for gearbox diagnostics and prognostics, 54th meeting of the MFPT, 2000. The limit is
    narrow: a lock by chance leaves a mean of sound records and does no harm.

    Examples
    --------
    >>> locked_variance([1.0, 1.2, 1.1, 4.0, 1.1])
    (1.1, 3)
    """
    values = np.asarray(variances, dtype=float)
    for count in range(2, values.size):
        before = values[:count]
        limit = before.mean() + z * before.std(ddof=1) / np.sqrt(count)
        if values[count] > limit:
            return float(before.mean()), count
    return float(values.mean()), values.size
