"""Adaptive steps: closed forms, error against tolerance, dense output, lanes, plain version."""

import math

import numpy as np
import pytest
from scipy.interpolate import BarycentricInterpolator

from known_marches import march_adaptive, march_one
from known_systems import EVENTS, MESH_FREQUENCY, hysteresis_system, reference_system
from plain.dormand_prince import step_plain
from tribodyn.dynamics import Contact, System, energy_audit, simulate, solve_adaptive
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics._engine.dormand_prince import MATRIX, NODES, WEIGHT_ERROR
from tribodyn.dynamics._engine.row_table import POINTS, _powers, build_table
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.errors import ComputationError, InputError

GRID = 32


def swinging(time, *, damping=0.1, stiffness=4.0, force=1.0, start=1.0):
    """Closed form of x'' + c x' + k x = f from rest at ``start``."""
    rate = 0.5 * damping
    turn = math.sqrt(stiffness - rate**2)
    off, fade = start - force / stiffness, np.exp(-rate * time)
    position = force / stiffness + fade * off * (
        np.cos(turn * time) + rate / turn * np.sin(turn * time)
    )
    return np.stack((position, -fade * off * stiffness / turn * np.sin(turn * time)), axis=-1)


OSCILLATOR = System([[1.0]], [[0.1]], [[4.0]], [1.0])


def light_system():
    """Six coordinates under light load near a resonance: the flanks part all the time."""
    return reference_system(0.1, gap=2e-5, damping=300.0)


def _light_start():
    return 2e-5 * np.random.default_rng(3).standard_normal(12)


CASES = {
    "friction": (
        reference_system(0.1),
        MESH_FREQUENCY,
        2,
        np.append(np.array([0.0, -7e-7, 4e-4, 0.0, 7e-7, 0.0]), np.zeros(6)),
        65536,
    ),
    "hysteresis": (hysteresis_system(), 0.88 / (2.0 * math.pi), 6, np.array([1.5, 0.8]), 4096),
    "light": (light_system(), 2600.0, 10, _light_start(), 8192),
}


def adaptive(case, rtol, steps=GRID):
    system, frequency, cycles, start, _ = CASES[case]
    record = np.empty((cycles * steps + 1, 2 * system.size, 1))
    compiled = compile_for(system, frequency, CASES[case][4])
    coarse = compiled.grid.left[_shared(compiled, steps)]
    _, _, crossings = march_one(
        system, frequency, start, cycles, rtol=rtol, points=coarse, record=record
    )
    return record[:, :, 0], crossings


