"""Changes by dotted key: parts that do not exist are named; rows and lists may have spreads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.study import read_case
from tribodyn.study.case.user_input import with_values


@pytest.mark.parametrize(
    ("name", "key", "known"),
    [
        ("two-stage-spur", "gears.z9.teeth", "z1, z2, z3, z4"),
        ("two-stage-spur", "meshes.frist.backlash", 'Did you mean "first"'),
        ("two-stage-spur", "load_cases.slwo.speed", 'Did you mean "slow"'),
        ("hypoid-axle", "bearings.frnt.clearance", "Known:"),
        ("planetary-stage", "planets.lwo.pin_stiffness", 'Did you mean "low"'),
        ("fzg-film", "faults.crack.depth", "give also kind"),
        ("helical-pair", "faults.crack.depth", "Known: none"),
    ],
)
@pytest.mark.parametrize("by", ["", "--set"])
def test_a_part_that_does_not_exist_is_named(name: str, key: str, known: str, by: str) -> None:
    case = td.load_case(name)
    with pytest.raises(InputError) as refused:
        case.replace({key: 3.0}, by=by)
    (problem,) = refused.value.problems
    assert str(problem.where) == f"{by or 'replace:'} {key}"
    assert f'"{key.split(".")[1]}"' in problem.what
    assert known in str(problem)


def test_a_part_may_be_added_as_a_whole() -> None:
    case = td.load_case("two-stage-spur")
    fault = {"kind": "eccentricity", "gear": "z1", "amplitude": 1e-5}
    whole = case.replace({"faults.run": fault})
    assert whole == case.replace({f"faults.run.{key}": value for key, value in fault.items()})
    assert whole["faults.run.amplitude"] == 1e-5


@pytest.mark.parametrize(
    ("name", "key", "middle", "change"),
    [
        ("two-stage-spur", "load_cases.slow.torque", "180 N*m", 200.0),
        ("two-stage-spur", "load_cases.cruise.speed", "700 rpm", 80.0),
        ("planetary-stage", "planets.low.pin_errors.2", "3 um", 2e-6),
        ("fzg-film", "operation.torque", "90 N*m", 95.0),
    ],
)
def test_values_in_lists_have_spreads(name: str, key: str, middle: str, change: float) -> None:
    case = td.load_case(name).replace({key: f"{middle} +- 5 %"})
    assert case.uncertain == {key: f"{middle} +- 5 %"}
    assert read_case(case.to_toml(), "x.toml").uncertain == case.uncertain
    assert case.replace({"solver.coupling_tolerance": 1e-5}).uncertain == case.uncertain
    certain = case.replace({key: change})
    assert (certain.uncertain, certain[key]) == ({}, pytest.approx(change))
    for text, problem in (("1 kg +- 5 %", "kg"), ("1e12 rad +- 5 %", "1e12")):
        with pytest.raises(InputError, match=problem):
            case.replace({key: text})


def test_a_spread_load_case_is_drawn() -> None:
    case = td.load_case("two-stage-spur").replace({"load_cases.slow.torque": "180 N*m +- 5 %"})
    drawn = [case.replace({"load_cases.slow.torque": value}) for value in (171.0, 189.0)]
    assert [each.load_cases[0].torque for each in drawn] == [171.0, 189.0]
    assert case.load_cases[0].torque == pytest.approx(180.0)


def test_a_law_of_a_machine_takes_its_options_along() -> None:
    case = td.load_case("two-stage-spur").replace(
        {"friction.law": "constant", "friction.coefficient": 0.05}
    )
    other = case.replace({"friction.law": "xu-2007"})
    assert "friction.coefficient" not in dict(other.values())
    with pytest.raises(InputError, match=r"friction\.coefficient"):
        case.replace({"friction.law": "xu-2007", "friction.coefficient": 0.06})


def test_values_are_set_in_tables_rows_and_lists() -> None:
    data: dict[str, Any] = {
        "a": {"x": 1},
        "rows": [{"name": "r", "v": 1}, {"v": 2}],
        "n": {"l": [1, 2]},
    }
    changed = with_values(data, {"a.x": None, "a.b.c": 3, "rows.r.v": 4, "rows.2.v": 5, "n.l.2": 6})
    assert changed == {
        "a": {"b": {"c": 3}},
        "rows": [{"name": "r", "v": 4}, {"v": 5}],
        "n": {"l": [1, 6]},
    }
    assert data["rows"][0]["v"] == data["a"]["x"] == 1
    assert np.array_equal(data["n"]["l"], [1, 2])
    for key in ("a.x.y", "n.l.3", "rows.q", "rows.3.v"):
        with pytest.raises(InputError):
            with_values(data, {key: 1})
    named, numbered = data["rows"]
    assert with_values(data, {"rows.r": None})["rows"] == [numbered]
    assert with_values(data, {"rows.1": None, "rows.2.v": 3})["rows"] == [{"v": 3}]
    assert with_values(data, {"rows.2": {"v": 7}})["rows"] == [named, {"v": 7}]
    assert "rows" not in with_values(data, {"rows.2": None, "rows.r": None})
    twice = {"rows": [named, {**named, "v": 9}]}
    assert with_values(twice, {"x": 1})["rows"] == twice["rows"]
