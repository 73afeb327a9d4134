"""The teeth of a mesh under load: how they share it, with or without films, and their force law.

Pairs are springs of their own, or they are solved together. Both answer ``shared_load`` with the
same :class:`SharedLoad`, and both give the force law of the mesh as a sum of ramps: points of it
lie at chosen deflections and where a pair begins to carry, joined by chords. Points are added until
the chords are near enough, so that linear pairs have one ramp and modified flanks twenty.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from tribodyn.contact import FaceContacts, PathOfContact
from tribodyn.ehl import FILM_MODELS, ThermalModel
from tribodyn.errors import require_between, warn
from tribodyn.friction.base import STEEL_BODIES
from tribodyn.friction.ehl import film_heat
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.film.loaded_contacts import FilmSprings
from tribodyn.stiffness import MODELS, ContactProblem, mesh_problem
from tribodyn.stiffness.loaded.face_problem import slice_stiffness
from tribodyn.stiffness.loaded.problem import Equilibrium
from tribodyn.stiffness.loaded.ramps import force_ramps, ramps_about
from tribodyn.stiffness.model import usable_stiffness
from tribodyn.types import Array, ByName, Mask

#: Largest composite roughness that is a roughness and not a slip of the unit [m].
_LARGEST_ROUGHNESS = 1e-4
#: Kinds of film stiffness that are springs; the printed sum of one source has the unit of a length.
IN_SERIES = ("approach", "tangent", "secant")


class ToothModel(NamedTuple):
    """How the teeth give way, whatever the gears and their load."""

    material: Material
    name: str
    options: tuple[tuple[str, Any], ...]


@dataclass(frozen=True, eq=False)
class ToothContact:
    """Settings of a tooth contact, whatever the gears, their speed and their load."""

    material: Material
    lubricant: Lubricant
    stiffness_model: str = "potential-energy"
    stiffness_options: ByName = field(default_factory=dict)
    composite_roughness: float = 0.0  #: [m]
    film_model: str = "none"
    film_options: ByName = field(default_factory=dict)
    friction_law: str = "none"
    friction_options: ByName = field(default_factory=dict)
    bodies: tuple[float, float] = STEEL_BODIES  #: sqrt(k rho c) of both gears

    def __post_init__(self) -> None:
        require_between(
            "composite_roughness", self.composite_roughness, 0.0, _LARGEST_ROUGHNESS, "m"
        )

    @property
    def teeth(self) -> ToothModel:
        """What of it the teeth alone depend on."""
        options = tuple(sorted(self.stiffness_options.items()))
        return ToothModel(self.material, self.stiffness_model, options)

    @cached_property
    def film(self) -> dict[str, Any]:
        """Options of the film model, its defaults filled in."""
        model = FILM_MODELS[self.film_model]
        heat = {"thermal": self.thermal_model} if model.heated else {}
        return {**model.complete(self.film_options), **heat}

    @property
    def thermal_model(self) -> ThermalModel:
        """Shear and bodies of a heated film: those of the friction law, if it shears the film."""
        return film_heat(self.friction_law, self.friction_options, self.bodies)

    @property
    def film_in_series(self) -> bool:
        """Whether the film of each pair is a spring in series with its teeth."""
        return self.film["stiffness"] in IN_SERIES


#: Part of the total load for which a separated pair has its film and friction.
LEAST_SHARE = 1e-3
#: Largest error of the force over the force, from a tenth of the load to three times of it, and
#: the one where flanks vary over the face, so that pairs begin to carry gradually.
LARGEST_ERROR, LARGEST_GRADUAL_ERROR = 2e-3, 1e-2
#: What of the force law is computed: that of teeth that are solved together (False) or of all
#: teeth, few ramps about the load, or the tangent there, which costs nothing.
FittedLaw = bool | Literal["about-load", "tangent"]


class SharedLoad(NamedTuple):
    """How a mesh carries its quasi-static load."""

    stiffness: Array  #: [N/m]
    share: Array  #: part of the total force on each pair on the path of contact
    corner_share: Array  #: the same on tip corners before A, and after E
    transmission_error: Array  #: approach along the line of action, deviations included [m]
    tangent: Array  #: slope of the total force over it [N/m]


@dataclass(frozen=True, eq=False)
class Teeth:
    """Teeth of all pairs over one mesh cycle that are solved together; made by :func:`teeth_of`."""

    in_contact: Mask  #: which pairs are on the path of contact
    normal_force: float  #: of all pairs together [N]
    problem: ContactProblem  #: the loaded tooth contact at the same phases
    #: Load of all pairs at each phase (n, 1) over ``normal_force``.
    loading: Array | float = field(default=1.0, kw_only=True)

    coupled: ClassVar[bool] = True
    #: Part of the load for which film and friction of a pair are found at least.
    least_share = LEAST_SHARE

    def shared_load(self, film: FilmSprings | None = None) -> SharedLoad:
        """Share the load among the pairs, each with its film in series."""
        return self._dry if film is None else self._shared(film)

    @cached_property
    def _dry(self) -> SharedLoad:
        return self._shared(None)

    @cached_property
    def dry_load(self) -> Array:
        """Load per width of every pair in contact without films [N/m]."""
        return np.asarray((self.load_per_width * self._dry.share)[self.in_contact])

    @cached_property
    def _dry_equilibrium(self) -> Equilibrium:
        return self.problem.at_loads(self._totals)

    @cached_property
    def _dry_law(self) -> tuple[Array, Array, float]:
        return force_ramps(self.problem, self.normal_force)

    def _shared(self, film: FilmSprings | None) -> SharedLoad:
        problem = self.with_film(film)
        solved = self._dry_equilibrium if film is None else problem.at_loads(self._totals)
        force = problem.forces(solved.load[0])
        inner = force[:, 1:-1] if self._extended else force
        on_path = np.where(self.in_contact, inner, 0.0)
        deflection = solved.approach[0] - problem.least_gap
        if film is not None and film.lead is not None:
            # The approach is counted from the first film. Each pair is offset by its own film: the
            # load deflects teeth and films from where the flanks touch, each pair by its share.
            lead = self._of_all(film.lead)
            stand_off = (force * lead).sum(axis=1) / np.ravel(self.force)
            from_flanks = solved.approach[0] - self.problem.film_offset(lead)
            deflection = from_flanks - self.problem.least_gap + stand_off
        places, contact = problem.places, problem.places.contact
        early = places.direction * (2.0 * places.path - contact.A - contact.E) < 0.0
        corners = force.copy()
        (corners[:, 1:-1] if self._extended else corners)[self.in_contact] = 0.0
        corner = [np.where(side, corners, 0.0).sum(axis=1) for side in (early, ~early)]
        return SharedLoad(
            stiffness=on_path / deflection[:, None],
            share=on_path / self.force,
            corner_share=np.stack(corner, axis=1) / self.force,
            transmission_error=solved.approach[0],
            tangent=solved.tangent[0],
        )

    def ramps(
        self, shared: SharedLoad, film: FilmSprings | None, *, fitted: bool
    ) -> tuple[Array, Array]:
        """Force law as ramps: where each begins [m], and its stiffness [N/m]."""
        problem = self.with_film(film)
        law = self._dry_law if film is None else force_ramps(problem, self.normal_force)
        place, slope, error = law
        if error > (LARGEST_GRADUAL_ERROR if problem.has_slices else LARGEST_ERROR):
            warn(
                "force-law",
                f"the force law of the mesh is {100.0 * error:.2g} % off the loaded tooth "
                f"contact with {place.shape[1]} ramps; smoother flanks are closer",
                stacklevel=4,
            )
        return place, slope

    def ramps_about_load(self, shared: SharedLoad, film: FilmSprings | None) -> tuple[Array, Array]:
        """Few ramps that are exact at the load: where each begins [m], and its stiffness [N/m]."""
        if film is None:
            return self._dry_ramps_about_load
        return ramps_about(self.with_film(film), shared.transmission_error)

    @cached_property
    def _dry_ramps_about_load(self) -> tuple[Array, Array]:
        return ramps_about(self.problem, self._dry.transmission_error)

    def with_film(self, film: FilmSprings | None) -> ContactProblem:
        """Put the films in series with the teeth."""
        if film is None:
            return self.problem
        lead = None if film.lead is None else self._of_all(film.lead)
        return self.problem.with_film(self._of_all(film.stiffness), lead)

    def film_offset(self, film: FilmSprings) -> float:
        """Distance before the flanks meet at which the first film begins to carry [m]."""
        return 0.0 if film.lead is None else self.problem.film_offset(self._of_all(film.lead))

    def _of_all(self, on_path: Array) -> Array:
        """Values of the pairs on the path, and those of its ends for pairs beyond them."""
        entering, leaving = self._ends()
        values = np.where(self.in_contact, on_path, on_path[leaving])
        if not self._extended:
            return values
        first = np.full((values.shape[0], 1), on_path[entering])
        return np.concatenate([first, values, np.full_like(first, on_path[leaving])], axis=1)

    @property
    def _extended(self) -> bool:
        return bool(self.problem.gaps.shape[2] > self.in_contact.shape[1])

    def _ends(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """Row and column of the pair at A, and of the pair at E."""
        last = int(np.flatnonzero(self.in_contact.any(axis=0))[-1])
        return (0, 0), (int(np.flatnonzero(self.in_contact[:, last])[-1]), last)

    @property
    def force(self) -> Array | float:
        """Force of all pairs together, at each phase where it differs (n, 1) [N]."""
        return self.normal_force * self.loading

    @property
    def _totals(self) -> Array:
        return np.reshape(self.force, (1, -1))

    @property
    def face_widths(self) -> Array:
        """Face width of each pair [m]."""
        return self.problem.face_widths

    @property
    def load_per_width(self) -> Array | float:
        """That force per face width of each pair, as far as it touches [N/m]."""
        widths = self.face_widths
        return self.force / np.where(widths > 0.0, widths, np.inf)

    @property
    def least_load(self) -> float:
        """Load for which film and friction of a pair are found at least [N/m]."""
        return self.least_share * self.normal_force / self.face_width

    @property
    def face_width(self) -> float:
        """Face width in contact [m]."""
        return self.problem.places.contact.pair.common_face_width

    @cached_property
    def bends(self) -> tuple[float, ...]:
        """Mesh phases, no events, at which a pair begins or ceases to carry."""
        if self.problem.places.is_sliced:
            return ()
        carries = self._dry_equilibrium.load[0].any(axis=1)
        phase = self.problem.places.phase
        turns = (carries[1:] != carries[:-1]).any(axis=1) & (np.diff(phase) > 0.0)
        return tuple(float(bend) for bend in 0.5 * (phase[1:] + phase[:-1])[turns])

    @cached_property
    def maximum_single_pair_stiffness(self) -> float:
        """Greatest stiffness of one pair that carries the whole force alone [N/m]."""
        places, compliance = self.problem.places, self.problem.compliance
        pairs = np.unique(places.number, return_inverse=True)[1]
        # A pair that is cut into slices carries the same load per width in each of them.
        together = np.where(pairs[:, None] == pairs, compliance.structure, 0.0).sum(axis=2)
        local = compliance.local - compliance.logarithm * np.log(
            self.normal_force / self.face_width
        )
        alone = np.where(places.on_path, self.problem.face_widths / (together + local), 0.0)
        return float(max(alone[:, pairs == pair].sum(axis=1).max() for pair in np.unique(pairs)))


@dataclass(frozen=True, eq=False)
class SpringTeeth(Teeth):
    """Teeth whose pairs are independent springs with a common deflection."""

    stiffness: Array  #: secant stiffness of each pair [N/m]

    coupled = False
    least_share = 0.0

    def _shared(self, film: FilmSprings | None) -> SharedLoad:
        """Share the load among springs of teeth and film; each begins where its film does."""
        each, problem = self.stiffness, self.with_film(film)
        if film is not None:
            each = np.zeros(self.stiffness.shape)
            touch = self.in_contact
            each[touch] = 1.0 / (1.0 / self.stiffness[touch] + 1.0 / film.stiffness[touch])
        gap = problem.gaps[:, 0, 1:-1] if self._extended else problem.gaps[:, 0]
        carries, total = self.in_contact, np.ravel(self.force)
        for _ in range(each.shape[1] + 1):  # each time a pair less carries, and one always does
            springs = np.where(carries, each, 0.0)
            deflection = (total + (springs * gap).sum(axis=1)) / springs.sum(axis=1)
            force = springs * (deflection[:, None] - gap)
            if np.all(force >= 0.0):
                break
            carries = carries & (force >= 0.0)
        share = force / self.force
        load = force / np.where(problem.face_widths > 0.0, problem.face_widths, np.inf)
        no_corners = np.zeros((deflection.size, 2))
        return SharedLoad(each, share, no_corners, deflection, problem.tangent_at(load))

    def ramps_about_load(self, shared: SharedLoad, film: FilmSprings | None) -> tuple[Array, Array]:
        """One ramp."""
        return self.ramps(shared, film, fitted=False)

    def ramps(
        self, shared: SharedLoad, film: FilmSprings | None, *, fitted: bool
    ) -> tuple[Array, Array]:
        """Force law as ramps; one with the stiffness of all pairs unless it is to be fitted."""
        if fitted:
            return super().ramps(shared, film, fitted=True)
        total_stiffness = shared.stiffness.sum(axis=1)
        first = shared.transmission_error - np.ravel(self.force) / total_stiffness
        return first[:, None], total_stiffness[:, None]

    @cached_property
    def bends(self) -> tuple[float, ...]:
        """None: every pair carries wherever it is in contact."""
        return ()


def teeth_of(
    contact: PathOfContact,
    places: tuple[Array, Array, Mask],
    settings: ToothModel,
    normal_force: float,
    loading: Array | float = 1.0,
    slices: FaceContacts | None = None,
) -> Teeth:
    """Teeth of a mesh by the stiffness model of the settings, whose stiffness is that at 1."""
    model, options = settings.name, dict(settings.options)
    chosen, pair = MODELS[model], contact.pair
    phase, path, in_contact = places
    model_options = {**chosen.options, **options}
    problem = mesh_problem(
        pair,
        provider=model,
        places=slices or places,
        total_force=normal_force,
        extended_contact=bool(model_options.get("extended_contact", False)),
        material=settings.material,
        options=options,
    )
    if chosen.coupled or pair.has_modification:
        return Teeth(in_contact, normal_force, problem, loading=loading)
    if chosen.influence is None:
        bending = np.diagonal(problem.compliance.structure, axis1=1, axis2=2)
        stiffness = np.where(in_contact, problem.face_widths / bending, 0.0)
    elif slices is not None:
        parts = chosen, pair, settings.material, slices, normal_force, options
        stiffness = slice_stiffness(*parts)
    else:
        each = chosen(pair, settings.material, path, in_contact, phase, normal_force, **options)
        stiffness = usable_stiffness(each, in_contact, model)
    return SpringTeeth(in_contact, normal_force, problem, stiffness, loading=loading)


def shared_load_columns(
    teeth: Teeth, shared: SharedLoad, film: FilmSprings | None, *, force_law: FittedLaw
) -> dict[str, Any]:
    """Columns of the mesh table that follow from teeth and films under load, its own copies."""
    if force_law == "tangent":
        first = shared.transmission_error - np.ravel(teeth.force) / shared.tangent
        ramps = first[:, None], shared.tangent[:, None]
    elif force_law == "about-load":
        ramps = teeth.ramps_about_load(shared, film)
    else:
        ramps = teeth.ramps(shared, film, fitted=force_law)
    without_film = shared if film is None else teeth.shared_load()
    alone: dict[str, Any] = {}
    if film is not None:
        alone = {
            "tooth_load_share": without_film.share,
            "tooth_corner_share": without_film.corner_share,
            "tooth_transmission_error": without_film.transmission_error,
            "film_offset": teeth.film_offset(film),
        }
    columns: dict[str, Any] = {
        "stiffness": shared.stiffness,
        "tooth_stiffness": without_film.stiffness,
        "corner_share": shared.corner_share,
        "static_transmission_error": shared.transmission_error,
        "mesh_stiffness_tangent": shared.tangent,
        "maximum_single_pair_stiffness": teeth.maximum_single_pair_stiffness,
        "ramp_deflection": ramps[0],
        "ramp_stiffness": ramps[1],
        "load_share": shared.share,
        "normal_force": teeth.force * shared.share,
        **alone,
    }
    return {name: np.copy(values)[()] for name, values in columns.items()}
