"""Base of all tables of the case file: frozen, each value checked by its Option.

A table whose key names a model, such as ``law`` of ``[friction]``, has the options of that model
in addition to its declared keys. Options of another model and unknown keys are errors.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from inspect import Parameter, Signature
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, TypeVar

from tribodyn.aliases import with_old_names
from tribodyn.arguments.reading import one_line
from tribodyn.errors import InputError
from tribodyn.model import Model, Models, Option
from tribodyn.types import ByName, Tree

Value = TypeVar("Value")
#: Kinds of values that are checked where a part is made of them.
RAW_KINDS = ("list", "share")


@dataclass(frozen=True)
class Table:
    """A table inside a table."""

    kind: type[Section]
    meaning: str  #: one line
    default: str = "required"  #: "required", "empty" for all defaults, or "none"


def table(kind: type[Section], meaning: str, default: str = "required") -> Any:
    """Declare a table inside a table; arguments as those of :class:`Table`."""
    return Table(kind, meaning, default)


class SectionKeys(NamedTuple):
    """Models that a table may name, all possible keys, and the models that own each option."""

    models: Mapping[str, Model]
    keys: Mapping[str, Option | Table]
    owners: Mapping[str, list[str]]


def _section_keys(fields: Mapping[str, Option | Table], models: ByName) -> SectionKeys:
    keys = dict(fields)
    owners: dict[str, list[str]] = {}
    for name, model in models.items():
        for key, option in model.case_options.items():
            keys.setdefault(key, option)
            owners.setdefault(key, []).append(name)
    return SectionKeys(models, keys, owners)


@with_old_names
class Section:
    """Base of the tables of a case file; its Options and Tables are class attributes."""

    fields: ClassVar[dict[str, Option | Table]] = {}
    _available: ClassVar[tuple[int, SectionKeys]]
    selector: ClassVar[str] = ""  #: key that names a model, which brings its options
    needed: ClassVar[tuple[str, ...]] = ()  #: keys that a remedy lists; empty: the required keys
    case_class: ClassVar[type[Section]]  #: the table that contains all others

    def __init_subclass__(cls) -> None:
        """Collect the declared keys in their order."""
        declared = {k: v for k, v in vars(cls).items() if isinstance(v, Option | Table)}
        cls.fields = {**cls.fields, **declared}
        chosen = [k for k, v in declared.items() if isinstance(getattr(v, "names", None), Models)]
        cls.selector = chosen[0] if chosen else ""
        for name in declared:
            delattr(cls, name)

    def __getattr__(self, name: str) -> Any:
        """None for an option that the chosen model does not have."""
        if not name.startswith("_") and name in type(self).section_keys().keys:
            return None
        raise AttributeError(f"{type(self).__name__} has no {name}")

    def __setattr__(self, name: str, value: object) -> None:
        """Raise: a checked case is immutable."""
        if name.startswith("_"):
            object.__setattr__(self, name, value)
            return
        what = f"{name} cannot be set: a case is immutable"
        remedy = 'Create a changed copy: case = case.replace({"operation.torque": "120 N*m"})'
        raise InputError(what, name, "", remedy)

    def __eq__(self, other: object) -> bool:
        """Tables are equal when all their values are."""
        return type(other) is type(self) and vars(other) == vars(self)

    def __hash__(self) -> int:
        """Hash of all values."""
        return hash(tuple(vars(self).values()))

    def __repr__(self) -> str:
        """Values that were given or have a default."""
        values = ((k, v) for k, v in vars(self).items() if v is not None and k[0] != "_")
        return one_line(type(self), values)

    def __dir__(self) -> list[str]:
        """List keys, methods and properties."""
        methods = {n for n in {*dir(type(self))} - {*dir(Section)} if not n.startswith("_")}
        return sorted({*methods, *type(self).section_keys().keys})

    @classmethod
    def section_keys(cls) -> SectionKeys:
        """Models that this table may name and all keys that it can have with them."""
        names = cls.fields[cls.selector].names if cls.selector else None  # type: ignore[union-attr]
        if not isinstance(names, Models):
            return SectionKeys({}, cls.fields, {})
        registry = names.registry()
        if vars(cls).get("_available", (None,))[0] != registry.version:
            models = registry.all()
            cls._available = (registry.version, _section_keys(cls.fields, models))
        return cls._available[1]

    @classmethod
    def model_named(cls, name: object) -> Model | None:
        """Return the model of a name, or None if there is no such model."""
        return cls.section_keys().models.get(name) if isinstance(name, str) else None

    @property
    def chosen(self) -> Model | None:
        """The model that this table names."""
        return self.model_named(vars(self)[self.selector]) if self.selector else None

    def _names(self) -> Iterable[str]:
        """Names of the keys of this table."""
        return type(self).section_keys().keys

    @classmethod
    def keys_for(cls, data: ByName) -> Mapping[str, Option | Table]:
        """Keys of a table with these values, without those of the model that it names."""
        return cls.fields

    @classmethod
    def spec(cls, name: str) -> Option | None:
        """Return the Option of a key, or None for an unknown key or a table."""
        option = cls.fields.get(name) or cls.section_keys().keys.get(name)
        return option if isinstance(option, Option) else None

    @classmethod
    def specs(cls) -> Iterator[tuple[str, Option]]:
        """Iterate over all keys that are not tables, in order."""
        yield from ((k, o) for k, o in cls.section_keys().keys.items() if isinstance(o, Option))


class _AnyName(Tree):
    """Fields of a table whose inner tables the user names; reference pages show it as NAME."""

    def __init__(self, inner: Table) -> None:
        super().__init__(NAME=inner)
        self.inner = inner

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str)

    def get(self, name: str, default: object = None) -> Any:
        """Return the same inner table for any name."""
        return self.inner


class NamedTables(Section):
    """A table of tables of one kind, which the user names."""

    listed: ClassVar[bool] = False  #: whether the file has a list of them, which have names

    def __init_subclass__(cls, inner: Table) -> None:
        """Set the kind of the inner tables."""
        cls.fields = _AnyName(inner)

    def _names(self) -> Iterable[str]:
        return vars(self)

    @classmethod
    def keys_for(cls, data: ByName) -> Mapping[str, Option | Table]:
        """One inner table for each name in the data."""
        inner: Table = cls.fields["NAME"]  # type: ignore[assignment]
        return dict.fromkeys(data, inner)


def named_rows(value: object) -> list[tuple[str, ByName]]:
    """Tables of a list of tables, such as ``[[load_cases]]``, with their names or numbers."""
    if not isinstance(value, list | tuple) or not all(isinstance(row, Mapping) for row in value):
        return []
    return [(str(row.get("name", number)), row) for number, row in enumerate(value, 1)]


class Rows(Tree):
    """Tables of a list of tables, by their names or numbers."""


def keyed_rows(data: object) -> object:
    """Copy of tables in which the rows of lists have their names or numbers as keys."""
    if isinstance(data, Mapping):
        return {key: keyed_rows(value) for key, value in data.items()}
    rows = Rows()
    for number, (name, row) in enumerate(named_rows(data), 1):
        rows[f"{name} {number}" if name in rows else name] = keyed_rows(row)
    return rows or data


def listed_rows(data: object) -> object:
    """Tables with the rows of lists as lists again, without lists whose rows have all gone."""
    if not isinstance(data, dict):
        return data
    tables = {key: listed_rows(value) for key, value in data.items() if not _is_empty(value)}
    return list(tables.values()) if isinstance(data, Rows) else tables


def _is_empty(value: object) -> bool:
    return isinstance(value, Rows) and not value


def flat_keys(table: ByName, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted keys of nested tables with their values."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from flat_keys(value, f"{prefix}{name}.")
        elif rows := named_rows(value):
            for row, body in rows:
                yield from flat_keys(body, f"{prefix}{name}.{row}.")
        else:
            yield f"{prefix}{name}", value


def table_in(data: ByName, name: str) -> ByName:
    """Table of a name in a table, the rows of a list by their names; empty where it is none."""
    value = data.get(name)
    return value if isinstance(value, Mapping) else dict(named_rows(value))


def option_at(root: type[Section], data: ByName, key: str | tuple[str, ...]) -> Option | None:
    """Option of a key of these tables; of a value of a list its number ends the key."""
    *path, name = key.split(".") if isinstance(key, str) else key
    section, inner = root, data
    for depth, each in enumerate(path, 1):
        field = section.keys_for(inner).get(each)
        if not isinstance(field, Table):
            listed = isinstance(field, Option) and field.kind == "numbers" and depth == len(path)
            return replace(field, kind="number") if listed and name.isdigit() else None  # type: ignore[type-var]
        section, inner = field.kind, table_in(inner, each)
    keys, model = section.keys_for(inner), None
    if section.selector:  # a table of a part may leave the model to the table for all parts
        shared = table_in(data, path[-1]).get(section.selector) if path else None
        chosen = inner.get(section.selector) or shared or keys[section.selector].default
        model = section.model_named(getattr(chosen, "value", chosen))
    option = (model.declared.get(name) if model else None) or keys.get(name, section.spec(name))
    return option if isinstance(option, Option) else None


def section_at(path: tuple[str, ...], root: type[Section] | None = None) -> type[Section] | None:
    """Return the class of the table at a dotted path of a case, or None."""
    section = root or Section.case_class
    for name in path:
        table = section.fields.get(name)
        if not isinstance(table, Table):
            return None
        section = table.kind
    return section


def options_of(section: type[Section], prefix: str) -> list[tuple[str, Option]]:
    """Return the options of a table and its inner tables by key, without those of models."""
    options: list[tuple[str, Option]] = []
    for name, field in section.fields.items():
        if isinstance(field, Table):
            options += options_of(field.kind, f"{prefix}{name}.")
        else:
            options.append((f"{prefix}{name}", field))
    return options


def entries(
    table: Tree, place: tuple[str, ...] = ()
) -> Iterator[tuple[Tree, str, tuple[str, ...]]]:
    """Iterate over the values of nested tables: the table, the name in it, and the place."""
    for name, value in table.items():
        if isinstance(value, dict):
            yield from entries(value, (*place, name))
        elif rows := named_rows(value):
            for row, body in rows:
                yield from entries(dict(body), (*place, name, row))
        else:
            yield table, name, (*place, name)


def file_entries(root: type[Section], data: Tree) -> Iterator[tuple[Tree, str, str]]:
    """Iterate over the values of tables, and of reasons, that name files, with their keys."""
    for table, name, place in entries(data):
        if place[0] == "assumed" and place[-1] == "value":
            place = tuple(place[1].split("."))
        option = option_at(root, data, place)
        if option is not None and option.kind == "file" and isinstance(table[name], str):
            yield table, name, ".".join(place)


def place_files(root: type[Section], data: Tree, folder: Path) -> None:
    """Resolve the paths of tables against a folder."""
    for table, name, _ in file_entries(root, data):
        table[name] = str((folder / table[name]).absolute())


class CaseTables(Section):
    """The table of all tables, with a cache of values derived from some of them."""

    _named_files: Callable[[], Mapping[str, Path]]

    def _once(self, name: str, tables: tuple[str, ...], compute: Callable[[], Value]) -> Value:
        """Return a value derived from some tables, cached for all cases that share these tables.

        Callers must not modify the value.
        """
        if self._named_files():  # they may change
            return compute()
        shared = vars(self).setdefault("_shared", {})
        sources = tuple(vars(self)[table] for table in tables)
        cached = shared.get(name)
        if cached is None or any(
            old is not new for old, new in zip(cached[0], sources, strict=True)
        ):
            cached = shared[name] = sources, compute()
        value: Value = cached[1]
        return value


class Choice(NamedTuple):
    """The model that a table of a case names, and the keys of all models it may name."""

    selector: str
    model: Model | None
    keys: SectionKeys


def choices(inputs: ByName, root: type[Section] | None = None) -> dict[str, Choice]:
    """Return the models that the tables name, by table; ``inputs`` has dotted keys."""
    chosen = {}
    for name, field in (root or Section.case_class).fields.items():
        if isinstance(field, Table) and field.kind.selector:
            selector, keys = field.kind.selector, field.kind.section_keys()
            model_name = inputs.get(f"{name}.{selector}", field.kind.fields[selector].default)
            model = keys.models.get(model_name) if isinstance(model_name, str) else None
            chosen[name] = Choice(selector, model, keys)
    return chosen


def flat(section: Section, prefix: str = "") -> Tree:
    """Return all values of a table and its inner tables by dotted key."""
    entries = vars(section)
    values: Tree = {}
    for name in section._names():
        value = entries.get(name)
        if isinstance(value, Section):
            values |= flat(value, f"{prefix}{name}.")
        else:
            values[f"{prefix}{name}"] = value
    return values


def in_force(case: Section) -> Tree:
    """Return all values by dotted key, with defaults of the chosen models filled in."""
    values = flat(case)
    for table, section in vars(case).items():
        if not (isinstance(section, Section) and section.selector):
            continue
        options = section.chosen.options if section.chosen else {}
        for name in section.section_keys().owners:
            key = f"{table}.{name}"
            if name not in options:
                values[key] = None
            elif values[key] is None:
                values[key] = options[name]
    return values


class _DefaultTable:
    """Default of an optional table, as shown in signatures."""

    def __repr__(self) -> str:
        """As :mod:`dataclasses` show it."""
        return "<factory>"


def signature_of(root: type[Section]) -> Signature:
    """Return the signature that editors and ``help`` display for the case class."""
    first = Parameter("source", Parameter.POSITIONAL_ONLY, default=None)
    keywords = []
    for name, field in {**root.fields, "assumed": Table(root, "", "empty")}.items():
        if isinstance(field, Table):
            default = {"required": Parameter.empty, "none": None}.get(
                field.default, _DefaultTable()
            )
        else:
            default = Parameter.empty if field.required else field.default
        keywords.append(Parameter(name, Parameter.KEYWORD_ONLY, default=default))
    return Signature([first, *keywords])
