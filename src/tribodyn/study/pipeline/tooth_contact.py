"""The tooth contact of a case: models and options, mesh, friction, and its state at rest."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case import derive
from tribodyn.study.case.derive import mesh_law_of, placed
from tribodyn.study.case.provenance import effective
from tribodyn.study.case.sections import Operation
from tribodyn.study.case.values import FaultError, Plain, read_value

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.stiffness import LoadedContact
    from tribodyn.study.case.case import Case


#: Load over the nominal load below which friction may be missing.
_LIGHT = 0.3


def chosen_options(case: Case, section: str) -> dict[str, Any]:
    """Options in force of the model that a table names, called as the model calls them."""
    model, values = getattr(case, section).chosen, effective(case)
    found = {
        option.argument or name: values[f"{section}.{name}"]
        for name, option in model.declared.items()
        if option.in_case
    }
    return {name: value for name, value in found.items() if value is not None}


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


def mesh_of(case: Case, progress: Progress = SILENT, *, load: float = 1.0) -> MeshTable:
    """Compute the tooth contact of a case over one mesh cycle."""
    from tribodyn.mesh import build

    return build(
        case.gear_pair,
        friction_law=case.friction.law,
        friction_options=chosen_options(case, "friction"),
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


def operation_values(name: str, given: Any, case: Case) -> list[float]:
    """Read one or several torques or speeds, each checked like the key of the case."""
    if given is None:
        return [getattr(case.operation, name)]
    several = isinstance(given, Iterable) and not isinstance(given, str)
    spec = dict(Operation.specs())[name]
    try:
        return [read_value(spec, name, Plain(item)) for item in (given if several else [given])]
    except FaultError as fault:
        problem = replace(fault.problem, where=f"argument {name}")
        raise InputError(problem) from None


def pinion_torques(case: Case, given: Any) -> list[float]:
    """Read torques on the gear named by ``operation.speed_of`` as those of the pinion."""
    return [value / _turns(case) for value in operation_values("torque", given, case)]


def pinion_speeds(case: Case, given: Any) -> list[float]:
    """Read speeds of the gear named by ``operation.speed_of`` as those of the pinion."""
    return [value * _turns(case) for value in operation_values("speed", given, case)]


def _turns(case: Case) -> float:
    """Turns of the pinion for one of the gear that speed and torque refer to."""
    return case.gear_pair.ratio if case.operation.speed_of == "wheel" else 1.0


def loaded_settings(case: Case) -> dict[str, Any]:
    """Provider, its options and the material of a case, as the loaded tooth contact has them."""
    settings = model_settings(case)
    options = dict(settings["stiffness_options"])
    return {
        "provider": settings["stiffness_model"],
        "extended_contact": bool(options.get("extended_contact", False)),
        "material": settings["material"],
        "options": options,
    }


def loaded_contact(case: Case, *, torque: Any = None, phases: int = 64) -> LoadedContact:
    """Find load sharing, transmission error and stiffness of a case under torques at rest.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`; its ``[stiffness]`` says how the teeth give way.
    torque : float, str or list, optional
        Torques on the gear named by ``operation.speed_of``: floats in N*m, or text with a unit.
        That of the case where absent.
    phases : int
        Evenly spaced phases of a mesh cycle.

    Returns
    -------
    LoadedContact
        Torques in it are those of the pinion; without oil film.

    Raises
    ------
    InputError
        If a torque is out of range.
    ComputationError
        If the load is beyond what the tooth contact covers.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    >>> mesh = loaded_contact(case, torque=["90 N*m", "150 N*m"])
    >>> mesh.peak_to_peak_transmission_error.shape
    (2,)
    """
    from tribodyn.stiffness import loaded_contact as compute

    values = pinion_torques(case, torque)
    single = torque is None or isinstance(torque, int | float | str)
    with placed(case):
        return compute(
            case.gear_pair, values[0] if single else values, phases=phases, **loaded_settings(case)
        )
