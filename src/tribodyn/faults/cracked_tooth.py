"""Compliance that a root crack adds to a tooth, by finite elements with an open seam."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from tribodyn.errors import Argument, InputError, require_between
from tribodyn.gear import Material, SpurGear
from tribodyn.nomenclature import require_number
from tribodyn.stiffness.fe2d.flank_load import flank_loads
from tribodyn.stiffness.fe2d.provider import held_radius
from tribodyn.stiffness.fe2d.ring import (
    assembled,
    plain_stiffness,
    plane_freedoms,
    plane_stress,
    symmetric_factors,
)
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, SectorMesh, ToothSide, tooth_mesh
from tribodyn.types import Array, Index

#: Places along the flank.
_PLACES = 13
#: Part of the tooth thickness beyond which what is left would bend plastically.
_DEEPEST = 0.8
#: Part of the depth from the root to the bore, or its substitute, that a crack may reach.
_LOWEST = 0.5
#: Refinement of the mesh of a whole gear: the tip of the crack needs small elements.
_REFINED = 2.0
_FINE = MeshSize().refined(_REFINED)
#: Size of the elements at the surface, of which the depth of a shallow crack is this multiple.
_OVER_CRACK = 4.0
#: Angles of a crack to the centre line of its tooth: into the body, and square to the tooth.
STEEPEST, SQUARE = math.radians(45.0), 0.5 * math.pi
#: Limits of the tangent of any fillet to the centre line: before it is 45 deg steep over the circle
#: the foot begins, and of undercut teeth it leans the other way at the involute.
LEAST_TANGENT, GREATEST_TANGENT = math.radians(-45.0), math.radians(45.0)
#: Points at which the tangent of the fillet is tabulated.
_TANGENTS = 401


@dataclass(frozen=True)
class CrackLine:
    """Straight line of a crack from the surface of the root to its tip."""

    depth: float  #: length from the surface to the tip [m]
    angle: float = SQUARE  #: to the centre line of the tooth; smaller runs into the body [rad]
    root_tangent: float | None = None  #: of the fillet where it begins, to the centre line [rad]

    def start(self, gear: SpurGear) -> float:
        """Length along the flank where the crack begins [modules]."""
        side = ToothSide(gear)
        foot = side.form_length - side.foot_length
        if self.root_tangent is None:
            return foot
        length = np.linspace(side.form_length, foot, _TANGENTS)
        step = np.diff(side.flank_points(length), axis=0)
        tangent = np.arctan2(step[:, 0], -step[:, 1])
        if not tangent[0] <= self.root_tangent <= tangent[-1]:
            low = math.ceil(100.0 * math.degrees(tangent[0])) / 100.0
            high = math.floor(100.0 * math.degrees(tangent[-1])) / 100.0
            raise InputError(
                f"root_tangent = {math.degrees(self.root_tangent):.4g} deg",
                Argument("root_tangent"),
                f"The fillet of this tooth has tangents of {low:.2f} to {high:.2f} deg to the "
                "centre line between the involute and the foot, where it is 45 deg steep over the "
                "circle",
                "Give an angle between them; the critical section of ISO 6336-3 has 30 deg",
            )
        return float(np.interp(self.root_tangent, tangent, 0.5 * (length[1:] + length[:-1])))

    def check(self, gear: SpurGear) -> None:
        """Raise InputError if the line leaves too little of the tooth, or of the body below it."""
        require_number("angle", self.angle)
        require_between("angle", self.angle, STEEPEST, SQUARE, "rad", remedy="Give 45 to 90 deg")
        module = gear.normal_module
        x, y = ToothSide(gear).flank_points(np.array(self.start(gear))) * module
        thickness = 2.0 * math.hypot(x, y) * math.atan2(x, y)
        limit = _DEEPEST * thickness / math.sin(self.angle)
        why = f"The tooth is {1e3 * thickness:.4g} mm thick where the crack begins, of which at "
        why += "least a fifth has to be left"
        below = _LOWEST * (gear.root_radius - held_radius(gear)) / max(math.cos(self.angle), 1e-9)
        if below < limit:
            limit, why = below, "Half of the body under the root has to be left"
        if self.depth > limit:
            what, remedy = f"depth = {1e3 * self.depth:.4g} mm", f"at most {1e3 * limit:.3g} mm"
            raise InputError(what, Argument("depth"), why, f"Give a depth of {remedy}")


def crack_compliance(
    gear: SpurGear,
    material: Material,
    depth: float,
    *,
    angle: float = SQUARE,
    root_tangent: float | None = None,
    refined: float = _REFINED,
) -> tuple[Array, Array]:
    """Compliance per face width that a root crack adds under a load on the flank.

    Parameters
    ----------
    gear, material : SpurGear, Material
        External gear and its material.
    depth : float
        Length of the crack from the surface to its tip [m].
    angle : float
        Angle of the crack to the centre line of the tooth [rad], from pi/4, into the body, to pi/2,
        square to the tooth.
    root_tangent : float, optional
        Angle of the tangent of the fillet to the centre line where the crack begins [rad], within
        that of the involute above and of the foot below. By default it begins at the foot, where
        the fillet is 45 deg steep over the circle; its lower end is lower still.
    refined : float
        Size of the elements of whole gears over that of these [1].

    Returns
    -------
    radius : (k,) array
        Radius of curvature of the flank at the load [m], ascending.
    compliance : (k,) array
        Displacement along the load over its line load, less that of the sound tooth [m^2/N].

    Raises
    ------
    InputError
        If the crack leaves less than a fifth of the tooth or half of the body, or an angle is out
        of range.

    Notes
    -----
    Plane stress, quadratic quadrilaterals of the whole ring, held at the bore; the sound teeth are
    reduced without loss to the cuts of the cracked one. A row of element edges is moved onto the
    crack with the mesh around it, and its nodes are doubled up to the tip, at which the middles of
    the edges are at a quarter. Elements at the surface are a quarter of a shallow crack, so that
    its compliance is within 1 % of fracture mechanics. The crack is open, and what it adds at the
    neighbours is left out.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02, bore_diameter=0.03)
    >>> radius, added = crack_compliance(gear, Material(), 1e-3, refined=1.0)
    >>> bool(np.all(added > 0.0))
    True
    """
    line = CrackLine(depth, angle, root_tangent)
    line.check(gear)
    size = MeshSize().refined(refined)
    radius, added = section_compliance(gear, material.poissons_ratio, line, size)
    return radius, added / material.youngs_modulus


@lru_cache(maxsize=64)
def section_compliance(
    gear: SpurGear,
    poissons_ratio: float,
    line: CrackLine,
    size: MeshSize = _FINE,
    graded: bool = True,
) -> tuple[Array, Array]:
    """Compliance of a crack for a Young's modulus of one, on elements that are graded to it."""
    depth = line.depth / gear.normal_module
    refined = (line.start(gear), min(size.flank, depth / _OVER_CRACK)) if graded else None
    mesh, others = _sound_ring(gear, poissons_ratio, size, refined)
    base = gear.base_radius
    low = gear.roll_angle(max(gear.form_radius, base)) * base
    radius = np.linspace(
        max(low, 0.02 * gear.normal_module), gear.roll_angle(gear.tip_radius) * base, _PLACES
    )
    forces = flank_loads(gear, mesh, radius).forces
    added = np.zeros(radius.size)
    for row, weight in crack_rows(gear, mesh, line):
        tooth = open_seam(mesh, row, depth, line.angle, sharp=True)
        sound, cracked = (
            _self_compliance(part, forces, poissons_ratio, others)
            for part in (tooth.sound, tooth.cracked)
        )
        added += weight * tooth.part * (cracked - sound)
    return radius, added


