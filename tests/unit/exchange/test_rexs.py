"""Gearbox models of other programs: figures, cases of spur stages, and what is refused."""

from __future__ import annotations

import csv
import io
import json
import math
import re
import zipfile
from pathlib import Path
from typing import Any

import pytest

import tribodyn as td
from tribodyn.errors import InputError
from tribodyn.exchange import case_from_rexs, read_rexs, write_rexs
from tribodyn.exchange.gearbox import GearboxModel
from tribodyn.exchange.rexs_file import RENAMED, WHOLE_CASE, model_of
from tribodyn.gear import zero_backlash_center_distance
from tribodyn.lubricant import Lubricant

MODELS = Path(__file__).parents[2] / "references" / "rexs"
RPM = math.pi / 30.0


@pytest.mark.parametrize("name", ["two_stages.rexs", "two_stages.rexsj"])
def test_both_forms_of_one_gearbox_give_the_figures_of_its_data_sheet(name: str) -> None:
    """Angles and sums of shifts follow from teeth, helix and distance alone, and must agree."""
    model = read_rexs(MODELS / name)
    assert sum(model.components.values()) == 49
    first, two = model.stages
    assert [(s.gear_1.teeth, s.gear_2.teeth) for s in (first, two)] == [(27, 51), (23, 34)]
    for stage, angle, total, reference in (
        (first, 22.8062, 0.46283, 187.9859), (two, 21.7751, 0.30148, 188.1078),
    ):  # fmt: skip
        assert math.degrees(stage.operating_pressure_angle) == pytest.approx(angle, abs=5e-5)
        assert stage.shift_sum == pytest.approx(total, abs=5e-6)
        assert stage.shift_sum == pytest.approx(
            2 * stage.gear_1.profile_shift_coefficient, abs=5e-6
        )
        assert stage.reference_center_distance == pytest.approx(reference * 1e-3, abs=5e-8)
    assert math.degrees(first.gear_1.helix_angle) == pytest.approx(21.0)
    assert math.degrees(two.gear_1.helix_angle) == pytest.approx(-10.0)
    rows = [
        (0.20, 543.0, 567.0, 244.35, 287.47, 110.197, 194.465),
        (0.30, 3456.0, 345.0, 1555.2, 1829.65, 701.365, 1237.702),
        (0.35, 1234.0, 456.0, 555.3, 653.29, 250.429, 441.934),
        (0.15, 789.0, 789.0, 355.05, 417.71, 160.121, 282.566),
    ]
    for load, (share, speed, torque, mesh, middle, second, last) in zip(
        model.loads, rows, strict=True
    ):
        assert load.share == pytest.approx(share)
        assert load.speeds == pytest.approx(
            {12: speed * RPM, 13: middle * RPM, 14: last * RPM}, rel=2e-5
        )
        assert load.torques[12] == torque
        assert load.torques[14] == pytest.approx(torque * 51 / 27 * 34 / 23)
        assert 27 * load.speeds[12] / (2 * math.pi) == pytest.approx(mesh, rel=1e-5)
        assert 23 * load.speeds[13] / (2 * math.pi) == pytest.approx(second, rel=1e-5)
        assert load.oil_temperature == pytest.approx(343.15)
    assert any("tip_diameter = 1 mm" in remark for remark in model.remarks)
    assert two.gear_1.tip_diameter is None
    pair = case_from_rexs(model, 19).gear_pair
    assert (pair.hand, pair.wheel.hand) == ("right", "left")
    ratios = pair.transverse_contact_ratio, pair.overlap_ratio
    assert ratios == pytest.approx((1.450202, 1.267467), abs=2e-4)


def test_xml_and_json_say_the_same() -> None:
    from_xml, other = (read_rexs(MODELS / f"two_stages.{end}") for end in ("rexs", "rexsj"))
    assert from_xml.stages == other.stages
    assert from_xml.loads == other.loads
    assert from_xml.remarks == other.remarks
    assert "27 / 51" in from_xml._repr_html_()
    assert "22.8062 deg" in from_xml._repr_html_()


