"""Compliance that a root crack on a part of the face adds to a tooth, by solid finite elements.

The tooth and its part of the body are slices of the face that are coupled, as in
:mod:`tribodyn.stiffness.fe3d`. The part above the crack moves by the displacement of the part below
and by the opening of the crack, which has functions over the cracked part of the face of its own.
Eliminating it leaves what the crack adds: symmetric, and nothing where there is no crack.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.splines import bspline_slopes, bspline_values, clamped_knots
from tribodyn.compiled import announce, source_digest
from tribodyn.faults.cracked_tooth import (
    SQUARE,
    CrackedTooth,
    CrackLine,
    crack_rows,
    open_seam,
    section_compliance,
)
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.fe2d.provider import looked_up
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize
from tribodyn.stiffness.fe3d.provider import file_name, gear_sector
from tribodyn.stiffness.fe3d.sections import (
    FaceBasis,
    FaceSize,
    SectionMatrices,
    condensed,
    element_matrices,
    eliminated,
    face_basis,
)
from tribodyn.stiffness.fe3d.sector import Sector, SolidSize, node_freedoms, turned_stiffness
from tribodyn.stiffness.teeth.face_influence import FaceInfluence
from tribodyn.types import Array, Index

#: Elements: the body is held two and a half modules below the root.
SIZE = SolidSize(MeshSize(0.2, 0.35, 1.3, 0.8, 0.45, 2), FaceSize(0.3, 1.0), depth=2.5)
#: Modules here on which the numbers depend.
_MODULES = ("cracked_face", "cracked_tooth")
#: Part of the face within which the end of a crack is that of the face, or another end.
_ROUNDING = 1e-9


def crack_influence(
    gear: SpurGear,
    material: Material,
    depth: float,
    ends: tuple[float, float],
    *,
    angle: float = SQUARE,
    root_tangent: float | None = None,
    size: SolidSize = SIZE,
) -> FaceInfluence:
    """Compliance that a root crack on a part of the face adds to its tooth.

    Parameters
    ----------
    gear, material : SpurGear, Material
        External gear, spur or helical, and its material.
    depth : float
        Length of the crack from the surface to its tip in the transverse section [m].
    ends : (float, float)
        Ends of the crack along the face, counted from the end of the face where lines of contact
        are at the tip; of a spur gear from either end [m].
    angle, root_tangent : float, float
        As for :func:`crack_compliance` [rad].
    size : SolidSize
        Sizes of the elements.

    Returns
    -------
    FaceInfluence
        Of the cracked tooth alone, less that of the sound one [m/N].

    Raises
    ------
    InputError
        If the crack leaves too little of the tooth, or an angle is out of range.

    Notes
    -----
    Quadratic quadrilaterals of the transverse section, with quarter points at the tip of the crack,
    times cubic splines over the face; two sound neighbours on each side. The seam follows the
    helix, is as deep over its whole length, and is open. The error that the section has in plane
    stress is taken off: :func:`crack_compliance` has a finer one. Source: Barsoum (1976), quarter
    points.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02, bore_diameter=0.03)
    >>> added = crack_influence(gear, Material(), 1e-3, (0.0, 0.01))
    >>> added.neighbours
    0
    """
    line = CrackLine(depth, angle, root_tangent)
    line.check(gear)
    radius, knots, added = _unit_influence(gear, material.poissons_ratio, line, ends, size)
    stiffness = material.youngs_modulus * gear.normal_module
    return FaceInfluence(radius, knots, added / stiffness, np.zeros((0, *added.shape)))


class _AddedCompliance(NamedTuple):
    """Compliance that a crack adds, for a module and a Young's modulus of one."""

    radius: Array  #: [m]
    knots: Array  #: [m]
    added: Array


@lru_cache(maxsize=32)
def _unit_influence(
    gear: SpurGear,
    poissons_ratio: float,
    line: CrackLine,
    ends: tuple[float, float],
    size: SolidSize,
) -> _AddedCompliance:
    sector = gear_sector(gear, poissons_ratio, size)
    name = file_name(
        sector, gear.normal_module, line, ends, source_digest(Path(__file__).parent, _MODULES)
    )

    def fits(unit: _AddedCompliance) -> bool:
        radii, functions = unit.radius.size, unit.knots.size - 4
        return unit.added.shape == (radii, radii, functions, functions)

    return looked_up(
        _AddedCompliance, name, partial(_computed, sector, line, ends), fits, "cracked"
    )


def _computed(sector: Sector, line: CrackLine, ends: tuple[float, float]) -> _AddedCompliance:
    gear, poissons_ratio = sector.form, sector.poissons_ratio
    announce(
        "computing the compliance of a cracked tooth over its face, once on this machine, 3 to 30 "
        "seconds"
    )
    module, knots, added = gear.normal_module, np.empty(0), np.zeros(1)
    for row, weight in crack_rows(gear, sector.mesh, line):
        tooth = open_seam(sector.mesh, row, line.depth / module, line.angle, sharp=True)
        model = _CrackedSector(sector, tooth, row, np.array(ends) / module)
        knots = model.face.knots * module
        added = added + weight * tooth.part * model.added_compliance()
    radius = sector.curvature_radius(sector.flank_length) * module
    places, fine = section_compliance(gear, poissons_ratio, line)
    coarse = section_compliance(gear, poissons_ratio, line, sector.size.section, graded=False)[1]
    factor = np.sqrt(np.interp(radius, places, fine / coarse))[:, None, None, None]
    return _AddedCompliance(radius, knots, added * factor * factor.transpose(1, 0, 2, 3))


