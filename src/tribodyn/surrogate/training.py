"""Training: networks for each target, and the search for their size."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError, require_between
from tribodyn.interrupt import single_blas_thread
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.surrogate.model import Surrogate
from tribodyn.surrogate.network import Fit, Network, Squares, levenberg_marquardt
from tribodyn.surrogate.preparation import Prepared, prepare
from tribodyn.types import Array, Tree

#: Rows per block of the Jacobian.
_ROWS = 1024
#: Sizes of a hidden layer that the source of BPNN-PL tries.
NEURONS = tuple(range(2, 12))


@dataclass(frozen=True)
class Training:
    """How networks are built and trained.

    Parameters
    ----------
    hidden : tuple of int
        Neurons of the hidden layers.
    activations : tuple of str
        ``"tansig"`` or ``"relu"`` for each of them.
    damping : float
        Damping of the first step of Levenberg and Marquardt; sources call it learning rate.
    epochs : int
        Most steps.
    patience : int
        Steps in a row without a lower validation error that end the training.
    starts : int
        Trainings from different weights; the one with the least validation error is selected.
    shares : tuple of float
        Parts of training, validation and test.
    outlier_limit : float, optional
        Training rows further from the mean are left out [standard deviations].
    moving_average : int
        Rows averaged within each group.
    level : float
        Probability of the band about a prediction [-].

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    hidden: tuple[int, ...] = (12, 12)
    activations: tuple[str, ...] = ("tansig", "tansig")
    damping: float = 0.01
    epochs: int = 300
    patience: int = 30
    starts: int = 1
    shares: tuple[float, ...] = (8.0, 1.0, 1.0)
    outlier_limit: float | None = None
    moving_average: int = 1
    level: float = 0.95

    def __post_init__(self) -> None:
        for name in ("epochs", "patience", "starts"):
            require_whole(name, getattr(self, name))
        require_between("level", self.level, 0.5, 0.9999)
        if require_number("damping", self.damping) < 0.0:
            what = f"damping = {self.damping:g}"
            raise InputError(what, Argument("damping"), "", "Give 0 or more")
        Network(1, self.hidden, self.activations)  # refuses layers that do not fit


#: As the source of BPNN-PL trains: two hidden layers, tansig then ReLU, one start.
BPNN_PL = Training(hidden=(11, 11), activations=("tansig", "relu"), epochs=1200, patience=6)


def train(
    data: object,
    *,
    features: Sequence[str],
    targets: Sequence[str],
    seed: int,
    groups: str = "",
    training: Training | None = None,
    progress: Progress = SILENT,
) -> Surrogate:
    """Train one network for each target.

    Parameters
    ----------
    data : mapping, xarray.Dataset, pandas.DataFrame or result with ``to_xarray``
        Columns of one number for each row; NaN is missing.
    features, targets : sequence of str
        Columns to predict from, and to predict.
    seed : int
        The same seed gives the same model.
    groups : str
        Column of labels; rows of one label, such as one trajectory, are not split.
    training : Training, optional
        Layers and steps; by default two layers of twelve neurons, tansig.
    progress : Progress
        Receives the progress over the networks; silent by default.

    Returns
    -------
    Surrogate
        With its errors over held-out rows.

    Raises
    ------
    InputError
        If columns are missing, or there are too few rows.

    Warns
    -----
    ModelWarning
        ``constant-feature`` if a feature does not vary.

    Notes
    -----
    Features and targets are scaled to 0 to 1 over the training rows. The least mean square is
    found by Levenberg and Marquardt from a start of Nguyen and Widrow; the weights with the least
    validation error are selected, and the errors are those of the test rows.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 200)
    >>> model = train({"x": x, "y": np.sin(6 * x)}, features=["x"], targets=["y"], seed=1,
    ...               training=Training(hidden=(5,), activations=("tansig",), epochs=100))
    >>> model.errors["y"].determination > 0.999
    True
    """
    chosen = Training() if training is None else training
    ready = prepare(data, features, targets, seed=seed, groups=groups, **_preparation(chosen))
    progress.start("Networks", len(targets))
    fits = []
    for column in range(len(targets)):
        fits.append(_fitted(ready, column, seed, chosen)[:2])
        progress.advance()
    progress.finish()
    return _model(data, ready, (list(features), list(targets)), fits, chosen, seed)


def bpnn_pl(
    data: object,
    *,
    features: Sequence[str],
    targets: Sequence[str],
    seed: int,
    groups: str = "",
    neurons: Iterable[int] = NEURONS,
    training: Training = BPNN_PL,
    progress: Progress = SILENT,
) -> tuple[Surrogate, dict[str, Array]]:
    """Train parallel networks of the size that suits each target.

    Parameters
    ----------
    data : mapping, xarray.Dataset, pandas.DataFrame or result with ``to_xarray``
        As of :func:`train`.
    features, targets : sequence of str
        Columns to predict from, and to predict, such as acceleration and mesh force.
    seed : int
        The same seed gives the same model.
    groups : str
        Column of labels; rows of one label are not split.
    neurons : iterable of int
        Neurons of each hidden layer that are tried.
    training : Training
        The rest; by default as the source has it.
    progress : Progress
        Receives the progress over the networks; silent by default.

    Returns
    -------
    model : Surrogate
        With the size of least error for each target.
    search : dict of str to (sizes, 3) array
        Neurons, mean square and mean absolute error over the validation rows, by target.

    Raises
    ------
    InputError
        As of :func:`train`.

    Notes
    -----
    The size with the least sum of the two errors, each over its least, is taken.
    """
    sizes = [require_whole("neurons", count) for count in neurons]
    if not sizes:
        raise InputError("no size to try", Argument("neurons"), "", "Give one or more")
    ready = prepare(data, features, targets, seed=seed, groups=groups, **_preparation(training))
    progress.start("Networks", len(sizes) * len(targets))
    fits, search = [], {}
    for column, name in enumerate(targets):
        tried, size_errors = [], []
        for count in sizes:
            layers = (count,) * len(training.hidden)
            network, fit, square, absolute = _fitted(
                ready, column, seed, replace(training, hidden=layers)
            )
            tried.append((network, fit))
            size_errors.append((count, square, absolute))
            progress.advance()
        search[str(name)] = np.array(size_errors)
        errors = search[str(name)][:, 1:]
        fits.append(tried[int(np.argmin((errors / errors.min(axis=0)).sum(axis=1)))])
    progress.finish()
    return _model(data, ready, (list(features), list(targets)), fits, training, seed), search


