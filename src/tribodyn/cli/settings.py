"""Words of the command line that change a case: ``--set`` and the ranges of studies."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.cli.screen import show_warnings
from tribodyn.errors import InputError, Problem, collected

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case


def check_place(target: Path, force: bool) -> None:
    """Clear what killed runs left beside a result, and refuse a place before any work is done."""
    from tribodyn.files import clear_leftovers
    from tribodyn.study.pipeline.save import check_target

    with collected() as told:
        clear_leftovers(target)
    show_warnings((warning.code, warning.message) for warning in told)
    remedy = "Choose another directory with --out, or replace it with --force"
    check_target(target, force, remedy=remedy)


def read_changes(settings: Sequence[str]) -> dict[str, Any]:
    """Read ``KEY=VALUE`` words as in a case file, where quotes may be left out."""
    from tribodyn.study.case.values import written

    changes: dict[str, Any] = {}
    problems = []
    for setting in settings:
        key, equals, value = (part.strip() for part in setting.partition("="))
        if not (key and equals):
            remedy = 'Write --set "operation.torque=120 N*m"'
            problems.append(Problem(f'"{setting}" is not KEY=VALUE', "--set", "", remedy))
        elif key in changes:
            what = f"{key} is set to {written(changes[key])} and to {written(read_value(value))}"
            problems.append(Problem(what, "--set", "", "Keep one of them"))
        else:
            changes[key] = read_value(value) if value else None
    if problems:
        raise InputError(problems)
    return changes


def read_value(text: str) -> Any:
    """Read a TOML value; what is none is text."""
    try:
        value = tomllib.loads(f"value = {text}\n")
    except tomllib.TOMLDecodeError:
        return text
    return value["value"] if list(value) == ["value"] else text


def changed_case(name_or_path: str, settings: Sequence[str]) -> Case:
    """Load a case and change values."""
    from tribodyn.cases.load import load_case

    case = load_case(name_or_path)
    changes = read_changes(settings)
    return case.replace(changes, by="--set") if changes else case


RANGE = 'Write "operation.speed=400..3500 rpm:60"'
GRAMMAR = f'{RANGE} or "operation.torque=50,150,300 N*m"'

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)")


def read_ranges(words: Sequence[str], *, lists: bool = True) -> dict[str, Any]:
    """Read what varies: a range with its number of points, or a list of values."""
    found: dict[str, Any] = {}
    problems = []
    grammar = GRAMMAR if lists else RANGE
    if not words:
        problems.append(Problem("nothing varies", "", "", grammar))
    for word in words:
        key, equals, text = (part.strip() for part in word.partition("="))
        try:
            if not (key and equals and text):
                raise _UnreadError("It is not KEY=VALUES")
            if key in found:
                raise _UnreadError(f"{key} varies twice: give all its values at once")
            found[key] = _range(text) if ".." in text else _list(text, lists)
        except _UnreadError as fault:
            problems.append(Problem(f'cannot read "{word}"', "", str(fault), grammar))
    if problems:
        raise InputError(problems)
    return found


def read_ends(text: str) -> tuple[Any, Any]:
    """Read the two ends of a range without points."""
    try:
        first, last, _ = _range(f"{text}:2")
    except _UnreadError as fault:
        what, remedy = f'cannot read "{text}"', 'Write "400..3500 rpm"'
        raise InputError(what, "", str(fault), remedy) from None
    return first, last


class _UnreadError(ValueError):
    """Why a word cannot be read."""


def _range(text: str) -> tuple[Any, Any, int]:
    ends, colon, count = text.rpartition(":")
    if not colon:
        raise _UnreadError("The number of points after a colon is missing")
    try:
        points = int(count)
    except ValueError:
        raise _UnreadError(f'"{count}" is no whole number of points') from None
    low, _, high = (part.strip() for part in ends.partition(".."))
    if high.startswith("."):
        raise _UnreadError("There are two dots between the ends of a range")
    first, last = _NUMBER.fullmatch(low), _NUMBER.fullmatch(high)
    if not (first and last):
        raise _UnreadError(f'"{high if first else low}" is no number')
    unit = last.group(2)
    return (_with(first.group(1), first.group(2) or unit), _with(last.group(1), unit), points)


def _list(text: str, allowed: bool) -> list[Any]:
    if not allowed:
        raise _UnreadError("A diagram goes over a range LOW..HIGH with a number of points")
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise _UnreadError("A value between two commas is missing")
    parts = [_NUMBER.fullmatch(item) for item in items]
    last = parts[-1]
    if any(parts) and not all(parts):
        odd = items[[part is None for part in parts].index(True)]
        raise _UnreadError(f'"{odd}" is no number')
    if last is None:
        return [read_value(item) for item in items]
    return [_with(part.group(1), part.group(2) or last.group(2)) for part in parts if part]


def _with(number: str, unit: str) -> Any:
    """Return number and unit as text, or the bare number."""
    return f"{number} {unit}" if unit else read_value(number)
