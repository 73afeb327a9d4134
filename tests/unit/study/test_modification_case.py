"""Flank modifications in the case file: keys, files, errors, and the modified pair."""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from broken import SOUND, Broken, line_of

import tribodyn as td
from tribodyn.cli import call
from tribodyn.errors import InputError
from tribodyn.gear import FlankModification, default_relief_length, flank_gap, flank_ranges
from tribodyn.study import SUMMARY, Case, read_case
from tribodyn.study.case.provenance import assumptions
from tribodyn.study.case.write import case_text
from tribodyn.study.pipeline.assembly import geometry

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

Saved = Callable[..., Path]
PINION, WHEEL = "gears.pinion.modification", "gears.wheel.modification"
_HEAD = "[gears.pinion.modification]\n"
_DISTANCE = 'center_distance = "91.5 mm"'


def with_pinion(*lines: str) -> str:
    return SOUND.replace("[gears.wheel]", "\n".join([_HEAD.strip(), *lines, "[gears.wheel]"]), 1)


def _mod(name: str, line: str, *says: str) -> Broken:
    new = f"{_HEAD}{line}\n[gears.wheel]"
    return Broken(name, "[gears.wheel]", new, line.partition(" = ")[0], (PINION, *says))


BROKEN = (
    _mod("relief-without-unit", "tip_relief = 10", "tip_relief = 10", "needs a unit", "10 um"),
    _mod("relief-in-metres", 'tip_relief = "10 m"', '"10 m"', "0 um to 500 um"),
    _mod("negative-relief", 'root_relief = "-5 um"', '"-5 um"', "0 um to 500 um"),
    _mod("relief-of-angle", 'tip_relief = "5 deg"', '"5 deg"'),
    _mod("zero-length", 'tip_relief_length = "0 mm"', '"0 mm"', "above 0 mm"),
    _mod("long-relief", 'tip_relief_length = "30 mm"', "30 mm of the pinion", "used flank of 17.6"),
    _mod("unknown-shape", 'tip_relief_shape = "parabola"', "linear, parabolic", '"parabolic"?'),
    _mod("misspelt-relief", 'tip_releif = "10 um"', "unknown key", 'Did you mean "tip_relief"?'),
    _mod("single-number-for-wear", 'wear_depth = "5 um"', "must be a list", '["5 um"]'),
    _mod("negative-wear", 'wear_depth = ["1 um", "-5 um"]', "wear_depth[1]", "0 um to 500 um"),
    _mod("few-pitches", 'cumulative_pitch_deviation = ["1 um", "0 um"]', "2 entries", "16 teeth",
         "Give 16 values"),
    _mod("open-circle", f"single_pitch_deviation = {json.dumps(['1 um'] * 16)}", "sum to 16 um",
         "Subtract their mean"),
    _mod("run-out-in-mm", 'run_out = "20 mm"', '"20 mm"', "0 um to 1000 um"),
    _mod("no-map", 'profile_map = "nowhere.csv"', "no such file", "nowhere.csv"),
    _mod("map-of-number", "profile_map = 3", "profile_map = 3", "path of a file", "quotes"),
    _mod("unknown-interpolation", 'profile_map_interpolation = "quintic"', "linear, cubic"),
    Broken("pitches-twice", "[gears.wheel]",
           _HEAD + f"single_pitch_deviation = {json.dumps(['0 um'] * 16)}\n"
           f"cumulative_pitch_deviation = {json.dumps(['0 um'] * 16)}\n[gears.wheel]",
           "single_pitch_deviation", (PINION, "both given", "Keep one")),
    Broken("misalignment-in-mm", _DISTANCE, _DISTANCE + '\nmisalignment = "3 mm"', "misalignment",
           ("gears.misalignment", "-500 um to 500 um")),
    Broken("relief-in-wrong-table", "teeth = 16", 'teeth = 16\nroot_relief = "3 um"', "root_relief",
           ("unknown key", "It belongs to [gears.pinion.modification]")),
    Broken("modification-is-a-value", "teeth = 16", "teeth = 16\nmodification = 3", "modification",
           (PINION, "is a table", "[gears.pinion.modification]")),
)  # fmt: skip


@pytest.mark.parametrize("broken", BROKEN, ids=lambda broken: broken.name)
def test_message_names_place_fault_and_remedy(broken: Broken) -> None:
    text = SOUND.replace(broken.old, broken.new, 1)
    with pytest.raises(InputError) as caught:
        read_case(text, "pair.toml")
    message = str(caught.value)
    for part in (*broken.says, f"pair.toml:{line_of(text, broken.at)}"):
        assert part in message
    assert all(problem.why or problem.remedy for problem in caught.value.problems)


