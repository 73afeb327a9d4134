"""Oil films of the cells of a hypoid pair, by formula or solved, alone or in series with the teeth.

Cells are contacts like the tooth pairs of spur gears: the same films, tables of solved contacts and
load sharing serve both. Every cell is a slice across its contact line; the Hamrock and Dowson film
takes each line as one elliptical contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar, NamedTuple, cast

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.ehl import FILM_MODELS, hamrock_dowson_minimum
from tribodyn.ehl.steady.batch import Films
from tribodyn.errors import ComputationError, InputError
from tribodyn.friction import LAWS, FrictionParts, TribologicalContact
from tribodyn.gear.hypoid.kinematics import CellMotion
from tribodyn.mesh.cycle import PairsInContact
from tribodyn.mesh.film.film_columns import judged, warn_of_loaded
from tribodyn.mesh.film.film_lookup import (
    FilmLookup,
    OutsideTableError,
    shared_films,
    table_for,
)
from tribodyn.mesh.film.film_table import FilmTable
from tribodyn.mesh.film.loaded_contacts import FilmSprings
from tribodyn.mesh.film.path_film import FormulaFilm
from tribodyn.mesh.film.sheared_film import place_from_pitch
from tribodyn.mesh.hypoid.cells import CellSprings
from tribodyn.mesh.hypoid.loaded_contact import HypoidLoadedContact
from tribodyn.mesh.loads import (
    Loads,
    reported_films,
    tribological_contact,
    under_load,
    warn_of_rigid_films,
)
from tribodyn.mesh.sharing import LEAST_SHARE, ToothContact
from tribodyn.types import Array, Index, Mask

#: Film model of each line as an elliptical contact; the other models are for line contacts.
ELLIPTICAL = "hamrock-dowson"


@dataclass(frozen=True, eq=False)
class CellFilms:
    """A loaded pair with its films and the friction of all cells that carry."""

    loaded: HypoidLoadedContact
    carries: Mask  #: (lines, cells)
    films: Films  #: of the cells that carry, NaN where they are not certain
    contact: TribologicalContact  #: of these cells
    friction: FrictionParts


@dataclass(frozen=True, eq=False)
class _EllipseFilm(FormulaFilm):
    """Each line as an elliptical contact under its whole force."""

    line: Index  #: number of the line of each cell
    side_radius: Array  #: radius of the gap along the line [m]

    def __call__(self, load_per_width: Array) -> Films:
        """Minimum films of all cells; warn of the lines that carry load alone."""
        oil = self.pairs.lubricant
        weights = load_per_width * self.pairs.length
        force: Array = np.bincount(self.line, weights)[self.line].astype(np.float64)

        def film(cells: Index) -> Array:
            pairs = self.pairs.some(cells)
            return hamrock_dowson_minimum(
                force[cells],
                pairs.equivalent_radius,
                self.side_radius[cells],
                pairs.entrainment_speed,
                oil.dynamic_viscosity,
                oil.pressure_viscosity_coefficient,
                pairs.effective_modulus,
            )

        loaded = np.flatnonzero(judged(force))
        films = warn_of_loaded(lambda: film(np.arange(force.size)), lambda: film(loaded))
        return Films(None, films, None, None)


class _CellShare(NamedTuple):
    """Part of the torque on each cell."""

    share: Array


class _CellTeeth:
    """Cells as tooth pairs of the load sharing: columns are the cells of all pairs."""

    coupled: ClassVar[bool] = True

    def __init__(self, loaded: HypoidLoadedContact, active: Mask, least: float) -> None:
        cells = loaded.cells
        self._dry, self._cells, self._active = loaded, cells, active
        self.in_contact: Mask = self._spread(active.astype(float)) > 0.5
        self._torque = (loaded.wheel_torque * np.broadcast_to(loaded.loading, cells.phase.shape))[
            cells.row, None
        ]
        arm = cells.touch.lever
        self.load_per_width = self._spread(self._torque / (arm * cells.length))
        self.face_widths = self._spread(cells.length)
        self.normal_force, self.face_width = least / LEAST_SHARE, 1.0
        self.least_load = least
        self.loaded = loaded

    def _spread(self, values: Array) -> Array:
        columns = self._cells.spread(values)
        return np.asarray(columns.reshape(columns.shape[0], -1))

    def _of_lines(self, columns: Array) -> Array:
        spread = columns.reshape(*self._cells.in_contact.shape, -1)
        return np.asarray(spread[self._cells.in_contact])

    @property
    def dry_load(self) -> Array:
        """Load per length of the cells without films."""
        return np.asarray((self._dry.line_force / self._cells.length)[self._active])

    def shared_load(self, film: FilmSprings | None = None) -> _CellShare:
        """Share of each cell in the torque, with its film in series."""
        cells, teeth = self._cells, self._dry.springs.stiffness
        self.loaded = self._dry
        if film is not None:
            lead = 0.0 if film.lead is None else self._of_lines(film.lead)
            soft = cells.length / self._of_lines(film.stiffness)
            self.loaded = self._dry.with_film(CellSprings(1.0 / (1.0 / teeth + soft), lead))
        share = self.loaded.line_force * cells.touch.lever / self._torque
        return _CellShare(self._spread(share))

    def named(self, row: int, column: int) -> str:
        """Name a cell."""
        pair, cell = divmod(column, self._cells.length.shape[1])
        phase = self._cells.phase[row]
        return f"cell {cell + 1} of the line of pair {pair + 1} at the mesh phase {phase:.3f}"


def cell_films(
    loaded: HypoidLoadedContact, motion: CellMotion, settings: ToothContact
) -> CellFilms:
    """Films and friction of all cells, their films in series with the teeth if requested."""
    cells, in_series = loaded.cells, settings.film_in_series
    width = loaded.line_force / cells.length
    solved = bool(FILM_MODELS[settings.film_model].method)
    if LAWS[settings.friction_law].needs_film and not solved:
        raise InputError(
            f'friction law "{settings.friction_law}" with a film by formula',
            where="film_model",
            why="The law needs the pressure of a solved film",
            remedy='Choose film_model = "newton", or another law',
        )
    active = np.ones(width.shape, dtype=bool) if in_series else width > 0.0
    least = LEAST_SHARE * float(loaded.line_force.sum() / cells.length.sum())
    teeth = _CellTeeth(loaded, active, least if solved or in_series else 0.0)
    pairs = PairsInContact(
        age=np.broadcast_to(cells.age[:, None], active.shape)[active],
        equivalent_radius=motion.equivalent_radius[active],
        entrainment_speed=motion.entrainment_speed[active],
        lubricant=settings.lubricant,
        effective_modulus=effective_modulus(settings.material, settings.material),
        length=cells.length[active],
        sliding_speed=_signed_sliding(motion)[active],
    )
    loads = _loads(teeth, settings, pairs, active)
    loaded = teeth.loaded
    films = loads.film_at(loads.tribological)
    flat = CellMotion(*(column[active] for column in motion))
    contact = tribological_contact(
        flat, pairs, loads.tribological, settings.composite_roughness, None, films
    )
    parts = _parts(loads.film_at.friction(contact, flat, settings))
    reported = reported_films(films, loads, teeth.least_load)
    return _carrying(loaded, active, reported, contact, parts)


def _signed_sliding(motion: CellMotion) -> Array:
    """Amount of the sliding; negative where the wheel rolls through the contact faster."""
    pinion, wheel = motion.pinion_rolling_speed, motion.wheel_rolling_speed
    faster = np.where(np.abs(pinion) >= np.abs(wheel), 1.0, -1.0)
    return np.asarray(faster * motion.sliding_speed)


def _loads(
    teeth: _CellTeeth, settings: ToothContact, pairs: PairsInContact, active: Mask
) -> Loads[_CellShare]:
    """Loads of the cells and their films."""
    film: FormulaFilm | FilmLookup
    cells, line = teeth.loaded.cells, np.asarray(np.nonzero(active)[0])
    with shared_films(persistent=True):
        if settings.film_model == "none":
            film = _EllipseFilm(settings, pairs, teeth.least_load, line, cells.side_radius[active])
        elif not FILM_MODELS[settings.film_model].method:
            film = FormulaFilm(settings, pairs, teeth.least_load)
        else:
            if settings.film["stiffness"] == "seed":
                raise InputError(
                    'stiffness = "seed" of a hypoid pair',
                    where="film.stiffness",
                    why="Cells interpolate their films in a table, which does not have this sum",
                    remedy='Choose "approach", "tangent" or "none"',
                )
            table = cast(FilmTable, table_for(settings, pairs, sheared=True))
            no_pitch, (along, across) = np.zeros(0, dtype=np.int64), cells.touch.places[active].T
            place = np.stack([place_from_pitch(across), (along - along.min()) / np.ptp(along)])
            film = FilmLookup(
                settings, table, pairs, teeth.in_contact, teeth.least_load, no_pitch, place
            )
        try:
            loads = under_load(teeth, settings, film, teeth.named)
        except OutsideTableError:
            raise ComputationError(
                f"the films of the {pairs.age.size} cells cannot be tabulated",
                where="film.model",
                why="Some have no solution, or too few nodes to be smooth over load and speed",
                remedy='Set film.nodes = 513 or more, or a formula such as film.model = "moes"',
            ) from None
        warn_of_rigid_films(loads.film_at)
        return loads


def _parts(friction: Array | FrictionParts) -> FrictionParts:
    """Film and asperities of friction; a law without asperities has all of it in the film."""
    if isinstance(friction, FrictionParts):
        return friction
    return FrictionParts(friction, np.zeros(friction.shape), np.ones(friction.shape))


def _carrying(
    loaded: HypoidLoadedContact,
    active: Mask,
    films: Films,
    contact: TribologicalContact,
    parts: FrictionParts,
) -> CellFilms:
    """Leave out cells that do not carry."""
    carries = loaded.line_force > 0.0
    chosen = carries[active]

    def some(values: Any) -> Any:
        """Values of the cells that carry; numbers and None as they are."""
        return values[chosen] if np.shape(values) == chosen.shape else values

    return CellFilms(
        loaded,
        carries,
        replace(films, **{n: some(v) for n, v in vars(films).items() if n != "solutions"}),
        replace(contact, **{name: some(value) for name, value in vars(contact).items()}),
        FrictionParts(*(some(values) for values in vars(parts).values())),
    )
