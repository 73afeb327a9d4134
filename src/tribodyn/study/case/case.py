"""The case: user input, checked and in SI, of a pair of gears, a machine or a planetary stage."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Container, Iterator, Mapping
from copy import copy
from functools import cached_property
from inspect import Signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from tribodyn.aliases import with_old_names
from tribodyn.arguments.reading import brief
from tribodyn.errors import InputError, Problem
from tribodyn.model import NO_OPTIONS
from tribodyn.study.case.provenance import (
    Assumption,
    changed_after,
    provenance,
    read_stated,
    settled,
    tables,
    without_records,
)
from tribodyn.study.case.section import (
    CaseTables,
    Section,
    file_entries,
    option_at,
    place_files,
)
from tribodyn.study.case.user_input import (
    Source,
    Stated,
    UserInput,
    changed_tables,
    plain,
    spread_problem,
    unsound,
    with_values,
    without_spread,
)
from tribodyn.study.case.values import (
    FaultError,
    KeyedProblems,
    Plain,
    correct_keys,
    read_value,
)
from tribodyn.study.case.write import case_rows, case_table, case_text
from tribodyn.types import ByName, Tree

if TYPE_CHECKING:
    from tribodyn.model import Option


class Taken(NamedTuple):
    """What was read in addition to the tables of a case."""

    stated: Stated  #: values that reasons and origin were stated for
    problems: KeyedProblems
    misspelt: KeyedProblems
    spread_faults: KeyedProblems
    typed_keys: dict[str, str]  #: keys as typed by correct key


@with_old_names
class Case(CaseTables):
    """One gear pair, machine or planetary stage under its loads: frozen, checked, in SI.

    Created by :func:`tribodyn.load_case`, or from nested keywords: a float is SI, text and pint
    quantities carry their unit. The tables decide what it is: with ``[meshes.NAME]``,
    ``[shafts.NAME]``, ``[bearings.NAME]`` or ``[planets.NAME]`` it is a machine of named parts
    (:class:`tribodyn.study.MachineCase`), without them a pair of gears
    (:class:`tribodyn.study.PairCase`).

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
    >>> isinstance(case, tribodyn.Case), case.gears.pinion.teeth
    (True, 16)
    """

    #: Classes of cases by what they describe; the last one takes what no other does.
    kinds: ClassVar[list[type[Case]]] = []
    groups: ClassVar[tuple[str, ...]] = ()  #: tables that a case of this kind has, no other
    root: ClassVar[type[Section]]  #: declares the tables of the case
    __signature__: ClassVar[Signature]
    title: str
    origin: str | None
    data: Tree  #: tables of the case file as typed, without spreads and records
    _source: Source
    _spread: dict[str, str]
    _assumed: dict[str, str]
    _stated: Stated
    _effective: Tree
    _changed: tuple[str, ...] | None = None

    def __new__(cls, source: Source | None = None, /, **data: object) -> Self:
        """Return an unread case of the kind that the tables describe."""
        return object.__new__(cls._kind_of(data) if cls is Case else cls)  # type: ignore[return-value]

    if TYPE_CHECKING:

        def __init__(self, source: Source | None = None, /, **data: object) -> None: ...

    def __init_subclass__(cls) -> None:
        """Register a kind of case, whose members show on this class too."""
        super().__init_subclass__()
        Case.kinds[:0] = [cls]
        Case.kinds.sort(key=lambda kind: not kind.groups)
        names = (*vars(cls), *cls.fields)
        members = {name: "Any" for name in names if name[0] != "_" and not hasattr(Case, name)}
        Case.__annotations__ = {**members, **Case.__annotations__}

    @staticmethod
    def _kind_of(data: ByName) -> type[Case]:
        """Class of the case that tables describe."""
        kinds = (kind for kind in Case.kinds if any(group in data for group in kind.groups))
        return next(kinds, Case.kinds[-1])

    def __setattr__(self, name: str, value: object) -> None:
        """Raise for a case that is complete: it is immutable."""
        if "_stated" in vars(self):
            super().__setattr__(name, value)
        else:
            vars(self)[name] = value

    def __getattr__(self, name: str) -> Any:
        """None for an option that the chosen model does not have; else say who has the name."""
        try:
            return super().__getattr__(name)
        except AttributeError:
            if name[0] == "_" or "_stated" not in vars(self):
                raise
        what = f"a {self.kind.lower()} has no {name}"
        others = [kind for kind in Case.kinds if name in {*vars(kind), *kind.root.fields}]
        if others:
            owner = "a machine of named parts" if others[0].groups else "a pair of gears"
            what += f": that is of {owner}"
        raise AttributeError(what)

    @property
    @abstractmethod
    def kind(self) -> str:
        """What the case describes, in words."""

    def _take(self, source: Source | None, typed: Tree) -> Taken:
        """Set the tables as the user typed them, those from Python in SI; return what is stated."""
        origin = source or Source()
        if problems := list(unsound(typed)):
            raise InputError(origin.place(problems))
        typed, misspelt, typed_keys = correct_keys(typed, self.root)
        typed = self._completed(typed)
        values, spread, faults = without_spread(typed if source is not None else plain(typed))
        data = without_records(values)
        place_files(self.root, data, Path())
        vars(self).update(data=data, _source=origin, _spread=spread)
        stated, problems = read_stated(self, values)
        return Taken(stated, problems, misspelt, faults, typed_keys)

    @staticmethod
    def _completed(data: Tree) -> Tree:
        """Tables with what other tables imply."""
        return data

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
        data: ByName,
        changes: ByName,
        spread: Mapping[str, str] = NO_OPTIONS,
        by: str = "",
    ) -> Tree:
        """Tables with values changed, without what the changes leave without effect."""
        return changed_tables(cls.root, data, changes, spread, by)

    @abstractmethod
    def density(self, gear: str) -> float:
        """Density of one gear [kg/m^3]: its own, or that of the material.

        Parameters
        ----------
        gear : str
            Name of its table, such as ``"pinion"``.

        Returns
        -------
        float
        """

    @abstractmethod
    def _all_values(self) -> Tree:
        """Values by dotted key in SI; None where a default is derived, of files their names."""

    def values(self) -> Iterator[tuple[str, Any]]:
        """Iterate over all values of the case.

        Yields
        ------
        tuple of (str, object)
            Dotted key and value in SI; None where nothing was given and a default is derived.
        """
        return iter(self._all_values().items())

    def _with_numbers(self, changes: ByName) -> Self | None:
        """Return a copy with changed numbers, checked by a fast path; None if that does not apply.

        It applies where numbers replace numbers without other effects: which keys are present
        decides the rest of a case.
        """
        base, numbers = self._stated.base, {}
        if not base or self.origin not in (None, base.get("origin")):
            return None
        # Convert NumPy floats.
        changes = {key: float(v) if isinstance(v, float) else v for key, v in changes.items()}
        for key, value in changes.items():
            spec, old = self.option_of(key), self._user_input.get(key)
            if type(value) is not float or spec is None or spec.kind != "number" or old is None:
                return None
            if key in self._spread or key in self._assumed or self._effective.get(key) is None:
                return None
            if key.count(".") > 1:  # inside an inner table or a list
                return None
            try:
                numbers[key] = read_value(spec, key.rpartition(".")[2], Plain(value))
            except FaultError:
                return None
        changed: Self = object.__new__(type(self))
        state: Any = self.__getstate__()
        vars(changed).update(state)
        changed._effective, changed._changed = self._effective | numbers, None
        changed._user_input = self._user_input.with_numbers(changes)
        vars(changed)["data"] = without_records(changed._user_input.data)
        changed._source = self._source.with_replaced(changes, "replace:")
        if not changed._take_numbers(self, numbers):
            return None
        changed_after(self, changed, numbers)
        return changed

    @abstractmethod
    def _take_numbers(self, before: Self, numbers: ByName) -> bool:
        """Take numbers in place of those of the case before; False where that takes a new one."""

    def replace(self, changes: ByName, *, by: str = "") -> Self:
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
        """Unit and range of a dotted key; None where the case has no such key.

        Parameters
        ----------
        key : str
            Such as ``"operation.torque"``.

        Returns
        -------
        Option or None
        """
        return option_at(self.root, self.data, key)

    def _named_files(self) -> dict[str, Path]:
        """Files that the case names, by dotted key."""
        return {key: Path(table[name]) for table, name, key in self._files if name != "value"}

    @cached_property
    def _files(self) -> tuple[tuple[Tree, str, str], ...]:
        return tuple(file_entries(self.root, self.data))

    @property
    def is_rated(self) -> bool:
        """Whether the case asks for the load capacity of its gears."""
        return self.data.get("rating") is not None

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

    def _every_value(self) -> Tree:
        """Tables that are written with the meanings of their keys; None where there is no value."""
        return with_values(self.data, self._spread)

    def to_toml(self) -> str:
        """Write the case as its file was read, with its comments; it reads back to an equal one."""
        return self._text(comments=False)

    def _text(self, *, comments: bool) -> str:
        """Text of the case file, on request with the meanings of its keys as comments."""
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
        """Copy whose housing files lie next to its case file, with a prefix before their names.

        Parameters
        ----------
        prefix : str
            Begins the names of the files.

        Returns
        -------
        Case
        """
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

    def get(self, key: str, default: object = None) -> Any:
        """Value of a dotted key in SI; the default where the case has no such key or value.

        Parameters
        ----------
        key : str
            Such as ``"operation.torque"``.
        default : object
            Takes the place of a missing value.

        Returns
        -------
        object
        """
        try:
            value = self[key]
        except InputError:
            return default
        return default if value is None else value

    def __eq__(self, other: object) -> bool:
        """Cases are equal when all values, their spreads, files and provenance are."""
        if not isinstance(other, Case) or type(self) is not type(other):
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
        return f"Case({brief(self.title)}: {values} values)"

    def __str__(self) -> str:
        """Format all values with units as a table."""
        return case_table(self)

    def _repr_html_(self) -> str:
        """One line that opens the table of all values in notebooks."""
        from tribodyn.record import html_table

        return html_table(repr(self), ("key", "value", "origin"), case_rows(self), closed=True)
