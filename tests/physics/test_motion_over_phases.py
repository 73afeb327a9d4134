"""Motion over independent phases: against one clock, a march over time, and printed figures."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.known_systems import plain_slope

from tribodyn.dynamics import (
    Contact,
    LoadFriction,
    Response,
    System,
    harmonic_balance,
    simulate,
)
from tribodyn.dynamics.harmonic.phase_balance import _Search
from tribodyn.dynamics.harmonic.phase_rows import PhaseRows
from tribodyn.errors import InputError, ModelWarning


def wave(*terms):
    """Sum of cosines of the mesh phase, each an amplitude and an angle."""
    return lambda x: sum(a * np.cos(2 * pi * n * x + b) for n, (a, b) in enumerate(terms, 1))


BASE = np.array([0.0311, 0.0698, 0.0405, 0.0992, 0.0432, 0.1259])
FREQUENCIES = 1430.0 * np.array([1.0, 29 / 83, 29 / 83 * 23 / 71])


def three_meshes():
    """Three spur meshes in a row: rotation times base radius and shift of each of six gears."""
    inertia = np.array([0.0006, 0.011, 0.0011, 0.033, 0.0019, 0.08])
    body = np.array([1.9, 8, 2.6, 14, 3.5, 21])
    support = np.array([1.7, 2.4, 2.0, 2.9, 2.6, 3.6]) * 1e8
    mass = np.diag(np.stack((inertia / BASE**2, body), axis=1).ravel())
    stiffness, damping = np.zeros((2, 12, 12))
    shift = np.arange(1, 12, 2)
    stiffness[shift, shift] = support
    damping[shift, shift] = 2 * 0.03 * np.sqrt(support * body)
    for first, k, c in ((1, 2.4e5, 12), (3, 4.1e5, 25)):
        twist = np.zeros(12)
        twist[2 * first], twist[2 * first + 2] = 1 / BASE[first], -1 / BASE[first + 1]
        stiffness += k * np.outer(twist, twist)
        damping += c * np.outer(twist, twist)
    force = np.zeros(12)
    force[0] = 60 / BASE[0]
    force[10] = -force[0] * BASE[1] / BASE[2] * BASE[3] / BASE[4]
    laws = (
        (2.6e8, ((0.2, 0.9), (0.07, 0.1), (0.02, 2.0)), 900, ((3, 0),), 35, 0.15),
        (3.3e8, ((0.09, -0.7), (0.05, 0.3)), 1400, ((5, 0.8), (2, -0.4)), 45, 0.72),
        (4.1e8, ((0.14, 0.2), (0.03, 1.0)), 1900, ((7, -1.1),), 50, 0.40),
    )
    contacts = []
    for number, (k, terms, c, errors, gap, offset) in enumerate(laws):
        direction = np.zeros(12)
        direction[4 * number : 4 * number + 4] = 1, 1, -1, -1
        cycles = tuple(int(axis == number) for axis in range(3))
        law, error = wave(*terms), wave(*errors)
        contacts.append(
            Contact(
                direction, lambda x, k=k, law=law: k * (1 + law(x)), c,
                lambda x, error=error: 1e-6 * error(x), gap * 1e-6, cycles=cycles, offset=offset,
            )
        )  # fmt: skip
    return System(mass, damping, stiffness, force, contacts)


@pytest.fixture(scope="module")
def three():
    return harmonic_balance(three_meshes(), FREQUENCIES)


def test_three_meshes_have_the_forces_of_an_independent_solution(three):
    force = three.fine.contact_force
    mean = three.fine.mean(force)
    assert mean == pytest.approx([1929.2604502, 3324.9970227, 7635.1783486], rel=1e-9)
    rms = np.sqrt(three.fine.mean((force - mean) ** 2))
    assert rms == pytest.approx([354.8064884, 588.1488718, 877.8570914], rel=1e-8)
    assert three.step_error < 2e-7
    torque = BASE[1] / BASE[2], BASE[3] / BASE[4]  # each shaft is in equilibrium on average
    assert mean == pytest.approx(60 / BASE[0] * np.cumprod([1.0, *torque]), rel=1e-9)


def test_a_march_that_starts_on_the_motion_stays_on_it(three):
    system = three_meshes()
    contacts, matrices = system.contacts, (system.stiffness, system.damping)
    rows = np.array([contact.direction for contact in contacts])

    def law(time, q, v):
        x = (FREQUENCIES * time + [c.offset for c in contacts]) % 1.0
        k, e = (np.array([getattr(c, name)(p) for c, p in zip(contacts, x, strict=True)])
                for name in ("stiffness", "error"))  # fmt: skip
        step = 1e-5
        ahead = np.array([c.error(p + step) - c.error(p - step)
                          for c, p in zip(contacts, x, strict=True)])  # fmt: skip
        d, rate = rows @ q - e, rows @ v - FREQUENCIES * ahead / (2 * step)
        gap = np.array([c.gap for c in contacts])
        return k * (d - gap) + np.array([c.damping for c in contacts]) * rate  # stays closed

    def slope(time, state):
        q, v = np.split(state, 2)
        force = system.force - matrices[0] @ q - matrices[1] @ v - rows.T @ law(time, q, v)
        return np.concatenate((v, np.linalg.solve(system.mass, force)))

    start = three.at([0.0])
    begin = np.concatenate((start.position[0], start.velocity[0]))
    times = np.linspace(0.0, 12 / FREQUENCIES[0], 25)
    marched = solve_ivp(slope, times[[0, -1]], begin, "DOP853", times, rtol=1e-10, atol=1e-14)
    at = three.at(times)
    assert np.abs(marched.y[:12].T - at.position).max() < 1e-6 * np.ptp(at.deflection)
    force = np.array([law(t, *np.split(y, 2)) for t, y in zip(times, marched.y.T, strict=True)])
    assert at.contact_force == pytest.approx(force, rel=1e-6)


def test_lines_are_those_of_whole_numbers_and_add_up_to_the_motion(three):
    lines = three.lines()
    assert lines.frequency == pytest.approx(lines.numbers @ FREQUENCIES, rel=1e-14, abs=1e-9)
    assert lines.frequency.min() == 0.0
    assert len({tuple(numbers) for numbers in lines.numbers}) == len(lines.numbers)
    times = np.array([0.0, 0.0123, 4.56])
    turns = np.exp(2j * pi * times[:, None] * lines.frequency)
    assert (turns @ lines.amplitude).real == pytest.approx(three.at(times).contact_force, rel=1e-6)


def step_law(x):
    return 1.0 + 0.3 * ((x >= 0.2) & (x < 0.65))


def two_meshes(cycles, *, gap=0.0, jumps=False, friction=False, amplitude=0.2):
    """Three bodies between two contacts, on one clock or on two phases."""
    first = Contact(
        [1.0, -1.0, 0.0],
        (lambda x: 3.0 * step_law(x)) if jumps else (lambda x: 3 + 0.9 * np.cos(2 * pi * x)),
        0.03, lambda x: amplitude * np.cos(2 * pi * x), gap,
        (lambda x: np.outer(np.sin(2 * pi * x), [0.05, 0.0, 0.02])) if friction else None,
        events=(0.0, 0.2, 0.65) if jumps else (0.0,), cycles=cycles[0], offset=0.15,
    )  # fmt: skip
    second = Contact(
        [0.0, 1.0, -1.0], lambda x: 4 + 0.8 * np.sin(2 * pi * x), 0.03,
        lambda x: 0.7 * amplitude * np.cos(4 * pi * x + 1), gap, cycles=cycles[1], offset=0.4,
    )  # fmt: skip
    rubbing = LoadFriction(
        [0.3, 0.0, -0.2], lambda x: np.stack((0.05 * np.sin(2 * pi * x), 0.01 + 0 * x), 1), 1.0,
        (1,), limit=100.0,
    )  # fmt: skip
    stiffness = np.array([[0.6, -0.3, 0.0], [-0.3, 0.8, -0.2], [0.0, -0.2, 0.5]])
    mass = np.diag([1.0, 0.6, 1.4])
    return System(
        mass, 0.05 * stiffness + 0.02 * mass, stiffness, [2.0, 0.3, -1.5], [first, second],
        frictions=[rubbing] if friction else [],
    )  # fmt: skip


@pytest.mark.parametrize(
    ("options", "accuracy"),
    [
        ({}, 1e-7),
        ({"friction": True, "amplitude": 0.02}, 1e-6),
        ({"jumps": True, "amplitude": 0.02}, 1e-4),
    ],
)
def test_two_phases_give_the_motion_of_a_common_period(options, accuracy):
    clock = harmonic_balance(two_meshes((5, 3), **options), 0.05)
    phases = harmonic_balance(two_meshes(((1, 0), (0, 1)), **options), (0.25, 0.15), steps=96)
    assert phases.converged
    at = phases.at(clock.time)
    for name in ("position", "contact_force"):
        expected = getattr(clock, name)
        assert np.abs(getattr(at, name) - expected).max() < accuracy * np.abs(expected).max()


@pytest.mark.parametrize(
    ("options", "points", "fine"),
    [
        ({}, 10, 48),
        ({"friction": True, "amplitude": 0.02}, (12, 8), 64),
        ({"jumps": True, "amplitude": 0.02}, 16, 96),
        ({"gap": 0.1, "amplitude": 0.12}, 24, 96),
    ],
)
def test_the_stated_error_is_that_against_a_fine_solution(options, points, fine):
    system, frequencies = two_meshes(((1, 0), (0, 1)), **options), (0.25, 0.11 * np.sqrt(2))
    coarse, exact = (harmonic_balance(system, frequencies, steps=n) for n in (points, fine))
    times = np.random.default_rng(1).uniform(0.0, 1e3, 500)
    at, expected = coarse.at(times).deflection, exact.at(times).deflection
    error = np.abs(at - expected).max() / np.abs(expected).max()
    assert error / 3.0 < coarse.step_error < 3.0 * error


@pytest.mark.filterwarnings("ignore:.*step-size")
@pytest.mark.slow
def test_flanks_that_separate_are_solved_with_second_order():
    with pytest.warns(ModelWarning, match="unstable-orbit"):
        clock = harmonic_balance(two_meshes((5, 3), gap=0.1, amplitude=0.12), 0.05)
    system, errors = two_meshes(((1, 0), (0, 1)), gap=0.1, amplitude=0.12), []
    for points in (24, 48, 96):
        phases = harmonic_balance(system, (0.25, 0.15), steps=points)
        assert phases.converged
        assert 0.03 < np.mean(phases.fine.contact_force == 0.0) < 0.06
        at = phases.at(clock.time)
        errors.append(np.sqrt(np.mean((at.position - clock.position) ** 2)))
    assert errors[2] < 1e-3 * np.abs(clock.position).max()
    assert errors[0] / errors[2] > 8.0  # two halvings; 16 for an even second order


@pytest.mark.parametrize(
    "options", [{"jumps": True, "amplitude": 0.02}, {"gap": 0.1, "amplitude": 0.12}]
)
def test_forces_that_break_are_in_balance_on_average(options):
    system = two_meshes(((1, 0), (0, 1)), **options)
    motion = harmonic_balance(system, (0.25, 0.11 * np.sqrt(2)), steps=(24, 12))
    rows = np.array([contact.direction for contact in system.contacts])
    position, force = (
        motion.lines(name).amplitude[0].real for name in ("position", "contact_force")
    )
    balance = system.force - system.stiffness @ position - force @ rows
    assert np.abs(balance).max() < 1e-9


def test_a_mesh_that_jumps_needs_points_over_its_own_phase_alone():
    """A march that ends its steps at the jumps stays on the motion, with second order."""
    system, frequencies = two_meshes(((1, 0), (0, 1)), jumps=True, amplitude=0.02), (0.25, 0.11)
    jumps = np.add.outer(np.arange(4), [0.2, 0.65]) - 0.15
    times = np.unique(np.concatenate(([0.0, 12.0], jumps.ravel() / frequencies[0])))
    times, slope = times[times <= 12.0], plain_slope(system, np.array(frequencies))
    errors = []
    for points in (24, 96, 192):
        motion = harmonic_balance(system, frequencies, steps=(points, 24))
        at = motion.at(times)
        states = [np.concatenate((at.position[0], at.velocity[0]))]
        for begin, end in pairwise(times):
            ends, last = (begin + 1e-12, end - 1e-12), states[-1]
            marched = solve_ivp(slope, ends, last, "DOP853", rtol=1e-9, atol=1e-12)
            states.append(marched.y[:, -1])
        error = np.abs(np.array(states)[:, :3] - at.position).max()
        errors.append(error / np.abs(at.deflection).max())
        assert errors[-1] / 3.0 < motion.step_error < 4.0 * errors[-1]
    assert errors[-1] < 2e-5
    assert errors[0] / errors[-1] > 10.0  # 64 for an even second order


def test_eccentric_gears_turn_with_their_shafts():
    teeth, frequency, amplitudes = (3, 4), 1200.0, (3e-6, 8e-6)
    mass, stiffness = np.diag([1.2, 2.5, 0.8, 1.7]), np.diag([0.0, 2e8, 0.0, 3e8])
    law, error = wave((0.15, 0.0), (0.05, 1.0)), wave((2e-6, 0.4))
    runs_out = [lambda x, a=a: a * np.cos(2 * pi * x + 0.3) for a in amplitudes]
    contact = Contact(
        [1.0, 1.0, -1.0, -1.0], lambda x: 3e8 * (1 + law(x)), 800.0, error, 20e-6,
        cycles=(1, 0, 0), offset=0.2, turning_error=runs_out,
        turning_cycles=[(0, 1, 0), (0, 0, 1)],
    )  # fmt: skip
    system = System(
        mass, np.diag([20.0, 1500.0, 20.0, 2000.0]), stiffness, [3e3, 0, -3e3, 0], [contact]
    )
    shafts = harmonic_balance(system, (frequency, frequency / teeth[0], frequency / teeth[1]))
    whole = replace(
        contact, cycles=1, offset=0.0, turning_error=(), turning_cycles=(),
        stiffness=lambda x: contact.stiffness((12 * x + 0.2) % 1),
        error=lambda x: error(12 * x + 0.2) + runs_out[0](4 * x) + runs_out[1](3 * x),
    )  # fmt: skip
    clock = harmonic_balance(replace(system, contacts=[whole]), frequency / 12)
    at = shafts.at(clock.time)
    assert at.contact_force == pytest.approx(clock.contact_force, rel=1e-7)
    # On one clock the run-outs are a part of the error, and the motion is an ordinary one.
    turned = replace(contact, cycles=12, turning_cycles=[(4,), (3,)])
    common = replace(system, contacts=[turned])
    motion = harmonic_balance(common, frequency / 12)
    assert type(motion) is Response
    assert shafts.at(motion.time).contact_force == pytest.approx(motion.contact_force, rel=1e-7)
    start = motion.position[0], motion.velocity[0]
    marched = simulate(common, frequency / 12, 1, start, steps=12 * 256)
    assert marched.position[-1] == pytest.approx(motion.position[0], rel=1e-3)
    # Alone, the wheel's run-out is a line of one cycle of its shaft.
    lines = shafts.lines("deflection")
    strongest = np.abs(lines.amplitude[:, 0]) * (np.abs(lines.numbers).sum(axis=1) == 1)
    named = [tuple(n) for n in lines.numbers[np.argsort(-strongest)[:3]]]
    assert (0, 0, 1) in named


def test_a_sweep_continues_from_the_last_motion():
    system = two_meshes(((1, 0), (0, 1)))
    first = harmonic_balance(system, (0.25, 0.15))
    again = harmonic_balance(system, (0.2501, 0.15 * np.sqrt(1.001)), start=first)
    alone = harmonic_balance(system, (0.2501, 0.15 * np.sqrt(1.001)))
    at = np.linspace(0.0, 30.0, 50)
    assert again.at(at).position == pytest.approx(alone.at(at).position, rel=1e-7, abs=1e-9)


def test_what_needs_one_clock_refuses_phases():
    system = two_meshes(((1, 0), (0, 1)))
    with pytest.raises(InputError, match="2 phases without a common clock"):
        simulate(system, 0.2, 3, start=([0.0] * 3, [0.0] * 3))
    with pytest.raises(InputError, match="2 independent phases"):
        harmonic_balance(system, 0.2)
    with pytest.raises(InputError, match="no multipliers"):
        harmonic_balance(system, (0.2, 0.3), stability=True)
    with pytest.raises(InputError, match="same phases"):
        replace(system, contacts=[system.contacts[0], replace(system.contacts[1], cycles=2)])
    with pytest.raises(InputError, match="at least one phase"):
        replace(system.contacts[0], cycles=(0, 0))
    with pytest.raises(InputError, match="1 turning errors and 0 turning cycles"):
        replace(system.contacts[0], turning_error=np.cos)


def test_wrong_input_over_phases_is_named():
    system = two_meshes(((1, 0), (0, 1)))
    with pytest.raises(InputError, match=r"1000000 x 1000000 points .* GB; this machine has"):
        harmonic_balance(system, (0.25, 0.15), steps=10**6)
    with pytest.raises(InputError, match="function of the phase of a shaft"):
        replace(system.contacts[0], turning_error=3e-6, turning_cycles=(0, 1))
    motion = harmonic_balance(system, (0.25, 0.15), steps=24)
    assert motion.at([]).position.shape == (0, 3)
    with pytest.raises(InputError, match="time = nan"):
        motion.at([0.0, np.nan])
    with pytest.raises(InputError, match="has 2e\\+06 cycles in one of the slowest"):
        harmonic_balance(system, (0.2, 1e-7))
    with pytest.raises(InputError, match="start is no motion over these phases"):
        harmonic_balance(three_meshes(), FREQUENCIES, start=motion)


@pytest.mark.parametrize("numbers", [(20, 1), (7, 5)])
def test_a_mesh_with_many_cycles_over_its_phase_moves_as_with_one(numbers):
    """Meshes that do not follow this phase feel all of its cycles."""
    system, cycles = two_meshes(((1, 0), (0, 1))), np.diag(numbers)
    contacts = [
        replace(contact, cycles=tuple(each))
        for contact, each in zip(system.contacts, cycles.tolist(), strict=True)
    ]
    frequencies, at = np.array([0.25, 0.15]), np.linspace(0.0, 40.0, 60)
    once = harmonic_balance(system, frequencies).at(at)
    often = harmonic_balance(replace(system, contacts=contacts), frequencies / numbers).at(at)
    assert np.abs(often.position - once.position).max() < 1e-6 * np.ptp(once.position)


def test_a_mesh_whose_phase_runs_back_is_the_mirrored_one():
    system = two_meshes((1, 2))
    first = system.contacts[0]
    back = replace(
        first, cycles=(-1,), offset=1.0 - first.offset, stiffness=lambda x: first.stiffness(1 - x),
        error=lambda x: first.error(1 - x),
    )  # fmt: skip
    clock = harmonic_balance(system, 0.2)
    motion = harmonic_balance(replace(system, contacts=[back, system.contacts[1]]), 0.2)
    moved = motion.at(clock.time).position
    assert np.abs(moved - clock.position).max() < 1e-6 * np.ptp(clock.position)


def test_an_entry_that_is_zero_where_a_cycle_begins_does_not_jump():
    contact = replace(two_meshes((1, 1)).contacts[0], error=lambda x: np.sin(2 * pi * x))
    system = two_meshes(((1, 0), (0, 1)))
    system = replace(system, contacts=[replace(contact, cycles=(1, 0)), system.contacts[1]])
    rows = PhaseRows.of(system, np.array([0.25, 0.15]))
    assert not any(mesh.jumps.size for mesh in rows.meshes)


def test_a_tuple_of_one_number_is_the_clock():
    contact = two_meshes((5, 3)).contacts[0]
    assert replace(contact, cycles=(5,)).cycles == 5


@pytest.mark.slow
@pytest.mark.parametrize("count", [4, 5])
def test_many_phases_have_the_mean_forces_of_equilibrium(count):
    """Gears in a row on one base radius each; shafts between the meshes."""
    size, stiffness, damping = 2 * count, *np.zeros((2, 2 * count, 2 * count))
    ratios = np.linspace(0.8, 1.3, count - 1)
    for number, ratio in enumerate(ratios):
        twist = np.zeros(size)
        twist[2 * number + 1], twist[2 * number + 2] = 1.0, -ratio
        stiffness += 4e7 * np.outer(twist, twist)
        damping += 2e3 * np.outer(twist, twist)
    force = np.zeros(size)
    force[0], force[-1] = 3e3, -3e3 * np.prod(ratios)
    means = 3e3 * np.cumprod([1.0, *ratios])
    contacts = []
    for number in range(count):
        direction = np.zeros(size)
        direction[2 * number : 2 * number + 2] = 1.0, -1.0
        law, error = wave((0.15, number), (0.04, 1.0)), wave((2e-6, 0.7 * number))
        cycles = tuple(int(axis == number) for axis in range(count))
        contacts.append(
            Contact(
                direction, lambda x, law=law: 3e8 * (1 + law(x)), 2e3, error, 30e-6, cycles=cycles
            )
        )
    mass = np.diag(np.linspace(0.8, 6.0, size))
    system = System(mass, damping, stiffness, force, contacts)
    frequencies = 1400.0 * 0.43 ** np.arange(count)
    motion = harmonic_balance(system, frequencies)
    assert motion.converged
    assert motion.step_error < 1e-2
    assert motion.fine.mean(motion.fine.contact_force) == pytest.approx(means, rel=1e-8)
    lines = motion.lines()
    assert lines.frequency == pytest.approx(lines.numbers @ frequencies, rel=1e-12, abs=1e-9)


def test_the_residual_of_a_search_has_no_step_where_a_motion_begins_to_reach_a_ramp():
    """Otherwise Newton's method may go to and fro between two solutions of coarse grids."""
    system = two_meshes(((1, 0), (0, 1)), amplitude=0.0)
    first = replace(
        system.contacts[0], ramp_stiffness=[0.3], ramp_gap=[0.7],
        stiffness=lambda x: 3.0 + np.tanh(6.0 * np.sin(2 * pi * x)),
    )  # fmt: skip
    search = _Search.of(replace(system, contacts=[first, system.contacts[1]]), np.array([0.3, 0.5]))
    residual = search.residual(((12, 12), (12, 12)))
    y = search.linear(residual)
    along = residual.parts[0].contacts.rows.along[:, 0]
    reaches = np.einsum("pr,pr->p", residual.split(y)[0], along).max()
    states = [residual.at(y * 0.7 / reaches * (1.0 + part)) for part in (1e-6, -1e-6)]
    assert states[1].residual == pytest.approx(states[0].residual, abs=1e-5 * states[0].size)
