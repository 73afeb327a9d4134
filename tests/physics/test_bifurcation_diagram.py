"""Bifurcation diagrams: hysteresis, period doubling, and chaos that only the step makes."""

from __future__ import annotations

import numpy as np
import pytest

from known_systems import hysteresis_system, pairs_in_contact, reference_system
from references.backlash_orbits import HIGH, LOW
from tribodyn.analysis import bifurcation, poincare
from tribodyn.dynamics import Contact, System, steady_state
from tribodyn.dynamics.equations.step_limit import LIMIT
from tribodyn.errors import InputError
from tribodyn.nonlinear.survey import step_verdict

TURN = 2.0 * np.pi


@pytest.fixture(scope="module")
def hysteresis():
    turns = np.array([0.83, 0.84, 0.88, 0.90, 0.91])
    return bifurcation(
        hysteresis_system(),
        turns / TURN,
        parameter=turns,
        parameter_name="frequency ratio",
        parameter_unit="-",
        sweep="both",
        steps=256,
        transient=120,
        exponents=24,
    )


def test_sweeps_up_and_down_differ_between_the_jumps(hysteresis):
    up, down = hysteresis.rms
    assert hysteresis.branches == ("up", "down")
    assert up[2] == pytest.approx(LOW, abs=1e-6)
    assert down[2] == pytest.approx(HIGH, abs=1e-6)
    differ = np.abs(up - down) > 1e-3
    assert differ.tolist() == [False, True, True, True, False]


def test_only_the_upper_branch_separates(hysteresis):
    lost = hysteresis.contact_loss_share > 0.0
    assert lost.tolist() == [[False] * 4 + [True], [False] + [True] * 4]


def test_all_motions_of_the_hysteresis_are_physical(hysteresis):
    assert hysteresis.verdicts() == {"physical": 10}
    assert np.all(hysteresis.period == 1)
    assert np.all(hysteresis.refined_steps == 512)
    assert hysteresis.largest_exponent[:, 2] == pytest.approx(-0.05, rel=1e-6)


def test_independent_starts_agree_with_a_sweep(hysteresis):
    lanes = bifurcation(
        hysteresis_system(),
        hysteresis.mesh_frequency,
        sweep="independent",
        steps=256,
        transient=120,
        verdict=False,
    )
    assert lanes.rms[0, :3] == pytest.approx(hysteresis.rms[0, :3], rel=1e-6)
    assert lanes.verdicts() == {}
    assert lanes.step_number == pytest.approx(hysteresis.step_number, rel=1e-9)


@pytest.fixture(scope="module")
def stiffer():
    """The mesh of the reference pair from 1.1e5 to 2.17e7 N/mm, with T_m/200 as the source."""
    stiffness = np.geomspace(1.1e8, 2.17e10, 9)[[0, 3, 5, 8]]

    def system(k):
        return reference_system(
            stiffness=lambda phase: 0.5 * k * pairs_in_contact(phase),
            damping=0.1 * np.sqrt(0.2 * k),
            gap=5e-5,
        )

    return bifurcation(
        [system(k) for k in stiffness],
        240.0,
        parameter=stiffness,
        parameter_name="mesh_stiffness",
        parameter_unit="N/m",
        steps=200,
        transient=150,
        cycles=48,
    )


def test_chaos_of_a_stiff_mesh_is_the_limit_of_the_step(stiffer):
    beyond = stiffer.step_number > LIMIT
    assert beyond.tolist() == [False, False, True, True]
    assert (stiffer.verdict[0] == "step-limited").tolist() == beyond.tolist()
    assert (stiffer.period[0] == 1).tolist() == (~beyond).tolist()


def test_with_shorter_steps_the_stiff_mesh_repeats_every_cycle(stiffer):
    assert np.all(stiffer.refined_period == 1)
    assert np.all(stiffer.step_number * stiffer.steps / stiffer.refined_steps <= 0.5 * LIMIT)
    assert np.all(np.diff(stiffer.refined_rms[0]) < 0.0)


