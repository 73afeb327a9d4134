"""Root stress along the face under a load at one place of flank and face.

A tooth with its part of the body is held at its cuts. The stress across the line of the root, where
it is greatest along the fillet, is taken over that of a plane section, and over the same ratio of a
straight tooth under an even load: an even load on a straight tooth stresses the root as in a plane
section. The size of the elements hardly matters to these ratios: plane elements resolve the notch,
these the face.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.splines import bspline_slopes, bspline_values
from tribodyn.compiled import source_digest
from tribodyn.gear import SpurGear
from tribodyn.stiffness.fe2d.provider import looked_up
from tribodyn.stiffness.fe2d.ring import quadratic_shapes
from tribodyn.stiffness.fe2d.root_stress import fillet_nodes
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, ToothSide
from tribodyn.stiffness.fe3d.provider import file_name, gear_sector
from tribodyn.stiffness.fe3d.sections import (
    FaceBasis,
    FaceSize,
    SectionMatrices,
    condensed,
    element_matrices,
)
from tribodyn.stiffness.fe3d.sector import Sector, SolidSize, node_freedoms, turned_stiffness
from tribodyn.types import Array, Index

#: Elements of the tooth: three or four along the fillet.
SIZE = SolidSize(section=MeshSize(0.25, 0.25, 1.4, 0.8, 0.45, 3), face=FaceSize(end=0.4))
#: Power of the plane stress in the mean along the fillet, which counts where it is greatest.
_PEAK = 8
#: Points over a slice of the face.
_POINTS = 4


class RootSpread(NamedTuple):
    """Stress of the root along the face under loads at places of it, lengths in modules."""

    curvature_radius: Array  #: loaded places of the flank (places,) in the transverse section
    knots: Array  #: of the functions over the face
    stress: Array  #: over that of an even load (places, functions of the stress, of the load)

    def between(self, slices: int, width: float) -> Array:
        """Part (places, stressed, loaded) that slices of the middle of the face feel of loads."""
        middle = 0.5 * (self.knots[0] + self.knots[-1])
        edges = np.linspace(middle - 0.5 * width, middle + 0.5 * width, slices + 1)
        points = edges[:-1, None] + (width / slices) * (np.arange(_POINTS) + 0.5) / _POINTS
        loads = bspline_values(self.knots, points.ravel()).reshape(slices, _POINTS, -1).mean(axis=1)
        stressed = bspline_values(self.knots, 0.5 * (edges[1:] + edges[:-1]))
        return np.asarray((width / slices) * (stressed @ self.stress @ loads.T))

    def at_radii(self, radius: Array, width: float) -> Array:
        """Part (n, stressed, loaded) for slices that are loaded at radii (n, slices)."""
        order = np.argsort(self.curvature_radius)
        places, table = self.curvature_radius[order], self.between(radius.shape[1], width)[order]
        inside = np.clip(radius, places[0], places[-1])
        below = np.clip(np.searchsorted(places, inside) - 1, 0, places.size - 2)
        share = ((inside - places[below]) / (places[below + 1] - places[below]))[:, None, :]
        columns = np.arange(radius.shape[1])
        first, second = (table[at, :, columns].swapaxes(1, 2) for at in (below, below + 1))
        return np.asarray((1.0 - share) * first + share * second)


def _displacements(sector: Sector, fillet: Index, face: FaceBasis) -> Array:
    """Displacement (nodes, 3, z, places, z) of fillet nodes under unit loads on the flank."""
    mesh = sector.mesh
    matrices = element_matrices(mesh.nodes[mesh.elements], sector.twist, sector.stress)
    turn = sector.directions()
    parts = SectionMatrices(*(turned_stiffness(m, turn[mesh.elements]) for m in matrices))
    freedoms = node_freedoms(mesh.elements)
    fixed = np.concatenate([mesh.right_cut, mesh.left_cut, mesh.fixed])
    freedoms[np.repeat(np.isin(mesh.elements, fixed), 3, axis=1)] = -1
    free = fillet[~np.isin(fillet, fixed) & ~np.isin(fillet, sector.flank)]
    retained = np.concatenate([3 * sector.flank, node_freedoms(free).ravel()])
    stiffness = condensed(freedoms, parts, sector.groups(), retained, face)
    size, places = retained.size * face.count, sector.flank.size
    loads = np.eye(size)[:, : places * face.count]
    scale = np.sqrt(sector.load_square)
    moved = scale * np.linalg.solve(stiffness.reshape(size, size), loads)
    moved = moved.reshape(retained.size, face.count, places, face.count)
    result = np.zeros((fillet.size, 3, *moved.shape[1:]))
    result[np.isin(fillet, free)] = moved[places:].reshape(free.size, 3, *moved.shape[1:])
    return result


def _stress(sector: Sector, line: Index, moved: Array, face: tuple[Array, Array]) -> Array:
    """Stress (points, z, places, loads) across the line of the root at the middle of edges."""
    values, slopes = quadratic_shapes(np.zeros(1))
    edges = np.arange(0, line.size - 2, 2)[:, None] + np.arange(3)
    nodes, twist = sector.mesh.nodes[line[edges]], sector.twist
    tangent, place = slopes[0] @ nodes, values[0] @ nodes
    each = moved[edges]  # (edges, 3 nodes, 3, functions, places, loads)
    value, slope = face
    along = np.einsum("a,eaxfpl,zf->exzpl", slopes[0], each, value, optimize=True)
    middle = np.einsum("a,eaxfpl->exfpl", values[0], each)
    over_face = np.einsum("exfpl,zf->exzpl", middle, slope)
    turned = np.einsum("exfpl,zf->exzpl", middle, value)
    over_face[:, 0] -= twist * turned[:, 1]
    over_face[:, 1] += twist * turned[:, 0]
    flat = np.zeros(len(place))
    lead = np.stack([-twist * place[:, 1], twist * place[:, 0], flat + 1.0], axis=1)
    tangent = np.concatenate([tangent, flat[:, None]], axis=1)
    length = np.linalg.norm(lead, axis=1)
    slide = np.einsum("ex,ex->e", tangent, lead) / length
    across = np.sqrt(np.einsum("ex,ex->e", tangent, tangent) - slide**2)
    # strains along the curves of the surface, then along the root line and across it
    first = np.einsum("ex,exzpl->ezpl", tangent, along)
    sheared = np.einsum("ex,exzpl->ezpl", tangent, over_face) + np.einsum(
        "ex,exzpl->ezpl", lead, along
    )
    second = np.einsum("ex,exzpl->ezpl", lead, over_face)
    shape = (-1, 1, 1, 1)
    length, slide, across = (each.reshape(shape) for each in (length, slide, across))
    root = second / length**2
    shear = (0.5 * sheared / length - slide * root) / across
    normal = (first - slide**2 * root - 2.0 * slide * across * shear) / across**2
    nu = sector.poissons_ratio
    return np.asarray((normal + nu * root) / (1.0 - nu**2))


def _over_plane(sector: Sector, line: Index, points: Array) -> Array:
    """Stress (places, points, loads) at points of the face over that of a plane section."""
    face, unit = sector.face, np.ones((1, 1))
    even = FaceBasis(face.knots, unit, 0.0 * unit, 0.0 * unit)  # along the helix
    plane = _stress(sector, line, _displacements(sector, line, even), (unit, 0.0 * unit))[
        :, 0, :, 0
    ]
    functions = bspline_values(face.knots, points), bspline_slopes(face.knots, points)
    stress = _stress(sector, line, _displacements(sector, line, face), functions)
    length = np.hypot(*np.diff(sector.mesh.nodes[line[::2]], axis=0).T)
    weight = length * np.maximum(plane.sum(axis=1), 0.0) ** _PEAK
    greatest = np.einsum("e,ezpl->pzl", weight, stress)
    return np.asarray(greatest / (weight @ plane)[:, None, None])


def computed_spread(sector: Sector) -> RootSpread:
    """Spread of a gear whose sector is known."""
    line, face = fillet_nodes(sector.mesh, ToothSide(sector.form)), sector.face
    points = np.array([face.knots[i + 1 : i + 4].mean() for i in range(face.count)])  # of Greville
    stress = _over_plane(sector, line, points)
    straight = stress
    if sector.twist:
        straight = _over_plane(replace(sector, twist=0.0), line, points)
    stress = stress / (straight @ face.mass.sum(axis=1))[:, :, None]
    functions = bspline_values(face.knots, points)
    radius = sector.curvature_radius(sector.flank_length)
    return RootSpread(radius, face.knots, np.linalg.solve(functions, stress))


def root_spread(gear: SpurGear, poissons_ratio: float) -> RootSpread:
    """Spread of the root stress of a gear along its face, stored on disk."""
    sector = gear_sector(gear, poissons_ratio, SIZE)
    name = file_name(sector, source_digest(Path(__file__).parent, ["root_spread"]))
    return looked_up(RootSpread, name, lambda: computed_spread(sector), method="spread")
