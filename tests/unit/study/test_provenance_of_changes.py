"""A changed value loses the reason and the source of the old one, however it is changed."""

from __future__ import annotations

import html
import json
import re
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

import tribodyn as td
from tribodyn.cases import case_files
from tribodyn.cases.catalogue import all_files
from tribodyn.cli import call
from tribodyn.errors import InputError
from tribodyn.model import Option
from tribodyn.report import render_report, write_sweep_report
from tribodyn.study import read_case
from tribodyn.study.case.provenance import (
    assumptions,
    changed_keys,
    effective,
    provenance,
)
from tribodyn.study.case.write import case_text
from tribodyn.study.pipeline.cautions import case_cautions
from tribodyn.study.pipeline.citations import cite

WIDTH = "gears.pinion.face_width"
MARK = re.compile(r'^("[\w.]+") = \{ value = (.*), reason = (".*") \}$', re.MULTILINE)


def reason_of(case: Any, key: str) -> str:
    """What is said of a value wherever a reader looks for it."""
    reasons = [row.reason for row in assumptions(case) if row.key == key and row.kind == "assumed"]
    return " ".join([*reasons, case.assumed.get(key, "")])


def with_every_key(case: Any) -> str:
    """The case file as ``tribodyn new --from`` writes it."""
    return case_text(case, comments=True)


def old_form(text: str) -> str:
    """A case file as it was written before values were recorded."""
    return MARK.sub(r"\1 = \3", text[: text.index("# Initial values of this case")])


def edited(text: str, key: str, line: str | None) -> str:
    """Text of a case file with the line of one key changed, added or taken away."""
    table, _, name = key.rpartition(".")
    head = re.search(rf"^\[{re.escape(table)}\].*\n", text, re.MULTILINE)
    if head is None:
        assert line is not None
        return text.replace("[assumed]", f"[{table}]\n{line}\n\n[assumed]", 1)
    end = text.find("\n[", head.end())
    body = text[head.end() : end]
    present = re.search(rf"^#? ?{name} = .*\n", body, re.MULTILINE)
    new = "" if line is None else line + "\n"
    body = new + body if present is None else body.replace(present.group(), new, 1)
    return text[: head.end()] + body + text[end:]


EDITS = {
    "length": (WIDTH, 'face_width = "30 mm"'),
    "number": ("dynamics.mesh_damping_ratio", "mesh_damping_ratio = 0.07"),
    "choice": ("operation.torque_balance", 'torque_balance = "drive"'),
    "default": ("dynamics.damping_in_gap", "damping_in_gap = true"),
    "default number": ("gears.addendum_coefficient", "addendum_coefficient = 0.98"),
    "oil": ("lubricant.name", 'name = "75W90-A"'),
    "printed": ("operation.torque", 'torque = "91 N*m"'),
    "whole number": ("solver.steps_per_mesh_cycle", "steps_per_mesh_cycle = 2048"),
    "removed": ("dynamics.backlash", None),
    "removed default": ("dynamics.mesh_damping_ratio", None),
    "removed mass": ("gears.pinion.mass", None),
    "added": ("gears.pinion.tip_diameter", 'tip_diameter = "88.5 mm"'),
    "modification": ("gears.pinion.modification.tip_relief", 'tip_relief = "12 um"'),
    "list": ("gears.wheel.modification.wear_depth", 'wear_depth = ["1 um", "2 um"]'),
}
#: Whose value stays what it was: 0.04 is the default as well.
STAYS = {"removed default"}


@pytest.mark.parametrize("kind", EDITS)
def test_an_edited_line_of_a_written_file_is_the_users(kind: str, tmp_path: Path) -> None:
    key, line = EDITS[kind]
    began = td.load_case("fzg-roughness")
    path = tmp_path / "my.toml"
    path.write_text(edited(with_every_key(began), key, line), encoding="utf-8")
    case = td.load_case(path)
    if kind in STAYS:
        assert changed_keys(case) == ()
        return
    assert changed_keys(case) == (key,)
    assert reason_of(case, key).strip() == ""
    assert provenance(case)[key] == ("default" if line is None else "given")
    again = read_case(with_every_key(case))
    assert again == case
    assert changed_keys(again) == changed_keys(case)
    assert with_every_key(again) == with_every_key(case)
    others = [k for k in began.assumed if k != key]
    assert all(case.assumed[k] == began.assumed[k] for k in others)


