"""Torques and speeds of the shafts of a machine that vary over their turns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.faults import DrivenSystem, drive
from tribodyn.faults.driven import drive_over_phases
from tribodyn.study.faults.machine_section import shaft_excitation
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.faults import ShaftExcitation
    from tribodyn.faults.driven import Lead
    from tribodyn.machine import MachineStructure

#: Eigenvalues below this share of the largest are those of free motions.
_FREE = 1e-12
#: Share up to which turns of shafts are those of one free motion.
_SAME = 1e-6
#: Mesh phases at which directions of contacts are read.
_PHASES = np.arange(8) / 8.0


def free_motions(system: System) -> Array:
    """Motions of the coordinates in which no spring and no contact is strained (n, k)."""
    from scipy.linalg import eigh

    stiffness = np.array(system.stiffness, dtype=float)
    size = float(np.abs(stiffness).max()) or 1.0
    for contact in system.contacts:
        along = contact.direction
        rows = np.atleast_2d(along(_PHASES) if callable(along) else np.asarray(along))
        stiffness += size * rows.T @ rows
    squares, shapes = eigh(stiffness, np.asarray(system.mass))
    return np.asarray(shapes[:, np.abs(squares) < _FREE * squares.max()])


def free_rotation(system: System, torques: Sequence[Array], turned: Sequence[float]) -> Array:
    """Free motion in which shafts with unit torques turn by these angles; zero without one."""
    free = free_motions(system)
    rows = np.asarray(torques) @ free
    shares = np.linalg.lstsq(rows, np.asarray(turned), rcond=_SAME)[0]
    fits = np.allclose(rows @ shares, turned, atol=_SAME * np.abs(turned).max())
    return np.asarray(free @ shares if fits else np.zeros(system.size))


def shaft_torques(structure: MachineStructure) -> dict[str, Array]:
    """Forces on the coordinates per torque on each shaft in its running sense (n,)."""
    machine = structure.machine
    loads, run, torques = machine.kinematics.shafts, machine.operation, {}
    for name, shaft in machine.shafts.items():
        place = shaft.length if name == run.output else 0.0
        torques[name] = np.asarray(np.sign(loads[name].speed) * structure.at(name, place)[3])
    return torques


def drive_machine_over_phases(
    structure: MachineStructure,
    system: System,
    excited: Sequence[tuple[ShaftExcitation, tuple[int, ...]]],
) -> tuple[System, Lead | None]:
    """A machine with excitations of its shafts, each with its cycles over the phases."""
    if not excited:
        return system, None
    torques, clock = shaft_torques(structure), structure.machine.clock
    speeds = {shaft: float(clock.turns[shaft]) * clock.frequency for shaft in torques}
    rotation = free_rotation(
        system, list(torques.values()), [2.0 * np.pi * speeds[shaft] for shaft in torques]
    )
    driven = [(each, cycles, speeds[each.gear], torques[each.gear]) for each, cycles in excited]
    return drive_over_phases(system, driven, rotation)


def drive_machine(
    structure: MachineStructure, system: System, faults: Mapping[str, Any]
) -> DrivenSystem:
    """A machine with the excitation of its shafts."""
    clock, torques = structure.machine.clock, shaft_torques(structure)
    cycles = max(clock.cycles.values())
    return _drive(
        system, cycles, faults, mesh_frequency=cycles * clock.frequency,
        turns=clock.turns, torques=torques,
    )  # fmt: skip


def _drive(
    system: System,
    cycles: int,
    faults: Mapping[str, Any],
    *,
    mesh_frequency: float,
    turns: Mapping[str, Fraction],
    torques: Mapping[str, Array],
) -> DrivenSystem:
    """Drive shafts, whose turns in the cycles are by name, by torques in their running sense."""
    excitations = [shaft_excitation(fault) for fault in faults.values() if fault.shaft]
    rotation = np.zeros(system.size)
    if excitations:
        turned = [2.0 * np.pi * float(turns[shaft]) / cycles for shaft in torques]
        rotation = free_rotation(system, list(torques.values()), turned)
    teeth = {shaft: Fraction(cycles) / turn for shaft, turn in turns.items() if turn}
    return drive(
        system, cycles, excitations, mesh_frequency=mesh_frequency, teeth=teeth,
        coordinates=torques, rotation=rotation,
    )  # fmt: skip
