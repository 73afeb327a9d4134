"""Bring the faults that the physics finds in a running case back to the keys of its file."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from tribodyn.errors import InputError, ModelOption, Problem

if TYPE_CHECKING:
    from tribodyn.study.case import Case


#: Arguments of the physics and the keys that they come from.
_KEYS = {
    "steps": "solver.steps_per_mesh_cycle",
    "roughness": "gears.composite_roughness",
    "pinion_speed": "operation.speed",
    "pinion_torque": "operation.torque",
    "minimum_sliding_speed": "friction.minimum_sliding_speed",
    "lubricant": "lubricant.name",
    "eyring_stress": "friction.eyring_stress",
    "positions": "film.positions",
    "nodes": "film.nodes",
    "domain": "film.domain",
    "inlet": "film.inlet",
}


def _key(case: Case, problem: Problem) -> str:
    """Key of the case that a problem is about; empty if it cannot be told."""
    place = problem.where
    if isinstance(place, ModelOption) and place.kind == "stiffness" and place.model:
        known = place.name in type(case.stiffness).model_fields
        return f"stiffness.{place.name}" if known else "stiffness.model"
    if argument := re.match(r"argument (\w+)", str(place)):
        return _KEYS.get(argument.group(1), "")
    return ""


@contextmanager
def placed(case: Case) -> Iterator[None]:
    """Name file, line and key in the input errors that are raised inside the block."""
    try:
        yield
    except InputError as error:
        keyed = [(_key(case, problem), problem) for problem in error.problems]
        unknown = [problem for key, problem in keyed if not key]
        found = case.source.place((key, problem) for key, problem in keyed if key)
        raise InputError([*found, *unknown]) from None
