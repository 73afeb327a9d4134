"""Damping in force: the values given, or the ratios turned into values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tribodyn.study.geometry import geometry
from tribodyn.study.provenance import effective

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case import Case

__all__ = ["Damping", "damping_of", "equivalent_mass"]


@dataclass(frozen=True)
class Damping:
    """Damping coefficients of a case.

    Parameters
    ----------
    mesh : float
        Of the tooth contact along the line of action [N*s/m].
    bearing_pinion, bearing_wheel : float
        Of each gear's support in each direction [N*s/m]; zero without supports.
    """

    mesh: float
    bearing_pinion: float
    bearing_wheel: float


def equivalent_mass(
    inertia_pinion: float, inertia_wheel: float, radius_pinion: float, radius_wheel: float
) -> float:
    """Mass that vibrates along the line of action when both gears turn freely.

    Parameters
    ----------
    inertia_pinion, inertia_wheel : float
        Moments of inertia [kg*m^2].
    radius_pinion, radius_wheel : float
        Base radii [m].

    Returns
    -------
    float [kg]

    Notes
    -----
    ``m_e = I_p I_g / (I_p r_bg^2 + I_g r_bp^2)``.

    Examples
    --------
    >>> round(equivalent_mass(407e-6, 1168e-6, 33.828934e-3, 50.743402e-3), 5)
    0.19935
    """
    weighted = inertia_pinion * radius_wheel**2 + inertia_wheel * radius_pinion**2
    return inertia_pinion * inertia_wheel / weighted


def damping_of(case: Case, mesh: MeshTable) -> Damping:
    """Damping of a case.

    Parameters
    ----------
    case : Case
        The case.
    mesh : MeshTable
        Its tooth contact, for the mean stiffness.

    Returns
    -------
    Damping
        From ratios: mesh ``2 zeta sqrt(K m_e)`` with the mean mesh stiffness, supports
        ``2 zeta sqrt(k m)`` with the mass of each gear.
    """
    data, body = case.dynamics, geometry(case)
    mesh_damping = data.mesh_damping
    if mesh_damping is None:
        mass = equivalent_mass(
            body["moment_of_inertia_pinion"], body["moment_of_inertia_wheel"],
            body["base_radius_pinion"], body["base_radius_wheel"],
        )  # fmt: skip
        mesh_damping = 2.0 * data.mesh_damping_ratio * math.sqrt(mesh.mean_mesh_stiffness * mass)
    return Damping(
        mesh_damping, _support(case, body["mass_pinion"]), _support(case, body["mass_wheel"])
    )


def _support(case: Case, mass: float) -> float:
    data = case.dynamics
    stiffness = effective(case)["dynamics.bearing_stiffness"]
    if stiffness is None:
        return 0.0
    if data.bearing_damping is not None:
        return data.bearing_damping
    return 2.0 * data.bearing_damping_ratio * math.sqrt(stiffness * mass)
