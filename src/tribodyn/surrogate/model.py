"""Trained model: one network for each target, with its training range and its errors."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError, real_numbers, warn
from tribodyn.interrupt import in_threads
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.surrogate.baselines import ErrorMeasures
from tribodyn.surrogate.network import Network
from tribodyn.surrogate.preparation import columns_of
from tribodyn.types import Array, Texts, Tree
from tribodyn.validated_files import read_dataset

#: Format name of a stored model.
_KIND = "tribodyn surrogate"
_STORED = ("feature_range", "target_range", "true", "predicted", "band", "epochs")
_WORDS = ("feature_unit", "target_unit", "stopped")
_COUNTS = ("training_rows", "validation_rows", "seed")
#: Tolerance beyond the range of a feature, as a share of it, without an extrapolation warning.
_MARGIN = 1e-9
#: Rows that are predicted at a time.
_ROWS = 65536


@record
class Surrogate(Record):
    """What :func:`train` returns: predictions of several targets, each with its own network.

    Parameters
    ----------
    features : (k,) array of str
        What is predicted from.
    targets : (t,) array of str
        What is predicted.
    feature_unit, target_unit : (k,), (t,) array of str
        Their units, if the data have them.
    feature_range : (2, k) array
        Least and greatest value of each feature over the training rows.
    target_range : (2, t) array
        The same of the targets.
    networks : tuple of (Network, array)
        Layers and weights by target.
    true, predicted : (t, n) array
        Targets over the held-out rows, and what the model makes of them.
    band : (t,) array
        Half width about the prediction that holds a new value with the probability ``level``.
    level : float
        That probability [-].
    epochs : (t,) array
        Steps of the selected training.
    stopped : (t,) array of str
        Why it ended: "validation", "epochs", "gradient" or "damping".
    training_rows, validation_rows : int
        Rows that the weights were fitted to, and that stopped the fit.
    seed : int
        Of split and start.
    """

    features: Texts = quantity("feature", unit="", axis=True, name="feature")
    targets: Texts = quantity("target", unit="", axis=True, name="target")
    feature_unit: Texts = quantity("feature", unit="")
    target_unit: Texts = quantity("target", unit="")
    feature_range: Array = quantity("end", "feature", unit="")
    target_range: Array = quantity("end", "target", unit="")
    networks: tuple[tuple[Network, Array], ...]
    true: Array = quantity("target", "row", unit="")
    predicted: Array = quantity("target", "row", unit="")
    band: Array = quantity("target", unit="")
    level: float = fact()
    epochs: Array = quantity("target", unit="1")
    stopped: Texts = quantity("target", unit="")
    training_rows: int = fact()
    validation_rows: int = fact()
    seed: int = fact()

    @cached_property
    def errors(self) -> dict[str, ErrorMeasures]:
        """Errors over the held-out rows, by target."""
        rows = zip(self.targets, self.true, self.predicted, strict=True)
        return {str(name): ErrorMeasures.of(true, predicted) for name, true, predicted in rows}

    def predict(self, inputs: object) -> dict[str, Array]:
        """Predict the targets.

        Parameters
        ----------
        inputs : mapping of str to float or array, table, or (..., k) array
            Features by name, or in their order along the last dimension.

        Returns
        -------
        dict of str to array
            By target, in the shape of the features.

        Raises
        ------
        InputError
            If a feature is missing or not finite.

        Warns
        -----
        ModelWarning
            ``surrogate-range`` where a feature is beyond those of the training.
        """
        rows, shape = self._read(inputs)
        low, high = self.feature_range
        reach = _MARGIN * (high - low)
        beyond = (rows < low - reach) | (rows > high + reach)
        if np.any(beyond):
            self._warn_of_range(rows, beyond)
        span = np.where(high > low, high - low, 1.0)
        parts = np.empty((len(self.targets), len(rows)))

        def block(begin: int) -> None:
            place = slice(begin, begin + _ROWS)
            scaled = (rows[place] - low) / span
            for number, (network, weights) in enumerate(self.networks):
                parts[number, place] = network.evaluate(weights, scaled)

        begins = range(0, len(rows), _ROWS)
        in_threads(block, begins, os.cpu_count() or 1, brief=len(begins) < 2)
        first, last = self.target_range[:, :, None]
        values = first + parts * np.where(last > first, last - first, 1.0)
        return {
            str(name): each.reshape(shape) for name, each in zip(self.targets, values, strict=True)
        }

    def predict_band(self, inputs: object) -> dict[str, tuple[Array, Array]]:
        """Band in which the targets lie with the probability ``level``.

        Parameters
        ----------
        inputs : mapping, table or array
            As of :meth:`predict`.

        Returns
        -------
        dict of str to tuple of (array, array)
            Lower and upper end by target.

        Notes
        -----
        Split conformal: the half width is the quantile of the absolute errors over the held-out
        rows, corrected for their number, so that a new row drawn like these lies inside with at
        least that probability, whatever the model. V. Vovk, A. Gammerman and G. Shafer,
        Algorithmic Learning in a Random World, 2005, chapter 4. Rows of one trajectory are no
        draws of their own; then the band holds on the average over such trajectories.
        """
        values = self.predict(inputs)
        return {
            name: (values[name] - half, values[name] + half)
            for name, half in zip(values, self.band, strict=True)
        }

    def _read(self, inputs: object) -> tuple[Array, tuple[int, ...]]:
        """Rows of features, and the shape of what is predicted."""
        names = [str(name) for name in self.features]
        if isinstance(inputs, Mapping) and not hasattr(inputs, "to_dataframe"):
            if lacking := [name for name in names if name not in inputs]:
                columns_of({str(key): np.zeros(1) for key in inputs}, lacking, "inputs")
            columns = [real_numbers(Argument(name), inputs[name]) for name in names]
            try:
                rows = np.stack(np.broadcast_arrays(*columns), axis=-1)
            except ValueError:
                what = f"features of the shapes {[each.shape for each in columns]}"
                remedy = "Give each one value, or arrays of one shape"
                raise InputError(what, Argument("inputs"), "", remedy) from None
        elif hasattr(inputs, "keys"):
            rows = columns_of(inputs, names, "inputs")
        else:
            rows = real_numbers(Argument("inputs"), inputs)
        if not rows.ndim or rows.shape[-1] != len(names) or not np.all(np.isfinite(rows)):
            what = f"inputs of the shape {rows.shape}, or values that are not finite"
            why = f"Wanted: {len(names)} features, {', '.join(names)}"
            raise InputError(what, Argument("inputs"), why, "Give finite values of each")
        return rows.reshape(-1, len(names)), rows.shape[:-1]

    def _warn_of_range(self, rows: Array, beyond: Any) -> None:
        column = int(np.argmax(beyond.sum(axis=0)))
        values = rows[beyond[:, column], column]
        low, high = self.feature_range[:, column]
        worst = values[np.argmax(np.maximum(low - values, values - high))]
        warn(
            "surrogate-range",
            f"{np.any(beyond, axis=1).sum()} of {len(rows)} rows are outside the training range: "
            f"{self.features[column]} = {worst:.5g}, trained from {low:.5g} to {high:.5g}. "
            "Errors and bands do not hold there; train over a wider range.",
            stacklevel=4,
        )

    def _parts(self) -> Parts:
        parts = super()._parts()
        for number, (network, weights) in enumerate(self.networks):
            parts.variables[f"weights_{number}"] = (
                f"weight_{number}",
                weights,
                {"hidden": list(network.hidden), "activations": " ".join(network.activations)},
            )
        parts.attributes["kind"] = _KIND
        return parts

    def __repr__(self) -> str:
        """One line."""
        errors = ", ".join(f"{n} R^2 {e.determination:.5f}" for n, e in self.errors.items())
        count = self.true.shape[1]
        return f"Surrogate(from {', '.join(self.features)}; {errors}, over {count} held-out rows)"


def load(path: str | os.PathLike[str]) -> Surrogate:
    """Read a model that ``save`` wrote.

    Parameters
    ----------
    path : str or path
        The netCDF file.

    Raises
    ------
    InputError
        If the file cannot be read, was changed, or holds no model.
    """
    data = read_dataset(path)
    if data.attrs.get("kind") != _KIND:
        why = "It was not written by Surrogate.save"
        raise InputError(f"{path} does not contain a surrogate", Argument("path"), why, "Train one")
    try:
        fields: Tree = {name: np.asarray(data[name].values) for name in _STORED}
        fields |= {name: int(data.attrs[name]) for name in _COUNTS}
        fields |= {f"{name}s": data[name].values.astype(str) for name in ("feature", "target")}
        fields |= {name: data[name].values.astype(str) for name in _WORDS}
        fields["level"] = float(data.attrs["level"])
        fields["networks"] = tuple(
            _network(data[f"weights_{number}"], data.sizes["feature"])
            for number in range(data.sizes["target"])
        )
    except (KeyError, ValueError) as error:
        what, why = f"{path} contains an incomplete surrogate", f"It lacks {error}"
        raise InputError(what, Argument("path"), why, "Train it again") from None
    return Surrogate(**fields)


def _network(stored: Any, inputs: int) -> tuple[Network, Array]:
    hidden = tuple(int(count) for count in np.atleast_1d(stored.attrs["hidden"]))
    network = Network(inputs, hidden, tuple(str(stored.attrs["activations"]).split()))
    weights = np.asarray(stored.values, dtype=float)
    if weights.shape != (network.size,):
        raise ValueError("the weights of its layers")
    return network, weights
