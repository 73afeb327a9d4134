"""A march by another integrator that starts on a motion over phases stays on it for 40 cycles."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.known_systems import plain_slope
from tests.physics.test_motion_over_phases import two_meshes, wave

from tribodyn.dynamics import Contact, System, harmonic_balance


def eccentric_pair():
    """A pair on springs, both gears eccentric, with a stop that holds beyond a clearance."""
    law, error = wave((0.15, 0.0), (0.05, 1.0)), wave((2e-6, 0.4))
    mesh = Contact(
        [1.0, 1.0, -1.0, -1.0], lambda x: 3e8 * (1 + law(x)), 800.0, error, 20e-6,
        cycles=(1, 0, 0), offset=0.2, turning_cycles=[(0, 1, 0), (0, 0, 1)],
        turning_error=[lambda x, a=a: a * np.cos(2 * pi * x + 0.3) for a in (3e-6, 8e-6)],
    )  # fmt: skip
    stop = Contact([0.0, 1.0, 0.0, 0.0], 1e8, 400.0, 0.0, 4e-6, cycles=(1, 0, 0))
    springs, damping = np.diag([0.0, 2e8, 0.0, 3e8]), np.diag([20.0, 1500.0, 20.0, 2000.0])
    load = [3e3, -1e3, -3e3, 0.0]
    return System(np.diag([1.2, 2.5, 0.8, 1.7]), damping, springs, load, [mesh, stop])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("system", "frequencies"),
    [
        (two_meshes(((1, 0), (0, 1)), friction=True, amplitude=0.02), (0.25, 0.11 * np.sqrt(2))),
        (eccentric_pair(), (1200.0, 1200.0 / 17, 1200.0 / 24)),
    ],
)
def test_a_march_that_starts_on_the_motion_stays_on_it(system, frequencies):
    motion = harmonic_balance(system, frequencies)
    assert motion.converged
    times = np.linspace(0.0, 40.0 / frequencies[0], 161)
    at = motion.at(times)
    begin = np.concatenate((at.position[0], at.velocity[0]))
    slope = plain_slope(system, np.array(frequencies))
    marched = solve_ivp(slope, times[[0, -1]], begin, "DOP853", times, rtol=1e-10, atol=1e-14)
    assert np.abs(marched.y[: system.size].T - at.position).max() < 1e-6 * np.ptp(at.deflection)
