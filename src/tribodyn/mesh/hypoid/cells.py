"""Contact lines of a hypoid pair in cells, and the forces of their springs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.gear import HypoidFlanks, Misalignment
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks, Touch, contact_lines
from tribodyn.gear.hypoid.envelope import Curvature, cross
from tribodyn.gear.hypoid.tooth_contact import gap_of
from tribodyn.types import Array, Index, Mask


@dataclass(frozen=True, eq=False)
class ContactCells:
    """Contact lines in the order of phases, each cut into cells of one length."""

    flanks: HypoidFlanks
    misalignment: Misalignment
    phase: Array  #: (p,) mesh cycles
    in_contact: Mask  #: (p, pairs); pair i came into contact i cycles before phase 0
    touch: Touch  #: of the cells' centres (lines, cells)
    length: Array  #: (lines, cells)
    gap: Array  #: (lines, cells) gap without load
    edge_gap: Array  #: (lines, cells + 1) the same at the ends of each cell
    edge_lever: Array  #: (lines, cells + 1) lever of the normal about the wheel's axis

    @cached_property
    def row(self) -> Index:
        """Phase that each line belongs to (lines,)."""
        return np.asarray(np.nonzero(self.in_contact)[0])

    @cached_property
    def age(self) -> Array:
        """Mesh cycles since each line came into contact (lines,)."""
        return np.asarray(self.phase[self.row] + np.nonzero(self.in_contact)[1])

    @cached_property
    def curvature(self) -> Curvature:
        """Curvature of the gap about each cell."""
        return self.touch.curvature

    @cached_property
    def side_radius(self) -> Array:
        """Radius of the gap along the line (lines, cells); infinite where it is not open."""
        middle = 0.5 * (self.edge_gap[:, 1:] + self.edge_gap[:, :-1])
        curvature = 8.0 * (middle - self.gap) / self.length**2
        with np.errstate(divide="ignore"):
            return 1.0 / np.maximum(curvature, 0.0)

    def summed(self, values: Array) -> Array:
        """Sum over all lines of each phase."""
        total = np.zeros((self.phase.size, *values.shape[1:]))
        np.add.at(total, self.row, values)
        return total

    def spread(self, values: Array, empty: float = 0.0) -> Array:
        """Spread values of the lines (lines, ...) over phases and pairs (phase, pair, ...)."""
        spread_values = np.full((*self.in_contact.shape, *values.shape[1:]), empty)
        spread_values[self.in_contact] = values
        return spread_values


class CellSprings(NamedTuple):
    """Springs of all cells, each in proportion to its length."""

    stiffness: Array | float  #: force per length and approach (lines, cells) [Pa]
    lead: Array | float = 0.0  #: gap at which each begins to carry (lines, cells) [m]


class _Lines(NamedTuple):
    """Lines of all pairs at mesh phases, in cells, whatever the misalignment."""

    in_contact: Mask
    touch: Touch  #: at the ends and the centres of the cells, in turn
    length: Array


@lru_cache(maxsize=4)
def _lines(flanks: ConjugateFlanks, phases: tuple[float, ...], count: int) -> _Lines:
    """Lines in cells; a misalignment or a load only changes their gap."""
    lines = contact_lines(flanks)
    phase: Array = np.array(phases)
    first, last = sorted(flanks.sense * end for end in lines.span)
    pitch = 2.0 * math.pi / flanks.blank.teeth_wheel
    pairs = math.ceil((last - first) / pitch)
    turn: Array = first + pitch * (phase[:, None] + np.arange(pairs))
    in_contact = turn < last
    rotation = flanks.sense * turn[in_contact]
    ends, meets = lines.ends(rotation)
    in_contact[in_contact], rotation, ends = meets, rotation[meets], ends[meets]
    # Ends and centres of cells in one line.
    station = ends[:, :1] + np.linspace(0.0, 1.0, 2 * count + 1) * np.ptp(ends, axis=1)[:, None]
    touch = lines.touch(rotation[:, None], station)
    steps = np.linalg.norm(np.diff(touch.contact.wheel.position, axis=1), axis=-1)
    return _Lines(in_contact, touch, steps[:, ::2] + steps[:, 1::2])


def contact_cells(
    flanks: HypoidFlanks, misalignment: Misalignment, phase: Array, count: int
) -> ContactCells:
    """Lines of all pairs at mesh phases; phase 0 is where a pair comes into contact."""
    in_contact, touch, length = _lines(flanks.conjugate, tuple(phase.tolist()), count)
    gap = gap_of(flanks.conjugate, touch, misalignment)
    return ContactCells(
        flanks,
        misalignment,
        phase,
        in_contact,
        touch.at((slice(None), slice(1, None, 2))),
        length,
        gap[:, 1::2],
        gap[:, ::2],
        touch.lever[:, ::2],
    )


#: Steps of Newton's method, which comes down a convex curve, and the parts of
#: the torque at which it ends and that are refused.
_STEPS, _CLOSE, _REFUSED = 60, 1e-13, 1e-9


def _gaps(cells: ContactCells, lead: Array | float) -> tuple[Array, Array]:
    """Gaps at both ends of each cell at which its spring begins to carry (lines, cells)."""
    return cells.edge_gap[:, :-1] - lead, cells.edge_gap[:, 1:] - lead


class ClosedCells(NamedTuple):
    """Closed parts of all cells (lines, cells)."""

    force: Array
    spring: Array  #: stiffness of the closed part [N/m]
    middle: Array  #: its middle as a share of the cell
    lever: Array  #: of the normal there about the wheel's axis


def closed_cells(
    cells: ContactCells, springs: CellSprings, lag: Array, deflection: Array | None = None
) -> ClosedCells:
    """Cells under the lag (p,) [rad] whose teeth bend away by a deflection (lines, cells + 1)."""
    lever, at_line = cells.edge_lever, lag[cells.row, None]
    gaps = _gaps(cells, springs.lead)
    approach = lever * at_line - (0.0 if deflection is None else deflection)
    first, second = approach[:, :-1] - gaps[0], approach[:, 1:] - gaps[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = first / (first - second)
    # The closed part of the cell, between shares of its length.
    begin = np.where(first >= 0.0, 0.0, np.where(second > 0.0, turn, 1.0))
    end = np.where(second >= 0.0, 1.0, np.where(first > 0.0, turn, begin))
    closed, middle = end - begin, 0.5 * (begin + end)
    spring = springs.stiffness * cells.length * closed
    force = spring * np.maximum(first + (second - first) * middle, 0.0)
    return ClosedCells(force, spring, middle, lever[:, :-1] + np.diff(lever) * middle)


def carried(cells: ContactCells, springs: CellSprings, lag: Array) -> tuple[Array, Array, Array]:
    """Forces of the cells of a wheel that lags (p,) [rad], its torque, and the slope of that."""
    closed, arm = closed_cells(cells, springs, lag), cells.touch.lever
    slope = closed.spring * closed.lever
    torque, rate = (cells.summed((each * arm).sum(axis=1)) for each in (closed.force, slope))
    return closed.force, torque, rate


def _lags(cells: ContactCells, lead: Array | float) -> Array:
    """Lags of the wheel at which the ends of the cells close (2, lines, cells) [rad]."""
    first, second = _gaps(cells, lead)
    return np.stack([first / cells.edge_lever[:, :-1], second / cells.edge_lever[:, 1:]])


def first_touch(cells: ContactCells, lead: Array | float = 0.0) -> Array:
    """Lag of the wheel at which the first cell of each phase carries (p,) [rad]."""
    least = np.full(cells.phase.size, np.inf)
    np.minimum.at(least, cells.row, _lags(cells, lead).min(axis=(0, 2)))
    return least


def lag_under(cells: ContactCells, springs: CellSprings, wheel_torque: Array | float) -> Array:
    """Lag of the wheel at which the cells of each phase balance a torque (p,) [rad].

    The torque is convex in the lag: from above Newton's method comes down to it.
    """
    spring = (springs.stiffness * cells.length * cells.touch.lever**2).sum(axis=1)
    most = np.full(cells.phase.size, -np.inf)
    np.maximum.at(most, cells.row, _lags(cells, springs.lead).max(axis=(0, 2)))
    lag = most + 1.1 * wheel_torque / cells.summed(spring)
    for _ in range(_STEPS):
        _, torque, rate = carried(cells, springs, lag)
        left = float(np.max(np.abs(torque - wheel_torque) / wheel_torque))
        if left < _CLOSE:
            break
        lag = lag - (torque - wheel_torque) / rate
    if not left < _REFUSED:
        least = float(np.min(wheel_torque))
        raise ComputationError(
            f"a torque of {least:.4g} N m on the wheel is balanced within {left:.2g} only",
            why="It is too small for the gaps by ease-off and misalignment",
            remedy="Increase the torque, or compute the tooth contact without load",
        )
    return lag


def in_frame(vectors: Array, flanks: ConjugateFlanks, gear: str) -> Array:
    """Vectors of the fixed frame in that of a gear, whose y axis lies along its rotation."""
    axis = flanks.axes.axis if gear == "pinion" else np.array([0.0, 0.0, -1.0])
    # The common perpendicular x, the axis in its running sense, and what is across both.
    across = np.array([0.0, -axis[2], axis[1]])
    return np.asarray(vectors @ np.array([[1.0, 0.0, 0.0], flanks.sense * axis,
                                          flanks.sense * across]).T)  # fmt: skip


def wrench(cells: ContactCells, forces: Array, gear: str) -> Array:
    """Force and moment (lines, cells, 6) of forces at the cells on a gear, in its frame."""
    axes, position = cells.flanks.conjugate.axes, cells.touch.contact.wheel.position
    arm = position - axes.origin if gear == "pinion" else position
    parts = [in_frame(v, cells.flanks.conjugate, gear) for v in (forces, cross(arm, forces))]
    return np.concatenate(parts, axis=-1)
