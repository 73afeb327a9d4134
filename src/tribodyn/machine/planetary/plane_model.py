"""Plane lumped model of a planetary stage, after Lin and Parker, and the pins of its planets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.entry import Entry, varies
from tribodyn.dynamics.equations.system import Contact, System
from tribodyn.dynamics.harmonic.radial_clearance import RadialClearance
from tribodyn.dynamics.linear.linear_system import linear_system
from tribodyn.dynamics.linear.natural_modes import undamped_modes
from tribodyn.errors import (
    Argument,
    InputError,
    real_numbers,
    require_between,
    require_positive,
    shortened,
)
from tribodyn.machine.planetary.double_planets import (
    Directions,
    DoublePlanets,
    MeshedPlanets,
)
from tribodyn.machine.planetary.phases import MeshPhases
from tribodyn.machine.planetary.positions import read_angles
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.types import Array


@dataclass(frozen=True, eq=False)
class Pins:
    """Springs between planets and carrier that may hold only beyond a clearance."""

    axes: Directions
    stiffness: Array  #: of each planet [N/m]
    ahead: Array  #: error of each pin [m]
    clearance: float = 0.0

    def __post_init__(self) -> None:
        number = require_number("pin_clearance", self.clearance)
        require_between("pin_clearance", number, 0.0, 0.01, "m")

    def supports(self) -> list[RadialClearance]:
        """Support of every planet in radial and tangential direction."""
        count = self.stiffness.size
        return [
            RadialClearance(
                np.array([self.axes.radial[i], self.axes.tangential[i]]),
                float(self.stiffness[i % count]),
                self.clearance,
                [0.0, float(self.ahead[i]) if i < count else 0.0],
            )
            for i in range(self.axes.bodies)
        ]

    def springs(self, force: dict[str, float]) -> tuple[Array, Array]:
        """Stiffness (n, n) and load (n,) of the pins, linear about their load by the meshes."""
        matrix, load = np.zeros((self.axes.size, self.axes.size)), np.zeros(self.axes.size)
        if not self.clearance:
            count = self.stiffness.size
            for along in (self.axes.radial, self.axes.tangential):
                matrix += (along.T * np.tile(self.stiffness, self.axes.bodies // count)) @ along
            return matrix, (self.stiffness * self.ahead) @ self.axes.tangential[:count]
        pushed = sum(-force[mesh] * along.sum(axis=0) for mesh, along in self.axes.meshes.items())
        for law, first, at in zip(self.supports(), self.axes.first, self.axes.at, strict=True):
            x, y = np.asarray(pushed)[first : first + 2]
            on_pin = np.array([np.cos(at) * x + np.sin(at) * y, np.cos(at) * y - np.sin(at) * x])
            size, rows = float(np.hypot(*on_pin)), np.asarray(law.directions)
            if not size:
                what, why = "pin_clearance without a load", "The springs are linear about the load"
                raise InputError(what, Argument("pin_clearance"), why, "Give force_per_planet")
            displacement = on_pin / size * (self.clearance + size / law.stiffness)
            tangent = law.tangent(displacement)
            matrix += rows.T @ tangent @ rows
            moved = np.asarray(law.offset) + displacement
            load += rows.T @ (tangent @ moved - law.force(displacement))
        return matrix, load


#: Central members, in the order of their coordinates.
CENTRAL = ("carrier", "ring", "sun")

#: Largest error of a pin, a tooth or a mesh [m].
_LARGEST_ERROR = 0.1

#: One entry for the meshes of all planets, or a list with one for each planet.
MeshEntry = Entry | Sequence[Entry]


def planetary_plane_model(
    *,
    planets: int,
    carrier_mass: float,
    carrier_inertia: float,
    ring_mass: float,
    ring_inertia: float,
    sun_mass: float,
    sun_inertia: float,
    planet_mass: ArrayLike,
    planet_inertia: ArrayLike,
    sun_mesh_stiffness: MeshEntry,
    ring_mesh_stiffness: MeshEntry,
    pin_stiffness: ArrayLike,
    carrier_support: float,
    ring_support: float,
    sun_support: float,
    carrier_torsional_support: float = 0.0,
    ring_torsional_support: float = 0.0,
    sun_torsional_support: float = 0.0,
    sun_pressure_angle: float,
    ring_pressure_angle: float,
    angles: ArrayLike | None = None,
    phases: MeshPhases | None = None,
    force_per_planet: float = 0.0,
    pin_errors: ArrayLike = 0.0,
    thickness_errors: ArrayLike = 0.0,
    sun_mesh_error: MeshEntry = 0.0,
    ring_mesh_error: MeshEntry = 0.0,
    mesh_gap: float = 0.0,
    damping_ratio: float = 0.0,
    carrier_speed: float = 0.0,
    double_planets: DoublePlanets | None = None,
    pin_clearance: float = 0.0,
    pin_radius: float = 0.0,
) -> System:
    """Build the plane model of a spur planetary stage in the frame of its carrier.

    Coordinates are x, y and u of carrier, ring, sun and every planet: u is the rotation times the
    base radius, of the carrier times the radius of the pins. The first planet is on the x axis
    where its angle is 0; rotations and angles are positive from x to y. Contacts are the sun
    meshes of all planets, then their ring meshes, then the meshes between the planets of pairs.
    Arguments of the planets are one value for all of them, or a list with one for each.

    Parameters
    ----------
    planets : int
        Number of planets N.
    carrier_mass, carrier_inertia, ring_mass, ring_inertia, sun_mass, sun_inertia : float
        Masses, and moments of inertia over the square of the base radius, of the carrier over
        that of the radius of the pins [kg].
    planet_mass, planet_inertia : float or (N,) array
        Mass, and moment of inertia over the square of the base radius [kg].
    sun_mesh_stiffness, ring_mesh_stiffness : float, function or list of N of these
        Stiffness along the line of action [N/m]; functions take the phase of their own mesh.
    pin_stiffness : float or (N,) array
        Radial stiffness between a planet and the carrier [N/m].
    carrier_support, ring_support, sun_support : float
        Stiffness of the supports along x and y [N/m]; 0 lets the member float.
    carrier_torsional_support, ring_torsional_support, sun_torsional_support : float
        Torsional stiffness over the square of the radius of u [N/m]; 0 lets the member turn.
    sun_pressure_angle, ring_pressure_angle : float
        Working pressure angles [rad].
    angles : (N,) array, optional
        Angles of the planets [rad]; those of ``phases``, or equally spaced, by default.
    phases : MeshPhases, optional
        Phases of the meshes, from :func:`mesh_phases`; needed where an entry is a function.
    force_per_planet : float
        Mean force of every sun mesh along its line of action [N]. Positive while the sun drives
        towards greater angles or brakes the other way. The torque acts on members without torsional
        support; the supports react on the others.
    pin_errors : float or (N,) array
        Distance by which a pin is ahead of its place, towards greater angles [m].
    thickness_errors : float or (N,) array
        Excess of the base tooth thickness of a planet [m]; each of its flanks has half of it.
    sun_mesh_error, ring_mesh_error : float, function or list of N of these
        Displacement errors, subtracted from the compressions [m].
    mesh_gap : float
        Half of the dead zone of every mesh [m]. At 0 the flanks never separate.
    damping_ratio : float
        Damping of every mode over its critical value [1].
    carrier_speed : float
        Speed of the carrier, for the Coriolis and centripetal terms of its frame [rad/s].
    double_planets : SteppedPlanets or MeshedPlanets, optional
        Second gears of the planets, or second planets of pairs; then the other data of planets are
        those of the gear at the sun.

    pin_clearance : float
        Radial distance that each planet can move on its pin before it is held [m]. The pins are
        linear about the load of ``force_per_planet``: across it they are softer.

    pin_radius : float
        Distance of the pins of the planets from the axis, for the centrifugal force of the planets
        at the speed of the carrier [m]; 0 leaves it out.

    Returns
    -------
    System
        Names are ``carrier_x, carrier_y, carrier_u, ring_x, ..., planet1_x, ...``, with
        ``ring_planet1_x, ...`` of pairs. With phases of stepped planets the clock has
        ``phases.cycles`` mesh cycles in its period.

    Raises
    ------
    InputError
        If a value is out of range, a list does not have N values, or an entry is a function and
        ``phases`` is missing.

    Notes
    -----
    Supports are equal in x and y. Source: Lin and Parker (1999), whose planets have radial and
    tangential coordinates, which gives the same frequencies. With a carrier speed W a body of mass
    m has the forces ``-2 m W (-y', x') + m W^2 (x, y)`` of the frame besides. Planets pull outwards
    on their pins: of their tangential displacement only that relative to the pins counts in
    ``m W^2``, in which the rotation of the carrier is taken off (not in Lin and Parker), so that a
    stage that is free to turn does so without force.

    Examples
    --------
    >>> from tribodyn.dynamics import natural_modes
    >>> stage = planetary_plane_model(
    ...     planets=3, carrier_mass=5.43, carrier_inertia=6.29, ring_mass=2.35, ring_inertia=3.0,
    ...     sun_mass=0.4, sun_inertia=0.39, planet_mass=0.66, planet_inertia=0.61,
    ...     sun_mesh_stiffness=5e8, ring_mesh_stiffness=5e8, pin_stiffness=1e8,
    ...     carrier_support=1e8, ring_support=1e8, sun_support=1e8, ring_torsional_support=1e9,
    ...     sun_pressure_angle=np.radians(24.6), ring_pressure_angle=np.radians(24.6))
    >>> natural_modes(stage).frequency[[1, 3]].round(2)
    array([ 743.16, 1102.42])
    """
    count = require_whole("planets", planets)
    carrier = (carrier_mass, carrier_inertia, carrier_support, carrier_torsional_support)
    ring = (ring_mass, ring_inertia, ring_support, ring_torsional_support)
    sun = (sun_mass, sun_inertia, sun_support, sun_torsional_support)
    central = np.array([_member(*each) for each in zip(CENTRAL, (carrier, ring, sun), strict=True)])
    alpha = _pressure_angles(sun_pressure_angle, ring_pressure_angle)
    axes = Directions(_angles(count, angles, phases), *alpha, double_planets)
    meshes = {"sun": (sun_mesh_stiffness, sun_mesh_error)}
    meshes["ring"] = ring_mesh_stiffness, ring_mesh_error
    bodies = [(planet_mass, planet_inertia)]
    if isinstance(double_planets, MeshedPlanets):
        bodies.append((double_planets.mass, double_planets.inertia))
        meshes["planet"] = double_planets.mesh_stiffness, double_planets.mesh_error
    carried = _of_planets("pin_stiffness", pin_stiffness, count, "N/m", positive=True)
    pins = Pins(axes, carried, _of_planets("pin_errors", pin_errors, count, "m"), pin_clearance)
    forces = axes.forces(require_number("force_per_planet", force_per_planet))
    stiffness, pushed = pins.springs(forces)
    stiffness[np.diag_indices(9)] += central[:, [2, 2, 3]].reshape(-1)
    load = _load(axes, forces, central[:, 3]) + pushed
    thick = _of_planets("thickness_errors", thickness_errors, count, "m")
    contacts = _contacts(axes, meshes, thick, mesh_gap, phases)
    masses = _masses(central[:, [0, 0, 1]], bodies, count)
    frame = axes, carrier_speed, pin_radius
    return with_modal_damping(_system(masses, stiffness, load, contacts, frame), damping_ratio)


def _pressure_angles(sun: float, ring: float) -> tuple[float, float]:
    for name, value in (("sun_pressure_angle", sun), ("ring_pressure_angle", ring)):
        remedy = "Give radians: 20 deg is 0.349066"
        angle = require_number(name, value)
        require_between(name, angle, 0.0, 0.25 * np.pi, "rad", remedy=remedy)
    return float(sun), float(ring)


def _masses(central: Array, planets: list[tuple[ArrayLike, ArrayLike]], count: int) -> Array:
    masses = [central.reshape(-1)]
    for body in planets:
        mass, inertia = (
            _of_planets(f"planet_{name}", value, count, "kg", positive=True)
            for name, value in zip(("mass", "inertia"), body, strict=True)
        )
        masses.append(np.stack([mass, mass, inertia], 1).reshape(-1))
    return np.concatenate(masses)


def _member(name: str, values: tuple[float, float, float, float]) -> tuple[float, ...]:
    """Mass, inertia, support and torsional support of a central member, within their limits."""
    keys = [f"{name}_{key}" for key in ("mass", "inertia", "support", "torsional_support")]
    numbers = [require_number(key, value) for key, value in zip(keys, values, strict=True)]
    for key, number in zip(keys[:2], numbers, strict=False):
        require_positive(key, number, "kg")
    for key, number in zip(keys[2:], numbers[2:], strict=True):
        require_between(key, number, 0.0, 1e30, "N/m")
    return tuple(numbers)


def _contacts(
    axes: Directions,
    meshes: dict[str, tuple[MeshEntry, MeshEntry]],
    thickness: Array,
    gap: float,
    phases: MeshPhases | None,
) -> list[Contact]:
    """Meshes of all planets by kind."""
    require_between("mesh_gap", require_number("mesh_gap", gap), 0.0, 1.0, "m")
    count, contacts = thickness.size, []
    for mesh, entries in meshes.items():
        stiffness = _entries(f"{mesh}_mesh_stiffness", entries[0], count, phases, positive=True)
        error = _entries(f"{mesh}_mesh_error", entries[1], count, phases)
        offset = np.zeros(count) if phases is None else phases.offset(mesh)
        # Of a pair the planet at the sun meshes with the sun and with the other planet.
        flank = 0.0 if mesh == "ring" and "planet" in meshes else 0.5
        contacts += [
            Contact(
                direction=axes.meshes[mesh][i],
                stiffness=stiffness[i],
                error=without_excess(error[i], flank * float(thickness[i])),
                gap=float(gap),
                cycles=1 if phases is None else phases.cycles[mesh],
                offset=float(offset[i]),
            )
            for i in range(count)
        ]
    return contacts


def _angles(count: int, angles: ArrayLike | None, phases: MeshPhases | None) -> Array:
    if phases is None:
        return read_angles(count, angles)
    if not isinstance(phases, MeshPhases):
        what, why = f"phases is {shortened(repr(phases), 60)}", "Wanted: phases of the meshes"
        raise InputError(what, Argument("phases"), why, "Give the result of mesh_phases(...)")
    if phases.angles.size != count:
        what = f"phases has {phases.angles.size} planets, and planets = {count}"
        remedy = f"Give mesh_phases(..., planets={count})"
        raise InputError(what, Argument("phases"), "They belong to the same stage", remedy)
    if angles is not None and not np.allclose(read_angles(count, angles), phases.angles, atol=1e-9):
        what, why = "angles differ from those of phases", "Every planet has one angle"
        raise InputError(what, Argument("angles"), why, "Leave angles out, or correct one of them")
    return phases.angles


def _of_planets(
    name: str, value: ArrayLike, count: int, unit: str, *, positive: bool = False
) -> Array:
    values = real_numbers(Argument(name), value, f"a number [{unit}], or one for each planet")
    if values.shape not in ((), (count,)):
        what = f"{name} has the shape {values.shape}, and there are {count} planets"
        why = "It is one value for all planets, or a list with one for each"
        raise InputError(what, Argument(name), why, f"Give 1 or {count} numbers in {unit}")
    if positive:
        require_positive(name, values, unit)
    else:
        require_between(name, values, -_LARGEST_ERROR, _LARGEST_ERROR, unit)
    return np.broadcast_to(values, (count,))


def _entries(
    name: str, entry: Any, count: int, phases: MeshPhases | None, *, positive: bool = False
) -> list[Entry]:
    """Entries of the meshes of all planets; numbers become floats."""
    one_each = isinstance(entry, list | tuple) or np.ndim(entry) == 1
    entries = list(entry) if one_each else [entry] * count
    if len(entries) != count:
        what = f"{name} has {len(entries)} entries, and there are {count} planets"
        why = "It is one entry for all planets, or a list with one for each"
        raise InputError(what, Argument(name), why, f"Give 1 or {count} entries")
    if phases is None and any(map(callable, entries)):
        why = "Its meshes have phases that follow from the numbers of teeth"
        remedy = "Give phases=mesh_phases(sun_teeth=..., ring_teeth=..., planets=...)"
        raise InputError(
            f"{name} is a function, and phases is missing", Argument(name), why, remedy
        )
    unit = "N/m" if positive else "m"
    return [
        value if callable(value) else float(_of_planets(name, value, 1, unit, positive=positive)[0])
        for value in entries
    ]


def without_excess(error: Any, thickness: float) -> Entry:
    """Error of a mesh, less the excess thickness of the flank of the planet."""
    if not varies(error):
        return float(error) - thickness
    if thickness == 0.0:
        return error  # type: ignore[no-any-return]
    function: Callable[[Array], Any] = error
    return lambda phase: function(phase) - thickness


def _load(axes: Directions, force: dict[str, float], supports: Array) -> Array:
    """Forces on the members that are free to turn; supports react on the others."""
    if force["sun"] and supports.all():
        what = f"force_per_planet = {force['sun']:.6g} N, and no member is free to turn"
        why = "Carrier, ring and sun have torsional supports, so that no torque can act"
        remedy = "Set the torsional support of the driving member to 0"
        raise InputError(what, Argument("force_per_planet"), why, remedy)
    load = np.zeros(axes.size)
    load[[2, 5, 8]] = axes.load(force) * (supports == 0.0)
    return load


def _system(
    masses: Array,
    stiffness: Array,
    load: Array,
    contacts: list[Contact],
    frame: tuple[Directions, float, float],
) -> System:
    """System in a frame that turns at a speed, with Coriolis and centripetal terms."""
    axes, speed, radius = frame
    require_number("carrier_speed", speed)
    require_between("pin_radius", require_number("pin_radius", radius), 0.0, 100.0, "m")
    load = load + axes.outward(masses, radius * speed**2)
    x = np.arange(0, masses.size, 3)
    gyroscopic = np.zeros_like(stiffness)
    gyroscopic[x, x + 1] = -2.0 * speed * masses[x]
    gyroscopic[x + 1, x] = 2.0 * speed * masses[x]
    stiffness[x, x] -= speed**2 * masses[x]
    stiffness[x + 1, x + 1] -= speed**2 * masses[x]
    # Pulled outwards, the planets hold the carrier: what is free to turn turns without force.
    for planet, (angle, reach) in enumerate(zip(axes.at, axes.radius, strict=True)):
        turning = reach * speed**2 * masses[9 + 3 * planet]
        tangent = np.array([-np.sin(angle), np.cos(angle)])
        stiffness[2, 9 + 3 * planet : 11 + 3 * planet] += turning * tangent
        stiffness[9 + 3 * planet : 11 + 3 * planet, 2] += turning * tangent
        stiffness[2, 2] -= reach * turning
    count = axes.angles.size
    members = [*CENTRAL, *(f"planet{i + 1}" for i in range(count))]
    members += [f"ring_planet{i + 1}" for i in range(axes.bodies - count)]
    return System(
        mass=np.diag(masses),
        damping=np.zeros_like(stiffness),
        stiffness=stiffness,
        force=load,
        contacts=contacts,
        names=[f"{member}_{axis}" for member in members for axis in "xyu"],
        gyroscopic=gyroscopic if speed else None,
    )


def without_free_rotation(system: System) -> System:
    """System without the Coriolis forces of a free rotation of the whole stage, whose mean is 0."""
    if system.gyroscopic is None:
        return system
    frequency, shape = undamped_modes(np.asarray(system.mass), linear_system(system).stiffness)
    if frequency[0] > 0.0:
        return system
    rigid = shape[:1]
    keep = np.eye(system.size) - rigid.T @ (rigid @ np.asarray(system.mass))
    return replace(system, gyroscopic=keep.T @ np.asarray(system.gyroscopic) @ keep)


def with_modal_damping(system: System, ratio: float) -> System:
    """System whose modes at rest have one damping ratio."""
    require_between("damping_ratio", require_number("damping_ratio", ratio), 0.0, 2.0)
    return replace(system, damping=modal_damping(system, ratio)) if ratio else system


def modal_damping(system: System, ratio: float) -> Array:
    """Damping matrix that gives every mode at rest the same damping ratio."""
    frequency, shape = undamped_modes(np.asarray(system.mass), linear_system(system).stiffness)
    momentum = np.asarray(system.mass) @ shape.T
    return np.asarray((momentum * (4.0 * np.pi * ratio * frequency)) @ momentum.T)
