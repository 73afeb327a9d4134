"""How tables and values of the case file are read: checked, and in SI."""

from __future__ import annotations

import difflib
import math
import numbers as numeric
import operator
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from tribodyn import units
from tribodyn.errors import Problem, shortened
from tribodyn.model import REQUIRED, Option
from tribodyn.study.case.section import Choice, Section, Table, section_at


class Word(NamedTuple):
    """What is said of a word."""

    meaning: str
    key: str = ""  #: last part of the key, or the quantity, that is meant
    page: str = ""  #: where the documentation says more


@lru_cache(maxsize=1)
def _words() -> dict[str, Word]:
    import tomllib

    text = files("tribodyn.study.case").joinpath("texts", "words.toml").read_text(encoding="utf-8")
    entries = tomllib.loads(text).values()
    return {
        word: Word(**{k: v for k, v in entry.items() if k != "words"})
        for entry in entries
        for word in entry["words"]
    }


def word(text: str) -> Word | None:
    """What is said of a word, whatever its case and its underscores; None if nothing is."""
    lowered = text.strip().lower()
    return _words().get(lowered) or _words().get(lowered.replace("_", " ").replace("-", " "))


def listed() -> list[str]:
    """All words."""
    return list(_words())


Chosen = Mapping[str, Choice]
Found = list[tuple[str, Problem]]
Kind = TypeVar("Kind", bound=Section)

#: Items of a list that a message repeats, and unknown keys that are told.
_SHOWN, _TOLD = 20, 50
#: Beyond this a whole number is a slip of the keyboard.
_LARGEST = 10**18


@dataclass(frozen=True)
class Plain:
    """A value given in Python: a bare number is SI, while in text it would lack its unit."""

    value: Any


class FaultError(Exception):
    """What is wrong with one value; its place is not known yet."""

    def __init__(self, what: str, why: str = "", remedy: str = "") -> None:
        super().__init__(what)
        self.problem = Problem(what, "", why, remedy)


def written(value: Any, depth: int = 5) -> str:
    """Show a value as TOML would have it, as much of it as a message takes."""
    if isinstance(value, Plain):
        value = value.value
    if isinstance(value, str):
        return f'"{shortened(value, 195)}"'
    if isinstance(value, Mapping | list | tuple) and not depth:
        return "..."
    if isinstance(value, Mapping):
        items = islice(value.items(), _SHOWN)
        text = ", ".join(f"{key} = {written(item, depth - 1)}" for key, item in items)
        return shortened(f"{{{text}}}")
    if isinstance(value, list | tuple):
        shown = [written(item, depth - 1) for item in value[:_SHOWN]]
        return shortened(f"[{', '.join(shown)}{', ...' if len(value) > _SHOWN else ''}]")
    if isinstance(value, int) and abs(value) > _LARGEST:
        return f"a whole number of about {int(0.30103 * value.bit_length()) + 1} digits"
    return str(value).lower() if isinstance(value, bool) else shortened(str(value))


def _grouped(spec: Option, name: str, value: str) -> FaultError | None:
    """Say how numbers are written, where one has a comma or separated thousands."""
    meant = units.readings(value)
    if not meant:
        return None
    shown = [f"{name} = {text}" if not spec.unit else f'{name} = "{text}"' for text in meant]
    why = units.NUMBERS[0].upper() + units.NUMBERS[1:]
    return FaultError(f"{name} = {written(value)}", why, f"Write {' or '.join(shown)}")


#: A plain decimal number.
_PLAIN = r"\d{1,9}(?:\.\d{0,9})?"


def _misread(spec: Option, name: str, value: str, told: str) -> FaultError:
    """Say why text is no quantity of the field, and what to write."""
    reason, lacks_unit, _ = told.partition("; write for example")
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


