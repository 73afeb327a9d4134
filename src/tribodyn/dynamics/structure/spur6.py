"""The 6-DOF spur gear pair: each gear moves along and across the line of action and turns."""

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


SPUR6_NAMES = ("pinion_x", "pinion_y", "pinion_theta", "wheel_x", "wheel_y", "wheel_theta")


def spur6(
    mesh: MeshFunctions,
    *,
    mass: ArrayLike,
    moment_of_inertia: ArrayLike,
    base_radius: ArrayLike,
    torque: ArrayLike,
    bearing_stiffness: ArrayLike,
    bearing_damping: ArrayLike = 0.0,
    mesh_damping: Entry = 0.0,
    driver: Driver = "pinion",
    backlash: float = 0.0,
    error: Entry = 0.0,
    damping_in_gap: bool = False,
    torque_balance: TorqueBalance = "drive",
    mesh_force: MeshForce = "stiffness",
) -> System:
    """Build the 6-DOF spur gear pair.

    Parameters
    ----------
    mesh : MeshFunctions
        From ``mesh_table.functions()``, or anything with the same functions of phase.
    mass : float or (2,) array
        Masses (pinion, wheel) [kg].
    moment_of_inertia : float or (2,) array
        Polar moments of inertia [kg*m^2].
    base_radius : (2,) array
        Base radii [m].
    torque : (2,) array
        Sizes of the nominal torques [N*m].
    bearing_stiffness : float or (2,) array
        Radial stiffness of each support, the same in x and y [N/m].
    bearing_damping : float or (2,) array
        Radial damping of each support [N*s/m].
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
        Coordinates ``pinion_x, pinion_y, pinion_theta, wheel_x, wheel_y, wheel_theta``: y along
        the line of action from the driving to the driven gear for the pinion driving, x across
        it in the direction of the surface speeds, angles positive in the running sense.

    Raises
    ------
    InputError
        If a value is out of range, or the mesh does not have what ``mesh_force`` needs.

    Notes
    -----
    Source: He, Gunda and Singh (2007), with the signs of friction and damping derived from
    virtual work.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> flat = SimpleNamespace(stiffness=lambda p: 3e8 + 0 * p, friction_sum=lambda p: 0 * p,
    ...     friction_moment_pinion=lambda p: 0 * p, friction_moment_wheel=lambda p: 0 * p,
    ...     event_phases=(0.0,))
    >>> spur6(flat, mass=1.0, moment_of_inertia=1e-3, base_radius=(0.03, 0.05),
    ...     torque=(90.0, 150.0), bearing_stiffness=1e9)
    System(6 coordinates, 1 contact)
    """
    m = pair_of("mass", mass, "kg")
    inertia = pair_of("moment_of_inertia", moment_of_inertia, "kg*m^2")
    stiffness = pair_of("bearing_stiffness", bearing_stiffness, "N/m")
    damping = pair_of("bearing_damping", bearing_damping, "N*s/m", positive=False)
    turning = torques(pair_of("torque", torque, "N*m", positive=False), driver)
    balance = balance_direction(torque_balance, driver)
    contacts = gear_contacts(
        mesh,
        mesh_force=mesh_force,
        base_radius=pair_of("base_radius", base_radius, "m"),
        driver=driver,
        mesh_damping=mesh_damping,
        backlash=backlash,
        error=error,
        damping_in_gap=damping_in_gap,
        supports=True,
    )
    return System(
        mass=np.diag([m[0], m[0], inertia[0], m[1], m[1], inertia[1]]),
        damping=np.diag([damping[0], damping[0], 0.0, damping[1], damping[1], 0.0]),
        stiffness=np.diag([stiffness[0], stiffness[0], 0.0, stiffness[1], stiffness[1], 0.0]),
        force=[0.0, 0.0, turning[0], 0.0, 0.0, turning[1]],
        contacts=contacts,
        names=SPUR6_NAMES,
        balance=None if balance is None else [0.0, 0.0, balance[0], 0.0, 0.0, balance[1]],
    )
