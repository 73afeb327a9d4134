"""Columns of numbers as text: CSV of any dialect, with lines of text before them."""

from __future__ import annotations

import gzip
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tribodyn.errors import InputError
from tribodyn.measurement.readers.content import Content, in_seconds, is_time
from tribodyn.stored import LARGEST
from tribodyn.types import Array

_NUMBER = re.compile(r"[+-]?((\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?|nan|inf)", re.IGNORECASE)
_WITH_UNIT = re.compile(r"(.*?)\s*[\[(]([^\])]*)[\])]\s*")
#: Lines of text that may come before the numbers.
_HEAD = 200


def looks_binary(head: bytes) -> bool:
    """Whether the beginning of a file is no text."""
    return b"\x00" in head and head[:2] not in (b"\xff\xfe", b"\xfe\xff")


def content(path: Path) -> Content:
    """Channels of a file of columns."""
    lines = [line for line in _text(path).splitlines() if line.strip()]
    first, delimiter, width = _first_row(lines, path)
    names, units = _named(lines[:first], delimiter, width)
    table = _numbers(lines, first, delimiter, width, path)
    columns = dict(zip(names, table.T, strict=True))
    of = dict(zip(names, units, strict=True))
    time = None
    if is_time(names[0], units[0]):
        time = in_seconds(columns.pop(names[0]), of.pop(names[0]))
    if not columns:
        raise InputError(
            "has times and nothing else",
            where=str(path),
            remedy="Add a column",
            why="A recording has at least one signal",
        )
    return Content(columns, of, time=time)


def _text(path: Path) -> str:
    raw = path.read_bytes()
    if raw[:2] == b"\x1f\x8b":
        with gzip.open(path) as file:
            raw = file.read(LARGEST["recording"] + 1)
        if len(raw) > LARGEST["recording"]:
            raise InputError(
                "is too large once it is unpacked",
                where=str(path),
                why="So large a table does not fit into the memory",
                remedy="Cut the recording, or lower its sampling rate",
            )
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return raw.decode("utf-16")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def _cells(line: str, delimiter: str | None) -> list[str]:
    cells = [cell.strip().strip('"').strip() for cell in line.split(delimiter)]
    return cells[:-1] if delimiter and len(cells) > 1 and not cells[-1] else cells


def _first_row(lines: Sequence[str], path: Path) -> tuple[int, str | None, int]:
    """First line of numbers, what parts its columns, and how many there are."""
    for row, line in enumerate(lines[:_HEAD]):
        for delimiter in (";", "\t", ",", None):
            if delimiter is not None and delimiter not in line:
                continue
            cells = _cells(line, delimiter)
            if all(_NUMBER.fullmatch(cell) for cell in cells):
                return row, delimiter, len(cells)
    raise InputError(
        "holds no line of numbers",
        where=str(path),
        why=f"Looked at the first {min(len(lines), _HEAD)} lines, parted by ; tab , or blanks",
        remedy="Export the channels as columns of numbers",
    )


def _named(head: Sequence[str], delimiter: str | None, width: int) -> tuple[list[str], list[str]]:
    """Names and units of the columns, from the last lines before the numbers."""
    rows = [_cells(line.lstrip("#%").strip(), delimiter) for line in head]
    rows = [cells for cells in rows if len(cells) == width]
    units = [""] * width
    if len(rows) > 1 and _are_units(rows[-1]):
        units = [cell.strip("[]() ") for cell in rows.pop()]
    names = rows[-1] if rows else [f"column {1 + n}" for n in range(width)]
    for place, name in enumerate(names):
        if match := _WITH_UNIT.fullmatch(name):
            names[place], units[place] = match[1] or f"column {1 + place}", match[2]
    return _distinct(names), units


def _are_units(cells: Sequence[str]) -> bool:
    """Whether a line below the names holds units: in brackets or empty, or one of time first."""
    bracketed = all(not cell or cell[0] in "[(" for cell in cells) and any(cells)
    return bracketed or cells[0].strip("[]() ") in ("s", "ms", "us", "µs", "min")


def _distinct(names: Sequence[str]) -> list[str]:
    found: list[str] = []
    for place, name in enumerate(names):
        name = name or f"column {1 + place}"
        found.append(name if name not in found else f"{name} ({1 + place})")
    return found


def _numbers(
    lines: Sequence[str], first: int, delimiter: str | None, width: int, path: Path
) -> Array:
    """All numbers (rows, columns); a line that is none is told by its number."""
    rows = lines[first:]
    comma = delimiter != ","
    plain = [line.replace('"', "").rstrip().removesuffix(delimiter or " ") for line in rows]
    if comma:
        plain = [line.replace(",", ".") for line in plain]
    try:
        table = np.loadtxt(plain, delimiter=delimiter, ndmin=2, comments=None)
    except ValueError:
        table = np.empty((0, 0))
    if table.shape != (len(rows), width) or not np.all(np.isfinite(table)):
        for row, line in enumerate(rows):
            cells = _cells(line, delimiter)
            bad = next((c for c in cells if not _NUMBER.fullmatch(c) or "n" in c.lower()), None)
            if len(cells) != width or bad is not None:
                what = f'"{bad}" is no number' if bad is not None else f"{len(cells)} columns"
                raise InputError(
                    f"{what} in row {1 + row} of the numbers: {line[:80]!r}",
                    where=str(path),
                    why=f"Every row holds {width} numbers",
                    remedy="The file is cut short there, or a sample is missing: cut the row, or "
                    "fill it by interpolation",
                )
        raise InputError(
            "holds numbers that are not finite",
            where=str(path),
            why="Spectra and orders need every sample",
            remedy="Fill the gaps, or cut the recording before them",
        )
    return table
