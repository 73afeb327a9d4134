"""What friction does to a running gear pair: one pair, everything else held, claims judged.

Friction laws and roughnesses vary under every choice of the driving gear and of the torque that
is held. Load shares and oil films do not depend on them: they are found once for each driver.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.checkpoints import Members
from tribodyn.errors import InputError, collected
from tribodyn.progress import SILENT, Progress
from tribodyn.study.case.derive import locate_errors, mesh_law_of
from tribodyn.study.pipeline.run import Asked
from tribodyn.study.pipeline.tooth_contact import contact_settings
from tribodyn.study.studies.axes import Axis, ends_of
from tribodyn.study.studies.friction_claims import (
    CONSTANT,
    MIXED,
    NONE,
    FrictionExperiment,
    Rubbing,
)
from tribodyn.study.studies.grid import identity, over_cases
from tribodyn.study.studies.sweep import points_of

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.mesh.build import LoadedMesh
    from tribodyn.study.case.case import Case

#: Laws that are compared; ``constant`` takes COEFFICIENTS, and the mean of MIXED at each roughness.
LAWS = ("none", "constant", "benedict-kelly", "xu-2007", "mixed", "mixed-ehl", "ehl")
#: Coefficients of the sources: the measured one of the rig, and three that were compared.
COEFFICIENTS = (0.035, 0.05, 0.15, 0.25)
#: Composite roughnesses [m]: those of the sources that the laws know, and some beside them.
ROUGHNESSES = (0.1e-6, 0.325e-6, 0.4e-6, 0.53e-6, 0.7e-6, 0.8e-6, 0.991e-6)
DRIVERS, BALANCES = ("pinion", "wheel"), ("drive", "load", "both")
#: Laws that need the thickness of the film.
_ON_FILM = frozenset({"mixed", MIXED, "matsumoto"})
_KEYS = ("gears.driver", "operation.torque_balance", "friction")


def friction_experiment(
    case: Case,
    *,
    roughness: Sequence[Any] | None = None,
    laws: Sequence[str] = LAWS,
    coefficients: Sequence[float] = COEFFICIENTS,
    partial: bool = False,
    progress: Progress = SILENT,
    members: Members | None = None,
) -> FrictionExperiment:
    """Compare friction laws and roughnesses on one gear pair, and judge five published claims.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`; a pair of computed teeth with its oil.
    roughness : sequence of float or str, optional
        Composite roughnesses: floats in m, or text with a unit; by default seven from 0.1 to
        0.991 um.
    laws : sequence of str
        Names in :data:`tribodyn.friction.LAWS`; ``"none"`` is always there to compare with.
    coefficients : sequence of float
        Coefficients of the law ``"constant"``, beside the mean of ``"mixed-ehl"`` at each
        roughness.
    partial : bool
        Return what is done when the computation is interrupted with Ctrl-C, in place of nothing.
    progress : Progress
        Told how many steady states are done; silent by default.
    members : tribodyn.checkpoints.Members, optional
        Keeps every state as it is finished, and has those that a killed process finished.

    Returns
    -------
    FrictionExperiment
        Every figure of the summary over driving gear, held torque and friction, and ``claims``.

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
    >>> found = friction_experiment(case, laws=["xu-2007"], roughness=["0.4 um", "0.8 um"])
    >>> bool(found.change("rms_mesh_force")[0, 0, -1] < 0.0)
    True
    """
    heights = _roughnesses(case, ROUGHNESSES if roughness is None else roughness)
    named = _laws(laws)
    base = _with_film(case, named)
    loaded = _loaded(base, progress)
    rubbing = tuple(_rubbing(base, loaded["pinion"], named, heights, coefficients))
    frictions = {one.name: one for one in rubbing}
    axes = (Axis(_KEYS[0], DRIVERS), Axis(_KEYS[1], BALANCES), Axis(_KEYS[2], tuple(frictions)))

    def asked(driver: str, balance: str, friction: str) -> Asked:
        one, mesh = frictions[friction], loaded[driver]
        changed = _changed(base, one, mesh, driver).replace({_KEYS[1]: balance})
        return Asked(changed, lambda: _table(changed, mesh))

    study = identity("friction", base, [(axis.key, axis.values) for axis in axes])
    points = points_of(axes, asked, study, partial, progress, members)
    return FrictionExperiment(base, axes, points, rubbing)


def _roughnesses(case: Case, given: Sequence[Any]) -> tuple[float, ...]:
    if isinstance(given, str) or not len(given):
        remedy = 'Write, for example, ["0.4 um", "0.8 um"]'
        raise InputError(f"roughness = {given!r}", "argument roughness", "A list of them", remedy)
    return tuple(sorted(set(ends_of(case, "gears.composite_roughness", given))))


def _laws(given: Sequence[str]) -> tuple[str, ...]:
    from tribodyn.friction import LAWS as KNOWN

    for name in given:
        KNOWN[name]  # tells which there are
    return tuple(dict.fromkeys((NONE, *given)))


def _with_film(case: Case, laws: Sequence[str]) -> Case:
    """Case with the film that the laws need, and its roughness given as that of both flanks."""
    from tribodyn.ehl import FILM_MODELS
    from tribodyn.friction import LAWS as KNOWN

    if case.gears.kind != "spur":
        remedy = "Take a case of spur gears"
        what, why = f'gears.kind = "{case.gears.kind}"', "The experiment solves films of spur gears"
        raise InputError(what, "argument case", why, remedy)
    changes: dict[str, Any] = {}
    solved = FILM_MODELS[case.film.model].method
    if any(KNOWN[name].needs_film for name in laws) and not solved:
        changes["film.model"] = "newton"
    if case.film.model == "none" and not _ON_FILM.isdisjoint(laws):
        changes.setdefault("film.model", "dowson-higginson")
    heights = [
        f"gears.{gear}.{name}" for gear in DRIVERS for name in ("roughness_rms", "roughness_ra")
    ]
    given = {key: None for key in heights if key in case.given}
    rough = {"gears.composite_roughness": case.composite_roughness} if given else {}
    return case.replace({**changes, **given, **rough})


def _loaded(base: Case, progress: Progress) -> dict[str, LoadedMesh]:
    """Loads and films of the pair, one for each driving gear."""
    from tribodyn.mesh.build import loaded_mesh

    found: dict[int, LoadedMesh] = {}

    def load(driver: str) -> LoadedMesh:
        case = base.replace({_KEYS[0]: driver})
        with locate_errors(case), collected():
            return loaded_mesh(
                case.gear_pair,
                contact_settings(case),
                (case.pinion_speed, case.pinion_torque),
                force_law=mesh_law_of(case) == "force-law",
            )

    progress.start("Loads and films", len(DRIVERS))
    over_cases(load, DRIVERS, found, progress)
    progress.finish()
    return {driver: found[place] for place, driver in enumerate(DRIVERS)}


def _rubbing(
    base: Case,
    loaded: LoadedMesh,
    laws: Sequence[str],
    heights: Sequence[float],
    coefficients: Sequence[float],
) -> list[Rubbing]:
    """Every friction of the experiment."""
    found = []
    for law in laws:
        if law == CONSTANT:
            found += [Rubbing(law, heights[0], float(c), varies=False) for c in coefficients]
            if MIXED in laws:
                found += [Rubbing(law, height, as_mixed=True) for height in heights]
            continue
        each = [Rubbing(law, height) for height in heights]
        if len(heights) > 1 and _alike(base, loaded, each[0], each[-1]):
            each = each[:1]
        found += [one._replace(varies=len(each) > 1 or law == MIXED) for one in each]
    return found


def _alike(base: Case, loaded: LoadedMesh, one: Rubbing, other: Rubbing) -> bool:
    """Whether two frictions have the same coefficients; what cannot be applied is told later."""
    try:
        with collected():
            first, second = (
                _table(_changed(base, each, loaded, DRIVERS[0]), loaded).friction_coefficient
                for each in (one, other)
            )
    except InputError:
        return False
    return bool(np.array_equal(first, second))


def _changed(base: Case, one: Rubbing, loaded: LoadedMesh, driver: str) -> Case:
    changes = {_KEYS[0]: driver, "gears.composite_roughness": one.roughness}
    if one.as_mixed:
        mixed = base.replace({**changes, "friction.law": MIXED})
        with collected():
            mean = _table(mixed, loaded).mean_friction_coefficient
        return base.replace({**changes, "friction.law": CONSTANT, "friction.coefficient": mean})
    chosen: dict[str, Any] = {**changes, "friction.law": one.law}
    if one.coefficient is not None:
        chosen["friction.coefficient"] = one.coefficient
    return base.replace(chosen)


def _table(case: Case, loaded: LoadedMesh) -> MeshTable:
    return loaded.table(contact_settings(case))
