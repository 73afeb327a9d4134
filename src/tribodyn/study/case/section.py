"""What every table of the case file shares: frozen, closed, each value checked by its Option.

A table whose key names a model, such as ``law`` of ``[friction]``, takes the options of that
model beside its own. An option of another model is told to belong there, any other key is unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from inspect import Parameter, Signature
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, TypeVar

from tribodyn.errors import InputError
from tribodyn.model import Model, Models, Option

Value = TypeVar("Value")


@dataclass(frozen=True)
class Table:
    """A table inside a table."""

    kind: type[Section]
    meaning: str  #: one line
    default: str = "required"  #: "required", "empty" for all defaults, or "none"


def table(kind: type[Section], meaning: str, default: str = "required") -> Any:
    """Declare a table inside a table; arguments as those of :class:`Table`."""
    return Table(kind, meaning, default)


class Known(NamedTuple):
    """Models that a table may name, all keys that it can have, and the models of each option."""

    models: Mapping[str, Model]
    keys: Mapping[str, Option | Table]
    owners: Mapping[str, list[str]]


def _known(fields: Mapping[str, Option | Table], models: Mapping[str, Any]) -> Known:
    keys = dict(fields)
    owners: dict[str, list[str]] = {}
    for name, model in models.items():
        for key, option in model.case_options.items():
            keys.setdefault(key, option)
            owners.setdefault(key, []).append(name)
    return Known(models, keys, owners)


class Section:
    """Base of the tables of a case file; its Options and Tables are class attributes."""

    fields: ClassVar[dict[str, Option | Table]] = {}
    _known: ClassVar[tuple[int, Known]]
    selector: ClassVar[str] = ""  #: key that names a model, which brings its options
    needed: ClassVar[tuple[str, ...]] = ()  #: keys to begin with; empty: those that are required
    whole: ClassVar[type[Section]]  #: the table that holds all others: the case

    def __init_subclass__(cls, whole: bool = False) -> None:
        """Collect the declared keys in their order."""
        if whole:
            Section.whole = cls
        own = {k: v for k, v in vars(cls).items() if isinstance(v, Option | Table)}
        cls.fields = {**cls.fields, **own}
        chosen = [k for k, v in own.items() if isinstance(getattr(v, "names", None), Models)]
        cls.selector = chosen[0] if chosen else ""
        for name in own:
            delattr(cls, name)

    def __getattr__(self, name: str) -> Any:
        """None for an option that the chosen model does not have."""
        if not name.startswith("_") and name in type(self).known().keys:
            return None
        raise AttributeError(f"{type(self).__name__} has no {name}")

    def __setattr__(self, name: str, value: Any) -> None:
        """Refuse a new value: a case stays what it was when it was checked."""
        if name.startswith("_"):
            object.__setattr__(self, name, value)
            return
        what = f"{name} cannot be set: a case does not change"
        remedy = 'Make a changed one: case = case.replace({"operation.torque": "120 N*m"})'
        raise InputError(what, name, "", remedy)

    def __eq__(self, other: object) -> bool:
        """Tables are equal when all their values are."""
        return type(other) is type(self) and vars(other) == vars(self)

    def __hash__(self) -> int:
        """Hash of all values."""
        return hash(tuple(vars(self).values()))

    def __repr__(self) -> str:
        """Values that were given or have a default."""
        shown = (f"{k}={v!r}" for k, v in vars(self).items() if v is not None and k[0] != "_")
        return f"{type(self).__name__}({', '.join(shown)})"

    def __dir__(self) -> list[str]:
        """Values and what can be done with them."""
        own = {n for n in dir(type(self)) if not n.startswith("_") and not hasattr(Section, n)}
        return sorted({*own, *type(self).known().keys})

    @classmethod
    def known(cls) -> Known:
        """Models that this table may name and all keys that it can have with them."""
        names = cls.fields[cls.selector].names if cls.selector else None  # type: ignore[union-attr]
        if not isinstance(names, Models):
            return Known({}, cls.fields, {})
        registry = names.registry()
        if vars(cls).get("_known", (None,))[0] != registry.version:
            models = registry.all()
            cls._known = (registry.version, _known(cls.fields, models))
        return cls._known[1]

    @classmethod
    def model_named(cls, name: Any) -> Model | None:
        """The model of a name, or None if there is no such model."""
        return cls.known().models.get(name) if isinstance(name, str) else None

    @property
    def chosen(self) -> Model | None:
        """The model that this table names."""
        return self.model_named(vars(self)[self.selector]) if self.selector else None

    @classmethod
    def spec(cls, name: str) -> Option | None:
        """Return the Option of a key, or None for an unknown key or a table."""
        option = cls.fields.get(name) or cls.known().keys.get(name)
        return option if isinstance(option, Option) else None

    @classmethod
    def specs(cls) -> Iterator[tuple[str, Option]]:
        """Walk over all keys that are no tables, in order."""
        yield from ((k, o) for k, o in cls.known().keys.items() if isinstance(o, Option))


def section_at(path: tuple[str, ...]) -> type[Section] | None:
    """Return the class of the table at a dotted path of a case, or None."""
    section = Section.whole
    for name in path:
        table = section.fields.get(name)
        if not isinstance(table, Table):
            return None
        section = table.kind
    return section


def options_of(section: type[Section], prefix: str) -> list[tuple[str, Option]]:
    """Options of a table and of the tables in it, by their keys; those of models are left out."""
    found: list[tuple[str, Option]] = []
    for name, field in section.fields.items():
        if isinstance(field, Table):
            found += options_of(field.kind, f"{prefix}{name}.")
        else:
            found.append((f"{prefix}{name}", field))
    return found


def file_keys() -> list[str]:
    """Dotted keys of a case that name files."""
    files = [key for key, option in options_of(Section.whole, "") if option.kind == "file"]
    for table, field in Section.whole.fields.items():
        known = field.kind.known().keys if isinstance(field, Table) else {}
        files += [
            f"{table}.{name}"
            for name, option in known.items()
            if isinstance(option, Option) and option.kind == "file"
        ]
    return files


class Whole(Section):
    """The table of all tables, with what follows from some of them."""

    #: Once they were looked for: a case with other numbers names the same.
    _files: dict[str, Path] | None = None

    def _once(self, name: str, tables: tuple[str, ...], compute: Callable[[], Value]) -> Value:
        """What follows from some tables alone: computed once for all cases that share them all.

        Nobody changes it.
        """
        if self._named_files():  # they may change
            return compute()
        shared = vars(self).setdefault("_shared", {})
        own = tuple(vars(self)[table] for table in tables)
        known = shared.get(name)
        if known is None or any(one is not other for one, other in zip(known[0], own, strict=True)):
            known = shared[name] = own, compute()
        found: Value = known[1]
        return found

    def _named_files(self) -> dict[str, Path]:
        """Files that the case names, by dotted key."""
        if self._files is None:
            values = flat(self)
            self._files = {key: Path(values[key]) for key in file_keys() if values.get(key)}
        return self._files


class Choice(NamedTuple):
    """The model that a table of a case names, and what is known of all that it could name."""

    selector: str
    model: Model | None
    known: Known


def choices(given: Mapping[str, Any]) -> dict[str, Choice]:
    """Models that the tables name, by table; ``given`` has dotted keys."""
    found = {}
    for name, field in Section.whole.fields.items():
        if isinstance(field, Table) and field.kind.selector:
            selector, known = field.kind.selector, field.kind.known()
            named = given.get(f"{name}.{selector}", field.kind.fields[selector].default)
            model = known.models.get(named) if isinstance(named, str) else None
            found[name] = Choice(selector, model, known)
    return found


def flat(section: Section, prefix: str = "") -> dict[str, Any]:
    """All values of a table and the tables in it, by dotted key."""
    held = vars(section)
    values: dict[str, Any] = {}
    for name in section.known().keys:
        value = held.get(name)
        if isinstance(value, Section):
            values |= flat(value, f"{prefix}{name}.")
        else:
            values[f"{prefix}{name}"] = value
    return values


def in_force(case: Section) -> dict[str, Any]:
    """All values by dotted key: an option not given has the default of the model that is named."""
    values = flat(case)
    for table, section in vars(case).items():
        if not (isinstance(section, Section) and section.selector):
            continue
        options = section.chosen.options if section.chosen else {}
        for name in section.known().owners:
            key = f"{table}.{name}"
            if name not in options:
                values[key] = None
            elif values[key] is None:
                values[key] = options[name]
    return values


class _Made:
    """Default of a table that may be left out."""

    def __repr__(self) -> str:
        """As :mod:`dataclasses` show it."""
        return "<factory>"


def signature_of(whole: type[Section]) -> Signature:
    """What editors and ``help`` show of the class that holds all tables."""
    first = Parameter("source", Parameter.POSITIONAL_ONLY, default=None)
    keywords = []
    for name, field in {**whole.fields, "assumed": Table(whole, "", "empty")}.items():
        if isinstance(field, Table):
            default = {"required": Parameter.empty, "none": None}.get(field.default, _Made())
        else:
            default = Parameter.empty if field.required else field.default
        keywords.append(Parameter(name, Parameter.KEYWORD_ONLY, default=default))
    return Signature([first, *keywords])
