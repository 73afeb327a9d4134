"""Commands that compute no motion, called in this process."""

from __future__ import annotations

import itertools
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

import tribodyn
from tribodyn.cli import call
from tribodyn.cli.app import COMMANDS
from tribodyn.study import SUMMARY

CHECKED = {
    "transverse_contact_ratio",
    "operating_pressure_angle",
    "center_distance",
    "gear_loss_factor",
    *(f"roll_angle_{place}" for place in "ABCDE"),
    *(
        f"{name}_{gear}"
        for name in ("base_radius", "tip_diameter", "mass", "moment_of_inertia")
        for gear in ("pinion", "wheel")
    ),
}


@pytest.fixture(autouse=True)
def in_new_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_bare_command_shows_three_next_steps(capsys: pytest.CaptureFixture[str]) -> None:
    assert call([]) == 0
    steps = [line for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    assert len(steps) == 3
    assert all(step.strip().startswith("tribodyn ") for step in steps)


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["--version"]) == 0
    assert capsys.readouterr().out.strip() == tribodyn.__version__


def test_the_package_itself_is_the_command_line() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tribodyn", "--version"], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == tribodyn.__version__


def test_the_shell_completes_commands(in_new_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(in_new_folder))  # its start file is written to
    script = in_new_folder / "completion"
    arguments = ["--install-completion", "--shell", "bash", "--output", str(script)]
    assert call(arguments) == 0
    text = script.read_text(encoding="utf-8")
    assert "bifurcation" in text
    assert "--install-completion" in text
    assert str(script) in (in_new_folder / ".bashrc").read_text(encoding="utf-8")


def test_every_extra_is_used() -> None:
    root = Path(__file__).parents[2]
    extras = tomllib.loads((root / "pyproject.toml").read_text("utf-8"))["project"][
        "optional-dependencies"
    ]
    known_extras = {"app", "cluster", "cuda", "docs", "images", "io", "learn", "test", "dev"}
    assert set(extras) == known_extras
    page = (root / "docs" / "install.md").read_text("utf-8")
    assert set(re.findall(r"^\| `(\w+)` \|", page, re.M)) == set(extras)


