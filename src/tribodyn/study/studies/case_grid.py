"""Cases of a study: their systems and their results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribodyn.checkpoints import Checkpoints
from tribodyn.errors import Argument, ComputationError, InputError, collected
from tribodyn.interrupt import STOPPED, refuse_stopped, single_blas_thread, stop_flag
from tribodyn.machine import system as system_of
from tribodyn.machine.reduction import default_limit, is_large, unreduced_size
from tribodyn.machine.static.supports import clearance_supports
from tribodyn.mesh import MeshTable
from tribodyn.progress import SILENT, Progress, StageProgress
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.first_use import compile_in_parallel
from tribodyn.study.machine.case import AnyCase, MachineCase
from tribodyn.study.machine.first_look import shape_figures
from tribodyn.study.machine.rated_meshes import rated_figures
from tribodyn.study.machine.result import LoadResult
from tribodyn.study.machine.result import steps_of as steps_of_machine
from tribodyn.study.machine.run import balanced_machine, run_load, structure_of
from tribodyn.study.pipeline.assembly import whole_system
from tribodyn.study.pipeline.cautions import MeshWarning
from tribodyn.study.pipeline.motion import steps_of
from tribodyn.study.pipeline.tooth_contact import mesh_of
from tribodyn.study.studies.runner import run_each
from tribodyn.study.studies.sweep_result import SweepPoint

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.study.case.pair import PairCase


class Member(NamedTuple):
    """Case of a study with its tooth contact and its structure."""

    case: PairCase
    mesh: MeshTable
    system: System


def contact_without_speed(case: PairCase) -> bool:
    """Whether the tooth contact is independent of the speed."""
    return case.film.model == "none" and case.friction.law in ("none", "constant")


def built(case: PairCase) -> Member:
    """Build tooth contact and structure of a case."""
    mesh = mesh_of(case)
    return Member(case, mesh, whole_system(case, mesh))


def varied(
    case: PairCase,
    changes: Sequence[Mapping[str, object]],
    progress: Progress,
    checkpoints: Checkpoints | None = None,
) -> list[Member]:
    """Build tooth contact and structure of a case for each change, in their order."""
    folder = checkpoints.folder if checkpoints is not None else None

    def member(index: int) -> Member:
        changed = case.replace(changes[index])
        path = folder / f"mesh-{index}.nc" if folder else None
        if path is not None and path.exists():
            with suppress(InputError):
                mesh = MeshTable.load(path)
                return Member(changed, mesh, whole_system(changed, mesh))
            path.unlink()
        built_member = built(changed)
        if path is not None:
            built_member.mesh.save(path)
        return built_member

    return run_each(member, range(len(changes)), task="Tooth contacts", progress=progress)


def results_under(
    case: MachineCase, changes: Sequence[Mapping[str, object]], progress: Progress = SILENT
) -> Iterator[tuple[LoadResult | InputError | ComputationError, tuple[str, ...]]]:
    """Results of a case at its operating point for changes of its keys, and warning codes."""
    stages = StageProgress(progress)
    for change in changes:
        refuse_stopped(STOPPED * int(stop_flag()[0]))
        of_meshes: list[MeshWarning] = []
        with collected() as caught, single_blas_thread():
            try:
                changed = case.replace(change)
                point = changed.operating_point
                result = run_load(changed, point, stages, of_meshes)
                result.figures.update(shape_figures(changed) | rated_figures(changed, result))
            except (InputError, ComputationError) as error:
                yield error, ()
                continue
        yield result, tuple(w.code for w in (*caught, *(each.warning for each in of_meshes)))


def points_of_parts(
    case: MachineCase,
    keys: Sequence[str],
    places: Sequence[tuple[object, ...]],
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


#: Factor by which a study takes fewer steps than a single motion (accurate to about 1e-6), and the
#: smallest number of steps.
COARSER, FEWEST = 4, 512


class Moving(NamedTuple):
    """Structure of a case that moves, for studies of many motions."""

    system: System
    frequency: float  #: mesh cycles in a second, of a machine periods of its clock [Hz]
    steps: int  #: per cycle of the fastest mesh
    contact: int = 0  #: contact of the mesh that is followed


def moving(case: AnyCase, mesh: str | None = None, *, rehearsal: bool = False) -> Moving:
    """Structure of a case under its load; ``mesh`` is that of a machine that is followed.

    That of a rehearsal has teeth of a few phases: its size and its steps are those of the others.
    """
    if case.lumped:
        member = built(case)
        frequency = member.mesh.mesh_frequency
        return Moving(member.system, frequency, study_steps(case, member.system, frequency))
    balanced = balanced_machine(case, case.operating_point, rehearsal=rehearsal)
    structure = structure_of(case, balanced.static.linearized())
    if supports := clearance_supports(structure):
        name = next(iter(supports))
        why = "Its force follows the motion, and its springs are not those of a contact"
        remedy = f"Remove bearings.{name}.clearance, or use run"
        raise InputError(f"bearing {name} has a clearance", Argument("case"), why, remedy)
    machine, system = structure.machine, system_of(structure)
    if system.phases:
        why = "A motion that repeats needs a clock that all meshes follow"
        remedy = 'Use run, which needs no period, or solver.phases = "off"'
        raise InputError("the meshes have no common period", Argument("case"), why, remedy)
    counts = {name: max(len(each.contacts), 1) for name, each in machine.meshes.items()}
    names = list(counts)
    first = sum(counts[name] for name in names[: names.index(mesh)]) if mesh in names else 0
    return Moving(system, machine.clock.frequency, steps_of_machine(structure), first)


#: What is left of a disturbance where a motion counts as settled; periods of the clock in which a
#: structure has to settle.
_LEFT, _LONGEST = 1e-9, 500


def settling_periods(member: Moving) -> int:
    """Periods of the clock in which the slowest mode of a machine decays, 500 at most."""
    from tribodyn.dynamics.equations.compiled import sample_system
    from tribodyn.dynamics.equations.orbit_coordinates import OverBases
    from tribodyn.dynamics.modal.contact_equations import close_contacts

    sampled = sample_system(member.system, member.steps)
    structure, _ = close_contacts(OverBases.of(sampled))
    periods = -np.log(_LEFT) * member.frequency / max(structure.decay, 1e-300)
    return int(np.ceil(min(periods, _LONGEST)))


def of_one_size(case: AnyCase, over: str, values: Sequence[float]) -> AnyCase:
    """Case whose structure has the same coordinates at all speeds: those of the greatest."""
    fixed = case.lumped or case.lone_stage or case.motion.frequency_limit is not None
    if fixed or over != "operation.speed":
        return case
    machine = case.replace({over: float(max(values, key=abs))}).machine()
    if not is_large(unreduced_size(machine)):
        return case
    return case.replace({"dynamics.frequency_limit": default_limit(machine)})


def moving_members(
    case: MachineCase, over: str, values: Sequence[float], mesh: str, progress: Progress
) -> list[Moving]:
    """Structure of a machine for each value of a key, in their order."""
    at = partial(moving_at, of_one_size(case, over, values), over, mesh)
    return run_each(at, values, task="Machines", progress=progress)


def moving_at(case: AnyCase, over: str, mesh: str, value: float) -> Moving:
    """Structure of a case at a value of a key."""
    return moving(case.replace({over: float(value)}), mesh)


@contextmanager
def many_motions(case: AnyCase) -> Iterator[None]:
    """Context of a study of many motions: errors with their place in the case, no warnings."""
    if not case.lumped:
        with collected(), single_blas_thread():
            yield
    else:
        with locate_errors(case), collected(), compile_in_parallel(case, "bifurcation"):
            yield


def build_system(case: AnyCase, *, progress: Progress = SILENT) -> tuple[System, float]:
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
        The structure under the load of the case, and its mesh frequency [Hz]; of a machine the
        periods of its clock in a second.

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
    with many_motions(case):
        progress.start("Tooth contact")
        built_case = moving(case)
        progress.finish()
    return built_case.system, built_case.frequency


def study_steps(case: PairCase, system: System, mesh_frequency: float) -> int:
    """Steps per mesh cycle of a study of many motions: those of the case, or a coarse default."""
    accurate = steps_of(case, system, mesh_frequency)
    return case.solver.steps_per_mesh_cycle or max(FEWEST, accurate // COARSER)