def _preparation(by: Training) -> Tree:
    """How the table is prepared."""
    names = ("shares", "outlier_limit", "moving_average")
    return {name: getattr(by, name) for name in names}


def _fitted(
    ready: Prepared, column: int, seed: int, training: Training
) -> tuple[Network, Fit, float, float]:
    """Best network of one target, with its validation errors in the unit of the target."""
    network = Network(ready.features.shape[1], tuple(training.hidden), tuple(training.activations))
    inputs = ready.feature_scaling.scaled(ready.features)
    target = ready.target_scaling.scaled(ready.targets)[:, column]
    fitted, held_out = ready.split.training, ready.split.validation
    residuals = _Residuals(network, inputs[fitted], target[fitted])
    validation = _Residuals(network, inputs[held_out], target[held_out])
    random = np.random.default_rng([seed, column])
    # Threads would wait for each other at every small product, and change the last digits.
    with single_blas_thread():
        fits = [
            levenberg_marquardt(
                residuals.squares,
                residuals.mean_square,
                network.start(random),
                validation=validation.mean_square,
                damping=training.damping,
                epochs=training.epochs,
                patience=training.patience,
            )
            for _ in range(training.starts)
        ]
    best = min(fits, key=lambda fit: validation.mean_square(fit.weights))
    span = float(ready.target_scaling.span[column])
    error = span * (network.evaluate(best.weights, inputs[held_out]) - target[held_out])
    return network, best, float(np.mean(error**2)), float(np.mean(np.abs(error)))


@dataclass(frozen=True)
class _Residuals:
    """Residuals of a network against scaled targets."""

    network: Network
    inputs: Array
    target: Array

    def mean_square(self, weights: Array) -> float:
        error = self.network.evaluate(weights, self.inputs) - self.target
        return float(error @ error) / self.target.size

    def squares(self, weights: Array) -> Squares:
        size, rows = weights.size, self.target.size
        total, gradient, normal = 0.0, np.zeros(size), np.zeros((size, size))
        for begin in range(0, rows, _ROWS):
            place = slice(begin, begin + _ROWS)
            value, slope = self.network.jacobian(weights, self.inputs[place])
            error = value - self.target[place]
            total += float(error @ error)
            gradient += slope.T @ error
            normal += slope.T @ slope
        return Squares(total / rows, gradient / rows, normal / rows)


def _model(
    data: object,
    ready: Prepared,
    names: tuple[list[str], list[str]],
    fits: list[tuple[Network, Fit]],
    training: Training,
    seed: int,
) -> Surrogate:
    """Combine the networks, and compute their errors over the test rows."""
    held_out, scaling = ready.split.test, ready.target_scaling
    inputs = ready.feature_scaling.scaled(ready.features[held_out])
    outputs = np.array([network.evaluate(fit.weights, inputs) for network, fit in fits])
    predicted = scaling.low[:, None] + outputs * scaling.span[:, None]
    true = ready.targets[held_out].T.copy()
    return Surrogate(
        features=np.array(names[0]),
        targets=np.array(names[1]),
        feature_unit=_units(data, names[0]),
        target_unit=_units(data, names[1]),
        feature_range=np.stack([ready.feature_scaling.low, ready.feature_scaling.high]),
        target_range=np.stack([scaling.low, scaling.high]),
        networks=tuple((network, fit.weights) for network, fit in fits),
        true=true,
        predicted=predicted,
        band=_half_width(np.abs(predicted - true), training.level),
        level=float(training.level),
        epochs=np.array([fit.epochs for _, fit in fits]),
        stopped=np.array([fit.stopped for _, fit in fits]),
        training_rows=int(ready.split.training.size),
        validation_rows=int(ready.split.validation.size),
        seed=int(seed),
    )


def _units(data: Any, names: list[str]) -> Any:
    """Units of columns, empty where the data have none."""
    units = getattr(data, "units", None)
    if isinstance(units, Mapping):
        return np.array([str(units.get(name, "")) for name in names])
    columns = (getattr(data[name], "attrs", {}) for name in names)
    return np.array([str(attributes.get("units", "")) for attributes in columns])


def _half_width(errors: Array, level: float) -> Array:
    """Conformal quantile of the errors at a level; infinite for too few errors."""
    rows = errors.shape[1]
    place = int(np.ceil((rows + 1) * level))
    widths = np.sort(errors, axis=1)
    return widths[:, place - 1] if place <= rows else np.full(len(errors), np.inf)
