"""``tribodyn ensemble``: figures of a case whose inputs are spread, with their bands."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import tribodyn as td
from tribodyn.cli import call

CASE = "time-varying-friction"


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_figures_lie_between_those_of_the_ends(tmp_path: Path, capsys) -> None:
    place = tmp_path / "spread"
    torque = td.load_case(CASE).operation.torque
    arguments = ["--size", "6", "--set", f"operation.torque={torque} N*m +- 2 %", "--json"]
    assert call(["ensemble", CASE, *arguments, "--out", str(place)]) == 0
    output = json.loads(capsys.readouterr().out)
    facts = output.get("figures", output)["line_load"]
    # The line load is in proportion to the torque, which ends at three deviations of 2 %.
    middle = td.run(CASE).summary()["line_load"]
    assert facts["middle"] == pytest.approx(middle, rel=1e-12)
    assert 0.94 * middle < facts["low"] < middle < facts["high"] < 1.06 * middle
    assert facts["mean_low"] < sum(facts[end] for end in ("low", "high")) / 2 < facts["mean_high"]
    assert "line" in (place / "report.html").read_text("utf-8")


def test_a_case_without_spread_is_explained(tmp_path: Path, capsys) -> None:
    assert call(["ensemble", CASE, "--out", str(tmp_path / "none")]) == 2
    error = capsys.readouterr().err
    assert "no value of the case is spread" in error
    assert "operation.torque=90 N*m +- 2 %" in error
    assert not (tmp_path / "none").exists()
