"""Two-way coupling of load, load shares, film, friction and stiffness by fixed-point iteration.

A mesh table is computed for the force of all pairs at each mesh phase. Friction takes part of the
torque, so that this force depends on the table: at rest by the torque balance, in motion by the
steady orbit. Both are iterated to their fixed point.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol, Self, TypeVar

import numpy as np

from tribodyn.errors import ComputationError, Problem, collected, warn
from tribodyn.mesh.gears import column_of
from tribodyn.nomenclature import GEARS
from tribodyn.progress import Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.mesh_inputs import MeshInputs, mesh_inputs
from tribodyn.study.pipeline.assembly import geometry, whole_system
from tribodyn.study.pipeline.motion import motion_of
from tribodyn.study.pipeline.response_series import mesh_force, one_sided_phase
from tribodyn.study.pipeline.tooth_contact import fitted_law, hypoid_friction_of, mesh_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case

#: Mesh tables by the name of the mesh, and the name of that of a pair.
Tables = Mapping[str, "MeshTable"]
_MESH = "mesh"
Point = TypeVar("Point", bound="Settling")
#: Takes a case and its mesh; returns the case updated by the mesh, such as with warmer oil.
Follow = Callable[["Case", "MeshTable"], "Case"]

#: Largest number of passes, and smallest relaxation factor before the iteration fails.
_MAX_PASSES, _MIN_RELAXATION = 60, 1.0 / 64.0
#: Lower limit of the force ratio at which film and friction are computed.
_LIGHT = 0.04
#: Distance of two samples below which they coincide [mesh cycles].
_PHASE_TOLERANCE = 1e-9
#: Changes recorded in each pass, in the order of its row.
_CHANGES = tuple(
    f"{name}_change" for name in ("load", "share", "film", "friction", "stiffness", "oil")
)


@record
class Coupling(Record):
    """Convergence of load, film, friction and stiffness of a case.

    Parameters
    ----------
    iteration : array (passes,)
        Number of each pass.
    load_change, share_change, film_change, friction_change, stiffness_change, oil_change
        Greatest change in each pass, over the nominal force, the whole load, the film itself, the
        greatest coefficient, the mean stiffness and the viscosity (passes,).
    phase : array (n,)
        Mesh phase.
    loading : array (n,)
        Force of all tooth pairs at that phase, over that of the torque alone.
    kind : str
        ``"static"`` or ``"dynamic"``.
    tolerance : float
        Change below which all of them agree.
    """

    iteration: Array = quantity("iteration", unit="1", axis=True)
    load_change: Array = quantity("iteration", unit="1")
    share_change: Array = quantity("iteration", unit="1")
    film_change: Array = quantity("iteration", unit="1")
    friction_change: Array = quantity("iteration", unit="1")
    stiffness_change: Array = quantity("iteration", unit="1")
    oil_change: Array = quantity("iteration", unit="1")
    phase: Array = quantity("knot", unit="1", axis=True)
    loading: Array = quantity("knot", unit="1")
    kind: str = fact()
    tolerance: float = fact()

    @property
    def contraction(self) -> float:
        """Part of the change of the load that the next pass leaves; of the last two passes."""
        last = self.load_change[-2:]
        return float(last[-1] / last[0]) if last.size > 1 and last[0] > 0.0 else 0.0


class Settling(Protocol):
    """Teeth that are to agree with their load: of a pair, or of all meshes of a machine."""

    def required(self, tables: Tables) -> dict[str, Array]:
        """Force of all pairs that results from the teeth, over its nominal force, by mesh."""

    def following(self, tables: Tables) -> tuple[Self, float]:
        """The same with what else follows from the teeth, such as warmer oil, and its change."""

    def under(self, loading: Mapping[str, Array]) -> Tables:
        """Teeth under given forces."""


@dataclass(frozen=True)
class _Pair:
    """A pair, whose oil may follow from its mesh."""

    case: Case
    nominal: MeshTable
    progress: Progress
    follow: Follow | None

    def required(self, tables: Tables) -> dict[str, Array]:
        (mesh,) = tables.values()
        return {_MESH: _loading(self.case.solver.coupling, self.case, mesh, self.progress)}

    def following(self, tables: Tables) -> tuple[_Pair, float]:
        changed = self.case if self.follow is None else self.follow(self.case, tables[_MESH])
        if changed == self.case:
            return self, 0.0
        nominal = mesh_of(changed, self.progress)
        point = replace(self, case=changed, nominal=nominal)
        return point, _viscosity_change(self.case, changed)

    def under(self, loading: Mapping[str, Array]) -> Tables:
        return {_MESH: mesh_under_load(mesh_inputs(self.case), self.nominal, loading[_MESH])}


def coupled(
    case: Case, progress: Progress, follow: Follow | None
) -> tuple[Case, MeshTable, Coupling]:
    """Iterate mesh and load to convergence; return the case, the mesh and the iteration."""
    nominal, solver = mesh_of(case, progress), case.solver
    start = _Pair(case, nominal, progress, follow)
    point, tables, loading, rows = settled(
        start, {_MESH: nominal}, solver.coupling, solver.coupling_tolerance
    )
    mesh = tables[_MESH]
    columns: dict[str, Any] = dict(zip(_CHANGES, np.array(rows).T, strict=True))
    record = Coupling(
        iteration=np.arange(1.0, len(rows) + 1.0),
        phase=mesh.phase,
        loading=loading[_MESH],
        kind=solver.coupling,
        tolerance=solver.coupling_tolerance,
        **columns,
    )
    return point.case, mesh, record


def settled(
    point: Point, tables: Tables, kind: str, tolerance: float
) -> tuple[Point, Tables, dict[str, Array], list[tuple[float, ...]]]:
    """Iterate teeth and load until they agree, from the teeth under the nominal load."""
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
            raise ComputationError(_not_converged(kind, rows))
    for name, mesh in tables.items():
        light = (required[name] < _LIGHT).astype(float)
        if light.any():
            warn(
                "coupling-light-load",
                f"the teeth carry less than {100.0 * _LIGHT:g} % of their nominal force in "
                f"{100.0 * float(mesh.grid.mean(light)):.2g} % of the mesh "
                "cycle; film and friction there are computed at that force",
            )
    return point, tables, loading, rows


def mesh_under_load(
    inputs: MeshInputs, nominal: MeshTable, loading: Array, *, about_load: bool = False
) -> MeshTable:
    """Compute the mesh under given forces; static errors stay those of the nominal torque."""
    from tribodyn.mesh.build import loaded_mesh

    if inputs.cylindrical is None:
        table = hypoid_friction_of(inputs, loading=loading).table()
    else:
        table = loaded_mesh(
            inputs.cylindrical,
            inputs.settings,
            (inputs.speed, inputs.torque),
            force_law=fitted_law(inputs, about_load),
            loading=loading,
        ).table(inputs.settings)
    if inputs.law == "tangent":
        # The tangent through force and deflection of each phase, at the nominal torque.
        missing_force = (1.0 - loading) * table.total_normal_force
        error = table.static_transmission_error + missing_force / table.mesh_stiffness_tangent
    else:
        error = nominal.static_transmission_error - nominal.film_offset + table.film_offset
    return replace(
        table,
        static_transmission_error=error,
        tooth_transmission_error=nominal.tooth_transmission_error,
    )


def _loading(kind: str, case: Case, mesh: MeshTable, progress: Progress) -> Array:
    """Return the force of all pairs that results from a mesh, over its nominal force."""
    if kind == "static":
        return balanced_load(case, mesh)
    response = motion_of(case, whole_system(case, mesh), mesh.mesh_frequency, progress)
    if response.periods > 1:
        what = f"the motion repeats only after {response.periods} mesh cycles"
        why = "The load of the teeth is then not a function of the mesh phase"
        remedy = 'Set solver.coupling = "static", or dynamics.friction_load = "dynamic"'
        raise ComputationError(what, "solver.coupling", why, remedy)
    return force_at_knots(mesh, response) / mesh.total_normal_force


def balanced_load(case: Case, mesh: MeshTable) -> Array:
    """Return the static force of all pairs with friction, over that without friction.

    With the torque of one gear prescribed, the force balances that torque; with both prescribed,
    both gears have the same acceleration along the line of action.
    """
    held_gear = {"drive": case.gears.driver, "both": None}.get(
        case.operation.torque_balance, case.gears.driven
    )
    if held_gear is not None:
        return load_of_torque(mesh, held_gear)
    body, numerator, denominator = geometry(case), np.zeros(1), np.zeros(1)
    for gear in GEARS:
        pushes, rubs = _levers(mesh, gear)
        lever = pushes / body[f"moment_of_inertia_{gear}"]
        numerator = numerator + lever * pushes
        denominator = denominator + lever * (pushes + rubs)
    return np.asarray(numerator / denominator)


def load_of_torque(mesh: MeshTable, gear: str) -> Array:
    """Return the force that holds the torque of a gear with friction, over that without it."""
    pushes, rubs = _levers(mesh, gear)
    return np.asarray(pushes / (pushes + rubs))


def _levers(mesh: MeshTable, gear: str) -> tuple[Array, Array]:
    """Levers of the teeth and of their friction about the axis of a gear."""
    directions = np.atleast_2d(mesh.direction), mesh.friction
    pushes, rubs = (column_of(each, f"{gear}_theta") for each in directions)
    return pushes, rubs


def force_at_knots(mesh: MeshTable, response: Response) -> Array:
    """Return the force of a periodic response at mesh grid points, on both sides of events."""
    from scipy.interpolate import Akima1DInterpolator

    samples, grid = response.fine, mesh.grid
    phase, force = one_sided_phase(samples), mesh_force(samples)
    forces = np.empty(grid.phase.size)
    for segment in grid.segments:
        phases = grid.phase[segment]
        inside = np.flatnonzero((phase > phases[0]) & (phase < phases[-1]))
        # The end of a step and the start of the next coincide: drop duplicates.
        samples_used = inside[np.diff(phase[inside], prepend=-1.0) > _PHASE_TOLERANCE]
        # Linear interpolation would flatten peaks; the force has kinks where flanks separate.
        curve = Akima1DInterpolator(phase[samples_used], force[samples_used], method="makima")
        forces[segment] = curve(np.clip(phases, *phase[samples_used[[0, -1]]]))
    return forces


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


def _viscosity_change(before: Case, after: Case) -> float:
    viscous_before, viscous_after = before.film_lubricant, after.film_lubricant
    if viscous_before is None or viscous_after is None:
        return 0.0
    return abs(float(np.log(viscous_after.dynamic_viscosity / viscous_before.dynamic_viscosity)))


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
