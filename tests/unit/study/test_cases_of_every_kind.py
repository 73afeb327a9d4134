"""Cases of every kind have the same members: values by key, origins, equality, text."""

from __future__ import annotations

import pickle
import re
import tomllib
from typing import Any

import pytest

import tribodyn as td
from tribodyn.cases.catalogue import all_files
from tribodyn.errors import InputError
from tribodyn.study import read_case
from tribodyn.study.case.provenance import changed_keys, provenance

CASES = (
    *("fzg-roughness", "fzg-12dof", "helical-pair", "hypoid-mixed-ehl"),
    *("two-stage-spur", "hypoid-axle", "planetary-stage", "wind-turbine-gearbox"),
)
STAGE = td.load_case("planetary-stage").to_toml()


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest) -> Any:
    return td.load_case(request.param)


def changed(case: Any) -> Any:
    return case.replace({"operation.torque": 1.01 * case["operation.torque"]})


def test_equal_files_give_equal_cases(case: Any) -> None:
    other = pickle.loads(pickle.dumps(case))
    assert other == case
    assert hash(other) == hash(case)
    assert changed(case) != case


def test_a_value_is_reached_by_its_key(case: Any) -> None:
    typed = {*case.user_input.typed}
    values = {key: value for key, value in case.values() if key in typed}
    assert len(values) > 20
    assert all(case[k] == v or str(case[k]).endswith(str(v)) for k, v in values.items())
    assert case.get("operation.torque") == case["operation.torque"] > 0.0
    assert case.get("operation.torqe", 3.0) == 3.0
    with pytest.raises(InputError, match=r"operation\.torqe.*Did you mean .*torque"):
        case["operation.torqe"]


def test_a_key_that_is_not_given_has_its_default(case: Any) -> None:
    key = "solver.method" if case.lumped else "dynamics.modal_damping_ratio"
    assert case[key] == case.option_of(key).default


def test_a_changed_case_knows_the_values_that_it_began_with(case: Any) -> None:
    other = changed(case)
    assert changed_keys(case) == ()
    assert changed_keys(other) == ("operation.torque",)
    assert other.stated.base["operation.torque"] == case["operation.torque"]
    text = other.to_toml()
    again = read_case(text, "case.toml")
    assert "[based_on]" in text
    assert again == other
    assert again.to_toml() == text
    assert changed_keys(again) == ("operation.torque",)
    back = again.replace({"operation.torque": case["operation.torque"]})
    assert back == case
    assert changed_keys(back) == ()


def test_the_table_names_each_value_and_its_origin(case: Any) -> None:
    assert f"Case: {case.title}" in str(case)
    (row,) = (line for line in str(case).splitlines() if line.startswith("  operation.torque "))
    assert "N*m" in row
    assert row.endswith("given")
    assert "<td>operation.torque</td>" in case._repr_html_()


@pytest.mark.parametrize(
    ("name", "key"),
    [("planetary-stage", "planets.low.pin_stiffness"), ("helical-pair", "operation.speed")],
)
def test_a_reason_is_dropped_once_its_value_changes(name: str, key: str) -> None:
    case = td.load_case(name)
    unit = case.option_of(key).unit
    for recorded, stays in ((case[key], True), (1.1 * case[key], False), (None, True)):
        record = f'{{ value = "{recorded!r} {unit}", reason = "a guess" }}'
        reason = '"a guess"' if recorded is None else record
        text = f'{case.to_toml().partition("[assumed]")[0]}\n[assumed]\n"{key}" = {reason}'
        given = read_case(text, "x.toml")
        assert given.assumed == ({key: "a guess"} if stays else {})
        assert (provenance(given)[key] == "assumed: a guess") == stays
        assert key not in given.replace({key: 1.2 * case[key]}).assumed
        other = changed(given)
        again = read_case(other.to_toml(), "x.toml")
        assert again == other
        assert again.assumed == given.assumed


def test_records_of_values_are_checked() -> None:
    wrong = f'{STAGE}\n[based_on]\n"planets.low.normal_module" = "2 kg"\n"planet.x" = 1\n'
    with pytest.raises(InputError) as error:
        read_case(wrong, "x.toml")
    texts = [str(problem) for problem in error.value.problems]
    assert any("x.toml" in text and "2 kg" in text for text in texts)
    assert any('there is no key "planet.x"' in text for text in texts)


