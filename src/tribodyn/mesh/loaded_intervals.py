"""Where tooth pairs carry load: the contact ratio under load, and the ages of a pair that carries.

A pair begins and ceases to carry at phases that are no knots of a mesh table. Between the last knot
without load and the first with load the share of the load is continued as a straight line to zero.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.mesh.face_lines import pair_column
from tribodyn.mesh.grid import PhaseGrid
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh.columns import MeshColumns

#: Begin and end of a part of the mesh cycle, or of the ages of a tooth pair [mesh cycles].
Interval = tuple[float, float]
#: Part of the load that is rounding.
_LOADED = 1e-9
#: Distance of two intervals that are one [mesh cycles].
_SAME = 1e-9


def loaded_intervals(grid: PhaseGrid, share: Array) -> list[Interval]:
    """Parts of the mesh cycle in which a share of the load (n,) at the knots is not zero."""
    intervals: list[Interval] = []
    for segment in grid.segments:
        phase, values = grid.phase[segment], share[segment]
        loaded = values > _LOADED
        edges = np.flatnonzero(np.diff(np.concatenate(([False], loaded, [False])).astype(int)))
        for first, stop in edges.reshape(-1, 2):
            start = _zero(phase, values, int(first), -1)
            end = _zero(phase, values, int(stop) - 1, 1)
            if end > start:
                intervals.append((start, end))
    return _joined(intervals)


def _zero(phase: Array, values: Array, last: int, step: int) -> float:
    """Phase at which values fall to zero beyond the last loaded knot in one sense."""
    beyond, before = last + step, last - step
    if not 0 <= beyond < phase.size:
        return float(phase[last])
    gap = float(phase[beyond] - phase[last])
    if not 0 <= before < phase.size or values[before] <= values[last]:
        return float(phase[last]) + 0.5 * gap
    fall = float(values[last] / (values[before] - values[last]))
    return float(phase[last]) + gap * min(fall, 1.0)


def _joined(intervals: list[Interval]) -> list[Interval]:
    """Intervals in order, those that meet as one."""
    joined: list[Interval] = []
    for start, end in sorted(intervals):
        if joined and start - joined[-1][1] < _SAME:
            joined[-1] = joined[-1][0], max(end, joined[-1][1])
        else:
            joined.append((start, end))
    return joined


def teeth_shares(mesh: MeshColumns) -> tuple[Array, Array]:
    """Load shares of the pairs on the path (n, pairs) and of tip corners (n, 2), films left out."""
    if mesh.tooth_load_share is None or mesh.tooth_corner_share is None:
        return pair_column(mesh, "load_share")[0], mesh.corner_share
    return pair_column(mesh, "tooth_load_share")[0], mesh.tooth_corner_share


def loaded_ages(mesh: MeshColumns, shares: tuple[Array, Array]) -> list[Interval]:
    """Ages between which one tooth pair carries, counted in mesh cycles from A."""
    share, corner = shares
    ages: list[Interval] = []
    for number, column in enumerate(share.T):
        ages += [(a + number, b + number) for a, b in loaded_intervals(mesh.grid, column)]
    ages += [(a - 1.0, b - 1.0) for a, b in loaded_intervals(mesh.grid, corner[:, 0])]
    if np.any(corner[:, 1] > _LOADED):
        ratio = mesh.transverse_contact_ratio
        for a, b in loaded_intervals(mesh.grid, corner[:, 1]):
            turns = np.ceil(ratio - 0.5 * (a + b) - _SAME)
            ages.append((a + turns, b + turns))
    return _joined(ages)


def contact_ratio(grid: PhaseGrid, share: Array, corners: Array) -> float:
    """Mean number of pairs that carry load over the mesh cycle, by the shares of all of them."""
    parts = [
        loaded_intervals(grid, column) for column in np.concatenate((share, corners), axis=1).T
    ]
    return float(sum(end - start for intervals in parts for start, end in intervals))


def sharing_parts(ages: list[Interval]) -> dict[int, float]:
    """Part of the mesh cycle in which so many pairs carry, from the ages at which one carries."""
    edges = sorted({0.0, 1.0, *(float(end % 1.0) for pair in ages for end in pair)})
    parts: dict[int, float] = {}
    for start, end in pairwise(edges):
        pairs = count_at(ages, 0.5 * (start + end))
        parts[pairs] = parts.get(pairs, 0.0) + end - start
    return dict(sorted(parts.items()))


def count_at(ages: list[Interval], phase: float) -> int:
    """Pairs that carry at a mesh phase."""
    return sum(int(np.floor(end - phase) - np.ceil(start - phase)) + 1 for start, end in ages)
