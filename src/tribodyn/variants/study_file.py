"""Read study files: the case, what varies, and what is computed and stored for every member."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.cases.catalogue import all_files
from tribodyn.cases.load import load_case
from tribodyn.errors import InputError, Problem, did_you_mean
from tribodyn.model import REQUIRED, Option, choice, integer, number, text
from tribodyn.nonlinear.parameter_map import SCALES
from tribodyn.study.case.read import key_lines, parse_toml, read_text
from tribodyn.study.case.user_input import Source, unsound
from tribodyn.study.case.values import FaultError, read_value, written
from tribodyn.study.machine.case import AnyCase
from tribodyn.study.pipeline.summary_figures import in_order
from tribodyn.study.studies.study_axes import (
    Axis,
    UnreadError,
    member_value,
    read_axis,
    read_values,
    toml_value,
)
from tribodyn.study.uncertain.lanes import draw
from tribodyn.types import ByName, Tree
from tribodyn.validated_files import read_bytes
from tribodyn.variants.compute import KINDS, MOST, Grid, Layout, listed

_MEANINGS = {name: kind.meaning for name, kind in KINDS.items()}
#: Keys at the top of a study file.
TOP: Mapping[str, Option] = {
    "title": text(None, meaning="one line that names the study", example='"Speed and torque"'),
    "case": text(
        REQUIRED,
        meaning="built-in case, or path of a case file from where the study file is",
        example='"fzg-roughness"',
    ),
    "compute": choice("summary", _MEANINGS, meaning="what is computed of each member"),
    "chunk": integer(
        None,
        1,
        10**6,
        "members that are computed and stored together; an interruption loses an unfinished chunk",
        meaning="members of a chunk",
        example="200",
    ),
    "table": text(None, meaning="CSV file with one member in each line", example='"cases.csv"'),
}
#: Keys of ``[samples]``.
SAMPLES: Mapping[str, Option] = {
    "size": integer(
        REQUIRED, 1, MOST, "more takes too long", meaning="number of members", example="1024"
    ),
    "seed": integer(
        REQUIRED,
        0,
        10**9,
        "any value is suitable",
        meaning="seed of the sampling; the same seed gives the same members",
        example="1",
    ),
    "method": choice(
        "sobol", ("sobol", "monte-carlo", "latin-hypercube"), meaning="sampling method"
    ),
}
_FACTOR: Option = number(
    1.0, 0.0, 1e6, "a factor of what the case has", meaning="factor", example="1.0"
)
_VARIES = ("axes", "samples", "cases", "table")
_EXAMPLE = 'Write for example [axes] with operation.speed = "400..3500 rpm:60"'
_SPREAD = 'Write for example operation.speed = "400 rpm .. 3500 rpm"'
#: Largest number of names that a message lists.
_LISTED = 12
#: Tables that hold keys of the case.
_KEYED = ("set", "axes", "samples.over")


@with_old_names
@dataclass(frozen=True)
class Study:
    """Many members of one case; created by :func:`load_study`.

    Parameters
    ----------
    title : str
        One line.
    case : Case
        With the values that all members share.
    compute : str
        Kind of computation: ``"summary"`` or ``"motions"``.
    keep : tuple of str
        Figures that are stored; all if it is empty.
    chunk : int
        Members that are computed and stored together.
    layout : Grid or Listed
        The members; ``layout.count`` is their number.
    specification : dict
        Specification of the members.
    place : str
        Path of the file, for messages.
    """

    title: str
    case: AnyCase
    compute: str
    keep: tuple[str, ...]
    chunk: int
    layout: Layout
    specification: ByName
    place: str = "study"


def load_study(path: str | os.PathLike[str]) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : str or path
        TOML file; its keys are described on the page on scale of the documentation.

    Raises
    ------
    InputError
        If it cannot be read, listing every error of the file.
    """
    return read_study(read_text(Path(path)), os.fspath(path))


