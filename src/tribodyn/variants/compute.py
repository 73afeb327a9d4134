"""Members of a study, how they grow, and what is computed of each."""

from __future__ import annotations

import io
import json
import math
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import InputError, Problem, TribodynError, quiet
from tribodyn.mesh.film.film_lookup import shared_films
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Parts
from tribodyn.study.pipeline.summary_figures import SUMMARY, figure_of, in_order, is_figure
from tribodyn.study.studies.study_axes import Axis
from tribodyn.types import Array, ByName, Index, Tree
from tribodyn.validated_files import write_dataset

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase

#: Fields of a list that a store records.
_LIST = ("units", "kinds", "count")
#: Largest number of members of a study.
MOST = 10**8
#: Relative difference below which a value of a finer grid equals that of the coarser one.
_SAME = 1e-12


@dataclass(frozen=True)
class Grid:
    """All combinations of the values of some keys; the last one varies fastest."""

    axes: tuple[Axis, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each key."""
        return tuple(len(axis.values) for axis in self.axes)

    @property
    def count(self) -> int:
        """Number of members."""
        return math.prod(self.shape)

    def columns(self, index: Index) -> dict[str, list[Any]]:
        """Values of some members by key."""
        places = np.unravel_index(index, self.shape)
        return {
            axis.key: [axis.values[n] for n in place]
            for axis, place in zip(self.axes, places, strict=True)
        }

    def facts(self) -> Tree:
        """What a store keeps of it."""
        return {"axes": [vars(axis) for axis in self.axes]}

    def after(self, before: ByName, where: str) -> Grid:
        """The same grid with exactly the values of an earlier one that it contains."""
        axes = []
        for axis, old in zip(self.axes, before["axes"], strict=True):
            values = list(axis.values)
            for value in old["values"]:
                matches = [n for n, each in enumerate(values) if _same(each, value)]
                if not matches:
                    what = f"{axis.key} no longer has the value {axis.show(value)}"
                    raise InputError(Problem(what, where, *_ONLY_GROWS))
                values[matches[0]] = value
            axes.append(replace(axis, values=tuple(values)))
        return Grid(tuple(axes))

    def places(self, before: ByName) -> Index:
        """Positions of the members of an earlier grid in this one."""
        rows = [
            [{value: n for n, value in enumerate(axis.values)}[each] for each in old["values"]]
            for axis, old in zip(self.axes, before["axes"], strict=True)
        ]
        return np.ravel_multi_index(np.ix_(*rows), self.shape).ravel()


@dataclass(frozen=True)
class Listed:
    """Drawn or listed members: values by key, one for each member."""

    values: Mapping[str, Sequence[Any]]
    units: Mapping[str, str]
    kinds: Mapping[str, str]  #: of the values by key, as NumPy calls them
    count: int

    def columns(self, index: Index) -> dict[str, list[Any]]:
        """Values of some members by key."""
        return {key: [column[n] for n in index] for key, column in self.values.items()}

    def facts(self) -> Tree:
        """What a store keeps of it."""
        return {**{n: getattr(self, n) for n in _LIST}, "crc": self._crc(self.count)}

    def _crc(self, count: int) -> int:
        text = [json.dumps(list(column[:count])) for column in self.values.values()]
        return zlib.crc32("".join(text).encode())

    def after(self, before: ByName, where: str) -> Listed:
        """The same list, if it begins with an earlier one."""
        count = before["count"]
        if self.count < count or self._crc(count) != before["crc"]:
            what = f"the first {count} members are no longer those that are stored"
            raise InputError(Problem(what, where, *_ONLY_GROWS))
        return self

    def places(self, before: ByName) -> Index:
        """Positions of the members of an earlier list in this one."""
        return np.arange(before["count"])


def listed(values: Mapping[str, Sequence[object]], units: Mapping[str, str]) -> Listed:
    """Members of values by key."""
    kinds = {key: np.array(column).dtype.kind for key, column in values.items()}
    named = {"f": "float", "i": "int", "b": "bool"}
    count = len(next(iter(values.values())))
    return Listed(values, units, {k: named.get(kind, "object") for k, kind in kinds.items()}, count)


_ONLY_GROWS = (
    "A stored study can be extended but not changed; a Latin hypercube of another size has other "
    "members",
    "Retain the earlier members, choose another directory, or start again with --force",
)

Layout = Grid | Listed


def layout_of(facts: ByName) -> Layout:
    """Members as recorded in a store; only the chunks hold the values of a list."""
    if "axes" in facts:
        return Grid(tuple(Axis(**{**a, "values": tuple(a["values"])}) for a in facts["axes"]))
    return Listed({}, *(facts[name] for name in _LIST))


def _same(first: Any, second: Any) -> bool:
    numbers = isinstance(first, float) and isinstance(second, float)
    return math.isclose(first, second, rel_tol=_SAME) if numbers else bool(first == second)


class Chunk(NamedTuple):
    """Members that are computed and stored together."""

    name: str  #: stage and number, ``"0/12"``
    begin: int  #: of the members in the order in which they are stored
    end: int


class Plan:
    """Members in the order of the store: those of earlier stages of the study come first."""

    def __init__(self, layout: Layout, stages: Sequence[ByName]) -> None:
        self.layout, self.chunks = layout, list[Chunk]()
        orders: list[Index] = []
        ordered_members = np.zeros(layout.count if len(stages) > 1 else 0, dtype=bool)
        begin = 0
        for number, facts in enumerate(stages):
            size = layout.count
            if len(stages) > 1:
                places = layout.places(facts)
                orders.append(places[~ordered_members[places]])
                ordered_members[places] = True
                size = orders[-1].size
            for n, first in enumerate(range(0, size, facts["chunk"])):
                last = min(first + facts["chunk"], size)
                self.chunks.append(Chunk(f"{number}/{n}", begin + first, begin + last))
            begin += size
        #: Members by stored order, and stored order by member; None where both are the same.
        self._order = np.concatenate(orders) if orders else None
        self._stored: Index | None = None
        if self._order is not None:
            self._stored = np.empty_like(self._order)
            self._stored[self._order] = np.arange(self._order.size)
        self.begins = np.array([chunk.begin for chunk in self.chunks], dtype=np.int64)

    def members(self, chunk: Chunk) -> Index:
        """Members of a chunk."""
        stored = np.arange(chunk.begin, chunk.end)
        return stored if self._order is None else self._order[stored]

    def locate(self, members: Index) -> Iterator[tuple[Chunk, Index, Index]]:
        """Yield the chunks of some members, with the members in each and their rows."""
        stored = members if self._stored is None else self._stored[members]
        numbers = np.searchsorted(self.begins, stored, side="right") - 1
        order = np.argsort(numbers, kind="stable")
        for group in np.split(order, np.flatnonzero(np.diff(numbers[order])) + 1):
            if group.size:
                chunk = self.chunks[int(numbers[group[0]])]
                yield chunk, group, stored[group] - chunk.begin


Columns = Mapping[str, list[Any]]

#: Labels of verdicts by their number.
VERDICTS = ("none", "physical", "step-limited", "undecided")
#: Errors of the machine, not of a member.
_MACHINE = (ImportError, MemoryError, OSError)


class Part(NamedTuple):
    """Results of some members, in their order."""

    figures: dict[str, Array]  #: in SI; NaN without a value
    failed: list[str]  #: reason why a member failed; empty if it did not
    warned: list[str]  #: codes of warnings of the models, separated by blanks


class Stored(NamedTuple):
    """Results of a chunk in the form of the store."""

    content: bytes  #: of its file
    failed: list[str]  #: reason why a member failed; empty if it did not
    figures: list[str]


class Job(NamedTuple):
    """Input for the computation of a chunk, which is sent to a worker."""

    kind: str
    case: AnyCase
    keep: tuple[str, ...]  #: figures to store; all if it is empty
    columns: Columns

    def compute(self, progress: Progress = SILENT) -> Part:
        """Compute the members."""
        with quiet(), shared_films(persistent=True):
            part = _each(partial(KINDS[self.kind].compute, self.case), self.columns, progress)
        names = self.keep or in_order(part.figures, KINDS[self.kind].figures)
        absent = np.full(len(part.failed), np.nan)
        return part._replace(figures={name: part.figures.get(name, absent) for name in names})

    def stored(self, progress: Progress = SILENT) -> Stored:
        """Compute the members and encode their results, both on the worker."""
        part = self.compute(progress)
        return Stored(self._encoded(part), part.failed, [*part.figures])

    def _encoded(self, part: Part) -> bytes:
        """Result as netCDF; built in memory, as HDF5 does not handle a full disk well."""
        columns = {**self.columns, "failed": part.failed, "warnings": part.warned}
        variables: Tree = {key: ("member", values) for key, values in columns.items()}
        names = {}
        if part.figures:
            units = [KINDS[self.kind].figure(name)[0] for name in part.figures]
            variables["units"] = "figure", units
            variables["value"] = ("member", "figure"), np.stack([*part.figures.values()], 1)
            names = {"figure": [*part.figures]}
        buffer = io.BytesIO()
        write_dataset(Parts(variables, names, {}), buffer)
        return buffer.getvalue()


def _each(compute: Callable[..., Part], columns: Columns, progress: Progress) -> Part:
    """Compute members together; after a failure in halves, down to the members that fail."""
    count = len(next(iter(columns.values())))
    try:
        return compute(columns, progress)
    except _MACHINE:
        raise
    except Exception as error:
        if count == 1:
            progress.advance()
            return Part({}, [_reason(error)], [""])
    halves = [
        _each(compute, {key: values[half] for key, values in columns.items()}, progress)
        for half in (slice(count // 2), slice(count // 2, None))
    ]
    names = dict.fromkeys(name for half in halves for name in half.figures)
    blank = [np.full(len(half.failed), np.nan) for half in halves]
    figures = {
        name: np.concatenate(
            [half.figures.get(name, nan) for half, nan in zip(halves, blank, strict=True)]
        )
        for name in names
    }
    (first, second) = halves
    return Part(figures, first.failed + second.failed, first.warned + second.warned)


def _reason(error: Exception) -> str:
    if isinstance(error, TribodynError):
        return str(error.problems[0])
    what = f"unexpected {type(error).__name__}: {error}"
    return str(Problem(what, why="This is an error in tribodyn, not in the input"))


def _summaries(case: AnyCase, columns: Columns, progress: Progress) -> Part:
    """Every figure of the summary of each member."""
    from tribodyn.study.studies.sweep import points_under

    rows = zip(*columns.values(), strict=True)
    points = points_under(case, [dict(zip(columns, row, strict=True)) for row in rows], progress)
    names = in_order(name for point in points for name in point.figures)
    figures = {
        name: np.array([point.figures.get(name, np.nan) for point in points], dtype=float)
        for name in names
    }
    warned = [" ".join(dict.fromkeys(point.warned)) for point in points]
    return Part(figures, [point.failed for point in points], warned)


def _motions(case: PairCase, columns: Columns, progress: Progress) -> Part:
    """Period, size and verdict of the steady motion of each member, integrated in batches."""
    # Lanes differ in real numbers; another number of teeth or another law makes a new case.
    fixed = [key for key, values in columns.items() if not isinstance(values[0], float)]
    rows = list(zip(*(columns[key] for key in fixed), strict=True))
    rows = rows or [()] * len(next(iter(columns.values())))
    figures = {name: np.full(len(rows), np.nan) for name in _MOTION}
    for row in dict.fromkeys(rows):
        index = [n for n, each in enumerate(rows) if each == row]
        changed = case.replace(dict(zip(fixed, row, strict=True))) if row else case
        real = {
            key: np.array([values[n] for n in index])
            for key, values in columns.items()
            if key not in fixed
        }
        for name, values in _marched(changed, real, len(index), progress).items():
            figures[name][index] = values
    lost = "the motion grew beyond all bounds. Add damping, or take another load."
    failed = ["" if np.isfinite(each) else lost for each in figures["rms"]]
    return Part(figures, failed, [""] * len(rows))


def _marched(
    case: PairCase, values: Mapping[str, Array], count: int, progress: Progress
) -> dict[str, Array]:
    from tribodyn.dynamics._engine.blocks import marching_on
    from tribodyn.nonlinear.parameter_map import SCALES, map_survey, stepped, surveyed
    from tribodyn.study.pipeline.motion import engine_arguments
    from tribodyn.study.uncertain.lanes import lanes_of

    lanes = lanes_of(case, values or {SCALES[0]: np.ones(count)})
    systems = [member.system for member in lanes.members]
    points, number = stepped(systems, lanes.mesh_frequency, lanes.factors)
    with marching_on(engine_arguments(case).get("backend")):
        outcomes, verdicts = surveyed(points, number, map_survey())
    progress.advance(count)
    return {
        "period": np.where(np.isfinite(outcomes.rms), outcomes.period, np.nan),
        "rms": outcomes.rms,
        "contact_loss_share": outcomes.contact_loss_share,
        "steps_per_mesh_cycle": points.steps.astype(float),
        "omega_max_dt": number,
        "verdict": np.array(
            [VERDICTS.index(verdict or "none") for verdict in verdicts], dtype=float
        ),
    }


_MOTION = {
    "period": ("1", "mesh cycles after which the motion repeats; 0 if it does not"),
    "rms": ("m", "alternating rms of the compression of the mesh"),
    "contact_loss_share": ("1", SUMMARY["contact_loss_share"].meaning),
    "steps_per_mesh_cycle": ("1", "steps per mesh cycle"),
    "omega_max_dt": ("1", "fastest motion times step"),
    "verdict": ("1", "judged by half the step: 1 physical, 2 step-limited, 3 undecided"),
}


@dataclass(frozen=True)
class Kind:
    """Kind of computation for the members of a study."""

    meaning: str
    compute: Callable[[Any, Columns, Progress], Part]
    figures: Mapping[str, tuple[str, str]]  #: unit and meaning by name, of gear pairs
    chunk: int  #: default number of members of a chunk

    def has_figure(self, name: str) -> bool:
        """Whether it computes a figure, of a pair or of a part of a machine."""
        return name in self.figures or (self.compute is _summaries and is_figure(name))

    def figure(self, name: str) -> tuple[str, str]:
        """Unit and meaning of a figure."""
        if name in self.figures:
            return self.figures[name]
        entry = figure_of(name)
        return entry.unit or "1", entry.meaning


KINDS = {
    "summary": Kind(
        "every figure of the summary, each member as tribodyn run computes it",
        _summaries,
        {name: (figure.unit or "1", figure.meaning) for name, figure in SUMMARY.items()},
        200,
    ),
    "motions": Kind(
        "period, alternating rms and contact loss of the mesh and a verdict by half the step",
        _motions,
        _MOTION,
        5000,
    ),
}
