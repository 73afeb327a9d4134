"""Motion of an assembled machine by both engines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from machines import two_stage_parts

from tribodyn.dynamics import harmonic_balance, simulate
from tribodyn.machine import Machine
from tribodyn.machine.assembly import system


def test_both_engines_give_the_motion_of_two_stages() -> None:
    def wave(size: float) -> object:
        return lambda x: size * np.cos(2.0 * np.pi * x)

    parts = two_stage_parts()
    entries = {"error": wave(3e-6), "damping": 2000.0, "gap": 20e-6}
    for name, mesh in parts["meshes"].items():
        rigid = lambda x: 4e8 * (1.0 + 0.1 * np.cos(2.0 * np.pi * x))  # noqa: E731
        parts["meshes"][name] = replace(mesh, stiffness=rigid, **entries)
    machine = Machine(**parts)
    equations, clock = system(machine), machine.clock.frequency
    motion = harmonic_balance(equations, clock, steps=64)
    assert motion.converged
    flow = machine.kinematics.meshes
    begin, torque = (motion.position[0], motion.velocity[0]), motion.extra_force
    again = simulate(equations, clock, 1, begin, steps=64, extra_force=torque)
    assert again.engine == "modal"
    for part in (motion, again):
        load = part.fine.mean(part.fine.contact_force)
        # Mean forces of a statically determinate drive are those of its torques.
        assert load == pytest.approx([mesh.force for mesh in flow.values()], rel=1e-6)
    squares = [part.fine.mean(part.fine.contact_force**2) for part in (motion, again)]
    assert squares[1] == pytest.approx(squares[0], rel=1e-6)
