"""What the loaded tooth contact tells: loads, deflection, transmission error, stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import draw
from tribodyn.gear import SpurPair
from tribodyn.stiffness.loaded.root_loads import RootLoads, root_loads
from tribodyn.types import Array, Index

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False, repr=False)
class LoadedContact:
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
        Distance of each contact from the pinion's base tangent point.
    pinion_curvature_radius, wheel_curvature_radius : array (p, n) [m]
        Where each gear is touched.
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
    """

    gear_pair: SpurPair
    provider: str
    reference: str
    torque: Array
    phase: Array
    number: Index
    path: Array
    pinion_curvature_radius: Array
    wheel_curvature_radius: Array
    gap: Array
    transmission_error: Array
    normal_force: Array
    load_per_width: Array
    mesh_stiffness_tangent: Array

    @property
    def total_normal_force(self) -> Array:
        """Normal force of all pairs together (...) [N]."""
        return np.asarray(self.torque / self.gear_pair.pinion.base_radius)

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
        from tribodyn.stiffness.loaded.harmonics import harmonic_amplitudes

        return harmonic_amplitudes(self.phase, self.transmission_error, self.mesh_cycles, count)

    @property
    def root_loads(self) -> RootLoads:
        """Bending moment, shear and normal force at the foot of every loaded tooth."""
        return root_loads(self)

    def to_xarray(self) -> xarray.Dataset:
        """Convert to a labelled data set with units.

        Returns
        -------
        xarray.Dataset
        """
        from tribodyn.stiffness.loaded.dataset import to_xarray

        return to_xarray(self)

    def plot(self) -> Any:
        """Draw transmission error, stiffness and load sharing over the roll angle.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, "loaded_contact")

    def plot_load_sharing(self) -> Any:
        """Draw the force on a tooth pair over its way through the mesh.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, "loaded_sharing")

    def plot_deformation(self) -> Any:
        """Draw the teeth in mesh with their deformation enlarged and the forces on them.

        Returns
        -------
        plotly.graph_objects.Figure
            With a slider over the mesh phase; bodies are those of ``fe2d`` whatever the provider.
        """
        return draw(self, "mesh_deformation")

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
