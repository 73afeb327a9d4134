"""Friction that follows the load: against friction tables, plain code and an independent solver."""

import numpy as np
import pytest

from known_systems import (
    DOUBLE,
    EVENTS,
    MESH_FREQUENCY,
    friction_vector,
    hysteresis_system,
    reference_system,
)  # fmt: skip
from plain.runge_kutta import march_plain
from tribodyn.analysis import lyapunov_exponents, mesh_harmonics
from tribodyn.dynamics import (
    Contact,
    LoadFriction,
    System,
    continuation,
    energy_audit,
    natural_modes,
    simulate,
    simulate_ensemble,
    steady_state,
)
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.equations.nodes import friction_force, friction_tangent
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.errors import InputError

AT_REST = (np.zeros(6), np.zeros(6))
#: Friction coefficient that falls with the load, and bends.
BENT = (0.12, -0.05, 0.012)


def _system(base, frictions):
    return System(
        base.mass, base.damping, base.stiffness, base.force, base.contacts, base.names,
        frictions=frictions,
    )  # fmt: skip


def _with_load(coefficients, gap=0.0, **change):
    friction = LoadFriction(lambda phase: friction_vector(phase, 1.0), coefficients, 2600.0,
                            events=EVENTS, **change)  # fmt: skip
    return _system(reference_system(gap=gap), [friction])


@pytest.mark.parametrize("gap", [0.0, 1e-5])
def test_a_constant_coefficient_is_the_friction_of_a_contact(gap):
    table, loop = reference_system(0.1, gap=gap), _with_load(0.1, gap)
    start = static_start(compile_for(table, MESH_FREQUENCY, 512))
    np.testing.assert_allclose(static_start(compile_for(loop, MESH_FREQUENCY, 512)), start,
                               rtol=1e-9, atol=1e-20)  # fmt: skip
    with_contact, with_load = (simulate(item, 900.0, 4, (start[:6], start[6:]), steps=512)
                for item in (table, loop))  # fmt: skip
    for name in ("position", "velocity", "acceleration", "contact_force", "deflection"):
        expected = getattr(with_contact.fine, name)
        size = np.abs(expected).max(axis=0) + 1e-30
        assert np.abs((getattr(with_load.fine, name) - expected) / size).max() < 1e-11, name
    audits = [
        energy_audit(item, motion) for item, motion in ((table, with_contact), (loop, with_load))
    ]
    assert audits[1].friction == pytest.approx(audits[0].friction, rel=1e-10)
    assert audits[1].imbalance < 1.001 * audits[0].imbalance < 1e-6
    ensembles = [
        simulate_ensemble(item, np.linspace(300, 2900, 20), 3, AT_REST, averaged=2)
        for item in (table, loop)
    ]
    for name in ("acceleration", "contact_force"):
        expected = getattr(ensembles[0], name).rms
        np.testing.assert_allclose(getattr(ensembles[1], name).rms, expected, rtol=1e-9)


def test_orbit_and_multipliers_of_a_constant_coefficient():
    systems = reference_system(0.1), _with_load(0.1)
    with_contact, with_load = (steady_state(item, MESH_FREQUENCY) for item in systems)
    np.testing.assert_allclose(with_load.contact_force, with_contact.contact_force, rtol=1e-9)
    leading = np.sort(np.abs(with_contact.floquet_multipliers))[-2:]
    np.testing.assert_allclose(
        np.sort(np.abs(with_load.floquet_multipliers))[-2:], leading, rtol=1e-6
    )
    modes = [natural_modes(item, friction=True).eigenvalues
             for item in (reference_system(0.1), _with_load(0.1))]  # fmt: skip
    np.testing.assert_allclose(modes[1], modes[0], rtol=1e-9)


@pytest.mark.parametrize("gap", [0.0, 1e-5])
def test_kernel_equals_plain(gap):
    system = _with_load(BENT, gap, limit=1.3)
    start = 2e-5 * np.random.default_rng(3).standard_normal(12)
    compiled = compile_for(system, MESH_FREQUENCY, 176)
    plain = march_plain(system, compiled.grid, compiled.nodes, MESH_FREQUENCY, 3, start)
    motion = simulate(system, MESH_FREQUENCY, 3, (start[:6], start[6:]), steps=176)
    states = np.hstack([motion.position, motion.velocity])
    assert np.abs((states - plain[:-1]) / np.abs(plain).max(axis=0)).max() < 1e-12
    # The limit is reached, and the load changes its sign.
    assert motion.contact_force.max() > 1.3 * 2600.0
    assert motion.contact_force.min() < 0.0


