"""Printed figures of a source, row by row, and how close computed ones are."""

from __future__ import annotations

import math
import operator
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from importlib.resources import files
from itertools import groupby
from pathlib import Path

import numpy as np

from tribodyn.errors import InputError
from tribodyn.types import ByName

#: Verdicts of a row: its value is met, only its trend, or neither.
VERDICTS = VALUE, TREND, NEITHER = "value", "trend", "cannot-reproduce"


@dataclass(frozen=True)
class PrintedRow:
    """One printed figure."""

    paper: str  #: case of the source
    table: str
    row: str
    #: A number, two ends of a range, or the trend of the figures along some values of a key.
    printed: float | str | list[float]
    expected: str
    reason: str
    unit: str = "1"
    tolerance: float = 0.01  #: relative deviation of a printed value that counts as none
    limit: str = ""  #: "most" or "least": an error, say, that is less is met as well
    compute: str = ""  #: name of a computation; empty where nothing can be computed
    of: str = ""  #: its figure
    case: str = ""  #: case that is computed; that of the source by default
    set: ByName = field(default_factory=dict)  #: changes of the case
    arguments: ByName = field(default_factory=dict)  #: of the computation
    against: ByName | None = None  #: changes of a second case; relative change to it
    along: ByName = field(default_factory=dict)  #: key or argument and its values
    series: str = ""  #: rows of one series have to run like the printed ones
    level: float = 0.0  #: relative change within a series or along a key that counts as none


def papers() -> dict[str, Path]:
    """Cases of the sources with printed tables, and the files of these."""
    folder = Path(str(files("tribodyn.cases").joinpath("reference")))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def printed_rows(paper: str) -> tuple[PrintedRow, ...]:
    """All rows of the source of a case.

    >>> printed_rows("fzg-12dof")[0].table
    'Table 1'
    """
    files_by_paper = papers()
    if paper not in files_by_paper:
        why = f"There are tables for {', '.join(files_by_paper)}"
        raise InputError(
            f'there are no printed tables for "{paper}"', "", why, "Take one of them, or --all"
        )
    tables = tomllib.loads(files_by_paper[paper].read_text(encoding="utf-8"))["tables"]
    return tuple(_row(paper, table, row) for table in tables for row in table["rows"])


_MERGED = ("set", "arguments")


def _row(paper: str, table: ByName, row: ByName) -> PrintedRow:
    """Return a row with the values that its table sets for all rows."""
    values = {**table, **row, "paper": paper}
    values |= {key: {**table.get(key, {}), **row.get(key, {})} for key in _MERGED}
    values.setdefault("case", paper)
    del values["rows"]
    if unknown := sorted(values.keys() - {each.name for each in fields(PrintedRow)}):
        raise InputError(f'unknown key "{unknown[0]}"', f"{paper}, {values['table']}", "", "")
    return PrintedRow(**values)


_WORDS = {1: "rises", -1: "falls"}
_STEADY = "stays"
#: Change that counts as none [%].
_MARGINAL = 1.0
#: How far a deviation is off: to either side, or only beyond what is printed as a limit.
_SIDES: Mapping[str, Callable[[float], float]] = {"": abs, "most": float, "least": operator.neg}
#: Relative rounding of a change of unit.
_ROUNDING = 1e-12


def signs(values: Sequence[float], level: float) -> list[int]:
    """Directions from value to value: -1, 0 or 1."""
    numbers = np.array(values, dtype=float)
    steps, size = np.diff(numbers), np.maximum(np.abs(numbers[1:]), np.abs(numbers[:-1]))
    return [int(sign) for sign in np.where(np.abs(steps) <= level * size, 0, np.sign(steps))]


def course(values: Sequence[float], level: float) -> str:
    """Return the trend of values: rises, falls, stays, or one then another.

    >>> course([3.0, 1.0, 2.0], 0.0)
    'falls, then rises'
    """
    runs = [sign for sign, _ in groupby(sign for sign in signs(values, level) if sign)]
    return ", then ".join(_WORDS[sign] for sign in runs) or _STEADY


def deviation(row: PrintedRow, computed: float | str | None) -> float | None:
    """Computed over printed, or over the nearer end of a range, less 1; None without numbers."""
    if not isinstance(computed, float) or isinstance(row.printed, str):
        return None
    if isinstance(row.printed, list):
        low, high = row.printed
        nearest = min(max(computed, low), high)
    else:
        nearest = row.printed
    if math.isclose(nearest, computed, rel_tol=_ROUNDING):
        return 0.0
    return computed / nearest - 1.0 if nearest else None


def verdicts(rows: Sequence[PrintedRow], computed: Sequence[float | str | None]) -> list[str]:
    """Verdict of every row: its value, or the course of its series, or neither."""
    runs = {name: _same_trend(rows, computed, name) for name in {series_of(row) for row in rows}}
    return [
        _verdict(row, value, runs[series_of(row)])
        for row, value in zip(rows, computed, strict=True)
    ]


def series_of(row: PrintedRow) -> tuple[str, str, str]:
    """Return the key of the series whose rows must show the same trend."""
    return row.paper, row.table, row.series


def _same_trend(
    rows: Sequence[PrintedRow], computed: Sequence[float | str | None], name: tuple[str, str, str]
) -> bool:
    if not name[2]:
        return False
    pairs = [
        (row, value) for row, value in zip(rows, computed, strict=True) if series_of(row) == name
    ]
    numbers = [value for _, value in pairs if isinstance(value, float)]
    printed = [row.printed for row, _ in pairs if isinstance(row.printed, int | float)]
    level = pairs[0][0].level
    complete = len(numbers) == len(printed) == len(pairs) > 1
    return complete and signs(numbers, level) == signs(printed, level)


def _verdict(row: PrintedRow, computed: float | str | None, same_trend: bool) -> str:
    if isinstance(computed, str):
        return TREND if computed.partition(":")[0] == row.printed else NEITHER
    if row.printed == 0 and computed is not None:
        return VALUE if abs(computed) <= row.level else NEITHER
    relative = deviation(row, computed)
    if relative is not None and _SIDES[row.limit](relative) <= row.tolerance:
        return VALUE
    single = row.against is not None and not row.series and isinstance(computed, float)
    if single and relative is not None:
        same_trend = relative > -1.0 and abs(computed or 0.0) >= _MARGINAL
    return TREND if same_trend else NEITHER
