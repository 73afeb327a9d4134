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

__all__ = ["operation_values"]


def operation_values(name: str, given: Any, case: Case) -> list[float]:
    """Read one or several torques or speeds, each checked like the key of the case.

    Parameters
    ----------
    name : str
        ``"torque"`` or ``"speed"``.
    given : float, str, list or None
        Floats in SI, or text with a unit; nothing for the value of the case.
    case : Case
        The case.

    Returns
    -------
    list of float
        In SI.

    Raises
    ------
    InputError
        If a value is out of range or has no unit of its kind.
    """
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
