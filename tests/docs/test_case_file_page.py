"""The page on the case file is made from the same fields that check a case."""

from __future__ import annotations

import re
from pathlib import Path

from tribodyn.cli.app import COMMANDS
from tribodyn.ehl import FILM_MODELS
from tribodyn.friction import LAWS
from tribodyn.stiffness import MODELS
from tribodyn.study.case.checks import case_options
from tribodyn.study.case.reference import case_keys, reference_tables

_ROW = r"^\| `([\w-]+)` \| (.*) \|$"
_DOCS = Path(__file__).parents[2] / "docs"


def test_all_keys_are_on_the_page_as_they_are_checked() -> None:
    page = (_DOCS / "case-file.md").read_text(encoding="utf-8")
    assert page.endswith(reference_tables())
    assert len(list(case_keys())) > 60


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
    for name, _, _ in COMMANDS:
        assert f"`tribodyn {name}" in page
