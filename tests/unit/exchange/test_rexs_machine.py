"""Machines of gearbox models: positions, kinematics, bearings, and what is missing."""

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
from tribodyn.gear import zero_backlash_center_distance
from tribodyn.machine import DeepGrooveBallBearing, TaperedRollerBearing, static_balance
from tribodyn.study import MachineCase, read_case

MODELS = Path(__file__).parents[2] / "references" / "rexs"
RPM = math.pi / 30.0
STIFF = {"meshes.stage_19.stiffness": 5e8, "meshes.stage_20.stiffness": 6e8}
#: Share, speed and torque of the input, and the speeds and mesh frequencies of its data sheet.
LOADS = [
    (0.20, 543.0, 567.0, 244.35, 287.47, 110.197, 194.465),
    (0.30, 3456.0, 345.0, 1555.2, 1829.65, 701.365, 1237.702),
    (0.35, 1234.0, 456.0, 555.3, 653.29, 250.429, 441.934),
    (0.15, 789.0, 789.0, 355.05, 417.71, 160.121, 282.566),
]


def helical(ending: str = "rexs", **changes: Any) -> MachineCase:
    return machine_from_rexs(read_rexs(MODELS / f"two_stages.{ending}"), changes=STIFF | changes)


@pytest.fixture
def tree() -> dict[str, Any]:
    model: dict[str, Any] = json.loads((MODELS / "two_stages.rexsj").read_text(encoding="utf-8"))
    return model


def part(tree: dict[str, Any], number: int) -> dict[str, Any]:
    """Attributes of a component by name."""
    (component,) = (c for c in tree["model"]["components"] if c["id"] == number)
    return {a["id"]: a for a in component["attributes"]}


def add(tree: dict[str, Any], number: int, unit: str = "mm", **values: Any) -> None:
    """Set values of a component."""
    (component,) = (c for c in tree["model"]["components"] if c["id"] == number)
    kept = [a for a in component["attributes"] if a["id"] not in values]
    component["attributes"] = kept + [
        {"id": name, "unit": unit, "floating_point": value} for name, value in values.items()
    ]


def stored(tree: dict[str, Any], folder: Path) -> Path:
    path = folder / "model.rexsj"
    path.write_text(json.dumps(tree), encoding="utf-8")
    return path


def straight(tree: dict[str, Any]) -> dict[str, Any]:
    """The gearbox with straight teeth at the centre distances that fit their shifts."""
    for gear in (15, 16, 17, 18):
        add(tree, gear, "deg", helix_angle_reference_diameter=0.0)
    for stage, teeth, module, shift in ((19, 78, 4.5e-3, 0.46283), (20, 57, 6.5e-3, 0.30148)):
        distance = zero_backlash_center_distance(teeth, module, math.radians(20.0), shift)
        add(tree, stage, center_distance=1e3 * distance)
    return tree


@pytest.mark.parametrize("ending", ["rexs", "rexsj"])
def test_speeds_and_mesh_frequencies_are_those_of_the_data_sheet(ending: str) -> None:
    case = helical(ending)
    assert len(case.load_cases) == 4
    for load, (share, speed, torque, first, middle, second, last) in zip(
        case.load_cases, LOADS, strict=True
    ):
        assert (load.share, load.torque) == (pytest.approx(share), torque)
        machine = case.machine(load)
        flow = machine.kinematics
        speeds = [flow.shafts[f"shaft_{n}"].speed / RPM for n in (12, 13, 14)]
        assert speeds == pytest.approx([speed, -middle, last], rel=1e-5)
        frequencies = [flow.meshes[f"stage_{n}"].mesh_frequency for n in (19, 20)]
        assert frequencies == pytest.approx([first, second], rel=5e-6)
        assert flow.shafts["shaft_14"].torque == pytest.approx(torque * 2.79227, rel=1e-5)
    assert dict(machine.clock.cycles) == {"stage_19": 51, "stage_20": 23}
    assert case.operating_point.speed == pytest.approx(543.0 * RPM)
    assert case.ends == ("shaft_12", "shaft_14")


def test_xml_and_json_give_the_same_machine() -> None:
    assert helical("rexs").to_toml() == helical("rexsj").to_toml()


