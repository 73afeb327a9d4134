"""Reader of text columns: CSV of any dialect, with optional header lines."""

from __future__ import annotations

import csv
import gzip
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tribodyn.errors import InputError
from tribodyn.measurement.readers.recording_data import (
    MEASURED,
    RecordingData,
    consistent_rate,
    header_rate,
    in_seconds,
    is_time,
)
from tribodyn.types import Array
from tribodyn.units import UnitProblemError, convert
from tribodyn.validated_files import LARGEST

_NUMBER = re.compile(r"[+-]?((\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?|nan|inf)", re.IGNORECASE)
#: Placeholders of loggers for missing samples.
_MISSING = {"", "na", "n/a", "#n/a", "null", "none", "-", "--", "?"}
_CLOCK = re.compile(r"(\d{4}-\d\d-\d\d)?[T ]?(\d\d?):(\d\d):(\d\d(?:[.,]\d*)?)Z?")
_WITH_UNIT = re.compile(r"(.*?)\s*[\[(]([^\])]*)[\])]\s*")
_BEFORE_UNIT = re.compile(r"(.*?)\s*[/,]\s*([^/,].*)")
_FACT = re.compile(
    r"\"?([^:=;,\t\d\[(\"]+?)\"?\s*(?:[\[(]([^\])]*)[\])])?\s*[:=;,\t]+\s*\"?"
    r"([0-9.,]+(?:e[+-]?\d+)?)[\";,\t ]*([a-zµμ]*)",
    re.IGNORECASE,
)
#: Number at the end of the name of one of several columns of times.
_REPEATED = re.compile(r" \(\d+\)$|(?<=\w{3})[ _.]?\d+$")
#: Characters of a line or a name in which a rate or a unit is searched, at most.
_LONGEST = 200
#: Lines that are searched for the first row of numbers; rows at the end that the truncation check
#: compares.
_HEAD, _LOOK = 200, 100


class _Layout(NamedTuple):
    """Layout of the columns of numbers in a file."""

    first: int  #: line
    delimiter: str | None
    width: int
    ends: bool  #: whether every row ends with the delimiter

    def cells(self, line: str) -> list[str]:
        """Cells of a line without the empty one after a trailing delimiter."""
        cells = _split_cells(line, self.delimiter)
        return cells[:-1] if self.ends and len(cells) == self.width + 1 else cells


def looks_binary(head: bytes) -> bool:
    """Whether the beginning of a file is binary (neither 8-bit nor UTF-16 text)."""
    return b"\x00" in head and head[:2] not in (b"\xff\xfe", b"\xfe\xff")


def read_columns(path: Path) -> RecordingData:
    """Read the channels of a text file with columns of numbers."""
    text = _text(path)
    lines = [line for line in text.splitlines() if line.strip()]
    layout = _layout(lines, path)
    rates, head = _header_rates(lines[: layout.first])
    names, units = _column_names_and_units(head, layout, path)
    table = _numbers(lines, layout, path)
    if not text.endswith(("\n", "\r")):
        _refuse_cut(lines[layout.first :], layout, path)
    columns = dict(zip(names, table.T, strict=True))
    unit_of = dict(zip(names, units, strict=True))
    clocks = _clocks(names, unit_of, columns)
    if not clocks:
        what, remedy = "has different sampling rates in its header", "Correct one of them"
        rate = consistent_rate(rates, str(path), what, remedy) if rates else None
        return RecordingData(columns, unit_of, dict.fromkeys(columns, rate) if rate else {})
    axes = {name: in_seconds(columns.pop(name), unit_of.pop(name), path) for name in clocks}
    if not columns:
        raise InputError(
            "has a time column but no channels", where=str(path), remedy="Add a column"
        )
    times, clock = {}, clocks[0]
    for name in names:
        clock = name if name in axes else clock
        if name in columns:
            times[name] = axes[clock]
    return RecordingData(columns, unit_of, times=times)


def _clocks(
    names: Sequence[str], units: Mapping[str, str], columns: Mapping[str, Array]
) -> list[str]:
    """Columns of times: each is that of the columns after it, the first of those before it too."""
    clocks = [name for name in names if is_time(_REPEATED.sub("", name), units[name])]
    rising = [name for name in clocks[1:] if np.all(np.diff(columns[name]) >= 0.0)]
    return clocks[:1] + [name for name in rising if np.ptp(columns[name]) > 0.0]


