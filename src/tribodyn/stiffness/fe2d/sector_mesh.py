"""Finite element mesh of one tooth with its part of the body, cut at the middle of both spaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.types import Array, Index


@dataclass(frozen=True, eq=False)
class SectorMesh:
    """One sector of a ring that repeats itself, all lengths in one unit of choice."""

    count: int  #: how often the sector is repeated around the ring
    nodes: Array  #: coordinates, the middle of the sector on +y
    elements: Index  #: nodes of each element, first local direction outermost
    right_cut: Index
    left_cut: Index
    held: Index  #: nodes that cannot move
    tooth: Index
    flank_length: Array  #: place of the nodes of the loaded flank as length along it, falling
    outline: Index  #: nodes of the free boundary from the right cut over the tip to the left cut


def grid_elements(grid: Index) -> Index:
    """Nine-node elements of a rectangular grid of nodes."""
    parts = [
        grid[i : grid.shape[0] - 2 + i : 2, j : grid.shape[1] - 2 + j : 2].ravel()
        for i in range(3)
        for j in range(3)
    ]
    return np.stack(parts, axis=1)
