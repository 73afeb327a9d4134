"""The compiled kernel against the readable one, and lanes against single runs."""

import numpy as np
import pytest

from known_systems import MESH_FREQUENCY, everything_varies, hysteresis_system, reference_system
from plain.runge_kutta import march_plain
from tribodyn.analysis import alternating_rms, extremes, mesh_harmonics, rms
from tribodyn.dynamics import simulate, simulate_ensemble
from tribodyn.dynamics.equations.compiled import compile_for

CASES = {
    "linear": (reference_system(0.1), MESH_FREQUENCY, 1e-6),
    "backlash": (reference_system(0.1, gap=1e-5), MESH_FREQUENCY, 2e-5),
    "hysteresis": (hysteresis_system(), 0.14, 1.5),
    "everything": (everything_varies(), 0.4, 0.2),
}


@pytest.mark.parametrize("name", CASES)
def test_kernel_equals_plain(name):
    system, frequency, size = CASES[name]
    start = size * np.random.default_rng(3).standard_normal(2 * system.size)
    compiled = compile_for(system, frequency, 176)
    plain = march_plain(system, compiled.grid, compiled.nodes, frequency, 3, start)
    half = system.size
    motion = simulate(system, frequency, 3, (start[:half], start[half:]), steps=176)
    scale = np.abs(plain).max(axis=0) + 1e-30
    states = np.hstack([motion.position, motion.velocity])
    assert np.abs((states - plain[:-1]) / scale).max() < 1e-12


def test_the_cases_do_open_and_close_contacts():
    for name in ("backlash", "hysteresis", "everything"):
        system, frequency, size = CASES[name]
        start = size * np.random.default_rng(3).standard_normal(2 * system.size)
        half = system.size
        motion = simulate(system, frequency, 3, (start[:half], start[half:]), steps=176)
        gap = max(float(np.max(c.gap)) if not callable(c.gap) else 0.015 for c in system.contacts)
        touching = np.abs(motion.deflection) > gap
        assert touching.any(), name
        assert not touching.all(), name


@pytest.mark.parametrize("lanes", [3, 5, 40, 70])
def test_lanes_equal_single_runs(lanes):
    system = reference_system(0.1, gap=1e-5)
    generator = np.random.default_rng(lanes)
    frequency = generator.uniform(200.0, 3000.0, lanes)
    position = 2e-5 * generator.standard_normal((lanes, 6))
    velocity = np.zeros((lanes, 6))
    extra = generator.standard_normal((lanes, 6))
    ensemble = simulate_ensemble(
        system, frequency, 4, (position, velocity), steps=256, extra_force=extra, averaged=1
    )
    for lane in (0, lanes // 2, lanes - 1):
        start = (position[lane], velocity[lane])
        single = simulate(system, frequency[lane], 4, start, steps=256, extra_force=extra[lane])
        fine = single.fine
        end = np.concatenate([fine.position[-1], fine.velocity[-1]])
        states = np.concatenate([ensemble.position[lane], ensemble.velocity[lane]])
        np.testing.assert_allclose(states, end, rtol=1e-13, atol=1e-13 * np.abs(end).max())


def test_statistics_in_the_kernel_equal_those_of_a_record():
    system = reference_system(0.1, gap=1e-5)
    start = (np.zeros(6), np.zeros(6))
    outputs = np.hstack([system.stiffness, system.damping])[:2]
    ensemble = simulate_ensemble(
        system, [240.0, 900.0, 2600.0, 3000.0], 3, start, steps=1024, averaged=3, outputs=outputs
    )
    for lane, frequency in enumerate(ensemble.mesh_frequency):
        response = simulate(system, frequency, 3, start, steps=1024)
        fine = response.fine
        # Both take parts of the steps in which teeth part, but not the same ones.
        loss_share = fine.mean((fine.deflection[:, 0] <= 1e-5).astype(float))
        limit, at_jumps, share = (1e-6, 1e-5, 2e-3) if loss_share > 0.0 else (1e-10, 1e-10, 1e-12)
        for statistics, signal in (
            (ensemble.deflection, fine.deflection),
            (ensemble.contact_force, fine.contact_force),
            (ensemble.acceleration, fine.acceleration),
            (ensemble.output, fine.position @ outputs[:, :6].T + fine.velocity @ outputs[:, 6:].T),
        ):
            scale = np.abs(signal).max(axis=0)
            size, most = limit * scale, at_jumps * scale
            assert np.all(np.abs(statistics.mean[lane] - fine.mean(signal)) <= size)
            assert np.all(np.abs(statistics.rms[lane] - rms(fine, signal)) <= size)
            # At the jump itself the two differ by as much as its place does.
            assert np.all(np.abs(statistics.minimum[lane] - signal.min(axis=0)) <= most)
            assert np.all(np.abs(statistics.maximum[lane] - signal.max(axis=0)) <= most)
        np.testing.assert_allclose(
            statistics.alternating_rms[lane], alternating_rms(fine, signal), rtol=1e-6
        )
        waves = mesh_harmonics(fine, fine.deflection[:, 0], 5)
        scale = np.abs(waves).max() * limit
        np.testing.assert_allclose(ensemble.deflection.harmonics[lane, 0], waves, atol=scale)
        # The samples count those at the boundary by halves, the kernel knows the time.
        assert ensemble.contact_loss_share[lane, 0] == pytest.approx(loss_share, abs=share)
        assert extremes(fine.deflection[:, 0])[1] >= ensemble.deflection.maximum[lane, 0] - 1e-15


def test_threads_do_not_change_a_bit():
    system = hysteresis_system()
    frequency = np.linspace(0.1, 0.3, 200)
    first, second = (
        simulate_ensemble(system, frequency, 5, ([1.5], [0.0]), steps=64, threads=threads)
        for threads in (1, 4)
    )
    np.testing.assert_array_equal(first.position, second.position)
    np.testing.assert_array_equal(first.deflection.rms, second.deflection.rms)
