"""The tooth contact of a case: its models and options, its mesh, its friction under any load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from tribodyn.errors import ComputationError
from tribodyn.progress import SILENT, Progress
from tribodyn.study import derive
from tribodyn.study.collect import collected
from tribodyn.study.options import TABLE_FORMS, model_options

if TYPE_CHECKING:
    from tribodyn.dynamics import MeshForce
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case import Case


#: Load over the nominal load below which friction may be missing.
_LIGHT = 0.3


def mesh_law_of(case: Case) -> MeshForce:
    """How the teeth of a case carry: plain stiffness, tangent to the force law, or the law."""
    from tribodyn.stiffness import MODELS

    if case.dynamics.mesh_law is not None:
        return cast("MeshForce", case.dynamics.mesh_law)
    whole = MODELS[case.stiffness.model].coupled or case.gear_pair.has_modification
    return "force-law" if whole else "stiffness"


def _options(case: Case, section: str, name: str) -> dict[str, Any]:
    """Options in force of a film model, stiffness model or friction law, as the model has them."""
    from tribodyn.study.provenance import effective

    values = effective(case)
    found = {key: values[f"{section}.{key}"] for key in model_options(section, name)}
    given = {key: value for key, value in found.items() if value is not None}
    if section == "stiffness" and name == "table":
        form = next(form for form in TABLE_FORMS if form in given)
        given[TABLE_FORMS[form]] = given.pop("values")
    return given


def model_settings(case: Case) -> dict[str, Any]:
    """Material, oil, stiffness and film of a case, as the mesh asks for them."""
    return {
        "material": case.material_properties,
        "stiffness_model": case.stiffness.model,
        "stiffness_options": _options(case, "stiffness", case.stiffness.model),
        "lubricant": case.lubricant_properties or derive.unused_lubricant(),
        "composite_roughness": case.composite_roughness or 0.0,
        "film_model": case.film.model,
        "film_options": _options(case, "film", case.film.model),
    }


def mesh_of(case: Case, progress: Progress = SILENT, *, load: float = 1.0) -> MeshTable:
    """Compute the tooth contact of a case over one mesh cycle."""
    from tribodyn.mesh import build

    return build(
        case.gear_pair,
        friction_law=case.friction.law,
        friction_options=_options(case, "friction", case.friction.law),
        pinion_speed=case.pinion_speed,
        pinion_torque=case.pinion_torque * load,
        force_law=mesh_law_of(case) == "force-law",
        progress=progress,
        **model_settings(case),
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
