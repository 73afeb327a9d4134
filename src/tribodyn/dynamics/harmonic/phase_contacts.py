"""Contacts of a part on a grid of phases, whose forces are integrated between their breaks.

Along the phase of its mesh the force of a contact breaks where an entry jumps and where a flank
opens or closes. Each line of the grid along this phase is cut there, and the force is integrated by
Gauss's rule over the pieces, which gives its lines without the error of equal steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from tribodyn.dynamics.harmonic.phase_grid import PhaseGrid, polynomial_shares
from tribodyn.dynamics.harmonic.phase_rows import Mesh, PhaseRows, PointRows
from tribodyn.dynamics.harmonic.radial_clearance import clearance_forces
from tribodyn.dynamics.modal.contact_equations import (
    NO_BREAKS,
    Breaks,
    ContactLaw,
    Law,
    Rows,
    of_contact,
    with_dead_zone,
)
from tribodyn.types import Array, Index

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

#: Points of Gauss's rule over a piece, and steps of the grid in a piece without breaks.
_GAUSS, _STEPS = 8, 3
#: Refinement of a grid along a phase between whose points motions are interpolated, and points of
#: the polynomial.
_REFINED, _POINTS = 4, 12
#: Points at which contacts are evaluated at once, of whole pieces.
_BLOCK = _GAUSS * 2**11
#: Intervals of a piece that are searched for the end of a dead zone, and Newton steps to it.
_INTERVALS, _NEWTON = 16, 4


class Cut(NamedTuple):
    """Places on the lines along a phase."""

    line: Index  #: (b,)
    place: Array  #: from 0 to 1 (b,)

    @classmethod
    def joined(cls, cuts: Sequence[Cut]) -> Cut:
        """All places one after the other."""
        none = np.zeros(0, dtype=np.int64), np.zeros(0)
        columns = zip(none, *cuts, strict=True)
        return cls(*(np.concatenate(column) for column in columns))


@dataclass(frozen=True)
class Pieces:
    """Points on the lines of a grid along one phase, with weights of an integral over it."""

    grid: PhaseGrid
    axis: int
    begin: Cut  #: of each piece
    width: Array
    at: Cut  #: points (q,)
    weight: Array  #: of the points; their sum over a line is 1
    uncut: Pieces | None = None  #: without some cuts, whose points are the first ones

    @classmethod
    def of(cls, grid: PhaseGrid, axis: int, cut: Cut, teeth: int = 1) -> Pieces:
        """Pieces between even places on all lines, the same for all teeth, and those of a cut."""
        lines = grid.size // grid.shape[axis]
        count = -(-grid.shape[axis] // (_STEPS * teeth)) * teeth
        even = Cut(np.repeat(np.arange(lines), count), np.tile(np.arange(count) / count, lines))
        line, place = Cut.joined((even, cut))
        order = np.lexsort((place, line))
        begin = Cut(line[order], place[order])
        last = np.append(begin.line[1:] != begin.line[:-1], True)
        end = np.roll(begin.place, -1)
        end[last] = 1.0 + begin.place[np.roll(last, 1)]
        width = end - begin.place
        return cls(grid, axis, begin, width, *_gauss(begin, width))

    def cut(self, piece: Index, inside: Array) -> Pieces:
        """The same with pieces cut at distances from their begins: its last points, no weight."""
        chosen, cuts = np.unique(piece, return_counts=True)
        owner, last = np.repeat(chosen, cuts + 1), np.cumsum(cuts + 1) - 1
        begin, end = np.zeros(owner.size), np.zeros(owner.size)
        middle = np.ones(owner.size, dtype=bool)
        middle[last] = False
        end[last], end[middle] = self.width[chosen], inside[np.lexsort((inside, piece))]
        begin[np.flatnonzero(middle) + 1] = end[middle]
        width = end - begin
        starts = Cut(self.begin.line[owner], self.begin.place[owner] + begin)
        at, weight = _gauss(starts, width)
        ends = Cut(self.begin.line[piece], (self.begin.place[piece] + inside) % 1.0)
        uncut = self.weight.copy()
        uncut.reshape(-1, _GAUSS)[chosen] = 0.0
        weight = np.concatenate((uncut, weight, np.zeros(piece.size)))
        return replace(self, at=Cut.joined((at, ends)), weight=weight, uncut=self)

    @property
    def points(self) -> Array:
        """Phases of the points (q, phases), but for those of the uncut pieces."""
        points = self.grid.points[self.grid.lines(self.axis)[self.at.line]]
        points[:, self.axis] = self.at.place
        return points

    @cached_property
    def between(self) -> csr_matrix:
        """Weights of the points of the refined lines in a motion at each point."""
        from scipy.sparse import vstack

        new = self.at_cuts
        return new if self.uncut is None else vstack((self.uncut.between, new), "csr")

    @cached_property
    def at_cuts(self) -> csr_matrix:
        """The same at the points that are none of the uncut pieces."""
        from scipy.sparse import csr_matrix

        count = _REFINED * self.grid.shape[self.axis]
        offsets = np.arange(_POINTS)
        first = np.floor(self.at.place * count)[:, None] - _POINTS // 2 + 1
        share = polynomial_shares(self.at.place[:, None] * count - first - offsets)
        columns = self.at.line[:, None] * count + (first + offsets).astype(np.int64) % count
        ends = np.arange(0, share.size + 1, _POINTS)
        size = len(share), _REFINED * self.grid.size
        return csr_matrix((share.reshape(-1), columns.reshape(-1), ends), size)

    def sample(self, values: Array) -> Array:
        """Values at the points (q, c) of a motion on the grid (p, c)."""
        return np.asarray(self.between @ self.refined(values))

    def refined(self, values: Array) -> Array:
        """Values on the refined lines of a motion on the grid (p, c)."""
        from scipy import fft

        count = self.grid.shape[self.axis]
        table = np.moveaxis(values.reshape(*self.grid.shape, -1), self.axis, -2)
        lines = fft.rfft(table, axis=-2)[..., : (count + 1) // 2, :]
        fine = fft.irfft(lines, _REFINED * count, axis=-2) * _REFINED
        return np.asarray(fine.reshape(-1, values.shape[1]))

    def gather(self, values: Array, times: int = 1) -> Array:
        """Motion on the grid (p, c) with the lines of values with their weights (q, c)."""
        # times: those of so many times the points along the phase
        from scipy import fft

        count, others = self.grid.shape[self.axis], np.delete(self.grid.shape, self.axis)
        table = (self.between.T @ values).reshape(*others, _REFINED * count, -1)
        count *= times
        lines = fft.rfft(table, axis=-2)[..., : (count + 1) // 2, :]
        coarse = np.moveaxis(fft.irfft(lines, count, axis=-2) * count, -2, self.axis)
        return np.asarray(coarse.reshape(times * self.grid.size, -1))


def _gauss(begin: Cut, width: Array) -> tuple[Cut, Array]:
    """Gauss's points of pieces, and their weights."""
    node, share = legendre.leggauss(_GAUSS)
    half = 0.5 * width[:, None]
    place = (begin.place[:, None] + half * (1.0 + node)) % 1.0
    return Cut(np.repeat(begin.line, _GAUSS), place.reshape(-1)), (half * share).reshape(-1)


