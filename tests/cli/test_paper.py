"""``tribodyn paper``: printed tables compared with computed values."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tribodyn.cases import compare_with_paper
from tribodyn.cases.papers import printed
from tribodyn.checkpoints import Checkpoints
from tribodyn.cli import call
from tribodyn.errors import ModelWarning

_KEYS = ["table", "row", "printed", "computed", "deviation", "expected", "verdict", "reason"]


@pytest.fixture(scope="module")
def comparison(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[Any], Path]:
    import contextlib
    import io

    folder, text = tmp_path_factory.mktemp("paper") / "there", io.StringIO()
    with contextlib.redirect_stdout(text):
        assert call(["paper", "fzg-12dof", "--json", "--out", str(folder)]) == 0
    return json.loads(text.getvalue()), folder


def test_rows_have_the_promised_keys_and_a_page(comparison: tuple[list[Any], Path]) -> None:
    rows, folder = comparison
    assert all(set(_KEYS) <= set(row) for row in rows)
    assert len(rows) == len(printed.printed_rows("fzg-12dof"))
    assert {row["verdict"] for row in rows} == set(printed.VERDICTS)
    page = (folder / "report.html").read_text("utf-8")
    assert "cannot-reproduce" in page
    assert (folder / "rows.csv").read_text("utf-8").count("fzg-12dof") == len(rows)


def test_computed_figures_are_those_of_a_run(comparison: tuple[list[Any], Path]) -> None:
    from tribodyn.cases import load_case, run

    row = next(row for row in comparison[0] if row["row"] == "fifth harmonic, constant")
    with pytest.warns(ModelWarning):
        figures = run(load_case("fzg-12dof-light")).summary()
    assert row["computed"] == 1e6 * figures["dynamic_transmission_error_harmonic_5"]
    assert row["deviation"] == pytest.approx(row["computed"] / 14.82 - 1.0)


def test_every_verdict_of_the_rig_is_the_expected_one(comparison: tuple[list[Any], Path]) -> None:
    assert [row for row in comparison[0] if row["verdict"] != row["expected"]] == []


@pytest.mark.parametrize("arguments", [[], ["fzg-12dof", "--all"], ["fzg-12-dof"]])
def test_an_unknown_paper_is_reported(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["paper", *arguments]) == 2
    assert "There are tables for fzg-12dof" in capsys.readouterr().err


def test_a_verdict_follows_the_computed_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    row = {"table": "T", "compute": "check", "of": "pinion_torque", "unit": "N*m", "case": "",
           "expected": "value", "reason": "-", "paper": "fzg-12dof"}  # fmt: skip

    def verdict(value: Any, **more: Any) -> str:
        printed_row = printed.PrintedRow(
            **{**row, "row": "R", "case": "fzg-12dof", "printed": value}, **more
        )
        monkeypatch.setattr(
            "tribodyn.cases.papers.comparison.printed_rows", lambda _: (printed_row,)
        )
        return str(compare_with_paper("fzg-12dof").rows[0]["verdict"])

    torque = {"along": {"operation.torque": ["90 N*m", "172 N*m"]}}
    assert verdict(172) == "value"
    assert verdict(170) == "cannot-reproduce"
    assert verdict([100, 180]) == "value"
    assert verdict([10, 100]) == "cannot-reproduce"
    assert verdict("rises", **torque) == "trend"
    assert verdict("falls", **torque) == "cannot-reproduce"


def test_an_interrupted_comparison_goes_on_from_there(tmp_path: Path) -> None:
    class Stopping:
        def __init__(self, after: int) -> None:
            self.left = after

        def start(self, task: str, total: int | None = None) -> None:
            self.total = total

        def advance(self, steps: int = 1) -> None:
            self.left -= steps
            if self.left < 0:
                raise KeyboardInterrupt

        def finish(self) -> None:
            self.total = None

    with Checkpoints(tmp_path / "there") as members:
        started = compare_with_paper(
            "fzg-12dof", partial=True, progress=Stopping(2), checkpoints=members
        )
    assert 0 < len(started.points) < started.computation_count
    assert started.surprises == ()
    assert 0 < len(started.rows) < len(printed.printed_rows("fzg-12dof"))
    with Checkpoints(tmp_path / "there") as members:
        complete = compare_with_paper("fzg-12dof", checkpoints=members)
        assert len(members) == len(started.points)
    assert complete.complete
