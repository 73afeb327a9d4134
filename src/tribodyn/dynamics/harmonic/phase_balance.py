"""Motion of a machine over several independent phases, by harmonic balance at its contacts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.checks import require_whole
from tribodyn.dynamics.equations.orbit_coordinates import (
    orbit_coordinates,
    refuse_disconnected,
    static_start,
)
from tribodyn.dynamics.equations.phases import read_frequencies
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.newton import Solution, newton
from tribodyn.dynamics.harmonic.phase_grid import PhaseContacts, PhaseGrid, PhaseResidual
from tribodyn.dynamics.harmonic.phase_response import PhaseResponse, phase_response
from tribodyn.dynamics.harmonic.phase_rows import PhaseRows
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.contact_equations import close_contacts
from tribodyn.errors import InputError, warn
from tribodyn.types import Array, Index, Mask

#: Points over a phase of meshes, and over one that only turns shafts, with which an automatic
#: choice starts, and those with which it tries at last to find a motion.
_MESH, _SHAFT, _LAST = 16, 8, 64
#: Change of the motion with twice the points at which an automatic choice stops: the first while it
#: falls to less than this part from grid to grid, the second where forces that bend or jump make it
#: fall slowly or the points are many; and the most points.
_ACCURATE, _FALLING, _ENOUGH, _MANY, _MOST = 2e-7, 0.1, 1e-3, 2**14, 2**17
#: Step error that causes a warning; part of the largest change with which a phase is refined too.
_LIMIT, _WORST = 1e-2, 0.2
#: Damping added at first where Newton's method does not converge, over the critical damping at
#: the highest mesh frequency, and the factors by which it is reduced; Newton steps with each.
_ADDED, _TRIES = (0.3, 0.1, 0.03, 0.01, 0.003), 12
#: Newton steps in which the error halves if the points suffice, and part of the largest change with
#: twice the points from which a phase matters.
_PATIENCE, _MATTER = 5, 0.01


@dataclass
class _Search:
    """A system over several phases with what does not depend on the grid."""

    rows: PhaseRows
    structure: ClosedStructure
    closed: Mask
    still: Array  #: motion at the contacts at rest (r,)

    @classmethod
    def of(cls, system: System, frequency: Array) -> _Search:
        rows = PhaseRows.of(system, frequency)
        means = rows.means
        refuse_disconnected(means)
        orbit_coordinates(means, float(frequency.max()))  # warns of forces that do not balance
        start = static_start(means)[: system.size]
        structure, closed = close_contacts(means, rows.sampled_forces(), start)
        along = structure.coordinates.lower @ structure.along
        return cls(rows, structure, closed, start @ along)

    def residual(self, shape: tuple[int, ...]) -> PhaseResidual:
        """Residual on a grid with so many points over each phase."""
        grid = PhaseGrid(shape, self.rows.frequency)
        return PhaseResidual(self.structure, PhaseContacts.of(self.rows, self.structure, grid))

    def solve(self, residual: PhaseResidual, y: Array | None, tolerance: float) -> Solution:
        """Newton's method; where it fails, with damping at the contacts that is removed again."""
        if y is None:
            rest = np.tile(self.still, (residual.grid.size, 1))
            state = residual.at(rest, self.closed)  # linear equations: one step solves them
            y = rest + residual.correction(state)[0]
        best = newton(residual, y, 0.01 * tolerance, patience=_PATIENCE)
        if best.error <= tolerance:
            return best
        critical = residual.contacts.rows.stiffness.sum(axis=-1).mean(axis=0)
        fastest = max(abs(self.rows.rate(mesh.cycles)) for mesh in self.rows.meshes)
        for part in (*_ADDED, 0.0):
            residual.excess = part * critical / (np.pi * fastest)
            trial = newton(residual, y, 0.01 * tolerance, _TRIES)
            if trial.error < 1e-3:
                y = trial.state.y
        residual.excess = 0.0 * critical
        return min(best, trial, key=lambda solution: solution.error)

    def first(
        self, shape: tuple[int, ...], start: PhaseResponse | None, tolerance: float, free: bool
    ) -> tuple[PhaseResidual, Solution]:
        """Motion on the first grid, with more points if they are free and it is not found."""
        while True:
            residual = self.residual(shape)
            y = None if start is None else _resampled(start, residual.grid)
            solution = self.solve(residual, y, tolerance)
            if solution.error <= tolerance or not free or max(shape) >= _LAST:
                return residual, solution
            shape = _doubled(shape, range(len(shape)))

    def finer(
        self,
        residual: PhaseResidual,
        solution: Solution,
        errors: Array,
        poor: Index,
        tolerance: float,
    ) -> tuple[PhaseResidual, Solution] | None:
        """Motion with twice the points over the poor phases, or more; None if it is not found."""
        shape = _doubled(residual.grid.shape, poor)
        while np.prod(shape) <= _MOST:
            finer = self.residual(shape)
            refined = residual.grid.refined(solution.state.y, finer.grid)
            better = newton(finer, refined, 0.01 * tolerance, patience=_PATIENCE)
            if better.error <= tolerance:
                return finer, better
            # Flanks that part for less than a step need more points over all phases that matter.
            matter = errors > _MATTER * errors.max()
            fewer = matter & (np.array(shape) < max(shape))
            shape = _doubled(shape, np.flatnonzero(fewer if fewer.any() else matter))
        return None

    def changes(self, residual: PhaseResidual, y: Array) -> Array:
        """Change of a motion with twice the points over each phase, over its size."""
        grid, size, errors = residual.grid, residual.at(y).size, []
        for axis in range(len(grid.shape)):
            finer = self.residual(_doubled(grid.shape, [axis]))
            trial = finer.at(grid.refined(y, finer.grid))
            change = finer.correction(trial, 1e-3)[0]
            errors.append(float(np.linalg.norm(change, axis=1).max()) / size)
        return np.array(errors)


