"""Axes of a study, keys of a case or its operating points, and the syntax of their values."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.aliases import with_old_names
from tribodyn.errors import InputError
from tribodyn.study.case.values import FaultError, Plain, read_value

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)")


def toml_value(text: str) -> Any:
    """Read a TOML value; any other text stays text."""
    try:
        value = tomllib.loads(f"value = {text}\n")
    except (ValueError, RecursionError):
        return text
    return value["value"] if list(value) == ["value"] else text


class UnreadError(ValueError):
    """Reason why a text cannot be read as values."""


def read_values(text: str) -> Any:
    """Read a range or a list."""
    return read_range(text) if ".." in text else read_list(text)


def read_range(text: str) -> tuple[Any, Any, int]:
    """Read both ends, the unit behind the last of them, and the number of points."""
    ends, colon, count = text.rpartition(":")
    if not colon:
        raise UnreadError("The number of points after a colon is missing")
    try:
        points = int(count)
    except ValueError:
        raise UnreadError(f'"{count}" is no whole number of points') from None
    low, _, high = (part.strip() for part in ends.partition(".."))
    if high.startswith("."):
        raise UnreadError("There are two dots between the ends of a range")
    first, last = _NUMBER.fullmatch(low), _NUMBER.fullmatch(high)
    if not (first and last):
        raise UnreadError(f'"{high if first else low}" is no number')
    unit = last.group(2)
    return (_with(first.group(1), first.group(2) or unit), _with(last.group(1), unit), points)


def read_list(text: str) -> list[Any]:
    """Read values between commas, with the unit behind the last of them."""
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise UnreadError("A value between two commas is missing")
    parts = [_NUMBER.fullmatch(item) for item in items]
    last = parts[-1]
    if any(parts) and not all(parts):
        odd = items[[part is None for part in parts].index(True)]
        raise UnreadError(f'"{odd}" is no number')
    if last is None:
        return [toml_value(item) for item in items]
    return [_with(part.group(1), part.group(2) or last.group(2)) for part in parts if part]


def _with(number: str, unit: str) -> Any:
    """Return number and unit as text, or the bare number."""
    return f"{number} {unit}" if unit else toml_value(number)


_EXAMPLE = 'Write, for example, {"operation.speed": ("400 rpm", "3500 rpm", 60)}'
_COMMAND_EXAMPLE = 'Write, for example, "operation.speed=400..3500 rpm:60"'
_FILE_EXAMPLE = 'Write, for example, operation.speed = "400..3500 rpm:60"'
#: Largest number of values of a study; each is a computation, so more are a typing error.
_MAX_VALUES = 100_000


@with_old_names
@dataclass(frozen=True)
class Axis:
    """Key of a case that a study varies, with its values."""

    key: str  #: dotted key of the case file
    values: tuple[Any, ...]  #: floats in SI, integers or names
    unit: str = ""
    display_unit: str = ""

    @property
    def name(self) -> str:
        """Last part of the key, of a value in a list with its number."""
        *_, table, name = ("", *self.key.split("."))
        return f"{table}_{name}" if name.isdigit() else name

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers."""
        return all(isinstance(v, int | float) and not isinstance(v, bool) for v in self.values)

    def display_values(self) -> NDArray[Any]:
        """Return the values in the display unit, or as text if they are names."""
        from tribodyn.units import convert

        if not self.numeric:
            return np.array([str(value) for value in self.values])
        factor = convert(1.0, self.unit, self.display_unit) if self.unit else 1.0
        return np.asarray(self.values, dtype=float) * factor

    def show(self, value: Any) -> str:
        """Format a value with its display unit."""
        from tribodyn.units import convert

        if not self.numeric:
            return str(value)
        number = convert(float(value), self.unit, self.display_unit) if self.unit else value
        return f"{number:.6g} {self.display_unit}".rstrip()


def ends_of(case: AnyCase, key: str, ends: Sequence[object], *, by: str = "") -> tuple[float, ...]:
    """Read numbers of one key as the case file does, each on its own."""
    values = [member_value(case, key, end, by) for end in ends]
    if not all(isinstance(value, float) for value in values):
        what, why = f"{key} goes from {ends[0]} to {ends[-1]}", "It has no values in between"
        remedy = 'Take a number such as "operation.speed", or list the values for a sweep'
        if by == "sweep":
            remedy = f'List the values, as in "{key}=A,B,C"'
        raise InputError(what, _location(by), why, remedy)
    return tuple(float(value) for value in values)