def _real(spec: Option, name: str, value: Any, as_text: bool) -> float:
    """Turn text, a pint quantity or a number into an SI float."""
    shown = f"{name} = {written(value)}"
    if hasattr(value, "magnitude") and hasattr(value, "to"):
        try:
            return float(value.to(spec.unit or "dimensionless").magnitude)
        except Exception as error:
            raise FaultError(
                shown, f"{name} is a quantity in {spec.unit or '1'}", str(error)
            ) from None
    if isinstance(value, str):
        if grouped := _grouped(spec, name, value):
            raise grouped
        if not spec.unit:
            share = re.fullmatch(rf"\s*({_PLAIN})\s*%\s*", value)
            remedy = "Write it without quotes"
            if share:
                remedy = f"Write {name} = {float(share[1]) / 100.0:g}"
            raise FaultError(shown, f"{name} is a pure number, not text", remedy)
        try:
            return units.parse(value, spec.unit)
        except units.UnitProblemError as error:
            raise _misread(spec, name, value, str(error)) from None
    if isinstance(value, bool) or not isinstance(value, numeric.Real):
        kind = "a number with a unit" if spec.unit else "a number"
        raise FaultError(shown, f"{name} must be {kind}", f"Write for example {spec.example}")
    if spec.unit and as_text:
        remedy = f'Write for example {name} = "{value} {spec.display_unit}"'
        raise FaultError(shown, f"{name} has a dimension and needs a unit, as text", remedy)
    try:
        return float(value)
    except OverflowError:
        raise FaultError(shown, f"{name} is too large", "Correct the value") from None


def _in_range(spec: Option, name: str, value: float, typed: Any) -> None:
    """Refuse what is not finite or outside the limits of the field."""
    outside = not (spec.low <= value <= spec.high) or (spec.positive and value == spec.low)
    if not outside and math.isfinite(value):
        return
    shown = f"{name} = {written(typed)}"
    if spec.unit and math.isfinite(value) and abs(value) < 1e300:
        display = spec.show(value)
        shown += "" if display == str(typed) else f" ({display})"
    why = f"Allowed: {spec.allowed()} ({spec.origin})" if spec.origin else spec.allowed()
    remedy = "Correct the value or its unit" if spec.unit else "Correct the value"
    if value < 0.0 <= spec.low <= -value <= spec.high:
        remedy = f"{remedy}; without its sign it is in the range"
    raise FaultError(shown, why, remedy)


def _whole(spec: Option, name: str, value: Any) -> int:
    try:
        if isinstance(value, bool):
            raise TypeError
        whole = operator.index(value)
    except TypeError:
        meant = re.fullmatch(r"(\d{1,9})(\.0*)?", str(value).strip())
        remedy = f"Write {name} = {int(meant[1])}" if meant else ""
        remedy = remedy or f"Write for example {name} = {spec.example}"
        raise FaultError(
            f"{name} = {written(value)}", f"{name} must be a whole number", remedy
        ) from None
    _in_range(spec, name, whole, value)
    return whole


def _name(spec: Option, name: str, value: Any) -> str:
    known = spec.names() if spec.names else []
    if isinstance(value, str) and value in known:
        return value
    shown, why = f"{name} = {written(value)}", f"Allowed: {', '.join(known)}"
    near = difflib.get_close_matches(str(value), known, n=1)
    said = None if near else word(str(value))
    if said is not None:
        raise FaultError(shown, said.meaning, f"Allowed: {', '.join(known)}")
    raise FaultError(shown, why, f'Did you mean "{near[0]}"?' if near else "Choose one of these")


