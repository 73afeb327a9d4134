"""Keys of machines and planetary stages, for ``explain``, the documentation and files to start."""

from __future__ import annotations

from collections.abc import Iterator

from tribodyn.machine import ROLLING_BEARINGS
from tribodyn.model import Option
from tribodyn.study.case.rating_tables import PartRating
from tribodyn.study.case.reference import default_of, key_tables, start_toml, walk
from tribodyn.study.case.section import Section, Table, section_at
from tribodyn.study.machine.tables import SHARED, HypoidMeshTable, rolling_options
from tribodyn.study.machine_tables import MachineTables

#: Files to start from.
STARTS = ("machine", "stage", "hypoid")


def machine_keys() -> Iterator[tuple[str, Option, str]]:
    """Iterate over the keys of parts with their tables; NAME stands for that of a part."""
    for group, field in MachineTables.fields.items():
        if isinstance(field, Table) and group not in SHARED:
            yield from walk(field.kind, (group,))
        if group == "rating":
            yield from walk(PartRating, (group,))
        if group == "bearings":
            yield from _rolling_keys(group)
        if group == "meshes":
            yield from walk(HypoidMeshTable, (group, 'NAME with kind = "hypoid"'))


def _rolling_keys(group: str) -> Iterator[tuple[str, Option, str]]:
    """Keys of each type of rolling bearings."""
    for kind, law in ROLLING_BEARINGS.all().items():
        for name, option in rolling_options(law).items():
            yield f'{group}.NAME with type = "{kind}".{name}', option, default_of(option)


def machine_tables() -> str:
    """Format the keys of parts as Markdown tables."""
    return key_tables(machine_keys())


def start_of(kind: str) -> str:
    """Return a short case file of a machine, a stage or a hypoid pair, to be filled in."""
    return start_toml(f"start_{kind}", _section)


def _section(path: tuple[str, ...]) -> type[Section] | None:
    """Table of a case of parts or of a pair at a path."""
    pair = path[0] == "gears" and path[1:] in ((), ("pinion",), ("wheel",))
    return section_at(path, None if pair else MachineTables) or section_at(path)
