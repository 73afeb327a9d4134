"""What every model of one gear pair shares: contact directions, torques and their balance."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.system import Contact
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions


Driver = Literal["pinion", "wheel"]
TorqueBalance = Literal["drive", "load", "both"]


def pair_of(name: str, value: ArrayLike, unit: str, *, positive: bool = True) -> Array:
    """Read one value for both gears, or (pinion, wheel)."""
    array = np.asarray(value, dtype=float)
    if array.shape not in ((), (2,)):
        raise InputError(
            f"{name} has the shape {array.shape}",
            where=f"argument {name}",
            why="Give one value for both gears or two in the order (pinion, wheel)",
        )
    if positive:
        require_positive(name, array, unit)
    else:
        require_between(name, array, 0.0, np.inf, unit)
    return np.broadcast_to(array, (2,)).astype(float)


def _sign(driver: Driver) -> float:
    if driver not in ("pinion", "wheel"):
        raise InputError(f'driver = "{driver}"', where="argument driver", why='"pinion" or "wheel"')
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
    """Build the contact of one gear pair."""
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
    towards: Entry = direction[keep]
    if (varying := getattr(mesh, "direction", None)) is not None:
        towards = _columns(varying, keep)
    of_mesh = getattr(mesh, "friction", None) or friction
    return Contact(
        direction=towards,
        stiffness=mesh.stiffness,
        damping=mesh_damping,
        error=with_error_of(mesh, error),
        gap=0.5 * backlash,
        friction=_columns(of_mesh, keep),
        events=tuple(mesh.event_phases),
        damping_in_gap=damping_in_gap,
    )


def with_error_of(mesh: object, error: Entry) -> Entry:
    """Error of a contact: the one prescribed, and that of a mesh that has one of its own."""
    of_mesh = getattr(mesh, "error", None)
    if of_mesh is None:
        return error

    def both(phase: Array) -> Array:
        given = error(phase) if callable(error) else error
        return np.asarray(np.asarray(given, dtype=float) + of_mesh(phase))

    return both


def _columns(function: Callable[[Array], Array], keep: slice | list[int]) -> Callable[..., Array]:
    return lambda phase: function(phase)[:, keep]


def torques(torque: Array, driver: Driver) -> Array:
    """Torques in the running sense: positive on the driving gear, negative on the driven."""
    return np.asarray(torque * np.array([1.0, -1.0]) * _sign(driver))


def balance_direction(torque_balance: TorqueBalance, driver: Driver) -> Array | None:
    """Direction (pinion, wheel) of the torque that is found, or None if both are held."""
    drives = np.array([1.0, 0.0]) if _sign(driver) > 0 else np.array([0.0, 1.0])
    if torque_balance == "both":
        return None
    if torque_balance == "drive":
        return drives - 1.0
    if torque_balance == "load":
        return drives
    raise InputError(
        f'torque_balance = "{torque_balance}"',
        where="argument torque_balance",
        why='"drive" holds the driving torque, "load" the load torque, "both" both',
    )