def test_a_planetary_gearbox_is_listed_and_no_pair_on_fixed_axes() -> None:
    model = read_rexs(MODELS / "planetary.rexsz")
    assert sum(model.components.values()) == 97
    assert [s.gear_2.teeth for s in model.stages] == [22, 22, 22, -61, -61, -61]
    assert all(s.shift_sum == pytest.approx(0.0, abs=1e-12) for s in model.stages)
    assert model.loads[0].torques == {34: pytest.approx(1591.549, abs=1e-3)}
    remark = model.remarks[-1]
    assert "sun 17, 3 planets 22, ring 61" in remark
    assert "4.588" in remark
    assert remark.endswith("equally spaced planets assemble")
    with pytest.raises(InputError, match="stage 211 is part of a planetary stage"):
        case_from_rexs(model, 211)


@pytest.fixture
def tree() -> dict[str, Any]:
    """The gearbox with straight teeth on axes that fit them."""
    model: dict[str, Any] = json.loads((MODELS / "two_stages.rexsj").read_text(encoding="utf-8"))
    for part in model["model"]["components"]:
        for attribute in part["attributes"]:
            if attribute["id"] == "helix_angle_reference_diameter":
                attribute["floating_point"] = 0.0
            if attribute["id"] == "center_distance":
                teeth, module, shift = (78, 4.5e-3, 0.46283) if part["id"] == 19 else (
                    57, 6.5e-3, 0.30148
                )  # fmt: skip
                fitting = zero_backlash_center_distance(teeth, module, math.radians(20), shift)
                attribute["floating_point"] = fitting * 1e3
    return model


def stored(tree: dict[str, Any], folder: Path) -> Path:
    path = folder / "model.rexsj"
    path.write_text(json.dumps(tree), encoding="utf-8")
    return path


def attribute(tree: dict[str, Any], number: int, name: str, case: int = 0) -> dict[str, Any]:
    model = tree["model"]
    parts = model["load_spectrum"]["load_cases"][case - 1] if case else model
    (part,) = (p for p in parts["components"] if p["id"] == number)
    return next(a for a in part["attributes"] if a["id"] == name)


def test_a_spur_stage_becomes_a_case_that_lists_its_assumptions(tree, tmp_path) -> None:
    model = read_rexs(stored(tree, tmp_path))
    case = case_from_rexs(model, 20, 3)
    assert (case.gears.pinion.teeth, case.gears.wheel.teeth) == (23, 34)
    assert case.gear_pair.pinion.normal_module == pytest.approx(6.5e-3)
    assert case.gears.pinion.face_width == pytest.approx(74e-3)
    assert case.operation.speed == pytest.approx(1234 * 27 / 51 * RPM)
    assert case.operation.torque == pytest.approx(456 * 51 / 27)
    assert case.gears.driver == "pinion"
    assert case.material.youngs_modulus == pytest.approx(210e9)
    points = ((313.15, 100e-6), (373.15, 11e-6))
    oil = Lubricant.from_temperature(343.15, points, 880.0, base_oil="mineral")
    assert case.lubricant_properties.dynamic_viscosity == pytest.approx(oil.dynamic_viscosity)
    assumed = case.to_toml().partition("[assumed]")[2].partition("\n[")[0]
    for key in ("bearing_stiffness", "backlash", "roughness_ra", "pressure_viscosity_coefficient"):
        assert key in assumed
    assert "speed" not in assumed


def test_the_driver_follows_from_the_sign_of_the_torque(tree, tmp_path) -> None:
    attribute(tree, 40, "torque_around_u_axis", case=1)["floating_point"] = -567.0
    model = read_rexs(stored(tree, tmp_path))
    assert [case_from_rexs(model, n, 1).gears.driver for n in (19, 20)] == ["wheel", "wheel"]
    assert [case_from_rexs(model, n, 2).gears.driver for n in (19, 20)] == ["pinion", "pinion"]


