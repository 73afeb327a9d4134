"""Timoshenko beam element of a round section, cylindrical or conical, solid or hollow.

The stiffness is the inverse of the flexibility of the element held at its first end, and the
shape functions are the deflections under forces at the second end: both hold for any taper.
Mass and gyroscopic matrix are consistent with these shape functions, rotary inertia included.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.gear import Material
from tribodyn.machine.section import Section
from tribodyn.types import Array

#: Gauss points of an integral over an element: exact for a cylinder, rounding for usual cones.
_POINTS = 12
_ABSCISSA, _WEIGHT = 0.5 * np.array(np.polynomial.legendre.leggauss(_POINTS)) + [[0.5], [0.0]]


def shear_coefficient(diameter_ratio: Array | float, poissons_ratio: float) -> Array:
    """Effective over geometric area in shear of a hollow round section, G. R. Cowper (1966) [1]."""
    square = np.asarray(diameter_ratio, dtype=float) ** 2
    outer, nu = (1.0 + square) ** 2, poissons_ratio
    return np.asarray(
        6.0 * (1.0 + nu) * outer / ((7.0 + 6.0 * nu) * outer + (20.0 + 12.0 * nu) * square)
    )


def carried_along(distance: Array | float) -> Array:
    """Matrix (..., 6, 6) that carries displacements rigidly along x; transposed, forces back."""
    distances = np.asarray(distance, dtype=float)
    out = np.zeros((*distances.shape, 6, 6))
    out[..., range(6), range(6)] = 1.0
    out[..., 1, 5], out[..., 2, 4] = distances, -distances
    return out


def carried_across(y: float, z: float) -> Array:
    """Matrix (6, 6) that carries displacements rigidly across x; transposed, forces back."""
    out = np.eye(6)
    out[0, 4:], out[1, 3], out[2, 3] = (z, -y), -z, y
    return out


def part_of(section: Section, start: float, end: float) -> Section:
    """Return the part of a section between two positions from its beginning [m]."""
    first, last = (section.diameters(at / section.length) for at in (start, end))
    return Section(end - start, *first, *last)


def _profile(section: Section, position: Array) -> tuple[Array, Array, Array]:
    """Area, second moment of area and inner over outer diameter at positions."""
    ends = zip(section.diameters(0.0), section.diameters(1.0), strict=True)
    outer, inner = (first + position / section.length * (last - first) for first, last in ends)
    area = np.pi / 4.0 * (outer**2 - inner**2)
    return area, area / 16.0 * (outer**2 + inner**2), inner / outer


@dataclass(frozen=True)
class BeamElement:
    """Beam element over the coordinates of its first node, then of its second: (12, 12) [SI]."""

    section: Section
    material: Material

    @cached_property
    def mass(self) -> Array:
        """Consistent mass matrix with rotary inertia, (12, 12) [kg, kg*m, kg*m^2]."""
        position, weight, motion = self._nodes
        area, bending, _ = _profile(self.section, position)
        inertia = np.stack((area, area, area, 2.0 * bending, bending, bending), axis=-1)
        inertia *= self.material.density * weight[:, None]
        matrix = np.einsum("pki,pk,pkj->ij", motion, inertia, motion)
        return np.asarray(0.5 * (matrix + matrix.T))

    @cached_property
    def gyroscopic(self) -> Array:
        """Skew gyroscopic matrix per unit of speed, (12, 12) [kg*m^2, kg*m, kg]."""
        position, weight, motion = self._nodes
        polar = 2.0 * self.material.density * weight * _profile(self.section, position)[1]
        half = np.einsum("pi,p,pj->ij", motion[:, 4], polar, motion[:, 5])
        return np.asarray(half - half.T)

    @cached_property
    def stiffness(self) -> Array:
        """Stiffness matrix, (12, 12) [N/m, N, N*m]."""
        matrix = self._strained.T @ self._end_stiffness @ self._strained
        return np.asarray(0.5 * (matrix + matrix.T))

    def motion(self, position: Array | float) -> Array:
        """Displacements (..., 6) inside the element per displacement of its nodes."""
        bent = self._bent(np.asarray(position, dtype=float)) @ self._end_stiffness @ self._strained
        bent[..., :6] += carried_along(position)
        return np.asarray(bent)

    @cached_property
    def _nodes(self) -> tuple[Array, Array, Array]:
        """Integration points, their weights and the shape functions there."""
        position = self.section.length * _ABSCISSA
        return position, self.section.length * _WEIGHT, self.motion(position)

    @cached_property
    def _strained(self) -> Array:
        """Displacement of the second end beyond that of a rigid element, (6, 12)."""
        return np.hstack((-carried_along(self.section.length), np.eye(6)))

    @cached_property
    def _end_stiffness(self) -> Array:
        return np.asarray(np.linalg.inv(self._bent(np.asarray(self.section.length))))

    def _bent(self, position: Array) -> Array:
        """Displacement at positions per unit load at the second end, the first one held."""
        inner = position[..., None] * _ABSCISSA
        compliance = self._compliance(inner) * (position[..., None] * _WEIGHT)[..., None]
        load = carried_along(self.section.length - inner).swapaxes(-1, -2)
        carried = carried_along(position[..., None] - inner)
        return np.asarray(
            np.einsum("...pik,...pk,...pkj->...ij", carried, compliance, load, optimize=True)
        )

    def _compliance(self, position: Array) -> Array:
        """Strains per unit of force and moment in a section, (..., 6)."""
        material = self.material
        area, bending, ratio = _profile(self.section, position)
        shear = material.shear_modulus
        sheared = 1.0 / (shear_coefficient(ratio, material.poissons_ratio) * shear * area)
        stretched, curved = 1.0 / (material.youngs_modulus * np.stack((area, bending)))
        twisted = 1.0 / (2.0 * shear * bending)
        return np.stack((stretched, sheared, sheared, twisted, curved, curved), axis=-1)
