"""Points of a study of a machine: its summary at the operating point for values of its keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.interrupt import STOPPED, refuse_stopped, single_blas_thread, stop_flag
from tribodyn.progress import SILENT
from tribodyn.study.machine.run import MeshWarning, run_load
from tribodyn.study.studies.sweep_result import SweepPoint

if TYPE_CHECKING:
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.result import LoadResult


def results_under(
    case: MachineCase, changes: Sequence[Mapping[str, Any]]
) -> Iterator[tuple[LoadResult | InputError | ComputationError, tuple[str, ...]]]:
    """Results of a machine at its operating point for changes of its keys, and warning codes."""
    start = None
    for change in changes:
        refuse_stopped(STOPPED * int(stop_flag()[0]))
        of_meshes: list[MeshWarning] = []
        with collected() as caught, single_blas_thread():
            try:
                changed = case.replace(change)
                load = changed.operating_point
                result = run_load(changed, load, SILENT, of_meshes, start)
            except (InputError, ComputationError) as error:
                yield error, ()
                continue
        start = result.response  # the next motion is near this one
        yield result, tuple(w.code for w in (*caught, *(each.warning for each in of_meshes)))


def machine_points(
    case: MachineCase, keys: Sequence[str], places: Sequence[tuple[Any, ...]]
) -> list[SweepPoint]:
    """Points of a sweep; a failed one holds its reason."""
    changes = [dict(zip(keys, values, strict=True)) for values in places]
    return [
        SweepPoint.of_failure(values, result)
        if isinstance(result, InputError | ComputationError)
        else SweepPoint(values, result.figures, "", codes)
        for values, (result, codes) in zip(places, results_under(case, changes), strict=True)
    ]
