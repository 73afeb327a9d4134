"""Members of a study: a grid of values or a list, and how both grow."""

from __future__ import annotations

import json
import math
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.study.studies.study_axes import Axis
from tribodyn.types import Index

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

    def facts(self) -> dict[str, Any]:
        """What a store keeps of it."""
        return {"axes": [vars(axis) for axis in self.axes]}

    def after(self, before: Mapping[str, Any], where: str) -> Grid:
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

    def places(self, before: Mapping[str, Any]) -> Index:
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

    def facts(self) -> dict[str, Any]:
        """What a store keeps of it."""
        return {**{n: getattr(self, n) for n in _LIST}, "crc": self._crc(self.count)}

    def _crc(self, count: int) -> int:
        text = [json.dumps(list(column[:count])) for column in self.values.values()]
        return zlib.crc32("".join(text).encode())

    def after(self, before: Mapping[str, Any], where: str) -> Listed:
        """The same list, if it begins with an earlier one."""
        count = before["count"]
        if self.count < count or self._crc(count) != before["crc"]:
            what = f"the first {count} members are no longer those that are stored"
            raise InputError(Problem(what, where, *_ONLY_GROWS))
        return self

    def places(self, before: Mapping[str, Any]) -> Index:
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


def layout_of(facts: Mapping[str, Any]) -> Layout:
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

    def __init__(self, layout: Layout, stages: Sequence[Mapping[str, Any]]) -> None:
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