def test_data_missing_in_the_file_are_requested(tree, tmp_path) -> None:
    del tree["model"]["load_spectrum"]
    model = read_rexs(stored(tree, tmp_path))
    with pytest.raises(InputError, match="speed and torque of stage 19 are not known"):
        case_from_rexs(model, 19)
    changes = {"operation.speed": "1500 rpm", "operation.torque": "100 N*m"}
    case = case_from_rexs(model, 19, changes=changes)
    assert case.operation.torque == 100.0
    points = ((313.15, 100e-6), (373.15, 11e-6))
    for kelvin, more in ((333.15, {}), (363.15, {"lubricant.temperature": "90 degC"})):
        oil = Lubricant.from_temperature(kelvin, points, 880.0, base_oil="mineral")
        lubricant = case_from_rexs(model, 19, changes={**changes, **more}).lubricant_properties
        assert lubricant.temperature == pytest.approx(kelvin)
        assert lubricant.dynamic_viscosity == pytest.approx(oil.dynamic_viscosity)
    assert "temperature" in case.to_toml().partition("[assumed]")[2]
    other = case_from_rexs(model, 19, changes={**changes, "lubricant.name": "ISO VG 220"})
    assert other.lubricant.name == "ISO VG 220"
    with pytest.raises(InputError, match="Stages: 19, 20"):
        case_from_rexs(model)
    with pytest.raises(InputError, match="there is no load case 7"):
        case_from_rexs(model, 19, 7)


def test_shifts_that_do_not_fit_the_distance_are_reported(tree, tmp_path) -> None:
    attribute(tree, 19, "center_distance")["floating_point"] += 0.1
    remarks = read_rexs(stored(tree, tmp_path)).remarks
    assert any("the profile shifts sum up to 0.4628" in remark for remark in remarks)


@pytest.mark.parametrize("name", list(td.cases()))
def test_a_case_reads_back_without_loss(name: str, tmp_path: Path) -> None:
    case = td.load_case(name)
    if case.gears.kind != "spur":
        with pytest.raises(InputError, match="not a cylindrical stage"):
            write_rexs(case, tmp_path / "case.rexs")
        return
    for ending in ("rexs", "rexsj", "rexsz"):
        path = tmp_path / f"case.{ending}"
        write_rexs(case, path)
        model = read_rexs(path)
        assert model.remarks == []
        assert case_from_rexs(model) == case


def hang(tree: dict[str, Any], flanks: tuple[int, ...], kind: str, **values: float) -> None:
    """Put a flank modification on flanks; values in millimetres."""
    model, number = tree["model"], 9000 + len(tree["model"]["relations"])
    attributes = [{"id": k, "unit": "mm", "floating_point": v} for k, v in values.items()]
    model["components"].append({"id": number, "type": kind, "attributes": attributes})
    model["relations"] += [
        {"type": "reference", "refs": [{"role": "origin", "id": flank},
                                       {"role": "referenced", "id": number}]}
        for flank in flanks
    ]  # fmt: skip


def flanks_of(tree: dict[str, Any], gear: int) -> tuple[int, ...]:
    (relation,) = (
        r
        for r in tree["model"]["relations"]
        if r["type"] == "flank" and gear in [ref["id"] for ref in r["refs"]]
    )
    return tuple(ref["id"] for ref in relation["refs"] if ref["id"] != gear)


def test_reliefs_and_crownings_of_the_flanks_are_read(tree, tmp_path) -> None:
    flanks = flanks_of(tree, 15)
    hang(tree, flanks, "tip_relief", tip_relief_depth=0.02, tip_relief_datum_length=3.5)
    hang(tree, flanks, "root_relief", root_relief_depth=0.01)
    hang(tree, flanks, "helix_crowning", helix_crowning_amount_datum_face=0.005,
         helix_crowning_amount_non_datum_face=0.005)  # fmt: skip
    for face in ("datum_face", "non_datum_face"):
        hang(tree, flanks, f"end_relief_{face}",
             **{f"end_relief_depth_{face}": 0.008, f"end_relief_length_{face}": 6.0})  # fmt: skip
    case = case_from_rexs(read_rexs(stored(tree, tmp_path)), 19)
    modified = case.gears.pinion.modification
    assert modified.tip_relief == pytest.approx(20e-6)
    assert modified.tip_relief_length == pytest.approx(3.5e-3)
    assert modified.root_relief == pytest.approx(10e-6)
    assert modified.root_relief_length is None
    assert modified.crowning == pytest.approx(5e-6)
    assert (modified.end_relief, modified.end_relief_length) == pytest.approx((8e-6, 6e-3))
    assert case.gears.wheel.modification is None


