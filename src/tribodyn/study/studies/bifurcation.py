"""The motion of a case over one of its values: jumps, doubled periods, chaos."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, Problem, collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.derive import placed
from tribodyn.study.case.provenance import spec_of
from tribodyn.study.pipeline.motion import steps_of
from tribodyn.study.studies.axes import ends_of
from tribodyn.study.studies.grid import varied

if TYPE_CHECKING:
    from tribodyn.analysis.bifurcation_result import Bifurcation
    from tribodyn.dynamics import System
    from tribodyn.study.case.case import Case


#: Steps over those at which a single motion is accurate to about 1e-6, and the fewest.
_COARSER, _FEWEST = 4, 512
#: Steps of all values are those of the slowest where these are no more than this times as many;
#: values of one structure are then marched side by side.
_ALIKE = 2


def bifurcation(
    case: Case,
    over: str = "operation.speed",
    between: tuple[Any, Any] | None = None,
    points: int = 300,
    *,
    steps: int | None = None,
    by: str = "",
    progress: Progress = SILENT,
    **options: Any,
) -> Bifurcation:
    """Follow the motion of a case over one of its values.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    over : str
        Dotted key of the value that varies.
    between : tuple
        Its two ends: floats in SI, or text with a unit.
    points : int
        Values, evenly spaced, the ends included.
    steps : int, optional
        Steps per mesh cycle; those of the case, else a quarter of what a single run takes and at
        least 512. Every motion is judged by a repetition with half the step.
    by : str
        What asks, for messages; then a bare number for a dimension is refused as in a file.
    progress : Progress
        Told how far the study has come; silent by default.
    **options : object
        ``sweep``, ``cycles``, ``transient``, ``keep``, ``signal``, ``verdict``, ``exponents`` and
        ``keep_partial`` of :func:`tribodyn.analysis.bifurcation`.

    Returns
    -------
    Bifurcation
        Its parameter is in the unit of the key, SI.

    Raises
    ------
    InputError
        If the key is unknown or not a number, or a value is out of range.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> found = bifurcation(case, between=("1800 rpm", "2000 rpm"), points=2, transient=20)
    >>> found.parameter_name, found.parameter.round(1).tolist()
    ('operation.speed', [188.5, 209.4])
    """
    from tribodyn.analysis import bifurcation as compute

    values = _values(case, over, between, points, by)
    systems, frequency, counts = _systems(case, over, values, steps, progress)
    return compute(
        systems,
        frequency,
        parameter=values,
        parameter_name=over,
        parameter_unit=_unit(case, over),
        steps=counts,
        progress=progress,
        **options,
    )


def _systems(
    case: Case, over: str, values: Any, steps: int | None, progress: Progress
) -> tuple[list[System], list[float], list[int]]:
    """Structure, mesh frequency and steps of every value; one structure where none differs."""
    same = over == "operation.speed" and _contact_without_speed(case)
    changes = [{over: float(value)} for value in values]
    with placed(case), collected():
        members = varied(case, changes[:1] if same else changes, progress)
        systems = [member.system for member in members]
        frequency = [member.mesh.mesh_frequency for member in members]
        cases = [member.case for member in members]
        if same:
            systems *= len(values)
            frequency = [frequency[0] * float(value) / float(values[0]) for value in values]
            cases = [case.replace(change) for change in changes]
        counts = [
            steps or _steps(*member) for member in zip(cases, systems, frequency, strict=True)
        ]
    if same and max(counts) <= _ALIKE * min(counts):
        counts = [max(counts)] * len(counts)
    return systems, frequency, counts


def _contact_without_speed(case: Case) -> bool:
    """Whether nothing in the tooth contact depends on how fast the gears turn."""
    return case.film.model == "none" and case.friction.law in ("none", "constant")


def _steps(case: Case, system: System, mesh_frequency: float) -> int:
    accurate = steps_of(case, system, mesh_frequency)
    return case.solver.steps_per_mesh_cycle or max(_FEWEST, accurate // _COARSER)


def _values(case: Case, over: str, between: tuple[Any, Any] | None, points: int, by: str) -> Any:
    """Values of the key in SI; the two ends are checked like the key of the case."""
    if between is None or len(between) != 2 or int(points) != points or points < 2:
        raise InputError(
            Problem(
                f"between = {between}, points = {points}",
                "argument between",
                "A diagram goes from one value to another in at least two points",
                'Write, for example, between=("400 rpm", "3500 rpm")',
            )
        )
    first, last = ends_of(case, over, between, by=by)
    return np.linspace(first, last, int(points))


def _unit(case: Case, over: str) -> str:
    spec = spec_of(case, over)
    return str(spec.unit) if spec is not None and spec.unit else "-"