def test_faults_of_both_gears_and_of_the_geometry_come_at_once() -> None:
    text = with_pinion('profile_map = "nowhere.csv"') + (
        '[gears.wheel.modification]\nprofile_map = "never.csv"\n'
    )
    with pytest.raises(InputError) as caught:
        read_case(text.replace('"91.5 mm"', '"80 mm"', 1), "pair.toml")
    places = [str(problem.where).partition(": ")[2] for problem in caught.value.problems]
    assert places == ["gears.center_distance", f"{PINION}.profile_map", f"{WHEEL}.profile_map"]


def test_keys_reach_the_pair() -> None:
    text = with_pinion(
        'tip_relief = "10 um"', 'tip_relief_length = "4 mm"', 'tip_relief_shape = "parabolic"',
        'root_relief = "3 um"', 'root_relief_length = "2 mm"', 'root_relief_shape = "parabolic"',
        'profile_crowning = "-4 um"', 'profile_slope = "5 um"', 'crowning = "6 um"',
        'lead_slope = "-7 um"', 'run_out = "20 um"', 'run_out_phase = "90 deg"',
        'wear_depth = ["1 um", "2 um"]',
        f"cumulative_pitch_deviation = {json.dumps([f'{tooth} um' for tooth in range(16)])}",
    ).replace(_DISTANCE, _DISTANCE + '\nmisalignment = "-8 um"', 1)  # fmt: skip
    pair = read_case(text, "pair.toml").gear_pair
    expected = FlankModification(
        tip_relief=10e-6, tip_relief_length=4e-3, tip_relief_shape="parabolic",
        root_relief=3e-6, root_relief_length=2e-3, root_relief_shape="parabolic",
        profile_crowning=-4e-6, profile_slope=5e-6, crowning=6e-6, lead_slope=-7e-6, run_out=20e-6,
        run_out_phase=np.pi / 2.0, wear_depth=(1e-6, 2e-6),
        cumulative_pitch_deviation=tuple(tooth * 1e-6 for tooth in range(16)),
    )  # fmt: skip
    assert repr(pair.pinion.modification) == repr(expected)
    assert pair.pinion.modification.run_out_phase == pytest.approx(np.pi / 2.0)
    assert pair.wheel.modification == FlankModification()
    assert pair.misalignment == pytest.approx(-8e-6)


def test_without_tables_the_flanks_are_involutes() -> None:
    case = td.load_case("fzg-roughness")
    assert not case.gear_pair.has_modification
    assert "# [gears.wheel.modification] is not given" in case_text(case, comments=True)
    assert not any("modification" in assumption.key for assumption in assumptions(case))


def test_values_are_replaced_and_taken_back() -> None:
    case = td.load_case("fzg-roughness")
    relieved = case.replace({f"{PINION}.tip_relief": "10 um", f"{WHEEL}.tip_relief": 12e-6})
    assert relieved.gear_pair.pinion.modification.tip_relief == pytest.approx(10e-6)
    assert relieved.gear_pair.wheel.modification.tip_relief == pytest.approx(12e-6)
    assert relieved.gears.pinion.modification.tip_relief == pytest.approx(10e-6)
    assert case.gears.pinion.modification is None
    assert relieved != case
    assert relieved.replace({PINION: None, WHEEL: None}) == case
    changed = relieved.replace({f"{WHEEL}.tip_relief": None})
    assert changed.gear_pair.wheel.modification == FlankModification()
    again = relieved.replace({f"{PINION}.tip_relief": 5e-6})
    assert again.gear_pair.pinion.modification.tip_relief == pytest.approx(5e-6)


def test_a_bare_number_on_the_command_line_needs_its_unit() -> None:
    with pytest.raises(InputError, match=r"--set gears\.pinion\.modification\.tip_relief"):
        td.load_case("fzg-roughness").replace({f"{PINION}.tip_relief": 10}, by="--set")


def test_a_written_case_reads_back() -> None:
    case = read_case(with_pinion('tip_relief = "10 um"', 'wear_depth = ["3 um"]'), "pair.toml")
    again = read_case(case.to_toml(), "again.toml")
    assert again == case
    assert hash(again) == hash(case)
    assert again.gear_pair == case.gear_pair
    assert tomllib.loads(case.to_toml())["gears"]["pinion"]["modification"]["tip_relief"] == "10 um"


