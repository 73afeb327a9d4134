"""Motion on a grid of several phases: its transforms and its contacts.

A motion over phases ``phi_d`` with the frequencies ``f_d`` is a Fourier series over all of them.
The line of the whole numbers ``k`` has the frequency ``k.f``; a derivative over time is the sum of
``f_d d/dphi_d``. Contacts act at the points of the grid; where their forces jump, the two points
about the jump along the phase of their mesh are corrected as those of a single clock.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.harmonic.phase_rows import Mesh, PhaseRows
from tribodyn.dynamics.modal.contact_equations import ContactEquations, with_dead_zone
from tribodyn.types import Array, ComplexArray, Index, Mask

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
        """Half spectrum (k, ...) of values (p, ...)."""
        axes = tuple(range(len(self.shape)))
        lines = np.fft.rfftn(values.reshape(*self.shape, -1), axes=axes)
        return np.asarray(lines.reshape(-1, values.shape[1]), dtype=complex)

    def values(self, spectrum: ComplexArray) -> Array:
        """Values (p, c) of a half spectrum (k, c)."""
        lines, axes = spectrum.reshape(*self.half, -1), tuple(range(len(self.shape)))
        return np.asarray(np.fft.irfftn(lines, self.shape, axes).reshape(self.size, -1))

    @property
    def half(self) -> tuple[int, ...]:
        """Shape of the half spectrum."""
        return (*self.shape[:-1], self.shape[-1] // 2 + 1)

    def places(self, numbers: Index) -> Index:
        """Places of lines (k, phases) of the half spectrum."""
        at = numbers % np.array(self.shape)
        return np.asarray(np.ravel_multi_index(tuple(at.T), self.half))

    def common(self, other: PhaseGrid) -> Index:
        """Numbers of the lines that two grids have (k, phases), the mean first."""
        pairs = zip(self.shape, other.shape, strict=True)
        shared = PhaseGrid(tuple(min(pair) for pair in pairs), self.frequency)
        return np.asarray(shared.numbers[~shared.unpaired])

    def refined(self, values: Array, finer: PhaseGrid) -> Array:
        """Values (p, c) on another grid: with the lines that both have."""
        numbers = self.common(finer)
        padded = np.zeros((math.prod(finer.half), values.shape[1]), dtype=complex)
        padded[finer.places(numbers)] = self.spectrum(values)[self.places(numbers)]
        padded *= finer.size / self.size
        return finer.values(padded)


class _Jumps(NamedTuple):
    """Places where a mesh phase passes a jump."""

    points: Array  #: phases (b, phases)
    before: Index  #: points of the grid before and after each
    after: Index
    fraction: Array  #: of the step between them

    @classmethod
    def joined(cls, parts: list[_Jumps]) -> _Jumps:
        """Places of all meshes."""
        none = np.zeros(0, dtype=np.int64)
        parts = [cls(np.zeros((0, 0)), none, none, np.zeros(0)), *parts]
        points = np.concatenate([part.points for part in parts[1:]] or [parts[0].points])
        columns = list(zip(*parts, strict=True))[1:]
        return cls(points, *(np.concatenate(column) for column in columns))


@dataclass(frozen=True)
class PhaseContacts(ContactEquations):
    """The contacts of a system on a grid of phases; their jumps lie along one phase each."""

    grid: PhaseGrid
    axis: Index  #: phase along which the sides of each contact are compared (contacts,)
    jumps: _Jumps  #: places of the rows of ``before`` and ``after``

    @classmethod
    def of(cls, rows: PhaseRows, structure: Any, grid: PhaseGrid) -> PhaseContacts:
        """Sample the contacts of a system."""
        inverse = structure.coordinates.inverse
        bases = inverse.T @ structure.along, inverse.T @ structure.push
        contacts = rows.system.contacts
        axis = np.zeros(len(contacts), dtype=np.int64)
        for mesh in rows.meshes:
            axis[mesh.contacts] = _axis_of(mesh)
        at = rows.projected(grid.points, *bases)
        jumping = [mesh for mesh in rows.meshes if mesh.jumps.size]
        jumps = [_jumps(rows, grid, mesh) for mesh in jumping]
        sides = [
            [rows.projected(jump.points, *bases, before=mesh if before else None)
             for mesh, jump in zip(jumping, jumps, strict=True)]
            for before in (True, False)
        ]  # fmt: skip
        counts = [len(jump.points) for jump in jumps]
        before, after = (_stacked(parts, counts) if parts else at.at(slice(0)) for parts in sides)
        return cls(
            rows.system, at, before, after, np.zeros(0), structure.along, structure.push,
            with_dead_zone(rows.means.nodes),
            np.array([contact.damping_in_gap for contact in contacts], dtype=bool), grid.size,
            grid, axis, _Jumps.joined(jumps),
        )  # fmt: skip

    def event_places(self) -> tuple[Index, Index, Array]:
        """Points before and after each row of ``before``, and the fraction of the step."""
        return self.jumps.before, self.jumps.after, self.jumps.fraction

    def neighbour(self, sample: Index, contact: Index, by: int) -> Index:
        """Point ``by`` steps along the phase of the mesh of a contact from another one."""
        return _along(self.grid, sample, self.axis[contact], by)

    def next_samples(self, values: Array | Mask) -> Array | Mask:
        """Values (p, contacts, ...) of the next points along the phase of each mesh."""
        ahead = np.empty_like(values)
        for axis in np.unique(self.axis):
            chosen = self.axis == axis
            table = values[:, chosen].reshape(*self.grid.shape, -1)
            ahead[:, chosen] = np.roll(table, -1, axis=axis).reshape(ahead[:, chosen].shape)
        return ahead


def _along(grid: PhaseGrid, sample: Index, axis: Any, by: Any) -> Index:
    """Point ``by`` steps along a phase from another one."""
    counts = np.array(grid.shape)
    strides = np.concatenate((np.cumprod(counts[:0:-1])[::-1], [1]))
    stride, count = strides[axis], counts[axis]
    at = sample // stride % count
    return np.asarray(sample + ((at + by) % count - at) * stride)


def _axis_of(mesh: Mesh) -> int:
    """Phase over which a mesh has the fewest cycles, but some."""
    return int(np.argmin(np.where(mesh.cycles == 0.0, np.inf, np.abs(mesh.cycles))))


def _jumps(rows: PhaseRows, grid: PhaseGrid, mesh: Mesh) -> _Jumps:
    """Places where a mesh passes its jumps, on every line along its phase."""
    axis = _axis_of(mesh)
    lines = np.arange(grid.size).reshape(grid.shape).take(0, axis).reshape(-1)
    turns, count = mesh.cycles[axis], grid.shape[axis]
    mesh_phase = grid.points[lines] @ mesh.cycles + mesh.offset
    if rows.system.lead is not None:  # it is a function of other phases
        mesh_phase = mesh_phase + rows.rate(mesh.cycles) * rows.system.lead(grid.points[lines])[0]
    cycles = np.arange(int(abs(turns)))
    at = (mesh.jumps[:, None, None] - mesh_phase[:, None] + cycles) / turns % 1.0 % 1.0
    place = (at * count).reshape(-1)
    step = np.ceil(place - 1e-6).astype(np.int64) - 1
    start = np.broadcast_to(lines[:, None], at.shape).reshape(-1)
    points = grid.points[start]
    points[:, axis] = at.reshape(-1)
    before = _along(grid, start, axis, step)
    return _Jumps(points, before, _along(grid, before, axis, 1), place - step)


def _stacked(parts: list[Any], counts: list[int]) -> Any:
    """Rows one after the other, so many of each."""
    if hasattr(parts[0], "_fields"):
        return type(parts[0])(*(_stacked(list(part), counts) for part in zip(*parts, strict=True)))
    pairs = zip(parts, counts, strict=True)
    return np.concatenate([np.broadcast_to(part, (n, *part.shape[1:])) for part, n in pairs])
