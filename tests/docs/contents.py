"""What the sources contain and where it is here: the data of ``docs/coverage.md``, and its page."""

import re
import tomllib
from collections.abc import Iterator
from functools import cache
from typing import Any

from pages import ROOT

DATA = ROOT / "tests" / "docs" / "contents.toml"
HEAD = """# What the sources contain

On this page you can look up how tribodyn covers every law, table, figure and number of the
sources of its built-in cases: the test that checks it, the figure that shows it, the published
table that `tribodyn paper CASE` [recomputes](papers.md), or the reason why it is missing.
"""


def sources() -> dict[str, Any]:
    """Sources by their short names."""
    return tomllib.loads(DATA.read_text("utf-8"))


def page(_: str = "") -> str:
    """Text of the page."""
    parts = [HEAD]
    for source in sources().values():
        lines = [f"\n## {source['title']}\n", "| row | content | where |", "|---|---|---|"]
        lines += [f"| {row['id']} | {row['text']} | {_where(row)} |" for row in source["rows"]]
        parts.append("\n".join(lines) + "\n")
    return "".join(parts)


def _where(row: dict[str, Any]) -> str:
    kinds = (("table", "tables"), ("figure", "figures"), ("test", "tests"))
    names = [f"{kind} `{name}`" for kind, key in kinds for name in row.get(key, [])]
    return "; ".join([*names, *([row["reason"]] if "reason" in row else [])])


@cache
def _tests() -> frozenset[str]:
    """Every test file by its bare name, and every test in it as ``file::name``."""
    tests = set()
    for path in (ROOT / "tests").rglob("test_*.py"):
        names = re.findall(r"^ *def (\w+)", path.read_text("utf-8"), re.MULTILINE)
        tests |= {path.name, *(f"{path.name}::{name}" for name in names)}
    return frozenset(tests)


def missing(row: dict[str, Any]) -> Iterator[str]:
    """Tests, figures and tables of a row that do not exist."""
    from tribodyn.cases.papers.printed import papers, printed_rows
    from tribodyn.plot import FIGURES

    for name in row.get("tests", []):
        if name not in _tests():
            yield f"test {name}"
    for name in row.get("figures", []):
        if name not in FIGURES:
            yield f"figure {name}"
    for name in row.get("tables", []):
        case, _, table = name.partition(": ")
        if case not in papers() or table not in {each.table for each in printed_rows(case)}:
            yield f"table {name}"
