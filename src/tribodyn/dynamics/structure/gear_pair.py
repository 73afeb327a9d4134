"""Models of one gear pair, and their contact directions, torques and balance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.system import Contact, System
from tribodyn.dynamics.structure.force_law import (
    MeshForce,
    carried,
    friction_direction,
    plane_rows,
    sum_of,
)
from tribodyn.errors import InputError, require_between, require_one_of, require_positive
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions


Driver = Literal["pinion", "wheel"]
TorqueBalance = Literal["drive", "load", "both"]


def row_of(
    name: str, value: ArrayLike, count: int, unit: str, *, positive: bool = True, why: str = ""
) -> Array:
    """Read one value for all items, or one for each."""
    array = np.asarray(value, dtype=float)
    if array.shape not in ((), (count,)):
        raise InputError(
            f"{name} has the shape {array.shape}",
            where=f"argument {name}",
            why=why or f"Give one value, or {count} of them",
            remedy="Give one value for all, or a list of them",
        )
    if not array.size:  # a shaft of one disc has no springs
        return array
    if positive:
        require_positive(name, array, unit)
    else:
        require_between(name, array, 0.0, np.inf, unit)
    return np.full(count, array)


def pair_of(name: str, value: ArrayLike, unit: str, *, positive: bool = True) -> Array:
    """Read one value for both gears, or (pinion, wheel)."""
    why = "Give one value for both gears or two in the order (pinion, wheel)"
    return row_of(name, value, 2, unit, positive=positive, why=why)


def _sign(driver: Driver) -> float:
    require_one_of("driver", driver, ("pinion", "wheel"))
    return 1.0 if driver == "pinion" else -1.0


class ToothGap(NamedTuple):
    """What a structure states of its teeth, apart from the mesh."""

    mesh_damping: Entry
    backlash: float
    error: Entry
    damping_in_gap: bool


def gear_contact(
    mesh: MeshFunctions,
    names: tuple[str, ...],
    *,
    base_radius: Array,
    driver: Driver,
    gap: ToothGap,
) -> Contact:
    """Build the contact of one gear pair over the coordinates of its structure."""
    rows, supports = plane_rows(names), len(names) > len(TORSIONAL_NAMES)
    keep = slice(None) if supports else [2, 5]
    towards: Entry = _sign(driver) * (rows[0] + base_radius @ rows[2:])
    if (varying := getattr(mesh, "direction", None)) is not None:
        keep = _direction_columns(varying, supports)
        towards = _columns(varying, keep)
    of_mesh = getattr(mesh, "friction", None)
    rub: Entry | None = None if of_mesh is None else _columns(of_mesh, keep)
    # In space the friction follows from its direction; the three sums describe a plane.
    if of_mesh is None and keep != [4, 10] and mesh.friction_sum is not None:
        rub = friction_direction(mesh, rows[1:])
    return tooth_contact(mesh, towards, rub, gap)


def tooth_contact(
    mesh: MeshFunctions, direction: Entry, friction: Entry | None, gap: ToothGap
) -> Contact:
    """Build the contact of the teeth of a mesh from its direction and its friction."""
    require_between("backlash", gap.backlash, 0.0, np.inf, "m")
    return Contact(
        direction=direction,
        stiffness=mesh.stiffness,
        damping=gap.mesh_damping,
        error=with_error_of(mesh, gap.error),
        gap=0.5 * gap.backlash,
        friction=friction,
        events=tuple(mesh.event_phases),
        damping_in_gap=gap.damping_in_gap,
    )


def _direction_columns(direction: Callable[[Array], Array], supports: bool) -> slice | list[int]:
    """Columns of a direction that a structure has: all of a plane, or both gear rotations."""
    in_space = np.shape(direction(np.zeros(1)))[-1] == 12
    if in_space and supports:
        why = "The gears of this structure move in one plane"
        remedy = "Use hypoid14, or torsional, which has gear rotations only"
        raise InputError("the mesh has directions in space", "argument mesh", why, remedy)
    if supports:
        return slice(None)
    return [4, 10] if in_space else [2, 5]


def with_error_of(mesh: object, error: Entry) -> Entry:
    """Error of a contact: the prescribed error plus that of the mesh, if it has one."""
    of_mesh = getattr(mesh, "error", None)
    return error if of_mesh is None else sum_of(error, of_mesh)


def _columns(function: Callable[[Array], Array], keep: slice | list[int]) -> Callable[..., Array]:
    return lambda phase: function(phase)[:, keep]


def torques(torque: Array, driver: Driver) -> Array:
    """Torques in the running sense: positive on the driving gear, negative on the driven."""
    return np.asarray(torque * np.array([1.0, -1.0]) * _sign(driver))


def balance_direction(torque_balance: TorqueBalance, driver: Driver) -> Array | None:
    """Direction (pinion, wheel) of the balancing torque, or None if both torques are prescribed."""
    drives = np.array([1.0, 0.0]) if _sign(driver) > 0 else np.array([0.0, 1.0])
    if torque_balance == "both":
        return None
    if torque_balance == "drive":
        return drives - 1.0
    if torque_balance == "load":
        return drives
    what = f'torque_balance = "{torque_balance}"'
    why = '"drive" prescribes the driving torque, "load" the load torque, "both" both'
    raise InputError(what, "argument torque_balance", why, "Choose one of these")


def pair_system(
    names: tuple[str, ...],
    turning: tuple[str, str],
    *,
    mass: Array,
    damping: Array,
    stiffness: Array,
    contacts: Sequence[Contact],
    drive: tuple[ArrayLike, Driver, TorqueBalance],
) -> System:
    """System of one pair from its matrices, or their diagonals, and what turns at two places."""
    torque, driver, torque_balance = drive
    pair = pair_of("torque", torque, "N*m", positive=False)
    rotations = [names.index(name) for name in turning]

    def spread(values: Array) -> Array:
        out = np.zeros(len(names))
        out[rotations] = values
        return out

    mass, damping, stiffness = (
        each if each.ndim == 2 else np.diag(each) for each in (mass, damping, stiffness)
    )
    force, balance = torques(pair, driver), balance_direction(torque_balance, driver)
    balancing = None if balance is None else spread(balance)
    return System(mass, damping, stiffness, spread(force), contacts, names, balancing)


#: Coordinates of a gear pair with 6 degrees of freedom, in their order.
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
        Driving gear.
    backlash : float
        Total backlash along the line of action [m]. With zero the flanks never separate: the force
        of one stiffness is then linear, that of a force law the same in tension and compression.
    error : float or function
        Displacement error subtracted from the compression [m].
    damping_in_gap : bool
        Keep the mesh damping in free flight.
    torque_balance : "drive", "load" or "both"
        Torque that is prescribed when friction acts; the steady state determines the other one.
    mesh_force : "stiffness", "tangent" or "force-law"
        Force law of the teeth: the mesh stiffness; the tangent stiffness, displaced so that the
        nominal static load gives the static transmission error; or the force law of the mesh, one
        contact for each of its ramps.

    Returns
    -------
    System
        Coordinates ``pinion_x, pinion_y, pinion_theta, wheel_x, wheel_y, wheel_theta``: y along
        the line of action from the driving to the driven gear for a driving pinion, x across
        it in the direction of the surface speeds, angles positive in the direction of rotation.

    Raises
    ------
    InputError
        If a value is out of range, or the mesh does not have the data that ``mesh_force`` needs.

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
    contact = gear_contact(
        mesh,
        SPUR6_NAMES,
        base_radius=pair_of("base_radius", base_radius, "m"),
        driver=driver,
        gap=ToothGap(mesh_damping, backlash, error, damping_in_gap),
    )
    return pair_system(
        SPUR6_NAMES,
        ("pinion_theta", "wheel_theta"),
        mass=np.array([m[0], m[0], inertia[0], m[1], m[1], inertia[1]]),
        damping=np.array([damping[0], damping[0], 0.0, damping[1], damping[1], 0.0]),
        stiffness=np.array([stiffness[0], stiffness[0], 0.0, stiffness[1], stiffness[1], 0.0]),
        contacts=carried(contact, mesh, mesh_force),
        drive=(torque, driver, torque_balance),
    )


#: Coordinates of a torsional gear pair, in their order.
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
    mesh, moment_of_inertia, base_radius, torque
        As in :func:`spur6` [kg*m^2], [m], [N*m].
    mesh_damping, driver, backlash, error, damping_in_gap, torque_balance
        As in :func:`spur6` [N*s/m], [m].
    mesh_force : "stiffness", "tangent" or "force-law"
        Force law of the teeth.

    Returns
    -------
    System
        Coordinates ``pinion_theta, wheel_theta``, positive in the direction of rotation.

    Raises
    ------
    InputError
        If a value is out of range, or the mesh does not have the data that ``mesh_force`` needs.

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
    contact = gear_contact(
        mesh,
        TORSIONAL_NAMES,
        base_radius=pair_of("base_radius", base_radius, "m"),
        driver=driver,
        gap=ToothGap(mesh_damping, backlash, error, damping_in_gap),
    )
    return pair_system(
        TORSIONAL_NAMES,
        TORSIONAL_NAMES,
        mass=inertia,
        damping=np.zeros(2),
        stiffness=np.zeros(2),
        contacts=carried(contact, mesh, mesh_force),
        drive=(torque, driver, torque_balance),
    )