@dataclass(frozen=True, eq=False)
class _CrackedSector:
    """Sector of one tooth with a crack between its sound neighbours, lengths in modules."""

    sector: Sector
    tooth: CrackedTooth
    row: int  #: row of nodes across the tooth on the crack
    ends: Array  #: of the crack along the face

    @cached_property
    def breaks(self) -> Array:
        """Ends of the elements over the face, closer together at the ends of the crack."""
        width, size = self.sector.width, self.sector.size.face
        within = self.ends[(self.ends > _ROUNDING * width) & (self.ends < (1 - _ROUNDING) * width)]
        cuts = [0.0, *within, width]
        return np.unique(np.concatenate([a + size.breaks(b - a) for a, b in pairwise(cuts)]))

    @cached_property
    def face(self) -> FaceBasis:
        """Functions of the displacement over the face."""
        return face_basis(self.breaks)

    @cached_property
    def _elements(self) -> tuple[SectionMatrices, Index]:
        """Matrices of all elements and their freedoms."""
        mesh, sector = self.tooth.sound, self.sector
        matrices = element_matrices(mesh.nodes[mesh.elements], sector.twist, sector.stress)
        turn = sector.directions()[mesh.elements]
        freedoms = node_freedoms(mesh.elements)
        freedoms[np.repeat(np.isin(mesh.elements, mesh.fixed), 3, axis=1)] = -1
        return SectionMatrices(*(turned_stiffness(part, turn) for part in matrices)), freedoms

    def _condensed(self, groups: list[Index], retained: Index) -> _Part:
        """Stiffness of some rows of elements."""
        matrices, freedoms = self._elements
        rows = np.concatenate(groups)
        ends = np.cumsum([group.size for group in groups])
        parts = SectionMatrices(*(matrix[rows] for matrix in matrices))
        steps = np.split(np.arange(rows.size), ends[:-1])
        return _Part(retained, condensed(freedoms[rows], parts, steps, retained, self.face))

    def added_compliance(self) -> Array:
        """Compliance (f, f, z, z) between the loaded places that the crack adds."""
        mesh, sector = self.tooth.sound, self.sector
        groups, loads = sector.groups(), 3 * sector.flank
        above, z = self.row // 2 - 1, self.face.count  # row of elements above the seam
        upper, seam = (node_freedoms(mesh.tooth[:, row]) for row in (self.row - 2, self.row))
        matrices, freedoms = self._elements
        in_top = loads[np.isin(loads, freedoms[np.concatenate(groups[:above])])]
        top = self._condensed(groups[:above], np.union1d(in_top, upper))
        section = _Section.of_elements(matrices, freedoms, groups[above])
        row = _Part(section.freedoms, section.matrices.of_solid(self.face))
        inner = np.setdiff1d(np.union1d(top.freedoms, row.freedoms), seam)
        cuts = node_freedoms(np.stack([mesh.right_cut, mesh.left_cut])).reshape(2, -1)
        base = self._condensed(groups[above + 1 :], np.concatenate([seam.ravel(), *cuts]))
        free = _without([top, row], inner, seam.ravel())
        neighbours = _neighbours(_without([free, base], seam.ravel(), cuts.ravel()), cuts)
        foot = _without([base, neighbours], cuts.ravel(), seam.ravel())
        unknowns = np.concatenate([loads, np.setdiff1d(inner, loads), seam.ravel()])
        full = _sum([top, row, foot], unknowns).reshape(unknowns.size * z, -1)
        coupling, opening = self._opening(section, unknowns)
        return self._eliminated(full, coupling, opening)

    def _eliminated(self, full: Array, coupling: Array, opening: Array) -> Array:
        """Compliance of the loads after the opening of the crack is eliminated."""
        from scipy.linalg import cho_factor, cho_solve

        loads, z = self.sector.flank.size, self.face.count
        moved = cho_solve(cho_factor(full, check_finite=False), coupling, check_finite=False)
        stiffness = opening - coupling.T @ moved
        root = np.linalg.cholesky(0.5 * (stiffness + stiffness.T))
        half = np.linalg.solve(root, moved[: loads * z].T)
        added = self.sector.load_square * (half.T @ half).reshape(loads, z, loads, z)
        return np.asarray(added.transpose(0, 2, 1, 3))

    def _opening(self, section: _Section, unknowns: Index) -> tuple[Array, Array]:
        """Stiffness (u z, d) between displacements and opening, and (d, d) of the opening."""
        every = _functions(self.breaks, slice(None), self.breaks)
        start, end = self.ends
        slack = _ROUNDING * self.sector.width
        cracked = self.breaks[(self.breaks > start - slack) & (self.breaks < end + slack)]
        # zero at the ends within the tooth
        open_ends = slice(
            0 if start < slack else 1, None if end > self.sector.width - slack else -1
        )
        opening = _functions(cracked, open_ends, self.breaks)
        seam = node_freedoms(self.tooth.seam).ravel()
        coupling = section.between(section.freedoms, seam, every, opening)
        rows = np.zeros((unknowns.size, *coupling.shape[1:]))
        rows[_places(unknowns, section.freedoms)] = coupling
        stiffness = section.between(seam, seam, opening, opening)
        size = stiffness.shape[-1]
        return rows.reshape(-1, size), stiffness.reshape(-1, size)


