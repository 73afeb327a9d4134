"""The motion of a run-up or run-down: samples over the mesh phase, figures of every mesh cycle."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import draw
from tribodyn.dynamics.running_up.run_up_profile import SpeedProfile
from tribodyn.dynamics.time.ensemble import LaneStatistics
from tribodyn.errors import InputError
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, Index, Mask

if TYPE_CHECKING:
    from tribodyn.dynamics.linear.natural_modes import NaturalModes


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
    #: Contacts of which the teeth are apart where they are open: the last to open of each mesh.
    last_to_open: Mask = field(repr=False)

    def __repr__(self) -> str:
        """One line."""
        return f"CycleStatistics({self.time.size} mesh cycles)"


@record
class RunUp(Record):
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
        Mesh cycles per revolution of the shaft whose speed is reported.
    cycles : CycleStatistics
        Figures of every mesh cycle.
    profile : SpeedProfile
        The prescribed speed.
    step_number : float
        Largest ``omega_max * dt`` [-].
    modes : NaturalModes, optional
        Natural modes of the system in the middle of the speed range; None without any.
    """

    time: Array = quantity("time", unit="s", axis=True)
    phase: Array = quantity("time", unit="1", axis=True)
    mesh_frequency: Array = quantity("time", unit="Hz", axis=True)
    position: Array = quantity("time", "coordinate", unit="m or rad")
    velocity: Array = quantity("time", "coordinate", unit="m/s or rad/s")
    acceleration: Array = quantity("time", "coordinate", unit="m/s^2 or rad/s^2")
    deflection: Array = quantity("time", "contact", unit="m")
    contact_force: Array = quantity("time", "contact", unit="N")
    output: Array = quantity("time", "output_name", unit="@output_unit")
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    output_names: tuple[str, ...] = quantity("output_name", axis=True, name="output_name")
    output_unit: str
    samples: int = fact()
    teeth: int = fact()
    cycles: CycleStatistics
    profile: SpeedProfile
    step_number: float = fact(name="omega_max_dt")
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
        """Return one signal by its name.

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
            unit = "rad/s^2" if "theta" in name else "m/s^2"
            return self.acceleration[:, self.names.index(name)], unit
        if name in self.output_names:
            return self.output[:, self.output_names.index(name)], self.output_unit
        signals = ("deflection", "contact_force", *self.names, *self.output_names)
        why = f"The signals are {', '.join(signals)}"
        raise InputError(f'no signal "{name}"', "argument signal", why, "Choose one of these")

    def __repr__(self) -> str:
        """One line."""
        beat = np.asarray(self.profile.mesh_frequency)
        loss = self.cycles.contact_loss_share[:, self.cycles.last_to_open]
        lost = float(np.max(loss, initial=0.0))
        top, count = self.profile.highest, len(self.names)
        back = f" and back to {beat[-1]:.6g}" if beat[-1] < top else ""
        return (
            f"RunUp({self.profile.duration:.6g} s, {self.cycles.time.size} mesh cycles, mesh "
            f"frequency {beat[0]:.6g} to {top:.6g}{back} Hz, "
            f"{count} coordinate{'s' if count > 1 else ''}, "
            f"{self.samples} samples per cycle{', teeth separate' if lost > 0.0 else ''})"
        )

    def plot_map(self) -> Any:
        """Draw amplitudes over speed and frequency, with mesh orders and natural modes.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, "run_up_map")

    def _units(self, unit: str | None) -> dict[str, str]:
        return {"units": self.output_unit} if unit == "@output_unit" else super()._units(unit)

    def _parts(self) -> Parts:
        variables, coordinates, _ = parts = super()._parts()
        cycles, cycle = self.cycles, "mesh_cycle"
        for name in ("acceleration", "deflection", "contact_force", "output"):
            (_, kind), _, units = variables[name]
            for figure in ("mean", "rms", "minimum", "maximum"):
                values = getattr(getattr(cycles, name), figure)
                variables[f"{name}_{figure}"] = ((cycle, kind), values, units)
        loss, force = cycles.contact_loss_share, cycles.extra_force
        variables["contact_loss_share"] = ((cycle, "contact"), loss, {"units": "1"})
        variables["extra_force"] = ((cycle, "coordinate"), force, {"units": "N or N*m"})
        coordinates["speed"] = ("time", self.speed, {"units": "rad/s"})
        coordinates["cycle_time"] = (cycle, cycles.time, {"units": "s"})
        coordinates["cycle_mesh_frequency"] = (cycle, cycles.mesh_frequency, {"units": "Hz"})
        return parts
