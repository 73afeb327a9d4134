"""Sensors of machines and planetary stages, checked before their motion is computed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import InputError
from tribodyn.study.faults.recording import unlisted_sensor
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.machine import Machine
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.user_tables import PartsCase
    from tribodyn.study.planetary.case import PlanetaryCase

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
#: Signals of a mesh.
_OF_MESH = ("mesh_force", "transmission_error")


@dataclass(frozen=True)
class SensorPlace:
    """Where a sensor is, and what it measures."""

    quantity: str  #: ``acceleration``, ``force``, ``mesh_force`` or ``transmission_error``
    part: str  #: node of the housing, bearing or mesh
    direction: Array  #: of an acceleration or a force
    unit: str
    seat: Callable[[Array], ComplexArray] | None = None  #: between the force and the acceleration


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
    def names(self) -> tuple[str, ...]:
        """Names of all sensors; an angle from y towards z may stand for x, y or z."""
        bearings, axes = self.machine.bearings, "xyz"
        seats = [name for name, bearing in bearings.items() if self.seat or bearing.node]
        return (
            *(f"housing.{n}.acceleration_{a}" for n in self.nodes for a in axes),
            *(f"bearings.{n}.acceleration_{a}" for n in seats for a in axes),
            *(f"bearings.{n}.force_{a}" for n in bearings for a in axes),
            *(f"meshes.{n}.{s}" for n in self.machine.meshes for s in _OF_MESH),
        )

    def check_tacho(self, shaft: str) -> None:
        """Refuse a shaft that there is not."""
        shafts = tuple(self.machine.clock.turns)
        if shaft not in shafts:
            why = f"The shafts are {', '.join(shafts)}"
            raise InputError(f'there is no shaft "{shaft}"', "argument tacho", why, "Name one")

    def place(self, sensor: str) -> SensorPlace:
        """Place of a sensor by its name."""
        group, _, inside = sensor.partition(".")
        part, _, name = inside.rpartition(".")
        quantity, _, axis = name.rpartition("_")
        if sensor in self.names and group == "meshes":
            return SensorPlace(name, part, np.zeros(3), "N" if name == "mesh_force" else "m")
        direction = _direction(axis)
        bearing = self.machine.bearings.get(part) if group == "bearings" else None
        if direction is not None and bearing is not None and quantity == "force":
            return SensorPlace("force", part, direction, "N")
        if direction is not None and quantity == "acceleration":
            if group == "housing" and part in self.nodes:
                return SensorPlace("acceleration", part, direction, "m/s^2")
            if bearing is not None and bearing.node is not None:
                return SensorPlace("acceleration", bearing.node, direction, "m/s^2")
            if bearing is not None and self.seat is not None:
                return SensorPlace("force", part, direction, "m/s^2", self.seat)
            if bearing is not None:
                what = f"the seat of bearing {part} is rigid, so that nothing accelerates"
                why = "There is no housing, and no seat that moves"
                remedy = (
                    'Give seat_mass and seat_frequency in [dynamics], such as "10 kg" and "2 kHz"'
                )
                raise InputError(what, "argument sensor", why, remedy)
        raise unlisted_sensor(sensor, self.names)


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


def seat_accelerance(case: MachineCase | PlanetaryCase) -> Callable[[Array], ComplexArray] | None:
    """Accelerance of a seat of one mass on a spring; None where the case has none."""
    data = case.motion
    if data.seat_mass is None or data.seat_frequency is None:
        return None
    mass, natural, damping = data.seat_mass, data.seat_frequency, data.seat_damping_ratio

    def accelerance(frequency: Array) -> ComplexArray:
        ratio = np.asarray(frequency) / natural
        return np.asarray(-(ratio**2) / (mass * (1.0 - ratio**2 + 2j * damping * ratio)))

    return accelerance


def stage_sensors(case: PlanetaryCase) -> tuple[str, ...]:
    """Names of the sensors of a planetary stage."""
    planets = range(1, case.table.count + 1)
    seat = ("ring.acceleration",) if seat_accelerance(case) else ()
    forces = (f"planet_{i}.{mesh}_mesh_force" for mesh in ("sun", "ring") for i in planets)
    return (*seat, "ring.force", *forces)


def check_stage_sensor(case: PlanetaryCase, sensor: str) -> None:
    """Refuse a sensor that a stage does not have."""
    known = stage_sensors(case)
    if sensor in known:
        return
    if sensor == "ring.acceleration":
        what, why = "the ring is rigid at its sensor", "Nothing accelerates there"
        remedy = "Give seat_mass and seat_frequency in [dynamics]"
        raise InputError(what, "argument sensor", why, remedy)
    raise unlisted_sensor(sensor, known)


def check_stage_tacho(case: PlanetaryCase, member: str) -> None:
    """Refuse a member that a stage does not have, or that stands."""
    members = {name: role for role, name in case.members.items()}
    planet = case.table.planet
    if member not in (*members, planet):
        why = f"The members are {', '.join((*members, planet))}"
        raise InputError(f'there is no member "{member}"', "argument tacho", why, "Name one")


def check_sensors(case: PartsCase, sensor: str | Sequence[str], tacho: str | None = None) -> None:
    """Refuse sensors and tachos that a machine or a stage does not have, before its motion."""
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.planetary.case import PlanetaryCase

    sensors = [sensor] if isinstance(sensor, str) else sensor
    if isinstance(case, PlanetaryCase):
        for name in sensors:
            check_stage_sensor(case, name)
        if tacho is not None:
            check_stage_tacho(case, tacho)
        return
    assert isinstance(case, MachineCase)
    places = MachineSensors(case.machine(), seat_accelerance(case))
    for name in sensors:
        places.place(name)
    if tacho is not None:
        places.check_tacho(tacho)
