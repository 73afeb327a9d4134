"""``tribodyn study``: what it says, how far it has come, and Ctrl-C that keeps what is done."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import pytest

from tribodyn.cli import call, progress_bar
from tribodyn.progress import TextProgress

_STUDY = """
case = "fzg-roughness"
chunk = 2
keep = ["rms_mesh_force"]
[set]
stiffness.model = "iso6336"
friction.law = "none"
film.model = "none"
[axes]
operation.speed = "900..1500 rpm:2"
gears.wheel.teeth = [24, 90]
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(_STUDY)
    return tmp_path


def test_a_study_is_computed_and_summarised(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupts, write = iter((False, True)), Path.write_bytes

    def interrupted(path: Path, content: bytes) -> int:
        if next(interrupts, False):
            raise KeyboardInterrupt
        return write(path, content)

    monkeypatch.setattr(Path, "write_bytes", interrupted)
    assert call(["study", "s.toml"]) == 130
    captured = capsys.readouterr()
    assert "2 of 4 members are done (50 %)" in captured.out
    assert "the same command continues from there" in captured.err
    monkeypatch.setattr(progress_bar, "TextProgress", partial(TextProgress, interval=0.0))
    assert call(["study", "s.toml"]) == 0
    captured = capsys.readouterr()
    assert "4 of 4 members are done (100 %)\n  2 of them failed:\n         2  " in captured.out
    assert "the centre distance must be at least 240" in captured.out
    assert "Members: 4 of 4" in captured.err
    assert "Store: s-study" in captured.err
    assert call(["study", "s-study", "--status", "--json"]) == 0
    state = json.loads(capsys.readouterr().out)
    assert state["complete"]
    assert not state["running"]
    assert list(state["reasons"].values()) == [2]
    (next(folder.glob("s-study/0-000/*.nc"))).unlink()
    assert call(["study", "s.toml"]) == 0
    assert "was damaged or missing and was computed again" in capsys.readouterr().err


def test_faults_end_with_their_code(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "s.toml").write_text(_STUDY.replace("chunk = 2", "chunk = 0"))
    assert call(["study", "s.toml", "--json"]) == 2
    (problem,) = json.loads(capsys.readouterr().out)["error"]["problems"]
    assert problem["where"] == "s.toml:3: chunk"
    assert call(["study", "s.toml", "--status"]) == 2
    assert "s-study" in capsys.readouterr().err
    assert not (folder / "s-study").exists()