class _Crossings(NamedTuple):
    """Places where a flank opens or closes."""

    piece: Index
    inside: Array  #: distances from the begins of the pieces
    contact: Index
    edge: Array  #: 1 or -1, the side of the dead zone
    slope: Array  #: derivative of the clearance by the phase

    @classmethod
    def none(cls) -> _Crossings:
        """No places."""
        index, none = np.zeros(0, dtype=np.int64), np.zeros(0)
        return cls(index, none, index, none, none)


@dataclass(frozen=True)
class PhaseContacts(ContactLaw):
    """The contacts of a part on a grid of phases."""

    part: PhaseRows
    bases: tuple[Array, Array]
    grid: PhaseGrid
    axis: int  #: phase of the meshes
    jumps: Cut  #: places where an entry jumps
    _opened: list[bool] = field(default_factory=list)  #: not empty once a motion opened a flank

    @classmethod
    def of(cls, rows: PhaseRows, structure: Any, grid: PhaseGrid, axis: int) -> PhaseContacts:
        """Contacts of a system with the bases of a structure."""
        inverse = structure.coordinates.inverse
        return cls(
            rows.system, with_dead_zone(rows.means.nodes), rows,
            (inverse.T @ structure.along, inverse.T @ structure.push), grid, axis,
            Cut.joined([_jumps(rows, grid, axis, mesh) for mesh in rows.meshes]),
        )  # fmt: skip

    @cached_property
    def rows(self) -> Rows:
        """Entries at the points of the grid."""
        return self.part.projected(self.grid.points, *self.bases).at(slice(None))

    @cached_property
    def _base(self) -> tuple[Pieces, PointRows]:
        """Pieces between the jumps of the entries, and the entries at their points."""
        pieces = Pieces.of(self.grid, self.axis, self.jumps, self.part.teeth(self.axis))
        return pieces, self.part.projected(pieces.points, *self.bases)

    def law(
        self, rows: Rows, frequency: float, y: Array, rate: Array, excess: Array,
        closed: Array | None = None,
    ) -> Law:  # fmt: skip
        """Contact forces at rows; those of supports with a clearance are all of a part."""
        law, supports = super().law(rows, frequency, y, rate, excess, closed), self.part.supports
        if closed is not None or not supports:
            return law
        springs = rows.stiffness[..., 0]
        force, tangent = clearance_forces(supports, law.compression)
        change = force - springs * law.compression
        tangent -= springs[..., None] * np.eye(springs.shape[1])
        push, along = rows.push[0], rows.along[0]
        return law._replace(
            contact=law.contact + change,
            force=law.force - change @ push,
            tangent=law.tangent._replace(supports=push.T @ tangent @ along),
        )

    def at(
        self, y: Array, rate: Array, excess: Array, closed: Array | None
    ) -> tuple[Law, Breaks, Pieces | None]:
        """Law of a motion (p, r) at the points of the grid, or of pieces where it breaks."""
        if not (self.jumps.line.size or self._opened):
            law = self.law(self.rows, 1.0, y, rate, excess, closed)
            if closed is not None or not self._opens(law):
                return law, NO_BREAKS, None
            self._opened.append(True)
        pieces, rows = self._base
        fine = [pieces.refined(part) for part in (y, rate)]
        moved = pieces.between @ fine[0], pieces.between @ fine[1]
        law, crossings = self._laws(pieces.width, rows, *moved, excess, closed)
        jumped = np.zeros((0, len(self.dead)))
        if crossings.piece.size:
            pieces = pieces.cut(crossings.piece, crossings.inside)
            rows = self.part.projected(pieces.points, *self.bases)
            moved = pieces.at_cuts @ fine[0], pieces.at_cuts @ fine[1]
            further, _ = self._laws(np.zeros(0), rows, *moved, excess, closed)
            ends = slice(rows.length - crossings.piece.size, rows.length)
            jumped = self._jumped(crossings, rows.at(ends), moved)
            law = _joined([law, further])
        weight, tangent = pieces.weight[:, None], law.tangent
        tangent = tangent._replace(
            stiffness=weight * tangent.stiffness, damping=weight * tangent.damping
        )
        tangent.stiffness[len(weight) - len(jumped) :] = jumped
        return law._replace(tangent=tangent), NO_BREAKS, pieces

    def _laws(
        self, width: Array, rows: PointRows, y: Array, rate: Array, excess: Array,
        closed: Array | None,
    ) -> tuple[Law, _Crossings]:  # fmt: skip
        """Law at points, a block of them at a time, and ends of dead zones in pieces of a width."""
        laws, crossings = [], [_Crossings.none()]
        for begin in range(0, rows.length, _BLOCK):
            some = slice(begin, begin + _BLOCK)
            entries = rows.at(some)
            laws.append(self.law(entries, 1.0, y[some], rate[some], excess, closed))
            if closed is None and width.size:
                first = begin // _GAUSS
                inside = width[first : first + _BLOCK // _GAUSS]
                crossings.append(self._crossings(first, inside, entries.gap, laws[-1].compression))
        joined = (np.concatenate(part) for part in zip(*crossings, strict=True))
        return _joined(laws), _Crossings(*joined)

    def bend(self, y: Array, rate: Array) -> bool:
        """Whether forces jump, or change their slope, along a motion (p, r) and its rate."""
        still = np.zeros(len(self.dead))
        return self.jumps.line.size > 0 or self._opens(self.law(self.rows, 1.0, y, rate, still))

    def _opens(self, law: Law) -> bool:
        """Whether a flank comes to another side of its dead zone."""
        gap = self.rows.gap
        sides = [(edge * law.compression[..., None] > gap) & self.dead for edge in (1.0, -1.0)]
        return any(bool(np.any(side != side[0])) for side in sides)

    def _crossings(self, first: int, width: Array, gaps: Array, compression: Array) -> _Crossings:
        """Ends of the dead zones, from the polynomials of the clearances over pieces."""
        # Ramps bend the force without a jump, which Gauss's rule bears.
        contact = np.flatnonzero(self.dead[:, 0])
        gap, distance = gaps[:, contact, 0], compression[:, contact]
        clearance = np.concatenate((distance - gap, -distance - gap), axis=1)
        node, share = legendre.leggauss(_GAUSS)
        degrees = np.arange(_GAUSS)
        into = (legendre.legvander(node, _GAUSS - 1) * share[:, None] * (degrees + 0.5)).T
        terms = into @ clearance.reshape(width.size, _GAUSS, 2 * contact.size)
        places = np.linspace(-1.0, 1.0, _INTERVALS + 1)
        closed = legendre.legvander(places, _GAUSS - 1) @ terms > 0.0
        piece, interval, column = np.nonzero(closed[:, 1:] != closed[:, :-1])
        chosen = terms[piece, :, column].T
        slopes = legendre.legder(chosen, axis=0)
        x = 0.5 * (places[interval] + places[interval + 1])
        for _ in range(_NEWTON):
            step = legendre.legval(x, chosen, False) / legendre.legval(x, slopes, False)
            x = np.clip(x - step, places[interval], places[interval + 1])
        half = 0.5 * width[piece]
        edge = np.where(column < contact.size, 1.0, -1.0)
        slope = legendre.legval(x, slopes, False) / half
        contact = contact[column % max(1, contact.size)]
        return _Crossings(first + piece, half * (1.0 + x), contact, edge, slope)

    def _jumped(self, crossings: _Crossings, rows: Rows, moved: tuple[Array, Array]) -> Array:
        """Stiffness of the contacts (b, c) where a damper begins or ceases to act."""
        each, contact = np.arange(crossings.contact.size), crossings.contact
        y, rate = (part[len(part) - each.size :] for part in moved)
        _, speed = rows.speed_of(contact, 1.0, y, rate)
        steady = self.system._damped_in_gap[contact]
        force = speed * np.where(steady, 0.0, of_contact(rows.nodes.damping, contact))
        stiffness = np.zeros((each.size, len(self.dead)))
        stiffness[each, contact] = crossings.edge * force / np.abs(crossings.slope)
        return stiffness


def _joined(parts: Sequence[Any]) -> Any:
    """Laws at points one after the other, with rows that all points have once."""
    first = parts[0]
    if isinstance(first, tuple):
        return type(first)(*map(_joined, zip(*parts, strict=True)))
    return first if first is None or len(first) == 1 else np.concatenate(parts)


def axis_of(cycles: Array) -> int:
    """Phase over which a mesh has the fewest cycles, but some."""
    return int(np.argmin(np.where(cycles == 0.0, np.inf, np.abs(cycles))))


def _jumps(rows: PhaseRows, grid: PhaseGrid, axis: int, mesh: Mesh) -> Cut:
    """Places where a mesh passes its jumps, on every line along its phase."""
    start = grid.points[grid.lines(axis)]
    turns = mesh.cycles[axis]
    mesh_phase = start @ mesh.cycles + mesh.offset
    if rows.system.lead is not None:  # it is a function of other phases
        mesh_phase = mesh_phase + rows.rate(mesh.cycles) * rows.system.lead(start)[0]
    cycles = np.arange(int(abs(turns)))
    at = (mesh.jumps[:, None, None] - mesh_phase[:, None] + cycles) / turns % 1.0 % 1.0
    lines = np.broadcast_to(np.arange(len(start))[:, None], at.shape)
    return Cut(lines.reshape(-1), at.reshape(-1))
