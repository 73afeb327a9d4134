"""Motions on a nonlinear force law: statics, energy, an independent solver, small vibrations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from known_laws import GRID, LOAD, constant_law, gear_pair, total_force, wavy_law
from known_systems import BASE_RADIUS
from tribodyn.dynamics import (
    Contact,
    System,
    energy_audit,
    law_contacts,
    simulate,
    steady_state,
)
from tribodyn.mesh import MeshForceLaw


def test_a_slow_mesh_follows_the_static_transmission_error():
    """Far below resonance the pair deflects as at rest, the nearer the slower it turns."""
    law = wavy_law(5)
    errors = []
    for frequency in (12.0, 1.2):
        system = gear_pair(law, model="torsional", mesh_damping=1.2e4)
        motion = steady_state(system, frequency, steps=4096 if frequency > 2.0 else 20480)
        fine = motion.fine
        static = 5e-5 + law.deflection(fine.phase % 1.0, LOAD)
        errors.append(np.abs(fine.deflection[:, 0] - static).max())
        assert fine.mean(total_force(motion)) == pytest.approx(LOAD, rel=1e-6)
    assert errors[1] < 2e-9
    assert errors[0] < 2e-8
    assert errors[1] < 0.2 * errors[0]


@pytest.mark.parametrize("damping", [0.0, 900.0])
def test_energy_audit_closes_on_a_force_law(damping):
    system = gear_pair(wavy_law(6), friction=0.05, backlash=1e-5, mesh_damping=damping)
    start = (np.zeros(6), np.array([0.0, 0.05, 1.5, 0.0, 0.0, 0.0]))
    motion = simulate(system, 1200.0, 2, start, steps=8192)
    carrying = (motion.contact_force != 0.0).sum(axis=1)
    assert carrying.min() == 0
    assert carrying.max() >= 4
    audit = energy_audit(system, motion)
    assert audit.imbalance < 1e-8
    assert audit.external > 0.0


def _elastic(law, phase, deflection, half):
    """Energy of both flanks from the law itself, not from its contacts."""
    return law.energy(phase, deflection - half) + law.energy(phase, -deflection - half)


def test_a_free_flight_between_two_nonlinear_flanks_keeps_its_energy():
    law = constant_law([0.0, 0.2, 0.5], [9.0, 4.0, 8.0])
    contacts = law_contacts(Contact([1.0], 0.0, gap=1.0), law)
    system = System([[1.0]], [[0.0]], [[0.0]], [0.0], contacts)
    motion = simulate(system, 0.05, 1, ([0.0], [-2.5]), steps=4096)
    place, speed = motion.position[:, 0], motion.velocity[:, 0]
    assert place.min() < -1.5
    assert place.max() > 1.5
    energy = 0.5 * speed**2 + _elastic(law, 0.0, place, 1.0)
    np.testing.assert_allclose(energy, 0.5 * 2.5**2, rtol=1e-8)
    force = law.force(0.0, place - 1.0) - law.force(0.0, -place - 1.0)
    np.testing.assert_allclose(motion.contact_force.sum(axis=1), force, atol=1e-12)


#: A body of mass 1 on a flank N = K d^1.1 with a damper, pushed by a wave: units of its own.
_STIFF, _POWER, _DAMPER, _PUSH = 40.0, 1.1, 0.8, 3.0


def _smooth_place(time, frequency):
    """The same motion from another solver and with the law as a formula."""

    def rate(now, state):
        deflection, speed = state
        force = _STIFF * max(deflection, 0.0) ** _POWER + _DAMPER * speed
        return [speed, _PUSH * (1.0 + 0.3 * np.cos(2 * np.pi * frequency * now)) - force]

    solution = solve_ivp(
        rate, (0.0, time[-1]), [0.12, 0.0], "DOP853", t_eval=time, rtol=1e-12, atol=1e-14
    )
    assert solution.y[0].min() > 0.0
    return solution.y[0]


def test_ramps_converge_to_the_smooth_law_with_the_square_of_their_width():
    frequency, errors = 0.5, []
    for ramps in (10, 20, 40, 80):
        deflection = np.tile(np.linspace(0.0, 0.16, ramps + 1), (GRID.phase.size, 1))
        law = MeshForceLaw.through(GRID, deflection, _STIFF * deflection**_POWER)
        system = System(
            [[1.0]],
            [[0.0]],
            [[0.0]],
            lambda phase: _PUSH * (1.0 + 0.3 * np.cos(2 * np.pi * phase))[:, None],
            law_contacts(Contact([1.0], 0.0, damping=_DAMPER), law),
        )
        motion = simulate(system, frequency, 3, ([0.12], [0.0]), steps=512)
        assert motion.position.max() < 0.16
        exact = _smooth_place(motion.time, frequency)
        errors.append(np.abs(motion.position[:, 0] - exact).max())
    assert errors[-1] < 2e-6
    # Where the knots happen to lie matters too: the order is that of the whole row.
    assert np.log2(errors[0] / errors[-1]) / 3.0 > 1.8


def test_small_vibrations_see_the_tangent_and_large_ones_do_not():
    """On one straight piece the law is its tangent; with a larger error it is left."""
    wave = 1.0 + 0.005 * np.cos(2 * np.pi * GRID.phase)
    place = np.tile([0.0, 5e-6, 14e-6], (GRID.phase.size, 1))
    law = MeshForceLaw(GRID, place, wave[:, None] * np.array([1.5e8, 1.5e8, 2e8]))
    assert 9e-6 < law.deflection(0.1, LOAD) < 13e-6
    swings = []
    for amplitude in (0.1e-6, 1.5e-6):
        motions = [
            steady_state(
                gear_pair(
                    law,
                    friction=0.05,
                    mesh_force=way,
                    error=lambda phase, size=amplitude: size * np.cos(4 * np.pi * phase),
                ),
                2400.0,
                steps=1024,
            )
            for way in ("tangent", "force-law", "stiffness")
        ]
        signals = [total_force(motion) for motion in motions]
        size = np.ptp(signals[1])
        swings.append([np.abs(signal - signals[1]).max() / size for signal in signals])
    small, large = swings
    assert small[0] < 3e-6  # curves between the knots differ a little
    assert small[2] > 1e-2
    assert large[0] > 1e-2


def test_friction_power_and_torques_hold_on_a_force_law():
    law = wavy_law(6)
    system = gear_pair(law, friction=0.05)
    motion = steady_state(system, 240.0, steps=2048)
    fine, force = motion.fine, total_force(motion)
    one_sided = fine.phase.reshape(-1, 3) + np.array([1e-9, 0.0, -1e-9])
    vector = system.contacts[0].friction(one_sided.reshape(-1) % 1.0)
    speed = 2 * np.pi * 240.0 / 16
    rigid_rotation = np.array([0.0, 0.0, speed, 0.0, 0.0, speed / 1.5])
    power = -force * (vector * (fine.velocity + rigid_rotation)).sum(axis=1)
    # Mean torque on the pinion: the load along the line of action and friction on its lever.
    torque = fine.mean(force * (BASE_RADIUS[0] + vector[:, 2]))
    assert torque == pytest.approx(90.0, rel=1e-9)
    assert fine.mean(power) != 0.0
