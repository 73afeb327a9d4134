"""Least squares after Levenberg and Marquardt, stopped where other data say so."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tribodyn.types import Array

#: Factor of the damping after a step, and the damping beyond which no step helps.
_CHANGE, _MOST, _LEAST = 10.0, 1e10, 1e-20
#: Gradient of half the mean square at which a minimum is reached.
_GRADIENT = 1e-9


class Squares(NamedTuple):
    """Mean square of the residuals at a place, with gradient and normal matrix of its half."""

    mean_square: float
    gradient: Array
    normal: Array


class Fit(NamedTuple):
    """What the search came to."""

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
    """Least mean square from a start.

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
        told = validation(weights)
        failures = 0 if told < least else failures + 1
        if told < least:
            best, least = weights, told
        elif failures >= patience:
            stopped = "validation"
            break
    return Fit(weights if validation is None else best, epoch, stopped)


def _step(
    current: Squares, mean_square: Callable[[Array], float], weights: Array, damping: float
) -> tuple[Array | None, float]:
    """A step that lowers the mean square, and the damping of the next one."""
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
