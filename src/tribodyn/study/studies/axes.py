"""The values that a study varies: keys of a case or its operating points, in SI."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import InputError
from tribodyn.study.case.provenance import spec_of
from tribodyn.study.case.section import section_at
from tribodyn.study.case.sections import Operation
from tribodyn.study.case.values import FaultError, Plain, read_value

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case


_EXAMPLE = 'Write, for example, {"operation.speed": ("400 rpm", "3500 rpm", 60)}'
_WORD = 'Write, for example, "operation.speed=400..3500 rpm:60"'
_LINE = 'Write, for example, operation.speed = "400..3500 rpm:60"'
#: Values of a study: more are a slip of the keyboard, since each is a computation.
_MOST = 100_000


@dataclass(frozen=True)
class Axis:
    """One key that varies."""

    key: str  #: dotted key of the case file
    values: tuple[Any, ...]  #: its values: floats in SI, whole numbers or names
    unit: str = ""
    display_unit: str = ""

    @property
    def name(self) -> str:
        """Last part of the key."""
        return self.key.rpartition(".")[2]

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers."""
        return all(isinstance(v, int | float) and not isinstance(v, bool) for v in self.values)

    def shown(self) -> NDArray[Any]:
        """Return the values as engineers read them."""
        from tribodyn.units import convert

        if not self.numeric:
            return np.array([str(value) for value in self.values])
        factor = convert(1.0, self.unit, self.display_unit) if self.unit else 1.0
        return np.asarray(self.values, dtype=float) * factor

    def show(self, value: Any) -> str:
        """Write one of the values with its unit."""
        from tribodyn.units import convert

        if not self.numeric:
            return str(value)
        shown = convert(float(value), self.unit, self.display_unit) if self.unit else value
        return f"{shown:.6g} {self.display_unit}".rstrip()


def ends_of(case: Case, key: str, ends: Sequence[Any], *, by: str = "") -> tuple[float, ...]:
    """Read values of one key as the case does, each by itself."""
    found = [member_value(case, key, end, by) for end in ends]
    if not all(isinstance(value, float) for value in found):
        what, why = f"{key} goes from {ends[0]} to {ends[-1]}", "It has no values in between"
        remedy = 'Take a number such as "operation.speed", or list the values for a sweep'
        if by == "sweep":
            remedy = f'List the values that it shall take, as in "{key}=A,B,C"'
        raise InputError(what, _place(by), why, remedy)
    return tuple(float(value) for value in found)


def member_value(case: Case, key: str, value: Any, by: str) -> Any:
    """Read one value; what it does together with other keys is seen when it is computed."""
    spec = spec_of(case, key)
    if spec is None and section_at(tuple(key.split("."))) is not None:
        remedy = f"Name one of its keys, such as {key}.{_first_key(case, key)}"
        raise InputError(f"{key} is a table", _place(by), "", remedy)
    if spec is None:
        case.replace({key: value}, by=by or "over")  # tells which keys there are
        what, why = f'there is no key "{key}"', "Axes of a study are keys of the case"
        raise InputError(what, _place(by), why, "Choose a key that tribodyn explain lists")
    try:
        return read_value(spec, key.rpartition(".")[2], value if by else Plain(value))
    except FaultError as fault:
        told = fault.problem
        where, remedy = f"{by} {key}".strip(), told.remedy
        if by and spec.unit and isinstance(value, int | float):
            remedy = f"Write the unit behind the last number. {_example(by)}"
        raise InputError(told.what, where, told.why, remedy) from None


def _example(by: str) -> str:
    """How values are written: in Python, in a study file, on the command line."""
    return {"": _EXAMPLE, "axes": _LINE}.get(by, _WORD)


def _place(by: str) -> str:
    return by or "argument over"


def _first_key(case: Case, key: str) -> str:
    section = section_at(tuple(key.split(".")))
    return next(iter(section.fields)) if section else ""


def read_axes(case: Case, over: Mapping[str, Any], *, by: str = "") -> tuple[Axis, ...]:
    """Read the keys that vary."""
    if not over:
        raise InputError("nothing varies", "argument over", "", _EXAMPLE)
    axes = tuple(read_axis(case, key, values, by) for key, values in over.items())
    _check_number(math.prod(len(axis.values) for axis in axes), by)
    return axes


def _check_number(points: int, by: str) -> None:
    if points > _MOST:
        why = f"Each is a computation by itself; at most {_MOST} are taken in one go"
        raise InputError(f"{points} values", _place(by), why, "Take fewer points")


def read_axis(case: Case, key: str, given: Any, by: str) -> Axis:
    """Read the values of one key."""
    if isinstance(given, tuple) and len(given) == 3:
        values = _range(case, key, given, by)
    elif isinstance(given, list | np.ndarray):
        values = tuple(member_value(case, key, value, by) for value in given)
    else:
        why = "It is (first, last, points), a tuple, or a list of values"
        raise InputError(f"{key} = {given!r}", _place(by), why, _example(by))
    if len(values) < 2:
        what = f"{key} has {len(values)} value{'s' if not values else ''}"
        remedy = "Give more values, or change the one in the case itself"
        raise InputError(what, _place(by), "A sweep needs at least two", remedy)
    spec = spec_of(case, key)
    unit, shown = (spec.unit, spec.display_unit) if spec else ("", "")
    return Axis(key, values, unit, shown)


def _range(case: Case, key: str, given: tuple[Any, ...], by: str) -> tuple[float, ...]:
    first, last, points = given
    if isinstance(points, bool) or int(points) != points or points < 2:
        why = "A range has at least two points, both ends included"
        what = f"{key} has {points} point{'s' if points != 1 else ''}"
        raise InputError(what, _place(by), why, _example(by))
    _check_number(int(points), by)
    low, high = ends_of(case, key, (first, last), by=by)
    if not low < high:
        why, remedy = "A range goes from the smaller value to the larger", "Exchange the two ends"
        what = f"{key} goes from {first} to {last}"
        raise InputError(what, _place(by), why, remedy)
    return tuple(np.linspace(low, high, int(points)).tolist())


def points_of(case: Case, key: str, given: Any, *, by: str) -> list[float]:
    """Read the values of a key that one alone may be of."""
    if isinstance(given, list) and len(given) == 1:
        return list(ends_of(case, key, given, by=by))
    return list(read_axes(case, {key: given}, by=by)[0].values)


def operation_values(name: str, given: Any, case: Case) -> list[float]:
    """Read one or several torques or speeds, each checked like the key of the case."""
    if given is None:
        return [getattr(case.operation, name)]
    several = isinstance(given, Iterable) and not isinstance(given, str)
    if isinstance(given, np.ndarray) and not given.ndim:
        given, several = float(given), False
    spec = dict(Operation.specs())[name]
    try:
        return [read_value(spec, name, Plain(item)) for item in (given if several else [given])]
    except FaultError as fault:
        problem = replace(fault.problem, where=f"argument {name}")
        raise InputError(problem) from None


def pinion_torques(case: Case, given: Any) -> list[float]:
    """Read torques on the gear named by ``operation.speed_of`` as those of the pinion."""
    return [value / _turns(case) for value in operation_values("torque", given, case)]


def pinion_speeds(case: Case, given: Any) -> list[float]:
    """Read speeds of the gear named by ``operation.speed_of`` as those of the pinion."""
    return [value * _turns(case) for value in operation_values("speed", given, case)]


def _turns(case: Case) -> float:
    """Turns of the pinion for one of the gear that speed and torque refer to."""
    return case.gear_ratio if case.operation.speed_of == "wheel" else 1.0
