"""What follows from a machine before anything is computed: speeds, torques, power, frequencies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribodyn.errors import warn
from tribodyn.study.machine.summary import helix_figures

if TYPE_CHECKING:
    from tribodyn.machine import Machine
    from tribodyn.study.machine.case import MachineCase

#: Mesh cycles of a period above which a warning says what they cost, steps per cycle, and bytes of
#: a step for each coordinate: three samples of position, velocity and acceleration.
_LONG_PERIOD, _STEPS, _BYTES = 400, 128, 72


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
            "Numbers of teeth on one shaft with a common factor shorten the period, such as 57 and "
            "21 in place of 57 and 22"
        ),
    )
    if turning:
        reason = "unequal teeth repeat with whole turns of their gears"
        remedy = "Faults of one gear only shorten the period"
    warn_of_steps(
        cycles,
        f"the meshes repeat together only after {cycles} cycles of mesh {fastest} "
        f"({1.0 / clock.frequency:.4g} s), because {reason} ({', '.join(pairs)})",
        remedy,
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


def warn_of_steps(cycles: int, period: str, remedy: str) -> None:
    """Warn of what a long period costs."""
    gigabytes = 1e-9 * _BYTES * _STEPS * cycles * 100
    cost = f"{_STEPS * cycles} steps and about {gigabytes:.2g} GB for 100 coordinates"
    warn("long-period", f"{period}. Each motion takes {cost}. {remedy}")


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
    return {key: float(value) for key, value in values.items()}
