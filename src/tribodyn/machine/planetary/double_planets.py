"""Double planets of the plane model: two gears on one shaft, or pairs that mesh with each other."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.nomenclature import require_number
from tribodyn.types import Array

#: First coordinates of ring, sun and the first planet.
_RING, _SUN, _PLANETS = 3, 6, 9


@dataclass(frozen=True, eq=False)
class SteppedPlanets:
    """Planets with two gears on one shaft, the first at the sun, the second at the ring.

    Parameters
    ----------
    radius_ratio : float
        Base radius of the gear at the ring over that of the gear at the sun [1].

    Raises
    ------
    InputError
        If it is not between 0.01 and 100.

    Notes
    -----
    The ring meshes carry the force of the sun meshes over ``radius_ratio``. The coordinate u of a
    planet is its rotation times the base radius of the gear at the sun. Both gears are in one
    plane: the moment of gears at a distance along the axis is left out.

    Examples
    --------
    >>> SteppedPlanets(0.8).force_ratio["ring"]
    1.25
    """

    radius_ratio: float

    def __post_init__(self) -> None:
        require_between(
            "radius_ratio", require_number("radius_ratio", self.radius_ratio), 0.01, 100.0, ""
        )

    @property
    def force_ratio(self) -> dict[str, float]:
        """Force of each kind of mesh over that of the sun mesh [1]."""
        return {"sun": 1.0, "ring": 1.0 / self.radius_ratio}


@dataclass(frozen=True, eq=False)
class MeshedPlanets:
    """Pairs of planets that mesh with each other, the first with the sun, the second with the ring.

    Parameters
    ----------
    mass, inertia : float or (N,) array
        Mass of the planet at the ring, and its moment of inertia over the square of its base
        radius [kg].
    mesh_stiffness : float, function or list of N of these
        Stiffness between the planets of a pair along their line of action [N/m].
    pressure_angle : float
        Working pressure angle between the planets of a pair [rad].
    angle : float
        Angle about the sun by which the planet at the ring is ahead of that at the sun [rad].
    radius_ratio : float
        Distance of the planet at the ring from the axis of the sun over that of the planet at the
        sun [1].
    mesh_error : float, function or list of N of these
        Displacement errors, subtracted from the compressions [m].

    Raises
    ------
    InputError
        If a value is out of range, or both planets have one axis.

    Notes
    -----
    All meshes carry the same force. Errors of pins and thickness are those of the planet at the
    sun, whose second flank meshes with the other planet.

    Examples
    --------
    >>> MeshedPlanets(0.6, 0.5, 5e8, 0.36, angle=0.6, radius_ratio=1.3).force_ratio
    {'sun': 1.0, 'ring': 1.0, 'planet': 1.0}
    """

    mass: ArrayLike
    inertia: ArrayLike
    mesh_stiffness: Any
    pressure_angle: float
    angle: float
    radius_ratio: float = 1.0
    mesh_error: Any = 0.0

    def __post_init__(self) -> None:
        require_between(
            "pressure_angle",
            require_number("pressure_angle", self.pressure_angle),
            0.0,
            0.25 * np.pi,
            "rad",
            remedy="Give radians: 20 deg is 0.349066",
        )
        require_positive("radius_ratio", require_number("radius_ratio", self.radius_ratio))
        require_between("angle", require_number("angle", self.angle), -np.pi, np.pi, "rad")
        if abs(self.line) < 1e-3:
            what = f"angle = {self.angle:.4g} rad with radius_ratio = {self.radius_ratio:.4g}"
            why = "Both planets of a pair have the same axis"
            remedy = "Give the angle and the distances of the axes of the planets about the sun"
            raise InputError(what, Argument("angle"), why, remedy)

    @property
    def line(self) -> complex:
        """From the axis of the first planet to that of the second, over that from sun to first."""
        return complex(
            self.radius_ratio * math.cos(self.angle) - 1.0,
            self.radius_ratio * math.sin(self.angle),
        )

    @property
    def force_ratio(self) -> dict[str, float]:
        """Force of each kind of mesh over that of the sun mesh [1]."""
        return {"sun": 1.0, "ring": 1.0, "planet": 1.0}


DoublePlanets = SteppedPlanets | MeshedPlanets


def force_ratios(double: DoublePlanets | None) -> dict[str, float]:
    """Force of each kind of mesh over that of the sun mesh, in the order of the contacts."""
    if double is not None and not isinstance(double, SteppedPlanets | MeshedPlanets):
        what = f"double_planets is {type(double).__name__}"
        remedy = "Give SteppedPlanets(...) or MeshedPlanets(...), or leave it out"
        raise InputError(what, Argument("double_planets"), "It is the kind of planets", remedy)
    return double.force_ratio if double else {"sun": 1.0, "ring": 1.0}


class Directions:
    """Derivatives of the compressions and of the pin displacements, (N, n) or (bodies, n) each."""

    def __init__(
        self, angles: Array, sun: float, ring: float, double: DoublePlanets | None
    ) -> None:
        self.angles, count = angles, angles.size
        self.ratios = force_ratios(double)
        meshed = double if isinstance(double, MeshedPlanets) else None
        self.bodies = 2 * count if meshed else count
        self.size = _PLANETS + 3 * self.bodies
        self.radius = np.ones(self.bodies)
        self.at = angles
        if meshed:
            self.radius[count:] = meshed.radius_ratio
            self.at = np.concatenate([angles, angles + meshed.angle])
        self.first = first = _PLANETS + 3 * np.arange(self.bodies)
        right = 0.5 * np.pi
        carrier, turn = np.zeros(self.bodies, int), -self.radius
        self.radial = self._between((first, carrier), self.at, (0.0, 0.0))
        self.tangential = self._between((first, carrier), self.at + right, (0.0, turn))
        second, first = first[count:], first[:count]
        self.meshes = {"sun": self._between((_SUN, first), angles - sun + right, (1.0, 1.0))}
        if meshed is None:
            step = double.radius_ratio if isinstance(double, SteppedPlanets) else 1.0
            self.meshes["ring"] = self._between((_RING, first), angles + ring + right, (1.0, -step))
        else:
            line = angles + float(np.angle(meshed.line))
            self.meshes["ring"] = self._between(
                (second, _RING), self.at[count:] - ring + right, (1.0, -1.0)
            )
            self.meshes["planet"] = self._between(
                (first, second), line + meshed.pressure_angle - right, (-1.0, -1.0)
            )

    def _between(self, bodies: tuple[Any, Any], angle: Array, turns: tuple[Any, Any]) -> Array:
        """Displacement of the first body along an angle less that of the second, and rotations."""
        rows, out = np.arange(angle.size), np.zeros((angle.size, self.size))
        for start, sign, turn in zip(bodies, (1.0, -1.0), turns, strict=True):
            out[rows, start] = sign * np.cos(angle)
            out[rows, start + 1] = sign * np.sin(angle)
            out[rows, start + 2] = turn
        return out

    def forces(self, force: float) -> dict[str, float]:
        """Force of each kind of mesh for that of the sun mesh [N]."""
        return {mesh: force * ratio for mesh, ratio in self.ratios.items()}

    def outward(self, masses: Array, acceleration: float) -> Array:
        """Centrifugal forces of the planets for an acceleration at the first pins (n,)."""
        load = np.zeros(self.size)
        pull = masses[self.first] * self.radius * acceleration
        load[self.first], load[self.first + 1] = pull * np.cos(self.at), pull * np.sin(self.at)
        return load

    def load(self, force: dict[str, float]) -> Array:
        """Forces on carrier, ring and sun that balance the meshes in rotation (3,)."""
        total = sum(force[mesh] * along.sum(axis=0) for mesh, along in self.meshes.items())
        carried = np.zeros(self.size)  # the planets displaced by a rotation of the carrier
        carried[self.first] = -self.radius * np.sin(self.at)
        carried[self.first + 1] = self.radius * np.cos(self.at)
        by_mesh = [force[mesh] * (along @ carried).sum() for mesh, along in self.meshes.items()]
        return np.array([sum(by_mesh), total[_RING + 2], total[_SUN + 2]])
