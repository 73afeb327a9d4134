"""Bearings with radial clearance: law, statics, periodic motion, machine, messages."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tribodyn.dynamics import Contact, RadialClearance, System, clearance_motion, harmonic_balance
from tribodyn.errors import InputError
from tribodyn.machine import (
    Bearing,
    Gear,
    Machine,
    MachineStructure,
    Mesh,
    Operation,
    Shaft,
    machine_structure,
    static_balance,
    system,
)
from tribodyn.study.machine.motion import machine_motion
from tribodyn.study.machine.result import steady_motion

STIFFNESS, GAP = 1e8, 20e-6
PLANE = np.eye(2)


def test_force_and_tangent_of_a_clearance() -> None:
    pin = RadialClearance(PLANE, STIFFNESS, GAP)
    at = np.array([[18e-6, 24e-6], [3e-6, -4e-6]])  # 10 um beyond the clearance, and inside
    np.testing.assert_allclose(pin.force(at[0]), [600.0, 800.0], rtol=1e-5)
    assert np.abs(pin.force(at[1])).max() < 1e-3
    for displacement in at:
        step = 1e-11
        slopes = [
            (pin.force(displacement + e) - pin.force(displacement - e)) / (2.0 * step)
            for e in step * PLANE
        ]
        np.testing.assert_allclose(pin.tangent(displacement), np.transpose(slopes), atol=2.0)
    # Beyond the clearance the support is soft across its load: F/|d|.
    across = pin.tangent(np.array([30e-6, 0.0]))[1, 1]
    assert across == pytest.approx(1e3 / 30e-6, rel=1e-5)
    free = RadialClearance(PLANE, STIFFNESS, 0.0)
    np.testing.assert_array_equal(free.tangent(at), np.broadcast_to(STIFFNESS * PLANE, (2, 2, 2)))


def body(error: float, load: float = 1e3) -> System:
    """A mass between a mesh along x and a load along y."""
    mesh = Contact([1.0, 0.0], 5e7, error=lambda phase: error * np.cos(2 * np.pi * phase))
    return System(np.eye(2), 1e3 * np.eye(2), np.zeros((2, 2)), [0.0, load], [mesh])


def test_without_clearance_the_motion_is_linear() -> None:
    linear = replace(body(2e-6), stiffness=STIFFNESS * PLANE)
    expected = harmonic_balance(linear, 500.0, steps=64).position
    pin = RadialClearance(PLANE, STIFFNESS, 0.0)
    motion = clearance_motion(body(2e-6), [pin], 500.0, steps=64)
    np.testing.assert_allclose(motion.position, expected, rtol=0, atol=1e-12 * expected.max())


def test_a_slow_motion_is_the_displacement_of_statics() -> None:
    pin = RadialClearance(PLANE, STIFFNESS, GAP, offset=[0.0, 5e-6])
    motion = clearance_motion(body(1e-9), [pin], 1e-3, steps=64)
    expected = 5e-6 + GAP + 1e3 / STIFFNESS
    np.testing.assert_allclose(motion.position[:, 1], expected, rtol=1e-5)


@pytest.mark.parametrize(("frequency", "load"), [(1500.0, 1e3), (900.0, 30.0)])
def test_periodic_motion_solves_the_equations(frequency: float, load: float) -> None:
    """By time integration over a period; under the small load the body loses contact."""
    pin = RadialClearance(PLANE, STIFFNESS, GAP)
    stage = body(8e-6, load)
    motion = clearance_motion(stage, [pin], frequency)

    def rates(time: float, state: Any) -> Any:
        mesh = 5e7 * (state[0] - 8e-6 * math.cos(math.tau * frequency * time))
        force = np.array([-mesh, load]) - 1e3 * state[2:] - pin.force(state[:2])
        return np.concatenate([state[2:], force])

    start = np.concatenate([motion.position[0], motion.velocity[0]])
    end = solve_ivp(rates, (0.0, 1.0 / frequency), start, rtol=1e-9, atol=1e-15).y[:2, -1]
    np.testing.assert_allclose(end, start[:2], atol=1e-5 * np.ptp(motion.position, axis=0).max())
    sizes = np.hypot(*motion.position.T)
    assert (sizes.min() < GAP) == (load < 100.0)


def shafts(clearance: float, load: float = 60.0) -> Machine:
    """Two rigid shafts with a spur mesh; one bearing with clearance."""
    return Machine(
        shafts={"in": Shaft(), "out": Shaft()},
        gears={"z1": Gear("in", 0.0, 20, 0.02), "z2": Gear("out", 0.0, 40, 0.02)},
        meshes={
            "first": Mesh(("z1", "z2"), 3e-3, stiffness=lambda x: 3e8 + 3e7 * np.cos(math.tau * x))
        },
        bearings={
            "A": Bearing("in", 0.0, 1e8, clearance=clearance),
            "B": Bearing("out", 0.0, 2e8),
        },
        operation=Operation("in", "out", 100.0, load),
    )


def test_static_balance_with_clearance() -> None:
    machine = shafts(GAP)
    balance = static_balance(machine)
    bearing = balance.bearings["A"]
    force = np.linalg.norm(bearing.load[1:3])
    assert force == pytest.approx(60.0 / (0.03 * math.cos(math.radians(20.0))), rel=1e-9)
    moved = np.linalg.norm(bearing.displacement[1:3])
    assert moved == pytest.approx(GAP + force / 1e8, rel=1e-5)
    with pytest.raises(InputError, match="bearing with clearance depends on its load"):
        MachineStructure(machine, 0.0)


def test_machine_in_motion_with_and_without_clearance() -> None:
    bearings, sizes = {}, {}
    for clearance in (0.0, 1e-12, GAP):
        structure = machine_structure(shafts(clearance), damping_ratio=0.05)
        response = steady_motion(structure, system(structure))
        motion = machine_motion(structure, response)
        bearings[clearance] = motion.bearing_force[:, motion.bearing.index("A"), 1:3]
        rows = structure.bearing("A")[1:3]
        sizes[clearance] = np.hypot(*response.fine.mean(response.fine.position @ rows.T))
        # Force of the bearing and of the mesh: both accelerate the mass of the gear.
        mass = structure.mass[0, 0]
        acceleration = response.fine.acceleration @ rows.T
        normal = structure.machine.directions["first"].direction[1:3]
        mesh = motion.mesh_force[:, :1] * normal
        damping = response.fine.velocity @ structure.damping @ rows.T
        balance = mass * acceleration + damping + bearings[clearance] + mesh
        assert np.abs(balance).max() < 1e-4 * np.abs(bearings[clearance]).max()
    scale = np.abs(bearings[0.0]).max()
    np.testing.assert_allclose(bearings[1e-12], bearings[0.0], atol=1e-6 * scale)
    # One mesh pushes along one line: the shaft is displaced, and the forces are those without.
    np.testing.assert_allclose(bearings[GAP], bearings[0.0], atol=1e-5 * scale)
    assert sizes[GAP] - sizes[0.0] == pytest.approx(GAP, rel=1e-4)


def test_wrong_clearances_are_refused() -> None:
    for values, message in (
        ({"radial_stiffness": (1e8, 2e8)}, "radial stiffness is 1e[+]08 and 2e[+]08"),
        ({"stiffness": np.eye(6)}, "holds all directions"),
        ({"torsional_stiffness": 1e6, "radial_stiffness": 1e8}, "torsional_stiffness"),
        ({"radial_stiffness": 0.0}, "Give one radial_stiffness above 0"),
    ):
        with pytest.raises(InputError, match=message):
            Bearing("in", 0.0, clearance=GAP, **values)
    with pytest.raises(InputError, match="The system has 2"):
        clearance_motion(body(1e-6), [RadialClearance(np.zeros((2, 3)), 1e8, GAP)], 100.0)
