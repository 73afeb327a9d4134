"""Compliance that a root crack adds to a tooth, by finite elements with an open seam."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.fe2d.flank_load import flank_loads
from tribodyn.stiffness.fe2d.provider import held_radius
from tribodyn.stiffness.fe2d.ring import element_stiffness, plane_stress
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, SectorMesh, ToothSide, tooth_mesh
from tribodyn.types import Array, Index

#: Places along the flank.
_PLACES = 13
#: Part of the tooth thickness beyond which the rest would bend plastically.
_DEEPEST = 0.8
#: Refinement of the mesh of a whole gear: the tip of the crack needs small elements.
_REFINED = 2.0


def crack_compliance(
    gear: SpurGear, material: Material, depth: float, *, refined: float = _REFINED
) -> tuple[Array, Array]:
    """Compliance per face width that a root crack adds under a load on the flank.

    Parameters
    ----------
    gear, material : SpurGear, Material
        External gear and its material.
    depth : float
        Length of the crack from the surface into the tooth [m].
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
        If the crack is deeper than 0.8 of the tooth at its root.

    Notes
    -----
    Plane stress, quadratic quadrilaterals, one tooth with its sector of the body held at the bore
    and at both cuts: what the crack adds belongs to the tooth alone. The nodes of the element edge
    that runs from the foot of the fillet through the tooth are doubled up to the tip of the crack.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02, bore_diameter=0.03)
    >>> radius, added = crack_compliance(gear, Material(), 1e-3, refined=1.0)
    >>> bool(np.all(added > 0.0))
    True
    """
    check_depth(gear, depth)
    unit = _unit_compliance(gear, material.poissons_ratio, depth, refined)
    return unit[0], unit[1] / material.youngs_modulus


def check_depth(gear: SpurGear, depth: float) -> None:
    """Raise InputError if hardly any tooth is left beside a crack."""
    side = ToothSide(gear)
    x, y = side.flank_points(np.array(side.form_length - side.foot_length))
    thickness = 2.0 * math.hypot(x, y) * math.atan2(x, y) * gear.normal_module
    if depth > _DEEPEST * thickness:
        raise InputError(
            f"depth = {1e3 * depth:.4g} mm",
            where=Argument("depth"),
            why=f"The tooth is {1e3 * thickness:.4g} mm thick where the crack begins, of which at "
            "least a fifth has to be left",
            remedy=f"Give a depth of at most {_DEEPEST * 1e3 * thickness:.3g} mm",
        )


@lru_cache(maxsize=64)
def _unit_compliance(
    gear: SpurGear, poissons_ratio: float, depth: float, refined: float
) -> tuple[Array, Array]:
    mesh = tooth_mesh(gear, held_radius(gear), MeshSize().refined(refined))
    base = gear.base_radius
    low = gear.roll_angle(max(gear.form_radius, base)) * base
    radius = np.linspace(
        max(low, 0.02 * gear.normal_module), gear.roll_angle(gear.tip_radius) * base, _PLACES
    )
    forces = flank_loads(gear, mesh, radius).forces
    seam = mesh.tooth[:, -1]
    reach = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(mesh.nodes[seam], axis=0).T))])
    length = depth / gear.normal_module
    # Only corners of elements can be the tip of the crack: compliance between them is interpolated
    # in the square of the depth, in which a shallow crack is linear.
    corner = int(np.searchsorted(reach[::2], length))
    sound = _self_compliance(mesh, mesh.elements, len(mesh.nodes), forces, poissons_ratio)
    added = []
    for tip in (corner - 1, corner):
        elements, count = _opened(mesh, seam, 2 * tip)
        loads = np.zeros((2 * count, radius.size))
        loads[: forces.shape[0]] = forces
        cracked = _self_compliance(mesh, elements, count, loads, poissons_ratio)
        added.append(cracked - sound)
    first, last = (reach[2 * tip] ** 2 for tip in (corner - 1, corner))
    share = (length**2 - first) / (last - first)
    return radius, (1.0 - share) * added[0] + share * added[1]


def _opened(mesh: SectorMesh, seam: Index, tip: int) -> tuple[Index, int]:
    """Elements whose nodes of the seam before the tip are doubled, and the number of nodes."""
    elements, count = mesh.elements.copy(), len(mesh.nodes)
    split = seam[:tip]
    twin = dict(zip(split.tolist(), range(count, count + split.size), strict=True))
    above = np.isin(mesh.elements, mesh.tooth[:, -2]).any(axis=1)
    rows = elements[above]
    for old, new in twin.items():
        rows[rows == old] = new
    elements[above] = rows
    return elements, count + split.size


def _self_compliance(
    mesh: SectorMesh, elements: Index, count: int, forces: Array, poissons_ratio: float
) -> Array:
    """Work of each load on its own displacement, for a Young's modulus of one."""
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import splu

    matrices = element_stiffness(mesh.nodes[mesh.elements], plane_stress(1.0, poissons_ratio))
    freedoms = (2 * elements[:, :, None] + np.arange(2)).reshape(len(elements), 18)
    rows = np.broadcast_to(freedoms[:, :, None], matrices.shape)
    columns = np.broadcast_to(freedoms[:, None, :], matrices.shape)
    entries: Any = (matrices.ravel(), (rows.ravel(), columns.ravel()))
    matrix = coo_array(entries, shape=(2 * count, 2 * count)).tocsc()
    fixed = np.concatenate([mesh.fixed, mesh.right_cut, mesh.left_cut])
    free = np.setdiff1d(np.arange(2 * count), (2 * fixed[:, None] + np.arange(2)).ravel())
    symmetric: Any = {"SymmetricMode": True}
    factors = splu(
        matrix[free][:, free], permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric
    )
    displacement = factors.solve(np.ascontiguousarray(forces[free]))
    return np.asarray(np.einsum("ik,ik->k", forces[free], displacement))
