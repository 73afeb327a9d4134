"""Torques and speeds of the shafts of a machine or a stage that vary over their turns."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.faults import DrivenSystem, drive
from tribodyn.study.faults.machine_section import OF_SHAFTS, shaft_excitation
from tribodyn.study.pipeline.assembly import geometry
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.machine import MachineStructure
    from tribodyn.study.planetary.case import PlanetaryCase
    from tribodyn.study.planetary.result import PlanetaryLoadResult

#: Eigenvalues below this share of the largest are those of free motions.
_FREE = 1e-12


def free_rotation(system: System) -> Array:
    """Motion of the coordinates in which nothing is strained (n,); zero where there is none."""
    from scipy.linalg import eigh

    from tribodyn.dynamics.linear.natural_modes import linear_system

    linear = linear_system(system)
    squares, shapes = eigh(linear.stiffness, linear.mass)
    free = shapes[:, np.abs(squares) < _FREE * squares.max()]
    return np.asarray(free[:, 0] if free.shape[1] == 1 else np.zeros(system.size))


def drive_machine(
    structure: MachineStructure, system: System, faults: Mapping[str, Any]
) -> DrivenSystem:
    """A machine with the excitation of its shafts."""
    machine = structure.machine
    clock, loads, run = machine.clock, machine.kinematics.shafts, machine.operation
    torques = {}
    for name, shaft in machine.shafts.items():
        place = shaft.length if name == run.output else 0.0
        torques[name] = np.sign(loads[name].speed) * structure.at(name, place)[3]
    cycles = max(clock.cycles.values())
    return _drive(
        system, cycles, faults, mesh_frequency=cycles * clock.frequency,
        turns=clock.turns, torques=torques, reference=run.input,
    )  # fmt: skip


def drive_stage(
    case: PlanetaryCase, sound: PlanetaryLoadResult, system: System, cycles: int
) -> DrivenSystem:
    """A planetary stage with the excitation of its members."""
    table, stage, fixed_role = case.table, sound.kinematics, case.roles[2]
    teeth = {role: abs(case.gears[getattr(table, role)].teeth) for role in ("sun", "ring")}
    planet = geometry(case.pairs["ring"])["base_radius_pinion"] / case.gears[table.planet].teeth
    radii = {role: planet * count for role, count in teeth.items()}
    radii["carrier"] = case.center_distance
    turns = {"sun": Fraction(cycles, teeth["sun"]), "ring": Fraction(-cycles, teeth["ring"])}
    turns["carrier"] = Fraction(0)  # about the carrier
    torques = {}
    for number, role in enumerate(("carrier", "ring", "sun")):
        unit = np.eye(system.size)[3 * number + 2] / radii[role]
        torques[case.members[role]] = sound.turn * np.sign(stage.speeds[role]) * unit
    return _drive(
        system, cycles, case.faults, mesh_frequency=stage.mesh_frequency,
        turns={case.members[role]: abs(turn - turns[fixed_role]) for role, turn in turns.items()},
        torques=torques, reference=case.ends[0],
    )  # fmt: skip


def _drive(
    system: System,
    cycles: int,
    faults: Mapping[str, Any],
    *,
    mesh_frequency: float,
    turns: Mapping[str, Fraction],
    torques: Mapping[str, Array],
    reference: str,
) -> DrivenSystem:
    """Drive shafts, whose turns in the cycles are by name, by torques in their running sense."""
    excitations = [shaft_excitation(fault) for fault in faults.values() if fault.kind in OF_SHAFTS]
    rotation = free_rotation(system) if excitations else np.zeros(system.size)
    if turned := float(rotation @ torques[reference]):
        rotation = rotation * (2.0 * np.pi * float(turns[reference]) / cycles / turned)
    teeth = {shaft: Fraction(cycles) / turn for shaft, turn in turns.items() if turn}
    return drive(
        system, cycles, excitations, mesh_frequency=mesh_frequency, teeth=teeth,
        coordinates=torques, rotation=rotation,
    )  # fmt: skip
