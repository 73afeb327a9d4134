"""Figures and summary figures of third parties, one file each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from own_case import CASE

import tribodyn as td
from tribodyn.cli import call

Load = Callable[[str], dict[str, object]]


def test_figure_is_a_method_of_the_result(load: Load, tmp_path: Path) -> None:
    load("figure")
    path = tmp_path / "my.toml"
    path.write_text(CASE, encoding="utf-8")
    result = td.run(path)
    figure = result.plot_force_over_compression()
    assert len(figure.data[0].x) == result.response.time.size
    report = result.save(tmp_path / "r") / "report.html"
    assert "force_over_compression" in report.read_text(encoding="utf-8")


def test_summary_figure_is_in_every_summary(
    load: Load, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    load("summary_figure")
    path = tmp_path / "my.toml"
    path.write_text(CASE, encoding="utf-8")
    result = td.run(path)
    figures = result.summary()
    ratio = figures["peak_mesh_force"] / figures["static_mesh_force"]
    assert figures["dynamic_load_factor"] == pytest.approx(ratio, rel=1e-2)
    assert call(["explain", "dynamic_load_factor"]) == 0
    assert "greatest mesh force over that at rest" in capsys.readouterr().out
