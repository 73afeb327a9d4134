"""Power of a machine: what enters is what leaves and what friction takes, mesh by mesh."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tribodyn.dynamics import steady_state
from tribodyn.machine import Bearing, Gear, Machine, Mesh, Operation, Shaft, system

FRICTION, REACH = 0.08, 4e-3


def reducer(driven: bool) -> Machine:
    """Two stages on rigid shafts, the second one internal; one pair of teeth slides in a mesh."""
    names = ("input", "middle", "output")
    gears = {
        "z1": Gear("input", None, 21, 0.02, 1.0, 1e-3),
        "z2": Gear("middle", None, 42, 0.02, 2.0, 5e-3),
        "z3": Gear("middle", None, 21, 0.02, 1.0, 1e-3),
        "z4": Gear("output", None, -63, 0.02, 4.0, 2e-2),
    }
    machine = Machine(
        shafts={name: Shaft() for name in names},
        gears=gears,
        meshes={
            "outer": Mesh(("z1", "z2"), 3e-3, angle=0.4, stiffness=3e8, damping=2e3),
            "inner": Mesh(("z4", "z3"), 3e-3, angle=2.0, stiffness=4e8, damping=2e3, offset=0.3),
        },
        bearings={
            name: Bearing(name, 0.0, radial_stiffness=3e8, radial_damping=2e3) for name in names
        },
        operation=Operation("input", "output", -90.0, -70.0 if driven else 70.0),
    )
    meshes = {
        name: replace(mesh, friction=_sliding(machine, name), events=(0.0, 0.5))
        for name, mesh in machine.meshes.items()
    }
    return replace(machine, meshes=meshes)


def _sliding(machine: Machine, name: str) -> Any:
    """Friction of one pair that passes the pitch point in the middle of the mesh cycle."""
    line = machine.directions[name]
    radii = [radius * np.sin(line.working_pressure_angle) for radius in line.working_radius]
    speeds = [
        abs(machine.kinematics.shafts[machine.gears[gear].shaft].speed)
        for gear in machine.meshes[name].gears
    ]
    rings = np.sign(line.working_radius)

    def path(phase: Any) -> Any:
        return REACH * (2.0 * np.asarray(phase) - 1.0)

    def levers(phase: Any) -> tuple[Any, Any]:
        # radii of curvature of both flanks without signs: they add up to the line of action of
        # an external pair, and differ by it in an internal one
        return rings[0] * (radii[0] + path(phase)), rings[1] * (radii[1] - path(phase))

    def pull(phase: Any) -> Any:
        first, second = levers(np.asarray(phase))
        sliding = speeds[0] * first - speeds[1] * second
        return FRICTION * np.sign(np.where(sliding == 0.0, first - second, sliding))

    return SimpleNamespace(
        friction_sum=pull,
        friction_moment_pinion=lambda x: pull(x) * levers(x)[0],
        friction_moment_wheel=lambda x: pull(x) * levers(x)[1],
        speeds=speeds,
    )


@pytest.mark.parametrize("driven", [False, True])
def test_what_enters_leaves_or_is_lost_in_sliding(driven: bool) -> None:
    machine = reducer(driven)
    response = steady_state(system(machine), machine.clock.frequency)
    loss = 0.0
    for column, (name, mesh) in enumerate(machine.meshes.items()):
        phase = (machine.clock.cycles[name] * response.fine.phase + mesh.offset) % 1.0
        force = response.fine.contact_force[:, column]
        speeds = mesh.friction.speeds
        sliding = speeds[0] * mesh.friction.friction_moment_pinion(phase)
        sliding = sliding - speeds[1] * mesh.friction.friction_moment_wheel(phase)
        loss += float(response.fine.mean(force * sliding))
    columns = [response.names.index(f"{name}_theta_x") for name in machine.shafts]
    speeds = np.array([shaft.speed for shaft in machine.kinematics.shafts.values()])
    torques = np.asarray(system(machine).force)[columns] + response.extra_force[columns]
    assert loss > 20.0
    assert torques @ speeds == pytest.approx(loss, rel=1e-9)
