"""What cases of every kind have, and the values and physics objects of a pair of gears."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Container, Iterator, Mapping
from copy import copy
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from tribodyn.arguments.reading import brief
from tribodyn.errors import InputError, Problem
from tribodyn.model import NO_OPTIONS, text
from tribodyn.study.case import to_models
from tribodyn.study.case.changes import changed_tables, with_values
from tribodyn.study.case.gears import Gears
from tribodyn.study.case.hypoid import hypoid_flanks
from tribodyn.study.case.provenance import (
    Assumption,
    assumptions,
    default_of,
    derived_values,
    provenance,
    read_stated,
    settled,
    tables,
    without_records,
)
from tribodyn.study.case.rating_tables import Materials, RatingTable
from tribodyn.study.case.section import (
    CaseTables,
    Section,
    file_entries,
    flat,
    option_at,
    place_files,
    table,
)
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
from tribodyn.study.case.user_input import (
    Source,
    Stated,
    UserInput,
    plain,
    spread_problem,
    without_spread,
)
from tribodyn.study.case.values import KeyedProblems
from tribodyn.study.case.write import case_rows, case_table, case_text, every_value
from tribodyn.study.faults.section import Faults

if TYPE_CHECKING:
    from tribodyn.gear import HypoidFlanks, Material, SpurPair
    from tribodyn.losses import Gearbox
    from tribodyn.lubricant import Lubricant
    from tribodyn.mesh.table_file import TableFile
    from tribodyn.model import Option


class Taken(NamedTuple):
    """What was read beside the tables of a case."""

    stated: Stated  #: values that reasons and origin were stated for
    problems: KeyedProblems
    spread_faults: KeyedProblems


class BaseCase:
    """What follows from the checked values of a case by dotted key, and from what was typed."""

    root: ClassVar[type[Section]]  #: declares the tables of the case
    title: str
    origin: str | None
    data: dict[str, Any]  #: tables of the case file as typed, without spreads and records
    _source: Source
    _spread: dict[str, str]
    _assumed: dict[str, str]
    _stated: Stated
    _effective: dict[str, Any]
    _changed: tuple[str, ...] | None = None
    __init__: Callable[..., None]

    def _take(self, source: Source | None, typed: dict[str, Any]) -> Taken:
        """Set the tables as the user typed them, those from Python in SI; return what is stated."""
        values, spread, faults = without_spread(typed if source is not None else plain(typed))
        data = without_records(values)
        place_files(self.root, data, Path())
        vars(self).update(data=data, _source=source or Source(), _spread=spread)
        stated, problems = read_stated(self, values)
        return Taken(stated, problems, faults)

    def _settle(self, stated: Stated) -> None:
        """Set the reasons that hold for the values, and the values that the case began with."""
        marks = self.data.get("assumed", {})
        self._stated, stale = settled(self, marks, UserInput(self.data), stated)
        self._assumed = {key: why for key, why in marks.items() if key not in stale}
        if stale:
            vars(self)["data"] = {**self.data, "assumed": self._assumed}

    @classmethod
    def _changed_tables(
        cls,
        data: Mapping[str, Any],
        changes: Mapping[str, Any],
        spread: Mapping[str, str] = NO_OPTIONS,
        by: str = "",
    ) -> dict[str, Any]:
        """Tables with values changed, without what the changes leave without effect."""
        return changed_tables(cls.root, data, changes, spread, by)

    @abstractmethod
    def _all_values(self) -> dict[str, Any]:
        """Values by dotted key in SI; None where a default is derived, of files their names."""

    def values(self) -> Iterator[tuple[str, Any]]:
        """Iterate over all values of the case.

        Yields
        ------
        tuple of (str, object)
            Dotted key and value in SI; None where nothing was given and a default is derived.
        """
        return iter(self._all_values().items())

    def _with_numbers(self, changes: Mapping[str, Any]) -> Self | None:
        """Copy with changed numbers by a fast path; None where that does not apply."""
        return None

    def replace(self, changes: Mapping[str, Any], *, by: str = "") -> Self:
        """Return a new case with some values changed; it is checked as a whole.

        Parameters
        ----------
        changes : mapping
            Dotted key to value: a float in SI, text with a unit, a pint quantity, or None to go
            back to the default. A changed value is no longer marked as assumed or documented by
            the origin of the case.
        by : str
            Source of the change, for messages, for example ``"--set"``; then a bare number for
            a dimension is refused as in a file.

        Raises
        ------
        InputError
            As for a case file.

        Examples
        --------
        >>> import tribodyn
        >>> rough = tribodyn.load_case("fzg-roughness").replace(
        ...     {"gears.composite_roughness": "0.991 um"})
        >>> round(rough.gears.composite_roughness * 1e6, 3)
        0.991
        """
        if not by and (quick := self._with_numbers(changes)) is not None:
            return quick
        source = self._source.with_replaced(changes, by or "replace:")
        data = self._changed_tables(self.user_input.data, changes, self._spread, by)
        changed: Self = type(self)(source, **data)
        return changed

    def option_of(self, key: str) -> Option | None:
        """Unit and range of a dotted key; None where the case has no such key."""
        return option_at(self.root, self.data, key)

    def _named_files(self) -> dict[str, Path]:
        """Files that the case names, by dotted key."""
        return {key: Path(table[name]) for table, name, key in self._files if name != "value"}

    @cached_property
    def _files(self) -> tuple[tuple[dict[str, Any], str, str], ...]:
        return tuple(file_entries(self.root, self.data))

    @property
    @abstractmethod
    def assumptions(self) -> tuple[Assumption, ...]:
        """What is assumed: reasons in ``[assumed]``, and what the case does not give."""

    def _default_of(self, key: str) -> Any:
        """Value of a key that is not given; None if it is derived or there is none."""
        option = self.option_of(key)
        return None if option is None or option.required else option.default

    def _derived_values(self) -> dict[str, float]:
        """Values that follow from others because the case does not give them."""
        return {}

    @abstractmethod
    def _unknown_key(self, key: str) -> Problem:
        """Problem of a key that the case does not have."""

    def _every_value(self) -> dict[str, Any]:
        """Tables that are written with the meanings of their keys; None where there is no value."""
        return with_values(self.data, self._spread)

    def to_toml(self) -> str:
        """Write the case as its file was read, with its comments; it reads back to an equal one."""
        return self._text(comments=False)

    def _text(self, *, comments: bool) -> str:
        """Text of the case file, if asked with the meanings of its keys as comments."""
        return case_text(self, comments=comments)

    def _spread_faults(self, faulty: Container[str] = ()) -> list[tuple[str, Problem]]:
        """Report spreads beyond the range of their key, and of keys that have no number."""
        faults = []
        for key, spread in self._spread.items():
            option = None if key in faulty else self.option_of(key)
            problem = None if option is None else spread_problem(option, key, spread)
            if key not in faulty and (option is None or option.kind not in ("number", "integer")):
                why = "Only numbers of the case have a spread"
                problem = Problem(f"{key} = {spread}", "", why, "Give one value")
            faults += [(key, problem)] if problem else []
        return faults

    @property
    def uncertain(self) -> dict[str, str]:
        """Values with a spread as typed, by dotted key."""
        return dict(self._spread)

    @property
    def assumed(self) -> dict[str, str]:
        """Reasons of values that the source of the case does not print, by dotted key."""
        return self._assumed

    @property
    def user_input(self) -> UserInput:
        """User input, before defaults."""
        return self._user_input

    @cached_property
    def _user_input(self) -> UserInput:
        return UserInput({**self.data, **tables(self._stated, self._assumed)})

    @property
    def source(self) -> Source:
        """Source of the values."""
        return self._source

    @property
    def stated(self) -> Stated:
        """Values that the reasons and the origin of the case refer to."""
        return self._stated

    @property
    def housing_files(self) -> dict[str, str]:
        """Paths of the files of the housing by key."""
        files = {key.partition("housing."): path for key, path in self._named_files().items()}
        return {name: str(path) for (before, _, name), path in files.items() if name and not before}

    def with_files(self, prefix: str) -> Self:
        """Copy whose housing files lie beside its case file, with a prefix before their names."""
        if not (files := self.housing_files):
            return self
        names = {k: prefix + Path(path).name.removeprefix(prefix) for k, path in files.items()}
        other = copy(self)
        vars(other)["data"] = {**self.data, "housing": {**self.data["housing"], **names}}
        vars(other).pop("_files", None)
        return other

    def __getitem__(self, key: str) -> Any:
        """Value of a dotted key in SI, given or by default; of a list also by number from 1."""
        values, (name, _, number) = self._effective, str(key).rpartition(".")
        if key in values:
            return values[key]
        if number.isdigit() and isinstance(listed := values.get(name), tuple):
            return listed[int(number) - 1] if 1 <= int(number) <= len(listed) else None
        if self.option_of(str(key)) is None:
            raise InputError(self._unknown_key(str(key)))
        file = self._named_files().get(key)
        return self._default_of(key) if file is None else str(file)

    def get(self, key: str, default: Any = None) -> Any:
        """Value of a dotted key in SI; the default where the case has no such key or value."""
        try:
            value = self[key]
        except InputError:
            return default
        return default if value is None else value

    def __eq__(self, other: object) -> bool:
        """Cases are equal when all values, their spreads, files and provenance are."""
        if not isinstance(other, BaseCase) or type(self) is not type(other):
            return NotImplemented
        same = self._effective == other._effective and self._spread == other._spread
        same = same and self._named_files() == other._named_files()
        return same and provenance(self) == provenance(other)

    def __hash__(self) -> int:
        """Hash all effective values."""
        return hash(tuple(self._effective.items()))

    def __repr__(self) -> str:
        """One line; ``print(case)`` writes the table."""
        values = sum(value is not None for value in self._effective.values())
        return f"{type(self).__name__}({brief(self.title)}: {values} values)"

    def __str__(self) -> str:
        """Format all values with units as a table."""
        return case_table(self)

    def _repr_html_(self) -> str:
        """One line that opens the table of all values in notebooks."""
        from tribodyn.record import html_table

        return html_table(repr(self), ("key", "value", "origin"), case_rows(self), closed=True)


class CaseData(BaseCase, CaseTables):
    """All tables of a case, the physics objects built from them, and their provenance."""

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
    def is_rated(self) -> bool:
        """Whether the case asks for the load capacity of its gears."""
        return self.rating is not None

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

    def _all_values(self) -> dict[str, Any]:
        return flat(self)