def test_parts_are_where_the_file_has_them_in_space() -> None:
    """The file has the corner of each shaft in space; ours follow from meshes and positions."""
    machine = helical().machine()
    corners = {12: (-70.0, 0.0, 0.0), 13: (-25.0, 0.0, -190.0), 14: (90.0, 0.0, 0.0)}
    for number, corner in corners.items():
        expected = 1e-3 * (np.array(corner) - np.array(corners[12]))
        assert machine.placement.shafts[f"shaft_{number}"] == pytest.approx(expected, abs=1e-12)
    middles = {33: -5.0, 34: 103.0, 35: 230.0, 36: 105.0, 37: -5.0, 38: 225.0}
    for number, middle in middles.items():
        x = machine.placement.bearings[f"bearing_{number}"][0]
        assert x == pytest.approx(1e-3 * (middle + 70.0), abs=1e-12)
    mesh = machine.meshes["stage_19"]
    assert (mesh.hand, mesh.helix_angle) == ("right", pytest.approx(math.radians(21.0)))
    assert machine.meshes["stage_20"].hand == "left"
    assert [s.length for s in machine.shafts["shaft_12"].sections] == [0.08, 0.08, 0.03]
    assert machine.shafts["shaft_14"].sections[0].inner_diameter == pytest.approx(0.058)
    assert machine.shafts["shaft_13"].material.youngs_modulus == pytest.approx(210e9)


def test_a_shaft_drawn_from_its_other_end_is_the_same_machine(tree, tmp_path) -> None:
    """The same gearbox, with the intermediate shaft described against x from its right end."""
    expected, length = helical("rexsj"), 270.0
    part(tree, 13)["u_axis_vector"]["floating_point_array"] = [-1.0, 0.0, 0.0]
    part(tree, 13)["support_vector"]["floating_point_array"] = [length - 25.0, 0.0, -190.0]
    for bearing in (37, 38):
        position = part(tree, bearing)["u_coordinate_on_shaft_inner_side"]
        position["floating_point"] = length - position["floating_point"]
    for section, begin in ((30, 225.0), (31, 165.0), (32, 0.0)):
        add(tree, section, u_coordinate_on_shaft=begin)
    case = machine_from_rexs(read_rexs(stored(tree, tmp_path)), changes=STIFF)
    assert case.to_toml() == expected.to_toml()


def test_a_face_that_begins_at_its_coordinate_has_its_middle_in_space(tree, tmp_path) -> None:
    """REXS 1.0 writes where the face begins; the position in space is its middle."""
    for gear, begin in ((15, 92.0), (17, 47.0)):
        add(tree, gear, u_coordinate_on_shaft=begin)
    case = machine_from_rexs(read_rexs(stored(tree, tmp_path)), changes=STIFF)
    assert case.gears["gear_15"].position == pytest.approx(0.117)


@pytest.mark.parametrize("ending", ["rexs", "rexsj"])
def test_teeth_of_helical_stages_are_computed(ending: str) -> None:
    """Figures of both pairs on their data sheets, by pinion and hand."""
    case = td.load_case(MODELS / f"two_stages.{ending}")
    assert case.meshes_with_teeth == ("stage_19", "stage_20")
    assert case.pair("stage_19", case.operating_point).stiffness.model == "fe3d"
    for mesh, teeth, hand, angle, ratios in (
        ("stage_19", (27, 51), "right", 22.806245, (1.450202, 1.267467)),
        ("stage_20", (23, 34), "left", 21.775125, (1.523695, 0.629272)),
    ):
        pair = case.pair(mesh, case.operating_point).gear_pair
        assert (pair.pinion.teeth, pair.wheel.teeth, pair.hand) == (*teeth, hand)
        assert math.degrees(pair.working_transverse_pressure_angle) == pytest.approx(angle)
        assert pair.transverse_contact_ratio == pytest.approx(ratios[0], rel=2e-4)
        assert pair.overlap_ratio == pytest.approx(ratios[1], rel=1e-6)
    changed = machine_from_rexs(
        read_rexs(MODELS / f"two_stages.{ending}"), changes={"meshes.stage_19.stiffness": 5e8}
    )
    assert changed.meshes_with_teeth == ("stage_20",)