def test_a_relief_from_a_diameter_on_is_as_long_as_the_involute_rolls(tmp_path: Path) -> None:
    case = td.load_case("fzg-roughness").replace({"gears.pinion.modification.tip_relief": 1e-5})
    pinion = case.gear_pair.pinion
    write_rexs(case, tmp_path / "case.rexsj")
    model = json.loads((tmp_path / "case.rexsj").read_text(encoding="utf-8"))
    (part,) = (p for p in model["model"]["components"] if p["type"] == "tip_relief")
    start = 0.5 * pinion.tip_diameter - 1e-3
    part["attributes"].append(
        {"id": "tip_relief_datum_diameter", "unit": "mm", "floating_point": 2e3 * start}
    )
    length = read_rexs(stored(model, tmp_path)).stages[0].gear_1.modification["tip_relief_length"]
    tip, base = 0.5 * pinion.tip_diameter, pinion.base_radius
    # by the angles of the involute instead of by Pythagoras
    roll = base * (math.tan(math.acos(base / tip)) - math.tan(math.acos(base / start)))
    assert length == pytest.approx(roll, rel=1e-9)


@pytest.mark.parametrize(
    ("kind", "values", "message"),
    [
        ("profile_slope", {"profile_slope": 0.01}, "its sign of 10 um differs between programs"),
        ("profile_twist", {"profile_twist": -0.006}, "sign of -6 um differs between programs; "
         "check it, and set flank_twist"),
        ("topographical_modification", {}, "a case does not have this form"),
        ("end_relief_datum_face", {"end_relief_depth_datum_face": 0.008,
                                   "end_relief_length_datum_face": 6.0},
         "0.008 mm over 6 mm and 0 mm"),
        ("tip_relief", {"tip_relief_depth": 0.02,
                        "tip_relief_length_of_tangential_transition_start": 1.0}, "no key for"),
        ("tip_relief", {}, "it has no depth"),
        ("profile_crowning", {"profile_crowning_at_tip": 0.01, "profile_crowning_at_root": 0.02},
         "at both ends differ"),
        ("tip_relief", {"tip_relief_depth": 0.02, "tip_relief_datum_diameter": 900.0},
         "is not on the flank"),
    ],
)  # fmt: skip
def test_unsupported_forms_are_reported_and_left_out(tree, tmp_path, kind, values, message):
    hang(tree, flanks_of(tree, 15), kind, **values)
    model = read_rexs(stored(tree, tmp_path))
    name = kind.removesuffix("_datum_face")
    assert any(name in remark and message in remark for remark in model.remarks)
    assert case_from_rexs(model, 19).gears.pinion.modification is None


def test_flanks_of_different_forms_are_reported(tree, tmp_path) -> None:
    left, _ = flanks_of(tree, 15)
    hang(tree, (left,), "tip_relief", tip_relief_depth=0.02)
    model = read_rexs(stored(tree, tmp_path))
    assert any("tip_relief of its flanks differs" in remark for remark in model.remarks)
    assert model.stages[0].gear_1.modification == {"tip_relief": pytest.approx(20e-6)}


def test_modifications_are_written_for_other_programs(tmp_path: Path) -> None:
    keys = {"tip_relief": 2e-5, "tip_relief_length": 2e-3, "crowning": 4e-6,
            "end_relief": 6e-6, "end_relief_length": 4e-3}  # fmt: skip
    changes = {f"gears.wheel.modification.{key}": value for key, value in keys.items()}
    case, path = td.load_case("fzg-roughness").replace(changes), tmp_path / "case.rexs"
    write_rexs(case, path)
    text = path.read_text(encoding="utf-8")
    (stage,) = read_rexs(path).stages
    assert stage.gear_1.modification == {}
    assert stage.gear_2.modification == pytest.approx(keys)
    assert case_from_rexs(read_rexs(path)) == case
    # without the case in its folder, and with another depth
    path.write_text(text.replace(">0.02<", ">0.03<"), encoding="utf-8")
    model = read_rexs(path)
    assert case_from_rexs(model).gears.wheel.modification.tip_relief == pytest.approx(3e-5)
    assert "modification.tip_relief was changed" in model.remarks[0]