class _Part(NamedTuple):
    """Stiffness (f, z, f, z) of some freedoms of the section."""

    freedoms: Index
    stiffness: Array


class _Functions(NamedTuple):
    """Functions (g, n) over the face at weighted points, and their slopes."""

    value: Array
    slope: Array


class _Section(NamedTuple):
    """Matrices of a row of elements."""

    freedoms: Index  #: rising
    matrices: SectionMatrices

    @classmethod
    def of_elements(cls, matrices: SectionMatrices, freedoms: Index, row: Index) -> _Section:
        """Sum of the elements of a row."""
        members = np.unique(freedoms[row])
        at = np.searchsorted(members, freedoms[row])
        sums = [np.zeros((members.size, members.size)) for _ in matrices]
        for total, matrix in zip(sums, matrices, strict=True):
            np.add.at(total, (at[:, :, None], at[:, None, :]), matrix[row])
        return cls(members, SectionMatrices(*sums))

    def between(self, rows: Index, columns: Index, first: _Functions, second: _Functions) -> Array:
        """Stiffness (rows, n, columns m) of freedoms with functions over the face."""
        parts = self.matrices
        rows, columns = (_places(self.freedoms, freedoms) for freedoms in (rows, columns))
        at, turned = np.ix_(rows, columns), np.ix_(columns, rows)
        total = sum(
            part[:, None, :, None] * (left.T @ right)[None, :, None, :]
            for part, left, right in (
                (parts.none[at], first.value, second.value),
                (parts.single[at], first.value, second.slope),
                (parts.single[turned].T, first.slope, second.value),
                (parts.double[at], first.slope, second.slope),
            )
        )
        return np.asarray(total).reshape(rows.size, first.value.shape[1], -1)


def _functions(breaks: Array, columns: slice, elements: Array) -> _Functions:
    """Some of the splines on breakpoints, which are ends of elements of the face too."""
    place, weight = np.polynomial.legendre.leggauss(4)
    half = 0.5 * np.diff(elements)[:, None]
    points, weights = (elements[:-1, None] + half * (1.0 + place)).ravel(), (half * weight).ravel()
    inside = (points > breaks[0]) & (points < breaks[-1])
    root = np.sqrt(np.where(inside, weights, 0.0))[:, None]
    knots = clamped_knots(breaks)
    return _Functions(
        *(root * of(knots, points)[:, columns] for of in (bspline_values, bspline_slopes))
    )


def _places(freedoms: Index, some: Index) -> Index:
    """Places of some freedoms among others."""
    order = np.argsort(freedoms)
    return np.asarray(order[np.searchsorted(freedoms, some, sorter=order)])


def _sum(parts: Sequence[_Part], unknowns: Index) -> Array:
    """Stiffness (f, z, f, z) of joined parts."""
    z = parts[0].stiffness.shape[1]
    total = np.zeros((unknowns.size, z, unknowns.size, z))
    for part in parts:
        at = _places(unknowns, part.freedoms)
        total[at[:, None], :, at[None, :], :] += part.stiffness.transpose(0, 2, 1, 3)
    return total


def _without(parts: Sequence[_Part], free: Index, retained: Index) -> _Part:
    """Joined parts with some freedoms free of loads."""
    z = parts[0].stiffness.shape[1]
    total = _sum(parts, np.concatenate([free, retained]))
    flat = eliminated(total.reshape(total.shape[0] * z, -1), free.size * z)
    return _Part(retained, flat.reshape(retained.size, z, retained.size, z))


def _neighbours(sector: _Part, cuts: Index) -> _Part:
    """Stiffness of two sound neighbours on each side at the cuts (right, left)."""
    middle = cuts.max() + 1 + np.arange(cuts.shape[1])
    right, left = cuts
    first = sector._replace(freedoms=np.concatenate([right, middle]))
    second = sector._replace(freedoms=np.concatenate([middle, left]))
    chain = _without([first, second], middle, np.concatenate([right, left]))
    sides = [_without([chain], *ends) for ends in ((right, left), (left, right))]
    # the left end of a chain joins the right cut of the cracked sector, and the other way round
    joined = [side._replace(freedoms=cut) for side, cut in zip(sides, (right, left), strict=True)]
    return _Part(np.concatenate([right, left]), _sum(joined, np.concatenate([right, left])))
