"""What cases of every kind have: values by key, where each comes from, equality and text."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

from tribodyn.arguments.display import brief
from tribodyn.errors import InputError
from tribodyn.study.case.provenance import Assumption, provenance
from tribodyn.study.case.user_input import Source, Stated, UserInput
from tribodyn.study.case.write import case_rows, case_table

if TYPE_CHECKING:
    from tribodyn.errors import Problem
    from tribodyn.model import Option
    from tribodyn.study.case.section import Section


class BaseCase:
    """What follows from the checked values of a case by dotted key, and from what was typed."""

    root: ClassVar[type[Section]]  #: declares the tables of the case
    title: str
    origin: str | None
    _source: Source
    _spread: dict[str, str]
    _assumed: dict[str, str]
    _user_input: UserInput
    _stated: Stated
    _effective: dict[str, Any]
    _changed: tuple[str, ...] | None = None
    _named_files: Callable[[], dict[str, Path]]  #: files that the case names, by dotted key

    @abstractmethod
    def option_of(self, key: str) -> Option | None:
        """Unit and range of a key; None where the case has no such key."""

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

    @abstractmethod
    def _text(self, *, comments: bool) -> str:
        """Text of the case file; a file of parts has a comment for each key if that is asked."""

    def to_toml(self) -> str:
        """Write the case file; it reads back to an equal case."""
        return self._text(comments=False)

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
        """Copy whose housing files lie beside its case file."""
        return self

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
