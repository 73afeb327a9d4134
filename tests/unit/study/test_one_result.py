"""One class holds the result of a case of any kind: what all results have, and what they do not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.study import MachineResult, PairResult, run

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

KINDS = {"pair": PairResult, "machine": MachineResult, "hypoid": PairResult}


@pytest.fixture(scope="module", params=KINDS)
def kind(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def result(kind: str) -> Any:
    if kind == "machine":
        return td.run("two-stage-spur")
    return td.run("fzg-stiffness" if kind == "pair" else "hypoid-mixed-ehl")


def test_a_result_of_any_kind_is_of_the_one_class(kind: str, result: Any, tmp_path: Path) -> None:
    for each in (result, td.load_result(result.save(tmp_path / "result"))):
        assert type(each) is KINDS[kind]
        assert isinstance(each, td.Result)
        assert repr(each).startswith('Result("')
        assert each.assumptions == tuple(each.case.assumptions)


def test_the_first_mesh_of_every_kind_has_its_errors_at_rest(result: Any) -> None:
    assert result.mesh is next(iter(result.tables.values()))
    at_rest = result.mesh.transmission_error_at_rest
    np.testing.assert_array_equal(result.transmission_error_at_rest(), at_rest)
    phase = result.mesh.phase[3:5]
    np.testing.assert_allclose(result.transmission_error_at_rest(phase), at_rest[3:5], rtol=1e-9)
    assert result.half_backlash >= 0.0
    if result.mesh.gears is not None:
        loaded = result.loaded_contact()
        assert loaded.torque == pytest.approx(result.mesh.pinion_torque)


def test_an_attribute_of_another_kind_is_named(kind: str, result: Any) -> None:
    name, owner = ("damping", "a pair of gears") if kind == "machine" else ("machine", "a machine")
    assert not hasattr(result, name)
    with pytest.raises(AttributeError, match=f"has no {name}: that is of {owner}$"):
        getattr(result, name)
    with pytest.raises(AttributeError, match=r"has no nonsense$"):
        result.nonsense  # noqa: B018


def test_the_class_shows_the_members_of_every_kind() -> None:
    for member in ("damping", "natural_modes", "operation", "load_cases", "mounting_study"):
        assert member in td.Result.__annotations__


@pytest.mark.filterwarnings("default::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("name", ["time-varying-friction", "two-stage-spur"])
def test_one_function_runs_a_case_of_any_kind(name: str) -> None:
    case = td.load_case(name).replace({"operation.torque": "5 N*m"})
    with pytest.warns(td.ModelWarning) as caught:
        result = run(case)
    assert isinstance(result, td.Result)
    assert [str(each.message) for each in caught] == [str(each) for each in result.warnings]
    assert {each.filename for each in caught} == {__file__}


def test_what_follows_a_pair_is_refused_for_a_machine() -> None:
    with pytest.raises(td.InputError, match="follow"):
        run(td.load_case("two-stage-spur"), follow=lambda case, mesh: case)


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_a_machine_without_computed_teeth_says_so() -> None:
    gears = {"a": {"shaft": "in", "teeth": 20}, "b": {"shaft": "out", "teeth": 41}}
    case = td.study.Case(
        gears={name: {**gear, "face_width": "10 mm"} for name, gear in gears.items()},
        meshes={"m": {"gears": ["a", "b"], "normal_module": "3 mm", "stiffness": "2e8 N/m"}},
        operation={"input": "in", "output": "out", "speed": "1000 rpm", "torque": "50 N*m"},
    )  # fmt: skip
    result = run(case)
    for of in (
        result.loaded_contact, result.transmission_error_at_rest, lambda: result.static_error(0.0),
        lambda: result.half_backlash,
    ):  # fmt: skip
        with pytest.raises(td.InputError, match="no mesh whose teeth are computed"):
            of()
