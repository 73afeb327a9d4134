"""Load capacity of the gears of a result: by the factors of the standard, and by computed ones."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property, partial
from itertools import chain
from typing import TYPE_CHECKING, cast

from tribodyn.errors import ModelWarning, collected
from tribodyn.rating import (
    GearRating,
    PairRating,
    RatedGear,
    RatingConditions,
    SpectrumLoad,
    SpectrumRating,
    rate_pair,
    rate_spectrum,
)
from tribodyn.rating.factor import check_range
from tribodyn.record import figure_method
from tribodyn.study.case.rating_tables import gear_material, history_classes, shaper_cutter
from tribodyn.study.computed_rating import load_sharing_factor
from tribodyn.study.rated_oil import gear_oil
from tribodyn.study.rated_parts import (
    ALL_CASES,
    BearingRating,
    NotchRating,
    PartRatings,
    Verdict,
)
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    import xarray

    from tribodyn.mesh import MeshTable
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.pipeline.result import PairResult

#: K_gamma of planetary stages by the number of planets, without a computation.
PLANET_FACTORS = {1: 1.0, 2: 1.0, 3: 1.10, 4: 1.25, 5: 1.35, 6: 1.44, 7: 1.47}
_ROLES = "pinion", "wheel"


@dataclass(frozen=True)
class MeshRating:
    """Rating of one mesh under one load.

    Parameters
    ----------
    load, mesh : str
        Names.
    gears : tuple of str
        Names of pinion and wheel.
    standard : PairRating
        By the factors of ISO 6336.
    computed : PairRating
        With K_v, K_Hbeta and K_Halpha of the computed motion and load distribution.
    rated : RatedMesh, optional
        The mesh with its load, tooth contact and motion.
    """

    load: str
    mesh: str
    gears: tuple[str, str]
    standard: PairRating
    computed: PairRating
    rated: RatedMesh | None = field(default=None, repr=False)

    @cached_property
    def root_stress(self) -> dict[str, dict[str, float]]:
        """Root stress by finite elements of ``pinion`` and ``wheel``; empty without computed teeth.

        ``ratio`` to Y_F Y_S for the same load at the outer point of single contact, greatest
        ``static_stress`` and ``dynamic_stress`` over the mesh cycle with K_A and K_gamma [Pa], and
        the ``bending_safety`` of the latter.
        """
        from tribodyn.study.computed_rating import root_stresses

        return root_stresses(self)

    @cached_property
    def maps(self) -> xarray.Dataset | None:
        """Criteria over path and face from computed pressure, friction, speed and film.

        Pressure, temperature of the contact, film over the mean roughness Ra, and safeties against
        pitting, scuffing and micropitting, with K_A, K_gamma and the computed K_v; the film is
        that of the load at rest. None without computed teeth; what the run does not compute, such
        as a film or friction, has no map.
        """
        from tribodyn.study.computed_rating import rating_maps

        return rating_maps(self)

    @cached_property
    def pointwise(self) -> dict[str, dict[str, float]]:
        """Least value of each safety of :attr:`maps` with its place on path and face [m]."""
        from tribodyn.study.computed_rating import least_safeties

        return least_safeties(self.maps)

    @cached_property
    def exposure(self) -> dict[str, dict[str, float]]:
        """Greatest exposure below the flanks with its ``depth`` and ``path`` [m], by role.

        Of gears whose material has a ``hardness_profile``, by
        :func:`tribodyn.rating.subsurface_exposure` with the pressure of :attr:`maps` and the
        friction of the run.
        """
        from tribodyn.study.computed_rating import exposures

        return exposures(self)

    @cached_property
    def wear_depth(self) -> dict[str, float]:
        """Greatest depth of wear by ``rating.wear_coefficient`` after the required life [m].

        By role, in steps with the load distribution of the worn flanks; of helical pairs the mean
        over the face.
        """
        from tribodyn.study.computed_rating import wear_depths

        return wear_depths(self)

    plot_maps = figure_method(
        "rating_maps", "Draw pressure, temperature, film and safeties over path and face."
    )

    def verdicts(self) -> Iterator[Verdict]:
        """Iterate over the safeties of the mesh and of its gears.

        Yields
        ------
        Verdict
        """
        needed = self.standard.conditions
        has_run = self.rated is None or self.rated.motion is not None
        pairs = zip(
            self.gears, self.standard.gears.values(), self.computed.gears.values(), strict=True
        )
        for (name, gear, other), single in zip(pairs, ("Z_B", "Z_D"), strict=True):
            point = single[-1] if gear.factors[single] > 1.0 else "C"
            places = {"pitting": f"at {point}", "bending": "root"}
            for mode, where in places.items():
                key, required = f"{mode}_safety", getattr(needed, f"{mode}_safety")
                values = getattr(gear, key), required, getattr(other, key) if has_run else None
                yield Verdict(mode, name, self.load, *values, where)
        for mode, key, required, factor in (
            ("scuffing (flash)", "scuffing_safety_flash", needed.scuffing_safety, "theta_fl_max"),
            ("scuffing (integral)", "scuffing_safety_integral", needed.scuffing_safety, ""),
            ("micropitting", "micropitting_safety", needed.micropitting_safety, "lambda_min"),
        ):
            if (safety := getattr(self.standard, key)) is not None:
                points = (self.pointwise.get(name) for name in (key, f"{key}_method_a"))
                least = next(filter(None, points), {"safety": getattr(self.computed, key)})
                where = self.standard.factors[factor].branch if factor else "mean of the path"
                computed = least["safety"] if has_run else None
                yield Verdict(mode, self.mesh, self.load, safety, required, computed, where)

    def to_dict(self) -> Tree:
        """Ratings of the mesh, as JSON has them.

        Returns
        -------
        dict of str
        """
        factors = {name: float(self.computed.factors[name]) for name in self.computed.overridden}
        return {
            "gears": list(self.gears),
            "load": self.load,
            **self.standard.to_dict(),
            "computed_factors": factors,
            "root_stress": self.root_stress,
            "pointwise": self.pointwise,
            "exposure": self.exposure,
            "wear_depth": self.wear_depth,
            "computed": {
                name: value
                for name, value in self.computed.to_dict().items()
                if name.endswith(("safety", "flash", "integral"))
            }
            | {
                role: {key: getattr(gear, key) for key in ("pitting_safety", "bending_safety")}
                for role, gear in self.computed.gears.items()
            },
        }


@dataclass(frozen=True)
class MeshSpectrum:
    """Damage of the gears of a mesh by all load cases together.

    Parameters
    ----------
    mesh : str
        Name.
    gears : tuple of str
        Names of pinion and wheel.
    rating : SpectrumRating
        Safeties and damage by load case.
    conditions : dict
        Required safeties.
    """

    mesh: str
    gears: tuple[str, str]
    rating: SpectrumRating
    conditions: Tree

    def verdicts(self) -> Iterator[Verdict]:
        """Iterate over the safeties of the gears.

        Yields
        ------
        Verdict
        """
        required = RatingConditions(**self.conditions)
        damages = self.rating.pinion, self.rating.wheel
        for name, damage in zip(self.gears, damages, strict=True):
            for mode in ("pitting", "bending"):
                key = f"{mode}_safety"
                values = getattr(damage, key), getattr(required, key), None
                yield Verdict(mode, name, ALL_CASES, *values)

    def to_dict(self) -> Tree:
        """Safeties, and damage by load case, as JSON has them.

        Returns
        -------
        dict of str
        """
        damages = self.rating.pinion, self.rating.wheel
        return {
            "load_cases": [case.name for case in self.rating.cases],
            **{name: asdict(damage) for name, damage in zip(self.gears, damages, strict=True)},
        }


@dataclass(frozen=True)
class CaseRating:
    """Load capacity of the cylindrical gears, the bearings and the shafts of a result.

    Parameters
    ----------
    ratings : tuple of MeshRating
        Each mesh under each load.
    spectra : tuple of MeshSpectrum
        Each mesh under all load cases together, where there are several and a required life.
    parts : PartRatings
        Bearings and shafts.
    """

    ratings: tuple[MeshRating, ...]
    spectra: tuple[MeshSpectrum, ...] = ()
    parts: PartRatings = field(default_factory=PartRatings)

    @property
    def bearings(self) -> dict[str, BearingRating]:
        """Life of each bearing; of one that is not rated the reason."""
        return {each.bearing: each for each in self.parts.bearings}

    @property
    def shafts(self) -> dict[str, dict[str, NotchRating]]:
        """Fatigue of the notches of each shaft, under the load with the least safety."""
        shafts: dict[str, dict[str, NotchRating]] = {}
        for each in sorted(self.parts.notches, key=lambda notch: notch.safety, reverse=True):
            shafts.setdefault(each.shaft, {})[each.notch] = each
        return shafts

    @property
    def warnings(self) -> list[ModelWarning]:
        """Warnings of all ratings, each once: factors outside of the range of their source."""
        listed = [warning for each in self.ratings for warning in each.standard.warnings]
        listed += self.parts.warnings
        return list({str(warning): warning for warning in listed}.values())

    @property
    def system_life(self) -> float | None:
        """Life of all rated bearings together [s]; None where there are none."""
        return self.parts.system_life

    @property
    def meshes(self) -> dict[str, PairRating]:
        """Rating of each mesh by the standard, under the load with its least margin."""
        return {name: each.standard for name, each in self._governing().items()}

    @property
    def gears(self) -> dict[str, dict[str, GearRating]]:
        """Ratings of each gear by its meshes, under the load with the least margin."""
        gears: dict[str, dict[str, GearRating]] = {}
        for mesh, each in self._governing().items():
            for name, rating in zip(each.gears, each.standard.gears.values(), strict=True):
                gears.setdefault(name, {})[mesh] = rating
        return gears

    @property
    def _to_last(self) -> list[MeshRating]:
        """Loads that the gears have to last: load classes, else the operating point."""
        return [each for each in self.ratings if not self.spectra or each.load != "operation"]

    def _governing(self) -> dict[str, MeshRating]:
        least: dict[str, tuple[float, MeshRating]] = {}
        for each in self._to_last:
            margin = min(verdict.margin for verdict in each.verdicts())
            if each.mesh not in least or margin < least[each.mesh][0]:
                least[each.mesh] = margin, each
        return {mesh: each for mesh, (_, each) in least.items()}

    def verdicts(self) -> list[Verdict]:
        """Least safety of each part against each mode over all loads, the least margin first.

        Returns
        -------
        list of Verdict
        """
        least: dict[tuple[str, ...], Verdict] = {}
        listed = [each.verdicts() for each in self._to_last]
        listed += [each.verdicts() for each in self.spectra]
        for verdict in chain(*listed, self.parts.verdicts()):
            place = verdict.where if verdict.mode.startswith("shaft") else ""  # each notch
            key = verdict.mode, verdict.part, place
            if key not in least or verdict.margin < least[key].margin:
                least[key] = verdict
        return sorted(least.values(), key=lambda verdict: verdict.margin)

    def to_dict(self) -> Tree:
        """Ratings of meshes and gears, as JSON has them.

        Returns
        -------
        dict of str
        """
        gears = {
            name: {mesh: rating.to_dict() for mesh, rating in meshes.items()}
            for name, meshes in self.gears.items()
        }
        return {
            "verdicts": [
                {**verdict._asdict(), "margin": verdict.margin} for verdict in self.verdicts()
            ],
            "meshes": {name: each.to_dict() for name, each in self._governing().items()},
            "gears": gears,
            "spectra": {each.mesh: each.to_dict() for each in self.spectra},
            **self.parts.to_dict(),
        }


def conditions_of(case: PairCase, planets: int) -> Tree:
    """Conditions of ``[rating]``; planets share the load unevenly."""
    rating = case.rating
    assert rating is not None
    sharing = rating.mesh_load_factor
    if sharing is None:
        most = max(PLANET_FACTORS)
        check_range(
            "planets", planets, 1, most, "K_gamma, see rating.mesh_load_factor", limited=True
        )
        sharing = PLANET_FACTORS[min(planets, most)]
    required = rating.minimum_safety
    names = ("pitting_safety", "bending_safety", "scuffing_safety", "micropitting_safety")
    safeties = {} if required is None else dict.fromkeys(names, required)
    return {
        "application_factor": rating.application_factor,
        "mesh_load_factor": sharing,
        "required_life": rating.required_life,
        "edition": rating.edition,
        **safeties,
    }


@dataclass(frozen=True)
class RatedMesh:
    """A mesh under a load, as it is rated."""

    load: str
    mesh: str
    case: PairCase  #: of its pair
    gears: tuple[str, str]
    #: speed [rad/s] and torque [N*m] of the pinion, negative where the other flanks carry
    operation: tuple[float, float]
    computed: Mapping[str, float]  #: factors of the motion and the load distribution
    meshes_per_turn: tuple[int, int] = (1, 1)
    reversed: tuple[bool, bool] = (False, False)
    inertia_shares: tuple[float, float] = (1.0, 1.0)
    planets: int = 1
    share: float | None = None  #: of the required life, of a load case
    table: MeshTable | None = None  #: tooth contact at this load
    #: mesh phase and mesh force over its mean along the motion
    motion: Callable[[], tuple[Array, Array]] | None = None

    def __post_init__(self) -> None:
        """Read what is common to all ratings of the mesh."""
        data = self.case.rating
        assert data is not None
        each = zip(_ROLES, self.meshes_per_turn, self.reversed, self.inertia_shares, strict=True)
        pinion, wheel = (
            RatedGear(
                material=gear_material(self.case, role),
                cutter=shaper_cutter(self.case, role),
                accuracy_grade=data.accuracy_grade,
                flank_roughness=data.flank_roughness,
                root_roughness=data.root_roughness,
                meshes_per_turn=count,
                stress_ratio=-1.2 if idler else 0.0,
                inertia_share=share,
            )
            for role, count, idler, share in each
        )
        conditions = conditions_of(self.case, self.planets)
        if self.share is not None and conditions["required_life"] is not None:
            conditions["required_life"] *= self.share
        gears = {"oil": gear_oil(self.case), "pinion": pinion, "wheel": wheel}
        object.__setattr__(self, "_common", {**gears, **conditions})

    @property
    def common(self) -> Tree:
        """Arguments of a rating other than the load."""
        return cast(Tree, vars(self)["_common"])


def rate_mesh(mesh: RatedMesh) -> MeshRating:
    """Rating of a mesh with the factors of the standard, and with computed ones."""
    pair, speed, torque = mesh.case.gear_pair, mesh.operation[0], abs(mesh.operation[1])
    standard = rate_pair(pair, torque=torque, speed=speed, **mesh.common)
    factors = dict(mesh.computed)
    if mesh.table is not None:
        factors["K_Halpha"] = load_sharing_factor(mesh.case, mesh.table)
        factors["K_Falpha"] = factors["K_Halpha"]
    with collected():  # those of the first rating
        computed = rate_pair(pair, torque=torque, speed=speed, factors=factors, **mesh.common)
    return MeshRating(mesh.load, mesh.mesh, mesh.gears, standard, computed, mesh)


def rate_load_cases(meshes: Sequence[RatedMesh]) -> MeshSpectrum | None:
    """Damage of a mesh by its load cases, each for its share of the required life."""
    first = meshes[0]
    life = first.case.rating.required_life if first.case.rating is not None else None
    shares = [mesh for mesh in meshes if mesh.share]
    if life is None or len(shares) < 2:
        return None
    cases = [
        SpectrumLoad(mesh.operation[1], mesh.operation[0], life * (mesh.share or 0.0), mesh.load)
        for mesh in shares
    ]
    common = {**first.common, "required_life": None}
    with collected():  # those of the single load cases
        rating = rate_spectrum(first.case.gear_pair, cases=cases, **common)
    return MeshSpectrum(first.mesh, first.gears, rating, conditions_of(first.case, 1))


def computed_factors(figures: Mapping[str, float | None]) -> dict[str, float]:
    """K_v of the motion and K_Hbeta of the load distribution, where they are computed."""
    factors = {}
    if (dynamic := figures.get("dynamic_factor_peak")) is not None:
        factors["K_v"] = max(float(dynamic), 1.0)
    if (face := figures.get("face_load_factor")) is not None:
        factors["K_Hbeta"] = max(float(face), 1.0)
    return factors


def case_rating(meshes: Iterable[RatedMesh], parts: PartRatings | None = None) -> CaseRating | None:
    """Rating of meshes under their loads, with bearings and shafts; None where nothing is rated."""
    groups: dict[str, list[RatedMesh]] = {}
    for mesh in meshes:
        groups.setdefault(mesh.mesh, []).append(mesh)
    ratings = tuple(rate_mesh(mesh) for group in groups.values() for mesh in group)
    spectra = tuple(filter(None, map(rate_load_cases, groups.values())))
    parts = parts or PartRatings()
    is_rated = ratings or parts.notches or any(each.lives for each in parts.bearings)
    return CaseRating(ratings, spectra, parts) if is_rated else None


def rated_pair(result: PairResult) -> Iterator[RatedMesh]:
    """The mesh of a pair, if its case has ``[rating]``."""
    case = result.case
    if case.is_rated:
        factors = computed_factors(result.figures)
        operation = result._MESH, case, _ROLES, case.operating_point, factors
        rated = RatedMesh(
            "operation", *operation, table=result.mesh, motion=partial(_force_over_mean, result)
        )
        yield rated
        stated = case.operation
        speed, torque = (
            a / b for a, b in zip(rated.operation, (stated.speed, stated.torque), strict=True)
        )
        for each in history_classes(case.rating, stated.speed):
            load = speed * each.speed, torque * each.torque
            yield replace(rated, load=each.name, operation=load, computed={}, share=each.duration,
                          table=None, motion=None)  # fmt: skip


def _force_over_mean(result: PairResult) -> tuple[Array, Array]:
    from tribodyn.study.pipeline.response_series import measured, mesh_force, one_sided_phase

    samples = measured(result.response)
    return one_sided_phase(samples), mesh_force(samples) / result.figures["mean_mesh_force"]
