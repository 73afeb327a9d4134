"""The sector of one tooth as a twisted solid, reduced to its flank and its borders."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from tribodyn.gear import SpurGear
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, SectorMesh, tooth_mesh
from tribodyn.stiffness.fe3d.sections import (
    FaceBasis,
    FaceSize,
    SectionMatrices,
    annulus_matrices,
    condensed,
    elasticity,
    element_matrices,
    eliminated,
    face_basis,
)
from tribodyn.types import Array, Index

#: Least radius of curvature of a load [modules].
LEAST_CURVATURE = 0.02
#: First radial size of the ring [modules].
_RING_SIZE = 0.4
#: Least depth of a ring under the meshed part of the body [modules].
_LEAST_RING = 0.3
#: Length along the flank that is rounding [modules].
_ROUNDING = 1e-9


@dataclass(frozen=True)
class SolidSize:
    """Sizes of the elements of a gear with its face width over the module.

    Parameters
    ----------
    section : MeshSize
        Elements of the transverse section; loads act where those of the flank meet.
    face : FaceSize
        Elements over the face width.
    depth : float [-]
        Depth of the meshed part of the body under the root circle; below, rings wave by wave.
    waves : int
        Waves around the axis, per tooth and on each side of a harmonic, that reach that depth.
    """

    section: MeshSize = field(default_factory=lambda: MeshSize(0.2, 0.6, 1.7, 0.8, 0.45, 2))
    face: FaceSize = field(default_factory=FaceSize)
    depth: float = 1.0
    waves: int = 2


@dataclass(frozen=True, eq=False)
class Sector:
    """Sector of one tooth, all lengths in modules; Young's modulus one."""

    form: SpurGear  #: the gear in its transverse section
    width: float  #: face width
    fixed_radius: float  #: radius of the circle where the body is held
    twist: float  #: angle by which the section turns anticlockwise per module of the face [rad]
    poissons_ratio: float
    size: SolidSize

    @cached_property
    def interface(self) -> float:
        """Radius where the meshed part of the body ends."""
        depth = self.form.root_radius / self.form.normal_module - self.form.sign * self.size.depth
        return (
            depth
            if self.form.sign * (depth - self.fixed_radius) > _LEAST_RING
            else self.fixed_radius
        )

    @property
    def on_ring(self) -> bool:
        """Whether a ring lies below the meshed part, which is held itself otherwise."""
        return self.interface != self.fixed_radius

    @property
    def count(self) -> int:
        """Number of sectors of the ring."""
        return abs(self.form.teeth)

    @cached_property
    def mesh(self) -> SectorMesh:
        """Elements of the section."""
        return tooth_mesh(self.form, self.interface * self.form.normal_module, self.size.section)

    @cached_property
    def face(self) -> FaceBasis:
        """Functions over the face."""
        return face_basis(self.size.face.breaks(self.width))

    @cached_property
    def stress(self) -> Array:
        """Elasticity for a Young's modulus of one."""
        return elasticity(self.poissons_ratio)

    @property
    def base_radius(self) -> float:
        """Base radius."""
        return self.form.base_radius / self.form.normal_module

    @cached_property
    def flank_length(self) -> Array:
        """Places on the flank as :class:`SectorMesh` counts them, by the radius of curvature."""
        form, lengths = self.form, self.mesh.flank_length[::2]
        roll = form.roll_angle(max(form.form_radius, form.base_radius))
        lowest = 0.5 * form.sign * self.base_radius * roll**2
        return lengths[lengths > lowest - _ROUNDING][:: -form.sign]

    @cached_property
    def flank(self) -> Index:
        """Nodes of the loaded places."""
        return self.mesh.tooth[0, : 2 * self.flank_length.size : 2][:: -self.form.sign]

    def curvature_radius(self, length: Array) -> Array:
        """Radius of curvature at places on the flank."""
        square = 2.0 * self.base_radius * np.maximum(self.form.sign * length, 0.0)
        return np.maximum(np.sqrt(square), LEAST_CURVATURE)

    def load_direction(self, length: Array) -> Array:
        """Loads (..., 3) whose part in the section is a unit vector, normal to the flank."""
        roll = self.form.sign * self.curvature_radius(length) / self.base_radius
        angle = roll - self.form.base_half_angle
        axial = np.full(angle.shape, -self.twist * self.base_radius)
        return np.stack([-np.cos(angle), -np.sin(angle), axial], axis=-1)

    def directions(self) -> Array:
        """Directions (n, 3, freedom): polar on the borders, along the load on the flank."""
        mesh = self.mesh
        turn = np.tile(np.eye(3), (len(mesh.nodes), 1, 1))
        polar = np.concatenate([mesh.right_cut, mesh.left_cut, mesh.fixed])
        outward = mesh.nodes[polar] / np.hypot(*mesh.nodes[polar].T)[:, None]
        turn[polar, :2, 0] = outward
        turn[polar, :2, 1] = outward[:, ::-1] * [-1.0, 1.0]
        load = self.load_direction(self.flank_length)
        load /= np.linalg.norm(load, axis=1)[:, None]
        aside = np.stack([-load[:, 1], load[:, 0], np.zeros(len(load))], axis=1)
        aside /= np.linalg.norm(aside, axis=1)[:, None]
        turn[self.flank] = np.stack([load, aside, np.cross(load, aside)], axis=2)
        return turn

    def groups(self) -> list[Index]:
        """Rows of elements from the tip to the foot, then from the root to the inner circle."""
        columns, rows = ((size - 1) // 2 for size in self.mesh.tooth.shape)
        body = np.arange(len(self.mesh.elements) - columns * rows)
        tooth = body.size + np.arange(columns * rows)
        grids = (
            tooth.reshape(columns, rows),
            body.reshape((self.mesh.fixed.size - 1) // 2, -1),
        )
        return [row for grid in grids for row in grid.T]

    @cached_property
    def border(self) -> tuple[Index, Index, Index]:
        """Nodes of the right and left cut and of the circle on the ring."""
        mesh = self.mesh
        return mesh.right_cut, mesh.left_cut, mesh.fixed if self.on_ring else mesh.fixed[:0]

    @property
    def border_points(self) -> Array:
        """Places of the nodes on the ring."""
        return self.mesh.nodes[self.border[2]]

    @property
    def loaded_freedoms(self) -> int:
        """Number of loaded places."""
        return self.flank.size

    @property
    def waves(self) -> int:
        """Waves on each side of a harmonic in the ring."""
        return self.size.waves

    @property
    def load_square(self) -> float:
        """Square of the length of a load, which is a unit vector in the section only."""
        return 1.0 + (self.twist * self.base_radius) ** 2

    def ring_stiffness(self, order: int) -> Array:
        """Stiffness of the ring for waves around the axis."""
        radii = annulus_radii(self.fixed_radius, self.interface, order, _RING_SIZE)
        return annulus_stiffness(radii, order, self.twist, self.stress, self.face)

    def condensed(self) -> Array:
        """Stiffness (f, z, f, z) of the flank, in its loaded direction, and of the borders."""
        mesh = self.mesh
        matrices = element_matrices(mesh.nodes[mesh.elements], self.twist, self.stress)
        turn = self.directions()[mesh.elements]

        freedoms = node_freedoms(mesh.elements)
        if not self.on_ring:
            freedoms[np.repeat(np.isin(mesh.elements, mesh.fixed), 3, axis=1)] = -1
        retained = np.concatenate([3 * self.flank, *map(node_freedoms, self.border)], axis=None)
        parts = SectionMatrices(*(turned_stiffness(matrix, turn) for matrix in matrices))
        return condensed(freedoms, parts, self.groups(), retained, self.face)


def turned_stiffness(matrix: Array, turn: Array) -> Array:
    """Element matrices (e, 3 n, 3 n) for directions (e, n, 3, freedom) of their nodes."""
    elements, nodes = turn.shape[:2]
    blocks = matrix.reshape(elements, nodes, 3, nodes, 3).transpose(0, 1, 3, 2, 4)
    blocks = np.swapaxes(turn, 2, 3)[:, :, None] @ (blocks @ turn[:, None])
    return np.asarray(blocks.transpose(0, 1, 3, 2, 4).reshape(matrix.shape))


def node_freedoms(nodes: Index) -> Index:
    """Freedoms of rows of nodes."""
    return np.reshape(3 * nodes[..., None] + np.arange(3), (*nodes.shape[:-1], -1))


#: First radial size over the radius over the order, growth, and largest size over the radius.
_FIRST, _GROWTH, _LARGEST = 0.6, 1.5, 0.25
#: Waves times the logarithm of radii beyond which nothing moves.
_DECAYED = 20.0


def annulus_radii(fixed: float, loaded: float, order: int, first: float) -> Array:
    """Radii (e, 3) of elements from the held circle to the loaded one, the last size ``first``."""
    decayed = _DECAYED / max(abs(order), 1)
    reach = loaded * np.exp(np.clip(np.log(fixed / loaded), -decayed, decayed))
    inwards = np.sign(loaded - fixed)
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
