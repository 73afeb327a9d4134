"""Distributions of uncertain quantities, read from text, their samples, and bands of results."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    real_numbers,
    require_between,
    require_one_of,
    shortened,
    warn,
)
from tribodyn.nomenclature import QUANTITIES, require_flag, require_whole
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array
from tribodyn.units import UnitProblemError, parse, split

#: Half width of the truncated normal distribution in standard deviations.
_CUT = 3.0
_SPREAD = re.compile(r"(normal|lognormal)?\s*(.+?)\s*(?:\+-|\+/-|±)\s*(.+)", re.IGNORECASE)
_RANGE = re.compile(r"(?:uniform)?\s*(.+?)\s*\.\.\s*(.+)", re.IGNORECASE)


def distribution(name: str, text: object, unit: str | None = None) -> Any:
    """Distribution of a quantity.

    Parameters
    ----------
    name : str
        Name of the quantity or dotted key of a case; where its last part is a quantity of the
        nomenclature, its values carry a unit and come back in SI.
    text : str, float, (n,) array or SciPy distribution
        ``"0.05 +- 0.83 %"`` or ``"90 N*m +- 2 N*m"``: mean and standard deviation of a normal
        distribution that is cut at three of them; ``"normal ..."`` the same without the cut;
        ``"lognormal 0.05 +- 20 %"`` mean and standard deviation of the quantity itself;
        ``"0.4 um .. 0.6 um"``: every value between is equally likely; a number or a quantity: that
        value; an array: measured values, in SI, drawn from their empirical distribution with
        straight lines between them.
    unit : str, optional
        Unit of the quantity; by default that of the nomenclature.

    Returns
    -------
    distribution
        With ``ppf``, the quantile function; of SciPy, or one value, or data.

    Raises
    ------
    InputError
        If the text is none of these, a unit is wrong, or a spread is not positive.

    Examples
    --------
    >>> made = distribution("operation.torque", "90 N*m +- 2 %")
    >>> [round(float(made.ppf(u)), 3) for u in (0.0, 0.5, 1.0)]
    [84.6, 90.0, 95.4]
    """
    if hasattr(text, "ppf"):
        return text
    if isinstance(text, bool) or text is None:
        raise _wrong(name, text)
    if isinstance(text, str):
        return _from_text(name, text.strip(), unit)
    try:
        values = np.sort(np.asarray(text, dtype=float).reshape(-1))
    except (TypeError, ValueError, OverflowError):
        raise _wrong(name, text) from None
    if not values.size or not np.all(np.isfinite(values)):
        raise _wrong(name, text)
    return _Data(values)


def _from_text(name: str, text: str, unit: str | None) -> Any:
    from scipy import stats

    if unit is None:
        quantity = QUANTITIES.get(name.rpartition(".")[2])
        unit = quantity.unit if quantity is not None else ""
    kind = text.lower().split()[0] if text else ""
    try:
        if match := _SPREAD.fullmatch(text):
            mean = parse(match[2].strip(), unit)
            spread = _spread(match[3].strip(), mean, unit)
            if kind == "lognormal":
                if not mean > 0.0:
                    raise _wrong(name, text, "The mean of a lognormal distribution is positive")
                square = float(np.log1p((spread / mean) ** 2))
                return stats.lognorm(np.sqrt(square), scale=mean * np.exp(-0.5 * square))
            if kind == "normal":
                return stats.norm(mean, spread)
            return stats.truncnorm(-_CUT, _CUT, mean, spread)
        if match := _RANGE.fullmatch(text):
            low, high = parse(match[1].strip(), unit), parse(match[2].strip(), unit)
            if not low < high:
                raise _wrong(name, text, "The first value is the smaller one")
            return stats.uniform(low, high - low)
        return _Data(np.array([parse(text, unit)]))
    except UnitProblemError as error:
        bare = re.fullmatch(r"([\d.]+)\s*(?:\+-|±)\s*([\d.]+)\s*([^\s\d%].*)", text)
        with_units = f'"{bare[1]} {bare[3]} +- {bare[2]} {bare[3]}", or ' if bare else ""
        raise _wrong(name, text, str(error), with_units) from None


def _spread(text: str, mean: float, unit: str) -> float:
    """Standard deviation in the unit, or in percent of the mean."""
    if text.endswith("%"):
        share, unit_text = split(text[:-1].strip())
        spread = abs(mean) * share / 100.0 if not unit_text else np.nan
    elif unit == "K":  # a temperature difference: the offset of degC cancels
        number, written = split(text)
        spread = parse(f"{number} {written}", "K") - parse(f"0 {written}", "K")
    else:
        spread = parse(text, unit)
    if not (np.isfinite(spread) and spread > 0.0):
        raise UnitProblemError(f"a standard deviation of {text} is not positive")
    return float(spread)


def _wrong(name: str, value: object, why: str = "", meant: str = "") -> InputError:
    what = f"{shortened(repr(value))} is not a distribution"
    remedy = (
        f'Write {meant}"0.05 +- 0.83 %", "uniform 0.4 um .. 0.6 um", "lognormal 0.05 +- 20 %", '
        "or give data or a SciPy distribution"
    )
    return InputError(what, name, why or "It is none of the supported kinds", remedy)


class _Data:
    """Empirical distribution of sorted values, with straight lines between them."""

    def __init__(self, values: Array) -> None:
        self.values = values

    def ppf(self, share: Any) -> Array:
        """Value below which a share of the distribution lies."""
        places = np.linspace(0.0, 1.0, self.values.size) if self.values.size > 1 else np.zeros(1)
        return np.asarray(np.interp(share, places, self.values))


Method = Literal["monte-carlo", "latin-hypercube", "sobol"]
#: Most numbers of one sample.
_MOST = 10**8


def sample(
    distributions: Mapping[str, object], size: int, *, method: Method = "monte-carlo", seed: int
) -> dict[str, Array]:
    """Draw values of independent quantities.

    Parameters
    ----------
    distributions : mapping of str to str, float, array or SciPy distribution
        What :func:`distribution` reads, by name of the quantity or key of a case.
    size : int
        Values of each quantity.
    method : {"monte-carlo", "latin-hypercube", "sobol"}
        Independent draws; one draw in each of ``size`` equally likely parts of every quantity,
        matched at random; a scrambled Sobol sequence, even over all quantities together, whose
        size should be a power of two.
    seed : int
        The same seed gives the same values.

    Returns
    -------
    dict of str to (size,) array
        Values in SI, by the same names.

    Raises
    ------
    InputError
        If a distribution cannot be read or an argument is out of its range.
    ComputationError
        If a distribution gives values that are not finite.

    Warns
    -----
    ModelWarning
        ``sobol-size`` if the size of a Sobol sequence is no power of two.

    Notes
    -----
    Uniform numbers of :mod:`scipy.stats.qmc` go through the quantile function of each
    distribution. M. D. McKay, R. J. Beckman and W. J. Conover, Technometrics 21 (1979) 239; A. B.
    Owen, Journal of Complexity 14 (1998) 466.

    Examples
    --------
    >>> made = sample({"mu": "0.05 +- 0.83 %"}, 1000, method="latin-hypercube", seed=1)
    >>> round(float(made["mu"].mean()), 6), round(float(made["mu"].std() / 0.05), 4)
    (0.05, 0.0082)
    """
    if not isinstance(distributions, Mapping) or not distributions:
        what = "no uncertain quantity is listed"
        remedy = 'Write {"friction.coefficient": "0.05 +- 0.83 %"}'
        raise InputError(what, Argument("distributions"), "Wanted: a mapping of names", remedy)
    spread = {str(name): distribution(str(name), text) for name, text in distributions.items()}
    count = require_whole("size", size)
    if count * len(spread) > _MOST:
        why = f"At most {_MOST:g} numbers are drawn at once"
        raise InputError(f"size = {count}", Argument("size"), why, "Draw several samples")
    shares = uniform(count, len(spread), method, require_whole("seed", seed, 0))
    values = {
        name: np.asarray(each.ppf(column), dtype=float)
        for (name, each), column in zip(spread.items(), shares.T, strict=True)
    }
    for name, column in values.items():
        if not np.all(np.isfinite(column)):
            what = "the distribution gives values that are not finite"
            raise ComputationError(what, name, "", "Check its parameters, or truncate it")
    return values


def uniform(size: int, width: int, method: str, seed: int) -> Array:
    """Numbers between zero and one (size, width)."""
    from scipy.stats import qmc

    require_one_of("method", method, ("monte-carlo", "latin-hypercube", "sobol"))
    random = np.random.default_rng(seed)
    if method == "monte-carlo":
        return random.random((size, width))
    if method == "latin-hypercube":
        return np.asarray(qmc.LatinHypercube(width, seed=random).random(size))
    power_of_two = 1 << max(size - 1, 0).bit_length()
    if power_of_two != size:
        warn(
            "sobol-size",
            f"A Sobol sequence of {size} values is not balanced; "
            f"use {power_of_two} or {power_of_two // 2}.",
            stacklevel=3,
        )
    return np.asarray(
        qmc.Sobol(width, seed=random).random_base2(power_of_two.bit_length() - 1)[:size]
    )


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