def test_a_load_case_is_changed_by_its_name() -> None:
    case = td.load_case("two-stage-spur")
    key = f"load_cases.{case.load_cases[0].name}.speed"
    other = case.replace({key: "1234 rpm"})
    assert other[key] == other.load_cases[0].speed == pytest.approx(1234 * 3.141592653589793 / 30)
    assert changed_keys(other) == (key,)
    with pytest.raises(InputError, match="there is no load case"):
        case.replace({"load_cases.absent.speed": "1 rpm"})


def test_the_former_name_of_a_central_value_stays() -> None:
    case = read_case(STAGE.replace('"600 N*m"', '"600 N*m +- 5 %"'), "x.toml")
    with pytest.warns(DeprecationWarning, match="get"):
        assert case.central("operation.torque") == case["operation.torque"] == 600.0
    assert case.uncertain == {"operation.torque": "600 N*m +- 5 %"}


TEETH = """[gears]  # both
    normal_module = "4.5 mm"   # from the drawing
normal_pressure_angle = "20 deg"
driver = "pinion"

# The pinion is ground.
[gears.pinion]
teeth=27
face_width = "50.0 mm"  # measured
# A table in one line.
modification = { tip_relief = "10 um" }

[gears.wheel]
teeth = 51
face_width = "50 mm"
"""
PAIR = f"""# Above the title.
title = "Two gears"  # the title

{TEETH}
[operation]
speed = "1200 rpm"  # of the motor
torque = "4e2 N*m"

[dynamics]
model = "torsional"
# The end.
"""
MACHINE = """# Above the title.
title = "Two gears"  # the title

# Shafts are rigid.
[gears.z1]  # the driver
shaft = "in"
teeth=27
face_width = "50.0 mm"  # measured
# A table in one line.
modification = { tip_relief = "10 um" }

[gears.z2]
shaft = "out"
teeth = 51
face_width = "50 mm"


[meshes.first]
gears = [
    "z1",  # drives
    "z2",
]
    normal_module = "4.5 mm"   # from the drawing

[lubricant]
name = "ISO VG 220"
temperature = "70 degC"

[operation]
input = "in"
output = "out"
speed = "1200 rpm"  # of the motor
torque = "4e2 N*m"

[[load_cases]]  # the first
name = "slow"
speed = "600 rpm"  # at night

[[load_cases]]  # the second
name = "fast"
torque = "3e2 N*m"  # by day
# The end.
"""
STAGE_TEXT = """# Above the title.
title = "One stage"

[planets.low]  # the stage
sun = "s"
planet = "p"
ring = "r"
carrier = "c"
count = 3
    normal_module = "3 mm"   # from the drawing

[gears]
s = { teeth = 24, face_width = "30.0 mm" }  # measured
p = { teeth = 27, face_width = "30 mm" }
r = { teeth = -78, face_width = "30 mm", rim_diameter = "270 mm" }

[operation]
input = "s"
output = "c"
speed = "1200 rpm"  # of the motor
torque = "4e2 N*m"
"""
TEXTS = {"pair": PAIR, "machine": MACHINE, "stage": STAGE_TEXT}
WIDTHS = {"pair": "gears.pinion", "machine": "gears.z1", "stage": "gears.s"}


@pytest.mark.parametrize("kind", TEXTS)
def test_a_file_is_written_as_it_was_read(kind: str) -> None:
    """Comments, empty lines, indents, lists over lines and numbers as typed."""
    case = read_case(TEXTS[kind], "x.toml")
    assert case.to_toml() == TEXTS[kind]
    assert read_case(TEXTS[kind].replace("\n", "\r\n"), "x.toml").to_toml() == TEXTS[kind]
    key = f"{WIDTHS[kind]}.face_width"
    other = case.replace({"operation.speed": "1300 rpm", key: 0.051, "material.density": 7850.0})
    lines = other.to_toml().partition("\n[based_on]")[0].splitlines()
    new = [line for line in lines if line not in TEXTS[kind].splitlines()]
    assert 'speed = "1300 rpm"' in new
    assert any('face_width = "51 mm"' in line for line in new)
    assert '\n\n[material]\ndensity = "7850 kg/m^3"\n' in other.to_toml()
    again = read_case(other.to_toml(), "x.toml")
    assert again == other
    assert again.to_toml() == other.to_toml()
    back = other.replace({"operation.speed": "1200 rpm", key: case[key], "material": None})
    assert back == case
    assert back.to_toml() == TEXTS[kind].replace("50.0", "50").replace("30.0", "30")


