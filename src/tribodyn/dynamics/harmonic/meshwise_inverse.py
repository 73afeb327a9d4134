"""Approximate inverse of the linearized equations over several phases: one mesh phase at a time.

The stiffness of the contacts is a mean, and for each phase the mean over all other phases less
that. With the part of one phase alone, the equations of the lines that differ in the number of this
phase only are small and dense; the product of these inverses leaves what couples two phases
through the structure, so that a few Krylov vectors remain. Their factors have single precision.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics.harmonic.newton import State, tangents
from tribodyn.dynamics.harmonic.phase_grid import CENTRAL, OTHERS, PhaseGrid
from tribodyn.types import Array, ComplexArray, Index

if TYPE_CHECKING:
    from tribodyn.dynamics.harmonic.residual import OnGrid

#: Part of the largest variation of a stiffness that is too small to matter.
_SMALL = 0.02
#: Bytes of the matrices that are set up at once.
_AT_ONCE = 2**22


class MeshwiseInverse:
    """Product with the approximate inverse of the derivative of a residual at a state."""

    def __init__(self, residual: OnGrid, state: State) -> None:
        self.shape = residual.grid.shape
        # Lines of a motion along the phase of pieces differ by more than there are on the grid.
        axes, shape = range(len(self.shape)), np.array(self.shape)
        if state.pieces is not None:
            shape[state.pieces.axis] *= 2
        both = tangents(residual.structure, state, 2)
        parts = [part.reshape(*shape, *part.shape[1:]) for part in both]
        self.mean = [part.mean(axis=tuple(axes)) for part in parts]
        self.phases = []
        for axis in axes:
            others = tuple(other for other in axes if other != axis)
            varying = [
                part.mean(axis=others) - mean for part, mean in zip(parts, self.mean, strict=True)
            ]
            if np.abs(varying).max() > _SMALL * np.abs(parts[0]).max(initial=0.0):
                self.phases.append(
                    _OnePhase(residual, axis, self.mean, varying, state.mean_stiffness)
                )

    def __call__(self, right: Array) -> Array:
        """Product with a right-hand side (p, r)."""
        y = right
        for phase in self.phases:
            y = phase.solved(y, first=phase is self.phases[0])
        return y


class _Block(NamedTuple):
    """Inverse for some rows of lines: those of different numbers of the other phases."""

    rows: Index
    chosen: Index  #: lines of each row that are coupled (m, l)
    factors: list[tuple[Any, ...]]  #: of the equations of the motion that is felt (l w, l w)
    others: ComplexArray  #: change of the other directions with it (m, l (r - w), l w)

    @classmethod
    def of(
        cls, rows: Index, most: float, gain: ComplexArray, rate: ComplexArray,
        number: Index, waves: list[Array],
    ) -> _Block:  # fmt: skip
        """Factorize the equations of some rows, each of at most so many bytes."""
        from scipy.linalg.lapack import cgetrf

        felt = waves[0].shape[2]
        chosen = _softest(gain[rows], int(np.sqrt(most / 8.0) / felt))
        size = chosen.shape[1] * felt
        some = max(1, _AT_ONCE // (8 * size**2))
        factors: list[tuple[Any, ...]] = []
        others = [np.zeros((0, chosen.shape[1] * (gain.shape[2] - felt), size), np.complex64)]
        for first in range(0, len(rows), some):
            lines = chosen[first : first + some]
            place = rows[first : first + some, None], lines
            spring, damper = (_between_lines(wave, number[place]) for wave in waves)
            damper *= np.repeat(rate[place], felt, axis=1)[:, None, None]
            change = gain[place] @ (spring + damper)  # of lines with their motion (m, l, r, l w)
            others.append(change[:, :, felt:].reshape(len(lines), -1, size))
            loops = np.eye(size, dtype=np.float32) - change[:, :, :felt].reshape(-1, size, size)
            factors += [cgetrf(loop)[:2] for loop in loops]
        return cls(rows, chosen, factors, np.concatenate(others))

    def solve(self, lines: ComplexArray) -> None:
        """Replace motions (m, l, r), those of directions that are felt first, by solutions."""
        from scipy.linalg.lapack import cgetrs

        felt = self.factors[0][1].size // self.chosen.shape[1]
        pairs = zip(self.factors, lines[..., :felt].reshape(len(lines), -1), strict=True)
        solved = np.array([cgetrs(*factors, right)[0] for factors, right in pairs])
        lines[..., :felt] = solved.reshape(*self.chosen.shape, felt)
        moved = self.others @ solved[..., None]
        lines[..., felt:] += moved.reshape(*self.chosen.shape, -1)


class _OnePhase:
    """Inverse with the stiffness that varies over one phase."""

    def __init__(
        self, residual: OnGrid, axis: int, mean: list[Array], varying: list[Array],
        mean_stiffness: Array | None,
    ) -> None:  # fmt: skip
        self.shape, self.axis = residual.grid.shape, axis
        count, teeth = self.shape[axis], residual.structure.rows.teeth(axis)
        self.teeth: int = teeth if count % teeth == 0 else 1
        # This phase is the first one, which has no half spectrum.
        order = [axis, *np.delete(np.arange(len(self.shape)), axis)]
        shape = tuple(self.shape[each] for each in order)
        frequency = residual.grid.frequency[order]
        if len(shape) == 1:
            shape, frequency = (*shape, 1), np.append(frequency, 0.0)
        self.grid = grid = PhaseGrid(shape, frequency)
        omega, unpaired = (each.reshape(count, -1).T for each in (grid.omega, grid.unpaired))
        receptances = residual.structure.receptances(omega.reshape(-1))
        receptances = receptances.reshape(*omega.shape, *receptances.shape[1:])
        receptances[unpaired] = 0.0
        rate = np.where(unpaired, 0.0, 1j * omega)
        mean_gain = receptances @ (mean[0] + rate[..., None, None] * mean[1])
        if mean_stiffness is not None:
            mean_gain[0, 0] -= receptances[0, 0] @ mean_stiffness
        self.base = np.linalg.inv(np.eye(mean_gain.shape[-1]) - mean_gain)
        varying = [varying[0], varying[1] * np.abs(omega).max()]
        varying = [part.reshape(self.teeth, -1, *part.shape[1:]).mean(axis=0) for part in varying]
        push, self.basis, felt = _bases(varying)
        waves = [push.T @ part @ self.basis[:felt].T for part in varying]
        gain = self.basis @ self.base @ receptances @ push  # (m, n, r, a)
        gain = self._by_tooth(gain.astype(np.complex64))
        rate = self._by_tooth((rate / np.abs(omega).max()).astype(np.complex64))
        number = np.rint(np.fft.fftfreq(count, 1.0 / count)).astype(int) // self.teeth
        number = self._by_tooth(np.tile(number, (len(omega), 1)))
        others = grid.numbers[: len(omega), 1:].any(axis=1).repeat(self.teeth)
        # Most of a motion has this phase alone: its lines are all coupled, of others the softest.
        self.blocks = []
        for rows, most in ((np.flatnonzero(~others), CENTRAL), (np.flatnonzero(others), OTHERS)):
            if rows.size:
                self.blocks.append(_Block.of(rows, most / rows.size, gain, rate, number, waves))

    def solved(self, y: Array, *, first: bool) -> Array:
        """Solution (p, r) for the right-hand side, or for one that the mean has solved already."""
        turned = np.moveaxis(y.reshape(*self.shape, -1), self.axis, 0)
        table = self.grid.spectrum(turned.reshape(y.shape))
        lines = table.reshape(self.shape[self.axis], -1, y.shape[1]).swapaxes(0, 1)
        if first:
            lines = (self.base @ lines[..., None])[..., 0]
        lines = self._by_tooth(lines)
        for block in self.blocks:
            place = block.rows[:, None], block.chosen
            along = lines[place] @ self.basis.T
            block.solve(along)
            lines[place] = along @ self.basis
        lines = lines.reshape(-1, self.teeth, *lines.shape[1:]).swapaxes(1, 2)
        lines = lines.reshape(-1, self.shape[self.axis], y.shape[1]).swapaxes(0, 1)
        values = self.grid.values(lines.reshape(table.shape))
        return np.moveaxis(values.reshape(turned.shape), 0, self.axis).reshape(y.shape)

    def _by_tooth(self, lines: Any) -> Any:
        """Lines (m, n, ...) with those in a row that teeth couple which are equal on average."""
        table = lines.reshape(len(lines), -1, self.teeth, *lines.shape[2:]).swapaxes(1, 2)
        return table.reshape(-1, *table.shape[2:])


def _bases(varying: list[Array]) -> tuple[Array, Array, int]:
    """Orthonormal bases (s, a) of forces and (r, r) of motions, the first of which they follow."""
    stacked = np.concatenate(varying)  # (2 n, s, r)
    left, size, _ = np.linalg.svd(np.concatenate(list(stacked), axis=1), full_matrices=False)
    flat = stacked.reshape(-1, stacked.shape[-1])
    _, length, right = np.linalg.svd(flat, full_matrices=False)
    return left[:, size > _SMALL * size[0]], right, int(np.sum(length > _SMALL * length[0]))


def _between_lines(part: Array, number: Index) -> ComplexArray:
    """Force of lines of each row per motion of others (m, l, a, l w), of a stiffness (n, a, w)."""
    between = (number[:, :, None] - number[:, None]) % len(part)
    waves = (np.fft.fft(part, axis=0) / len(part)).astype(np.complex64)[between]  # (m, l, l, a, w)
    return np.asarray(np.moveaxis(waves, 3, 2).reshape(*number.shape, part.shape[1], -1))


def _softest(gain: ComplexArray, most: int) -> Index:
    """Places of the lines of each row with the largest motion per force (m, n, r, a)."""
    size = np.linalg.norm(gain.reshape(*gain.shape[:2], -1), axis=-1)
    return np.sort(np.argsort(-size, axis=1, kind="stable")[:, : max(most, 3)], axis=1)