def _doubled(shape: tuple[int, ...], axes: Any) -> tuple[int, ...]:
    return tuple(count * (2 if axis in axes else 1) for axis, count in enumerate(shape))


def phase_balance(
    system: System, frequency: Any, steps: Any, start: Any, tolerance: float
) -> PhaseResponse:
    """Find the motion over several phases; arguments as of :func:`harmonic_balance`."""
    frequency = read_frequencies(frequency, system.phases)
    if start is not None and not isinstance(start, PhaseResponse):
        what, why = "start is no motion over these phases", "Grids of several phases are refined"
        remedy = "Give the Response of another frequency of the same system, or leave it out"
        raise InputError(what, "start", why, remedy)
    search = _Search.of(system, frequency)
    shape = _first_shape(search.rows) if steps is None else _read_steps(steps, system.phases)
    residual, solution = search.first(shape, start, tolerance, steps is None)
    step_error, smooth = float("nan"), True
    while solution.error <= tolerance:
        errors = search.changes(residual, solution.state.y)
        smooth &= not errors.sum() > _FALLING * step_error  # the first one has none before it
        step_error = float(errors.sum())
        limit = _ACCURATE if smooth and residual.grid.size <= _MANY else _ENOUGH
        poor = np.flatnonzero(errors > max(limit / errors.size, _WORST * errors.max()))
        if steps is not None or not poor.size:
            break
        better = search.finer(residual, solution, errors, poor, tolerance)
        if better is None:
            break
        residual, solution = better
    converged = bool(solution.error <= tolerance)
    if not converged:
        warn(
            "steady-state", _not_converged(search.rows, residual, solution, tolerance), stacklevel=3
        )
    elif step_error > _LIMIT:
        warn("step-size", _coarse(residual.grid, step_error), stacklevel=3)
    error = max(solution.error, float(np.finfo(float).eps))
    facts = {"error": error, "step_error": step_error, "converged": converged}
    return phase_response(search.rows, residual, solution.state, **facts)


def _first_shape(rows: PhaseRows) -> tuple[int, ...]:
    """Points over each phase with which an automatic choice starts."""
    cycles = np.abs([mesh.cycles for mesh in rows.meshes]).max(axis=0)
    turns = [np.abs(term.cycles) for each in rows.system.contacts for term in each.turning]
    shafts = np.max(turns, axis=0) if turns else np.ones_like(cycles)
    counts = np.where(cycles > 0.0, _MESH * cycles, _SHAFT * np.maximum(shafts, 1.0))
    return tuple(int(count) for count in counts)


def _read_steps(steps: Any, phases: int) -> tuple[int, ...]:
    """Points over each phase: one whole number for all, or one for each."""
    counts: Index = np.atleast_1d(np.asarray(steps))
    if counts.size not in (1, phases):
        what, why = f"steps = {steps}", f"There are {phases} phases"
        raise InputError(what, "steps", why, "Give a whole number for each, or one for all")
    return tuple(
        require_whole("steps", count, 4) for count in np.broadcast_to(counts, (phases,)).tolist()
    )


def _resampled(start: PhaseResponse, grid: PhaseGrid) -> Array:
    """Motion at the contacts of another solution on a grid."""
    numbers, values = start._contact_lines
    y = np.zeros((grid.size, values.shape[1]))
    step = max(1, 2**22 // max(len(numbers), 1))
    for begin in range(0, grid.size, step):
        turns = grid.points[begin : begin + step] @ numbers.T
        y[begin : begin + step] = (np.exp(2j * np.pi * turns) @ values).real
    return y


def _coarse(grid: PhaseGrid, step_error: float) -> str:
    counts = " x ".join(map(str, grid.shape))
    return (
        f"the motion changes by {100.0 * step_error:.2g} % of its size with twice the points, "
        f"limit {100.0 * _LIMIT:g} %: {counts} points over the phases. Give more steps, or omit "
        "them for an automatic choice"
    )


def _not_converged(
    rows: PhaseRows, residual: PhaseResidual, solution: Solution, tolerance: float
) -> str:
    """Message that names the contact with the largest residual."""
    state = solution.state
    along = np.broadcast_to(
        residual.contacts.rows.along, (len(state.y), *residual.contacts.rows.along.shape[1:])
    )
    distance = np.abs(np.einsum("pjr,pr->pj", along, state.residual)).max(axis=0)
    worst = int(np.argmax(distance))
    open_share = float(np.mean(state.law.side[:, worst] == 0.0))
    mesh = next(mesh for mesh in rows.meshes if worst in mesh.contacts)
    return (
        f"no motion over the phases was found: certified error {solution.error:.2e}, limit "
        f"{tolerance:.0e}. Contact {worst}, whose mesh runs at {abs(rows.rate(mesh.cycles)):.6g} "
        f"Hz, has the largest residual, {1e6 * distance[worst]:.3g} um; it is open for "
        f"{100.0 * open_share:.3g} % of the motion. Try another start, more steps or more damping"
    )