def test_default_length_is_shown_where_it_holds() -> None:
    case = read_case(with_pinion('tip_relief = "10 um"'), "pair.toml")
    length = default_relief_length(case.gear_pair)
    line = f'# tip_relief_length = "{1e3 * length:.10g} mm"'
    assert line in case_text(case, comments=True)
    assert f"{1e3 * length:.10g} mm" in str(case)
    figures = geometry(case)
    assert figures["tip_relief_pinion"] == pytest.approx(10e-6)
    assert figures["tip_relief_length_pinion"] == pytest.approx(length)
    assert "tip_relief_wheel" not in figures
    assert set(figures) <= set(SUMMARY)


def test_geometry_lists_the_modifications() -> None:
    case = td.load_case("fzg-roughness").replace(
        {f"{WHEEL}.crowning": "5 um", f"{WHEEL}.run_out": "20 um", "gears.misalignment": "4 um",
         f"{WHEEL}.cumulative_pitch_deviation": ["1 um", *["0 um"] * 23]}
    )  # fmt: skip
    figures = geometry(case)
    assert figures["crowning_wheel"] == pytest.approx(5e-6)
    assert figures["run_out_wheel"] == pytest.approx(20e-6)
    assert figures["misalignment"] == pytest.approx(4e-6)
    assert figures["hunting_period"] == 48
    assert set(figures) - set(geometry(td.load_case("fzg-roughness"))) == {
        "crowning_wheel", "run_out_wheel", "misalignment", "hunting_period"
    }  # fmt: skip


# Measured maps


@pytest.fixture
def saved(tmp_path: Path) -> Saved:
    """Write a case with a map in its folder: ``saved(rows)`` gives the path of the case."""

    def save(text: str, *lines: str) -> Path:
        folder = tmp_path / "case"
        folder.mkdir(exist_ok=True)
        (folder / "flank.csv").write_text(text, encoding="utf-8")
        path = folder / "pair.toml"
        path.write_text(with_pinion('profile_map = "flank.csv"', *lines), encoding="utf-8")
        return path

    return save


MAP = """\
# Measured on the left flank of tooth 1
roll_length,face_position,deviation
mm,mm,um
10,-10,0
10,10,4
29,-10,2
29,10,6
"""


def test_a_map_in_the_folder_of_the_case_is_read(saved: Saved) -> None:
    pair = td.load_case(saved(MAP)).gear_pair
    pinion, wheel = flank_ranges(pair)
    gap = flank_gap(pair, 19.5e-3, wheel.lowest, np.array([-10e-3, 0.0, 10e-3]))
    assert gap == pytest.approx([-1e-6, -3e-6, -5e-6], rel=1e-9)
    assert pinion.lowest < 19.5e-3 < pinion.highest
    assert pair.has_lead_modification


def test_points_may_come_in_any_order_with_other_units_and_semicolons(saved: Saved) -> None:
    text = "deviation;roll_length;face_position\nmm;m;cm\n0.006;0.029;1\n0.004;0.010;1\n"
    text += "0.002;0.029;-1\n0;0.01;-1\n"
    pair = td.load_case(saved(text)).gear_pair
    assert pair == td.load_case(saved(MAP)).gear_pair


def test_a_single_profile_over_diameters(saved: Saved) -> None:
    text = "diameter,deviation\nmm,um\n70,0\n90,8\n"
    pair = td.load_case(saved(text, 'profile_map_interpolation = "cubic"')).gear_pair
    chart = pair.pinion.modification.profile_map
    assert (chart.coordinate, chart.interpolation) == ("diameter", "cubic")
    radius = np.sqrt(40e-3**2 - pair.pinion.base_radius**2)
    assert float(chart.at(radius, 0.0, base_radius=pair.pinion.base_radius)) == pytest.approx(4e-6)
    assert not pair.has_lead_modification


def test_a_changed_file_is_read_again(saved: Saved) -> None:
    path = saved(MAP)
    before = td.load_case(path).gear_pair
    saved(MAP.replace("29,10,6", "29,10,9.5"))
    after = td.load_case(path).gear_pair
    assert before != after


def test_a_written_case_finds_its_map_from_anywhere(saved: Saved, tmp_path: Path) -> None:
    case = td.load_case(saved(MAP))
    (tmp_path / "elsewhere").mkdir()
    other = tmp_path / "elsewhere" / "case.toml"
    other.write_text(case.to_toml(), encoding="utf-8")
    again = td.load_case(other)
    assert again == case
    assert again.gear_pair == case.gear_pair


