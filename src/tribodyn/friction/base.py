"""What a friction law is given, what a friction law is, and the laws by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields
from inspect import signature
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.ehl.traction.film_temperature import STEEL_THERMAL_CONTACT_COEFFICIENT
from tribodyn.errors import InputError, Problem, require_between, require_positive, shortened, warn
from tribodyn.model import Model, Registry
from tribodyn.types import Array, ByName, Mask, Tree

if TYPE_CHECKING:
    from tribodyn.ehl.traction.traction import FilmState
    from tribodyn.friction.mesh_means import PitchPoint


#: Thermal contact coefficients of two bodies of gear steel [J/(m^2 K s^0.5)].
STEEL_BODIES = (STEEL_THERMAL_CONTACT_COEFFICIENT, STEEL_THERMAL_CONTACT_COEFFICIENT)

#: Static friction coefficient of dry hard steel (Marks' Standard Handbook for Mechanical
#: Engineers); sliding has less. A regression of lubricated contacts means nothing above it.
DRY_STEEL = 0.78

_POSITIVE = (
    ("load_per_width", "N/m"),
    ("hertz_pressure", "Pa"),
    ("entrainment_speed", "m/s"),
    ("equivalent_radius", "m"),
)
_FILMS = ("film_thickness", "central_film")


@with_old_names
@dataclass(frozen=True)
class TribologicalContact:
    """Loaded tooth contacts as friction laws see them: arrays of one shape, and two scalars.

    Contacts that carry no load have no friction coefficient: leave them out.

    Parameters
    ----------
    load_per_width : array [N/m]
        Normal load of the tooth pair per face width.
    hertz_pressure : array [Pa]
        Maximum Hertzian pressure.
    sliding_speed : array [m/s]
        Difference of the surface speeds, of either sign.
    entrainment_speed : array [m/s]
        HALF the sum of the surface speeds.
    slide_to_roll_ratio : array
        Sliding speed over entrainment speed.
    equivalent_radius : array [m]
        Reduced radius of curvature.
    dynamic_viscosity : float [Pa*s]
        Viscosity of the oil at the inlet.
    composite_roughness : float [m]
        Root of the sum of squares of the two rms roughnesses.
    film : FilmState, optional
        Solved oil film of every contact, in flat order; ``None`` where none is solved.
    oil_density : float, optional [kg/m^3]
        Density of the oil, for laws of kinematic viscosity.
    film_thickness : array, optional [m]
        Smallest thickness known of the oil film of each contact.
    pitch : PitchPoint, optional
        The mesh at its pitch point, for laws of one mean value.
    central_film : array, optional [m]
        Film in the centre of each contact, where it is known.
    bodies : (float, float) [J/(m^2 K s^0.5)]
        ``sqrt(k rho c)`` of both bodies; gear steel by default.

    Raises
    ------
    InputError
        If there is no contact, the shapes or the number of films differ, a load, pressure, speed
        or radius is not positive, or the sliding speed disagrees with the slide-to-roll ratio.

    Examples
    --------
    >>> one = np.ones(3)
    >>> contact = TribologicalContact(
    ...     1e5 * one, 8e8 * one, one, 2 * one, one / 2, 8e-3 * one, 0.08, 5e-7
    ... )
    >>> contact.size
    3
    """

    load_per_width: Array
    hertz_pressure: Array
    sliding_speed: Array
    entrainment_speed: Array
    slide_to_roll_ratio: Array
    equivalent_radius: Array
    dynamic_viscosity: float
    composite_roughness: float
    film: FilmState | None = field(default=None, repr=False)
    oil_density: float | None = None
    film_thickness: Array | None = field(default=None, repr=False)
    pitch: PitchPoint | None = field(default=None, repr=False)
    central_film: Array | None = field(default=None, repr=False)
    bodies: tuple[float, float] = field(default=STEEL_BODIES, repr=False)

    def __post_init__(self) -> None:
        """Refuse contacts without load, mixed shapes and contradicting speeds."""
        names = [name for name, _ in _POSITIVE] + ["sliding_speed", "slide_to_roll_ratio"]
        films = [name for name in _FILMS if getattr(self, name) is not None]
        names += films
        shapes = {name: np.shape(getattr(self, name)) for name in names}
        if len(set(shapes.values())) > 1:
            listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
            what, why = f"shapes differ: {listed}", "element i of every array belongs to contact i"
            raise InputError(what, "TribologicalContact", why, "Broadcast the arrays first")
        if self.size == 0:
            raise InputError(
                "no contact", "TribologicalContact", "All arrays are empty", "Give one"
            )
        for name, unit in _POSITIVE:
            require_positive(name, getattr(self, name), unit, remedy="Leave unloaded pairs out")
        require_positive("dynamic_viscosity", self.dynamic_viscosity, "Pa*s")
        require_between("composite_roughness", self.composite_roughness, 0.0, np.inf, "m")
        if self.oil_density is not None:
            require_positive("oil_density", self.oil_density, "kg/m^3")
        require_positive("bodies", self.bodies, "J/(m^2 K s^0.5)")
        for name in films:
            require_between(name, getattr(self, name), 0.0, np.inf, "m")
        self._require_consistent_sliding()
        if self.film is not None and self.film.size != self.size:
            what = f"{self.film.size} films for {self.size} contacts"
            why = "film i belongs to contact i, in flat order"
            remedy = "Give the index of the film of each contact"
            raise InputError(what, "TribologicalContact", why, remedy)

    def _require_consistent_sliding(self) -> None:
        """Refuse a slide-to-roll ratio that was formed with the sum of the speeds, say."""
        expected = np.atleast_1d(self.sliding_speed) / np.atleast_1d(self.entrainment_speed)
        ratio = np.atleast_1d(self.slide_to_roll_ratio)
        wrong = ~(np.abs(ratio - expected) <= 1e-4 * np.abs(expected) + 1e-9)
        if np.any(wrong):
            raise InputError(
                f"slide_to_roll_ratio = {ratio[wrong][0]:.6g}, but sliding_speed over "
                f"entrainment_speed = {expected[wrong][0]:.6g}",
                where="TribologicalContact",
                why="the ratio is (u1 - u2) / ((u1 + u2)/2)",
                remedy="Give entrainment_speed as half the sum of the surface speeds",
            )

    @property
    def size(self) -> int:
        """Number of contacts."""
        return int(np.size(self.load_per_width))

    @property
    def kinematic_viscosity(self) -> float:
        """Viscosity over density [m^2/s]."""
        return self.dynamic_viscosity / float(self.require("oil_density"))

    @property
    def film_ratio(self) -> Array:
        """Film thickness over composite roughness; infinite over smooth flanks."""
        with np.errstate(divide="ignore"):
            return np.asarray(self.require("film_thickness") / np.float64(self.composite_roughness))

    def require(self, name: str) -> Any:
        """Field that a law needs.

        Parameters
        ----------
        name : str
            Name of the field.

        Returns
        -------
        object
            Its value.

        Raises
        ------
        InputError
            If the contacts do not have it, with where it comes from.

        Examples
        --------
        >>> values = 1e5, 8e8, 1.0, 2.0, 0.5, 8e-3, 0.08, 5e-7
        >>> TribologicalContact(*values, oil_density=880.0).require("oil_density")
        880.0
        """
        value = getattr(self, name)
        if value is not None:
            return value
        what = f"{name} is not known"
        raise InputError(what, "TribologicalContact", "The friction law needs it", _REMEDIES[name])


#: Where the fields come from that not every law needs.
_REMEDIES = {
    "film": 'Set [film] model = "newton" (or "multigrid"), or choose another friction law',
    "film_thickness": 'Set [film] model, for example "dowson-higginson", or choose another law',
    "oil_density": "Give the density of the oil",
    "pitch": "Give pitch = pitch_point(pair, speed, torque)",
}


@dataclass(frozen=True)
class FrictionParts:
    """Friction coefficients of contacts whose load a film and asperities share.

    Parameters
    ----------
    film, asperities : array
        Parts of the coefficient: friction force of each over the whole normal force.
    film_load_share : array
        Part of the load on the film.
    """

    film: Array
    asperities: Array
    film_load_share: Array

    @property
    def coefficient(self) -> Array:
        """Friction force over normal force."""
        return np.asarray(self.film + self.asperities)


@with_old_names
@dataclass(frozen=True)
class FrictionLaw(Model):
    """A friction law: called with contacts and options, gives friction coefficients.

    Parameters
    ----------
    name : str
        Name in the registry.
    source : str
        Paper behind the law.
    function : callable
        ``function(contact, **options)``; gives the coefficients, or :class:`FrictionParts`.
    options : mapping of str to Option or default
        Options that the law knows; afterwards their defaults, ``None`` where the user must give a
        value. ``declared`` holds their descriptions.
    needs_film : bool
        Whether the contacts must have their solved ``film``.
    needs_oil : bool
        Whether it needs viscosity or roughness; a case then needs both.
    meaning : str
        One line for whoever chooses a law.
    papers : tuple of str
        Keys of the bibliography of the package.
    rehearsal : str
        Where it needs a solved film: the law that refuses the same options without one.
    together : bool
        Whether the coefficient of a contact depends on that contact alone, its ``pitch`` left out:
        contacts of several operating points may then be given in rows.
    asperities : bool
        Whether it counts the friction of asperities: it gives :class:`FrictionParts`.

    Examples
    --------
    >>> LAWS["constant"].options["coefficient"] is None
    True
    """

    name: str
    source: str
    function: Callable[..., Array | FrictionParts] = field(repr=False)
    options: ByName = field(default_factory=lambda: MappingProxyType({}))
    needs_film: bool = False
    needs_oil: bool = True
    meaning: str = ""
    papers: tuple[str, ...] = ()
    rehearsal: str = "none"
    together: bool = False
    asperities: bool = False

    def __call__(self, contact: TribologicalContact, **options: Any) -> Array:
        """Friction coefficient of every contact, never negative.

        Parameters
        ----------
        contact : TribologicalContact
            Loaded contacts.
        **options : Any
            Options of the law.

        Returns
        -------
        array
            Shape of ``contact.load_per_width``.

        Raises
        ------
        InputError
            If an option is unknown or missing, or the law cannot be applied.
        """
        friction = self.evaluate(contact, options)
        return friction.coefficient if isinstance(friction, FrictionParts) else friction

    def evaluate(self, contact: TribologicalContact, options: ByName) -> Array | FrictionParts:
        """Result of the law: the coefficients, with their parts if it has them.

        Parameters
        ----------
        contact, options
            As for a call of the law.

        Returns
        -------
        array or FrictionParts

        Raises
        ------
        InputError
            As a call of the law.
        """
        return self.function(contact, **self.complete(options))

    def complete(self, options: ByName) -> Tree:
        """Options with the defaults filled in.

        Parameters
        ----------
        options : mapping of str to Any
            What the user gave.

        Returns
        -------
        dict of str to Any

        Raises
        ------
        InputError
            Listing every unknown option and every missing one.

        Examples
        --------
        >>> LAWS["constant"].complete({"coefficient": 0.05})
        {'coefficient': 0.05}
        """
        if not isinstance(options, Mapping):
            what, why = f"options = {shortened(repr(options))}", "They are names with values"
            remedy = f"Known here: {', '.join(self.options) or 'none'}"
            raise InputError(what, f'friction law "{self.name}"', why, remedy)
        problems = [self._unknown(name) for name in options if name not in self.options]
        complete = {**self.options, **options}
        problems += [
            Problem(
                what=f'option "{name}" is missing',
                where=f'friction law "{self.name}"',
                remedy=f"Give {name}",
                why="The law cannot be computed without it",
            )
            for name in self.options
            if complete[name] is None and self.declared[name].required
        ]
        if problems:
            raise InputError(problems)
        return complete

    def _unknown(self, name: str) -> Problem:
        """Say that an option is unknown, naming the nearest."""
        return Problem(
            what=f'unknown option "{name}"',
            where=f'friction law "{self.name}"',
            why=f"Its options: {', '.join(self.options) or 'none'}",
            remedy=self.nearest(name) or "Give one of these",
        )


#: The friction laws by name, open to third parties through the entry points of this group.
LAWS: Registry[FrictionLaw] = Registry("friction law", "tribodyn.friction", FrictionLaw)


#: What formulas call columns of the contacts that have another name there.
_CALLED = {"roughness": "composite_roughness", "roughness_rms": "composite_roughness"}


def of_columns(formula: Callable[..., Array]) -> Callable[..., Array]:
    """Law of a formula whose arguments are columns of the contacts, by name, and options."""
    fields_of_contact = {each.name for each in fields(TribologicalContact)} | {
        "kinematic_viscosity"
    }
    named = {name: _CALLED.get(name, name) for name in signature(formula).parameters}
    columns = {name: column for name, column in named.items() if column in fields_of_contact}

    def law(contact: TribologicalContact, **options: Any) -> Array:
        return formula(**{n: getattr(contact, column) for n, column in columns.items()}, **options)

    return law


class Range(NamedTuple):
    """A quantity with the range in which a law was fitted."""

    name: str  #: name of the quantity
    value: Array  #: value in any unit, named below
    low: float
    high: float
    unit: str = ""  #: unit of value and limits


def warn_outside(law: str, ranges: Iterable[Range], remedy: str) -> None:
    """Warn once, naming every quantity outside of its range with all that it runs through."""
    outside = [(quantity, _outside(quantity)) for quantity in ranges]
    faults = [(_range_text(quantity), mask) for quantity, mask in outside if np.any(mask)]
    if faults:
        texts, masks = zip(*faults, strict=True)
        affected = np.any(np.broadcast_arrays(*masks), axis=0)
        message = f"{law}: {'; '.join(texts)}. {remedy}"
        warn("friction-range", message, stacklevel=3, affected=affected)


def _outside(quantity: Range) -> Mask:
    """Mask of the values outside of the range."""
    value = np.asarray(quantity.value)
    return ~((quantity.low <= value) & (value <= quantity.high))


def _range_text(quantity: Range) -> str:
    """Write the whole range of a quantity and the one of the law."""
    low, high = f"{np.min(quantity.value):.4g}", f"{np.max(quantity.value):.4g}"
    values = low if low == high else f"{low} to {high}"
    limits = f"{quantity.low:g} to {quantity.high:g}"
    if quantity.high == np.inf:
        limits = f"{quantity.low:g} or more"
    unit = f" {quantity.unit}" if quantity.unit else ""
    return f"{quantity.name} {values}{unit}, fitted for {limits}{unit}"