def read_study(content: str, name: str = "study.toml") -> Study:
    r"""Check the text of a study file.

    Parameters
    ----------
    content : str
        TOML text.
    name : str
        Path of the file, for messages; paths in it are relative to its directory.

    Raises
    ------
    InputError
        Listing every error of the file.

    Examples
    --------
    >>> study = read_study('case = "fzg-roughness"\naxes.operation.speed = "400..900 rpm:3"')
    >>> study.layout.count, study.compute
    (3, 'summary')
    """
    data = parse_toml(content, name)
    source = Source(name, partial(key_lines, content))
    if faults := list(unsound({key: each for key, each in data.items() if key != "cases"})):
        raise InputError(source.place(faults))
    reader = _Reader(data, Path(name).parent)
    study = reader.study(name)
    if study is None:
        raise InputError(source.place(reader.faults))
    return study


class _Reader:
    """Reader of the parts of a study file that collects every error with its key."""

    def __init__(self, data: Tree, folder: Path) -> None:
        self.data, self.folder = data, folder
        self.faults: list[tuple[str, Problem]] = []

    def put(self, key: str, problem: Problem) -> None:
        """Record an error of a key."""
        self.faults.append((key, problem))

    @contextmanager
    def _errors(
        self, key: str, locate: Callable[[str, Problem], tuple[str, Problem]] | None = None
    ) -> Iterator[None]:
        """Record the errors of a block at a key, or where ``locate`` puts them."""
        try:
            yield
        except FaultError as fault:
            self.put(key, fault.problem)
        except InputError as error:
            locate = locate or (lambda key, problem: (key, replace(problem, where="")))
            self.faults += [locate(key, problem) for problem in error.problems]

    def study(self, name: str) -> Study | None:
        """The study, or None after an error."""
        top = self._values(self.data, TOP, "", (*TOP, "keep", "set", *_VARIES[:3]))
        kind = top.get("compute", "summary")
        keep = self._keep(kind)
        varies = [key for key in _VARIES if key in self.data]
        if len(varies) != 1:
            what = f"{' and '.join(varies)} are set" if varies else "nothing varies"
            why = f"Exactly one of {', '.join(_VARIES)} defines what varies"
            self.put("".join(varies[-1:]), Problem(what, "", why, _EXAMPLE))
        case = self._case(top.get("case"))
        if case is not None and not case.lumped and kind == "motions":
            what, why = f'compute = "{kind}"', "It integrates the motions of gear pairs in batches"
            self.put("compute", Problem(what, "", why, 'Write compute = "summary"'))
        if self.faults or case is None:
            return None
        free = SCALES if kind == "motions" else ()
        if varies[0] == "axes":
            layout, request = self._grid(case, free)
        elif varies[0] == "samples":
            layout, request = self._sampled(case)
        else:
            layout, request = self._listed(case, top["table"], free)
        if layout is None:
            return None
        chunk, title = top["chunk"] or KINDS[kind].chunk, top["title"] or case.title
        return Study(title, case, kind, keep, chunk, layout, request, name)

    def _values(self, data: ByName, options: Mapping[str, Option], path: str, allowed: Any) -> Tree:
        """Values of a table; records its errors."""
        values: Tree = {}
        for key in (key for key in data if key not in allowed):
            remedy = did_you_mean(key, allowed, "Remove it")
            place = f"[{path[:-1]}]" if path else "the top of the file"
            why = f"{place} has: {', '.join(allowed)}"
            self.put(path + key, Problem(f"{key}: unknown key", "", why, remedy))
        for key, option in options.items():
            if key in data:
                with self._errors(path + key):
                    values[key] = read_value(option, key, data[key])
                continue
            values[key] = None if option.required else option.default
            if option.required:
                remedy = f"Add for example {key} = {option.example}"
                self.put(path + key, Problem(f"{key} is missing", "", option.meaning, remedy))
        return values

    def _keep(self, kind: str) -> tuple[str, ...]:
        names, figures = self.data.get("keep", []), KINDS[kind].figures
        has_figure = KINDS[kind].has_figure
        if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
            remedy = f'Write for example keep = ["{next(iter(figures))}"]'
            self.put("keep", Problem(f"keep = {written(names)}", "", "It is a list", remedy))
            return ()
        for name in (name for name in names if not has_figure(name)):
            remedy = did_you_mean(name, figures, "List the names by: tribodyn run CASE --json")
            gives = ", ".join(figures) if len(figures) <= _LISTED else "the figures of a summary"
            why = f'compute = "{kind}" gives {gives}'
            self.put("keep", Problem(f'there is no figure "{name}"', "", why, remedy))
        return tuple(in_order(filter(has_figure, names), figures))

    def _case(self, name: str | None) -> AnyCase | None:
        """The case with the values that all members share."""
        if name is None:
            return None
        with self._errors("case", _at_key):
            try:
                case: Any = load_case(name if name in all_files() else self.folder / name)
                changes = self._keys("set", self.data)
                changed: AnyCase = case.replace(changes, by="set") if changes else case
                return changed
            except InputError:
                raise
            except (OSError, ValueError) as error:
                raise InputError(f"{written(name)} cannot be read: {error}") from None
        return None

    def _keys(self, name: str, data: Mapping[str, object]) -> Tree:
        """Values of a table by dotted key of the case."""
        table = data.get(name.rpartition(".")[2], {})
        if not isinstance(table, dict):
            self.put(name, Problem(f"{written(table)}", "", "It is a table", f"Write [{name}]"))
            return {}
        with self._errors(name):
            return _flat(table)
        return {}

    def _grid(self, case: AnyCase, free: Any) -> tuple[Layout | None, ByName]:
        axes: list[Axis] = []
        for key, entry in self._keys("axes", self.data).items():
            with self._errors(f"axes.{key}"):
                values = _ranges(entry)
                axes.append(_factors(key, values) if key in free else _axis(case, key, values))
        if not axes and not self.faults:
            self.put("axes", Problem("nothing varies", "", "", _EXAMPLE))
        elif (count := math.prod(len(axis.values) for axis in axes)) > MOST:
            why = f"The limit is {MOST:g}"
            self.put("axes", Problem(f"{count:g} members", "", why, "Use fewer values"))
        grid = None if self.faults else Grid(tuple(axes))
        return grid, {"axes": [axis.key for axis in axes]}

    def _sampled(self, case: AnyCase) -> tuple[Layout | None, ByName]:
        table = self.data["samples"]
        if not isinstance(table, dict):
            self.put("samples", Problem(written(table), "", "It is a table", "Write [samples]"))
            return None, {}
        values = self._values(table, SAMPLES, "samples.", (*SAMPLES, "over"))
        over = self._keys("samples.over", table)
        if not over and not self.faults:
            self.put("samples.over", Problem("nothing varies", "", "", _SPREAD))
        if self.faults:
            return None, {}
        options = {"method": values["method"], "seed": values["seed"]}
        with self._errors("samples.over", _at_distribution):
            samples = draw(case, over, values["size"], **options)
            columns = {key: column.tolist() for key, column in samples.items()}
            units = {key: _unit(case, key) for key in samples}
            request = {"over": {key: str(each) for key, each in over.items()}, **options}
            return listed(columns, units), request
        return None, {}

    def _listed(self, case: AnyCase, path: str | None, free: Any) -> tuple[Layout | None, ByName]:
        key = "table" if path is not None else "cases"
        rows: list[tuple[str, Tree]] = []
        with self._errors(key, _at_key):
            rows = _rows(self.data["cases"]) if path is None else _read_csv(self.folder / path)
        values: dict[str, list[Any]] = {name: [] for _, row in rows[:1] for name in row}
        for place, row in rows:
            for name, entry in row.items():
                with self._errors(key, partial(_in_row, place)):
                    value = _factor(name, entry) if name in free else _value(case, name, entry)
                    values[name].append(value)
        if self.faults:
            return None, {}
        units = {name: _unit(case, name) for name in values}
        return listed(values, units), {"cases": sorted(values)}


