"""Read tables and values of the case file: check them and convert them to SI."""

from __future__ import annotations

import difflib
import math
import numbers as numeric
import operator
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np

from tribodyn import units
from tribodyn.aliases import closest
from tribodyn.arguments.annotations import UnitRefusedError, magnitude, quantity_in, unit_text
from tribodyn.errors import Problem, did_you_mean, shortened
from tribodyn.model import REQUIRED, Option
from tribodyn.nomenclature import GEARS
from tribodyn.scope import not_modelled
from tribodyn.study.case.section import RAW_KINDS, Choice, Section, Table, named_rows, section_at
from tribodyn.types import ByName, Tree


class Term(NamedTuple):
    """Explanation of a term that users type or search for."""

    meaning: str
    key: str = ""  #: last part of the key, or the quantity, that the term means
    page: str = ""  #: page of the documentation


@lru_cache(maxsize=1)
def _terms() -> dict[str, Term]:
    import tomllib

    text = files("tribodyn.study.case").joinpath("texts", "words.toml").read_text(encoding="utf-8")
    entries = tomllib.loads(text).values()
    listed = {
        name: Term(**{k: v for k, v in entry.items() if k != "words"})
        for entry in entries
        for name in entry["words"]
    }
    return listed | {name: Term(text, page="scope.md") for name, text in not_modelled().items()}


def find_term(text: str) -> Term | None:
    """Find a term, ignoring case and underscores; None if it is not listed."""
    lowered = text.strip().lower()
    return _terms().get(lowered) or _terms().get(lowered.replace("_", " ").replace("-", " "))


def listed_terms() -> list[str]:
    """Return all listed terms."""
    return list(_terms())


Chosen = Mapping[str, Choice]
KeyedProblems = list[tuple[str, Problem]]
Kind = TypeVar("Kind", bound=Section)

#: Items of a list that a message repeats, and unknown keys that are reported, at most.
_MAX_ITEMS, _MAX_UNKNOWN = 20, 50
#: Integers above this are taken for typing errors.
_LARGEST = 10**18


@dataclass(frozen=True)
class Plain:
    """A value given in Python: a bare number is SI, while in text it would lack its unit."""

    value: Any


def unmarked(value: object) -> Any:
    """A value as text or number, lists as tuples."""
    value = value.value if isinstance(value, Plain) else value
    return tuple(map(unmarked, value)) if isinstance(value, list | tuple) else value


class FaultError(Exception):
    """Error in one value, before its location in the file is added."""

    def __init__(self, what: str, why: str = "", remedy: str = "") -> None:
        super().__init__(what)
        self.problem = Problem(what, "", why, remedy)


def written(value: object, depth: int = 5) -> str:
    """Format a value as TOML, shortened to fit a message."""
    if isinstance(value, Plain):
        value = value.value
    if isinstance(value, str):
        return f'"{shortened(value, 195)}"'
    if isinstance(value, Mapping | list | tuple) and not depth:
        return "..."
    if isinstance(value, Mapping):
        items = islice(value.items(), _MAX_ITEMS)
        text = ", ".join(f"{key} = {written(item, depth - 1)}" for key, item in items)
        return shortened(f"{{{text}}}")
    if isinstance(value, list | tuple):
        items_text = [written(item, depth - 1) for item in value[:_MAX_ITEMS]]
        return shortened(f"[{', '.join(items_text)}{', ...' if len(value) > _MAX_ITEMS else ''}]")
    if isinstance(value, int) and abs(value) > _LARGEST:
        return f"a whole number of about {int(0.30103 * value.bit_length()) + 1} digits"
    return str(value).lower() if isinstance(value, bool) else shortened(str(value))


def _grouped(spec: Option, name: str, value: str) -> FaultError | None:
    """Return the error for a number with a comma or separated thousands, or None."""
    readings = units.readings(value)
    if not readings:
        return None
    examples = [f"{name} = {text}" if not spec.unit else f'{name} = "{text}"' for text in readings]
    why = units.NUMBERS[0].upper() + units.NUMBERS[1:]
    return FaultError(f"{name} = {written(value)}", why, f"Write {' or '.join(examples)}")


