"""Prepare columns for training: gaps, outliers, smoothing, scaling, split by groups.

Scalings and limits are fitted to the training rows only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.errors import (
    Argument,
    InputError,
    no_such,
    real_numbers,
    require_positive,
    shortened,
    warn,
)
from tribodyn.nomenclature import require_whole
from tribodyn.record import Record
from tribodyn.types import Array, Index, Mask


@dataclass(frozen=True)
class Split:
    """Rows of the parts of a table."""

    training: Index
    validation: Index
    test: Index


@dataclass(frozen=True)
class Scaling:
    """Range, mean and standard deviation of each column over the training rows."""

    low: Array
    high: Array
    mean: Array
    deviation: Array

    @classmethod
    def of(cls, columns: Array) -> Scaling:
        """Fit to rows (n, columns); missing values are left out."""
        return cls(
            np.nanmin(columns, axis=0),
            np.nanmax(columns, axis=0),
            np.nanmean(columns, axis=0),
            np.nanstd(columns, axis=0),
        )

    def filled(self, columns: Array) -> Array:
        """Put the mean of the training rows where values are missing."""
        return np.where(np.isnan(columns), self.mean, columns)

    def outliers(self, columns: Array, limit: float) -> Mask:
        """Rows with a value further than so many standard deviations from the mean."""
        is_outlier = np.abs(columns - self.mean) > limit * self.deviation
        return np.asarray(np.any(is_outlier & (self.deviation > 0.0), axis=1))

    @property
    def span(self) -> Array:
        """Width of the range; 1 for a column that does not vary."""
        return np.asarray(np.where(self.high > self.low, self.high - self.low, 1.0))

    def scaled(self, columns: Array) -> Array:
        """Columns over the range 0 to 1 of the training rows."""
        return np.asarray((columns - self.low) / self.span)


@dataclass(frozen=True)
class Prepared:
    """Features and targets (n, columns) with their split; missing values are filled."""

    features: Array
    targets: Array
    split: Split
    feature_scaling: Scaling
    target_scaling: Scaling
    outliers: int  #: training rows that were dropped as outliers


def columns_of(data: Any, names: Sequence[str], argument: str) -> Array:
    """Columns of a table by name (rows, columns); missing values are NaN."""
    listed = list(names) if isinstance(names, list | tuple | np.ndarray) else []
    if not listed or len(set(map(str, listed))) != len(listed):
        what = f"{argument} = {shortened(repr(names))}"
        why = "Wanted: a list of names, each once"
        raise InputError(what, Argument(argument), why, "Name columns of the data")
    table = data.to_xarray() if isinstance(data, Record) else data
    if not all(hasattr(table, name) for name in ("keys", "__getitem__")):
        why = "Wanted: arrays by name, a data set of xarray or a table of pandas"
        raise InputError(f"a {type(table).__name__}", Argument("data"), why, "Give one")
    shapes = {str(key): np.shape(table[key]) for key in table}
    rows = max((shape[0] for shape in shapes.values() if len(shape) == 1), default=0)
    for name in map(str, listed):
        if name not in shapes:
            raise InputError(no_such("column", name, shapes, Argument(argument)))
    return np.stack([_column(table[name], str(name), rows) for name in listed], axis=1)


def _column(column: Any, name: str, rows: int) -> Array:
    try:
        values = np.asarray(column, dtype=float)
    except (TypeError, ValueError):
        values = np.zeros(0)
    if values.shape != (rows,) or np.any(np.isinf(values)):
        what = f'the column "{name}" has the shape {np.shape(column)}, or holds no finite numbers'
        why = f"Every column has one number for each of the {rows} rows"
        raise InputError(what, Argument("data"), why, "Use NaN for missing values")
    return values


def split_rows(
    rows: int, shares: Sequence[float] = (8.0, 1.0, 1.0), *, seed: int, groups: object = None
) -> Split:
    """Split rows at random into training, validation (early stopping) and test rows.

    Parameters
    ----------
    rows : int
        Rows of the table.
    shares : (3,) sequence of float
        Parts of training, validation and test, in any unit.
    seed : int
        The same seed gives the same split.
    groups : (rows,) array, optional
        Rows of one group, such as one trajectory, stay together.

    Returns
    -------
    Split
        With rows in rising order.

    Raises
    ------
    InputError
        If there are too few rows or groups for three parts, or shares are not positive.

    Examples
    --------
    >>> parts = split_rows(10, seed=1, groups=np.repeat(np.arange(5), 2))
    >>> parts.training.size, parts.validation.size, parts.test.size
    (6, 2, 2)
    """
    count = require_whole("rows", rows)
    parts = real_numbers(Argument("shares"), shares)
    if parts.shape != (3,) or not np.all(np.isfinite(parts) & (parts > 0.0)):
        why = "Wanted: three positive numbers"
        raise InputError(f"shares = {shares}", Argument("shares"), why, "Give (8, 1, 1)")
    labels = np.arange(count) if groups is None else np.asarray(groups)
    if labels.shape != (count,):
        what, why = f"groups have the shape {labels.shape}", f"There are {count} rows"
        raise InputError(what, Argument("groups"), why, "Give one label for each row")
    names, of_row = np.unique(labels, return_inverse=True)
    if names.size < 3:
        what = f"{names.size} group{'s' if names.size != 1 else ''} of rows"
        why = "Training, validation and test need one each"
        raise InputError(what, Argument("groups"), why, "Give more data")
    random = np.random.default_rng(require_whole("seed", seed, 0))
    counts = np.maximum(np.round(parts[1:] / parts.sum() * names.size), 1).astype(int)
    order = random.permutation(names.size)
    ends = np.cumsum(counts)
    place = np.zeros(names.size, dtype=int)
    place[order[: ends[0]]], place[order[ends[0] : ends[1]]] = 1, 2
    return Split(*(np.flatnonzero(place[of_row] == number) for number in range(3)))


def smoothed(columns: Array, window: int, groups: object = None) -> Array:
    """Moving average of each column, centred, shorter at the ends of a group."""
    if window == 1:
        return columns
    labels = np.zeros(len(columns)) if groups is None else np.asarray(groups)
    result = np.empty_like(columns)
    for label in np.unique(labels):
        rows = np.flatnonzero(labels == label)
        total = np.vstack([np.zeros(columns.shape[1]), np.cumsum(columns[rows], axis=0)])
        begin = np.maximum(np.arange(rows.size) - (window - 1) // 2, 0)
        end = np.minimum(np.arange(rows.size) + window // 2 + 1, rows.size)
        result[rows] = (total[end] - total[begin]) / (end - begin)[:, None]
    return result


def prepare(
    data: object,
    features: Sequence[str],
    targets: Sequence[str],
    *,
    seed: int,
    groups: str = "",
    shares: Sequence[float] = (8.0, 1.0, 1.0),
    outlier_limit: float | None = None,
    moving_average: int = 1,
) -> Prepared:
    """Prepare a table for training.

    Parameters
    ----------
    data : mapping, xarray.Dataset, pandas.DataFrame or result with ``to_xarray``
        Columns of one number for each row; NaN is missing.
    features, targets : sequence of str
        Columns to predict from, and to predict.
    seed : int
        The same seed gives the same split.
    groups : str
        Column of labels; rows of one label are not split. Empty: rows are split individually.
    shares : (3,) sequence of float
        Parts of training, validation and test.
    outlier_limit : float, optional
        Training rows with a value further from the mean are left out [standard deviations].
    moving_average : int
        Rows that are averaged within each group. Without groups, rows of training and test that
        follow each other are mixed.

    Returns
    -------
    Prepared
        Features with gaps filled by the mean of the training rows; rows whose target is missing
        are left out.

    Raises
    ------
    InputError
        If columns are missing or not numbers, or too few rows remain.

    Warns
    -----
    ModelWarning
        ``constant-feature`` if a feature does not vary over the training rows.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 20)
    >>> prepare({"x": x, "y": 2 * x}, ["x"], ["y"], seed=1).split.test.size
    2
    """
    inputs, outputs = columns_of(data, features, "features"), columns_of(data, targets, "targets")
    if overlap := set(features) & set(targets):
        what = f"{', '.join(sorted(overlap))} is both feature and target"
        raise InputError(what, Argument("targets"), "", "Leave it out of one of them")
    labels = columns_of(data, [groups], "groups")[:, 0] if groups else None
    if labels is not None and np.any(np.isnan(labels)):
        raise InputError("a row has no group", Argument("groups"), "", "Fill the column")
    window = require_whole("moving_average", moving_average)
    complete = ~np.any(np.isnan(outputs), axis=1)
    inputs, outputs = inputs[complete], outputs[complete]
    labels = None if labels is None else labels[complete]
    if len(inputs) < 3 or np.any(np.all(np.isnan(inputs), axis=0)):
        what = f"{len(inputs)} rows with targets, or a feature without any value"
        raise InputError(what, Argument("data"), "", "Give more data")
    split = split_rows(len(inputs), shares, seed=seed, groups=labels)
    inputs = Scaling.of(inputs[split.training]).filled(inputs)
    retained = _without_outliers(np.hstack([inputs, outputs]), split, outlier_limit)
    split = Split(*(_renumbered(rows, retained) for rows in vars(split).values()))
    labels = None if labels is None else labels[retained]
    inputs, outputs = (smoothed(each[retained], window, labels) for each in (inputs, outputs))
    scaling = Scaling.of(inputs[split.training])
    still = [str(n) for n, same in zip(features, scaling.low == scaling.high, strict=True) if same]
    if still:
        warn(
            "constant-feature",
            f"{', '.join(still)} does not vary over the training rows, and "
            "says nothing about the targets.",
            stacklevel=3,
        )
    return Prepared(
        inputs, outputs, split, scaling, Scaling.of(outputs[split.training]), int(np.sum(~retained))
    )


def _without_outliers(columns: Array, split: Split, limit: float | None) -> Mask:
    """Mask of the rows without outliers among the training rows."""
    retained = np.ones(len(columns), dtype=bool)
    if limit is not None:
        require_positive("outlier_limit", limit)
        training = columns[split.training]
        retained[split.training] = ~Scaling.of(training).outliers(training, float(limit))
        if np.sum(retained[split.training]) < 2:
            what = "fewer than two rows are left for training"
            raise InputError(what, Argument("outlier_limit"), "", "Widen the limit")
    return retained


def _renumbered(rows: Index, retained: Mask) -> Index:
    """Retained rows, renumbered after the removal of the others."""
    return np.asarray((np.cumsum(retained) - 1)[rows[retained[rows]]])
