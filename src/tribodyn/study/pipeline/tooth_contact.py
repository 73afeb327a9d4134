"""Tooth contact of a case: models and options, mesh table, friction under any load."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import ComputationError, InputError, ModelWarning, collected, warn
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.sections import Operation
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.case.values import FaultError, Plain, read_value
from tribodyn.study.mesh_inputs import (
    HypoidTeeth,
    MeshInputs,
    TableTeeth,
    mesh_inputs,
    model_settings,
)
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.mesh import HypoidFriction, HypoidLoadedContact, MeshFriction, MeshTable
    from tribodyn.mesh.sharing import FittedLaw, ToothContact
    from tribodyn.stiffness import LoadedContact
    from tribodyn.study.case.pair import PairCase
    from tribodyn.types import Array


#: Load over the nominal load below which friction may be missing.
_LIGHT = 0.3
#: Phase intervals of a rehearsal, of hypoid teeth and with so many cells.
_FEWEST, _HYPOID = 32, 16


def mesh_of(case: PairCase, progress: Progress = SILENT, **options: Any) -> MeshTable:
    """Compute the tooth contact of a pair over one mesh cycle, as :func:`mesh_table`."""
    return mesh_table(mesh_inputs(case), progress, **options)


def mesh_table(
    inputs: MeshInputs,
    progress: Progress = SILENT,
    *,
    load: float = 1.0,
    rehearsal: bool = False,
    about_load: bool = False,
    friction_alone: bool = False,
) -> MeshTable:
    """Compute the tooth contact of a mesh over one mesh cycle."""
    # A rehearsal has few phases and a film by formula: it only has to raise the input errors.
    # about_load: the force law has few ramps, or is its tangent where the inputs take no more.
    # friction_alone: the force law is its tangent, which costs nothing.
    from tribodyn.mesh.build import mesh_table as of_cylindrical

    if isinstance(inputs.teeth, TableTeeth):
        return inputs.teeth.file.table(
            teeth=inputs.teeth.gears.pinion.teeth,
            driver=inputs.driver,
            pinion_speed=inputs.speed,
            pinion_torque=inputs.torque,
            friction_coefficient=inputs.teeth.friction_coefficient,
        )
    settings = _rehearsed(inputs.settings) if rehearsal else inputs.settings
    if isinstance(inputs.teeth, HypoidTeeth):
        fewest = {"steps": _HYPOID, "cells": _HYPOID} if rehearsal else {}
        loaded = hypoid_loaded_contact_of(inputs, load=load, progress=progress, **fewest)
        return _friction_in_cells(inputs, loaded, settings).table()
    return of_cylindrical(
        inputs.teeth,
        settings,
        steps=_FEWEST if rehearsal else None,
        pinion_speed=inputs.speed,
        pinion_torque=inputs.torque * load,
        force_law="tangent" if friction_alone else fitted_law(inputs, about_load),
        progress=progress,
    )


def fitted_law(inputs: MeshInputs, about_load: bool = False) -> FittedLaw:
    """How the force law of a mesh is fitted: with few ramps about the load, or with all."""
    fitted: FittedLaw = inputs.law == "force-law"
    if about_load:
        fitted = "about-load" if fitted else "tangent"
    return fitted


def _rehearsed(settings: ToothContact) -> ToothContact:
    """Settings that take no solution of a film and raise the same input errors."""
    from tribodyn.friction import LAWS

    film = "none" if settings.film_model == "none" else "dowson-higginson"
    settings = replace(settings, film_model=film, film_options={})
    if settings.stiffness_model == "fe3d":  # solids take seconds, plane sections do not
        settings = replace(settings, stiffness_model="fe2d")
    law = LAWS[settings.friction_law]
    if not law.needs_film:
        return settings
    other = LAWS[law.rehearsal]
    options = settings.friction_options.items()
    shared_options = {name: value for name, value in options if name in other.options}
    return replace(settings, friction_law=other.name, friction_options=shared_options)


def teeth_contact_ratio(inputs: MeshInputs) -> float | None:
    """Contact ratio under load on the grid points of a run; None if only a mesh table has it."""
    from tribodyn.mesh.build import teeth_under_load
    from tribodyn.mesh.face_lines import contact_ratio

    pair = inputs.cylindrical
    if pair is None or not pair.has_profile_modification:
        return None
    cycle, teeth = teeth_under_load(pair, inputs.settings, inputs.torque, None, None)
    shared = teeth.shared_load()
    return contact_ratio(cycle.grid, shared.share, shared.corner_share)


def film_group(case: PairCase) -> object:
    """Key of cases whose tooth contacts differ in speed and load alone; None for other cases."""
    if case.spur_pair is None or case._named_files():
        return None
    try:
        inputs = mesh_inputs(case)
        return inputs.teeth, inputs.contact, inputs.law
    except InputError:
        return None  # preparing the run reports the error


def meshes_of(points: Sequence[MeshInputs]) -> list[Callable[[], MeshTable]]:
    """Mesh tables of meshes with the same key from one pass; empty if none can be shared."""
    from tribodyn.mesh.operating_points import mesh_tables

    first, law = points[0], points[0].law == "force-law"
    assert first.cylindrical is not None
    operation = [(point.speed, point.torque) for point in points]
    tables = mesh_tables(first.cylindrical, first.settings, operation, force_law=law)
    return [partial(_repeated, *entry) for entry in tables]


def _repeated(table: MeshTable, model_warnings: Iterable[ModelWarning]) -> MeshTable:
    repeat(model_warnings)
    return table


def repeat(model_warnings: Iterable[ModelWarning]) -> None:
    """Issue collected warnings again."""
    for warning in model_warnings:
        warn(warning.code, warning.message, affected=warning.affected)


def hypoid_friction_of(inputs: MeshInputs, *, loading: Array | None = None) -> HypoidFriction:
    """Load, film and friction of a hypoid pair in every cell of its contact lines."""
    loaded = hypoid_loaded_contact_of(inputs)
    if loading is not None:
        loaded = loaded.under_loading(loading)
    return _friction_in_cells(inputs, loaded, inputs.settings)


def _friction_in_cells(
    inputs: MeshInputs, loaded: HypoidLoadedContact, settings: ToothContact
) -> HypoidFriction:
    from tribodyn.mesh.hypoid.friction import friction_in_cells

    assert isinstance(inputs.teeth, HypoidTeeth)
    return friction_in_cells(loaded, inputs.speed, settings, inputs.teeth.gears.entrainment)


def hypoid_loaded_contact_of(
    inputs: MeshInputs, *, load: float = 1.0, progress: Progress = SILENT, **resolution: int
) -> HypoidLoadedContact:
    """Loaded contact of a hypoid pair, with phases (``steps``) and ``cells``."""
    from tribodyn.mesh import hypoid_loaded_contact

    teeth = inputs.teeth
    assert isinstance(teeth, HypoidTeeth)  # Only hypoid pairs have such a contact.
    return hypoid_loaded_contact(
        teeth.flanks,
        inputs.torque * load,
        misalignment=teeth.mounting,
        material=inputs.settings.material,
        line_stiffness=teeth.gears.line_stiffness,
        # fewer phases or cells are a rehearsal, which takes no time
        stiffness_model="line" if "cells" in resolution else teeth.gears.stiffness_model,
        progress=progress,
        **resolution,
    )


def load_friction_of(
    inputs: MeshInputs, nominal: MeshTable, rehearsal: bool = False
) -> MeshFriction | None:
    """Friction of a mesh under any load of the teeth."""
    if inputs.dynamics.friction_load == "nominal":
        return None
    from tribodyn.mesh import LOADS, mesh_friction

    tables = []
    with collected():
        for load in LOADS:
            try:
                at = partial(mesh_table, load=load, rehearsal=rehearsal, friction_alone=True)
                tables.append(nominal if load == 1.0 else at(inputs))
            except ComputationError:
                # An oil film in series is softer than lightly loaded teeth. Light loads rub little.
                if load > _LIGHT:
                    raise
    return mesh_friction(tables, nominal)


_PHASES = 64  #: phases of a mesh cycle


def loaded_settings(case: PairCase) -> Tree:
    """Provider, its options and material of a case, as arguments of the loaded tooth contact."""
    settings = model_settings(case)
    options = dict(settings["stiffness_options"])
    return {
        "provider": settings["stiffness_model"],
        "extended_contact": bool(options.get("extended_contact", False)),
        "material": settings["material"],
        "options": options,
    }


def phases_of_turns(case: PairCase) -> Array:
    """Phases until all repeats: shorter than the hunting period where one gear is even."""
    gears = (case.gear_pair.pinion, case.gear_pair.wheel)
    turns = math.lcm(*(gear.teeth for gear in gears if gear.modification.teeth_differ))
    return np.arange(_PHASES * turns) / _PHASES


def loaded_contact(
    case: PairCase, *, torque: Any = None, phases: int | Array = _PHASES
) -> LoadedContact:
    """Find load sharing, transmission error and stiffness of a case under torques at rest.

    Parameters
    ----------
    case : PairCase
        From :func:`tribodyn.load_case`; its ``[stiffness]`` sets the compliance of the teeth.
    torque : float, str or list, optional
        Torques on the gear named by ``operation.speed_of``: floats in N*m, or text with a unit.
        By default that of the case.
    phases : int or array (p,)
        Evenly spaced phases of a mesh cycle, or the phases themselves.

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

    values = read_torques(case, torque)
    single = torque is None or isinstance(torque, int | float | str)
    with locate_errors(case):
        return compute(
            case.gear_pair, values[0] if single else values, phases=phases, **loaded_settings(case)
        )


def operation_values(name: str, values: Any, case: PairCase) -> list[float]:
    """Read torques or speeds, each checked like the key of the case."""
    if values is None:
        return [getattr(case.operation, name)]
    several = isinstance(values, Iterable) and not isinstance(values, str)
    if isinstance(values, np.ndarray) and not values.ndim:
        values, several = float(values), False
    spec = dict(Operation.specs())[name]
    try:
        return [read_value(spec, name, Plain(item)) for item in (values if several else [values])]
    except FaultError as fault:
        problem = replace(fault.problem, where=f"argument {name}")
        raise InputError(problem) from None


def read_torques(case: PairCase, values: Any) -> list[float]:
    """Read torques on the gear named by ``operation.speed_of`` as those of the first gear."""
    return [value / case.speed_ratio for value in operation_values("torque", values, case)]


def read_speeds(case: PairCase, values: Any) -> list[float]:
    """Read speeds of the gear named by ``operation.speed_of`` as those of the first gear."""
    return [value * case.speed_ratio for value in operation_values("speed", values, case)]