def test_spellings_of_other_programs_are_read(tree, tmp_path) -> None:
    text = (MODELS / "two_stages.rexs").read_text(encoding="utf-8-sig")
    expected = read_rexs(MODELS / "two_stages.rexs")
    path = tmp_path / "model.rexs"
    path.write_text(text.replace("<model ", '<model xmlns="urn:any" ', 1), encoding="utf-8")
    assert read_rexs(path).stages == expected.stages
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("folder/inside/model.rexs", text)
        archive.writestr("__MACOSX/folder/inside/._model.rexs", b"\x00")
        archive.writestr("folder/part.fe", b"mesh")
    assert read_rexs(path).stages == expected.stages
    # values at the gear instead of at flanks, as in a model of part of a gearbox
    model = tree["model"]
    model["relations"] = [r for r in model["relations"] if r["type"] != "flank"]
    for part in model["components"]:
        if part["type"] == "cylindrical_gear":
            part["attributes"].append(
                {"id": "normal_pressure_angle", "unit": "deg", "floating_point": 20.0}
            )
    assert read_rexs(stored(tree, tmp_path)).stages[0].gear_1.teeth == 27


def test_negative_teeth_are_those_of_a_ring(tree, tmp_path) -> None:
    gear = read_rexs(stored(tree, tmp_path)).stages[0].gear_2
    entry = attribute(tree, gear.id, "number_of_teeth")
    entry[next(key for key in entry if key in ("integer", "floating_point"))] = -gear.teeth
    attribute(tree, 19, "center_distance")["floating_point"] = -54.0
    model = read_rexs(stored(tree, tmp_path))
    assert model.stages[0].ratio < 0.0
    assert model.stages[0].center_distance == pytest.approx(54e-3)
    with pytest.raises(InputError, match="stage 19 has a ring gear"):
        case_from_rexs(model, 19)


def test_changes_by_another_program_are_loaded_and_reported(tmp_path: Path) -> None:
    case = td.load_case("fzg-roughness")
    path = tmp_path / "case.rexs"
    write_rexs(case, path)
    text = path.read_text(encoding="utf-8").replace(">90.0<", ">120.0<")
    path.write_text(text.replace(">206000.0<", ">206000.00000001<"), encoding="utf-8")
    model = read_rexs(path)
    assert case_from_rexs(model) == case.replace({"operation.torque": 120.0})
    assert model.remarks == ["operation.torque was changed to 120 (SI) by another program"]


def test_nothing_is_replaced_without_force(tmp_path: Path) -> None:
    case, path = td.load_case("fzg-roughness"), tmp_path / "case.rexs"
    write_rexs(case, path)
    with pytest.raises(InputError, match="exists already"):
        write_rexs(case, path)
    write_rexs(case, path, force=True)
    with pytest.raises(InputError, match=r"Use a suffix of \.rexs, \.rexsj, \.rexsz"):
        write_rexs(case, tmp_path / "case.xml")


