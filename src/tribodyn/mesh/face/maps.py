"""Values of a mesh over the path of contact and the face width, and the face load factor."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribodyn.errors import InputError
from tribodyn.mesh.face.lines import by_pair, slice_count
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh.columns import MeshColumns


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