def _at_key(key: str, problem: Problem) -> tuple[str, Problem]:
    """Put an error of a value of the case at its key in the study file, if there is one."""
    table, _, inner = str(problem.where).partition(" ")
    if table in _KEYED and inner:
        return f"{table}.{inner}", replace(problem, where="")
    what = f"{problem.where}: {problem.what}" if problem.where else problem.what
    return key, replace(problem, what=what, where="")


def _at_distribution(key: str, problem: Problem) -> tuple[str, Problem]:
    name = str(problem.where).removeprefix("distributions ")
    return f"{key}.{name}", replace(problem, where="")


def _in_row(place: str, key: str, problem: Problem) -> tuple[str, Problem]:
    return key, replace(problem, where="", what=f"{place}: {problem.what}")


def _ranges(entry: object) -> Any:
    """Range or list of values of an axis."""
    try:
        values = read_values(entry) if isinstance(entry, str) else entry
        if isinstance(values, tuple | list):
            return values
        why = "It is text with a range, or a list of values"
    except UnreadError as fault:
        why = str(fault)
    raise InputError(f"cannot read {written(entry)}", "", why, _EXAMPLE)


def _flat(table: Mapping[str, object], prefix: str = "") -> Tree:
    """Values by dotted key, which may be written as tables inside each other."""
    flat: Tree = {}
    for key, value in table.items():
        inner = (
            _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {prefix + key: value}
        )
        if twice := flat.keys() & inner.keys():
            raise InputError(f"{min(twice)} is set twice", "", "", "Keep one of them")
        flat |= inner
    return flat


