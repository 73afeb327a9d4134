"""What the values of a case were when its reasons and its origin were written down.

A reason in ``[assumed]`` belongs to one value, and ``origin`` to those that the case began with.
Both are kept beside the values in force, so that a changed value never keeps the words of the old.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from tribodyn.errors import Problem
from tribodyn.model import Option
from tribodyn.study.case.checks import DEFAULT_MARK
from tribodyn.study.case.given import Given
from tribodyn.study.case.section import section_at
from tribodyn.study.case.values import FaultError, Plain, read_value, written

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

#: Equal to this, two ways of writing one value are the same.
_ROUNDING = 1e-9
_PARTS = {"value", "reason"}
#: Faults that are told.
_TOLD = 50

Found = list[tuple[str, Problem]]


class Stated(NamedTuple):
    """Values in SI by dotted key, as they were when something was said about them."""

    #: Values that the reasons in ``[assumed]`` belong to.
    marks: dict[str, Any]
    #: Values that the case began with, and the origin that stands for them.
    base: dict[str, Any]


def differing(before: Mapping[str, Any], now: Mapping[str, Any]) -> set[str]:
    """Keys of values that are not equal to rounding any more."""
    return {key for key, value in before.items() if not same(value, now.get(key))}


def same(one: Any, other: Any) -> bool:
    """Whether two values in SI are equal to rounding."""
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (one, other))
    return math.isclose(one, other, rel_tol=_ROUNDING) if numbers else bool(one == other)


def reasons(data: Mapping[str, Any]) -> Any:
    """The ``[assumed]`` table with its reasons alone; what is no mark is left for the check."""
    marks = data["assumed"]
    if not isinstance(marks, Mapping):
        return marks
    return {
        key: mark["reason"] if _is_record(mark) and "reason" in mark else mark
        for key, mark in marks.items()
    }


def reason_faults(marks: Any) -> Found:
    """Faults of an ``[assumed]`` table whose reasons are no text."""
    if not isinstance(marks, Mapping):
        what = f"assumed = {written(marks)}"
        return [("assumed", Problem(what, "", "assumed is a table", "Write [assumed]"))]
    return [
        (
            f"assumed.{key}",
            Problem(f"{key} = {written(reason)}", "", "Input should be a valid string",
                    "Correct the value"),
        )
        for key, reason in marks.items()
        if not isinstance(reason, str)
    ]  # fmt: skip


def without_records(data: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a case file that hold its values and reasons."""
    body = {key: value for key, value in data.items() if key != "based_on"}
    return {**body, "assumed": reasons(data)} if "assumed" in data else body


def _is_record(mark: Any) -> bool:
    return isinstance(mark, Mapping) and set(mark) <= _PARTS


def _spec_at(key: str, given: Given) -> Option | None:
    """The Option of a key, that of the model which its table names first."""
    *path, name = key.split(".")
    section = section_at(tuple(path))
    if section is None:
        return None
    model = section.model_named(given.get(".".join((*path, section.selector))))
    return (model.declared.get(name) if model else None) or section.spec(name)


def _read(given: Given, table: str, typed: Mapping[str, Any]) -> tuple[dict[str, Any], Found]:
    values: dict[str, Any] = {}
    found: Found = []
    for key, value in typed.items():
        if len(found) > _TOLD:
            break
        spec, place = _spec_at(key, given), f"{table}.{key}"
        if spec is None:
            why, remedy = f"[{table}] remembers values of this case", "Remove the line"
            found.append((place, Problem(f'there is no key "{key}"', "", why, remedy)))
            continue
        try:
            values[key] = read_value(spec, key.rpartition(".")[2], value)
        except FaultError as fault:
            found.append((place, fault.problem))
    return values, found


def read_stated(given: Given) -> tuple[Stated, Found]:
    """Read the values recorded in ``[assumed]`` and ``[based_on]``, with every fault."""
    table, base = given.data.get("assumed", {}), given.data.get("based_on", {})
    if not isinstance(base, Mapping):
        problem = Problem(f"based_on = {written(base)}", "", "It is a table", "Write [based_on]")
        return Stated({}, {}), [("based_on", problem)]
    records = table.items() if isinstance(table, Mapping) else ()
    typed = {k: m["value"] for k, m in records if _is_record(m) and "value" in m}
    marks, found = _read(given, "assumed", typed)
    began, more = _read(given, "based_on", _flat(base))
    return Stated(marks, began), [*found, *more]


def _flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Dotted keys of a table whose keys are quoted or nested."""
    flat: dict[str, Any] = {}
    for name, value in table.items():
        deeper = isinstance(value, Mapping)
        flat |= _flat(value, f"{prefix}{name}.") if deeper else {f"{prefix}{name}": value}
    return flat


def settled(
    case: Case, values: Mapping[str, Any], given: Given, stated: Stated
) -> tuple[Stated, set[str]]:
    """What holds of values in force [SI], and the keys whose reason was that of another value."""
    # A reason without a recorded value belongs to the value that it came with.
    reasons = case.assumed
    marks = {key: stated.marks.get(key, values.get(key)) for key in reasons}
    stale = differing(marks, values)
    said = {key: value for key, value in marks.items() if reasons[key] != DEFAULT_MARK}
    kept = {key: value for key, value in marks.items() if key not in stale}
    if stated.base and case.origin in (None, stated.base.get("origin")):
        recorded = {key: value for key, value in said.items() if key in stated.marks}
        return Stated(kept, stated.base | recorded | stated.base), stale
    base = {
        key: values[key]
        for key in given.typed
        if key in values and reasons.get(key) != DEFAULT_MARK
    }
    # Another origin stands for the values in force, whatever they were before.
    return Stated(kept, base if stated.base else base | said), stale


def tables(stated: Stated, marks: Mapping[str, str]) -> dict[str, Any]:
    """The tables ``[assumed]`` and ``[based_on]``, from which an equal case is made."""
    return {
        "assumed": {
            key: {"value": Plain(stated.marks[key]), "reason": reason}
            if stated.marks.get(key) is not None
            else reason
            for key, reason in marks.items()
        },
        "based_on": {key: Plain(value) for key, value in stated.base.items() if value is not None},
    }
