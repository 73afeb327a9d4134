"""Approximate inverse of the linearized equations over several phases: one mesh phase at a time.

The stiffness of the contacts is a mean, and for each phase the mean over all other phases less
that. With the part of one phase alone, the equations of the lines that differ in the number of this
phase only are small and dense; the product of these inverses leaves what couples two phases
through the structure, so that a few Krylov vectors remain.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics.harmonic.newton import State
from tribodyn.types import Array, ComplexArray, Index

if TYPE_CHECKING:
    from tribodyn.dynamics.harmonic.residual import OnGrid

#: Part of the largest variation of a stiffness that is too small to matter.
_SMALL = 0.02
#: Bytes of the inverse of the lines of one phase alone, and of those that others shift; with more,
#: only the lines at which the structure yields most are coupled.
_CENTRAL, _OTHERS = 2**25, 2**27
#: Bytes of the matrices that are inverted at once.
_AT_ONCE = 2**22


class MeshwiseInverse:
    """Product with the approximate inverse of the derivative of a residual at a state."""

    def __init__(self, residual: OnGrid, state: State) -> None:
        self.shape = residual.grid.shape
        structure, cell = residual.structure, state.cell
        stiffness: Any = structure.contact_stiffness - state.law.stiffness
        damping: Any = structure.contact_damping - state.law.damping
        if cell is not None:
            stiffness, damping = (
                cell.pieces.gather(part.reshape(len(part), -1)).reshape(-1, *part.shape[1:])
                for part in (cell.stiffness, cell.damping)
            )
        wide = (residual.grid.size, *stiffness.shape[1:])
        parts = [
            np.broadcast_to(part, wide).reshape(*self.shape, *wide[1:])
            for part in (stiffness, damping)
        ]
        axes = range(len(self.shape))
        self.mean = [part.mean(axis=tuple(axes)) for part in parts]
        self.phases = []
        for axis in axes:
            others = tuple(other for other in axes if other != axis)
            varying = [
                part.mean(axis=others) - mean for part, mean in zip(parts, self.mean, strict=True)
            ]
            if np.abs(varying).max() > _SMALL * np.abs(stiffness).max(initial=0.0):
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
    moved: ComplexArray  #: change of these lines with the motion that is felt (m, l r, l w)

    @classmethod
    def of(
        cls, rows: Index, most: float, gain: ComplexArray, rate: ComplexArray, along: Array,
        waves: list[Array],
    ) -> _Block:  # fmt: skip
        """Solve the equations of some rows, with a matrix of at most so many bytes for each."""
        chosen = _softest(gain[rows], int(np.sqrt(most / 16.0) / len(along)))
        size = chosen.shape[1] * len(along)
        some = max(1, _AT_ONCE // (16 * size**2))
        moved = [np.zeros((0, chosen.shape[1] * gain.shape[2], size), dtype=complex)]
        for first in range(0, len(rows), some):
            lines = chosen[first : first + some]
            place = rows[first : first + some, None], lines
            spring, damper = (_between_lines(wave, lines) for wave in waves)
            force = spring + damper * np.repeat(rate[place], len(along), axis=1)[:, None, None]
            change = gain[place] @ force  # of the lines with their motion (m, l, r, l w)
            loop = np.eye(size) - (along @ change).reshape(-1, size, size)
            change = change.reshape(len(lines), -1, size)
            moved.append(np.asarray(change @ np.linalg.inv(loop), dtype=complex))
        return cls(rows, chosen, np.concatenate(moved))


class _OnePhase:
    """Inverse with the stiffness that varies over one phase."""

    def __init__(
        self, residual: OnGrid, axis: int, mean: list[Array], varying: list[Array],
        mean_stiffness: Array | None,
    ) -> None:  # fmt: skip
        grid = residual.grid
        self.shape, self.axis = grid.shape, axis
        teeth: int = residual.structure.rows.teeth(axis)
        self.teeth = teeth if self.shape[axis] % teeth == 0 else 1
        self.half = (axis - 1) % len(grid.shape) if len(grid.shape) > 1 else None
        numbers = self._numbers()
        omega = 2.0 * np.pi * (numbers @ grid.frequency)
        omega[np.abs(omega) <= 1e-12 * np.abs(omega).max()] = 0.0
        unpaired = (2 * np.abs(numbers) == np.array(grid.shape)).any(axis=-1)
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
        push, self.along = _bases(varying)
        waves = [push.T @ part @ self.along.T for part in varying]
        gain = self._by_tooth(self.base @ receptances @ push)  # (m, n, r, a)
        rate = self._by_tooth(rate / np.abs(omega).max())
        others = np.delete(numbers[:, 0], axis, axis=1).any(axis=1).repeat(self.teeth)
        # Most of a motion has this phase alone: its lines are all coupled, of others the softest.
        self.blocks = []
        for rows, most in ((np.flatnonzero(~others), _CENTRAL), (np.flatnonzero(others), _OTHERS)):
            self.blocks.append(_Block.of(rows, most / len(rows), gain, rate, self.along, waves))

    def solved(self, y: Array, *, first: bool) -> Array:
        """Solution (p, r) for the right-hand side, or for one that the mean has solved already."""
        lines = self._lines(y)
        if first:
            lines = (self.base @ lines[..., None])[..., 0]
        lines = self._by_tooth(lines)
        for block in self.blocks:
            place = block.rows[:, None], block.chosen
            felt = (lines[place] @ self.along.T).reshape(len(block.rows), -1, 1)
            lines[place] += (block.moved @ felt).reshape(*block.chosen.shape, -1)
        table = lines.reshape(-1, self.teeth, *lines.shape[1:]).swapaxes(1, 2)
        return self._values(table.reshape(-1, self.shape[self.axis], lines.shape[-1]))

    def _by_tooth(self, lines: Any) -> Any:
        """Lines (m, n, ...) with those in a row that teeth couple which are equal on average."""
        table = lines.reshape(len(lines), -1, self.teeth, *lines.shape[2:]).swapaxes(1, 2)
        return table.reshape(-1, *table.shape[2:])

    def _axes(self) -> list[int]:
        """Phases in the order of the transform, the one of the half spectrum at the end."""
        axes = [axis for axis in range(len(self.shape)) if axis != self.half]
        return axes if self.half is None else [*axes, self.half]

    def _numbers(self) -> Index:
        """Whole numbers of the lines (m, n, phases), all of this phase in a row."""
        parts = [np.rint(np.fft.fftfreq(count) * count) for count in self.shape]
        if self.half is not None:
            parts[self.half] = np.arange(self.shape[self.half] // 2 + 1.0)
        lines = np.stack(np.meshgrid(*parts, indexing="ij"), axis=-1)
        row = np.moveaxis(lines, self.axis, -2)
        return row.reshape(-1, *row.shape[-2:]).astype(np.int64)

    def _lines(self, y: Array) -> ComplexArray:
        """Lines (m, n, r) of values (p, r)."""
        values = y.reshape(*self.shape, -1)
        axes = self._axes()
        lines = (
            np.fft.fftn(values, axes=axes) if self.half is None else np.fft.rfftn(values, axes=axes)
        )
        self._folded = np.moveaxis(lines, self.axis, -2).shape
        return np.asarray(np.moveaxis(lines, self.axis, -2).reshape(-1, *self._folded[-2:]))

    def _values(self, lines: ComplexArray) -> Array:
        """Values (p, r) of lines (m, n, r)."""
        table = np.moveaxis(lines.reshape(self._folded), -2, self.axis)
        axes = self._axes()
        if self.half is None:
            values = np.fft.ifftn(table, axes=axes).real
        else:
            values = np.fft.irfftn(table, [self.shape[axis] for axis in axes], axes)
        return np.asarray(values.reshape(-1, lines.shape[-1]))


def _bases(varying: list[Array]) -> tuple[Array, Array]:
    """Orthonormal bases (s, a) and (w, r) of the forces and motions of what varies."""
    stacked = np.concatenate(varying)  # (2 n, s, r)
    left, size, _ = np.linalg.svd(np.concatenate(list(stacked), axis=1), full_matrices=False)
    flat = stacked.reshape(-1, stacked.shape[-1])
    _, length, right = np.linalg.svd(flat, full_matrices=False)
    return left[:, size > _SMALL * size[0]], right[length > _SMALL * length[0]]


def _between_lines(part: Array, chosen: Index) -> ComplexArray:
    """Force of lines of each row per motion of others (m, l, a, l w), of a stiffness (n, a, w)."""
    between = (chosen[:, :, None] - chosen[:, None]) % len(part)
    waves = (np.fft.fft(part, axis=0) / len(part))[between]  # (m, l, l, a, w)
    return np.asarray(np.moveaxis(waves, 3, 2).reshape(*chosen.shape, part.shape[1], -1))


def _softest(gain: ComplexArray, most: int) -> Index:
    """Places of the lines of each row with the largest motion per force (m, n, r, a)."""
    size = np.linalg.norm(gain.reshape(*gain.shape[:2], -1), axis=-1)
    return np.sort(np.argsort(-size, axis=1, kind="stable")[:, : max(most, 3)], axis=1)
