"""Warnings and figures of film and friction count contacts that carry load."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import ModelWarning, collected
from tribodyn.mesh import MeshTable
from tribodyn.plot import FIGURES
from tribodyn.study.mesh_inputs import mesh_inputs
from tribodyn.study.pipeline.cautions import MeshWarning, mesh_cautions, warn_of_meshes
from tribodyn.study.pipeline.tooth_contact import hypoid_friction_of, mesh_of

RELIEVED: dict[str, Any] = {
    "stiffness.model": "analytic",
    "film.model": "dowson-higginson",
    "friction.law": "xu-2007",
    "gears.pinion.modification.tip_relief": "60 um",
    "gears.pinion.modification.tip_relief_length": "4 mm",
    "gears.wheel.modification.tip_relief": "60 um",
    "gears.wheel.modification.tip_relief_length": "4 mm",
}


def mesh(case: Any, **options: Any) -> tuple[MeshTable, dict[str, str]]:
    with collected() as warnings:
        table = mesh_of(case, **options)
    return table, {each.code: each.message for each in warnings}


@pytest.fixture(scope="module")
def relieved() -> Any:
    return td.load_case("fzg-roughness").replace(RELIEVED)


@pytest.mark.parametrize("law", ["xu-2007", "mixed"])
def test_a_law_is_judged_at_contacts_that_carry(relieved: Any, law: str) -> None:
    table, warnings = mesh(relieved.replace({"friction.law": law}))
    assert np.any(table.in_contact & (table.load_share == 0.0))
    low, high = map(float, re.findall(r"hertz_pressure ([\d.]+) to ([\d.]+) GPa",
                                      warnings["friction-range"])[0])  # fmt: skip
    # A quarter of the load per width: half the pressure, for radii that hardly differ.
    load = table.load_per_width
    judged = 1e-9 * table.hertz_pressure[load >= 0.25 * load.max()]
    assert (low, high) == pytest.approx((judged.min(), judged.max()), rel=1e-3)
    assert low > 0.4 * high


def test_pairs_that_do_not_touch_warn_of_nothing(relieved: Any) -> None:
    heavy = relieved.replace({"operation.torque": "300 N*m", "operation.speed": "1000 rpm"})
    table, warnings = mesh(heavy)
    load, pressure = table.load_per_width, table.hertz_pressure
    carry = load >= 0.25 * load.max()
    assert pressure[carry].min() > 0.5e9 > pressure[table.in_contact].min()
    assert "hertz_pressure" not in warnings.get("friction-range", "")
    assert "film-range" not in warnings


def test_friction_is_the_same_whether_it_warns_or_not(relieved: Any) -> None:
    table, _ = mesh(relieved)
    constant, warnings = mesh(relieved.replace({"friction.law": "none"}))
    assert np.array_equal(table.load_share, constant.load_share)
    carry = table.load_share > 1e-3
    assert np.all(table.friction_coefficient[carry] >= 0.0)
    assert "friction-range" not in warnings


@pytest.mark.parametrize("name", ["friction", "film", "lubrication"])
def test_curves_have_gaps_where_no_load_is_carried(relieved: Any, name: str) -> None:
    table, _ = mesh(relieved.replace({"friction.law": "mixed"}))
    touching = table.in_contact.T
    carries = table.load_share.T[touching] > 1e-3
    assert 0.3 < carries.mean() < 0.95
    figure = FIGURES[name](table)
    names_of_curves = {"friction": ["friction coefficient", "friction force"],
                       "film": ["in the centre", "at its thinnest", "film ratio"],
                       "lubrication": ["film ratio", "oil film", "asperities"]}[name]  # fmt: skip
    curves = [trace for trace in figure.data if trace.name in names_of_curves]
    assert len(curves) >= 2
    for trace in curves:
        assert np.array_equal(np.isfinite(np.asarray(trace.y, dtype=float)), carries), trace.name
    assert "no load" in FIGURES[name].caption_of(table)
    plain, _ = mesh(td.load_case("fzg-roughness").replace({"film.model": "dowson-higginson"}))
    assert "no load" not in FIGURES[name].caption_of(plain)


def hypoid(**changes: Any) -> MeshTable:
    case = td.load_case("hypoid-mixed-ehl").replace(
        {"gears.composite_roughness": 0.6e-6, "operation.speed": "600 rpm",
         **{name.replace("__", "."): value for name, value in changes.items()}}
    )  # fmt: skip
    return mesh(case, rehearsal=True)[0]


@pytest.mark.parametrize("teeth", [(10, 43), (11, 39)])
@pytest.mark.parametrize("law", ["mixed", "mixed-ehl", "constant"])
def test_the_advice_of_mixed_lubrication_follows_the_law(law: str, teeth: tuple[int, int]) -> None:
    coefficient = {"friction__coefficient": 0.05} if law == "constant" else {}
    changes = {"gears__pinion__teeth": teeth[0], "gears__wheel__teeth": teeth[1]}
    table = hypoid(friction__law=law, **coefficient, **changes)
    (advice,) = (each.message for each in mesh_cautions(table) if each.code == "mixed-lubrication")
    assert ('friction.law = "mixed"' in advice) == (law == "constant")
    assert ("so is the friction" in advice) == (law == "constant")
    assert "film stiffness" not in advice  # there is none in a formula of the ellipse
    (share,) = map(float, re.findall(r"up to (\d+)% of the load", advice))
    assert 20.0 < share < 100.0


def test_the_caption_of_film_on_the_flank_names_the_lines_that_are_drawn() -> None:
    with collected():
        rich = hypoid_friction_of(mesh_inputs(td.load_case("hypoid-mixed-ehl")))
    figure = FIGURES["hypoid_friction"]
    assert "full film lubrication everywhere" in figure.caption_of(rich)
    assert "lines at" not in figure.caption_of(rich)
    thin = td.load_case("hypoid-mixed-ehl").replace(
        {"gears.composite_roughness": 0.2e-6, "operation.speed": "1500 rpm"}
    )
    with collected():
        rubbed = hypoid_friction_of(mesh_inputs(thin))
    assert "lines at 2 separate" in figure.caption_of(rubbed)


@pytest.mark.parametrize(
    ("name", "torque", "warned"),
    [
        ("helical-pair", 1.0, False),
        ("hypoid-mixed-ehl", 1.0, False),
        ("hypoid-mixed-ehl", 0.1, True),
        ("time-varying-friction", 1.0, True),
    ],
)
def test_a_built_in_pair_warns_where_a_real_part_of_the_load_is_outside(
    name: str, torque: float, warned: bool
) -> None:
    case = td.load_case(name)
    case = case.replace({"operation.torque": torque * case.operation.torque})
    _, warnings = mesh(case, rehearsal=True)
    assert ("friction-range" in warnings) == warned


@pytest.mark.parametrize("case", ["fzg-roughness", "helical-pair"])
def test_the_part_of_the_load_outside_is_that_of_the_table(case: str) -> None:
    law = {"friction.law": "xu-2007", "film.model": "dowson-higginson"}
    if case == "fzg-roughness":
        law |= {"operation.speed": "1500 rpm", "gears.composite_roughness": "0.4 um"}
    parts = []
    for torque in (3.0, 1.0, 0.25, 0.1):
        changed = td.load_case(case)
        force = {"operation.torque": torque * changed.operation.torque}
        table, warnings = mesh(changed.replace({**law, **force}))
        load, pressure = table.load_per_width, table.hertz_pressure
        judged = load >= 0.25 * load.max()
        ratio = np.abs(table.slide_to_roll_ratio)
        outside = judged & ((pressure < 0.5e9) | (ratio > 1.0))
        outside |= judged & ((table.equivalent_radius < 5e-3) | (table.entrainment_speed < 1.0))
        part = float(load[outside].sum() / load.sum())
        assert ("friction-range" in warnings) == (part >= 0.2), (part, warnings)
        if part >= 0.2:
            stated = re.findall(
                r"(\d+)% of the load .less than 20% is not reported", warnings["friction-range"]
            )
            assert [int(each) for each in stated] == [pytest.approx(100.0 * part, abs=1.0)]
        parts.append(part)
    assert max(parts[0], 0.2) < parts[-1]


def test_meshes_of_a_machine_are_counted_in_one_warning_of_each_law() -> None:
    def of(mesh: str, part: float | None, quantity: str) -> MeshWarning:
        text = f"xu-2007: {quantity} 0.3 to 0.7, fitted for 1 to 2. Compare."
        return MeshWarning(mesh, "operation", ModelWarning("friction-range", text, part))

    listed = [of("a", 0.3, "pressure"), of("b", 0.9, "speed"), of("c", 0.25, "pressure")]
    with collected() as warnings:
        warn_of_meshes(listed)
    assert len(warnings) == 1
    assert warnings[0].message == (
        "mesh b, operation: xu-2007: speed 0.3 to 0.7, fitted for 1 to 2. Compare. "
        "The same in mesh a, operation (30%); mesh c, operation (25%)."
    )
    with collected() as warnings:
        warn_of_meshes([of("a", None, "pressure"), of("b", None, "speed")])
    assert len(warnings) == 2
