"""The one pipeline: case, gear pair, mesh cycle, motion, result."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from tribodyn.errors import ModelWarning, collected, frames
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.derive import locate_errors
from tribodyn.study.case.read import unchanged_files
from tribodyn.study.coupling import Follow, coupled
from tribodyn.study.first_use import compile_in_parallel
from tribodyn.study.heat_balance import balanced
from tribodyn.study.pipeline.assembly import damping_of, system_of
from tribodyn.study.pipeline.cautions import (
    case_cautions,
    friction_cautions,
    friction_suspected,
    load_cautions,
    mesh_cautions,
    motion_cautions,
    teeth_cautions,
)
from tribodyn.study.pipeline.computed import Coupling
from tribodyn.study.pipeline.motion import motion_of, motions_of, steps_of
from tribodyn.study.pipeline.result import Result
from tribodyn.study.pipeline.tooth_contact import (
    alike,
    load_friction_of,
    mesh_of,
    meshes_of,
    teeth_contact_ratio,
)

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case.case import Case
    from tribodyn.study.heat_balance import HeatBalance
    from tribodyn.study.pipeline.assembly import Damping


def run(
    case: Case, progress: Progress = SILENT, *, stacklevel: int = 2, follow: Follow | None = None
) -> Result:
    """Compute a case.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    progress : Progress
        Told how far the run has come; silent by default.
    stacklevel : int
        Frames to skip in warnings, as in :func:`warnings.warn`.
    follow : callable, optional
        Takes the case and its mesh in every pass of ``solver.coupling``, and returns the case with
        what follows from them, such as oil at another temperature.

    Raises
    ------
    InputError
        If the case cannot be computed as it stands.
    ComputationError
        If no steady motion is found.

    Warns
    -----
    ModelWarning
        Everything that the models said, once each; also kept in ``Result.warnings``.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> result = run(case)  # doctest: +SKIP
    """
    with nullcontext() if _has_marched() else compile_in_parallel(case):
        result = computed(case, progress, follow=follow)
    for warning in result.warnings:
        warnings.warn(warning, stacklevel=frames(stacklevel, sys._getframe()))
    return result


def _has_marched() -> bool:
    """Whether this process has loaded the engine already, and so most of what it needs."""
    from tribodyn.dynamics._engine.marching import march_block

    return bool(getattr(march_block, "signatures", ()))


def rehearse(case: Case) -> tuple[ModelWarning, ...]:
    """Refuse what a run would refuse because of the case alone; tell what it would of the load."""
    from tribodyn.dynamics.equations.compiled import compile_for

    with locate_errors(case), collected():
        mesh = mesh_of(case, rehearsal=True)
        system = system_of(case, mesh, damping_of(case, mesh))
        steps = steps_of(case, system, mesh.mesh_frequency)
        compile_for(system, mesh.mesh_frequency, steps)
    return load_cautions(mesh, teeth_contact_ratio(case))


def computed(
    case: Case,
    progress: Progress = SILENT,
    known: Callable[[], MeshTable] | None = None,
    follow: Follow | None = None,
) -> Result:
    """Compute a case; what the models said is kept in the result alone.

    ``known`` gives its mesh table where a study has loads and films at hand.
    """
    return begin(case, progress, known, follow).result(progress)


@dataclass
class Begun:
    """A case up to its motion, which studies find side by side."""

    case: Case
    mesh: MeshTable
    coupling: Coupling | None
    heat: HeatBalance | None
    friction: MeshFriction | None
    damping: Damping
    system: System
    told: list[ModelWarning]
    motion: Callable[[], Response] | None = None  #: samples its motion, where that is known

    @property
    def response(self) -> Response | None:
        """Its motion, where it is known, sampled anew."""
        return None if self.motion is None else self.motion()

    def result(self, progress: Progress = SILENT) -> Result:
        """Find the motion if it is not known, and the result."""
        case, mesh, response, compared = self.case, self.mesh, self.response, None
        with unchanged_files(case), locate_errors(case), collected() as found:
            if response is None:
                with friction_suspected(mesh):
                    response = motion_of(case, self.system, mesh.mesh_frequency, progress)
            if self.friction is not None:
                table = system_of(case, mesh, self.damping)
                compared = motion_of(case, table, mesh.mesh_frequency, progress)
        noticed = (
            *mesh_cautions(mesh),
            *motion_cautions(case, self.system, response),
            *friction_cautions(self.friction, response),
        )
        everything = (*case_cautions(case), *teeth_cautions(case), *self.told, *found, *noticed)
        told = tuple({str(warning): warning for warning in everything}.values())
        parts = case, mesh, self.system, response, self.damping, told
        return Result(*parts, self.friction, compared, self.coupling, self.heat)


def begin(
    case: Case,
    progress: Progress = SILENT,
    known: Callable[[], MeshTable] | None = None,
    follow: Follow | None = None,
) -> Begun:
    """Compute a case up to its motion, as :func:`computed`."""
    with unchanged_files(case), locate_errors(case), collected() as found:
        progress.start("Tooth contact")

        def mesh_at(point: Case) -> tuple[Case, MeshTable, Coupling | None]:
            if case.solver.coupling != "none":
                return coupled(point, progress, follow)
            return point, mesh_of(point, progress) if known is None else known(), None

        heat = None
        if case.lubricant is not None and case.lubricant.heat_transfer is not None:
            known = None  # loads and films at hand belong to another temperature
            case, mesh, coupling, heat = balanced(case, mesh_at)
        else:
            case, mesh, coupling = mesh_at(case)
        friction = load_friction_of(case, mesh)
        damping = damping_of(case, mesh)
        system = system_of(case, mesh, damping, friction)
        progress.finish()
    return Begun(case, mesh, coupling, heat, friction, damping, system, found)


class Asked(NamedTuple):
    """A case that is to be begun, and its mesh table where a study has loads and films at hand."""

    case: Case
    known: Callable[[], MeshTable] | None = None


def with_tables(asked: Sequence[Asked]) -> list[Asked]:
    """Add the mesh tables of cases that differ by speed and load alone, computed in one pass."""
    places: dict[Any, list[int]] = {}
    for place, (case, known) in enumerate(asked):
        oil = case.lubricant
        follows = case.solver.coupling != "none" or (oil is not None and oil.heat_transfer)
        if known is None and not follows and (key := alike(case)) is not None:
            places.setdefault(key, []).append(place)
    found = list(asked)
    for group in places.values():
        tables = meshes_of([asked[place].case for place in group])
        for place, table in zip(group, tables, strict=False):
            found[place] = asked[place]._replace(known=table)
    return found


def move_together(points: Sequence[Begun]) -> None:
    """Find motions side by side, of as many cases as that is possible for."""
    motions = motions_of([(each.case, each.system, each.mesh.mesh_frequency) for each in points])
    for each, motion in zip(points, motions, strict=True):
        each.motion = motion
