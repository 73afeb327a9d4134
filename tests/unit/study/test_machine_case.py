"""Case files of machines: parts, defaults, load cases, and messages that name the part."""

from pathlib import Path

import numpy as np
import pytest

from tribodyn import load_case
from tribodyn.errors import InputError
from tribodyn.machine import Bearing
from tribodyn.machine.bearing import takes_axial_force
from tribodyn.study import read_case
from tribodyn.study.machine.case import MachineCase

#: Four gears and two ratios, without shafts, bearings or tooth contact.
SMALL = """
[gears]
z1 = { shaft = "in", teeth = 27, face_width = "50 mm" }
z2 = { shaft = "middle", teeth = 51, face_width = "50 mm" }
z3 = { shaft = "middle", position = "80 mm", teeth = 23, face_width = "74 mm" }
z4 = { shaft = "out", teeth = 34, face_width = "74 mm" }
[meshes.first]
gears = ["z1", "z2"]
normal_module = "4.5 mm"
stiffness = "5.2e8 N/m"
[meshes.second]
gears = ["z3", "z4"]
normal_module = "6.5 mm"
stiffness = "7e8 N/m"
[operation]
input = "in"
output = "out"
speed = "1234 rpm"
torque = "456 N*m"
"""


@pytest.fixture(scope="module")
def reducer() -> MachineCase:
    return load_case("two-stage-spur")


def test_a_machine_of_four_gears_needs_no_shafts_and_bearings():
    case = read_case(SMALL, "small.toml")
    machine = case.machine()
    assert case.implied_shafts == ("in", "middle", "out")
    assert dict(machine.clock.cycles) == {"first": 51, "second": 23}
    speed = machine.kinematics.shafts["out"].speed
    assert speed == pytest.approx(1234 * np.pi / 30 * 27 / 51 * 23 / 34)


def test_what_is_written_reads_back(reducer):
    again = read_case(reducer.to_toml(), "again.toml")
    assert again.to_toml() == reducer.to_toml()
    assert again.load_cases == reducer.load_cases
    assert repr(again.machine()) == repr(reducer.machine())


def test_numbers_from_python_are_written_with_their_units(reducer):
    changed = reducer.replace({"operation.speed": 100.0, "meshes.first.backlash": 1e-4})
    again = read_case(changed.to_toml(), "again.toml")
    assert again.operating_point.speed == 100.0
    assert again.pair("first", again.operating_point).backlash == 1e-4


def test_the_pair_of_a_mesh_has_its_speed_torque_and_driver(reducer):
    point = reducer.operating_point
    first, second = (reducer.pair(name, point) for name in ("first", "second"))
    assert first.operation.speed == pytest.approx(100.0 * np.pi)
    assert first.operation.torque == pytest.approx(120.0)
    assert second.operation.speed == pytest.approx(100.0 * np.pi * 23 / 57)
    assert second.operation.torque == pytest.approx(120.0 * 57 / 23)
    assert (first.gears.driver, second.gears.driver) == ("pinion", "pinion")
    braking = reducer.replace({"operation.torque": "-120 N*m"})
    assert braking.pair("first", braking.operating_point).gears.driver == "wheel"


def test_a_mesh_has_models_of_its_own(reducer):
    changed = reducer.replace({"meshes.second.friction": {"law": "constant", "coefficient": 0.05}})
    pairs = {n: changed.pair(n, changed.operating_point) for n in ("first", "second")}
    assert {n: p.friction.law for n, p in pairs.items()} == {
        "first": "xu-2007",
        "second": "constant",
    }


def test_load_cases_have_names_and_shares(reducer):
    loads = {load.name: (load.share, load.torque) for load in reducer.load_cases}
    assert loads == {"slow": (0.3, 180.0), "cruise": (0.7, 90.0)}


