"""Computed teeth in the plane model of a stage: its contacts over the coordinates of the model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tribodyn.dynamics.equations.system import Contact, LoadFriction, System
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.directions import MeshDirection, mesh_direction
from tribodyn.machine.mesh import Mesh
from tribodyn.machine.plane_law import coordinate_count, pair_coordinates, projected
from tribodyn.machine.planetary.phases import MeshPhases
from tribodyn.machine.planetary.plane_model import without_excess
from tribodyn.types import Array, Tree

#: First coordinates of ring and sun.
_RING, _SUN = 3, 6


@dataclass(frozen=True, eq=False)
class PlanetMesh:
    """Teeth of the sun meshes or of the ring meshes, which are equal but for their phases."""

    member: str  #: ``sun`` or ``ring``
    mesh: Mesh  #: of pinion and wheel, with the contact and the frictions of one pair
    gears: tuple[Gear, Gear]
    planet_first: bool  #: whether the planet is the pinion

    def direction(self, angle: float, *, sun_drives: bool) -> MeshDirection:
        """Direction of the mesh of a planet at an angle; the torque on the sun is positive."""
        turn = 1 if sun_drives else -1
        torque = 1 if self.member == "sun" else -1
        of_member = turn if self.member == "sun" else -turn
        senses = (-turn, of_member) if self.planet_first else (of_member, -turn)
        toward = angle + (math.pi if self.planet_first else 0.0)
        mesh = replace(self.mesh, angle=toward)
        return mesh_direction(mesh, self.gears, torque, senses)

    def rows(self, planet: int, angle: float, size: int, *, sun_drives: bool) -> Array:
        """Coordinates of the pair from those of the stage; ``size`` of the pair, (size, n)."""
        direction = self.direction(angle, sun_drives=sun_drives)
        first = 9 + 3 * planet, _SUN if self.member == "sun" else _RING
        order = first if self.planet_first else first[::-1]
        count = 12 + 3 * planet
        gears = np.zeros((12, count))
        for gear, (start, radius) in enumerate(zip(order, direction.base_radius, strict=True)):
            gears[[6 * gear + 1, 6 * gear + 2], [start, start + 1]] = 1.0
            gears[6 * gear + 3, start + 2] = 1.0 / radius
        member_drives = sun_drives if self.member == "sun" else not sun_drives
        first_drives = member_drives != self.planet_first
        return pair_coordinates(direction, size, first_drives=first_drives) @ gears


def with_computed_teeth(
    stage: System,
    phases: MeshPhases,
    meshes: Sequence[PlanetMesh],
    *,
    sun_drives: bool = True,
    thickness_errors: Array | float = 0.0,
) -> System:
    """Plane model with the force laws and the friction of computed teeth, for a positive torque."""
    contacts: list[Contact] = []
    frictions: list[LoadFriction] = []
    excess = np.broadcast_to(thickness_errors, phases.angles.shape)
    for mesh in meshes:
        lag = getattr(phases, mesh.member)
        offsets = (-lag if sun_drives else lag) % 1.0 % 1.0
        for planet, angle in enumerate(phases.angles):
            rows = np.zeros((coordinate_count(mesh.mesh.contacts[0]), stage.size))
            onto = mesh.rows(planet, float(angle), len(rows), sun_drives=sun_drives)
            rows[:, : onto.shape[1]] = onto
            frictions += [
                projected(
                    friction, rows, contacts=tuple(len(contacts) + j for j in friction.contacts)
                )
                for friction in mesh.mesh.frictions
            ]
            for contact in mesh.mesh.contacts:
                error = without_excess(contact.error, 0.5 * float(excess[planet]))
                changes: Tree = {"offset": float(offsets[planet]), "error": error}
                contacts.append(projected(contact, rows, **changes))
    return replace(stage, contacts=contacts, frictions=frictions)