def bomb() -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("model.rexs", b" " * 60_000_000)
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "it is not a REXS file"),
        (b"\x00\xff", "it is not a REXS file"),
        (b"<model/>", "the model has no components"),
        (b"<html></html>", "its XML root is <html>"),
        (b'<!DOCTYPE m [<!ENTITY a "b">]><model>&a;</model>', "declares a document type"),
        (b"{}", "JSON without a REXS model"),
        (b'{"model": []}', "does not contain a REXS model"),
        (b'{"model": {"components": 3}}', "components is not a list"),
        (b'{"model": {"components": [{"id": "x"}]}}', "an id is not a whole number"),
        (b'{"model": {"components": [{"id": 1}, {"id": 1}]}}', "two components"),
        (b'{"model":' * 100_000, "it is not a REXS file|nested too deeply"),
        (bomb(), "larger than 50 MB"),
        (b"PK\x03\x04 cut off", "damaged zip"),
    ],
)  # fmt: skip
def test_invalid_models_are_refused_with_a_message(
    content: bytes, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "model.rexs"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        read_rexs(path)


@pytest.mark.parametrize(
    ("number", "name", "value", "message"),
    [
        (15, "normal_module", math.nan, "normal_module = nan"),
        (15, "normal_module", -4.5, "normal_module = -0.0045"),
        (15, "number_of_teeth", 27.5, "number_of_teeth = 27.5"),
        (15, "face_width", "wide", "face_width = wide"),
        (19, "center_distance", None, "center_distance is missing"),
    ],
)
def test_impossible_values_are_refused(tree, tmp_path, number, name, value, message) -> None:
    entry = attribute(tree, number, name)
    for key in ("floating_point", "integer"):
        if key in entry:
            entry[key] = value
    with pytest.raises(InputError, match=message):
        read_rexs(stored(tree, tmp_path))


def test_units_are_those_that_the_file_names(tree, tmp_path) -> None:
    entry = attribute(tree, 19, "center_distance")
    entry["floating_point"] /= 25.4
    entry["unit"] = "in"
    from_file = read_rexs(stored(tree, tmp_path)).stages[0].center_distance
    assert from_file == pytest.approx(entry["floating_point"] * 0.0254)
    entry["unit"] = "N m"
    with pytest.raises(InputError, match=r'cylindrical_stage 19 .*"N m"'):
        read_rexs(stored(tree, tmp_path))


def test_names_and_units_of_later_versions_give_the_same_case(tmp_path: Path) -> None:
    """REXS 2.0.0 renames the roughness and the tool's tip radius, and has the modulus in MPa."""
    case = td.load_case("fzg-film").replace({"gears.rack_tip_radius_coefficient": 0.3})
    for gear in ("pinion", "wheel"):
        keys = {f"gears.{gear}.roughness_rms": None, f"gears.{gear}.roughness_ra": 0.7e-6}
        case = case.replace(keys)
    path = tmp_path / "first.rexsj"
    write_rexs(case, path)
    tree = json.loads(path.read_text(encoding="utf-8"))
    for component in tree["model"]["components"]:
        attributes = component["attributes"]
        component["attributes"] = [a for a in attributes if a["id"] != WHOLE_CASE]
    before = case_from_rexs(read_rexs(stored(tree, tmp_path)))
    assert not [r for r in read_rexs(tmp_path / "model.rexsj").remarks if "version" in r]
    new_names = {
        "arithmetic_average_roughness_flank": "arithmetic_mean_roughness_flank_iso_4287_1997",
        "tip_radius_factor": "tip_corner_radius_factor_reference_profile",
    }
    for component in tree["model"]["components"]:
        for attribute in component["attributes"]:
            attribute["id"] = new_names.get(attribute["id"], attribute["id"])
            if attribute["id"] == "elastic_modulus":
                attribute["unit"] = "MPa"
        if component["type"] == "rack_shaped_tool":
            new = {"id": "protuberance_amount", "unit": "mm", "floating_point": 0.1}
            component["attributes"].append(new)
    for version in ("2.0.0", "1.7", "3.1"):
        known = version != "3.1"
        tree["model"]["version"] = version
        model = read_rexs(stored(tree, tmp_path))
        after = case_from_rexs(model)
        same = dict(before.values()) | {"origin": after.origin}
        assert dict(after.values()) == same
        assert after.gears.rack_tip_radius_coefficient == pytest.approx(0.3)
        assert after.gears.pinion.roughness_ra == pytest.approx(0.7e-6)
        assert any("its protuberance is ignored" in remark for remark in model.remarks)
        unknown = [remark for remark in model.remarks if remark.startswith("REXS version")]
        assert len(unknown) == (not known)
        assert all(re.search("rack_shaped_tool: .*protuberance_amount", text) for text in unknown)


def test_every_name_that_the_change_logs_rename_is_read_by_both_names() -> None:
    """A table of all 406 renamed attributes, and the names that the reader asks for."""
    folder = Path(td.exchange.__file__).parent
    source = "".join(path.read_text("utf-8") for path in folder.glob("*.py"))
    read = {*re.findall(r'"([a-z_0-9]{6,})"', source)} - {*RENAMED, "tip_diameter"}
    rows = csv.DictReader((MODELS / "renamed.csv").read_text("utf-8").splitlines())
    renamed = [(row["old"], row["new"]) for row in rows if row["old"] in read]
    assert len(renamed) >= 3
    other = {"name": "catalogue_designation"}  # of a bearing, read by both names where it is
    assert {new: old for old, new in renamed if old not in other} == RENAMED


def test_times_are_read_by_the_name_of_version_1_3_and_the_oil_of_a_stage(tmp_path: Path) -> None:
    text = (MODELS / "two_stages.rexs").read_text("utf-8-sig")
    first = read_rexs(MODELS / "two_stages.rexs")
    later = text.replace("load_duration_fraction", "operating_time_fraction")
    (tmp_path / "later.rexs").write_text(later, "utf-8")
    second = read_rexs(tmp_path / "later.rexs")
    assert [load.share for load in second.loads] == [0.2, 0.3, 0.35, 0.15]
    assert second.loads == first.loads
    assert second.remarks == first.remarks
    tree = json.loads((MODELS / "two_stages.rexsj").read_text("utf-8"))["model"]
    for load in tree["load_spectrum"]["load_cases"]:
        for part in load["components"]:
            if part["type"] == "gear_casing":
                part |= {"type": "cylindrical_stage", "id": 19}
    moved = GearboxModel(model_of(tree, "moved"))
    assert [load.oil_temperature for load in moved.loads] == pytest.approx([343.15] * 4)


@pytest.mark.parametrize("amount", [0.0, 0.1])
def test_tools_of_manufacturing_steps_make_the_rack(amount: float, tmp_path: Path) -> None:
    case = td.load_case("helical-pair").replace({"gears.rack_tip_radius_coefficient": 0.3})
    write_rexs(case, tmp_path / "first.rexsj")
    tree = json.loads((tmp_path / "first.rexsj").read_text("utf-8"))["model"]
    for part in tree["components"]:
        part["attributes"] = [a for a in part["attributes"] if a["id"] != WHOLE_CASE]
        if part["type"] == "rack_shaped_tool":
            new = {"id": "protuberance_amount", "unit": "mm", "floating_point": amount}
            part["attributes"].append(new)
            tool = part["id"]
    kept = [r for r in tree["relations"] if r["type"] != "ordered_reference"]
    flanks = [r["refs"][1]["id"] for r in kept if r["type"] == "flank"]
    assert len(flanks) == 2
    steps = [
        {"id": 90 + n, "type": "manufacturing_step", "order": 1,
         "refs": [{"role": "workpiece", "id": n}, {"role": "tool", "id": tool}]}
        for n in flanks
    ]  # fmt: skip
    model = GearboxModel(model_of(tree | {"relations": [*kept, *steps]}, "steps"))
    assert case_from_rexs(model).gears.rack_tip_radius_coefficient == pytest.approx(0.3)
    assert any("protuberance" in remark for remark in model.remarks) == bool(amount)


@pytest.mark.parametrize("name", ["two_stages.rexs", "two_stages.rexsj"])
@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_models_in_other_encodings_are_the_same(name: str, encoding: str, tmp_path: Path) -> None:
    text = (MODELS / name).read_text("utf-8")
    if encoding.startswith("utf-16"):
        text = text.replace('encoding="UTF-8"', 'encoding="UTF-16"')
    (tmp_path / name).write_bytes(text.encode(encoding))
    first, second = (read_rexs(path) for path in (MODELS / name, tmp_path / name))
    assert [stage.id for stage in second.stages] == [stage.id for stage in first.stages]
    assert list(second.remarks) == list(first.remarks)


def test_a_file_without_a_version_is_said(tmp_path: Path) -> None:
    text = (MODELS / "two_stages.rexs").read_text("utf-8")
    path = tmp_path / "m.rexs"
    path.write_text(re.sub(r'(<model[^>]*?) version="[^"]*"', r"\1", text, count=1), "utf-8")
    assert any("names no version of REXS" in remark for remark in read_rexs(path).remarks)