def _shared(compiled, steps):
    return np.arange(0, compiled.grid.steps, compiled.grid.steps // steps)


@pytest.fixture(scope="module")
def fine():
    """Runge-Kutta with very short steps, at the same mesh phases."""
    records = {}
    for name, (system, frequency, cycles, start, steps) in CASES.items():
        compiled = compile_for(system, frequency, steps)
        record = np.empty((cycles * steps + 1, 2 * system.size, 1))
        march(compiled, np.array([1.0 / frequency]), start[None], cycles, record=record)
        index = (_shared(compiled, GRID) + steps * np.arange(cycles)[:, None]).ravel()
        records[name] = record[np.append(index, cycles * steps), :, 0]
    return records


def test_coefficients_satisfy_the_order_conditions():
    assert MATRIX.sum(axis=1) == pytest.approx(NODES, abs=1e-14)
    weights = np.append(MATRIX[6], 0.0)
    for power in range(5):
        assert weights @ NODES**power == pytest.approx(1.0 / (power + 1.0), abs=1e-14)
    for power in range(4):
        assert WEIGHT_ERROR @ NODES**power == pytest.approx(0.0, abs=1e-14)
    assert abs(WEIGHT_ERROR @ NODES**4) > 1e-4


@pytest.mark.parametrize("rtol", [1e-5, 1e-7, 1e-10])
def test_closed_form(rtol):
    motion = solve_adaptive(OSCILLATOR, 1.0, 20, ([1.0], [0.0]), rtol=rtol)
    time = np.linspace(0.0, 20.0, 301)
    exact = swinging(time)
    error = np.abs(motion(time) - exact).max(axis=0) / np.abs(exact).max(axis=0)
    assert error.max() < rtol
    assert error.max() > 1e-3 * rtol


def test_errors_do_not_add_up_over_a_hundred_undamped_periods():
    free = System([[1.0]], [[0.0]], [[400.0]], [0.0])
    motion = solve_adaptive(free, 1.0, 30, ([1.0], [0.0]), rtol=1e-7)
    time = np.linspace(0.0, 30.0, 400)
    assert np.abs(motion(time)[:, 0] - np.cos(20.0 * time)).max() < 1e-7


@pytest.mark.parametrize("rtol", [1e-5, 1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("case", CASES)
def test_error_stays_within_the_tolerance(case, rtol, fine):
    states, crossings = adaptive(case, rtol)
    size = np.abs(fine[case]).max(axis=0)
    assert (np.abs(states - fine[case]).max(axis=0) / size).max() < 1.5 * rtol
    assert (crossings > 0) == (case != "friction")


def row_at(table, phase, segment):
    """Varying factors at one mesh phase, in plain NumPy."""
    low, high = table.events[segment : segment + 2]
    powers = table.powers[slice(*table.first[segment : segment + 2])]
    place = (phase - low) / (high - low) * len(powers)
    interval = min(int(place), len(powers) - 1)
    return np.polyval(powers[interval], place - interval)


def test_polynomials_of_a_table_are_those_through_its_nodes():
    generator = np.random.default_rng(4)
    for steps in (1, 2, 3, 7):
        rows = generator.normal(size=(steps, 3, 2))
        rows[1:, 0] = rows[:-1, 2]
        nodes = np.concatenate((rows[:, :2].reshape(-1, 2), rows[-1:, 2]))
        powers = _powers(rows, np.array([0, steps]))
        for place in (0.0, 0.3, 0.8 * steps, 1.7 * steps, 2.0 * steps):
            interval = min(int(place), 2 * steps - 1)
            start = min(max(interval - 2, 0), max(len(nodes) - POINTS, 0))
            near = slice(start, start + POINTS)
            lagrange = BarycentricInterpolator(np.arange(len(nodes))[near], nodes[near], rng=0)
            value = np.polyval(powers[interval], place - interval)
            assert value == pytest.approx(lagrange(place), abs=1e-12)


def test_table_meets_the_entries_and_takes_sides_at_events():
    system = reference_system(0.1)
    table = build_table(system, 1e-10)
    assert table.error < 1e-12
    segment = int(np.flatnonzero(table.events == EVENTS[2])[0])
    before, after = (row_at(table, EVENTS[2], segment - 1 + side)[0] for side in (0, 1))
    assert before == pytest.approx(4e8, rel=1e-12)
    assert after == pytest.approx(2e8, rel=1e-12)
    wave = Contact([1.0], stiffness=lambda phase: 2.0 + np.sin(40 * np.pi * phase) ** 3)
    table = build_table(System([[1.0]], [[0.0]], [[0.0]], [0.0], [wave]), 1e-10)
    assert table.error < 1e-12
    for phase in (0.013, 0.5, 0.777):
        truth = 2.0 + np.sin(40 * np.pi * phase) ** 3
        assert row_at(table, phase, 0)[0] == pytest.approx(truth, rel=2e-11)


@pytest.mark.parametrize(("count", "rtol"), [(24, 1e-8), (24, 1e-6), (37, 1e-6)])
def test_a_table_with_grid_points_meets_the_tolerance(count, rtol):
    knots = np.linspace(0.0, 1.0, count)

    def polygon(phase):
        return np.interp(phase, knots, 1.0 + 0.3 * np.cos(2 * np.pi * knots))

    declared = tuple(knots[:-1])
    systems = [
        System([[1.0]], [[0.1]], [[0.0]], [0.5], [Contact([1.0], stiffness=polygon, events=events)])
        for events in ((0.0,), declared)
    ]
    smooth, tabulated = (solve_adaptive(s, 0.2, 4, ([0.5], [0.0]), rtol=rtol) for s in systems)
    time = np.linspace(0.0, 20.0, 50)
    assert np.abs(smooth(time) - tabulated(time)).max() < rtol


def test_order_of_the_dense_output():
    """The error between ends of steps falls with the fifth power of the step."""
    errors = []
    for rtol in (1e-5, 1e-8):
        motion = solve_adaptive(OSCILLATOR, 1.0, 6, ([1.0], [0.0]), rtol=rtol)
        inside = 0.5 * (motion.time[1:] + motion.time[:-1])
        at_ends = np.abs(motion.state - swinging(motion.time)).max()
        between = np.abs(motion(inside) - swinging(inside)).max()
        assert between < 2.0 * at_ends
        errors.append((between, motion.steps))
    order = math.log(errors[0][0] / errors[1][0]) / math.log(errors[1][1] / errors[0][1])
    assert order > 4.5


def test_step_equals_the_plain_one():
    system = light_system()
    start, side, width = _light_start(), np.ones(1), 0.02
    start[2] = 4e-3  # the flanks are pressed together, and stay so
    plain = step_plain(system, 2600.0, 0.02, width, start, side)
    half = step_plain(system, 2600.0, 0.02, width / 2, start, side)
    assert np.abs(plain.middle - half.state).max() < 40.0 * np.abs(half.error).max()
    shifted = _later(system, 0.02)
    motion = solve_adaptive(shifted, 2600.0, 1, (start[:6], start[6:]), rtol=1e-3, atol=1e30)
    first = motion.phase[1]
    again = step_plain(system, 2600.0, 0.02, first, start, side)
    scale = np.abs(again.state)
    assert (np.abs(motion.state[1] - again.state) / scale).max() < 1e-11
    assert (np.abs(motion(motion.time[1] / 2) - again.middle) / scale).max() < 1e-10


def _later(system, phase):
    """The same system with the mesh cycle counted from a later phase."""
    contact = system.contacts[0]

    def turned(entry):
        return lambda place: entry((place + phase) % 1.0)

    moved = Contact(
        contact.direction,
        turned(contact.stiffness),
        contact.damping,
        gap=contact.gap,
        friction=turned(contact.friction),
        events=tuple((event - phase) % 1.0 for event in contact.events),
    )
    return System(system.mass, system.damping, system.stiffness, system.force, [moved])


def test_response_equals_runge_kutta_and_balances_energy():
    system = light_system()
    start = (_light_start()[:6], np.zeros(6))
    options = {"mesh_frequency": 2600.0, "cycles": 3, "start": start, "steps": 2048}
    classical = simulate(system, **options)
    motion = simulate(system, **options, method="dormand-prince", rtol=1e-10)
    for name in ("position", "velocity", "contact_force"):
        expected, value = getattr(classical, name), getattr(motion, name)
        assert np.abs(expected - value).max() < 2e-6 * np.abs(expected).max()
    assert 0.0 < motion.step_number < 20.0
    smooth = System([[1.0]], [[0.1]], [[4.0]], [1.0], [Contact([1.0], 2.0, 0.05)])
    swing = simulate(smooth, 1.0, 5, ([1.0], [0.0]), steps=256, method="dormand-prince", rtol=1e-9)
    audit = energy_audit(smooth, swing)
    assert audit.imbalance < 1e-8
    assert audit.dissipated > 0.1


def test_every_engine_gives_the_same_motion():
    motions = {
        method: simulate(OSCILLATOR, 1.0, 3, ([1.0], [0.0]), steps=512, method=method, **options)
        for method, options in (
            ("rk4", {}),
            ("dormand-prince", {"rtol": 1e-9, "atol": (1e-12, 1e-12)}),
            ("newmark", {"gamma": 0.5, "beta": 0.25}),
        )
    }
    exact = swinging(motions["rk4"].time)[:, 0]
    errors = {name: np.abs(m.position[:, 0] - exact).max() for name, m in motions.items()}
    assert errors["rk4"] < 1e-10
    assert errors["dormand-prince"] < 1e-9
    assert 1e-7 < errors["newmark"] < 1e-5


@pytest.mark.slow
def test_lanes_equal_single_runs():
    system, lanes, cycles = light_system(), 19, 3
    generator = np.random.default_rng(1)
    period = 1.0 / generator.uniform(2000.0, 3000.0, lanes)
    state = 2e-5 * generator.standard_normal((lanes, 12))
    extra = generator.standard_normal((lanes, 6))
    compiled = compile_for(system, 2000.0, 1024)
    record = np.empty((cycles * 1024 + 1, 12, lanes))
    end = march_adaptive(
        compiled, period, state, cycles, rtol=1e-8, extra_force=extra, record=record
    )
    assert np.array_equal(record[-1].T, end)
    scale = np.abs(record).max(axis=(0, 2))
    for lane in (0, 7, 18):
        motion = solve_adaptive(
            system, 1.0 / period[lane], cycles, (state[lane, :6], state[lane, 6:]), 1e-8,
            extra_force=extra[lane],
        )  # fmt: skip
        assert motion.crossings > 2
        time = (compiled.grid.left[::16] + np.arange(cycles)[:, None]).ravel() * period[lane]
        lane_states = record[:-1:16, :, lane]
        assert (np.abs(lane_states - motion(time)) / scale).max() < 3e-8


def test_grazing_and_impacts_between_events():
    """A ball in a dead zone: flight and elastic contact in closed form."""
    contact = Contact([1.0], 100.0, gap=1.0)
    ball = System([[1.0]], [[0.0]], [[0.0]], [0.0], [contact])
    speed, turn = 2.0, 10.0
    motion = solve_adaptive(ball, 0.1, 1, ([0.0], [speed]), rtol=1e-9)
    half = 2.0 / speed + math.pi / turn
    met = 0.5 + half * np.arange(9)
    cycle = 2.0 * half
    assert motion.crossings == np.sum(met < 10.0) + np.sum(met + math.pi / turn < 10.0)
    assert np.abs(motion.time[:, None] - met[:5]).min(axis=0).max() < 1e-8
    flight = motion(np.array([cycle, 2.0 * cycle]))
    assert flight[:, 0] == pytest.approx([0.0, 0.0], abs=1e-8)
    assert flight[:, 1] == pytest.approx([speed, speed], rel=1e-8)
    # Thrown up to just below, at and just above the flank: the excursion is tiny.
    for free_flight in (-1e-9, 0.0, 1e-9, 1e-6):
        throw = math.sqrt(2.0 * (1.0 + free_flight))
        tossed = System([[1.0]], [[0.0]], [[0.0]], [-1.0], [contact])
        motion = solve_adaptive(tossed, 0.5, 1, ([0.0], [throw]), rtol=1e-10)
        above = max(free_flight, 0.0)
        impulse = 100.0 * above * math.sqrt(2.0 * above) * 4.0 / 3.0
        end = 2.0 * throw - 2.0 - impulse * (2.0 - throw)
        assert motion(2.0)[0] == pytest.approx(end, abs=3e-10)


def test_solution_describes_itself():
    motion = solve_adaptive(hysteresis_system(), 0.14, 3, ([1.5], [0.8]), rtol=1e-6)
    text = repr(motion)
    assert "\n" not in text
    assert f"{motion.steps} steps" in text
    assert np.all(np.diff(motion.time) > 0.0)
    data = motion.to_xarray()
    assert data.position.shape == (motion.steps + 1, 1)
    assert data.velocity.units == "m/s or rad/s"
    assert motion(motion.time[-1]) == pytest.approx(motion.state[-1], rel=1e-12)
    with pytest.raises(InputError, match="motion goes from 0"):
        motion(1e3)


def test_wrong_input_is_refused():
    start = ([1.0], [0.0])
    with pytest.raises(InputError, match="rtol"):
        solve_adaptive(OSCILLATOR, 1.0, 1, start, rtol=0.5)
    with pytest.raises(InputError, match="each of the 2 states"):
        solve_adaptive(OSCILLATOR, 1.0, 1, start, atol=[1e-6, -1.0])
    with pytest.raises(InputError, match="Known: rk4, dormand-prince, newmark, modal"):
        simulate(OSCILLATOR, 1.0, 1, start, method="euler")
    with pytest.raises(InputError, match='It belongs to "dormand-prince"'):
        simulate(OSCILLATOR, 1.0, 1, start, rtol=1e-6)
    jump = Contact([1.0], stiffness=lambda phase: np.where(phase < 0.37, 1.0, 2.0))
    with pytest.raises(InputError, match=r"jumps by 1 at the mesh phase 0\.37"):
        solve_adaptive(System([[1.0]], [[0.1]], [[0.0]], [0.5], [jump]), 1.0, 1, start)


def test_an_unstable_motion_is_reported_with_time_and_body():
    unstable = System(
        np.eye(2), np.diag([0.0, -900.0]), np.eye(2), [1.0, 1.0], names=("wheel", "rim")
    )
    with pytest.raises(ComputationError, match=r"first in coordinate rim.* at the time .* s"):
        solve_adaptive(unstable, 1.0, 3, ([0.0, 0.0], [0.0, 0.0]))


def test_a_failing_lane_is_named():
    push = Contact([1.0], 100.0, -30.0, gap=1.0)
    system = System([[1.0]], [[0.0]], [[0.0]], [0.0], [push])
    state = np.zeros((40, 2))
    state[33] = [0.5, 2.0]
    with pytest.raises(ComputationError, match="lane 33"):
        march_adaptive(compile_for(system, 1.0, 64), np.ones(40), state, 60)
