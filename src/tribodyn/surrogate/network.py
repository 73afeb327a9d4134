"""Feed-forward network of one output: layers, start of the weights, Jacobian."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tribodyn.errors import Argument, InputError, require_one_of
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array

#: Rows per block, so that a block stays in the processor cache.
_ROWS = 4096
#: Most weights: the memory of the normal equations grows with their square.
_MOST_WEIGHTS = 5000


def _relu(x: Any) -> Any:
    """Positive part; for complex steps decided by the real part."""
    return np.where(np.real(x) > 0.0, x, 0.0)


#: Activation function, and its slope as a function of its value. ``2/(1 + exp(-2 x)) - 1`` is the
#: hyperbolic tangent; the slope of ReLU at its kink is taken as zero.
ACTIVATIONS: dict[str, tuple[Callable[[Any], Any], Callable[[Any], Any]]] = {
    "tansig": (np.tanh, lambda y: 1.0 - y * y),
    "relu": (_relu, lambda y: (y > 0.0).astype(float)),
}


@dataclass(frozen=True)
class Network:
    """Layers of a network whose output is linear; its weights are one vector.

    Parameters
    ----------
    inputs : int
        Number of inputs, each scaled to the range 0 to 1.
    hidden : tuple of int
        Neurons of the hidden layers.
    activations : tuple of str
        ``"tansig"`` or ``"relu"`` for each of them.

    Raises
    ------
    InputError
        If the layers and their activations do not fit together, or the network is too large.

    Examples
    --------
    >>> Network(4, (11, 11), ("tansig", "relu")).size
    199
    """

    inputs: int
    hidden: tuple[int, ...]
    activations: tuple[str, ...]

    def __post_init__(self) -> None:
        if not all(isinstance(each, tuple | list) for each in (self.hidden, self.activations)):
            what = f"hidden = {self.hidden!r}, activations = {self.activations!r}"
            why = "Each layer has a size and an activation"
            raise InputError(what, Argument("hidden"), why, "Give both as tuples")
        for count in (self.inputs, *self.hidden):
            require_whole("hidden", count)
        for name in self.activations:
            require_one_of("activations", name, ACTIVATIONS)
        if not self.hidden or len(self.hidden) != len(self.activations):
            what = f"{len(self.hidden)} hidden layers and {len(self.activations)} activations"
            raise InputError(what, Argument("hidden"), "Each layer has one", "Give both")
        if self.size > _MOST_WEIGHTS:
            what, why = f"a network of {self.size} weights", f"At most {_MOST_WEIGHTS} are trained"
            raise InputError(what, Argument("hidden"), why, "Take fewer neurons")

    @property
    def shapes(self) -> list[tuple[int, int]]:
        """Neurons and inputs of every layer, the output last."""
        return [(after, before) for before, after in pairwise((self.inputs, *self.hidden, 1))]

    @property
    def size(self) -> int:
        """Number of weights and biases."""
        return sum(after * (before + 1) for after, before in self.shapes)

    def layers(self, weights: Any) -> Iterator[tuple[Any, Any]]:
        """Cut the vector of weights into a matrix and a bias for each layer.

        Parameters
        ----------
        weights : (size,) array

        Yields
        ------
        tuple of ((neurons, inputs) array, (neurons,) array)
        """
        begin = 0
        for after, before in self.shapes:
            end = begin + after * before
            yield weights[begin:end].reshape(after, before), weights[end : end + after]
            begin = end + after

    def start(self, random: np.random.Generator) -> Array:
        """Initial weights, after Nguyen and Widrow.

        Parameters
        ----------
        random : numpy.random.Generator

        Returns
        -------
        (size,) array

        Notes
        -----
        The active stretches of the neurons of a layer cover the range of its inputs evenly: rows of
        the length ``0.7 neurons^(1/inputs)`` in random directions. The output begins near zero.
        Source: Nguyen and Widrow (1990).
        """
        parts = []
        for layer, (after, before) in enumerate(self.shapes):
            if layer == len(self.hidden):
                parts += [0.1 * random.uniform(-1.0, 1.0, after * before), np.full(1, 0.5)]
                continue
            rows = random.uniform(-1.0, 1.0, (after, before))
            reach = 0.7 * after ** (1.0 / before)
            rows *= reach / np.linalg.norm(rows, axis=1, keepdims=True)
            bias = reach * np.linspace(-1.0, 1.0, after) if after > 1 else np.zeros(1)
            bias *= np.sign(random.uniform(-1.0, 1.0, after))
            if layer == 0:  # from the range -1 to 1 to the range 0 to 1
                rows, bias = 2.0 * rows, bias - rows.sum(axis=1)
            parts += [rows.reshape(-1), bias]
        return np.concatenate(parts)

    def evaluate(self, weights: object, inputs: Any) -> Any:
        """Output of the network.

        Parameters
        ----------
        weights : (size,) array
        inputs : (n, inputs) array
            Scaled inputs.

        Returns
        -------
        (n,) array
        """
        layers = list(self.layers(weights))
        parts = []
        for begin in range(0, max(len(inputs), 1), _ROWS):
            signal = inputs[begin : begin + _ROWS]
            for (matrix, bias), name in zip(layers[:-1], self.activations, strict=True):
                signal = ACTIVATIONS[name][0](signal @ matrix.T + bias)
            matrix, bias = layers[-1]
            parts.append((signal @ matrix.T + bias)[:, 0])
        return np.concatenate(parts)

    def jacobian(self, weights: Array, inputs: Array) -> tuple[Array, Array]:
        """Output of the network and its derivatives by the weights, by backpropagation.

        Parameters
        ----------
        weights : (size,) array
        inputs : (n, inputs) array
            Scaled inputs.

        Returns
        -------
        tuple of ((n,) array, (n, size) array)
        """
        layers = list(self.layers(weights))
        signals, slopes = [inputs], []
        for (matrix, bias), name in zip(layers[:-1], self.activations, strict=True):
            value, slope = ACTIVATIONS[name]
            signals.append(value(signals[-1] @ matrix.T + bias))
            slopes.append(slope(signals[-1]))
        matrix, bias = layers[-1]
        output = (signals[-1] @ matrix.T + bias)[:, 0]
        parts: list[Array] = []
        back = np.ones((len(inputs), 1))
        for layer in range(len(layers) - 1, -1, -1):
            rows = (back[:, :, None] * signals[layer][:, None, :]).reshape(len(inputs), -1)
            parts[:0] = [rows, back]
            if layer:
                back = (back @ layers[layer][0]) * slopes[layer - 1]
        return output, np.concatenate(parts, axis=1)


#: Factor of the damping after a step, and the damping beyond which no step helps.
_CHANGE, _MOST, _LEAST = 10.0, 1e10, 1e-20
#: Gradient of half the mean square at which a minimum is reached.
_GRADIENT = 1e-9


class Squares(NamedTuple):
    """Mean square of the residuals, with gradient and normal matrix of half of it."""

    mean_square: float
    gradient: Array
    normal: Array


class Fit(NamedTuple):
    """Result of the fit."""

    weights: Array
    epochs: int
    stopped: str  #: "validation", "epochs", "gradient" or "damping"


def levenberg_marquardt(
    squares: Callable[[Array], Squares],
    mean_square: Callable[[Array], float],
    start: Array,
    *,
    validation: Callable[[Array], float] | None = None,
    damping: float = 0.01,
    epochs: int = 1200,
    patience: int = 6,
) -> Fit:
    """Minimise a mean square by the method of Levenberg and Marquardt.

    Parameters
    ----------
    squares : callable
        Mean square, gradient and normal matrix at some weights.
    mean_square : callable
        Mean square alone.
    start : (p,) array
        Weights to begin with.
    validation : callable, optional
        Mean square of other data; the weights that make it least are returned.
    damping : float
        Damping of the first step, of the normal matrix of the mean square; divided by ten after a
        step that helps, multiplied by ten after one that does not.
    epochs : int
        Most steps that help.
    patience : int
        Steps in a row after which a validation that does not fall ends the search.

    Notes
    -----
    M. T. Hagan and M. B. Menhaj, IEEE Trans. Neural Networks 5 (1994) 989. Without damping the
    least square of a linear problem is found in one step.

    Examples
    --------
    >>> a, b = np.array([[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]]), np.array([1.0, 3.0, 5.0])
    >>> def mean_square(w): return float(np.mean((a @ w - b) ** 2))
    >>> def squares(w): return Squares(mean_square(w), a.T @ (a @ w - b) / 3, a.T @ a / 3)
    >>> levenberg_marquardt(squares, mean_square, np.zeros(2), damping=0.0, epochs=1).weights
    array([1., 2.])
    """
    weights, current = start, squares(start)
    best, least = start, np.inf if validation is None else validation(start)
    failures, stopped, epoch = 0, "epochs", 0
    while epoch < epochs:
        if np.abs(current.gradient).max() < _GRADIENT:
            stopped = "gradient"
            break
        step, damping = _step(current, mean_square, weights, damping)
        if step is None:
            stopped = "damping"
            break
        weights, epoch = weights + step, epoch + 1
        current = squares(weights)
        if validation is None:
            continue
        validation_error = validation(weights)
        failures = 0 if validation_error < least else failures + 1
        if validation_error < least:
            best, least = weights, validation_error
        elif failures >= patience:
            stopped = "validation"
            break
    return Fit(weights if validation is None else best, epoch, stopped)


def _step(
    current: Squares, mean_square: Callable[[Array], float], weights: Array, damping: float
) -> tuple[Array | None, float]:
    """Weights after a step that lowers the mean square, and the damping of the next step."""
    from scipy.linalg import LinAlgError, cho_factor, cho_solve

    diagonal = np.eye(weights.size)
    while damping <= _MOST:
        try:
            factor = cho_factor(current.normal + damping * diagonal)
            step = -cho_solve(factor, current.gradient)
            if mean_square(weights + step) < current.mean_square:
                return step, max(damping / _CHANGE, 0.0 if damping == 0.0 else _LEAST)
        except LinAlgError:  # singular without more damping
            pass
        damping = max(damping * _CHANGE, _LEAST)
    return None, damping
