"""Load capacity of a mesh from computed fields: load sharing, root stress by finite elements."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import collected
from tribodyn.gear import FlankModification
from tribodyn.nomenclature import GEARS
from tribodyn.rating.root_elements import root_stress_by_elements

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.rating import MeshRating


def load_sharing_factor(case: Case, table: MeshTable) -> float:
    """Greatest load of a tooth pair over that of flanks without modification or deviation."""
    from tribodyn.mesh.build import teeth_under_load
    from tribodyn.mesh.face.lines import by_pair, slice_count
    from tribodyn.study.mesh_inputs import mesh_inputs

    inputs, bare = mesh_inputs(case), FlankModification()
    gears = {name: replace(getattr(case.gear_pair, name), modification=bare) for name in GEARS}
    with collected():
        pair = replace(case.gear_pair, **gears)
        cycle, teeth = teeth_under_load(pair, inputs.settings, table.pinion_torque, None, None)
    slices = 1 if cycle.slices is None else slice_count(table)
    ideal = by_pair(teeth.shared_load().share, slices).sum(axis=2)
    shares = by_pair(table.load_share, slice_count(table)).sum(axis=2)
    return max(float(shares.max() / ideal.max()), 1.0)


def root_stresses(rating: MeshRating) -> dict[str, dict[str, float]]:
    """Root stress by finite elements of both gears, at rest and along the motion, by role."""
    mesh = rating.rated
    if mesh is None or (table := mesh.table) is None:
        return {}
    outer = rating.computed.factors["K_A"] * rating.computed.factors["K_gamma"]
    # a table of whole pairs has the mean load of the face
    spread = rating.computed.factors["K_Fbeta"] if table.face_position is None else 1.0
    phase, force = mesh.motion() if mesh.motion is not None else (table.phase, 1.0)
    force, figures = np.broadcast_to(force, phase.shape), {}
    for role, standard in rating.standard.gears.items():
        nu = mesh.common[role].material.poissons_ratio
        root = root_stress_by_elements(mesh.case.gear_pair, role, table, nu)
        dynamic = root.under_force(phase, force * table.total_normal_force)
        assert root.greatest is not None
        assert dynamic is not None
        figures[role] = {
            "ratio": root.ratio,
            "static_stress": outer * spread * root.greatest,
            "dynamic_stress": outer * spread * dynamic,
            "bending_safety": standard.factors["sigma_FG"] / (outer * spread * dynamic),
        }
    return figures
