"""A gear that nothing loads floats between its flanks: the others move as they do without it."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, harmonic_balance
from tribodyn.errors import ModelWarning

CLOCK, PHASES = 300.0, np.array([900.0, 600.0 * np.sqrt(1.1)])
ON_CLOCK, OVER_PHASES = (3, 2), ((1, 0), (0, 1))


def train(cycles, idle, seed, gap=50e-6, load=0.0, error=2e-6):
    """A loaded gear on springs and a body, with gears in a row behind it that have neither."""
    random = np.random.default_rng(seed)
    share, angle = random.uniform(0.05, 0.25, 3), random.uniform(0.0, 6.0, 3)
    row = np.eye(2 + idle)
    directions = [row[0], *(row[2 + i] - row[1 + i if i else 0] for i in range(idle))]
    contacts = [
        Contact(
            direction, lambda x, n=n: 3e8 * (1.0 + share[n] * np.cos(2 * np.pi * x + angle[n])),
            900.0, lambda x, n=n: error * np.cos(2 * np.pi * x + angle[n]),
            gap if n else 40e-6, cycles=cycles[min(n, 1)],
        )
        for n, direction in enumerate(directions)
    ]  # fmt: skip
    springs, force = np.zeros(row.shape), np.zeros(len(row))
    springs[:2, :2] = random.uniform(0.5, 2.0) * np.array([[15e6, -4e6], [-4e6, 12e6]])
    force[0], force[-1] = 3000.0, load
    mass = np.diag(random.uniform(0.8, 2.5, 4)[: len(row)])
    return System(mass, 2e-5 * springs, springs, force, contacts)


@pytest.mark.parametrize("change", [0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2])
@pytest.mark.parametrize("idle", [1, 2])
def test_no_change_of_the_speed_makes_an_idle_gear_rattle(idle, change):
    for seed in range(3):
        system, speed = train(ON_CLOCK, idle, seed), CLOCK * (1.0 + change)
        motion = harmonic_balance(system, speed, steps=64, stability=True)
        assert motion.converged
        assert not motion.fine.contact_force[:, 1:].any()
        alone = harmonic_balance(train(ON_CLOCK, 0, seed), speed, steps=64)
        force = alone.fine.contact_force[:, 0]
        np.testing.assert_allclose(motion.fine.contact_force[:, 0], force, rtol=1e-9)
        # A gear that nothing holds is in the middle between its flanks.
        assert np.abs(motion.fine.mean(motion.fine.deflection[:, 1:])).max() < 1e-6


@pytest.mark.parametrize("idle", [1, 2])
def test_an_idle_gear_floats_over_phases(idle):
    for seed in range(2):
        for change in (0.0, 1e-9):
            motion = harmonic_balance(train(OVER_PHASES, idle, seed), PHASES * (1.0 + change))
            assert motion.converged
            assert not motion.fine.contact_force[:, 1:].any()
            alone = harmonic_balance(train((1,), 0, seed), PHASES[0] * (1.0 + change)).fine
            force = motion.at(alone.time).contact_force[:, 0]
            np.testing.assert_allclose(force, alone.contact_force[:, 0], rtol=1e-6)


def test_a_gear_that_is_loaded_stays_on_its_flank():
    motion = harmonic_balance(train(ON_CLOCK, 1, 0, load=800.0), CLOCK)
    assert motion.fine.mean(motion.fine.contact_force[:, 1]) == pytest.approx(800.0, rel=1e-9)
    # Held by springs, a contact without a force at rest is no floating gear.
    system = train(ON_CLOCK, 1, 0, error=20e-6)
    held = np.array(system.stiffness)
    held[2, 2] = 2e7
    held_gear = System(system.mass, 1e-4 * held, held, system.force, system.contacts)
    with pytest.warns(ModelWarning, match="unstable-orbit"):  # it hits its flanks
        at_rest = harmonic_balance(held_gear, CLOCK, steps=64)
    assert at_rest.fine.contact_force[:, 1].any()


def test_teeth_wider_than_their_space_are_not_open():
    motion = harmonic_balance(train(ON_CLOCK, 1, 0, gap=1e-6, error=8e-6), CLOCK)
    assert motion.fine.contact_force[:, 1].any()
    assert motion.fine.mean(motion.fine.contact_force[:, 1]) == pytest.approx(0.0, abs=1e-3)
