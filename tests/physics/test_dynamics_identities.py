"""Closed forms, conservation laws and observed orders of the dynamics engine."""

import re

import numpy as np
import pytest

from known_systems import (
    BASE_RADIUS,
    EVENTS,
    LINE,
    MESH_FREQUENCY,
    hysteresis_system,
    reference_system,
)
from tribodyn.dynamics import Contact, System, energy_audit, simulate, steady_state
from tribodyn.errors import InputError


def _end(motion):
    return np.concatenate([motion.fine.position[-1], motion.fine.velocity[-1]])


def _observed_orders(run, steps):
    exact = run(16 * steps[-1])
    errors = [np.abs(run(count) - exact).max() for count in steps]
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_fourth_order_across_events():
    system = reference_system(0.1)

    def run(steps):
        motion = simulate(system, MESH_FREQUENCY, 2, (np.zeros(6), np.zeros(6)), steps=steps)
        return motion.fine.deflection[-1]

    assert _observed_orders(run, [256, 512, 1024]).min() > 3.8


def test_fourth_order_across_contact_loss():
    def run(steps):
        motion = simulate(hysteresis_system(), 0.14, 3, ([2.6], [0.0]), steps=steps)
        assert motion.position.min() < 1.0
        return _end(motion)

    assert _observed_orders(run, [64, 128, 256]).min() > 3.8


def test_fourth_order_where_the_contact_damper_makes_the_force_jump():
    contact = Contact([1.0], stiffness=9.0, damping=0.6, gap=1.0)
    system = System([[1.0]], [[0.0]], [[0.5]], [0.3], [contact])

    def run(steps):
        return _end(simulate(system, 0.2, 2, ([1.8], [0.0]), steps=steps))

    assert _observed_orders(run, [256, 512, 1024]).min() > 3.8


def test_events_not_declared_are_reported():
    """Steps across a jump have a lower order: a warning names the phase of the jump."""
    phases, start = [0.0], (np.zeros(6), np.zeros(6))
    for _ in EVENTS[1:]:  # one after the other
        system = reference_system(0.1, events=tuple(phases))
        with pytest.raises(InputError, match=r"jumps by .* at the mesh phase") as error:
            simulate(system, MESH_FREQUENCY, 5, start, steps=2000)
        phase = float(re.search(r"mesh phase (\S+),", str(error.value))[1])
        nearest = min(EVENTS, key=lambda event: abs(event - phase))
        assert abs(nearest - phase) < 1e-5
        phases.append(nearest)
    assert sorted(phases) == sorted(EVENTS)


def test_energy_audit_closes_across_events():
    system = reference_system(0.1)
    motion = simulate(system, MESH_FREQUENCY, 2, (np.zeros(6), np.zeros(6)), steps=8192)
    audit = energy_audit(system, motion)
    assert audit.imbalance < 1e-9
    assert audit.dissipated > 0.0
    assert abs(audit.parametric) > 1e-3 * audit.dissipated


def _pulsating(damping):
    contact = Contact(
        [1.0, -0.5],
        stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase),
        damping=damping,
        error=lambda phase: 0.1 * np.sin(2 * np.pi * phase),
        gap=0.3,
    )
    return System(np.diag([1.0, 2.0]), 0.05 * np.eye(2), np.eye(2), [0.5, -0.2], [contact])


@pytest.mark.parametrize("damping", [0.0, 0.2])
def test_energy_audit_closes_with_contact_loss_and_a_moving_error(damping):
    # With a contact damper the force jumps inside a step.
    system = _pulsating(damping)
    motion = simulate(system, 0.3, 4, ([0.9, 0.0], [0.0, 0.4]), steps=2048)
    assert np.abs(motion.deflection).min() < 0.3
    assert energy_audit(system, motion).imbalance < 1e-9


def test_orbit_returns_all_the_energy_it_stores():
    contact = Contact([1.0], stiffness=lambda phase: 9.0 + np.cos(2 * np.pi * phase), damping=0.3)
    system = System([[1.0]], [[0.1]], [[1.0]], lambda phase: np.sin(2 * np.pi * phase)[:, None],
                    [contact])  # fmt: skip
    audit = energy_audit(system, steady_state(system, 0.3, steps=2048))
    assert abs(audit.stored) < 1e-10 * audit.dissipated
    assert audit.imbalance < 1e-10
    assert audit.external > 0.0


def test_forced_oscillator_against_the_closed_form():
    mass, damping, stiffness, frequency = 2.0, 0.7, 30.0, 0.4
    omega = 2 * np.pi * frequency
    system = System(
        [[mass]], [[damping]], [[stiffness]], lambda phase: np.cos(2 * np.pi * phase)[:, None], []
    )
    motion = steady_state(system, frequency, steps=4096)
    amplitude = 1.0 / (stiffness - mass * omega**2 + 1j * damping * omega)
    exact = (amplitude * np.exp(1j * omega * motion.time)).real
    np.testing.assert_allclose(motion.position[:, 0], exact, atol=1e-11)
    assert motion.error < 1e-11