def _axis(case: AnyCase, key: str, entry: object) -> Axis:
    return read_axis(case, key, entry, "axes")


def _value(case: AnyCase, key: str, entry: object) -> Any:
    return member_value(case, key, entry, "cases")


def _unit(case: AnyCase, key: str) -> str:
    spec = None if key in SCALES else case.option_of(key)
    return spec.unit if spec else ""


def _factor(key: str, entry: object) -> float:
    try:
        return float(read_value(_FACTOR, key, entry))
    except FaultError as fault:
        raise InputError(fault.problem) from None


def _factors(key: str, entry: Any) -> Axis:
    """Values of a factor."""
    values = [_factor(key, each) for each in (entry[:2] if isinstance(entry, tuple) else entry)]
    if isinstance(entry, tuple) and not (values[0] < values[1] and 2 <= entry[2] <= MOST):
        what, why = f"{key} has {entry[2]} points", "A range rises, and has at least two"
        raise InputError(f"{what} from {values[0]} to {values[1]}", "", why, _EXAMPLE)
    if isinstance(entry, tuple):
        values = np.linspace(values[0], values[1], entry[2]).tolist()
    return Axis(key, tuple(values))


def _rows(entry: object) -> list[tuple[str, Tree]]:
    """Members listed in the study file itself."""
    if not isinstance(entry, list) or not entry or not all(isinstance(row, dict) for row in entry):
        what = f"cases = {written(entry)}"
        raise InputError(what, "", "There is one table for each member", "Write [[cases]]")
    rows = [(f"member {number}", _flat(row)) for number, row in enumerate(entry, 1)]
    _check_rows(rows)
    return rows


def _read_csv(path: Path) -> list[tuple[str, Tree]]:
    """Members of a CSV file with their line; its first line has keys with units in brackets."""
    remedy = "Its first line reads: operation.speed [rpm], operation.torque [N*m]"
    try:
        lines = read_bytes(path, "table").decode("utf-8-sig").splitlines()
        table = [row for row in enumerate(csv.reader(lines), 1) if any(map(str.strip, row[1]))]
    except (OSError, UnicodeDecodeError, ValueError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{path} cannot be read: {reason}", "", "", remedy) from None
    if len(table) < 2:
        raise InputError(f"{path} has no members", "", "", remedy)
    heads = [[part.strip() for part in head.rstrip("] ").split("[")] for head in table[0][1]]
    keys, units = [head[0] for head in heads], [" ".join(head[1:]) for head in heads]
    if not all(keys) or len(set(keys)) < len(keys):
        raise InputError(f"{path}:{table[0][0]}: keys are missing or twice", "", "", remedy)
    rows = []
    for line, cells in table[1:]:
        if len(cells) != len(keys):
            what = f"{path}:{line}: {len(cells)} values under {len(keys)} keys"
            raise InputError(what, "", "", "Give every member one value of each key")
        row = {
            key: f"{cell.strip()} {unit}" if unit else toml_value(cell.strip())
            for key, unit, cell in zip(keys, units, cells, strict=True)
        }
        rows.append((f"{path}:{line}", row))
    return rows


def _check_rows(rows: list[tuple[str, Tree]]) -> None:
    keys = set(rows[0][1])
    for place, row in rows:
        if not row or set(row) != keys:
            odd = ", ".join(sorted(set(row) ^ keys)) or "no key"
            why = "All members have the same keys"
            raise InputError(f"{place}: {odd}", "", why, "Give every member each key")
