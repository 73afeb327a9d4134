"""Commands of studies: what they tell, write and refuse."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from tribodyn.cli import call

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

_SOON = ("--set", "stiffness.model=analytic")


def _told(capsys: pytest.CaptureFixture[str], *words: str) -> Any:
    assert call([*words, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_modes_are_those_of_the_structure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "modes"
    found = _told(capsys, "modes", "fzg-roughness", "1000..5000 rpm", "--out", str(place), *_SOON)
    case = td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    modes = td.natural_modes(case)
    frequency = [row["frequency"] for row in found["modes"]]
    assert frequency == pytest.approx(modes.frequency[modes.rigid :])
    teeth = case.gears.pinion.teeth
    for row in found["modes"]:
        speeds = [2.0 * np.pi * row["frequency"] / (order * teeth) for order in found["orders"]]
        assert row["speeds"] == pytest.approx(speeds)
    assert {file.name for file in place.iterdir()} == {"case.toml", "study.nc", "report.html"}
    text = (place / "report.html").read_text()
    assert "Campbell diagram" in text
    assert "rpm at harmonic 1" in text


def test_harris_is_told_over_the_torque(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ("harris", "fzg-roughness", "60 N*m", "120 N*m", "--out", str(tmp_path / "h"), *_SOON)
    found = _told(capsys, *words)
    assert found["torque"] == [60.0, 120.0]
    assert found["peak_to_peak_transmission_error"][0] < found["peak_to_peak_transmission_error"][1]


@pytest.mark.slow
def test_the_better_case_of_a_relief_is_better(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "relief"
    found = _told(capsys, "relief", "fzg-roughness", "60 N*m", "120 N*m", "--gears", "wheel",
                  "--out", str(place), *_SOON)  # fmt: skip
    best = td.load_case(place / "best.toml")
    assert best.gears.wheel.modification.tip_relief == pytest.approx(found["amount"], rel=1e-6)
    assert best.gears.pinion.modification is None
    swing = td.harris_map(best, found["torque"], phases=512).peak_to_peak_transmission_error
    np.testing.assert_allclose(swing, found["peak_to_peak_after"], rtol=1e-6)
    assert max(swing) < max(found["peak_to_peak_before"])
    assert call(["relief", "fzg-roughness", "--out", str(place), *_SOON]) == 2
    assert "--force" in capsys.readouterr().err


@pytest.mark.slow
def test_a_run_up_tells_its_levels(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = _told(capsys, "run-up", "fzg-roughness", "2900..3000 rpm", "--duration", "0.05",
                  "--out", str(tmp_path / "up"), *_SOON)  # fmt: skip
    assert len(found["speed"]) == len(found["rms_mesh_force"]) > 1
    assert min(found["rms_mesh_force"]) > 0.0


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["modes", "fzg-roughness", "fast"], 'cannot read "fast"'),
        (["run-up", "fzg-roughness"], "tribodyn run-up fzg-roughness"),
        (["harris", "fzg-roughness", "60 mm"], "torque"),
        (["relief", "fzg-roughness", "--gears", "both of them"], "both"),
        (["compare", "nothing", "nothing"], "no such directory"),
    ],
)
def test_wrong_words_are_told(
    words: list[str], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert call(words) == 2
    assert says in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_two_results_are_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
    places = [str(tmp_path / name) for name in ("a", "b")]
    results = [td.run(each) for each in (case, case.replace({"operation.torque": "120 N*m"}))]
    for result, place in zip(results, places, strict=True):
        result.save(place)
    found = _told(capsys, "compare", *places)
    assert found["values"] == {"operation.torque": [90.0, 120.0]}
    assert found["figures"]["line_load"][1] / found["figures"]["line_load"][0] == pytest.approx(
        120.0 / 90.0
    )
    assert "center_distance" not in found["figures"]
    assert call(["compare", *places]) == 0
    shown = capsys.readouterr().out
    assert "+33.3 %" in shown
    assert "Operating point" in shown
    assert call(["compare", places[0], places[0]]) == 0
    assert "equal" in capsys.readouterr().out
