"""Samples of several quantities, spread at random or evenly."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from tribodyn.checks import require_whole
from tribodyn.errors import Argument, ComputationError, InputError, require_one_of, warn
from tribodyn.types import Array
from tribodyn.uncertainty.distribution import distribution

Method = Literal["monte-carlo", "latin-hypercube", "sobol"]
#: Most numbers of one sample.
_MOST = 10**8


def sample(
    distributions: Mapping[str, Any],
    size: int,
    *,
    method: Method = "monte-carlo",
    seed: int,
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
        raise InputError(
            "no quantity is spread",
            Argument("distributions"),
            "Wanted: a mapping of names",
            'Write {"friction.coefficient": "0.05 +- 0.83 %"}',
        )
    made = {str(name): distribution(str(name), text) for name, text in distributions.items()}
    count = require_whole("size", size)
    if count * len(made) > _MOST:
        why = f"At most {_MOST:g} numbers are drawn at once"
        raise InputError(f"size = {count}", Argument("size"), why, "Draw several samples")
    shares = uniform(count, len(made), method, require_whole("seed", seed, 0))
    values = {
        name: np.asarray(each.ppf(column), dtype=float)
        for (name, each), column in zip(made.items(), shares.T, strict=True)
    }
    for name, drawn in values.items():
        if not np.all(np.isfinite(drawn)):
            what = "the distribution gives values that are not finite"
            raise ComputationError(what, name, "", "Look at its parameters, or cut it")
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
    whole = 1 << max(size - 1, 0).bit_length()
    if whole != size:
        warn(
            "sobol-size",
            f"A Sobol sequence of {size} values is not balanced; take {whole} or {whole // 2}.",
            stacklevel=3,
        )
    return np.asarray(qmc.Sobol(width, seed=random).random_base2(whole.bit_length() - 1)[:size])
