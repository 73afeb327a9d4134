"""Tables of figures that fit on a screen: meshes as columns, shafts and bearings as rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from textwrap import shorten

from tribodyn.cli.console import table
from tribodyn.study.pipeline.summary_figures import by_topic, figure_of, is_chief, split_key

_WIDTH = 100
#: Kinds with a figure in each row; of the others each part has a row.
_FIGURES_DOWN = ("meshes", "planets")
#: A value that is less than this part of the greatest of its table and unit is rounding.
_ROUNDING = 1e-9


def chief_figures(values: Mapping[str, float]) -> str:
    """Tables of the chief figures of a summary, and how to see the others."""
    chief = [name for name in values if is_chief(name)]
    left = len(values) - len(chief)
    return f"{screen(values, chief)}\n{left} more figures with --all; tribodyn explain NAME for one"


def screen(values: Mapping[str, float], names: Iterable[str]) -> str:
    """Tables of figures, one for each kind of part, which fit on a screen."""
    kinds: dict[str, list[str]] = {}
    for name in names:
        load, kind, part, _ = split_key(name)
        title = "load cases" if load else kind if part else ""
        kinds.setdefault(title, []).append(name)
    lines: list[str] = []
    for title, listed in kinds.items():
        lines += _grid(values, listed, title) if title else _listed(values, listed)
    return "\n".join(lines)


def _listed(values: Mapping[str, float], names: list[str]) -> Iterator[str]:
    """Figures one below the other by topic, with as much of the meaning as fits."""
    rows = [(name, figure_of(name).show(values[name]), figure_of(name).meaning) for name in names]
    name_width, value_width = (max(len(row[i]) for row in rows) for i in (0, 1))
    space = _WIDTH - name_width - value_width - 6
    cells = {row[0]: (*row[:2], shorten(row[2], space, placeholder=" ...")) for row in rows}
    lines = dict(zip(cells, table(list(cells.values())).splitlines(), strict=True))
    for topic, listed in by_topic(names).items():
        yield topic
        yield from (lines[name] for name in listed)


def _grid(values: Mapping[str, float], names: list[str], title: str) -> Iterator[str]:
    """Figures over parts: columns that do not fit next to each other follow below."""
    cells: dict[tuple[str, str], tuple[str, str]] = {}
    numbers = _numbers(values, names)
    for name in names:
        load, kind, part, figure = split_key(name)
        column = f"{kind}.{part} {figure}" if part else figure
        place = (load, column) if load else (part, figure)
        cells[place[::-1] if title in _FIGURES_DOWN else place] = numbers[name]
    rows, columns = (list(dict.fromkeys(key[i] for key in cells)) for i in (0, 1))
    units = {key[title not in _FIGURES_DOWN]: unit for key, (_, unit) in cells.items()}
    heads = {
        label: [*label.split(" "), *([f"[{units[label]}]"] if units.get(label) else [])]
        for label in (*rows, *columns)
    }
    labels = [f"  {' '.join(heads[row])}" for row in rows]
    deepest = max(len(heads[column]) for column in columns)
    block: list[list[str]] = []
    for column in columns:
        head = [""] * (deepest - len(heads[column])) + heads[column]
        block.append([*head, *(cells.get((row, column), ("-", ""))[0] for row in rows)])
    first = [title[:1].upper() + title[1:], *[""] * (deepest - 1), *labels]
    yield from _side_by_side(first, block)


def _side_by_side(first: list[str], columns: list[list[str]]) -> Iterator[str]:
    """Right-aligned columns behind the first one, as many as fit in each block; no empty rows."""
    widths = [max(map(len, column)) + 2 for column in columns]
    label_width = max(map(len, first))
    start = 0
    while start < len(columns):
        end, width_used = start, label_width
        while end < len(columns) and (end == start or width_used + widths[end] <= _WIDTH):
            width_used += widths[end]
            end += 1
        for number, label in enumerate(first):
            cells = [column[number] for column in columns[start:end]]
            if any(cell != "-" for cell in cells):
                row = "".join(map(str.rjust, cells, widths[start:end]))
                yield label.ljust(label_width) + row
        start = end


def _numbers(values: Mapping[str, float], names: list[str]) -> dict[str, tuple[str, str]]:
    """Five digits and the unit of each value, zero where it is rounding next to the others."""
    split = {name: figure_of(name).show(values[name]).partition(" ") for name in names}
    greatest: dict[str, float] = {}
    for number, _, unit in split.values():
        greatest[unit] = max(greatest.get(unit, 0.0), abs(float(number)))
    return {
        name: (_digits(float(number), _ROUNDING * greatest[unit]), unit)
        for name, (number, _, unit) in split.items()
    }


def _digits(value: float, rounding: float) -> str:
    """Five digits, of greater numbers all before the point."""
    return f"{float(f'{value:.5g}'):.9g}" if abs(value) > rounding else "0"
