"""``tribodyn sweep`` and ``bifurcation``: files, tables, bad input, and Ctrl-C that keeps."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray

from tribodyn.cli import call
from tribodyn.cli.settings import read_ranges
from tribodyn.errors import InputError
from tribodyn.study.pipeline.save import BIFURCATION_FILES, SWEEP_FILES

_TRIBODYN = (sys.executable, "-m", "tribodyn.cli")
_FAST = ("--set", "solver.steps_per_mesh_cycle=512", "--set", "film.model=none")
_SPEEDS = "operation.speed=1000..1500 rpm:2"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a.b=400..3500 rpm:60", ("400 rpm", "3500 rpm", 60)),
        ("a.b=400 rpm .. 58 Hz : 3", ("400 rpm", "58 Hz", 3)),
        ("a.b=1.1e5..2.17e7 N/mm:5", ("1.1e5 N/mm", "2.17e7 N/mm", 5)),
        ("a.b=0.01..0.1:4", (0.01, 0.1, 4)),
        ("a.b=-1..1 um:3", ("-1 um", "1 um", 3)),
        ("a.b=50,150, 300 N*m", ["50 N*m", "150 N*m", "300 N*m"]),
        ("a.b=16,17", [16, 17]),
        ("a.b=none,xu-2007", ["none", "xu-2007"]),
    ],
)
def test_grammar(text: str, values: object) -> None:
    assert read_ranges([text]) == {"a.b": values}


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("operation.speed", "not KEY=VALUES"),
        ("a.b=4..5 rpm", "number of points"),
        ("a.b=4..5 rpm:some", "no whole number"),
        ("a.b=low..5 rpm:3", '"low" is no number'),
        ("a.b=1,,2", "between two commas"),
    ],
)
def test_a_wrong_range_is_explained_with_the_grammar(text: str, why: str) -> None:
    with pytest.raises(InputError, match=why) as caught:
        read_ranges([text])
    assert "operation.speed=400..3500 rpm:60" in str(caught.value)


def test_sweep_writes_a_table_and_a_report(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["sweep", "fzg-roughness", _SPEEDS, "operation.torque=50,90 N*m", *_FAST]
    assert call(arguments) == 0
    captured = capsys.readouterr()
    lines = captured.out.splitlines()
    assert "peak_mesh_force" in lines[1]
    assert [line.split()[:4] for line in lines[2:]] == [
        ["1000", "rpm", "50", "N*m"], ["1000", "rpm", "90", "N*m"],
        ["1500", "rpm", "50", "N*m"], ["1500", "rpm", "90", "N*m"],
    ]  # fmt: skip
    assert "fzg-roughness-sweep/report.html" in captured.err
    place = folder / "fzg-roughness-sweep"
    assert set(os.listdir(place)) == set(SWEEP_FILES)
    page = (place / "report.html").read_text(encoding="utf-8")
    assert "Mesh force, rms" in page
    assert call(arguments) == 2
    assert "--force" in capsys.readouterr().err
    assert call([*arguments, "--force"]) == 0


def test_json_holds_every_row_in_si(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["sweep", "fzg-roughness", "friction.law=none,constant", *_FAST, "--json"]
    assert call(arguments) == 0
    captured = capsys.readouterr()
    output = json.loads(captured.out)
    assert output["complete"] is True
    first, second = output["rows"]
    assert first["failed"] == ""
    assert first["static_mesh_force"] == pytest.approx(2660.444, rel=1e-6)
    assert second["rms_mesh_force"] is None
    assert "coefficient is missing" in second["failed"]
    assert "1 of 2 values failed" in captured.err


def test_a_sweep_in_which_all_fails_exits_with_one(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["sweep", "fzg-roughness", "solver.steps_per_mesh_cycle=64,65", "--set"]
    assert call([*arguments, "dynamics.bearing_stiffness=1e12 N/m"]) == 1
    assert "2 of 2 values failed" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["sweep", "bifurcation"])
@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["operation.sped=400..3500 rpm:4"], 'Did you mean "speed"?'),
        (["operation.speed=400..3500:4"], "Write the unit behind the last number"),
        (["operation.speed=400..3500 rpm:100000000"], "the limit is 100000"),
        (["operation.speed=400...3500 rpm:4"], "two dots"),
        (["operation.speed=400..3500 rpm:4", "--sweep", "sideways"], "--help"),
        (["gears.pinion.teeth=15..17:3"], "no values in between"),
        (["operation.speed=3500..400 rpm:4"], "Exchange the two ends"),
        (["operation.speed=400..3500 rpm:1"], "at least two points"),
        (["operation.speed=400..3500 rpm"], "number of points"),
        (["operation.speed=4..5 mm:4"], "rpm"),
        (["friction.law=1..2:3"], "law"),
        ([_SPEEDS, _SPEEDS], "varies twice"),
        ([], "nothing varies"),
    ],
)
def test_bad_input(
    command: str, arguments: list[str], says: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call([command, "fzg-roughness", *arguments]) == 2
    captured = capsys.readouterr()
    assert says in captured.err
    assert captured.out == ""
    assert os.listdir(folder) == []


@pytest.mark.parametrize("command", ["sweep", "bifurcation"])
def test_a_strange_directory_is_not_replaced(
    command: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "mine").mkdir()
    (folder / "mine" / "thesis.tex").write_text("x")
    assert call([command, "fzg-roughness", _SPEEDS, "--out", "mine", "--force"]) == 2
    assert "thesis.tex" in capsys.readouterr().err


def test_bifurcation_prints_its_findings(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--sweep", "both", "--transient", "60", "--cycles", "8", *_FAST]
    assert call(["bifurcation", "fzg-roughness", _SPEEDS, *options]) == 0
    captured = capsys.readouterr()
    assert "4 motions: 4 physical" in captured.out
    assert "down: period 1 from 1000 rpm to 1500 rpm" in captured.out
    place = folder / "fzg-roughness-bifurcation"
    assert set(os.listdir(place)) == set(BIFURCATION_FILES)
    with xarray.open_dataset(place / "bifurcation.nc", engine="h5netcdf") as data:
        assert data.section.shape == (2, 2, 8)
        assert data.parameter.values == pytest.approx(np.array([1000.0, 1500.0]) * np.pi / 30.0)
    page = (place / "bifurcation.html").read_text(encoding="utf-8")
    assert "<h2>Results</h2>" in page


def test_bifurcation_reports_where_the_step_limits_the_motion(
    capsys: pytest.CaptureFixture[str],
) -> None:
    over = "stiffness.mean_stiffness=1.3e7..1.7e7 N/mm:3"
    options = ["--steps", "200", "--transient", "40", "--cycles", "8", "--json"]
    assert call(["bifurcation", "fzg-stiffness", over, *options]) == 0
    output = json.loads(capsys.readouterr().out)
    assert output["step_limited_onset"] == pytest.approx(1.7e10)
    assert 2.7 < output["omega_max_dt_at_onset"] < 2.95
    assert output["verdicts"]["step-limited"] == 1
    assert output["complete"] is True


def test_a_diagram_goes_over_one_range(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["bifurcation", "fzg-roughness", _SPEEDS, "operation.torque=1..2 N*m:3"]
    assert call(arguments) == 2
    assert "2 keys vary" in capsys.readouterr().err
    assert call(["bifurcation", "fzg-roughness", "operation.torque=1,2 N*m"]) == 2
    assert "a range LOW..HIGH" in capsys.readouterr().err


# Writes the progress into a file, and makes every part slow enough to be interrupted.
_HOOKS = {
    "sweep": """
