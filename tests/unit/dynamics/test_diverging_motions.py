"""Motions that run away through a dead zone end with a message, or with a verdict, everywhere."""

import re

import numpy as np
import pytest

from known_systems import reference_system
from tribodyn.analysis import basins, bifurcation, lyapunov_exponents, parameter_map, poincare
from tribodyn.dynamics import (
    Contact,
    System,
    continuation,
    run_up,
    simulate,
    simulate_ensemble,
    solve_adaptive,
    steady_state,
)
from tribodyn.errors import ComputationError

NAMES = ("pinion_x", "wheel_x")
FREQUENCY = 2.0
START = ([0.0, 0.2], [0.0, 0.0])
TIME = r"at the time ([0-9.]+) s"
METHODS = ("rk4", "dormand-prince", "newmark")


def runs_away(stiffness=-900.0, damping=0.2):
    """The wheel has backlash and less than no stiffness, or less than no damping, of its own."""
    contact = Contact(
        [0.0, 1.0], lambda phase: 400.0 * (1.0 + 0.3 * np.cos(2 * np.pi * phase)), 0.5, gap=0.1
    )
    matrix = np.diag([100.0, stiffness])
    return System(np.eye(2), np.diag([1.0, damping]), matrix, [1.0, 60.0], [contact], names=NAMES)


def _growth(stiffness=-900.0, damping=0.2):
    """Exponent of the motion far beyond the backlash [1/s], and its size at the start."""
    total = 400.0 + stiffness
    return -0.5 * (damping + 0.5) + np.sqrt(0.25 * (damping + 0.5) ** 2 - total)


@pytest.mark.parametrize("method", METHODS)
def test_time_body_and_cause_of_every_engine(method):
    with pytest.raises(ComputationError) as caught:
        simulate(runs_away(), FREQUENCY, 2000, START, steps=256, method=method)
    text = str(caught.value)
    reported_time = float(re.search(TIME, text).group(1))
    # From about one to the largest number: the reports count from the start of the motion.
    assert reported_time == pytest.approx(709.0 / _growth(), rel=0.03)
    assert "wheel_x" in text
    assert "stiffness matrix has a negative eigenvalue" in text
    with pytest.raises(ComputationError) as caught:
        simulate_ensemble(runs_away(), np.linspace(2.0, 3.0, 18), 2000, START, steps=256,
                          method=method)  # fmt: skip
    assert re.search(r"in lane \d+", str(caught.value))
    assert "System.stiffness" in str(caught.value)


@pytest.mark.parametrize("method", ["dormand-prince", "newmark"])
def test_negative_damping_is_named_as_the_cause(method):
    system = runs_away(stiffness=100.0, damping=-9.0)
    with pytest.raises(ComputationError, match="damping matrix has a negative eigenvalue"):
        simulate(system, FREQUENCY, 4000, START, steps=256, method=method)


def _section(system):
    return poincare(system, FREQUENCY, start=START, transient=3000, steps=256)


def _exponents(system):
    return lyapunov_exponents(system, FREQUENCY, start=START, transient=3000, steps=256)


@pytest.mark.parametrize(
    "answer",
    [
        lambda system: solve_adaptive(system, FREQUENCY, 2000, START),
        lambda system: steady_state(system, FREQUENCY, steps=256),
        lambda system: continuation(system, between=(1.5, 3.0), steps=128),
        _section,
        _exponents,
    ],
    ids=["solve_adaptive", "steady_state", "continuation", "poincare", "lyapunov_exponents"],
)
def test_analyses_of_a_diverging_motion_end_with_a_message(answer):
    for system in (runs_away(), runs_away(stiffness=100.0, damping=-9.0)):
        with pytest.raises(ComputationError, match="grew beyond all bounds") as caught:
            answer(system)
        assert "wheel_x" in str(caught.value)


def test_times_of_sections_and_exponents_count_from_the_start():
    for answer in (_section, _exponents):
        with pytest.raises(ComputationError) as caught:
            answer(runs_away())
        reported_time = float(re.search(TIME, str(caught.value)).group(1))
        assert reported_time == pytest.approx(709.0 / _growth(), rel=0.03)


def test_a_run_up_ends_with_a_message():
    with pytest.raises(ComputationError, match=r"grew beyond all bounds after .* wheel_x"):
        run_up(runs_away(), ([0.0, 60.0], [1.0, 3.0]), start=START, steps=256)


def test_diagrams_keep_the_motions_that_do_not_diverge():
    values = np.array([-900.0, 100.0, 200.0])
    systems = [runs_away(stiffness=value) for value in values]
    diagram = bifurcation(
        systems, FREQUENCY, parameter=values, parameter_name="stiffness", parameter_unit="N/m",
        start=START, steps=256, transient=200, sweep="independent",
    )  # fmt: skip
    assert diagram.verdict[0].tolist() == ["undecided", "physical", "physical"]
    assert np.isnan(diagram.rms[0, 0])
    lost = basins(runs_away(), FREQUENCY, between=((-1.0, 1.0), (-1.0, 1.0)), points=(5, 5),
                  coordinates=("wheel_x", "wheel_x_velocity"), steps=256)  # fmt: skip
    assert lost.unresolved == 1.0
    assert "no attractor, 100 % unresolved" in repr(lost)
    over = (("mesh_frequency", np.linspace(1.5, 3.0, 3)), ("force_scale", [0.5, 2.0]))
    assert np.all(np.isnan(parameter_map(runs_away(), over=over, steps=256).rms))


def test_steps_beyond_the_limit_give_a_verdict():
    system = reference_system(0.1, gap=2e-5)
    diagram = bifurcation(system, np.linspace(200.0, 300.0, 3), steps=64, transient=60)
    assert set(diagram.verdict.ravel()) == {"step-limited"}
    assert np.all(diagram.step_number > 2.7)
