"""Position at rest of a system under its mean loads, with springs at its contacts."""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics.equations.grid import unrepeated
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array


def balanced_position(
    system: System,
    nodes: Nodes,
    carrying: Array,
    push: Array,
    bases: tuple[Array, Array] | None = None,
) -> Array:
    """Position at rest if each newton of a contact pushes with ``push`` (..., contacts, n)."""
    # bases: those along which directions and ``push`` have components
    weight = nodes.weight[..., None] * carrying
    stiffness, pushed = _sums(push, weight, nodes.direction, nodes.error + nodes.gap)
    if bases is not None:
        stiffness, pushed = bases[1] @ stiffness @ bases[0].T, pushed @ bases[1].T
    stiffness = stiffness + np.asarray(system.stiffness)
    force = np.einsum("...rs,...rsi->...i", nodes.weight, nodes.force) + pushed
    # Least squares in mass-weighted coordinates: free motions get no displacement.
    scale = 1.0 / np.sqrt(np.diag(np.asarray(system.mass)))
    matrix = stiffness * np.outer(scale, scale)
    if matrix.ndim == 2:
        return np.asarray(scale * np.linalg.lstsq(matrix, scale * force, rcond=1e-12)[0])
    inverse = np.linalg.pinv(matrix, rcond=1e-12)
    return np.asarray(scale * np.einsum("...ij,...j->...i", inverse, scale * force))


def _sums(push: Array, weight: Array, along: Array, shift: Array) -> tuple[Array, Array]:
    """Sums of ``weight push along`` (..., s, r) and of ``weight push shift`` (..., s)."""
    lead, size, wide = push.shape[:-4], push.shape[-1], along.shape[-1]
    constant_push, constant_along = (
        not lead and unrepeated(part, 2).size == part[0, 0].size for part in (push, along)
    )
    if constant_push and constant_along:
        total, moved = weight.sum(axis=(0, 1)), (weight * shift).sum(axis=(0, 1))
        return (push[0, 0].T * total) @ along[0, 0], push[0, 0].T @ moved
    if constant_along:
        # Of each contact only the sum of its pushes counts.
        flat = push.reshape(-1, *push.shape[2:])
        pairs = np.stack((weight, weight * shift)).reshape(2, *flat.shape[:2])
        total, moved = np.stack([pairs[..., j] @ flat[:, j] for j in range(flat.shape[1])], axis=1)
        return total.T @ along[0, 0], moved.sum(axis=0)
    flat = np.swapaxes(push.reshape(*lead, -1, size), -1, -2)
    factors = np.stack((weight, weight * shift), axis=-1).reshape(*lead, -1, 2)
    if (constant := unrepeated(along, 1)).size == wide:  # a factor of the sum
        sums = flat @ factors
        return sums[..., :1] * constant.reshape(wide), sums[..., 1]
    each = np.broadcast_to(along, (*push.shape[:-1], wide)).reshape(*lead, -1, wide)
    weighted = factors[..., :1] * each
    return flat @ weighted, (flat @ factors[..., 1:])[..., 0]
