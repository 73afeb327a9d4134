"""Solved films of one oil between bodies of one material, tabled over the numbers M and L of Moes.

Films over their scales depend on nothing else. The table is made of polynomials over cells of a
fixed lattice in ``ln M`` and ``ln L``; a cell is made when a contact asks for it, and halved where
solutions midway between its nodes are not met. So an answer depends on the contact alone, and not
on what was asked before.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from tribodyn.types import Array, Index, Mask

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

    def halves(self, ways: Iterable[int]) -> list[_Cell]:
        """Parts of the cell, halved in some directions."""
        cells = [self]
        for way in ways:
            cells = [half for cell in cells for half in cell._halved(way)]
        return cells

    def _halved(self, way: int) -> tuple[_Cell, _Cell]:
        (i, j), (wide, high) = self.node, self.sides
        if way == 0:
            sides, other = (wide // 2, high), (i + wide // 2, j)
        else:
            sides, other = (wide, high // 2), (i, j + high // 2)
        return _Cell(self.node, sides), _Cell(other, sides)


class FilmTable:
    """Quantities of contacts as a function of ``ln M`` and ``ln L``.

    ``solve`` gives them (quantities, n) for n contacts, NaN where one has no solution, and
    ``tolerance`` is the error up to which a cell is kept, infinite for what is not checked. Where
    the smallest cells miss a ``strict`` quantity, the table has no values.
    """

    def __init__(
        self, solve: Callable[[Array, Array], Array], tolerance: Array, strict: Mask
    ) -> None:
        self._solve, self._tolerance, self._strict = solve, tolerance, strict
        self._known: dict[_Node, Array] = {}
        #: Halves of each cell that was looked at, none where it is kept.
        self._halves: dict[_Cell, list[_Cell]] = {}
        self._powers: list[Array] = []
        #: For each of the largest cells, the kept cell at each place of its smallest ones.
        self._kept: dict[_Node, Index] = {}
        self._frames: list[tuple[float, float, float, float]] = []
        self._arrays = (np.zeros((0, 4)), np.zeros((0, 0, 0, 0)))
        self._lost: set[_Cell] = set()
        self._lock = threading.Lock()

    @property
    def solved(self) -> int:
        """Number of contacts that were solved for it."""
        return len(self._known)

    def __call__(self, log_m: Array, log_l: Array) -> Array:
        """Quantities (q, n) of some contacts; NaN where the table has no value."""
        place = np.stack([log_m, log_l])
        fine = np.floor(place / (_SMALLEST * _STEP)).astype(np.int64)
        cell = self._cells(fine)
        if np.any(cell < 0):
            with self._lock:
                self._make(fine[:, self._cells(fine) < 0])
            cell = self._cells(fine)
        frames, powers = self._arrays
        first, second = (place - frames[cell, :2].T) / frames[cell, 2:].T
        in_m = np.vander(first, _ORDER, increasing=True)
        in_l = np.vander(second, _ORDER, increasing=True)
        return np.asarray(np.einsum("niqj,nj,ni->qn", powers[cell], in_l, in_m, optimize=True))

    def _cells(self, fine: Index) -> Index:
        """Number of the kept cell at places in sides of the smallest one, or -1."""
        parts = _LARGEST // _SMALLEST
        large, inner = np.divmod(fine, parts)
        found = np.full(fine.shape[1], -1)
        for i, j in set(map(tuple, large.T.tolist())):
            if (i, j) in self._kept:
                here = (large[0] == i) & (large[1] == j)
                found[here] = self._kept[i, j][inner[0, here], inner[1, here]]
        return found

    def _make(self, fine: Index) -> None:
        """Make the cells of places in sides of the smallest one."""
        parts = _LARGEST // _SMALLEST
        roots = sorted(set(map(tuple, (fine.T // parts).tolist())))
        cells = [_Cell((i * _LARGEST, j * _LARGEST), (_LARGEST, _LARGEST)) for i, j in roots]
        kept: list[_Cell] = []
        while cells:
            new = [cell for cell in cells if cell not in self._halves]
            self._learn({node for cell in new for node in self._wanted(cell)})
            for cell in new:
                self._halves[cell] = cell.halves(self._ways(cell))
                if self._halves[cell] == [cell]:
                    kept.append(cell)
            cells = [
                half
                for cell in cells
                for half in self._halves[cell]
                if half != cell and _holds(half, fine)
            ]
        for cell in kept:
            self._frames.append(_frame(cell))
            self._powers.append(self._polynomial(cell) * (np.nan if cell in self._lost else 1.0))
        self._arrays = np.array(self._frames), np.array(self._powers)
        for number, cell in enumerate(kept, len(self._frames) - len(kept)):
            (i, j), (wide, high) = cell.node, cell.sides
            places = self._kept.setdefault(
                (i // _LARGEST, j // _LARGEST), np.full((parts, parts), -1)
            )
            first, second = i % _LARGEST // _SMALLEST, j % _LARGEST // _SMALLEST
            places[first : first + wide // _SMALLEST, second : second + high // _SMALLEST] = number

    def _wanted(self, cell: _Cell) -> list[_Node]:
        checks = [cell.at(*place) for row in _BETWEEN for place in row]
        return [*cell.nodes, *checks]

    def _learn(self, nodes: set[_Node]) -> None:
        """Solve the contacts of nodes that are not known yet, together."""
        new = sorted(nodes.difference(self._known))
        if new:
            values = self._solve(*(_STEP * np.array(new, dtype=float).T))
            self._known.update(zip(new, values.T, strict=True))

    def _polynomial(self, cell: _Cell) -> Array:
        """Powers (in M, quantity, in L) of the values at its nodes, over [-1, 1]."""
        values = np.array([self._known[node] for node in cell.nodes]).reshape(_ORDER, _ORDER, -1)
        return np.asarray(np.einsum("ai,ijq,bj->aqb", _POWERS, values, _POWERS))

    def _ways(self, cell: _Cell) -> list[int]:
        """Directions in which a cell is halved, because its polynomial misses solutions there."""
        powers = self._polynomial(cell)
        missed = [
            np.any([self._missed(cell, powers, place) for place in places], axis=0)
            for places in _BETWEEN
        ]
        ways = [w for w in (0, 1) if np.any(missed[w]) and cell.sides[w] > _SMALLEST]
        if not ways and np.any(missed & self._strict):
            self._lost.add(cell)
        return ways

    def _missed(self, cell: _Cell, powers: Array, place: tuple[int, int]) -> Mask:
        """Quantities whose polynomial misses the solution at a place in eighths of the sides."""
        in_m, in_l = np.vander(0.25 * np.array(place) - 1.0, _ORDER, increasing=True)
        expected = np.einsum("iqj,i,j->q", powers, in_m, in_l)
        error = np.abs(expected - self._known[cell.at(*place)])
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
