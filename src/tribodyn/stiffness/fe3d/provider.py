"""Influence of one gear over radius and face position from finite elements of its whole ring.

A line load that changes little over the face compresses the flank as in plane strain across the
line. The compression after Weber and Banaschek, which belongs to the contact, replaces that part:
this module computes how much of it a coarse section shows, so that it can be taken off where the
load acts, and what of it is to be taken off near the load.
"""

from __future__ import annotations

import hashlib
import math
from functools import cache as remember
from functools import partial
from typing import NamedTuple

import numpy as np

from tribodyn.compiled import announce
from tribodyn.gear import Material, SpurGear
from tribodyn.interrupt import single_blas_thread
from tribodyn.progress import SILENT, Progress
from tribodyn.stiffness.fe2d.flank_load import nodal_weights
from tribodyn.stiffness.fe2d.provider import (
    digest_of,
    held_radius,
    looked_up,
    neighbour_count,
    wind_up_to_take_off,
)
from tribodyn.stiffness.fe2d.ring import assembled, symmetric_factors
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, SectorMesh, tooth_mesh
from tribodyn.stiffness.fe3d.ring import Ring, solved_harmonics
from tribodyn.stiffness.fe3d.sections import element_matrices
from tribodyn.stiffness.fe3d.sector import Sector, SolidSize, node_freedoms
from tribodyn.stiffness.teeth.face_influence import FaceInfluence
from tribodyn.stiffness.teeth.tooth_bending import load_point
from tribodyn.types import Array

#: Half width of the loads on the fine mesh [modules].
_PATCH = 0.12
#: By how much the mean compression of a Hertzian contact is less than that of its middle, in units
#: of the load over pi/2 times the modulus of plane strain.
_MEAN = 0.25
#: Distances from the tip corner [modules] from which the compliance goes on to the tip.
_TIP_SUPPORT = np.array([0.14, 0.19, 0.24])
#: Largest share of the involute that this may take.
_TIP_SHARE = 0.4


def local_compliance(sector: Sector) -> Array:
    """Local part (f, f) of the compliance between the loaded places, even over the face."""
    nu, length = sector.poissons_ratio, sector.flank_length
    tip = length.max()
    shrink = min(1.0, _TIP_SHARE * (tip - length.min()) / _TIP_SUPPORT[-1])
    support = tip - shrink * _TIP_SUPPORT
    coarse = np.diagonal(_clamped_compliance(sector, sector.mesh, length, 0.0))
    fine_mesh = tooth_mesh(sector.form, sector.interface * sector.form.normal_module, MeshSize())
    places = np.concatenate([np.minimum(length, support[0]), support])
    patch = shrink * _PATCH
    fine = np.diagonal(_clamped_compliance(sector, fine_mesh, places, patch))
    scale, depth, narrowing = _normal_section(sector, places)
    bracket = np.log(2.0 * depth / (patch * narrowing)) - nu / (2.0 * (1.0 - nu)) - _MEAN
    structure = fine - scale * bracket
    curve = np.polyfit(tip - support, structure[length.size :], 2)
    on_tip = length > support[0]
    structure = np.where(on_tip, np.polyval(curve, tip - length), structure[: length.size])
    # between two places the half plane, from the depth on nothing
    scale, depth, narrowing = _normal_section(sector, length)
    reach = depth / narrowing * np.exp(-0.5 / (1.0 - nu))
    distance = np.abs(length[:, None] - length) + np.eye(length.size)
    share = np.sqrt(reach[:, None] * reach) / distance
    local = 0.5 * np.sqrt(scale[:, None] * scale) * np.log1p(share**2)
    np.fill_diagonal(local, coarse - structure)
    return np.asarray(local)


def _normal_section(sector: Sector, length: Array) -> tuple[Array, Array, Array]:
    """Compliance factor, depth, and ratio of lengths in a section across the line of a load."""
    radius, nu = sector.curvature_radius(length), sector.poissons_ratio
    module = sector.form.normal_module
    slope = sector.twist * sector.base_radius
    base_cosine = 1.0 / np.hypot(1.0, slope)
    cosine = 1.0 / np.hypot(1.0, sector.twist * np.hypot(sector.base_radius, radius))
    scale = 2.0 * (1.0 - nu**2) / np.pi * cosine / base_cosine**2
    depth = load_point(sector.form, radius * module).depth / module
    return scale, depth * base_cosine, cosine / base_cosine


def _clamped_compliance(
    sector: Sector, mesh: SectorMesh, length: Array, half_width: float
) -> Array:
    """Compliance (f, f) of the tooth clamped at its foot under loads even over a long face."""
    elements, size = mesh.tooth_elements(), 3 * len(mesh.nodes)
    matrix = element_matrices(mesh.nodes[elements], sector.twist, sector.stress).none
    full = assembled(matrix, node_freedoms(elements), size).tocsc()
    free = node_freedoms(mesh.tooth[:, :-1].ravel())
    weights = nodal_weights(mesh, length, np.full(length.size, half_width))
    loads = (weights[:, None, :] * sector.load_direction(length).T).reshape(size, -1)[free]
    return np.asarray(loads.T @ symmetric_factors(full[free][:, free]).solve(loads))


class UnitFaceCompliances(NamedTuple):
    """Compliances for a Young's modulus of one, lengths in modules."""

    curvature_radius: Array
    knots: Array
    compliance: Array  #: [neighbour, loaded radius, displaced radius, loaded, displaced function]


def gear_sector(gear: SpurGear, poissons_ratio: float, size: SolidSize) -> Sector:
    """Sector of a gear, turned along the face so that lines of contact fall from its tip."""
    module = gear.normal_module
    return Sector(
        form=gear,
        width=gear.face_width / module,
        fixed_radius=held_radius(gear) / module,
        twist=gear.sign * math.tan(gear.base_helix_angle) * module / gear.base_radius,
        poissons_ratio=poissons_ratio,
        size=size,
    )


