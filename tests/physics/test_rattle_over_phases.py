"""Motion over phases whose flanks separate so much that it has no lines: a march over time."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tribodyn.dynamics import Contact, System, harmonic_balance
from tribodyn.dynamics.harmonic.phase_grid import Follower
from tribodyn.dynamics.harmonic.phase_response import cycles_of_march
from tribodyn.errors import InputError

pytestmark = pytest.mark.slow
FREQUENCIES = np.array([0.25, 0.11 * np.sqrt(2.0)])
LOAD = 0.02


def rattling(load=LOAD):
    """Three free bodies in a row, pressed together less than their teeth need to touch."""
    gap = 0.1
    first = Contact(
        [1.0, -1.0, 0.0], lambda x: 3 + 0.9 * np.cos(2 * pi * x), 0.06,
        lambda x: 0.08 * np.cos(2 * pi * x), gap, cycles=(1, 0), offset=0.15, name="mesh fast",
    )  # fmt: skip
    second = Contact(
        [0.0, 1.0, -1.0], lambda x: 4 + 0.8 * np.sin(2 * pi * x), 0.06,
        lambda x: 0.05 * np.cos(2 * pi * x + 1), gap, cycles=(0, 1), offset=0.4, name="mesh slow",
    )  # fmt: skip
    mass, none = np.diag([1.0, 0.6, 1.4]), np.zeros((3, 3))
    return System(mass, none, none, [load, 0.0, -load], [first, second])


@pytest.fixture(scope="module")
def rattle():
    with pytest.warns(match="time integration over") as caught:
        motion = harmonic_balance(rattling(), FREQUENCIES, steps=16)
    return motion, str(caught[0].message)


def test_the_message_names_mesh_frequency_and_cycles(rattle):
    motion, message = rattle
    cycles = motion.turns[1]
    assert f"time integration over {cycles} cycles of mesh slow" in message
    assert "that of mesh" in message
    assert " Hz" in message
    assert not motion.converged
    assert motion.engine == "modal"
    assert cycles > 100


def test_the_cycles_that_are_integrated_are_known_before(rattle):
    motion, _ = rattle
    followers = [Follower(1, each.cycles) for each in motion._rows.system.contacts]
    decay = motion._march.structure.decay
    cycles = cycles_of_march(followers, FREQUENCIES, decay)
    assert motion.fine.time[-1] * FREQUENCIES[0] == pytest.approx(cycles, rel=1e-2)
    assert len(motion._march.begins) - 1 == pytest.approx(cycles / 16, abs=1.0)
    twice = [follower._replace(period=2) for follower in followers]
    assert cycles_of_march(twice, FREQUENCIES, decay) == 2.0 * cycles


def test_statistics_are_those_of_the_march(rattle):
    motion, _ = rattle
    fine = motion.fine
    assert np.ptp(fine.time) * FREQUENCIES == pytest.approx(motion.turns, rel=1e-2)
    assert 0.1 < np.mean(fine.contact_force <= 0.0) < 0.9
    # Bodies that stay together are pushed by the load on average.
    assert fine.mean(fine.contact_force) == pytest.approx([LOAD, LOAD], rel=2e-2)
    lines = motion.lines()
    assert lines.frequency == pytest.approx(lines.numbers @ FREQUENCIES, rel=1e-12, abs=1e-12)
    assert lines.amplitude[0].real == pytest.approx(fine.mean(fine.contact_force), rel=1e-12)


def test_the_march_is_that_of_another_integrator(rattle):
    motion, _ = rattle
    system = rattling()
    rows = np.array([contact.direction for contact in system.contacts])

    def force(time, q, v):
        total = []
        for row, f, contact in zip(rows, FREQUENCIES, system.contacts, strict=True):
            x = (f * time + contact.offset) % 1.0
            slope = (contact.error(x + 1e-6) - contact.error(x - 1e-6)) / 2e-6
            d, rate = row @ q - contact.error(x), row @ v - f * slope
            spring = contact.stiffness(x) * (d - np.sign(d) * contact.gap)
            touching = abs(d) > contact.gap
            total.append(spring + contact.damping * rate if touching else 0.0)
        return np.array(total)

    def slope(time, state):
        q, v = np.split(state, 2)
        return np.concatenate((v, (system.force - force(time, q, v) @ rows) / np.diag(system.mass)))

    start = motion.at([1.0])
    begin = np.concatenate((start.position[0], start.velocity[0]))
    times = np.linspace(1.0, 21.0, 81)  # few cycles: a rattle forgets where it began
    marched = solve_ivp(
        slope, (1.0, 21.0), begin, "DOP853", times, rtol=1e-9, atol=1e-12, max_step=0.02
    )
    at = motion.at(times)
    assert np.any(at.contact_force == 0.0)
    assert np.abs(marched.y[:3].T - at.position).max() < 1e-4 * np.ptp(at.deflection)
    with pytest.raises(InputError, match="time"):
        motion.at([-1.0])


def test_more_load_gives_lines_from_the_same_system():
    motion = harmonic_balance(rattling(load=1.2), FREQUENCIES)
    assert motion.converged
    assert motion.fine.mean(motion.fine.contact_force) == pytest.approx([1.2, 1.2], rel=1e-4)
