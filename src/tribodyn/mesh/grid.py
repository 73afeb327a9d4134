"""The phase grid of a mesh cycle: knots that stand exactly on the events, with both sides.

At an event (a pair enters, leaves or passes the pitch point) quantities jump. Each segment
between two events has its own knots at both ends, so a phase on an event occurs twice: with the
value before and with the value after.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.arrays.linear_algebra import times
from tribodyn.arrays.memory import Memo
from tribodyn.arrays.splines import monotone_cubic
from tribodyn.errors import InputError
from tribodyn.types import Array, ComplexArray, Index

#: Cubic interpolation needs three intervals; Simpson's rule an even number.
_LEAST_INTERVALS = 4
#: The last sets of phases with their knots and weights, and sizes of those that are remembered.
_located_places: Memo[tuple[Index, Array]] = Memo(8)
_FEWEST_CACHED, _MOST_CACHED = 512, 65536


@dataclass(frozen=True, eq=False)
class PhaseGrid:
    """Uniform knots in each segment between two events.

    Parameters
    ----------
    event_phases : tuple of float
        Increasing, from 0 to below 1.
    intervals : tuple of int
        Number of intervals of each segment, even, at least four.
    """

    event_phases: tuple[float, ...]
    intervals: tuple[int, ...]

    @cached_property
    def segments(self) -> tuple[slice, ...]:
        """Knots of each segment, both ends included."""
        stops = np.cumsum(np.array(self.intervals) + 1)
        return tuple(
            slice(int(stop) - count - 1, int(stop))
            for stop, count in zip(stops, self.intervals, strict=True)
        )

    @cached_property
    def phase(self) -> Array:
        """Mesh phase of the knots, from 0 to 1; each event occurs twice."""
        ends = (*self.event_phases[1:], 1.0)
        spans = zip(self.event_phases, ends, self.intervals, strict=True)
        return np.concatenate([np.linspace(a, b, count + 1) for a, b, count in spans])

    @cached_property
    def middle(self) -> Array:
        """Phase of the middle of the segment of each knot: a place that is on no event."""
        ends = np.array((*self.event_phases[1:], 1.0))
        middles = 0.5 * (np.array(self.event_phases) + ends)
        return np.repeat(middles, np.array(self.intervals) + 1)

    @cached_property
    def _layout(self) -> tuple[Array, Index, Array, Index]:
        """Begin, intervals, width and first knot of each segment."""
        starts, counts = np.array(self.event_phases), np.array(self.intervals)
        return starts, counts, np.diff(starts, append=1.0), np.cumsum(counts + 1) - counts - 1

    def _interpolated(self, phase: Array, columns: Array) -> Array:
        """Values (c, ...) of columns (n, c) at phases by the cubic through the four nearest knots.

        The values of each column are contiguous.
        """
        if phase.size < _FEWEST_CACHED:
            knots, weights = self._located(phase)
            return np.asarray(np.einsum("k...,k...c->c...", weights, columns[knots]))
        if phase.size <= _MOST_CACHED:
            # Tables of one case and of all its operating points are evaluated at the same phases.
            key = phase, self.phase
            knots, weights = _located_places.get(key, lambda: self._located(phase.ravel()))
        else:
            knots, weights = self._located(phase.ravel())
        interpolated = np.empty((columns.shape[1], phase.size))
        for column, place in zip(np.ascontiguousarray(columns.T), interpolated, strict=True):
            np.einsum("kp,kp->p", weights, column.take(knots), out=place)
        return interpolated.reshape(-1, *phase.shape)

    def _located(self, phase: Array) -> tuple[Index, Array]:
        folded = np.mod(phase, 1.0)
        starts, counts, widths, knots = self._layout
        segment = np.searchsorted(starts, folded, side="right") - 1
        count = counts[segment]
        position = (folded - starts[segment]) / widths[segment] * count
        left = np.minimum(np.maximum(position.astype(int) - 1, 0), count - 3)
        u = position - left
        weights = (
            (1.0 - u) * (2.0 - u) * (3.0 - u) / 6.0,
            u * (2.0 - u) * (3.0 - u) / 2.0,
            u * (u - 1.0) * (3.0 - u) / 2.0,
            u * (u - 1.0) * (u - 2.0) / 6.0,
        )
        return np.stack([knots[segment] + left + knot for knot in range(4)]), np.stack(weights)

    def mean(self, values: Array) -> Array:
        """Mean over the cycle by Simpson's rule in each segment.

        Parameters
        ----------
        values : array (n, ...)
            Values at the knots.

        Returns
        -------
        array (...)
            Exact for piecewise cubics.
        """
        means = self._weights @ values.reshape(len(values), -1)
        return np.asarray(means.reshape(values.shape[1:]))

    def _harmonics(self, values: Array, count: int) -> Array:
        """Peak amplitudes (count,) of the mesh harmonics 1, 2, ... of values (n,) at the knots."""
        waves = self._waves(count) * values[:, None]
        return np.asarray(2.0 * np.abs(self._weights @ waves))

    def _waves(self, count: int) -> ComplexArray:
        if count not in self._cached_waves:
            orders = np.arange(1, count + 1)
            self._cached_waves[count] = np.exp(-2j * np.pi * np.outer(self.phase, orders))
        return self._cached_waves[count]

    @cached_property
    def _cached_waves(self) -> dict[int, ComplexArray]:
        return {}

    @cached_property
    def _weights(self) -> Array:
        parts = []
        for segment, count in zip(self.segments, self.intervals, strict=True):
            simpson = np.ones(count + 1)
            simpson[1:-1:2], simpson[2:-1:2] = 4.0, 2.0
            ends = self.phase[segment][[0, -1]]
            parts.append(simpson * (ends[1] - ends[0]) / (3.0 * count))
        return np.concatenate(parts)


@dataclass(frozen=True, eq=False)
class PhaseFunction:
    """Values on a phase grid as a function of any mesh phase.

    Parameters
    ----------
    grid : PhaseGrid
        The knots.
    values : array (n, ...)
        Values at the knots.
    onto : array (m, k), optional
        Matrix of pure numbers by which the last m values become k.
    """

    grid: PhaseGrid
    values: Array
    onto: Array | None = None

    @property
    def event_phases(self) -> tuple[float, ...]:
        """Phases at which it may jump."""
        return self.grid.event_phases

    def __call__(self, phase: Array | float) -> Array:
        """Interpolate with the cubic through four knots; on an event the value after it."""
        at = np.asarray(phase, dtype=float)
        interpolated = self.grid._interpolated(at, self.values.reshape(len(self.values), -1))
        interpolated = np.moveaxis(interpolated, 0, -1).reshape(at.shape + self.values.shape[1:])
        return interpolated if self.onto is None else times(interpolated, self.onto.T)


def phase_grid(event_phases: tuple[float, ...], steps: int = 512) -> PhaseGrid:
    """Divide one mesh cycle into about ``steps`` intervals, with knots on every event.

    Parameters
    ----------
    event_phases : tuple of float
        Phases at which something jumps: increasing, the first 0, all below 1.
    steps : int
        Wanted number of intervals, at least 16.

    Returns
    -------
    PhaseGrid
        Each segment has an even number of intervals near its share, at least four.

    Raises
    ------
    InputError
        If the events are not in order, or there are too few steps.

    Notes
    -----
    Any number of events. Source: quadrature and interpolation keep their order only on smooth
    pieces.

    Examples
    --------
    >>> grid = phase_grid((0.0, 0.25), 16)
    >>> grid.intervals, grid.segments
    ((4, 12), (slice(0, 5, None), slice(5, 18, None)))
    >>> float(grid.mean(grid.phase**3))
    0.25
    """
    edges = np.array((*event_phases, 1.0))
    if edges[0] != 0.0 or np.any(np.diff(edges) <= 0.0):
        what = f"event phases {', '.join(f'{edge:g}' for edge in event_phases)}"
        why = "They start with 0, increase and stay below 1"
        remedy = "Sort the phases and remove repeated ones"
        raise InputError(what, "argument event_phases", why, remedy)
    if steps < 16:
        why = "A mesh cycle needs at least 16 intervals"
        raise InputError(f"steps = {steps}", "argument steps", why, "Give for example steps = 512")
    halves = np.rint(0.5 * steps * np.diff(edges)).astype(int)
    intervals = tuple(max(_LEAST_INTERVALS, 2 * int(half)) for half in halves)
    return PhaseGrid(tuple(float(event) for event in event_phases), intervals)


@dataclass(frozen=True, eq=False)
class MonotonePhaseFunction:
    """Monotone piecewise cubic in each segment between two events.

    For quantities that have corners at phases which are no events: a cubic through four knots
    would swing there, and a stiffness of zero would swing below zero.

    Parameters
    ----------
    grid : PhaseGrid
        The knots.
    values : array (n, ...)
        Values at the knots, in any unit.

    Notes
    -----
    Source: Fritsch and Carlson (1980), SIAM J. Numer. Anal. 17, 238-246.

    Examples
    --------
    >>> from tribodyn.mesh import phase_grid
    >>> grid = phase_grid((0.0,), 16)
    >>> corner = MonotonePhaseFunction(grid, np.maximum(grid.phase - 0.5, 0.0))
    >>> float(corner(0.49)), float(corner(0.9375))
    (0.0, 0.4375)
    """

    grid: PhaseGrid
    values: Array

    @property
    def event_phases(self) -> tuple[float, ...]:
        """Phases at which it may jump."""
        return self.grid.event_phases

    @cached_property
    def _pieces(self) -> list[Callable[[Array], Array]]:
        return [
            monotone_cubic(self.grid.phase[part], self.values[part]) for part in self.grid.segments
        ]

    def __call__(self, phase: Array | float) -> Array:
        """Interpolate; on an event the value after it, NaN where the phase is not finite."""
        folded = np.mod(np.asarray(phase, dtype=float), 1.0)
        segment = np.searchsorted(np.array(self.grid.event_phases), folded, side="right") - 1
        interpolated = np.empty(folded.shape + self.values.shape[1:])
        for number, piece in enumerate(self._pieces):
            in_segment = segment == number
            if np.any(in_segment):
                interpolated[in_segment] = piece(folded[in_segment])
        return interpolated
