"""Operating points of a study: torques and speeds as a user gives them, in SI."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from pydantic_core import PydanticCustomError

from tribodyn.errors import InputError, Problem
from tribodyn.study.surroundings import Operation
from tribodyn.study.values import Plain, read_value

if TYPE_CHECKING:
    from tribodyn.study.case import Case


def operation_values(name: str, given: Any, case: Case) -> list[float]:
    """Read one or several torques or speeds, each checked like the key of the case."""
    if given is None:
        return [getattr(case.operation, name)]
    several = isinstance(given, Iterable) and not isinstance(given, str)
    spec = dict(Operation.specs())[name]
    try:
        return [read_value(spec, name, Plain(item)) for item in (given if several else [given])]
    except PydanticCustomError as error:
        told = error.context or {}
        problem = Problem(told["what"], f"argument {name}", told["why"], told["remedy"])
        raise InputError(problem) from None


def pinion_torques(case: Case, given: Any) -> list[float]:
    """Read torques on the gear named by ``operation.speed_of`` as those of the pinion."""
    return [value / _turns(case) for value in operation_values("torque", given, case)]


def pinion_speeds(case: Case, given: Any) -> list[float]:
    """Read speeds of the gear named by ``operation.speed_of`` as those of the pinion."""
    return [value * _turns(case) for value in operation_values("speed", given, case)]


def _turns(case: Case) -> float:
    """Turns of the pinion for one of the gear that speed and torque refer to."""
    return case.gear_pair.ratio if case.operation.speed_of == "wheel" else 1.0
