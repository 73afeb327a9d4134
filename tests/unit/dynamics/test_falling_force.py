"""A force law that falls is refused, by hand-made contacts and by points of a law."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, simulate, steady_state
from tribodyn.errors import InputError
from tribodyn.mesh import MeshForceLaw, phase_grid


def system(*contacts):
    return System([[1.0]], [[0.2]], [[0.0]], [0.5], contacts)


def ramp(stiffness, gap, **options):
    return Contact([1.0], stiffness=stiffness, gap=gap, **options)


def test_negative_stiffness_beyond_a_dead_zone_is_refused():
    with pytest.raises(InputError, match=r"contacts\[0\].stiffness: the force falls by 1 N per m"):
        steady_state(system(ramp(-1.0, 1.0)), 0.1, steps=64)


def test_ramps_that_make_the_force_fall_are_refused():
    falling = system(ramp(1.0, 1.0), ramp(-1.5, 1.2))
    with pytest.raises(InputError, match=r"contacts\[1\].*falls by 0\.5 N per m.*1\.2e\+06 um"):
        simulate(falling, 0.1, 1, ([1.0], [0.0]), steps=64)
    low = ramp(lambda phase: np.where(phase < 0.5, 2.0, 1.0), 1.0, events=(0.5,))
    with pytest.raises(InputError, match=r"at the mesh phase 0\.5"):
        steady_state(system(low, ramp(-1.5, 1.2)), 0.1, steps=64)


def test_softening_ramps_and_linear_springs_are_accepted():
    softer = system(ramp(1.0, 1.0), ramp(-0.5, 1.2))
    # 0.5 = (d - 1) - 0.5 (d - 1.2) where it is at rest
    assert steady_state(softer, 0.1, steps=64).deflection[0, 0] == pytest.approx(1.8, abs=1e-9)
    # a linear negative spring, and a ramp beyond a dead zone that holds it
    softening = System([[1.0]], [[0.2]], [[2.0]], [0.5], [ramp(-1.0, 0.0), ramp(3.0, 1.0)])
    assert steady_state(softening, 0.1, steps=64).position[0, 0] == pytest.approx(0.5, abs=1e-9)


def test_ramps_of_another_mesh_do_not_count():
    other = Contact([2.0], stiffness=5.0, gap=0.1)
    with pytest.raises(InputError, match=r"contacts\[1\].stiffness"):
        steady_state(system(other, ramp(-1.0, 1.0)), 0.1, steps=64)


def test_points_of_a_falling_law_are_refused():
    grid = phase_grid((0.0,), 16)
    points = np.tile([0.0, 1e-5, 2e-5], (17, 1))
    force = np.tile([0.0, 3000.0, 2000.0], (17, 1))
    with pytest.raises(InputError, match=r"falls from 3000 N at 10 um to 2000 N at 20 um"):
        MeshForceLaw.through(grid, points, force)
