"""Harmonic balance and modal integration agree, and meet orbits that SciPy finds on its own."""

from math import pi

import numpy as np
import pytest

from known_random_machines import random_machine
from known_systems import MESH_FREQUENCY, hysteresis_system, reference_system
from references.backlash_orbits import HIGH, LOW, MULTIPLIER, SPEED
from references.gear_pair_orbits import ORBITS
from tribodyn.analysis import alternating_rms, extremes, peak_to_peak, rms
from tribodyn.dynamics import harmonic_balance, simulate, steady_state

EVERY = dict.fromkeys(("friction", "turning", "gyroscopic", "torque", "load_friction"), True)


@pytest.mark.parametrize("friction", [pytest.param(0.0, marks=pytest.mark.slow), 0.1])
def test_orbits_with_jumps_of_stiffness_and_friction(friction):
    motion = harmonic_balance(reference_system(friction), MESH_FREQUENCY, steps=16384)
    fine = motion.fine
    deflection, force = fine.deflection[:, 0], fine.contact_force[:, 0]
    mean, span, mean_force, rms_force, peak, acceleration = ORBITS[friction]
    assert fine.mean(deflection) * 1e6 == pytest.approx(mean, rel=1e-6)
    assert peak_to_peak(deflection) * 1e6 == pytest.approx(span, rel=4e-6)
    assert fine.mean(force) == pytest.approx(mean_force, rel=1e-6)
    assert rms(fine, force) == pytest.approx(rms_force, rel=1e-6)
    assert extremes(force)[1] == pytest.approx(peak, rel=1e-6)
    assert rms(fine, fine.acceleration[:, 1]) == pytest.approx(acceleration, rel=1e-5)


@pytest.mark.parametrize(
    ("start", "value"), [(([1.5], [0.0]), LOW), (([2.2], [0.3]), HIGH)], ids=["quiet", "loud"]
)
def test_both_motions_behind_a_backlash(start, value):
    system, frequency = hysteresis_system(), SPEED / (2.0 * pi)
    neighbour_motion = steady_state(system, 0.99 * frequency, start=start, steps=128)
    motion = harmonic_balance(system, frequency, start=neighbour_motion, steps=2048, stability=True)
    assert motion.converged
    assert alternating_rms(motion.fine, motion.fine.position[:, 0]) == pytest.approx(
        value, rel=3e-6
    )
    assert np.abs(motion.floquet_multipliers) == pytest.approx(MULTIPLIER, rel=2e-5)


@pytest.mark.parametrize(
    ("seed", "gap", "parts"),
    [(2, None, {}), (4, 0.2, {"friction": True}), (6, 0.2, {"jumps": True}), (12, 0.1, EVERY)],
)
def test_integration_repeats_the_motion_of_harmonic_balance(seed, gap, parts):
    machine = random_machine(seed, gap=gap, depth=0.2, **parts)
    frequency = 0.3 / machine.cycles
    motion = harmonic_balance(machine, frequency)
    assert motion.converged
    begin = motion.position[0], motion.velocity[0]
    again = simulate(machine, frequency, 1, begin, steps=128, method="modal")
    for name in ("deflection", "contact_force"):
        exact = getattr(motion.fine, name)
        mean = [part.fine.mean(getattr(part.fine, name)) for part in (motion, again)]
        square = [part.fine.mean(getattr(part.fine, name) ** 2) for part in (motion, again)]
        scale = np.abs(exact).max()
        assert mean[1] == pytest.approx(mean[0], abs=1e-6 * scale)
        assert square[1] == pytest.approx(square[0], abs=1e-6 * scale**2)
