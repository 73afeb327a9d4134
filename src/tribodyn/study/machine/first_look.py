"""What follows from a machine before anything is computed: speeds, torques, power, frequencies."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING

from tribodyn.errors import ComputationError, Problem, warn
from tribodyn.machine import machine_structure
from tribodyn.study.machine.summary import helix_figures
from tribodyn.study.planetary.machine_stages import motion_of_stage

if TYPE_CHECKING:
    from tribodyn.machine import Machine
    from tribodyn.study.machine.case import MachineCase

#: Mesh cycles of a period above which a warning says what they cost, steps per cycle, and bytes of
#: a step for each coordinate: three samples of position, velocity and acceleration.
_LONG_PERIOD, _STEPS, _BYTES = 400, 128, 72
#: Coordinates that a large structure has at least after its reduction.
_FEWEST = 60


def warn_of_period(machine: Machine) -> None:
    """Warn of a period with so many mesh cycles that it takes much time and memory."""
    clock = machine.clock
    fastest = max(clock.cycles, key=lambda name: clock.cycles[name])
    cycles = clock.cycles[fastest]
    if cycles <= _LONG_PERIOD:
        return
    pairs = (
        f"{name} {' : '.join(str(abs(machine.gears[gear].teeth)) for gear in mesh.gears)}"
        for name, mesh in machine.meshes.items()
    )
    turning = any(mesh.period > 1 for mesh in machine.meshes.values())
    reason, remedy = (
        "the teeth have few common factors",
        (
            "In Python, harmonic_balance(system(structure, phases=True), machine.phases.frequency) "
            "finds the motion without a common period"
        ),
    )
    if turning:
        reason = "unequal teeth repeat with whole turns of their gears"
        remedy = "Faults of one gear only, or a case of its stage alone, shorten the period"
    warn_of_steps(
        cycles,
        f"the meshes repeat together only after {cycles} cycles of mesh {fastest} "
        f"({1.0 / clock.frequency:.4g} s), because {reason} ({', '.join(pairs)})",
        remedy,
        machine_structure(machine).size,
    )


def warn_of_orders(cycles: int, seconds: float) -> None:
    """Warn of orders of torques and speeds that repeat with the meshes after many cycles."""
    if cycles > _LONG_PERIOD:
        warn_of_steps(
            cycles,
            f"meshes, torques and speeds repeat together only after {cycles} mesh cycles "
            f"({seconds:.4g} s), because shafts with varying torques or speeds make whole turns",
            "Excitations of one shaft only, or orders that repeat after a part of a turn, shorten "
            "the period",
        )


def warn_of_steps(cycles: int, period: str, remedy: str, coordinates: int = 100) -> None:
    """Warn of what a long period costs; refuse what this computer has no memory for."""
    steps, least = _STEPS * cycles, min(coordinates, _FEWEST)
    gigabytes = 1e-9 * _BYTES * steps
    cost = f"{steps} steps and about {gigabytes * coordinates:.2g} GB for {coordinates} coordinates"
    if gigabytes * least > _memory():
        what = f"the motion takes {steps} steps and at least {gigabytes * least:.2g} GB"
        where = f"This computer has {_memory():.3g} GB, and {period}"
        raise ComputationError(Problem(what, "meshes", where, remedy))
    warn("long-period", f"{period}. Each motion takes {cost}. {remedy}")


def _memory() -> float:
    """Memory of this computer [GB]; endless where the system does not tell."""
    try:
        return 1e-9 * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return math.inf


def kinematic_figures(case: MachineCase) -> dict[str, float]:
    """Speeds, torques and power of shafts and meshes, in SI by dotted key."""
    machine = case.machine()
    flow, run = machine.kinematics, machine.operation
    values = {
        "machine.clock_frequency": machine.clock.frequency,
        "machine.input_power": abs(run.speed * run.torque),
        "machine.output_torque": abs(flow.shafts[run.output].torque),
    }
    for name, mesh in flow.meshes.items():
        values[f"meshes.{name}.mesh_frequency"] = mesh.mesh_frequency
        values[f"meshes.{name}.static_mesh_force"] = mesh.force
        for key, value in helix_figures(machine, name, mesh.force).items():
            values[f"meshes.{name}.{key}"] = value
    for name, shaft in flow.shafts.items():
        values[f"shafts.{name}.speed"] = shaft.speed
        values[f"shafts.{name}.torque"] = shaft.torque
        values[f"shafts.{name}.power"] = shaft.power
    for name, stage in machine.planets.items():
        for key, value in motion_of_stage(machine, name, stage, flow).items():
            values[f"planets.{name}.{key}"] = value
    return {key: float(value) for key, value in values.items()}
