"""How far predictions are from what they predict."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.types import Array


@dataclass(frozen=True)
class ErrorMeasures:
    """Errors of one target over rows that no training has seen.

    Parameters
    ----------
    rows : int
        Number of rows.
    mean_square : float
        Mean square error, in the square of the unit of the target.
    mean_absolute : float
        Mean absolute error, in the unit of the target.
    determination : float
        R^2: 1 less the mean square error over the variance [-]; NaN where nothing varies.
    mean_absolute_relative : float
        Mean of the absolute error over the absolute value, rows of the value 0 left out [-].
    largest : float
        Largest absolute error, in the unit of the target.
    """

    rows: int
    mean_square: float
    mean_absolute: float
    determination: float
    mean_absolute_relative: float
    largest: float

    @classmethod
    def of(cls, true: Array, predicted: Array) -> ErrorMeasures:
        """Compare predictions with true values.

        Parameters
        ----------
        true, predicted : (n,) array
        """
        error = np.abs(predicted - true)
        square, variance, there = float(np.mean(error**2)), float(np.var(true)), true != 0.0
        relative = float(np.mean(error[there] / np.abs(true[there]))) if there.any() else np.nan
        share = 1.0 - square / variance if variance > 0.0 else np.nan
        return cls(true.size, square, float(error.mean()), share, relative, float(error.max()))
