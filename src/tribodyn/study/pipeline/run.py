"""Pipeline of a run: case, gear pair, mesh cycle, motion, result."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from tribodyn.errors import Argument, InputError, ModelWarning, collected, frames
from tribodyn.nomenclature import PAIR_MESH
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.read import unchanged_files
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.coupling import Coupling, Follow, PairTeeth, coupling_of
from tribodyn.study.first_use import compile_in_parallel
from tribodyn.study.mesh_inputs import mesh_inputs
from tribodyn.study.pipeline.assembly import damping_of, system_of, whole_system
from tribodyn.study.pipeline.cautions import (
    case_cautions,
    friction_cautions,
    friction_suspected,
    load_cautions,
    mesh_cautions,
    motion_cautions,
    teeth_cautions,
)
from tribodyn.study.pipeline.motion import (
    may_balance,
    motion_of,
    motions_of,
    slow_cautions,
    steps_of,
)
from tribodyn.study.pipeline.response_series import measured, mesh_force
from tribodyn.study.pipeline.result import PairResult
from tribodyn.study.pipeline.result_of_case import Result
from tribodyn.study.pipeline.store import Stored
from tribodyn.study.pipeline.stored_motion import NOMINAL, read_friction, read_passes, read_response
from tribodyn.study.pipeline.tooth_contact import (
    film_group,
    load_friction_of,
    mesh_of,
    meshes_of,
    teeth_contact_ratio,
)
from tribodyn.study.settle import settle

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.heat_balance import HeatBalance
    from tribodyn.study.machine.case import AnyCase
    from tribodyn.study.pipeline.assembly import Damping


def run(
    case: AnyCase,
    progress: Progress = SILENT,
    *,
    stacklevel: int = 2,
    follow: Follow | None = None,
) -> Result:
    """Compute a case of any kind.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    progress : Progress
        Receives the progress of the run; silent by default.
    stacklevel : int
        Frames to skip in warnings, as in :func:`warnings.warn`.
    follow : callable, optional
        Called with the case and its mesh in every pass of ``solver.coupling``; returns the case
        with the values that follow from them, such as oil at another temperature. Of pairs.

    Returns
    -------
    Result

    Raises
    ------
    InputError
        If a value of the case is missing or invalid.
    ComputationError
        If no steady motion is found.

    Warns
    -----
    ModelWarning
        Every warning of the models, once each; also in ``Result.warnings``.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> result = run(case)  # doctest: +SKIP
    """
    from tribodyn.study.machine.run import run_machine

    result: Result
    if not case.lumped:
        if follow is not None:
            why = "It takes a pair of gears and the table of its mesh"
            raise InputError("follow is given", Argument("follow"), why, "Leave it out")
        result = run_machine(case, progress)
    else:
        with nullcontext() if _has_marched() else compile_in_parallel(case):
            result = computed(case, progress, follow=follow)
    for warning in result.warnings:
        warnings.warn(warning, stacklevel=frames(stacklevel, sys._getframe()))
    return result


def _has_marched() -> bool:
    """Whether this process has already loaded the time integration kernel."""
    from tribodyn.dynamics._engine.marching import march_block

    return bool(getattr(march_block, "signatures", ()))


def rehearse(case: PairCase) -> tuple[ModelWarning, ...]:
    """Raise the input errors of a run without computing it; return its warnings on the load."""
    from tribodyn.dynamics.equations.program import compile_system
    from tribodyn.dynamics.equations.step_limit import FEWEST, refuse_steps

    with locate_errors(case), collected():
        mesh = mesh_of(case, rehearsal=True)
        system = whole_system(case, mesh, rehearsal=True)
        compile_system(system, FEWEST)  # the tables of a slow run take gigabytes
        slow = slow_cautions(case, system, mesh.mesh_frequency)
        steps = 0 if may_balance(case) else steps_of(case, system, mesh.mesh_frequency)
        if steps and not slow:
            refuse_steps(system, mesh.mesh_frequency, steps)
    return (*slow, *load_cautions(mesh, teeth_contact_ratio(mesh_inputs(case))))


def computed(
    case: PairCase,
    progress: Progress = SILENT,
    mesh_source: Callable[[], MeshTable] | None = None,
    follow: Follow | None = None,
) -> PairResult:
    """Compute a case without raising the warnings of the models, which the result holds.

    ``mesh_source`` returns its mesh table if a study has already computed loads and films.
    """
    return prepare_run(case, progress, mesh_source, follow).result(progress)


@dataclass
class PreparedRun:
    """A case with mesh and structure, ready for its motion, which studies find in batches."""

    case: PairCase
    mesh: MeshTable
    coupling: Coupling | None
    heat: HeatBalance | None
    friction: MeshFriction | None
    damping: Damping
    system: System
    model_warnings: list[ModelWarning]
    motion: Callable[[], Response] | None = None  #: samples the motion, if it was found in a batch

    @property
    def response(self) -> Response | None:
        """Newly sampled motion, if it was found in a batch."""
        return None if self.motion is None else self.motion()

    def result(self, progress: Progress = SILENT) -> PairResult:
        """Return the result, after computing the motion if no batch has found it."""
        case, mesh, response, compared = self.case, self.mesh, self.response, None
        with unchanged_files(case), locate_errors(case), collected() as model_warnings:
            if response is None:
                with friction_suspected([mesh]):
                    response = motion_of(case, self.system, mesh.mesh_frequency, progress)
            if self.friction is not None:
                table = system_of(case, mesh, self.damping)
                compared = motion_of(case, table, mesh.mesh_frequency, progress)
        cautions = (
            *mesh_cautions(mesh),
            *motion_cautions(case, self.system, response),
            *friction_cautions(self.friction, mesh_force(measured(response))),
        )
        everything = (
            *case_cautions(case),
            *teeth_cautions(case),
            *self.model_warnings,
            *model_warnings,
            *cautions,
        )
        unique_warnings = tuple({str(warning): warning for warning in everything}.values())
        parts = case, mesh, self.system, response, self.damping, unique_warnings
        return PairResult(*parts, self.friction, compared, self.coupling, self.heat)


def prepare_run(
    case: PairCase,
    progress: Progress = SILENT,
    mesh_source: Callable[[], MeshTable] | None = None,
    follow: Follow | None = None,
) -> PreparedRun:
    """Compute mesh and structure of a case; the motion follows in :meth:`PreparedRun.result`."""
    with unchanged_files(case), locate_errors(case), collected() as model_warnings:
        progress.start("Tooth contact")
        start = PairTeeth(case, progress, follow, mesh_source)
        coupling = case.solver.coupling, case.solver.coupling_tolerance
        settled = settle(start, *coupling, case.lubricant, [case.lubricant])
        point, mesh = settled.point, settled.tables[PAIR_MESH]
        to = settled.temperatures
        case = (point if to is None else point.at(to)).case
        friction = load_friction_of(mesh_inputs(case), mesh)
        damping = damping_of(case, mesh)
        system = system_of(case, mesh, damping, friction)
        progress.finish()
    parts = case, mesh, coupling_of(settled), settled.heat, friction, damping, system
    return PreparedRun(*parts, model_warnings)


def restored(case: PairCase, stored: Stored) -> PairResult:
    """Result from its folder; the forces along its motion are computed again."""
    (load,) = stored.loads
    data, (mesh,) = load.data, load.tables.values()
    with locate_errors(case):
        friction = read_friction(mesh, data)
        damping = damping_of(case, mesh)
        system = system_of(case, mesh, damping, friction)
        response = read_response(system, data)
        compared = None  # nor has a folder of the last version it
        if f"{NOMINAL}time" in data:
            compared = read_response(system_of(case, mesh, damping), data, NOMINAL)
    passes = [read_passes(name, mesh, data) for name in ("coupling", "heat")]
    parts = case, mesh, system, response, damping, stored.warnings
    result = PairResult(*parts, friction, compared, *passes)
    vars(result)["figures"] = stored.summary
    return result


class PendingRun(NamedTuple):
    """A case to be prepared, and the source of its mesh table if the study has computed it."""

    case: PairCase
    mesh_source: Callable[[], MeshTable] | None = None


def with_tables(pending: Sequence[PendingRun]) -> list[PendingRun]:
    """Add the mesh tables of cases that differ in speed and load alone, computed in one pass."""
    places: dict[Any, list[int]] = {}
    for place, (case, mesh_source) in enumerate(pending):
        oil = case.lubricant
        follows = case.solver.coupling != "none" or (oil is not None and oil.heat_transfer)
        if mesh_source is None and not follows and (key := film_group(case)) is not None:
            places.setdefault(key, []).append(place)
    filled = list(pending)
    for group in places.values():
        tables = meshes_of([mesh_inputs(pending[place].case) for place in group])
        for place, table in zip(group, tables, strict=False):
            filled[place] = pending[place]._replace(mesh_source=table)
    return filled


def find_motions(points: Sequence[PreparedRun]) -> None:
    """Find the motions of as many cases as possible in one batch."""
    motions = motions_of(
        [(point.case, point.system, point.mesh.mesh_frequency) for point in points]
    )
    for point, motion in zip(points, motions, strict=True):
        point.motion = motion
