"""The torsional gear pair: two rotating inertias coupled by the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.structure.force_law import MeshForce, gear_contacts
from tribodyn.dynamics.structure.gear_pair import (
    Driver,
    TorqueBalance,
    balance_direction,
    pair_of,
    torques,
)

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions


TORSIONAL_NAMES = ("pinion_theta", "wheel_theta")


def torsional(
    mesh: MeshFunctions,
    *,
    moment_of_inertia: ArrayLike,
    base_radius: ArrayLike,
    torque: ArrayLike,
    mesh_damping: Entry = 0.0,
    driver: Driver = "pinion",
    backlash: float = 0.0,
    error: Entry = 0.0,
    damping_in_gap: bool = False,
    torque_balance: TorqueBalance = "drive",
    mesh_force: MeshForce = "stiffness",
) -> System:
    """Build the torsional gear pair on rigid supports.

    Parameters
    ----------
    mesh : MeshFunctions
        From ``mesh_table.functions()``, or anything with the same functions of phase.
    moment_of_inertia : float or (2,) array
        Polar moments of inertia (pinion, wheel) [kg*m^2].
    base_radius : (2,) array
        Base radii [m].
    torque : (2,) array
        Sizes of the nominal torques [N*m].
    mesh_damping : float or function
        Damping along the line of action [N*s/m].
    driver : "pinion" or "wheel"
        Which gear drives.
    backlash : float
        Total play along the line of action [m]. Zero keeps the flanks together: the force of one
        stiffness is then linear, that of a force law the same for tension as for compression.
    error : float or function
        Displacement error taken off the compression [m].
    damping_in_gap : bool
        Keep the mesh damping in free flight.
    torque_balance : "drive", "load" or "both"
        Which torque is held when friction acts; the other one is found by the steady state.
    mesh_force : "stiffness", "tangent" or "force-law"
        How the teeth carry: with the mesh stiffness; with the tangent stiffness, displaced so that
        the nominal load at rest gives the static transmission error; or with the force law of the
        mesh, one contact for each of its ramps.

    Returns
    -------
    System
        Coordinates ``pinion_theta, wheel_theta``, positive in the running sense.

    Raises
    ------
    InputError
        If a value is out of range, or the mesh does not have what ``mesh_force`` needs.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> flat = SimpleNamespace(stiffness=lambda p: 3e8 + 0 * p, friction_sum=lambda p: 0 * p,
    ...     friction_moment_pinion=lambda p: 0 * p, friction_moment_wheel=lambda p: 0 * p,
    ...     event_phases=(0.0,))
    >>> torsional(flat, moment_of_inertia=1e-3, base_radius=(0.03, 0.05), torque=(90.0, 150.0))
    System(2 coordinates, 1 contact)
    """
    inertia = pair_of("moment_of_inertia", moment_of_inertia, "kg*m^2")
    contacts = gear_contacts(
        mesh,
        mesh_force=mesh_force,
        base_radius=pair_of("base_radius", base_radius, "m"),
        driver=driver,
        mesh_damping=mesh_damping,
        backlash=backlash,
        error=error,
        damping_in_gap=damping_in_gap,
        supports=False,
    )
    return System(
        mass=np.diag(inertia),
        damping=np.zeros((2, 2)),
        stiffness=np.zeros((2, 2)),
        force=torques(pair_of("torque", torque, "N*m", positive=False), driver),
        contacts=contacts,
        names=TORSIONAL_NAMES,
        balance=balance_direction(torque_balance, driver),
    )
