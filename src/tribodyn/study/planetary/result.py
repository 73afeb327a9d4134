"""Result of a planetary stage: its loads, summary, modes and report."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tribodyn.drawing import draw, write_report_of
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine import (
    LoadShares,
    PlanetaryKinematics,
    RingSensorSignal,
    planetary_modes,
    planetary_plane_model,
    ring_sensor_signal,
)
from tribodyn.study.pipeline.parts_result import PartsResult
from tribodyn.study.pipeline.save import new_directory
from tribodyn.study.planetary.stage_modes import StageModes
from tribodyn.study.planetary.stage_signals import signals_along
from tribodyn.study.planetary.summary import summary_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.errors import ModelWarning
    from tribodyn.machine import MeshPhases, PlanetaryModes
    from tribodyn.mesh import MeshTable
    from tribodyn.study.faults.planetary_motion import PlanetaryTurningMotion
    from tribodyn.study.machine.load_cases import LoadCase
    from tribodyn.study.machine.modes import MachineCampbell, MeshOrder
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.planetary.case import PlanetaryCase
    from tribodyn.study.planetary.motion import PlanetaryMotion


#: Steps of a mesh cycle, which is the period of the motion.
STEPS = 200


@dataclass(frozen=True, eq=False)
class PlanetaryLoadResult:
    """A planetary stage under one load.

    Parameters
    ----------
    load : LoadCase
        Speed and torque.
    kinematics : PlanetaryKinematics
        Speeds, torques and power with the computed losses of the meshes.
    tables : mapping of str to MeshTable
        Tooth contact of a ``sun`` mesh and of a ``ring`` mesh.
    data : mapping
        Arguments of :func:`tribodyn.machine.planetary_plane_model` with the mean stiffness of the
        meshes, in the direction of the torque on the sun.
    shares : LoadShares
        Static load sharing.
    system : System
        Equations of motion with the force laws of the teeth.
    motion : PlanetaryMotion
        Forces and displacements over a mesh cycle.
    response : Response
        Motion of all coordinates, in the direction of the torque on the sun.
    case : PlanetaryCase
        What was computed.
    """

    steps: ClassVar[int] = STEPS
    load: LoadCase
    kinematics: PlanetaryKinematics
    tables: Mapping[str, MeshTable]
    data: Mapping[str, Any]
    shares: LoadShares
    system: System
    motion: PlanetaryMotion
    response: Response
    case: PlanetaryCase

    @cached_property
    def figures(self) -> dict[str, float]:
        """All figures in SI by dotted key."""
        return summary_of(self.case, self)

    @property
    def clock_frequency(self) -> float:
        """Mesh cycles in a second [Hz]."""
        return self.kinematics.mesh_frequency

    @property
    def turn(self) -> int:
        """Sign of the torque on the sun."""
        return self.case.turn(self.load)

    @cached_property
    def stage_modes(self) -> StageModes:
        """Natural modes with the mean stiffness of the meshes, and what excites them."""
        modes = planetary_modes(planetary_plane_model(**self.data))
        return StageModes(self.load, self.kinematics, self.data, modes)

    @property
    def modes(self) -> PlanetaryModes:
        """Natural modes with the mean stiffness of the meshes."""
        return self.stage_modes.modes

    @property
    def mesh_orders(self) -> tuple[MeshOrder, ...]:
        """Mesh harmonics with what they excite of the modes by the phases of the meshes."""
        return self.stage_modes.orders()

    def signals_along(self, response: Response) -> MachineMotion:
        """Forces and errors of all meshes, and forces of pins and supports, along another motion.

        Parameters
        ----------
        response : Response
            Motion of the same coordinates.

        Returns
        -------
        MachineMotion
        """
        return signals_along(self, response)

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
            Angle of the sensor [rad]; the first planet begins at 0.
        window : float or function, optional
            As for :func:`tribodyn.machine.ring_sensor_signal`.
        steps : int
            Samples of a mesh cycle.

        Returns
        -------
        RingSensorSignal

        Raises
        ------
        InputError
            If an argument is out of range.
        """
        at, motion, stage = np.arange(steps) / steps, self.motion, self.kinematics
        columns = [np.interp(at, motion.phase, f, period=1.0) for f in motion.ring_mesh_force.T]
        turn = 1.0 if stage.torques["sun"] > 0.0 else -1.0
        relative = -stage.relative_speeds["ring"]
        return ring_sensor_signal(
            ring_mesh_force=np.stack(columns, axis=1),
            ring_teeth=round(2.0 * np.pi * stage.mesh_frequency / abs(relative)),
            angles=turn * self.phases.angles,
            sensor_angle=sensor_angle,
            window=window,
            carrier_frequency=abs(relative) / (2.0 * np.pi),
            backwards=relative < 0.0,
        )

    @property
    def phases(self) -> MeshPhases:
        """Phases of all meshes."""
        phases: MeshPhases = self.data["phases"]
        return phases


