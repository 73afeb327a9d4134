"""Build the structure of a case: the system that vibrates, and its mesh frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribodyn.errors import collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.pipeline.motion import steps_of
from tribodyn.study.studies.case_grid import built

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.study.case.case import Case

#: Factor by which a study takes fewer steps than a single motion (accurate to about 1e-6), and the
#: smallest number of steps.
_COARSER, _FEWEST = 4, 512


def build_system(case: Case, *, progress: Progress = SILENT) -> tuple[System, float]:
    """Build the structure of a case with its tooth contact, ready for every nonlinear method.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    progress : Progress
        Receives the progress of the tooth contact; silent by default.

    Returns
    -------
    tuple of System and float
        The structure under the load of the case, and its mesh frequency [Hz].

    Raises
    ------
    InputError
        If a value of the case is missing or invalid.

    Examples
    --------
    >>> import tribodyn
    >>> system, mesh_frequency = build_system(tribodyn.load_case("fzg-roughness"))
    >>> system.size, round(mesh_frequency, 1)
    (6, 240.0)
    """
    with locate_errors(case), collected():
        progress.start("Tooth contact")
        member = built(case)
        progress.finish()
    return member.system, member.mesh.mesh_frequency


def study_steps(case: Case, system: System, mesh_frequency: float) -> int:
    """Steps per mesh cycle of a study of many motions: those of the case, or a coarse default."""
    accurate = steps_of(case, system, mesh_frequency)
    return case.solver.steps_per_mesh_cycle or max(_FEWEST, accurate // _COARSER)