def test_a_stiffness_of_a_stage_needs_a_unit_on_the_command_line() -> None:
    model = read_rexs(MODELS / "two_stages.rexs")
    with pytest.raises(InputError, match=r"stage_19\.stiffness"):
        machine_from_rexs(model, changes=dict.fromkeys(STIFF, 5e8), by="--set")


def test_a_planetary_stage_runs_from_its_file(tmp_path) -> None:
    path = MODELS / "planetary.rexsz"
    case = td.load_case(path)
    (stage,) = case.stages.values()
    assert [gear.teeth for gear in stage.gears.values()] == [17, -61]
    assert (stage.planet.teeth, stage.table.count) == (22, 3)
    assert case.operating_point.torque == pytest.approx(1591.549, abs=1e-3)
    carrier = case.machine().kinematics.shafts[stage.table.carrier]
    assert carrier.speed * 30 / np.pi == pytest.approx(326.9231, abs=1e-4)
    reasons = {assumption.key: assumption.reason for assumption in case.assumptions}
    assert "not in the REXS file" in reasons["gears.gear_53.roughness_ra"]
    other = tmp_path / "stage.toml"
    other.write_text(case.to_toml())
    assert td.load_case(other).operating_point == case.operating_point
    assert td.load_case(other).stages[stage.name].center_distance == stage.center_distance
    assert machine_from_rexs(read_rexs(path)) == stage_from_rexs(read_rexs(path)) == case
    assert any("Planetenlager" in reason and "left out" in reason for reason in reasons.values())


def test_internal_teeth_are_computed_and_turn_alike(tree, tmp_path) -> None:
    straight(tree)
    add(tree, 17, "", number_of_teeth=-51.0)
    add(tree, 19, center_distance=-54.0)
    shift = "addendum_modification_coefficient"
    for component in tree["model"]["components"]:
        for attribute in component["attributes"]:
            if attribute["id"] == shift and attribute["floating_point"] > 0.2:
                attribute["floating_point"] = 0.0
    case = machine_from_rexs(read_rexs(stored(tree, tmp_path)))
    assert case.meshes_with_teeth == ("stage_19", "stage_20")
    assert case.pair("stage_19", case.operating_point).gear_pair.is_internal
    speeds = [case.machine().kinematics.shafts[f"shaft_{n}"].speed / RPM for n in (12, 13)]
    assert speeds == pytest.approx([543.0, 543.0 * 27.0 / 51.0])


def test_a_pair_stored_as_a_gearbox_model_is_loaded_as_a_pair(tmp_path) -> None:
    case = td.load_case("fzg-roughness")
    write_rexs(case, tmp_path / "pair.rexs")
    assert td.load_case(tmp_path / "pair.rexs") == case


def test_spur_stages_make_a_machine_with_computed_teeth(tree, tmp_path) -> None:
    case = td.load_case(stored(straight(tree), tmp_path))
    assert case.meshes_with_teeth == ("stage_19", "stage_20")
    pair = case.pair("stage_20", case.load_cases[2])
    assert pair.stiffness.model == "fe2d"
    assert (pair.gears.pinion.teeth, pair.gears.wheel.teeth) == (23, 34)
    assert pair.operation.speed == pytest.approx(1234.0 * 27.0 / 51.0 * RPM)
    assert pair.operation.torque == pytest.approx(456.0 * 51.0 / 27.0)
    assert pair.lubricant_properties.temperature == pytest.approx(343.15)
    assumed = {a.key: a for a in case.assumptions}
    assert assumed["gears.gear_15.roughness_ra"].value == "0.4 um"
    assert "dynamics.backlash" in assumed
    assert "6210-2Z" in assumed["bearings.bearing_33"].reason
    assert "shaft_12 and shaft_14" in assumed["bearings.bearing_36"].reason
    remarks = " ".join(a.reason for key, a in assumed.items() if key.startswith("remark"))
    assert "tip_diameter = 1 mm is ignored" in remarks
    assert 'external_load 42 "Load [70]": its forces and bending moments are ignored' in remarks
    assert "the axes of its shafts are 190 mm apart" in remarks
    path = tmp_path / "machine.toml"
    path.write_text(case.to_toml(), encoding="utf-8")
    again = td.load_case(path)
    assert again.to_toml() == case.to_toml()
    assert again.assumptions == case.assumptions
    changed = again.replace({"dynamics.backlash": 1e-4})
    assert "dynamics.backlash" not in {a.key for a in changed.assumptions}


