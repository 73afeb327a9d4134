"""The directory of a machine: all loads with their mesh tables and motions, and back."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, ModelWarning, TribodynError, collected
from tribodyn.gear import Misalignment
from tribodyn.interrupt import single_blas_thread
from tribodyn.record import Parts, labels_of
from tribodyn.study.machine.housing_files import copy_housing
from tribodyn.study.machine.motion import MachineMotion
from tribodyn.study.machine.result import LoadResult, MachineResult
from tribodyn.validated_files import read_bytes, read_dataset, write_dataset

if TYPE_CHECKING:
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.load_cases import LoadCase

#: The file with the motion at the operating point, and the checksums of all others.
MOTION = "motion.nc"
#: Before the names of the files of the housing.
HOUSING = "housing-"
_REMEDY = "Give the directory that tribodyn run or MachineResult.save wrote"


def write_machine(result: MachineResult, place: Path) -> None:
    """Write case, summary, mesh tables and motions of all loads; without the report."""
    case = copy_housing(result.case, place, HOUSING)
    texts = {
        "case.toml": case.to_toml(),
        "summary.json": json.dumps(result.summary(), indent=2, allow_nan=False) + "\n",
    }
    for name, text in texts.items():
        (place / name).write_text(text, encoding="utf-8")
    for number, load in reversed(list(enumerate((result.operation, *result.load_cases)))):
        values = {
            name: asdict(value) if isinstance(value, Misalignment) else value
            for name, value in load.misalignment.items()
        }
        facts = {"misalignment": json.dumps(values)}
        files: dict[int, str] = {}  # planets with equal teeth have one table
        for mesh, (name, table) in enumerate(load.tables.items()):
            if id(table) not in files:
                files[id(table)] = _table_file(number, mesh, name)
                table.save(place / files[id(table)])
        facts["tables"] = json.dumps({n: files[id(table)] for n, table in load.tables.items()})
        if number == 0:  # written last: it has the checksums of the others
            warnings = [(warning.code, warning.message) for warning in result.warnings]
            others = {path.name: _checksum(path) for path in sorted(place.iterdir())}
            facts |= {"warnings": json.dumps(warnings), "files": json.dumps(others)}
        parts = load.motion._parts()
        stored = Parts(parts.variables, parts.coordinates, {**parts.attributes, **facts})
        write_dataset(stored, place / _motion_file(number))


def read_machine(
    folder: Path,
    load_case: Callable[[Path], Any],
    read_summary: Callable[[Path], dict[str, float]],
) -> MachineResult:
    """Read the result of a machine; its matrices are assembled again, its motion is stored."""
    data = read_dataset(folder / MOTION, str(folder))
    try:
        _check_files(folder, json.loads(data.attrs["files"]))
        case: MachineCase = load_case(folder / "case.toml")
        summary = read_summary(folder)
        with collected(), single_blas_thread():
            loads = [
                _read_load(case, load, folder, number, summary)
                for number, load in enumerate((case.operating_point, *case.load_cases))
            ]
        warnings = tuple(ModelWarning(*each) for each in json.loads(data.attrs["warnings"]))
    except TribodynError:
        raise
    # What a damaged file holds makes its readers stumble in many ways.
    except Exception as error:
        why = f"{error or type(error).__name__}: it is damaged, or an earlier version wrote it"
        remedy = f"Compute it again: tribodyn run {folder / 'case.toml'}"
        raise InputError("this result cannot be read back", str(folder), why, remedy) from None
    result = MachineResult(case, loads[0], tuple(loads[1:]), warnings)
    vars(result)["_summary"] = summary
    return result


def _check_files(folder: Path, checksums: dict[str, str]) -> None:
    """Refuse files that lack, or that differ from those with which the result was written."""
    for name, checksum in checksums.items():
        if not (folder / name).is_file():
            raise InputError("this is no result", str(folder), f"It holds no {name}", _REMEDY)
        if _checksum(folder / name) != checksum:
            why = f"{name} is of another, or was damaged or changed after it was written"
            raise InputError("these files are of different results", str(folder), why, _REMEDY)


def _read_load(
    case: MachineCase, load: LoadCase, folder: Path, number: int, summary: dict[str, float]
) -> LoadResult:
    from tribodyn.machine import system as system_of
    from tribodyn.mesh import MeshTable
    from tribodyn.study.machine.run import static_with_teeth, structure_of

    data = read_dataset(folder / _motion_file(number), str(folder))
    misalignment = {
        name: Misalignment(**value) if isinstance(value, dict) else value
        for name, value in json.loads(data.attrs["misalignment"]).items()
    }
    names = {name: _table_file(number, mesh, name) for mesh, name in enumerate(misalignment)}
    names |= json.loads(data.attrs.get("tables", "{}"))
    stored = {file: MeshTable.load(folder / file) for file in dict.fromkeys(names.values())}
    tables = {name: stored[file] for name, file in names.items()}
    static = static_with_teeth(case, load, tables, misalignment)
    structure = structure_of(case, static.linearized())
    system, motion = system_of(structure), _motion(data)
    result = LoadResult(load, structure, static, tables, misalignment, system, motion)
    prefix = f"load_cases.{load.name}."
    vars(result)["figures"] = {
        key.removeprefix(prefix): value
        for key, value in summary.items()
        if (key.startswith(prefix) if number else not key.startswith("load_cases."))
    }
    return result


def _motion(data: Any) -> MachineMotion:
    """Motion from its data set."""
    values: dict[str, Any] = {}
    for name, labels in labels_of(MachineMotion).items():
        if not labels.dims:
            values[name] = float(data.attrs[name])
        elif name in ("mesh", "bearing", "node"):
            values[name] = tuple(map(str, data[name].values)) if name in data else ()
        else:
            values[name] = np.asarray(data[name].values)
    return MachineMotion(**values)


def _checksum(path: Path) -> str:
    return hashlib.sha256(read_bytes(path, "netcdf")).hexdigest()


def _motion_file(number: int) -> str:
    return f"load-{number}-motion.nc" if number else MOTION


def _table_file(number: int, mesh: int, name: str) -> str:
    """Name of the file of a mesh table; a mesh may have a name that no file can have."""
    plain = name if name.replace("_", "").replace("-", "").isalnum() else str(mesh + 1)
    return f"load-{number}-mesh-{plain}.nc" if number else f"mesh-{plain}.nc"
