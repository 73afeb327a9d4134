"""The case of a pair of gears, with derived objects as properties."""

from __future__ import annotations

import math
from copy import copy
from dataclasses import replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, ClassVar, Literal, Self

from tribodyn.errors import InputError, Problem
from tribodyn.model import text
from tribodyn.study.case import to_models
from tribodyn.study.case.case import Case
from tribodyn.study.case.checks import cross_problems
from tribodyn.study.case.gears import Gears, is_needed, with_gear_defaults
from tribodyn.study.case.hypoid import hypoid_flanks, torque_problem
from tribodyn.study.case.provenance import (
    Assumption,
    assumptions,
    default_of,
    derived_values,
    effective_values,
    reason_faults,
)
from tribodyn.study.case.rating_tables import Materials, RatingTable
from tribodyn.study.case.section import Section, choices, flat, section_at, signature_of, table
from tribodyn.study.case.sections import (
    Dynamics,
    Film,
    Friction,
    Losses,
    LubricantData,
    MaterialData,
    Operation,
    Solver,
    Stiffness,
)
from tribodyn.study.case.user_input import Source, UserInput
from tribodyn.study.case.values import (
    read_fields,
    unknown_key,
    with_typed_keys,
)
from tribodyn.study.case.write import every_value
from tribodyn.study.faults.section import Faults
from tribodyn.types import ByName, Tree

if TYPE_CHECKING:
    from tribodyn.gear import HypoidFlanks, Material, SpurPair
    from tribodyn.losses import Gearbox
    from tribodyn.lubricant import Lubricant
    from tribodyn.mesh.table_file import TableFile


