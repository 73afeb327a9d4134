"""Operating point and load cases of a machine."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from tribodyn.errors import Problem
from tribodyn.study.case.rating_tables import history_classes, history_problems
from tribodyn.study.case.section import named_rows
from tribodyn.study.case.values import KeyedProblems
from tribodyn.study.machine.read_parts import is_faulty, read_share


@dataclass(frozen=True)
class LoadCase:
    """Speed and torque of the input, and the share of the time with them.

    Parameters
    ----------
    name : str
        Name of the load case.
    speed : float
        Speed of the input [rad/s].
    torque : float
        Torque on the input [N*m].
    share : float
        Share of the time [1].
    temperature, gear_temperature : float, optional
        Temperatures of oil and gears in place of those of the table ``lubricant`` [K].
    """

    name: str
    speed: float
    torque: float
    share: float
    temperature: float | None = None
    gear_temperature: float | None = None


class Loads(NamedTuple):
    """Input and output, the operating point and the load cases."""

    ends: tuple[str, str]
    operating_point: LoadCase
    load_cases: tuple[LoadCase, ...]


def read_loads(
    data: Mapping[str, Any], tables: Any, named: Mapping[str, Any], problems: KeyedProblems
) -> Loads | None:
    """Read ``[operation]``, and ``[[load_cases]]`` or a history; None without operating point."""
    operation = tables.operation
    rows = data.get("load_cases", [])
    if not isinstance(rows, list | tuple) or not all(isinstance(r, Mapping) for r in rows):
        remedy = "Write [[load_cases]] with share, speed and torque"
        problems.append(("load_cases", Problem("load_cases is no list", "", "", remedy)))
    elif len({name for name, _ in named_rows(rows)}) < len(rows):
        what = "two load cases have one name"
        problems.append(("load_cases", Problem(what, "", "", "Rename one of them")))
    if operation is None or is_faulty("operation", problems):
        return None
    for end in ("input", "output"):
        if not getattr(operation, end):
            problem = Problem(f'{end} = ""', "", "It names a shaft or a member", "Give its name")
            problems.append((f"operation.{end}", problem))
    point = LoadCase("operation", operation.speed, operation.torque, 1.0)
    loads = _history_loads(tables.rating, point, bool(named), problems)
    loads += tuple(_load_cases(named, point, problems))
    total = sum(load.share for load in loads)
    if total > 1.0 + 1e-9:
        what, why = f"the shares add up to {100.0 * total:.6g} %", "They are parts of one time"
        problems.append(("load_cases", Problem(what, "", why, "Correct the shares")))
    return Loads((operation.input, operation.output), point, loads)


def _history_loads(
    rating: Any, point: LoadCase, has_load_cases: bool, problems: KeyedProblems
) -> tuple[LoadCase, ...]:
    """Classes of the history of the torque as load cases."""
    if is_faulty("rating", problems):
        return ()
    faults = list(history_problems(rating, point.speed))
    if not faults and has_load_cases and rating is not None and rating.torque_history is not None:
        what, why = "torque_history stands beside [[load_cases]]", "Both are loads of the machine"
        faults = [("rating.torque_history", Problem(what, "", why, "Remove one of both"))]
    problems += faults
    return () if faults else tuple(
        LoadCase(each.name, math.copysign(each.speed, point.speed), each.torque, each.duration)
        for each in history_classes(rating, point.speed)
    )  # fmt: skip


def _load_cases(
    rows: Mapping[str, Any], point: LoadCase, problems: KeyedProblems
) -> Iterator[LoadCase]:
    for place, (row, table) in enumerate(rows.items()):
        key = f"load_cases.{row}"
        if is_faulty(key, problems):
            continue
        share: float | None = 1.0 / len(rows)
        if table.share is not None:
            share = read_share(f"{key}.share", table.share, problems)
        if share is not None:
            stated = {"speed": table.speed, "torque": table.torque}
            values = {name: value for name, value in stated.items() if value is not None}
            yield replace(point, name=table.name or f"load case {place + 1}", share=share, **values)
