"""The command that judges claims: what it prints and writes, what it refuses, how it is stopped."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from tribodyn.cli import call

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_FEW = ("--laws", "xu-2007", "--roughness", "0.4,0.8 um")


def test_claims_and_figures_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place = tmp_path / "f"
    assert call(["experiment", "friction", "--out", str(place), "--json", *_FEW]) == 0
    output: dict[str, Any] = json.loads(capsys.readouterr().out)
    assert output["complete"]
    assert len(output["rows"]) == 2 * 3 * 3
    assert {row["friction"] for row in output["rows"]} == {"none", "xu-2007 0.4 um",
                                                           "xu-2007 0.8 um"}  # fmt: skip
    (claim,) = (c for c in output["claims"] if c["source_of"] == "time-varying-friction")
    assert claim["verdict"] == "fails"
    assert claim["computed"].endswith("it falls where pinion drives")
    assert {file.name for file in place.iterdir()} == {
        "case.toml", "sweep.csv", "sweep.nc", "report.html"
    }  # fmt: skip
    # a second time needs --force
    assert call(["experiment", "friction", "--out", str(place), *_FEW]) == 2
    assert "--force" in capsys.readouterr().err
    assert call(["experiment", "friction", "--out", str(place), "--force", *_FEW]) == 0
    out = capsys.readouterr().out
    assert "holds" not in out.splitlines()[5]
    assert "The pinion drives, torque held: both" in out
    none, xu = (line.split() for line in out.splitlines() if line.startswith(("  none ", "  xu-")))
    assert float(none[1]) == 0.0 < float(xu[3])
    assert float(xu[4]) < float(none[2])  # mean force: friction takes part of the torque


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["experiment"], "tribodyn experiment friction"),
        (["experiment", "wear"], 'there is no experiment "wear"'),
        (["experiment", "friction", "fzg-rough"], "fzg-roughness"),
        (["experiment", "friction", "--roughness", "0.4,0.8"], "lengths with a unit"),
        (["experiment", "friction", "--roughness", "0.4..0.8 um:3"], "lengths with a unit"),
        (["experiment", "friction", "--roughness", "0.4,0.8 mm"], "Allowed"),
        (["experiment", "friction", "--laws", "xu"], "xu-2007"),
        (["experiment", "friction", "--set", "operation.torque=3"], "unit"),
    ],
)
def test_wrong_arguments_are_refused_with_the_remedy(
    arguments: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert call(arguments) == 2
    error = capsys.readouterr().err
    assert message in error
    assert "Traceback" not in error
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_ctrl_c_stores_finished_results_and_the_same_command_resumes(tmp_path: Path) -> None:
    heights = ",".join(f"{0.1 * number:.1f}" for number in range(1, 13)) + " um"
    command = [sys.executable, "-m", "tribodyn", "experiment", "friction", "--out", "part",
               "--laws", "xu-2007", "--roughness", heights]  # fmt: skip
    process = subprocess.Popen(command, cwd=tmp_path, text=True, stderr=subprocess.PIPE,
                               stdout=subprocess.PIPE, start_new_session=True)  # fmt: skip
    members = tmp_path / ".part.members" / "members.jsonl"
    for _ in range(1200):
        if members.exists() and members.read_text().count("\n") > 12:  # groups of eight
            break
        assert process.poll() is None
        time.sleep(0.1)
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=120)
    assert process.returncode == 130, err
    assert "Traceback" not in err
    assert "not computed" in out
    stored_count = members.read_text().count("\n") - 1
    first = (tmp_path / "part" / "sweep.csv").read_text().splitlines()
    rows = first[1:]
    assert 10 <= len(rows) <= stored_count
    done = subprocess.run([*command, "--force"], cwd=tmp_path, text=True, capture_output=True,
                          check=True, timeout=600)  # fmt: skip
    assert f"{stored_count} finished parts" in done.stderr
    last = (tmp_path / "part" / "sweep.csv").read_text().splitlines()
    again = last[1:]
    before, later = (
        {tuple(list(row.values())[:3]): row for row in csv.DictReader(text)}
        for text in (first, last)
    )
    for key, row in before.items():  # the orbits are stored, and measured anew
        for name in ("mean_mesh_force [N]", "peak_mesh_force [N]"):
            assert float(row[name]) == pytest.approx(float(later[key][name]), rel=1e-9)
    assert len(again) == (1 + 12) * 6
    assert sorted(os.listdir(tmp_path)) == ["part"]
