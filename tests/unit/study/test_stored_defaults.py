"""A stored result keeps the defaults with which it was computed, whatever those of its reader."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from broken import SOUND

import tribodyn as td
from tribodyn.study import MachineCase, read_case
from tribodyn.study.case.sections import Dynamics, Solver
from tribodyn.study.machine.tables import MotionTable

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
GEAR = {"face_width": "20 mm"}
POINT = {"speed": "1500 rpm", "torque": "90 N*m"}
RATIO, TOLERANCE = "dynamics.mesh_damping_ratio", "solver.coupling_tolerance"


def pair() -> Any:
    return read_case(SOUND, "pair.toml")


def machine() -> Any:
    return MachineCase(
        gears={"a": {"shaft": "in", "teeth": 20, **GEAR},
               "b": {"shaft": "out", "teeth": 41, **GEAR}},
        meshes={"m": {"gears": ["a", "b"], "normal_module": "3 mm", "backlash": "0.1 mm"}},
        friction={"law": "constant", "coefficient": 0.05}, stiffness={"model": "iso6336"},
        operation={"input": "in", "output": "out", **POINT},
    )  # fmt: skip


def stage() -> Any:
    return td.load_case("planetary-stage").replace({"load_cases": None})


def with_default(patch: pytest.MonkeyPatch, table: Any, name: str, value: Any) -> None:
    patch.setitem(table.fields, name, replace(table.fields[name], default=value))


@pytest.mark.parametrize("make", [pair, machine, stage])
def test_defaults_of_another_version_do_not_change_a_stored_result(
    make: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = make().replace({RATIO: None})
    result = td.run(case)
    folder = result.save(tmp_path / "run")
    assert td.load_result(folder).case == case
    with_default(monkeypatch, Dynamics, "mesh_damping_ratio", 0.09)
    with_default(monkeypatch, Solver, "coupling_tolerance", 1e-3)
    with_default(monkeypatch, MotionTable, "harmonics", 7)
    assert td.run(make().replace({RATIO: None})).summary() != result.summary()
    again = td.load_result(folder)
    assert again.case[RATIO] == pytest.approx(0.04)
    assert again.case[TOLERANCE] in (1e-6, None)
    if not case.lumped:
        assert again.case.motion.harmonics == 20
    assert td.run(again.case).summary() == pytest.approx(dict(result.summary()))
