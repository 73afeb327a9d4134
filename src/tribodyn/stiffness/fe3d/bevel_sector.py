"""Sector of one tooth of a hypoid or spiral bevel gear with the top of its body, in hexahedra."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.stiffness.fe2d.ring import quadratic_shapes
from tribodyn.stiffness.fe2d.tooth_mesh import SectorMesh, numbered_sector, with_middles
from tribodyn.stiffness.fe3d.bevel_tooth import BevelTooth
from tribodyn.stiffness.fe3d.sections import SolidMatrices, condensed, elasticity
from tribodyn.stiffness.fe3d.sector import node_freedoms, turned_stiffness
from tribodyn.types import Array, Index

#: Share of the thickness that the layer under the flank may take.
_THINNEST = 0.4
#: Largest share of the root radius at the toe that the body takes.
_BODY_SHARE = 0.6


@dataclass(frozen=True)
class BevelSize:
    """Numbers of the elements of a tooth, and lengths over the mean normal module.

    Parameters
    ----------
    face : int
        Elements along the face.
    height : int
        Elements over the flank, in addition to one over each upper fillet.
    thickness : int
        Elements below the layer under the loaded flank.
    root : int
        Elements over half a root.
    body : int
        Elements over the depth of the body, which grow by half each.
    layer : float [-]
        Thickness of the layer under the loaded flank, at whose bottom displacements are taken.
    depth : float [-]
        Depth of the body below the root cone; its bottom is held.
    fillet : float [-]
        Largest radius of the fillets; it is less where the root is narrow.
    """

    face: int = 10
    height: int = 5
    thickness: int = 3
    root: int = 2
    body: int = 3
    layer: float = 0.4
    depth: float = 2.7
    fillet: float = 0.3


@dataclass(frozen=True, eq=False)
class BevelSector:
    """Sector of one tooth, lengths in mean normal modules; Young's modulus one."""

    tooth: BevelTooth
    poissons_ratio: float
    size: BevelSize

    @property
    def count(self) -> int:
        """Number of sectors of the ring."""
        return self.tooth.count

    waves, load_square = 0, 1.0

    @cached_property
    def along(self) -> Array:
        """Places of the sections of nodes along the pitch cone."""
        return np.linspace(*self.tooth.cone.ends, 2 * self.size.face + 1)

    @cached_property
    def depth(self) -> float:
        """Depth of the body below the root cone."""
        cone, toe = self.tooth.cone, self.along[:1]
        radius = cone.at(toe, cone.height(cone.root, toe))[0][0]
        most = _BODY_SHARE * float(radius) / math.cos(cone.pitch)
        return min(self.size.depth, most)

    @cached_property
    def _corners(self) -> tuple[Array, Array]:
        return self.tooth.fillets(self.along, self.size.fillet)

    @cached_property
    def up(self) -> Array:
        """Places up (stations, rows) of the nodes of the loaded flank, from tip to fillet."""
        tip = self.tooth.cone.height(self.tooth.cone.tip, self.along)
        low = self._corners[0][:, :, 0, 1]
        share = np.linspace(0.0, 1.0, 2 * self.size.height + 1)
        return np.asarray(tip[:, None] + share * (low.max(axis=0) - tip)[:, None])

    @cached_property
    def layer(self) -> Array:
        """Thickness (stations, rows) of the layer under the nodes of the loaded flank."""
        along = np.broadcast_to(self.along[:, None], self.up.shape)
        loaded, other = (fit(along, self.up) for fit in self.tooth.fits)
        thickness = (other - loaded) * self._per_angle
        return np.asarray(np.minimum(self.size.layer, _THINNEST * thickness))

    @cached_property
    def normals(self) -> Array:
        """Unit normals (stations, rows, 3) of the loaded flank into the tooth."""
        along = np.broadcast_to(self.along[:, None], self.up.shape)
        tangents = self.tooth.tangents(along, self.up)
        normal = np.cross(tangents[..., 0], tangents[..., 1])
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        inwards = np.sum(normal * self._around, axis=-1, keepdims=True)
        return np.asarray(normal * np.sign(inwards))

    @cached_property
    def _around(self) -> Array:
        """Unit vectors around the axis at the nodes of the loaded flank."""
        along = np.broadcast_to(self.along[:, None], self.up.shape)
        angle = self.tooth.fits[0](along, self.up)
        return np.stack([-np.sin(angle), np.cos(angle), np.zeros_like(angle)], axis=-1)

    @cached_property
    def _per_angle(self) -> Array:
        """Depth under the loaded flank per angle."""
        radius = self.tooth.cone.at(self.along[:, None], self.up)[0]
        return np.asarray(radius * np.sum(self.normals * self._around, axis=-1))

    def _arcs(self, share: Array) -> Array:
        """Points (sides, stations, share, 2) of the fillets, from flank to root."""
        (corners, cosine), t = self._corners, share[:, None]
        weights = (1.0 - t) ** 2, 2.0 * t * (1.0 - t), t**2
        middle = cosine[..., None, None]
        top = sum(
            weight * corners[:, :, None, k] * (middle if k == 1 else 1.0)
            for k, weight in enumerate(weights)
        )
        return np.asarray(top / (weights[0] + weights[1] * middle + weights[2]))

    def _sections(self) -> tuple[Array, Array]:
        """Grids (stations, columns, rows, 2) of (angle, up) of the tooth and of the body."""
        size, stations = self.size, self.along.size
        along = np.broadcast_to(self.along[:, None], self.up.shape)
        flanks = [np.stack([fit(along, self.up), self.up], axis=-1) for fit in self.tooth.fits]
        # Rows of both flanks are equally high, down to where the upper one of the fillets begins.
        upper = self._arcs(np.array([0.25, 0.5]))
        right, left = (
            np.concatenate([flank, arc], axis=1) for flank, arc in zip(flanks, upper, strict=True)
        )
        across = with_middles(np.linspace(0.0, 1.0, size.thickness + 1))
        first = np.zeros((stations, right.shape[1]))
        first[:, : self.up.shape[1]] = self.layer / self._per_angle
        first[:, self.up.shape[1] :] = first[:, self.up.shape[1] - 1 : self.up.shape[1]]
        inner = right + np.stack([first, np.zeros_like(first)], axis=-1)
        layer = 0.5 * (right + inner)
        inner_nodes = inner[:, None] + across[:, None, None] * (left - inner)[:, None]
        tooth = np.concatenate([right[:, None], layer[:, None], inner_nodes], axis=1)
        top = np.concatenate([self._root(0), tooth[:, :, -1], self._root(1)], axis=1)
        steps = np.cumsum(np.concatenate([[0.0], 1.5 ** np.arange(size.body)]))
        levels = with_middles(steps / steps[-1])
        bottom = self.tooth.cone.height(self.tooth.cone.root, self.along) - self.depth
        body = np.repeat(top[:, :, None], levels.size, axis=2)
        body[..., 1] += levels * (bottom[:, None, None] - top[:, :, None, 1])
        return tooth, body

    def _root(self, side: int) -> Array:
        """Nodes of half a root without the foot of the tooth, in the order of the angle."""
        ends = self._corners[0][:, :, 2]
        cut = 0.5 * (ends[1, :, 0] - self.tooth.pitch + ends[0, :, 0])
        cut = cut if side == 0 else cut + self.tooth.pitch
        count = 2 * self.size.root
        arc = self._arcs(np.linspace(0.5, 1.0, 33))[side]
        land = np.stack([cut, ends[side, :, 1]], axis=-1)
        curve = np.concatenate([arc, land[:, None]], axis=1)
        scale = self.tooth.cone.at(self.along, ends[side, :, 1])[0]
        steps = np.diff(curve, axis=1) * np.stack([scale, np.ones_like(scale)], axis=-1)[:, None]
        length = np.cumsum(np.linalg.norm(steps, axis=-1), axis=1)
        length = np.concatenate([np.zeros((len(length), 1)), length], axis=1)
        share = np.linspace(0.0, 1.0, count + 1)[1:]
        nodes = np.stack(
            [
                np.stack([np.interp(share * s[-1], s, c[:, k]) for k in (0, 1)], axis=-1)
                for s, c in zip(length, curve, strict=True)
            ]
        )
        return nodes[:, ::-1] if side == 0 else nodes

    @cached_property
    def mesh(self) -> tuple[SectorMesh, Array]:
        """Elements of the sections, which are the same all along the face, and nodes (s, n, 3)."""
        tooth, body = self._sections()
        rows = np.arange(tooth.shape[2], dtype=float)
        sections = [
            numbered_sector(self.count, 1, *grids, rows) for grids in zip(tooth, body, strict=True)
        ]
        nodes = np.stack([section.nodes for section in sections])
        points = self.tooth.points(self.along[:, None], nodes[..., 1], nodes[..., 0])
        return sections[0], points

    @cached_property
    def flank(self) -> Index:
        """Nodes (stations, rows) of the loaded flank."""
        return self._at(self.mesh[0].tooth[0, : self.up.shape[1]])

    @cached_property
    def bottom(self) -> Index:
        """Nodes (stations, rows) of the bottom of the layer under the loaded flank."""
        return self._at(self.mesh[0].tooth[2, : self.up.shape[1]])

    def _at(self, nodes: Index) -> Index:
        """Nodes of a section at all stations (stations, n)."""
        section, points = self.mesh
        return np.asarray(len(section.nodes) * np.arange(len(points))[:, None] + nodes)

    @property
    def loaded_freedoms(self) -> int:
        """Number of nodes of the loaded flank and of the bottom of its layer."""
        return 2 * self.flank.size

    @cached_property
    def border(self) -> tuple[Index, Index, Index]:
        """Nodes of the right and left cut; there is no ring below."""
        section = self.mesh[0]
        cuts = [self._at(nodes).ravel() for nodes in (section.right_cut, section.left_cut)]
        return cuts[0], cuts[1], np.zeros(0, dtype=int)

    @property
    def border_points(self) -> Array:
        """Places of the nodes on a ring below: none."""
        return np.zeros((0, 2))

    def ring_stiffness(self, order: int) -> Array:
        """Stiffness of a ring below, which does not exist."""
        raise ValueError(f"no ring lies below the teeth of a hypoid gear (order {order})")

    @cached_property
    def elements(self) -> Index:
        """Nodes (slabs, e, 27) of the elements."""
        section = self.mesh[0]
        return stacked_elements(section.elements, len(section.nodes), self.size.face)

    def directions(self) -> Array:
        """Directions (n, 3, freedom): polar, on flank and layer those of the flank."""
        points = self.mesh[1].reshape(-1, 3)
        outward = points[:, :2] / np.hypot(points[:, 0], points[:, 1])[:, None]
        turn = np.zeros((len(points), 3, 3))
        turn[:, :2, 0], turn[:, 2, 2] = outward, 1.0
        turn[:, 0, 1], turn[:, 1, 1] = -outward[:, 1], outward[:, 0]
        aside = np.cross(self.normals, [0.0, 0.0, 1.0])
        aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
        local = np.stack([self.normals, aside, np.cross(self.normals, aside)], axis=-1)
        turn[self.flank], turn[self.bottom] = local, local
        return turn

    def condensed(self) -> Array:
        """Stiffness (f, 1, f, 1) of flank and layer in the normal direction, and of the cuts."""
        points, elements = self.mesh[1].reshape(-1, 3), self.elements.reshape(-1, 27)
        stress = elasticity(self.poissons_ratio)
        stiffness = hexahedra_stiffness(points[elements], stress)
        stiffness = turned_stiffness(stiffness, self.directions()[elements])
        freedoms = node_freedoms(elements)
        fixed = np.isin(elements, self._at(self.mesh[0].fixed))
        freedoms[np.repeat(fixed, 3, axis=1)] = -1
        groups = np.arange(len(elements)).reshape(self.size.face, -1)
        retained = np.concatenate(
            [
                3 * self.flank.ravel(),
                3 * self.bottom.ravel(),
                *map(node_freedoms, self.border[:2]),
            ],
            axis=None,
        )
        return condensed(freedoms, SolidMatrices(stiffness), list(groups), retained, None)


