"""Film models by name: formulas by author, and the solved line contact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.formulas.line import (
    dowson_1968_minimum,
    dowson_toyoda_central,
    moes_central,
    moes_load_exponent,
    pan_hamrock_central,
    pan_hamrock_minimum,
)
from tribodyn.ehl.steady.batch import Films, solved_films
from tribodyn.ehl.thermal.thermal_model import ThermalModel
from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.lubricant import Lubricant
from tribodyn.model import Model, Registry, choice, integer, numbers
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, ByName, Tree

#: Film [m] from load per width, equivalent radius, entrainment speed, dynamic viscosity,
#: pressure-viscosity coefficient and effective modulus, in this order and in SI.
FilmFormula = Callable[..., Array]

#: Meanings of the film stiffnesses.
_KINDS = {
    "approach": "film stiffness as the slope of the load over the approach of the bodies less "
    "Hertz's; each film keeps its distance in the load sharing",
    "none": "the film is rigid",
    "tangent": "film stiffness as the slope of the load over the central film; of the mesh force, "
    "linear about the load",
    "secant": "film stiffness as the sum of all nodal forces over their films",
    "seed": "film stiffness as one source prints it, a length that doubles with every grid: shown, "
    "not in series",
}


def _stiffness(default: str) -> Any:
    meaning = "stiffness of the oil film; approach, tangent and secant are in series with the teeth"
    return choice(
        default,
        _KINDS,
        meaning=meaning,
        example='"approach"',
        basis="the film model: approach where the contact is solved, none for a formula",
    )


#: Options of the solved films.
_SOLVED: ByName = {
    "stiffness": _stiffness("approach"),
    "nodes": integer(
        513, 65, 16385, "a power of two plus one", example="513",
        meaning="nodes of each solved contact",
    ),
    "positions": integer(
        30, 8, 200, "fewer miss how the film changes, more only cost time", example="30",
        meaning="positions on the path of contact at which the film is solved",
    ),
    "inlet": choice(
        "flooded",
        {
            "flooded": "the inlet of the contact is full of oil",
            "zero": "the oil begins where the domain does: a starved contact",
        },
        meaning="oil supply: plenty, or none before the domain begins",
    ),
    "domain": numbers(
        -100.0, 10.0, "a contact is wetted over 1.5 to 20 half widths", example="-2.5, 1.5",
        meaning="first and last position of each solved contact in Hertzian half widths",
    ),
}  # fmt: skip


@dataclass(frozen=True)
class FilmModel(Model):
    """A film model: the formulas that it has, or the engine that solves the contact.

    Parameters
    ----------
    name : str
        Name in the registry.
    source : str
        Papers behind the model.
    central : callable, optional
        Formula of the central film; ``None`` where the model has none.
    minimum : callable, optional
        Formula of the minimum film; ``None`` where the model has none.
    load_exponent : float or callable, optional
        Slope of the logarithm of the central film over that of the load; a callable takes the
        arguments of the formula.
    method : str
        Engine of :func:`tribodyn.ehl.solve_line_contacts`; empty for formulas.
    options : mapping of str to Option or default
        Options of a formula beyond ``stiffness``, passed to it by name; afterwards the defaults of
        all options of the model.
    meaning : str
        One line for whoever chooses a model.
    papers : tuple of str
        Keys of the bibliography of the package.
    heated : bool
        Whether the energy equation is solved with the film, which then depends on the sliding.

    Examples
    --------
    >>> FILM_MODELS["moes"].minimum is None
    True
    >>> FILM_MODELS["newton"].options["nodes"]
    513
    """

    name: str
    source: str
    central: FilmFormula | None = None
    minimum: FilmFormula | None = None
    load_exponent: float | FilmFormula | None = None
    method: str = ""
    options: ByName = field(default_factory=dict)
    meaning: str = ""
    papers: tuple[str, ...] = ()
    heated: bool = False

    def __post_init__(self) -> None:
        """Separate options from defaults."""
        common = _SOLVED if self.method else {"stiffness": _stiffness("none")}
        self.declare({**common, **self.options})

    @property
    def stiffness_kinds(self) -> tuple[str, ...]:
        """Stiffnesses of the film that the model can put in series with the teeth."""
        if self.method:
            return tuple(_KINDS)
        return ("none",) if self.load_exponent is None else ("none", "tangent")

    def why_not(self, kind: str) -> str:
        """Say why the film has no stiffness of some kind.

        Parameters
        ----------
        kind : str
            Requested stiffness.
        """
        supported = f"Its film has: {', '.join(self.stiffness_kinds)}"
        if kind != "approach" or self.central is None:
            return supported
        return f"{supported}. A formula gives the film but not the approach of the bodies"

    def complete(self, options: ByName) -> Tree:
        """Options with the defaults filled in.

        Parameters
        ----------
        options : mapping of str to object
            What the user gave; ``None`` counts as not given.

        Returns
        -------
        dict of str to object

        Raises
        ------
        InputError
            Listing every option that the model does not have, or a stiffness that it cannot give.

        Examples
        --------
        >>> FILM_MODELS["moes"].complete({"stiffness": "tangent"})
        {'stiffness': 'tangent'}
        """
        supplied = {name: value for name, value in options.items() if value is not None}
        problems = [self._unknown(name) for name in supplied if name not in self.options]
        kind = supplied.get("stiffness", self.options["stiffness"])
        if kind not in self.stiffness_kinds:
            what = f'stiffness = "{kind}"'
            remedy = 'Choose one of these, or the film model "newton"'
            problems.append(
                Problem(what, f'film model "{self.name}"', self.why_not(str(kind)), remedy)
            )
        if problems:
            raise InputError(problems)
        return {**self.options, **supplied}

    def _unknown(self, name: str) -> Problem:
        what, why = f'there is no option "{name}"', f"Its options are: {', '.join(self.options)}"
        return Problem(what, f'film model "{self.name}"', why, self.nearest(name) or "Remove it")

    def films(
        self,
        load_per_width: ArrayLike,
        equivalent_radius: ArrayLike,
        entrainment_speed: ArrayLike,
        lubricant: Lubricant,
        effective_modulus: float,
        *,
        length: ArrayLike = 1.0,
        sliding_speed: ArrayLike | None = None,
        thermal: ThermalModel | None = None,
        progress: Progress = SILENT,
        **options: Any,
    ) -> Films:
        """Films of loaded contacts.

        Parameters
        ----------
        load_per_width, equivalent_radius, entrainment_speed : float or array [N/m], [m], [m/s]
            Normal load per face width, reduced radius of curvature, HALF the sum of the surface
            speeds.
        lubricant, effective_modulus : Lubricant, float [Pa]
            Oil at working temperature; ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
        length : float or array [m]
            Length of the contact line, for the film stiffness.
        sliding_speed : float or array, optional [m/s]
            Difference of the surface speeds; a heated film needs it, others do not depend on it.
        thermal : ThermalModel, optional
            Shear and bodies of a heated film; Ree-Eyring between bodies of steel by default.
        progress : Progress
            Receives the number of solved contacts.
        **options : object
            Options of this model; ``positions`` is for those who choose the contacts.

        Returns
        -------
        Films
            Of the common shape of the arguments; ``None`` where the model gives nothing. Where
            ``stiffness`` is ``"none"`` the film stiffness is that of the approach, of a formula the
            tangent one.

        Raises
        ------
        InputError
            If a value is not positive or an option unknown.
        ComputationError
            If a contact cannot be solved.

        Notes
        -----
        Range and source: those of the formulas, and of :func:`tribodyn.ehl.solve_line_contacts`.

        Examples
        --------
        >>> oil = Lubricant(0.082, 880.0, 2.19e-8)
        >>> films = FILM_MODELS["moes"].films(147802.0, 8e-3, 3.0722, oil, 2.2e11, length=0.02)
        >>> print(f"{float(films.film_stiffness):.3g} N/m")
        3.26e+10 N/m
        """
        chosen = self.complete(options)
        require_positive("length", length, "m")
        contacts = load_per_width, equivalent_radius, entrainment_speed
        if self.method:
            chosen.pop("positions")
            chosen |= {"length": length, "method": self.method, "progress": progress}
            if chosen["domain"] is None:
                chosen["domain"] = "auto"
            if self.heated:
                chosen["thermal"] = thermal or ThermalModel("ree-eyring")
                chosen["sliding_speed"] = _required(sliding_speed)
            return solved_films(*contacts, lubricant, effective_modulus, **chosen)
        oil = lubricant.dynamic_viscosity, lubricant.pressure_viscosity_coefficient
        arguments = *contacts, *oil, effective_modulus
        model_options = {name: value for name, value in chosen.items() if name != "stiffness"}
        central = None if self.central is None else self.central(*arguments, **model_options)
        minimum = None if self.minimum is None else self.minimum(*arguments, **model_options)
        exponent = self.load_exponent
        slope = exponent(*arguments, **model_options) if callable(exponent) else exponent
        stiffness = None
        if central is not None and slope is not None:
            stiffness = -np.asarray(length) * np.asarray(load_per_width) / (slope * central)
        return Films(central, minimum, None, stiffness)


def _required(sliding_speed: ArrayLike | None) -> ArrayLike:
    """Sliding speed of a heated film, which must be given."""
    if sliding_speed is None:
        what, why = "sliding_speed is missing", "the heat in the film depends on it"
        remedy = 'Give it [m/s], or choose the film model "newton"'
        raise InputError(what, 'film model "thermal"', why, remedy)
    return sliding_speed


#: The film models by name; ``none`` computes no film.
FILM_MODELS: Registry[FilmModel] = Registry("film model", "tribodyn.film", FilmModel, "central")

for _model in (
    FilmModel("none", "no film is computed"),
    FilmModel(
        "newton",
        "solved line contact: multilevel Newton-Krylov",
        method="newton",
        meaning="oil film of solved line contacts: Reynolds equation with elastic "
        "flanks, multilevel Newton-Krylov",
        papers=("dowson-higginson-book", "roelands", "saad-schultz"),
    ),
    FilmModel(
        "multigrid",
        "solved line contact: full multigrid after Venner and Lubrecht",
        method="multigrid",
        meaning="oil film of solved line contacts: Reynolds equation with elastic "
        "flanks, full multigrid",
        papers=("dowson-higginson-book", "roelands", "venner-lubrecht"),
    ),
    FilmModel(
        "thermal",
        "solved line contact with its energy equation: Yang and Wen (1990)",
        method="newton",
        heated=True,
        meaning="oil film of solved line contacts with the heat of shear and compression: "
        "temperatures across the film and of the surfaces, viscosity that varies across it",
        papers=("yang-wen", "dowson-generalized", "carslaw-jaeger"),
    ),
    FilmModel(
        "dowson-higginson",
        "minimum film: Dowson (1968); central film: Dowson and Toyoda (1979)",
        central=dowson_toyoda_central,
        minimum=dowson_1968_minimum,
        load_exponent=-0.10,
        meaning="minimum and central oil film of line contacts after Dowson, Higginson and Toyoda",
        papers=("dowson", "dowson-toyoda"),
    ),
    FilmModel(
        "pan-hamrock",
        "Pan and Hamrock (1989)",
        central=pan_hamrock_central,
        minimum=pan_hamrock_minimum,
        load_exponent=-0.166,
        meaning="minimum and central oil film of line contacts after Pan and Hamrock",
        papers=("pan-hamrock",),
    ),
    FilmModel(
        "moes",
        "central film: Moes (1965, 2000)",
        central=moes_central,
        load_exponent=moes_load_exponent,
        meaning="central oil film of line contacts over all regimes after Moes",
        papers=("moes",),
    ),
):
    FILM_MODELS.register(_model.name)(_model)
