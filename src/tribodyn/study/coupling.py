"""Two-way coupling: load, load shares, film, friction and stiffness until each follows the others.

A mesh table belongs to the force of all pairs at each mesh phase. Friction takes part of the
torque, so that this force follows from the table: at rest from the balance of the torques, in
motion from the steady orbit. Both are iterated to their fixed point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import ComputationError, Problem, collected, warn
from tribodyn.mesh.gears import COORDINATES
from tribodyn.progress import Progress
from tribodyn.study.case.derive import mesh_law_of
from tribodyn.study.pipeline.assembly import geometry, whole_system
from tribodyn.study.pipeline.computed import Coupling
from tribodyn.study.pipeline.motion import motion_of
from tribodyn.study.pipeline.series import mesh_force, one_sided_phase
from tribodyn.study.pipeline.tooth_contact import contact_settings, mesh_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case

#: Takes a case and its mesh; returns the case with what follows from it, such as warmer oil.
Follow = Callable[["Case", "MeshTable"], "Case"]

#: Passes, and the least part of a step that is taken before giving up.
_MOST, _LEAST_STEP = 60, 1.0 / 64.0
#: Force over the nominal one below which film and friction are those of this force.
_LIGHT = 0.04
#: Distance of two samples below which they are one [mesh cycles].
_SAME = 1e-9
#: What changes in a pass, in the order of its row.
_CHANGES = tuple(
    f"{name}_change" for name in ("load", "share", "film", "friction", "stiffness", "oil")
)


def coupled(
    case: Case, progress: Progress, follow: Follow | None
) -> tuple[Case, MeshTable, Coupling]:
    """Iterate the mesh of a case with its load; the case that follows, the mesh, and how."""
    nominal = mesh = mesh_of(case, progress)
    kind, tolerance = case.solver.coupling, case.solver.coupling_tolerance
    loading, part, before = np.ones(mesh.phase.size), 1.0, np.inf
    rows: list[tuple[float, ...]] = []
    while True:
        with collected():  # The mesh and the motion that are found say it again.
            answer = _loading(kind, case, mesh, progress)
            step = np.maximum(answer, _LIGHT) - loading
            change = float(np.abs(step).max())
            if change > before:
                part *= 0.5
            before = change
            loading = loading + part * step
            changed = case if follow is None else follow(case, mesh)
            if changed != case:
                nominal = mesh_of(changed, progress)
            found = _under(changed, nominal, loading)
        rows.append((change, *_changes(mesh, found), _oil(case, changed)))
        case, mesh = changed, found
        if max(rows[-1]) < tolerance:
            break
        if not np.isfinite(change) or part < _LEAST_STEP or len(rows) == _MOST:
            raise ComputationError(_unsettled(kind, rows))
    if np.any(answer < _LIGHT):
        warn(
            "coupling-light-load",
            f"the teeth carry less than {100.0 * _LIGHT:g} % of their nominal force in "
            f"{100.0 * float(mesh.grid.mean((answer < _LIGHT).astype(float))):.2g} % of the mesh "
            "cycle; film and friction there are those of that force",
        )
    columns: dict[str, Any] = dict(zip(_CHANGES, np.array(rows).T, strict=True))
    order = np.arange(1.0, len(rows) + 1.0)
    how = Coupling(
        iteration=order,
        phase=mesh.phase,
        loading=loading,
        kind=kind,
        tolerance=tolerance,
        **columns,
    )
    return case, mesh, how


def _under(case: Case, nominal: MeshTable, loading: Array) -> MeshTable:
    """Mesh of a case under these forces; what is told of it at rest is that of the torque."""
    from tribodyn.mesh.build import loaded_mesh

    settings = contact_settings(case)
    table = loaded_mesh(
        case.gear_pair,
        settings,
        (case.pinion_speed, case.pinion_torque),
        force_law=mesh_law_of(case) == "force-law",
        loading=loading,
    ).table(settings)
    return replace(
        table,
        static_transmission_error=nominal.static_transmission_error
        - nominal.film_offset
        + table.film_offset,
        tooth_transmission_error=nominal.tooth_transmission_error,
        mesh_stiffness_tangent=nominal.mesh_stiffness_tangent,
    )


def _loading(kind: str, case: Case, mesh: MeshTable, progress: Progress) -> Array:
    """Force of all pairs over that of the torque alone that follows from a mesh."""
    if kind == "static":
        return balanced_load(case, mesh)
    response = motion_of(case, whole_system(case, mesh), mesh.mesh_frequency, progress)
    if response.periods > 1:
        what = f"the motion repeats only after {response.periods} mesh cycles"
        why = "Then the load of the teeth is not a function of the mesh phase"
        remedy = 'Set solver.coupling = "static", or dynamics.friction_load = "dynamic"'
        raise ComputationError(what, "solver.coupling", why, remedy)
    return force_at_knots(mesh, response) / mesh.total_normal_force


def balanced_load(case: Case, mesh: MeshTable) -> Array:
    """Force of all pairs at rest, over that of the torque alone, with friction in the balance.

    With one torque held it is the force that holds it; with both, that which leaves both gears
    the same acceleration along the line of action.
    """
    held = {"drive": case.gears.driver, "both": None}.get(
        case.operation.torque_balance, "wheel" if case.gears.driver == "pinion" else "pinion"
    )
    body, direction, friction = geometry(case), np.atleast_2d(mesh.direction), mesh.friction
    above = below = np.zeros(1)
    for gear in ("pinion", "wheel"):
        if held not in (gear, None):
            continue
        turn = COORDINATES.index(f"{gear}_theta")
        lever = direction[:, turn] / (1.0 if held else body[f"moment_of_inertia_{gear}"])
        above = above + lever * direction[:, turn]
        below = below + lever * (direction[:, turn] + friction[:, turn])
    return np.asarray(above / below)


def force_at_knots(mesh: MeshTable, response: Response) -> Array:
    """Force of a periodic motion at the knots of a mesh, on both sides of every event."""
    from scipy.interpolate import Akima1DInterpolator

    samples, grid = response.fine, mesh.grid
    phase, force = one_sided_phase(samples), mesh_force(samples)
    found = np.empty(grid.phase.size)
    for knots in grid.segments:
        places = grid.phase[knots]
        inside = np.flatnonzero((phase > places[0]) & (phase < places[-1]))
        # A step ends where the next begins: of both sides one is enough.
        here = inside[np.diff(phase[inside], prepend=-1.0) > _SAME]
        # Chords would blunt the force at its peaks; it has kinks where flanks part.
        curve = Akima1DInterpolator(phase[here], force[here], method="makima")
        found[knots] = curve(np.clip(places, *phase[here[[0, -1]]]))
    return found


def _changes(before: MeshTable, after: MeshTable) -> tuple[float, float, float, float]:
    """Greatest change of shares, films, friction and stiffness from one mesh to the next."""
    film = 0.0
    for name in ("central_film", "minimum_film"):
        one, other = getattr(before, name), getattr(after, name)
        if other is not None:
            known = (one > 0.0) & (other > 0.0)
            film = max(film, float(np.abs(np.log(other[known] / one[known])).max(initial=0.0)))
    scales = {
        "load_share": 1.0,
        "friction_coefficient": float(after.friction_coefficient.max()) or 1.0,
        "mesh_stiffness": after.mean_mesh_stiffness,
    }
    share, friction, stiffness = (
        float(np.abs(getattr(after, name) - getattr(before, name)).max()) / scale
        for name, scale in scales.items()
    )
    return share, film, friction, stiffness


def _oil(before: Case, after: Case) -> float:
    one, other = before.lubricant_properties, after.lubricant_properties
    if one is None or other is None:
        return 0.0
    return abs(float(np.log(other.dynamic_viscosity / one.dynamic_viscosity)))


def _unsettled(kind: str, rows: list[tuple[float, ...]]) -> Problem:
    last = rows[-1][0]
    factor = last / rows[-2][0] if len(rows) > 1 else np.inf
    remedy = (
        'Set solver.coupling = "static", whose load is that at rest; or give more damping or torque'
        if kind == "dynamic"
        else "Give more torque or a smaller friction coefficient"
    )
    return Problem(
        f"load, film and friction do not settle: the load still changes by {100.0 * last:.2g} % in "
        f"pass {len(rows)}, {factor:.2g} times the change before",
        "solver.coupling",
        "Each pass throws the load further than the one before: teeth that part, a resonance, or "
        "friction that nearly holds the torque",
        f'{remedy}, or set solver.coupling = "none"',
    )
