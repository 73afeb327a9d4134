"""The page on the case file is made from the same fields that check a case."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from generated import GENERATED, written
from pages import ROOT, blocks
from written_tables import machine_tables, needs_table, reference_tables

import tribodyn as td
from tribodyn.cli import call
from tribodyn.cli.app import COMMANDS
from tribodyn.ehl import FILM_MODELS
from tribodyn.friction import LAWS
from tribodyn.stiffness import MODELS
from tribodyn.study import read_case
from tribodyn.study.case.checks import case_options
from tribodyn.study.case.provenance import derived_values
from tribodyn.study.case.reference import case_keys, start_toml

_ROW = r"^\| `([\w-]+)` \| (.*) \|$"
_INERTIAS = ("mass", "moment_of_inertia")
_DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("page", GENERATED)
def test_pages_are_those_that_the_program_writes(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    assert text == written(page), "run: python tests/docs/generated.py"


def test_all_keys_are_on_the_page_as_they_are_checked() -> None:
    page = (_DOCS / "case-file.md").read_text(encoding="utf-8")
    assert reference_tables() in page
    parts = machine_tables()
    assert page.endswith(parts)
    assert "| `pin_clearance` |" in parts
    assert '### `[bearings.NAME with type = "angular-contact"]`' in parts
    assert len(list(case_keys())) > 60


def test_studies_of_motions_take_every_kind_of_case() -> None:
    row = "| `bifurcation` | a structure that moves | yes | yes | yes | `--mesh NAME`"
    assert row in needs_table()


def test_readme_and_page_have_the_file_that_new_writes(tmp_path: Path) -> None:
    assert call(["new", str(tmp_path / "my.toml")]) == 0
    text = (tmp_path / "my.toml").read_text(encoding="utf-8")
    for page in (ROOT / "README.md", _DOCS / "case-file.md"):
        assert text in blocks(page.read_text(encoding="utf-8"), "toml")


@pytest.mark.slow
def test_the_file_to_start_from_runs_without_a_warning() -> None:
    case = read_case(start_toml())
    body = derived_values(case)
    assert {f"gears.{g}.{key}" for g in ("pinion", "wheel") for key in _INERTIAS} <= set(body)
    root, tip = (
        7800.0 * math.pi / 4.0 * (diameter**2 - 0.04**2) * 0.04 for diameter in (0.106, 0.124)
    )
    assert root < body["gears.pinion.mass"] < tip
    assert case.friction.law == "xu-2007"
    assert case.backlash == 1e-4
    result = td.run(case)  # A warning would be an error here.
    assert result.warnings == ()
    assert 0.03 < result.summary()["mean_friction_coefficient"] < 0.07


def test_options_on_the_page_belong_to_their_models() -> None:
    page = (_DOCS / "case-file.md").read_text(encoding="utf-8")
    sections = (
        ("film", FILM_MODELS.names()),
        ("stiffness", MODELS.names()),
        ("friction", LAWS.names()),
    )
    parts = page.split("## All keys")[0].split("| law | options |")
    rows = [dict(re.findall(_ROW, part, re.M)) for part in (parts[0], parts[0], parts[1])]
    for (section, names), row in zip(sections, rows, strict=True):
        # "none" is both a film model and a friction law
        for name in names:
            assert set(re.findall(r"`(\w+)`", row[name])) == set(case_options(section, name))


def test_every_command_is_on_its_page() -> None:
    page = (_DOCS / "command-line.md").read_text(encoding="utf-8")
    for command in COMMANDS:
        assert f"`tribodyn {command.name}" in page
