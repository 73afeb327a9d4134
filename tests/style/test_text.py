"""What is written names no machine, and the version is the same everywhere."""

import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest
from source_tree import ROOT, expected_files, repository_files, text_files, tracked_files
from text_checks import machine_paths, strange_hosts

import tribodyn


def contents() -> list[tuple[str, str]]:
    return [
        (path.relative_to(ROOT).as_posix(), path.read_text("utf-8", errors="replace"))
        for path in text_files()
    ]


def test_no_machine_paths() -> None:
    complaints = [match for name, text in contents() for match in machine_paths(name, text)]
    assert not complaints, "\n".join(complaints)


def test_only_known_hosts() -> None:
    complaints = [match for name, text in contents() for match in strange_hosts(name, text)]
    assert not complaints, "\n".join(complaints)


@pytest.mark.parametrize("start", ["home", "work", "tmp", "root"])
def test_machine_paths_are_detected(start: str) -> None:
    assert machine_paths("x", f'open("/{start}/file")')
    assert machine_paths("x", f"see /{start}/file")
    assert not machine_paths("x", f"docs/{start}/file and $HOME/{start}/x")
    assert machine_paths("x", "C:" + chr(92) + "Users")


def test_unknown_hosts_are_detected() -> None:
    address = "https:" + "//"
    assert strange_hosts("x", address + "mirror.local/simple")
    assert strange_hosts("x", address + "doi.org:8080/x")
    assert not strange_hosts("x", address + "doi.org/10.1/x")


def test_files_of_the_repository_are_listed() -> None:
    names = {name for name, _ in contents()}
    assert {"README.md", "pyproject.toml", ".ci/run", "src/tribodyn/units.py"} <= names


def test_nothing_lies_about_that_a_merge_or_an_editor_left() -> None:
    left = (".orig", ".rej", ".bak", "~")
    assert not [path.name for path in repository_files() if path.name.endswith(left)]


def _repository_with_leftovers(root: Path) -> set[str]:
    """Make a small repository in which a user has worked; return the files that it holds."""
    names = {"README.md", "docs/page.md", "src/tribodyn/units.py", ".ci/run"}
    left = {"fzg-report/report.html", "my.toml", ".venv/pyvenv.cfg", "build/x.py", "runs/a.md"}
    for name in names | left:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text("x")
    return names


def _text_files_in(root: Path) -> set[str]:
    return {path.relative_to(root).as_posix() for path in text_files(root)}


def test_files_that_users_leave_in_the_folder_are_not_read(tmp_path: Path) -> None:
    names = _repository_with_leftovers(tmp_path)
    assert tracked_files(tmp_path) is None
    assert _text_files_in(tmp_path) == names


@pytest.mark.skipif(shutil.which("git") is None, reason="needs git")
def test_in_a_clone_only_tracked_files_are_read(tmp_path: Path) -> None:
    names = _repository_with_leftovers(tmp_path)
    (tmp_path / "docs" / "notes.md").write_text("x")
    for command in (["init", "-q"], ["add", "-f", *names]):
        subprocess.run(["git", *command], cwd=tmp_path, check=True)
    assert _text_files_in(tmp_path) == names


def test_every_tracked_file_is_at_an_expected_place() -> None:
    tracked = tracked_files() or []
    strange = set(tracked) - set(expected_files(ROOT))
    assert not strange, "add these to the folders and files in source_tree.py"


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
