"""Result of the loaded tooth contact: loads, deflection, transmission error, stiffness."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, NamedTuple

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.gear import SpurGear, SpurPair, half_tooth
from tribodyn.record import Labels, Record, fact, figure_method, quantity, record
from tribodyn.stiffness.teeth.tooth_bending import load_point
from tribodyn.types import Array, Index


class RootLoads(NamedTuple):
    """Loads at the feet of the teeth of both gears, (..., p, n) each.

    Parameters
    ----------
    pinion_bending_moment, wheel_bending_moment : array [N*m]
        About the middle of the foot, positive where the loaded flank is in tension.
    pinion_shear_force, wheel_shear_force : array [N]
        Across the axis of the tooth.
    pinion_compressive_force, wheel_compressive_force : array [N]
        Along the axis of the tooth, towards the gear centre.
    """

    pinion_bending_moment: Array
    wheel_bending_moment: Array
    pinion_shear_force: Array
    wheel_shear_force: Array
    pinion_compressive_force: Array
    wheel_compressive_force: Array


def root_loads(pair: SpurPair, curvature_radii: tuple[Array, Array], force: Array) -> RootLoads:
    """Carry the normal force of every pair to the feet of its two teeth.

    The foot is the height at which the fillet meets the root circle, the lowest section of the
    tooth; the force crosses the axis of the tooth at the height ``h``:
    ``M = F cos(a) (h - h_foot)``, ``Q = F cos(a)``, ``N = F sin(a)``. Without friction. Source:
    statics; the lever of ISO 6336-3 is that of the 30 degree tangent, a little higher.
    """
    feet = [
        _foot(gear, radius, force)
        for gear, radius in zip((pair.pinion, pair.wheel), curvature_radii, strict=True)
    ]
    return RootLoads(*(load for tooth_loads in zip(*feet, strict=True) for load in tooth_loads))


def _foot(gear: SpurGear, curvature_radius: Array, force: Array) -> tuple[Array, Array, Array]:
    load = load_point(gear, curvature_radius)
    lever = load.axis_height - half_tooth(gear)[0][0]
    across = force * np.cos(load.load_angle)
    return across * lever, across, force * np.sin(load.load_angle)


def harmonic_amplitudes(phase: Array, values: Array, mesh_cycles: int, count: int) -> Array:
    """Peak amplitudes of the orders 1, 2, ... of the mesh frequency."""
    even = np.arange(phase.size) * (mesh_cycles / phase.size) + phase[0]
    if not np.allclose(phase, even, rtol=0.0, atol=1e-9):
        why = "Harmonics need evenly spaced phases over whole mesh cycles"
        remedy = "Give the number of phases of a mesh cycle instead"
        raise InputError("mesh phases that are not evenly spaced", Argument("phases"), why, remedy)
    if not 1 <= count < phase.size / (2 * mesh_cycles):
        raise InputError(
            f"count = {count}",
            where=Argument("count"),
            why=f"{phase.size // mesh_cycles} phases of a mesh cycle have less than half as "
            "many harmonics",
            remedy="Give more phases, for example phases=64",
        )
    spectrum = 2.0 * np.abs(np.fft.rfft(values, axis=-1)) / phase.size
    return np.asarray(spectrum[..., mesh_cycles * np.arange(1, count + 1)])


@record
class LoadedContact(Record):
    """Quasi-static mesh under load; made by :func:`tribodyn.stiffness.loaded_contact`.

    Shapes: ``...`` is nothing for one torque and (torques,) for several; p phases, n tooth pairs
    that may touch, s slices of the face width. A mesh whose teeth differ goes on over several
    mesh cycles.

    Parameters
    ----------
    gear_pair : SpurPair
        Both gears in their working position.
    provider : str
        What the tooth compliances come from.
    reference : str
        Where the gear bodies are held.
    torque : array (...) [N*m]
        Torque on the pinion.
    phase : array (p,)
        Mesh phase, 0 where a pair reaches A, from 0 to the number of mesh cycles.
    number : array (n,) of int
        Mesh cycles between the entry of each pair and that of pair 0.
    path : array (p, n) [m]
        Distance of each contact from the pinion's base tangent point, in the middle of the face.
    pinion_curvature_radius, wheel_curvature_radius : array (p, n) [m]
        Where each gear is touched there.
    gap : array (p, n) [m]
        Least separation of each pair over the face width without load.
    transmission_error : array (..., p) [m]
        Approach of the gears along the line of action from the contact of perfect rigid flanks:
        deflection and deviations together; positive where the driven gear lags.
    normal_force : array (..., p, n) [N]
        Force on each pair.
    load_per_width : array (..., p, s, n) [N/m]
        Load of each pair in each slice.
    mesh_stiffness_tangent : array (..., p) [N/m]
        Slope of the total force over the transmission error at this load.
    face_load : array (..., s), optional
        Force on each slice over all phases and pairs, over the mean of all slices.
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {
        "deflection": Labels(("torque", "phase"), of="static_transmission_error"),
        "mesh_stiffness_secant": Labels(("torque", "phase")),
        "load_share": Labels(("torque", "phase", "pair")),
        "pair_deflection": Labels(("torque", "phase", "pair"), of="static_transmission_error"),
    }

    gear_pair: SpurPair
    provider: str = fact()
    reference: str = fact()
    torque: Array = quantity("torque", axis=True)
    phase: Array = quantity("phase", axis=True, of="mesh_phase")
    number: Index = quantity("pair", unit="1", axis=True, name="pair")
    path: Array = quantity("phase", "pair")
    pinion_curvature_radius: Array = quantity("phase", "pair", of="curvature_radius")
    wheel_curvature_radius: Array = quantity("phase", "pair", of="curvature_radius")
    gap: Array = quantity("phase", "pair", of="static_transmission_error")
    transmission_error: Array = quantity("torque", "phase", of="static_transmission_error")
    normal_force: Array = quantity("torque", "phase", "pair")
    load_per_width: Array = quantity("torque", "phase", "slice", "pair")
    mesh_stiffness_tangent: Array = quantity("torque", "phase")
    face_load: Array | None = quantity("torque", "slice", unit="1", default=None)

    @property
    def total_normal_force(self) -> Array:
        """Normal force of all pairs together (...) [N]."""
        return np.asarray(self.torque / self.gear_pair.pinion.base_radius)

    @property
    def face_load_factor(self) -> Array:
        """Greatest over mean load of a slice of the face, each over all phases (...)."""
        each = np.full(1, np.nan) if self.face_load is None else self.face_load
        return np.asarray(each.max(axis=-1))

    @property
    def load_share(self) -> Array:
        """Part of the normal force on each pair (..., p, n)."""
        return np.asarray(self.normal_force / self.total_normal_force[..., None, None])

    @property
    def unloaded_transmission_error(self) -> Array:
        """Transmission error of the rigid mesh (p,) [m]: that of the deviations alone."""
        return np.asarray(self.gap.min(axis=-1))

    @property
    def deflection(self) -> Array:
        """Approach that the load alone causes (..., p) [m]."""
        return self.transmission_error - self.unloaded_transmission_error

    @property
    def pair_deflection(self) -> Array:
        """Deflection of each loaded pair (..., p, n) [m]: approach less gap, zero where apart."""
        left = self.transmission_error[..., None] - self.gap
        return np.where(self.normal_force > 0.0, left, 0.0)

    @property
    def mesh_stiffness_secant(self) -> Array:
        """Total force over the deflection that it causes (..., p) [N/m]."""
        return np.asarray(self.total_normal_force[..., None] / self.deflection)

    @property
    def mesh_cycles(self) -> int:
        """Mesh cycles after which everything repeats."""
        return round(float(self.phase[-1] + self.phase[1] - self.phase[0]))

    @property
    def mean_transmission_error(self) -> Array:
        """Mean over the phases (...) [m]."""
        return np.asarray(self.transmission_error.mean(axis=-1))

    @property
    def peak_to_peak_transmission_error(self) -> Array:
        """Largest less least transmission error (...) [m]."""
        return np.asarray(np.ptp(self.transmission_error, axis=-1))

    def transmission_error_harmonics(self, count: int = 5) -> Array:
        """Amplitudes of the mesh harmonics of the transmission error.

        Parameters
        ----------
        count : int
            Number of harmonics, less than half the phases of a mesh cycle.

        Returns
        -------
        array (..., count) [m]
            Peak amplitudes of the orders 1, 2, ... of the mesh frequency.

        Raises
        ------
        InputError
            If there are too few phases, or they are not evenly spaced.
        """
        return harmonic_amplitudes(self.phase, self.transmission_error, self.mesh_cycles, count)

    @property
    def root_loads(self) -> RootLoads:
        """Bending moment, shear and normal force at the foot of every loaded tooth."""
        radii = self.pinion_curvature_radius, self.wheel_curvature_radius
        return root_loads(self.gear_pair, radii, self.normal_force)

    plot_load_sharing = figure_method(
        "loaded_sharing", "Draw the force on a tooth pair over its way through the mesh."
    )
    plot_deformation = figure_method(
        "mesh_deformation",
        "Draw the teeth in mesh with the forces on them and their deformation enlarged, that of "
        "``fe2d`` whatever the provider, with a slider over the mesh phase.",
    )

    def __repr__(self) -> str:
        """One line with the figures that matter."""
        if self.torque.ndim:
            low, high = self.torque.min(), self.torque.max()
            return (
                f"LoadedContact({self.provider}, {self.torque.size} torques from {low:g} to "
                f"{high:g} N*m, {self.phase.size} phases)"
            )
        return (
            f"LoadedContact({self.provider}, {float(self.torque):g} N*m, transmission error "
            f"{self.mean_transmission_error * 1e6:.4g} um mean, "
            f"{self.peak_to_peak_transmission_error * 1e6:.4g} um peak to peak, "
            f"stiffness {self.mesh_stiffness_secant.mean():.4g} N/m)"
        )
