"""The row table at any mesh phase, interpolated between the nodes of a fine grid.

Rows are the factors that the kernel reads
(:class:`~tribodyn.dynamics.equations.program.Program`). The grid has equal steps between two
events, so that their ends and middles are equidistant nodes, and a row between two of them follows
from the polynomial through the six nearest of its segment. The grid is refined until the middle of
every step follows from the ends of the neighbouring steps, which are twice as far apart. Kinks
never do: steps of the integration end on both sides of them.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.grid import Grid, build_grid, system_events, unrepeated
from tribodyn.dynamics.equations.nodes import Nodes, evaluate_nodes
from tribodyn.dynamics.equations.program import Program, build_program
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array, Index

#: Nodes of an interpolation; a segment of two steps has five.
POINTS = 6
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
    """Polynomials of the factors of a program between the nodes."""

    program: Program  #: with a single row, for the factors that do not vary
    events: Array  #: mesh phases of the events, of both sides of kinks, and 1 [-]
    first: Index  #: first interval of each segment, and the number of intervals
    varying: Index  #: columns of the factors that vary
    powers: Array  #: from the fifth power on, over the part of each interval (m, 6, varying)
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
    rows = program.rows.reshape(steps, 3, -1)
    varying = np.flatnonzero(np.any(rows != rows[0, 0], axis=(0, 1)))
    phases, last = np.append(grid.left[first], 1.0), np.append(first, steps)
    powers = _powers(rows[..., varying], last)
    program = program._replace(rows=rows[0, 0].copy())
    return RowTable(program, phases, 2 * last, varying, powers, error)


def _powers(rows: Array, first: Index) -> Array:
    """Powers of the polynomial between all nodes, from rows (steps, 3, varying)."""
    begin, count = (np.repeat(item, 2 * np.diff(first)) for item in (first[:-1], np.diff(first)))
    start, basis = _polynomials(np.arange(2 * len(rows)) - 2 * begin, 2 * count)
    powers = np.zeros((begin.size, POINTS, rows.shape[2]))
    for k in range(POINTS):
        node = np.minimum(start + k, 2 * count)
        step = np.minimum(node >> 1, count - 1)
        powers += basis[:, k, :, None] * rows[begin + step, node - 2 * step][:, None]
    return powers


def _polynomials(number: Index, count: Index) -> tuple[Index, Array]:
    """First node of each interval, of ``count``, and powers of each node's basis (m, 6, 6)."""
    points = np.minimum(POINTS, count + 1)
    start = np.clip(number - 2, 0, count + 1 - points)
    kinds, which = np.unique(POINTS * points + number - start, return_inverse=True)
    return start, np.stack([_basis(*divmod(kind, POINTS)) for kind in kinds.tolist()])[which]


@cache
def _basis(points: int, shift: int) -> Array:
    """Powers of the polynomial of each of some nodes, in the interval behind node ``shift``."""
    basis, nodes = np.zeros((POINTS, POINTS)), np.arange(points)
    for k in range(points):
        others = np.delete(nodes, k)
        basis[k, POINTS - points :] = np.poly(others - shift) / np.prod(k - others)
    return basis


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
    start, basis = _polynomials(np.arange(grid.steps) - begin, count)
    return begin + start, basis @ 0.5 ** np.arange(POINTS - 1, -1, -1)
