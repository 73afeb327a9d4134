"""Reference cases D1, D2 and H1: periodic orbits that SciPy finds on its own (tests/references)."""

import numpy as np
import pytest

from known_systems import MESH_FREQUENCY, hysteresis_system, reference_system
from references.backlash_orbits import HIGH, LOW
from references.backlash_orbits import MULTIPLIER as BACKLASH_MULTIPLIER
from references.gear_pair_orbits import ACROSS, HARMONICS, MULTIPLIER, ORBITS
from tribodyn.analysis import alternating_rms, extremes, mesh_harmonics, peak_to_peak, rms
from tribodyn.dynamics import steady_state


@pytest.fixture(scope="module", params=[0.0, 0.1], ids=["D1", "D2"])
def orbit(request):
    return request.param, steady_state(reference_system(request.param), MESH_FREQUENCY, steps=4096)


def test_means_and_rms(orbit):
    friction, motion = orbit
    fine = motion.fine
    deflection, force = fine.deflection[:, 0], fine.contact_force[:, 0]
    mean, span, mean_force, rms_force, peak, acceleration = ORBITS[friction]
    assert fine.mean(deflection) * 1e6 == pytest.approx(mean, rel=1e-6)
    assert peak_to_peak(deflection) * 1e6 == pytest.approx(span, rel=2e-6)
    assert fine.mean(force) == pytest.approx(mean_force, rel=1e-6)
    assert rms(fine, force) == pytest.approx(rms_force, rel=1e-6)
    assert extremes(force)[1] == pytest.approx(peak, rel=1e-6)
    assert rms(fine, fine.acceleration[:, 1]) == pytest.approx(acceleration, rel=2e-6)


def test_harmonics(orbit):
    friction, motion = orbit
    harmonics = np.abs(mesh_harmonics(motion, motion.fine.deflection[:, 0], 3)) * 1e6
    np.testing.assert_allclose(harmonics, HARMONICS[friction], rtol=1e-6, atol=1e-6)


def test_bearing_and_friction_forces_of_d2():
    system = reference_system(0.1)
    motion = steady_state(system, MESH_FREQUENCY, steps=4096)
    fine = motion.fine
    forces = fine.position @ system.stiffness.T + fine.velocity @ system.damping.T
    assert alternating_rms(fine, forces[:, 0]) == pytest.approx(ACROSS["bearing_x"], rel=2e-6)
    assert alternating_rms(fine, forces[:, 1]) == pytest.approx(ACROSS["bearing_y"], rel=2e-6)
    # The force that the two supports and the inertia of the pinion take up is the friction force.
    friction = forces[:, 0] + 0.676 * fine.acceleration[:, 0]
    assert rms(fine, friction) == pytest.approx(ACROSS["friction"], rel=2e-6)
    assert abs(motion.floquet_multipliers[0]) == pytest.approx(MULTIPLIER, abs=2e-6)


def test_without_friction_nothing_moves_across_the_line_of_action():
    motion = steady_state(reference_system(0.0), MESH_FREQUENCY)
    assert np.abs(motion.fine.acceleration[:, [0, 3]]).max() < 1e-9


def _h1(frequency, start=None):
    return steady_state(hysteresis_system(), frequency / (2 * np.pi), start=start, steps=512)


def _rms(motion):
    return float(alternating_rms(motion.fine, motion.fine.position[:, 0]))


def _end(motion):
    return motion.position[0], motion.velocity[0]


def test_both_branches_of_the_hysteresis():
    low, high = _h1(0.88, ([1.5], [0.0])), _h1(0.88, ([2.2], [0.3]))
    for motion, value, touches in ((low, LOW, False), (high, HIGH, True)):
        assert motion.converged
        assert motion.stable
        assert _rms(motion) == pytest.approx(value, rel=3e-6)
        assert bool(motion.fine.position.min() < 1.0) is touches
        np.testing.assert_allclose(
            np.abs(motion.floquet_multipliers), BACKLASH_MULTIPLIER, rtol=1e-5
        )


@pytest.mark.parametrize(("first", "last", "value"), [(0.80, 0.88, LOW), (0.96, 0.88, HIGH)])
def test_each_sweep_direction_stays_on_its_branch(first, last, value):
    motion = _h1(first)
    for frequency in np.linspace(first, last, 9)[1:]:
        motion = _h1(frequency, _end(motion))
        assert motion.converged
    # Rising speed stays on the branch that keeps contact, falling speed on the other.
    assert _rms(motion) == pytest.approx(value, rel=3e-6)


@pytest.mark.parametrize("frequency", [0.82, 0.95])
def test_one_branch_only_outside_the_hysteresis(frequency):
    ends = [_rms(_h1(frequency, ([x], [0.0]))) for x in (1.5, 2.6, 0.4)]
    np.testing.assert_allclose(ends, ends[0], rtol=1e-6)