_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(3)


def stacked_elements(section: Index, layer: int, count: int) -> Index:
    """Elements (count, e, 27) from those of one section (e, 9), ``layer`` nodes per section."""
    first = 2 * layer * np.arange(count)[:, None, None, None]
    nodes = first + layer * np.arange(3)[:, None] + section[:, None, :]
    return np.asarray(nodes.reshape(count, len(section), 27))


def _shapes() -> tuple[Array, Array]:
    """Slopes (g, 3, 27) of the shape functions at the Gauss points, and the weights."""
    value, slope = quadratic_shapes(_PLACES)
    slopes = [
        np.einsum("pa,qb,rc->pqrabc", *(slope if k == axis else value for k in range(3)))
        for axis in range(3)
    ]
    weights = np.einsum("p,q,r->pqr", _WEIGHTS, _WEIGHTS, _WEIGHTS)
    return np.stack([each.reshape(27, 27) for each in slopes], axis=1), weights.ravel()


def hexahedra_stiffness(corners: Array, stress: Array) -> Array:
    """Stiffness (e, 81, 81) of elements with nodes (e, 27, 3), the last direction fastest."""
    local, weights = _shapes()
    jacobian = np.einsum("gdn,enx->egdx", local, corners)
    determinant = np.linalg.det(jacobian)
    if determinant.min() * determinant.max() <= 0.0:
        raise ComputationError(
            "the finite element mesh of the tooth has an element that is turned inside out",
            why="Flanks, fillets and body of this tooth do not fit into the mesh",
            remedy='Choose the stiffness model "line", which has one for the contact line',
        )
    slopes = np.linalg.solve(jacobian, np.broadcast_to(local, (*jacobian.shape[:2], 3, 27)))
    slopes = slopes * np.sqrt(np.abs(determinant) * weights)[..., None, None]
    strain = np.zeros((*slopes.shape[:2], 6, 27, 3))
    for axis in range(3):
        strain[..., axis, :, axis] = slopes[..., axis, :]
    for row, (first, second) in enumerate(((1, 2), (0, 2), (0, 1)), start=3):
        strain[..., row, :, first] = slopes[..., second, :]
        strain[..., row, :, second] = slopes[..., first, :]
    rows = strain.reshape(len(corners), -1, 81)
    stressed = (stress @ strain.reshape(*slopes.shape[:2], 6, 81)).reshape(rows.shape)
    return np.asarray(np.swapaxes(rows, 1, 2) @ stressed)
