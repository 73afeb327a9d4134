"""Finite element mesh of one tooth with its part of the body, cut at the middle of both spaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["SectorMesh", "grid_elements"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class SectorMesh:
    """One sector of a ring that repeats itself, all lengths in one unit of choice.

    Parameters
    ----------
    count : int
        How often the sector is repeated around the ring.
    nodes : array (nodes, 2)
        Coordinates, the middle of the sector on +y.
    elements : array (elements, 9)
        Nodes of each element, first local direction outermost.
    right_cut, left_cut : array (m,)
        Nodes of the cuts, in the order of their radius, without those that are held.
    held : array
        Nodes that cannot move.
    tooth : array (a, b)
        Nodes of the tooth, from the loaded flank across and from the tip down to the foot.
    flank_length : array (b,)
        Place of the nodes of the loaded flank as length along it, falling.
    outline : array
        Nodes of the free boundary from the right cut over the tip to the left cut.
    """

    count: int
    nodes: FloatArray
    elements: IntArray
    right_cut: IntArray
    left_cut: IntArray
    held: IntArray
    tooth: IntArray
    flank_length: FloatArray
    outline: IntArray


def grid_elements(grid: IntArray) -> IntArray:
    """Nine-node elements of a rectangular grid of nodes.

    Parameters
    ----------
    grid : array (2 a + 1, 2 b + 1)
        Node numbers.

    Returns
    -------
    array (a b, 9)
    """
    parts = [
        grid[i : grid.shape[0] - 2 + i : 2, j : grid.shape[1] - 2 + j : 2].ravel()
        for i in range(3)
        for j in range(3)
    ]
    return np.stack(parts, axis=1)
