"""Stiffness of the ring under the teeth, wave by wave around the axis."""

from __future__ import annotations

import numpy as np

from tribodyn.stiffness.fe3d.condense import eliminated
from tribodyn.stiffness.fe3d.face import FaceBasis
from tribodyn.stiffness.fe3d.sections import SectionMatrices, annulus_matrices
from tribodyn.types import Array

#: First radial size over the radius over the order, growth, and largest size over the radius.
_FIRST, _GROWTH, _LARGEST = 0.6, 1.5, 0.25
#: Waves times the logarithm of radii beyond which nothing moves.
_DECAYED = 20.0


def annulus_radii(held: float, loaded: float, order: int, first: float) -> Array:
    """Radii (e, 3) of elements from the held circle to the loaded one, the last size ``first``."""
    decayed = _DECAYED / max(abs(order), 1)
    reach = loaded * np.exp(np.clip(np.log(held / loaded), -decayed, decayed))
    inwards = np.sign(loaded - held)
    depths, step = [0.0], min(first, _FIRST * loaded / (abs(order) + 1.0))
    while depths[-1] < abs(loaded - reach):
        depths.append(depths[-1] + min(step, _LARGEST * (loaded - inwards * depths[-1])))
        step *= _GROWTH
    edges = loaded + (reach - loaded) / depths[-1] * np.array(depths[::-1])
    return np.stack([edges[:-1], 0.5 * (edges[:-1] + edges[1:]), edges[1:]], axis=1)


def annulus_stiffness(
    radii: Array, order: int, twist: float, stress: Array, face: FaceBasis
) -> Array:
    """Stiffness (3 z, 3 z) per radian at the loaded circle under loads ``exp(i order angle)``."""
    matrices = annulus_matrices(radii, order, twist, stress)
    block = 3 * face.count
    below = np.zeros((block, block), dtype=complex)
    for element in range(len(radii)):
        parts = SectionMatrices(*(part[element] for part in matrices))
        full = parts.of_solid(face).reshape(3 * block, 3 * block)
        if element == 0:
            full = full[block:, block:]
        else:
            full[:block, :block] += below
        below = eliminated(full, full.shape[0] - block)
    return below
