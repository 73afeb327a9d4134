"""Read a case file of any kind: a pair of gears, or a machine, which may be one stage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from tribodyn.errors import InputError
from tribodyn.model import NO_OPTIONS
from tribodyn.study.case.read import parse_toml, source_of
from tribodyn.study.case.section import file_entries, place_files
from tribodyn.study.machine.case import AnyCase, MachineCase


def kind_of_tables(data: Mapping[str, Any]) -> type[AnyCase]:
    """Class of the case that tables describe."""
    return MachineCase._kind_of(data)  # type: ignore[return-value]


def files_of(data: dict[str, Any]) -> list[str]:
    """Files that the tables of a case name, without opening them."""
    return [table[name] for table, name, _ in file_entries(kind_of_tables(data).root, data)]


def read_case(
    text: str,
    name: str = "",
    folder: Path | None = None,
    changes: Mapping[str, Any] = NO_OPTIONS,
    by: str = "",
) -> Any:
    """Check the text of a case file of any kind.

    Parameters
    ----------
    text : str
        TOML text.
    name : str
        File name, for messages.
    folder : Path, optional
        Where the files lie that the case names; the folder of ``name`` by default.
    changes : mapping
        Values that replace those of the text, by dotted key.
    by : str
        Source of the changes, for messages.

    Returns
    -------
    Case

    Raises
    ------
    InputError
        Listing every problem of the file.

    Examples
    --------
    >>> try:
    ...     read_case("title = 'x'", "my.toml")
    ... except InputError as error:
    ...     print(error.problems[0])
    my.toml: gears: the table [gears] is missing. The case cannot be computed without it. \
Add it with normal_module, normal_pressure_angle, driver, pinion, wheel.
    """
    data = parse_toml(text, name)
    if not data and not changes:
        why, remedy = "A case needs gears, speed and torque", "tribodyn new my.toml"
        remedy = f"Create a case to start from: {remedy}"
        raise InputError("the file has no values", name, why, remedy)
    kind, place = kind_of_tables(data), Path(name).parent if folder is None else folder
    place_files(kind.root, data, place)
    source = source_of(text, name).with_replaced(changes, by)
    try:
        return kind(source, **(kind._changed_tables(data, changes, by=by) if changes else data))
    except InputError as error:
        # Some checks of parts know neither the file nor its lines.
        prefixes = (name, by or name, "--")
        raise InputError(
            [
                problem
                if str(problem.where).startswith(prefixes)
                else replace(problem, where=f"{name}: {problem.where}".removesuffix(": "))
                for problem in error.problems
            ]
        ) from error
