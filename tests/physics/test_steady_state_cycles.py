"""How many mesh cycles the search for a steady state takes, and where it ends."""

from __future__ import annotations

import numpy as np
import pytest

from known_systems import reference_system
from tribodyn.dynamics import Contact, System, simulate, steady_state

STEPS = 256
PLAY = 20e-6


def spread(orbit):
    return abs(orbit.floquet_multipliers[0])


@pytest.mark.filterwarnings(r"ignore:\[step-size\]")  # coarse on purpose
@pytest.mark.parametrize("gap", [0.0, PLAY])
@pytest.mark.parametrize("damping", [90.0, 900.0])
@pytest.mark.parametrize("frequency", [240.0, 500.0, 4000.0, 7000.0, 9000.0])
def test_cycles_of_the_reference_pair(frequency, damping, gap):
    system = reference_system(0.1, damping=damping, gap=gap)
    orbit = steady_state(system, frequency, steps=STEPS)
    assert orbit.converged
    assert orbit.stable
    assert np.all(orbit.deflection > gap)
    assert spread(orbit) <= 0.993
    limit = 10 if spread(orbit) < 0.95 else 30
    assert orbit.search_cycles <= limit
    assert orbit.cycles_used <= limit
    # with the flanks in touch the play only shifts the motion
    closed = steady_state(reference_system(0.1, damping=damping), frequency, steps=STEPS)
    moved = orbit.deflection - closed.deflection - gap
    assert np.abs(moved).max() < 1e-9 * np.abs(orbit.deflection).max()


def weakly_damped(decay, gap):
    contact = Contact(
        [1.0], stiffness=lambda phase: 1.0 + 0.02 * np.cos(2 * np.pi * phase), gap=gap
    )
    rate = 0.7
    damping = -np.log(decay) * 2.0 * rate / (2.0 * np.pi)
    return System([[1.0]], [[damping]], [[0.0]], [1.0], [contact]), rate / (2.0 * np.pi)


@pytest.mark.parametrize("gap", [0.0, 1.0])
@pytest.mark.parametrize("decay", [0.9, 0.949, 0.993, 0.999])
def test_cycles_do_not_grow_with_the_multiplier(decay, gap):
    system, frequency = weakly_damped(decay, gap)
    orbit = steady_state(system, frequency, steps=STEPS)
    assert spread(orbit) == pytest.approx(decay, rel=1e-5)
    assert orbit.cycles_used <= 10
    assert orbit.converged
    motion = simulate(system, frequency, 2, (orbit.position[0], orbit.velocity[0]), steps=STEPS)
    difference = abs(motion.position[STEPS, 0] - orbit.position[0, 0])
    assert difference < 1e-9


def test_a_start_far_off_that_parts_the_flanks_is_followed():
    system, frequency = weakly_damped(0.9, 1.0)
    far = steady_state(system, frequency, steps=STEPS, start=([4.5], [0.0]))
    orbit = steady_state(system, frequency, steps=STEPS)
    assert far.search_cycles > orbit.search_cycles
    np.testing.assert_allclose(far.position, orbit.position, rtol=1e-7)


def test_flanks_that_never_part_from_rest_on_are_followed_over_one_cycle():
    orbit = steady_state(reference_system(0.1, gap=PLAY), 1500.0, steps=STEPS)
    assert orbit.search_cycles == 1
    assert orbit.cycles_used == 2  # the lanes of the matrix, and the orbit itself