@pytest.mark.parametrize(
    ("changes", "place", "text"),
    [
        ({"bearings.A.position": "500 mm"}, "bearings.A.position", "off the shaft"),
        ({"bearings.A.shaft": "inputt"}, "bearings.A.shaft", 'Did you mean "input"'),
        ({"bearings.A.typ": "ball"}, "bearings.A.typ", 'more. Did you mean "type"'),
        ({"bearings.A.type": "ball"}, "bearings.A.type", "deep-groove"),
        ({"bearings.A.bore_diameter": "30"}, "bearings.A.bore_diameter", "has no unit"),
        ({"bearings.C": None, "bearings.D": None}, "shafts.middle", "no bearing"),
        ({"gears.z1.tip_diameter": "50 mm"}, "gears.z1.tip_diameter", "base circle"),
        ({"gears.z3.position": "65 mm"}, "gears.z3.position", "one place"),
        ({"gears.z2.face_width": None}, "gears.z2.face_width", "is missing"),
        ({"meshes.first.center_distance": "500 mm"}, "meshes.first.center_distance", "reach"),
        ({"meshes.first.gears": ["z1", "z9"]}, "meshes.first.gears", 'no gear "z9"'),
        ({"meshes.first.gears": "z1"}, "meshes.first.gears", "two gears"),
        ({"meshes.first.friction.law": "x"}, "meshes.first.friction.law", "Allowed"),
        ({"friction.law": "x"}, "friction.law", "Allowed"),
        ({"gears.z2.teeth": -57}, "gears.z2.bore_diameter", "of a ring"),
        ({"meshes.first.stiffness": "5 mm"}, "meshes.first.stiffness", "N/m"),
        ({"operation.output": "none"}, "operation.output", "there is no shaft"),
        ({"operation.speed": "5"}, "operation.speed", "has no unit"),
        ({"lubricant.temperature": "5"}, "lubricant.temperature", "has no unit"),
        ({"shafts.input.sections": [["5 mm"]]}, "shafts.input.sections", "diameters"),
        ({"shafts.input.length": "5 mm"}, "shafts.input.length", "Write it in sections"),
        ({"shafts.input.inner_diameter": 0.01}, "shafts.input.inner_diameter", "in sections"),
        ({"load_cases": [{"share": "120 %"}]}, "--set load_cases.1.share", "at most 1"),
        ({"load_cases": [{"share": 0.6}, {"share": 0.6}]}, "load_cases", "add up to 120 %"),
        ({"housing.mass_file": "missing.mtx"}, "housing.mass_file", "cannot be read"),
        ({"planets": {}}, "planets", "no stage"),
        ({"meshes": None}, "meshes", "no mesh"),
    ],
)
def test_messages_name_the_part(reducer, changes, place, text):
    with pytest.raises(InputError) as caught:
        reducer.replace(changes, by="--set")
    assert f"{place}: " in str(caught.value)
    assert text in str(caught.value)


def test_problems_of_a_file_have_their_lines():
    broken = SMALL.replace('"7e8 N/m"', '"7e8 N"').replace("teeth = 34", "teeth = 3.4")
    with pytest.raises(InputError) as caught:
        read_case(broken, "small.toml")
    text = str(caught.value)
    assert "small.toml:14: meshes.second.stiffness" in text
    assert "small.toml:6: gears.z4.teeth" in text


def test_a_case_from_python_takes_numbers_in_si():
    shaft = {"sections": [[0.1, 0.04], ["100 mm", 0.05, 0.0]]}
    bearings = {
        f"{name}{end}": {"shaft": name, "position": at, "radial_stiffness": [4e8, 5e8]}
        for name in ("in", "out")
        for end, at in (("left", 0.0), ("right", 0.2))
    }
    case = MachineCase(
        shafts={"in": shaft, "out": shaft},
        bearings=bearings,
        gears={
            "z1": {"shaft": "in", "position": 0.1, "teeth": 27, "face_width": 0.02},
            "z2": {"shaft": "out", "position": 0.1, "teeth": 51, "face_width": 0.02},
        },
        meshes={"first": {"gears": ["z1", "z2"], "normal_module": 4.5e-3, "stiffness": 4e8}},
        operation={"input": "in", "output": "out", "speed": 100.0, "torque": 50.0},
        load_cases=[{"share": 0.5, "torque": 25.0}],
    )
    assert case.shafts["in"].length == 0.2
    assert case.bearings["inleft"].stiffness_matrix[2, 2] == 5e8
    again = read_case(case.to_toml(), "again.toml")
    assert again.to_toml() == case.to_toml()
    assert again.load_cases[0].torque == 25.0


