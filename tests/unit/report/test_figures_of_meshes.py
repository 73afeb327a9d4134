"""The report of a machine has the figures of the teeth that the report of a pair has."""

from __future__ import annotations

from typing import Any

import pytest
from tests.unit.study.test_cautions_of_meshes import pair_and_machine

import tribodyn as td
from tribodyn.report.figure_blocks import HYPOID_SECTIONS, SECTIONS, figure_blocks

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
OF_TEETH = SECTIONS[: SECTIONS.index("mesh_force")]


def figures(result: Any) -> dict[str, Any]:
    return {block.name: block for block in figure_blocks(result) if not block.missing}


@pytest.mark.parametrize("helix", [{}, {"helix_angle": "12 deg"}])
def test_a_mesh_has_the_figures_of_its_pair(helix: dict[str, str]) -> None:
    gear = {"face_width": "20 mm", "modification": {"tip_relief": "10 um"}, "roughness_ra": "1 um"}
    parts = {"teeth": 20, **gear}, {"teeth": 41, **gear}
    point = {"speed": "1500 rpm", "torque": "90 N*m"}
    oil = {"lubricant": {"name": "ISO VG 100", "temperature": "60 degC"}, "film": {"model": "moes"}}
    cases = pair_and_machine(*parts, point, geometry=helix, models=oil, backlash="0.1 mm")
    of_pair, of_machine = (figures(td.run(case)) for case in cases)
    teeth = [name for name in of_pair if name in (*OF_TEETH, "face_maps")]
    assert len(teeth) >= 8
    for name in teeth:
        block = of_machine[f"{name.replace('_', '-')}-1"]
        assert block.heading.lower() == f"mesh m: {of_pair[name].heading.lower()}"
        assert block.topic == of_pair[name].topic


@pytest.mark.slow
def test_hypoid_teeth_and_planets_have_theirs() -> None:
    axle = figures(td.run(td.load_case("hypoid-axle").replace({"load_cases": None})))
    names = HYPOID_SECTIONS[: HYPOID_SECTIONS.index("mesh_force")]
    assert {f"{name.replace('_', '-')}-1" for name in names} <= {*axle}
    stage = figures(td.run(td.load_case("planetary-stage").replace({"load_cases": None})))
    sharing = [block.heading for name, block in stage.items() if name.startswith("load-sharing")]
    assert sharing == ["Mesh low_sun1: load sharing", "Mesh low_ring1: load sharing"]
