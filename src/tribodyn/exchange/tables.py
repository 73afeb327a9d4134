"""Tables and figures of a result as CSV and JSON, for spreadsheets and other programs."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.drawing import FIGURES, draw, figures_of
from tribodyn.errors import InputError, OutputExistsError
from tribodyn.files import atomic_write
from tribodyn.record import Record
from tribodyn.study import ResultOfCase
from tribodyn.study.pipeline.store import table_stem
from tribodyn.study.pipeline.summary_figures import figure_of
from tribodyn.validated_files import csv_text

#: Arrays of a curve of a figure that become columns.
_COLUMNS = ("x", "y", "z")
_nothing = "".format  # for a figure without conditions
Table = tuple[list[str], list[Sequence[Any]]]  # heads with units, columns


def write_tables(result: ResultOfCase | Record, folder: str | PathLike[str]) -> Path:
    """Write all tables and figures of a result into a new folder, as CSV and as JSON.

    Parameters
    ----------
    result : ResultOfCase or Record
        A computed or loaded result; also sweeps, bifurcations, maps and all other results with
        ``to_xarray``.
    folder : path
        New folder: ``summary``, ``mesh over ...``, ``motion over ...`` and ``figure ...``, each as
        ``.csv`` with units in the head and as ``.json``; figures in JSON are those of plotly. For
        results other than those of a run: ``table over ...`` and ``figure ...``. Figures for which
        the gears or the case have no data are left out.

    Raises
    ------
    OutputExistsError
        If the folder exists.
    InputError
        If the folder cannot be written.

    Values are in SI in tables, and as displayed in figures.
    """
    target = Path(folder)
    if target.exists():
        raise OutputExistsError("this exists already", str(folder), "", "Choose another name")
    if not target.absolute().parent.is_dir():
        raise InputError("there is no such directory", str(target.parent), "", "Create it")
    with atomic_write(target, folder=True) as place:
        place.mkdir(exist_ok=True)
        for name, table in _tables(result):
            (place / f"{name}.csv").write_text(_as_csv(table), encoding="utf-8")
            (place / f"{name}.json").write_text(_as_json(table), encoding="utf-8")
        for name in figures_of(result):
            if getattr(FIGURES[name], "missing", _nothing)(result):
                continue
            try:
                figure = draw(result, name)
            except InputError:  # needs gears of another kind, or a choice without a default
                continue
            (place / f"figure_{name}.json").write_text(figure.to_json(), encoding="utf-8")
            (place / f"figure_{name}.csv").write_text(_curves(figure), encoding="utf-8")
    return target


def _tables(result: ResultOfCase | Record) -> Iterator[tuple[str, Table]]:
    if not isinstance(result, ResultOfCase):
        yield from _of_data("table", result.to_xarray())
        return
    summary = result.summary()
    yield (
        "summary",
        (
            ["figure", "value", "unit", "meaning"],
            [
                list(summary),
                list(summary.values()),
                [figure_of(name).unit or "1" for name in summary],
                [figure_of(name).meaning for name in summary],
            ],
        ),
    )
    yield from _of_loads(result)


def _of_loads(result: ResultOfCase) -> Iterator[tuple[str, Table]]:
    """Mesh tables and signals of all loads; those of load cases by their number."""
    for number, load in enumerate(result.loads.values()):
        prefix = f"load_{number}_" if number else ""
        for place, (name, table) in enumerate(load.tables.items()):
            stem = table_stem(number, place, name, result._MESH, "_")
            yield from _of_data(stem, table.to_xarray())
        yield from _of_data(f"{prefix}motion", load.signals)


def _of_data(kind: str, data: Any) -> Iterator[tuple[str, Table]]:
    """One table for all variables over the same dimensions."""
    data = data if hasattr(data, "data_vars") else data.to_dataset(name=data.name or "value")
    groups: dict[tuple[str, ...], list[str]] = {}
    for name, variable in data.data_vars.items():
        groups.setdefault(tuple(map(str, variable.dims)), []).append(str(name))
    for dims, names in groups.items():
        if not dims:
            columns: list[Sequence[Any]] = [[data[name].values.item()] for name in names]
            yield f"{kind}_of_single_values", ([_head(name, data) for name in names], columns)
            continue
        frame = data[names].to_dataframe().reset_index()
        heads = [_head(str(column), data) for column in frame]
        yield f"{kind}_over_{'_and_'.join(dims)}", (heads, [frame[c].tolist() for c in frame])


def _head(name: str, data: Any) -> str:
    unit = data[name].attrs.get("units", "") if name in data.variables else ""
    return f"{name} [{unit}]" if unit not in ("", "1") else name


def _as_csv(table: Table) -> str:
    heads, columns = table
    return csv_text([heads, *zip(*columns, strict=True)])


def _as_json(table: Table) -> str:
    heads, columns = table
    plain = [[_plain(value) for value in column] for column in columns]
    return json.dumps(dict(zip(heads, plain, strict=True)), allow_nan=False, ensure_ascii=False)


def _plain(value: object) -> Any:
    """Value for JSON: None for NaN and infinity, text for complex and other values."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, str | int) else str(value)


def _curves(figure: Any) -> str:
    """All curves of a figure as CSV, one row for each point."""
    rows: list[Sequence[Any]] = [["curve", *_COLUMNS]]
    for trace in figure.data:
        arrays = [getattr(trace, name, None) for name in _COLUMNS]
        x, y, z = (None if each is None else np.asarray(each, dtype=object) for each in arrays)
        if z is not None and z.ndim == 2 and x is not None and y is not None:
            x, y = (np.resize(x, z.shape), np.repeat(y, z.shape[1])) if y.ndim == 1 else (x, y)
        columns = [each.ravel() for each in (x, y, z) if each is not None]
        length = max((each.size for each in columns), default=0)
        if any(each.size != length for each in columns):
            continue
        for row in zip(*columns, strict=True):
            rows.append([trace.name or "", *row, *[""] * (len(_COLUMNS) - len(row))])
    return csv_text(rows)
