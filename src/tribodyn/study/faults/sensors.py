"""Sensors of pairs and machines, checked before their motion is computed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from tribodyn.aliases import closest
from tribodyn.errors import InputError, did_you_mean, no_such
from tribodyn.nomenclature import GEARS
from tribodyn.study.planetary.common import only_stage
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.machine import Machine
    from tribodyn.study.machine.case import AnyCase

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
#: Signals of a mesh.
_OF_MESH = ("mesh_force", "transmission_error")
#: Signals of the mesh of a pair by their names in the data of a result.
_OF_PAIR = {"mesh_force": "mesh_force", "dynamic_transmission_error": "transmission_error"}
_RIGID = "Give seat_mass and seat_frequency in [dynamics]"


class SensorPlace(NamedTuple):
    """Where a sensor is, and what it measures."""

    #: ``acceleration``, ``force``, ``passing_force``, ``mesh_force`` or ``transmission_error``
    quantity: str
    part: str  #: coordinate, node of the housing, bearing, mesh or stage
    unit: str
    direction: Array = np.zeros(3)  #: of an acceleration or a force
    seat: Callable[[Array], ComplexArray] | None = None  #: between the force and the acceleration


class Sensors(Protocol):
    """Sensors of a case."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all sensors."""

    @property
    def shafts(self) -> tuple[str, ...]:
        """Shafts, gears of a pair, or members of a stage, that may have the tacho."""

    def place(self, sensor: str) -> SensorPlace:
        """Place of a sensor by its name; refuse another name."""


@dataclass(frozen=True)
class PairSensors:
    """Sensors of a pair with these coordinates."""

    coordinates: tuple[str, ...]
    shafts: tuple[str, ...] = GEARS

    @cached_property
    def _by_name(self) -> dict[str, str]:
        """Coordinates and attributes of the signals by their names in the data of a result."""
        from tribodyn.study.pipeline.response_series import centre_column, directions_of

        by_coordinate = {name: name for name in self.coordinates}
        for gear in GEARS:
            for direction, (axis, _) in directions_of(self.coordinates).items():
                column = centre_column(self.coordinates, gear, axis)
                if column is not None:
                    by_coordinate[self.coordinates[column]] = f"acceleration_{direction}_{gear}"
        return {signal: name for name, signal in by_coordinate.items()} | _OF_PAIR

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all sensors; coordinates stand for their accelerations."""
        return tuple(self._by_name)

    def place(self, sensor: str) -> SensorPlace:
        """Coordinate or mesh of a signal, whose attribute is also accepted."""
        by_name = self._by_name
        if sensor not in by_name and sensor not in by_name.values():
            sensor_names = [a if a == b else f"{b} or {a}" for a, b in by_name.items()]
            raise unlisted_sensor(sensor, sensor_names)
        name = by_name.get(sensor, sensor)
        if name in self.coordinates:
            return SensorPlace("acceleration", name, "rad/s^2" if "_theta" in name else "m/s^2")
        return SensorPlace(name, "mesh", "N" if name == "mesh_force" else "m")


@dataclass(frozen=True)
class MachineSensors:
    """Sensors of a machine."""

    machine: Machine
    seat: Callable[[Array], ComplexArray] | None  #: accelerance of a seat [1/kg] over [Hz]

    @property
    def nodes(self) -> tuple[str, ...]:
        """Nodes of the housing."""
        housing = self.machine.housing
        return tuple(housing.nodes or ()) if housing is not None else ()

    @property
    def shafts(self) -> tuple[str, ...]:
        """Names of the shafts."""
        return tuple(self.machine.clock.turns)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all sensors; an angle from y towards z may stand for x, y or z."""
        bearings, axes = self.machine.bearings, "xyz"
        seats = [name for name, bearing in bearings.items() if self.seat or bearing.node]
        return (
            *(f"housing.{n}.acceleration_{a}" for n in self.nodes for a in axes),
            *(f"bearings.{n}.acceleration_{a}" for n in seats for a in axes),
            *(f"bearings.{n}.force_{a}" for n in bearings for a in axes),
            *(f"meshes.{n}.{s}" for n in self.machine.meshes for s in _OF_MESH),
            *self._of_stage,
        )

    @cached_property
    def _of_stage(self) -> dict[str, SensorPlace]:
        """Ring that planets pass, and planets of a machine that is one stage, by their names."""
        stage = only_stage(self.machine)
        if stage is None:
            return {}
        places = {"ring.force": SensorPlace("passing_force", stage, "N")}
        if self.seat:
            places["ring.acceleration"] = SensorPlace(
                "passing_force", stage, "m/s^2", seat=self.seat
            )
        return places | {
            f"planet_{number}.{kind}_mesh_force": SensorPlace("mesh_force", mesh, "N")
            for kind, meshes in self.machine.planets[stage].mesh_names(stage).items()
            for number, mesh in enumerate(meshes, 1)
        }

    def place(self, sensor: str) -> SensorPlace:
        """Place of a sensor by its name."""
        if sensor in self._of_stage:
            return self._of_stage[sensor]
        if sensor == "ring.acceleration" and self._of_stage:
            what, why = "the ring is rigid at its sensor", "Nothing accelerates there"
            raise InputError(what, "argument sensor", why, _RIGID)
        group, _, inside = sensor.partition(".")
        part, _, name = inside.rpartition(".")
        quantity, _, axis = name.rpartition("_")
        if sensor in self.names and group == "meshes":
            return SensorPlace(name, part, "N" if name == "mesh_force" else "m")
        direction = _direction(axis)
        bearing = self.machine.bearings.get(part) if group == "bearings" else None
        if direction is not None and bearing is not None and quantity == "force":
            return SensorPlace("force", part, "N", direction)
        if direction is not None and quantity == "acceleration":
            if group == "housing" and part in self.nodes:
                return SensorPlace("acceleration", part, "m/s^2", direction)
            if bearing is not None and bearing.node is not None:
                return SensorPlace("acceleration", bearing.node, "m/s^2", direction)
            if bearing is not None and self.seat is not None:
                return SensorPlace("force", part, "m/s^2", direction, self.seat)
            if bearing is not None:
                what = f"the seat of bearing {part} is rigid, so that nothing accelerates"
                why = "There is no housing, and no seat that moves"
                remedy = f'{_RIGID}, such as "10 kg" and "2 kHz"'
                raise InputError(what, "argument sensor", why, remedy)
        raise unlisted_sensor(sensor, self.names)