def crack_rows(gear: SpurGear, mesh: SectorMesh, line: CrackLine) -> list[tuple[int, float]]:
    """Rows of element edges between which the crack begins, and their weights."""
    corners = mesh.flank_length[::2]  # falling
    place = np.interp(-line.start(gear), -corners, np.arange(corners.size))
    first = min(int(place), corners.size - 2)
    weights = [(2 * first, first + 1.0 - place), (2 * first + 2, place - first)]
    return [(row, float(weight)) for row, weight in weights if weight > 1e-9]


@dataclass(frozen=True, eq=False)
class CrackedTooth:
    """A meshed tooth with an open seam."""

    sound: SectorMesh  #: with a row of element edges on the crack
    cracked: SectorMesh  #: the same with the nodes of the crack doubled, the second ones last
    seam: Index  #: nodes that are doubled
    tip: int  #: node at the tip of the crack
    part: float  #: compliance of the crack over that of the seam, which is an element at least


def open_seam(
    mesh: SectorMesh, row: int, length: float, angle: float, sharp: bool = False
) -> CrackedTooth:
    """Move a row of element edges onto a crack and open it; lengths in modules."""
    seam = mesh.tooth[:, row]
    reach = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(mesh.nodes[seam], axis=0).T))])
    # The compliance of a shallow crack grows with the square of its depth.
    meshed = max(length, reach[2])
    tip = 2 + 2 * int(np.argmin(np.abs(reach[2:-2:2] - meshed * math.sin(angle))))
    along = (reach[: tip + 1] * (meshed / reach[tip]))[:, None]
    direction = np.array([math.sin(angle), math.cos(angle)])
    shift = np.zeros((seam.size, 2))
    shift[: tip + 1] = mesh.nodes[seam[0]] - along * direction - mesh.nodes[seam[: tip + 1]]
    shift[tip:] = shift[tip] * ((reach[-1] - reach[tip:]) / (reach[-1] - reach[tip]))[:, None]
    sound = _moved(mesh, row, shift)
    if sharp:
        _move_to_quarters(sound, row, tip)
    twins = np.arange(len(mesh.nodes))
    twins[seam[:tip]] = len(mesh.nodes) + np.arange(tip)
    above = np.asarray(np.isin(mesh.elements, mesh.tooth[:, row - 1]).any(axis=1))
    elements = np.where(above[:, None], twins[mesh.elements], mesh.elements)
    nodes = np.concatenate([sound.nodes, sound.nodes[seam[:tip]]])
    cracked = replace(sound, nodes=nodes, elements=elements)
    part = (length / meshed) ** 2
    return CrackedTooth(sound, cracked, seam[:tip], int(seam[tip]), part)


