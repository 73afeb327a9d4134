"""Samples of a response where contacts open and close: as many as before, none across a jump."""

import numpy as np
import pytest

from tribodyn.analysis import rms
from tribodyn.dynamics import Contact, System, energy_audit, simulate

START = ([3.0], [-2.0])


def bouncing(steps, **contact):
    """A mass that falls on a spring and a damper and leaves them again; and its system."""
    pair = Contact([1.0], **{"stiffness": 40.0, "damping": 1.5, "gap": 1.0} | contact)
    system = System([[1.0]], [[0.0]], [[0.0]], [-1.0], [pair])
    return system, simulate(system, 0.1, 2, START, steps=steps)


def test_mean_force_is_the_change_of_momentum():
    for steps in (1024, 2048):
        _, motion = bouncing(steps)
        fine = motion.fine
        assert np.count_nonzero(np.diff(motion.contact_force[:, 0] != 0.0)) > 3
        gained = fine.velocity[-1, 0] - fine.velocity[0, 0]
        force = fine.mean(fine.contact_force[:, 0])
        assert gained == pytest.approx((-1.0 - force) * motion.duration, abs=2e-6)
        assert fine.mean(fine.acceleration[:, 0]) == pytest.approx(-1.0 - force, rel=1e-12)


def test_rms_of_the_force_has_order_four_or_nearly():
    exact = rms(*_force(bouncing(8192)[1]))
    errors = [abs(rms(*_force(bouncing(steps)[1])) / exact - 1.0) for steps in (512, 1024, 2048)]
    assert errors[1] < 1e-6
    assert errors[2] < errors[0] / 4**2.5


def _force(motion):
    return motion.fine, motion.fine.contact_force[:, 0]


def test_layout_stays():
    system, motion = bouncing(256)
    fine = motion.fine
    assert fine.phase.size == 3 * 512
    assert np.all(np.diff(fine.phase) >= 0.0)
    assert fine.weight.sum() == pytest.approx(1.0, rel=1e-12)
    assert fine.mean(np.cos(2 * np.pi * fine.phase)) == pytest.approx(0.0, abs=1e-9)
    triples = fine.phase.reshape(-1, 3)
    np.testing.assert_array_equal(triples[1:, 0], triples[:-1, 2])
    # Rows of the response itself stay where the steps are.
    np.testing.assert_allclose(np.diff(motion.time), motion.time[1], rtol=1e-9)
    moved = np.flatnonzero(np.abs(triples[:, 0] - np.arange(512) / 256) > 1e-12)
    assert 3 < moved.size < 25
    assert energy_audit(system, motion).imbalance < 5e-5


def test_two_flanks_that_open_at_one_place():
    """A spring halved into two contacts gives the samples of the whole."""
    _, single = bouncing(256)
    half = Contact([1.0], stiffness=20.0, damping=0.75, gap=1.0)
    system = System([[1.0]], [[0.0]], [[0.0]], [-1.0], [half, half])
    double = simulate(system, 0.1, 2, START, steps=256).fine
    np.testing.assert_allclose(double.phase, single.fine.phase, rtol=1e-12)
    force = single.fine.contact_force[:, 0]
    np.testing.assert_allclose(double.contact_force.sum(axis=1), force, atol=1e-7)
