"""What every model of one gear pair shares: contact directions, torques and their balance."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tribodyn.dynamics.system import Contact, Entry
from tribodyn.errors import InputError, Problem, require_between, require_positive

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions

__all__ = ["Driver", "TorqueBalance", "balance_direction", "gear_contact", "pair_of", "torques"]

Array = NDArray[np.float64]
Driver = Literal["pinion", "wheel"]
TorqueBalance = Literal["drive", "load", "both"]


def pair_of(name: str, value: ArrayLike, unit: str, *, positive: bool = True) -> Array:
    """Read one value for both gears, or (pinion, wheel).

    Parameters
    ----------
    name : str
        Argument name for messages.
    value : float or (2,) array
        Value in ``unit``.
    unit : str
        Unit for messages.
    positive : bool
        Whether zero is refused too.

    Returns
    -------
    (2,) array

    Raises
    ------
    InputError
        If there are not one or two values, or one is out of range.

    Examples
    --------
    >>> pair_of("mass", 2.0, "kg").tolist()
    [2.0, 2.0]
    """
    array = np.asarray(value, dtype=float)
    if array.shape not in ((), (2,)):
        raise InputError(
            Problem(
                what=f"{name} has the shape {array.shape}",
                where=f"argument {name}",
                why="Give one value for both gears or two in the order (pinion, wheel)",
            )
        )
    if positive:
        require_positive(name, array, unit)
    else:
        require_between(name, array, 0.0, np.inf, unit)
    return np.broadcast_to(array, (2,)).astype(float)


def _sign(driver: Driver) -> float:
    if driver not in ("pinion", "wheel"):
        raise InputError(
            Problem(what=f'driver = "{driver}"', where="argument driver", why='"pinion" or "wheel"')
        )
    return 1.0 if driver == "pinion" else -1.0


def gear_contact(
    mesh: MeshFunctions,
    *,
    base_radius: Array,
    driver: Driver,
    mesh_damping: Entry,
    backlash: float,
    error: Entry,
    damping_in_gap: bool,
    supports: bool,
) -> Contact:
    """Build the contact of one gear pair.

    Parameters
    ----------
    mesh : MeshFunctions
        Stiffness and friction sums over the mesh phase.
    base_radius : (2,) array
        Base radii (pinion, wheel) [m].
    driver : "pinion" or "wheel"
        Which gear drives.
    mesh_damping : float or function
        Damping along the line of action [N*s/m].
    backlash : float
        Total play along the line of action [m].
    error : float or function
        Displacement error taken off the compression [m].
    damping_in_gap : bool
        Keep the damping in free flight.
    supports : bool
        Whether the coordinates are (x, y, theta) of each gear, or theta alone.

    Returns
    -------
    Contact

    Raises
    ------
    InputError
        If the backlash is negative or ``driver`` is neither gear.

    Notes
    -----
    With the pinion driving ``delta = r_bp theta_p - r_bw theta_w + y_p - y_w - e``; with the
    wheel driving every sign of ``h`` turns over, since the other flanks touch. Friction acts on
    the pinion against its sliding over the wheel, whichever gear drives.
    """
    require_between("backlash", backlash, 0.0, np.inf, "m")
    sign = _sign(driver)
    radius_pinion, radius_wheel = base_radius
    direction = np.array([0.0, 1.0, radius_pinion, 0.0, -1.0, -radius_wheel]) * sign

    def friction(phase: Array) -> Array:
        across = np.asarray(mesh.friction_sum(phase))
        return np.stack(
            (
                across,
                np.zeros_like(across),
                np.asarray(mesh.friction_moment_pinion(phase)),
                -across,
                np.zeros_like(across),
                -np.asarray(mesh.friction_moment_wheel(phase)),
            ),
            axis=-1,
        )

    keep = slice(None) if supports else [2, 5]
    return Contact(
        direction=direction[keep],
        stiffness=mesh.stiffness,
        damping=mesh_damping,
        error=error,
        gap=0.5 * backlash,
        friction=_columns(friction, keep),
        events=tuple(mesh.event_phases),
        damping_in_gap=damping_in_gap,
    )


def _columns(function: Callable[[Array], Array], keep: slice | list[int]) -> Callable[..., Array]:
    return lambda phase: function(phase)[:, keep]


def torques(torque: Array, driver: Driver) -> Array:
    """Torques in the running sense: positive on the driving gear, negative on the driven.

    Parameters
    ----------
    torque : (2,) array
        Sizes (pinion, wheel) [N*m].
    driver : "pinion" or "wheel"
        Which gear drives.

    Returns
    -------
    (2,) array
        In N*m.

    Examples
    --------
    >>> torques(np.array([90.0, 135.0]), "wheel").tolist()
    [-90.0, 135.0]
    """
    return np.asarray(torque * np.array([1.0, -1.0]) * _sign(driver))


def balance_direction(torque_balance: TorqueBalance, driver: Driver) -> Array | None:
    """Direction (pinion, wheel) of the torque that is found, or None if both are held.

    Parameters
    ----------
    torque_balance : "drive", "load" or "both"
        Which torque is held when friction acts.
    driver : "pinion" or "wheel"
        Which gear drives.

    Returns
    -------
    (2,) array or None

    Raises
    ------
    InputError
        If ``torque_balance`` is none of the three.

    Examples
    --------
    >>> balance_direction("drive", "pinion").tolist()
    [0.0, -1.0]
    """
    drives = np.array([1.0, 0.0]) if _sign(driver) > 0 else np.array([0.0, 1.0])
    if torque_balance == "both":
        return None
    if torque_balance == "drive":
        return drives - 1.0
    if torque_balance == "load":
        return drives
    raise InputError(
        Problem(
            what=f'torque_balance = "{torque_balance}"',
            where="argument torque_balance",
            why='"drive" holds the driving torque, "load" the load torque, "both" both',
        )
    )
