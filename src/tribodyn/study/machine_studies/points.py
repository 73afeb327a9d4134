"""Points of a study of a machine or a stage: its summary for values of its keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.interrupt import STOPPED, refuse_stopped, single_blas_thread, stop_flag
from tribodyn.progress import SILENT, Progress, StageProgress
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.result import LoadResult
from tribodyn.study.machine.run import MeshWarning, run_load
from tribodyn.study.planetary.case import PlanetaryCase
from tribodyn.study.planetary.result import PlanetaryLoadResult
from tribodyn.study.planetary.run import run_load as run_stage
from tribodyn.study.studies.sweep_result import SweepPoint

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.study.machine.user_tables import PartsCase

#: Result of a machine or of a planetary stage under one load.
AnyLoadResult = LoadResult | PlanetaryLoadResult


def result_under(
    case: PartsCase,
    progress: Progress,
    of_meshes: list[MeshWarning],
    start: Response | None = None,
) -> AnyLoadResult:
    """Compute a machine or a stage at its operating point, from a similar motion if any."""
    load = case.operating_point
    if isinstance(case, PlanetaryCase):
        return run_stage(case, load, progress, of_meshes, start)
    assert isinstance(case, MachineCase)
    return run_load(case, load, progress, of_meshes, start)


def results_under(
    case: PartsCase, changes: Sequence[Mapping[str, Any]], progress: Progress = SILENT
) -> Iterator[tuple[AnyLoadResult | InputError | ComputationError, tuple[str, ...]]]:
    """Results of a case at its operating point for changes of its keys, and warning codes."""
    start, stages = None, StageProgress(progress)
    for change in changes:
        refuse_stopped(STOPPED * int(stop_flag()[0]))
        of_meshes: list[MeshWarning] = []
        with collected() as caught, single_blas_thread():
            try:
                changed = case.replace(change)
                result = result_under(changed, stages, of_meshes, start)
            except (InputError, ComputationError) as error:
                yield error, ()
                continue
        start = result.response  # the next motion is similar
        yield result, tuple(w.code for w in (*caught, *(each.warning for each in of_meshes)))


def points_of_parts(
    case: PartsCase,
    keys: Sequence[str],
    places: Sequence[tuple[Any, ...]],
    progress: Progress = SILENT,
) -> list[SweepPoint]:
    """Points of a sweep; a failed one holds its reason."""
    changes = [dict(zip(keys, values, strict=True)) for values in places]
    results = results_under(case, changes, progress)
    return [
        SweepPoint.of_failure(values, result)
        if isinstance(result, InputError | ComputationError)
        else SweepPoint(values, result.figures, "", codes)
        for values, (result, codes) in zip(places, results, strict=True)
    ]
