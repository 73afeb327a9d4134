"""Values changed by dotted key in the tables of a case, and what that leaves without effect."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem, did_you_mean
from tribodyn.model import NO_OPTIONS, Option
from tribodyn.study.case.section import (
    NamedTables,
    Section,
    Table,
    named_rows,
    section_at,
    table_in,
)
from tribodyn.study.case.user_input import UserInput, plain
from tribodyn.study.case.values import Plain, unmarked

#: Keys other than model names whose choice decides which keys of their table are allowed.
_DECIDES = ("solver.method",)


def changed_tables(
    root: type[Section],
    data: Mapping[str, Any],
    changes: Mapping[str, Any],
    spread: Mapping[str, str] = NO_OPTIONS,
    by: str = "",
) -> dict[str, Any]:
    """Tables with values changed by dotted key; without ``by`` the values are those of Python."""
    changes = changes if by else plain(changes)
    if problems := list(_missing_parts(root, data, changes)):
        by = by or "replace:"
        raise InputError([replace(p, where=f"{by} {p.where}") for p in problems])
    dropped = _dropped_options(root, UserInput(data), changes)
    spread_values = {key: text for key, text in spread.items() if key not in dropped}
    tables = with_values(data, {**spread_values, **dict.fromkeys(dropped), **changes})
    if isinstance(marks := tables.get("assumed"), Mapping):
        stale = {*changes, *dropped}
        tables["assumed"] = {key: why for key, why in marks.items() if key not in stale}
    return tables


def with_values(data: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy of tables with dotted keys set, of lists and their rows too; None removes."""
    result: dict[str, Any] = _copy(data)
    for key, value in values.items():
        *tables, name = key.split(".")
        table: Any = result
        for depth, each in enumerate(tables, 1):
            inner = table.setdefault(each, {}) if isinstance(table, dict) else table
            if depth == len(tables) and name.isdigit() and _is_list(inner, table):
                table[each] = _with_element(inner, table, key, value)
                break
            rows = dict(named_rows(table))
            table = rows.get(each) if rows else inner
            if not isinstance(table, dict) and not named_rows(table):
                raise InputError(f"{each} is a value, not a table", key, "", "Correct the key")
        else:
            if unmarked(value) is None:
                table.pop(name, None)
            else:
                table[name] = value
    return result


def _copy(data: Any) -> Any:
    if isinstance(data, Mapping):
        return {key: _copy(value) for key, value in data.items()}
    return [_copy(row) for row in data] if named_rows(data) else data


def _is_list(value: Any, table: Mapping[str, Any]) -> bool:
    """Whether a value is a list of values, or the list of the planets that is not given."""
    value = value.value if isinstance(value, Plain) else value
    return isinstance(value, list | tuple) or (value == {} and "count" in table)


def _with_element(value: Any, table: dict[str, Any], key: str, item: Any) -> list[Any]:
    """List with a value changed; of planets one that is missing has zeros."""
    *_, name, number = key.split(".")
    if value == {}:
        value = [Plain(0.0)] * int(unmarked(table["count"]))
    if isinstance(value, Plain):
        value = [Plain(each) for each in np.atleast_1d(value.value).tolist()]
    if not 1 <= int(number) <= len(value) or unmarked(item) is None:
        why = f"{name} has {len(value)} values, counted from 1"
        raise InputError(f'there is no value "{key}"', key, why, "Correct the number in the key")
    return [*value[: int(number) - 1], item, *value[int(number) :]]


def _missing_parts(
    root: type[Section], data: Mapping[str, Any], changes: Mapping[str, Any]
) -> Iterator[Problem]:
    """Report keys of parts that do not exist, and that the changes do not give as a whole."""
    for key in changes:
        group, name, inner = (*key.split(".", 2), "", "")[:3]
        section, parts = section_at((group,), root), table_in(data, group)
        if not inner or name in parts or not section or not issubclass(section, NamedTables):
            continue
        part = section.fields["NAME"]
        assert isinstance(part, Table)
        needed = [k for k, o in part.kind.fields.items() if isinstance(o, Option) and o.required]
        absent = [each for each in needed if f"{group}.{name}.{each}" not in changes]
        if absent or section.listed:
            what = f'there is no {part.meaning.partition(" ")[2]} "{name}"'
            remedy = "Correct the name"
            remedy += f", or give also {', '.join(absent)} of a new one" if absent else ""
            why = f"Known: {', '.join(parts) or 'none'}"
            yield Problem(what, key, why, did_you_mean(name, list(parts), remedy))


def _dropped_options(
    root: type[Section], inputs: UserInput, changes: Mapping[str, Any]
) -> list[str]:
    """Return the options that newly chosen models, laws and methods do not have."""
    dropped = []
    for key, value in changes.items():
        table, _, name = key.rpartition(".")
        section = section_at(tuple(table.split(".")), root) if table else None
        if section is None or not (name == section.selector or key in _DECIDES):
            continue
        spec = section.fields[name]
        assert isinstance(spec, Option)
        chosen = spec.default if unmarked(value) is None else unmarked(value)
        if spec.names is None or chosen not in spec.names():
            continue  # it is reported where it is read
        typed = [each for each in inputs.typed if each.rpartition(".")[0] == table]
        dropped += [
            each
            for each in typed
            if each not in changes and each != key and not _accepts(section, inputs, chosen, each)
        ]
    return dropped


def _accepts(section: type[Section], inputs: UserInput, chosen: str, key: str) -> bool:
    """Whether a table with a newly chosen model or method has a key."""
    model, option = section.model_named(chosen), key.rpartition(".")[2]
    if model is None:  # a method
        return chosen != "steady" or option != "cycles"
    if option == "stiffness" and hasattr(model, "stiffness_kinds"):
        return inputs.get(key) in model.stiffness_kinds
    return option not in section.section_keys().owners or option in model.case_options
