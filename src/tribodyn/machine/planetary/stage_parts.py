"""A planetary stage of a machine: its planets, pins and meshes as parts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import require_whole
from tribodyn.errors import Argument, InputError, real_numbers
from tribodyn.machine.bearing import Bearing
from tribodyn.machine.fields import check_name, check_number, quoted
from tribodyn.machine.gear import Gear
from tribodyn.machine.mesh import Hand, Mesh
from tribodyn.machine.planetary.phases import MeshPhases, mesh_phases
from tribodyn.machine.planetary.plane_model import without_excess
from tribodyn.machine.planetary.positions import planetary_positions, read_angles
from tribodyn.machine.shaft import Shaft
from tribodyn.types import Array

#: Largest error of a pin or a tooth [m].
_LARGEST_ERROR = 0.01


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
        Number of planets.
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
        Further fields of the meshes, such as ``stiffness``. The first gear of a sun mesh is the
        sun, that of a ring mesh the planet.
    sun_to_ring : float
        Mesh cycles by which the ring mesh of a planet lags behind its sun mesh [1];
        :func:`sun_to_ring_lag` computes it from the teeth.
    pin_errors, thickness_errors : float or (N,) array
        Distance by which a pin is ahead of its place, from y towards z, and excess of the base
        tooth thickness of a planet [m].

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
    sun_mesh: Mapping[str, Any] = field(default_factory=dict)
    ring_mesh: Mapping[str, Any] = field(default_factory=dict)
    sun_to_ring: float = 0.0
    pin_errors: ArrayLike = 0.0
    thickness_errors: ArrayLike = 0.0

    def __post_init__(self) -> None:
        for name in ("sun", "ring", "carrier"):
            check_name(self, name)
        if not isinstance(self.planet, Gear):
            what, why = f"planet = {quoted(self.planet)}", "Wanted: a Gear"
            raise InputError(what, Argument("PlanetaryStage.planet"), why, "Give a Gear")
        require_whole("count", self.count)
        read_angles(self.count, self.angles)
        check_number(self, "sun_to_ring", "", 0.0, 1.0)
        for name in ("pin_errors", "thickness_errors"):
            where = Argument(f"PlanetaryStage.{name}")
            values = real_numbers(
                where, getattr(self, name), "a number [m], or one for each planet"
            )
            if values.shape not in ((), (self.count,)) or np.abs(values).max() > _LARGEST_ERROR:
                what = f"{name} = {values.tolist()}"
                why = f"Wanted: one value, or {self.count}, of at most 10 mm"
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
        return planetary_positions(
            **self._teeth(gears),
            planet_teeth=self.planet.teeth,
            center_distance=self.center_distance,
            tip_diameter=None
            if self.center_distance is None
            else self.normal_module * (self.planet.teeth / math.cos(self.helix_angle) + 2.0),
        ).angles

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
        return mesh_phases(**self._teeth(gears), sun_to_ring=self.sun_to_ring)

    def _teeth(self, gears: Mapping[str, Gear]) -> dict[str, Any]:
        return {
            "sun_teeth": gears[self.sun].teeth,
            "ring_teeth": gears[self.ring].teeth,
            "planets": self.count,
            "angles": self.angles,
        }

    def mesh_names(self, name: str) -> dict[str, tuple[str, ...]]:
        """Names of the ``sun`` and of the ``ring`` meshes of all planets.

        Parameters
        ----------
        name : str
            Name of the stage.

        Returns
        -------
        dict
        """
        numbers = range(1, self.count + 1)
        return {m: tuple(f"{name}_{m}{i}" for i in numbers) for m in ("sun", "ring")}

    def parts(self, name: str, gears: Mapping[str, Gear]) -> dict[str, dict[str, Any]]:
        """Build the shafts, gears, meshes and bearings of the planets.

        Parameters
        ----------
        name : str
            Name of the stage; ``low`` gives ``low_planet1``, ``low_sun1``, ``low_ring1`` and
            ``low_pin1``.
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
            "center_distance": self.center_distance,
            "carrier": self.carrier,
        }
        other: Hand = "left" if self.hand == "right" else "right"
        axial, tilting = (1e9, 1e6) if self.helix_angle else (0.0, 0.0)
        pin = self.pin or Bearing(
            "planet", 0.0, 1e9, axial_stiffness=axial, tilting_stiffness=tilting
        )
        parts: dict[str, dict[str, Any]] = {
            k: {} for k in ("shafts", "gears", "meshes", "bearings")
        }
        errors = np.asarray(self.pin_errors), np.asarray(self.thickness_errors)
        for number, angle in enumerate(read_angles(self.count, self.angles).tolist()):
            planet = f"{name}_planet{number + 1}"
            parts["shafts"][planet] = Shaft()
            parts["gears"][planet] = replace(self.planet, shaft=planet, position=0.0)
            ahead = float(errors[0][number])
            shift = np.asarray(pin.offset) + ahead * np.array(
                [0.0, -math.sin(angle), math.cos(angle), 0.0, 0.0, 0.0]
            )
            parts["bearings"][f"{name}_pin{number + 1}"] = replace(
                pin, shaft=planet, carrier=self.carrier, offset=shift
            )
            for mesh, ends, hand, toward in (
                ("sun", (self.sun, planet), self.hand, angle),
                ("ring", (planet, self.ring), other, angle + math.pi),
            ):
                fields = dict(getattr(self, f"{mesh}_mesh"))
                excess = 0.5 * float(errors[1][number])
                fields["error"] = without_excess(fields.get("error", 0.0), excess)
                part = Mesh(ends, hand=hand, angle=toward, **rack, **fields)
                parts["meshes"][f"{name}_{mesh}{number + 1}"] = part
        return parts
