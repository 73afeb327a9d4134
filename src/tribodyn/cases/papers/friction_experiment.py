"""Experiment on the effect of friction on one running gear pair, all other values held constant.

Friction laws and roughnesses vary for every choice of the driving gear and of the torque that is
held constant. Load shares and oil films do not depend on them: they are computed once per driver.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.cases.papers.computations import Meshes
from tribodyn.cases.papers.friction_claims import CONSTANT, MIXED, NONE, FrictionExperiment, Rubbing
from tribodyn.checkpoints import Checkpoints
from tribodyn.errors import InputError, collected
from tribodyn.nomenclature import GEARS
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.to_models import locate_errors
from tribodyn.study.pipeline.run import PendingRun
from tribodyn.study.studies.needs import require
from tribodyn.study.studies.runner import identity, run_each
from tribodyn.study.studies.study_axes import Axis, ends_of
from tribodyn.study.studies.sweep import compute_points, pair_source
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase

#: Laws that are compared; ``constant`` takes COEFFICIENTS, and the mean of MIXED at each roughness.
LAWS = ("none", "constant", "benedict-kelly", "xu-2007", "mixed", "mixed-ehl", "ehl")
#: Coefficients of the sources: the one measured on the rig, and three that a source compares.
COEFFICIENTS = (0.035, 0.05, 0.15, 0.25)
#: Composite roughnesses [m]: those of the sources within the range of the laws, and some between.
ROUGHNESSES = (0.1e-6, 0.325e-6, 0.4e-6, 0.53e-6, 0.7e-6, 0.8e-6, 0.991e-6)
DRIVERS, BALANCES = GEARS, ("drive", "load", "both")
#: Laws that need the thickness of the film.
_ON_FILM = frozenset({"mixed", MIXED, "matsumoto"})
_KEYS = ("gears.driver", "operation.torque_balance", "friction")


@with_old_names
def friction_experiment(
    case: PairCase,
    *,
    roughness: Sequence[Any] | None = None,
    laws: Sequence[str] = LAWS,
    coefficients: Sequence[float] = COEFFICIENTS,
    partial: bool = False,
    progress: Progress = SILENT,
    checkpoints: Checkpoints | None = None,
) -> FrictionExperiment:
    """Compare friction laws and roughnesses on one gear pair, and judge five published claims.

    Parameters
    ----------
    case : PairCase
        From :func:`tribodyn.load_case`; a pair of computed teeth with its oil.
    roughness : sequence of float or str, optional
        Composite roughnesses: floats in m, or text with a unit; by default seven from 0.1 to
        0.991 um.
    laws : sequence of str
        Names in :data:`tribodyn.friction.LAWS`; ``"none"`` is always added as the reference.
    coefficients : sequence of float
        Coefficients of the law ``"constant"``, in addition to the mean of ``"mixed-ehl"`` at each
        roughness.
    partial : bool
        Return the finished steady states when interrupted with Ctrl-C, instead of raising.
    progress : Progress
        Receives the number of finished steady states; silent by default.
    checkpoints : tribodyn.checkpoints.Checkpoints, optional
        Stores each finished state, and restores those that a killed process had finished.

    Returns
    -------
    FrictionExperiment
        All figures of the summary over driving gear, held torque and friction, and ``claims``.

    Raises
    ------
    InputError
        If a law is unknown, a roughness out of range, or the case has no computed teeth or no oil.
    ComputationError
        If the films of the pair cannot be solved.

    Notes
    -----
    The film is that of the case, or ``"newton"`` where a law shears the film and none is solved. A
    law whose coefficients are the same at the least and the greatest roughness is computed once.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> experiment = friction_experiment(case, laws=["xu-2007"], roughness=["0.4 um", "0.8 um"])
    >>> bool(experiment.change("rms_mesh_force")[0, 0, -1] < 0.0)
    True
    """
    require("experiment", case)
    heights = _roughnesses(case, ROUGHNESSES if roughness is None else roughness)
    named = _laws(laws)
    base = _with_film(case, named)
    meshes = _loaded(base, progress)
    rubbing = tuple(_list_frictions(base, meshes, named, heights, coefficients))
    frictions = {applied.name: applied for applied in rubbing}
    axes = (Axis(_KEYS[0], DRIVERS), Axis(_KEYS[1], BALANCES), Axis(_KEYS[2], tuple(frictions)))

    def pending_at(driver: str, balance: str, friction: str) -> PendingRun:
        changed = _case_with(base, frictions[friction], meshes, driver)
        changed = changed.replace({_KEYS[1]: balance})
        return PendingRun(changed, lambda: meshes.table(changed))

    study = identity("friction", base, [(axis.key, axis.values) for axis in axes])
    points = compute_points(
        axes, pair_source(pending_at), study, checkpoints, partly=partial, progress=progress
    )
    return FrictionExperiment(base, axes, points, rubbing)


def _roughnesses(case: PairCase, values: Sequence[object]) -> tuple[float, ...]:
    if isinstance(values, str) or not len(values):
        remedy = 'Write, for example, ["0.4 um", "0.8 um"]'
        raise InputError(
            f"roughness = {values!r}", "argument roughness", "It must be a list", remedy
        )
    return tuple(sorted(set(ends_of(case, "gears.composite_roughness", values))))


def _laws(names: Sequence[str]) -> tuple[str, ...]:
    from tribodyn.friction import LAWS as LAW_REGISTRY

    for name in names:
        LAW_REGISTRY[name]  # raises an error that lists the laws
    return tuple(dict.fromkeys((NONE, *names)))


def _with_film(case: PairCase, laws: Sequence[str]) -> PairCase:
    """Return the case with the film that the laws need, not in series, and one roughness."""
    from tribodyn.ehl import FILM_MODELS
    from tribodyn.friction import LAWS as LAW_REGISTRY

    if case.spur_pair is None:
        remedy = "Take a case of spur gears"
        what, why = f'gears.kind = "{case.gears.kind}"', "The experiment solves films of spur gears"
        raise InputError(what, "argument case", why, remedy)
    changes: Tree = {}
    solved = FILM_MODELS[case.film.model].method
    if any(LAW_REGISTRY[name].needs_film for name in laws) and not solved:
        changes["film.model"] = "newton"
    if case.film.model == "none" and not _ON_FILM.isdisjoint(laws):
        changes.setdefault("film.model", "dowson-higginson")
    if changes and "film.stiffness" not in case.user_input:
        changes["film.stiffness"] = "none"  # the teeth stay those of the case
    heights = [
        f"gears.{gear}.{name}" for gear in DRIVERS for name in ("roughness_rms", "roughness_ra")
    ]
    cleared = {key: None for key in heights if key in case.user_input}
    rough = {"gears.composite_roughness": case.composite_roughness} if cleared else {}
    return case.replace({**changes, **cleared, **rough})


def _loaded(base: PairCase, progress: Progress) -> Meshes:
    """Compute loads and films of the pair for each driving gear."""
    meshes = Meshes()

    def load(driver: str) -> None:
        case = base.replace({_KEYS[0]: driver})
        with locate_errors(case), collected():
            meshes.loaded(case)

    run_each(load, DRIVERS, task="Loads and films", progress=progress)
    return meshes


def _list_frictions(
    base: PairCase,
    meshes: Meshes,
    laws: Sequence[str],
    heights: Sequence[float],
    coefficients: Sequence[float],
) -> list[Rubbing]:
    """List every combination of law, roughness and coefficient of the experiment."""
    frictions = []
    for law in laws:
        if law == CONSTANT:
            frictions += [Rubbing(law, heights[0], float(c), varies=False) for c in coefficients]
            if MIXED in laws:
                frictions += [Rubbing(law, height, as_mixed=True) for height in heights]
            continue
        by_roughness = [Rubbing(law, height) for height in heights]
        if len(heights) > 1 and _same_coefficients(base, meshes, by_roughness[0], by_roughness[-1]):
            by_roughness = by_roughness[:1]
        frictions += [
            friction._replace(varies=len(by_roughness) > 1 or law == MIXED)
            for friction in by_roughness
        ]
    return frictions


def _same_coefficients(base: PairCase, meshes: Meshes, smooth: Rubbing, rough: Rubbing) -> bool:
    """Whether two frictions have the same coefficients; False if a law cannot be applied."""
    try:
        with collected():
            coefficients, others = (
                meshes.table(_case_with(base, friction, meshes, DRIVERS[0])).friction_coefficient
                for friction in (smooth, rough)
            )
    except InputError:
        return False
    return bool(np.array_equal(coefficients, others))


def _case_with(base: PairCase, friction: Rubbing, meshes: Meshes, driver: str) -> PairCase:
    changes = {_KEYS[0]: driver, "gears.composite_roughness": friction.roughness}
    if friction.as_mixed:
        mixed = base.replace({**changes, "friction.law": MIXED})
        with collected():
            mean = meshes.table(mixed).mean_friction_coefficient
        return base.replace({**changes, "friction.law": CONSTANT, "friction.coefficient": mean})
    chosen: Tree = {**changes, "friction.law": friction.law}
    if friction.coefficient is not None:
        chosen["friction.coefficient"] = friction.coefficient
    return base.replace(chosen)