@pytest.mark.parametrize(
    "command",
    [
        ["--json"],
        ["cases", "--json"],
        ["check", "fzg-roughness", "--json"],
        ["explain", "backlash", "--json"],
        ["units", "--json"],
        ["new", "my.toml", "--from", "fzg-roughness", "--json"],
        ["check", "no-such-case", "--json"],
        ["explain", "no-such-symbol", "--json"],
        ["cite", "no-such-result", "--json"],
        ["run", "no-such-case", "--json"],
        ["frobnicate", "--json"],
        ["check", "--json"],
    ],
)
def test_json_is_exactly_one_value_on_stdout(
    command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    code = call(command)
    captured = capsys.readouterr()
    value = json.loads(captured.out)
    assert code in (0, 2)
    assert ("error" in value) == (code == 2)
    if code == 2:
        assert value["error"]["exit_code"] == 2
        assert value["error"]["problems"][0]["what"]
        assert captured.err.startswith("error: ")


def test_check_gives_the_geometry_in_si(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["check", "fzg-roughness", "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert set(values) >= CHECKED
    assert set(values) <= set(SUMMARY)
    assert all(type(value) is float for value in values.values())
    assert values["transverse_contact_ratio"] == pytest.approx(1.326952, abs=5e-7)
    assert values["tip_diameter_pinion"] == pytest.approx(88.593e-3, abs=5e-7)
    assert values["moment_of_inertia_wheel"] == pytest.approx(1168e-6)


def test_check_prints_values_with_units_warnings_and_assumptions(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert call(["check", "fzg-roughness"]) == 0
    captured = capsys.readouterr()
    assert re.search(r"center_distance +91\.5 mm +distance", captured.out)
    assert "warning [thin-tip]" in captured.err
    assert "(--all): 20 assumed, 25 default" in captured.err
    assert call(["check", "fzg-roughness", "--all"]) == 0
    text = capsys.readouterr().err
    assert "dynamics.backlash = 0.05 mm (assumed): the printed equations are linear" in text
    assert (text.count(" (assumed): "), text.count(" (default): ")) == (20, 25)


def test_check_of_a_machine_fits_a_screen(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["check", "two-stage-spur"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 80
    assert max(map(len, lines)) <= 100
    (row,) = [line for line in lines if "center_distance [mm]" in line]
    shown = [float(value) for value in row.split("]")[1].split()]
    assert call(["check", "two-stage-spur", "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    meshes = [name for name in values if name.endswith(".center_distance")]
    assert shown == pytest.approx([1e3 * values[name] for name in meshes], rel=1e-4)


def test_set_changes_a_value_and_is_named_in_errors(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert call(["check", "fzg-roughness", "--json", "--set", "gears.driver=wheel"]) == 0
    wheel = json.loads(capsys.readouterr().out)
    assert wheel["roll_angle_A"] != pytest.approx(0.324239, abs=1e-3)
    faulty = ["check", "fzg-roughness", "--set", "operation.speed=900", "--set", "gears.x=1"]
    assert call(faulty) == 2
    error = capsys.readouterr().err
    assert "--set operation.speed: speed = 900" in error
    assert "--set gears.x: x = 1: unknown key" in error
    assert "2 faults found" in error


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        ("torque", "is not KEY=VALUE"),
        ("operation.torque=", "--set operation.torque: torque is missing"),
        ("=3 mm", "is not KEY=VALUE"),
    ],
)
def test_malformed_set(setting: str, says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["check", "fzg-roughness", "--set", setting]) == 2
    assert says in capsys.readouterr().err


def test_the_same_key_set_twice(capsys: pytest.CaptureFixture[str]) -> None:
    twice = ["--set", "operation.torque=1 N*m", "--set", "operation.torque=2 N*m"]
    assert call(["check", "fzg-roughness", *twice]) == 2
    assert '"1 N*m" and to "2 N*m"' in capsys.readouterr().err


def test_new_writes_a_case_that_checks(
    in_new_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["new", "my.toml", "--from", "fzg-roughness"]) == 0
    assert tribodyn.load_case("my.toml") == tribodyn.load_case("fzg-roughness")
    assert call(["check", "my.toml"]) == 0
    before = (in_new_folder / "my.toml").read_text()
    assert call(["new", "my.toml", "--from", "fzg-roughness"]) == 2
    assert "exists already" in capsys.readouterr().err
    assert (in_new_folder / "my.toml").read_text() == before
    assert call(["new", "my.toml", "--from", "fzg-roughness", "--force"]) == 0
    assert call(["new", "no/my.toml", "--from", "fzg-roughness"]) == 2
    assert "no such directory" in capsys.readouterr().err
    assert [path.name for path in in_new_folder.iterdir()] == ["my.toml"]


def test_new_takes_the_files_of_a_machine_along(
    in_new_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = [f"my-two-stage-spur-housing-{matrix}.mtx" for matrix in "KM"]
    assert call(["new", "my.toml", "--from", "two-stage-spur", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"path": "my.toml", "files": names}
    machine, origin = map(tribodyn.load_case, ("my.toml", "two-stage-spur"))
    assert sorted(machine.housing_files.values()) == [str(in_new_folder / name) for name in names]
    assert (machine.housing.stiffness == origin.housing.stiffness).all()
    (in_new_folder / "my.toml").unlink()
    assert call(["new", "my.toml", "--from", "two-stage-spur"]) == 2
    assert f"{names[0]}: this exists already" in capsys.readouterr().err
    assert not (in_new_folder / "my.toml").exists()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["chekc"], 'Did you mean "check"?'),
        (["run"], "tribodyn run fzg-roughness"),
        (["run", "fzg-roughness", "--set", "a=1", "b=2"], "Repeat --set"),
        (["run", "fzg-roughness", "--oot", "x"], "--out"),
        (["check", "fzg-roughnes"], 'Did you mean "fzg-roughness"?'),
        (["check", "."], "directory"),
        (["explain", "alpha_vt"], "alpha_wt"),
        (["new"], "tribodyn new my.toml"),
    ],
)
def test_wrong_arguments_name_the_right_ones(
    arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(arguments) == 2
    assert says in capsys.readouterr().err


def test_a_missing_file_names_its_neighbours(
    in_new_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (in_new_folder / "gears.toml").write_text("title = 'x'")
    assert call(["check", "gaers.toml"]) == 2
    error = capsys.readouterr().err
    assert 'Did you mean "gears.toml"?' in error
    assert "fzg-roughness" in error


def test_a_file_that_is_no_text(in_new_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (in_new_folder / "x.toml").write_bytes(b"title = 'x'\n\xff\xfe")
    assert call(["check", "x.toml"]) == 2
    assert "x.toml:2: byte 0xff is not UTF-8" in capsys.readouterr().err


def test_explain_knows_quantities_keys_and_figures(capsys: pytest.CaptureFixture[str]) -> None:
    for term, says in (
        ("epsilon_alpha", "transverse_contact_ratio"),
        ("gears.center_distance", "0.1 mm to 10000 mm"),
        ("contact_loss_share", "part of the mesh cycle"),
    ):
        assert call(["explain", term]) == 0
        assert says in capsys.readouterr().out


@pytest.mark.parametrize("failure", [RuntimeError("inner fault"), KeyError("k")])
def test_an_unexpected_failure_shows_no_traceback(
    failure: Exception, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise failure

    monkeypatch.setattr("tribodyn.cases.catalogue.cases", fail)
    assert call(["cases"]) == 1
    error = capsys.readouterr().err
    assert "Traceback" not in error
    assert type(failure).__name__ in error
    assert "TRIBODYN_TRACEBACK" in error
    monkeypatch.setenv("TRIBODYN_TRACEBACK", "1")
    assert call(["cases"]) == 1
    assert "Traceback" in capsys.readouterr().err


def test_interruption_has_its_own_exit_code(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tribodyn.cases.catalogue.cases", stop)
    assert call(["cases"]) == 130
    assert "interrupted" in capsys.readouterr().err


@pytest.mark.parametrize(
    "settings",
    [
        ["friction.law=none"],
        ["friction.law=xu-2007"],
        ["friction.law=constant", "friction.coefficient=0.1"],
        ["friction.law="],
        ["friction.variant="],
        ["stiffness.model=iso6336"],
        ["stiffness.model=rectangular", "stiffness.pair_stiffness=2e8 N/m"],
        ["dynamics.model=torsional"],
    ],
)
def test_another_choice_leaves_the_options_of_the_old_one_behind(settings: list[str]) -> None:
    arguments = [argument for setting in settings for argument in ("--set", setting)]
    assert call(["check", "fzg-roughness", *arguments]) == 0


def test_an_option_set_together_with_a_choice_is_never_dropped(
    capsys: pytest.CaptureFixture[str],
) -> None:
    together = ["--set", "friction.law=none", "--set", "friction.coefficient=0.1"]
    assert call(["check", "fzg-roughness", *together]) == 2
    assert "coefficient = 0.1 does not belong" in capsys.readouterr().err


def test_options_of_an_earlier_choice_do_not_return() -> None:
    case = tribodyn.load_case("fzg-roughness")
    changed = case.replace({"friction.law": "none"})
    back = changed.replace({"friction.law": "benedict-kelly"})
    assert back.friction.variant is None
    assert "friction.variant" not in back.assumed


def test_a_full_disk_is_no_fault_of_the_program() -> None:
    command = f"{sys.executable} -m tribodyn.cli units > /dev/full"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "no space left" in done.stderr
    assert "fault of tribodyn" not in done.stderr


def test_the_way_of_a_result_may_be_blocked_by_a_file(
    in_new_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (in_new_folder / "thing").write_text("x")
    assert call(["run", "fzg-roughness", "--out", "thing"]) == 2
    assert "a file is in the way" in capsys.readouterr().err
    assert call(["run", "fzg-roughness", "--out", "thing/inner"]) == 2
    assert "a file, not a directory" in capsys.readouterr().err


@pytest.mark.parametrize("command", [name for name, *_ in COMMANDS])
def test_lines_of_help_are_as_long_as_the_screen_lets_them(
    command: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert call([command, "--help"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("│")]
    for line, following in itertools.pairwise(line[1:-1].rstrip() for line in lines):
        more = re.match(r"^ {8,}(\S+)", following)  # goes on with the line before
        assert more is None or len(line) + 1 + len(more[1]) > 76


@pytest.mark.parametrize(
    ("command", "text"),
    [
        ("modes", "Values of the case to change"),
        ("lead", "It holds best.toml"),
        ("sobol", "Tolerances and other changes of the case"),
        ("friction-from-loss", "gear_loss_factor, gear_sets"),
        ("signal", "Sensitivity of its sensor"),
    ],
)
def test_options_that_commands_share_have_the_text_of_each(
    command: str, text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call([command, "--help"]) == 0
    lines = capsys.readouterr().out.splitlines()
    words = " ".join(" ".join(line.strip("│").split()) for line in lines)
    assert text in words
    assert "--json" in words