@pytest.mark.parametrize("lanes", [3, 20, 40])
def test_lanes_equal_single_runs(lanes):
    system = _with_load(BENT, 1e-5)
    frequency = np.linspace(300.0, 2900.0, lanes)
    ensemble = simulate_ensemble(system, frequency, 4, AT_REST, steps=256)
    for lane in (0, lanes - 1):
        single = simulate(system, frequency[lane], 4, AT_REST, steps=256).fine
        np.testing.assert_allclose(ensemble.velocity[lane], single.velocity[-1], rtol=1e-11,
                                   atol=1e-12 * np.abs(single.velocity[-1]).max())  # fmt: skip


def test_against_an_independent_solver():
    """Load sharing and a coefficient that follow the tooth force, with everything written anew."""
    from scipy.integrate import solve_ivp

    mass = np.array([0.7, 0.4])
    pull = np.array([1.0, -0.8])
    rub = np.array([0.3, 0.6])

    def stiffness(phase):
        return 2e4 * (1.0 + 0.3 * np.cos(2 * np.pi * phase))

    def coefficients(phase):
        sense = np.sin(2 * np.pi * phase)
        return np.stack([0.2 * sense, 0.1 * sense**2, -0.04 * sense], axis=1)

    contact = Contact(pull, stiffness, damping=5.0)
    friction = LoadFriction(rub, coefficients, load=60.0, limit=1.5)
    system = System(np.diag(mass), 3.0 * np.eye(2), 3e3 * np.eye(2), [50.0, -20.0], [contact],
                    frictions=[friction])  # fmt: skip
    frequency = 25.0

    def rate(time, y):
        phase = frequency * time
        force = stiffness(phase) * (pull @ y[:2]) + 5.0 * (pull @ y[2:])
        x = min(abs(force) / 60.0, 1.5)
        sense = np.sin(2 * np.pi * phase)
        mu = 0.2 * sense + 0.1 * sense**2 * x - 0.04 * sense * x**2
        total = np.array([50.0, -20.0]) - 3.0 * y[2:] - 3e3 * y[:2]
        return np.concatenate([y[2:], (total - pull * force - rub * mu * force) / mass])

    start = np.array([4e-3, 1e-3, 0.3, -0.2])
    other = solve_ivp(rate, (0.0, 4 / frequency), start, "DOP853", rtol=1e-12, atol=1e-14)
    motion = simulate(system, frequency, 4, (start[:2], start[2:]), steps=2048)
    end = np.concatenate([motion.fine.position[-1], motion.fine.velocity[-1]])
    np.testing.assert_allclose(end, other.y[:, -1], rtol=2e-8)
    lone = simulate(_system(system, ()), frequency, 4, (start[:2], start[2:]), steps=2048)
    assert np.abs(lone.fine.position[-1] / end[:2] - 1.0).max() > 1e-2


def test_friction_never_feeds_energy_in():
    """Direction of sliding and rate of sliding go together: mu > 0 takes energy at every place."""
    omega = 2 * np.pi * MESH_FREQUENCY / 16
    system = _with_load(BENT)
    motion = steady_state(system, MESH_FREQUENCY)
    nodes = compile_for(system, MESH_FREQUENCY, motion.time.size).nodes
    fine = motion.fine
    force = friction_force(
        system, nodes.friction_coefficients.reshape(-1, 1, 3), fine.contact_force
    )[:, 0]  # fmt: skip
    direction = nodes.friction_direction[:, :, 0].reshape(-1, 6)
    # The nominal rotation slides too: pinion omega, wheel 16/24 of it.
    velocity = fine.velocity + omega * np.array([0, 0, 1.0, 0, 0, 16 / 24])
    power = -force * np.einsum("si,si->s", direction, velocity)
    driving = fine.contact_force[:, 0] > 0.0
    far = np.abs(fine.phase % 1.0 - EVENTS[1]) > 0.05
    assert power[driving & far].max() <= 0.0
    assert fine.mean(power) < -1.0
    coefficient = BENT[0] + BENT[1] * 0.9 + BENT[2] * 0.9**2
    table = steady_state(reference_system(coefficient), MESH_FREQUENCY)
    waves = [mesh_harmonics(item, item.fine.deflection[:, 0], 1)[0] for item in (motion, table)]
    assert 1e-4 < abs(waves[0] / waves[1] - 1.0) < 0.1
    moving = simulate(
        system, MESH_FREQUENCY, 2, (motion.position[0], motion.velocity[0]), steps=2048
    )
    assert energy_audit(system, moving).imbalance < 1e-7