def _moved(mesh: SectorMesh, row: int, shift: Array) -> SectorMesh:
    """Mesh whose row of nodes across the tooth is moved, less towards tip and bore."""
    columns = tooth_columns(mesh)
    place = mesh.nodes[columns]
    reach = np.cumsum(np.hypot(*np.diff(place, axis=1, prepend=place[:, :1]).transpose(2, 0, 1)), 1)
    at, end = reach[:, row, None], reach[:, -1:]
    weight = np.minimum(reach / at, (end - reach) / (end - at))
    nodes = mesh.nodes.copy()
    nodes[columns] += weight[:, :, None] * shift[:, None]
    return replace(mesh, nodes=nodes)


def tooth_columns(mesh: SectorMesh) -> Index:
    """Nodes across the tooth and the body under it, from the tip to the bore."""
    levels = np.arange(mesh.right_cut.size + 1)
    return np.concatenate([mesh.tooth[:, :-1], mesh.tooth[:, -1:] + levels], axis=1)


def _move_to_quarters(mesh: SectorMesh, row: int, tip: int) -> None:
    """Move the middles of the edges that end at the tip of a crack to a quarter (Barsoum)."""
    nodes, grid = mesh.nodes, tooth_columns(mesh)
    for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        end, begin = grid[tip + 2 * a, row + 2 * b], grid[tip, row]
        nodes[grid[tip + a, row + b]] = 0.75 * nodes[begin] + 0.25 * nodes[end]
    for a in (1, -1):
        for b in (1, -1):
            patch = nodes[grid[np.ix_(tip + a * np.arange(3), row + b * np.arange(3))]]
            corners = patch[::2, ::2].sum((0, 1))
            edges = patch[::2, 1].sum(0) + patch[1, ::2].sum(0)
            nodes[grid[tip + a, row + b]] = 0.5 * edges - 0.25 * corners