def _header_rates(head: Sequence[str]) -> tuple[dict[str, float], list[str]]:
    """Sampling rates in the lines above the columns, and the other lines."""
    rates: dict[str, float] = {}
    others = []
    for line in head:
        fact = line.lstrip("#% ").rstrip('";,\t ')
        match = _FACT.fullmatch(fact) if len(fact) <= _LONGEST else None
        number = match and _decimal(match[3])
        value = match and number and header_rate(match[1], number, match[4] or match[2] or "")
        if match and value:
            rates[match[1].strip()] = value
        else:
            others.append(line)
    return rates, others


def _decimal(text: str) -> float | None:
    """Number with a decimal point or comma; None for other text, such as a list."""
    try:
        return float(text.rstrip(",").replace(",", "."))
    except ValueError:
        return None


def _text(path: Path) -> str:
    raw = path.read_bytes()
    if raw[:2] == b"\x1f\x8b":
        with gzip.open(path) as file:
            raw = file.read(LARGEST["recording"] + 1)
        if len(raw) > LARGEST["recording"]:
            raise InputError("is too large after decompression", where=str(path))
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return raw.decode("utf-16")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def _split_cells(line: str, delimiter: str | None) -> list[str]:
    if delimiter and '"' in line:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter))]
    return [cell.strip().strip('"').strip() for cell in line.split(delimiter)]


def _is_sample(cell: str) -> bool:
    """Whether a cell holds a number, a time of day, or a placeholder for a missing sample."""
    return bool(_NUMBER.fullmatch(cell) or cell.lower() in _MISSING or _CLOCK.fullmatch(cell))


def _row(line: str) -> tuple[str | None, int, bool] | None:
    """Delimiter and number of cells of a line of numbers, and whether its last cell is empty."""
    for delimiter in (";", "\t", ",", None):
        if delimiter is not None and delimiter not in line:
            continue
        cells = _split_cells(line, delimiter)
        if all(map(_is_sample, cells)) and any(map(_NUMBER.fullmatch, cells)):
            return delimiter, len(cells), not cells[-1]
    return None


def _layout(lines: Sequence[str], path: Path) -> _Layout:
    """Detect the first row, delimiter and number of the columns.

    Numbers in the header are separated from the columns by a line of text.
    """
    layouts: list[_Layout] = []
    after_text = True
    for number, line in enumerate(lines[:_HEAD]):
        row = _row(line)
        if row is None:
            entries = re.split(r"[;,\t ]+", line)
            after_text |= not any(map(_NUMBER.fullmatch, entries))
            continue
        last = layouts[-1] if layouts else None
        if last and (last.delimiter, last.width + last.ends) == row[:2]:
            # In a single column, a name cannot be distinguished from an invalid sample.
            if after_text and last.width > 1 and number > last.first + 1:
                layouts.append(_Layout(number, row[0], row[1] - row[2], row[2]))
            elif last.ends and not row[2]:
                layouts[-1] = last._replace(width=row[1], ends=False)
        elif last is None or after_text:
            layouts.append(_Layout(number, row[0], row[1] - row[2], row[2]))
        after_text = False
    if layouts:
        return layouts[-1]
    what = "holds no line of numbers"
    why = f"Searched the first {min(len(lines), _HEAD)} lines with the delimiters ; tab , and blank"
    raise InputError(what, str(path), why, "Export the channels as columns of numbers")


def _column_names_and_units(
    head: Sequence[str], layout: _Layout, path: Path
) -> tuple[list[str], list[str]]:
    """Names and units of the columns, from the last lines before the numbers."""
    width = layout.width
    rows = [layout.cells(line.lstrip("#%").strip()) for line in head]
    if rows and 2 * len(rows[-1]) == width and layout.delimiter == ",":
        what = f"has {len(rows[-1])} names and {width} columns of numbers"
        why = "The comma seems to be both column delimiter and decimal sign"
        remedy = "Export it with semicolons as delimiters or with decimal points"
        raise InputError(what, str(path), why, remedy)
    if rows and width == 1 and _WITH_UNIT.fullmatch(name := head[-1].lstrip("#%").strip()):
        rows[-1] = [name]  # the blank before the unit delimits no columns
    rows = [cells for cells in rows if len(cells) == width]
    units = [""] * width
    if len(rows) > 1 and _are_units(rows[-1], rows[-2]):
        units = [cell.strip("[]() ") for cell in rows.pop()]
    names = list(rows[-1]) if rows else [f"column {1 + n}" for n in range(width)]
    for column, name in enumerate(names):
        if len(name) > _LONGEST:
            continue
        if match := _WITH_UNIT.fullmatch(name):
            names[column], units[column] = match[1] or f"column {1 + column}", match[2]
        elif (match := _BEFORE_UNIT.fullmatch(name)) and match[1] and _is_unit(match[2]):
            names[column], units[column] = match[1], match[2]
    return _distinct(names), units


