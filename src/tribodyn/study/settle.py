"""Settling: teeth, shafts that deflect, film and load, and oil temperature in one fixed point.

A mesh table is computed for the force of all pairs at each mesh phase. Friction takes part of the
torque, so that this force depends on the table; the load bends the shafts, which misalign the
flanks; and the losses heat the oil. Pairs, machines and stages say what follows from their teeth.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Generic, NamedTuple, Protocol, Self, TypeVar

import numpy as np

from tribodyn.errors import ComputationError, Problem, collected, warn
from tribodyn.study.heat_balance import HeatBalance, Temperatures, balanced
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.sections import LubricantData

#: Mesh tables by the name of the mesh.
Tables = Mapping[str, "MeshTable"]
Point = TypeVar("Point", bound="Settling")

#: Largest number of passes, and smallest relaxation factor before the iteration fails.
_MAX_PASSES, _MIN_RELAXATION = 60, 1.0 / 64.0
#: Lower limit of the force ratio at which film and friction are computed.
_LIGHT = 0.04


class Settling(Protocol):
    """Teeth under one load that are to agree with what follows from them."""

    @property
    def tables(self) -> Tables:
        """Teeth under the nominal load."""

    def aligned(self) -> Self:
        """The same with the misalignment by the shafts that these teeth bend."""

    def at(self, to: Temperatures) -> Self:
        """The same at other temperatures."""

    def required(self, tables: Tables) -> dict[str, Array]:
        """Force of all pairs that results from the teeth, over its nominal force, by mesh."""

    def following(self, tables: Tables) -> tuple[Self, float]:
        """The same with what else follows from the teeth, such as warmer oil, and its change."""

    def under(self, loading: Mapping[str, Array]) -> Tables:
        """Teeth under given forces."""

    def friction(self, tables: Tables) -> float:
        """Power that the friction of the teeth takes [W]."""

    def lost(self, tables: Tables, to: Temperatures) -> float:
        """Power that all parts lose with oil and gears at these temperatures [W]."""


class Settled(NamedTuple, Generic[Point]):
    """What is settled: its inputs, teeth, passes and temperatures."""

    point: Point
    tables: Tables
    loading: Mapping[str, Array] = {}  #: force of all pairs over the nominal force, if coupled
    rows: Sequence[tuple[float, ...]] = ()  #: changes of each pass, if coupled
    temperatures: Temperatures | None = None
    heat: HeatBalance | None = None


def settle(
    point: Point,
    coupling: str,
    tolerance: float,
    heat: LubricantData | None = None,
    oils: Sequence[LubricantData | None] = (),
) -> Settled[Point]:
    """Teeth that agree with misalignment, load and temperature, as far as a case asks for it."""
    # coupling: load that they follow; heat: of the balance; oils: their data limit its temperature
    if heat is None or heat.heat_transfer is None:
        return _agreed(point.aligned(), coupling, tolerance)

    def solve(to: Temperatures) -> tuple[Settled[Point], float]:
        nonlocal point
        settled = _agreed(point.at(to).aligned(), coupling, tolerance)
        point = settled.point
        return settled, point.friction(settled.tables)

    def loss(settled: Settled[Point], to: Temperatures) -> float:
        return settled.point.lost(settled.tables, to)

    settled, temperatures, balance = balanced(heat, [*filter(None, oils)], solve, loss)
    return settled._replace(temperatures=temperatures, heat=balance)


def _agreed(point: Point, coupling: str, tolerance: float) -> Settled[Point]:
    """Iterate teeth and load until they agree, from the teeth under the nominal load."""
    tables = point.tables
    if coupling == "none":
        return Settled(point, tables)
    loading = {name: np.ones(table.phase.size) for name, table in tables.items()}
    relaxation, last_change, rows = 1.0, np.inf, list[tuple[float, ...]]()
    while True:
        with collected():  # The teeth under the nominal load and the motion have these warnings.
            required = point.required(tables)
            steps = {n: np.maximum(required[n], _LIGHT) - loading[n] for n in tables}
            change = max(float(np.abs(step).max()) for step in steps.values())
            if change > last_change:
                relaxation *= 0.5
            last_change = change
            loading = {name: loading[name] + relaxation * step for name, step in steps.items()}
            point, other = point.following(tables)
            solved = point.under(loading)
        of_meshes = [_changes(tables[name], solved[name]) for name in tables]
        rows.append((change, *map(max, zip(*of_meshes, strict=True)), other))
        tables = solved
        if max(rows[-1]) < tolerance:
            break
        if not np.isfinite(change) or relaxation < _MIN_RELAXATION or len(rows) == _MAX_PASSES:
            raise ComputationError(_not_converged(coupling, rows))
    for name, mesh in tables.items():
        light = (required[name] < _LIGHT).astype(float)
        if light.any():
            warn(
                "coupling-light-load",
                f"the teeth carry less than {100.0 * _LIGHT:g} % of their nominal force in "
                f"{100.0 * float(mesh.grid.mean(light)):.2g} % of the mesh "
                "cycle; film and friction there are computed at that force",
            )
    return Settled(point, tables, loading, rows)


def _changes(before: MeshTable, after: MeshTable) -> tuple[float, float, float, float]:
    """Return the largest changes of shares, films, friction and stiffness between two meshes."""
    film = 0.0
    for name in ("central_film", "minimum_film"):
        old, new = getattr(before, name), getattr(after, name)
        if new is not None:
            positive = (old > 0.0) & (new > 0.0)
            film = max(film, float(np.abs(np.log(new[positive] / old[positive])).max(initial=0.0)))
    scales = {
        "load_share": 1.0,
        "friction_coefficient": float(after.friction_coefficient.max()) or 1.0,
        "mesh_stiffness": after.mean_mesh_stiffness,
    }
    scales["mesh_stiffness_tangent"] = after.mean_mesh_stiffness_tangent
    share, friction, secant, tangent = (
        float(np.abs(getattr(after, name) - getattr(before, name)).max()) / scale
        for name, scale in scales.items()
    )
    return share, film, friction, max(secant, tangent)


def _not_converged(kind: str, rows: list[tuple[float, ...]]) -> Problem:
    last = rows[-1][0]
    factor = last / rows[-2][0] if len(rows) > 1 else np.inf
    remedy = (
        'Set solver.coupling = "static", which uses the static load; or increase damping or torque'
        if kind == "dynamic"
        else "Increase the torque or reduce the friction coefficient"
    )
    return Problem(
        f"load, film and friction do not settle: the load still changes by {100.0 * last:.2g} % in "
        f"pass {len(rows)}, {factor:.2g} times the change before",
        "solver.coupling",
        "The changes grow from pass to pass: loss of contact, a resonance, or "
        "friction that nearly balances the torque",
        f'{remedy}, or set solver.coupling = "none"',
    )
