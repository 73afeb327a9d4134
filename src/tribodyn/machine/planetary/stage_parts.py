"""A planetary stage of a machine: its planets, pins and meshes as parts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, real_numbers
from tribodyn.machine.bearing import Bearing
from tribodyn.machine.fields import check_name, check_number, quoted
from tribodyn.machine.gear import Gear
from tribodyn.machine.mesh import Hand, Mesh
from tribodyn.machine.planetary.phases import MeshPhases, mesh_phases
from tribodyn.machine.planetary.plane_model import without_excess
from tribodyn.machine.planetary.positions import (
    PlanetType,
    planetary_positions,
    read_angles,
    refuse_touching_pairs,
)
from tribodyn.machine.shaft import Shaft
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array, ByName

#: Largest error of a pin or a tooth over the module: beyond, it exceeds any usual backlash.
LARGEST_ERROR = 0.1


def mesh_kinds(planet_type: str) -> dict[str, str]:
    """Kinds of meshes of a planet, with the words in the names of its meshes."""
    kinds = {"sun": "sun", "ring": "ring"}
    return {**kinds, "planet": "pair"} if planet_type == "meshed" else kinds


@dataclass(frozen=True, eq=False)
class PlanetaryStage:
    """Equal planets between a sun and a ring, on the pins of a carrier.

    Parameters
    ----------
    sun, ring : str
        Names of gears of the machine.
    carrier : str
        Name of the shaft that carries the pins.
    planet : Gear
        Planet; its shaft and its position are ignored.
    count : int
        Number of planets, or of pairs of planets that mesh with each other.
    normal_module : float
        Module in the normal section [m].
    helix_angle : float
        Helix angle at the reference circle, without a sign [rad].
    hand : "right" or "left"
        Hand of the sun.
    center_distance : float, optional
        Distance from the axis of the sun to those of the planets [m]; without profile shift by
        default.
    pressure_angle : float
        Pressure angle of the basic rack, in the normal section [rad].
    angles : (N,) array, optional
        Angles of the planets from y towards z, at the position of the carrier for which the
        machine is computed [rad]; equally spaced by default.
    pin : Bearing
        Bearing of each planet on the carrier; its shaft and carrier are ignored. Stiff by default,
        along x only for helical teeth, which also tilt the planet.
    sun_mesh, ring_mesh : mapping
        Further fields of the meshes, such as ``stiffness``, or another ``normal_module``. The first
        gear of a sun mesh is the sun, that of a ring mesh the planet.
    sun_to_ring : float
        Mesh cycles by which the ring mesh of a planet lags behind its sun mesh [1];
        :func:`sun_to_ring_lag` computes it from the teeth.
    pin_errors, thickness_errors : float or (N,) array
        Distance by which a pin is ahead of its place, from y towards z, and excess of the base
        tooth thickness of a planet [m]; of a pair those of the planet at the sun.
    planet_type : {"single", "stepped", "meshed"}
        Planets with one gear, with two gears on one shaft, or pairs that mesh with each other.
    ring_planet : Gear, optional
        Second gear of stepped planets, at its position behind the first one, or planet at the ring
        of pairs; then ``planet`` is that at the sun.
    planet_mesh : mapping
        As ``sun_mesh``, of the mesh of a pair, whose first gear is the planet at the sun.
    sun_to_planet : float
        Mesh cycles by which the mesh of a pair lags behind its sun mesh [1].
    ring_center_distance, pair_center_distance : float, optional
        Distance from the axis of the sun to the planets at the ring of pairs, and between the
        planets of a pair [m]; without profile shift by default.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> from tribodyn.machine import Machine, Operation
    >>> low = PlanetaryStage("s", "r", "carrier", Gear("planet", 0.0, 22, 0.05), 3, 4e-3)
    >>> machine = Machine(
    ...     shafts={name: Shaft() for name in ("sun", "ring")} | {"carrier": Shaft(mass=5.0)},
    ...     gears={"s": Gear("sun", 0.0, 17, 0.05), "r": Gear("ring", 0.0, -61, 0.05)},
    ...     meshes={}, planets={"low": low},
    ...     bearings={"support": Bearing("ring", 0.0, 1e8, torsional_stiffness=1e7)},
    ...     operation=Operation("sun", "carrier", speed=157.08, torque=100.0))
    >>> round(machine.kinematics.shafts["carrier"].speed, 4)
    34.2354
    """

    sun: str
    ring: str
    carrier: str
    planet: Gear
    count: int
    normal_module: float
    helix_angle: float = 0.0
    hand: Hand = "right"
    center_distance: float | None = None
    pressure_angle: float = math.radians(20.0)
    angles: ArrayLike | None = None
    pin: Bearing | None = None
    sun_mesh: ByName = field(default_factory=dict)
    ring_mesh: ByName = field(default_factory=dict)
    sun_to_ring: float = 0.0
    pin_errors: ArrayLike = 0.0
    thickness_errors: ArrayLike = 0.0
    planet_type: PlanetType = "single"
    ring_planet: Gear | None = None
    planet_mesh: ByName = field(default_factory=dict)
    sun_to_planet: float = 0.0
    ring_center_distance: float | None = None
    pair_center_distance: float | None = None

    def __post_init__(self) -> None:
        for name in ("sun", "ring", "carrier"):
            check_name(self, name)
        if not isinstance(self.planet, Gear):
            what, why = f"planet = {quoted(self.planet)}", "Wanted: a Gear"
            raise InputError(what, Argument("PlanetaryStage.planet"), why, "Give a Gear")
        if (self.planet_type == "single") != (self.ring_planet is None):
            what = f'planet_type = "{self.planet_type}" with ring_planet = {self.ring_planet}'
            why, remedy = "Double planets have a second gear", "Give both, or none of them"
            raise InputError(what, Argument("PlanetaryStage.ring_planet"), why, remedy)
        require_whole("count", self.count)
        read_angles(self.count, self.angles)
        check_number(self, "sun_to_ring", "", 0.0, 1.0)
        check_number(self, "sun_to_planet", "", 0.0, 1.0)
        for name in ("pin_errors", "thickness_errors"):
            where = Argument(f"PlanetaryStage.{name}")
            values = real_numbers(
                where, getattr(self, name), "a number [m], or one for each planet"
            )
            most = LARGEST_ERROR * self.normal_module
            if values.shape not in ((), (self.count,)) or np.abs(values).max() > most:
                what = f"{name} = {values.tolist()}"
                why = f"Wanted: one value, or {self.count}, of at most {1e3 * most:.4g} mm"
                raise InputError(what, where, why, "Give numbers in m")
            object.__setattr__(self, name, np.broadcast_to(values, (self.count,)))

    def positions(self, gears: Mapping[str, Gear]) -> Array:
        """Angles of the planets; planets that do not fit are refused.

        Parameters
        ----------
        gears : mapping of str to Gear
            Gears of the machine.

        Returns
        -------
        (N,) array
            From y towards z [rad].

        Raises
        ------
        InputError
            If the teeth of a planet do not enter both gaps, or neighbours touch.
        """
        tips = [self._tip_diameter(gear) for gear in (self.planet, self.ring_planet) if gear]
        at = planetary_positions(
            **self._teeth(gears),
            center_distance=self.center_distance,
            tip_diameter=None if self.center_distance is None else max(tips),
        ).angles
        if self.planet_type == "meshed":
            refuse_touching_pairs(
                self.planet_axes(gears, at), tips, self._tip_diameter(gears[self.sun])
            )
        return at

    def _tip_diameter(self, gear: Gear) -> float:
        return self.normal_module * (gear.teeth / math.cos(self.helix_angle) + 2.0)

    def planet_axes(self, gears: Mapping[str, Gear], angles: Array) -> Array:
        """Axes of the planets of pairs in the plane, as complex numbers y + i z.

        Parameters
        ----------
        gears : mapping of str to Gear
            Gears of the machine.
        angles : (N,) array
            Angles of the planets at the sun [rad].

        Returns
        -------
        (2, N) array
            Of the planets at the sun and at the ring [m].

        Raises
        ------
        InputError
            If the centre distances form no triangle.
        """
        assert self.ring_planet is not None
        module = 0.5 * self.normal_module / math.cos(self.helix_angle)
        first, second = self.planet.teeth, self.ring_planet.teeth
        to_sun = self.center_distance or module * (gears[self.sun].teeth + first)
        to_ring = self.ring_center_distance or module * (abs(gears[self.ring].teeth) - second)
        between = self.pair_center_distance or module * (first + second)
        cosine = (to_sun**2 + to_ring**2 - between**2) / (2.0 * to_sun * to_ring)
        if abs(cosine) >= 1.0:
            raise InputError(
                f"the planets of a pair do not reach each other: their axes are {to_sun * 1e3:.5g} "
                f"and {to_ring * 1e3:.5g} mm from that of the sun and {between * 1e3:.5g} mm apart",
                Argument("PlanetaryStage.ring_planet"),
                "The three axes form a triangle",
                "Correct the numbers of teeth or the centre distances",
            )
        turned = to_ring * np.exp(1j * math.acos(cosine))
        return np.asarray(np.array([[to_sun], [turned]]) * np.exp(1j * angles))

    def phases(self, gears: Mapping[str, Gear]) -> MeshPhases:
        """Phases of all meshes while the sun turns from y towards z relative to the carrier.

        Parameters
        ----------
        gears : mapping of str to Gear
            Gears of the machine.

        Returns
        -------
        MeshPhases
        """
        lags: dict[str, Any] = {
            "sun_to_ring": self.sun_to_ring,
            "sun_to_planet": self.sun_to_planet,
        }
        return mesh_phases(**self._teeth(gears), **lags)

    def _teeth(self, gears: Mapping[str, Gear]) -> dict[str, Any]:
        return {
            "sun_teeth": gears[self.sun].teeth,
            "ring_teeth": gears[self.ring].teeth,
            "planets": self.count,
            "angles": self.angles,
            "planet_teeth": (self.planet.teeth, self.ring_planet.teeth)
            if self.ring_planet
            else self.planet.teeth,
            "planet_type": self.planet_type,
        }

    def mesh_names(self, name: str) -> dict[str, tuple[str, ...]]:
        """Names of the ``sun``, the ``ring`` and, of pairs, the ``planet`` meshes of all planets.

        Parameters
        ----------
        name : str
            Name of the stage.

        Returns
        -------
        dict
        """
        numbers = range(1, self.count + 1)
        kinds = mesh_kinds(self.planet_type).items()
        return {m: tuple(f"{name}_{kind}{i}" for i in numbers) for m, kind in kinds}

    def _meshes(self, name: str) -> set[str]:
        """Names of all its meshes."""
        return {mesh for names in self.mesh_names(name).values() for mesh in names}

    def parts(self, name: str, gears: Mapping[str, Gear]) -> dict[str, dict[str, Any]]:
        """Build the shafts, gears, meshes and bearings of the planets.

        Parameters
        ----------
        name : str
            Name of the stage; ``low`` gives ``low_planet1``, ``low_sun1``, ``low_ring1`` and
            ``low_pin1``, of double planets ``low_ring_planet1`` as well, of pairs also
            ``low_pair1`` and ``low_ring_pin1``.
        gears : mapping of str to Gear
            Gears of the machine, with sun and ring.

        Returns
        -------
        dict
            By ``shafts``, ``gears``, ``meshes`` and ``bearings``.
        """
        rack: dict[str, Any] = {
            "normal_module": self.normal_module,
            "helix_angle": self.helix_angle,
            "pressure_angle": self.pressure_angle,
            "carrier": self.carrier,
        }
        behind = self.ring_planet.position if self.ring_planet else 0.0
        axial, tilting = (1e9, 1e6) if self.helix_angle or behind else (0.0, 0.0)
        pin = self.pin or Bearing(
            "planet", 0.0, 1e9, axial_stiffness=axial, tilting_stiffness=tilting
        )
        parts: dict[str, dict[str, Any]] = {
            k: {} for k in ("shafts", "gears", "meshes", "bearings")
        }
        errors = np.asarray(self.pin_errors), np.asarray(self.thickness_errors)
        at = read_angles(self.count, self.angles)
        for number, angle in enumerate(at.tolist()):
            planets = self._planets(f"{name}_", number + 1)
            parts["shafts"] |= {gear.shaft: Shaft() for gear in planets}
            names = [f"{name}_planet{number + 1}", f"{name}_ring_planet{number + 1}"]
            parts["gears"] |= dict(zip(names, planets, strict=False))
            ahead = float(errors[0][number])
            shift = np.asarray(pin.offset) + ahead * np.array(
                [0.0, -math.sin(angle), math.cos(angle), 0.0, 0.0, 0.0]
            )
            for body, shaft in enumerate(dict.fromkeys(gear.shaft for gear in planets)):
                role = "ring_pin" if body else "pin"
                parts["bearings"][f"{name}_{role}{number + 1}"] = replace(
                    pin,
                    shaft=shaft,
                    carrier=self.carrier,
                    offset=pin.offset if body else shift,
                )
            excess = 0.5 * float(errors[1][number])
            for mesh, link in self._links(gears, names, angle).items():
                fields = dict(getattr(self, f"{mesh}_mesh"))
                flank = 0.0 if mesh == "ring" and self.planet_type == "meshed" else excess
                fields["error"] = without_excess(fields.get("error", 0.0), flank)
                key = self.mesh_names(name)[mesh][number]
                parts["meshes"][key] = Mesh(**{**rack, **link, **fields})
        return parts

    def _planets(self, prefix: str, number: int) -> list[Gear]:
        """Gears of a planet, or of a pair of planets, on their shafts."""
        shaft = f"{prefix}planet{number}"
        planets = [replace(self.planet, shaft=shaft, position=0.0)]
        if self.ring_planet is not None:
            pair = {"shaft": f"{prefix}ring_planet{number}", "position": 0.0}
            place = pair if self.planet_type == "meshed" else {"shaft": shaft}
            planets.append(replace(self.ring_planet, **place))
        return planets

    def _links(
        self, gears: Mapping[str, Gear], planets: list[str], angle: float
    ) -> dict[str, dict[str, Any]]:
        """Gears, hand, direction and centre distance of the meshes of a planet by kind."""
        other: Hand = "left" if self.hand == "right" else "right"
        last = planets[0] if self.ring_planet is None else planets[1]

        def link(
            ends: tuple[str, str], hand: Hand, toward: float, distance: object
        ) -> dict[str, Any]:
            """Fields of a mesh."""
            return {"gears": ends, "hand": hand, "angle": toward, "center_distance": distance}

        distance = self.center_distance
        links = {"sun": link((self.sun, planets[0]), self.hand, angle, distance)}
        if self.planet_type != "meshed":
            return links | {"ring": link((last, self.ring), other, angle + math.pi, distance)}
        first, second = self.planet_axes(gears, np.array([angle]))[:, 0]
        line, inward = float(np.angle(second - first)), float(np.angle(-second))
        links["planet"] = link((planets[0], last), other, line, self.pair_center_distance)
        ends = last, self.ring
        return links | {"ring": link(ends, self.hand, inward, self.ring_center_distance)}
