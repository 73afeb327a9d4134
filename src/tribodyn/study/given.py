"""The keys that the user gave, before any default: nested values addressed by dotted keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tribodyn.errors import InputError, Problem
from tribodyn.study.values import Plain, written


def plain(data: Any) -> Any:
    """Mark every value of nested mappings as coming from Python, where a bare float is SI."""
    if isinstance(data, Mapping):
        return {
            key: _marks(value) if key == "assumed" else plain(value) for key, value in data.items()
        }
    return data if isinstance(data, Plain) else Plain(data)


def _marks(table: Any) -> Any:
    """Mark the values that reasons belong to; the reasons stay as they are."""
    if not isinstance(table, Mapping):
        return table
    return {
        key: {**mark, "value": plain(mark["value"])}
        if isinstance(mark, Mapping) and "value" in mark
        else mark
        for key, mark in table.items()
    }


class Given:
    """Read access by dotted keys to what the user gave; never fails on odd shapes."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self.data = data

    def value(self, key: str, default: Any = None) -> Any:
        """Value at a dotted key as typed, or ``default``."""
        node: Any = self.data
        for part in key.split("."):
            if not isinstance(node, Mapping) or part not in node:
                return default
            node = node[part]
        return node.value if isinstance(node, Plain) else node

    def __contains__(self, key: str) -> bool:
        """Tell whether the key was given."""
        return self.value(key, self) is not self

    def show(self, key: str) -> str:
        """Write ``key = value`` as the user typed it."""
        return f"{key.rpartition('.')[2]} = {written(self.value(key))}"

    def keys(self, prefix: str) -> Iterator[str]:
        """Walk over the dotted keys of all values below ``prefix``."""
        table = self.value(prefix) if prefix else self.data
        for name, value in table.items() if isinstance(table, Mapping) else ():
            key = f"{prefix}.{name}" if prefix else str(name)
            if isinstance(value, Mapping):
                yield from self.keys(key)
            else:
                yield key

    def merged(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """Return a copy with dotted keys set."""
        result: dict[str, Any] = _copy(self.data)
        for key, value in changes.items():
            *tables, name = key.split(".")
            node = result
            for table in tables:
                node = node.setdefault(table, {})
                if not isinstance(node, dict):
                    raise InputError(
                        Problem(f"{table} is a value, not a table", key, "", "Correct the key")
                    )
            if value is None or (isinstance(value, Plain) and value.value is None):
                node.pop(name, None)
            else:
                node[name] = value
        return result


def _copy(data: Any) -> Any:
    if isinstance(data, Mapping):
        return {key: _copy(value) for key, value in data.items()}
    return data
