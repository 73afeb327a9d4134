"""The tooth contact of a case: its models and options, its mesh, its friction under any load."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tribodyn.errors import ComputationError, collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case import derive
from tribodyn.study.case.derive import chosen_options, friction_of_table, mesh_law_of

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.mesh.sharing import ToothContact
    from tribodyn.study.case.case import Case


#: Load over the nominal load below which friction may be missing.
_LIGHT = 0.3
#: Phase intervals of a rehearsal.
_FEWEST = 16


def model_settings(case: Case) -> dict[str, Any]:
    """Material, oil, stiffness and film of a case, as the mesh asks for them."""
    return {
        "material": case.material_properties,
        "stiffness_model": case.stiffness.model,
        "stiffness_options": chosen_options(case, "stiffness"),
        "lubricant": case.lubricant_properties or derive.unused_lubricant(),
        "composite_roughness": case.composite_roughness or 0.0,
        "film_model": case.film.model,
        "film_options": chosen_options(case, "film"),
    }


def contact_settings(case: Case) -> ToothContact:
    """Settings of the tooth contact of a case."""
    from tribodyn.mesh.sharing import ToothContact

    return ToothContact(
        friction_law=case.friction.law,
        friction_options=chosen_options(case, "friction"),
        **model_settings(case),
    )


def mesh_of(
    case: Case, progress: Progress = SILENT, *, load: float = 1.0, rehearsal: bool = False
) -> MeshTable:
    """Compute the tooth contact of a case over one mesh cycle.

    A rehearsal has few places and no film: only what is refused matters.
    """
    from tribodyn.friction import LAWS
    from tribodyn.mesh.build import mesh_table

    if case.mesh_table is not None:
        return case.mesh_table.table(
            teeth=case.gears.pinion.teeth,
            driver=case.gears.driver,
            pinion_speed=case.pinion_speed,
            pinion_torque=case.pinion_torque,
            friction_coefficient=friction_of_table(case),
        )
    settings = contact_settings(case)
    if rehearsal:
        settings = replace(settings, film_model="none", film_options={})
        if LAWS[case.friction.law].needs_film:
            settings = replace(settings, friction_law="none", friction_options={})
    return mesh_table(
        case.gear_pair,
        settings,
        steps=_FEWEST if rehearsal else None,
        pinion_speed=case.pinion_speed,
        pinion_torque=case.pinion_torque * load,
        force_law=mesh_law_of(case) == "force-law",
        progress=progress,
    )


def load_friction_of(case: Case, nominal: MeshTable) -> MeshFriction | None:
    """Friction of a case under any load of the teeth."""
    if case.dynamics.friction_load == "nominal":
        return None
    from tribodyn.mesh import LOADS, mesh_friction

    tables = []
    with collected():
        for load in LOADS:
            try:
                tables.append(nominal if load == 1.0 else mesh_of(case, load=load))
            except ComputationError:
                # An oil film in series is softer than lightly loaded teeth. Light loads rub little.
                if load > _LIGHT:
                    raise
    return mesh_friction(tables, nominal)
