"""Values of many contacts from polynomials that are fitted to solved ones.

What a solved film shears ripples by a per cent while the tip of its pressure moves from node to
node. A polynomial through a few solutions enlarges that ripple; one that is fitted to them together
with a wave of the place of the tip leaves it out.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from itertools import combinations_with_replacement

import numpy as np

from tribodyn.types import Array

#: Degree of the polynomials, and solved contacts for each of their coefficients.
_DEGREE, _SAMPLES = 4, 2.0
#: Solutions for each coefficient below which a cell has no values; smallest part of the greatest
#: singular value of the fit that counts.
_FEWEST, _FAINT = 1.2, 1e-3
#: Coefficients of the wave.
_WAVE = 2

#: Places of contacts, their rows (rows, n) and the tips of their pressure [nodes] at wanted places;
#: NaN where a contact has no solution.
Sampler = Callable[[Array], tuple[Array, Array, Array]]


class FittedTable:
    """Rows of values as a function of places (d, n) on a lattice with cells of one unit."""

    def __init__(self, sample: Sampler, dimensions: int) -> None:
        self._sample = sample
        self._exponents = np.array(
            [
                np.bincount(factors, minlength=dimensions)
                for degree in range(_DEGREE + 1)
                for factors in combinations_with_replacement(range(dimensions), degree)
            ]
        ).reshape(-1, dimensions)
        count = int(_SAMPLES * (len(self._exponents) + _WAVE))
        self._places = _even_places(count, dimensions)
        self._cells: dict[tuple[int, ...], Array] = {}
        self._lock = threading.Lock()

    @property
    def solved(self) -> int:
        """Number of contacts that were solved for it."""
        return len(self._cells) * int(self._places.shape[1])

    def __call__(self, places: Array) -> Array:
        """Rows (rows, n) at places (d, n), NaN where too many contacts have no solution."""
        cells, of_place = np.unique(np.floor(places).astype(int), axis=1, return_inverse=True)
        keys = list(map(tuple, cells.T.tolist()))
        with self._lock:
            self._add([key for key in keys if key not in self._cells])
        parts = [places[:, of_place.ravel() == number] for number in range(len(keys))]
        values = np.empty((len(self._cells[keys[0]]), places.shape[1]))
        for number, (key, part) in enumerate(zip(keys, parts, strict=True)):
            values[:, of_place.ravel() == number] = self._cells[key] @ self._powers(part, key)
        return values

    def _add(self, keys: list[tuple[int, ...]]) -> None:
        """Fit the polynomials of cells, whose contacts are solved in one batch."""
        if not keys:
            return
        wanted = np.concatenate([np.array(key)[:, None] + self._places for key in keys], axis=1)
        solved = [np.split(each, len(keys), axis=-1) for each in self._sample(wanted)]
        for key, places, rows, tips in zip(keys, *solved, strict=True):
            self._cells[key] = self._fitted(self._powers(places, key), rows, tips)

    def _fitted(self, powers: Array, rows: Array, tips: Array) -> Array:
        solved_places = np.isfinite(rows).all(axis=0)
        wave = np.stack([np.cos(2.0 * np.pi * tips), np.sin(2.0 * np.pi * tips)])
        terms = np.concatenate([powers, wave])[:, solved_places]
        if solved_places.sum() < _FEWEST * len(terms):
            return np.full((len(rows), len(powers)), np.nan)
        fit = np.linalg.lstsq(terms.T, rows[:, solved_places].T, rcond=_FAINT)[0]
        return np.asarray(fit[: len(powers)].T)

    def _powers(self, places: Array, cell: tuple[int, ...]) -> Array:
        """Terms of the polynomial (terms, n) at places, over [-1, 1] in a cell."""
        inside = 2.0 * (places - np.array(cell)[:, None]) - 1.0
        return np.asarray(np.prod(inside[None] ** self._exponents[:, :, None], axis=1))


def _even_places(count: int, dimensions: int) -> Array:
    """Places (d, n) in the unit cell, denser near its sides: a recurrence of golden ratios."""
    golden = 2.0
    for _ in range(40):
        golden = (1.0 + golden) ** (1.0 / (dimensions + 1.0))
    step = golden ** -np.arange(1.0, dimensions + 1.0)
    even = (0.5 + step[:, None] * np.arange(1, count + 1)) % 1.0
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * even))
