"""Columns of whole tooth pairs from those of their slices, and maps over path and face."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import InputError
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
