"""Torques and speeds of the shafts of a machine that vary over their turns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.faults.driven import drive_over_phases
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
    torques, rotation = driven_rotation(structure, system, [each for each, _ in excited])
    clock = structure.machine.clock
    driven = [
        (each, cycles, float(clock.turns[each.gear]) * clock.frequency, torques[each.gear])
        for each, cycles in excited
    ]
    return drive_over_phases(system, driven, rotation)


def driven_rotation(
    structure: MachineStructure, system: System, excited: Sequence[ShaftExcitation]
) -> tuple[dict[str, Array], Array]:
    """Forces per torque on each shaft, and the speed of the coordinates if shafts are driven."""
    torques, clock = shaft_torques(structure), structure.machine.clock
    speeds = [2.0 * np.pi * float(clock.turns[shaft]) * clock.frequency for shaft in torques]
    rotation = np.zeros(system.size)
    if excited:
        rotation = free_rotation(system, list(torques.values()), speeds)
    return torques, rotation
