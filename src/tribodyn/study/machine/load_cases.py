"""Operating point and load cases of a machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from tribodyn.errors import Problem
from tribodyn.study.case.values import KeyedProblems, Plain
from tribodyn.study.machine.read_parts import read_share, table_of
from tribodyn.study.machine.tables import LoadCaseTable, OperationTable


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


def read_loads(data: Mapping[str, Any], problems: KeyedProblems) -> Loads | None:
    """Read ``[operation]`` and ``[[load_cases]]``; None where there is no operating point."""
    if "operation" not in data:
        remedy = "Add it with input, output, speed, torque"
        missing = Problem("the table [operation] is missing", "", "", remedy)
        problems.append(("operation", missing))
        return None
    run = table_of(OperationTable, data["operation"], "operation", problems)
    if run is None:
        return None
    for end in ("input", "output"):
        if not getattr(run, end):
            problem = Problem(f'{end} = ""', "", "It names a shaft or a member", "Give its name")
            problems.append((f"operation.{end}", problem))
    point = LoadCase("operation", run.speed, run.torque, 1.0)
    rows = data.get("load_cases", [])
    if not isinstance(rows, list | tuple) or not all(isinstance(r, Mapping) for r in rows):
        remedy = "Write [[load_cases]] with share, speed and torque"
        problems.append(("load_cases", Problem("load_cases is no list", "", "", remedy)))
        rows = []
    return Loads((run.input, run.output), point, tuple(_load_cases(rows, point, problems)))


def _load_cases(
    rows: Sequence[Mapping[str, Any]], point: LoadCase, problems: KeyedProblems
) -> list[LoadCase]:
    loads = []
    for place, row in enumerate(rows):
        body, key = dict(row), "load_cases"
        share = read_share(f"{key}.share", body.pop("share", 1.0 / len(rows)), problems)
        body = {"speed": Plain(point.speed), "torque": Plain(point.torque), **body}
        table = table_of(LoadCaseTable, body, key, problems)
        if table is not None and share is not None:
            name = table.name or f"load case {place + 1}"
            loads.append(LoadCase(name, table.speed, table.torque, share))
    total = sum(load.share for load in loads)
    if len(loads) == len(rows) and total > 1.0 + 1e-9:
        what, why = f"the shares add up to {100.0 * total:.6g} %", "They are parts of one time"
        problems.append(("load_cases", Problem(what, "", why, "Correct the shares")))
    if len({load.name for load in loads}) < len(loads):
        what = "two load cases have one name"
        problems.append(("load_cases", Problem(what, "", "", "Rename one of them")))
    return loads
