"""Newmark's scheme: closed forms of one oscillator, the readable version, lanes, refusals."""

from __future__ import annotations

import numpy as np
import pytest

from known_marches import compile_newmark, march_newmark
from known_systems import (
    MESH_FREQUENCY,
    everything_varies,
    hysteresis_system,
    reference_system,
)
from plain.newmark import newmark_plain
from tribodyn.dynamics import Contact, System
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.dynamics.time.newmark import NEWMARK_PRESETS
from tribodyn.errors import ComputationError, InputError

RATE = 3.0
FREE = System([[2.0]], [[0.0]], [[2.0 * RATE**2]], [0.0])
#: The same oscillator with its spring as a contact without dead zone.
MESHED = System([[2.0]], [[0.0]], [[0.0]], [0.0], [Contact([1.0], stiffness=2.0 * RATE**2)])
STEPS, CYCLES = 16, 5


def march(system, frequency, start, **options):
    compiled = compile_newmark(
        system, frequency, STEPS, gamma=options.get("gamma", 0.5), beta=options.get("beta", 0.25)
    )
    start = np.atleast_2d(np.asarray(start, dtype=float))
    period = np.full(start.shape[0], 1.0 / frequency)
    return march_newmark(compiled, period, start, CYCLES, **options)


@pytest.mark.parametrize("system", [FREE, MESHED])
@pytest.mark.parametrize("number", [0.1, 1.0, 40.0])
def test_average_acceleration_turns_by_the_angle_of_its_closed_form(system, number):
    # theta = 2 arctan(omega h / 2): the period is too long by theta's error, the energy constant
    frequency = RATE / (number * STEPS)
    turned = 2.0 * np.arctan(0.5 * number) * STEPS * CYCLES
    (end,) = march(system, frequency, [1.0, 0.0])
    assert end[0] == pytest.approx(np.cos(turned), abs=1e-12)
    assert end[1] / RATE == pytest.approx(-np.sin(turned), abs=1e-12)


@pytest.mark.parametrize(("gamma", "beta"), [(0.5, 1 / 6), (0.5, 0.0), (0.5, 0.5), (0.6, 0.35)])
@pytest.mark.parametrize("system", [FREE, MESHED])
def test_turn_and_decay_of_the_family(system, gamma, beta):
    number = 0.8
    share = number**2 / (1.0 + beta * number**2)
    determinant = 1.0 - (gamma - 0.5) * share
    half_trace = 1.0 - 0.5 * (gamma + 0.5) * share
    turn = STEPS * CYCLES * np.arccos(half_trace / np.sqrt(determinant))
    ends = march(system, RATE / (number * STEPS), np.eye(2), gamma=gamma, beta=beta)
    decay = determinant ** (0.5 * STEPS * CYCLES)
    assert np.linalg.det(ends) == pytest.approx(decay**2, rel=1e-11)
    assert np.trace(ends) == pytest.approx(2.0 * decay * np.cos(turn), abs=1e-11)
    if gamma > 0.5:
        assert decay < 0.2


@pytest.mark.parametrize(
    ("system", "frequency", "size", "options"),
    [
        (reference_system(0.1), MESH_FREQUENCY, 1e-6, {}),
        (reference_system(0.1, gap=1e-5), MESH_FREQUENCY, 2e-5, {"gamma": 0.6, "beta": 0.4}),
        (everything_varies(), 0.4, 0.2, {}),
        (everything_varies(), 0.4, 0.2, {"gamma": 0.6, "beta": 0.4}),
    ],
)
def test_compiled_equals_plain(system, frequency, size, options):
    steps, cycles = 96, 3
    start = size * np.random.default_rng(3).standard_normal(2 * system.size)
    compiled = compile_newmark(system, frequency, steps, **options)
    plain = newmark_plain(
        system, compiled.grid, compiled.nodes, frequency, cycles, start, **options
    )
    record = np.empty((steps * cycles + 1, 2 * system.size, 1))
    march_newmark(
        compiled, np.array([1.0 / frequency]), start[None], cycles, record=record, **options
    )
    difference = (record[:, :, 0] - plain) / (np.abs(plain).max(axis=0) + 1e-30)
    assert np.abs(difference).max() < 1e-11


