"""Compliance of all tooth pairs of a mesh together: what a load on one pair does at the others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tribodyn.stiffness.influence import GearInfluence
from tribodyn.stiffness.loaded.places import ContactPlaces

__all__ = ["Compliance", "coupled_compliance", "independent_compliance"]

FloatArray = NDArray[np.float64]


def coupled_compliance(
    pinion: GearInfluence, wheel: GearInfluence, places: ContactPlaces
) -> FloatArray:
    """Structural compliance of all pairs that may touch, coupled through both gear bodies.

    Parameters
    ----------
    pinion, wheel : GearInfluence
        Structure of each gear.
    places : ContactPlaces
        Where the pairs touch.

    Returns
    -------
    array (p, n, n) [m^2/N]
        Approach at the first pair per load per face width on the second; symmetric.

    Notes
    -----
    Places are those of contacts, on the involute; what rounding takes them beyond its ends is
    brought back. A contact that is a base pitch further along the path has larger radii of
    curvature on the pinion and smaller ones on the wheel, so that it is on the other side of the
    wheel's tooth.
    """
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


def independent_compliance(stiffness: FloatArray, face_width: float) -> FloatArray:
    """Compliance of pairs that know nothing of each other.

    Parameters
    ----------
    stiffness : array (p, n) [N/m]
        Stiffness of each pair; zero where it is not in contact.
    face_width : float [m]
        Common face width.

    Returns
    -------
    array (p, n, n) [m^2/N]
        Diagonal; one where there is no contact, which then has no influence.

    Examples
    --------
    >>> independent_compliance(np.array([[2e8, 0.0]]), 0.02)[0].diagonal().tolist()
    [1e-10, 1.0]
    """
    touching = stiffness > 0.0
    diagonal = np.where(touching, face_width / np.where(touching, stiffness, 1.0), 1.0)
    return np.asarray(diagonal[..., None] * np.eye(stiffness.shape[1]))


@dataclass(frozen=True, eq=False)
class Compliance:
    """Everything that the solver needs of the teeth at some phases.

    Parameters
    ----------
    structure : array (p, n, n) [m^2/N]
        Compliance without the local compression.
    local : array (p, n) [m^2/N]
        Coefficient ``A`` of the local compression ``f (A - B ln f)``.
    logarithm : float [m^2/N]
        Coefficient ``B``; zero where the compression is in proportion to the load.
    """

    structure: FloatArray
    local: FloatArray
    logarithm: float
