"""Write a case: as its file was read, with the meanings of its keys, or as a table."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn import units
from tribodyn.arguments.annotations import quantity_in, without_units
from tribodyn.model import Option
from tribodyn.study.case.checks import DEFAULT_MARK
from tribodyn.study.case.gears import is_idle
from tribodyn.study.case.provenance import changed_keys, effective, provenance
from tribodyn.study.case.section import (
    RAW_KINDS,
    Section,
    Table,
    named_rows,
    option_at,
    section_at,
)
from tribodyn.study.case.user_input import Note, with_values
from tribodyn.study.case.values import Plain, in_unit, unmarked, written
from tribodyn.types import ByName, Tree

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.case.pair import PairCase

Place = tuple[str, ...]
Rows = list[tuple[Place, Any]]

_NUMBERS = ("number", "numbers")
#: Line above ``[based_on]``, and the one above ``[assumed]``.
_BASE_NOTE = "# Initial values of this case, which reports use to name changed values: do not edit"
_MARKS_NOTE = """
# Values above that the source of this case does not print, and defaults. A reason is
# valid for the value recorded with it, and is dropped once the value above changes.
"""


def case_text(case: Case, *, comments: bool = False) -> str:
    """Text of the file as it was read; with the meanings of all keys on request, or from Python."""
    is_read = not comments and bool(case.source.comments)
    return (_Writer(case, case.source.comments) if is_read else _Commentator(case)).text()


def every_value(case: PairCase) -> Tree:
    """Tables with all values of a pair; of keys without a value None."""
    values, kind = effective(case), case.gears.kind

    def inside(section: Section, prefix: str) -> Tree:
        table: Tree = {}
        for name in section._names():
            key, inner = f"{prefix}{name}", vars(section).get(name)
            if isinstance(inner, Section):
                table[name] = inside(inner, f"{key}.")
            elif not (prefix.startswith("gears") and is_idle(key, kind)):
                value = values.get(key)
                table[name] = case.uncertain.get(key, None if value is None else Plain(value))
        return table

    return inside(case, "")


class _Writer:
    """Writer of tables in their order, with what the file has above and behind each key."""

    def __init__(self, case: Case, notes: Mapping[str, Note]) -> None:
        self._case, self._changed, self._notes = case, changed_keys(case), notes
        self._tables = with_values(case.data, case._spread)

    def text(self) -> str:
        """Text of the file."""
        above = self._note(("based_on",)).above.replace(f"{_BASE_NOTE}\n", "").rstrip("\n")
        text = "".join((*self._inside(self._tables, (), ()), self._note(("",)).above, above))
        return (text if text.endswith("\n") else f"{text}\n") + "".join(self._base())

    def _inside(self, table: ByName, place: Place, key: Place) -> Iterator[str]:
        """Values of a table, then tables in it; in ``key`` tables of a list have their numbers."""
        values, tables = self._split(table, place, key)
        for names, value in values:
            at = (*place, *names)
            yield self._entry(at, self._note((*key, *names)), value, len(names))
        for names, value in tables:
            at, its_key = (*place, *names), (*key, *names)
            if at == ("assumed",):
                yield from self._reasons(value)
            elif isinstance(value, Mapping):
                yield from self._table(f"[{_dotted(at)}]", value, at, its_key)
            elif value is None:
                meaning = self._meaning(at).replace("  #", ":")
                yield f"\n# [{'.'.join(at)}] is not given{meaning}\n"
            for number, (row, body) in enumerate(named_rows(value), 1):
                head = f"[[{_dotted(at)}]]"
                yield from self._table(head, body, (*at, row), (*its_key, str(number)))

    def _split(self, table: ByName, place: Place, key: Place) -> tuple[Rows, Rows]:
        """Values of a table, also tables that are written in one line, and other tables."""
        values: Rows = []
        tables: Rows = []
        for name, value in table.items():
            note = self._note((*key, name))
            is_table = isinstance(value, Mapping) or bool(named_rows(value))
            is_absent = value is None and bool(self._meaning((*place, name)))
            if note.dotted and isinstance(value, Mapping):
                inside = self._split(value, (*place, name), (*key, name))
                for rows, inner in zip((values, tables), inside, strict=True):
                    rows += [((name, *names), each) for names, each in inner]
            else:
                rows = tables if is_absent or (is_table and not note.value) else values
                rows.append(((name,), value))
        return values, tables

    def _table(self, head: str, body: ByName, place: Place, key: Place) -> Iterator[str]:
        """Head of a table, unless only other tables are in it, and what is inside."""
        note = self._notes.get(".".join(key))
        if note is not None:
            yield f"{note.above}{head}{note.behind}\n"
        elif self._split(body, place, key)[0] or not body:
            yield f"\n{head}{self._meaning(place)}\n"
        yield from self._inside(body, place, key)

    def _note(self, key: Place) -> Note:
        """What the file has for a key."""
        return self._notes.get(".".join(key)) or Note("")

    def _entry(self, place: Place, note: Note, value: object, names: int) -> str:
        """Line of a value, whose last ``names`` names are written."""
        if unmarked(value) is None:
            return ""
        text = note.value if _denotes(note.value, value) else f" = {self._value(place, value)}"
        behind = "" if ".".join(place) in self._changed else note.behind
        return f"{note.above}{_dotted(place[-names:])}{text}{behind}\n"

    def _value(self, place: Place, value: object) -> str:
        """Text of a value, or of a table in one line."""
        if isinstance(value, Mapping):
            pairs = (f"{_quoted(k)} = {self._value((*place, k), v)}" for k, v in value.items())
            return f"{{ {', '.join(pairs)} }}"
        return written_value(value, option_at(self._case.root, self._tables, place))

    def _meaning(self, place: Place) -> str:
        """Comment behind the head of a table that the file does not have."""
        return ""

    def _reasons(self, reasons: Mapping[str, str]) -> Iterator[str]:
        """Table of the reasons, each with its value once the case has changed."""
        if not reasons and "assumed" not in self._notes:
            return
        head = self._notes.get("assumed", Note("\n"))
        yield f"{head.above}[assumed]{head.behind}\n"
        for key, reason in reasons.items():
            note, value = self._note(("assumed", key)), self._case._effective.get(key)
            typed = _typed(note.value)
            is_record = isinstance(typed, Mapping) and typed.get("reason") == reason
            if is_record or (typed == reason and not self._changed):
                text = note.value
            else:
                text = f" = {self._with_value(key, reason, value)}"
            yield f"{note.above}{_quoted(key)}{text}{note.behind}\n"

    def _with_value(self, key: str, reason: str, value: object) -> str:
        why = json.dumps(reason, ensure_ascii=False)
        if value is None:
            return why
        return f"{{ value = {self._recorded(key, value)}, reason = {why} }}"

    def _recorded(self, key: str, value: object) -> str:
        option = self._case.option_of(key)
        is_raw = option is None or (option.kind in RAW_KINDS and not option.unit)
        return written_value(value if is_raw else Plain(value), None if is_raw else option)

    def _base(self) -> Iterator[str]:
        """Initial values in ``[based_on]``, of a case that has changed or whose file has them."""
        if self._changed or "based_on" in self._notes:
            yield f"\n{_BASE_NOTE}\n[based_on]\n"
            for key, value in self._case.stated.base.items():
                if value is not None and key != "title":
                    yield f"{_quoted(key)} = {self._recorded(key, value)}\n"


class _Commentator(_Writer):
    """Writer of tables with the meanings of their keys; what has no value is a comment."""

    def __init__(self, case: Case) -> None:
        super().__init__(case, {})
        self._origins = provenance(case)
        self._derived = case._derived_values()
        self._tables = {k: v for k, v in case._every_value().items() if k != "assumed"}
        values = (key for key, origin in self._origins.items() if origin == DEFAULT_MARK)
        marks = dict.fromkeys((k for k in values if case._effective[k] is not None), DEFAULT_MARK)
        if reasons := {**case.assumed, **marks}:
            self._tables["assumed"] = reasons

    def text(self) -> str:
        """Text of the file."""
        return super().text().lstrip("\n")

    def _meaning(self, place: Place) -> str:
        parent = section_at(place[:-1], self._case.root)
        field = parent.fields.get(place[-1]) if parent else None
        return f"  # {field.meaning}" if isinstance(field, Table) else ""

    def _entry(self, place: Place, note: Note, value: object, names: int) -> str:
        option = option_at(self._case.root, self._tables, place)
        if option is None:
            return super()._entry(place, note, value, names)
        key, name, spread = ".".join(place), place[-1], self._case.uncertain
        if value is not None:
            default = self._origins.get(key) == DEFAULT_MARK
            why = DEFAULT_MARK if default else "known within bounds" if key in spread else ""
            if key == "origin" and self._changed:
                why = f"{len(self._changed)} of the values have changed since: see [based_on]"
            return f"{name} = {written_value(value, option)}{_comment(option, why)}\n"
        if (derived := self._derived.get(key)) is not None:
            why = _comment(option, f"default: from {option.basis}")
            return f'# {name} = "{option.show(derived)}"{why}\n'
        return f"# {name} = {_example(option)}{_comment(option, _owners(self._case, place))}\n"

    def _reasons(self, reasons: Mapping[str, str]) -> Iterator[str]:
        yield f"{_MARKS_NOTE}[assumed]\n"
        for key, reason in reasons.items():
            value = self._case._effective.get(key)
            yield f"{_quoted(key)} = {self._with_value(key, reason, value)}\n"

    def _base(self) -> Iterator[str]:
        if self._changed or self._case.stated.base.get("origin") is not None:
            self._notes = {"based_on": Note("")}
        return super()._base()


def _comment(option: Option, note: str) -> str:
    meaning = f"{option.symbol}: {option.meaning}" if option.symbol else option.meaning
    limits = option.allowed() if option.names or math.isfinite(option.low) else ""
    text = "; ".join(part for part in (meaning, limits, note) if part)
    return f"  # {text}" if text else ""


def _example(option: Option) -> str:
    """Return a value that makes the line valid TOML when uncommented."""
    if option.kind == "numbers":
        return option.example if option.example.startswith("[") else f"[{option.example}]"
    if option.kind == "flag":
        return "true"
    return f'"{option.names()[0]}"' if option.names is not None else option.example or '"..."'


def _owners(case: Case, place: Place) -> str:
    """Name the models that have an option which the model of the case lacks."""
    section = section_at(place[:-1], case.root)
    owners = section.section_keys().owners.get(place[-1], []) if section else []
    chosen = vars(case).get(place[0])
    if section is None or not owners or not isinstance(chosen, Section) or chosen.chosen is None:
        return "not given"
    if chosen.chosen.name in owners:
        return "not given"
    return f"belongs to {section.selector} = {', '.join(owners)}"


def _quoted(name: str) -> str:
    return name if name.replace("_", "").replace("-", "").isalnum() else json.dumps(name)


def _dotted(names: Place) -> str:
    return ".".join(map(_quoted, names))


def _typed(text: str) -> Any:
    """Value of a text such as ``= 3``; None where it is none."""
    with suppress(tomllib.TOMLDecodeError):
        return tomllib.loads(f"x{text}")["x"] if text else None
    return None


def _denotes(text: str, value: object) -> bool:
    """Whether the text of a file denotes a value that was read."""
    return not isinstance(value, Plain) and bool(text) and bool(_typed(text) == value)


def written_number(spec: Option, value: float) -> str:
    """Format a number as TOML, with its unit."""
    if not spec.unit:
        return repr(value)
    return f'"{units.shortest_quantity(value, spec.unit, spec.display_unit)}"'


def written_value(value: object, option: Option | None) -> str:
    """Text of a value; a number or a quantity from Python with the unit of its key."""
    if isinstance(value, Plain) and isinstance(value.value, list | tuple | np.ndarray):
        value = [Plain(item) for item in value.value]
    if isinstance(value, list | tuple):
        return f"[{', '.join(written_value(item, option) for item in value)}]"
    if isinstance(value, Plain):
        unit = option.unit if option else None
        foreign = quantity_in(value.value) is not None
        number = in_unit(value.value, unit) if foreign else without_units(value.value, unit)
        is_number = isinstance(number, float | int | np.number) and not isinstance(number, bool)
        if is_number and option is not None and (option.unit or option.kind in _NUMBERS):
            return written_number(option, float(number))
        value = number.item() if isinstance(number, np.generic) else number
    if isinstance(value, bool):
        return str(value).lower()
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)


def case_rows(case: Case) -> list[tuple[str, str, str]]:
    """Return key, value with unit, and provenance of every effective value."""
    origins, derived = provenance(case), case._derived_values()
    values = {key: derived.get(key, value) for key, value in effective(case).items()}
    specs = {key: case.option_of(key) for key in values}
    return [
        (key, _value_text(specs[key], value), origins.get(key, "").partition(":")[0])
        for key, value in values.items()
        if value is not None and key != "title"
    ]


def _value_text(spec: Option | None, value: object) -> str:
    if spec is None or (spec.kind in RAW_KINDS and not spec.unit):
        return written(value).strip('"')
    return spec.show(value)


def case_table(case: Case) -> str:
    """Format the case as a table with units, one row for each effective value."""
    rows = case_rows(case)
    widths = [min(max(len(row[column]) for row in rows), 48) for column in range(2)]
    head = f"Case: {case.title}"
    body = [f"  {k:<{widths[0]}}  {v:<{widths[1]}}  {origin}" for k, v, origin in rows]
    return "\n".join([head, *(line.rstrip() for line in body)])
