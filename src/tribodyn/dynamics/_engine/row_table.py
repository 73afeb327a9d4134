"""The row table at any mesh phase, interpolated between the nodes of a fine grid.

Rows are the factors that the kernel reads
(:class:`~tribodyn.dynamics.equations.program.Program`). The grid has equal steps between two
events, so that their ends and middles are equidistant nodes, and a row follows from the six nearest
nodes of its segment by Lagrange's polynomial. The grid is refined until the middle of every step
follows from the ends of the neighbouring steps, which are twice as far apart. Kinks never do: steps
of the integration end on both sides of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.grid import Grid, build_grid, system_events, unrepeated
from tribodyn.dynamics.equations.nodes import Nodes, evaluate_nodes
from tribodyn.dynamics.equations.program import Program, build_program
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array, Index

#: Nodes of an interpolation; a segment of two steps has five.
POINTS = 6
#: ``1 / prod(k - j)`` of node k among ``row`` nodes.
DENOMINATORS = np.array(
    [
        [
            1.0 / np.prod([k - j for j in range(points) if j != k]) if k < points else 0.0
            for k in range(POINTS)
        ]
        for points in range(POINTS + 1)
    ]
)
#: Initial and largest number of steps, and most numbers of the table.
_FIRST, _MOST_STEPS, _MOST_NUMBERS = 256, 32768, 2**24
#: Deviation over the tolerance of the motion at which the grid is fine enough.
_FINE = 1e-3
#: Nodes are half as far apart as the ends of the steps: a kink, the worst case, has a quarter.
_HALVED = 0.25
#: Deviation over the largest beyond which a step has a kink, and share of the steps that may.
_KINK, _RARE = 0.01, 0.05
#: Components below this part of the largest of an entry are judged as if they were so large.
_SMALL = 1e-3
#: Size of a numerical derivative in phase over that of its entry, below which it is rounding.
_SLOPE = 2.0


class RowTable(NamedTuple):
    """Rows of a program between which is interpolated."""

    program: Program
    events: Array  #: mesh phases of the events, of both sides of kinks, and 1 [-]
    first: Index  #: first step of each segment, and the number of steps
    varying: Index  #: columns of the factors that vary
    error: float  #: mean deviation of the entries from their interpolation, over their size [-]


def build_table(
    system: System, rtol: float, *, scaled: bool = False, split: bool = False
) -> RowTable:
    """Tabulate the entries of a system for motions of the tolerance ``rtol``."""
    events = system_events(system)
    steps = max(_FIRST, 4 * len(events))
    while True:
        grid = build_grid(events, steps)
        nodes = evaluate_nodes(system, grid)
        deviation = interpolation_deviation(grid, nodes)
        error = float((grid.width @ deviation).max(initial=0.0))
        program = build_program(system, grid, nodes, scaled=scaled, split=split)
        finest = 2 * steps > _MOST_STEPS or 2 * program.rows.size > _MOST_NUMBERS
        if error <= _FINE * rtol or finest:
            break
        steps *= 2
    first = np.flatnonzero(grid.after_event)
    if deviation.max() > _FINE * rtol:
        first = np.union1d(first, _around_kinks(deviation.max(axis=1)))
    rows = program.rows.reshape(3 * steps, -1)
    varying = np.flatnonzero(np.any(rows != rows[0], axis=0))
    phases = np.append(grid.left[first], 1.0)
    return RowTable(program, phases, np.append(first, steps), varying, error)


def _around_kinks(deviation: Array) -> Index:
    """Steps at which parts with kinks begin and end; none if entries deviate everywhere."""
    kinked = deviation > _KINK * deviation.max()
    if kinked.mean() > _RARE:
        return np.zeros(0, dtype=np.int64)
    return np.flatnonzero(np.diff(kinked, prepend=False))


def interpolation_deviation(grid: Grid, nodes: Nodes) -> Array:
    """Deviation of interpolated entries over the size of each, (steps, entries)."""
    floors = {
        "error_slope": _SLOPE * float(np.abs(unrepeated(nodes.error)).max(initial=0.0)),
        "direction_slope": _SLOPE * float(np.abs(unrepeated(nodes.direction)).max(initial=0.0)),
    }
    first, weights = _stencils(grid)
    parts = [np.zeros((grid.steps, 1))]
    for name, values in nodes._asdict().items():
        if name in ("phase", "weight") or not values.size or not values.strides[0]:
            continue
        rows = values.reshape(grid.steps, 3, -1)
        size = np.abs(rows).max(axis=(0, 1))
        size = np.maximum(size, max(_SMALL * size.max(), floors.get(name, 0.0)))
        ends = np.concatenate((rows[:, 0], rows[-1:, 2]))
        deviation = -rows[:, 1]
        for k, weight in enumerate(weights.T):
            part = ends[np.minimum(first + k, grid.steps)]
            # The end of a segment belongs to its last step, not to the first of the next.
            last = (first + k < grid.steps) & (
                grid.segment_left[np.minimum(first + k, grid.steps - 1)] != grid.segment_left
            )
            part[last] = rows[first[last] + k - 1, 2]
            deviation = deviation + weight[:, None] * part
        parts.append(_HALVED * np.abs(deviation[:, size > 0.0]) / size[size > 0.0])
    return np.concatenate(parts, axis=1)


def _stencils(grid: Grid) -> tuple[Index, Array]:
    """First end of the interpolation to the middle of each step, and weights (steps, 6)."""
    begins = np.flatnonzero(grid.after_event)
    counts = np.diff(np.append(begins, grid.steps))
    begin, count = np.repeat(begins, counts), np.repeat(counts, counts)
    points = np.minimum(POINTS, count + 1)
    number = np.arange(grid.steps) - begin
    first = np.clip(number - 2, 0, count + 1 - points)
    x = number + 0.5 - first
    weights = DENOMINATORS[points].copy()
    for k in range(POINTS):
        for j in range(POINTS):
            if j != k:
                weights[:, k] *= np.where(j < points, x - j, 1.0)
    return begin + first, weights
