"""Folder of a result: case, summary, mesh tables and motions of all loads, and back."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.drawing import write_report_of
from tribodyn.errors import InputError, ModelWarning, TribodynError, collected
from tribodyn.interrupt import single_blas_thread
from tribodyn.model import Option
from tribodyn.record import Parts
from tribodyn.study.case.provenance import same
from tribodyn.study.case.section import Section, Table, table_in
from tribodyn.study.pipeline.save import new_directory
from tribodyn.study.pipeline.summary_figures import Figures, in_order, is_figure
from tribodyn.types import ByName, Tree
from tribodyn.validated_files import read_bytes, read_dataset, write_dataset

if TYPE_CHECKING:
    import xarray

    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.pipeline.result_of_case import ResultOfCase

#: Names of the files of a motion: of parts by name, and of a pair.
MOTIONS = ("motion", "response")
_REMEDY = "Give the directory that tribodyn run or the save method of a result wrote"


class StoredLoad(NamedTuple):
    """Mesh tables and motion of one load in a folder."""

    tables: dict[str, MeshTable]
    data: xarray.Dataset


class Stored(NamedTuple):
    """What a folder of a result holds."""

    motion: str  #: name of the files of its motions, which says of what kind it is
    summary: Figures
    warnings: tuple[ModelWarning, ...]
    loads: list[StoredLoad]


def table_stem(load: int, place: int, mesh: str, only: str, sep: str = "-") -> str:
    """Name of the file of a mesh table; a mesh may have a name that no file can have."""
    plain = mesh if mesh.replace("_", "").replace("-", "").isalnum() else str(place + 1)
    return f"{_of_load(load, sep)}mesh" + (f"{sep}{plain}" if mesh != only else "")


def _of_load(load: int, sep: str = "-") -> str:
    return f"load{sep}{load}{sep}" if load else ""


def write_result(
    result: ResultOfCase, directory: str | os.PathLike[str], *, force: bool, csv: bool
) -> Path:
    """Write case, summary, mesh tables, motions and report into a new directory."""
    import tribodyn

    target = Path(directory)
    with single_blas_thread(), new_directory(target, force=force) as place:
        texts = {
            "case.toml": result._case_in(place).to_toml(),
            "summary.json": json.dumps(result.summary(), indent=2, allow_nan=False) + "\n",
        }
        for name, text in texts.items():
            (place / name).write_text(text, encoding="utf-8")
        for number, load in reversed(list(enumerate(result.loads.values()))):
            files: dict[int, str] = {}  # planets with equal teeth have one table
            for mesh, (name, table) in enumerate(load.tables.items()):
                if id(table) not in files:
                    files[id(table)] = f"{table_stem(number, mesh, name, result._MESH)}.nc"
                    table.save(place / files[id(table)])
            parts: Parts = load._stored()
            facts = {"tables": json.dumps({n: files[id(t)] for n, t in load.tables.items()})}
            if number == 0:  # written last: it has the checksums of the others
                others = {path.name: _checksum(path) for path in sorted(place.iterdir())}
                warning_texts = [(warning.code, warning.message) for warning in result.warnings]
                facts |= {"warnings": json.dumps(warning_texts), "files": json.dumps(others)}
                facts["version"] = tribodyn.__version__
                facts["defaults"] = json.dumps(defaults_of(result.case))
            stored_parts = Parts(parts.variables, parts.coordinates, {**parts.attributes, **facts})
            write_dataset(stored_parts, place / f"{_of_load(number)}{result._MOTION}.nc")
        if csv:
            (place / "response.csv").write_text(result.to_csv(), encoding="utf-8")
        write_report_of(result, place / "report.html")
    return target


@contextmanager
def readable(folder: Path) -> Iterator[None]:
    """Refuse a folder whose files make their readers stumble."""
    try:
        with collected(), single_blas_thread():
            yield
    except TribodynError:
        raise
    # What a damaged file holds makes its readers stumble in many ways.
    except Exception as error:
        why = f"{str(error) or type(error).__name__}: it is damaged, or an earlier version wrote it"
        remedy = f"Compute it again: tribodyn run {folder / 'case.toml'}"
        raise InputError("this result cannot be read back", str(folder), why, remedy) from None


def read_stored(folder: Path) -> Stored:
    """Read what the folder of a result holds, in the layout of this and of the last version."""
    from tribodyn.mesh import MeshTable

    summary, motion = read_summary(folder), _motion_of(folder)
    data = read_dataset(folder / f"{motion}.nc", str(folder))
    _check_files(folder, summary, data.attrs)
    loads: list[StoredLoad] = []
    while not loads or (folder / f"{_of_load(len(loads))}{motion}.nc").is_file():
        number = len(loads)
        if number:
            data = read_dataset(folder / f"{_of_load(number)}{motion}.nc", str(folder))
        files: dict[str, str] = json.loads(data.attrs.get("tables", '{"mesh": "mesh.nc"}'))
        tables = {file: MeshTable.load(folder / file) for file in dict.fromkeys(files.values())}
        loads.append(StoredLoad({name: tables[file] for name, file in files.items()}, data))
    first = loads[0].data.attrs
    model_warnings = tuple(ModelWarning(*each) for each in json.loads(first["warnings"]))
    return Stored(motion, summary, model_warnings, loads)


def defaults_of(case: Any) -> Tree:
    """Values in SI of the keys that a case leaves to defaults, also in the pairs of its meshes."""
    keys = _left_out(case.root, case.data, case.lumped)
    if case.lumped:
        values = {key: case._effective.get(key) for key in keys}
    else:
        values = {key: case._default_of(key) for key in keys}
        for _, pair, _ in case.mesh_pairs():
            of_pair = {pair.source.key(key): value for key, value in defaults_of(pair).items()}
            values |= {k: v for k, v in of_pair.items() if case.option_of(k) is not None}
    return {key: value for key, value in values.items() if value is not None}


def _left_out(root: type[Section], data: ByName, models: bool, prefix: str = "") -> Iterator[str]:
    """Keys that have no value in tables, with ``models`` also in tables of models that lack."""
    keys, chosen = dict(root.keys_for(data)), data.get(root.selector)
    default = keys.get(root.selector)
    if isinstance(default, Option) and (model := root.model_named(chosen or default.default)):
        keys |= model.case_options
    for name, field in keys.items():
        if not isinstance(field, Table):
            if data.get(name) is None:
                yield f"{prefix}{name}"
        elif name in data or (field.default == "empty" and (models or not field.kind.selector)):
            yield from _left_out(field.kind, table_in(data, name), models, f"{prefix}{name}.")


def as_computed(case: Case, stored: Stored) -> Case:
    """Case with the defaults with which another version computed its stored result."""
    then = json.loads(stored.loads[0].data.attrs.get("defaults", "{}"))
    now = json.loads(json.dumps(defaults_of(case) if then else {}))
    for key in [key for key in then if key in now and not same(now[key], then[key])]:
        with suppress(InputError):  # it has no effect in this case
            case = case.replace({key: then[key]})
    return case


def figures_of_load(summary: Mapping[str, float], load: str = "") -> Figures:
    """Figures of a load case by its name, of the operating point without one."""
    start = f"load_cases.{load}." if load else ""
    return Figures(
        (key.removeprefix(start), value)
        for key, value in summary.items()
        if (key.startswith(start) if start else not key.startswith("load_cases."))
    )


def _motion_of(folder: Path) -> str:
    """Name of the files of the motions in a folder."""
    return next((name for name in MOTIONS if (folder / f"{name}.nc").is_file()), MOTIONS[-1])


def _check_files(folder: Path, summary: Mapping[str, float], facts: Mapping[str, object]) -> None:
    """Refuse files that lack, or that differ from those with which the result was written."""
    checksums: dict[str, str] = json.loads(str(facts.get("files", "{}")))
    for name in checksums:
        _require(folder, name)
    changed = [name for name, checksum in checksums.items() if _checksum(folder / name) != checksum]
    # The last version wrote the figures of a pair into the file of the motion in their place.
    if not checksums and any(facts.get(name, value) != value for name, value in summary.items()):
        changed = ["summary.json"]
    if changed:
        why = f"{changed[0]} is of another, or was damaged or changed after it was written"
        raise InputError("these files are of different results", str(folder), why, _REMEDY)


def _checksum(path: Path) -> str:
    return hashlib.sha256(read_bytes(path, "netcdf")).hexdigest()


def _require(folder: Path, name: str) -> None:
    """Refuse a folder without a file of a result."""
    if not (folder / name).is_file():
        why = f"It holds no {name}" if folder.is_dir() else "There is no such directory"
        raise InputError("this is no result", str(folder), why, _REMEDY)


def read_summary(folder: Path) -> Figures:
    """Figures of a saved result, from a directory that holds all of its files."""
    place = folder / "summary.json"
    for name in (f"{_motion_of(folder)}.nc", "case.toml", "summary.json"):
        _require(folder, name)
    try:
        entries = json.loads(read_bytes(place, "case"))
        if not isinstance(entries, dict) or not entries:
            raise ValueError("It is no table of figures")
        figures = {name: float(value) for name, value in entries.items()}
        if wrong := [n for n, v in figures.items() if not np.isfinite(v)]:
            raise ValueError(f"It has {wrong[0]} = {figures[wrong[0]]}")
        if unknown := [name for name in figures if not is_figure(name)]:
            raise ValueError(f"It has a figure that this version does not know, {unknown[0]}")
    except (OSError, TypeError, ValueError, RecursionError) as error:
        remedy = "Compute the case again"
        raise InputError("cannot be read", str(place), str(error), remedy) from None
    return Figures((name, figures[name]) for name in in_order(figures))
