"""Slow meshes whose jumps ring: points of their phases that reach the natural frequency."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tribodyn.dynamics import Contact, System, harmonic_balance
from tribodyn.dynamics.equations.phases import read_frequencies
from tribodyn.dynamics.harmonic.newton import solved
from tribodyn.dynamics.harmonic.phase_balance import _poor, _Search, phase_cost, work_of
from tribodyn.dynamics.harmonic.phase_grid import Work
from tribodyn.errors import ModelWarning

SLOW, FAST = 20.0, 311.7


def gears(phases, ramps=()):
    """A slow mesh whose stiffness jumps, and a fast one of constant stiffness."""
    slow, fast = ((1, 0), (0, 1)) if phases else (1, 1)
    first = Contact(
        [1.0, -1.0, 0.0], lambda x: np.where(np.asarray(x) % 1.0 < 0.6, 2.6e8, 1.8e8), 2000.0,
        cycles=slow, events=(0.0, 0.6), name="slow",
        ramp_stiffness=[1e7] * len(ramps), ramp_gap=ramps,
    )  # fmt: skip
    fewer = {"ramp_stiffness": [1e7] * len(ramps[1:]), "ramp_gap": ramps[1:]}
    second = Contact([0.0, 1.0, -1.0], 2.4e8, 2000.0, cycles=fast, name="fast", **fewer)
    # Natural frequencies of about 1.0 and 2.1 kHz are multiples 50 and 105 of the slow mesh.
    masses, ground = np.diag([8.0, 12.0, 3.0]), np.diag([0.0, 0.0, 2e8])
    return System(masses, np.diag([300.0] * 3), ground, [5e4, 0.0, 0.0], [first, second])


@cache
def over_phases(ramps=()):
    """Motion over the phases of both meshes; ramps of the slow one begin beyond its compression."""
    return harmonic_balance(gears(phases=True, ramps=ramps), (SLOW, FAST))


def test_ringing_of_a_slow_mesh_is_that_of_one_clock():
    clock = harmonic_balance(gears(phases=False), SLOW, steps=8192).fine
    response = over_phases()
    forces = response.fine.contact_force
    assert response.points[0] >= 4 * 48  # 24 points leave out the multiples that ring
    assert response.step_error < 1e-2
    for contact in (0, 1):
        one = clock.contact_force[:, contact]
        rms = np.sqrt(clock.mean((one - clock.mean(one)) ** 2))
        assert forces[:, contact].std() == pytest.approx(rms, rel=0.02)
        assert forces[:, contact].max() == pytest.approx(one.max(), rel=0.02)


@pytest.mark.parametrize("ramps", [(), (1.0, 2.0)])
def test_a_mesh_has_the_lines_of_another_that_its_grid_lacks(ramps):
    """The fast mesh is a spring and a damper, at the 50th multiple of the slow one too."""
    motion = over_phases(ramps)
    force, moved = (motion.lines(name) for name in ("contact_force", "position"))
    compression = moved.amplitude[:, 1] - moved.amplitude[:, 2]
    expected = (2.4e8 + 2j * np.pi * moved.frequency * 2000.0) * compression
    assert np.array_equal(force.numbers, moved.numbers)
    ringing = np.flatnonzero((force.numbers == (50, 0)).all(axis=1))
    assert abs(expected[ringing]) > 1.0  # N
    assert np.abs(force.amplitude[:, 1] - expected).max() < 1e-6 * np.abs(expected[1:]).max()


def test_the_warning_names_mesh_and_phase():
    with pytest.warns(
        ModelWarning, match=r"that of slow over the phase of its teeth \(20 Hz\), 16"
    ):
        harmonic_balance(gears(phases=True), (SLOW, FAST), steps=16)


def test_the_warning_names_the_shaft():
    """A turning error of three waves a turn needs more than six points."""
    sound = gears(phases=True)
    steady = (replace(each, stiffness=2e8, events=(0.0,)) for each in sound.contacts)
    first, second = (replace(each, cycles=(*each.cycles, 0)) for each in steady)
    turning = {"turning_error": lambda turn: 1e-5 * np.cos(6 * np.pi * turn)}
    second = replace(second, **turning, turning_cycles=(0, 0, 1))
    names = ("slow", "fast", "output shaft")
    system = replace(sound, contacts=[first, second], phase_names=names)
    with pytest.warns(ModelWarning, match=r"of fast over the phase of output shaft \(3 Hz\), 6"):
        harmonic_balance(system, (SLOW, FAST, 3.0), steps=(8, 8, 6))


def test_the_stated_error_counts_lines_that_ring_beyond_twice_the_points():
    exact = over_phases()
    with pytest.warns(ModelWarning, match="step-size"):
        few = harmonic_balance(gears(phases=True), (SLOW, FAST), steps=(24, 8))
    times = np.linspace(0.0, 10.0 / SLOW, 20_011)
    motions = [each.at(times).position[:, :2] @ [1.0, -1.0] for each in (exact, few)]
    change = np.abs(motions[1] - motions[0]).max() / np.abs(motions[0]).max()
    assert 0.2 < change < few.step_error < 1.5 * change


def test_grids_grow_beyond_the_usual_limit_only_where_a_mesh_rings():
    system = gears(phases=True)
    search = _Search.of(system, read_frequencies((SLOW, FAST), system.phases))
    points = ((256, 96), (256, 96))  # as many unknowns as forces that jump get
    errors = np.array([[0.1, 0.0], [0.0, 0.0]])
    twice, ahead = np.full((2, 2), 2), np.array([[8, 2], [2, 2]])
    assert not _poor(search.size, points, errors, twice, False).any()
    chosen = _poor(search.size, points, errors, ahead, False)
    assert chosen.tolist() == [[True, False], [False, False]]


def test_the_cost_of_a_mesh_that_rings_is_known_before():
    system = gears(phases=True)
    assert work_of(system, (SLOW, FAST)).kind == "ringing"
    assert work_of(system, (100 * SLOW, FAST)).kind == "broken"
    # The first grid of the slow mesh has 24 points, and the usual statement counts them twice.
    followers = [(1, (1, 0)), (1, (0, 1))]
    rings, jumps = (
        phase_cost(followers, (SLOW, FAST), work=Work(kind))[0] for kind in ("ringing", "broken")
    )
    assert 0.5 < (2 * rings / jumps) / (over_phases().points[0] / 24) < 2.0


def test_a_trial_has_the_changes_of_the_first_grids():
    system, frequency = gears(phases=True), (SLOW, FAST)
    search = _Search.of(system, read_frequencies(frequency, system.phases))
    residual = search.residual(((24, 12), (12, 24)))
    state = solved(residual, search.linear(residual), 1e-6).state
    every, none = np.ones((2, 2), dtype=bool), np.zeros((2, 2))
    errors, times = search.changes(((24, 12), (12, 24)), residual, state, every, none)
    found = work_of(system, frequency).changes
    assert [each[:2] for each in found] == [(f, g) for f in frequency for g in frequency]
    assert [each[2] for each in found] == pytest.approx(errors.reshape(-1), rel=1e-3, abs=1e-6)
    assert [each[3] for each in found] == times.reshape(-1).tolist() == [8, 2, 2, 2]
    change, small = found[0][2], found[3][2]
    assert small < 1e-6 * change
