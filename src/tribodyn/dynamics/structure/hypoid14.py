"""The hypoid pair with fourteen coordinates: both gears in space, engine and load on shafts."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

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
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions

_WAYS = ("x", "y", "z", "theta_x", "theta", "theta_z")
#: Coordinates of the structure of a hypoid pair, in their order.
HYPOID14_NAMES = (
    "engine_theta",
    *(f"{gear}_{way}" for gear in ("pinion", "wheel") for way in _WAYS),
    "load_theta",
)
_SPINS = ("engine_theta", "pinion_theta", "wheel_theta", "load_theta")
#: Places of the turning coordinates from the engine to the load.
_TRAIN = [HYPOID14_NAMES.index(name) for name in _SPINS]


@dataclass(frozen=True, kw_only=True)
class HypoidSupports:
    """Shafts and bearings of a hypoid pair, of pinion and wheel; the defaults are assumed.

    Parameters
    ----------
    engine_moment_of_inertia, load_moment_of_inertia : float [kg*m^2]
        Inertia at the other end of the pinion's shaft, and of the wheel's.
    diametral_moment_of_inertia : float or (2,) array [kg*m^2]
        Moments of inertia about any axis across that of the gear.
    bearing_stiffness, axial_bearing_stiffness : float or (2,) array [N/m]
        Across and along the axis of the gear.
    tilting_stiffness : float or (2,) array [N*m/rad]
        Of the bearings against tilting of the gear.
    shaft_stiffness : float or (2,) array [N*m/rad]
        Against twist between engine and pinion, and between wheel and load.
    bearing_damping_ratio, shaft_damping_ratio : float
        Damping of each of these springs over the critical value with the supported inertia.
    """

    engine_moment_of_inertia: float = 0.006
    load_moment_of_inertia: float = 0.1
    diametral_moment_of_inertia: ArrayLike = (0.05, 0.5)
    bearing_stiffness: ArrayLike = 4e8
    axial_bearing_stiffness: ArrayLike = (2e8, 2.5e8)
    tilting_stiffness: ArrayLike = (5e6, 1e7)
    shaft_stiffness: ArrayLike = (1e5, 5e5)
    bearing_damping_ratio: float = 0.03
    shaft_damping_ratio: float = 0.03

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            unit = _UNITS.get(each.name.rpartition("_")[2], "")
            if each.name.endswith("ratio"):
                require_between(each.name, value, 0.0, 10.0, unit)
            elif each.name.startswith(("engine", "load")):
                require_positive(each.name, value, unit)
            else:
                object.__setattr__(self, each.name, pair_of(each.name, value, unit))


_UNITS = {"inertia": "kg*m^2", "stiffness": "N/m"}


def hypoid14(
    mesh: MeshFunctions,
    *,
    mass: ArrayLike,
    moment_of_inertia: ArrayLike,
    torque: ArrayLike,
    supports: HypoidSupports | None = None,
    mesh_damping: Entry = 0.0,
    driver: Driver = "pinion",
    backlash: float = 0.0,
    error: Entry = 0.0,
    damping_in_gap: bool = False,
    torque_balance: TorqueBalance = "drive",
    mesh_force: MeshForce = "stiffness",
) -> System:
    """Build the hypoid pair with engine and load.

    Parameters
    ----------
    mesh : MeshFunctions
        Of a mesh table in space: its directions have six components for each gear.
    mass, moment_of_inertia : float or (2,) array
        Masses [kg] and polar moments of inertia [kg*m^2] of pinion and wheel.
    torque : (2,) array
        Sizes of the nominal torques on pinion and wheel [N*m].
    supports : HypoidSupports, optional
        Shafts and bearings; assumed where left out.
    mesh_damping, driver, backlash, error, damping_in_gap
        As in :func:`spur6` [N*s/m], [m].
    torque_balance : "drive", "load" or "both"
        Torque that is prescribed when friction acts; torques act on engine and load.
    mesh_force : "stiffness", "tangent" or "force-law"
        Force law of the teeth.

    Returns
    -------
    System
        Coordinates :data:`HYPOID14_NAMES`: for each gear x along the common perpendicular of the
        axes, y along its axis in the sense of its rotation, z = x cross y, about the point
        where the perpendicular meets the axis; ``theta`` is the rotation about y.

    Raises
    ------
    InputError
        If a value is out of range, or the mesh has no directions in space.

    Notes
    -----
    The four rotations ``theta`` have no spring to the ground: the drive has one rigid motion.
    Source: the structure of a published study of hypoid gears with mixed lubrication, which
    gives masses of both gears and inertias of engine and load only.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> row = np.array([0, 1, 0, 0, 0.03, 0, 0, 0, -1, 0, -0.12, 0.0])
    >>> flat = SimpleNamespace(stiffness=lambda p: 5e8 + 0 * p, event_phases=(0.0,),
    ...     direction=lambda p: np.tile(row, (np.size(p), 1)), friction=None)
    >>> hypoid14(flat, mass=(11.4, 49.5), moment_of_inertia=(0.0125, 0.9), torque=(500, 2000))
    System(14 coordinates, 1 contact)
    """
    bearings = supports or HypoidSupports()
    inertia = _inertia(
        pair_of("mass", mass, "kg"),
        pair_of("moment_of_inertia", moment_of_inertia, "kg*m^2"),
        bearings,
    )
    stiffness, damping = _springs(inertia, bearings)
    along, rubbing = in_space(mesh)
    gap = ToothGap(mesh_damping, backlash, error, damping_in_gap)
    contact = tooth_contact(mesh, along, rubbing, gap)
    return pair_system(
        HYPOID14_NAMES,
        ("engine_theta", "load_theta"),
        mass=inertia,
        damping=damping,
        stiffness=stiffness,
        contacts=carried(contact, mesh, mesh_force),
        drive=(torque, driver, torque_balance),
    )


def in_space(mesh: Any) -> tuple[Entry, Entry | None]:
    """Direction and friction of a mesh over all coordinates, zero for engine and load."""

    def padded(entry: Any) -> Entry:
        return lambda phase: np.pad(entry(phase), ((0, 0), (1, 1)))

    direction, friction = directions_of_crossed_axes(mesh)
    return padded(direction), None if friction is None else padded(friction)


def directions_of_crossed_axes(mesh: object) -> tuple[Entry, Entry | None]:
    """Direction and friction of a mesh over the coordinates of both gears."""
    entries: list[Entry | None] = []
    for function in (getattr(mesh, "direction", None), getattr(mesh, "friction", None)):
        size = 0 if function is None else np.shape(function(np.zeros(1)))[-1]
        if size != 2 * len(_WAYS) and not (function is None and entries):
            why = "Gears with crossed axes need six components for each gear"
            remedy = "Use the mesh table of a hypoid pair, or another structure"
            raise InputError("the mesh has no directions in space", "argument mesh", why, remedy)
        entries.append(function)
    return entries[0], entries[1]  # type: ignore[return-value]


def _inertia(mass: Array, polar: Array, supports: HypoidSupports) -> Array:
    across = np.asarray(supports.diametral_moment_of_inertia)
    gears = [[m, m, m, d, p, d] for m, p, d in zip(mass, polar, across, strict=True)]
    return np.concatenate(
        ([supports.engine_moment_of_inertia], *gears, [supports.load_moment_of_inertia])
    ).astype(float)


def _springs(inertia: Array, supports: HypoidSupports) -> tuple[Array, Array]:
    """Stiffness, and a damper parallel to every spring as a part of the critical value."""
    radial = np.asarray(supports.bearing_stiffness)
    axial = np.asarray(supports.axial_bearing_stiffness)
    tilting = np.asarray(supports.tilting_stiffness)
    gears = [[r, a, r, t, 0.0, t] for r, a, t in zip(radial, axial, tilting, strict=True)]
    grounded = np.concatenate(([0.0], *gears, [0.0]))
    stiffness = np.diag(grounded)
    damping = np.diag(2.0 * supports.bearing_damping_ratio * np.sqrt(grounded * inertia))
    twist = np.array([[1.0, -1.0], [-1.0, 1.0]])
    for spring, ends in zip(
        np.asarray(supports.shaft_stiffness), (_TRAIN[:2], _TRAIN[2:]), strict=True
    ):
        reduced = 1.0 / np.sum(1.0 / inertia[ends])
        stiffness[np.ix_(ends, ends)] += spring * twist
        critical = 2.0 * np.sqrt(spring * reduced)
        damping[np.ix_(ends, ends)] += supports.shaft_damping_ratio * critical * twist
    return stiffness, damping
