"""What is written names no machine, and the version is the same everywhere."""

import re
import tomllib

import pytest
from source_tree import ROOT, text_files
from text_checks import machine_paths, strange_hosts

import tribodyn


def contents() -> list[tuple[str, str]]:
    return [
        (path.relative_to(ROOT).as_posix(), path.read_text("utf-8", errors="replace"))
        for path in text_files()
    ]


def test_no_machine_paths() -> None:
    complaints = [found for name, text in contents() for found in machine_paths(name, text)]
    assert not complaints, "\n".join(complaints)


def test_only_known_hosts() -> None:
    complaints = [found for name, text in contents() for found in strange_hosts(name, text)]
    assert not complaints, "\n".join(complaints)


@pytest.mark.parametrize("start", ["home", "work", "tmp", "root"])
def test_machine_paths_are_found(start: str) -> None:
    assert machine_paths("x", f'open("/{start}/file")')
    assert machine_paths("x", f"see /{start}/file")
    assert not machine_paths("x", f"docs/{start}/file and $HOME/{start}/x")
    assert machine_paths("x", "C:" + chr(92) + "Users")


def test_strange_hosts_are_found() -> None:
    address = "https:" + "//"
    assert strange_hosts("x", address + "mirror.local/simple")
    assert strange_hosts("x", address + "doi.org:8080/x")
    assert not strange_hosts("x", address + "doi.org/10.1/x")


def test_files_of_the_repository_are_found() -> None:
    names = {name for name, _ in contents()}
    assert {"README.md", "pyproject.toml", ".ci/run", "src/tribodyn/units.py"} <= names


def test_nothing_lies_about_that_a_merge_or_an_editor_left() -> None:
    left = (".orig", ".rej", ".bak", "~")
    every = (path for place in ("src", "tests", "docs") for path in (ROOT / place).rglob("*"))
    assert not [path.name for path in every if path.name.endswith(left)]


def test_version_is_the_same_everywhere() -> None:
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    changelog = (ROOT / "CHANGELOG.md").read_text("utf-8")
    assert f"version: {tribodyn.__version__}\n" in citation
    newest = re.search(r"^## \[(\d[^\]]*)\] - \d{4}-\d\d-\d\d$", changelog, re.MULTILINE)
    assert newest
    assert newest.group(1) == tribodyn.__version__


def test_licence_is_the_same_everywhere() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert project["license"] == "BSD-3-Clause"
    assert "license: BSD-3-Clause" in (ROOT / "CITATION.cff").read_text("utf-8")
    assert (ROOT / "LICENSE").read_text("utf-8").startswith("BSD 3-Clause License")