@dataclass(frozen=True, eq=False)
class PlanetaryResult(PartsResult):
    """What :func:`tribodyn.run` returns for a planetary stage.

    Parameters
    ----------
    case : PlanetaryCase
        What was computed.
    operation : PlanetaryLoadResult
        At the speed and torque of ``[operation]``.
    load_cases : tuple of PlanetaryLoadResult
        Under each of ``[[load_cases]]``.
    warnings : tuple of ModelWarning
        Warnings of the models.
    """

    case: PlanetaryCase
    operation: PlanetaryLoadResult
    load_cases: tuple[PlanetaryLoadResult, ...]
    warnings: tuple[ModelWarning, ...]

    @property
    def motion(self) -> PlanetaryMotion:
        """Motion at the operating point."""
        return self.operation.motion

    @cached_property
    def modes(self) -> PlanetaryModes:
        """Natural modes with the mean stiffness of the meshes at the operating point."""
        return self.operation.modes

    @cached_property
    def campbell(self) -> MachineCampbell:
        """Natural frequencies and excitations over the speed of the input."""
        return self.operation.stage_modes.campbell()

    @cached_property
    def turning_motion(self) -> PlanetaryTurningMotion:
        """Motion over whole turns of the gears with faults, with the passing of the planets."""
        from tribodyn.study.faults.planetary_motion import planetary_turning_motion

        return planetary_turning_motion(self.case, self.operation)

    def plot(self, figure: str = "planetary_stage") -> Any:
        """Draw a figure: ``planetary_stage``, ``planetary_forces``.

        Parameters
        ----------
        figure : str
            Name in :data:`tribodyn.plot.FIGURES`.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, figure)

    def save(
        self, directory: str | os.PathLike[str], *, force: bool = False, csv: bool = False
    ) -> Path:
        """Write case, summary, mesh tables, motion and report into a new directory.

        Parameters
        ----------
        directory : str or path
            Directory to make; it appears complete or not at all.
        force : bool
            Replace an earlier result there.
        csv : bool
            Write the mesh forces as ``response.csv`` as well.

        Raises
        ------
        OutputExistsError
            If it exists and is not to be replaced, or is no result.
        InputError
            If the place cannot be written to.
        """
        target = Path(directory)
        with single_blas_thread(), new_directory(target, force=force) as place:
            texts = {
                "case.toml": self.case.to_toml(),
                "summary.json": json.dumps(self.summary(), indent=2, allow_nan=False) + "\n",
            }
            for name, text in texts.items():
                (place / name).write_text(text, encoding="utf-8")
            for mesh, table in self.operation.tables.items():
                table.save(place / f"mesh-{mesh}.nc")
            self.motion.save(place / "motion.nc")
            if csv:
                frame = self.to_xarray().sun_mesh_force.to_pandas()
                (place / "response.csv").write_text(frame.to_csv(), encoding="utf-8")
            write_report_of(self, place / "report.html")
        return target

    def __repr__(self) -> str:
        """One line."""
        figures, name = self.summary(), self.case.name
        return (
            f'PlanetaryResult("{self.case.title}": efficiency '
            f"{100.0 * figures['machine.efficiency']:.4g} %, "
            f"K_gamma {figures[f'planets.{name}.load_factor']:.4g}, peak mesh forces "
            f"{figures['meshes.sun.peak_mesh_force']:.5g} N and "
            f"{figures['meshes.ring.peak_mesh_force']:.5g} N)"
        )
