"""The event-aligned phase grid and the row table that the kernel reads.

Every event is a grid point; each step has its own width in phase and three rows of values: at
its left end, middle and right end, taken one-sidedly at events. No step spans a jump, so that
the fourth order of the integrator survives, and nothing is interpolated in the loop.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.system import Entry, System
from tribodyn.errors import InputError
from tribodyn.types import Array, Index, Mask

#: Events nearer than this are one event.
_MERGE = 1e-10
#: Distance from an event at which a one-sided value is taken.
_SIDE = 2e-10
#: Widest stencil of the numerical derivative in phase.
_STENCIL = 1e-4


@dataclass(frozen=True)
class Grid:
    """Steps of one mesh cycle in phase."""

    left: Array  #: [-]
    width: Array  #: [-]
    after_event: Mask  #: whether an event lies at the left end
    segment_left: Array  #: [-]
    segment_right: Array  #: [-]

    @cached_property
    def steps(self) -> int:
        """Number of steps in a mesh cycle."""
        return int(self.left.size)


def system_events(*systems: System) -> tuple[float, ...]:
    """Events of all contacts and frictions, sorted and merged."""
    given = [part.events for system in systems for part in system.contacts]
    given += [part.events for system in systems for part in system.frictions]
    events = sorted({0.0, *(event for part in given for event in part)})
    kept: list[float] = []
    for event in events:
        if (not kept or event - kept[-1] > _MERGE) and event < 1.0 - _MERGE:
            kept.append(event)
    return tuple(kept)


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
    """Give each segment its part of the steps, at least two, by largest remainder."""
    free = steps - 2 * lengths.size
    ideal = lengths / lengths.sum() * steps - 2.0
    ideal = np.maximum(ideal, 0.0)
    ideal *= free / ideal.sum() if ideal.sum() > 0 else 0.0
    counts = np.floor(ideal).astype(np.int64)
    rest = free - int(counts.sum())
    order = np.argsort(counts - ideal)
    counts[order[:rest]] += 1
    return np.asarray(counts + 2)


class RowEvaluator:
    """Evaluates entries on the three nodes of every step, one-sidedly at events."""

    def __init__(self, grid: Grid) -> None:
        self.grid = grid
        nodes = np.stack((grid.left, grid.left + 0.5 * grid.width, grid.left + grid.width), axis=1)
        self._low = grid.segment_left[:, None] + _SIDE
        self._high = grid.segment_right[:, None] - _SIDE
        self.nodes = np.clip(nodes, self._low, self._high)

    def _call(self, where: str, entry: Any, phases: Array, size: int) -> Array:
        """Evaluate on any phases; returns phases.shape + (size,)."""
        flat = phases.reshape(-1)
        if callable(entry):
            values = _oriented(where, entry, flat, size)
        else:
            values = _constant(where, entry, flat, size)
        if not np.all(np.isfinite(values)):
            at = flat[np.flatnonzero(~np.isfinite(values).all(axis=1))[0]]
            raise InputError(
                f"{where} is NaN or infinite at the mesh phase {at:.6g}",
                where=where,
                remedy="Check the table or function there; declare jumps as events",
            )
        return values.reshape(*phases.shape, size)

    def values(self, where: str, entry: Entry, size: int = 1) -> Array:
        """Values on the nodes."""
        return self._call(where, entry, self.nodes, size)

    def derivatives(self, where: str, entry: Entry, size: int = 1) -> Array:
        """Derivatives with respect to phase on the nodes, from a five-point stencil."""
        if not _varies(entry):
            return np.zeros((*self.nodes.shape, size))
        span = self._high - self._low
        step = np.minimum(_STENCIL, span / 8.0)
        centre = np.clip(self.nodes, self._low + 2.0 * step, self._high - 2.0 * step)
        shift = (self.nodes - centre) / step
        points = centre[..., None] + step[..., None] * np.arange(-2, 3)
        values = self._call(where, entry, points, size)
        weights = _stencil_derivative(shift)
        result: Array = np.einsum("rspk,rsp->rsk", values, weights) / step[..., None]
        return result


def _varies(entry: Any) -> bool:
    if callable(entry):
        return True
    return isinstance(entry, list | tuple) and any(callable(item) for item in entry)


def _stencil_derivative(shift: Array) -> Array:
    """Derivative weights of the Lagrange polynomial on -2..2 at ``shift``."""
    nodes = np.arange(-2.0, 3.0)
    weights = np.zeros((*shift.shape, 5))
    for i in range(5):
        others = np.delete(nodes, i)
        scale = np.prod(nodes[i] - others)
        for k in range(4):
            rest = np.delete(others, k)
            weights[..., i] += np.prod(shift[..., None] - rest, axis=-1) / scale
    return weights


def _constant(where: str, entry: Any, phases: Array, size: int) -> Array:
    if _varies(entry):
        columns = [
            _oriented(where, item, phases, 1)[:, 0]
            if callable(item)
            else np.full(phases.size, float(item))
            for item in entry
        ]
        return _broadcast(where, np.stack(columns, axis=1), phases.size, size)
    value = np.asarray(entry, dtype=float)
    if value.ndim > 1 or (value.ndim == 1 and value.size != size):
        raise InputError(
            f"{where} has the shape {value.shape}",
            where=where,
            why=f"It must be a number or have the shape ({size},)",
        )
    return np.broadcast_to(value, (phases.size, size)).astype(float)


def _broadcast(where: str, values: Array, count: int, size: int) -> Array:
    if values.shape != (count, size):
        raise InputError(
            f"{where} gives the shape {values.shape}",
            where=where,
            why=f"It must be ({count}, {size}) for {count} mesh phases",
        )
    return values


def _oriented(where: str, function: Callable[[Array], Any], phases: Array, size: int) -> Array:
    """Call a function of phase; accept (p, size), (size, p), (p,), (size,) and scalars."""
    # One more or one less phase than components makes the orientation unambiguous.
    probe = phases if phases.size not in (1, size) else np.resize(phases, size + 2)
    try:
        values = np.asarray(function(probe), dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"{where} is not a vectorized function of the mesh phase: {error}",
            where=where,
            why="It is called with an array of phases and returns an array",
            remedy="Use numpy.where instead of if, and functions that take arrays",
        ) from error
    if values.ndim == 0:
        values = np.full((probe.size, 1), float(values))
    elif values.ndim == 1 and values.size == probe.size and size == 1:
        values = values[:, None]
    elif values.ndim == 1 and values.size == size:
        values = np.broadcast_to(values, (probe.size, size))
    elif values.shape == (size, probe.size):
        values = values.T
    return _broadcast(where, np.asarray(values, dtype=float), probe.size, size)[: phases.size]
