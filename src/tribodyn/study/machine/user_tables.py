"""Tables of a machine as the user gives them: with changes, and with reasons."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import deepcopy
from typing import Any

from tribodyn.errors import InputError
from tribodyn.study.case.provenance import Assumption
from tribodyn.study.machine.read_parts import in_si
from tribodyn.study.machine.tables import unit_of
from tribodyn.study.machine.write import written_value


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
