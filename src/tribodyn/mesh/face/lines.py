"""Columns of whole tooth pairs from those of their slices over the face width."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

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
