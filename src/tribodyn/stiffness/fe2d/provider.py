"""Influence of one gear from finite elements of its whole ring."""

from __future__ import annotations

import hashlib
from functools import cache as remember
from pathlib import Path

import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.fe2d.cache import load_arrays, store_arrays
from tribodyn.stiffness.fe2d.compliances import (
    NODES,
    UnitCompliances,
    held_radius,
    unit_compliances,
    wind_up_to_take_off,
)
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize
from tribodyn.stiffness.influence import GearInfluence

#: Folders, relative to this one, and modules on which the numbers depend.
_SOURCES = (
    (".", "compliances element flamant flank_load ring sector_mesh tooth_mesh tooth_side"),
    ("..", "load_point sainsot"),
    ("../../gear", "form_circle involute rack tooth_form trochoid"),
)


def fe2d_influence(
    gear: SpurGear,
    material: Material,
    *,
    reference: str = "bore",
    neighbours: int = 3,
    cache: bool = True,
    size: MeshSize | None = None,
) -> GearInfluence:
    """Influence of one gear from plane-stress finite elements of its whole ring.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    material : Material
        Its material.
    reference : str
        ``"bore"``: the bore is held; ``"rim"``: the wind-up of the body is taken off.
    neighbours : int
        Number of neighbours on each side that are known, 1 or more; no more than there are.
    cache : bool
        Whether the result is looked up and kept in the folder of
        :func:`tribodyn.stiffness.fe2d.cache.cache_folder`.
    size : MeshSize, optional
        Sizes of the elements.

    Returns
    -------
    GearInfluence

    Raises
    ------
    InputError
        If the reference is unknown or is the bore of a gear without bore, the bore leaves hardly
        any rim, or no neighbours are asked for.

    Notes
    -----
    Plane stress; quadratic quadrilaterals; the ring of all teeth, reduced without loss to one
    tooth by the discrete Fourier transform around it. The local compression
    ``2/(pi E) [ln(2h/a) - nu/2]`` of a narrow load of half width ``a`` is not part of the self
    compliance; ``h`` is the depth of :func:`tribodyn.stiffness.load_point`. From 0.07 modules
    before the corner of the tip on the self compliance is continued smoothly. A solid gear with
    the rim as reference is held along a seventh of its root radius. Source: Timoshenko and
    Goodier, Theory of Elasticity (half plane under a point load); Weber and Banaschek (1953), the
    split into structure and local compression.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02, bore_diameter=0.03)
    >>> influence = fe2d_influence(gear, Material(), cache=False)
    >>> bool(influence.between(0.02, 0.02, 1) < influence.at(0.02)), influence.neighbours
    (True, 3)
    """
    wind_up = wind_up_to_take_off(gear, material, reference)
    if neighbours < 1:
        raise InputError(
            Problem(
                what=f"neighbours = {neighbours}",
                where=Argument("neighbours"),
                why="Teeth in contact at the same time move one another",
                remedy="Give 1 or more",
            )
        )
    known = max(min(neighbours, (gear.teeth - 1) // 2), 1)
    found = _looked_up(gear, material.poissons_ratio, known, size or MeshSize(), cache)
    own = found.self_compliance / material.youngs_modulus - wind_up
    if not np.all(own > 0.0):
        raise InputError(_too_thin(gear))
    cross = found.cross_compliance / material.youngs_modulus - wind_up
    return GearInfluence(found.curvature_radius, own, cross)


def _too_thin(gear: SpurGear) -> Problem:
    rim = gear.root_radius - held_radius(gear)
    return Problem(
        what=f"the bore of {gear.bore_diameter * 1e3:.4g} mm leaves a rim of {rim * 1e3:.3g} mm "
        "under the root circle",
        where="bore_diameter",
        why="The held bore lies so close to the lowest contacts that the local compression of the "
        "contact alone, which reaches to the middle of the tooth, is more than the whole "
        "deflection",
        remedy="Give a smaller bore",
    )


def _looked_up(
    gear: SpurGear, poissons_ratio: float, neighbours: int, size: MeshSize, cache: bool
) -> UnitCompliances:
    if not cache:
        return unit_compliances(gear, poissons_ratio, neighbours, size)
    name = _file_name(gear, poissons_ratio, neighbours, size)
    arrays = load_arrays(name)
    if arrays is not None and set(arrays) == set(UnitCompliances._fields):
        kept = UnitCompliances(**arrays)
        shapes = [part.shape for part in kept]
        if shapes == [(NODES,), (NODES,), (neighbours, NODES, NODES)] and all(
            np.all(np.isfinite(part)) for part in kept
        ):
            return kept
    found = unit_compliances(gear, poissons_ratio, neighbours, size)
    store_arrays(name, found._asdict())
    return found


def _file_name(gear: SpurGear, poissons_ratio: float, neighbours: int, size: MeshSize) -> str:
    """Hash of everything that the compliances for a Young's modulus of one depend on."""
    form = (
        gear.teeth,
        gear.normal_module,
        gear.normal_pressure_angle,
        gear.profile_shift_coefficient,
        gear.tip_diameter,
        gear.tooth_thinning,
        gear.rack,
        held_radius(gear),
    )
    text = repr((form, poissons_ratio, neighbours, size, _digest()))
    return hashlib.sha256(text.encode()).hexdigest()


@remember
def _digest() -> str:
    here = Path(__file__).parent
    return "".join(source_digest(here / folder, names.split()) for folder, names in _SOURCES)
