"""Models selected by name, their options, and the registries that list them.

An :class:`Option` describes one value that a user may set: its meaning, its unit,
its range and why, an example, the argument of the physics that it becomes. The keys of the case
file are options, and so are the values that a friction law or a film formula takes. A model of a
third party is one file: a function, decorated with :meth:`Registry.define` and its options. From
then on a case file can name it, and its options are keys of the table of the case that names it.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from importlib import metadata
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

from tribodyn.errors import InputError, did_you_mean
from tribodyn.types import ByName

if TYPE_CHECKING:
    from tribodyn.nomenclature import Quantity

T = TypeVar("T")
Names = Callable[[], list[str]]

#: The default of an option that must be given, and what no options are.
REQUIRED: Any = ...
NO_OPTIONS: ByName = MappingProxyType({})


@cache
def entry_points(group: str = "") -> metadata.EntryPoints:
    """Entry points of a group, or of all; the installed packages are searched once."""
    every = entry_points() if group else cast("metadata.EntryPoints", metadata.entry_points())
    return every.select(group=group) if group else every


@dataclass(frozen=True)
class Option:
    """Description of one value that a user may set.

    Created by :func:`number`, :func:`numbers`, :func:`integer`, :func:`choice`, :func:`flag`,
    :func:`text` and :func:`file_path`. Ranges and defaults are in SI.
    """

    #: "number", "numbers", "integer", "choice", "flag", "text" or "file", of parts "list", "share"
    kind: str
    meaning: str  #: one line
    default: Any = None  #: ``REQUIRED`` where one must be given, None where one is derived or none
    symbol: str = ""
    unit: str = ""
    display_unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    positive: bool = False  #: zero is refused although ``low`` is zero
    signed: bool = False  #: a negative value of a size between the limits is accepted too
    pair: bool = False  #: a list of two, for both gears, is accepted too
    origin: str = ""  #: reason for the limits
    names: Names | None = None  #: allowed names of a choice
    meanings: Mapping[str, str] = field(default_factory=dict)  #: meanings of the names
    example: str = ""  #: TOML value displayed where the value is missing
    basis: str = ""  #: source of the value where it is not set
    argument: str = ""  #: name of the argument that it is passed as, if that differs
    absent: str = ""  #: reason why other models do not have this option
    in_case: bool = True  #: whether it is a key of the case file, not only an argument in Python

    @property
    def required(self) -> bool:
        """Whether the value must be given."""
        return self.default is REQUIRED

    def show(self, value: Any) -> str:
        """Write a value in the display unit, lists in brackets, flags as TOML does."""
        if isinstance(value, tuple):
            return f"[{', '.join(self.show(item) for item in value)}]"
        if isinstance(value, bool):
            return str(value).lower()
        if self.unit:
            from tribodyn.units import format_quantity

            return format_quantity(value, self.unit, self.display_unit)
        return f"{value:.10g}" if isinstance(value, float) else str(value)

    def allowed(self) -> str:
        """Accepted range or names, as text."""
        if self.kind == "flag":
            return "true or false"
        if self.names is not None:
            return ", ".join(self.names())
        if math.isfinite(self.low) and math.isfinite(self.high):
            sign = "above " if self.positive else ""
            return f"{sign}{self.show(self.low)} to {self.show(self.high)}"
        finite = f"any finite value in {self.display_unit}" if self.unit else "any finite value"
        kinds = {"text": "text", "file": "path of a file", "list": "a list", "share": "up to 100 %"}
        return kinds.get(self.kind, finite)


def number(
    default: object,
    low: float,
    high: float,
    origin: str,
    *,
    of: str = "",
    meaning: str = "",
    unit: str = "",
    display_unit: str = "",
    symbol: str = "",
    example: str = "",
    **more: Any,
) -> Any:
    """Declare a real option.

    Parameters
    ----------
    default : float, None or REQUIRED
        Value in force where none is given.
    low, high : float
        Allowed range, in SI.
    origin : str
        Why the range is what it is.
    of : str
        Its quantity in :data:`tribodyn.nomenclature.QUANTITIES`, which knows symbol, unit, meaning
        and example. Arguments override them.
    meaning, unit, display_unit, symbol, example : str
        Of a quantity that is not in the nomenclature, or of this option alone.
    **more : object
        Further fields of :class:`Option`.

    Returns
    -------
    Option

    Examples
    --------
    >>> slope = number(0.3, 0.0, 1.0, "dry steel has 0.6", meaning="fall of the friction")
    >>> slope.allowed()
    '0 to 1'
    """
    quantity = _quantity(of)
    return Option(
        kind=more.pop("kind", "number"),
        meaning=meaning or quantity.meaning,
        default=default,
        symbol=symbol or quantity.symbol,
        unit=unit or quantity.unit,
        display_unit=display_unit or unit or quantity.display_unit,
        low=low,
        high=high,
        origin=origin,
        example=example or quantity.example or (f'"1 {display_unit or unit}"' if unit else "1.0"),
        **more,
    )


def _quantity(name: str) -> Quantity:
    from tribodyn.nomenclature import QUANTITIES, Quantity

    return QUANTITIES.get(name) or Quantity(name, "", "", "", "")


def numbers(low: float, high: float, origin: str, *, default: Any = None, **more: Any) -> Any:
    """Declare an optional list of real values; arguments as for :func:`number`."""
    return number(default, low, high, origin, kind="numbers", **more)


def integer(default: Any, low: int, high: int, origin: str, *, meaning: str, **more: Any) -> Any:
    """Declare a whole number."""
    more.setdefault("example", str(default if type(default) is int else low))
    return Option("integer", meaning, default, low=low, high=high, origin=origin, **more)


def choice(default: Any, names: Any, *, meaning: str, **more: Any) -> Any:
    """Declare a choice of names: a list, a mapping to meanings, or a function returning these."""
    if callable(names):
        return Option("choice", meaning, default, names=names, **more)
    names_listed = tuple(names)
    meanings = dict(names) if isinstance(names, Mapping) else {}
    more.setdefault("example", f'"{names_listed[0]}"')
    names = partial(list, names_listed)
    return Option("choice", meaning, default, names=names, meanings=meanings, **more)


def flag(default: bool | None, *, meaning: str, **more: Any) -> Any:
    """Declare an option that is true or false."""
    return Option("flag", meaning, default, **more)


def text(default: Any, *, meaning: str, **more: Any) -> Any:
    """Declare an option of free text."""
    return Option("text", meaning, default, **more)


def file_path(*, meaning: str, example: str) -> Any:
    """Declare an optional path of a file; it becomes absolute."""
    return Option("file", meaning, example=example)


def _declared(default: object) -> Option:
    """Option with a default only."""
    if isinstance(default, Option):
        return default
    if default is None:
        return Option("number", "", REQUIRED, example="1.0")
    if isinstance(default, bool):
        return Option("flag", "", default)
    if isinstance(default, str):
        return Option("text", "", default)
    kind = "numbers" if isinstance(default, tuple | list) else "number"
    return Option(kind, "", default, example="1.0")


class Model:
    """Base class of models: name, source and options.

    The dataclass of a model declares ``options`` as a mapping of names to :class:`Option` or to
    bare defaults, and calls :meth:`declare` in its constructor. Afterwards ``options`` holds the
    defaults, None where a value must be given, and ``declared`` the options themselves.
    """

    name: str
    source: str
    meaning: str
    papers: tuple[str, ...]
    options: ByName
    declared: Mapping[str, Option]
    case_options: Mapping[str, Option]  #: those of them that are keys of the case file

    def __post_init__(self) -> None:
        """Separate options from defaults."""
        self.declare(self.options)

    def declare(self, options: ByName) -> None:
        """Separate the options from their defaults."""
        declared = {name: _declared(option) for name, option in options.items()}
        defaults = {n: None if o.required else o.default for n, o in declared.items()}
        object.__setattr__(self, "declared", MappingProxyType(declared))
        object.__setattr__(self, "options", MappingProxyType(defaults))
        keys = {name: option for name, option in declared.items() if option.in_case}
        object.__setattr__(self, "case_options", MappingProxyType(keys))

    def nearest(self, option: str) -> str:
        """Suggestion of the closest option name; empty if none is close."""
        return did_you_mean(option, self.declared)


_registries: list[Registry[Any]] = []


def known_elsewhere() -> bool:
    """Whether a new process that imports this package has all models of this process."""
    return not any(registry.of_this_process() for registry in _registries)


class Registry(Generic[T]):
    """Registry of named items of one kind, extended by the entry-point group of the same name.

    Parameters
    ----------
    kind : str
        What the things are, for messages: ``"friction law"``.
    group : str, optional
        Entry-point group that third parties use, for example ``"tribodyn.friction"``.
    model : type, optional
        Class of the things, for :meth:`define`.
    part : str
        Its argument that a decorated function becomes.

    Examples
    --------
    >>> laws = Registry("law")
    >>> @laws.register("twice")
    ... def twice(x):
    ...     return 2 * x
    >>> laws["twice"](3)
    6
    """

    def __init__(
        self,
        kind: str,
        group: str | None = None,
        model: Callable[..., T] | None = None,
        part: str = "function",
    ) -> None:
        self.kind = kind
        self.group = group
        self.model = model
        self.part = part
        self._items: dict[str, T] = {}
        self._searched = group is None
        self._entered: set[str] = set()
        self._added: set[str] = set()
        self.version = 0  #: incremented with every registration
        _registries.append(self)

    def register(self, name: str) -> Callable[[T], T]:
        """Decorator that registers an item as ``name``."""

        def keep(item: T) -> T:
            self._items[name] = item
            self.version += 1
            # A number or a table has no module, unlike a function.
            by = str(sys._getframe(1).f_globals.get("__name__", ""))
            (self._added.discard if by.startswith("tribodyn.") else self._added.add)(name)
            return item

        return keep

    def define(self, name: str, **details: object) -> Callable[[Callable[..., Any]], Any]:
        """Decorator that registers a function as a model; details are fields of the model class."""

        def keep(function: Callable[..., Any]) -> Callable[..., Any]:
            if self.model is None:
                raise TypeError(f"a {self.kind} is registered, not defined")
            fields = {"name": name, self.part: function, "options": {}, **details}
            self.register(name)(self.model(**fields))
            return function

        return keep

    def _search(self) -> None:
        if not self._searched and self.group is not None:
            self._searched = True
            for entry in entry_points(self.group):
                self._items.setdefault(entry.name, entry.load())
                self._entered.add(entry.name)
            self.version += 1

    def of_this_process(self) -> bool:
        """Whether it has items that come neither from this package nor from an entry point."""
        added = {
            n: getattr(i, self.part, i) for n, i in self._items.items() if n not in self._entered
        }
        modules = [getattr(item, "__module__", "tribodyn.") for item in added.values()]
        foreign = any(not module.startswith("tribodyn.") for module in modules)
        return foreign or any(name in self._added for name in added)

    def names(self) -> list[str]:
        """All names, in order of registration."""
        if not self._searched:
            self._search()
        return list(self._items)

    def all(self) -> Mapping[str, T]:
        """All items by name, in order of registration."""
        if not self._searched:
            self._search()
        return MappingProxyType(self._items)

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names."""
        return iter(self.names())

    def __contains__(self, name: object) -> bool:
        """Whether ``name`` is registered."""
        if not self._searched:
            self._search()
        return name in self._items

    def __getitem__(self, name: str) -> T:
        """Return the item called ``name``, or raise :class:`InputError` with the closest name."""
        if not self._searched:
            self._search()
        if isinstance(name, str) and name in self._items:
            return self._items[name]
        raise InputError(
            f'no {self.kind} is called "{name}"',
            why=f"Known: {', '.join(self._items)}",
            remedy=did_you_mean(name, self._items, "Choose one of these"),
        )


@dataclass(frozen=True)
class Models:
    """Names of the models of a registry that is imported at first use."""

    registry: Callable[[], Registry[Any]]

    def __call__(self) -> list[str]:
        """Return the names."""
        return self.registry().names()


def model_choice(
    default: str, registry: Callable[[], Registry[Any]], *, meaning: str, **more: Any
) -> Any:
    """Declare the choice of a model, whose options are keys of the same table."""
    return Option("choice", meaning, default, names=Models(cache(registry)), **more)
