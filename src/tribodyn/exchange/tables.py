"""Tables and figures of a result as CSV and JSON, for spreadsheets and other programs."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.drawing import FIGURES, draw, figures_of
from tribodyn.errors import InputError, OutputExistsError
from tribodyn.files import whole
from tribodyn.study import SUMMARY, Result

#: Arrays of a curve of a figure that become columns.
_COLUMNS = ("x", "y", "z")
_nothing = "".format  # what a figure without conditions lacks
Table = tuple[list[str], list[Sequence[Any]]]  # heads with units, columns


def write_tables(result: Result, folder: str | PathLike[str]) -> Path:
    """Write all tables and figures of a result into a new folder, as CSV and as JSON.

    Parameters
    ----------
    result : Result
        What was computed, or read back.
    folder : path
        Folder to make: ``summary``, ``mesh over ...``, ``motion over ...`` and ``figure ...``,
        each as ``.csv`` with units in the head and as ``.json``; figures as JSON are those of
        plotly.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    OutputExistsError
        If there is something of that name.
    InputError
        If the place cannot be written to.

    Values are in SI in tables, and as drawn in figures.
    """
    target = Path(folder)
    if target.exists():
        raise OutputExistsError("this exists already", str(folder), "", "Choose another name")
    if not target.absolute().parent.is_dir():
        raise InputError("there is no such directory", str(target.parent), "", "Create it")
    with whole(target, folder=True) as place:
        place.mkdir(exist_ok=True)
        for name, table in _tables(result):
            (place / f"{name}.csv").write_text(_as_csv(table), encoding="utf-8")
            (place / f"{name}.json").write_text(_as_json(table), encoding="utf-8")
        for name in figures_of(result):
            if getattr(FIGURES[name], "missing", _nothing)(result):
                continue
            figure = draw(result, name)
            (place / f"figure_{name}.json").write_text(figure.to_json(), encoding="utf-8")
            (place / f"figure_{name}.csv").write_text(_curves(figure), encoding="utf-8")
    return target


def _tables(result: Result) -> Iterator[tuple[str, Table]]:
    summary = result.summary()
    yield (
        "summary",
        (
            ["figure", "value", "unit", "meaning"],
            [
                list(summary),
                list(summary.values()),
                [SUMMARY[name].unit or "1" for name in summary],
                [SUMMARY[name].meaning for name in summary],
            ],
        ),
    )
    for kind, data in (("mesh", result.mesh.to_xarray()), ("motion", result.to_xarray())):
        groups: dict[tuple[str, ...], list[str]] = {}
        for name, variable in data.data_vars.items():
            groups.setdefault(tuple(map(str, variable.dims)), []).append(str(name))
        for dims, names in groups.items():
            frame = data[names].to_dataframe().reset_index()
            heads = [_head(str(column), data) for column in frame]
            yield f"{kind}_over_{'_and_'.join(dims)}", (heads, [frame[c].tolist() for c in frame])


def _head(name: str, data: Any) -> str:
    unit = data[name].attrs.get("units", "") if name in data.variables else ""
    return f"{name} [{unit}]" if unit not in ("", "1") else name


def _as_csv(table: Table) -> str:
    heads, columns = table
    held = io.StringIO()
    writer = csv.writer(held, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(zip(*columns, strict=True))
    return held.getvalue()


def _as_json(table: Table) -> str:
    heads, columns = table
    plain = [[None if value != value else value for value in column] for column in columns]
    return json.dumps(dict(zip(heads, plain, strict=True)), allow_nan=False, ensure_ascii=False)


def _curves(figure: Any) -> str:
    """The curves of a figure below each other, one row for each point."""
    held = io.StringIO()
    writer = csv.writer(held, lineterminator="\n")
    writer.writerow(["curve", *_COLUMNS])
    for trace in figure.data:
        given = [getattr(trace, name, None) for name in _COLUMNS]
        x, y, z = (None if each is None else np.asarray(each, dtype=object) for each in given)
        if z is not None and z.ndim == 2 and x is not None and y is not None:
            x, y = (np.resize(x, z.shape), np.repeat(y, z.shape[1])) if y.ndim == 1 else (x, y)
        columns = [each.ravel() for each in (x, y, z) if each is not None]
        length = max((each.size for each in columns), default=0)
        if any(each.size != length for each in columns):
            continue
        for row in zip(*columns, strict=True):
            writer.writerow([trace.name or "", *row, *[""] * (len(_COLUMNS) - len(row))])
    return held.getvalue()
