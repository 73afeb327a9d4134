"""A pair of cylindrical gears that move and tilt in space, each on springs of its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.structure.force_law import MeshForce, carried
from tribodyn.dynamics.structure.gear_pair import (
    Driver,
    ToothGap,
    TorqueBalance,
    pair_of,
    pair_system,
    tooth_contact,
)
from tribodyn.errors import InputError, require_between
from tribodyn.nomenclature import GEARS
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions

#: Coordinates of a pair of cylindrical gears in space, in their order.
HELICAL12_NAMES = tuple(
    f"{gear}_{way}" for gear in GEARS for way in ("x", "y", "z", "theta_x", "theta_y", "theta")
)


@dataclass(frozen=True, kw_only=True)
class SpatialSupports:
    """Supports of the gears of a pair in space, of pinion and wheel; the defaults are assumed.

    Parameters
    ----------
    bearing_stiffness, axial_bearing_stiffness : float or (2,) array [N/m]
        Across and along the axis of the gear.
    tilting_stiffness : float or (2,) array [N*m/rad]
        Against tilting of the gear.
    diametral_moment_of_inertia : float or (2,) array [kg*m^2], optional
        About any axis across that of the gear; half the polar one where left out.
    bearing_damping_ratio : float
        Damping of each of these springs over the critical value with the supported inertia.
    """

    bearing_stiffness: ArrayLike = 4e8
    axial_bearing_stiffness: ArrayLike = 2e8
    tilting_stiffness: ArrayLike = 5e6
    diametral_moment_of_inertia: ArrayLike | None = None
    bearing_damping_ratio: float = 0.02

    def __post_init__(self) -> None:
        units = {"tilting_stiffness": "N*m/rad"}
        for name in ("bearing_stiffness", "axial_bearing_stiffness", "tilting_stiffness"):
            values = pair_of(name, getattr(self, name), units.get(name, "N/m"))
            object.__setattr__(self, name, values)
        if self.diametral_moment_of_inertia is not None:
            name = "diametral_moment_of_inertia"
            object.__setattr__(self, name, pair_of(name, getattr(self, name), "kg*m^2"))
        require_between("bearing_damping_ratio", self.bearing_damping_ratio, 0.0, 10.0)


def helical12(
    mesh: MeshFunctions,
    *,
    mass: ArrayLike,
    moment_of_inertia: ArrayLike,
    torque: ArrayLike,
    supports: SpatialSupports | None = None,
    mesh_damping: Entry = 0.0,
    driver: Driver = "pinion",
    backlash: float = 0.0,
    error: Entry = 0.0,
    damping_in_gap: bool = False,
    torque_balance: TorqueBalance = "drive",
    mesh_force: MeshForce = "stiffness",
) -> System:
    """Build a pair of cylindrical gears with six coordinates each.

    Parameters
    ----------
    mesh : MeshFunctions
        From ``mesh_table.functions()`` of a cylindrical pair.
    mass, moment_of_inertia, torque
        As in :func:`spur6` [kg], [kg*m^2], [N*m].
    supports : SpatialSupports, optional
        Springs of the gears; assumed where left out.
    mesh_damping, driver, backlash, error, damping_in_gap, torque_balance
        As in :func:`spur6` [N*s/m], [m].
    mesh_force : "stiffness", "tangent" or "force-law"
        Force law of the teeth.

    Returns
    -------
    System
        Coordinates :data:`HELICAL12_NAMES`: ``x``, ``y`` and ``theta`` as those of :func:`spur6`,
        ``z`` along the axes in the sense of the pinion's rotation, ``theta_x`` and ``theta_y`` the
        right-handed rotations about x and y.

    Raises
    ------
    InputError
        If a value is out of range, or the mesh is not one of cylindrical gears.

    Notes
    -----
    The force of the mesh acts at the centre of the load, which moves along the path of contact
    and over the face: the moment that tilts the gears changes with it (shuttling). Axial force and
    moments over both gears balance. Source: statics; ISO 21771 for the base helix angle.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> row = np.array([0, 1, -0.3, 0, 0.01, 0.03, 0, -1, 0.3, 0, 0.015, -0.05])
    >>> flat = SimpleNamespace(stiffness=lambda p: 3e8 + 0 * p, event_phases=(0.0,),
    ...     spatial_direction=lambda p: np.tile(row, (np.size(p), 1)), spatial_friction=None)
    >>> helical12(flat, mass=1.0, moment_of_inertia=1e-3, torque=(90.0, 150.0))
    System(12 coordinates, 1 contact)
    """
    inertia, stiffness, damping = _bodies(
        pair_of("mass", mass, "kg"),
        pair_of("moment_of_inertia", moment_of_inertia, "kg*m^2"),
        supports or SpatialSupports(),
    )
    gap = ToothGap(mesh_damping, backlash, error, damping_in_gap)
    contact = tooth_contact(mesh, direction_in_space(mesh), mesh.spatial_friction, gap)
    return pair_system(
        HELICAL12_NAMES,
        ("pinion_theta", "wheel_theta"),
        mass=inertia,
        damping=damping,
        stiffness=stiffness,
        contacts=carried(contact, mesh, mesh_force),
        drive=(torque, driver, torque_balance),
    )


def direction_in_space(mesh: MeshFunctions) -> Entry:
    """Direction of the force of a mesh of cylindrical gears over all coordinates."""
    towards: Entry | None = getattr(mesh, "spatial_direction", None)
    if towards is None:
        why = "The gears of this structure are cylindrical and move in space"
        remedy = "Use the mesh table of a cylindrical pair, or another structure"
        raise InputError("the mesh has no directions in space", "argument mesh", why, remedy)
    return towards


def _bodies(mass: Array, polar: Array, springs: SpatialSupports) -> tuple[Array, Array, Array]:
    """Inertia, stiffness and damping of every coordinate."""
    across = springs.diametral_moment_of_inertia
    tilting = 0.5 * polar if across is None else np.asarray(across)
    inertia = np.stack((mass, mass, mass, tilting, tilting, polar), axis=1).ravel()
    radial, axial, tilt = (
        np.asarray(values)
        for values in (
            springs.bearing_stiffness,
            springs.axial_bearing_stiffness,
            springs.tilting_stiffness,
        )
    )
    stiffness = np.stack((radial, radial, axial, tilt, tilt, np.zeros(2)), axis=1).ravel()
    return inertia, stiffness, 2.0 * springs.bearing_damping_ratio * np.sqrt(stiffness * inertia)
