"""The energy audit of motions with damped impacts closes to the order of the integrator."""

import numpy as np
import pytest

from known_systems import reference_system
from tribodyn.dynamics import Contact, System, energy_audit, simulate

TURN = 2.0 * np.pi


def bouncing(**contact):
    """A mass that falls on a spring and a damper and leaves them again."""
    pair = Contact([1.0], **{"stiffness": 40.0, "damping": 1.5, "gap": 1.0} | contact)
    return System([[1.0]], [[0.0]], [[0.0]], [-1.0], [pair])


MOVING = {
    "stiffness": lambda phase: 40.0 + 10.0 * np.sin(TURN * phase),
    "error": lambda phase: 0.05 * np.sin(TURN * phase),
    "gap": lambda phase: 1.0 + 0.1 * np.cos(TURN * phase),
}


def audits(system, frequency, cycles, start, counts):
    """Audits of one motion with several numbers of steps, in each of which the contact parts."""
    results = []
    for steps in counts:
        motion = simulate(system, frequency, cycles, start, steps=steps)
        gap = system.contacts[0].gap
        touching = motion.deflection[:, 0] > (gap(motion.phase) if callable(gap) else gap)
        assert np.count_nonzero(np.diff(touching)) > 2
        results.append(energy_audit(system, motion))
    return results


@pytest.mark.parametrize("contact", [{}, {"damping_in_gap": True}, MOVING])
def test_a_bouncing_mass(contact):
    results = audits(bouncing(**contact), 0.1, 2, ([3.0], [-2.0]), (512, 1024, 2048))
    errors = [audit.imbalance for audit in results]
    assert errors[1] < 1e-6
    assert errors[2] < errors[0] / 4**3.3
    assert results[1].dissipated == pytest.approx(results[2].dissipated, rel=1e-6)
    if contact is MOVING:
        assert abs(results[2].parametric) > 0.02 * results[2].dissipated


def test_a_pair_of_gears_that_separates():
    start = (np.zeros(6), np.array([0.0, 0.05, 1.5, 0.0, 0.0, 0.0]))
    system = reference_system(0.1, gap=1e-5)
    results = audits(system, 900.0, 4, start, (1024, 2048, 4096))
    errors = [audit.imbalance for audit in results]
    assert errors[0] < 1e-6
    assert errors[2] < errors[0] / 4**3.3
    assert min(abs(results[0].friction), results[0].dissipated, results[0].parametric) > 0.01


def test_two_flanks_that_open_together_lose_energy_as_one_does():
    half = Contact([1.0], stiffness=20.0, damping=0.75, gap=1.0)
    twins = System([[1.0]], [[0.0]], [[0.0]], [-1.0], [half, half])
    single, double = (
        audits(system, 0.1, 2, ([3.0], [-2.0]), (1024,))[0] for system in (bouncing(), twins)
    )
    assert double.imbalance < 1e-6
    assert double.dissipated == pytest.approx(single.dissipated, rel=1e-8)
