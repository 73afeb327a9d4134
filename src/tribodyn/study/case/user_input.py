"""User input by dotted keys, before defaults: values, file and line, spreads and changes.

A value with a spread is written as ``"0.05 +- 0.83 %"``.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice
from typing import Any, NamedTuple, cast

import numpy as np

from tribodyn.errors import InputError, Problem, no_such
from tribodyn.model import NO_OPTIONS, Option
from tribodyn.nomenclature import QUANTITIES
from tribodyn.study.case.section import (
    NamedTables,
    Rows,
    Section,
    Table,
    entries,
    keyed_rows,
    listed_rows,
    named_rows,
    option_at,
    section_at,
    table_in,
)
from tribodyn.study.case.values import FaultError, Plain, read_value, unmarked, written
from tribodyn.types import ByName, Tree
from tribodyn.uncertainty import distribution
from tribodyn.units import UnitProblemError, convert, split

#: Keys of a case, tables inside each other, and characters of one text, at most.
_MAX_KEYS, _MAX_DEPTH, _MAX_TEXT = 3000, 12, 10_000
_CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff]")
#: Patterns of values with a spread, and keys of free text that are not searched for it.
_SPREAD, _RANGE = re.compile(r"\s*(?:\+-|\+/-|±)"), re.compile(r"\s\.\.\s")
_KIND = re.compile(r"^\s*(?:normal|lognormal|uniform)\s+", re.IGNORECASE)
_TEXT_KEYS = ("title", "origin", "assumed", "based_on")
#: Share of the values of an unbounded distribution that may lie beyond the range of its key.
_TAIL = 1e-6
#: Types of list items that are checked in turn.
_NESTED = (Mapping, list, tuple, str, Plain)


def unsound(data: ByName) -> Iterator[tuple[str, Problem]]:
    """Report values that no key accepts, such as control characters, before reading the case."""
    pending: list[tuple[str, Any, int]] = [("", data, 0)]
    for number, (key, value, depth) in enumerate(pending):
        value = value.value if isinstance(value, Plain) else value
        if number == _MAX_KEYS:
            remedy = "This is not a case file"
            yield "", Problem(f"there are more than {_MAX_KEYS} keys", "", "", remedy)
            return
        problem = _unsound(key, value, depth)
        if problem is not None:
            yield ".".join(key.split(".")[:_MAX_DEPTH]), problem
        elif isinstance(value, Mapping):
            prefix = f"{key}." if key else ""
            pending += [(f"{prefix}{name}", item, depth + 1) for name, item in value.items()]
        elif isinstance(value, list | tuple):
            inner = (item for item in value if isinstance(item, _NESTED))
            pending += [(key, item, depth + 1) for item in islice(inner, _MAX_KEYS)]


def _unsound(key: str, value: object, depth: int) -> Problem | None:
    name = key.rpartition(".")[2]
    control = _CONTROL.search(f"{name}{value}" if isinstance(value, str) else name)
    if control is not None:
        what = f"{name} holds the character U+{ord(control[0]):04X}"
        return Problem(what, "", "Control characters are not allowed", "Remove it")
    if depth > _MAX_DEPTH:
        return Problem("tables or lists are nested too deeply", "", "", "This is not a case file")
    if isinstance(value, str) and len(value) > _MAX_TEXT:
        why = f"A text has at most {_MAX_TEXT} characters"
        return Problem(f"{name} has {len(value)} characters", "", why, "Shorten it")
    if isinstance(value, int) and abs(value) > 10**18:
        return Problem(f"{name} = {written(value)}", "", "It is too large", "Correct the value")
    return None


def plain(data: object) -> Any:
    """Mark numbers of tables from Python, where a bare one is SI; lists of numbers as a whole."""
    if isinstance(data, Mapping):
        return {str(key): plain(value) for key, value in data.items()}
    if isinstance(data, list | tuple) and any(isinstance(each, _NESTED) for each in data):
        return [plain(item) for item in data]
    return data if isinstance(data, str | bool | Plain) else Plain(data)


def si_value(option: Option, name: str, value: object) -> Any:
    """Value in SI as it is read, the numbers of a list of parts too."""
    if option.kind != "list" or not option.unit:
        return unmarked(read_value(option, name, value))
    value = value.value if isinstance(value, Plain) else value
    if isinstance(value, list | tuple | np.ndarray):
        return tuple(si_value(option, name, item) for item in value)
    return read_value(replace(option, kind="number"), name, Plain(value))


def values_in_si(root: type[Section], data: Tree) -> Tree:
    """Values of tables in SI by dotted key, without files; a wrong one as typed."""
    values = {}
    for table, name, place in entries(data):
        option = option_at(root, data, place)
        if place[0] == "assumed" or (option is not None and option.kind == "file"):
            continue
        value = unmarked(table[name])
        with suppress(FaultError):
            value = value if option is None else si_value(option, name, table[name])
        values[".".join(place)] = value
    return values


class UserInput(Tree):
    """User input by dotted keys: values as typed, and tables; ``data`` is the nested form."""

    def __init__(self, data: ByName) -> None:
        super().__init__()
        self.data = data
        self.typed: tuple[str, ...] = ()  #: keys of values, without those of tables
        pending = [("", data)]
        for prefix, table in pending:
            for name, value in table.items():
                key = f"{prefix}{name}"
                if isinstance(value, Mapping):
                    pending.append((f"{key}.", value))
                elif rows := named_rows(value):
                    self[key] = value
                    pending += [(f"{key}.{row}.", body) for row, body in rows]
                    continue
                else:
                    self.typed += (key,)
                    value = value.value if isinstance(value, Plain) else value
                self[key] = value

    def __reduce__(self) -> Any:
        """Copy and pickle by the nested data."""
        return type(self), (self.data,)

    def show(self, key: str) -> str:
        """Write ``key = value`` as the user typed it."""
        return f"{key.rpartition('.')[2]} = {written(self.get(key))}"

    def with_numbers(self, numbers: Mapping[str, float]) -> UserInput:
        """Return a copy with some values replaced by SI numbers from Python."""
        copy = UserInput({})
        copy.update(self)
        copy.data, copy.typed = dict(self.data), self.typed
        for key, number in numbers.items():
            table, _, name = key.partition(".")
            copy[table] = {**copy[table], name: Plain(number)}
            copy.data[table] = copy[table]
            copy[key] = number
        return copy


#: Reason for excluding one of two alternative keys.
CONFLICT_REASON = "Both define the same quantity"


def conflicting_keys(inputs: UserInput, first: str, second: str) -> tuple[str, Problem]:
    """Return the problem of two keys that exclude each other, with the first key."""
    what = f"{inputs.show(first)} and {inputs.show(second)} are both given"
    return first, Problem(what, "", CONFLICT_REASON, "Keep one of them")


@dataclass(frozen=True)
class Note:
    """What a file has for a key besides its value in SI."""

    above: str  #: comments and empty lines before it, and what its line begins with
    behind: str = ""  #: comment behind it, with the space before
    value: str = ""  #: equals sign and value as typed; empty for the head of a table
    dotted: bool = False  #: whether it is a table without a head, of dotted keys


@dataclass(frozen=True)
class Source:
    """Origin of the keys of a case."""

    name: str = ""  #: file name as supplied by the user
    find: Callable[[], Mapping[str, list[int]]] = (
        dict  #: finds the lines of the keys; called on demand
    )
    replaced: Mapping[str, str] = field(default_factory=dict)
    notes: Callable[[], Mapping[str, Note]] = field(default=dict, kw_only=True)

    @cached_property
    def lines(self) -> Mapping[str, list[int]]:
        """Line numbers of each key."""
        return self.find()

    @cached_property
    def comments(self) -> Mapping[str, Note]:
        """What the file has for each key."""
        return self.notes()

    def key(self, key: str) -> str:
        """Key of the file for a key of the case."""
        return key

    def named(self, text: str) -> str:
        """Text about the gears of a case with their names."""
        return text

    def line(self, key: str) -> int:
        """Return the line of a key, or of its first inner key or enclosing table; zero if none."""
        while key and key not in self.lines:
            inside = [at[0] for other, at in self.lines.items() if other.startswith(f"{key}.")]
            if inside:
                return min(inside)
            key = key.rpartition(".")[0]
        return self.lines[key][0] if key else 0

    def where(self, key: str) -> str:
        """Format the location ``file:line: key``, without the parts that are unknown."""
        parts = key.split(".")
        tables = (".".join(parts[:end]) for end in range(len(parts), 0, -1))
        if by := next((self.replaced[each] for each in tables if each in self.replaced), ""):
            return f"{by} {key}"
        if not self.name:
            return key
        line = self.line(key)
        return f"{self.name}:{line}: {key}" if line else f"{self.name}: {key}".removesuffix(": ")

    def place(self, problems: Iterable[tuple[str, Problem]]) -> list[Problem]:
        """Set the location of each problem and sort the problems by line."""
        ordered = sorted(problems, key=lambda pair: self.line(pair[0]))
        return [replace(problem, where=self.where(key)) for key, problem in ordered]

    def with_replaced(self, keys: Iterable[str], by: str) -> Source:
        """Return the same source with some keys replaced."""
        return replace(self, replaced={**self.replaced, **dict.fromkeys(keys, by)})


def without_spread(
    data: ByName, prefix: str = ""
) -> tuple[Tree, dict[str, str], list[tuple[str, Problem]]]:
    """Return tables with central values, the spreads by key (of lists by number), and problems."""
    middles: Tree = {}
    spreads: dict[str, str] = {}
    faults: list[tuple[str, Problem]] = []
    for name, value in data.items():
        key, text = f"{prefix}{name}", value.value if isinstance(value, Plain) else value
        middles[name] = value
        if key in _TEXT_KEYS:
            continue
        numbered = isinstance(value, list | tuple) and any(map(_has_spread, value))
        items = {str(place): each for place, each in enumerate(value, 1)} if numbered else {}
        rows = dict(listed := named_rows(value))
        if len(rows) < len(listed):
            continue  # rows with one name are refused
        if inner := value if isinstance(value, Mapping) else rows or items:
            values, inside, wrong = without_spread(inner, f"{key}.")
            middles[name] = values if isinstance(value, Mapping) else list(values.values())
            spreads |= inside
            faults += wrong
        elif _has_spread(text):
            try:
                middles[name], spreads[key] = _middle(key, text), text
            except InputError as error:
                faults.append((key, error.problems[0]))
    return middles, spreads, faults


def _has_spread(text: object) -> bool:
    """Whether a value is a text with a spread."""
    return isinstance(text, str) and bool(_SPREAD.search(text) or _RANGE.search(text))


def _middle(key: str, text: str) -> str | float:
    """Return the central value of a spread as text with unit, or as float if dimensionless."""
    spread = _SPREAD.search(text)
    first = _KIND.sub("", text[: (spread or _RANGE.search(text) or spread).start()])  # type: ignore[union-attr]
    quantity = QUANTITIES.get(key.rpartition(".")[2])
    try:  # the typed unit where the nomenclature has none
        unit = quantity.unit if quantity else split(first)[1]
    except UnitProblemError as error:
        raise InputError(str(error)) from None
    values = distribution(key, text, unit)
    middle = first if spread else f"{float(values.ppf(0.5))!r} {unit}".strip()
    return middle if unit else float(middle)


def spread_problem(spec: Option, key: str, text: object) -> Problem | None:
    """Check the values of a spread quantity against the range of its key; None if all fit."""
    if spec.kind not in ("number", "integer"):
        return None
    try:
        low, high = _reach(distribution(key, text, spec.unit))
    except InputError as error:
        return replace(error.problems[0], where="")
    if _within(spec, low, high):
        return None
    name = key.rpartition(".")[2]
    ends = f"{_short(spec, low)} to {_short(spec, high)}"
    what = f"{name} = {written(text)} has values from {ends}"
    why = f"Allowed: {spec.allowed()}" + (f" ({spec.origin})" if spec.origin else "")
    return Problem(what, "", why, _narrower(spec, key, text))


def _reach(values: Any) -> tuple[float, float]:
    """Return the bounds of a distribution; tail quantiles where it is unbounded."""
    ends = float(values.ppf(0.0)), float(values.ppf(1.0))
    if all(map(math.isfinite, ends)):
        return ends
    return float(values.ppf(_TAIL)), float(values.ppf(1.0 - _TAIL))


def _within(spec: Option, low: float, high: float) -> bool:
    return spec.low <= low and high <= spec.high and not (spec.positive and low == spec.low)


def _short(spec: Option, value: float) -> str:
    """Write a value with four significant digits in the display unit."""
    if not spec.unit:
        return f"{value:.4g}"
    return f"{convert(value, spec.unit, spec.display_unit):.4g} {spec.display_unit}"


def _narrower(spec: Option, key: str, text: Any) -> str:
    """Return the remedy for a spread out of range: the largest valid standard deviation."""
    match = _SPREAD.search(text) if isinstance(text, str) else None
    if match is None:
        return "Correct the ends of the range, or their unit"
    kind = _KIND.match(text)
    if kind is not None and kind[0].strip().lower() == "lognormal":
        return "Write a smaller standard deviation"
    values = distribution(key, text, spec.unit)
    mean, reach = float(values.ppf(0.5)), 0.5 * (_reach(values)[1] - _reach(values)[0])
    deviation = float(values.std()) if kind else reach / 3.0
    largest = deviation * min(mean - spec.low, spec.high - mean) / reach
    middle = _KIND.sub("", text).strip()
    cut = "" if kind else ": it is cut at three of them"
    remedy = f"Write a standard deviation of at most {_deviation(spec, text, largest, mean)}{cut}"
    positive = f"lognormal {middle}"
    if mean > 0.0 <= spec.low and _within(spec, *_reach(distribution(key, positive, spec.unit))):
        remedy += f', or "{positive}", whose values are all positive'
    return remedy


def _deviation(spec: Option, text: str, value: float, mean: float) -> str:
    """Standard deviation, rounded down to three digits: in percent where the user wrote that."""
    unit = spec.display_unit
    if text.rstrip().endswith("%"):
        value, unit = 100.0 * value / abs(mean), "%"
    elif spec.unit == "K":
        unit = "K"
    elif spec.unit:
        value = convert(value, spec.unit, unit)
    step = 10.0 ** (math.floor(math.log10(value)) - 2) if value > 0.0 else 1.0
    return f"{math.floor(value / step) * step:.3g} {unit}".strip()


class Stated(NamedTuple):
    """Values in SI by dotted key that reasons and the origin of the case refer to."""

    #: Values that the reasons in ``[assumed]`` refer to.
    marks: Tree
    #: Initial values of the case, and the origin that documents them.
    base: Tree


#: Keys other than model names whose choice decides which keys of their table are allowed.
_DECIDES = ("solver.method",)


def changed_tables(
    root: type[Section],
    data: ByName,
    changes: ByName,
    spread: Mapping[str, str] = NO_OPTIONS,
    by: str = "",
) -> Tree:
    """Tables with values changed by dotted key; without ``by`` the values are those of Python."""
    changes = changes if by else plain(changes)
    if problems := list(_missing_parts(root, data, changes)):
        by = by or "replace:"
        raise InputError([replace(p, where=f"{by} {p.where}") for p in problems])
    dropped = _dropped_options(root, UserInput(data), changes)
    spread_values = {key: text for key, text in spread.items() if key not in dropped}
    tables = with_values(data, {**spread_values, **dict.fromkeys(dropped), **changes})
    if isinstance(marks := tables.get("assumed"), Mapping):
        stale = {*changes, *dropped}
        tables["assumed"] = {key: why for key, why in marks.items() if key not in stale}
    return tables


def with_values(data: ByName, values: ByName) -> Tree:
    """Return a copy of tables with dotted keys set, of lists and their rows too; None removes."""
    result = cast(Tree, keyed_rows(data))
    for key, value in values.items():
        *tables, name = key.split(".")
        table: Tree = result
        for depth, each in enumerate(tables, 1):
            inner = table.setdefault(_row(table, each, key), {})
            if depth == len(tables) and name.isdigit() and _is_list(inner, table):
                table[each] = _with_element(inner, table, key, value)
                break
            if not isinstance(inner, dict):
                raise InputError(f"{each} is a value, not a table", key, "", "Correct the key")
            table = inner
        else:
            if unmarked(value) is None:
                table.pop(_row(table, name, key), None)
            else:
                table[_row(table, name, key)] = value
    return cast(Tree, listed_rows(result))


def _row(table: Tree, name: str, key: str) -> str:
    """Name of a part of a table; of a row that has a name its number is taken too."""
    if not isinstance(table, Rows) or name in table:
        return name
    if name.isdigit() and 1 <= int(name) <= len(table):
        return list(table)[int(name) - 1]
    raise InputError(no_such("value", key, table, key, "Correct the name or number"))


def _is_list(value: object, table: ByName) -> bool:
    """Whether a value is a list of values, or the list of the planets that is not given."""
    value = value.value if isinstance(value, Plain) else value
    return isinstance(value, list | tuple) or (value == {} and "count" in table)


def _with_element(value: Any, table: Tree, key: str, item: Any) -> list[Any]:
    """List with a value changed; of planets one that is missing has zeros."""
    *_, name, number = key.split(".")
    if value == {}:
        value = [Plain(0.0)] * int(unmarked(table["count"]))
    if isinstance(value, Plain):
        value = [Plain(each) for each in np.atleast_1d(value.value).tolist()]
    if not 1 <= int(number) <= len(value) or unmarked(item) is None:
        why = f"{name} has {len(value)} values, counted from 1"
        raise InputError(f'there is no value "{key}"', key, why, "Correct the number in the key")
    return [*value[: int(number) - 1], item, *value[int(number) :]]


def _missing_parts(root: type[Section], data: ByName, changes: ByName) -> Iterator[Problem]:
    """Report keys of parts that do not exist, and that the changes do not give as a whole."""
    for key in changes:
        group, name, inner = (*key.split(".", 2), "", "")[:3]
        section, parts = section_at((group,), root), table_in(data, group)
        if not inner or name in parts or not section or not issubclass(section, NamedTables):
            continue
        part = section.fields["NAME"]
        assert isinstance(part, Table)
        needed = [k for k, o in part.kind.fields.items() if isinstance(o, Option) and o.required]
        absent = [each for each in needed if f"{group}.{name}.{each}" not in changes]
        if absent or section.listed:
            remedy = "Correct the name"
            remedy += f", or give also {', '.join(absent)} of a new one" if absent else ""
            yield no_such(part.meaning.partition(" ")[2], name, parts, key, remedy)


def _dropped_options(root: type[Section], inputs: UserInput, changes: ByName) -> list[str]:
    """Return the options that newly chosen models, laws and methods do not have."""
    dropped = []
    for key, value in changes.items():
        table, _, name = key.rpartition(".")
        section = section_at(tuple(table.split(".")), root) if table else None
        if section is None or not (name == section.selector or key in _DECIDES):
            continue
        spec = section.fields[name]
        assert isinstance(spec, Option)
        chosen = spec.default if unmarked(value) is None else unmarked(value)
        if spec.names is None or chosen not in spec.names():
            continue  # it is reported where it is read
        typed = [each for each in inputs.typed if each.rpartition(".")[0] == table]
        dropped += [
            each
            for each in typed
            if each not in changes and each != key and not _accepts(section, inputs, chosen, each)
        ]
    return dropped


def _accepts(section: type[Section], inputs: UserInput, chosen: str, key: str) -> bool:
    """Whether a table with a newly chosen model or method has a key."""
    model, option = section.model_named(chosen), key.rpartition(".")[2]
    if model is None:  # a method
        return chosen != "steady" or option != "cycles"
    if option == "stiffness" and hasattr(model, "stiffness_kinds"):
        return inputs.get(key) in model.stiffness_kinds
    return option not in section.section_keys().owners or option in model.case_options
