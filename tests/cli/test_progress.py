"""What is seen while something is computed: counts, time left, and what is compiled once."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import tribodyn as td
from tribodyn.analysis import bifurcation
from tribodyn.cli.console import tell
from tribodyn.cli.progress_bar import Bar
from tribodyn.compiled import announcing_to
from tribodyn.dynamics import System
from tribodyn.errors import collected
from tribodyn.progress import TextProgress, counted, left

_KERNEL = """
import sys
import numba as nb
from tribodyn.compiled import announced, announcing_to

told = []
double = announced(nb.njit(cache=True)(lambda x: 2.0 * x), "the doubling", "no time")
with announcing_to(told.append):
    double(1.0)
    double(2)
print(told)
"""


@pytest.mark.parametrize(
    ("done", "total", "text"), [(31, 60, "31 of 60"), (0, 1, "0 of 1"), (5, None, "")]
)
def test_progress_text_has_the_total_if_known(done: int, total: int | None, text: str) -> None:
    assert counted(done, total) == text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (None, ""),
        (12.4, "about 12 s left"),
        (130.0, "about 2 min 10 s left"),
        (7260.0, "about 2 h 1 min left"),
    ],
)
def test_the_time_that_is_left(seconds: float | None, text: str) -> None:
    assert left(seconds) == text


def test_the_bar_draws_them() -> None:
    bar = Bar()
    with bar as progress:
        progress.start("Motions", 60)
        progress.advance(31)
        console = Console(width=120, color_system=None)
        with console.capture() as caught:
            console.print(bar._screen.get_renderable())
        progress.finish()
    assert "Motions" in caught.get()
    assert "31 of 60" in caught.get()


def test_a_compilation_is_announced_once_and_never_when_cached(tmp_path: Path) -> None:
    script = tmp_path / "kernel.py"
    script.write_text(_KERNEL)
    outputs = [
        subprocess.run(
            [sys.executable, str(script)], capture_output=True, text=True, check=True
        ).stdout.strip()
        for _ in range(2)
    ]
    assert outputs == ["['compiling the doubling, once on this machine, about no time']", "[]"]


@pytest.mark.parametrize(("transient", "times"), [(40, 0), (100_000_000, 1)])
def test_a_diagram_of_many_steps_estimates_its_time(transient: int, times: int) -> None:
    mass = System([[1.0]], [[0.5]], [[1.0]], [0.0], [])
    with announcing_to((messages := []).append):
        bifurcation(mass, [0.1, 0.2], steps=512, transient=transient, cycles=8, keep=8, signal="q0")
    estimates = [text for text in messages if "2 motions with 512 steps" in text]
    assert len(estimates) == times
    assert all("min at most" in text for text in estimates)


@pytest.mark.parametrize(
    "name", [pytest.param("two-stage-spur", marks=pytest.mark.slow), "planetary-stage"]
)
def test_an_ensemble_of_a_machine_reports_teeth_and_members(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    case = td.load_case(name).replace({"load_cases": None})
    torque = f"{case.operating_point.torque} N*m +- 1 %"
    with collected():
        td.ensemble(case, {"operation.torque": torque}, 3, seed=1, progress=TextProgress(tell, 0.0))
    lines = capsys.readouterr().err.splitlines()
    for number in range(5):
        assert any(line.startswith(f"Variants: {number} of 4") for line in lines)
    assert sum("Tooth contact: " in line and " 1 of 2)" in line for line in lines) >= 4
    assert sum("(Motion: " in line for line in lines) >= 4


def test_lines_of_progress_are_rare(capsys: pytest.CaptureFixture[str]) -> None:
    times = iter(np.arange(0.0, 200.0, 5.0))
    lines = TextProgress(tell, clock=lambda: float(next(times)))
    lines.start("Motions", 12)
    for _ in range(12):
        lines.advance()
    lines.finish()
    written = capsys.readouterr().err.splitlines()
    assert 2 <= len(written) <= 4
    assert written[0].startswith("Motions: ")
    assert all("about" in line for line in written[1:])