#: A plain decimal number.
_PLAIN = r"\d{1,9}(?:\.\d{0,9})?"


def _misread(spec: Option, name: str, value: str, message: str) -> FaultError:
    """Return the error for text that is not a quantity of the field."""
    reason, lacks_unit, _ = message.partition("; write for example")
    remedy = f"Write for example {spec.example}"
    if lacks_unit:
        remedy = f'Write for example {name} = "{value.strip()} {spec.display_unit}"'
    elif spec.unit == "K" and (degrees := re.fullmatch(rf"\s*(-?{_PLAIN})\s*([CF])\s*", value)):
        remedy = f'Write {name} = "{degrees[1]} deg{degrees[2]}"'
    elif spec.unit == "m" and (pitch := re.fullmatch(rf"\s*({_PLAIN})\s*1/in(ch)?\s*", value)):
        module = 25.4 / max(float(pitch[1]), 1e-9)
        remedy = f'If that is a diametral pitch, write the module, "{module:.6g} mm"'
    elif spec.unit == "rad/s":
        turns = re.fullmatch(r"\s*([\d.]+)\s*Hz\s*", value)
        remedy = 'Write a rotational speed in rpm, for example "900 rpm"'
        if turns:
            rpm = 60.0 * float(turns.group(1))
            remedy = f'Write it in rpm: "{rpm:g} rpm" if turns per second are meant'
    return FaultError(f"{name} = {written(value)}", reason, remedy)


def in_unit(value: object, unit: str | None) -> Any:
    """Number of a quantity in ``unit``, by exact factors where it is one float."""
    number, written_float = magnitude(value, unit), getattr(quantity_in(value), "magnitude", None)
    if unit and isinstance(written_float, float | int):
        with suppress(units.UnitProblemError):
            return units.convert(float(written_float), unit_text(quantity_in(value)), unit)
    return number


def _in_si(spec: Option, name: str, value: object) -> Any:
    """SI number, or list of numbers, of an object with a unit."""
    try:
        return np.asarray(in_unit(value, spec.unit)).tolist()
    except UnitRefusedError as refused:
        remedy = f"Write for example {spec.example}"
        raise FaultError(f"{name} = {written(str(value))}", str(refused), remedy) from None


def _real(spec: Option, name: str, value: object, as_text: bool) -> float:
    """Convert text, a quantity with a unit or a number to an SI float."""
    entry = f"{name} = {written(value)}"
    if quantity_in(value) is not None:
        as_text, value = False, _in_si(spec, name, value)
    if isinstance(value, str):
        if grouped := _grouped(spec, name, value):
            raise grouped
        if not spec.unit:
            share = re.fullmatch(rf"\s*({_PLAIN})\s*%\s*", value)
            remedy = "Write it without quotes"
            if share:
                remedy = f"Write {name} = {float(share[1]) / 100.0:g}"
            raise FaultError(entry, f"{name} is a pure number, not text", remedy)
        try:
            return units.parse(value, spec.unit)
        except units.UnitProblemError as error:
            raise _misread(spec, name, value, str(error)) from None
    if isinstance(value, bool) or not isinstance(value, numeric.Real):
        kind = "a number with a unit" if spec.unit else "a number"
        raise FaultError(entry, f"{name} must be {kind}", f"Write for example {spec.example}")
    if spec.unit and as_text:
        remedy = f'Write for example {name} = "{value} {spec.display_unit}"'
        raise FaultError(entry, f"{name} has a dimension and needs a unit, as text", remedy)
    try:
        return float(value)
    except OverflowError:
        raise FaultError(entry, f"{name} is too large", "Correct the value") from None


def _in_range(spec: Option, name: str, value: float, typed: object) -> None:
    """Raise if a value is not finite or outside the limits of the field."""
    size = abs(value) if spec.signed else value
    outside = not (spec.low <= size <= spec.high) or (spec.positive and value == spec.low)
    if not outside and math.isfinite(value):
        return
    entry = f"{name} = {written(typed)}"
    if spec.unit and math.isfinite(value) and abs(value) < 1e300:
        display = spec.show(value)
        entry += "" if display == str(typed) else f" ({display})"
    why = f"Allowed: {spec.allowed()} ({spec.origin})" if spec.origin else spec.allowed()
    remedy = "Correct the value or its unit" if spec.unit else "Correct the value"
    if value < 0.0 <= spec.low <= -value <= spec.high:
        remedy = f"{remedy}; without its sign it is in the range"
    raise FaultError(entry, why, remedy)