class PairCase(Case):
    """One gear pair under one load, or several: frozen, checked, in SI.

    Created by :func:`tribodyn.load_case`, or from nested keywords: a float is SI, text and pint
    quantities carry their unit.

    Parameters
    ----------
    source : Source, optional
        Where the values come from; then a bare number for a dimension is refused.
    **data : object
        The tables of the case file.

    Raises
    ------
    InputError
        Listing every problem with its location, the allowed range and the remedy.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness")
    >>> case.gears.pinion.teeth
    16
    """

    title: str = text("Gear pair", meaning="one line that names this case", example='"My gear"')
    origin: str | None = text(
        None, meaning="the document that the values come from", example='"Drawing 4711"'
    )
    gears: Gears = table(Gears, "the gear pair")
    material: MaterialData = table(MaterialData, "material of the gears", "empty")
    lubricant: LubricantData | None = table(LubricantData, "the oil", "none")
    operation: Operation = table(Operation, "speed and load")
    film: Film = table(Film, "oil film", "empty")
    stiffness: Stiffness = table(Stiffness, "stiffness of the teeth", "empty")
    friction: Friction = table(Friction, "friction of the teeth", "empty")
    dynamics: Dynamics = table(Dynamics, "the vibrating structure", "empty")
    losses: Losses | None = table(Losses, "power losses other than those of the teeth", "none")
    solver: Solver = table(Solver, "how the motion is computed", "empty")
    materials: Materials | None = table(Materials, "strength of the gears, by name", "none")
    rating: RatingTable | None = table(RatingTable, "load capacity of the gears", "none")
    faults: Faults | None = table(Faults, "faults that repeat with a shaft, by name", "none")

    _default_of, _derived_values, _every_value = default_of, derived_values, every_value

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """What is assumed: reasons in ``[assumed]``, and what the case does not give."""
        return assumptions(self)

    @cached_property
    def mesh_table(self) -> TableFile | None:
        """The mesh table of another program; None where the teeth are computed."""
        return to_models.mesh_table(self.gears)

    @property
    def gear_ratio(self) -> float:
        """Teeth of the wheel over teeth of the pinion."""
        return abs(self.gears.wheel.teeth / self.gears.pinion.teeth)

    @cached_property
    def gear_pair(self) -> SpurPair:
        """Both gears in their working position.

        Raises
        ------
        InputError
            If the case has a mesh table of another program, or a hypoid pair.
        """
        if self.gears.kind != "spur":
            raise InputError(to_models.no_gear_pair(self.gears.kind))
        pair = partial(to_models.case_pair, self.gears, self.dynamics)
        return self._once("gear_pair", ("gears", "dynamics"), pair)

    @property
    def spur_pair(self) -> SpurPair | None:
        """Both gears in their working position; None where they are no spur gears."""
        return self.gear_pair if self.gears.kind == "spur" else None

    @property
    def contact_models(self) -> tuple[str, str]:
        """Names of the models of the tooth contact in force: stiffness, and film."""
        return to_models.contact_models(self)

    @cached_property
    def hypoid_flanks(self) -> HypoidFlanks | None:
        """Flanks of the side that carries; None where the gears are no hypoid pair."""
        return hypoid_flanks(self.gears) if self.gears.kind == "hypoid" else None

    @cached_property
    def material_properties(self) -> Material:
        """Material of both gears."""
        return self._once("material", ("material",), lambda: to_models.material(self.material))

    def density(self, gear: str) -> float:
        """Density of one gear [kg/m^3]: its own, or that of the material.

        Parameters
        ----------
        gear : str
            ``"pinion"`` or ``"wheel"``.

        Returns
        -------
        float

        Examples
        --------
        >>> import tribodyn
        >>> tribodyn.load_case("fzg-film").density("wheel")
        7800.0
        """
        value = getattr(self.gears, gear).density
        return float(self.material.density if value is None else value)

    @property
    def thermal_contact_coefficients(self) -> tuple[float, float]:
        """``sqrt(k rho c)`` of pinion and wheel [J/(m^2 K s^0.5)]; gear steel if not given."""
        return to_models.thermal_contact_coefficients(self)

    @cached_property
    def lubricant_properties(self) -> Lubricant | None:
        """The oil at its working temperature; None if the case has none."""
        return None if self.lubricant is None else to_models.lubricant(self.lubricant)

    @cached_property
    def film_lubricant(self) -> Lubricant | None:
        """The oil at the bulk temperature of the gears, at which it enters the film."""
        oil = self.lubricant
        if oil is None or oil.gear_temperature is None:
            return self.lubricant_properties
        return to_models.lubricant(oil, oil.gear_temperature)

    @cached_property
    def gearbox(self) -> Gearbox | None:
        """Shafts, seals and oil bath; None if the case has no ``[losses]``."""
        return None if self.losses is None else to_models.gearbox(self.losses)

    @property
    def backlash(self) -> float:
        """Total play on the line of action [m]: given, or that of the tooth thicknesses."""
        value = self.dynamics.backlash
        if value is None:
            return to_models.backlash(self)
        return value

    @property
    def composite_roughness(self) -> float | None:
        """Root of the sum of squares of both roughnesses [m]; None if none is given."""
        pinion, wheel = self.gears.pinion.rms, self.gears.wheel.rms
        if pinion is not None and wheel is not None:
            return math.hypot(pinion, wheel)
        return self.gears.composite_roughness

    @property
    def speed_ratio(self) -> float:
        """Speed of the pinion over that of the gear whose speed and torque the case gives."""
        return self.gear_ratio if self.operation.speed_of == "wheel" else 1.0

    @property
    def pinion_speed(self) -> float:
        """Speed of the pinion [rad/s], whichever gear the speed is given for."""
        return self.operation.speed * self.speed_ratio

    @property
    def pinion_torque(self) -> float:
        """Nominal torque on the pinion [N*m], whichever gear the torque is given for."""
        return self.operation.torque / self.speed_ratio

    @property
    def operating_point(self) -> tuple[float, float]:
        """Speed [rad/s] and nominal torque [N*m] of the pinion."""
        return self.pinion_speed, self.pinion_torque

    def _all_values(self) -> Tree:
        return flat(self)

    kind = "Pair of gears"  #: what the case describes, in words
    lumped: ClassVar[Literal[True]] = True  #: whether ``[dynamics]`` names a lumped structure

    def __init__(self, source: Source | None = None, /, **data: object) -> None:
        stated, problems, misspelt, spread_faults, typed_keys = self._take(source, data)
        records = {name: data[name] for name in ("assumed",) if name in data}
        inputs = UserInput({**self.data, **records})
        complete = with_gear_defaults(inputs)
        body = {name: value for name, value in complete.data.items() if name != "assumed"}
        chosen = choices(complete)
        vars(self).update(read_fields(type(self), body, "", chosen, problems))
        problems = [
            (key, torque_problem(key, problem, inputs))
            for key, problem in problems
            if is_needed(key, inputs.get("gears.kind"))
        ]
        problems += [*misspelt, *reason_faults(self.data.get("assumed", {}))]
        spread_keys = {key for key, _ in spread_faults}
        problems = [fault for fault in problems if fault[0] not in spread_keys] + spread_faults
        problems += self._spread_faults({key for key, _ in problems})
        readable = not any(key.startswith("gears") for key, _ in problems)
        problems += cross_problems(inputs, chosen, {key for key, _ in problems})
        if not problems:
            problems = to_models.case_problems(self)
        elif readable and self.gears is not None:
            reported = {key for key, _ in problems}
            problems += [
                fault for fault in to_models.gear_problems(self.gears) if fault[0] not in reported
            ]
        if problems:
            raise InputError(self._source.place(with_typed_keys(problems, typed_keys)))
        self._effective = effective_values(self)
        self._settle(stated)

    def __getstate__(self) -> Tree:
        """Return the state without derived attributes."""
        return {key: value for key, value in vars(self).items() if key not in _DERIVED}

    def _take_numbers(self, before: Self, numbers: ByName) -> bool:
        vars(self)["_shared"] = vars(before).setdefault("_shared", {})
        for key, number in numbers.items():
            table, _, name = key.partition(".")
            vars(self)[table] = section = copy(getattr(self, table))
            vars(section)[name] = number
        indirect = any(key.startswith(("gears.", "faults.")) for key in numbers)
        return not (indirect or to_models.case_problems(self))

    def _unknown_key(self, key: str) -> Problem:
        path = tuple(key.split("."))
        if (section := section_at(path)) is not None:
            remedy = f"Name one of its keys, such as {key}.{next(iter(section.fields))}"
            return Problem(f"{key} is a table", "", "", remedy)
        while section_at(path[:-1]) is None:
            path = path[:-1]
        return replace(unknown_key(path, None), what=f"{'.'.join(path)}: unknown key")


PairCase.__signature__ = signature_of(PairCase)
PairCase.root = PairCase
#: What help and signature display of the class of every kind.
Case.fields, Case.__signature__ = PairCase.fields, PairCase.__signature__
Section.case_class = Case
#: Attributes derived from the tables, which are not pickled.
_DERIVED = {
    "_shared",
    *(name for name, attribute in vars(PairCase).items() if isinstance(attribute, cached_property)),
}
