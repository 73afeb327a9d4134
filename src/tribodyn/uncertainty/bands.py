"""Confidence band of the mean of repeated curves, by the bootstrap."""

from __future__ import annotations

import numpy as np

from tribodyn.checks import require_flag, require_whole
from tribodyn.errors import Argument, InputError, real_numbers, require_between
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array


@record
class Band(Record):
    """Mean of repeated curves with its confidence band.

    Parameters
    ----------
    mean : (...) array
        Mean over the repeats, in the unit of the samples.
    low, high : (...) array
        Ends of the band.
    level : float
        Probability that the band holds the true mean [-].
    repeats : int
        Number of curves.
    simultaneous : bool
        True: the band holds the whole curve with that probability; False: each point does.
    unit : str
        Unit of the samples.
    """

    mean: Array = quantity("point", unit="@unit")
    low: Array = quantity("point", unit="@unit")
    high: Array = quantity("point", unit="@unit")
    level: float = fact()
    repeats: int = fact()
    simultaneous: bool = fact()
    unit: str = ""


def bootstrap_band(
    samples: object,
    level: float = 0.95,
    *,
    seed: int,
    resamples: int = 2000,
    simultaneous: bool = False,
    unit: str = "",
) -> Band:
    """Confidence band of the mean over repeated curves.

    Parameters
    ----------
    samples : (repeats, ...) array
        Repeated values or curves, such as the motion over a mesh cycle of every repeat.
    level : float
        Probability that the band holds the true mean [-].
    seed : int
        The same seed gives the same band.
    resamples : int
        Resampled means.
    simultaneous : bool
        Whether the band holds the whole curve with that probability, not each point of it.
    unit : str
        Unit of the samples, for display.

    Raises
    ------
    InputError
        If there are fewer than three repeats, samples are not finite, or an argument is out of
        its range.

    Notes
    -----
    Bootstrap-t: of every resampled mean the distance to the mean is divided by its own standard
    error, and the quantiles of that ratio are multiplied by the standard error of the samples. It
    keeps its level for few repeats and for skew distributions, where plain percentiles are too
    narrow. B. Efron and R. J. Tibshirani, An Introduction to the Bootstrap, 1993, section 12.5. A
    point at which all repeats are equal has a band of no width.

    Examples
    --------
    >>> values = np.random.default_rng(0).normal(3.0, 1.0, 50)
    >>> made = bootstrap_band(values, seed=1)
    >>> bool(made.low < 3.0 < made.high)
    True
    """
    curves = real_numbers(Argument("samples"), samples)
    require_between("level", level, 0.5, 0.9999)
    count = require_whole("resamples", resamples, 100)
    all_points = require_flag("simultaneous", simultaneous)
    if curves.ndim < 1 or curves.shape[0] < 3 or not curves.size or not np.all(np.isfinite(curves)):
        what = f"samples have the shape {curves.shape}, or are not all finite"
        why = "At least three repeats of finite values are needed, the repeats first"
        remedy = "Repeat the measurement, or leave out what is missing"
        raise InputError(what, Argument("samples"), why, remedy)
    repeats, shape = curves.shape[0], curves.shape[1:]
    flat = curves.reshape(repeats, -1)
    mean, error = flat.mean(axis=0), flat.std(axis=0, ddof=1) / np.sqrt(repeats)
    ratio = _ratios(flat - mean, count, np.random.default_rng(require_whole("seed", seed, 0)))
    if all_points:
        reach = np.quantile(np.abs(ratio).max(axis=1), level)
        above, below = reach * error, reach * error
    else:
        ends = np.quantile(ratio, (0.5 * (1.0 - level), 0.5 * (1.0 + level)), axis=0)
        below, above = ends[1] * error, -ends[0] * error
    low, high = ((mean - below).reshape(shape), (mean + above).reshape(shape))
    return Band(mean.reshape(shape), low, high, float(level), repeats, all_points, unit)


def _ratios(away: Array, count: int, random: np.random.Generator) -> Array:
    """Resampled means over their own standard errors (resamples, points)."""
    repeats = away.shape[0]
    weights = random.multinomial(repeats, np.full(repeats, 1.0 / repeats), size=count) / repeats
    means = weights @ away
    squares = weights @ away**2 - means**2
    # A resample that repeats a single curve has no variance and is left out.
    error = np.sqrt(np.maximum(squares, 0.0) / (repeats - 1))
    least = 1e-9 * np.sqrt(np.mean(away**2, axis=0))
    return np.asarray(np.where(error > least, means / np.maximum(error, least + 1e-300), 0.0))
