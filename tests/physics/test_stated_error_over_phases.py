"""The stated error of a motion over phases is the true one, of systems drawn at random."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.known_systems import plain_slope

from tribodyn.dynamics import Contact, System, harmonic_balance


def wave(random, amplitude):
    """Two harmonics of a function of a phase."""
    parts = amplitude * random.uniform(0.3, 1.0, 2) * [1.0, 0.3]
    angles = random.uniform(0.0, 6.0, 2)
    return lambda x: sum(
        a * np.cos(2.0 * np.pi * n * x + b)
        for n, (a, b) in enumerate(zip(parts, angles, strict=True), 1)
    )


def drawn(seed, meshes, shafts=0, load=1.0):
    """Gears in a row on springs, each mesh with its phase, or one whose gears are eccentric."""
    random = np.random.default_rng(seed)
    phases, size = meshes + shafts, 2 * (meshes + 1)
    unit = np.eye(phases, dtype=int)
    contacts = []
    for mesh in range(meshes):
        row = np.zeros(size)
        row[2 * mesh : 2 * mesh + 4] = 1.0, random.uniform(0.3, 1), -1.0, -random.uniform(0.3, 1)
        law, mean = wave(random, 0.2), random.uniform(1.5e8, 4e8)
        contacts.append(
            Contact(
                row, lambda x, law=law, mean=mean: mean * (1.0 + law(x)),
                random.uniform(600.0, 2500.0), wave(random, 4e-6), random.uniform(1e-5, 4e-5),
                cycles=tuple(unit[mesh].tolist()), offset=float(random.uniform()),
                turning_cycles=[tuple(each) for each in unit[meshes:].tolist()],
                turning_error=[wave(random, 1e-5) for _ in range(shafts)],
            )
        )  # fmt: skip
    mass, springs = random.uniform(0.6, 3.0, size), np.zeros(size)
    springs[1::2] = random.uniform(1.5e8, 4e8, size // 2)
    damping = np.where(springs > 0.0, 0.08 * np.sqrt(springs * mass), 50.0)
    force = np.zeros(size)
    force[0] = load * random.uniform(2500.0, 6000.0)
    force[-2] = -force[0]
    system = System(np.diag(mass), np.diag(damping), np.diag(springs), force, contacts)
    slower = np.sqrt(random.uniform(1.5, 6.0, phases)) * ([1.0] * meshes + [17.0] * shafts)
    slower[0] = 1.0
    return system, random.uniform(700.0, 1800.0) / slower


def felt(system, position):
    """Motion along the meshes: all but the free rotation."""
    return position @ np.array([contact.direction for contact in system.contacts]).T


def true_error(system, frequencies, motion, points):
    """Largest change of a motion with so many points, over its size."""
    times = np.linspace(0.0, 40.0 / frequencies[0], 401)
    better = harmonic_balance(system, frequencies, steps=points, start=motion)
    assert better.converged
    first, second = (felt(system, each.at(times).position) for each in (motion, better))
    return np.abs(first - second).max() / np.linalg.norm(first, axis=1).max()


@pytest.mark.parametrize(
    ("seed", "meshes", "shafts"), [(0, 2, 0), (1, 2, 0), (2, 1, 1), (3, 1, 2), (4, 1, 2)]
)
def test_of_closed_flanks(seed, meshes, shafts):
    system, frequencies = drawn(seed, meshes, shafts)
    motion = harmonic_balance(system, frequencies)
    assert motion.converged
    assert motion.fine.contact_force.min() > 0.0
    points = [2 * count for count in motion.points]
    error = true_error(system, frequencies, motion, points)
    assert error < 1.5 * motion.step_error + 1e-10
    assert motion.step_error < 3.0 * error + 1e-10


@pytest.mark.parametrize(("seed", "scale"), [(1, 0.1), (3, 0.1), (11, 30.0)])
def test_of_bodies_of_unlike_mass(seed, scale):
    """It is that of the compressions, and of those that new lines of one mesh cause at another."""
    system, frequencies = drawn(seed, 2)
    first = np.where(np.arange(6) < 2, scale, 1.0)
    scaled = {name: getattr(system, name) * first for name in ("mass", "damping", "stiffness")}
    system = replace(system, **scaled)
    motion = harmonic_balance(system, frequencies, steps=12)
    assert motion.fine.contact_force.min() > 0.0
    error = true_error(system, frequencies, motion, 24)
    assert error < 1.2 * motion.step_error
    assert motion.step_error < 1.5 * error


def negative(function):
    """The same with the other sign."""
    return lambda x: -function(x)


@pytest.mark.parametrize(("seed", "meshes", "shafts"), [(0, 2, 0), (3, 1, 2)])
def test_flanks_on_the_other_side_carry_the_same(seed, meshes, shafts):
    """A contact whose direction and errors have the other sign is the same with minus its force."""
    system, frequencies = drawn(seed, meshes, shafts)
    contacts = [
        replace(
            each, direction=-np.asarray(each.direction), error=negative(each.error),
            turning_error=[negative(error) for error in each.turning_error],
        )
        for each in system.contacts
    ]  # fmt: skip
    mirrored = harmonic_balance(replace(system, contacts=contacts), frequencies)
    motion = harmonic_balance(system, frequencies)
    assert mirrored.converged
    assert mirrored.fine.contact_force.max() < 0.0
    expected, force = motion.fine.position, motion.fine.contact_force
    assert np.abs(felt(system, mirrored.fine.position - expected)).max() < 1e-8 * np.ptp(expected)
    assert np.abs(mirrored.fine.contact_force + force).max() < 1e-8 * force.max()


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "meshes", "shafts"), [(0, 2, 0), (6, 3, 0), (3, 1, 2)])
def test_a_march_stays_within_it(seed, meshes, shafts):
    system, frequencies = drawn(seed, meshes, shafts)
    motion = harmonic_balance(system, frequencies)
    times = np.linspace(0.0, 40.0 / frequencies[0], 81)
    at = motion.at(times)
    begin = np.concatenate((at.position[0], at.velocity[0]))
    slope = plain_slope(system, frequencies)
    marched = solve_ivp(slope, times[[0, -1]], begin, "DOP853", times, rtol=1e-10, atol=1e-14)
    moved = felt(system, at.position)
    left = np.abs(felt(system, marched.y[: system.size].T) - moved).max()
    assert left < 1e-6 * np.linalg.norm(moved, axis=1).max()


@pytest.mark.slow
@pytest.mark.parametrize("points", [24, 48])
def test_of_flanks_that_separate(points):
    system, frequencies = drawn(5, 2)
    motion = harmonic_balance(system, frequencies, steps=points)
    assert np.mean(motion.fine.contact_force <= 0.0) > 0.1
    error = true_error(system, frequencies, motion, 96)
    assert error < 1.2 * motion.step_error
    assert motion.step_error < 4.0 * error


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "load"), [(106, 0.3), (301, 0.25)])
def test_an_automatic_choice_refines_flanks_that_separate(seed, load):
    system, frequencies = drawn(seed, 2, load=load)
    motion = harmonic_balance(system, frequencies)
    assert np.mean(motion.fine.contact_force <= 0.0) > 0.02
    assert motion.converged
    assert motion.step_error < 1e-3
    error = true_error(system, frequencies, motion, 144)
    assert error < 2.0 * motion.step_error
    assert motion.step_error < 3.0 * error
