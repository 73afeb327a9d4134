"""What no machine or stage can be is refused where the file says it, with a remedy."""

from __future__ import annotations

from typing import Any

import pytest

import tribodyn as td
from tribodyn.cases.catalogue import all_files
from tribodyn.errors import InputError, collected
from tribodyn.study import read_case
from tribodyn.study.machine.run import rehearse_machine

BOX = """\
[gears]
z1 = { shaft = "in", teeth = 21, face_width = "30 mm" }
z2 = { shaft = "mid", teeth = 42, face_width = "30 mm" }
z3 = { shaft = "mid", teeth = 19, face_width = "30 mm" }
z4 = { shaft = "out", teeth = 40, face_width = "30 mm" }
[meshes.first]
gears = ["z1", "z2"]
normal_module = "3 mm"
[meshes.second]
gears = ["z3", "z4"]
normal_module = "3 mm"
angle = "90 deg"
[friction]
law = "constant"
coefficient = 0.05
[operation]
input = "in"
output = "out"
speed = "1500 rpm"
torque = "90 N*m"
"""
STAGE = all_files()["planetary-stage"].read_text(encoding="utf-8").partition("[[load_cases]]")[0]
STIFF = BOX.replace('"3 mm"\n', '"3 mm"\nstiffness = "4e8 N/m"\n').replace(
    '[friction]\nlaw = "constant"\ncoefficient = 0.05\n', ""
)
SUPPORT = '[bearings.A]\nshaft = "in"\nposition = "0 mm"\nstiffness = "4e8 N/m"\n'
TAPER = SUPPORT.replace('stiffness = "4e8 N/m"', 'type = "tapered-roller"\ndirection = "-"')
LOAD = '[[load_cases]]\nname = "a"\nshare = "30 %"\n'


def refusal(text: str) -> Any:
    """Problems of a file when it is read, or checked."""
    with pytest.raises(InputError) as caught, collected():
        rehearse_machine(read_case(text, "box.toml"))
    return caught.value.problems


@pytest.mark.parametrize(
    ("text", "before", "after", "key", "words"),
    [
        (BOX, '["z1", "z2"]', '["z1", "z1"]', "meshes.first.gears", "A mesh has two gears"),
        (BOX, '"1500 rpm"', '"0 rpm"', "operation.speed", "Allowed: 0.01 rpm"),
        (STIFF, '"1500 rpm"', '"0 rpm"', "operation.speed", "Allowed: 0.01 rpm"),
        (STAGE, '"1500 rpm"', '"0 rpm"', "operation.speed", "Allowed: 0.01 rpm"),
        (BOX, '"90 N*m"', '"0 N*m"', "operation.torque", "Give a torque"),
        (STAGE, '"600 N*m"', '"0 N*m"', "operation.torque", "Give a torque"),
        (BOX + SUPPORT, "stiffness", "stiffness", "bearings.A.stiffness", "mean radial_stiffness"),
        (BOX + TAPER, '"-"', '"up"', "bearings.A.direction", "direction = 1."),
        (STAGE, '"4e8 N/m"', '"0 N/m"', "planets.low.pin_stiffness", "above 0 N/m"),
    ],
)
def test_values_that_cannot_be(text: str, before: str, after: str, key: str, words: str) -> None:
    assert before in text
    (problem,) = refusal(text.replace(before, after, 1))
    line = 1 + text[: text.index(before)].count("\n")
    assert str(problem.where) == f"box.toml:{line}: {key}"
    assert words in str(problem)


@pytest.mark.parametrize("base", [BOX, STIFF, STAGE])
@pytest.mark.parametrize(("name", "value"), [("speed", "0 rpm"), ("torque", "0 N*m")])
def test_load_cases_are_named_where_they_are_wrong(base: str, name: str, value: str) -> None:
    other = LOAD.replace('"a"', '"b"')
    text = f'{base}{other}{LOAD}{name} = "{value}"\n'
    if base is STIFF and name == "torque":
        with collected():  # meshes with a constant stiffness may idle
            rehearse_machine(read_case(text, "box.toml"))
        return
    (problem,) = refusal(text)
    assert str(problem.where) == f"box.toml:{text.count(chr(10))}: load_cases.a.{name}"


def test_load_cases_with_one_name_are_not_merged() -> None:
    (problem,) = refusal(f"{BOX}{LOAD}{LOAD}")
    assert str(problem.where).endswith("load_cases")
    assert "two load cases have one name" in problem.what


def test_a_misspelt_planet_is_no_mesh_with_a_constant_stiffness() -> None:
    problems = refusal(STAGE.replace('planet = "planet"', 'planet = "plant"'))
    assert any('there is no gear "plant"' in problem.what for problem in problems)
    assert not any("constant stiffness" in str(problem) for problem in problems)


def test_the_cases_are_sound_without_the_change() -> None:
    with collected():
        for text in (BOX, STIFF, STAGE):
            rehearse_machine(read_case(text, "box.toml"))
    assert td.load_case("planetary-stage").lone_stage == "low"


def test_a_ring_without_a_shaft_in_a_machine_is_told_its_own() -> None:
    text = all_files()["wind-turbine-gearbox"].read_text(encoding="utf-8")
    named = '[gears.ring]\nshaft = "ring"\n'
    assert named in text
    with pytest.raises(InputError, match=r'gears\.ring\.shaft: shaft is missing.*shaft = "ring"'):
        read_case(text.replace(named, "[gears.ring]\n"))