def unlisted_sensor(sensor: str, sensors: Sequence[str]) -> InputError:
    """Error of a sensor that a motion does not have."""
    why = f"The sensors are {closest(sensor, sensors)}"
    remedy = did_you_mean(sensor, sensors, "Name one of these")
    return InputError(f'no sensor is named "{sensor}"', "argument sensor", why, remedy)


def _direction(axis: str) -> Array | None:
    """Unit vector of ``x``, ``y``, ``z`` or an angle such as ``30deg``; None of anything else."""
    if axis in _AXES:
        return np.array(_AXES[axis])
    try:
        angle = math.radians(float(axis.removesuffix("deg")))
    except ValueError:
        return None
    if not axis.endswith("deg") or not math.isfinite(angle):
        return None
    return np.array([0.0, math.cos(angle), math.sin(angle)])


def seat_accelerance(data: Any) -> Callable[[Array], ComplexArray] | None:
    """Accelerance of a seat of one mass on a spring, by its table; None where it has none."""
    if data.seat_mass is None or data.seat_frequency is None:
        return None
    mass, natural, damping = data.seat_mass, data.seat_frequency, data.seat_damping_ratio

    def accelerance(frequency: Array) -> ComplexArray:
        ratio = np.asarray(frequency) / natural
        return np.asarray(-(ratio**2) / (mass * (1.0 - ratio**2 + 2j * damping * ratio)))

    return accelerance


def sensors_of(case: AnyCase) -> Sensors:
    """Sensors of the parts of a case, or of the coordinates of its lumped structure."""
    if not case.lumped:
        return MachineSensors(case.machine(), seat_accelerance(case.motion))
    from tribodyn.errors import collected
    from tribodyn.study.case.to_models import locate_errors
    from tribodyn.study.pipeline.assembly import whole_system
    from tribodyn.study.pipeline.tooth_contact import mesh_of

    with locate_errors(case), collected():  # the run raises the warnings
        mesh = mesh_of(case, rehearsal=True)
        return PairSensors(tuple(whole_system(case, mesh, rehearsal=True).names))


def check_sensors(places: Sensors, sensor: str | Sequence[str], tacho: str | None = None) -> None:
    """Refuse sensors and a tacho that a case does not have, before its motion."""
    for name in [sensor] if isinstance(sensor, str) else sensor:
        places.place(name)
    if tacho is not None:
        check_tacho(places, tacho)


def check_tacho(places: Sensors, shaft: str) -> None:
    """Refuse a shaft that there is not."""
    if shaft not in places.shafts:
        raise InputError(no_such("shaft", shaft, places.shafts, "argument tacho"))
