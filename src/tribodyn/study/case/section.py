"""What every table of the case file shares: frozen, closed, each value checked by its Option.

A table whose key names a model, such as ``law`` of ``[friction]``, takes the options of that
model beside its own. An option of another model is told to belong there, any other key is unknown.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, Self

from tribodyn.errors import InputError, Problem
from tribodyn.model import REQUIRED, Model, Models, Option
from tribodyn.study.case.values import FaultError, Plain, read_value, written

Found = list[tuple[str, Problem]]


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

    def __init__(self, **values: Any) -> None:
        self.__dict__.update(values)

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
        raise InputError(Problem(what, name, "", remedy))

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

    @classmethod
    def read(cls, data: Mapping[str, Any], path: str, found: Found) -> Self:
        """Read a table; what is wrong with its keys is added to ``found``."""
        values = read_fields(cls, data, path, found)
        return cls(**values)


def read_fields(cls: type[Section], data: Mapping[str, Any], path: str, found: Found) -> Any:
    """Values of the keys of a table, in the order of their declaration."""
    values: dict[str, Any] = {}
    options = _options(cls, data)
    for name, field in options.items():
        key = f"{path}.{name}" if path else name
        if isinstance(field, Table):
            values[name] = _read_table(field, data, name, key, found)
        elif name in data:
            try:
                values[name] = read_value(field, name, data[name])
            except FaultError as fault:
                found.append((key, fault.problem))
        elif name in cls.fields:
            values[name] = cls.fields[name].default
            if values[name] is REQUIRED:
                values[name] = None
                found.append((key, _missing(field, name, path)))
        else:
            values[name] = None
    if not options.keys() >= data.keys():
        found += _foreign(cls, data, options, path)
    return values


def _options(cls: type[Section], data: Mapping[str, Any]) -> dict[str, Option | Table]:
    """Keys of a table under the model that it names, whose options go before its own."""
    if not cls.selector:
        return cls.fields
    named = data.get(cls.selector, cls.fields[cls.selector].default)
    model = cls.model_named(named.value if isinstance(named, Plain) else named)
    return cls.fields if model is None else {**cls.fields, **model.case_options}


def _read_table(
    table: Table, data: Mapping[str, Any], name: str, key: str, found: Found
) -> Section | None:
    if name not in data:
        if table.default == "none":
            return None
        if table.default == "required":
            found.append((key, _missing_table(table.kind, key)))
            return None
    inner = data.get(name, {})
    if isinstance(inner, Mapping):
        return table.kind.read(inner, key, found)
    found.append((key, Problem(f"{name} = {written(inner)}", "", f"{name} is a table",
                               f"Write [{key}]")))  # fmt: skip
    return None


def _foreign(
    cls: type[Section], data: Mapping[str, Any], options: Mapping[str, Any], path: str
) -> Iterator[tuple[str, Problem]]:
    """Faults of keys that are not those of this table under its model."""
    strange = [name for name in data if name not in options]
    known = cls.known().keys if strange else {}
    for name in strange:
        key, option = (f"{path}.{name}" if path else name), known.get(name)
        if isinstance(option, Option):
            # That it belongs to another model is told with the other contradictions.
            try:
                read_value(option, name, data[name])
            except FaultError as fault:
                yield key, fault.problem
        else:
            yield key, unknown(tuple(key.split(".")), data[name])


def _missing(option: Option, name: str, path: str) -> Problem:
    example = option.example or '"..."'
    place = f" to [{path}]" if path else ""
    why = f"{option.meaning}: no default exists" if option.meaning else ""
    return Problem(f"{name} is missing", "", why, f"Add for example {name} = {example}{place}")


def _missing_table(kind: type[Section], path: str) -> Problem:
    needed = [
        name
        for name, field in kind.fields.items()
        if (field.required if isinstance(field, Option) else field.default == "required")
    ]
    remedy = f"Add it with {', '.join(needed)}" if needed else "Add it"
    return Problem(f"the table [{path}] is missing", remedy=remedy)


def section_at(path: tuple[str, ...]) -> type[Section] | None:
    """Return the class of the table at a dotted path of a case, or None."""
    section = Section.whole
    for name in path:
        table = section.fields.get(name)
        if not isinstance(table, Table):
            return None
        section = table.kind
    return section


def _homes(name: str, path: tuple[str, ...] = ()) -> list[str]:
    """List the tables that have a key called ``name``."""
    section = section_at(path)
    found = []
    for key, field in section.known().keys.items() if section else ():
        if isinstance(field, Table):
            found += _homes(name, (*path, key))
        elif key == name:
            found.append(f"[{'.'.join(path)}]")
    return found


def unknown(path: tuple[str, ...], value: Any) -> Problem:
    """Say that there is no such key, naming the nearest or the table that has it."""
    *table, name = path
    section = section_at(tuple(table))
    known = list(section.known().keys) if section else []
    known += [] if table else ["assumed"]
    shown = f"{name} = {written(value)}" if not isinstance(value, Mapping) else f"table [{name}]"
    place = f"[{'.'.join(table)}]" if table else "the top of the file"
    why = f"{place} has: {', '.join(known)}"
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.6)
    if near:
        return Problem(f"{shown}: unknown key", "", why, f'Did you mean "{near[0]}"?')
    homes = _homes(name)
    remedy = f"It belongs to {' or '.join(homes)}" if homes else "Remove it"
    return Problem(f"{shown}: unknown key", "", why, remedy)
