"""Format a case as a commented case file, and as a table."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from tribodyn import units
from tribodyn.model import Option
from tribodyn.study.case.checks import DEFAULT_MARK
from tribodyn.study.case.gears import is_idle
from tribodyn.study.case.provenance import (
    changed_keys,
    derived_values,
    effective,
    provenance,
    spec_of,
)
from tribodyn.study.case.section import RAW_KINDS, Section, Table, section_at
from tribodyn.study.case.values import written

if TYPE_CHECKING:
    from tribodyn.study.case.case_data import BaseCase, CaseData


#: Line above ``[based_on]``.
BASE_NOTE = "# Initial values of this case, which reports use to name changed values: do not edit"


def written_number(spec: Option, value: float) -> str:
    """Format a number as TOML, with its unit."""
    if not spec.unit:
        return repr(value)
    return f'"{units.shortest_quantity(value, spec.unit, spec.display_unit)}"'


def _toml_value(spec: Option, value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return f"[{', '.join(written_number(spec, item) for item in value)}]"
    if spec.kind == "number":
        return written_number(spec, value)
    return str(value) if spec.kind == "integer" else json.dumps(value, ensure_ascii=False)


def _comment(spec: Option, note: str) -> str:
    meaning = f"{spec.symbol}: {spec.meaning}" if spec.symbol else spec.meaning
    limits = spec.allowed() if spec.names or math.isfinite(spec.low) else ""
    return "; ".join(part for part in (meaning, limits, note) if part)


def _line(
    spec: Option, name: str, value: Any, origin: str, derived: float | None, owners: str
) -> str:
    if value is None and derived is not None:
        note = f"default: from {spec.basis}"
        return f'# {name} = "{spec.show(derived)}"  # {_comment(spec, note)}'
    if value is None:
        return f"# {name} = {_unset_example(spec)}  # {_comment(spec, owners)}"
    note = origin if origin == DEFAULT_MARK else ""
    return f"{name} = {_toml_value(spec, value)}  # {_comment(spec, note)}"


def _unset_example(spec: Option) -> str:
    """Return a value that makes the line valid TOML when uncommented."""
    if spec.kind == "numbers":
        return spec.example if spec.example.startswith("[") else f"[{spec.example}]"
    if spec.kind == "flag":
        return "true"
    return f'"{spec.names()[0]}"' if spec.names is not None else spec.example or '"..."'


def _owners(case: CaseData, key: str) -> str:
    """Name the models that have an option which the model of the case lacks."""
    table, _, name = key.rpartition(".")
    section = section_at((table,)) if "." not in table else None
    owners = section.section_keys().owners.get(name, []) if section else []
    chosen = vars(case).get(table)
    if not (section and owners and isinstance(chosen, Section)) or chosen.chosen is None:
        return "not given"
    names = ", ".join(owners)
    available = chosen.chosen.name in owners
    return "not given" if available else f"belongs to {section.selector} = {names}"


def case_toml(case: CaseData) -> str:
    """Format the complete commented case file."""
    values, origins, derived = effective(case), provenance(case), derived_values(case)
    changed = changed_keys(case)
    lines: list[str] = []
    table = ""
    for key, value in values.items():
        spec = spec_of(case, key)
        place, _, name = key.rpartition(".")
        if is_idle(key, case.gears.kind) and place.startswith("gears"):
            continue
        if spec is None:
            if key.endswith(".modification"):
                lines += ["", f"# [{key}] is not given: the flanks are involutes"]
            continue
        if place != table:
            table = place
            section = section_at(tuple(place.split("."))) if place else None
            lines += ["", f"[{place}]  # {_table_meaning(case, place)}" if section else ""]
        owners = _owners(case, key)
        lines.append(_line(spec, name, value, origins.get(key, ""), derived.get(key), owners))
        if key in case.uncertain:
            text = json.dumps(case.uncertain[key], ensure_ascii=False)
            lines[-1] = f"{name} = {text}  # {_comment(spec, 'known within bounds')}"
        if key == "origin" and value is not None and changed:
            lines[-1] += f"; {len(changed)} of the values have changed since: see [based_on]"
    for name, why in (
        ("lubricant", "nothing in this case needs an oil"),
        ("losses", "of what loses power the teeth alone are counted"),
    ):
        if getattr(case, name) is None:
            lines += ["", f"# [{name}] is not given: {why}"]
    marks = {
        key: case.assumed.get(key, DEFAULT_MARK)
        for key, origin in origins.items()
        if origin != "given" and values[key] is not None
    }
    return "\n".join([*lines, *_assumed_lines(case, marks), *base_lines(case)]) + "\n"


def _assumed_lines(case: CaseData, marks: dict[str, str]) -> list[str]:
    """Format the reasons in ``[assumed]``, each with the value that it refers to."""
    if not marks:
        return []
    return [
        "",
        "# Values above that the source of this case does not print, and defaults. A reason is",
        "# valid for the value recorded with it, and is dropped once the value above changes.",
        "[assumed]",
        *reason_lines(case, marks),
    ]


def reason_lines(
    case: BaseCase, marks: Mapping[str, str], *, records: bool = True
) -> Iterator[str]:
    """Format reasons, with records each with the value that it refers to."""
    for key, reason in marks.items():
        why, value = json.dumps(reason, ensure_ascii=False), case._effective.get(key)
        if records and value is not None:
            why = f"{{ value = {_recorded(case, key, value)}, reason = {why} }}"
        yield f'"{key}" = {why}'


def base_lines(case: BaseCase) -> list[str]:
    """Format the initial values in ``[based_on]``; empty without an origin and changes."""
    base = case.stated.base
    if base.get("origin") is None and not changed_keys(case):
        return []
    lines = [
        f"{_quoted(key)} = {_recorded(case, key, value)}"
        for key, value in base.items()
        if value is not None and key != "title"
    ]
    return [
        "",
        BASE_NOTE,
        "[based_on]",
        *lines,
    ]


def _quoted(key: str) -> str:
    return f'"{key}"' if "." in key else key


def _recorded(case: BaseCase, key: str, value: Any) -> str:
    spec = case.option_of(key)
    if spec is None or spec.kind in RAW_KINDS:
        return json.dumps(value, ensure_ascii=False)
    return _toml_value(spec, value)


def _table_meaning(case: CaseData, place: str) -> str:
    *path, name = place.split(".")
    parent = section_at(tuple(path))
    table = parent.fields.get(name) if parent else None
    return table.meaning if isinstance(table, Table) else ""


def case_rows(case: BaseCase) -> list[tuple[str, str, str]]:
    """Return key, value with unit, and provenance of every effective value."""
    origins, derived = provenance(case), case._derived_values()
    values = {key: derived.get(key, value) for key, value in effective(case).items()}
    specs = {key: case.option_of(key) for key in values}
    return [
        (key, _value_text(specs[key], value), origins.get(key, "").partition(":")[0])
        for key, value in values.items()
        if value is not None and key != "title"
    ]


def _value_text(spec: Option | None, value: Any) -> str:
    if spec is None or spec.kind in RAW_KINDS:
        return written(value).strip('"')
    return spec.show(value)


def case_table(case: BaseCase) -> str:
    """Format the case as a table with units, one row for each effective value."""
    rows = case_rows(case)
    widths = [max(len(row[column]) for row in rows) for column in range(2)]
    head = f"Case: {case.title}"
    body = [f"  {k:<{widths[0]}}  {v:<{widths[1]}}  {origin}" for k, v, origin in rows]
    return "\n".join([head, *(line.rstrip() for line in body)])
