"""Cells of all contact lines of a hypoid pair over one mesh cycle: their places and gaps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.gear import HypoidFlanks, Misalignment
from tribodyn.gear.hypoid.conjugate import Touch
from tribodyn.gear.hypoid.contact_lines import ContactLines
from tribodyn.gear.hypoid.envelope import Curvature
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
        """Lay values of the lines (lines, ...) out over phases and pairs."""
        whole = np.full((*self.in_contact.shape, *values.shape[1:]), empty)
        whole[self.in_contact] = values
        return whole


def contact_cells(
    flanks: HypoidFlanks, misalignment: Misalignment, phase: Array, count: int
) -> ContactCells:
    """Lines of all pairs at mesh phases; phase 0 is where a pair comes into contact."""
    lines = ContactLines(flanks.conjugate)
    sense = lines.flanks.sense
    first, last = sorted(sense * end for end in lines.span())
    pitch = 2.0 * math.pi / flanks.blank.teeth_wheel
    pairs = math.ceil((last - first) / pitch)
    turn = first + pitch * (phase[:, None] + np.arange(pairs))
    in_contact = turn < last
    rotation = sense * turn[in_contact]
    ends, there = lines.ends(rotation)
    in_contact[in_contact], rotation, ends = there, rotation[there], ends[there]
    # Ends and centres of cells in one line.
    station = ends[:, :1] + np.linspace(0.0, 1.0, 2 * count + 1) * np.ptp(ends, axis=1)[:, None]
    touch = lines.touch(rotation[:, None], station)
    steps = np.linalg.norm(np.diff(touch.contact.wheel.position, axis=1), axis=-1)
    gap = gap_of(lines.flanks, touch, misalignment)
    return ContactCells(
        flanks,
        misalignment,
        phase,
        in_contact,
        touch.at((slice(None), slice(1, None, 2))),
        steps[:, ::2] + steps[:, 1::2],
        gap[:, 1::2],
        gap[:, ::2],
        touch.lever[:, ::2],
    )
