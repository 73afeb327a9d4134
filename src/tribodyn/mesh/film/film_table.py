"""Values between solved contacts: polynomials fitted to them, and the table of films over M and L.

What a solved film shears ripples by a per cent while the tip of its pressure moves from node to
node. A polynomial through a few solutions enlarges that ripple; one that is fitted to them together
with a wave of the place of the tip leaves it out.

Films over their scales depend on the numbers M and L of Moes alone. Their table is made of
polynomials over cells of a fixed lattice in ``ln M`` and ``ln L``. A cell is built when a contact
first needs it, and halved where it misses the solutions midway between its nodes. So a value
depends on the contact alone, not on earlier requests.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np

from tribodyn.types import Array, Index, Mask

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


#: Side of the largest cells in steps of the lattice, which is one unit of ``ln M`` or ``ln L``, and
#: of the smallest; a cell has five nodes along each side, and solutions are checked midway.
_LARGEST, _SMALLEST = 128, 8
_STEP = 1.0 / _LARGEST
_ORDER = 5
#: Places of the checks in eighths of a side: between nodes along ``ln M``, and along ``ln L``.
_BETWEEN = (((1, 2), (3, 4), (7, 6)), ((2, 1), (4, 5), (6, 7)))
#: Powers from the values at five even nodes of [-1, 1].
_POWERS = np.linalg.inv(np.vander(np.linspace(-1.0, 1.0, _ORDER), increasing=True))

#: Place on the lattice.
_Node = tuple[int, int]


class _Cell(NamedTuple):
    """First node of a cell, and its sides, in steps of the lattice."""

    node: _Node
    sides: tuple[int, int]

    @property
    def nodes(self) -> list[_Node]:
        """Nodes, the second coordinate fastest."""
        steps = range(0, 2 * _ORDER - 1, 2)
        return [self.at(first, second) for first in steps for second in steps]

    def at(self, first: int, second: int) -> _Node:
        """Place in eighths of its sides."""
        (i, j), (wide, high) = self.node, self.sides
        return i + first * wide // 8, j + second * high // 8

    def halves(self, directions: Iterable[int]) -> list[_Cell]:
        """Parts of the cell, halved in some directions."""
        cells = [self]
        for direction in directions:
            cells = [half for cell in cells for half in cell._halved(direction)]
        return cells

    def _halved(self, direction: int) -> tuple[_Cell, _Cell]:
        (i, j), (wide, high) = self.node, self.sides
        if direction == 0:
            sides, other = (wide // 2, high), (i + wide // 2, j)
        else:
            sides, other = (wide, high // 2), (i, j + high // 2)
        return _Cell(self.node, sides), _Cell(other, sides)


class FilmTable:
    """Quantities of contacts as a function of ``ln M`` and ``ln L``.

    ``solve`` returns them (quantities, n) for n contacts, NaN where a contact has no solution.
    ``tolerance`` is the greatest error of a cell that is not halved, infinite for quantities that
    are not checked. Where the smallest cells miss a ``strict`` quantity, the table has no values.
    """

    def __init__(
        self, solve: Callable[[Array, Array], Array], tolerance: Array, strict: Mask
    ) -> None:
        self._solve, self._tolerance, self._strict = solve, tolerance, strict
        self._solutions: dict[_Node, Array] = {}
        #: Halves of each checked cell; only the cell itself where it is accurate.
        self._halves: dict[_Cell, list[_Cell]] = {}
        self._powers: list[Array] = []
        #: For each of the largest cells, the number of the cell at each of its smallest parts.
        self._numbers: dict[_Node, Index] = {}
        self._frames: list[tuple[float, float, float, float]] = []
        self._arrays = (np.zeros((0, 4)), np.zeros((0, 0, 0, 0)))
        self._unresolved: set[_Cell] = set()
        self._lock = threading.Lock()

    @property
    def solved(self) -> int:
        """Number of contacts that were solved for it."""
        return len(self._solutions)

    def __call__(self, log_m: Array, log_l: Array) -> Array:
        """Return the quantities (q, n) of n contacts, NaN where the table has no value."""
        place = np.stack([log_m, log_l])
        fine = np.floor(place / (_SMALLEST * _STEP)).astype(np.int64)
        cell = self._cells(fine)
        if np.any(cell < 0):
            with self._lock:
                self._add_cells(fine[:, self._cells(fine) < 0])
            cell = self._cells(fine)
        frames, powers = self._arrays
        first, second = (place - frames[cell, :2].T) / frames[cell, 2:].T
        in_m = np.vander(first, _ORDER, increasing=True)
        in_l = np.vander(second, _ORDER, increasing=True)
        return np.asarray(np.einsum("niqj,nj,ni->qn", powers[cell], in_l, in_m, optimize=True))

    def _cells(self, fine: Index) -> Index:
        """Number of the cell at places in sides of the smallest cell, or -1 where there is none."""
        parts = _LARGEST // _SMALLEST
        large, inner = np.divmod(fine, parts)
        numbers = np.full(fine.shape[1], -1)
        for i, j in set(map(tuple, large.T.tolist())):
            if (i, j) in self._numbers:
                in_cell = (large[0] == i) & (large[1] == j)
                numbers[in_cell] = self._numbers[i, j][inner[0, in_cell], inner[1, in_cell]]
        return numbers

    def _add_cells(self, fine: Index) -> None:
        """Build the cells that cover places in sides of the smallest cell."""
        parts = _LARGEST // _SMALLEST
        roots = sorted(set(map(tuple, (fine.T // parts).tolist())))
        cells = [_Cell((i * _LARGEST, j * _LARGEST), (_LARGEST, _LARGEST)) for i, j in roots]
        new_cells: list[_Cell] = []
        while cells:
            new = [cell for cell in cells if cell not in self._halves]
            self._solve_nodes({node for cell in new for node in self._sample_nodes(cell)})
            for cell in new:
                self._halves[cell] = cell.halves(self._halved_directions(cell))
                if self._halves[cell] == [cell]:
                    new_cells.append(cell)
            cells = [
                half
                for cell in cells
                for half in self._halves[cell]
                if half != cell and _holds(half, fine)
            ]
        for cell in new_cells:
            self._frames.append(_frame(cell))
            self._powers.append(
                self._polynomial(cell) * (np.nan if cell in self._unresolved else 1.0)
            )
        self._arrays = np.array(self._frames), np.array(self._powers)
        for number, cell in enumerate(new_cells, len(self._frames) - len(new_cells)):
            (i, j), (wide, high) = cell.node, cell.sides
            places = self._numbers.setdefault(
                (i // _LARGEST, j // _LARGEST), np.full((parts, parts), -1)
            )
            first, second = i % _LARGEST // _SMALLEST, j % _LARGEST // _SMALLEST
            places[first : first + wide // _SMALLEST, second : second + high // _SMALLEST] = number

    def _sample_nodes(self, cell: _Cell) -> list[_Node]:
        checks = [cell.at(*place) for row in _BETWEEN for place in row]
        return [*cell.nodes, *checks]

    def _solve_nodes(self, nodes: set[_Node]) -> None:
        """Solve the contacts of all unsolved nodes in one batch."""
        new = sorted(nodes.difference(self._solutions))
        if new:
            values = self._solve(*(_STEP * np.array(new, dtype=float).T))
            self._solutions.update(zip(new, values.T, strict=True))

    def _polynomial(self, cell: _Cell) -> Array:
        """Powers (in M, quantity, in L) of the values at its nodes, over [-1, 1]."""
        values = np.array([self._solutions[node] for node in cell.nodes]).reshape(
            _ORDER, _ORDER, -1
        )
        return np.asarray(np.einsum("ai,ijq,bj->aqb", _POWERS, values, _POWERS))

    def _halved_directions(self, cell: _Cell) -> list[int]:
        """Directions in which the polynomial of a cell misses solutions, so that it is halved."""
        powers = self._polynomial(cell)
        misses = [
            np.any([self._misses(cell, powers, place) for place in places], axis=0)
            for places in _BETWEEN
        ]
        directions = [w for w in (0, 1) if np.any(misses[w]) and cell.sides[w] > _SMALLEST]
        if not directions and np.any(misses & self._strict):
            self._unresolved.add(cell)
        return directions

    def _misses(self, cell: _Cell, powers: Array, place: tuple[int, int]) -> Mask:
        """Quantities whose polynomial misses the solution at a place in eighths of the sides."""
        in_m, in_l = np.vander(0.25 * np.array(place) - 1.0, _ORDER, increasing=True)
        expected = np.einsum("iqj,i,j->q", powers, in_m, in_l)
        error = np.abs(expected - self._solutions[cell.at(*place)])
        return np.asarray(~(error <= self._tolerance))


def _holds(cell: _Cell, fine: Index) -> bool:
    """Whether one of the places lies in a cell."""
    (i, j), (wide, high) = cell.node, cell.sides
    inside = (fine[0] >= i // _SMALLEST) & (fine[0] < (i + wide) // _SMALLEST)
    return bool(np.any(inside & (fine[1] >= j // _SMALLEST) & (fine[1] < (j + high) // _SMALLEST)))


def _frame(cell: _Cell) -> tuple[float, float, float, float]:
    """Middle of a cell, and half of its sides."""
    half = [0.5 * _STEP * side for side in cell.sides]
    middle = [_STEP * node + h for node, h in zip(cell.node, half, strict=True)]
    return middle[0], middle[1], half[0], half[1]
