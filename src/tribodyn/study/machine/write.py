"""Write the tables of a machine as TOML."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from tribodyn.study.case.values import Plain
from tribodyn.study.machine.tables import unit_of


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
