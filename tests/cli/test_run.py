"""``tribodyn run`` and ``cite``: whole results, no overwriting, and Ctrl-C leaves nothing."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tribodyn.cli import call
from tribodyn.study.pipeline.save import RESULT_FILES

_TRIBODYN = (sys.executable, "-m", "tribodyn.cli")
_SWEEP = "operation.speed=900,1000 rpm"
_FAST = ("--set", "solver.steps_per_mesh_cycle=256")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_run_writes_a_result_named_after_the_case(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["run", "fzg-roughness", *_FAST]) == 0
    captured = capsys.readouterr()
    assert "peak_mesh_force" in captured.out
    assert "fzg-roughness/report.html" in captured.err
    assert "warning [thin-tip]" in captured.err
    assert os.listdir(folder) == ["fzg-roughness"]
    assert set(os.listdir(folder / "fzg-roughness")) == set(RESULT_FILES)


def test_a_quiet_run_prints_warnings_and_the_report_and_opens_it(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    assert call(["run", "fzg-roughness", *_FAST, "--quiet", "--open"]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "warning [thin-tip]" in captured.err
    assert opened == [(folder / "fzg-roughness" / "report.html").as_uri()]


def test_json_is_the_summary_that_is_saved(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["run", "fzg-roughness", *_FAST, "--json", "--out", "rough"]
    assert call([*arguments, "--set", "gears.composite_roughness=0.991 um"]) == 0
    captured = capsys.readouterr()
    figures = json.loads(captured.out)
    assert figures == json.loads((folder / "rough" / "summary.json").read_text())
    assert figures["mesh_frequency"] == pytest.approx(240.0)
    assert "warning [friction-roughness]" in captured.err


def test_an_existing_result_is_replaced_only_by_force(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = folder / "fzg-roughness"
    assert call(["run", "fzg-roughness", *_FAST]) == 0
    first = (place / "summary.json").read_text()
    other = ["run", "fzg-roughness", *_FAST, "--set", "operation.torque=120 N*m"]
    assert call(other) == 2
    assert "--force" in capsys.readouterr().err
    assert (place / "summary.json").read_text() == first
    assert call([*other, "--force"]) == 0
    assert (place / "summary.json").read_text() != first
    assert os.listdir(folder) == ["fzg-roughness"]


def test_the_saved_case_runs_again_to_the_same_figures(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["run", "fzg-roughness", *_FAST]) == 0
    assert call(["run", "fzg-roughness/case.toml", "--out", "again"]) == 0
    first, two = (json.loads((folder / d / "summary.json").read_text())
                  for d in ("fzg-roughness", "again"))  # fmt: skip
    assert first == two
    capsys.readouterr()


def test_force_does_not_touch_other_files(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "fzg-roughness").mkdir()
    (folder / "fzg-roughness" / "thesis.tex").write_text("x")
    assert call(["run", "fzg-roughness", *_FAST, "--force"]) == 2
    assert "thesis.tex" in capsys.readouterr().err
    assert (folder / "fzg-roughness" / "thesis.tex").exists()


def test_a_failed_computation_exits_with_one(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from tribodyn.errors import ComputationError

    def fail(*_: object) -> None:
        raise ComputationError("the search failed")

    monkeypatch.setattr("tribodyn.cases.load.run", fail)
    assert call(["run", "fzg-roughness", "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["error"]["exit_code"] == 1
    assert os.listdir(folder) == []


def test_the_root_directory_is_no_place_for_a_result(capsys: pytest.CaptureFixture[str]) -> None:
    for command in ("run", "modes"):
        assert call([command, "fzg-roughness", "--out", "/"]) == 2
        error = capsys.readouterr().err
        assert error.startswith("error: /: this is the root directory. ")
        assert error.endswith("Choose a directory in it.\n")


@pytest.mark.skipif(os.name != "posix", reason="Windows has no such locks")
def test_two_runs_do_not_write_one_directory(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    codes: list[int] = []

    def compute(*_: object) -> None:
        """Start another command while this one computes."""
        others = [["run", "fzg-roughness", "--force"], ["sweep", "fzg-roughness", _SWEEP]]
        for arguments in others:
            command = [*_TRIBODYN, *arguments, "--out", "r"]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            codes.append(done.returncode)
            assert "r: this directory is in use. Another run" in done.stderr
        raise KeyboardInterrupt

    monkeypatch.setattr("tribodyn.cases.load.run", compute)
    assert call(["run", "fzg-roughness", "--out", "r"]) == 130
    assert codes == [2, 2]
    assert os.listdir(folder) == []


def test_cite_reads_a_result(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["run", "fzg-roughness", *_FAST, "--json"]) == 0
    capsys.readouterr()
    assert call(["cite", "fzg-roughness"]) == 0
    assert "Benedict" in capsys.readouterr().out
    assert call(["cite", "fzg-roughness", "--bibtex"]) == 0
    assert "@article{benedict-kelley," in capsys.readouterr().out
    assert call(["cite", "fzg-roughness", "--json"]) == 0
    assert "xu" not in [paper["key"] for paper in json.loads(capsys.readouterr().out)]
    assert call(["cite", "."]) == 2
    assert "no case.toml" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "code"), [(["cases"], 0), (["check", "no-such-case"], 2), (["frobnicate"], 2)]
)
def test_exit_codes_of_the_process(arguments: list[str], code: int) -> None:
    done = subprocess.run([*_TRIBODYN, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == code
    assert "Traceback" not in done.stderr
    assert bool(done.stdout) == (code == 0)


def test_a_closed_pipe_is_no_failure() -> None:
    command = f"{' '.join(_TRIBODYN)} units | head -n 1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert done.stderr == ""


@pytest.mark.slow
@pytest.mark.parametrize("moment", ["computing", "writing"])
def test_ctrl_c_leaves_nothing(folder: Path, moment: str) -> None:
    # A long transient is interrupted while it marches; a result while its report is written.
    hook = folder.parent / f"{folder.name}-hook"
    hook.mkdir()
    (hook / "sitecustomize.py").write_text(_SLOW_REPORT if moment == "writing" else _AT_WORK)
    march = ["--set", "solver.method=transient", "--set", "solver.cycles=20000"]
    arguments = [*_TRIBODYN, "run", "fzg-roughness", *(march if moment == "computing" else _FAST)]
    process = subprocess.Popen(
        arguments, cwd=folder, text=True, stderr=subprocess.PIPE, stdout=subprocess.PIPE,
        start_new_session=True, env={**os.environ, "PYTHONPATH": str(hook)},
    )  # fmt: skip
    _wait_until(folder, hook, moment)
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted" in err
    assert "Traceback" not in err
    assert out == ""
    assert os.listdir(folder) == []


_SLOW_REPORT = """
import time
import tribodyn.report
from tribodyn.drawing import REPORTS
REPORTS.register("Result")(lambda result, path: time.sleep(60))
"""


# Creates a file once the motion is being computed.
_AT_WORK = """
import pathlib
from importlib import import_module
pipeline = import_module("tribodyn.study.pipeline.run")
original = pipeline.motion_of
def motion_of(*words):
    pathlib.Path(__file__).with_name("at-work").touch()
    return original(*words)
pipeline.motion_of = motion_of
"""


def _wait_until(folder: Path, hook: Path, moment: str) -> None:
    """Wait until the process computes the motion, or has begun to write its result."""
    for _ in range(1200):
        if moment == "computing" and (hook / "at-work").exists():
            time.sleep(1.0)
            return
        if moment == "writing" and any(
            (place / "response.nc").exists() for place in folder.iterdir()
        ):
            return
        time.sleep(0.1)
    pytest.fail("the process never came so far")
