"""From a case and its mesh to the structure that vibrates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from tribodyn.study.geometry import geometry
from tribodyn.study.rig import rig_of

if TYPE_CHECKING:
    from tribodyn.dynamics import MeshForce, System
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case import Case
    from tribodyn.study.damping import Damping

__all__ = ["mesh_law_of", "static_error", "system_of"]

_GEARS = ("pinion", "wheel")


def mesh_law_of(case: Case) -> MeshForce:
    """How the teeth of a case carry: plain stiffness, tangent to the force law, or the law.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    "stiffness", "tangent" or "force-law"
    """
    from tribodyn.stiffness import MODELS

    if case.dynamics.mesh_law is not None:
        return cast("MeshForce", case.dynamics.mesh_law)
    whole = MODELS[case.stiffness.model].coupled or case.gear_pair.has_modification
    return "force-law" if whole else "stiffness"


def static_error(case: Case, phase: NDArray[np.float64] | float) -> NDArray[np.float64]:
    """Static transmission error of a case: a cosine at mesh frequency.

    Parameters
    ----------
    case : Case
        The case.
    phase : float or array
        Mesh phase.

    Returns
    -------
    array [m]
    """
    amplitude = case.dynamics.transmission_error_amplitude
    angle = 2.0 * np.pi * np.asarray(phase) + case.dynamics.transmission_error_phase
    return np.asarray(amplitude * np.cos(angle))


def system_of(case: Case, mesh: MeshTable, damping: Damping) -> System:
    """Build the structure of a case with its tooth contact.

    Parameters
    ----------
    case : Case
        The case.
    mesh : MeshTable
        Its tooth contact.
    damping : Damping
        Its damping.

    Returns
    -------
    System
    """
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