@single_blas_thread()
def unit_face_compliances(
    sector: Sector, neighbours: int, progress: Progress = SILENT
) -> UnitFaceCompliances:
    """Compliances of a gear whose body is held along a circle."""
    progress.start("compliance over the face", solved_harmonics(sector.count).size)
    # the side of larger radii is the clockwise one; of a ring the other
    sectors = -sector.form.sign * np.arange(neighbours + 1)
    compliance = Ring(sector).flank_compliances(sectors, progress=progress)
    local = local_compliance(sector)[:, None, :, None]
    compliance[0] -= local * np.linalg.inv(sector.face.mass)[None, :, None, :]
    progress.finish()
    # [s, displaced f, z, loaded f, z] to [s, loaded f, displaced f, loaded z, displaced z]
    tables = np.ascontiguousarray(compliance.transpose(0, 3, 1, 4, 2))
    return UnitFaceCompliances(
        sector.curvature_radius(sector.flank_length), sector.face.knots, tables
    )


#: Folders, relative to this one, and modules on which the numbers depend.
_SOURCES = (
    (".", "provider ring sections sector"),
    ("../fe2d", "flank_load ring tooth_mesh"),
    ("../teeth", "tooth_bending tooth_compliance"),
    ("../../gear", "curves tooth_form"),
    ("../../arrays", "splines"),
)


def fe3d_influence(
    gear: SpurGear,
    material: Material,
    *,
    reference: str = "bore",
    neighbours: int = 3,
    cache: bool = True,
    size: SolidSize | None = None,
    progress: Progress = SILENT,
) -> FaceInfluence:
    """Influence of one gear over its flank and face width from finite elements of its whole ring.

    Parameters
    ----------
    gear, material : SpurGear, Material
        The gear and its material.
    reference : str
        ``"bore"``: the bore is held over the face; ``"rim"``: the mean wind-up of the body is
        taken off.
    neighbours : int
        Number of neighbours on each side that are known, 1 or more; no more than there are.
    cache : bool
        Whether the result is read from and stored in the folder of
        :func:`tribodyn.stiffness.fe2d.provider.cache_folder`.
    size : SolidSize, optional
        Sizes of the elements.
    progress : Progress
        Receiver of the progress.

    Raises
    ------
    InputError
        If the reference is unknown or is the bore of a gear without bore, the bore leaves hardly
        any rim, or ``neighbours`` is less than one.

    Notes
    -----
    Three-dimensional; a disc as wide as the face. Quadratic quadrilaterals of the transverse
    section times cubic splines over the face, in the frame that turns with the section along the
    helix; all teeth, reduced to one by the discrete Fourier transform around the axis, and the
    body below the root as rings, wave by wave. Beyond eight, some harmonics only are solved.
    Displacement and load lie along the transverse line of action, per transverse force; the load
    has the axial part ``tan(beta_b)``, and the displacement is the normal one over
    ``cos(beta_b)``.

    The compression under the load is not part of it, as in
    :func:`tribodyn.stiffness.fe2d_influence`: in plane strain, times the load per face width,
    ``2 (1 - nu^2)/(pi E cos(beta_b)) [ln(2h/a) - nu/(2(1 - nu))]`` with the depth ``h`` of
    :func:`tribodyn.stiffness.load_point` times ``cos(beta_b)``. The rest alone need not be
    positive for loads that alternate from slice to slice; together with the compression of a
    contact whose half width is below ``h/4`` it is. Source: Weber and Banaschek (1953), the split
    into structure and local compression; ISO 21771, the helix.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02, bore_diameter=0.03)
    >>> fe3d_influence(gear, Material(), cache=False).neighbours
    3
    """
    wind_up = wind_up_to_take_off(gear, material, reference) / gear.face_width
    count = neighbour_count(gear, neighbours)
    sector = gear_sector(gear, material.poissons_ratio, size or SolidSize())
    unit = _unit(sector, count, cache, progress)
    module = gear.normal_module
    compliance = unit.compliance / (material.youngs_modulus * module) - wind_up
    return FaceInfluence(
        unit.curvature_radius * module, unit.knots * module, compliance[0], compliance[1:]
    )


def _unit(sector: Sector, neighbours: int, cache: bool, progress: Progress) -> UnitFaceCompliances:
    if not cache:
        return unit_face_compliances(sector, neighbours, progress)

    def compute() -> UnitFaceCompliances:
        announce(
            f"computing the compliance of {sector.count} teeth over their face, once on this "
            "machine, 1 to 10 seconds"
        )
        return unit_face_compliances(sector, neighbours, progress)

    def fits(unit: UnitFaceCompliances) -> bool:
        radii, functions = unit.curvature_radius.size, unit.knots.size - 4
        return unit.compliance.shape == (neighbours + 1, radii, radii, functions, functions)

    return looked_up(UnitFaceCompliances, file_name(sector, neighbours), compute, fits, "fe3d")


def file_name(sector: Sector, *settings: object) -> str:
    """Hash of everything that the compliances for a Young's modulus of one depend on."""
    form, module = sector.form, sector.form.normal_module
    outline = (
        form.teeth,
        form.normal_pressure_angle,
        form.profile_shift_coefficient,
        form.tip_diameter / module,
        form.tooth_thinning / module,
        form.rack,
        form.helix_angle,
    )
    solid = (sector.width, sector.fixed_radius, sector.twist, sector.poissons_ratio, sector.size)
    text = repr((outline, solid, *settings, _digest()))
    return hashlib.sha256(text.encode()).hexdigest()


_digest = remember(partial(digest_of, __file__, _SOURCES))