def _self_compliance(
    mesh: SectorMesh, forces: Array, poissons_ratio: float, others: Array
) -> Array:
    """Work of each load on its own displacement in the ring, for a Young's modulus of one."""
    displacement = ring_displacement(mesh, forces, poissons_ratio, others)
    return np.asarray(np.einsum("ik,ik->k", forces, displacement[: forces.shape[0]]))


def ring_displacement(
    mesh: SectorMesh, forces: Array, poissons_ratio: float, others: Array
) -> Array:
    """Displacement of all nodes of a sector in the ring, for a Young's modulus of one."""
    matrix = plain_stiffness(mesh, plane_stress(1.0, poissons_ratio)).tocsr()
    cuts, turn = _cut_freedoms(mesh)
    block = (turn.T @ others @ turn)[None]
    matrix = matrix + assembled(block, cuts[None], matrix.shape[0]).tocsr()
    free = np.setdiff1d(np.arange(matrix.shape[0]), plane_freedoms(mesh.fixed))
    load = np.zeros((matrix.shape[0], forces.shape[1]))
    load[: forces.shape[0]] = forces
    displacement = np.zeros_like(load)
    displacement[free] = symmetric_factors(matrix[free][:, free]).solve(load[free])
    return displacement


@lru_cache(maxsize=8)
def _sound_ring(
    gear: SpurGear, poissons_ratio: float, size: MeshSize, refined: tuple[float, float] | None
) -> tuple[SectorMesh, Array]:
    """Mesh of a sector, and the stiffness of all others between its right and its left cut."""
    mesh = tooth_mesh(gear, held_radius(gear), size, refined)
    matrix = plain_stiffness(mesh, plane_stress(1.0, poissons_ratio)).tocsr()
    cuts, turn = _cut_freedoms(mesh)
    inner = np.setdiff1d(np.arange(matrix.shape[0]), np.append(cuts, plane_freedoms(mesh.fixed)))
    border = matrix[inner][:, cuts].toarray()
    factors = symmetric_factors(matrix[inner][:, inner])
    sector = turn @ (matrix[cuts][:, cuts].toarray() - border.T @ factors.solve(border)) @ turn.T
    half = cuts.size // 2
    right, left = np.arange(half), np.arange(half, 2 * half)
    chain = sector  # of sectors that follow one another anticlockwise
    for _sector in range(mesh.count - 2):
        middle = np.linalg.inv(chain[np.ix_(left, left)] + sector[np.ix_(right, right)])
        link = np.concatenate([chain[right][:, left], sector[left][:, right]])
        ends = np.zeros_like(chain)
        ends[:half, :half], ends[half:, half:] = chain[:half, :half], sector[half:, half:]
        chain = ends - link @ middle @ link.T
    # its right end is at the left cut
    swap = np.append(left, right)
    return mesh, chain[np.ix_(swap, swap)]


def _cut_freedoms(mesh: SectorMesh) -> tuple[Index, Array]:
    """Freedoms of both cuts, and the matrix that turns them into radial and tangential ones."""
    cuts = np.concatenate([mesh.right_cut, mesh.left_cut])
    x, y = (mesh.nodes[cuts] / np.hypot(*mesh.nodes[cuts].T)[:, None]).T
    turn = np.zeros((cuts.size, 2, cuts.size, 2))
    each = np.arange(cuts.size)
    turn[each, :, each] = np.stack([np.stack([x, y], -1), np.stack([-y, x], -1)], axis=1)
    return plane_freedoms(cuts), turn.reshape(2 * cuts.size, -1)
