"""The printed tables of all sources: their data, and the verdict of every row."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tribodyn.cases import cases
from tribodyn.cases.papers.computations import COMPUTATIONS
from tribodyn.cases.papers.jobs import Jobs
from tribodyn.cases.papers.printed import (
    NEITHER,
    VERDICTS,
    PrintedRow,
    course,
    papers,
    printed_rows,
    signs,
    verdicts,
)
from tribodyn.cli import call


@pytest.mark.parametrize("paper", papers())
def test_tables_are_whole(paper: str) -> None:
    rows = printed_rows(paper)
    assert paper in cases()
    assert len({(row.table, row.row) for row in rows}) == len(rows)
    for row in rows:
        assert row.expected in VERDICTS
        assert row.reason.endswith(".")
        assert row.compute in COMPUTATIONS if row.compute else row.expected == NEITHER
        assert not row.along or isinstance(row.printed, str)
    # every case with its changes can be made, and equal ones are computed once
    jobs = Jobs(rows)
    assert len(set(jobs.names.values())) < len(jobs.requests)


@pytest.mark.slow
@pytest.mark.parametrize("paper", [name for name in papers() if name != "fzg-12dof"])
def test_every_verdict_is_the_expected_one(
    paper: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["paper", paper, "--json", "--out", str(tmp_path / "there")]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert len(rows) == len(printed_rows(paper))
    assert [row for row in rows if row["verdict"] != row["expected"]] == []


def test_courses_of_figures() -> None:
    assert course([1.0, 2.0, 3.0], 0.0) == "rises"
    assert course([3.0, 1.0, 1.005, 2.0], 0.01) == "falls, then rises"
    assert course([1.0, 1.001], 0.01) == "stays"
    assert signs([4.7, 4.0, 4.1], 0.03) == [-1, 0]


@pytest.mark.parametrize(
    ("limit", "met"), [("", (0, 1, 0)), ("most", (1, 1, 0)), ("least", (0, 1, 1))]
)
def test_a_limit_is_met_by_better_values(limit: str, met: tuple[int, ...]) -> None:
    row = PrintedRow("", "", "", 2.0, "value", "", limit=limit)
    wanted = ["value" if each else NEITHER for each in met]
    assert verdicts([row] * 3, [1.0, 2.01, 3.0]) == wanted
