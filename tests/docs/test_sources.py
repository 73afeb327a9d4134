"""Every source that docstrings, pages and data cite is in the bibliography."""

from __future__ import annotations

import re
from pathlib import Path

from pages import ROOT

from tribodyn.study.pipeline.citations import bibliography

_AUTHOR = r"[A-Z][\wäöüé]+"
#: "Author (1999)", "A and B (1999)", "A, B and C, title (1999)" with the years in brackets.
_CITED = re.compile(
    rf"((?:{_AUTHOR}, )*(?:{_AUTHOR} and )?{_AUTHOR})(?:, [A-Z][^().]*)? \((1[6-9]\d\d|20[0-2]\d)"
)
_STANDARD = re.compile(r"\b(?:(ISO(?:/TR)?|DIN|AGMA|ASTM) (D?\d+)(-\d+)?)")
_SPELT = {"Mueller": "Müller"}
#: Words before a year in brackets that are no authors.
_NO_AUTHORS = {
    "Chaos",
    "Gearing",
    "IMechE",
    "Lyon",
    "Munich",
    "Trib",
    "Trans",
    "Valid",
    "Source",
    "Unreleased",
}


def _texts() -> list[Path]:
    source = ROOT / "src" / "tribodyn"
    pages = [
        p for p in (ROOT / "docs").glob("*.md") if p.name not in ("bibliography.md", "reference.md")
    ]
    return [*source.rglob("*.py"), *pages, source / "lubricant" / "library.toml"]


def _missing(text: str, sources: list[str]) -> list[str]:
    missing = []
    for names, year in _CITED.findall(re.sub(r"\s+", " ", text)):
        for name in re.split(r", | and ", names):
            author = _SPELT.get(name, name)
            if author in _NO_AUTHORS:
                continue
            if not any(
                author in entry.partition("(")[0] and f"({year})" in entry for entry in sources
            ):
                missing.append(f"{names} ({year})")
    for body, number, _ in _STANDARD.findall(text):
        if not any(re.search(rf"\b{body} {number}\b", entry) for entry in sources):
            missing.append(f"{body} {number}")
    return missing


def test_cited_sources_are_in_the_bibliography() -> None:
    sources = list(bibliography().values())
    missing = {path: _missing(path.read_text("utf-8"), sources) for path in _texts()}
    assert {path.name: names for path, names in missing.items() if names} == {}


def test_a_missing_source_is_noticed() -> None:
    sources = list(bibliography().values())
    assert _missing("after Nobody and Else (1999) and ISO 99999", sources) == [
        "Nobody and Else (1999)",
        "Nobody and Else (1999)",
        "ISO 99999",
    ]
    assert _missing("after Dowson (1968), ISO 21771", sources) == []


def test_no_source_is_hidden() -> None:
    hidden = re.compile(r"source document|publication that prints|published chaos", re.I)
    assert [path.name for path in _texts() if hidden.search(path.read_text("utf-8"))] == []
