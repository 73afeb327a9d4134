"""Residual of a motion over several phases, in which the contacts of each mesh have their own grid.

A mesh needs many points over its own phase, at which its teeth change, but few over the phases of
others, which reach it through the structure. Contacts that follow the same phases are a part, with
a grid that is fine over these and coarse over the others. Parts are coupled by the lines that both
of their grids have.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import permutations
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.meshwise_inverse import MeshwiseInverse
from tribodyn.dynamics.harmonic.newton import (
    LINEAR,
    VECTORS,
    Residual,
    State,
    force_change,
    solve_linear,
)
from tribodyn.dynamics.harmonic.phase_contacts import Cell, PhaseContacts, axis_of
from tribodyn.dynamics.harmonic.phase_grid import PhaseGrid
from tribodyn.dynamics.harmonic.phase_rows import PhaseRows
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.contact_equations import NO_BREAKS, close_contacts
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Bytes of the vectors of a linear solution, and the fewest of them.
_MEMORY, _FEWEST = 2**29, 30
#: Vectors of a linear solution up to which an approximate inverse serves for the next one.
_SERVES = 12
#: Largest part of a residual that a linear solution leaves.
_LOOSE = 0.1


@dataclass(frozen=True, eq=False)
class Part:
    """Contacts that follow the same phases, in a structure with all contacts closed."""

    rows: PhaseRows
    members: Index  #: numbers of the contacts in the system
    axes: frozenset[int]  #: phases that they follow
    axis: int  #: that of their meshes
    structure: ClosedStructure
    along: Array  #: basis of compressions in coordinates of unit mass (n, r)
    push: Array  #: basis of forces (n, s)
    contact_stiffness: Array  #: means of these contacts (s, r) [1/s^2]
    contact_damping: Array
    closed: Mask  #: springs that are closed at rest

    @property
    def coordinates(self) -> Any:
        """Coordinates of the structure."""
        return self.structure.coordinates

    def receptances(self, omega: Array, push: Array | None = None) -> ComplexArray:
        """Motions of the part per force, its own by default (k, r, s); the first line is zero."""
        return self.structure.receptances(omega, self.along, self.push if push is None else push)


def parts_of(
    system: System, frequency: Array, structure: ClosedStructure, start: Array
) -> list[Part]:
    """Divide a system into the contacts that follow the same phases, and close them all."""
    groups: dict[tuple[frozenset[int], int], list[int]] = {}
    for number, contact in enumerate(system.contacts):
        cycles = [contact.cycles, *(term.cycles for term in contact.turning)]
        axes = frozenset(np.flatnonzero(np.any(np.array(cycles) != 0, axis=0)).tolist())
        groups.setdefault((axes, axis_of(np.array(contact.cycles))), []).append(number)
    parts = []
    for key, numbers in groups.items():
        place = {number: at for at, number in enumerate(numbers)}
        frictions = [
            replace(each, contacts=tuple(place[j] for j in each.contacts))
            for each in system.frictions
            if each.contacts[0] in place
        ]
        contacts = [system.contacts[number] for number in numbers]
        alone = replace(
            system, contacts=contacts, frictions=frictions, force=np.zeros(system.size),
            balance=None,
        )  # fmt: skip
        rows = PhaseRows.of(alone, frequency)
        none = np.zeros((0, system.size))
        law, closed = close_contacts(rows.means, none, start, structure.coordinates)
        means = law.along, law.push, law.contact_stiffness, law.contact_damping
        parts.append(Part(rows, np.array(numbers), *key, structure, *means, closed))
    push, along = structure.push, structure.along
    stiffness, damping = (
        sum(push.T @ part.push @ getattr(part, name) @ part.along.T @ along for part in parts)
        for name in ("contact_stiffness", "contact_damping")
    )
    joined = ClosedStructure(system, structure.coordinates, push, along, stiffness, damping)
    return [replace(part, structure=joined) for part in parts]


class OnGrid(NamedTuple):
    """A part on its grid."""

    structure: Part
    grid: PhaseGrid
    contacts: PhaseContacts
    receptances: ComplexArray  #: of its own forces (k, r, s); zero where lines have no sign
    slope: ComplexArray  #: derivative of each line by time (k, 1)
    loaded: ComplexArray  #: lines of the motion under the external force (k, r)

    @classmethod
    def of(cls, part: Part, grid: PhaseGrid, force: Callable[[Array], Array]) -> OnGrid:
        """Sample a part under external forces, a function of the points."""
        contacts = PhaseContacts.of(part.rows, part, grid, part.axis)
        structure, numbers = part.structure, grid.numbers
        structure.refuse_resonance(grid.omega, lambda k: f"the line {numbers[k]} of the phases")
        receptances = part.receptances(grid.omega)
        receptances[grid.unpaired] = 0.0
        slope = np.where(grid.unpaired, 0.0, 1j * grid.omega)[:, None]
        loads = force(grid.points) @ structure.coordinates.inverse.T @ structure.push
        loaded = np.zeros((len(grid.omega), part.along.shape[1]), dtype=complex)
        count = 1 if len(loads) == 1 else len(loaded)
        lines = loads.astype(complex) if count == 1 else grid.spectrum(loads) / grid.size
        response = part.receptances(grid.omega[:count], structure.push)
        loaded[:count] = (response @ lines[..., None])[..., 0]
        loaded[grid.unpaired] = 0.0
        return cls(part, grid, contacts, receptances, slope, loaded)

    def rate(self, y: Array) -> Array:
        """Derivative of a motion (p, r) by time."""
        return self.grid.values(self.slope * self.grid.spectrum(y))

    def at(self, y: Array, excess: Array, closed: bool) -> State:
        """Forces of a motion (p, r), without its residual."""
        rate, springs = self.rate(y), self.structure.closed if closed else None
        means = self.structure.contact_stiffness, self.structure.contact_damping
        law, cell = self.contacts.at(y, rate, excess, springs, means)
        force = y @ means[0].T + rate @ means[1].T + self.integral(law.force, cell)
        return State(y, rate, law, NO_BREAKS, force, y, cell)

    @staticmethod
    def integral(values: Array, cell: Cell | None) -> Array:
        """Values at the points of the grid from those of a law."""
        if cell is None:
            return values
        return cell.pieces.gather(cell.pieces.weight[:, None] * values)


class _Link(NamedTuple):
    """How the forces of a part move another one."""

    into: Index  #: places of the common lines in the grid of the first
    of: Index  #: and of the second
    receptances: ComplexArray


class PhaseResidual(Residual):
    """Residual of a motion over several phases, whose parts are joined in one column."""

    links: dict[tuple[int, int], _Link]
    inverses: dict[int, MeshwiseInverse]  #: of the parts at their last states, while they serve

    def __init__(
        self,
        parts: Sequence[Part],
        grids: Sequence[PhaseGrid],
        force: Callable[[Array], Array],
        prior: PhaseResidual | None = None,
    ) -> None:
        self.structure = parts[0].structure
        self.frequency = 1.0
        same = {} if prior is None else {(id(p.structure), p.grid.shape): p for p in prior.parts}
        self.parts: list[OnGrid] = [
            same.get((id(part), grid.shape)) or OnGrid.of(part, grid, force)
            for part, grid in zip(parts, grids, strict=True)
        ]
        links = {} if prior is None else prior.links
        before = [None] * len(parts) if prior is None else prior.parts
        reused = {n for n, part in enumerate(self.parts) if part is before[n]}
        self.links = {
            pair: links[pair] if reused.issuperset(pair) else self._link(*pair)
            for pair in permutations(range(len(parts)), 2)
        }
        widths = [grid.size * part.along.shape[1] for part, grid in zip(parts, grids, strict=True)]
        self.ends = np.cumsum([0, *widths])
        old = {} if prior is None else prior.inverses
        self.inverses = {id(part): old[id(part)] for part in self.parts if id(part) in old}
        self.excess = np.zeros(1)  #: additional damping of all contacts [N*s/m]

    def _link(self, to: int, by: int) -> _Link:
        first, second = self.parts[to], self.parts[by]
        numbers = first.grid.common(second.grid)
        into, of = first.grid.places(numbers), second.grid.places(numbers)
        matrices = first.structure.receptances(first.grid.omega[into], second.structure.push)
        return _Link(into, of, matrices)

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return int(self.ends[-1])

    def split(self, y: Array) -> list[Array]:
        """Motions (p, r) of the parts."""
        pieces = np.split(y.reshape(-1), self.ends[1:-1])
        return [piece.reshape(part.grid.size, -1)
                for piece, part in zip(pieces, self.parts, strict=True)]  # fmt: skip

    @staticmethod
    def joined(parts: Sequence[Array]) -> Array:
        """Motions of the parts in one column."""
        return np.concatenate([part.reshape(-1) for part in parts])[:, None]

    def refined(self, y: Array, finer: PhaseResidual) -> Array:
        """A motion on the grids of another residual of the same parts."""
        return self.joined([
            part.grid.refined(piece, other.grid)
            for part, other, piece in zip(self.parts, finer.parts, self.split(y), strict=True)
        ])  # fmt: skip

    def responses(
        self, forces: Sequence[Array | None], loaded: bool = False, of: Sequence[int] | None = None
    ) -> list[Array]:
        """Motions of parts, all by default, under the forces (p, s) of some, and the load."""
        lines = [None if force is None else part.grid.spectrum(force) / part.grid.size
                 for part, force in zip(self.parts, forces, strict=True)]  # fmt: skip
        motions = []
        for to in range(len(self.parts)) if of is None else of:
            part, own = self.parts[to], lines[to]
            moved = part.loaded.copy() if loaded else np.zeros_like(part.loaded)
            if own is not None:
                moved += (part.receptances @ own[..., None])[..., 0]
            for by, pushing in enumerate(lines):
                if by != to and pushing is not None:
                    link = self.links[to, by]
                    pushed = pushing[link.of, :, None]
                    moved[link.into] += (link.receptances @ pushed)[..., 0]
            motions.append(part.grid.values(moved * part.grid.size))
        return motions

    def at(self, y: Array, closed: Any = None) -> State:
        """Evaluate a motion; ``closed`` fixes the springs to those that are closed at rest."""
        excess = np.broadcast_to(self.excess, sum(len(p.structure.members) for p in self.parts))
        states = [
            part.at(piece, excess[part.structure.members], bool(closed))
            for part, piece in zip(self.parts, self.split(y), strict=True)
        ]
        moved = self.responses([state.force for state in states], loaded=True)
        states = [
            state._replace(residual=state.y - motion)
            for state, motion in zip(states, moved, strict=True)
        ]
        residual = self.joined([state.residual for state in states])
        first = states[0]
        return State(
            y, first.rate, first.law, first.breaks, first.force, residual, None, tuple(states)
        )  # fmt: skip

    def derivative(self, state: State) -> Callable[[Array], Array]:
        """Product of the derivative of the residual with a motion."""
        pairs = list(zip(self.parts, state.parts, strict=True))
        changes = [force_change(part.structure, each) for part, each in pairs]

        def product(motion: Array) -> Array:
            triples = zip(changes, self.split(motion), self.parts, strict=True)
            forces = [change(piece, part.rate) for change, piece, part in triples]
            return motion - self.joined(self.responses(forces))

        return product

    def accuracy(self, norms: list[float]) -> float:
        """Accuracy of the linear solution after steps that left residuals of these norms."""
        # Source: Eisenstat and Walker (1996), SIAM J. Sci. Comput. 17, 16, choice 2.
        fell = norms[-1] / norms[-2] if len(norms) > 1 else 1.0
        return float(np.clip(0.9 * fell**2, LINEAR, _LOOSE))

    def change(self, coarser: PhaseResidual, state: State, number: int) -> Array:
        """Estimate the change of a solution with more points of one part."""
        part, old, states = self.parts[number], coarser.parts[number], state.parts
        forces: list[Array | None] = [each.force for each in states]
        before = forces[number] = old.grid.refined(states[number].force, part.grid)
        y = self.responses(forces, loaded=True, of=[number])[0]
        none = np.zeros(len(part.structure.members))
        further: list[Array | None] = [None] * len(states)
        further[number] = part.at(y, none, closed=False).force - before
        right = self.responses(further)
        # The new lines as they are, the lines of before by their approximate inverse.
        inverses = coarser.inverses_at(state)
        low = part.grid.refined(right[number], old.grid)
        felt = inverses[number](low) - low
        changes = [
            each + old.grid.refined(felt, part.grid) if n == number else inverse(each)
            for n, (inverse, each) in enumerate(zip(inverses, right, strict=True))
        ]
        return self.joined(changes)

    def inverses_at(self, state: State) -> list[MeshwiseInverse]:
        """Approximate inverse of the derivative for each part alone, as long as it serves."""
        for part, each in zip(self.parts, state.parts, strict=True):
            if id(part) not in self.inverses:
                self.inverses[id(part)] = MeshwiseInverse(part, each)
        return [self.inverses[id(part)] for part in self.parts]

    def nearly(self, state: State) -> Callable[[Array], Array]:
        """Product with an approximate inverse of the derivative: that of each part alone."""
        inverses = self.inverses_at(state)

        def product(right: Array) -> Array:
            return self.joined(
                [inverse(piece) for inverse, piece in zip(inverses, self.split(right), strict=True)]
            )

        return product

    def _corrected(self, state: State, accuracy: float) -> tuple[Array, int]:
        vectors = int(np.clip(_MEMORY // state.y.nbytes, _FEWEST, VECTORS))
        product, nearly = self.derivative(state), self.nearly(state)
        solution, count = solve_linear(
            lambda x: product(nearly(x)), -state.residual, accuracy, vectors
        )
        step = nearly(solution)
        if count > _SERVES:
            self.inverses.clear()
        return step, count
