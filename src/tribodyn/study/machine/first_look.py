"""What follows from a machine before anything is computed: speeds, torques, power, frequencies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribodyn.study.pipeline.run import rehearse

if TYPE_CHECKING:
    from tribodyn.study.machine.case import MachineCase


def rehearse_machine(case: MachineCase) -> None:
    """Raise the input errors of the tooth contacts of a machine without computing it."""
    for name in case.meshes_with_teeth:
        rehearse(case.pair(name, case.operating_point))


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
    for name, shaft in flow.shafts.items():
        values[f"shafts.{name}.speed"] = shaft.speed
        values[f"shafts.{name}.torque"] = shaft.torque
        values[f"shafts.{name}.power"] = shaft.power
    return {key: float(value) for key, value in values.items()}
