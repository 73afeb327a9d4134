"""Compute a planetary stage: teeth of a sun and a ring mesh, load sharing, motion."""

from __future__ import annotations

import sys
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tribodyn.dynamics import harmonic_balance
from tribodyn.errors import collected, frames
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine.planetary.pins import motion_in_clearance
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.load_cases import LoadCase
from tribodyn.study.machine.run import MeshWarning, run_machine, warn_of_meshes
from tribodyn.study.planetary.case import PlanetaryCase
from tribodyn.study.planetary.motion import planetary_motion
from tribodyn.study.planetary.result import STEPS, PlanetaryLoadResult, PlanetaryResult
from tribodyn.study.planetary.stage import (
    stage_data,
    stage_shares,
    stage_system,
    stage_teeth,
)
from tribodyn.study.planetary.summary import mesh_losses

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.study.machine.result import MachineResult
    from tribodyn.study.machine.user_tables import PartsCase


def run_parts(
    case: PartsCase, progress: Progress = SILENT, *, stacklevel: int = 2
) -> MachineResult | PlanetaryResult:
    """Compute a machine or a planetary stage."""
    if isinstance(case, PlanetaryCase):
        return run_planetary(case, progress, stacklevel=stacklevel + 1)
    assert isinstance(case, MachineCase)
    return run_machine(case, progress, stacklevel=stacklevel + 1)


def run_planetary(
    case: PlanetaryCase, progress: Progress = SILENT, *, stacklevel: int = 2
) -> PlanetaryResult:
    """Compute a planetary stage at its operating point and under its load cases."""
    with collected() as caught, single_blas_thread():
        of_meshes: list[MeshWarning] = []
        loads = (case.operating_point, *case.load_cases)
        results: dict[tuple[float, float], PlanetaryLoadResult] = {}
        for load in loads:
            point = load.speed, load.torque
            if point not in results:
                results[point] = run_load(case, load, progress, of_meshes)
        warn_of_meshes(of_meshes)
        listed = [replace(results[load.speed, load.torque], load=load) for load in loads]
    unique = {str(warning): warning for warning in caught}
    for warning in unique.values():
        warnings.warn(warning, stacklevel=frames(stacklevel, sys._getframe()))
    return PlanetaryResult(case, listed[0], tuple(listed[1:]), tuple(unique.values()))


def run_load(
    case: PlanetaryCase,
    load: LoadCase,
    progress: Progress,
    of_meshes: list[MeshWarning],
    start: Response | None = None,
) -> PlanetaryLoadResult:
    """Compute a planetary stage under one load, its motion from that of a similar one if any."""
    teeth = stage_teeth(case, load, progress)
    of_meshes += teeth.warnings
    progress.finish()
    progress.start(f"Motion: {load.name}")
    lossless = case.kinematics(load)
    losses = mesh_losses(case, load, teeth.tables)
    efficiencies = {f"{mesh}_efficiency": 1.0 - lost for mesh, lost in losses.items()}
    data = stage_data(case, load, teeth.tables, case.phases(load))
    system = stage_system(case, load, teeth, data)
    if start is not None and start.names != tuple(system.names):
        start = None
    search: dict[str, Any] = {"steps": STEPS, "start": start}
    if data["pin_clearance"]:
        response = motion_in_clearance(system, data, lossless.mesh_frequency, **search)
    else:
        response = harmonic_balance(system, lossless.mesh_frequency, **search)
    progress.finish()
    return PlanetaryLoadResult(
        load=load,
        kinematics=case.kinematics(load, **efficiencies),
        tables=teeth.tables,
        data=data,
        shares=stage_shares(data),
        system=system,
        motion=planetary_motion(response, data, case.turn(load)),
        response=response,
        case=case,
    )


def rehearse_planetary(case: PlanetaryCase) -> None:
    """Raise the input errors of a stage without computing its films and motion."""
    with collected(), single_blas_thread():
        for load in (case.operating_point, *case.load_cases):
            teeth = stage_teeth(case, load, rehearsal=True)
            stage_system(case, load, teeth, stage_data(case, load, teeth.tables, case.phases(load)))
