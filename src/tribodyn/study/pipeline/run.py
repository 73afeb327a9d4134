"""The one pipeline: case, gear pair, mesh cycle, motion, result."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING

from tribodyn.errors import ModelWarning, collected, frames
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.derive import placed
from tribodyn.study.case.read import unchanged_files
from tribodyn.study.coupling import Follow, coupled
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
from tribodyn.study.pipeline.motion import motion_of, steps_of
from tribodyn.study.pipeline.result import Result
from tribodyn.study.pipeline.tooth_contact import load_friction_of, mesh_of

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.case import Case


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
    result = computed(case, progress, follow=follow)
    for warning in result.warnings:
        warnings.warn(warning, stacklevel=frames(stacklevel, sys._getframe()))
    return result


def rehearse(case: Case) -> tuple[ModelWarning, ...]:
    """Refuse what a run would refuse because of the case alone; tell what it would of the load."""
    from tribodyn.dynamics.equations.compiled import compile_for

    with placed(case), collected():
        mesh = mesh_of(case, rehearsal=True)
        system = system_of(case, mesh, damping_of(case, mesh))
        steps = steps_of(case, system, mesh.mesh_frequency)
        compile_for(system, mesh.mesh_frequency, steps)
    return load_cautions(mesh)


def computed(
    case: Case,
    progress: Progress = SILENT,
    known: Callable[[], MeshTable] | None = None,
    follow: Follow | None = None,
) -> Result:
    """Compute a case; what the models said is kept in the result alone.

    ``known`` gives its mesh table where a study has loads and films at hand.
    """
    with unchanged_files(case), placed(case), collected() as found:
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
        with friction_suspected(mesh):
            response = motion_of(case, system, mesh.mesh_frequency, progress)
        compared = None
        if friction is not None:
            table = system_of(case, mesh, damping)
            compared = motion_of(case, table, mesh.mesh_frequency, progress)
    noticed = (
        *mesh_cautions(mesh),
        *motion_cautions(case, system, response),
        *friction_cautions(friction, response),
    )
    everything = (*case_cautions(case), *teeth_cautions(case), *found, *noticed)
    told = tuple({str(warning): warning for warning in everything}.values())
    return Result(case, mesh, system, response, damping, told, friction, compared, coupling, heat)
