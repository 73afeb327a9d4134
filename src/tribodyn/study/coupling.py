"""What follows from the teeth of a pair: its load at rest by the balance of torques, or in motion.

The force of all pairs at each mesh phase is that of the torque less the friction, or that of the
steady orbit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.mesh.gears import column_of
from tribodyn.nomenclature import GEARS, PAIR_MESH
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.heat_balance import Temperatures
from tribodyn.study.mesh_inputs import MeshInputs, mesh_inputs
from tribodyn.study.pipeline.assembly import geometry, whole_system
from tribodyn.study.pipeline.motion import motion_of
from tribodyn.study.pipeline.preview import gearbox_losses_of
from tribodyn.study.pipeline.response_series import mesh_force, one_sided_phase
from tribodyn.study.pipeline.tooth_contact import fitted_law, hypoid_friction_of, mesh_of
from tribodyn.study.settle import Settled, Tables
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.pair import PairCase

#: Takes a case and its mesh; returns the case updated by the mesh, such as with warmer oil.
Follow = Callable[["PairCase", "MeshTable"], "PairCase"]

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


@dataclass(frozen=True)
class PairTeeth:
    """The teeth of a pair under its load, whose oil may follow from its mesh."""

    case: PairCase
    progress: Progress = SILENT
    follow: Follow | None = None
    mesh_source: Callable[[], MeshTable] | None = None  #: of a study that has the loads and films

    @cached_property
    def tables(self) -> Tables:
        """Teeth under the nominal load."""
        source = self.mesh_source or partial(mesh_of, self.case, self.progress)
        return {PAIR_MESH: source()}

    def aligned(self) -> PairTeeth:
        """The same: the misalignment of a pair is given."""
        return self

    def at(self, to: Temperatures) -> PairTeeth:
        """The same at other temperatures."""
        changes = {f"lubricant.{name}": value for name, value in to.changes().items()}
        return replace(self, case=self.case.replace(changes), mesh_source=None)

    def required(self, tables: Tables) -> dict[str, Array]:
        """Force of all pairs that results from the teeth, over its nominal force."""
        loading = _loading(self.case.solver.coupling, self.case, tables[PAIR_MESH], self.progress)
        return {PAIR_MESH: loading}

    def following(self, tables: Tables) -> tuple[PairTeeth, float]:
        """The same with the oil that follows from the teeth, and the change of its viscosity."""
        changed = self.case if self.follow is None else self.follow(self.case, tables[PAIR_MESH])
        if changed == self.case:
            return self, 0.0
        point = replace(self, case=changed, mesh_source=None)
        return point, _viscosity_change(self.case, changed)

    def under(self, loading: Mapping[str, Array]) -> Tables:
        """Teeth under a given force."""
        inputs, nominal = mesh_inputs(self.case), self.tables[PAIR_MESH]
        return {PAIR_MESH: mesh_under_load(inputs, nominal, loading[PAIR_MESH])}

    def friction(self, tables: Tables) -> float:
        """Power that the friction of the teeth takes [W]."""
        return tables[PAIR_MESH].mean_friction_power

    def lost(self, tables: Tables, to: Temperatures) -> float:
        """Power that teeth, bearings, seals and oil lose [W]."""
        return float(gearbox_losses_of(self.at(to).case, self.friction(tables)).total[0, 0])


def coupling_of(settled: Settled[PairTeeth]) -> Coupling | None:
    """Convergence of the teeth and the load of a pair; None without coupling."""
    if not settled.rows:
        return None
    solver = settled.point.case.solver
    columns: Tree = dict(zip(_CHANGES, np.array(settled.rows).T, strict=True))
    return Coupling(
        iteration=np.arange(1.0, len(settled.rows) + 1.0),
        phase=settled.tables[PAIR_MESH].phase,
        loading=settled.loading[PAIR_MESH],
        kind=solver.coupling,
        tolerance=solver.coupling_tolerance,
        **columns,
    )


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


def _loading(kind: str, case: PairCase, mesh: MeshTable, progress: Progress) -> Array:
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


def balanced_load(case: PairCase, mesh: MeshTable) -> Array:
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


def _viscosity_change(before: PairCase, after: PairCase) -> float:
    viscous_before, viscous_after = before.film_lubricant, after.film_lubricant
    if viscous_before is None or viscous_after is None:
        return 0.0
    return abs(float(np.log(viscous_after.dynamic_viscosity / viscous_before.dynamic_viscosity)))