def test_tangent_is_the_derivative_of_the_force():
    system = _with_load(BENT, limit=1.3)
    load, small = np.array([-4000.0, -500.0, 800.0, 3000.0, 5000.0])[:, None], 1e-3
    rows = np.array(BENT)[None, None, :]
    slope = friction_force(system, rows, load + small) - friction_force(system, rows, load - small)
    np.testing.assert_allclose(friction_tangent(system, rows, load), slope / (2 * small), rtol=1e-7)


def test_floquet_multipliers_and_small_motions_follow_the_tangent():
    """With a constant stiffness, multipliers of the orbit are those of the linear system."""
    contact = Contact([1.0, -0.5], stiffness=4e4, damping=6.0)
    friction = LoadFriction([0.4, 1.0], [0.3, 0.25, -0.06], load=50.0)
    system = System(np.diag([1.0, 0.5]), np.diag([2.0, 1.0]), np.diag([2e3, 9e3]), [60.0, -40.0],
                    [contact], frictions=[friction])  # fmt: skip
    modes = natural_modes(system, friction=True)
    orbit = steady_state(system, 20.0, steps=1024)
    assert orbit.converged
    expected = np.sort(np.abs(np.exp(modes.eigenvalues / 20.0)))
    np.testing.assert_allclose(np.sort(np.abs(orbit.floquet_multipliers)), expected, rtol=1e-5)
    static_position = static_start(compile_for(system, 20.0, 64))[:2]
    np.testing.assert_allclose(orbit.position[0], static_position, rtol=1e-9)


def test_exponents_with_a_constant_coefficient_and_a_refusal_beyond():
    base = hysteresis_system()
    contact = Contact([1.0], stiffness=base.contacts[0].stiffness, gap=1.0, friction=[0.1])
    table = System(base.mass, base.damping, base.stiffness, base.force, [contact])
    loop = _system(base, [LoadFriction([1.0], 0.1, 1.0)])
    start = ([1.7], [0.0])
    with_contact, with_load = (lyapunov_exponents(item, 0.14, start=start, cycles=100, steps=128)
                for item in (table, loop))  # fmt: skip
    np.testing.assert_allclose(with_load.exponents, with_contact.exponents, rtol=1e-8)
    with pytest.raises(InputError, match=r"frictions\[0\] has 2 coefficients"):
        lyapunov_exponents(_system(base, [LoadFriction([1.0], [0.1, 0.1], 1.0)]), 0.14)


def test_continuation_follows_friction_in_the_loop():
    base = hysteresis_system()

    def make(level):
        return _system(base, [LoadFriction([1.0], [0.0, level], 1.0)])

    branch = continuation(make, 0.2, between=(0.0, 0.3), at=(0.3,), steps=128)
    end = steady_state(make(0.3), 0.2, steps=128)
    at = int(np.argmin(np.abs(branch.parameter - 0.3)))
    np.testing.assert_allclose(branch.position[at], end.position[0], rtol=1e-7)
    assert abs(branch.position[0] / branch.position[at] - 1.0).max() > 1e-3


@pytest.mark.parametrize(
    ("friction", "part"),
    [
        (lambda: LoadFriction([1.0], 0.1, 0.0), "load"),
        (lambda: LoadFriction([1.0], 0.1, 1.0, limit=-1.0), "limit"),
        (lambda: LoadFriction([1.0], 0.1, 1.0, contacts=()), "contacts"),
        (lambda: LoadFriction([1.0], 0.1, 1.0, events=(1.2,)), "LoadFriction.events"),
        (lambda: LoadFriction([1.0], 0.1, 1.0, contacts=(1,)), "friction 0 follows contact 1"),
        (lambda: LoadFriction([1.0, 1.0], 0.1, 1.0), "frictions[0].direction"),
        (lambda: LoadFriction([1.0], lambda p: np.where(p > 0.5, np.nan, 0.1), 1.0),
         "frictions[0].coefficients is NaN or infinite at the mesh phase 0.5"),
    ],
)  # fmt: skip
def test_wrong_frictions(friction, part):
    with pytest.raises(InputError) as caught:
        steady_state(_system(hysteresis_system(), [friction()]), 0.14, steps=64)
    assert part in str(caught.value)


def test_shares_of_the_pairs_may_differ():
    """Two frictions of one contact add up to that with their sum."""
    half = [LoadFriction(lambda phase: friction_vector(phase, 1.0), np.multiply(BENT, part), 2600.0,
                         events=EVENTS) for part in (0.3, 0.7)]  # fmt: skip
    motion = simulate(_with_load(BENT), 700.0, 2, AT_REST)
    two = simulate(_system(reference_system(), half), 700.0, 2, AT_REST)
    np.testing.assert_allclose(two.velocity, motion.velocity, rtol=1e-9, atol=1e-14)
    assert DOUBLE > 0.0
