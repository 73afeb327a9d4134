"""A motion that drifts through the play under a constant force is not taken for an orbit."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from known_systems import BASE_RADIUS, MESH_FREQUENCY, reference_system
from tribodyn.dynamics import steady_state
from tribodyn.dynamics.orbits.orbit_map import newton_step


def test_newton_step_includes_the_residual_that_no_step_removes():
    # Free flight over a period of 1: the place gains the speed, the speed gains 0.1.
    matrix = np.array([[1.0, 1.0], [0.0, 1.0]])
    step, distance = newton_step(matrix, np.array([0.3, 0.1]))
    np.testing.assert_allclose(step, [0.0, -0.3], atol=1e-12)
    assert distance == pytest.approx(0.4)
    # Where the map contracts, the step takes everything away.
    step, distance = newton_step(0.5 * np.eye(2), np.array([0.3, 0.1]))
    np.testing.assert_allclose(step, [0.6, 0.2])
    assert distance == pytest.approx(np.hypot(0.6, 0.2))


def test_lightly_loaded_gears_carry_the_torque_or_have_no_orbit():
    pair = reference_system(gap=2.5e-5)
    system = replace(pair, force=np.array(pair.force) * 1e-8)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        motion = steady_state(system, MESH_FREQUENCY, start=(np.zeros(6), np.zeros(6)))
    force = motion.fine.mean(motion.fine.contact_force[:, 0])
    carried = force == pytest.approx(90e-8 / BASE_RADIUS[0], rel=1e-3)
    assert carried or not motion.converged
    assert carried or any("no periodic orbit" in str(warning.message) for warning in caught)