def test_bearings_with_dimensions_are_rolling_bearings(tree, tmp_path) -> None:
    add(tree, 33, inner_diameter=50.0, outer_diameter=90.0, width=20.0)
    add(tree, 33, "", number_of_rolling_elements=10)
    for number in (34, 35):
        add(tree, number, inner_diameter=60.0, outer_diameter=95.0, width=27.0)
        add(tree, number, "", catalogue_value_e=0.33)
    case = machine_from_rexs(read_rexs(stored(tree, tmp_path)), changes=STIFF)
    ball, left, right = (case.bearings[f"bearing_{n}"].rolling for n in (33, 34, 35))
    assert isinstance(ball, DeepGrooveBallBearing)
    assert (ball.bore_diameter, ball.outer_diameter, ball.balls) == (0.05, 0.09, 10)
    assert isinstance(left, TaperedRollerBearing)
    assert (left.direction, right.direction) == (-1, 1)
    assert math.tan(left.contact_angle) == pytest.approx(0.22)
    assert "bearings.bearing_33" not in {a.key for a in case.assumptions}
    changes = {"bearings.bearing_38.type": "cylindrical-roller",
               "bearings.bearing_38.bore_diameter": 0.08,
               "bearings.bearing_38.outer_diameter": 0.14,
               "bearings.bearing_38.width": 0.026}  # fmt: skip
    bearing = helical(**changes).bearings["bearing_38"]
    assert bearing.rolling.bore_diameter == 0.08


def test_a_floating_bearing_of_the_file_takes_no_axial_force(tree, tmp_path) -> None:
    for number in (33, 36):
        add(tree, number, inner_diameter=50.0, outer_diameter=90.0, width=20.0)
        add(tree, number, "", bearing_type="radial_grooved_ball_bearing")
    loads = {}
    for floating in ("both_directions", "no_direction"):
        add(tree, 36, "", axial_force_absorption=floating)
        case = machine_from_rexs(read_rexs(stored(tree, tmp_path)), changes=STIFF)
        balance = static_balance(case.machine())
        loads[floating] = [balance.bearings[f"bearing_{n}"].load[0] for n in (33, 36)]
    assert case.bearings["bearing_36"].floating
    assert not case.bearings["bearing_33"].floating
    total = sum(loads["both_directions"])
    assert min(map(abs, loads["both_directions"])) > 0.01 * abs(total)
    assert loads["no_direction"] == pytest.approx([total, 0.0], abs=1e-6 * abs(total))
    add(tree, 36, "", axial_force_absorption="positive")
    case = machine_from_rexs(read_rexs(stored(tree, tmp_path)), changes=STIFF)
    reason = next(a.reason for a in case.assumptions if a.key == "bearings.bearing_36")
    assert reason.endswith(
        "it takes axial forces of both directions, in the file of the positive one"
    )


def test_tables_in_python_hold_lists_of_numbers_and_of_names() -> None:
    case = MachineCase(
        shafts={"in": {"sections": [[0.1, 0.05], ["100 mm", 0.06, 0.01]]}, "out": {}},
        bearings={"A": {"shaft": "in", "position": 0.0, "radial_stiffness": [4e8, 5e8]},
                  "B": {"shaft": "in", "position": 0.2}},
        gears={"z1": {"shaft": "in", "position": 0.1, "teeth": 27, "face_width": 0.05},
               "z2": {"shaft": "out", "teeth": 51, "face_width": 0.05}},
        meshes={"first": {"gears": ["z1", "z2"], "normal_module": 4.5e-3, "stiffness": 5e8}},
        operation={"input": "in", "output": "out", "speed": 100.0, "torque": 400.0},
        load_cases=[{"share": 0.3, "speed": 50.0}],
        assumed={"meshes.first.stiffness": "estimated"},
    )  # fmt: skip
    again = read_case(case.to_toml())
    assert again.to_toml() == case.to_toml()
    assert again.shafts["in"].sections[1].inner_diameter == 0.01
    assert again.bearings["A"].radial_stiffness == (4e8, 5e8)
    assert again.load_cases[0].speed == 50.0
    assert str(again.assumptions[0]) == (
        "meshes.first.stiffness = 500000000 N/m (assumed): estimated"
    )


