"""Statistics gathered while marching, where damped contacts open and close within steps."""

import numpy as np
import pytest

from known_systems import reference_system
from tribodyn.analysis import mesh_harmonics, rms
from tribodyn.dynamics import Contact, LaneParameters, System, simulate_ensemble, steady_state

START = ([3.0], [-2.0])


def _pounding(stiffness=1.0, damping=1.0, gap=1.0, force=1.0):
    """A mass thrown against a spring and a damper, and back."""
    pair = Contact([1.0], stiffness=40.0 * stiffness, damping=3.0 * damping, gap=gap)
    push = lambda phase: force * (4.0 + 9.0 * np.cos(2 * np.pi * phase))[:, None]  # noqa: E731
    return System([[1.0]], [[0.05]], [[0.0]], push, [pair])


def _falling(steps, lanes=1, harmonics=5):
    pair = Contact([1.0], stiffness=40.0, damping=1.5, gap=1.0)
    system = System([[1.0]], [[0.0]], [[0.0]], [-1.0], [pair])
    return simulate_ensemble(
        system, [0.1] * lanes, 2, START, steps=steps, averaged=2, harmonics=harmonics
    )


def _compare(ensemble, lane, motion, limit):
    fine = motion.fine
    for statistics, signal in (
        (ensemble.deflection, fine.deflection),
        (ensemble.contact_force, fine.contact_force),
        (ensemble.acceleration, fine.acceleration),
    ):
        size = np.abs(signal).max(axis=0)
        assert np.all(np.abs(statistics.mean[lane] - fine.mean(signal)) <= limit * size)
        np.testing.assert_allclose(statistics.rms[lane], rms(fine, signal), rtol=limit)
    force = fine.contact_force[:, 0]
    waves = mesh_harmonics(fine, force, 5)
    statistics = ensemble.contact_force.harmonics[lane, 0]
    np.testing.assert_allclose(statistics, waves, atol=limit * np.abs(waves).max())
    assert ensemble.contact_force.maximum[lane, 0] == pytest.approx(force.max(), rel=1e-6)


@pytest.mark.parametrize("steps", [512, 1024])
def test_orbit_of_the_gear_pair(steps):
    system, frequency = reference_system(0.1, gap=1e-5), [2470.0, 2500.0, 2520.0]
    for lane, beat in enumerate(frequency):
        orbit = steady_state(system, beat, steps=steps)
        ensemble = simulate_ensemble(
            system, frequency, orbit.periods, (orbit.position[0], orbit.velocity[0]), steps=steps,
            averaged=orbit.periods,
        )  # fmt: skip
        assert ensemble.contact_loss_share[lane, 0] > 0.03
        _compare(ensemble, lane, orbit, 1e-7)


@pytest.mark.parametrize("steps", [512, 1024])
def test_lanes_with_factors(steps):
    parameter_sets = [(1.0, 1.0, 1.0, 1.0), (1.1, 1.4, 1.1, 1.1), (0.9, 1.3, 0.8, 0.95)]
    stiffness, damping, gap, force = np.array(parameter_sets).T
    factors = LaneParameters(
        stiffness_scale=stiffness, damping_scale=damping, gap_scale=gap, force_scale=force
    )
    orbits = [steady_state(_pounding(*values), 1.6, steps=steps) for values in parameter_sets]
    start = tuple(
        np.array([getattr(orbit, name)[0] for orbit in orbits]) for name in ("position", "velocity")
    )
    ensemble = simulate_ensemble(
        _pounding(), [1.6] * 3, 1, start, steps=steps, averaged=1, parameters=factors
    )
    separate = simulate_ensemble(
        [_pounding(*values) for values in parameter_sets],
        [1.6] * 3,
        1,
        start,
        steps=steps,
        averaged=1,
    )
    for lane, orbit in enumerate(orbits):
        assert 0.1 < ensemble.contact_loss_share[lane, 0] < 0.9
        _compare(ensemble, lane, orbit, 1e-8)
        _compare(separate, lane, orbit, 1e-8)


def test_order_of_the_statistics():
    exact = _falling(8192)

    def errors(steps):
        values = _falling(steps)
        force, true = values.contact_force, exact.contact_force
        return np.array([
            abs(force.mean - true.mean)[0, 0],
            abs(force.rms - true.rms)[0, 0],
            abs(values.acceleration.rms - exact.acceleration.rms)[0, 0],
            np.abs(force.harmonics - true.harmonics).max(),
            abs(values.contact_loss_share - exact.contact_loss_share)[0, 0],
        ])  # fmt: skip

    order = np.log2(errors(512) / errors(2048)) / 2.0
    assert np.all(order > 3.4), order


def test_force_is_the_change_of_momentum():
    values = _falling(512)
    balance = values.contact_force.mean[0, 0] + values.acceleration.mean[0, 0]
    assert balance == pytest.approx(-1.0, rel=1e-12)
    gained = (values.velocity[0, 0] - START[1][0]) / 20.0
    assert values.acceleration.mean[0, 0] == pytest.approx(gained, abs=2e-6)


def test_high_harmonics_are_those_of_short_steps():
    """The waves turn by a large angle in a step: they are taken where the parts begin and end."""
    coarse, fine = (_falling(steps, harmonics=60).contact_force.harmonics for steps in (1024, 8192))
    assert np.abs(coarse - fine).max() < 1e-4 * np.abs(fine).max()


def test_lanes_do_not_share_their_parts():
    system = reference_system(0.1, gap=1e-5)
    frequency = np.linspace(2300.0, 2700.0, 17)
    start = (np.zeros(6), np.zeros(6))
    options = {"steps": 256, "averaged": 2}
    ensemble = simulate_ensemble(system, frequency, 12, start, **options)
    assert np.count_nonzero(ensemble.contact_loss_share) > 3
    for lane in (0, int(np.argmax(ensemble.contact_loss_share[:, 0])), 16):
        single = simulate_ensemble(system, frequency[lane : lane + 1], 12, start, **options)
        for name in ("deflection", "contact_force", "acceleration"):
            for part in ("mean", "rms", "minimum", "maximum"):
                values, alone = (getattr(getattr(each, name), part) for each in (ensemble, single))
                np.testing.assert_allclose(values[lane], alone[0], rtol=1e-9, atol=1e-9)
