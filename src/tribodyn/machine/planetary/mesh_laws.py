"""Computed teeth in the plane model: lag of the ring meshes, and contacts over its coordinates."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.dynamics.equations.system import Contact, LoadFriction, System
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.directions import MeshDirection, mesh_direction
from tribodyn.machine.mesh import Mesh
from tribodyn.machine.plane_law import coordinate_count, pair_coordinates, projected
from tribodyn.machine.planetary.phases import MeshPhases
from tribodyn.machine.planetary.plane_model import without_excess
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.gear import CylindricalPair

#: First coordinates of ring and sun.
_RING, _SUN = 3, 6


def sun_to_ring_lag(
    sun_pair: CylindricalPair, ring_pair: CylindricalPair, *, sun_drives: bool = True
) -> float:
    """Mesh cycles by which the ring mesh of a planet lags behind its sun mesh.

    Parameters
    ----------
    sun_pair, ring_pair : CylindricalPair
        Sun and planet, planet and ring. The mesh phase is 0 where a pair of teeth begins contact.
    sun_drives : bool
        Whether power flows from the sun to the ring relative to the carrier; if not, the
        ring mesh leads by the value.

    Returns
    -------
    float
        From 0 to below 1 [1]; ``sun_to_ring`` of :func:`mesh_phases`.

    Notes
    -----
    Opposite flanks of a planet carry in its two meshes. From the angles of their involutes on the
    base circle, ``lag p_b = r_b (pi - alpha_s - alpha_r) + rho_s + rho_r - s_b`` with the radii of
    curvature of the planet's flanks where contact begins and its base tooth thickness.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> rack = {"normal_module": 4e-3, "normal_pressure_angle": math.radians(20.0)}
    >>> sun = spur_pair(pinion_teeth=17, wheel_teeth=22, pinion_face_width=0.05, **rack)
    >>> ring = spur_pair(pinion_teeth=22, wheel_teeth=-61, pinion_face_width=0.05, **rack)
    >>> round(sun_to_ring_lag(sun, ring), 4)
    0.1235
    """
    planet = ring_pair.pinion
    wheel = sun_pair.pinion.teeth != planet.teeth or sun_pair.wheel.teeth == planet.teeth
    return gear_lag(sun_pair, ring_pair, wheel=(wheel, False), drives=sun_drives)


def gear_lag(
    first: CylindricalPair,
    second: CylindricalPair,
    *,
    wheel: tuple[bool, bool],
    turn: float = 0.0,
    drives: bool = True,
) -> float:
    """Mesh cycles by which the second mesh of a gear lags behind the first [1]."""
    # The gear is the wheel or the pinion of each pair; its second mate is opposite to the first
    # one, but for an angle ``turn`` from y towards z while the first one turns this way.
    gear = first.wheel if wheel[0] else first.pinion
    begin, alpha = [], first.operating_pressure_angle + second.operating_pressure_angle
    for pair, is_wheel, at_tip in ((first, wheel[0], drives), (second, wheel[1], not drives)):
        radii = sorted(
            pair.line_of_action_length - limit if is_wheel else limit for limit in pair.path_limits
        )
        begin.append(radii[at_tip])
    arc = math.pi - alpha - turn
    distance = gear.base_radius * (arc - 2.0 * gear.base_half_angle) + sum(begin)
    return float((distance / gear.base_pitch) % 1.0)


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