@pytest.mark.parametrize("kind", TEXTS)
def test_a_new_key_is_written_in_its_table(kind: str) -> None:
    keys = {f"{WIDTHS[kind]}.profile_shift_coefficient": -0.1, f"{WIDTHS[kind]}.density": 7850.0}
    other = read_case(TEXTS[kind], "x.toml").replace(keys)
    text = other.to_toml()
    assert text.index("teeth") < text.index("density = ") < text.index("[operation]")
    assert 'density = "7850 kg/m^3"' in text
    assert read_case(text) == other


def test_rows_of_a_list_keep_their_comments() -> None:
    """Each row its own: the first gets a torque, the second keeps that which it has."""
    case = read_case(MACHINE, "x.toml")
    keys = {"load_cases.slow.torque": "200 N*m", "load_cases.fast.speed": "700 rpm"}
    text = case.replace(keys).to_toml()
    slow, fast = text.partition("\n# The end.")[0].split("[[load_cases]]")[1:]
    assert slow.rstrip() == '  # the first\nname = "slow"\nspeed = "600 rpm"  # at night\n' + (
        'torque = "200 N*m"'
    )
    assert fast == '  # the second\nname = "fast"\ntorque = "3e2 N*m"  # by day\nspeed = "700 rpm"'


@pytest.mark.parametrize("kind", TEXTS)
def test_a_case_from_python_has_meanings_as_comments(kind: str) -> None:
    read = read_case(TEXTS[kind], "x.toml")
    case = type(read)(**tomllib.loads(TEXTS[kind]))
    text = case.to_toml()
    lines = text.partition("[assumed]")[0].splitlines()
    assert all("  # " in line for line in lines if line.startswith(("teeth", "speed", "[gears")))
    again = read_case(text, "x.toml")
    assert again == case == read
    assert again.to_toml() == text


@pytest.mark.parametrize("name", td.cases(machines=True))
def test_built_in_files_are_written_as_they_are(name: str) -> None:
    text = all_files()[name].read_text(encoding="utf-8")
    written = [line for line in td.load_case(name).to_toml().splitlines() if "_file" not in line]
    assert written == [line for line in text.splitlines() if "_file" not in line]


@pytest.mark.parametrize("kind", TEXTS)
@pytest.mark.parametrize(
    ("wrong", "right"),
    [("torqe", "torque"), ("operaton", "operation"), ("spede", "speed"), ("teet", "teeth")],
)
def test_a_misspelt_key_is_one_problem(kind: str, wrong: str, right: str) -> None:
    """It is not missing besides, nor is what depends on it."""
    text = re.sub(rf"\b{right}(?=\]|\s*=)", wrong, TEXTS[kind], count=1)
    with pytest.raises(InputError) as error:
        read_case(text, "x.toml")
    (problem,) = error.value.problems
    line = next(n for n, each in enumerate(text.splitlines(), 1) if wrong in each)
    assert str(problem.where).startswith(f"x.toml:{line}: ")
    assert f'Did you mean "{right}"?' in str(problem)


@pytest.mark.parametrize("kind", TEXTS)
def test_a_written_case_keeps_spreads_and_reasons(kind: str) -> None:
    spread = '"4e2 N*m +- 5 %"  # measured'
    reason = '[assumed]\n"operation.speed" = "a guess"  # of the owner\n'
    text = TEXTS[kind].replace('"4e2 N*m"', spread) + f"\n{reason}"
    case = read_case(text, "x.toml")
    assert case.to_toml() == text
    assert case.uncertain == {"operation.torque": "4e2 N*m +- 5 %"}
    assert case["operation.torque"] == 400.0
    other = case.replace({"material.density": 7850.0})
    again = read_case(other.to_toml(), "x.toml")
    assert again == other
    assert again.uncertain == case.uncertain
    assert again.assumed == other.assumed == {"operation.speed": "a guess"}
    assert f"operation.torque = {spread}"[10:] in other.to_toml()
    assert again.replace({"operation.speed": "900 rpm"}).assumed == {}


@pytest.mark.parametrize("kind", TEXTS)
def test_dotted_keys_stay_dotted(kind: str) -> None:
    table = re.search(r"\n\[operation\][^\[]*", TEXTS[kind])
    assert table is not None
    dotted = re.sub(
        r"(?m)^(\s*)(\w+)(\s*=)", r"\1operation.\2\3", table[0].replace("[operation]", "")
    )
    text = dotted + TEXTS[kind].replace(table[0], "\n")
    case = read_case(text, "x.toml")
    assert case == read_case(TEXTS[kind], "x.toml")
    assert case.to_toml() == text
    other = case.replace({"operation.speed": "1300 rpm"})
    assert 'operation.speed = "1300 rpm"' in other.to_toml()
    assert "[operation]" not in other.to_toml()
    assert read_case(other.to_toml()) == other
