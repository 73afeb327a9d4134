"""Tables of a machine as the user gives them: values, changes, reasons, and the file."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from copy import deepcopy
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.errors import InputError
from tribodyn.study.case.provenance import Assumption
from tribodyn.study.case.values import FaultError, Plain, read_value
from tribodyn.study.machine.read_parts import in_si
from tribodyn.study.machine.tables import unit_of

if TYPE_CHECKING:
    from tribodyn.study.machine.case import MachineCase


def changed_tables(
    tables: Mapping[str, Any], changes: Mapping[str, Any], *, by: str = ""
) -> dict[str, Any]:
    """Tables with values changed by dotted key, and without reasons for the former values."""
    data = deepcopy(dict(tables))
    for key, value in changes.items():
        *names, name = key.split(".")
        table = data
        for each in names:
            table = table.setdefault(each, {})
            if not isinstance(table, dict):
                why, remedy = f"{each} is not a table", "Correct the key"
                raise InputError(f"{key} = {value!r}", key, why, remedy)
        if value is None:
            table.pop(name, None)
        else:
            table[name] = value if by else in_si(value)
    if isinstance(reasons := data.get("assumed"), Mapping):
        data["assumed"] = {k: why for k, why in reasons.items() if k not in changes}
    return data


def stated_assumptions(data: Mapping[str, Any]) -> Iterator[Assumption]:
    """Reasons in ``[assumed]`` with the values they refer to."""
    for key, why in data.get("assumed", {}).items():
        *names, name = key.split(".")
        value: Any = data
        for each in (*names, name):
            value = value.get(each) if isinstance(value, Mapping) else None
        blank = value is None or isinstance(value, Mapping)
        text = "" if blank else written_value(value, unit_of((*names, name))).strip('"')
        yield Assumption(key, text, "assumed", why)


def default_assumptions(case: MachineCase) -> Iterator[Assumption]:
    """What the case does not give, and what is estimated in its place."""
    for name, shaft in case.shafts.items():
        if shaft.is_rigid:
            why = "a shaft without sections"
            yield Assumption(f"shafts.{name}", "rigid", "default", why)
    for name, bearing in case.bearings.items():
        if bearing.is_default:
            why = "a bearing without stiffness or type is stiff"
            yield Assumption(f"bearings.{name}", "1e9 N/m", "default", why)
        for key, value, why in _estimates(getattr(bearing.rolling, "assumptions", ())):
            yield Assumption(f"bearings.{name}.{key}", value, "default", why)
    if case.housing is None:
        yield Assumption("housing", "rigid", "default", "without [housing]")


def _estimates(texts: Iterable[str]) -> Iterator[tuple[str, str, str]]:
    """Key, value and reason of estimates such as ``balls = 8, estimated: usual filling``."""
    for text in texts:
        key, _, value_and_reason = text.partition(" = ")
        value, _, why = value_and_reason.partition(", ")
        yield key, value, why


def user_values(case: MachineCase) -> Iterator[tuple[str, Any]]:
    """Dotted keys and values in SI of what the case gives."""
    for key, value in flat_keys(case.data):
        option, name = case.option_of(key), key.rpartition(".")[2]
        if option is not None and option.kind == "file":
            yield key, Path(str(value)).name
            continue
        try:
            yield key, read_value(option, name, value) if option is not None else _plain(value)
        except FaultError:  # a list of values, or a text in place of a number
            yield key, _plain(value)


def flat_keys(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted keys of nested tables with their values."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from flat_keys(value, f"{prefix}{name}.")
        elif isinstance(value, list | tuple) and value and isinstance(value[0], Mapping):
            for number, row in enumerate(value):
                yield from flat_keys(row, f"{prefix}{name}.{row.get('name', number + 1)}.")
        else:
            yield f"{prefix}{name}", value


def _plain(value: Any) -> Any:
    """A value as text or number, lists as tuples."""
    value = value.value if isinstance(value, Plain) else value
    return tuple(map(_plain, value)) if isinstance(value, list | tuple) else value


def with_spreads(tables: Mapping[str, Any], spreads: Mapping[str, str]) -> dict[str, Any]:
    """Tables with the texts of values that have a spread."""
    data = deepcopy(dict(tables))
    for key, text in spreads.items():
        *names, name = key.split(".")
        table = data
        for each in names:
            table = table[each]
        table[name] = text
    return data


def machine_toml(data: Mapping[str, Any]) -> str:
    """Write nested tables of a machine; values are as they were given."""
    return "\n".join(_lines(data, ())).strip() + "\n"


def _lines(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    values = {k: v.value if isinstance(v, Plain) else v for k, v in table.items()}
    inner = {k: v for k, v in values.items() if isinstance(v, Mapping)}
    rows = {k: v for k, v in values.items() if _is_rows(v)}
    for name, value in table.items():
        if name not in inner and name not in rows and values[name] is not None:
            yield f"{_key(name)} = {written_value(value, unit_of((*path, name)))}"
    for name, body in inner.items():
        place = (*path, name)
        if not body or any(not isinstance(v, Mapping) for v in body.values()):
            yield f"\n[{'.'.join(map(_key, place))}]"
        yield from _lines(body, place)
    for name, bodies in rows.items():
        for body in bodies:
            yield f"\n[[{'.'.join(map(_key, (*path, name)))}]]"
            yield from _lines(body, (*path, name))


def _is_rows(value: Any) -> bool:
    listed = isinstance(value, list | tuple) and len(value) > 0
    return listed and all(isinstance(item, Mapping) for item in value)


def _key(name: str) -> str:
    return name if name.replace("_", "").replace("-", "").isalnum() else json.dumps(name)


def written_value(value: Any, unit: str) -> str:
    """Text of a value; a number in SI, as Python gives it, with its unit."""
    if isinstance(value, Plain) and isinstance(value.value, list | tuple):
        value = [Plain(item) for item in value.value]
    if isinstance(value, Plain):
        number = isinstance(value.value, float | int) and not isinstance(value.value, bool)
        return f'"{value.value!r} {unit}"' if number and unit else written_value(value.value, "")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return f"[{', '.join(written_value(item, unit) for item in value)}]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