def test_floating_bearings_of_a_case_file(reducer):
    def message(**values):
        with pytest.raises(InputError) as error:
            reducer.replace({f"bearings.A.{name}": value for name, value in values.items()})
        return str(error.value)

    spring = {"type": None, "bore_diameter": None, "outer_diameter": None, "width": None}
    refused = message(**spring, balls=None, floating=True, axial_stiffness="1e8 N/m")
    assert "bearings.A.floating: floating = true. It takes no axial force" in refused
    angular = {"type": "angular-contact", "bore_diameter": "40 mm", "outer_diameter": "80 mm"}
    angular |= dict.fromkeys(("radial_stiffness", "axial_stiffness", "radial_damping"))
    geometry = {**angular, "width": "18 mm", "contact_angle": "25 deg"}
    assert "bearings.A.floating: floating = true. A bearing with a contact" in message(
        **geometry, floating=True
    )
    geometry |= {"type": "deep-groove", "contact_angle": None}
    floating = reducer.replace(
        {f"bearings.A.{k}": v for k, v in {**geometry, "floating": True}.items()}
    )
    assert floating.bearings["A"].floating
    assert not takes_axial_force(floating.bearings["A"])
    assert read_case(floating.to_toml(), "again.toml").bearings["A"].floating
    stiff = Bearing("in", 0.0, floating=True)
    assert stiff.stiffness_matrix.diagonal().tolist() == [0.0, 1e9, 1e9, 0.0, 0.0, 0.0]


def test_a_misspelt_table_beside_the_right_one_keeps_both_lines() -> None:
    text = SMALL + "[shafts.in]\ndensity = 3\n[shaft.in]\n[shaft.out]\ndensity = 4\n"
    with pytest.raises(InputError) as caught:
        read_case(text, "small.toml")
    lines = text.splitlines()
    for key in ("shafts.in.density", "shaft.out.density"):
        number = {"shafts.in.density": "density = 3", "shaft.out.density": "density = 4"}[key]
        assert f"small.toml:{lines.index(number) + 1}: {key}" in str(caught.value)


def test_of_many_keys_those_that_are_alike_are_named() -> None:
    with pytest.raises(InputError) as caught:
        read_case(SMALL + '[friction]\nlawe = "constant"\n', "small.toml")
    assert "has: law, " in str(caught.value)
    assert 'Did you mean "law"?' in str(caught.value)
    assert " more. " in str(caught.value)
    assert str(caught.value).count(", ") < 12


def test_a_housing_that_cannot_be_read_says_why(tmp_path: Path) -> None:
    nodes: dict[str, list[int]] = {"seat A": [0, 1, 2, 3, 4, 5]}
    stiffness = np.eye(6) * 1e9
    np.savez(tmp_path / "dict.npz", K=stiffness, M=np.eye(6), nodes=np.array(nodes, dtype=object))
    for name, message in (
        ("dict.npz", r"such as a dict of nodes.*nodes=numpy\.array"),
        ("none.npz", r"none\.npz cannot be read: there is no such file\. .*Correct the path"),
    ):
        file = (tmp_path / name).as_posix()
        with pytest.raises(InputError, match=message):
            read_case(f'{SMALL}[housing]\nmatrices = "{file}"\n', "small.toml")


def test_a_mesh_without_two_gears_blames_no_key_of_a_gear() -> None:
    text = SMALL.replace('["z3", "z4"]', '"z3"').replace('stiffness = "7e8 N/m"\n', "")
    text = text.replace("teeth = 23,", 'teeth = 23, roughness_ra = "0.3 um",')
    with pytest.raises(InputError) as caught:
        read_case(text, "small.toml")
    assert [str(problem.where) for problem in caught.value.problems] == [
        "small.toml:12: meshes.second.gears"
    ]
