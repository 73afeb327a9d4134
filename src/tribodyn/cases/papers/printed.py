"""What a source prints, row by row, and how each row is computed: files in ``cases/reference``."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from importlib.resources import files
from pathlib import Path
from typing import Any

from tribodyn.errors import InputError

#: What is expected of a row, and what its figures can say: the printed value, its trend, neither.
VERDICTS = VALUE, TREND, NEITHER = "value", "trend", "cannot-reproduce"


@dataclass(frozen=True)
class PrintedRow:
    """One printed figure."""

    paper: str  #: case of the source
    table: str
    row: str
    #: A number, two ends of a range, or the word for how figures run along some values of a key.
    printed: float | str | list[float]
    expected: str
    reason: str
    unit: str = "1"
    tolerance: float = 0.01  #: relative deviation of a printed value that counts as none
    limit: str = ""  #: "most" or "least": an error, say, that is less is met as well
    compute: str = ""  #: name of a computation; empty where nothing can be computed
    of: str = ""  #: its figure
    case: str = ""  #: case that is computed; that of the source by default
    set: Mapping[str, Any] = field(default_factory=dict)  #: changes of the case
    given: Mapping[str, Any] = field(default_factory=dict)  #: arguments of the computation
    against: Mapping[str, Any] | None = None  #: changes of a second case; relative change to it
    along: Mapping[str, Any] = field(default_factory=dict)  #: key or argument and its values
    series: str = ""  #: rows of one series have to run like the printed ones
    level: float = 0.0  #: relative change within a series or along a key that counts as none

    @property
    def is_word(self) -> bool:
        """Whether a word is printed and not a number."""
        return isinstance(self.printed, str)


def papers() -> dict[str, Path]:
    """Cases of the sources with printed tables, and the files of these."""
    folder = Path(str(files("tribodyn.cases").joinpath("reference")))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def printed_rows(paper: str) -> tuple[PrintedRow, ...]:
    """All rows of the source of a case.

    >>> printed_rows("fzg-12dof")[0].table
    'Table 1'
    """
    known = papers()
    if paper not in known:
        why = f"There are tables for {', '.join(known)}"
        raise InputError(
            f'no printed tables are known for "{paper}"', "", why, "Take one of them, or --all"
        )
    tables = tomllib.loads(known[paper].read_text(encoding="utf-8"))["tables"]
    return tuple(_row(paper, table, row) for table in tables for row in table["rows"])


_MERGED = ("set", "given")


def _row(paper: str, table: Mapping[str, Any], row: Mapping[str, Any]) -> PrintedRow:
    """A row with what its table says of all rows."""
    both = {**table, **row, "paper": paper}
    both |= {key: {**table.get(key, {}), **row.get(key, {})} for key in _MERGED}
    both.setdefault("case", paper)
    del both["rows"]
    if unknown := sorted(both.keys() - {each.name for each in fields(PrintedRow)}):
        raise InputError(f'unknown key "{unknown[0]}"', f"{paper}, {both['table']}", "", "")
    return PrintedRow(**both)