@pytest.mark.slow
def test_lanes_equal_single_runs_and_threads_change_nothing():
    system, steps, lanes = reference_system(0.1, gap=1e-5), 128, 37
    generator = np.random.default_rng(5)
    period = 1.0 / generator.uniform(200.0, 3000.0, lanes)
    state = np.hstack([2e-5 * generator.standard_normal((lanes, 6)), np.zeros((lanes, 6))])
    extra = generator.standard_normal((lanes, 6))
    compiled = compile_newmark(system, 1.0 / period, steps)
    record = np.empty((2 * steps + 1, 12, lanes))
    batch = march_newmark(compiled, period, state, 2, extra_force=extra, record=record, threads=3)
    again = np.empty((12, lanes, 2 * steps + 1)).transpose(2, 0, 1)
    march_newmark(compiled, period, state, 2, extra_force=extra, record=again, threads=1)
    np.testing.assert_array_equal(record, again)
    np.testing.assert_array_equal(record[-1].T, batch)
    for lane in (0, 20, lanes - 1):
        selection = slice(lane, lane + 1)
        single = march_newmark(
            compiled, period[selection], state[selection], 2, extra_force=extra[selection]
        )
        np.testing.assert_allclose(single[0], batch[lane], rtol=1e-12, atol=1e-15)


def test_stiff_support_needs_no_short_step():
    stiff = System(np.eye(2), 0.1 * np.eye(2), np.diag([1.0, 1e10]), [1.0, 1.0])
    with pytest.raises(InputError, match="Runge-Kutta"):
        compile_for(stiff, 0.2, 64)
    compiled = compile_newmark(stiff, 0.2, 64)
    assert compiled.step_number == pytest.approx(1e5 * 5.0 / 64, rel=1e-3)
    end = march_newmark(compiled, np.array([5.0]), np.zeros((1, 4)), 60)
    assert end[0, 0] == pytest.approx(1.0, abs=1e-5)
    assert abs(end[0, 1]) < 3e-10


@pytest.mark.parametrize(("name", "limit"), [("central difference", 2.0),
                                             ("linear acceleration", 2.0 * 3.0**0.5)])  # fmt: skip
def test_conditional_stability_is_refused_at_its_limit(name, limit):
    gamma, beta = NEWMARK_PRESETS[name]
    longest = RATE / (limit * STEPS)
    options = {"gamma": gamma, "beta": beta}
    end = march(FREE, 1.001 * longest, [1.0, 0.0], **options)
    assert abs(end[0, 0]) < 30.0
    with pytest.raises(InputError, match=r"1/sqrt\(gamma/2 - beta\)"):
        compile_newmark(FREE, 0.999 * longest, STEPS, **options)
    slower = compile_newmark(FREE, 0.999 * longest, STEPS)
    with pytest.raises(InputError, match="any step is stable only with 2 beta >= gamma"):
        march_newmark(slower, np.array([1.001 / longest]), np.ones((1, 2)), 1, **options)


def test_arguments_out_of_range_are_refused():
    for options in ({"gamma": 0.4}, {"beta": -0.1}, {"gamma": float("nan")}):
        with pytest.raises(InputError, match="gamma"):
            compile_newmark(FREE, 1.0, STEPS, **options)
    for arguments in ((0.0, STEPS), (1.0, 2.5), (1.0, 0)):
        with pytest.raises(InputError, match=r"mesh_frequency|steps"):
            compile_newmark(FREE, *arguments)


def test_growth_is_reported_with_time_and_coordinate():
    # the second coordinate grows with exp(5 t) and leaves the range of numbers at 142 s
    system = System(
        np.eye(2), np.diag([0.1, -10.0]), np.diag([1.0, 100.0]), [1.0, 1.0], names=("calm", "wild")
    )
    compiled = compile_newmark(system, 0.5, 512)
    with pytest.raises(ComputationError, match="first in coordinate wild") as caught:
        march_newmark(compiled, np.array([2.0]), np.zeros((1, 4)), 100)
    time = float(str(caught.value).split("at the time ")[1].split(" s")[0])
    assert time == pytest.approx(np.log(np.finfo(float).max) / 5.0, rel=0.02)


def test_unconverged_contact_forces_are_reported():
    # a negative stiffness that takes the whole effective mass: 1 + beta h^2 k / m = 0
    h = 1.0 / STEPS
    contact = Contact([1.0], stiffness=-1.0 / (0.25 * h * h))
    system = System([[1.0]], [[0.0]], [[0.0]], [1.0], [contact])
    with pytest.raises(ComputationError, match=r"ends at 0\.0625 s did not converge"):
        march_newmark(compile_newmark(system, 1.0, STEPS), np.ones(1), np.ones((1, 2)), 50)


def test_hysteresis_start_decides_the_branch():
    compiled = compile_newmark(hysteresis_system(), 0.14, 256)
    start = np.array([[1.5, 0.0], [2.6, 0.0], [0.0, 3.0], [1.4, 0.1]])
    record = np.empty((256 * 200 + 1, 2, 4))
    march_newmark(compiled, np.full(4, 1.0 / 0.14), start, 200, record=record)
    last = record[-257:-1, 0]
    spread = np.round(last.std(axis=0), 3)
    assert set(spread) == {spread.min(), spread.max()}
    assert spread.max() > 1.5 * spread.min()
