"""Machines written as gearbox models: read back without loss, and without the stored case."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.exchange import machine_from_rexs, read_rexs, stage_from_rexs, write_rexs
from tribodyn.exchange.rexs_file import WHOLE_CASE
from tribodyn.machine import TaperedRollerBearing
from tribodyn.study import MachineCase

MACHINES = ("two-stage-spur", "two-stage-helical", "planetary-stage", "wind-turbine-gearbox")
BEARINGS = {
    "type": "tapered-roller", "bore_diameter": 0.04, "outer_diameter": 0.09, "width": 0.023,
    "contact_angle": 0.25, "direction": -1,
}  # fmt: skip


def stripped(path: Path) -> Path:
    """The model as a file of another program: without the stored case."""
    tree = json.loads(path.read_text("utf-8"))
    for part in tree["model"]["components"]:
        part["attributes"] = [a for a in part["attributes"] if a["id"] != WHOLE_CASE]
    other = path.with_name("stripped.rexsj")
    other.write_text(json.dumps(tree), "utf-8")
    return other


@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_reads_back_without_loss_and_what_is_missing_is_named(
    name: str, tmp_path: Path
) -> None:
    case = td.load_case(name)
    for ending in ("rexs", "rexsj", "rexsz"):
        path = tmp_path / ending / f"{name}.{ending}"
        path.parent.mkdir()
        omitted = write_rexs(case, path)
        again = td.load_case(path)
        assert dict(again.values()) == dict(case.values())
        assert again.housing_files.keys() == case.housing_files.keys()
        if case.housing is None:
            assert again == case
        else:
            assert Path(again.housing_files["mass_file"]).parent == path.parent
            assert np.array_equal(again.housing.stiffness, case.housing.stiffness)
        assert {"film", "dynamics", "lubricant.name"} <= set(omitted)
        assert not {"operation.input", "operation.output", "shafts", "meshes"} & set(omitted)


@pytest.mark.parametrize("name", MACHINES)
def test_the_model_alone_has_the_kinematics_positions_and_teeth_of_the_machine(
    name: str, tmp_path: Path
) -> None:
    case, path = td.load_case(name), tmp_path / "machine.rexsj"
    write_rexs(case, path)
    other = machine_from_rexs(read_rexs(stripped(path)))
    assert len(other.load_cases) == len(case.load_cases)
    for load, load_again in zip(
        case.load_cases or [case.operating_point],
        other.load_cases or [other.operating_point],
        strict=True,
    ):
        assert load_again.speed == pytest.approx(load.speed, rel=1e-12)
        assert load_again.torque == pytest.approx(load.torque, rel=1e-12)
        assert load_again.share == pytest.approx(load.share)
        flows = [c.machine(n).kinematics for c, n in ((case, load), (other, load_again))]
        frequencies = [sorted(m.mesh_frequency for m in f.meshes.values()) for f in flows]
        assert frequencies[1] == pytest.approx(frequencies[0], rel=1e-12)
        speeds = [sorted(s.speed for s in f.shafts.values()) for f in flows]
        assert speeds[1] == pytest.approx(speeds[0], rel=1e-9, abs=1e-9)
    machines = case.machine(), other.machine()
    places = [np.array([*m.placement.gears.values()]) for m in machines]
    order = [np.lexsort(place.T.round(9)) for place in places]
    assert places[1][order[1]] == pytest.approx(places[0][order[0]], abs=1e-12)
    for mesh, mesh_again in zip(case.meshes_with_teeth, other.meshes_with_teeth, strict=True):
        pairs = [
            c.pair(m, c.operating_point).gear_pair for c, m in ((case, mesh), (other, mesh_again))
        ]
        figures = [
            (p.transverse_contact_ratio, p.overlap_ratio, abs(p.center_distance), p.hand == "right",
             p.pinion.profile_shift_coefficient, p.wheel.tip_diameter)
            for p in pairs
        ]  # fmt: skip
        assert figures[1] == pytest.approx(figures[0], rel=1e-9)
    sizes = [[b.rolling for b in c.bearings.values() if b.rolling] for c in (case, other)]
    assert [type(b) for b in sizes[1]] == [type(b) for b in sizes[0]]
    assert [b.bore_diameter for b in sizes[1]] == pytest.approx([b.bore_diameter for b in sizes[0]])
    stiff = [
        [b.radial_stiffness for b in c.bearings.values() if b.axial_stiffness]
        for c in (case, other)
    ]
    if name == "wind-turbine-gearbox":
        assert stiff == [pytest.approx([2e9, 1.5e9])] * 2
    if name == "planetary-stage":
        assert stage_from_rexs(read_rexs(stripped(path))) == other


def test_changes_by_another_program_reach_the_machine_and_are_reported(tmp_path: Path) -> None:
    case, path = td.load_case("two-stage-helical"), tmp_path / "machine.rexsj"
    write_rexs(case, path)
    text = path.read_text("utf-8")
    assert text.count('"floating_point": 190.0') == 1
    path.write_text(text.replace('"floating_point": 190.0', '"floating_point": 250.0'), "utf-8")
    model = read_rexs(path)
    changed = machine_from_rexs(model)
    assert changed.load_cases[0].torque == 250.0
    assert "load_cases.slow.torque was changed to 250 (SI) by another program" in model.remarks
    assert changed["film.model"] == case["film.model"]


def test_tapered_bearings_other_axes_and_reversed_speeds_survive(tmp_path: Path) -> None:
    changes: dict[str, Any] = {f"bearings.B.{key}": value for key, value in BEARINGS.items()}
    changes |= {"operation.speed": -100.0, "meshes.second.angle": -2.0}
    changes |= {f"bearings.{name}.node": None for name in "ABCDEF"}
    case = td.load_case("two-stage-spur").replace({**changes, "housing": None, "load_cases": None})
    path = tmp_path / "machine.rexsj"
    write_rexs(case, path)
    other = machine_from_rexs(read_rexs(stripped(path)))
    assert other.operating_point.speed == pytest.approx(-100.0)
    assert other.operating_point.torque == pytest.approx(case.operating_point.torque)
    bearing = next(
        b.rolling for b in other.bearings.values() if isinstance(b.rolling, TaperedRollerBearing)
    )
    assert bearing.direction == -1
    assert bearing.contact_angle == pytest.approx(0.25)
    angles = sorted(mesh.angle for mesh in other.machine().meshes.values())
    assert angles == pytest.approx([-2.0, 0.0])


def test_what_has_no_stage_in_a_model_is_refused_by_name(tmp_path: Path) -> None:
    data = td.load_case("planetary-stage").data
    gears = {**data["gears"], "outer": data["gears"]["planet"]}
    low = {**data["planets"]["low"], "ring_planet": "outer", "planet_type": "stepped"}
    stepped = MachineCase(**{**data, "gears": gears, "planets": {"low": low}})
    constant = td.load_case("two-stage-spur").replace({"meshes.first.stiffness": 5e8})
    for case, message in (
        (td.load_case("hypoid-axle"), "not a cylindrical stage"),
        (stepped, "planets of two gears"),
        (constant, r"meshes\.first\.stiffness: a mesh with a constant stiffness has no teeth"),
    ):
        with pytest.raises(InputError, match=message):
            write_rexs(case, tmp_path / "machine.rexs")


def test_the_official_name_of_roller_bearings_is_read(tmp_path: Path) -> None:
    """REXS 1.0 to 1.4 call a cylindrical roller bearing a radial roller bearing."""
    path = tmp_path / "machine.rexs"
    write_rexs(td.load_case("two-stage-spur"), path)
    text = path.read_text("utf-8")
    assert text.count("radial_roller_bearing") == 3
    assert text.count("radial_grooved_ball_bearing") == 3
    assert math.isclose(
        float(text.partition('"inner_diameter" unit="mm">')[2].partition("<")[0]), 30.0
    )