def read_value(spec: Option, name: str, value: Any) -> Any:
    """Check one value and return it in SI."""
    as_text = not isinstance(value, Plain)
    if isinstance(value, Plain):
        value = value.value
    if spec.pair and isinstance(value, list | tuple):
        return _both_gears(spec, name, value, as_text)
    if spec.kind == "number":
        result = _real(spec, name, value, as_text)
        _in_range(spec, name, result, value)
        return result
    if spec.kind == "integer":
        return _whole(spec, name, value)
    if spec.kind == "choice":
        return _name(spec, name, value)
    if spec.kind == "numbers":
        return _list(spec, name, value, as_text)
    wanted = bool if spec.kind == "flag" else str
    if not isinstance(value, wanted):
        remedy = "Write true or false" if wanted is bool else "Write it in quotes"
        raise FaultError(f"{name} = {written(value)}", f"{name} must be {spec.allowed()}", remedy)
    return str(Path(str(value)).absolute()) if spec.kind == "file" else value


def _list(spec: Option, name: str, value: Any, as_text: bool) -> tuple[float, ...]:
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        remedy = f"Write for example {name} = [{spec.example}]"
        raise FaultError(f"{name} = {written(value)}", f"{name} must be a list", remedy)
    result = []
    for position, item in enumerate(value):
        label = f"{name}[{position}]"
        result.append(_real(spec, label, item, as_text))
        _in_range(spec, label, result[-1], item)
    return tuple(result)


def _both_gears(spec: Option, name: str, value: Any, as_text: bool) -> tuple[float, ...]:
    if len(value) != 2:
        remedy = f"Write one value for both gears, or {name} = [{spec.example}, {spec.example}]"
        raise FaultError(f"{name} = {written(value)}", "A list has pinion and wheel", remedy)
    return _list(spec, name, value, as_text)


def read_table(
    cls: type[Kind], data: Mapping[str, Any], path: str, chosen: Chosen, found: Found
) -> Kind:
    """Read a table under the models that are named; what is wrong with it is added to ``found``."""
    section = cls.__new__(cls)
    vars(section).update(read_fields(cls, data, path, chosen, found))
    return section


def read_fields(
    cls: type[Section], data: Mapping[str, Any], path: str, chosen: Chosen, found: Found
) -> dict[str, Any]:
    """Values of the keys of a table, in the order of their declaration."""
    values: dict[str, Any] = {}
    model = chosen[path].model if path in chosen else None
    # The options of a model go before keys of the same name.
    options = {**cls.fields, **model.case_options} if model else cls.fields
    for name, field in options.items():
        key = f"{path}.{name}" if path else name
        if isinstance(field, Table):
            values[name] = _inner(field, data, key, chosen, found)
        elif model and name == cls.selector:
            values[name] = model.name
        elif name in data:
            try:
                values[name] = read_value(field, name, data[name])
            except FaultError as fault:
                found.append((key, fault.problem))
        elif name in cls.fields:
            values[name] = field.default
            if values[name] is REQUIRED:
                values[name] = None
                found.append((key, _missing(field, name, path)))
        else:
            values[name] = None
    if not options.keys() >= data.keys():
        found += _foreign(cls, data, options, path)
    return values


def _inner(
    table: Table, data: Mapping[str, Any], key: str, chosen: Chosen, found: Found
) -> Section | None:
    name = key.rpartition(".")[2]
    if name not in data:
        if table.default == "none":
            return None
        if table.default == "required":
            found.append((key, _missing_table(table.kind, key)))
            return None
    inner = data.get(name, {})
    if isinstance(inner, Mapping):
        return read_table(table.kind, inner, key, chosen, found)
    what = f"{name} = {written(inner)}"
    found.append((key, Problem(what, "", f"{name} is a table", f"Write [{key}]")))
    return None


def _foreign(
    cls: type[Section], data: Mapping[str, Any], options: Mapping[str, Any], path: str
) -> Iterator[tuple[str, Problem]]:
    """Faults of keys that are not those of this table under its model."""
    strange = list(islice((name for name in data if name not in options), _TOLD))
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
    needed = kind.needed or [
        name
        for name, field in kind.fields.items()
        if (field.required if isinstance(field, Option) else field.default == "required")
    ]
    remedy = f"Add it with {', '.join(needed)}" if needed else "Add it"
    what = f"the table [{path}] is missing"
    return Problem(what, why="The case cannot be computed without it", remedy=remedy)


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


