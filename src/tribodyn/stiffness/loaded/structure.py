"""Compliance of all tooth pairs of a mesh together: what a load on one pair does at the others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.stiffness.influence import GearInfluence
from tribodyn.stiffness.loaded.places import ContactPlaces
from tribodyn.types import Array


def coupled_compliance(pinion: GearInfluence, wheel: GearInfluence, places: ContactPlaces) -> Array:
    """Structural compliance of all pairs that may touch, coupled through both gear bodies."""
    radii = [
        np.clip(radius, *gear.curvature_radius[[0, -1]])
        for gear, radius in (
            (pinion, places.pinion_curvature_radius),
            (wheel, places.wheel_curvature_radius),
        )
    ]
    count = places.path.shape[1]
    total = np.empty((places.path.shape[0], count, count))
    for i in range(count):
        total[:, i, i] = pinion.at(radii[0][:, i]) + wheel.at(radii[1][:, i])
        for j in range(i + 1, count):
            further = (j - i) * places.direction
            cross = pinion.between(radii[0][:, i], radii[0][:, j], further)
            cross = cross + wheel.between(radii[1][:, i], radii[1][:, j], -further)
            total[:, i, j] = total[:, j, i] = cross
    return total


def independent_compliance(stiffness: Array, face_width: float) -> Array:
    """Compliance of pairs that know nothing of each other."""
    touching = stiffness > 0.0
    diagonal = np.where(touching, face_width / np.where(touching, stiffness, 1.0), 1.0)
    return np.asarray(diagonal[..., None] * np.eye(stiffness.shape[1]))


@dataclass(frozen=True, eq=False)
class Compliance:
    """Everything that the solver needs of the teeth at some phases."""

    structure: Array  #: compliance without the local compression [m^2/N]
    local: Array  #: coefficient ``A`` of the local compression ``f (A - B ln f)`` [m^2/N]
    logarithm: float  #: coefficient ``B`` [m^2/N]
