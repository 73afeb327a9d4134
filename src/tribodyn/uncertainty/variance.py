"""Which input the spread of an output comes from: Sobol indices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from tribodyn.checks import require_whole
from tribodyn.errors import Argument, ComputationError, InputError
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array
from tribodyn.uncertainty.sampling import distribution


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
    """

    name: Any = quantity("input", axis=True, unit="")
    first_order: Array = quantity("input", unit="1")
    total_order: Array = quantity("input", unit="1")
    evaluations: int = fact()


def sobol_indices(
    function: Callable[[dict[str, Array]], Any],
    distributions: Mapping[str, Any],
    size: int = 1024,
    *,
    seed: int,
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
        why = "A mapping of names to distributions tells how each input is spread"
        raise InputError("no input is spread", Argument("distributions"), why, "Give one or more")
    if not callable(function):
        raise InputError("it cannot be called", Argument("function"), "", "Give a function")
    count = require_whole("size", size, 2)
    if count & (count - 1):
        why = "A Sobol sequence is even in powers of two only"
        near = 1 << (count.bit_length() - 1)
        raise InputError(f"size = {count}", Argument("size"), why, f"Take {near}")
    made = {str(name): distribution(str(name), text) for name, text in distributions.items()}
    total = 0

    def answer(columns: Array) -> Array:
        nonlocal total
        total += columns.shape[1]
        found = np.asarray(function(dict(zip(made, columns, strict=True))))
        if found.shape != (columns.shape[1],) or found.dtype.kind not in "biuf":
            what = f"the function returns {found.dtype} values of the shape {found.shape}"
            why = f"It was given {columns.shape[1]} values of each input"
            raise InputError(what, Argument("function"), why, "Return one number for each")
        if not np.all(np.isfinite(found)):
            raise ComputationError(
                "the function returns values that are not finite",
                why="Shares of a variance need every sample",
                remedy="Look for the sample at which the function fails",
            )
        if np.ptp(found) == 0.0:
            why = "Shares of a variance need one above zero"
            raise ComputationError("the output does not vary", why=why, remedy="Widen the inputs")
        return found.astype(float)

    random = np.random.default_rng(require_whole("seed", seed, 0))
    found = indices(func=answer, n=count, dists=list(made.values()), random_state=random)
    first, whole = np.asarray(found.first_order), np.asarray(found.total_order)
    return SobolIndices(np.array(list(made)), first.reshape(-1), whole.reshape(-1), total)
