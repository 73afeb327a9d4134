"""Motion of a planetary stage over a mesh cycle: forces and displacements of all parts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.machine.planetary.pins import pins_of
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Response


@record
class PlanetaryMotion(Record):
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

    def mean(self, signal: Array) -> Array:
        """Mean over the mesh cycle.

        Parameters
        ----------
        signal : (s, ...) array
            On the samples.

        Returns
        -------
        (...) array
            In the unit of the signal.
        """
        return np.asarray(np.tensordot(self.weight, signal, axes=1))

    def rms(self, signal: Array) -> Array:
        """Root mean square about the mean.

        Parameters
        ----------
        signal : (s, ...) array
            On the samples.

        Returns
        -------
        (...) array
            In the unit of the signal.
        """
        return np.asarray(np.sqrt(np.maximum(self.mean((signal - self.mean(signal)) ** 2), 0.0)))

    @property
    def load_factor(self) -> float:
        """Mesh load factor K_gamma in motion: greatest mean load of a planet over that of all."""
        means = self.mean(self.sun_mesh_force)
        return float(means.max() / means.mean())


def planetary_motion(response: Response, data: Mapping[str, Any], turn: int) -> PlanetaryMotion:
    """Motion of a stage from the response of its plane model, whose y is along the sun's torque."""
    fine, angles = response.fine, data["phases"].angles
    count = angles.size
    position = fine.position.reshape(len(fine.phase), -1, 3)
    # Radial and tangential forces of the planets on their pins, turned to x and y.
    laws = pins_of(data).supports()
    on_pins = np.stack([law.force(law.displacement(fine.position)) for law in laws], axis=1)
    # A mesh is one contact, or two of a law that is linear about the load.
    sun, ring = (
        fine.contact_force.reshape(len(fine.phase), 2, count, -1).sum(axis=-1).swapaxes(0, 1)
    )
    turned = (on_pins[..., 0] + 1j * on_pins[..., 1]) * np.exp(1j * angles)
    pin_force = np.stack([turned.real, turned.imag], axis=-1)
    return PlanetaryMotion(
        phase=fine.phase - fine.phase[0],
        weight=fine.weight,
        planet=np.arange(1.0, count + 1.0),
        member=("carrier", "ring", "sun"),
        axis=("x", "y", "u"),
        sun_mesh_force=sun,
        ring_mesh_force=ring,
        pin_force=pin_force * np.array([1.0, turn]),
        displacement=position[:, :3] * np.array([1.0, turn, turn]),
        mesh_frequency=response.mesh_frequency,
    )