def test_moving_error_excites_like_a_force():
    """Through spring and damper an error e acts as the force k e + c e' (sign included)."""
    k, c, frequency = 30.0, 0.7, 0.4
    omega = 2 * np.pi * frequency
    contact = Contact(
        [1.0], stiffness=k, damping=c, error=lambda phase: 0.1 * np.cos(2 * np.pi * phase)
    )
    motion = steady_state(
        System([[2.0]], [[0.0]], [[0.0]], [0.0], [contact]), frequency, steps=2048
    )
    amplitude = 0.1 * (k + 1j * omega * c) / (k - 2.0 * omega**2 + 1j * omega * c)
    exact = (amplitude * np.exp(1j * omega * motion.time)).real
    np.testing.assert_allclose(motion.position[:, 0], exact, atol=1e-10)


def test_meissner_multipliers():
    """Stiffness that switches between two values: multipliers in closed form."""
    k1, k2, damping, frequency, duty = 1.3, 0.6, 0.05, 0.22, 0.35
    contact = Contact(
        [1.0], stiffness=lambda phase: np.where(phase < duty, k1, k2), events=(0.0, duty)
    )
    motion = steady_state(
        System([[1.0]], [[damping]], [[0.0]], [1.0], [contact]), frequency, steps=4096
    )

    def over(k, time):
        w = np.sqrt(k - damping**2 / 4)
        e, s, c = np.exp(-damping * time / 2), np.sin(w * time), np.cos(w * time)
        return e * np.array(
            [[c + damping / 2 / w * s, s / w], [-k / w * s, c - damping / 2 / w * s]]
        )

    matrix = over(k2, (1 - duty) / frequency) @ over(k1, duty / frequency)
    exact = np.linalg.eigvals(matrix)
    np.testing.assert_allclose(
        np.sort_complex(motion.floquet_multipliers), np.sort_complex(exact), atol=1e-9
    )


def test_product_of_multipliers_is_the_trace_of_the_damping():
    """Liouville: the state volume shrinks with exp(-trace(M^-1 C) T)."""
    motion = steady_state(hysteresis_system(), 0.88 / (2 * np.pi), start=([2.2], [0.3]), steps=2048)
    shrink = np.exp(-0.1 * motion.duration)
    assert np.prod(motion.floquet_multipliers).real == pytest.approx(shrink, rel=1e-5)


def test_momentum_of_a_free_pair_is_conserved():
    """Contact and friction forces are equal and opposite: no net force on the two centres."""
    free = System(
        reference_system().mass, np.zeros((6, 6)), np.zeros((6, 6)), np.zeros(6),
        reference_system(0.1, gap=1e-6).contacts,
    )  # fmt: skip
    start = (np.array([0, 1e-5, 0, 0, 0, 0.0]), np.array([0.01, -0.02, 1.0, 0.03, 0.01, 0.5]))
    motion = simulate(free, MESH_FREQUENCY, 2, start, steps=512)
    masses = np.diag(free.mass)
    for x, other in ((0, 3), (1, 4)):
        momentum = motion.velocity[:, [x, other]] @ masses[[x, other]]
        np.testing.assert_allclose(momentum, momentum[0], rtol=1e-9)
    assert np.ptp(motion.velocity[:, 0]) > 1e-3


def test_friction_turns_the_whole_drive_as_its_levers_say():
    """Virtual work: the free rotation feels friction alone, with the levers rho_1 and rho_2."""
    system = reference_system(0.1)
    free = np.array([0, 0, BASE_RADIUS[1], 0, 0, BASE_RADIUS[0]])
    phase = np.array([0.05, 0.2, 0.5, 0.9])
    vector = system.contacts[0].friction(phase)
    across = vector[:, 0]
    # s.z = sum sigma mu share (rho_1 r_b2 - rho_2 r_b1), and rho_1 + rho_2 = a sin(alpha_w).
    pinion, wheel = vector[:, 2], -vector[:, 5]
    np.testing.assert_allclose(pinion + wheel, across * LINE, atol=1e-15)
    np.testing.assert_allclose(vector @ free, pinion * BASE_RADIUS[1] - wheel * BASE_RADIUS[0])


def test_no_force_in_free_flight():
    """Damping acts only while in contact, unless requested otherwise."""
    for keep, expected in ((False, 0.0), (True, 0.6)):
        contact = Contact([1.0], stiffness=9.0, damping=0.6, gap=1.0, damping_in_gap=keep)
        system = System([[1.0]], [[0.0]], [[0.0]], [0.0], [contact])
        motion = simulate(system, 1.0, 1, ([0.0], [0.5]), steps=64)
        np.testing.assert_allclose(motion.contact_force[:, 0], expected * motion.velocity[:, 0])
        drift = motion.velocity[-1, 0] - 0.5
        assert (drift == 0.0) is not keep


def test_back_flank_pushes_the_other_way():
    contact = Contact([1.0], stiffness=9.0, gap=1.0)
    motion = simulate(
        System([[1.0]], [[0.0]], [[0.0]], [0.0], [contact]), 0.05, 1, ([0.0], [-1.0]), steps=2048
    )
    force, place = motion.contact_force[:, 0], motion.position[:, 0]
    assert force.min() < 0.0 < force.max()
    assert np.all(force[place < -1.0] <= 0.0)
    assert np.all(force[np.abs(place) < 1.0] == 0.0)
    # Elastic bounces between the two flanks keep the speed; energy in closed form.
    energy = motion.velocity[:, 0] ** 2 / 2 + 9.0 / 2 * np.maximum(np.abs(place) - 1.0, 0.0) ** 2
    np.testing.assert_allclose(energy, 0.5, rtol=1e-8)