def member_value(case: AnyCase, key: str, value: object, by: str) -> Any:
    """Read a value of one key; conflicts with other keys are found when it is computed."""
    spec = case.option_of(key)
    if spec is None:
        raise InputError(replace(case._unknown_key(key), where=_location(by)))
    if spec.kind == "numbers":
        what, why = f"{key} is a list", "An axis of a study is one value"
        raise InputError(what, _location(by), why, f"Name one of its values, such as {key}.1")
    names = key.split(".")
    name = ".".join(names[-2:]) if names[-1].isdigit() else names[-1]
    try:
        return read_value(spec, name, value if by else Plain(value))
    except FaultError as fault:
        problem = fault.problem
        where, remedy = f"{by} {key}".strip(), problem.remedy
        if by and spec.unit and isinstance(value, int | float):
            remedy = f"Write the unit behind the last number. {_example(by)}"
        raise InputError(problem.what, where, problem.why, remedy) from None


def _example(by: str) -> str:
    """Return an example of a range in Python, in a study file or on the command line."""
    return {"": _EXAMPLE, "axes": _FILE_EXAMPLE}.get(by, _COMMAND_EXAMPLE)


def _location(by: str) -> str:
    return by or "argument over"


def read_axes(case: AnyCase, over: Mapping[str, object], *, by: str = "") -> tuple[Axis, ...]:
    """Read the keys that vary with their values, and limit the number of points."""
    if not over:
        raise InputError("nothing varies", "argument over", "", _EXAMPLE)
    axes = tuple(read_axis(case, key, values, by) for key, values in over.items())
    _check_number(math.prod(len(axis.values) for axis in axes), by)
    return axes


def _check_number(points: int, by: str) -> None:
    if points > _MAX_VALUES:
        why = f"Each value is a computation; the limit is {_MAX_VALUES}"
        raise InputError(f"{points} values", _location(by), why, "Take fewer points")


def read_axis(case: AnyCase, key: str, entry: object, by: str) -> Axis:
    """Read a range ``(first, last, points)`` or a list of values of one key."""
    if isinstance(entry, tuple) and len(entry) == 3:
        values = _range(case, key, entry, by)
    elif isinstance(entry, list | np.ndarray):
        values = tuple(member_value(case, key, value, by) for value in entry)
    else:
        why = "It is (first, last, points), a tuple, or a list of values"
        raise InputError(f"{key} = {entry!r}", _location(by), why, _example(by))
    if len(values) < 2:
        what = f"{key} has {len(values)} value{'s' if not values else ''}"
        remedy = "Give more values, or change the one in the case itself"
        raise InputError(what, _location(by), "A sweep needs at least two", remedy)
    spec = case.option_of(key)
    unit, display_unit = (spec.unit, spec.display_unit) if spec else ("", "")
    return Axis(key, values, unit, display_unit)


def _range(case: AnyCase, key: str, entry: tuple[Any, ...], by: str) -> tuple[float, ...]:
    first, last, points = entry
    if isinstance(points, bool | str) or int(points) != points or points < 2:
        why = "A range has at least two points, both ends included"
        if isinstance(points, str):
            why = "A tuple is (first, last, points); a list has single values"
        what = f"{key} has {points} point{'s' if points != 1 else ''}"
        raise InputError(what, _location(by), why, _example(by))
    _check_number(int(points), by)
    low, high = ends_of(case, key, (first, last), by=by)
    if not low < high:
        why, remedy = "A range goes from the smaller value to the larger", "Exchange the two ends"
        what = f"{key} goes from {first} to {last}"
        raise InputError(what, _location(by), why, remedy)
    return tuple(np.linspace(low, high, int(points)).tolist())


def points_of(case: AnyCase, key: str, values: object, *, by: str) -> list[float]:
    """Read the values of a key; a list may have a single value."""
    if isinstance(values, list) and len(values) == 1:
        return list(ends_of(case, key, values, by=by))
    return list(read_axes(case, {key: values}, by=by)[0].values)