import pathlib, time
import tribodyn.study.studies.sweep as module
original = module._figures
def figures(*words):
    found = original(*words)
    with pathlib.Path(__file__).with_name("done").open("a") as file:
        file.write("x")
    return found
module._figures = figures
""",
    "bifurcation": """
import contextlib, pathlib, time
import tribodyn.cli.progress_bar as bar
mark = pathlib.Path(__file__).with_name("done")
class Slow:
    marching = False
    def start(self, task, total=None):
        self.marching = task == "Motions"
    def advance(self, steps=1):
        if self.marching:
            with mark.open("a") as file:
                file.write("x")
            time.sleep(0.2)
    def finish(self):
        pass
bar.progress_bar = lambda: contextlib.nullcontext(Slow())
""",
}


@pytest.fixture(scope="module")
def compiled_kernels() -> None:
    """Compile all kernels: an interruption of the compiler would end the command."""
    subprocess.run([*_TRIBODYN, "warm-up", "fzg-roughness"], capture_output=True, check=True)


@pytest.mark.slow
@pytest.mark.usefixtures("compiled_kernels")
@pytest.mark.parametrize("command", ["sweep", "bifurcation"])
def test_ctrl_c_stores_finished_results(folder: Path, command: str) -> None:
    hook = folder.parent / f"{folder.name}-hook"
    hook.mkdir()
    (hook / "sitecustomize.py").write_text(_HOOKS[command])
    over = "operation.speed=1000..2000 rpm:" + ("2000" if command == "sweep" else "60")
    process = subprocess.Popen(
        [*_TRIBODYN, command, "fzg-roughness", over, "--out", "part", *_FAST], cwd=folder,
        text=True, stderr=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True,
        env={**os.environ, "PYTHONPATH": str(hook)},
    )  # fmt: skip
    _wait_for(hook / "done", process)
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert "interrupted: " in err
    assert "Traceback" not in err
    place = folder / "part"
    if command == "sweep":
        assert set(os.listdir(place)) == set(SWEEP_FILES)
        rows = list(csv.DictReader((place / "sweep.csv").open(encoding="utf-8")))
        assert 2 <= len(rows) < 2000
        assert f"{len(rows)} of 2000 values are done" in err
        assert len(out.splitlines()) == len(rows) + 2
    else:
        assert set(os.listdir(place)) == set(BIFURCATION_FILES)
        with xarray.open_dataset(place / "bifurcation.nc", engine="h5netcdf") as data:
            done = int(np.isfinite(data.rms.values).sum())
        assert 1 <= done < 60
        assert f"{done} of 60 motions are done" in err
    assert "the same command with --force continues" in err
    assert sorted(os.listdir(folder)) == [".part.members", "part"]


def _wait_for(mark: Path, process: subprocess.Popen[str]) -> None:
    """Wait until two values are done, or marching has begun, and a moment more."""
    for _ in range(1200):
        if mark.exists() and len(mark.read_text()) >= 2:
            time.sleep(1.5)
            return
        if process.poll() is not None:
            break
        time.sleep(0.1)
    pytest.fail("the process never came so far")
