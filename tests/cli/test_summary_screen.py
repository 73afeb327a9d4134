"""The summary that ``tribodyn run`` prints: it fits a screen, ``--all`` has every figure."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tribodyn.cli import call
from tribodyn.cli.screen import chief_figures, screen
from tribodyn.study import SUMMARY
from tribodyn.study.pipeline.summary_figures import figure_of, is_chief, part_figures

_FROZEN = Path(__file__).parents[1] / "freeze" / "snapshot" / "figures.json"
_SUMMARIES = json.loads(_FROZEN.read_text(encoding="utf-8"))


@pytest.mark.parametrize("case", _SUMMARIES)
def test_a_summary_fits_a_screen(case: str) -> None:
    values = _SUMMARIES[case]["summary"]
    lines = chief_figures(values).splitlines()
    assert len(lines) <= 50
    assert max(map(len, lines)) <= 100
    hidden = sum(not is_chief(name) for name in values)
    assert lines[-1].startswith(f"{hidden} more figures")


def test_a_reducer_of_two_stages_fits_a_screen() -> None:
    counts = {"machine": 1, "meshes": 2, "shafts": 3, "bearings": 6, "housing": 6}
    values = {
        f"{load}{kind}.{'' if kind == 'machine' else f'{kind[:4]} {n}.'}{name}": -12345.678
        for load in ("", "load_cases.slow.", "load_cases.cruise.")
        for kind, count in counts.items()
        for n in range(count)
        for name in part_figures()[kind]
    }
    lines = chief_figures(values).splitlines()
    assert len(lines) <= 50
    assert max(map(len, lines)) <= 100
    assert lines[-1].startswith(f"{sum(not is_chief(name) for name in values)} more figures")


def test_numbers_of_many_parts_stand_under_their_names() -> None:
    kinds = part_figures()
    values = {
        f"meshes.mesh{n}.{name}": float(100 * n + i + 1)
        for n in range(15)
        for i, name in enumerate(kinds["meshes"])
    }
    values |= {"bearings.a.b.mean_radial_force": 1234.5, "bearings.a.b.mean_axial_force": 1e-9}
    values |= {"load_cases.slow 1.5.meshes.mesh0.peak_mesh_force": 77.0}
    text = chief_figures(values)
    lines = text.splitlines()
    assert max(map(len, lines)) <= 100
    heads = [i for i, line in enumerate(lines) if line.startswith("Meshes")]
    shown = {}
    for i in heads:
        names = lines[i].split()[1:]
        row = next(line for line in lines[i:] if "peak_mesh_force [N]" in line)
        shown |= dict(zip(names, map(float, row.split("]")[1].split()), strict=True))
    peaks = {f"mesh{n}": values[f"meshes.mesh{n}.peak_mesh_force"] for n in range(15)}
    assert shown == peaks
    bearing = next(line for line in lines if line.startswith("  a.b"))
    assert bearing.split()[1:] == ["1234.5", "0"]  # rounding is no force
    assert "77" in next(line for line in lines if line.startswith("  slow 1.5"))


def test_each_chief_figure_is_one_of_its_kind() -> None:
    assert any(map(is_chief, SUMMARY))
    for kind, names in part_figures().items():
        chief = [name for name in names if is_chief(f"{kind}.x.{name}")]
        assert chief
        assert all(figure_of(f"{kind}.x.{name}").meaning for name in chief)


def test_all_prints_every_figure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    fast = ("--set", "solver.steps_per_mesh_cycle=256", "--force")
    assert call(["run", "fzg-stiffness", *fast]) == 0
    short = capsys.readouterr().out
    assert call(["run", "fzg-stiffness", *fast, "--all"]) == 0
    every = capsys.readouterr().out
    names = json.loads((tmp_path / "fzg-stiffness" / "summary.json").read_text())
    assert all(name in every for name in names)
    assert "peak_mesh_force" in short
    assert "tip_diameter_pinion" not in short


def test_rows_without_a_value_in_a_block_are_left_out() -> None:
    values = {f"meshes.planet_mesh{n}.mesh_frequency": 10.0 + n for n in range(12)}
    values["meshes.planet_mesh0.center_distance"] = 0.1
    lines = screen(values, values).splitlines()
    assert sum(line.startswith("Meshes") for line in lines) > 1
    assert sum("mesh_frequency" in line for line in lines) > 1
    (row,) = [line for line in lines if "center_distance" in line]
    assert "100" in row