def _are_units(cells: Sequence[str], above: Sequence[str]) -> bool:
    """Whether the cells below the names are units: in brackets, or units of measured quantities."""
    if all(not cell or cell[0] in "[(" for cell in cells) and any(cells):
        return True
    named = all(cell and not _is_sample(cell) for cell in above)
    labels = [cell for cell in cells if cell not in ("", "-", "%")]
    return named and bool(labels) and not is_time(cells[0]) and all(map(_is_unit, labels))


def _is_unit(text: str) -> bool:
    """Whether a text is the unit of a measured quantity, not a name."""
    for si in (*MEASURED, "s", "Hz"):
        try:
            return bool(convert(1.0, text, si))
        except UnitProblemError:
            continue
    return False


def _distinct(names: Sequence[str]) -> list[str]:
    distinct: dict[str, None] = {}
    for column, name in enumerate(names):
        name = name or f"column {1 + column}"
        while name in distinct:
            name = f"{name} ({1 + column})"
        distinct[name] = None
    return list(distinct)


def _numbers(lines: Sequence[str], layout: _Layout, path: Path) -> Array:
    """Parse all numbers (rows, columns); raise InputError with the number of an invalid row."""
    rows, shape = lines[layout.first :], (len(lines) - layout.first, layout.width)
    try:
        if '"' in rows[0] or ":" in rows[0]:
            first = next((cell for cell in layout.cells(rows[0]) if _CLOCK.fullmatch(cell)), "")
            table = np.array([_values(layout.cells(row), first) for row in rows])
        else:
            plain = [row.rstrip().removesuffix(layout.delimiter or " ") for row in rows]
            if layout.delimiter != ",":
                plain = [row.replace(",", ".") for row in plain]
            table = np.loadtxt(plain, delimiter=layout.delimiter, ndmin=2, comments=None)
    except ValueError:
        table = np.empty((0, 0))
    if table.shape == shape and np.all(np.isfinite(table)):
        return table
    for number, row in enumerate(rows, 1):
        cells = layout.cells(row)
        bad = [c for c in cells if not (_NUMBER.fullmatch(c) or _CLOCK.fullmatch(c))]
        bad += [c for c in cells if c.lower().lstrip("+-") in ("nan", "inf")]
        if len(cells) != layout.width or bad:
            what = f'"{bad[0]}" is not a number' if bad else f"{len(cells)} columns"
            raise InputError(
                f"{what} in row {number} of the numbers: {row[:80]!r}",
                where=str(path),
                why=f"Every row must hold {layout.width} numbers",
                remedy="The file is cut short or a sample is missing: delete the row, or "
                "fill the gap by interpolation",
            )
    raise InputError("holds numbers that are not finite", where=str(path))


def _values(cells: Sequence[str], first: str) -> list[float]:
    """Numbers of a row; times of day in seconds from the first date, to preserve precision."""
    values = []
    for cell in cells:
        clock, start = _CLOCK.fullmatch(cell), _CLOCK.fullmatch(first)
        if clock is None or start is None:
            values.append(float(cell.replace(",", ".")))
            continue
        days = [np.datetime64(match[1] or "1970-01-01") for match in (clock, start)]
        hours, minutes, seconds = (float(part.replace(",", ".")) for part in clock.groups()[1:])
        values.append(
            3600.0 * (24.0 * (days[0] - days[1]).astype(int) + hours) + 60.0 * minutes + seconds
        )
    return values


def _refuse_cut(rows: Sequence[str], layout: _Layout, path: Path) -> None:
    """Raise InputError if the unterminated last row ends in a number with too few digits."""
    digits = [
        len(re.split(r"[.,]", layout.cells(row)[-1].lower().partition("e")[0])[-1])
        for row in rows[-_LOOK:]
    ]
    shorter = np.mean(np.array(digits[:-1]) <= digits[-1]) if len(digits) > 20 else 1.0
    if shorter == 0.0 or (shorter < 0.05 and digits[-1] < 0.5 * np.median(digits)):
        what = f"seems to be cut short in its last row: {rows[-1][:80]!r}"
        why = "Its last number has fewer digits than those above, and the line is not terminated"
        remedy = "Export the file from the measuring system again, or terminate its last line"
        raise InputError(what, str(path), why, remedy)
