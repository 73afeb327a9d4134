"""Influence of one gear over radius and face position from finite elements of its whole ring."""

from __future__ import annotations

import hashlib
import math
from functools import cache as remember
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tribodyn.compiled import announce, source_digest
from tribodyn.errors import Argument, InputError
from tribodyn.gear import Material, SpurGear
from tribodyn.interrupt import single_blas_thread
from tribodyn.progress import SILENT, Progress
from tribodyn.stiffness.fe2d.provider import (
    held_radius,
    load_arrays,
    store_arrays,
    wind_up_to_take_off,
)
from tribodyn.stiffness.fe3d.local import local_compliance
from tribodyn.stiffness.fe3d.ring import Ring, solved_harmonics
from tribodyn.stiffness.fe3d.sector import Sector, SolidSize
from tribodyn.stiffness.teeth.face_influence import FaceInfluence
from tribodyn.types import Array


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
        held=held_radius(gear) / module,
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
    (".", "condense face local provider ring sections sector"),
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
    if neighbours < 1:
        why, remedy = "Teeth in contact at the same time move one another", "Give 1 or more"
        raise InputError(f"neighbours = {neighbours}", Argument("neighbours"), why, remedy)
    neighbour_count = max(min(neighbours, (abs(gear.teeth) - 1) // 2), 1)
    sector = gear_sector(gear, material.poissons_ratio, size or SolidSize())
    unit = _looked_up(sector, neighbour_count, cache, progress)
    module = gear.normal_module
    compliance = unit.compliance / (material.youngs_modulus * module) - wind_up
    return FaceInfluence(
        unit.curvature_radius * module, unit.knots * module, compliance[0], compliance[1:]
    )


def _looked_up(
    sector: Sector, neighbours: int, cache: bool, progress: Progress
) -> UnitFaceCompliances:
    if not cache:
        return unit_face_compliances(sector, neighbours, progress)
    name = file_name(sector, neighbours)
    arrays = load_arrays(name, "fe3d")
    if arrays is not None and set(arrays) == set(UnitFaceCompliances._fields):
        unit = UnitFaceCompliances(**arrays)
        radii, functions = unit.curvature_radius.size, unit.knots.size - 4
        shape = (neighbours + 1, radii, radii, functions, functions)
        if unit.compliance.shape == shape and all(np.all(np.isfinite(rows)) for rows in unit):
            return unit
    announce(
        f"computing the compliance of {sector.count} teeth over their face, once on this machine, "
        "1 to 10 seconds"
    )
    unit = unit_face_compliances(sector, neighbours, progress)
    store_arrays(name, unit._asdict(), "fe3d")
    return unit


def file_name(sector: Sector, *settings: Any) -> str:
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
    solid = (sector.width, sector.held, sector.twist, sector.poissons_ratio, sector.size)
    text = repr((outline, solid, *settings, _digest()))
    return hashlib.sha256(text.encode()).hexdigest()


@remember
def _digest() -> str:
    package_folder = Path(__file__).parent
    return "".join(
        source_digest(package_folder / folder, names.split()) for folder, names in _SOURCES
    )
