"""A drive that turns away leaves no trace in the figures of its motion."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.unit.study.test_machine_run import GEARED

import tribodyn as td
from tribodyn.dynamics import simulate, torsional
from tribodyn.machine import (
    Bearing,
    Gear,
    Machine,
    MachineStructure,
    Operation,
    PlanetaryStage,
    Shaft,
)
from tribodyn.study import read_case
from tribodyn.study.machine.motion import mesh_rotation

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
STAGE = """
title = "Stage 24/36/96 with a planet that carries nothing"
[gears]
s = { teeth = 24, face_width = "25 mm", roughness_ra = "0.3 um" }
p = { teeth = 36, face_width = "25 mm", roughness_ra = "0.3 um" }
r = { teeth = -96, face_width = "25 mm", roughness_ra = "0.3 um" }
[planets.low]
sun = "s"
ring = "r"
planet = "p"
carrier = "c"
count = 4
normal_module = "2 mm"
pin_errors = ["20 um", "0 um", "0 um", "0 um"]
sun_support = "1e9 N/m"
[lubricant]
name = "ISO VG 100"
temperature = "70 degC"
[film]
model = "moes"
[friction]
law = "constant"
coefficient = 0.05
[dynamics]
backlash = "0.1 mm"
[operation]
input = "s"
output = "c"
speed = "2000 rpm"
torque = "200 N*m"
"""


@pytest.mark.slow
def test_transmission_error_of_a_stage_with_an_unloaded_planet_is_micrometres() -> None:
    result = td.run(read_case(STAGE, "stage.toml"))
    figures = result.summary()
    assert figures["planets.low.planets_unloaded"] == 1.0
    for mesh in ("low_sun2", "low_ring2"):
        value = figures[f"meshes.{mesh}.transmission_error_peak_to_peak"]
        assert 1e-7 < value < 2e-5
    assert np.abs(result.operation.stage().motion.displacement).max() < 1e-4
    # The loaded planets turn on the line of action by as much as they approach and tilt.
    loaded = [result.motion.mesh.index(f"low_sun{i}") for i in (2, 3, 4)]
    assert np.ptp(result.motion.transmission_error[:, loaded], axis=0).max() < 2e-5


def rotating(machine: Machine) -> tuple[MachineStructure, Any]:
    """Structure of a machine, and the displacement by which it turns without any strain."""
    structure, flow = MachineStructure(machine), machine.kinematics
    speeds = {name: load.speed for name, load in flow.shafts.items()}
    motion = np.array([
        next(v for n, v in speeds.items() if name.startswith(n)) if "theta_x" in name else 0.0
        for name in structure.names
    ])  # fmt: skip
    return structure, motion


def stage() -> Machine:
    """A planetary stage with its ring held."""
    members = ("sun", "carrier", "ring")
    return Machine(
        shafts={name: Shaft(mass=1.0, moment_of_inertia=0.1) for name in members},
        gears={"s": Gear("sun", 0.0, 17, 0.02), "r": Gear("ring", 0.0, -61, 0.02)},
        meshes={},
        planets={"low": PlanetaryStage("s", "r", "carrier", Gear("p", 0.0, 22, 0.02), 3, 2e-3)},
        bearings={
            name: Bearing(name, 0.0, 1e9, torsional_stiffness=1e8 * (name == "ring"))
            for name in members
        },
        operation=Operation("sun", "carrier", 50.0, 200.0),
    )


@pytest.mark.parametrize(
    "machine", [read_case(GEARED).machine(), stage()], ids=["gears", "planets"]
)
def test_turning_drive_has_no_transmission_error(machine: Machine) -> None:
    structure, motion = rotating(machine)
    for mesh in machine.meshes:
        row = mesh_rotation(structure, mesh)
        assert abs(row @ motion) < 1e-9 * np.abs(row).max() * np.abs(motion).max()


def test_friction_turns_a_free_drive_as_by_runge_kutta() -> None:
    mesh: Any = SimpleNamespace(
        stiffness=lambda x: 3e8 + 4e7 * np.cos(2 * np.pi * x),
        friction_sum=lambda x: 0.03 * np.sin(2 * np.pi * x),
        friction_moment_pinion=lambda x: 3e-3 * np.cos(2 * np.pi * x),
        friction_moment_wheel=lambda x: 5e-3 * np.cos(2 * np.pi * x + 0.4),
        event_phases=(0.0,),
    )
    pair = torsional(
        mesh, moment_of_inertia=(407e-6, 1168e-6), base_radius=(0.0338, 0.0507),
        torque=(80.0, 120.0), mesh_damping=1500.0, backlash=0.0,
    )  # fmt: skip
    start = np.array([2.5e-4, 0.0]), np.array([1e-2, -1e-2])
    runs = [simulate(pair, 450.0, 6, start, steps=256, method=m) for m in ("rk4", "modal")]
    for name in ("position", "velocity"):
        plain, modal = (getattr(run, name) for run in runs)
        np.testing.assert_allclose(modal, plain, atol=1e-3 * np.ptp(plain))