def _integer(spec: Option, name: str, value: Any) -> int:
    try:
        if isinstance(value, bool):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        digits = re.fullmatch(r"(\d{1,9})(\.0*)?", str(value).strip())
        remedy = f"Write {name} = {int(digits[1])}" if digits else ""
        remedy = remedy or f"Write for example {name} = {spec.example}"
        raise FaultError(
            f"{name} = {written(value)}", f"{name} must be a whole number", remedy
        ) from None
    _in_range(spec, name, number, value)
    return number


def _name(spec: Option, name: str, value: object) -> str:
    names = spec.names() if spec.names else []
    if isinstance(value, str) and value in names:
        return value
    entry, why = f"{name} = {written(value)}", f"Allowed: {', '.join(names)}"
    remedy = did_you_mean(value, names)
    if not remedy and (term := find_term(str(value))):
        raise FaultError(entry, term.meaning, why)
    raise FaultError(entry, why, remedy or "Choose one of these")


def read_value(spec: Option, name: str, value: object) -> Any:
    """Check one value and return it in SI; lists of parts, which have own checks, as they are."""
    if spec.kind in RAW_KINDS:
        return value
    as_text = not isinstance(value, Plain)
    if isinstance(value, Plain):
        value = value.value
    if quantity_in(value) is not None:
        as_text, value = False, _in_si(spec, name, value)
    if spec.pair and isinstance(value, list | tuple):
        return _both_gears(spec, name, value, as_text)
    if spec.kind == "number":
        result = _real(spec, name, value, as_text)
        _in_range(spec, name, result, value)
        return result
    if spec.kind == "integer":
        return _integer(spec, name, value)
    if spec.kind == "choice":
        return _name(spec, name, value)
    if spec.kind == "numbers":
        return _list(spec, name, value, as_text)
    expected_type = bool if spec.kind == "flag" else str
    if not isinstance(value, expected_type):
        remedy = "Write true or false" if expected_type is bool else "Write it in quotes"
        raise FaultError(f"{name} = {written(value)}", f"{name} must be {spec.allowed()}", remedy)
    return str(Path(str(value)).absolute()) if spec.kind == "file" else value


def _list(spec: Option, name: str, value: object, as_text: bool) -> tuple[float, ...]:
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        example = spec.example if spec.example.startswith("[") else f"[{spec.example}]"
        remedy = f"Write for example {name} = {example}"
        raise FaultError(f"{name} = {written(value)}", f"{name} must be a list", remedy)
    result = []
    for position, item in enumerate(value):
        label = f"{name}[{position}]"
        plain = isinstance(item, Plain)
        item = item.value if plain else item
        result.append(_real(spec, label, item, as_text and not plain))
        _in_range(spec, label, result[-1], item)
    return tuple(result)


def _both_gears(spec: Option, name: str, value: Any, as_text: bool) -> tuple[float, ...]:
    if len(value) != 2:
        remedy = f"Write one value for both gears, or {name} = [{spec.example}, {spec.example}]"
        raise FaultError(
            f"{name} = {written(value)}",
            f"A list must have two values, for {GEARS[0]} and {GEARS[1]}",
            remedy,
        )
    return _list(spec, name, value, as_text)


def read_table(
    cls: type[Kind], data: ByName, path: str, chosen: Chosen, problems: KeyedProblems
) -> Kind:
    """Read a table with the options of its model; append errors to ``problems``."""
    section = cls.__new__(cls)
    vars(section).update(read_fields(cls, data, path, chosen, problems))
    return section


