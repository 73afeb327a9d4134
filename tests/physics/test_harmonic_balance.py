"""Harmonic balance of machines: printed figures, closed forms, other methods, superposition."""

import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from known_machines import CLOCK, PRINTED, two_mesh_system
from known_random_machines import random_machine
from tribodyn.dynamics import (
    Contact,
    Response,
    System,
    energy_audit,
    harmonic_balance,
    simulate,
    steady_state,
)
from tribodyn.errors import ComputationError, InputError, ModelWarning, quiet

CASES = [
    (1, {"friction": True}, None, 0.1),
    (3, {"gyroscopic": True}, None, 0.1),
    (5, {"load_friction": True, "torque": True}, None, 0.1),
    (11, {"turning": True, "gyroscopic": True}, 0.1, 0.1),
    (14, {"jumps": True}, 0.1, 0.1),
    (21, {"load_friction": True}, 0.2, 0.8),
]
SLOW = [
    (16, {}, 0.2, 0.8),
    (15, dict.fromkeys(("friction", "turning", "gyroscopic", "torque", "jumps"), True), 0.1, 0.1),
]


def figures(motion: Response) -> np.ndarray:
    """Mean and rms about it of compressions and forces."""
    fine = motion.fine
    signals = np.hstack((fine.deflection, fine.contact_force))
    mean = fine.mean(signals)
    return np.concatenate((mean, np.sqrt(fine.mean((signals - mean) ** 2))))


def test_two_meshes_of_a_gearbox_meet_the_printed_motion():
    motion = harmonic_balance(two_mesh_system(), CLOCK)
    assert motion.converged
    assert motion.engine == "harmonic-balance"
    fine = motion.fine
    for j, printed in enumerate(PRINTED):
        d, n = 1e6 * fine.deflection[:, j], fine.contact_force[:, j]
        values = (fine.mean(d), d - fine.mean(d), fine.mean(n), n - fine.mean(n))
        mean, swing, load, pulse = values
        rms = [np.sqrt(fine.mean(part**2)) for part in (swing, pulse)]
        assert (mean, rms[0], load, rms[1], n.max(), n.min()) == pytest.approx(printed, rel=1e-5)


@pytest.mark.parametrize(
    ("seed", "parts", "gap", "depth"),
    [*CASES, *(pytest.param(*case, marks=pytest.mark.slow) for case in SLOW)],
)
def test_motion_is_the_orbit_of_time_integration(seed, parts, gap, depth):
    machine = random_machine(seed, gap=gap, depth=depth, **parts)
    frequency = 0.4 / machine.cycles
    motion = harmonic_balance(machine, frequency)
    with quiet():
        orbit = steady_state(machine, frequency, steps=512)
    assert orbit.converged
    assert motion.converged
    size = np.abs(orbit.deflection).max()
    assert figures(motion) == pytest.approx(figures(orbit), rel=1e-6, abs=1e-6 * size)


def test_constant_stiffness_and_harmonic_errors_have_a_closed_form():
    mass, damping, stiffness = 2.0, 0.3, 1.5
    rigid, viscous, load, cycles = 7.0, 0.2, 1.3, (2, 3)
    size = 0.1, 0.2
    contacts = [
        Contact(
            [1.0],
            rigid,
            damping=viscous,
            error=lambda x, a=a: a * np.cos(2.0 * np.pi * x),
            cycles=n,
            offset=0.25,
        )
        for n, a in zip(cycles, size, strict=True)
    ]
    machine = System([[mass]], [[damping]], [[stiffness]], [load], contacts)
    motion = harmonic_balance(machine, 0.21)
    clock = motion.phase
    exact = np.full(clock.size, load / (stiffness + 2.0 * rigid))
    for n, a in zip(cycles, size, strict=True):
        omega = 2.0 * np.pi * 0.21 * n
        top = (rigid + 1j * omega * viscous) * a
        bottom = stiffness + 2.0 * rigid + 1j * omega * (damping + 2.0 * viscous) - mass * omega**2
        exact += (top / bottom * np.exp(2j * np.pi * (n * clock + 0.25))).real
    assert motion.position[:, 0] == pytest.approx(exact, abs=1e-10)
    assert motion.error < 1e-12


def test_responses_of_separate_meshes_add_in_a_linear_machine():
    def compression(shaken: tuple[int, ...]) -> np.ndarray:
        machine = two_mesh_system(gaps=(0.0, 0.0))
        contacts = [
            Contact(
                contact.direction,
                rigid,
                damping=contact.damping,
                error=contact.error if j in shaken else 0.0,
                cycles=contact.cycles,
                offset=contact.offset,
            )
            for j, (contact, rigid) in enumerate(zip(machine.contacts, (4e8, 6e8), strict=True))
        ]
        parts = machine.mass, machine.damping, machine.stiffness, machine.force, contacts
        return harmonic_balance(System(*parts, balance=machine.balance), CLOCK, steps=64).position

    still = compression(())
    joint, first, second = (compression(which) - still for which in ((0, 1), (0,), (1,)))
    elastic = [1, 3, 5, 7]
    scale = np.abs(joint[:, elastic]).max()
    assert joint[:, elastic] == pytest.approx((first + second)[:, elastic], abs=1e-11 * scale)


