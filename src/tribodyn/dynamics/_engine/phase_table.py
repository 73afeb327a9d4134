"""The row table at any mesh phase: piecewise polynomials between events.

Rows are the factors that the kernel reads
(:class:`~tribodyn.dynamics.equations.program.Program`). Each segment between two events is divided
into cells; in each cell every factor that varies is a polynomial through Chebyshev nodes. A cell is
halved until the polynomial meets the entry between its nodes, so that an entry with kinks gets
small cells there, and steps end at kinks. Linear interpolation is not enough: each of its grid
points is a kink at which an adaptive integrator reduces its step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.grid import Grid, build_grid, system_events
from tribodyn.dynamics.equations.nodes import Nodes, evaluate_nodes
from tribodyn.dynamics.equations.program import Program, build_program
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError
from tribodyn.types import Array, Index

#: Highest degree of a polynomial.
_DEGREE = 10
#: Largest deviation between the nodes, over the largest size of the factor.
_DEVIATION = 1e-11
#: The same times the width of the cell: the part of it that affects a step across the cell.
_NOTICED = 1e-14
#: Rounding of a numerical derivative in phase, over the size of what is differentiated.
_NOISE = 2e-11
#: Rounding of a sum, over the sum of the sizes of its terms.
_CANCELLED = 1e-14
#: Cells below this width are not halved.
_NARROWEST = 1e-10
#: Cells are not halved further when this many halvings in a row did not help.
_STALLED = 3
#: Cells below this width adjoin a kink; jump of a slope that counts as one, over the size of the
#: factor and per mesh cycle.
_NARROW, _KINK = 5e-5, 1e-5
#: Most cells of a mesh cycle.
_MOST = 40_000
#: Initial cells per mesh cycle, and points that show which terms are never zero.
_FIRST, _SAMPLE = 16, 256


class PhaseTable(NamedTuple):
    """Rows of a program as polynomials of the mesh phase."""

    program: Program  #: the terms, and the rows at sample points
    events: Array  #: mesh phases of the events, of kinks of the entries between them, and 1 [-]
    first: Index  #: first cell of each segment, and the number of cells
    edge: Array  #: mesh phases between which the cells lie [-]
    degree: Index  #: degree of the polynomials of each cell
    start: Index  #: where the coefficients of each cell begin
    coefficients: Array
    varying: Index  #: columns of the factors that vary
    constant: Array  #: the row
    error: float  #: [-]


class _Rows:
    """Rows of a program at chosen points, with the same terms each time."""

    def __init__(self, system: System, events: Array, scaled: bool, split: bool) -> None:
        self.system, self.scaled, self.split = system, scaled, split
        self._sample_terms(build_grid(tuple(events[:-1]), max(_SAMPLE, 8 * events.size)))

    def _sample_terms(self, sample: Grid) -> None:
        """Take the terms and the sizes of their factors from a sample."""
        self.sample = sample
        nodes, self.program = self._compile(sample)
        self.columns = int(self.program.code[2])
        self.scale = np.abs(self.program.rows.reshape(-1, self.columns)).max(axis=0)
        self.noise = _noise(self.system, nodes, self.program)

    def _compile(self, grid: Grid) -> tuple[Nodes, Program]:
        nodes = evaluate_nodes(self.system, grid)
        scaled, split = self.scaled, self.split
        return nodes, build_program(self.system, grid, nodes, scaled=scaled, split=split)

    def at(self, middle: Array, half: Array, low: Array, high: Array) -> Array:
        """Rows at ``middle - half``, ``middle`` and ``middle + half``: (points, 3, columns)."""
        first = self.sample
        grid = Grid(
            np.concatenate((first.left, middle - half)),
            np.concatenate((first.width, 2.0 * half)),
            np.zeros(first.steps + middle.size, dtype=np.bool_),
            np.concatenate((first.segment_left, low)),
            np.concatenate((first.segment_right, high)),
        )
        _, program = self._compile(grid)
        if not np.array_equal(program.code, self.program.code):
            # A term that is zero on the sample is not zero elsewhere: the sample grows.
            self._sample_terms(grid)
            raise _MoreTermsError
        rows = program.rows.reshape(-1, 3, self.columns)[first.steps :]
        self.scale = np.maximum(self.scale, np.abs(rows).max(axis=(0, 1)))
        return rows

    def full_scale(self) -> Array:
        """Size of each column; for a column of mere rounding, the size that causes the rounding."""
        scale = np.maximum(self.scale, self.noise / _DEVIATION)
        return np.where(scale > 0.0, scale, 1.0)


class _MoreTermsError(Exception):
    """The sample did not show all terms."""


def _noise(system: System, nodes: Nodes, program: Program) -> Array:
    """Rounding of each column: of numerical derivatives in phase, and of sums that cancel."""
    rows = program.rows.reshape(*nodes.phase.shape, -1)
    noise = np.zeros(rows.shape[-1])
    inverse = system.inverse_mass
    size = np.abs(inverse)
    pushes = (nodes.force_direction, nodes.direction, nodes.force_direction - nodes.direction)
    load = np.einsum("ik,rsk->rsi", inverse, nodes.force)
    parts = [(load, _CANCELLED, np.einsum("ik,rsk->rsi", size, np.abs(nodes.force)))]
    for j in range(nodes.error.shape[-1]):
        parts += [
            (nodes.error_slope[:, :, j, None], _NOISE, nodes.error[:, :, j, None]),
            (nodes.direction_slope[:, :, j], _NOISE, nodes.direction[:, :, j]),
            *(
                (
                    -np.einsum("ik,rsk->rsi", inverse, push[:, :, j]),
                    _CANCELLED,
                    np.einsum("ik,rsk->rsi", size, np.abs(push[:, :, j])),
                )
                for push in pushes
            ),
        ]
    for values, share, sizes in parts:
        for i in range(values.shape[-1]):
            same = np.all(rows == values[:, :, i, None], axis=(0, 1)) & np.any(values[:, :, i])
            noise[same] = np.maximum(noise[same], share * np.abs(sizes[:, :, i]).max())
    return noise


def build_table(system: System, *, scaled: bool = False, split: bool = False) -> PhaseTable:
    """Turn the entries of a system into polynomials of the mesh phase."""
    events = np.array([*system_events(system), 1.0])
    rows = _Rows(system, events, scaled, split)
    for _ in range(8):
        try:
            return _refine(rows, events)
        except _MoreTermsError:
            continue
    what = "entries of the system are zero at most mesh phases but not at all"
    why = "Samples of the mesh cycle do not show which terms are present"
    remedy = "Declare the phases where an entry begins and ends as events"
    raise InputError(what, "argument system", why, remedy)


class _Level:
    """Cells of one size class and how well polynomials meet their entries."""

    def __init__(self, rows: _Rows, left: Array, right: Array, low: Array, high: Array) -> None:
        self.left, self.right, self.low, self.high = left, right, low, high
        count = _DEGREE + 1
        angle = np.pi * (np.arange(count) + 0.5) / count
        between = np.cos(np.pi * np.arange(count // 2 + 1) / count)
        pairs = np.concatenate((np.cos(angle[: count // 2]), between))
        half = 0.5 * (right - left)
        middle = left + half

        def spread(values: Array) -> Array:
            return np.repeat(values, pairs.size)

        sampled_rows = rows.at(
            spread(middle), (half[:, None] * pairs).ravel(), spread(low), spread(high)
        ).reshape(left.size, pairs.size, 3, -1)
        nodes = sampled_rows[:, : count // 2]
        # In the order of falling abscissa: right ends, the middle, left ends.
        values = np.concatenate((nodes[:, :, 2], nodes[:, :1, 1], nodes[:, ::-1, 0]), axis=1)
        basis = np.cos(np.outer(np.arange(count), angle)) * 2.0 / count
        basis[0] *= 0.5
        self.spectrum = np.einsum("km,cmv->ckv", basis, values)
        check = np.concatenate((-between, between))
        edge = 2e-10 / half
        # At an event the entry is taken a little inside, and so is the polynomial.
        x = np.clip(
            check[None, :],
            np.where(left == low, -1.0 + edge, -1.0)[:, None],
            np.where(right == high, 1.0 - edge, 1.0)[:, None],
        )
        model = np.einsum(
            "ckv,kcp->cpv",
            self.spectrum,
            np.cos(np.arange(count)[:, None, None] * np.arccos(np.clip(x, -1.0, 1.0))),
        )
        truth = np.concatenate(
            (sampled_rows[:, count // 2 :, 0], sampled_rows[:, count // 2 :, 2]), axis=1
        )
        self.deviation = np.abs(model - truth).max(axis=1)


def _refine(rows: _Rows, events: Array) -> PhaseTable:
    pieces = np.maximum(2, np.ceil(_FIRST * np.diff(events)).astype(np.int64))
    edges = [
        np.linspace(low, high, count + 1)
        for low, high, count in zip(events[:-1], events[1:], pieces, strict=True)
    ]
    left = np.concatenate([edge[:-1] for edge in edges])
    right = np.concatenate([edge[1:] for edge in edges])
    low, high = np.repeat(events[:-1], pieces), np.repeat(events[1:], pieces)
    parent, stalled = np.full(left.size, np.inf), np.zeros(left.size)
    done: list[tuple[Array, Array, Array, Array]] = []
    while left.size:
        level = _Level(rows, left, right, low, high)
        scale = rows.full_scale()
        width = (right - left)[:, None]
        ratio = (level.deviation / scale * np.minimum(1.0 / _DEVIATION, width / _NOTICED)).max(
            axis=1, initial=0.0
        )
        # Rounding of an entry does not shrink with the cell; a kink halves, all else falls faster.
        stalled = np.where((ratio > 0.7 * parent) & (ratio < 1e4), stalled + 1, 0)
        at_cell_limit = sum(item[0].size for item in done) + 2 * left.size > _MOST
        narrow = (right - left) < _NARROWEST
        accepted = (ratio <= 1.0) | (stalled >= _STALLED) | narrow | at_cell_limit
        done.append(
            (
                left[accepted],
                right[accepted],
                level.spectrum[accepted],
                level.deviation[accepted] / scale,
            )
        )
        split = ~accepted
        middle = 0.5 * (left + right)
        left, right = (
            np.concatenate((left[split], middle[split])),
            np.concatenate((middle[split], right[split])),
        )
        low, high, parent, stalled = (
            np.tile(item[split], 2) for item in (low, high, ratio, stalled)
        )
    parts = (np.concatenate(part) for part in zip(*done, strict=True))
    return _assemble(rows, events, *parts)


def _assemble(
    rows: _Rows, events: Array, left: Array, right: Array, spectrum: Array, deviation: Array
) -> PhaseTable:
    order = np.argsort(left)
    left, right, spectrum = left[order], right[order], spectrum[order]
    error = float((deviation[order] * (right - left)[:, None]).sum(axis=0).max(initial=0.0))
    scale = rows.full_scale()
    spectrum = np.where(np.abs(spectrum) > 1e-13 * scale, spectrum, 0.0)
    differing = np.any(spectrum[:, 1:] != 0.0, axis=(0, 1))
    differing |= np.ptp(spectrum[:, 0], axis=0) > 1e-13 * scale
    varying = np.flatnonzero(differing)
    used = np.any(spectrum[:, :, varying] != 0.0, axis=2)
    degree = np.where(used, np.arange(_DEGREE + 1), 0).max(axis=1)
    powers = np.zeros((_DEGREE + 1, _DEGREE + 1))
    for k in range(_DEGREE + 1):
        powers[k, : k + 1] = np.polynomial.chebyshev.cheb2poly([0.0] * k + [1.0])
    monomials = np.einsum("ckv,kp->cvp", spectrum[:, :, varying], powers)
    within_degree = np.arange(_DEGREE + 1)[None, None, :] <= degree[:, None, None]
    sizes = (degree + 1) * varying.size
    ends = _with_kinks(events, left, right, spectrum / scale)
    return PhaseTable(
        program=rows.program,
        events=ends,
        first=np.append(np.searchsorted(left, ends[:-1]), left.size).astype(np.int64),
        edge=np.append(left, 1.0),
        degree=degree.astype(np.int64),
        start=(np.cumsum(sizes) - sizes).astype(np.int64),
        coefficients=np.append(monomials[np.broadcast_to(within_degree, monomials.shape)], 0.0),
        varying=varying.astype(np.int64),
        constant=spectrum[0, 0].copy(),
        error=error,
    )


def _with_kinks(events: Array, left: Array, right: Array, spectrum: Array) -> Array:
    """Events, and cell edges at kinks: where a slope jumps, and next to the narrowest cells."""
    width = right - left
    order = np.arange(_DEGREE + 1.0)[None, :, None]
    rise = 2.0 / width[:, None] * (order**2 * spectrum).sum(axis=1)
    start = 2.0 / width[:, None] * (-((-1.0) ** order) * order**2 * spectrum).sum(axis=1)
    jump = np.abs(start[1:] - rise[:-1]).max(axis=1, initial=0.0)
    narrow = np.minimum(width[1:], width[:-1])
    kinked = (jump > np.maximum(_KINK, 4e-9 / narrow)) & (narrow > _NARROW)
    around = np.concatenate(([np.inf], width, [np.inf]))
    least = (width < _NARROW) & (width <= around[:-2]) & (width < around[2:])
    kinks = np.concatenate((left[1:][kinked], right[least]))
    kinks = kinks[np.abs(kinks[:, None] - events).min(axis=1) > _NARROW]
    return np.union1d(events, kinks)