def read_fields(
    cls: type[Section], data: ByName, path: str, chosen: Chosen, problems: KeyedProblems
) -> Tree:
    """Read the values of a table in the order of declaration; append errors to ``problems``."""
    values: Tree = {}
    model = chosen[path].model if path in chosen else None
    # The options of a model take precedence over keys of the same name.
    fields = cls.keys_for(data)
    options = {**fields, **model.case_options} if model else fields
    for name, field in options.items():
        key = f"{path}.{name}" if path else name
        if isinstance(field, Table):
            values[name] = _read_inner(field, data.get(name), key, chosen, problems)
        elif model and name == cls.selector:
            values[name] = model.name
        elif name in data:
            try:
                values[name] = read_value(field, name, data[name])
            except FaultError as fault:
                problems.append((key, fault.problem))
        elif name in fields:
            values[name] = field.default
            if values[name] is REQUIRED:
                values[name] = None
                problems.append((key, _missing(field, name, path)))
        else:
            values[name] = None
    if not options.keys() >= data.keys():
        problems += _unexpected_keys(cls, data, options, path)
    return values


def _read_inner(
    table: Table, value: object, key: str, chosen: Chosen, problems: KeyedProblems
) -> Section | None:
    if value is None:
        if table.default == "none":
            return None
        if table.default == "required":
            problems.append((key, _missing_table(table.kind, key)))
            return None
    inner = dict(named_rows(value)) or ({} if value is None else value)
    if isinstance(inner, Mapping):
        return read_table(table.kind, inner, key, chosen, problems)
    name = key.rpartition(".")[2]
    what = f"{name} = {written(inner)}"
    problems.append((key, Problem(what, "", f"{name} is a table", f"Write [{key}]")))
    return None


def _unexpected_keys(
    cls: type[Section], data: ByName, options: ByName, path: str
) -> Iterator[tuple[str, Problem]]:
    """Report keys that neither this table nor its model has."""
    unexpected = list(islice((name for name in data if name not in options), _MAX_UNKNOWN))
    of_models = cls.section_keys().owners if unexpected else {}
    for name in unexpected:
        key, option = (f"{path}.{name}" if path else name), cls.spec(name)
        if option is not None and name in of_models:
            # Options of another model are reported by the cross checks.
            try:
                read_value(option, name, data[name])
            except FaultError as fault:
                yield key, fault.problem
        else:
            yield key, unknown_key(tuple(key.split(".")), data[name], cls, [*options, *of_models])


def _missing(option: Option, name: str, path: str) -> Problem:
    example = option.example or '"..."'
    place = f" to [{path}]" if path else ""
    why = f"{option.meaning}: no default exists" if option.meaning else ""
    return Problem(f"{name} is missing", "", why, f"Add for example {name} = {example}{place}")


def _missing_table(kind: type[Section], path: str) -> Problem:
    needed = kind.needed or [
        name
        for name, field in kind.fields.items()
        if (field.required if isinstance(field, Option) else field.default == "required")
    ]
    remedy = f"Add it with {', '.join(needed)}" if needed else "Add it"
    what = f"the table [{path}] is missing"
    return Problem(what, why="The case cannot be computed without it", remedy=remedy)


def _tables_with(name: str, path: tuple[str, ...] = ()) -> list[str]:
    """List the tables that have a key called ``name``."""
    section = section_at(path)
    tables = []
    for key, field in section.section_keys().keys.items() if section else ():
        if isinstance(field, Table):
            tables += _tables_with(name, (*path, key))
        elif key == name:
            tables.append(f"[{'.'.join(path)}]")
    return tables


def _intended_key(name: str, keys: ByName) -> str:
    """Guess the key intended by a misspelt one; empty if there is no close match."""
    if term := find_term(name):
        return term.key if term.key in keys else ""
    for gear in GEARS:
        base_name = name.removesuffix(f"_{gear}").removeprefix(f"{gear}_")
        if base_name != name and base_name in keys:
            return base_name
    return next(iter(difflib.get_close_matches(name, list(keys), n=1, cutoff=0.6)), "")


