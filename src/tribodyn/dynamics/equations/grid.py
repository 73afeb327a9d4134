"""The event-aligned phase grid and the row table that the kernel reads.

Every event is a grid point; each step has its own width in phase and three rows of values: at
its left end, middle and right end, taken one-sidedly at events. No step spans a jump, so that
the fourth order of the integrator survives, and nothing is interpolated in the loop.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import cached_property, partial
from typing import Any

import numpy as np

from tribodyn.arrays.linear_algebra import times
from tribodyn.arrays.memory import Memo
from tribodyn.dynamics.equations.entry import (
    Entry,
    entry_values,
    refuse_chance,
    refuse_jumps,
    varies,
)
from tribodyn.dynamics.equations.phases import narrower, table_of
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError
from tribodyn.types import Array, Index, Mask

#: Events nearer than this are one event.
_MERGE = 1e-10
#: Distance from an event at which a one-sided value is taken.
_SIDE = 2e-10
#: Most values of tables that are looked up at once.
_TOGETHER = 2**22
#: Tables that were looked up together by their values at the knots, each with the last values at
#: phases, if these are no more than so many: those of a study are often the same.
_tables: Memo[tuple[Any, Memo[Array]]] = Memo(8)
_CACHED = 2**18
#: Derivatives of the last tables on nodes, which a study does not change either.
_derivatives: Memo[Array] = Memo(16)
#: Widest stencil of the numerical derivative in phase.
_STENCIL = 1e-4
#: Derivatives of the Lagrange polynomials on -2..2: factors of the powers 0 to 3 of the place.
_STENCIL_POWERS = np.array([
    [1.0, -8.0, 0.0, 8.0, -1.0], [-1.0, 16.0, -30.0, 16.0, -1.0],
    [-3.0, 6.0, 0.0, -6.0, 3.0], [2.0, -8.0, 12.0, -8.0, 2.0],
]) / 12.0  # fmt: skip


@dataclass(frozen=True)
class Grid:
    """Steps of one period of the clock: of a mesh cycle where all contacts have one cycle."""

    left: Array  #: [-]
    width: Array  #: [-]
    after_event: Mask  #: whether an event lies at the left end
    segment_left: Array  #: [-]
    segment_right: Array  #: [-]

    @cached_property
    def steps(self) -> int:
        """Number of steps in a period."""
        return int(self.left.size)

    @cached_property
    def events(self) -> frozenset[float]:
        """Phases at which a value may jump [-]."""
        changes = np.diff(self.segment_left, prepend=np.nan)
        return frozenset(self.segment_left[np.flatnonzero(changes)].tolist())

    def rows(self, which: Index) -> Grid:
        """Some of the steps."""
        return Grid(*(getattr(self, field.name)[which] for field in fields(Grid)))


def system_events(*systems: System) -> tuple[float, ...]:
    """Events of all contacts and frictions, sorted and merged."""
    event_lists = [part.events for system in systems for part in system.clocked_contacts]
    event_lists += [part.events for system in systems for part in system.clocked_frictions]
    events = sorted({0.0, *(event for part in event_lists for event in part)})
    merged: list[float] = []
    for event in events:
        if (not merged or event - merged[-1] > _MERGE) and event < 1.0 - _MERGE:
            merged.append(event)
    return tuple(merged)


def build_grid(events: tuple[float, ...], steps: int) -> Grid:
    """Divide the mesh cycle so that every event is a grid point."""
    edges = np.array([*events, 1.0])
    if steps < 2 * len(events):
        raise InputError(
            f"steps = {steps}",
            where="argument steps",
            why=f"The mesh cycle has {len(events)} segments between events and needs at "
            "least two steps in each",
            remedy=f"Use at least {max(64, 2 * len(events))} steps",
        )
    counts = _shares(np.diff(edges), steps)
    left = [
        edges[i] + np.arange(count) * (edges[i + 1] - edges[i]) / count
        for i, count in enumerate(counts)
    ]
    width = np.repeat(np.diff(edges) / counts, counts)
    first = np.zeros(steps, dtype=np.bool_)
    first[np.concatenate(([0], np.cumsum(counts)[:-1]))] = True
    return Grid(
        np.concatenate(left),
        width,
        first,
        np.repeat(edges[:-1], counts),
        np.repeat(edges[1:], counts),
    )


def _shares(lengths: Array, steps: int) -> Index:
    """Distribute the steps over the segments, at least two each, by largest remainder."""
    free = steps - 2 * lengths.size
    ideal = lengths / lengths.sum() * steps - 2.0
    ideal = np.maximum(ideal, 0.0)
    ideal *= free / ideal.sum() if ideal.sum() > 0 else 0.0
    counts = np.floor(ideal).astype(np.int64)
    remaining = free - int(counts.sum())
    # Equal remainders go to the first segments, whatever rounding and the processor's sort say.
    order = np.argsort(np.round(counts - ideal, 9), kind="stable")
    counts[order[:remaining]] += 1
    return np.asarray(counts + 2)


def unrepeated(values: Array, trailing: int = 0) -> Array:
    """View with every broadcast axis reduced to one item; the last ``trailing`` axes stay."""
    axes = values.strides[: values.ndim - trailing]
    return values[tuple(slice(None if stride else 1) for stride in axes)]


class RowEvaluator:
    """Evaluate entries on the three nodes of every step, one-sidedly at events."""

    def __init__(self, grid: Grid, *, checks: bool = True) -> None:
        self.grid, self.checks, self._values = grid, checks, dict[Any, Array]()
        nodes = np.stack((grid.left, grid.left + 0.5 * grid.width, grid.left + grid.width), axis=1)
        self._low = grid.segment_left[:, None] + _SIDE
        self._high = grid.segment_right[:, None] - _SIDE
        self.nodes = np.clip(nodes, self._low, self._high)

    def values(self, where: str, entry: Entry, size: int = 1) -> Array:
        """Values on the nodes, of an entry that jumps at events only."""
        if not varies(entry):
            constant = entry_values(where, entry, self.nodes[:1, 0], size)[0]
            return np.broadcast_to(constant, (*self.nodes.shape, size))
        if (values := self._looked_up(entry, size)) is not None:
            return values.reshape(*self.nodes.shape, size)
        flat = entry_values(where, entry, self.nodes.reshape(-1), size)
        values = flat.reshape(*self.nodes.shape, size)
        if self.checks and not self.is_smooth(entry):
            refuse_chance(where, entry, self.nodes.reshape(-1), flat)
            refuse_jumps(where, entry, self.nodes, values)
        return values

    def look_up(self, entries: Iterable[Any]) -> None:
        """Look up all entries that are tables on the nodes, those with the same grid at once."""
        groups: dict[Any, tuple[dict[int, Any], dict[tuple[int, float], None]]] = {}
        for entry in entries:
            if (looked_up := table_of(entry)) is not None and self.is_smooth(entry):
                table, *clock = looked_up
                tables, clocks = groups.setdefault((type(table), id(table.grid)), ({}, {}))
                tables[id(table.values)] = table
                clocks[int(clock[0]), float(clock[1])] = None
        for (kind, _), (tables, clocks) in groups.items():
            if len(tables) * len(clocks) > 1:
                self._look_up(kind, list(tables.values()), np.array(list(clocks)))

    def _look_up(self, kind: Any, tables: list[Any], clocks: Array) -> None:
        flat = [table.values.reshape(len(table.values), -1) for table in tables]
        columns, nodes = np.concatenate(flat, axis=1), self.nodes.reshape(-1)
        if not np.isfinite(columns).all():  # reported when each entry is evaluated alone
            return
        grid, ends = tables[0].grid, np.cumsum([each.shape[1] for each in flat])
        table, cached = _tables.get((columns, grid.phase), lambda: (kind(grid, columns), Memo(4)))
        together = max(1, _TOGETHER // (nodes.size * columns.shape[1]))
        for first in range(0, len(clocks), together):
            some = clocks[first : first + together]
            phase = (some[:, :1] * nodes + some[:, 1:]) % 1.0
            if phase.size * columns.shape[1] > _CACHED:
                values = table(phase)
            else:
                values = cached.get((phase,), partial(table, phase))
            for (cycles, offset), rows in zip(some.tolist(), values, strict=True):
                parts = zip(tables, np.split(rows, ends[:-1], axis=1), strict=True)
                for each, part in parts:
                    self._values[id(each.values), cycles, offset] = part

    def _looked_up(self, entry: object, size: int) -> Array | None:
        """Values (p, size) of an entry that was looked up."""
        looked_up = table_of(entry)
        if looked_up is None:
            return None
        table, cycles, offset = looked_up
        values = self._values.get((id(table.values), cycles, offset))
        if values is None:
            return None
        onto = getattr(table, "onto", None)
        values = values if onto is None else values @ onto
        return values if values.shape[1] == size else None

    def is_smooth(self, entry: Entry) -> bool:
        """Whether the entry is a table that jumps only at events of this grid."""
        events = getattr(entry, "event_phases", None)
        return events is not None and self.grid.events.issuperset(events)

    def derivatives(self, where: str, entry: Entry, size: int = 1) -> Array:
        """Derivatives with respect to phase on the nodes, from a five-point stencil."""
        if not varies(entry):
            return np.broadcast_to(0.0, (*self.nodes.shape, size))
        if (narrow := narrower(entry)) is None:
            return self._differences(where, entry, size)
        table, onto = narrow
        compute = partial(self._differences, where, table, len(onto))
        looked_up = table_of(table)
        assert looked_up is not None
        of_table = looked_up[0].values, looked_up[0].grid.phase, np.array(looked_up[1:])
        key = (self.nodes, self._low, self._high, *of_table)
        is_kept = self.nodes.size * len(onto) <= _CACHED
        return times(_derivatives.get(key, compute) if is_kept else compute(), onto.T)

    def _differences(self, where: str, entry: Entry, size: int) -> Array:
        """Derivatives by a five-point stencil."""
        span = self._high - self._low
        step = np.minimum(_STENCIL / getattr(entry, "cycles", 1), span / 8.0)
        centre = np.clip(self.nodes, self._low + 2.0 * step, self._high - 2.0 * step)
        shift = (self.nodes - centre) / step
        points = centre[..., None] + step[..., None] * np.arange(-2, 3)
        values = entry_values(where, entry, points.reshape(-1), size).reshape(*points.shape, size)
        weights = _stencil_derivative(shift)
        result: Array = np.einsum("rspk,rsp->rsk", values, weights) / step[..., None]
        return result


class PointEvaluator(RowEvaluator):
    """Evaluate entries at phases of the clock, on one side of the events, (points, 1)."""

    def __init__(self, phase: Array, events: tuple[float, ...], *, before: bool = False) -> None:
        edges = np.array([*events, 1.0])
        shift = -_MERGE if before else _MERGE
        segment = np.searchsorted(edges, (phase + shift) % 1.0, side="right") - 1
        self.checks, self._values = False, dict[Any, Array]()
        self._low = edges[segment][:, None] + _SIDE
        self._high = edges[segment + 1][:, None] - _SIDE
        at = np.where((phase == 0.0) & before, 1.0, phase)
        self.nodes = np.clip(at[:, None], self._low, self._high)

    def is_smooth(self, entry: Entry) -> bool:
        """Whether tables may be evaluated together: a point lies on one side of all events."""
        return True


def _stencil_derivative(shift: Array) -> Array:
    """Derivative weights of the Lagrange polynomial on -2..2 at ``shift``."""
    weights = np.broadcast_to(_STENCIL_POWERS[0], (*shift.shape, 5)).copy()
    if (moved := shift != 0.0).any():
        powers = np.polynomial.polynomial.polyval(shift[moved, None], _STENCIL_POWERS, False)
        weights[moved] = powers
    return weights
