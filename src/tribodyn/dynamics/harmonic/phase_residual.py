"""Residual of a motion over several phases, in which the contacts of each mesh have their own grid.

A mesh needs many points over its own phase, at which its teeth change, but few over the phases of
others, which reach it through the structure. Contacts that follow the same phases are a part, with
a grid that is fine over these and coarse over the others. Parts are coupled by the lines that both
of their grids have.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.orbit_coordinates import OverBases, Rest
from tribodyn.dynamics.harmonic.meshwise_inverse import MeshwiseInverse
from tribodyn.dynamics.harmonic.newton import LINEAR, VECTORS, State
from tribodyn.dynamics.harmonic.phase_contacts import PhaseContacts, axis_of
from tribodyn.dynamics.harmonic.phase_grid import PhaseGrid
from tribodyn.dynamics.harmonic.phase_rows import Mesh, PhaseRows
from tribodyn.dynamics.harmonic.residual import OnGrid, Residual
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.contact_equations import close_contacts
from tribodyn.types import Array, ComplexArray, Index, Mask

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
    closed: Array  #: sides of springs that are closed at rest, 0 of others
    floating: Mask  #: contacts that carry nothing at rest

    @property
    def coordinates(self) -> Any:
        """Coordinates of the structure."""
        return self.structure.coordinates

    @cached_property
    def compressions(self) -> Array:
        """Mean compressions of the contacts per motion (contacts, r)."""
        nodes, along = self.rows.means.nodes, self.coordinates.inverse.T @ self.along
        return np.asarray(np.einsum("rs,rscn->cn", nodes.weight, nodes.direction) @ along)

    def receptances(self, omega: Array, push: Array | None = None) -> ComplexArray:
        """Motions of the part per force, its own by default (k, r, s); the first line is zero."""
        return self.structure.receptances(omega, self.along, self.push if push is None else push)

    def on_grid(self, grid: PhaseGrid, force: Callable[[Array], Array]) -> OnGrid:
        """Sample the part under external forces, a function of the points."""
        numbers, structure = grid.numbers, self.structure
        structure.refuse_resonance(grid.omega, lambda k: f"the line {numbers[k]} of the phases")
        loads = force(grid.points) @ structure.coordinates.inverse.T @ structure.push
        lines = grid.spectrum(loads) if len(loads) > 1 else loads.astype(complex)
        omega = grid.omega[: len(lines)]
        loaded = (self.receptances(omega, structure.push) @ lines[..., None])[..., 0]
        loaded[grid.unpaired[: len(lines)]] = 0.0
        contacts = PhaseContacts.of(self.rows, self, grid, self.axis)
        return OnGrid.of(self, grid, contacts, loaded, self.members, self.closed, self.floating)


def parts_of(rows: PhaseRows, structure: ClosedStructure, equilibrium: Rest) -> list[Part]:
    """Divide a system into the contacts that follow the same phases, and close them all."""
    groups: dict[tuple[frozenset[int], int], list[Mesh]] = {}
    for mesh in rows.meshes:
        groups.setdefault((mesh.axes, axis_of(mesh.cycles)), []).append(mesh)
    parts = []
    for key, meshes in groups.items():
        some, members = rows.some(meshes), np.sort(np.concatenate([m.contacts for m in meshes]))
        resting = equilibrium._replace(floating=equilibrium.floating[members])
        narrow = OverBases.of(some.means, None, structure.coordinates)
        law, closed = close_contacts(narrow, resting)
        means = law.along, law.push, law.contact_stiffness, law.contact_damping
        parts.append(Part(some, members, *key, structure, *means, closed, resting.floating))
    push, along = structure.push, structure.along
    stiffness, damping = (
        sum(push.T @ part.push @ getattr(part, name) @ part.along.T @ along for part in parts)
        for name in ("contact_stiffness", "contact_damping")
    )
    joined = ClosedStructure(rows.system, structure.coordinates, push, along, stiffness, damping)
    return [replace(part, structure=joined) for part in parts]


class PhaseResidual(Residual):
    """Residual of a motion over several phases."""

    inverses: dict[int, MeshwiseInverse]  #: of the parts at their last states, while they serve

    def __init__(
        self,
        parts: Sequence[Part],
        grids: Sequence[PhaseGrid],
        force: Callable[[Array], Array],
        prior: PhaseResidual | None = None,
    ) -> None:
        self.structure = parts[0].structure
        same = {} if prior is None else {(id(p.structure), p.grid.shape): p for p in prior.parts}
        super().__init__(
            [
                same.get((id(part), grid.shape)) or part.on_grid(grid, force)
                for part, grid in zip(parts, grids, strict=True)
            ],
            prior,
        )
        old = {} if prior is None else prior.inverses
        self.inverses = {id(part): old[id(part)] for part in self.parts if id(part) in old}

    def refined(self, y: Array, finer: PhaseResidual) -> Array:
        """A motion on the grids of another residual of the same parts."""
        return self.joined([
            part.grid.refined(piece, other.grid)
            for part, other, piece in zip(self.parts, finer.parts, self.split(y), strict=True)
        ])  # fmt: skip

    def bends(self, state: State) -> bool:
        """Whether forces jump, or change their slope, along a motion."""
        return any(
            isinstance(part.contacts, PhaseContacts) and part.contacts.bend(each.y, each.rate)
            for part, each in zip(self.parts, state.each, strict=True)
        )

    def extent(self, y: Array) -> float:
        """Size of the largest compression in a motion."""
        pairs = zip(self.parts, self.split(y), strict=True)
        each = (piece @ part.structure.compressions.T for part, piece in pairs)
        return float(max(np.abs(compression).max(initial=0.0) for compression in each))

    def accuracy(self, norms: list[float]) -> float:
        """Accuracy of the linear solution after steps that left residuals of these norms."""
        # Source: Eisenstat and Walker (1996), SIAM J. Sci. Comput. 17, 16, choice 2.
        fell = norms[-1] / norms[-2] if len(norms) > 1 else 1.0
        return float(np.clip(0.9 * fell**2, LINEAR, _LOOSE))

    def change(self, coarser: PhaseResidual, state: State, number: int) -> float:
        """Estimate the largest change of a compression with more points of one part."""
        part, old, states = self.parts[number], coarser.parts[number], state.each
        forces: list[Array | None] = [each.force for each in states]
        before = forces[number] = old.grid.refined(states[number].force, part.grid)
        y = self.responses(forces, loaded=True, of=[number])[0]
        further = part.at(y, np.zeros(part.members.size), closed=False).force - before
        lines = part.grid.spectrum(further)
        lines[part.grid.unpaired] = 0.0
        # The new lines as they are, those of before by their approximate inverse.
        driven: list[Array | None] = [None] * len(states)
        driven[number] = part.grid.refined(further, old.grid)
        right = coarser.joined(coarser.responses(driven))
        felt = coarser.split(coarser.nearly(state)(right) - right)
        largest = 0.0
        for n, other in enumerate(coarser.parts):
            gains = part.receptances
            if n != number:
                gains = other.structure.receptances(part.grid.omega, part.structure.push)
            motion = part.grid.values((gains @ lines[..., None])[..., 0])
            motion += other.grid.refined(felt[n], part.grid)
            compression = motion @ other.structure.compressions.T
            largest = max(largest, float(np.abs(compression).max(initial=0.0)))
        return largest

    def inverses_at(self, state: State) -> list[MeshwiseInverse]:
        """Approximate inverse of the derivative for each part alone, as long as it serves."""
        for part, each in zip(self.parts, state.each, strict=True):
            if id(part) not in self.inverses:
                self.inverses[id(part)] = MeshwiseInverse(part, each)
        return [self.inverses[id(part)] for part in self.parts]

    def nearly(self, state: State) -> Callable[[Array], Array]:
        """Product with an approximate inverse of the derivative."""
        return self.preconditioned(state)[1]

    def preconditioned(self, state: State) -> tuple[Callable[[Array], Array], ...]:
        """The derivative after the inverses of the parts alone, one after the other, and these."""
        # Each part feels the forces of those before it, which the derivative takes over.
        inverses, changes = self.inverses_at(state), self.changes(state)

        def inverted(right: Array) -> tuple[list[Array], list[Array]]:
            lines: list[ComplexArray | None] = [None] * len(self.parts)
            motions, products = [], []
            for number, (part, piece) in enumerate(zip(self.parts, self.split(right), strict=True)):
                felt = self.response(number, lines) if number else np.zeros(1)
                motions.append(inverses[number](piece + felt))
                lines[number] = part.grid.spectrum(changes[number](motions[-1]))
                products.append(motions[-1] - felt)
            for number, left in enumerate(products):
                left -= self.response(number, lines)
                lines[number] = None
            return motions, products

        return (
            lambda right: self.joined(inverted(right)[1]),
            lambda right: self.joined(inverted(right)[0]),
        )

    def correction(
        self, state: State, accuracy: float = LINEAR, most: int = VECTORS
    ) -> tuple[Array, int]:
        """Newton step of a motion, and the number of products, of ``most``, that it took."""
        step, count = super().correction(state, accuracy, most)
        if count > _SERVES:
            self.inverses.clear()
        return step, count