@pytest.mark.parametrize("parts", [{}, {"friction": True, "gyroscopic": True}, {"torque": True}])
def test_power_balances(parts):
    machine = random_machine(3, **parts)
    contacts = [Contact(**{**vars(part), "events": ()}) for part in machine.contacts]
    machine = System(**{
        name: getattr(machine, name) for name in ("mass", "damping", "stiffness", "force")
    }, contacts=contacts, gyroscopic=machine.gyroscopic)  # fmt: skip
    motion = harmonic_balance(machine, 0.4 / machine.cycles, steps=256)
    clock, v, n = motion.phase, motion.velocity, motion.contact_force
    load = machine.force(clock) if callable(machine.force) else machine.force
    supplied = np.mean(np.sum(v * load, axis=1))
    dissipated = np.mean(np.einsum("pi,ik,pk->p", v, machine.damping, v))
    into_contacts = rubbed = 0.0
    for j, contact in enumerate(machine.contacts):
        into_contacts += np.mean(n[:, j] * (v @ contact.direction))
        rub = np.zeros(machine.size) if contact.friction is None else contact.friction
        rubbed += np.mean(n[:, j] * (v @ rub))
    total = abs(supplied) + dissipated + abs(into_contacts) + abs(rubbed)
    assert supplied - into_contacts - rubbed == pytest.approx(dissipated, abs=1e-10 * total)
    # What dampers and friction take is what the varying stiffness and the errors supply.
    audit = energy_audit(machine, motion)
    assert audit.dissipated > dissipated / motion.mesh_frequency
    assert audit.imbalance < 1e-8


def test_small_machine_follows_scipy():
    machine = random_machine(11, gap=0.1)
    frequency = 0.4 / machine.cycles
    motion = harmonic_balance(machine, frequency)
    size, inverse = machine.size, np.linalg.inv(machine.mass)

    def slope(time, state):
        q, v = state[:size], state[size:]
        total = machine.force - machine.stiffness @ q - machine.damping @ v
        for contact in machine.clocked_contacts:
            clock, h = np.array([time * frequency % 1.0]), np.asarray(contact.direction)
            error_change = contact.error(clock + 1e-6) - contact.error(clock - 1e-6)
            d = h @ q - contact.error(clock)[0]
            rate = h @ v - frequency * error_change[0] / 2e-6
            if abs(d) > contact.gap:
                spring = contact.stiffness(clock)[0] * (d - np.sign(d) * contact.gap)
                total = total - h * (spring + contact.damping * rate)
        return np.concatenate((v, inverse @ total))

    start = np.concatenate((motion.position[0], motion.velocity[0]))
    rows = slice(None, None, motion.time.size // 8)
    span = 0.0, 1.0 / frequency
    run = solve_ivp(slope, span, start, "DOP853", motion.time[rows], rtol=1e-9, atol=1e-11)
    scale = np.abs(motion.position).max()
    assert motion.position[rows] == pytest.approx(run.y[:size].T, abs=1e-6 * scale)


def test_balancing_torque_is_that_of_the_orbit():
    machine = two_mesh_system()
    motion = harmonic_balance(machine, CLOCK, steps=64)
    assert motion.extra_force[6] == pytest.approx(-11316.48141289, rel=1e-9)
    # Mean forces of a statically determinate drive are its torques.
    load = motion.fine.mean(motion.fine.contact_force)
    assert load == pytest.approx([420.0 / 0.05835, 420.0 / 0.05835 * 0.11021 / 0.0701], rel=1e-8)


def test_start_from_the_motion_at_another_speed():
    machine = two_mesh_system()
    first = harmonic_balance(machine, CLOCK, steps=64)
    second = harmonic_balance(machine, 1.02 * CLOCK, steps=64, start=first)
    alone = harmonic_balance(machine, 1.02 * CLOCK, steps=64)
    assert second.deflection == pytest.approx(alone.deflection, rel=1e-9)


def test_a_motion_that_does_not_repeat_names_the_contact():
    pair = Contact([1.0], lambda x: 9.0 * (1.0 + 0.9 * np.cos(2.0 * np.pi * x)), gap=1.0)
    free = Contact([1.0], 0.01, cycles=2)
    machine = System([[1.0]], [[0.002]], [[0.0]], [0.1], [free, pair])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ModelWarning)
        motion = harmonic_balance(machine, 0.31, steps=32, tolerance=1e-30)
    assert not motion.converged
    messages = [str(entry.message) for entry in caught]
    assert any("The largest residual is that of contact" in text for text in messages)
    # An integrated period stands in for the motion.
    start = motion.position[0], motion.velocity[0]
    again = simulate(machine, 0.31, 1, start, steps=512, extra_force=motion.extra_force)
    at = np.interp(motion.time, again.time, again.position[:, 0])
    assert motion.position[:, 0] == pytest.approx(at, abs=1e-4 * np.ptp(at))
    assert (motion.engine, motion.period) == ("modal", 0)


def test_a_mode_without_damping_at_a_harmonic_is_refused():
    machine = System([[1.0]], [[0.0]], [[0.0]], [1.0], [Contact([1.0], 4.0)])
    with pytest.raises(ComputationError, match=r"0.31831 Hz has no damping.*harmonic 1"):
        harmonic_balance(machine, 1.0 / np.pi)
    assert harmonic_balance(machine, 1.1 / np.pi).converged


def test_arguments_are_checked():
    machine = two_mesh_system()
    with pytest.raises(InputError, match="frequency"):
        harmonic_balance(machine, -1.0)
    with pytest.raises(InputError, match="steps"):
        harmonic_balance(machine, CLOCK, steps=2)
    with pytest.raises(InputError, match="no coordinate is moved by a contact"):
        harmonic_balance(System([[1.0]], [[0.1]], [[1.0]], [1.0]), 1.0)
