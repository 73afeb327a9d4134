"""A planetary stage of a machine under one load: load sharing, motion, modes, ring sensor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.arrays.linear_algebra import periodic
from tribodyn.machine import LoadShares, RingSensorSignal, ring_sensor_signal
from tribodyn.machine.planetary.modes import plane_rows
from tribodyn.machine.planetary.positions import read_angles
from tribodyn.record import fact, quantity, record
from tribodyn.study.machine.motion import PeriodicSamples
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.machine import (
        Machine,
        MachineStructure,
        MeshPhases,
        PlanetaryModes,
        PlanetaryStage,
    )
    from tribodyn.study.machine.result import LoadResult

#: Harmonics whose excited types of modes are listed.
_HARMONICS = 12


@record
class PlanetaryMotion(PeriodicSamples):
    """Periodic motion of a planetary stage in the frame of its carrier.

    Parameters
    ----------
    phase : (s,) array
        Phase of the mesh cycle; both ends and the middle of every step.
    weight : (s,) array
        Weights of the samples for means over the cycle.
    planet : (N,) array
        Numbers of the planets.
    member : tuple of str
        ``carrier``, ``ring``, ``sun``.
    axis : tuple of str
        ``x``, ``y``, and ``u``: rotation times the base radius, of the carrier times that of the
        pins.
    sun_mesh_force, ring_mesh_force : (s, N) array
        Force of each mesh along its transverse line of action [N].
    pin_force : (s, N, 2) array
        Force of each planet on its pin along x and y [N].
    displacement : (s, 3, 3) array
        Displacement of the central members [m].
    mesh_frequency : float
        Mesh cycles per second [Hz].
    """

    phase: Array = quantity("phase", unit="1", axis=True)
    weight: Array = quantity("phase", unit="1")
    planet: Array = quantity("planet", unit="1", axis=True)
    member: tuple[str, ...] = quantity("member", unit="", axis=True)
    axis: tuple[str, ...] = quantity("axis", unit="", axis=True)
    sun_mesh_force: Array = quantity("phase", "planet", unit="N")
    ring_mesh_force: Array = quantity("phase", "planet", unit="N")
    pin_force: Array = quantity("phase", "planet", "direction", unit="N")
    displacement: Array = quantity("phase", "member", "axis", unit="m")
    mesh_frequency: float = fact()

    @property
    def load_factor(self) -> float:
        """Mesh load factor K_gamma in motion: greatest mean load of a planet over that of all."""
        means = self.mean(self.sun_mesh_force)
        return float(means.max() / means.mean())


@dataclass(frozen=True, eq=False)
class StageResult:
    """A planetary stage of a machine under one load.

    Parameters
    ----------
    result : LoadResult
        The machine under the load.
    name : str
        Name of the stage.
    """

    result: LoadResult
    name: str

    @property
    def stage(self) -> PlanetaryStage:
        """The stage of the machine."""
        return self.result.machine.planets[self.name]

    @property
    def meshes(self) -> dict[str, tuple[str, ...]]:
        """Names of the meshes of all planets by kind: ``sun``, ``ring``, of pairs ``planet``."""
        return self.stage.mesh_names(self.name)

    @property
    def phases(self) -> MeshPhases:
        """Phases of all meshes; angles count in the direction of the torque on the sun."""
        return turned_phases(self.result.machine, self.name)

    @property
    def modes(self) -> PlanetaryModes:
        """Natural modes of the machine as motions of the stage in its plane."""
        return self.result.modes.of_stage(self.name)

    @cached_property
    def shares(self) -> LoadShares:
        """Load sharing at rest."""
        static = self.result.static
        force = np.array([static.meshes[mesh].force for mesh in self.meshes["sun"]])
        moved = {role: static.gears[getattr(self.stage, role)][1:3] for role in ("ring", "sun")}
        moved["carrier"] = static.shafts[self.stage.carrier].displacement[0, 1:3]
        places = {role: (float(y), float(z)) for role, (y, z) in moved.items()}
        return LoadShares(force, force / force.mean(), places)

    @cached_property
    def motion(self) -> PlanetaryMotion:
        """Forces and displacements over the mesh cycles of the motion."""
        motion, structure = self.result.motion, self.result.structure
        columns = {
            kind: [motion.mesh.index(mesh) for mesh in names] for kind, names in self.meshes.items()
        }
        numbers = range(1, self.stage.count + 1)
        pins = [motion.bearing.index(f"{self.name}_pin{i}") for i in numbers]
        rows = plane_rows(structure, self.name)
        position = self.result.response.fine.position
        members = ("carrier", "ring", "sun")
        cycles = float(motion.cycles[columns["sun"][0]])
        return PlanetaryMotion(
            phase=motion.clock * cycles,
            weight=motion.weight,
            planet=np.arange(1.0, self.stage.count + 1.0),
            member=members,
            axis=("x", "y", "u"),
            sun_mesh_force=motion.mesh_force[:, columns["sun"]],
            ring_mesh_force=motion.mesh_force[:, columns["ring"]],
            pin_force=motion.bearing_force[:, pins, 1:3],
            displacement=np.stack([position @ rows[member].T for member in members], axis=1),
            mesh_frequency=float(motion.mesh_frequency[columns["sun"][0]]),
        )

    def excitation_text(self) -> str:
        """Types of modes that each harmonic of the mesh frequency excites."""
        return ", ".join(
            f"{k}: {self.phases.excitation(k).types}" for k in range(1, _HARMONICS + 1)
        )

    def ring_sensor(
        self,
        sensor_angle: float = 0.0,
        window: float | Callable[[Array], Array] | None = None,
        steps: int = 256,
    ) -> RingSensorSignal:
        """Signal of a sensor on the ring, which the planets pass.

        Parameters
        ----------
        sensor_angle : float
            Angle of the sensor from y towards z [rad].
        window : float or function, optional
            As for :func:`tribodyn.machine.ring_sensor_signal`.
        steps : int
            Samples of a mesh cycle.

        Returns
        -------
        RingSensorSignal
        """
        machine, motion = self.result.machine, self.motion
        ring = machine.gears[self.stage.ring]
        speeds = {n: load.speed for n, load in machine.kinematics.shafts.items()}
        relative = speeds[self.stage.carrier] - speeds[ring.shaft]
        at = np.arange(steps) / steps
        return ring_sensor_signal(
            ring_mesh_force=periodic(at, motion.phase, motion.ring_mesh_force),
            ring_teeth=abs(ring.teeth),
            angles=planetary_angles(self.stage),
            sensor_angle=sensor_angle,
            window=window,
            carrier_frequency=abs(relative) / (2.0 * np.pi),
            backwards=relative < 0.0,
        )

    @cached_property
    def plane_data(self) -> Tree:
        """Arguments of :func:`tribodyn.machine.planetary_plane_model` for the stage alone."""
        return plane_data(self.result.structure, self.name)


def plane_data(structure: MachineStructure, name: str) -> Tree:
    """Arguments of the plane model of a stage, in the direction of the torque on its sun."""
    machine = structure.machine
    stage, flow, pin = machine.planets[name], machine.kinematics, machine.bearings[f"{name}_pin1"]
    sun, ring = (stage.mesh_names(name)[kind][0] for kind in ("sun", "ring"))
    turn, rows = flow.meshes[sun].sense, plane_rows(structure, name)
    shafts = {role: machine.gears[getattr(stage, role)].shaft for role in ("sun", "ring")}
    shafts["carrier"] = stage.carrier
    data: Tree = {}
    for member in ("carrier", "ring", "sun", "planet1"):
        mobility = np.diag(rows[member] @ np.linalg.solve(structure.mass, rows[member].T))
        inertia = 1.0 / float(mobility[2])
        key = member.removesuffix("1")
        data[f"{key}_inertia"] = inertia
        data[f"{key}_mass"] = 1.0 / float(mobility[0]) if mobility[0] else inertia
    for role, shaft in shafts.items():
        supports = [b.stiffness_matrix for b in machine.bearings.values() if b.shaft == shaft]
        data[f"{role}_support"] = sum(float(each[1, 1]) for each in supports)
        turning = sum(float(each[3, 3]) for each in supports)
        data[f"{role}_torsional_support"] = turning / float(np.abs(rows[role][2]).max()) ** 2
    return {
        **data,
        "planets": stage.count,
        "phases": turned_phases(machine, name),
        "sun_mesh_stiffness": structure.mesh_stiffness(sun),
        "ring_mesh_stiffness": structure.mesh_stiffness(ring),
        "sun_pressure_angle": machine.directions[sun].working_pressure_angle,
        "ring_pressure_angle": machine.directions[ring].working_pressure_angle,
        "pin_stiffness": float(pin.stiffness_matrix[1, 1]),
        "force_per_planet": flow.meshes[sun].force,
        "carrier_speed": turn * flow.shafts[stage.carrier].speed,
        "pin_errors": turn * np.asarray(stage.pin_errors),
        "thickness_errors": np.asarray(stage.thickness_errors),
    }


def turned_phases(machine: Machine, name: str) -> MeshPhases:
    """Phases of a stage whose angles count in the direction of the torque on its sun."""
    stage = machine.planets[name]
    sense = machine.kinematics.meshes[stage.mesh_names(name)["sun"][0]].sense
    lags = {name: sense * getattr(stage, name) % 1.0 for name in ("sun_to_ring", "sun_to_planet")}
    return replace(stage, angles=sense * planetary_angles(stage), **lags).phases(machine.gears)


def planetary_angles(stage: PlanetaryStage) -> Array:
    """Angles of the planets from y towards z [rad]."""
    return read_angles(stage.count, stage.angles)