def test_a_braking_torque_drives_from_the_output(tree, tmp_path) -> None:
    for case in tree["model"]["load_spectrum"]["load_cases"]:
        for component in case["components"]:
            for attribute in component["attributes"]:
                if attribute["id"] in ("torque_around_u_axis", "rotational_speed"):
                    sign = -1.0 if attribute["id"] == "rotational_speed" else 1.0
                    attribute["floating_point"] *= sign
    load = machine_from_rexs(read_rexs(stored(tree, tmp_path)), 3, changes=STIFF).operating_point
    assert load.speed == pytest.approx(-1234.0 * RPM)
    assert load.torque == -456.0


def test_sections_with_a_gap_leave_a_rigid_shaft_and_a_remark(tree, tmp_path) -> None:
    add(tree, 22, u_coordinate_on_shaft=85.0)
    model = read_rexs(stored(tree, tmp_path))
    case = machine_from_rexs(model, changes=STIFF)
    assert case.shafts["shaft_12"].is_rigid
    assert any("its sections leave a gap at 80 mm" in remark for remark in model.remarks)


def test_crossed_shafts_and_unknown_loads_are_refused(tree, tmp_path) -> None:
    del tree["model"]["load_spectrum"]
    model = read_rexs(stored(tree, tmp_path))
    with pytest.raises(InputError, match="speed and the torque of the gearbox are not known"):
        machine_from_rexs(model, changes=STIFF)
    loads = {"operation.speed": "1500 rpm", "operation.torque": "100 N*m"}
    assert machine_from_rexs(model, changes=STIFF | loads).operating_point.torque == 100.0
    part(tree, 14)["u_axis_vector"]["floating_point_array"] = [1.0, 1.0, 0.0]
    with pytest.raises(InputError, match="its axis is inclined by 45 deg"):
        machine_from_rexs(read_rexs(stored(tree, tmp_path)), changes=STIFF | loads)


def test_import_writes_the_case_file_of_the_machine(tmp_path, capsys) -> None:
    from tribodyn.cli.commands.exchange_commands import import_

    path, out = MODELS / "two_stages.rexs", tmp_path / "gearbox.toml"
    settings = [f"{key}={value:g} N/m" for key, value in STIFF.items()]
    import_(path, out=out, machine=True, set_=settings)
    assert td.load_case(out).gears.keys() == helical().gears.keys()
    assert "tip_diameter = 1 mm is ignored" in capsys.readouterr().err
    with pytest.raises(InputError, match="--machine writes the case of all stages"):
        import_(path, machine=True)


def test_faces_that_do_not_meet_whole_are_reported_with_what_meets(
    tree: dict[str, Any], tmp_path: Path
) -> None:
    """Faces of 50 mm whose middles are 0, 12 and 50.5 mm apart have 50, 38 and 0 mm in common."""
    middle = part(tree, 17)["support_vector"]["floating_point_array"]
    remarks = {}
    for shift in (0.0, -12.0):
        middle[0] = 47.0 + shift
        model = read_rexs(stored(tree, tmp_path))
        machine_from_rexs(model, changes=STIFF)
        remarks[shift] = [remark for remark in model.remarks if "mid plane" in remark]
    assert remarks[0.0] == []
    assert "12 mm apart along their axes, so that 38 mm of the narrower" in remarks[-12.0][0]
    middle[0] = 97.5
    with pytest.raises(InputError, match=r"stage 19 are 50\.5 mm apart along their axes"):
        machine_from_rexs(read_rexs(stored(tree, tmp_path)), changes=STIFF)
