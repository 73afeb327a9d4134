"""Motion of whole machines: balances of force and power, and the same motion by other ways."""

from dataclasses import replace

import numpy as np
import pytest

from tribodyn.dynamics import harmonic_balance, simulate
from tribodyn.machine import (
    Bearing,
    Gear,
    Machine,
    MachineStructure,
    Mesh,
    Operation,
    Section,
    Shaft,
    reduce_structure,
    static_balance,
    system,
)

DEGREE = np.pi / 180.0


def two_stages(first=4e-6, second=6e-6, **mesh):
    """A two-stage helical reducer, whose meshes have 2 and 1 cycles in a period of the clock."""
    shaft = Shaft([Section(0.3, 0.05)])
    names = ("input", "middle", "output")
    supports = {
        f"{name}{end}": Bearing(name, position, 4e8, axial, radial_damping=3e3, axial_damping=3e3)
        for name in names
        for end, position, axial in ((" left", 0.02, 2e8), (" right", 0.28, 0.0))
    }
    return Machine(
        shafts=dict.fromkeys(names, shaft),
        gears={
            "z1": Gear("input", 0.1, 27, 0.05), "z2": Gear("middle", 0.1, 46, 0.05),
            "z3": Gear("middle", 0.2, 23, 0.074), "z4": Gear("output", 0.2, 34, 0.074),
        },
        meshes={
            "first": Mesh(("z1", "z2"), 4.5e-3, 21 * DEGREE, "right", None, 30 * DEGREE,
                          stiffness=4e8, damping_ratio=0.06,
                          error=lambda x: first * np.cos(2 * np.pi * x), **mesh),
            "second": Mesh(("z3", "z4"), 6.5e-3, 10 * DEGREE, "left", None, -20 * DEGREE,
                           stiffness=6e8, damping_ratio=0.06,
                           error=lambda x: second * np.cos(4 * np.pi * x), **mesh),
        },
        bearings=supports,
        operation=Operation("input", "output", 130.0, 456.0),
    )  # fmt: skip


def coarse(machine):
    return reduce_structure(MachineStructure(machine, element_length=0.1), 2000.0)


@pytest.fixture(scope="module")
def structure():
    return coarse(two_stages())


@pytest.fixture(scope="module")
def motion(structure):
    return harmonic_balance(system(structure), structure.machine.clock.frequency)


def test_mean_loads_are_those_of_the_static_balance(structure, motion):
    balance = static_balance(structure.machine)
    fine, scale = motion.fine, 12e3
    for number, name in enumerate(structure.machine.meshes):
        mean = fine.mean(fine.contact_force[:, number])
        assert mean == pytest.approx(structure.machine.kinematics.meshes[name].force, rel=1e-9)
    for name in structure.machine.bearings:
        load = fine.mean(structure.bearing_load(name, fine.position, fine.velocity))
        np.testing.assert_allclose(load, balance.bearings[name].load, atol=1e-8 * scale)


def test_input_power_leaves_again_or_is_damped(structure, motion):
    """Without torques that vary, power is that of the steady rotation: in equals out."""
    torque, fine = 456.0, motion.fine
    ratio = float(structure.machine.kinematics.shafts["output"].ratio)
    # the meshes hand on what the input brings, whatever their errors do
    for number, (gear, name) in enumerate((("z1", "first"), ("z3", "second"))):
        radius = structure.machine.directions[name].base_radius[0]
        shaft = structure.machine.kinematics.shafts[structure.machine.gears[gear].shaft]
        power = fine.mean(fine.contact_force[:, number]) * radius * abs(shaft.speed)
        assert power == pytest.approx(torque * 130.0, rel=1e-9)
    assert structure.force @ structure.balance == pytest.approx(
        -torque / ratio * (structure.balance @ structure.balance), rel=1e-9
    )


def test_errors_of_two_meshes_superpose(structure, motion):
    """A linear machine: the responses to the errors of either mesh add up."""
    frequency = structure.machine.clock.frequency
    parts = [
        harmonic_balance(system(coarse(two_stages(*errors))), frequency).fine
        for errors in ((4e-6, 0.0), (0.0, 6e-6), (0.0, 0.0))
    ]
    total = parts[0].position + parts[1].position - parts[2].position
    scale = np.abs(motion.fine.position - parts[2].position).max()
    np.testing.assert_allclose(total, motion.fine.position, atol=1e-9 * scale)
    assert np.ptp(parts[2].contact_force, axis=0).max() < 1e-5


def test_a_reduced_machine_moves_like_the_full_one():
    machine = two_stages()
    full = MachineStructure(machine, element_length=0.1)
    forces = []
    for structure in (full, reduce_structure(full)):
        fine = harmonic_balance(system(structure), machine.clock.frequency).fine
        load = structure.bearing_load("middle left", fine.position, fine.velocity)
        forces.append(np.hstack((fine.contact_force, load[:, :3])))
    dynamic = np.ptp(forces[0], axis=0)
    difference = np.abs(forces[1] - forces[0]).max(axis=0)
    assert np.all(difference < 5e-3 * dynamic.max())


def test_time_integration_stays_on_the_periodic_motion():
    """From a point of the periodic motion Newmark's method follows it."""
    machine = two_stages(first=2e-6, second=3e-6)
    structure = coarse(machine)
    motion, frequency = system(structure), machine.clock.frequency
    orbit = harmonic_balance(motion, frequency)
    start = (orbit.position[0], orbit.velocity[0])
    # harmonic balance determines the torque that holds the output; here it is the lossless one
    response = simulate(replace(motion, balance=None), frequency, 1, start, steps=96,
                        method="newmark")  # fmt: skip
    for number in range(2):
        force, exact = response.contact_force[:, number], orbit.fine.contact_force[:, number]
        assert np.ptp(force) == pytest.approx(np.ptp(exact), rel=0.03)
        assert force.mean() == pytest.approx(exact.mean(), rel=1e-3)
