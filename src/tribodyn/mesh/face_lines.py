"""Whole tooth pairs from their slices, maps over path and face, and where pairs carry load.

A pair begins and ceases to carry at phases that are no knots of a mesh table. Between the last knot
without load and the first with load the share of the load is continued as a straight line to zero.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import InputError
from tribodyn.mesh.grid import PhaseGrid
from tribodyn.types import Array, Mask

if TYPE_CHECKING:
    from tribodyn.mesh.columns import MeshColumns

#: Columns of which a pair has the sum over its slices; others are those in the middle of the face.
SUMMED = frozenset(
    (
        "film_stiffness",
        "load_share",
        "normal_force",
        "stiffness",
        "tooth_load_share",
        "tooth_stiffness",
    )
)


def slice_count(mesh: MeshColumns) -> int:
    """Slices of each pair; 1 where the contacts are whole pairs."""
    face = mesh.face_position
    return 1 if face is None else int(np.unique(face).size)


def by_pair(values: NDArray[Any], slices: int) -> NDArray[Any]:
    """Values (..., pairs, slices) of contacts (..., pairs * slices)."""
    return values.reshape(*values.shape[:-1], -1, slices)


def along_flank(values: NDArray[Any], in_contact: Mask, slices: int) -> NDArray[Any]:
    """Values (n, contacts) of a tooth pair from its entry to its exit, slice by slice (m,)."""
    touching = by_pair(in_contact, slices).transpose(2, 1, 0)
    return np.asarray(by_pair(values, slices).transpose(2, 1, 0)[touching])


def pair_column(mesh: MeshColumns, column: str, *, in_middle: bool = False) -> tuple[Array, Mask]:
    """Values of whole pairs (n, pairs), and which pairs are in contact there."""
    values, slices = np.asarray(getattr(mesh, column)), slice_count(mesh)
    if slices == 1:
        return values, mesh.in_contact
    each, touching = by_pair(values, slices), by_pair(mesh.in_contact, slices)
    middle = slices // 2
    if column not in SUMMED:
        return each[:, :, middle], touching[:, :, middle]
    in_contact = touching[:, :, middle] if in_middle else touching.any(axis=2)
    return np.nansum(each, axis=2), np.asarray(in_contact)


def middle_delay(mesh: MeshColumns) -> float:
    """Mesh cycles between the entry of a pair and that of its slice in the middle of the face."""
    if mesh.face_position is None or mesh.gears is None:
        return 0.0
    slices = slice_count(mesh)
    return float(mesh.gears.entry_delay(slices)[slices // 2])


class FaceMap(NamedTuple):
    """Values of a tooth pair over its flank."""

    path: Array  #: distance from the pinion's base tangent point (points,) [m]
    face_position: Array  #: from the middle of the face (slices,) [m]
    values: Array  #: (slices, points)


def face_map(mesh: MeshColumns, column: str, points: int = 101) -> FaceMap:
    """Values of a column over path and face, which every slice of a tooth pair passes once."""
    values, slices = getattr(mesh, column, None), slice_count(mesh)
    if not isinstance(values, np.ndarray) or values.shape != mesh.path.shape:
        what = f'the mesh table has no column "{column}" over its contacts'
        raise InputError(what, "argument column", "Maps are drawn of contacts", "Name another one")
    ends = mesh.path[mesh.in_contact]
    path = np.linspace(ends.min(), ends.max(), points)
    rows = []
    for k in range(slices):
        touching = by_pair(mesh.in_contact, slices)[:, :, k]
        place = by_pair(mesh.path, slices)[:, :, k][touching]
        column_values = by_pair(values, slices)[:, :, k][touching]
        order = np.argsort(place, kind="stable")
        rows.append(np.interp(path, place[order], column_values[order]))
    face = np.zeros(1) if mesh.face_position is None else mesh.face_position[:slices]
    return FaceMap(path, face, np.stack(rows))


def face_load(mesh: MeshColumns) -> Array:
    """Mean load of each slice over the mesh cycle, over the mean of all slices (s,)."""
    slices = slice_count(mesh)
    each = mesh.grid.mean(by_pair(mesh.load_share, slices).sum(axis=1))
    return np.asarray(each / each.mean())


def face_load_factor(mesh: MeshColumns) -> float | None:
    """Greatest over mean load per width, each over the mesh cycle: K_H_beta after ISO 6336-1."""
    return None if mesh.face_position is None else float(face_load(mesh).max())


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
