"""Read a case file of any kind: a pair of gears, or a machine, which may be one stage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.errors import InputError
from tribodyn.model import NO_OPTIONS
from tribodyn.study.case.read import changed_file, parse_toml, source_of
from tribodyn.study.case.section import file_keys, flat_keys
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.tables import HousingTable
from tribodyn.study.machine.unused_keys import changed_machine

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case


_OF_HOUSING = tuple(name for name, option in HousingTable.specs() if option.kind == "file")


def is_machine(data: Mapping[str, Any]) -> bool:
    """Whether tables of a case file describe a machine rather than a pair."""
    return any(group in data for group in ("shafts", "meshes", "bearings", "planets"))


def machine_files(data: Mapping[str, Any]) -> list[str]:
    """Files that the tables of a machine name, without opening them."""
    names = {*_OF_HOUSING, *(key.rpartition(".")[2] for key in file_keys())}
    return [
        value
        for key, value in flat_keys(data)
        if key.rpartition(".")[2] in names and isinstance(value, str)
    ]


def read_any_case(
    text: str,
    name: str = "",
    folder: Path | None = None,
    changes: Mapping[str, Any] = NO_OPTIONS,
    by: str = "",
) -> Case | MachineCase:
    """Check the text of a case file of any kind, with values replaced by dotted key."""
    try:
        return _read(parse_toml(text, name), text, name, folder, changes, by)
    except InputError as error:
        # Some checks of parts know neither the file nor its lines.
        raise InputError(
            [
                problem
                if str(problem.where).startswith((name, by or name, "--"))
                else replace(problem, where=f"{name}: {problem.where}".removesuffix(": "))
                for problem in error.problems
            ]
        ) from error


def _read(
    data: dict[str, Any],
    text: str,
    name: str,
    folder: Path | None,
    changes: Mapping[str, Any],
    by: str,
) -> Case | MachineCase:
    if not is_machine(data):
        return changed_file(text, name, changes, by)
    place = Path(name).parent if folder is None else folder
    faults = data.get("faults")
    tables: list[tuple[Any, tuple[str, ...]]] = [(data.get("housing"), _OF_HOUSING)]
    tables += [
        (table, ("file",)) for table in (faults.values() if isinstance(faults, dict) else ())
    ]
    for table, keys in tables:
        for key in keys if isinstance(table, dict) else ():
            if isinstance(table.get(key), str):
                table[key] = str((place / table[key]).absolute())
    source = source_of(text, name).with_replaced(changes, by)
    return MachineCase(source, **changed_machine(data, changes, by=by))
