"""Residual of a motion at the contacts, on one clock or over several phases.

The residual is the motion less the response of the closed structure to the forces that this motion
causes: forces at points of the phases, responses at the lines of their Fourier series. Contacts
that follow the same phases are a part with a grid of its own, on one clock all of them; parts are
coupled by the lines that both of their grids have.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import permutations
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.harmonic.newton import LINEAR, VECTORS, State, force_change, solve_linear
from tribodyn.dynamics.harmonic.phase_contacts import PhaseContacts, Pieces
from tribodyn.dynamics.harmonic.phase_grid import PhaseGrid
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.contact_equations import ContactEquations, Law, outer
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Bytes of the vectors of a linear solution, and the fewest of them.
_MEMORY, _FEWEST = 2**29, 30
#: Residual over the size of the motion that is rounding.
_ROUNDING = 3e-14
#: States of a structure from which plain products cost less than its march, and most of them.
_LARGE, _PLAIN = 100, 24


class OnGrid(NamedTuple):
    """Contacts of a closed structure on a grid of the phases."""

    structure: Any  #: closed structure, or the part of one with these contacts
    grid: PhaseGrid
    contacts: PhaseContacts | ContactEquations
    receptances: ComplexArray  #: of their own forces (k, r, s); zero where lines have no sign
    slope: ComplexArray  #: derivative of each line by time (k, 1)
    loaded: ComplexArray  #: lines of the motion under external forces that act apart (k or 1, r)
    members: Index  #: numbers of the contacts in the system
    closed: Array  #: sides of springs that are closed at rest, 0 of others
    floating: Mask  #: contacts that carry nothing at rest

    @classmethod
    def of(
        cls, structure: Any, grid: PhaseGrid, contacts: PhaseContacts | ContactEquations,
        loaded: ComplexArray, members: Index, closed: Array, floating: Mask,
        receptances: ComplexArray | None = None,
    ) -> OnGrid:  # fmt: skip
        """Contacts with the receptances at the lines of their grid."""
        receptances = structure.receptances(grid.omega) if receptances is None else receptances
        receptances[grid.unpaired] = 0.0
        slope = np.where(grid.unpaired, 0.0, 1j * grid.omega)[:, None]
        return cls(structure, grid, contacts, receptances, slope, loaded, members, closed, floating)

    def rate(self, y: Array) -> Array:
        """Derivative of a motion (p, r) by time."""
        return self.grid.values(self.slope * self.grid.spectrum(y))

    def at(self, y: Array, excess: Array, closed: bool) -> State:
        """Forces of a motion (p, r), without its residual."""
        rate, springs = self.rate(y), self.closed if closed else None
        law, breaks, pieces = self.contacts.at(y, rate, excess, springs)
        law = law._replace(force=self.integral(law.force, pieces))
        force = law.force + y @ self.structure.contact_stiffness.T
        force += rate @ self.structure.contact_damping.T
        breaks.scatter(force, breaks.correction)
        return State(y, rate, law, breaks, force, y, pieces, self._mean_stiffness(law))

    def _mean_stiffness(self, law: Law) -> Array | None:
        """Stiffness (s, r) that holds the mean place of bodies which nothing holds in a motion."""
        open_throughout = self.floating & law.open.all(axis=0)
        if not open_throughout.any():
            return None
        rows = self.contacts.rows
        stiffness = np.where(open_throughout, rows.stiffness[..., 0], 0.0)
        return np.asarray(outer(rows.push, stiffness, rows.along).mean(axis=0))

    @staticmethod
    def integral(values: Array, pieces: Pieces | None) -> Array:
        """Values at the points of the grid from those of a law."""
        return values if pieces is None else pieces.gather(pieces.weight[:, None] * values)


class _Link(NamedTuple):
    """How the forces of a part move another one."""

    into: Index  #: places of the common lines in the grid of the first
    of: Index  #: and of the second
    receptances: ComplexArray


class Residual:
    """Residual of a motion, whose parts are joined in one column if there are several."""

    structure: ClosedStructure
    links: dict[tuple[int, int], _Link]
    plain = False  #: whether a few products without an approximate inverse are tried first

    def __init__(self, parts: Sequence[OnGrid], prior: Residual | None = None) -> None:
        self.parts = list(parts)
        before = [] if prior is None else prior.parts
        links = {} if prior is None else prior.links
        reused = {
            n for n, (part, old) in enumerate(zip(parts, before, strict=False)) if part is old
        }
        self.links = {
            pair: links[pair] if reused.issuperset(pair) else self._link(*pair)
            for pair in permutations(range(len(parts)), 2)
        }
        self.ends = np.cumsum([0, *(part.grid.size * part.receptances.shape[1] for part in parts)])
        self.excess = np.zeros(sum(part.members.size for part in parts))  #: added damping [N*s/m]

    def _link(self, to: int, by: int) -> _Link:
        first, second = self.parts[to], self.parts[by]
        into, of = first.grid.common(second.grid)
        matrices = first.structure.receptances(first.grid.omega[into], second.structure.push)
        return _Link(into, of, matrices)

    def split(self, y: Array) -> list[Array]:
        """Motions (p, r) of the parts."""
        if len(self.parts) == 1:
            return [y]
        pieces = np.split(y.reshape(-1), self.ends[1:-1])
        return [piece.reshape(part.grid.size, -1)
                for piece, part in zip(pieces, self.parts, strict=True)]  # fmt: skip

    @staticmethod
    def joined(parts: Sequence[Array]) -> Array:
        """Motions of the parts, of several in one column."""
        if len(parts) == 1:
            return parts[0]
        return np.concatenate([part.reshape(-1) for part in parts])[:, None]

    def responses(
        self, forces: Sequence[Array | None], loaded: bool = False, of: Sequence[int] | None = None
    ) -> list[Array]:
        """Motions of parts, all by default, under the forces (p, s) of some, and the load."""
        lines = [None if force is None else part.grid.spectrum(force)
                 for part, force in zip(self.parts, forces, strict=True)]  # fmt: skip
        chosen = range(len(self.parts)) if of is None else of
        return [self.response(to, lines, loaded) for to in chosen]

    def response(
        self, to: int, lines: Sequence[ComplexArray | None], loaded: bool = False
    ) -> Array:
        """Motion of a part under the lines of the forces of some, and the load."""
        part, driving = self.parts[to], lines[to]
        if driving is None:
            moved = np.zeros(part.receptances.shape[:2], dtype=complex)
        else:
            moved = (part.receptances @ driving[..., None])[..., 0]
        if loaded:
            moved[: len(part.loaded)] += part.loaded
        for by, pushing in enumerate(lines):
            if by != to and pushing is not None:
                link = self.links[to, by]
                pushed = pushing[link.of, :, None]
                moved[link.into] += (link.receptances @ pushed)[..., 0]
        return part.grid.values(moved)

    def at(self, y: Array, closed: bool = False) -> State:
        """Evaluate a motion; ``closed`` fixes the springs to those that are closed at rest."""
        states = [
            part.at(piece, self.excess[part.members], closed)
            for part, piece in zip(self.parts, self.split(y), strict=True)
        ]
        moved = self.responses([state.force for state in states], loaded=True)
        states = [
            state._replace(residual=state.y - motion)
            for state, motion in zip(states, moved, strict=True)
        ]
        if len(states) == 1:
            return states[0]
        residual = self.joined([state.residual for state in states])
        return states[0]._replace(y=y, residual=residual, parts=tuple(states))

    def changes(self, state: State) -> list[Callable[[Array], Array]]:
        """Change of the forces of each part with its motion."""
        pairs = zip(self.parts, state.each, strict=True)
        return [force_change(part, each) for part, each in pairs]

    def derivative(self, state: State) -> Callable[[Array], Array]:
        """Product of the derivative of the residual with a motion."""
        changes = self.changes(state)

        def product(motion: Array) -> Array:
            pieces = zip(changes, self.split(motion), strict=True)
            forces = [change(piece) for change, piece in pieces]
            return motion - self.joined(self.responses(forces))

        return product

    def accuracy(self, norms: list[float]) -> float:
        """Accuracy of the linear solution after steps that left residuals of these norms."""
        return LINEAR

    def nearly(self, state: State) -> Callable[[Array], Array] | None:
        """Product with an approximate inverse of the derivative, if there is one."""
        return None

    def preconditioned(self, state: State) -> tuple[Callable[[Array], Array], ...]:
        """The derivative after an approximate inverse, and this; none without one."""
        product, nearly = self.derivative(state), self.nearly(state)
        return (product,) if nearly is None else (lambda x: product(nearly(x)), nearly)

    def correction(
        self, state: State, accuracy: float = LINEAR, most: int = VECTORS
    ) -> tuple[Array, int]:
        """Newton step of a motion, and the number of products, of ``most``, that it took."""
        if np.linalg.norm(state.residual, axis=1).max(initial=0.0) <= _ROUNDING * state.size:
            return -state.residual, 0  # rounding: a body that nothing holds would magnify it
        if self.plain:
            step, count = solve_linear(self.derivative(state), -state.residual, accuracy, _PLAIN)
            if count < _PLAIN:
                return step, count
            self.plain = False
        vectors = min(int(np.clip(_MEMORY // state.y.nbytes, _FEWEST, VECTORS)), most)
        product, *nearly = self.preconditioned(state)
        solution, count = solve_linear(product, -state.residual, accuracy, vectors)
        return (nearly[0](solution) if nearly else solution), count


class ClockResidual(Residual):
    """Residual of a periodic motion at one frequency of the clock."""

    def __init__(
        self, structure: ClosedStructure, contacts: ContactEquations, frequency: float,
        closed: Array, floating: Mask, finer: ClockResidual | None = None,
    ) -> None:  # fmt: skip
        grid = PhaseGrid((contacts.steps,), np.array([frequency]))
        known = None if finer is None else finer.parts[0].receptances[: grid.omega.size].copy()
        if finer is None:
            structure.refuse_resonance(grid.omega)
        still, members = np.zeros((1, structure.along.shape[1]), complex), np.arange(len(closed))
        self.structure, self.contacts, self.frequency = structure, contacts, frequency
        self.plain = len(structure.matrix) >= _LARGE
        contacts = contacts.turning(frequency)
        places = still, members, closed, floating
        super().__init__([OnGrid.of(structure, grid, contacts, *places, known)])

    @cached_property
    def omega(self) -> Array:
        """Angular frequencies of the harmonics [rad/s]."""
        return self.parts[0].grid.omega

    def rate(self, y: Array) -> Array:
        """Derivative of a motion (steps, r) by time."""
        return self.parts[0].rate(y)

    def nearly(self, state: State) -> Callable[[Array], Array] | None:
        """Time integration of the linearized equations over a period."""
        if self.structure.modes is None:
            return None
        from tribodyn.dynamics.harmonic.tangent_march import TangentMarch

        march = TangentMarch.of(self, state)
        return lambda motion: march(motion, self.rate(motion))
