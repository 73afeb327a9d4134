"""What sensors of a machine receive of its motion over whole turns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.faults import BearingForce, BearingImpacts
from tribodyn.machine.planetary.ring_sensor import passing_weights
from tribodyn.study.faults.impact_transfer import FreeStructure, ImpactResponse, impact_response
from tribodyn.study.faults.sensors import SensorPlace
from tribodyn.study.faults.turning import SAMPLES, PeriodicMotion, even_samples
from tribodyn.study.planetary.common import only_stage
from tribodyn.study.planetary.stage_result import planetary_angles
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.machine import Machine, MachineStructure
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.result import LoadResult


class RingPlace(NamedTuple):
    """Where a sensor is on a ring, and how it feels a passing planet."""

    angle: float = 0.0  #: from y towards z [rad]
    window: float | Callable[[Array], Array] | None = None  #: as of ``ring_sensor_signal``


@dataclass(frozen=True, eq=False)
class MachineTurningMotion(PeriodicMotion):
    """Motion of a machine over whole turns of its shafts, and what its sensors receive."""

    sound: LoadResult  #: with equal teeth under the same load
    structure: MachineStructure  #: with the force laws of all teeth over the turns
    motion: MachineMotion
    ring: RingPlace

    @property
    def machine(self) -> Machine:
        """The machine with the force laws over the turns."""
        return self.structure.machine

    def series(self, place: SensorPlace) -> Array:
        """Acceleration, force or transmission error."""
        motion = self.motion
        if place.quantity == "force":
            values = motion.bearing_force[:, motion.bearing.index(place.part), :3] @ place.direction
        elif place.quantity == "acceleration":
            values = motion.acceleration[:, motion.node.index(place.part)] @ place.direction
        elif place.quantity == "passing_force":
            names = self.machine.planets[place.part].mesh_names(place.part)["ring"]
            values = motion.mesh_force[:, [motion.mesh.index(name) for name in names]]
        else:
            values = getattr(motion, place.quantity)[:, motion.mesh.index(place.part)]
        fastest = int(motion.cycles.max())
        even = even_samples(motion.clock, SAMPLES * fastest)(values)
        even = np.tile(even, (self.cycles // fastest, *[1] * (even.ndim - 1)))
        if place.quantity == "passing_force":
            even = (even * self._passing(place.part, fastest, len(even))).sum(axis=1)
        return np.asarray(even)

    def _passing(self, stage: str, fastest: int, count: int) -> Array:
        """Weight of each planet at the sensor on the ring, on even samples (count, N)."""
        machine, parts = self.machine, self.machine.planets[stage]
        flow, ring = machine.kinematics.shafts, machine.gears[parts.ring]
        mesh = self.motion.mesh.index(parts.mesh_names(stage)["ring"][0])
        share = float(self.motion.cycles[mesh]) / fastest
        at = np.arange(count) / SAMPLES
        turns = share * (at + self.lead(at / fastest % 1.0)) / abs(ring.teeth)
        relative = np.sign(flow[parts.carrier].speed - flow[ring.shaft].speed)
        return passing_weights(planetary_angles(parts), relative * turns, *self.ring)

    def sensed_from(self, tacho: str | None, angle: float, window: Any) -> MachineTurningMotion:
        """The motion with its tacho on another shaft, and its sensor at an angle of the ring."""
        if only_stage(self.machine) is None:
            return PeriodicMotion.sensed_from(self, tacho, angle, window)  # type: ignore[no-any-return]
        place = RingPlace(angle, window)
        return replace(self, ring=place, tacho=self.tacho if tacho is None else tacho)

    @cached_property
    def free_structure(self) -> FreeStructure:
        """The machine with closed meshes, through which impacts of bearings reach the sensors."""
        return FreeStructure(on_mesh_cycles(self.sound.system))

    def impacts(
        self, sensor: str, defect: tuple[str, BearingImpacts], time: Array, seed: int
    ) -> Array:
        """What a sensor receives of the defect of a bearing, which is named, in its unit."""
        bearing, impacts = defect
        assert isinstance(impacts, BearingForce)
        rate, half_sine = 1.0 / float(time[1] - time[0]), (impacts.force, impacts.duration)
        key = sensor, bearing, rate, half_sine
        if key not in self.splines:
            place = self.places.place(sensor)
            self.splines[key] = impact_response(self, bearing, place, half_sine, rate)
        shaft = self.rotation_frequency(self.machine.bearings[bearing].shaft)
        response: ImpactResponse = self.splines[key]
        return impacts.superposed(response.at, response.duration, shaft, time, seed)

    def __repr__(self) -> str:
        """One line."""
        turns = ", ".join(f"{shaft} {turns}" for shaft, turns in self.turns.items())
        return f"MachineTurningMotion({self.period:.5g} s, turns of the shafts: {turns})"


def on_mesh_cycles(system: System) -> System:
    """The system for means over mesh cycles, which contacts over phases have too."""
    if not system.phases:
        return system
    clock: dict[str, Any] = {"cycles": 1, "offset": 0.0, "turning_error": (), "turning_cycles": ()}
    return replace(system, contacts=[replace(each, **clock) for each in system.contacts])