def correct_keys(
    data: ByName, root: type[Section], path: tuple[str, ...] = ()
) -> tuple[Tree, KeyedProblems, dict[str, str]]:
    """Tables without misspelt keys, the problems, and the typed key of each corrected key."""
    section = section_at(path, root)
    keys = {**section.keys_for(data), **section.section_keys().keys} if section else {}
    result: Tree = {}
    problems: KeyedProblems = []
    typed_keys: dict[str, str] = {}
    # Keys of a case from Python may be of any type.
    for name, value in ((str(key), value) for key, value in data.items()):
        misspelt = section is not None and name not in keys and (path or name != "assumed")
        intended = _intended_key(name, keys) if misspelt else ""
        inner, table = keys.get(intended or name), isinstance(value, Mapping)
        # A correctly spelt key takes precedence over a misspelt one; tables are merged.
        if (intended in data or intended in result) and not (table and isinstance(inner, Table)):
            intended = ""
        if intended:
            typed, right = (".".join((*path, key)) for key in (name, intended))
            problems.append((typed, unknown_key((*path, name), value, section, [*keys])))
            both = data.get(intended) if table else None  # given, rightly and misspelt
            inside = [f".{n}" for n in value if n not in both] if both else [""]
            typed_keys |= {right + each: typed + each for each in inside}
        key = intended or name
        if table and isinstance(inner, Table):
            value, inner_problems, inner_typed = correct_keys(value, root, (*path, key))
            problems, typed_keys = [*problems, *inner_problems], typed_keys | inner_typed
            value = {**value, **result.get(key, {})} if key in result else value
        result[key] = value
    return result, problems, typed_keys


def with_typed_keys(
    problems: KeyedProblems, typed_keys: Mapping[str, str]
) -> Iterator[tuple[str, Problem]]:
    """Yield problems under the keys as typed, without those of keys reported as misspelt."""
    for key, problem in problems:
        if key not in typed_keys:
            corrected = next(
                (corrected for corrected in typed_keys if key.startswith(f"{corrected}.")), ""
            )
            yield typed_keys.get(corrected, "") + key[len(corrected) :], problem


def unknown_key(
    path: tuple[str, ...],
    value: object,
    section: type[Section] | None = None,
    keys: Sequence[str] = (),
) -> Problem:
    """Return the problem of an unknown key, with the closest key or the table that has it."""
    *table, name = path
    section = section or section_at(tuple(table))
    keys = list(dict.fromkeys(keys or (section.section_keys().keys if section else ())))
    keys += [] if table else ["assumed"]
    entry = f"{name} = {written(value)}" if not isinstance(value, Mapping) else f"table [{name}]"
    location = f"[{'.'.join(table)}]" if table else "The top of the file"
    why = f"{location} has: {closest(name, keys)}"
    what = f"{entry}: unknown key"
    if term := find_term(name):
        return Problem(what, "", term.meaning, f"Write {term.key}" if term.key else "Remove it")
    if remedy := _gear_key_remedy(name, section):
        return Problem(what, "", why, remedy)
    for key, option in section.specs() if section else ():
        # A row of a list has it, as sections of a shaft have their length and diameter.
        parts = re.findall(r"\w+", option.meaning) if option.example.startswith("[[") else ()
        if set(name.split("_")) <= set(parts):
            return Problem(what, "", why, f"Write it in {key}, such as {key} = {option.example}")
    if longer := [key for key in keys if key.endswith(f"_{name}")]:
        return Problem(what, "", why, f"Did you mean {' or '.join(longer)}?")
    if not isinstance(value, Mapping) and (tables := _tables_with(name)):
        inner_tables = [label for label in tables if label.startswith(f"{location[:-1]}.")]
        return Problem(what, "", why, f"It belongs to {' or '.join(inner_tables or tables)}")
    return Problem(what, "", why, did_you_mean(name, keys, "Remove it"))


def _gear_key_remedy(name: str, section: type[Section] | None) -> str:
    """Return the remedy for a key that contains the name of a gear, or an empty text."""
    for gear in GEARS:
        base_name = name.removesuffix(f"_{gear}").removeprefix(f"{gear}_")
        spec = section.spec(base_name) if section and base_name != name else None
        if spec is not None and spec.pair:
            example = f"{base_name} = [{spec.example}, {spec.example}]"
            return f"Give the values of both gears in one list: {example}"
        if base_name != name and f"[gears.{gear}]" in _tables_with(base_name):
            return f"It is {base_name} in [gears.{gear}]"
    return ""
