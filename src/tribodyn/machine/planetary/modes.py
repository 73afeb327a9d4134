"""Natural modes of a planetary stage and their types."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from tribodyn.arrays.linear_algebra import standard_rotation
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.linear.natural_modes import natural_modes
from tribodyn.errors import Argument, InputError
from tribodyn.machine.planetary.plane_model import CENTRAL
from tribodyn.record import Record, quantity, record
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.machine.modes import MachineModes
    from tribodyn.machine.structure import MachineStructure

ModeType = Literal["rotational", "translational", "planet", "mixed"]

Shape = Array | ComplexArray

#: Amplitude over that of the mode below which a central member is at rest.
_AT_REST = 1e-6
#: Relative difference of frequencies that is rounding.
_EQUAL = 1e-9


@record
class PlanetaryModes(Record):
    """Natural modes of a planetary stage with their types.

    Parameters
    ----------
    names : tuple of str
        Names of the coordinates.
    angles : (N,) array
        Angles of the planets [rad].
    frequency : (n,) array
        Natural frequencies, rising [Hz].
    types : tuple of str
        Type of each mode: ``rotational`` where carrier, ring and sun only turn, ``translational``
        where they only translate, ``planet`` where they are at rest, ``mixed`` where they turn and
        translate.
    shape : (n, n) array
        One mode per row, with unit modal mass [kg^-1/2].
    """

    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    angles: Array = quantity("planet", unit="rad")
    frequency: Array = quantity("mode", unit="Hz")
    types: tuple[ModeType, ...] = quantity("mode", axis=True, name="type")
    shape: Shape = quantity("mode", "coordinate", unit="kg^-1/2")

    def of_type(self, mode_type: ModeType) -> Array:
        """Select the natural frequencies of a type.

        Parameters
        ----------
        mode_type : {"rotational", "translational", "planet", "mixed"}
            Type of the modes.

        Returns
        -------
        (m,) array
            Rising [Hz].
        """
        return np.asarray(self.frequency[np.array(self.types) == mode_type])

    def __repr__(self) -> str:
        """One line."""
        counts = {each: self.types.count(each) for each in dict.fromkeys(self.types)}
        listed = ", ".join(f"{count} {each}" for each, count in counts.items())
        return f"PlanetaryModes({self.angles.size} planets, {listed})"


def planetary_modes(system: System) -> PlanetaryModes:
    """Compute the natural modes of a plane model and classify them by their shapes.

    Parameters
    ----------
    system : System
        Model of :func:`planetary_plane_model`.

    Raises
    ------
    InputError
        If the system is another one.

    Notes
    -----
    Equal planets at equal spacing have 6 rotational modes, 6 pairs of translational ones and, from
    4 planets on, 3 groups of N - 3 modes of the planets. A member is at rest where its amplitude,
    weighted by the root of its mass, is below 1e-6 of the mode. Source: Lin and Parker (1999).

    Examples
    --------
    >>> import tribodyn as td
    >>> stage = td.machine.planetary_plane_model(
    ...     planets=4, carrier_mass=5.43, carrier_inertia=6.29, ring_mass=2.35, ring_inertia=3.0,
    ...     sun_mass=0.4, sun_inertia=0.39, planet_mass=0.66, planet_inertia=0.61,
    ...     sun_mesh_stiffness=5e8, ring_mesh_stiffness=5e8, pin_stiffness=1e8,
    ...     carrier_support=1e8, ring_support=1e8, sun_support=1e8, ring_torsional_support=1e9,
    ...     sun_pressure_angle=np.radians(24.6), ring_pressure_angle=np.radians(24.6))
    >>> modes = td.machine.planetary_modes(stage)
    >>> modes
    PlanetaryModes(4 planets, 6 rotational, 12 translational, 3 planet)
    >>> modes.of_type("planet").round(2)
    array([1808.18, 5963.76, 6981.71])
    """
    expected = tuple(f"{member}_{axis}" for member in CENTRAL for axis in "xyu")
    if tuple(system.names[:9]) != expected:
        what = f"the coordinates are {', '.join(system.names[:3])}, ..."
        why = f"A plane model begins with {', '.join(expected[:3])}"
        remedy = "Give a system of planetary_plane_model"
        raise InputError(what, Argument("system"), why, remedy)
    modes = natural_modes(system)
    weight = np.sqrt(np.diag(np.asarray(system.mass)))[:9]
    shape, types = _by_type(modes.frequency, modes.shape, weight)
    # The pins couple the rotation of the carrier with the tangential motion of each planet.
    along_x, along_y = np.asarray(system.stiffness)[2, 9:].reshape(-1, 3)[:, :2].T
    angles = np.arctan2(along_x, -along_y) % (2.0 * np.pi)
    return PlanetaryModes(
        names=modes.names,
        angles=np.where(angles > 2.0 * np.pi - 1e-9, 0.0, angles),
        frequency=modes.frequency,
        types=types,
        shape=shape,
    )


def modes_of_stage(modes: MachineModes, stage: str) -> PlanetaryModes:
    """Modes of a machine as motions of one of its planetary stages in its plane, with types."""
    structure = modes.structure
    rows = plane_rows(structure, stage)
    mass = structure.mass
    modal = np.einsum("mi,ij,mj->m", modes.shape.conj(), mass, modes.shape).real
    shape = (modes.shape / np.sqrt(modal)[:, None]) @ np.vstack(list(rows.values())).T
    central = np.vstack(list(rows.values()))[:9]
    mobility = np.einsum("ci,ic->c", central, np.linalg.solve(mass, central.T))
    weight = 1.0 / np.sqrt(np.where(mobility > 0.0, mobility, np.inf))
    shape, types = _by_type(modes.frequency, shape, weight)
    return PlanetaryModes(
        names=tuple(f"{member}_{axis}" for member in rows for axis in "xyu"),
        angles=structure.machine.planets[stage].phases(structure.machine.gears).angles,
        frequency=modes.frequency,
        types=types,
        shape=shape,
    )


def plane_rows(structure: MachineStructure, stage: str) -> dict[str, Array]:
    """Displacements x, y and u of each member of a stage per coordinate, (3, n) each."""
    machine = structure.machine
    parts = machine.planets[stage]
    radii: dict[str, float] = {}
    for mesh in parts._meshes(stage):
        radii |= zip(machine.meshes[mesh].gears, machine.directions[mesh].base_radius, strict=True)
    pin = next(b for n, b in machine.bearings.items() if n == f"{stage}_pin1")
    place = machine.placement.shafts
    between = np.subtract(place[pin.shaft], place[parts.carrier])
    rows = {"carrier": structure.at(parts.carrier, pin.carrier_position)[1:4]}
    rows |= {role: structure.gear(getattr(parts, role))[1:4] for role in ("ring", "sun")}
    numbers = range(1, parts.count + 1)
    planets = {f"planet{i}": f"{stage}_planet{i}" for i in numbers}
    if parts.planet_type == "meshed":
        planets |= {f"ring_planet{i}": f"{stage}_ring_planet{i}" for i in numbers}
    rows |= {member: structure.gear(gear)[1:4] for member, gear in planets.items()}
    lengths = {role: radii[getattr(parts, role)] for role in ("ring", "sun")}
    lengths |= {member: radii[gear] for member, gear in planets.items()}
    lengths["carrier"] = float(np.linalg.norm(between[1:]))
    return {
        member: np.vstack([row[:2], abs(lengths[member]) * row[2:]]) for member, row in rows.items()
    }


def _by_type(frequency: Array, shape: Shape, weight: Array) -> tuple[Shape, tuple[ModeType, ...]]:
    """Shapes, those of one frequency separated by their types, and the types."""
    shape = _separated(frequency, shape, weight)
    turns, moves = (np.abs(part).max(axis=1) > _AT_REST for part in _central(shape, weight))
    types: dict[tuple[bool, bool], ModeType] = {
        (True, False): "rotational",
        (False, True): "translational",
        (False, False): "planet",
        (True, True): "mixed",
    }
    return shape, tuple(types[bool(t), bool(m)] for t, m in zip(turns, moves, strict=True))


def _central(shape: Shape, weight: Array) -> tuple[Shape, Shape]:
    """Rotations (m, 3) and translations (m, 6) of the central members in modes of unit mass."""
    amplitude = shape[:, :9] * weight
    return amplitude[:, 2::3], np.delete(amplitude, [2, 5, 8], axis=1)


def _separated(frequency: Array, shape: Shape, weight: Array) -> Shape:
    """Modes of one frequency in the combinations that have one type each, where they exist."""
    shape = shape.copy()
    first = np.flatnonzero(np.diff(frequency, prepend=-1.0) > _EQUAL * frequency)
    for rows in np.split(np.arange(frequency.size), first[1:]):
        still, groups = rows, []
        for part in (1, 0):  # those that translate first, then those that turn
            left, size, _ = np.linalg.svd(_central(shape[still], weight)[part])
            shape[still] = left.conj().T @ shape[still]
            moving, still = np.split(still, [np.count_nonzero(size > _AT_REST)])
            groups.append(moving)
        for group in (*groups, still):
            shape[group] = standard_rotation(np.zeros(group.size), shape[group]) @ shape[group]
    return shape
