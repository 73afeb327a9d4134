"""Signals of a planetary stage by mesh, pin and support."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.machine import planetary_plane_model
from tribodyn.study.machine.motion import MachineMotion, joined
from tribodyn.study.planetary.motion import planetary_motion

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.study.planetary.result import PlanetaryLoadResult
    from tribodyn.types import Array


def signals_along(result: PlanetaryLoadResult, response: Response) -> MachineMotion:
    """Forces and errors of all meshes, forces of pins and supports, along a motion of a stage."""
    data = result.data
    motion = planetary_motion(response, data, result.turn)
    count, samples = motion.planet.size, motion.phase.size
    plane = planetary_plane_model(**data)
    directions = np.array([np.asarray(contact.direction) for contact in plane.contacts])
    # The carrier takes the planets along: what turns with it does not turn against it.
    x, angles = 9 + 3 * np.arange(count), data["phases"].angles
    rotations = np.where(np.arange(plane.size) % 3 == 2, directions, 0.0)
    rotations[:, 2] += directions[:, x + 1] @ np.cos(angles) - directions[:, x] @ np.sin(angles)
    meshes = [f"{mesh} {i + 1}" for mesh in ("sun", "ring") for i in range(count)]
    force = np.hstack([motion.sun_mesh_force, motion.ring_mesh_force])
    radial = {f"pin {i + 1}": motion.pin_force[:, i] for i in range(count)}
    for number, member in enumerate(motion.member):
        if (support := float(data[f"{member}_support"])) > 0.0:
            radial[member] = support * motion.displacement[:, number, :2]
    forces = np.zeros((samples, len(radial), 6))
    forces[..., 1:3] = joined(radial, samples, (2,))
    return MachineMotion(
        clock=motion.phase,
        weight=motion.weight,
        mesh=tuple(meshes),
        bearing=tuple(radial),
        node=(),
        mesh_force=force,
        compression=response.fine.deflection[:, : len(meshes)],
        transmission_error=response.fine.position @ rotations.T,
        open=(force == 0.0).astype(float),
        bearing_force=forces,
        acceleration=np.zeros((samples, 0, 3)),
        cycles=np.ones(len(meshes)),
        frequency=motion.mesh_frequency,
    )


def common_lines(levels: Any, planets: int) -> dict[str, Array | tuple[str, ...]]:
    """Fields of levels with the greatest of all planets for sun meshes, ring meshes and pins."""

    def greatest(values: Array) -> Array:
        """The greatest of the sun meshes and of the ring meshes, in the last axis."""
        return np.asarray(values.reshape(*values.shape[:-1], 2, planets).max(axis=-1))

    def with_pins(values: Array) -> Array:
        """The greatest of all pins, then the supports, in the last axis."""
        pins = values[..., :planets].max(axis=-1, keepdims=True)
        return np.concatenate([pins, values[..., planets:]], axis=-1)

    # All meshes have the same frequency: the lines of the first one are those of all.
    count = len(levels.line) // len(levels.mesh)
    return {
        "mesh": ("sun", "ring"),
        "bearing": ("pins", *levels.bearing[planets:]),
        "line": tuple(f"mesh x {harmonic}" for harmonic in range(1, count + 1)),
        "order": levels.order[:count],
        "mesh_force": greatest(levels.mesh_force),
        "transmission_error": greatest(levels.transmission_error),
        "bearing_force": with_pins(levels.bearing_force),
        "mesh_force_line": greatest(levels.mesh_force_line[:, :count]),
        "transmission_error_line": greatest(levels.transmission_error_line[:, :count]),
        "bearing_force_line": with_pins(levels.bearing_force_line[:, :count]),
        "acceleration_line": levels.acceleration_line[:, :count],
    }
