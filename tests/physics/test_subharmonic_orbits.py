"""Orbits of several mesh cycles: found, certified, with their true period."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from known_systems import hysteresis_system
from tribodyn.dynamics import Contact, System, simulate, simulate_ensemble, steady_state
from tribodyn.errors import InputError, ModelWarning

STEPS = 128


def oscillator(depth, damping, gap=1.0):
    contact = Contact(
        [1.0], stiffness=lambda phase: 1.0 + depth * np.cos(2 * np.pi * phase), gap=gap
    )
    return System([[1.0]], [[damping]], [[0.0]], [0.3], [contact])


#: Depth of the stiffness variation, damping, circular mesh frequency and true period.
PERIODS = {1: (0.2, 0.1, 0.9), 2: (0.2, 0.05, 2.0), 3: (0.4, 0.06, 2.5), 4: (0.6, 0.1, 2.0)}

#: Besides the orbit of three mesh cycles there are stable ones of one and of four.
STARTS = {3: ([-0.44], [-1.38])}


def case(period):
    depth, damping, rate = PERIODS[period]
    return oscillator(depth, damping), rate / (2.0 * np.pi)


def repeats_after(system, frequency, orbit, cycles):
    start = (orbit.position[0], orbit.velocity[0])
    motion = simulate(system, frequency, cycles + 1, start, steps=STEPS)
    place = motion.position[::STEPS, 0]
    return np.abs(place - place[0])


@pytest.mark.parametrize(
    ("period", "requested"),
    [(1, 5), (1, 6), (1, 7), (1, 8), (2, 2), (2, 4), (2, 6), (2, 8), (4, 4), (4, 8)],
)
def test_the_period_is_the_shortest(period, requested):
    system, frequency = case(period)
    orbit = steady_state(system, frequency, steps=STEPS, periods=requested)
    assert orbit.converged
    assert orbit.stable
    assert (orbit.period, orbit.periods) == (period, requested)
    distances = repeats_after(system, frequency, orbit, period)
    assert distances[period] < 1e-7
    assert np.all(distances[1:period] > 1e-2)


@pytest.mark.parametrize("period", [1, 2, 3, 4])
def test_automatic_periods_find_the_motion_that_marching_ends_in(period):
    system, frequency = case(period)
    with warnings.catch_warnings():
        warnings.simplefilter("error", ModelWarning)
        orbit = steady_state(
            system, frequency, steps=STEPS, periods="auto", start=STARTS.get(period)
        )
    assert orbit.converged
    assert orbit.stable
    assert orbit.period == orbit.periods == period
    assert 0 <= orbit.search_cycles < orbit.cycles_used
    distances = repeats_after(system, frequency, orbit, period)
    assert distances[period] < 1e-7
    assert np.all(distances[1:period] > 1e-2)


def test_an_unstable_orbit_of_one_cycle_is_reported():
    system, frequency = case(2)
    with pytest.warns(ModelWarning, match=r'unstable-orbit.*periods = "auto"'):
        orbit = steady_state(system, frequency, steps=STEPS)
    assert orbit.converged
    assert orbit.period == 1
    # the flip: one multiplier left of -1, and the product of both that the damping gives
    assert orbit.floquet_multipliers[0].real < -1.0
    product = np.prod(orbit.floquet_multipliers).real
    assert product == pytest.approx(np.exp(-0.05 / frequency), rel=1e-6)


def test_a_motion_that_never_repeats_is_reported():
    system = oscillator(0.6, 0.05)
    with pytest.warns(ModelWarning, match="lyapunov_exponents") as caught:
        orbit = steady_state(system, 2.0 / (2.0 * np.pi), steps=STEPS, periods="auto")
    text = str(caught[0].message)
    assert "1 to 8 mesh cycles earlier" in text
    assert orbit.converged
    assert not orbit.stable


def test_a_motion_that_grows_without_bounds_is_reported():
    with pytest.warns(ModelWarning, match="grows without bounds"):
        steady_state(oscillator(0.6, 0.02), 1.9 / (2 * np.pi), steps=STEPS, periods="auto")
    linear = oscillator(0.6, 0.02, gap=0.0)
    with pytest.warns(ModelWarning, match="linear"):
        steady_state(linear, 1.9 / (2 * np.pi), steps=STEPS, periods="auto")


@pytest.mark.parametrize("periods", [0, 1.5, "all"])
def test_other_periods_are_refused(periods):
    with pytest.raises(InputError, match="auto"):
        steady_state(hysteresis_system(), 0.14, periods=periods)


def test_every_start_belongs_to_the_orbit_that_its_motion_approaches():
    system, frequency, count = hysteresis_system(), 0.88 / (2.0 * np.pi), 24
    generator = np.random.default_rng(7)
    position = generator.uniform(0.0, 3.5, (count, 1))
    velocity = generator.uniform(-1.2, 1.2, (count, 1))
    marched = simulate_ensemble(
        system, np.full(count, frequency), 200, (position, velocity), steps=STEPS
    )
    place = marched.position[:, 0]
    high = place > 0.5 * (place.min() + place.max())
    assert 3 <= high.sum() <= count - 3
    for lane in range(count):
        start = (position[lane], velocity[lane])
        orbit = steady_state(system, frequency, start=start, steps=STEPS)
        assert orbit.position[0, 0] == pytest.approx(place[lane], abs=1e-6)


def test_automatic_periods_follow_the_motion_where_several_orbits_are_stable():
    system, frequency = case(3)
    generator, count = np.random.default_rng(1), 16
    position = generator.uniform(-2.0, 3.0, (count, 1))
    velocity = generator.uniform(-1.5, 1.5, (count, 1))
    ends = simulate_ensemble(
        system, np.full(count, frequency), 600, (position, velocity), steps=STEPS
    )
    periods = set()
    for lane in range(count):
        orbit = steady_state(
            system, frequency, steps=STEPS, periods="auto", start=(position[lane], velocity[lane])
        )
        periods.add(orbit.period)
        visited = orbit.position[::STEPS, 0]
        assert np.abs(visited - ends.position[lane, 0]).min() < 1e-5
    assert periods == {1, 3, 4}
