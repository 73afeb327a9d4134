"""From a case and its mesh to the structure that vibrates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.study.damping import damping_of
from tribodyn.study.geometry import geometry
from tribodyn.study.rig import rig_of
from tribodyn.study.tooth_contact import load_friction_of, mesh_law_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case import Case
    from tribodyn.study.damping import Damping


_GEARS = ("pinion", "wheel")


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
    from tribodyn.dynamics import spur6, torsional

    body, torque = geometry(case), case.pinion_torque
    shared: dict[str, Any] = {
        "moment_of_inertia": [body[f"moment_of_inertia_{gear}"] for gear in _GEARS],
        "base_radius": [body[f"base_radius_{gear}"] for gear in _GEARS],
        "torque": [torque, torque * case.gear_pair.ratio],
        "mesh_damping": damping.mesh,
        "driver": case.gears.driver,
        "backlash": case.backlash,
        "damping_in_gap": case.dynamics.damping_in_gap,
        "torque_balance": case.operation.torque_balance,
        "mesh_force": mesh_law_of(case),
    }
    if case.dynamics.transmission_error_amplitude > 0.0:
        shared["error"] = lambda phase: static_error(case, phase)
    if case.dynamics.model == "torsional":
        return torsional(mesh.functions(), **shared)
    if case.dynamics.model == "fzg-12dof":
        return rig_of(case, mesh, damping, shared)
    return spur6(
        mesh.functions(),
        mass=[body[f"mass_{gear}"] for gear in _GEARS],
        bearing_stiffness=case.dynamics.bearing_stiffness or 0.0,
        bearing_damping=[damping.bearing_pinion, damping.bearing_wheel],
        **shared,
    )
