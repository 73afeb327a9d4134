"""What is done on the page as a Python script: it gives the same summaries and studies."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("dash", reason="the page needs Dash")

import tribodyn as td
from tribodyn.app import results
from tribodyn.app.jobs import Job
from tribodyn.app.script import script_of
from tribodyn.app.session import TabSession
from tribodyn.app.studies import STUDIES, first_values
from tribodyn.app.study_functions import FUNCTIONS
from tribodyn.app.workspace import Workspace
from tribodyn.cases.load import load_case
from tribodyn.progress import SILENT
from unit.app.test_page_studies import _FEW


class Recorder:
    """Jobs of a server that computes nothing, and says that all is done."""

    def __init__(self) -> None:
        self.count = 0

    def start(self, kind: str, title: str, order: Mapping[str, Any], case: object = None) -> Job:
        self.count += 1
        job = Job(self.count, kind, title, {**order, "kind": kind}, Path(), case, "done")
        job.content = {"blocks": [{"name": "mesh_force", "missing": ""}]} if kind == "run" else {}
        job.saved = True
        return job

    def forget(self, job: Job) -> None:
        """Nothing is stored."""


def tab(folder: Path, name: str = "fzg-roughness") -> TabSession:
    return TabSession(Workspace(folder), Recorder(), load_case(name))  # type: ignore[arg-type]


def typed(desk: TabSession, key: str, value: str, unit: str = "") -> None:
    desk.edit({"form": "case", "key": key, "number": desk.edits + 1, "value": value, "unit": unit})
    assert [fault for fault in desk.faults if fault["key"] == key] == []


def ran(folder: Path, script: str) -> list[dict[str, float]]:
    """Summaries that a script prints in a process of its own."""
    (folder / "script.py").write_text(script, "utf-8")
    paths = {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "script.py"], cwd=folder, env={**os.environ, **paths},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return [ast.literal_eval(line) for line in done.stdout.splitlines()]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")  # the page lists them
def test_the_script_gives_the_same_summaries_in_a_new_process(tmp_path: Path) -> None:
    desk = tab(tmp_path)
    desk.run()
    typed(desk, "operation.torque", "0.1", "kN*m")
    typed(desk, "operation.torque", "0.12", "kN*m")
    typed(desk, "friction.law", "constant")
    typed(desk, "friction.coefficient", "0.05")
    desk.run()
    typed(desk, "friction.law", "none")  # drops the coefficient
    typed(desk, "dynamics.backlash", "0.08 mm")
    desk.run()
    desk.picked = [2, 3]
    desk.overlay_runs()
    script = script_of(desk)
    assert len(script.splitlines()) <= 40
    assert "0.1 kN*m" not in script  # edits of one value are one
    summaries = ran(tmp_path, script)
    for job, summary in zip(desk.runs, summaries, strict=True):
        assert summary == pytest.approx(td.run(job.case).summary(), rel=1e-9, nan_ok=True)
    assert {"run-1.html", "overlay.html"} <= {path.name for path in tmp_path.iterdir()}


def executed(script: str) -> dict[str, Any]:
    """Names that a script leaves; its runs are their cases, without figures and summaries."""
    lines = script.replace("td.run(case)", "case").splitlines()
    names: dict[str, Any] = {}
    exec("\n".join(n for n in lines if "write_html" not in n and "summary" not in n), names)
    return names


@pytest.mark.parametrize("name", ["fzg-roughness", "two-stage-spur", "planetary-stage"])
def test_the_case_of_the_form_is_that_of_the_script(name: str, tmp_path: Path) -> None:
    desk = tab(tmp_path, name)
    typed(desk, "operation.speed", "1000 rpm", "rpm")
    key = next(k for k in desk.form.options() if k.endswith(".face_width"))
    typed(desk, key, "33", "mm")
    typed(desk, key, "0.034", "m")
    script = script_of(desk)
    assert f"td.load_case({name!r})" in script
    assert script.count(".replace(") == 1
    assert executed(script)["case"] == desk.case


def test_a_new_case_and_one_of_the_folder_are_opened(tmp_path: Path) -> None:
    desk = tab(tmp_path)
    desk.open("")
    typed(desk, "operation.torque", "400 N*m")
    script = script_of(desk)
    assert "td.Case(**{" in script
    assert executed(script)["case"] == desk.case
    desk.save("mine", force=False)
    desk.open("file:mine.toml")
    assert "td.load_case('mine.toml')" in script_of(desk)
    # a file that was changed since is no longer the case that was opened
    typed(desk, "operation.torque", "300 N*m")
    desk.save("mine", force=True)
    typed(desk, "operation.speed", "1000 rpm")
    script = script_of(desk)
    assert "mine.toml" not in script
    assert executed(script)["case"] == desk.case


def test_the_case_of_a_run_is_restored_and_what_is_removed_is_left_out(tmp_path: Path) -> None:
    desk = tab(tmp_path)
    desk.run()
    typed(desk, "operation.torque", "120 N*m")
    desk.run()
    desk.case_of(1)
    typed(desk, "operation.speed", "950 rpm")
    desk.run()
    desk.remove(2)
    script = script_of(desk)
    assert script.count("td.run(case)") == 2
    assert "120 N*m" not in script
    names = {k: v for k, v in executed(script).items() if k.startswith("run_")}
    assert names == {"run_1": desk.runs[0].case, "run_3": desk.runs[1].case}


def test_the_page_shows_the_script_and_offers_it(tmp_path: Path) -> None:
    desk = tab(tmp_path)
    desk.view = "script"
    text = str(results.bench(desk))
    assert "import tribodyn as td" in text
    assert "href='script.py'" in text


def same(a: Any, b: Any) -> bool:
    """Whether two facts of a study are equal."""
    if isinstance(a, float) or getattr(getattr(a, "dtype", None), "kind", "") in tuple("fc"):
        return bool(np.allclose(a, b, rtol=1e-9, atol=0.0, equal_nan=True))
    return bool(np.all(a == b))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")  # the page lists them
@pytest.mark.parametrize("kind", STUDIES)
def test_every_study_of_the_script_is_that_of_the_page(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    desk = tab(tmp_path)
    if kind in ("continuation", "basins", "lyapunov"):
        typed(desk, "stiffness.model", "analytic")
        typed(desk, "friction.law", "none")
    desk.choose_study(kind)
    desk.values[kind] |= first_values(kind, desk.case) | _FEW.get(kind, {})
    desk.start_study()
    script = script_of(desk)
    names: dict[str, Any] = {}
    exec(script, names)
    assert (tmp_path / "study-1.html").stat().st_size > 1000
    if kind not in FUNCTIONS or kind == "modes":
        return  # their data are not those of a report
    values = STUDIES[kind].read(desk.studies[0].order["values"])
    data = FUNCTIONS[kind](desk.case, values, SILENT).data
    fields = [name for name in vars(data) if not name.startswith("_")]
    plain = [n for n in fields if isinstance(getattr(data, n), float | int | str | np.ndarray)]
    assert plain
    for name in plain:
        assert same(getattr(data, name), getattr(names["study_1"], name)), name
