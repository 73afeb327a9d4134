"""Variants of a case as lanes: factors of a shared structure, or structures of their own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.dynamics.equations.program import compile_system
from tribodyn.errors import Argument, ComputationError, InputError, quiet, warn
from tribodyn.nonlinear.parameter_map import SCALES
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.provenance import effective
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.case.user_input import spread_problem
from tribodyn.study.pipeline.motion import steps_of
from tribodyn.study.studies.case_grid import (
    COARSER,
    FEWEST,
    Member,
    built,
    contact_without_speed,
    varied,
)
from tribodyn.study.studies.sweep import points_under
from tribodyn.types import Array, ByName, Index, Tree
from tribodyn.uncertainty import distribution, sample

if TYPE_CHECKING:
    from tribodyn.dynamics import LaneParameters
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase
    from tribodyn.study.studies.sweep_result import SweepPoint

#: Steps on which two structures are compared, and the relative difference that counts as none.
_LOOK, _SAME = 64, 1e-12


@dataclass(frozen=True)
class Lanes:
    """Variants of a case: lane ``i`` marches the structure of ``members[i]`` with its factors."""

    members: list[Member]
    mesh_frequency: Array
    factors: dict[str, Array]
    steps: Index

    @property
    def count(self) -> int:
        """Number of lanes."""
        return self.mesh_frequency.size

    def parameters(self) -> LaneParameters:
        """Factors of all lanes."""
        from tribodyn.dynamics import LaneParameters

        return LaneParameters(**self.factors)

    def table(self) -> Array:
        """Factors of all lanes (lanes, 6)."""
        return self.parameters().table(self.count)


def draw(
    case: AnyCase, spread: ByName, size: int, *, method: Any = "monte-carlo", seed: int
) -> dict[str, Array]:
    """Values of keys of a case and of factors, each in the unit that it has there."""
    return sample(distributions_of(case, spread), size, method=method, seed=seed)


def distributions_of(case: AnyCase, spread: Mapping[str, object]) -> Tree:
    """Distributions of keys of a case and of factors, each in the unit that it has there."""
    distributions = {}
    for key, text in spread.items():
        spec = None if key in SCALES else case.option_of(str(key))
        if spec is None and key not in SCALES:
            raise InputError(replace(case._unknown_key(str(key)), where=f"distributions {key}"))
        distributions[str(key)] = distribution(str(key), text, spec.unit if spec else "")
        problem = spread_problem(spec, str(key), text) if spec and isinstance(text, str) else None
        if problem is not None:
            raise InputError(replace(problem, where=f"distributions {key}"))
    return distributions


def lanes_of(case: PairCase, values: Mapping[str, Array], progress: Progress = SILENT) -> Lanes:
    """Lanes of a case for values by key, all (lanes,), or by name of a factor."""
    count = len(next(iter(values.values())))
    factors = {name: np.ones(count) for name in SCALES}
    speed, keyed = np.ones(count), {}
    for key, column in values.items():
        if key in SCALES:
            factors[key] = factors[key] * column
            continue
        check_spread_key(case, key, column)
        if key == "operation.speed" and contact_without_speed(case):
            speed = np.asarray(column) / case.operation.speed
        elif (name := _factor(case, key, column)) is not None:
            nominal = effective(case)[key]
            factors[name] = factors[name] * (np.asarray(column) / nominal)
        else:
            keyed[key] = column
    with locate_errors(case), quiet():
        if keyed:
            # Lanes of the same values share one structure, and so one march.
            rows = [tuple(map(float, row)) for row in zip(*keyed.values(), strict=True)]
            places = {row: place for place, row in enumerate(dict.fromkeys(rows))}
            changes = [dict(zip(keyed, row, strict=True)) for row in places]
            built_members = varied(case, changes, progress)
            members = [built_members[places[row]] for row in rows]
        else:
            members = [built(case)] * count
    frequency = speed * np.array([member.mesh.mesh_frequency for member in members])
    varied_factors = {name: column for name, column in factors.items() if np.any(column != 1.0)}
    return Lanes(members, frequency, varied_factors, _steps(members, frequency, factors))


def check_spread_key(case: AnyCase, key: str, column: Array) -> None:
    """Raise if a key is no number of the case, or its least or greatest value is out of range."""
    spec = case.option_of(key)
    value = case.get(key)
    number = spec is not None and spec.kind not in ("file", "text", "choice", "flag")
    if not number or isinstance(value, bool | str):
        where = Argument("distributions")
        what, why = f"{key} cannot be spread", "Numbers of the case can"
        factors = f", and the factors {', '.join(SCALES)}" if case.lumped else ""
        raise InputError(what, where, why + factors, "Name one of these")
    for end in (np.min(column), np.max(column)):
        case.replace({key: float(end)})


def points_of_values(
    case: AnyCase, values: Mapping[str, Array], progress: Progress = SILENT
) -> list[SweepPoint]:
    """Compute a case at values of its keys, each as a case of its own."""
    for key, column in values.items():
        check_spread_key(case, key, column)
    rows = [dict(zip(values, row, strict=True)) for row in zip(*values.values(), strict=True)]
    return points_under(case, rows, progress)


def successful(
    points: list[SweepPoint], noun: str, spread: str, fewest: int, why: str = ""
) -> list[SweepPoint]:
    """Points that could be computed; others are reported, an error if there are too few."""
    good = [point for point in points if not point.failed]
    if len(good) < len(points):
        first = next(filter(None, (point.failed for point in points)))
        what = f"{len(points) - len(good)} of {len(points)} {noun} cannot be computed: {first}"
        if len(good) < fewest:
            raise ComputationError(what, "", why, f"Narrow the {spread}, or correct the case")
        warn("ensemble-failed", f"{what}. They are left out: narrow the {spread}")
    return good


def _factor(case: PairCase, key: str, column: Array) -> str | None:
    """Return the factor of the structure that is equivalent to a key, or None."""
    nominal = effective(case).get(key)
    if not isinstance(nominal, float) or nominal == 0.0:
        return None
    if key == "friction.coefficient" and case.friction.law == "constant":
        return "friction_scale"
    if key in ("dynamics.mesh_damping", "dynamics.mesh_damping_ratio"):
        return "damping_scale"
    if key == "operation.torque" and _contact_without_load(case, column):
        return "force_scale"
    return None


def _contact_without_load(case: PairCase, torques: Array) -> bool:
    """Whether the tooth contact is the same for the least, the greatest and the stated torque."""
    if not contact_without_speed(case):
        return False
    with locate_errors(case), quiet():
        torques = np.array([np.min(torques), np.max(torques), case.operation.torque])
        systems = [
            built(case.replace({"operation.torque": float(torque)})).system for torque in torques
        ]
    # The structure under a torque of one, which is all that may be left of the torque.
    rows = []
    for system, torque in zip(systems, torques, strict=True):
        nodes = compile_system(system, _LOOK)[1]
        rows.append(nodes._replace(force=nodes.force / torque))
    return all(
        first.shape == second.shape
        and np.allclose(first, second, _SAME, _SAME * np.abs(first).max(initial=0))
        for row in rows[1:]
        for first, second in zip(rows[0], row, strict=True)
    )


def _steps(members: list[Member], frequency: Array, factors: dict[str, Array]) -> Index:
    """Steps per mesh cycle of every lane, those of a single study of motions."""
    rates: dict[int, float] = {}
    counts = np.empty(frequency.size, dtype=np.int64)
    stiff = np.sqrt(np.maximum(factors["stiffness_scale"], 1.0))
    for lane, member in enumerate(members):
        if member.case.solver.steps_per_mesh_cycle:
            counts[lane] = member.case.solver.steps_per_mesh_cycle
            continue
        key = id(member)
        if key not in rates:
            rates[key] = steps_of(member.case, member.system, member.mesh.mesh_frequency)
        needed = rates[key] * member.mesh.mesh_frequency / frequency[lane] * stiff[lane] / COARSER
        counts[lane] = max(FEWEST, 2 ** int(np.ceil(np.log2(needed))))
    return counts