def test_in_python_a_path_begins_at_the_working_directory(
    saved: Saved, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(saved(MAP).parent)
    case: Case = td.load_case("fzg-roughness").replace({f"{PINION}.profile_map": "flank.csv"})
    named = case.gears.pinion.modification.profile_map
    assert named == os.path.join(os.getcwd(), "flank.csv")
    assert case.gear_pair.has_profile_modification


BAD_MAPS = {
    "empty": ("", ("holds no points", "flank.csv", "mm,mm,um")),
    "one-row": ("roll_length,deviation\nmm,um\n", ("holds no points",)),
    "no-units": (MAP.replace("mm,mm,um\n", ""), ("row of units is missing", "line 3", "mm,mm,um")),
    "wrong-unit": (MAP.replace("mm,mm,um", "mm,deg,um"), ('"deg" is no unit', "line 3")),
    "wrong-columns": (MAP.replace("face_position", "width"), ("roll_length, width, deviation",)),
    "two-places": (
        "roll_length,diameter,deviation\nmm,mm,um\n1,2,3\n",
        ("roll_length, diameter, deviation", "Correct the first row"),
    ),
    "hole": (
        MAP.replace("29,-10,2\n", ""),
        ("3 points", "no full grid of 2 x 2", "roll_length 29 mm and face_position -10 mm"),
    ),
    "twice": (MAP + "29,10,6\n", ("this point comes twice", "line 8")),
    "short-row": (MAP + "30,10\n", ("this row has 2 entries and the first row 3", "line 8")),
    "decimal-comma": (MAP + "30,10,1,5\n", ("4 entries", "decimal sign is a point")),
    "word": (MAP + "30,10,missing\n", ('"missing" is no number', "line 8")),
    "nan": (MAP.replace("10,-10,0", "10,-10,nan"), ("deviation of profile_map is nan um",)),
    "metres": (MAP.replace("mm,mm,um", "mm,mm,m"), ("4e+06 um", "unit")),
    "one-place": ("roll_length,deviation\nmm,um\n10,1\n", ("two or more places",)),
    "too-short": (
        MAP.replace("29,", "25,"),
        ("covers the roll lengths 10 to 25 mm", "to 28.5967 mm", "not extrapolated"),
    ),
    "too-narrow": (
        MAP.replace(",10,", ",5,"),
        ("the face from -10 to 5 mm", "-10 to 10 mm"),
    ),
}


@pytest.mark.parametrize("name", BAD_MAPS)
def test_a_wrong_map_is_refused(saved: Saved, name: str) -> None:
    text, says = BAD_MAPS[name]
    path = saved(text)
    with pytest.raises(InputError) as caught:
        td.load_case(path)
    line = line_of(path.read_text(encoding="utf-8"), "profile_map")
    for part in (*says, f"pair.toml:{line}: {PINION}.profile_map"):
        assert part in str(caught.value)


def test_a_map_that_is_no_text_is_refused(saved: Saved) -> None:
    path = saved(MAP)
    (path.parent / "flank.csv").write_bytes(b"\xff\xfe\x00\x01" * 20)
    with pytest.raises(InputError, match="UTF-8"):
        td.load_case(path)


def test_the_command_line_shows_and_writes_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["check", "fzg-roughness", "--set", f"{PINION}.tip_relief=10 um", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["tip_relief_pinion"] == pytest.approx(1e-5)
    source, target = tmp_path / "a.toml", tmp_path / "b.toml"
    source.write_text(with_pinion('tip_relief = "10 um"'), encoding="utf-8")
    assert call(["new", str(target), "--from", str(source)]) == 0
    assert td.load_case(target).gear_pair == td.load_case(source).gear_pair
    assert call(["check", "fzg-roughness", "--set", f"{PINION}.tip_relief_length=40 mm"]) == 2
    assert "used flank" in capsys.readouterr().err


def test_without_backlash_a_vanishing_relief_is_none() -> None:
    quick = {"stiffness.model": "iso6336", "solver.steps_per_mesh_cycle": 128}
    case = td.load_case("fzg-12dof-light").replace(quick)
    assert case.dynamics.backlash == 0.0
    forces = [
        td.run(case.replace({f"{PINION}.tip_relief": relief})).response.contact_force
        for relief in (0.0, 1e-11, 1e-9)
    ]
    none, little, more = (np.asarray(force).sum(axis=-1).max() for force in forces)
    assert abs(little - none) < 0.02 * abs(more - none) < 0.01