def test_period_doubling_is_seen():
    pair = Contact([1.0], lambda p: 1.0 + 0.3 * np.cos(TURN * p), damping=0.05, gap=1.0)
    system = System([[1.0]], [[0.05]], [[0.0]], [0.3], [pair])
    diagram = bifurcation(
        system, np.array([1.2, 2.0]) / TURN, start=([1.3], [0.1]), steps=128, transient=300
    )
    assert diagram.period.tolist() == [[1, 2]]
    assert diagram.verdicts() == {"physical": 2}
    section = diagram.section[0, 1]
    assert section[2:] == pytest.approx(section[:-2], abs=1e-4)
    assert abs(section[1] - section[0]) > 0.1


def test_a_lost_motion_leaves_the_others_alone():
    pair = Contact([1.0], lambda p: 1.0 + 0.5 * np.cos(TURN * p))
    system = System([[1.0]], [[0.01]], [[0.0]], [0.5], [pair])
    diagram = bifurcation(
        system, np.array([0.7, 2.0]) / TURN, sweep="independent", steps=64, transient=3000
    )
    assert np.isfinite(diagram.rms[0]).tolist() == [True, False]
    assert diagram.verdict[0].tolist() == ["physical", "undecided"]


@pytest.mark.filterwarnings(r"ignore:\[step-size\]")  # coarse on purpose
def test_a_diagram_takes_any_coordinate():
    system, options = reference_system(), {"steps": 256, "transient": 20, "cycles": 8, "keep": 8}
    diagram = bifurcation(system, [240.0], signal="pinion_y", **options)
    orbit = steady_state(system, 240.0, steps=256)
    assert diagram.signal == "pinion_y"
    assert diagram.section[0, 0, -1] == pytest.approx(orbit.position[0, 1], rel=1e-6)
    spread = orbit.fine.mean(orbit.fine.position[:, 1] ** 2)
    spread -= orbit.fine.mean(orbit.fine.position[:, 1]) ** 2
    assert diagram.rms[0, 0] == pytest.approx(np.sqrt(spread), rel=1e-6)


@pytest.mark.filterwarnings(r"ignore:\[step-size\]")  # coarse on purpose
@pytest.mark.parametrize("coefficient", [0.0, 0.1])
def test_section_of_a_gear_pair_is_one_point(coefficient):
    system = reference_system(coefficient)
    section = poincare(system, 240.0, transient=40, steps=256)
    orbit = steady_state(system, 240.0, steps=256, periods=2)
    assert section.period == 1
    assert poincare(orbit).period == 1
    assert section.deflection[-1] == pytest.approx(orbit.deflection[0], rel=1e-7)


@pytest.mark.parametrize(
    ("facts", "expected"),
    [
        ((0.2, 1, 0.31, 1, 0.312), "physical"),
        ((0.2, 0, 0.31, 0, 0.33), "physical"),
        ((0.2, 1, 0.31, 1, 0.33), "undecided"),
        ((0.2, 2, 0.31, 1, 0.31), "step-limited"),
        ((2.71, 1, 0.31, 1, 0.31), "step-limited"),
        ((0.2, 0, np.nan, 0, 0.31), "undecided"),
    ],
)
def test_verdict(facts, expected):
    assert step_verdict(*facts) == expected


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"sweep": "sideways"}, "sideways"),
        ({"signal": 3}, "signal = 3"),
        ({"signal": "nose"}, "nose"),
        ({"keep": 100, "cycles": 10}, "keep = 100"),
        ({"steps": 0}, "steps = 0"),
        ({"steps": [64, 64, 64]}, "mesh frequencies"),
    ],
)
def test_bad_input_is_refused(options, message):
    with pytest.raises(InputError, match=message):
        bifurcation(hysteresis_system(), [0.1, 0.2], **options)


def test_diagram_has_units_and_a_figure(hysteresis):
    table = hysteresis.to_xarray()
    assert table["largest_exponent"].attrs["units"] == "1/s"
    assert table["rms"].sel(branch="down").values[2] == pytest.approx(HIGH, abs=1e-6)
    figure = hysteresis.plot()
    assert figure.layout.title.text == "Two responses coexist from 0.84 to 0.9"
    assert len(figure.data) == 7


def test_figure_greys_step_limited_motions(stiffer):
    figure = stiffer.plot()
    assert (
        figure.layout.title.text == "2 of 4 responses depend on the time step and are not physical"
    )
    (grey,) = (trace for trace in figure.data if trace.name == "step-limited, not physical")
    assert np.unique(grey.x).size == 2
