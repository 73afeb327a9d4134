"""From a case and its mesh to the structure that vibrates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.study.case.derive import chosen_options, mesh_law_of
from tribodyn.study.pipeline.damping import damping_of
from tribodyn.study.pipeline.geometry import geometry
from tribodyn.study.pipeline.tooth_contact import load_friction_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.case.derive import mesh_law_of
from tribodyn.study.pipeline.damping import Damping


def static_error(case: Case, phase: Array | float) -> Array:
    """Static transmission error of a case: a cosine at mesh frequency."""
    amplitude = case.dynamics.transmission_error_amplitude
    angle = 2.0 * np.pi * np.asarray(phase) + case.dynamics.transmission_error_phase
    return np.asarray(amplitude * np.cos(angle))


def system_of(
    case: Case, mesh: MeshTable, damping: Damping, friction: MeshFriction | None = None
) -> System:
    """Build the structure of a case with its tooth contact."""
    from tribodyn.dynamics import follow_load

    system = _structure(case, mesh, damping)
    return system if friction is None else follow_load(system, friction)


def whole_system(case: Case, mesh: MeshTable) -> System:
    """Build the structure of a case with its tooth contact, its damping and its friction."""
    return system_of(case, mesh, damping_of(case, mesh), load_friction_of(case, mesh))


def _structure(case: Case, mesh: MeshTable, damping: Damping) -> System:
    from tribodyn.dynamics import STRUCTURES, Gearing

    body, torque = geometry(case), case.pinion_torque
    contact: dict[str, Any] = {
        "mesh_damping": damping.mesh,
        "driver": case.gears.driver,
        "backlash": case.backlash,
        "damping_in_gap": case.dynamics.damping_in_gap,
        "torque_balance": case.operation.torque_balance,
        "mesh_force": mesh_law_of(case),
    }
    if case.dynamics.transmission_error_amplitude > 0.0:
        contact["error"] = lambda phase: static_error(case, phase)
    gearing = Gearing(
        mesh.functions(),
        mass=(body.get("mass_pinion", 0.0), body.get("mass_wheel", 0.0)),
        moment_of_inertia=(body["moment_of_inertia_pinion"], body["moment_of_inertia_wheel"]),
        base_radius=(body["base_radius_pinion"], body["base_radius_wheel"]),
        torque=(torque, torque * case.gear_ratio),
        contact=contact,
    )
    return STRUCTURES[case.dynamics.model](gearing, **chosen_options(case, "dynamics"))
