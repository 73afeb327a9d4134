"""What friction does to a running gear pair: one pair, everything else held, claims judged.

Friction laws and roughnesses vary under every choice of the driving gear and of the torque that
is held. Load shares and oil films do not depend on them: they are found once for each driver.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from tribodyn.drawing import draw
from tribodyn.errors import InputError, Problem, collected
from tribodyn.members import Members
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts, record
from tribodyn.study.case.derive import mesh_law_of, placed
from tribodyn.study.pipeline.run import computed
from tribodyn.study.pipeline.tooth_contact import contact_settings
from tribodyn.study.studies.axes import Axis, ends_of
from tribodyn.study.studies.grid import identity, over_cases
from tribodyn.study.studies.sweep import points_of
from tribodyn.study.studies.sweep_result import Sweep
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.mesh.build import LoadedMesh
    from tribodyn.study.case.case import Case
    from tribodyn.study.pipeline.result import Result
    from tribodyn.study.studies.friction_claims import Claim

#: Laws that are compared; ``constant`` takes COEFFICIENTS, and the mean of MIXED at each roughness.
LAWS = ("none", "constant", "benedict-kelly", "xu-2007", "mixed", "mixed-ehl", "ehl")
#: Coefficients of the sources: the measured one of the rig, and three that were compared.
COEFFICIENTS = (0.035, 0.05, 0.15, 0.25)
#: Composite roughnesses [m]: those of the sources that the laws know, and some beside them.
ROUGHNESSES = (0.1e-6, 0.325e-6, 0.4e-6, 0.53e-6, 0.7e-6, 0.8e-6, 0.991e-6)
DRIVERS, BALANCES = ("pinion", "wheel"), ("drive", "load", "both")
NONE, CONSTANT, MIXED = "none", "constant", "mixed-ehl"
#: Figures of the table of effects, and what they are multiplied by.
_EFFECTS = {
    "mean_friction_coefficient": 1.0,
    "mean_mesh_force": 1.0,
    "rms_mesh_force": 1.0,
    "peak_to_peak_dynamic_transmission_error": 1e6,
    "dynamic_transmission_error_harmonic_1": 1e6,
    "rms_bearing_force_loa_pinion": 1.0,
    "rms_bearing_force_oloa_pinion": 1.0,
}
#: Laws that need the thickness of the film.
_ON_FILM = frozenset({"mixed", MIXED, "matsumoto"})
_KEYS = ("gears.driver", "operation.torque_balance", "friction")


class Rubbing(NamedTuple):
    """One way in which the teeth rub."""

    law: str
    roughness: float  #: composite roughness [m]
    coefficient: float | None = None  #: of the law "constant"
    as_mixed: bool = False  #: constant at the mean of the mixed friction of this roughness
    varies: bool = True  #: whether the law knows the roughness

    @property
    def name(self) -> str:
        """Name in tables."""
        if self.coefficient is not None:
            return f"{self.law} {self.coefficient:g}"
        words = f"{self.law} as {MIXED}" if self.as_mixed else self.law
        return f"{words} {self.roughness * 1e6:g} um" if self.varies else words


@record
class FrictionExperiment(Sweep):
    """What :func:`tribodyn.friction_experiment` returns: a sweep whose last key is the friction.

    Parameters
    ----------
    case : Case
        The case that was varied.
    axes : tuple of Axis
        Driving gear, torque that is held, and friction by name.
    points : tuple of SweepPoint
        What is done; all of the grid unless it was interrupted.
    rubbing : tuple of Rubbing
        Law, roughness and coefficient behind the names of the friction.
    """

    rubbing: tuple[Rubbing, ...] = ()
    CLAIM_HEAD: ClassVar[tuple[str, ...]] = (
        "Source of",
        "Claim",
        "Printed",
        "Computed",
        "Verdict",
        "Holds where",
        "Why",
    )

    EFFECT_HEAD: ClassVar[tuple[str, ...]] = (
        "Friction",
        "mu",
        "mean force [N]",
        "rms force [N]",
        "error p-p [um]",
        "harmonic 1 [um]",
        "bearing along, rms [N]",
        "across, rms [N]",
    )

    @cached_property
    def claims(self) -> tuple[Claim, ...]:
        """What five sources claim of friction, each judged by this experiment."""
        from tribodyn.study.studies.friction_claims import judged

        return judged(self)

    def claim_rows(self) -> Iterator[tuple[str, ...]]:
        """Table of the claims under ``CLAIM_HEAD``.

        Yields
        ------
        tuple of str
        """
        for each in self.claims:
            yield (each.case, each.statement, each.printed, each.computed, each.verdict,
                   each.where, each.why)  # fmt: skip

    def nearest(self) -> list[int]:
        """Places of each law with friction, at the roughness nearest to that of the case."""
        wanted, chosen = self.case.composite_roughness or 0.0, dict[str, int]()
        for k, one in enumerate(self.rubbing):
            known = self.rubbing[chosen.get(one.law, k)]
            nearer = abs(one.roughness - wanted) < abs(known.roughness - wanted)
            if one.law not in chosen or nearer:
                chosen[one.law] = k
        return [k for law, k in chosen.items() if law != NONE]

    def effect_rows(self) -> Iterator[tuple[str, ...]]:
        """Table under ``EFFECT_HEAD``: figures by law, driver and held torque as in the case.

        Yields
        ------
        tuple of str
        """
        row, column = (
            axis.values.index(value)
            for axis, value in zip(
                self.axes,
                (self.case.gears.driver, self.case.operation.torque_balance),
                strict=False,
            )
        )
        for k in (self.index(NONE), *self.nearest()):
            values = [self[name][row, column, k] * scale for name, scale in _EFFECTS.items()]
            if np.isfinite(values).all():
                yield (self.rubbing[k].name, *(f"{round(value, 9):.4g}" for value in values))

    @property
    def lead(self) -> str:
        """What was done, in a line."""
        failed = sum(bool(point.failed) for point in self.points)
        lost = f", {failed} failed" if failed else ""
        return f"{len(self.points)} of {self.failed.size} steady states{lost}"

    def plot(self, figure: str = "friction_effect", **options: Any) -> Any:
        """Draw the experiment.

        Parameters
        ----------
        figure : str
            ``"friction_effect"``, ``"friction_claims"`` or ``"friction_harmonics"``.
        **options
            None are known.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, figure, **options)

    def change(self, figure: str) -> Array:
        """Relative change of a figure by friction, over the grid.

        Parameters
        ----------
        figure : str
            Name in the summary.

        Returns
        -------
        array (2, 3, frictions)
            Over the same pair without friction, less 1.
        """
        values = self[figure]
        plain = values[:, :, self.index(NONE)]
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(values / plain[:, :, None] - 1.0)

    def index(self, law: str, **wanted: Any) -> int:
        """Place of a friction: the first of a law with given properties.

        Parameters
        ----------
        law : str
            Friction law.
        **wanted : object
            Properties of :class:`Rubbing`.

        Returns
        -------
        int

        Raises
        ------
        InputError
            If it was not computed.
        """
        for place, one in enumerate(self.rubbing):
            if one.law == law and all(getattr(one, k) == v for k, v in wanted.items()):
                return place
        told = ", ".join(dict.fromkeys(one.law for one in self.rubbing))
        raise InputError(
            f'friction "{law}" was not computed',
            "argument law",
            f"There is {told}",
            remedy="Choose one of these",
        )

    def _parts(self) -> Parts:
        parts = super()._parts()
        rows = {
            "law": (np.array([one.law for one in self.rubbing], dtype=object), "1"),
            "composite_roughness": (np.array([one.roughness for one in self.rubbing]), "m"),
        }
        for name, (values, unit) in rows.items():
            parts.variables[name] = ("friction", values, {"units": unit})
        for name, texts in zip(self.CLAIM_HEAD, zip(*self.claim_rows(), strict=True), strict=True):
            key = f"claim_{name.lower().replace(' ', '_')}"
            parts.variables[key] = ("claim", np.array(texts, dtype=object), {"units": "1"})
        return parts

    def __repr__(self) -> str:
        """One line."""
        told = ", ".join(f"{claim.case} {claim.verdict}" for claim in self.claims)
        return f"FrictionExperiment({self.lead}; claims: {told})"


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
    members : tribodyn.members.Members, optional
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

    def compute(driver: str, balance: str, friction: str) -> Result:
        one, mesh = frictions[friction], loaded[driver]
        changed = _changed(base, one, mesh, driver).replace({_KEYS[1]: balance})
        return computed(changed, known=lambda: _table(changed, mesh))

    study = identity("friction", base, [(axis.key, axis.values) for axis in axes])
    points = points_of(axes, compute, study, partial, progress, members)
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
        raise InputError(Problem(what, "argument case", why, remedy))
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
        with placed(case), collected():
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
