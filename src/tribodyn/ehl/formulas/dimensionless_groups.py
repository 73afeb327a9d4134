"""Dimensionless groups of a line contact, and the arguments that every film formula shares."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from types import FunctionType
from typing import Any, NamedTuple, Protocol, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import warn
from tribodyn.nomenclature import positive
from tribodyn.types import Array, Mask


class Groups(NamedTuple):
    """Groups of an isothermal line contact, and the radius that scales the film.

    Parameters
    ----------
    speed : array
        ``U = eta0 u_e / (E' R)`` with the mean entrainment speed, a pure number.
    material : array [1]
        ``G = alpha E'``.
    load : array [1]
        ``W = w / (E' R)``.
    equivalent_radius : array [m]
        Film thickness over dimensionless film ``H = h/R``.
    """

    speed: Array
    material: Array
    load: Array
    equivalent_radius: Array

    @property
    def moes_load(self) -> Array:
        """Load number of Moes, ``M = W (2 U)^(-1/2)``."""
        return np.asarray(self.load / np.sqrt(2.0 * self.speed))

    @property
    def moes_material(self) -> Array:
        """Material number of Moes, ``L = G (2 U)^(1/4)``."""
        return np.asarray(self.material * (2.0 * self.speed) ** 0.25)

    @property
    def moes_film_unit(self) -> Array:
        """Film [m] at ``H_Moes = (h/R) (2 U)^(-1/2) = 1``."""
        return np.asarray(self.equivalent_radius * np.sqrt(2.0 * self.speed))


F = TypeVar("F", bound=Callable[..., Any])

#: What every film formula takes, in this order and in SI: the text of its section ``Parameters``.
ARGUMENTS = """\
load_per_width : float or array [N/m]
    Normal load per face width.
equivalent_radius : float or array [m]
    Reduced radius of curvature.
entrainment_speed : float or array [m/s]
    HALF the sum of the surface speeds.
dynamic_viscosity : float or array [Pa*s]
    Viscosity at ambient pressure.
pressure_viscosity_coefficient : float or array [1/Pa]
    Slope of ln(viscosity) over pressure.
effective_modulus : float or array [Pa]
    ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``."""

_RETURNS = """\
float or array [m]
    Film thickness, of the common shape of the arguments."""
_RAISES = """\
InputError
    If any value is not finite and positive."""


class FilmFormula(Protocol):
    """A formula of six arguments, each a number or an array; see :data:`ARGUMENTS`."""

    def __call__(
        self,
        load_per_width: ArrayLike,
        equivalent_radius: ArrayLike,
        entrainment_speed: ArrayLike,
        dynamic_viscosity: ArrayLike,
        pressure_viscosity_coefficient: ArrayLike,
        effective_modulus: ArrayLike,
    ) -> Array:
        """Film, or what else the formula gives."""


def full_text(text: str) -> str:
    """Docstring of a formula with what all of them share; sections that it has itself stay."""
    first, _, sections = text.partition("\n\n")
    for title, lines in (("Raises", _RAISES), ("Returns", _RETURNS), ("Parameters", ARGUMENTS)):
        if f"{title}\n---" not in sections:
            sections = f"{title}\n{'-' * len(title)}\n{lines}\n\n{sections}"
    return f"{first}\n\n{sections}"


def shared_arguments(function: F) -> F:
    """Complete the docstring of a function that takes the six arguments."""
    function.__doc__ = full_text(inspect.cleandoc(function.__doc__ or ""))
    return function


def film_formula(law: Callable[[Groups], Array]) -> FilmFormula:
    """Make a law of the dimensionless groups a formula of the six arguments in SI."""

    def value(*arguments: Any, **named: Any) -> Array:
        return np.asarray(law(_groups(*arguments, **named)))[()]

    def formula(*arguments: Any, **named: Any) -> Array:
        return value(*arguments, **named)

    # With the globals of the law's module: there the search for doctests expects it.
    public = FunctionType(
        formula.__code__, law.__globals__, law.__name__, None, formula.__closure__
    )
    signature_si = inspect.signature(line_contact_groups, eval_str=True).replace(
        return_annotation="Array"
    )
    public.__signature__ = signature_si  # type: ignore[attr-defined]
    public.__annotations__ = {**line_contact_groups.__annotations__, "return": "Array"}
    public.__module__, public.__qualname__ = law.__module__, law.__qualname__
    public.__doc__ = law.__doc__
    return cast(FilmFormula, shared_arguments(public))


@shared_arguments
def line_contact_groups(
    load_per_width: ArrayLike,
    equivalent_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    pressure_viscosity_coefficient: ArrayLike,
    effective_modulus: ArrayLike,
) -> Groups:
    """Dimensionless groups of a line contact, from checked SI values.

    Returns
    -------
    Groups
        Arrays of the common shape of the arguments.

    Raises
    ------
    InputError
        If any value is not finite and positive.

    Valid for any line contact. Source: Dowson and Higginson (1966); Moes (1965).

    Examples
    --------
    >>> groups = line_contact_groups(49267.5, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11)
    >>> round(float(groups.moes_load), 3), round(float(groups.moes_material), 2)
    (1.654, 19.82)
    """
    return Groups(*np.broadcast_arrays(*_groups(**locals())))


def _groups(
    load_per_width: ArrayLike,
    equivalent_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    pressure_viscosity_coefficient: ArrayLike,
    effective_modulus: ArrayLike,
) -> Groups:
    """The same groups, each of the shape of what it is made of: constants stay numbers."""
    load, radius, speed, viscosity, coefficient, modulus = positive(**locals())
    stiffness = modulus * radius
    return Groups(
        speed=np.asarray(viscosity * speed / stiffness),
        material=np.asarray(coefficient * modulus),
        load=np.asarray(load / stiffness),
        equivalent_radius=radius,
    )


#: The rigid asymptote is left gradually; below this part of the elastic one the film formulas of
#: the elastic regime exceed the film that the piezoviscous oil can build between rigid bodies.
_RIGID_SHARE = 1.0 / 1.5


def rigid_isoviscous(load: Array) -> Array:
    """Film ``H_Moes = 3/M``: neither the bodies yield nor the oil thickens (Martin, Guembel)."""
    return np.asarray(3.0 / load)


def elastic_isoviscous(load: Array) -> Array:
    """Film ``2.621 M^(-1/5)``: the bodies yield (Herrebrugh); 5 % above its exact asymptote."""
    return np.asarray(2.621 * load**-0.2)


def rigid_piezoviscous(material: Array) -> Array:
    """Film ``1.287 L^(2/3)``: the oil thickens (Blok)."""
    return np.asarray(1.287 * material ** (2.0 / 3.0))


def elastic_piezoviscous(load: Array, material: Array) -> Array:
    """Film ``1.311 M^(-1/8) L^(3/4)``: both, the regime of gears (Grubin)."""
    return np.asarray(1.311 * load**-0.125 * material**0.75)


def survey_film(load: Array, material: Array) -> Array:
    """Film of the asymptote that the survey diagram of Moes (1965) puts a contact on."""
    isoviscous = np.maximum(rigid_isoviscous(load), elastic_isoviscous(load))
    thick = np.minimum(rigid_piezoviscous(material), elastic_piezoviscous(load, material))
    return np.asarray(np.maximum(isoviscous, thick))


def elsewhere(isoviscous: Array, rigid: Array, elastic: Array, most: Array) -> Mask:
    """Whether contacts with these films of the asymptotes may be clearly in another regime."""
    # The elastic film has two values where the numbers are bounds of several contacts.
    return np.asarray((isoviscous > np.minimum(elastic, rigid)) | (rigid < _RIGID_SHARE * most))


def _outside(load: tuple[Any, Any], material: tuple[Any, Any]) -> Mask:
    """The same of line contacts with numbers from the first to the second."""
    isoviscous = np.maximum(rigid_isoviscous(load[0]), elastic_isoviscous(load[0]))
    rigid, elastic = rigid_piezoviscous(material[0]), elastic_piezoviscous(load[1], material[0])
    return elsewhere(isoviscous, rigid, elastic, elastic_piezoviscous(load[0], material[1]))


def warn_outside_elastic_piezoviscous(groups: Groups, formula: str) -> None:
    """Warn once (``film-range``) where the survey diagram puts the contact clearly elsewhere."""
    load = groups.moes_load
    first, last = (
        Groups(*(np.asarray(end(group)) for group in groups)).moes_material
        for end in (np.min, np.max)
    )
    if not _outside((np.min(load), np.max(load)), (first, last)):
        return  # none of them, as the worst of both would not be
    load, material = np.broadcast_arrays(load, groups.moes_material)
    remedy = 'Use the film model "moes", which covers all regimes.'
    outside = _outside((load, load), (material, material))
    warn_of_regime(formula, outside, load, material, remedy, stacklevel=7)


def warn_of_regime(
    formula: str, outside: Mask, load: Array, material: Array, remedy: str, *, stacklevel: int
) -> None:
    """Warn once (``film-range``) of the contacts outside of the elastic-piezoviscous regime."""
    if not np.any(outside):
        return
    low, high = np.min(load[outside]), np.max(load[outside])
    warn(
        "film-range",
        f"{formula} holds in the elastic-piezoviscous regime; {np.count_nonzero(outside)} of "
        f"{outside.size} contacts with a Moes load number M from {low:.3g} to {high:.3g} and a "
        f"material number L down to {np.min(material[outside]):.3g} lie outside, where the "
        "survey diagram of Moes puts another asymptote, and the film can be wrong by more than "
        f"20 %. {remedy}",
        stacklevel=stacklevel,
    )
