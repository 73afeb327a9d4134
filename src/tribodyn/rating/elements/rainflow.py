"""Rainflow counting of a load history: ASTM E1049.

For shafts and housings, whose stress follows the torque. Teeth of gears are loaded once a turn
and mesh: they take the load classes of :func:`tribodyn.rating.load_classes` instead.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.types import Array


class LoadCycles(NamedTuple):
    """Cycles of a load history, in its unit; made by :func:`rainflow_cycles`.

    Parameters
    ----------
    ranges, means : array
        Greatest less least load of each cycle, and their mean (the unit of the history).
    counts : array
        1, or 0.5 of half a cycle, pure numbers.
    """

    ranges: Array
    means: Array
    counts: Array

    def equivalent_amplitude(self, exponent: float, cycles: float) -> float:
        """Constant amplitude that does the same damage.

        Parameters
        ----------
        exponent : float
            Slope k of the life curve ``N ~ amplitude^-k``, pure number.
        cycles : float
            Number of its cycles, pure number.

        Returns
        -------
        float
            In the unit of the history.

        Raises
        ------
        InputError
            If a value is not positive.
        """
        require_positive("exponent", exponent)
        require_positive("cycles", cycles)
        damage = float((self.counts * (0.5 * self.ranges) ** exponent).sum())
        return float((damage / cycles) ** (1.0 / exponent))


def _turning_points(history: Array) -> Array:
    """Ends and turning points of a history."""
    moving: Array = history[np.concatenate([[True], np.diff(history) != 0.0])]
    turned = np.diff(np.sign(np.diff(moving))) != 0.0
    if moving.size < 2:
        return moving
    return np.asarray(moving[np.concatenate([[True], turned, [True]])])


def rainflow_cycles(history: ArrayLike) -> LoadCycles:
    """Count the cycles of a load history by the rainflow method.

    Parameters
    ----------
    history : array [Pa]
        Stresses in their order, at least two different ones; loads of another unit too.

    Returns
    -------
    LoadCycles
        In the order in which they close, then what is left as half cycles.

    Raises
    ------
    InputError
        If the history has no turning points or values that are no numbers.

    Notes
    -----
    Source: ASTM E1049, 5.4.4.

    Examples
    --------
    >>> cycles = rainflow_cycles([-2, 1, -3, 5, -1, 3, -4, 4, -2])
    >>> cycles.ranges.tolist(), cycles.counts.tolist()
    ([3.0, 4.0, 4.0, 8.0, 9.0, 8.0, 6.0], [0.5, 0.5, 1.0, 0.5, 0.5, 0.5, 0.5])
    """
    loads = np.asarray(history, dtype=float).ravel()
    require_between("history", loads, -1e300, 1e300)
    points = _turning_points(loads).tolist()
    if len(points) < 2:
        why, remedy = "A cycle goes from one load to another", "Give at least two different loads"
        raise InputError("the history does not change", Argument("history"), why, remedy)
    stack: list[float] = []
    cycles: list[tuple[float, float, float]] = []
    for point in points:
        stack.append(point)
        while len(stack) >= 3 and abs(stack[-1] - stack[-2]) >= abs(stack[-2] - stack[-3]):
            is_half = len(stack) == 3  # it has the first point
            cycles.append((stack[-3], stack[-2], 0.5 if is_half else 1.0))
            del stack[-3 : -2 if is_half else -1]
    cycles += [(first, last, 0.5) for first, last in itertools.pairwise(stack)]
    first, last, count = np.array(cycles).T
    return LoadCycles(np.abs(last - first), 0.5 * (first + last), count)
