"""Shafts as chains of discs, and drives with several meshes assembled from them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.system import Contact, System
from tribodyn.dynamics.structure.force_law import friction_direction, plane_rows
from tribodyn.dynamics.structure.gear_pair import Driver, row_of
from tribodyn.errors import InputError, require_between, require_one_of, require_positive
from tribodyn.types import Array


@dataclass(frozen=True)
class Body:
    """A part of a drive without its meshes.

    Parameters
    ----------
    names : tuple of str
        Names of its coordinates: ``<disc>_theta``, and ``<disc>_x``, ``<disc>_y`` if it can move.
    mass, damping, stiffness : (n, n) array
        Matrices of the part [kg or kg*m^2, N*s/m or N*m*s, N/m or N*m].
    """

    names: tuple[str, ...]
    mass: Array
    damping: Array
    stiffness: Array

    def __repr__(self) -> str:
        """One line."""
        return f"Body({', '.join(self.names)})"


@dataclass(frozen=True)
class GearMesh:
    """A mesh between two discs of a drive.

    Parameters
    ----------
    pinion, wheel : str
        Names of the two discs.
    base_radius : (2,) array
        Base radii (pinion, wheel) [m].
    stiffness : float or function
        Mesh stiffness over the mesh phase [N/m].
    damping : float or function
        Damping along the line of action [N*s/m].
    error : float or function
        Displacement error subtracted from the compression [m].
    backlash : float
        Total backlash along the line of action [m]. With zero the flanks never separate.
    events : tuple of float
        Mesh phases at which an entry jumps.
    driver : "pinion" or "wheel"
        Driving gear.
    line_angle : float
        Direction of the line of action from the driving to the driven gear in the plane of x and
        y, from x to y, for a driving pinion [rad].
    friction : object, optional
        With ``friction_sum``, ``friction_moment_pinion`` and ``friction_moment_wheel`` over the
        mesh phase, such as ``mesh_table.functions()``.
    cycles : int
        Mesh cycles of this mesh in the common cycle of all meshes.
    lag : float
        Mesh phase of this mesh at the start of the common cycle, in [0, 1) [1].
    """

    pinion: str
    wheel: str
    base_radius: ArrayLike
    stiffness: Entry
    damping: Entry = 0.0
    error: Entry = 0.0
    backlash: float = 0.0
    events: tuple[float, ...] = (0.0,)
    driver: Driver = "pinion"
    line_angle: float = 0.5 * np.pi
    friction: Any = None
    cycles: int = 1
    lag: float = 0.0


def torsional_stiffness(
    diameter: float, length: float, *, bore: float = 0.0, shear_modulus: float = 79.3e9
) -> float:
    """Torsional stiffness of a round shaft.

    Parameters
    ----------
    diameter : float
        Outer diameter [m].
    length : float
        Length [m].
    bore : float
        Diameter of the bore [m].
    shear_modulus : float
        Shear modulus [Pa].

    Returns
    -------
    float
        ``pi G (D^4 - d^4)/(32 L)`` [N*m/rad].

    Raises
    ------
    InputError
        If a size is not positive, or the bore is not smaller than the shaft.

    Examples
    --------
    >>> round(torsional_stiffness(0.03, 0.1), 1)
    63060.6
    """
    require_positive("diameter", diameter, "m")
    require_positive("length", length, "m")
    require_positive("shear_modulus", shear_modulus, "Pa")
    require_between("bore", bore, 0.0, float(np.nextafter(diameter, 0.0)), "m")
    return float(np.pi * shear_modulus * (diameter**4 - bore**4) / (32.0 * length))


def shaft_chain(
    names: Sequence[str],
    moment_of_inertia: ArrayLike,
    stiffness: ArrayLike = (),
    *,
    damping: ArrayLike = 0.0,
    mass: ArrayLike | None = None,
    bearing_stiffness: ArrayLike = 0.0,
    bearing_damping: ArrayLike = 0.0,
) -> Body:
    """Build a shaft as discs with torsion springs between them.

    Parameters
    ----------
    names : sequence of str
        Names of the discs from one end to the other; one disc makes a rigid shaft.
    moment_of_inertia : float or (discs,) array
        Polar moments of inertia of the discs [kg*m^2].
    stiffness : float or (discs - 1,) array
        Torsional stiffness between neighbours [N*m/rad].
    damping : float or (discs - 1,) array
        Torsional damping between neighbours [N*m*s/rad].
    mass : float or (discs,) array, optional
        Masses of the discs [kg]; without them the discs only rotate.
    bearing_stiffness : float or (discs,) array
        Radial stiffness of the support of each disc, the same in x and y [N/m].
    bearing_damping : float or (discs,) array
        Radial damping of the support of each disc [N*s/m].

    Returns
    -------
    Body
        Coordinates ``<disc>_theta``, with masses ``<disc>_x``, ``<disc>_y``, ``<disc>_theta``.

    Raises
    ------
    InputError
        If a value is out of range or the number of values is wrong.

    Examples
    --------
    >>> shaft_chain(["motor", "gear"], [2e-3, 1e-3], 5e4).stiffness
    array([[ 50000., -50000.],
           [-50000.,  50000.]])
    """
    count = len(names)
    inertia = row_of("moment_of_inertia", moment_of_inertia, count, "kg*m^2")
    springs = row_of("stiffness", stiffness, count - 1, "N*m/rad")
    dampers = row_of("damping", damping, count - 1, "N*m*s/rad", positive=False)
    turn_stiffness, turn_damping = _chain(springs), _chain(dampers)
    if mass is None:
        turning = tuple(f"{name}_theta" for name in names)
        return Body(turning, np.diag(inertia), turn_damping, turn_stiffness)
    masses = row_of("mass", mass, count, "kg")
    support = row_of("bearing_stiffness", bearing_stiffness, count, "N/m", positive=False)
    losses = row_of("bearing_damping", bearing_damping, count, "N*s/m", positive=False)

    def full_matrix(radial: Array, turn: Array) -> Array:
        out = np.diag(np.stack((radial, radial, np.zeros(count)), axis=1).reshape(-1))
        out[2::3, 2::3] = turn
        return out

    return Body(
        tuple(f"{name}_{axis}" for name in names for axis in ("x", "y", "theta")),
        full_matrix(masses, np.diag(inertia)),
        full_matrix(losses, turn_damping),
        full_matrix(support, turn_stiffness),
    )


def _chain(springs: Array) -> Array:
    out = np.zeros((springs.size + 1, springs.size + 1))
    for i, spring in enumerate(springs):
        out[i : i + 2, i : i + 2] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return out


def assemble(
    bodies: Sequence[Body],
    meshes: Sequence[GearMesh],
    torque: Mapping[str, float],
    *,
    balance: str | None = None,
) -> System:
    """Assemble a drive from shafts and meshes.

    Parameters
    ----------
    bodies : sequence of Body
        Shafts; every disc occurs once.
    meshes : sequence of GearMesh
        One contact each.
    torque : mapping of str to float
        Torque on discs by name, positive in the direction of rotation: positive where power enters
        [N*m].
    balance : str, optional
        Disc whose torque is determined so that the drive keeps its mean speed.

    Returns
    -------
    System
        All angles are positive in the direction of rotation of their shaft. The mesh phase is that
        of the common cycle, which contains ``cycles`` mesh cycles of each mesh.

    Raises
    ------
    InputError
        If a disc occurs twice or does not exist, or a value is out of range.

    Examples
    --------
    >>> gears = [shaft_chain([name], 1e-3) for name in ("pinion", "idler", "wheel")]
    >>> teeth = [GearMesh("pinion", "idler", (0.03, 0.04), 3e8),
    ...          GearMesh("idler", "wheel", (0.04, 0.05), 3e8)]
    >>> assemble(gears, teeth, {"pinion": 90.0, "wheel": -150.0})
    System(3 coordinates, 2 contacts)
    """
    names = tuple(name for body in bodies for name in body.names)
    doubled = sorted({name for name in names if names.count(name) > 1})
    if doubled:
        what, remedy = f'two bodies have a coordinate "{doubled[0]}"', "Rename one of them"
        raise InputError(what, "argument bodies", "Names of discs have to be unique", remedy)
    force = np.zeros(len(names))
    for disc, value in torque.items():
        force[_column(names, disc, "argument torque")] = value
    direction = None
    if balance is not None:
        direction = np.zeros(len(names))
        direction[_column(names, balance, "argument balance")] = 1.0
    return System(
        mass=_diagonal([body.mass for body in bodies]),
        damping=_diagonal([body.damping for body in bodies]),
        stiffness=_diagonal([body.stiffness for body in bodies]),
        force=force,
        contacts=[_contact(names, mesh) for mesh in meshes],
        names=names,
        balance=direction,
    )


def _diagonal(blocks: Sequence[Array]) -> Array:
    size = sum(len(block) for block in blocks)
    out, first = np.zeros((size, size)), 0
    for block in blocks:
        out[first : first + len(block), first : first + len(block)] = block
        first += len(block)
    return out


def _column(names: tuple[str, ...], disc: str, where: str) -> int:
    if f"{disc}_theta" not in names:
        discs = ", ".join(name.removesuffix("_theta") for name in names if name.endswith("_theta"))
        why = "Torques and meshes refer to the discs of the shafts"
        raise InputError(f'there is no disc "{disc}"', where, why, f"Use one of {discs}")
    return names.index(f"{disc}_theta")


def _contact(names: tuple[str, ...], mesh: GearMesh) -> Contact:
    require_between("backlash", mesh.backlash, 0.0, np.inf, "m")
    require_between("lag", mesh.lag, 0.0, 1.0, "")
    if int(mesh.cycles) != mesh.cycles or mesh.cycles < 1:
        why, remedy = "It is a whole number of at least 1", "Give cycles=1 for a single pair"
        raise InputError(f"cycles = {mesh.cycles}", "GearMesh.cycles", why, remedy)
    require_one_of("GearMesh.driver", mesh.driver, ("pinion", "wheel"))
    radii = row_of("base_radius", mesh.base_radius, 2, "m")
    for disc in (mesh.pinion, mesh.wheel):
        _column(names, disc, "argument meshes")
    rows = plane_rows(names, (mesh.pinion, mesh.wheel), mesh.line_angle)
    sense, friction = 1.0 if mesh.driver == "pinion" else -1.0, mesh.friction
    return Contact(
        direction=sense * (rows[0] + radii @ rows[2:]),
        stiffness=mesh.stiffness,
        damping=mesh.damping,
        error=mesh.error,
        gap=0.5 * mesh.backlash,
        friction=None if friction is None else friction_direction(friction, rows[1:]),
        events=tuple(sorted({0.0, *mesh.events})),
        cycles=mesh.cycles,
        offset=mesh.lag % 1.0,
    )
