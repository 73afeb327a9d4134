"""The local part of the compliance that the elements of a section show around a load.

A line load that changes little over the face compresses the flank as in plane strain across the
line. The compression after Weber and Banaschek, which belongs to the contact, replaces that part:
this module finds how much of it a coarse section shows, so that it can be taken off where the load
acts, and what of it is to be taken off near the load.
"""

from __future__ import annotations

import numpy as np

from tribodyn.stiffness.fe2d.flank_load import nodal_weights
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, SectorMesh, tooth_mesh
from tribodyn.stiffness.fe3d.sections import element_matrices
from tribodyn.stiffness.fe3d.sector import Sector
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
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import splu

    elements = mesh.tooth_elements()
    matrix = element_matrices(mesh.nodes[elements], sector.twist, sector.stress).none
    freedoms = (3 * elements[:, :, None] + np.arange(3)).reshape(len(elements), 27)
    rows = np.broadcast_to(freedoms[:, :, None], matrix.shape)
    columns = np.swapaxes(rows, 1, 2)
    size = 3 * len(mesh.nodes)
    full = coo_array((matrix.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsc()
    free = (3 * mesh.tooth[:, :-1].ravel()[:, None] + np.arange(3)).ravel()
    weights = nodal_weights(mesh, length, np.full(length.size, half_width))
    loads = (weights[:, None, :] * sector.load_direction(length).T).reshape(size, -1)[free]
    options = {"SymmetricMode": True}
    factors = splu(
        full[free][:, free].tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options=options,
    )
    return np.asarray(loads.T @ factors.solve(loads))
