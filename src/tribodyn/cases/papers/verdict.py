"""How near computed figures are to the printed ones."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby

import numpy as np

from tribodyn.cases.papers.printed import NEITHER, TREND, VALUE, PrintedRow

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
    """Word for how values run: rises, falls, stays, or one then another.

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
    runs = {name: _runs_alike(rows, computed, name) for name in {series_of(row) for row in rows}}
    return [
        _verdict(row, value, runs[series_of(row)])
        for row, value in zip(rows, computed, strict=True)
    ]


def series_of(row: PrintedRow) -> tuple[str, str, str]:
    """Which rows have to run alike; without a name none."""
    return row.paper, row.table, row.series


def _runs_alike(
    rows: Sequence[PrintedRow], computed: Sequence[float | str | None], name: tuple[str, str, str]
) -> bool:
    if not name[2]:
        return False
    pairs = [
        (row, value) for row, value in zip(rows, computed, strict=True) if series_of(row) == name
    ]
    found = [value for _, value in pairs if isinstance(value, float)]
    printed = [row.printed for row, _ in pairs if isinstance(row.printed, int | float)]
    level = pairs[0][0].level
    whole = len(found) == len(printed) == len(pairs) > 1
    return whole and signs(found, level) == signs(printed, level)


def _verdict(row: PrintedRow, computed: float | str | None, alike: bool) -> str:
    if isinstance(computed, str):
        return TREND if computed.partition(":")[0] == row.printed else NEITHER
    if row.printed == 0 and computed is not None:
        return VALUE if abs(computed) <= row.level else NEITHER
    apart = deviation(row, computed)
    if apart is not None and _SIDES[row.limit](apart) <= row.tolerance:
        return VALUE
    single = row.against is not None and not row.series and isinstance(computed, float)
    if single and apart is not None:
        alike = apart > -1.0 and abs(computed or 0.0) >= _MARGINAL
    return TREND if alike else NEITHER
