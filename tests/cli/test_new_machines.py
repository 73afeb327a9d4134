"""Files to start from of machines, stages and hypoid pairs, and keys that are explained."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import tribodyn as td
from tribodyn.cli import call
from tribodyn.study.machine_tables import STARTS, machine_keys


@pytest.mark.parametrize("kind", STARTS)
def test_a_file_to_start_from_is_in_order_and_commented(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    assert call(["new", str(path), f"--{kind}"]) == 0
    assert call(["check", str(path)]) == 0
    lines = path.read_text("utf-8").splitlines()
    values = [line for line in lines if " = " in line and not line.startswith("#")]
    assert sum("  # " in line or " # " in line for line in values) > 0.6 * len(values)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("kind", STARTS)
def test_a_file_to_start_from_runs_as_it_stands(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    assert call(["new", str(path), f"--{kind}"]) == 0
    assert call(["run", str(path), "--out", str(tmp_path / "r"), "--quiet"]) == 0


@pytest.mark.parametrize("name", ["two-stage-helical", "hypoid-axle", "planetary-stage"])
def test_a_copy_has_comments_and_the_same_values(name: str, tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    assert call(["new", str(path), "--from", name]) == 0
    text = path.read_text("utf-8")
    assert "  # z: number of teeth" in text
    assert "  # n: speed of the input" in text
    # Housing files have names of their own beside the copy.
    copy, case = dict(td.load_case(path).values()), dict(td.load_case(name).values())
    differing = {key for key in case if copy[key] != case[key]}
    assert copy.keys() == case.keys()
    assert all(key.startswith("housing.") for key in differing)


def test_two_beginnings_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["new", str(tmp_path / "my.toml"), "--machine", "--from", "fzg-film"]) == 2
    assert "--from and --machine are both given" in capsys.readouterr().err


def test_every_key_of_the_built_in_machines_is_listed_and_explained(
    capsys: pytest.CaptureFixture[str],
) -> None:
    names = {key.rpartition(".")[2] for key, _, _ in machine_keys()}
    groups = ("shafts", "bearings", "planets", "couplings", "load_cases", "operation")
    for name in ("two-stage-spur", "hypoid-axle", "wind-turbine-gearbox", "planetary-stage"):
        keys = [key for key, _ in td.load_case(name).values() if key.partition(".")[0] in groups]
        assert {key.rpartition(".")[2] for key in keys} <= names
    for key, table in (
        ("bearings.A.clearance", "bearings.NAME.clearance"),
        ("losses.shafts.input.immersion", "losses.shafts.NAME.immersion"),
        ("pin_errors", "planets.NAME.pin_errors"),
        ("sections", "shafts.NAME.sections"),
    ):
        assert call(["explain", key, "--json"]) == 0
        assert table in {each.get("key") for each in json.loads(capsys.readouterr().out)}
