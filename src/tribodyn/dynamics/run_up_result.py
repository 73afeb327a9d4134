"""The motion of a run-up or run-down: samples over the mesh phase, figures of every mesh cycle."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.dynamics.run_up_profile import SpeedProfile
from tribodyn.dynamics.time.ensemble import LaneStatistics
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array, Index

if TYPE_CHECKING:
    import xarray

    from tribodyn.dynamics.natural_modes import NaturalModes


@dataclass(frozen=True)
class CycleStatistics:
    """Figures of every mesh cycle of a run-up, exact to the order of the integrator."""

    time: Array  #: [Hz]
    mesh_frequency: Array  #: [Hz]
    rate: Array  #: mean change of the mesh frequency [Hz/s]
    deflection: LaneStatistics = field(repr=False)  #: [m, N, m/s^2 or rad/s^2, as given]
    contact_force: LaneStatistics = field(repr=False)  #: [m, N, m/s^2 or rad/s^2, as given]
    acceleration: LaneStatistics = field(repr=False)  #: [m, N, m/s^2 or rad/s^2, as given]
    output: LaneStatistics = field(repr=False)  #: [m, N, m/s^2 or rad/s^2, as given]
    contact_loss_share: Array = field(repr=False)  #: part of the cycle off the driving flank [-]
    extra_force: Array = field(repr=False)  #: [N or N*m]
    steps: Index = field(repr=False)  #: integration steps

    def __repr__(self) -> str:
        """One line."""
        return f"CycleStatistics({self.time.size} mesh cycles)"


@dataclass(frozen=True)
class RunUp:
    """Motion while the speed changes as prescribed, sampled equally in the mesh phase.

    Parameters
    ----------
    time : (m,) array
        Time [s].
    phase : (m,) array
        Mesh cycles from the beginning [-].
    mesh_frequency : (m,) array
        Mesh frequency [Hz].
    position, velocity, acceleration : (m, n) array
        Coordinates and their derivatives [m or rad, ...], without the free rotation's drift.
    deflection, contact_force : (m, contacts) array
        Compression [m] and force [N] of the contacts.
    output : (m, o) array
        Further outputs [``output_unit``].
    names, output_names : tuple of str
        Names of the coordinates and of the outputs.
    output_unit : str
        Unit of the outputs.
    samples : int
        Samples of a mesh cycle.
    teeth : int
        Mesh cycles per revolution of the shaft whose speed is told.
    cycles : CycleStatistics
        Figures of every mesh cycle.
    profile : SpeedProfile
        The prescribed speed.
    step_number : float
        Largest ``omega_max * dt`` [-].
    modes : NaturalModes, optional
        Natural modes at the middle of the speeds; None where there are none.
    """

    time: Array
    phase: Array
    mesh_frequency: Array
    position: Array
    velocity: Array
    acceleration: Array
    deflection: Array
    contact_force: Array
    output: Array
    names: tuple[str, ...]
    output_names: tuple[str, ...]
    output_unit: str
    samples: int
    teeth: int
    cycles: CycleStatistics = field(repr=False)
    profile: SpeedProfile
    step_number: float
    modes: NaturalModes | None = field(default=None, repr=False)

    @property
    def speed(self) -> Array:
        """Speed of the shaft at the samples, (m,) [rad/s]."""
        return 2.0 * np.pi * self.mesh_frequency / self.teeth

    @property
    def rotation(self) -> Array:
        """Angle of the shaft at the samples, (m,) [rad]."""
        return 2.0 * np.pi * self.phase / self.teeth

    def signal(self, name: str) -> tuple[Array, str]:
        """Take one signal by its name.

        Parameters
        ----------
        name : str
            ``"deflection"`` (first contact), ``"contact_force"`` (sum of all contacts), the name
            of a coordinate (its acceleration) or of an output.

        Returns
        -------
        tuple of (m,) array and str
            The samples and their unit.

        Raises
        ------
        InputError
            If there is no such signal.
        """
        if name == "deflection" and self.deflection.shape[1]:
            return self.deflection[:, 0], "m"
        if name == "contact_force" and self.contact_force.shape[1]:
            return np.asarray(self.contact_force.sum(axis=1)), "N"
        if name in self.names:
            unit = "rad/s^2" if name.endswith("theta") else "m/s^2"
            return self.acceleration[:, self.names.index(name)], unit
        if name in self.output_names:
            return self.output[:, self.output_names.index(name)], self.output_unit
        known = ("deflection", "contact_force", *self.names, *self.output_names)
        raise InputError(
            Problem(
                what=f'no signal "{name}"',
                where="argument signal",
                why=f"There are {', '.join(known)}",
            )
        )

    def __repr__(self) -> str:
        """One line."""
        beat = np.asarray(self.profile.mesh_frequency)
        lost = float(np.max(self.cycles.contact_loss_share, initial=0.0))
        return (
            f"RunUp({self.profile.duration:.6g} s, {self.cycles.time.size} mesh cycles from "
            f"{beat[0]:.6g} over {self.profile.highest:.6g} to {beat[-1]:.6g} Hz, "
            f"{len(self.names)} coordinates, "
            f"{self.samples} samples per cycle{', teeth separate' if lost > 0.0 else ''})"
        )

    def to_xarray(self) -> xarray.Dataset:
        """Return samples and figures of the cycles with units.

        Returns
        -------
        xarray.Dataset
            Dimensions ``time``, ``coordinate``, ``contact``, ``output_name`` and ``mesh_cycle``.
        """
        import xarray

        data: dict[str, Any] = {}
        units = {
            "position": ("coordinate", "m or rad"),
            "velocity": ("coordinate", "m/s or rad/s"),
            "acceleration": ("coordinate", "m/s^2 or rad/s^2"),
            "deflection": ("contact", "m"),
            "contact_force": ("contact", "N"),
            "output": ("output_name", self.output_unit),
        }
        for name, (kind, unit) in units.items():
            data[name] = (("time", kind), getattr(self, name), {"units": unit})
            found = getattr(self.cycles, name, None)
            for figure in ("mean", "rms", "minimum", "maximum") if found else ():
                values = (("mesh_cycle", kind), getattr(found, figure), {"units": unit})
                data[f"{name}_{figure}"] = values
        loss = (("mesh_cycle", "contact"), self.cycles.contact_loss_share, {"units": "1"})
        extra = (("mesh_cycle", "coordinate"), self.cycles.extra_force, {"units": "N or N*m"})
        coords: dict[str, Any] = {
            "time": ("time", self.time, {"units": "s"}),
            "phase": ("time", self.phase, {"units": "1"}),
            "mesh_frequency": ("time", self.mesh_frequency, {"units": "Hz"}),
            "speed": ("time", self.speed, {"units": "rad/s"}),
            "coordinate": list(self.names),
            "output_name": list(self.output_names),
            "cycle_time": ("mesh_cycle", self.cycles.time, {"units": "s"}),
            "cycle_mesh_frequency": ("mesh_cycle", self.cycles.mesh_frequency, {"units": "Hz"}),
        }
        facts = {"teeth": self.teeth, "samples": self.samples, "omega_max_dt": self.step_number}
        return xarray.Dataset(
            {**data, "contact_loss_share": loss, "extra_force": extra}, coords, facts
        )

    def plot(self) -> Any:
        """Draw overall level and orders over the speed.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        # The one step upward of the layers: a result draws itself.
        from tribodyn.plot import FIGURES

        return FIGURES["run_up"](self)

    def plot_map(self) -> Any:
        """Draw amplitudes over speed and frequency, with mesh orders and natural modes.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        from tribodyn.plot import FIGURES

        return FIGURES["run_up_map"](self)
