"""Grids of several phases and their transforms.

A motion over phases ``phi_d`` with the frequencies ``f_d`` is a Fourier series over all of them.
The line of the whole numbers ``k`` has the frequency ``k.f``; a derivative over time is the sum of
``f_d d/dphi_d``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tribodyn.errors import InputError
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Points over a phase of meshes, and over one that only turns shafts, with which an automatic
#: choice starts.
_MESH, _SHAFT = 24, 8
#: Points of the first grids over each cycle of phases that a part does not follow, of meshes and of
#: shafts alone, by the number of phases, and over each of their mesh cycles where teeth differ.
_OTHERS, _TURNED, _TEETH = (12, 12, 12, 8, 4), (12, 12, 12, 4, 4), 4
#: Most of these points, tried in turn, and the unknowns of the first grids up to which all stay.
_COARSER, _LARGE = (12, 8, 6, 4), 3 * 2**19
#: Times the points over its phase with which a mesh that jumps is looked at too, as far as with so
#: many times the points of the first grids.
AHEAD = 8
#: Forces that do not break along the motion, and points of a phase at which others are evaluated.
_WHOLE, _CUT = ("steady", "smooth"), 8 / 3
#: Time of what a search does once; of Newton's step for each point and contact, and further for
#: each pair of contacts and spring where forces are evaluated; of a product with the derivative,
#: for each point and contact, and each number of the factors of an inverse; of a look at more
#: points, for each of them and contact, pair of contacts, and further broken forces and their
#: springs; of these factors, for each number and further for each row [s].
_ONCE, _STEP, _PRODUCT = 0.2, (4.6e-7, 1e-8, 4.8e-8), (4e-4, 3.3e-7, 1.9e-9)
_LOOK, _FACTOR = (1.2e-3, 3.5e-7, 3.5e-7, 1.1e-6, 2e-7), (3.1e-8, 2.6e-11)
#: Bytes of the factors of the lines of one phase alone, and of those that others shift, in an
#: approximate inverse; with more, only the lines at which the structure yields most are coupled.
CENTRAL, OTHERS = 2**24, 2**26
#: Part of the largest frequency that is none.
_STILL = 1e-12


@dataclass(frozen=True)
class PhaseGrid:
    """Equal steps over every phase; arrays of values have one row for each point (p, ...)."""

    shape: tuple[int, ...]  #: points over each phase
    frequency: Array  #: of each phase [Hz]

    @property
    def size(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    @cached_property
    def points(self) -> Array:
        """Phases of all points (p, phases)."""
        axes = (np.arange(count) / count for count in self.shape)
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(self.shape))

    @cached_property
    def numbers(self) -> Index:
        """Whole numbers of each line of the half spectrum (k, phases)."""
        *others, last = self.shape
        axes = [np.rint(np.fft.fftfreq(count) * count) for count in others]
        lines = np.meshgrid(*axes, np.arange(last // 2 + 1), indexing="ij")
        return np.stack(lines, axis=-1).reshape(-1, len(self.shape)).astype(np.int64)

    @cached_property
    def omega(self) -> Array:
        """Angular frequency of each line (k,) [rad/s]; exactly zero where it is rounding."""
        omega = 2.0 * np.pi * (self.numbers @ self.frequency)
        return np.where(np.abs(omega) <= _STILL * np.abs(omega).max(initial=0.0), 0.0, omega)

    @cached_property
    def unpaired(self) -> Mask:
        """Lines at the highest number of a phase, which has no sign (k,)."""
        return np.asarray((2 * np.abs(self.numbers) == np.array(self.shape)).any(axis=1))

    def spectrum(self, values: Array) -> ComplexArray:
        """Amplitudes of the lines of the half spectrum (k, ...) of values (p, ...)."""
        from scipy import fft

        table, axes = values.reshape(*self.shape, -1), range(len(self.shape))
        lines = fft.rfftn(table, axes=axes, norm="forward")
        return np.asarray(lines.reshape(-1, values.shape[1]), dtype=complex)

    def values(self, spectrum: ComplexArray) -> Array:
        """Values (p, c) of a half spectrum (k, c)."""
        from scipy import fft

        lines, axes = spectrum.reshape(*self.half, -1), range(len(self.shape))
        return np.asarray(fft.irfftn(lines, self.shape, axes, "forward").reshape(self.size, -1))

    @property
    def half(self) -> tuple[int, ...]:
        """Shape of the half spectrum."""
        return (*self.shape[:-1], self.shape[-1] // 2 + 1)

    def common(self, other: PhaseGrid) -> tuple[Index, ...]:
        """Places of the lines that two grids have, in each of them, the mean first."""
        pairs = zip(self.shape, other.shape, strict=True)
        *highest, last = ((min(pair) - 1) // 2 for pair in pairs)
        lines = np.ix_(*(np.r_[: n + 1, -n:0] for n in highest), np.arange(last + 1))
        halves = self.half, other.half
        return tuple(np.ravel_multi_index(lines, n, mode="wrap").reshape(-1) for n in halves)

    def refined(self, values: Array, finer: PhaseGrid) -> Array:
        """Values (p, c) on another grid: with the lines that both have."""
        places, finer_places = self.common(finer)
        padded = np.zeros((math.prod(finer.half), values.shape[1]), dtype=complex)
        padded[finer_places] = self.spectrum(values)[places]
        return finer.values(padded)

    def lines(self, axis: int) -> Index:
        """First points of all lines along a phase."""
        return np.arange(self.size).reshape(self.shape).take(0, axis).reshape(-1)


def polynomial_shares(distance: Array) -> Array:
    """Weights of even points in the polynomial through them, at distances in steps (p, points)."""
    orders = np.arange(distance.shape[1])
    distance = np.where(distance == 0.0, 1e-200, distance)  # all weight at this point
    binomial = [math.comb(orders.size - 1, k) for k in orders]
    share = (-1.0) ** orders * binomial / distance
    return np.asarray(share / share.sum(axis=1, keepdims=True))


#: Points over each phase of the grids of all parts.
Points = tuple[tuple[int, ...], ...]


def read_points(steps: Any, phases: int, parts: int) -> Points:
    """Points over each phase of parts: one whole number for all, or one for each."""
    counts: Index = np.atleast_1d(np.asarray(steps))
    if counts.size not in (1, phases):
        what, why = f"steps = {steps}", f"There are {phases} phases"
        raise InputError(what, "steps", why, "Give a whole number for each, or one for all")
    listed = (require_whole("steps", n, 4) for n in np.broadcast_to(counts, (phases,)).tolist())
    return (tuple(listed),) * parts


def doubled(points: Points, which: Mask, times: Index | int = 2) -> Points:
    """Twice the points of some parts over some phases (parts, phases), or so many times."""
    return tuple(tuple(row) for row in (np.array(points) * np.where(which, times, 1)).tolist())


def most_points(points: Points) -> tuple[int, ...]:
    """Points over each phase of the finest grid over it."""
    return tuple(max(counts) for counts in zip(*points, strict=True))


#: Fields of a follower.
Fields = tuple[Any, ...]


class Follower(NamedTuple):
    """Contacts of a mesh, and what they follow."""

    contacts: int
    cycles: Any  #: periods of the entries over each phase
    period: int = 1  #: mesh cycles in them
    turns: tuple[tuple[int, ...], ...] = ()  #: cycles of the errors that turn with shafts


def points_of(
    followers: Sequence[Follower], orders: Any, mesh: int | None = None, *, coarser: bool = True
) -> Index:
    """First points of each follower over each phase (f, phases); orders are of forces."""
    cycles = np.abs([each.cycles for each in followers])
    periods = np.array([each.period for each in followers])[:, None]
    still = np.zeros_like(cycles[0])
    turns = np.array([np.abs([still, *each.turns]).max(axis=0) for each in followers])
    # A mesh whose teeth differ has all cycles of its period.
    meshes, driven = (cycles * periods).max(axis=0), _SHAFT * np.asarray(orders)
    shafts = np.maximum(turns.max(axis=0), 1)
    fine = np.where(meshes > 0, (mesh or _MESH) * meshes, _SHAFT * shafts)
    fine = np.maximum(fine, driven)
    place = min(len(fine), len(_OTHERS)) - 1
    each_cycle = np.where(meshes > 0, _OTHERS[place], _TURNED[place])
    repeats = np.where(meshes > 0, cycles.max(axis=0), shafts)
    teeth = np.where(cycles > 0, periods, 1).max(axis=0)
    contacts = np.array([each.contacts for each in followers])
    # What turns with a phase that meshes of others have needs fewer points than these.
    turned = np.where(meshes > 0, np.minimum(fine, _MESH * turns), fine)
    for most in _COARSER if coarser else _COARSER[:1]:
        felt = np.minimum(each_cycle, most) * repeats
        felt = np.maximum(felt, _TEETH * np.where(teeth > 1, teeth, 0))
        felt = np.minimum(fine, np.maximum(felt, driven))
        points = np.where(turns > 0, np.maximum(turned, felt), felt)
        points = np.where(cycles > 0, fine, points).astype(int)
        if contacts @ points.astype(float).prod(axis=1) <= _LARGE:
            break
    return np.asarray(points)


def first_sizes(
    followers: Sequence[Follower], orders: Any, mesh: int | None = None, *, coarser: bool = True
) -> list[int]:
    """Points of the first grid of each follower."""
    points = points_of(followers, orders, mesh, coarser=coarser)
    return [math.prod(each) for each in points.tolist()]


def given_points(follower: Follower, orders: Any, mesh: int) -> tuple[int, ...]:
    """Points over each phase of one mesh, with so many over its mesh cycle."""
    return tuple(points_of([follower], orders, mesh)[0].tolist())


class Work(NamedTuple):
    """What the time of a motion depends on beside its grids, from a trial on the first ones."""

    kind: str = "broken"  #: steady or smooth forces, broken ones, ringing meshes, or open flanks
    size: int = 12  #: coordinates
    newton: int = 4  #: steps of Newton's method on a grid
    products: int = 30  #: with the derivative in them
    springs: int = 1  #: of a contact
    decay: float = 0.0  #: of a disturbance of the structure, at least [1/s]
    #: Frequency of a mesh, that of the mesh or the shaft over whose phase there are more points
    #: [Hz], change of the motion with them, and how many times as many they are.
    changes: tuple[tuple[float, float, float, int], ...] = ()
    #: Frequency of a mesh [Hz], and unknowns at a point of each contact, as where loads move along.
    columns: tuple[tuple[float, float], ...] = ()
    samples: float = 0.0  #: memory of entries along mesh cycles [byte]

    def wide(self, follower: Follower, frequency: Array) -> Follower:
        """A follower with so many contacts as it has unknowns at a point."""
        rate = abs(float(np.asarray(follower.cycles) @ frequency)) * follower.period
        closest = min(self.columns, key=lambda each: abs(each[0] - rate), default=(rate, 1.0))
        return follower._replace(contacts=round(follower.contacts * closest[1]))

    def change(self, mesh: float, over: float) -> tuple[float, int]:
        """Change of a mesh with so many times the points over a phase."""
        if not self.changes or 0.0 in (mesh, over):
            return (0.02 if mesh and mesh == over else 0.0), 2
        return min(self.changes, key=lambda each: abs(each[0] - mesh) + abs(each[1] - over))[2:]


def whose(frequency: Array, axes: Iterable[int], rates: Iterable[float]) -> Array:
    """Frequency of the mesh of each phase, from meshes with their axes, or of its shaft."""
    over = np.abs(frequency)
    for axis, rate in zip(axes, rates, strict=True):
        over[axis] = rate or over[axis]
    return over


def time_of_grids(
    followers: Sequence[Follower], orders: Array | float, frequency: Array, work: Work,
    poor: Callable[..., Mask],
) -> tuple[float, float]:  # fmt: skip
    """Time of a search [s], whose grids are refined as of a motion, and lines of its last grids."""
    widths: dict[tuple[tuple[int, ...], ...], int] = {}
    grids: dict[tuple[tuple[int, ...], ...], tuple[int, ...]] = {}
    for each, row in zip(followers, points_of(followers, orders).tolist(), strict=True):
        key = tuple(each.cycles), *each.turns
        widths[key] = widths.get(key, 0) + each.contacts
        grids[key] = tuple(row)
    cycles = np.array([each for each, *_ in widths])
    felt = np.array([np.any(each, axis=0) for each in widths])
    axes = np.where(cycles == 0, np.inf, np.abs(cycles)).argmin(axis=1)
    points: Points = tuple(grids.values())
    errors, times = np.zeros(felt.shape), np.full(felt.shape, 2)
    periods = {tuple(each.cycles): each.period for each in followers}
    rates = [abs(float(each @ frequency)) * periods[tuple(each.tolist())] for each in cycles]
    over = whose(frequency, axes, rates)
    for at in np.ndindex(felt.shape):
        errors[at], times[at] = work.change(rates[at[0]], float(over[at[1]]))

    def size(grids: Points) -> int:
        return sum(math.prod(grid) * w for grid, w in zip(grids, widths.values(), strict=True))

    first, again, smooth = points, np.ones(felt.shape, dtype=bool), work.kind in _WHOLE
    seconds, teeth = _ONCE, np.where(cycles != 0, np.array(points) // _MESH, 1).max(axis=1)
    while True:
        for place, (grid, width) in enumerate(zip(points, widths.values(), strict=True)):
            axis = int(axes[place])
            ahead = AHEAD * first[place][axis] // grid[axis]
            multiples = 2 * int(again[place].sum())
            multiples += ahead if ahead > 2 and work.kind not in _WHOLE else 0
            seconds += _time(grid, width, axis, multiples, work, int(teeth[place]))
        chosen = poor(size, points, errors, times, smooth)
        if not chosen.any():
            return seconds, 0.0 if work.kind == "steady" else 0.4 * sum(map(math.prod, points))
        # Forces that bend cause lines that fall with the square of their number, and those of a
        # natural frequency fall as much once they are reached.
        points, errors = doubled(points, chosen, times), errors / np.where(chosen, 4.0, 1.0)
        times, again, smooth = np.full(felt.shape, 2), felt | (cycles != 0).any(axis=0), False


def _time(
    grid: tuple[int, ...], width: int, axis: int, multiples: int, work: Work, teeth: int
) -> float:
    """Time of one part on a grid [s]; it is looked at with so many times its points."""
    points, broken = math.prod(grid), work.kind not in _WHOLE
    inside = points * width * (_CUT if broken else 1.0)  # where forces are evaluated
    each = _STEP[0] * points * width + inside * (_STEP[1] * width + _STEP[2] * work.springs)
    seconds = (work.newton + 1) * each
    seconds += work.products * (_PRODUCT[0] + _PRODUCT[1] * points * width)
    each = _LOOK[0] + points * width * (_LOOK[1] + _LOOK[2] * width)
    each += broken * points * (_LOOK[3] + _LOOK[4] * width * work.springs)
    seconds += multiples * each
    if work.kind == "steady":
        return seconds
    others = teeth * (points // grid[axis] // 2)
    for rows, most in ((teeth, CENTRAL), (others, OTHERS)):
        equations = min(grid[axis] // teeth * width, math.sqrt(most / (8.0 * max(rows, 1))))
        factor = _FACTOR[0] + _FACTOR[1] * equations + _PRODUCT[2] * work.products
        seconds += rows * equations**2 * factor
    return seconds