@pytest.mark.parametrize("same", ["20 mm", "0.02 m", "2e4 um", "0.02000000000001 m"])
def test_the_same_value_in_another_unit_preserves_its_reason(same: str) -> None:
    text = with_every_key(td.load_case("fzg-roughness"))
    case = read_case(edited(text, WIDTH, f'face_width = "{same}"'))
    assert provenance(case)[WIDTH].startswith("assumed: FZG type A test gears are 20 mm wide")
    assert changed_keys(case) == ()
    assert "Values of the case: Study" in cite(case)


def test_another_value_by_a_thousandth_does_not() -> None:
    text = with_every_key(td.load_case("fzg-roughness"))
    case = read_case(edited(text, WIDTH, 'face_width = "20.02 mm"'))
    assert provenance(case)[WIDTH] == "given"


@pytest.mark.parametrize("name", sorted(case_files()))
def test_unchanged_values_preserve_their_reason(name: str, tmp_path: Path) -> None:
    case = td.load_case(name)
    origins = provenance(case)
    assert all(origins[key] == f"assumed: {reason}" for key, reason in case.assumed.items())
    assert f"Values of the case: {case.origin}" in cite(case)
    for text in (with_every_key(case), old_form(with_every_key(case))):
        path = tmp_path / "copy.toml"
        path.write_text(text, encoding="utf-8")
        copy = td.load_case(path)
        assert copy == case
        assert assumptions(copy) == assumptions(case)
        assert cite(copy) == cite(case)
        assert case_cautions(copy) == case_cautions(case)


def other_values(spec: Option, value: Any) -> list[Any]:
    """Values of a key unlike the one in force, the likeliest to be allowed first."""
    if spec.names is not None:
        return [name for name in spec.names() if name != value]
    if spec.kind == "flag":
        return [not value]
    if spec.kind == "integer":
        return [value + 1, value - 1]
    if isinstance(value, tuple):
        return [tuple(factor * each for each in value) for factor in (1.001, 0.999)]
    return [value * 1.001, value * 0.999] if value else [spec.high * 1e-3]


def mutated(case: Any, key: str) -> Any:
    """The case with another value of one key, or None if the change alone is no valid case."""
    for other in other_values(case.option_of(key), effective(case)[key]):
        try:
            return case.replace({key: other})
        except InputError:
            continue
    return None


@pytest.mark.parametrize("name", sorted(case_files()))
def test_every_changed_value_loses_its_reason(name: str, tmp_path: Path) -> None:
    case = td.load_case(name)
    text = with_every_key(case)
    path, done = tmp_path / "my.toml", Counter[str]()
    for key in case.assumed:
        changed = mutated(case, key)
        if changed is None or key in changed.assumed:
            assert changed is None
            continue
        loses_its_reason(case, changed, key, changed_text := with_every_key(changed))
        done["replace"] += 1
        lines = re.findall(
            rf"^{key.rpartition('.')[2]} = .*$", edited_block(changed_text, key), re.MULTILINE
        )
        assert len(lines) == 1, key
        for way, began in (("file", text), ("old file", old_form(text))):
            path.write_text(edited(began, key, lines[0]), encoding="utf-8")
            try:
                changed = td.load_case(path)
            except InputError:
                continue  # Options of the model left behind have to go by hand.
            loses_its_reason(case, changed, key, with_every_key(changed))
            done[way] += 1
    assert all(done[way] >= 0.75 * len(case.assumed) for way in ("replace", "file", "old file"))


