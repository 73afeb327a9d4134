"""The oil film from the case file to the figures of ``tribodyn run``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import tribodyn as td
from tribodyn.cli import call
from tribodyn.study import SUMMARY

NAMED = (
    "central_film_pitch_point",
    "minimum_film_over_path",
    "minimum_film_ratio",
    "oil_film_stiffness_pitch_point",
)
_FAST = ("--set", "solver.steps_per_mesh_cycle=256")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def figures(capsys: pytest.CaptureFixture[str], case: str, *sets: str, out: str = "out") -> Any:
    options = [argument for setting in sets for argument in ("--set", setting)]
    assert call(["run", case, *_FAST, *options, "--json", "--out", out]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.slow
def test_run_adds_the_figures_of_the_film(capsys: pytest.CaptureFixture[str]) -> None:
    output = figures(capsys, "fzg-film")
    assert all(type(output[name]) is float for name in NAMED)
    assert set(output) <= set(SUMMARY)
    # microns and 1e10 N/m, the order that a solution by hand of this pair at 150 N*m has
    assert 0.7e-6 < output["minimum_film_over_path"] < output["central_film_pitch_point"] < 1.6e-6
    assert 5e9 < output["oil_film_stiffness_pitch_point"] < 4e10
    roughness = td.load_case("fzg-film").composite_roughness
    assert roughness == pytest.approx(0.58e-6, rel=0.01)
    assert output["minimum_film_ratio"] == pytest.approx(
        output["minimum_film_over_path"] / roughness
    )


@pytest.mark.slow
def test_a_film_in_series_softens_the_mesh_a_little(capsys: pytest.CaptureFixture[str]) -> None:
    soft = figures(capsys, "fzg-film")
    stiff = figures(capsys, "fzg-film", "film.stiffness=none", out="stiff")
    ratio = soft["mean_mesh_stiffness"] / stiff["mean_mesh_stiffness"]
    assert 0.97 < ratio < 0.995
    assert stiff["oil_film_stiffness_pitch_point"] == pytest.approx(
        soft["oil_film_stiffness_pitch_point"], rel=0.1
    )


def test_the_film_of_the_roughness_study_adds_figures_and_changes_none(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with_film = figures(capsys, "fzg-roughness")
    without = figures(capsys, "fzg-roughness", "film.model=none", out="without")
    assert not set(NAMED) & set(without)
    assert set(NAMED) <= set(with_film)
    assert {name: with_film[name] for name in without} == without


def test_a_formula_omits_figures_that_it_cannot_give(capsys: pytest.CaptureFixture[str]) -> None:
    output = figures(capsys, "fzg-film", "film.model=moes")
    assert {*NAMED} - set(output) == {"minimum_film_over_path"}
    ideal = figures(
        capsys, "fzg-film", "film.model=pan-hamrock", "gears.pinion.roughness_rms=0 um",
        "gears.wheel.roughness_rms=0 um", out="ideal",
    )  # fmt: skip
    assert {*NAMED} - set(ideal) == {"minimum_film_ratio"}


def test_another_model_leaves_the_options_of_the_old_one_behind() -> None:
    case = td.load_case("fzg-film").replace(
        {"film.nodes": 257, "film.positions": 20, "film.stiffness": "secant"}
    )
    formula = case.replace({"film.model": "moes"})
    assert (formula.film.nodes, formula.film.positions) == (None, None)
    assert formula.film.stiffness == "none"
    assert case.replace({"film.model": "multigrid"}).film.stiffness == "secant"
    tangent = td.load_case("fzg-film").replace({"film.model": "moes"})
    assert tangent.film.stiffness == "tangent"
    assert tangent.replace({"film.model": "none"}).film.stiffness == "none"


def test_a_foreign_option_is_refused_on_the_command_line(
    capsys: pytest.CaptureFixture[str],
) -> None:
    arguments = ["check", "fzg-film", "--set", "film.model=moes", "--set", "film.nodes=513"]
    assert call(arguments) == 2
    error = capsys.readouterr().err
    assert "--set film.nodes: nodes = 513 does not belong to" in error
    assert call(["check", "fzg-film", "--set", "film.nodes=500"]) == 2
    assert "nodes = 257 or nodes = 513" in capsys.readouterr().err


def test_a_new_case_file_lists_all_keys_of_the_film(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["new", "my.toml", "--from", "fzg-film"]) == 0
    text = (folder / "my.toml").read_text(encoding="utf-8")
    for line in ('model = "newton"', 'stiffness = "tangent"', "nodes = 513", "positions = 30",
                 'inlet = "flooded"', "# domain = [-2.5, 1.5]"):  # fmt: skip
        assert f"\n{line}  # " in text
    assert "65 to 16385" in text
    assert td.load_case("my.toml") == td.load_case("fzg-film")
    assert call(["check", "my.toml"]) == 0
    capsys.readouterr()


@pytest.mark.parametrize("name", [*NAMED, "tangent", "secant", "flooded", "film.positions"])
def test_names_of_the_film_are_explained(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["explain", name, "--json"]) == 0
    assert "film" in json.dumps(json.loads(capsys.readouterr().out)) or name == "flooded"


@pytest.mark.parametrize("model", ["newton", "multigrid"])
def test_the_solver_is_cited(model: str) -> None:
    from tribodyn.study.pipeline.citations import cite

    case = td.load_case("fzg-film").replace({"film.model": model})
    assert ("Venner" in cite(case)) == (model == "multigrid")
    assert "Roelands" in cite(case)


def test_the_case_is_listed_with_its_origin(capsys: pytest.CaptureFixture[str]) -> None:
    assert "fzg-film" in td.cases()
    case = td.load_case("fzg-film")
    # printed: 24 teeth drive at 1400 rpm, and 150 N*m on the base circle of 50.7434 mm
    assert case.pinion_torque / case.gear_pair.pinion.base_radius / 20e-3 == pytest.approx(
        147802.0, rel=1e-4
    )
    assert case.gear_pair.driver == "wheel"
