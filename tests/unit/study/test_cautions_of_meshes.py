"""A mesh of a machine or a stage is warned of as the pair of its gears is."""

from __future__ import annotations

from typing import Any

import pytest

import tribodyn as td
from tribodyn.study import Case, MachineCase
from tribodyn.study.machine.run import balanced_machine
from tribodyn.study.pipeline.cautions import mesh_cautions

CODES = {"mixed-lubrication", "hertz-pressure", "contact-ratio-reduced", "relief-large"}
GEAR = {"face_width": "6 mm", "roughness_ra": "0.8 um", "modification": {"tip_relief": "300 um"}}
MODELS = {"friction": {"law": "constant", "coefficient": 0.05}, "stiffness": {"model": "iso6336"}}
OIL = {"name": "ISO VG 32", "temperature": "90 degC"}
POINT = {"speed": "300 rpm", "torque": "220 N*m"}


def codes(warnings: Any) -> set[str]:
    return CODES & {warning.code for warning in warnings}


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_a_machine_of_two_gears_warns_as_its_pair() -> None:
    gears = {"pinion": {"teeth": 20, **GEAR}, "wheel": {"teeth": 41, **GEAR}, "driver": "pinion"}
    gears |= {"normal_module": "3 mm", "normal_pressure_angle": "20 deg"}
    film = {"model": "dowson-higginson"}
    pair = td.run(Case(
        gears=gears, lubricant=OIL, film=film, **MODELS, operation=POINT,
        dynamics={"model": "torsional", "backlash": "0.1 mm"},
    ))  # fmt: skip
    machine = td.run(MachineCase(
        gears={"a": {"shaft": "in", "teeth": 20, **GEAR},
               "b": {"shaft": "out", "teeth": 41, **GEAR}},
        meshes={"m": {"gears": ["a", "b"], "normal_module": "3 mm", "backlash": "0.1 mm"}},
        lubricant=OIL, film=film, **MODELS, operation={"input": "in", "output": "out", **POINT},
    ))  # fmt: skip
    assert codes(pair.warnings) >= {"mixed-lubrication", "hertz-pressure"}
    assert codes(machine.warnings) == codes(pair.warnings)
    texts = {warning.code: warning.message for warning in machine.warnings}
    for warning in pair.warnings:
        if warning.code in CODES:
            assert texts[warning.code] == f"mesh m, operation: {warning.message}"


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("name", ["planetary-stage", "hypoid-axle"])
def test_films_that_do_not_separate_the_flanks_are_said_once_with_all_meshes(name: str) -> None:
    case = td.load_case(name).replace({"load_cases": None})
    state = balanced_machine(case, case.operating_point)
    mixed = [each.mesh for each in state.warnings if each.warning.code == "mixed-lubrication"]
    touching = [
        mesh
        for mesh, table in state.tables.items()
        if any(each.code == "mixed-lubrication" for each in mesh_cautions(table))
    ]
    assert touching
    assert mixed == touching
    (said,) = [w.message for w in td.run(case).warnings if w.code == "mixed-lubrication"]
    assert all(f"mesh {mesh}, operation" in said for mesh in touching)