def loses_its_reason(case: Any, changed: Any, key: str, text: str) -> None:
    """Check that a changed value has no reason, neither in the case, nor its file or sources."""
    assert key in changed_keys(changed)
    assert reason_of(changed, key).strip() == ""
    assert provenance(changed)[key] == "given"
    assert not re.search(rf'^"{key}" = .*{re.escape(case.assumed[key])}', text, re.MULTILINE)
    sources = cite(changed)
    assert f"Values of the case: {case.origin}" not in sources
    assert f"Based on: {case.origin}" in sources
    assert key in sources


def edited_block(text: str, key: str) -> str:
    """The table of a key in the text of a case file."""
    table = key.rpartition(".")[0]
    start = text.index(f"\n[{table}]")
    return text[start : text.find("\n[", start + 2)]


def test_all_of_it_holds_on_the_command_line(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert call(["check", "fzg-roughness"]) == 0
    assert "(--all): 20 assumed" in capsys.readouterr().err
    arguments = ["--set", f"{WIDTH}=30 mm", "--set", "gears.wheel.face_width=30 mm"]
    assert call(["check", "fzg-roughness", *arguments]) == 0
    by_set = capsys.readouterr().err
    assert "(--all): 18 assumed" in by_set
    assert call(["new", "my.toml", "--from", "fzg-roughness"]) == 0
    text = Path("my.toml").read_text(encoding="utf-8")
    Path("my.toml").write_text(text.replace('\nface_width = "20 mm"', '\nface_width = "30 mm"'))
    capsys.readouterr()
    assert call(["check", "my.toml"]) == 0
    # What has no effect is named at its line, and a copy of the case has other lines.
    places = re.compile(r"^\S+\.toml:\d+: (?=.* has no effect)", re.MULTILINE)
    assert places.sub("", capsys.readouterr().err) == places.sub("", by_set)
    assert call(["check", "my.toml", "--json"]) == 0
    out = capsys.readouterr()
    assert "20 mm wide" not in out.out + out.err
    assert isinstance(json.loads(out.out), dict)
    sources = cite(td.load_case("my.toml"))
    assert "Values of the case" not in sources
    assert f"2 values of the case differ: {WIDTH}, gears.wheel.face_width" in sources
    assert r"gears.pinion.face\_width" in cite(td.load_case("my.toml"), "bibtex")


def test_result_and_report_say_nothing_of_the_old_value(tmp_path: Path) -> None:
    case = td.load_case("fzg-stiffness")
    old = case.assumed["friction.coefficient"]
    for value, cited in ((None, True), (0.1, False)):
        changes = {} if value is None else {"friction.coefficient": value}
        result = td.run(case.replace(changes | {"solver.steps_per_mesh_cycle": 256}))
        page = html.unescape(render_report(result))
        reasons = [row.reason for row in result.assumptions]
        assert (old in reasons) is cited
        assert (old in page) is cited
        assert "Values of the case:" not in page + result.cite()  # the steps are not its own
        assert "solver.steps_per_mesh_cycle" in result.cite()
        assert ("friction.coefficient" in result.cite()) is not cited
    result.save(tmp_path / "unchanged")
    assert td.load_case(tmp_path / "unchanged" / "case.toml") == result.case


def test_the_table_of_a_sweep_gives_no_reason_for_varied_keys(tmp_path: Path) -> None:
    case = td.load_case("fzg-stiffness").replace({"solver.steps_per_mesh_cycle": 256})
    result = td.sweep(case, {"friction.coefficient": [0.1, 0.119]})
    page = write_sweep_report(result, tmp_path / "report.html").read_text(encoding="utf-8")
    table = page[page.index('id="assumptions"') : page.index("</section>", page.index('id="assu'))]
    old = case.assumed["friction.coefficient"]
    assert html.escape(old, quote=False) not in table
    assert "stiffness.mean_stiffness" in table


def test_replace_by_another_table_drops_the_reasons_of_the_old() -> None:
    case = td.load_case("time-varying-friction").replace({"lubricant": None, "friction": None})
    assert "lubricant.name" not in case.assumed
    assert {"lubricant.name", "friction.law"} <= set(changed_keys(case))
    wide = td.load_case("fzg-film").replace({"lubricant.name": "80W"} | dict.fromkeys(
        ("lubricant.dynamic_viscosity", "lubricant.density",
         "lubricant.pressure_viscosity_coefficient")))  # fmt: skip
    assert "lubricant.name" in changed_keys(wide)


def test_back_to_the_old_value_is_the_old_source_again() -> None:
    case = td.load_case("fzg-roughness")
    changed = case.replace({WIDTH: "30 mm"})
    assert changed_keys(changed) == (WIDTH,)
    back = changed.replace({WIDTH: "20 mm"})
    assert changed_keys(back) == ()
    assert provenance(back)[WIDTH] == "given"  # by who wrote it anew
    assert "Values of the case" in cite(back)


def test_keywords_take_a_reason_with_or_without_its_value() -> None:
    tables = {
        "gears": {
            "normal_module": 4.5e-3, "normal_pressure_angle": 0.35, "driver": "pinion",
            "pinion": {"teeth": 20, "face_width": 0.02}, "wheel": {"teeth": 24},
        },
        "operation": {"speed": 100.0, "torque": 90.0},
        "stiffness": {"reference": "rim"},
        "dynamics": {"model": "torsional"},
    }  # fmt: skip
    plain = td.Case(**tables, assumed={WIDTH: "a guess"})
    assert plain.assumed == {WIDTH: "a guess"}
    assert plain.replace({WIDTH: 0.03}).assumed == {}
    for value, retained in ((0.02, True), ("2 cm", True), (0.021, False)):
        record = {WIDTH: {"value": value, "reason": "a guess"}}
        assert (WIDTH in td.Case(**tables, assumed=record).assumed) is retained


def test_a_reason_of_the_user_is_preserved() -> None:
    text = edited(with_every_key(td.load_case("fzg-roughness")), WIDTH, 'face_width = "30 mm"')
    mark = next(line for line in text.splitlines() if line.startswith(f'"{WIDTH}"'))
    case = read_case(text.replace(mark, f'"{WIDTH}" = "measured on the drawing"'))
    assert provenance(case)[WIDTH] == "assumed: measured on the drawing"
    assert changed_keys(case) == (WIDTH,)
    assert read_case(with_every_key(case)) == case


def test_a_removed_mark_changes_no_value() -> None:
    text = with_every_key(td.load_case("fzg-roughness"))
    lines = [line for line in text.splitlines() if not line.startswith(f'"{WIDTH}" = {{')]
    case = read_case("\n".join(lines))
    assert provenance(case)[WIDTH] == "given"
    assert changed_keys(case) == ()


def test_a_new_origin_replaces_the_source_of_the_preset() -> None:
    text = edited(with_every_key(td.load_case("fzg-roughness")), WIDTH, 'face_width = "30 mm"')
    line = next(line for line in text.splitlines() if line.startswith("origin = "))
    case = read_case(text.replace(line, 'origin = "Drawing 4711"', 1))
    assert changed_keys(case) == ()
    assert "Values of the case: Drawing 4711." in cite(case)
    assert "Study of the flank roughness" not in cite(case) + with_every_key(case)
    assert "Based on: Drawing 4711" in cite(case.replace({"operation.torque": 95.0}))
    none = read_case(text.replace(line, "", 1))
    assert "Study of the flank" not in cite(none)


def test_a_mass_of_another_gear_is_reported() -> None:
    case = td.load_case("fzg-roughness")
    code = "mass-of-other-gear"
    assert code not in [warning.code for warning in case_cautions(case)]
    wide = read_case(edited(with_every_key(case), WIDTH, 'face_width = "30 mm"'))
    texts = [str(warning) for warning in case_cautions(wide) if warning.code == code]
    assert len(texts) == 2
    solid = wide.replace({"gears.pinion.moment_of_inertia": None, "gears.pinion.mass": None})
    assert code not in [warning.code for warning in case_cautions(solid)]
    assert "pinion: moment_of_inertia = 407 kg*mm^2" in texts[1]
    assert f"before {WIDTH} changed" in texts[1]


def test_a_reason_states_that_its_value_has_changed() -> None:
    case = td.load_case("fzg-12dof").replace({WIDTH: "12 mm"})
    reason = "assumed: that of a comparable FZG pair, 20 mm wide; none is printed"
    assert provenance(case)["gears.pinion.mass"] == f"{reason}; stated before {WIDTH} changed"
    assert provenance(case)["gears.wheel.mass"].endswith("none is printed")
    assert provenance(read_case(with_every_key(case))) == provenance(case)


@pytest.mark.parametrize("origin", ['origin = "Another"', 'title = "x"'])
@pytest.mark.parametrize("of_file", [True, False])
def test_a_base_of_another_origin_reads_back_equal(origin: str, of_file: bool) -> None:
    text = Path(case_files()["fzg-12dof"]).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if of_file or not line.startswith("origin")]
    case = read_case("\n".join([*lines, "[based_on]", origin, '"gears.pinion.teeth" = 20']))
    assert read_case(with_every_key(case)) == case


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('"gears.pinion.face_widht" = { value = "20 mm", reason = "x" }', "no key"),
        (f'"{WIDTH}" = {{ value = "20 s", reason = "x" }}', "wrong kind of quantity"),
        (f'"{WIDTH}" = {{ value = "20 mm" }}', "must be text"),
        (f'"{WIDTH}" = {{ value = "20 mm", reason = "x", of = 3 }}', "must be text"),
        ('[based_on]\n"gears.module" = "3 mm"', "no key"),
    ],
)
def test_faults_of_a_record_are_reported_with_their_line(line: str, message: str) -> None:
    text = Path(case_files()["fzg-stiffness"]).read_text(encoding="utf-8") + line + "\n"
    with pytest.raises(InputError, match=message) as caught:
        read_case(text, "my.toml")
    assert f"my.toml:{text.count(chr(10))}" in str(caught.value)


