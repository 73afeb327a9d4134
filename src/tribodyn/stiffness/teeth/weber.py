"""Weber and Banaschek: local compression of the flanks, and a tooth on a half plane."""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.errors import ComputationError, InputError, require_between, require_positive
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.teeth.influence import GearInfluence
from tribodyn.stiffness.teeth.tooth_bending import (
    beam_to_axis,
    flank_nodes,
    load_point,
    tooth_section,
)
from tribodyn.stiffness.teeth.tooth_compliance import check_reference
from tribodyn.types import Array

Number = TypeVar("Number", float, Array)


def weber_banaschek_compression(
    load_per_width: Number, half_width: Number, depth: Number, material: Material
) -> Number:
    """Compression of one body between the contact and the tooth centreline.

    ``2 w (1 - nu^2) / (pi E) [ln(2 h / a) - nu / (2 (1 - nu))]``. It is not proportional to the
    load, because the half width ``a`` of the contact grows with its square root.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Normal load per face width.
    half_width : float or array [m]
        Hertzian half width of the contact under that load.
    depth : float or array [m]
        Distance from the contact to the tooth centreline along the load.
    material : Material
        Material of the body.

    Returns
    -------
    float or array [m]

    Raises
    ------
    InputError
        If an argument is not positive.
    ComputationError
        If the contact is so wide that the formula gives no positive compression.

    Notes
    -----
    Valid for ``a`` much smaller than ``h``; plane strain. Source: Weber and Banaschek (1953),
    Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten Raedern, Vieweg.

    Examples
    --------
    >>> from tribodyn.gear import Material
    >>> compression = weber_banaschek_compression(1e5, 6e-5, 3e-3, Material())
    >>> print(f"{compression * 1e6:.4f} um")
    1.2348 um
    """
    for name, value, unit in (
        ("load_per_width", load_per_width, "N/m"),
        ("half_width", half_width, "m"),
        ("depth", depth, "m"),
    ):
        require_positive(name, value, unit)
    nu = material.poissons_ratio
    bracket = np.log(2.0) + np.log(depth) - np.log(half_width) - nu / (2.0 * (1.0 - nu))
    if np.any(bracket <= 0.0):
        raise ComputationError(
            f"contact half width {np.max(half_width) * 1e3:.4g} mm against a depth of "
            f"{np.min(depth) * 1e3:.4g} mm",
            where="Weber-Banaschek compression",
            why="The formula holds for a half width much smaller than the depth",
            remedy="Lower the load",
        )
    modulus = material.youngs_modulus / (1.0 - nu**2)
    compression: Number = 2.0 * load_per_width / (np.pi * modulus) * bracket
    return compression


def local_terms(
    gears: tuple[SpurGear, SpurGear], radii: tuple[Array, Array], material: Material
) -> tuple[Array, float]:
    """Terms ``L`` (2, ...) and factor ``B`` of both compressions ``B f (L - ln(f)/2)`` under Hertz.

    The half width of the contact of two flanks with these radii of curvature goes with the root
    of the load per width ``f``. Source: :func:`weber_banaschek_compression`; Hertz (1881).
    """
    nu = material.poissons_ratio
    reduced = radii[0] * radii[1] / (radii[0] + radii[1])
    square = 8.0 * reduced / (np.pi * effective_modulus(material, material))
    depths = np.stack([load_point(g, np.abs(r)).depth for g, r in zip(gears, radii, strict=True)])
    terms = np.log(2.0 * depths) - 0.5 * np.log(square) - nu / (2.0 * (1.0 - nu))
    return terms, 2.0 * (1.0 - nu**2) / (np.pi * material.youngs_modulus)


def half_plane_compliance(
    load_angle: Array | float, load_height: Array | float, foot_width: float, material: Material
) -> Array:
    """Compliance of the half plane under a tooth, per unit face width [m^2/N].

    ``cos^2(a) (1 - nu^2) / E [18/pi (u/s)^2 + 2 (1 - 2 nu)/(1 - nu) u/s
    + 4.8/pi (1 + (1 - nu)/2.4 tan^2 a)]`` with the angle ``a`` [rad] between the load and the
    normal of the tooth axis, the height ``u`` [m] above the foot at which the load crosses that
    axis, and the thickness ``s`` [m] of the tooth at its foot.

    Plane strain. The deflection of a half plane under a force is unbounded; the last term omits
    what the body does far from the tooth. Weber (1949) has 5.2, 1.0, 1.4 and 0.294 for the
    coefficients at a Poisson's ratio of 0.3, here 5.73, 1.14, 1.53 and 0.292. Source: Weber and
    Banaschek (1953), Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten Raedern,
    Vieweg.

    >>> compliance = half_plane_compliance(0.3, 5e-3, 8e-3, Material())
    >>> print(f"{float(compliance) * 1e6:.4g} mm^2/N")
    1.824e-05 mm^2/N
    """
    require_positive("foot_width", foot_width, "m")
    nu = material.poissons_ratio
    ratio = np.asarray(load_height, dtype=float) / foot_width
    tilt = np.tan(load_angle) ** 2
    bracket = (
        18.0 / math.pi * ratio**2
        + 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * ratio
        + 4.8 / math.pi * (1.0 + (1.0 - nu) / 2.4 * tilt)
    )
    modulus = material.youngs_modulus / (1.0 - nu**2)
    return np.asarray(np.cos(load_angle) ** 2 / modulus * bracket)


def weber_influence(
    gear: SpurGear, material: Material, *, reference: str = "rim", nodes: int = 30
) -> GearInfluence:
    """Influence of one gear by the energy method on a half plane, without neighbours.

    Plane strain, bending, shear and axial compression from the foot of the tooth, where the
    fillet meets the root circle, up to the place where the load crosses the tooth axis, and the
    half plane under the foot. The gear body beyond the neighbourhood of the tooth is rigid, which
    makes the method the stiffest of all; a half plane has no bore, so that ``reference`` is
    ``"rim"``. Source: Weber (1949), The deformation of loaded gears and the effect on their
    load-carrying capacity, DSIR report 3; Weber and Banaschek (1953).

    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02)
    >>> weber_influence(gear, Material()).neighbours
    0
    """
    check_reference(reference)
    if reference != "rim":
        why = "Its foundation is a half plane, which has no bore"
        remedy = 'Choose reference = "rim", or a model with a gear body: "fe2d", "analytic"'
        raise InputError(f'reference = "{reference}"', "stiffness model weber", why, remedy)
    require_between("nodes", nodes, 4, 1000)
    section = tooth_section(gear)
    foot_height, foot_half_width = section.foot
    radii = flank_nodes(gear, nodes)
    load = load_point(gear, radii)
    tooth = beam_to_axis(section, load, material)
    widening = 1.0 - material.poissons_ratio**2
    self_compliance = (
        widening * (tooth.bending + tooth.axial)
        + tooth.shear
        + half_plane_compliance(
            load.load_angle, load.axis_height - foot_height, 2.0 * foot_half_width, material
        )
    )
    return GearInfluence(radii, self_compliance, np.zeros((0, nodes, nodes)))
