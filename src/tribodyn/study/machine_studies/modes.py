"""Natural modes of a machine or a planetary stage about its static load."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from tribodyn.machine import MachineModes, PlanetaryModes, machine_modes
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.modes import MachineCampbell, campbell_of, structure_at_rest
from tribodyn.study.machine_studies.levels import MeshOrder, mesh_orders
from tribodyn.study.planetary.case import PlanetaryCase
from tribodyn.study.planetary.stage_modes import stage_modes

if TYPE_CHECKING:
    from tribodyn.study.machine.user_tables import PartsCase
    from tribodyn.types import Array


class ModesOfParts(NamedTuple):
    """Natural modes, and what the harmonics of the meshes strain of each of them."""

    modes: MachineModes | PlanetaryModes
    orders: tuple[MeshOrder, ...]


def modes_at_rest(case: PartsCase, progress: Progress = SILENT) -> ModesOfParts:
    """Natural modes of a machine or a stage with the teeth at its operating point."""
    if isinstance(case, PlanetaryCase):
        stage = stage_modes(case, progress)
        return ModesOfParts(stage.modes, stage.orders)
    assert isinstance(case, MachineCase)
    modes = machine_modes(structure_at_rest(case, progress))
    return ModesOfParts(modes, mesh_orders(modes))


def parts_campbell(
    case: PartsCase, speeds: Array | None = None, progress: Progress = SILENT
) -> MachineCampbell:
    """Campbell diagram of a machine or a stage over the speed of its input [rad/s]."""
    if isinstance(case, PlanetaryCase):
        return stage_modes(case, progress).campbell(speeds)
    assert isinstance(case, MachineCase)
    return campbell_of(structure_at_rest(case, progress), speeds)