def test_a_file_of_before_names_what_its_user_changed(tmp_path: Path) -> None:
    path = tmp_path / "old.toml"
    text = edited(
        old_form(with_every_key(td.load_case("fzg-12dof"))), WIDTH, 'face_width = "14 mm"'
    )
    text = edited(text, "dynamics.shaft1_damping", 'shaft1_damping = "0.5 N*m*s/rad"')
    path.write_text(text, encoding="utf-8")
    case = td.load_case(path)
    assert changed_keys(case) == (WIDTH, "dynamics.shaft1_damping")
    assert provenance(case)["dynamics.shaft1_damping"] == "given"
    assert provenance(case)["dynamics.shaft2_damping"].startswith("assumed: about 2 %")
    assert "Based on: Study of the transmission error of FZG A10 gears" in cite(case)


@pytest.mark.parametrize("law", ["none", "constant", "xu-2007", "mixed"])
def test_only_options_of_the_chosen_law_are_listed(law: str) -> None:
    options = {"friction.law": law, "friction.coefficient": 0.05 if law == "constant" else None}
    case = td.load_case("fzg-roughness").replace({"friction.variant": None, **options})
    listed = {each.key for each in assumptions(case) if each.key.startswith("friction.")}
    option_keys = {f"friction.{name}" for name in case.friction.chosen.options}
    assert listed - {"friction.law"} <= option_keys
    assert ("friction.summit_density" in listed) == (law == "mixed")


@pytest.mark.parametrize("name", ["fzg-roughness", "planetary-stage", "wind-turbine-gearbox"])
def test_an_edited_copy_of_a_named_case_knows_what_was_changed(name: str, tmp_path: Path) -> None:
    file, text = tmp_path / "copy.toml", all_files()[name].read_text(encoding="utf-8")
    file.write_text(text, encoding="utf-8")
    assert td.load_case(file) == td.load_case(name)
    (speed, *_) = re.findall(r'^speed = "([\d.]+) rpm"', text, re.MULTILINE)
    line = f'speed = "{2.0 * float(speed)} rpm"'
    file.write_text(text.replace(f'speed = "{speed} rpm"', line, 1), encoding="utf-8")
    assert changed_keys(td.load_case(file)) == ("operation.speed",)