def _meant(name: str, section: type[Section]) -> str:
    """Key of a table that an unknown one stands for; empty where nobody can tell."""
    known = section.known().keys
    if said := word(name):
        return said.key if said.key in known else ""
    for gear in ("pinion", "wheel"):
        inner = name.removesuffix(f"_{gear}").removeprefix(f"{gear}_")
        if inner != name and inner in known:
            return inner
    return next(iter(difflib.get_close_matches(name, list(known), n=1, cutoff=0.6)), "")


def as_meant(
    data: Mapping[str, Any], path: tuple[str, ...] = ()
) -> tuple[dict[str, Any], Found, dict[str, str]]:
    """Tell unknown keys and put them where they belong, so that nothing seems to be missing.

    The third has them by where they belong: what is wrong there has been told.
    """
    section = section_at(path)
    known = section.known().keys if section else {}
    result: dict[str, Any] = {}
    found: Found = []
    places: dict[str, str] = {}
    # Keys of a case that is written in Python may be anything.
    for name, value in ((str(key), value) for key, value in data.items()):
        strange = section is not None and name not in known and (path or name != "assumed")
        meant = _meant(name, section) if strange and section else ""
        inner, table = known.get(meant or name), isinstance(value, Mapping)
        # A value that is there goes before one that is taken for it; tables are put together.
        if (meant in data or meant in result) and not (table and isinstance(inner, Table)):
            meant = ""
        if meant:
            found.append((".".join((*path, name)), unknown((*path, name), value)))
            places[".".join((*path, meant))] = found[-1][0]
        key = meant or name
        if table and isinstance(inner, Table):
            value, more, others = as_meant(value, (*path, key))
            found, places = [*found, *more], places | others
            value = {**value, **result.get(key, {})} if key in result else value
        result[key] = value
    return result, found, places


def as_typed(found: Found, meant: Mapping[str, str]) -> Iterator[tuple[str, Problem]]:
    """Faults with the keys that the user typed, without those of values told as misspelt."""
    for key, problem in found:
        if key not in meant:
            place = next((place for place in meant if key.startswith(f"{place}.")), "")
            yield meant.get(place, "") + key[len(place) :], problem


def unknown(path: tuple[str, ...], value: Any) -> Problem:
    """Say that there is no such key, naming the nearest or the table that has it."""
    *table, name = path
    section = section_at(tuple(table))
    known = list(section.known().keys) if section else []
    known += [] if table else ["assumed"]
    shown = f"{name} = {written(value)}" if not isinstance(value, Mapping) else f"table [{name}]"
    place = f"[{'.'.join(table)}]" if table else "the top of the file"
    why = f"{place} has: {', '.join(known)}"
    told = f"{shown}: unknown key"
    if said := word(name):
        return Problem(told, "", said.meaning, f"Write {said.key}" if said.key else "Remove it")
    if remedy := _of_one_gear(name, section):
        return Problem(told, "", why, remedy)
    if homes := _homes(name):
        inside = [home for home in homes if home.startswith(f"{place[:-1]}.")]
        return Problem(told, "", why, f"It belongs to {' or '.join(inside or homes)}")
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.6)
    return Problem(told, "", why, f'Did you mean "{near[0]}"?' if near else "Remove it")


def _of_one_gear(name: str, section: type[Section] | None) -> str:
    """What to write for a key that has the name of a gear in it."""
    for gear in ("pinion", "wheel"):
        inner = name.removesuffix(f"_{gear}").removeprefix(f"{gear}_")
        spec = section.spec(inner) if section and inner != name else None
        if spec is not None and spec.pair:
            example = f"{inner} = [{spec.example}, {spec.example}]"
            return f"Give that of pinion and wheel in one list: {example}"
        if inner != name and f"[gears.{gear}]" in _homes(inner):
            return f"It is {inner} in [gears.{gear}]"
    return ""
