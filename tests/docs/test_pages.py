"""README and documentation: code runs, links lead somewhere, the glossary is the table."""

import re
import tomllib
from pathlib import Path

import pytest
from glossary import PAGE, page
from pages import PAGES, ROOT, anchors, blocks, broken_links

from registries import as_before
from tribodyn.cli import call
from tribodyn.study import Case

README = (ROOT / "README.md").read_text("utf-8")
INDEX = (ROOT / "docs" / "index.md").read_text("utf-8")
# Their examples solve films, move faulty gears, and compile what few others need.
SLOW = {"film.md", "stiffness.md", "dynamics.md", "hypoid.md", "faults.md"}
# Those of the cookbook run in test_cookbook.py.
WITH_PYTHON = [
    path
    for path in PAGES
    if path.parent.name != "cookbook" and blocks(path.read_text("utf-8"), "python")
]


def test_readme_has_exactly_the_two_commands() -> None:
    main, suite = blocks(README, "bash")
    for command in (main, suite):
        assert command.count("\n") == 1
        assert command.startswith("python3 -m venv .venv && .venv/bin/pip install ")
    assert " .venv/bin/tribodyn run fzg-roughness --out fzg-report" in main
    assert '".[test]"' in suite
    assert suite.rstrip().endswith('-m pytest -n auto -m "not slow"')


def test_the_first_pages_name_all_kinds_of_gears() -> None:
    """Gears of a case are spur gears or hypoid pairs, or the mesh table of another program."""
    kinds = set(dict(Case.fields["gears"].kind.specs())["kind"].names())
    assert kinds == {"spur", "hypoid", "table"}
    scope = next(text for text in README.split("\n\n") if "(docs/scope.md)" in text)
    index = next(line for line in INDEX.splitlines() if "(scope.md)" in line)
    for text in (scope, index):
        assert all(kind in text for kind in kinds - {"table"})


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, marks=pytest.mark.slow if path.name in SLOW else ())
        for path in WITH_PYTHON
    ],
    ids=lambda path: path.name,
)
def test_python_blocks_run(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "page"}
    with as_before():
        for block in blocks(path.read_text("utf-8"), "python"):
            exec(compile(block, path.name, "exec"), names)
    if path.name == "README.md":
        assert (tmp_path / "my-report" / "report.html").is_file()


def test_readme_is_among_the_pages_with_code() -> None:
    assert ROOT / "README.md" in WITH_PYTHON
    assert {path.name for path in WITH_PYTHON} > SLOW


def test_toml_blocks_are_toml() -> None:
    for path in PAGES:
        for block in blocks(path.read_text("utf-8"), "toml"):
            assert tomllib.loads(block), path


def test_links_lead_somewhere() -> None:
    broken = {path.name: broken_links(path, path.read_text("utf-8")) for path in PAGES}
    assert {name: links for name, links in broken.items() if links} == {}


def test_broken_links_are_detected(tmp_path: Path) -> None:
    page_file = tmp_path / "page.md"
    assert broken_links(page_file, "[x](nowhere.md)")
    assert broken_links(page_file, "# Title\n[x](#other)")
    assert not broken_links(page_file, "# My title!\n[x](#my-title) [y](https:" + "//doi.org)")
    assert anchors("## Two `commands`, here\n") == {"two-commands-here"}


def test_every_page_is_reached_from_the_index() -> None:
    index = (ROOT / "docs" / "index.md").read_text("utf-8")
    index += (ROOT / "docs" / "cookbook.md").read_text("utf-8")
    pages = {path.relative_to(ROOT / "docs").as_posix() for path in PAGES if "docs" in path.parts}
    assert {page for page in pages - {"index.md"} if f"({page})" not in index} == set()


def test_glossary_is_the_table_of_quantities() -> None:
    assert PAGE.read_text("utf-8") == page(), "run: python tests/docs/glossary.py"


def commands() -> list[str]:
    text = "\n".join(blocks(README, "text"))
    return sorted(set(re.findall(r"^tribodyn ([a-z]+)", text, re.MULTILINE)))


def test_commands_of_the_readme_exist(capsys: pytest.CaptureFixture[str]) -> None:
    assert len(commands()) > 5
    wrong = {}
    for command in commands():
        code = call([command, "--help"])
        text = capsys.readouterr()
        if code != 0 or command not in text.out + text.err:
            wrong[command] = code, text.err
    assert wrong == {}


def test_the_page_on_extending_shows_the_files_that_are_tested() -> None:
    page = (ROOT / "docs" / "extending.md").read_text("utf-8")
    files = sorted((ROOT / "docs" / "extending").glob("*.py"))
    assert len(files) == 7
    for file in files:
        assert file.read_text("utf-8") in blocks(page, "python")
