"""Bifurcation diagram of a case: units, steps, torque balance, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.study import bifurcation

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

ENDS = ("1900 rpm", "2000 rpm")


@pytest.fixture(scope="module")
def case():
    return td.load_case("fzg-roughness")


@pytest.fixture(scope="module")
def diagram(case):
    return td.bifurcation(case, between=ENDS, points=2, steps=1024, transient=60, verdict=False)


def test_parameter_is_in_si_and_its_axis_in_display_units(diagram):
    assert diagram.parameter == pytest.approx(np.array([1900.0, 2000.0]) * np.pi / 30.0, rel=1e-12)
    assert diagram.parameter_unit == "rad/s"
    figure = diagram.plot()
    assert figure.layout.xaxis.title.text == "Speed [rpm]"
    assert np.unique(figure.data[0].x) == pytest.approx([1900.0, 2000.0])


def test_motion_is_that_of_a_run(case, diagram):
    orbit = td.run(
        case.replace({"operation.speed": ENDS[0], "solver.steps_per_mesh_cycle": 1024})
    ).response
    signal = orbit.fine.deflection[:, 0]
    rms = np.sqrt(orbit.fine.mean((signal - orbit.fine.mean(signal)) ** 2))
    assert diagram.rms[0, 0] == pytest.approx(rms, rel=1e-6)
    assert diagram.section[0, 0, -1] == pytest.approx(orbit.deflection[0, 0], rel=1e-6)


def test_steps_are_those_of_the_case_or_enough_to_judge(case):
    diagram = bifurcation(case, between=ENDS, points=2, transient=20)
    case_of_600 = case.replace({"solver.steps_per_mesh_cycle": 600})
    assert diagram.steps.tolist() == [512, 512]
    assert diagram.verdicts() == {"physical": 2}
    diagram_of_600 = bifurcation(case_of_600, between=ENDS, points=2, transient=20, verdict=False)
    assert diagram_of_600.steps.tolist() == [600, 600]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "between"),
        ({"between": ENDS, "points": 1}, "points = 1"),
        ({"over": "friction.law", "between": ("none", "none")}, "no values in between"),
        ({"between": ("1900 mm", "2000 rpm")}, "mm"),
        ({"over": "operation.sped", "between": ENDS}, "sped"),
    ],
)
def test_bad_input_is_refused(case, options, message):
    with pytest.raises(InputError, match=message):
        bifurcation(case, **options)
