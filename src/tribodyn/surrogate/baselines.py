"""Error measures of predictions, and simpler models for comparison."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError, require_one_of
from tribodyn.surrogate.preparation import Prepared, prepare
from tribodyn.types import Array


@dataclass(frozen=True)
class ErrorMeasures:
    """Errors of one target over held-out rows.

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
        square, variance, nonzero = float(np.mean(error**2)), float(np.var(true)), true != 0.0
        relative = (
            float(np.mean(error[nonzero] / np.abs(true[nonzero]))) if nonzero.any() else np.nan
        )
        share = 1.0 - square / variance if variance > 0.0 else np.nan
        return cls(true.size, square, float(error.mean()), share, relative, float(error.max()))


#: Fits scaled training rows to one target, and returns what predicts from scaled rows.
Fitter = Callable[[Array, Array, int], Callable[[Array], Array]]
#: Bins of the table over one feature.
_PLACES = 64
#: Most rows for a Gaussian process: its cost grows with their cube.
_MOST_ROWS = 1500
#: Initial length scale [range of a feature] and noise [variance of the target] of its fit.
_LENGTH, _NOISE = 0.3, 1e-4


def _mean(inputs: Array, target: Array, seed: int) -> Callable[[Array], Array]:
    return lambda rows: np.full(len(rows), target.mean())


def _linear(inputs: Array, target: Array, seed: int) -> Callable[[Array], Array]:
    factors = np.linalg.lstsq(np.c_[inputs, np.ones(len(inputs))], target, rcond=None)[0]
    return lambda rows: np.asarray(np.c_[rows, np.ones(len(rows))] @ factors)


def _table(inputs: Array, target: Array, seed: int) -> Callable[[Array], Array]:
    """Mean of the target in bins of the first feature; the overall mean in empty bins."""
    place = np.minimum((inputs[:, 0] * _PLACES).astype(int), _PLACES - 1)
    count = np.bincount(place, minlength=_PLACES)
    total = np.bincount(place, target, minlength=_PLACES)
    means = np.where(count > 0, total / np.maximum(count, 1), target.mean())
    return lambda rows: np.asarray(
        means[np.clip((rows[:, 0] * _PLACES).astype(int), 0, _PLACES - 1)]
    )


def _gaussian_process(inputs: Array, target: Array, seed: int) -> Callable[[Array], Array]:
    process = _learned("gaussian_process")
    kernels = process.kernels
    # Starting from a length of one, the fit mistakes a vibration for noise.
    smooth = kernels.RBF(np.full(inputs.shape[1], _LENGTH), (1e-2, 1e4))
    noise = kernels.WhiteKernel(_NOISE, (1e-12, 1.0))
    kernel = kernels.ConstantKernel(1.0, (1e-4, 1e6)) * smooth + noise
    chosen = np.random.default_rng(seed).permutation(len(inputs))[:_MOST_ROWS]
    model = process.GaussianProcessRegressor(kernel, normalize_y=True, random_state=seed)
    with (
        warnings.catch_warnings()
    ):  # it warns at the bounds of the search; the errors are reported anyway
        warnings.simplefilter("ignore")
        return model.fit(inputs[chosen], target[chosen]).predict  # type: ignore[no-any-return]


def _boosted_trees(inputs: Array, target: Array, seed: int) -> Callable[[Array], Array]:
    model = _learned("ensemble").HistGradientBoostingRegressor(random_state=seed, max_iter=300)
    return model.fit(inputs, target).predict  # type: ignore[no-any-return]


def _learned(part: str) -> Any:
    from importlib import import_module

    try:
        return import_module(f"sklearn.{part}")
    except ImportError:
        what, why = "scikit-learn is not installed", "Gaussian process and boosted trees are its"
        remedy = 'Install it: pip install "tribodyn[learn]", or leave these two out'
        raise InputError(what, Argument("kinds"), why, remedy) from None


#: Models to compare a network with, by name.
BASELINES: dict[str, Fitter] = {
    "mean": _mean,
    "linear": _linear,
    "table": _table,
    "gaussian-process": _gaussian_process,
    "boosted-trees": _boosted_trees,
}


def baselines(
    data: object,
    *,
    features: Sequence[str],
    targets: Sequence[str],
    seed: int,
    groups: str = "",
    kinds: Iterable[str] = ("mean", "linear", "table"),
    table_over: str = "phase",
) -> dict[str, dict[str, ErrorMeasures]]:
    """Errors of simpler models over the held-out rows of the same split.

    Parameters
    ----------
    data : mapping, xarray.Dataset, pandas.DataFrame or result with ``to_xarray``
        As of :func:`train`.
    features, targets : sequence of str
        Columns to predict from, and to predict.
    seed : int
        That of :func:`train`, for the same split.
    groups : str
        That of :func:`train`.
    kinds : iterable of str
        ``"mean"``; ``"linear"``; ``"table"``, the mean over each of 64 places of ``table_over``;
        ``"gaussian-process"`` and ``"boosted-trees"`` of scikit-learn.
    table_over : str
        Column of the table, such as the mesh phase; it need not be a feature.

    Returns
    -------
    dict of str to dict of str to ErrorMeasures
        By kind and target.

    Raises
    ------
    InputError
        If a kind is unknown, a column is missing, or scikit-learn is not installed.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 50)
    >>> found = baselines({"x": x, "y": 3 * x}, features=["x"], targets=["y"], seed=1,
    ...                   kinds=["mean", "linear"])
    >>> round(found["linear"]["y"].determination, 6)
    1.0
    """
    ready = prepare(data, features, targets, seed=seed, groups=groups)
    errors = {}
    for kind in kinds:
        require_one_of("kinds", kind, BASELINES)
        prepared = ready
        if kind == "table":
            prepared = prepare(data, [table_over], targets, seed=seed, groups=groups)
        errors[kind] = {
            str(name): _errors(prepared, BASELINES[kind], column, seed)
            for column, name in enumerate(targets)
        }
    return errors


def _errors(ready: Prepared, fitter: Fitter, column: int, seed: int) -> ErrorMeasures:
    inputs, target = ready.feature_scaling.scaled(ready.features), ready.targets[:, column]
    rows, held_out = ready.split.training, ready.split.test
    predict = fitter(inputs[rows], target[rows], seed)
    return ErrorMeasures.of(target[held_out], predict(inputs[held_out]))
