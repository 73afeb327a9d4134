"""Which input the spread of an output comes from: Sobol indices."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from tribodyn.errors import Argument, ComputationError, InputError
from tribodyn.nomenclature import require_whole
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array, Texts
from tribodyn.uncertainty.sampling import distribution

#: Bootstrap resamples of the intervals.
_RESAMPLES = 400


@record
class SobolIndices(Record):
    """Shares of the variance of an output by input.

    Parameters
    ----------
    name : (k,) array of str
        Inputs.
    first_order : (k,) array
        Share that the input causes alone [-].
    total_order : (k,) array
        Share that would be gone if the input were known, its interactions included [-].
    evaluations : int
        Evaluations of the function.
    first_order_band, total_order_band : (2, k) array, optional
        Lower and upper end of the bootstrap intervals of both [-].
    level : float
        Probability that such an interval holds the share of an endless sample; 0 without them [-].
    """

    name: Texts = quantity("input", axis=True, unit="")
    first_order: Array = quantity("input", unit="1")
    total_order: Array = quantity("input", unit="1")
    evaluations: int = fact()
    first_order_band: Array | None = quantity("end", "input", unit="1", default=None)
    total_order_band: Array | None = quantity("end", "input", unit="1", default=None)
    level: float = fact(default=0.0)

    def __repr__(self) -> str:
        """One line."""
        shares = zip(self.name, self.first_order, self.total_order, strict=True)
        text = ", ".join(f"{name} {first:.2g} ({total:.2g})" for name, first, total in shares)
        return f"SobolIndices(alone, with interactions in brackets: {text})"


def sobol_indices(
    function: Callable[[dict[str, Array]], object],
    distributions: Mapping[str, object],
    size: int = 1024,
    *,
    seed: int,
    level: float = 0.0,
) -> SobolIndices:
    """Share the variance of an output among independent inputs.

    Parameters
    ----------
    function : callable
        Takes the values of all inputs by name, arrays (n,) in SI, and returns the output (n,).
    distributions : mapping
        As of :func:`sample`.
    size : int
        Size of the Sobol sequence, a power of two; the function sees ``size`` times the number of
        inputs and two more values.
    seed : int
        The same seed gives the same indices.
    level : float
        Probability of bootstrap intervals, such as 0.95; 0 leaves them out.

    Raises
    ------
    InputError
        If the size is no power of two, a distribution cannot be read, or the function returns
        anything but as many numbers as it was given.
    ComputationError
        If the output does not vary or is not finite.

    Notes
    -----
    :func:`scipy.stats.sobol_indices` with the estimators of A. Saltelli et al., Computer Physics
    Communications 181 (2010) 259, table 2.

    Examples
    --------
    >>> made = sobol_indices(lambda x: x["a"] + 2 * x["b"], {"a": "0..1", "b": "0..1"}, seed=1)
    >>> made.first_order.round(2).tolist()
    [0.2, 0.8]
    """
    from scipy.stats import sobol_indices as indices

    if not isinstance(distributions, Mapping) or not distributions:
        why = "A mapping of names to distributions defines how each input is spread"
        raise InputError("no input is spread", Argument("distributions"), why, "Give one or more")
    if not callable(function):
        why = "It computes the figure of every sample"
        raise InputError("it cannot be called", Argument("function"), why, "Give a function")
    count = require_whole("size", size, 2)
    if count & (count - 1):
        why = "A Sobol sequence is balanced for powers of two only"
        power_of_two = 1 << (count.bit_length() - 1)
        raise InputError(f"size = {count}", Argument("size"), why, f"Take {power_of_two}")
    if not 0.0 <= level < 1.0:
        why, remedy = "A probability below 1, or 0 for no intervals", "Take 0.95"
        raise InputError(f"level = {level}", Argument("level"), why, remedy)
    spread = {str(name): distribution(str(name), text) for name, text in distributions.items()}
    outputs: list[Array] = []

    def answer(columns: Array) -> Array:
        outputs.append(
            _checked(function(dict(zip(spread, columns, strict=True))), columns.shape[1])
        )
        return outputs[-1]

    random = np.random.default_rng(require_whole("seed", seed, 0))
    bands: Sequence[Array | None] | Array = (None, None)
    if len(spread) == 1:  # all of the variance comes from it
        answer(np.asarray(next(iter(spread.values())).ppf(random.random((1, count)))))
        first = totals = np.ones(1)
        bands = [np.ones((2, 1))] * 2 if level else (None, None)
    else:
        shares = indices(func=answer, n=count, dists=list(spread.values()), random_state=random)
        first, totals = np.asarray(shares.first_order), np.asarray(shares.total_order)
        bands = _bootstrapped(outputs, len(spread), level, random) if level else (None, None)
    return SobolIndices(
        name=np.array(list(spread)),
        first_order=first.reshape(-1),
        total_order=totals.reshape(-1),
        evaluations=sum(values.size for values in outputs),
        first_order_band=bands[0],
        total_order_band=bands[1],
        level=float(level),
    )


def _checked(values: object, count: int) -> Array:
    """Output of the function, one finite number for each sample, not all of them equal."""
    output = np.asarray(values)
    if output.shape != (count,) or output.dtype.kind not in "biuf":
        what = f"the function returns {output.dtype} values of the shape {output.shape}"
        why = f"It was called with {count} values of each input"
        raise InputError(what, Argument("function"), why, "Return one number for each")
    if not np.all(np.isfinite(output)):
        raise ComputationError(
            "the function returns values that are not finite",
            why="Shares of a variance need every sample",
            remedy="Find the sample at which the function fails",
        )
    if np.ptp(output) == 0.0:
        why = "Indices are shares of the variance, which is zero"
        raise ComputationError("the output does not vary", why=why, remedy="Widen the inputs")
    return output.astype(float)


def _bootstrapped(outputs: list[Array], inputs: int, level: float, random: Any) -> Array:
    """Percentiles of first and total order over resampled rows of the sequence (2, 2, inputs)."""
    from scipy.stats import sobol_indices as indices

    first, second = outputs[0], outputs[1]
    size = first.size
    mixed = outputs[2].reshape(size, inputs)
    resampled = np.empty((_RESAMPLES, 2, inputs))
    for number in range(_RESAMPLES):
        rows = random.integers(size, size=size)
        if np.ptp(np.concatenate((first[rows], second[rows]))) == 0.0:
            rows = np.arange(size)  # a sample that does not vary has no shares
        parts = {
            "f_A": first[None, rows],
            "f_B": second[None, rows],
            "f_AB": mixed[rows].T[:, None, :],
        }
        answer = indices(func=parts, n=size)
        resampled[number] = np.reshape(answer.first_order, -1), np.reshape(answer.total_order, -1)
    ends = np.quantile(resampled, (0.5 - 0.5 * level, 0.5 + 0.5 * level), axis=0)
    return np.asarray(np.moveaxis(ends, 1, 0))
