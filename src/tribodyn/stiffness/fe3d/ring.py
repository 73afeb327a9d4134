"""The ring of all teeth with its face width, harmonic by harmonic around the axis."""

from __future__ import annotations

from itertools import pairwise
from typing import Protocol

import numpy as np

from tribodyn.arrays.splines import bspline_values, interpolation_knots
from tribodyn.progress import SILENT, Progress
from tribodyn.stiffness.fe3d.sections import eliminated
from tribodyn.types import Array, Index

#: Harmonics that are all solved; beyond, the next one is so much larger, and those between
#: follow by a spline over the logarithm.
_ALL, _RATIO = 8, 1.25


def solved_harmonics(count: int) -> Index:
    """Harmonics of a ring of ``count`` sectors that are solved."""
    harmonics = list(range(min(_ALL, count // 2) + 1))
    while harmonics[-1] < count // 2:
        harmonics.append(min(max(harmonics[-1] + 1, int(harmonics[-1] * _RATIO)), count // 2))
    if len(harmonics) > _ALL + 2 and harmonics[-1] - harmonics[-2] == 1:
        harmonics.pop(-2)
    return np.array(harmonics)


def harmonic_weights(count: int, harmonics: Index, sectors: Index) -> Array:
    """Weights (sectors, harmonics) of the harmonics in the displacement of sectors."""
    every = np.arange(count // 2 + 1)
    twice = np.where((every == 0) | (2 * every == count), 1.0, 2.0)
    wave = twice * np.exp(2j * np.pi * every * sectors[:, None] / count) / count
    if harmonics.size == every.size:
        return np.asarray(wave)
    place = np.log(1.0 + harmonics)
    knots = interpolation_knots(place)
    spline = bspline_values(knots, np.log(1.0 + every)) @ np.linalg.inv(
        bspline_values(knots, place)
    )
    return np.asarray(wave @ spline)


class RingSector(Protocol):
    """One of the equal sectors of a ring."""

    @property
    def count(self) -> int:
        """Number of sectors of the ring."""

    @property
    def loaded_freedoms(self) -> int:
        """Number of freedoms of the tooth that are retained."""

    @property
    def border(self) -> tuple[Index, Index, Index]:
        """Nodes of the right and left cut and of the circle on the ring below."""

    @property
    def border_points(self) -> Array:
        """Places of the nodes on the ring below."""

    @property
    def waves(self) -> int:
        """Waves around the axis, per tooth and on each side of a harmonic, in the ring below."""

    @property
    def load_square(self) -> float:
        """Square of the length of a unit load."""

    def condensed(self) -> Array:
        """Stiffness (f, z, f, z) of the tooth and of the borders in polar directions."""

    def ring_stiffness(self, order: int) -> Array:
        """Stiffness of the ring below for waves around the axis."""


class Ring:
    """Ring of equal sectors that is held along its inner circle."""

    def __init__(self, sector: RingSector) -> None:
        self._sector = sector
        self._stiffness = sector.condensed()
        sizes = [sector.loaded_freedoms, *(3 * nodes.size for nodes in sector.border)]
        ends = np.cumsum([0, *sizes])
        self._flank, self._right, self._left, self._inner = (
            slice(*pair) for pair in pairwise(ends)
        )

    def flank_compliances(
        self, sectors: Index, harmonics: Index | None = None, progress: Progress = SILENT
    ) -> Array:
        """Compliance (s, f, z, f, z) of flanks, anticlockwise, under loads on the sector 0."""
        count = self._sector.count
        harmonics = solved_harmonics(count) if harmonics is None else harmonics
        weights = harmonic_weights(count, harmonics, sectors)
        total = 0.0
        for harmonic, weight in zip(harmonics, weights.T, strict=True):
            compliance = self.harmonic_compliance(int(harmonic))
            total = total + np.real(weight.reshape(-1, 1, 1, 1, 1) * compliance)
            progress.advance()
        return np.asarray(total)

    def harmonic_compliance(self, harmonic: int) -> Array:
        """Compliance (f, z, f, z) under loads that turn by a harmonic from sector to sector."""
        sector, face = self._sector, self._stiffness.shape[1]
        phase = np.exp(2j * np.pi * harmonic / sector.count)
        waves = self._waves(harmonic)
        reduced = self._folded(self._stiffness, np.conj(phase), np.conj(waves))
        folded = self._folded(reduced.transpose(2, 3, 0, 1), phase, waves)
        stiffness, size = np.ascontiguousarray(folded.transpose(2, 3, 0, 1)), len(folded)
        first = self._right.stop - self._right.start
        for place, order in enumerate(self._orders(harmonic)):
            ring = sector.ring_stiffness(order)
            rows = slice(first + 3 * place, first + 3 * place + 3)
            share = 2.0 * np.pi / sector.count
            stiffness[rows, :, rows, :] += share * ring.reshape(3, face, 3, face)
        loaded = self._flank.stop
        below = (size - loaded) * face
        inverse = np.linalg.inv(eliminated(stiffness.reshape(size * face, -1), below))
        compliance = 0.5 * sector.load_square * (inverse + np.conj(inverse.T))
        return np.asarray(compliance.reshape(loaded, face, loaded, face))

    def _orders(self, harmonic: int) -> list[int]:
        """Waves around the axis on the inner circle."""
        sector = self._sector
        if not sector.border[2].size:
            return []
        waves = range(-sector.waves, sector.waves + 1)
        return [harmonic + wave * sector.count for wave in waves]

    def _folded(self, values: Array, phase: complex, waves: Array) -> Array:
        """Rows per cut, wave on the inner circle and flank from those of all retained freedoms."""
        cut = values[self._right] + phase * values[self._left]
        inner = np.tensordot(waves, values[self._inner], 1)
        return np.concatenate([cut, inner, values[self._flank]])

    def _waves(self, harmonic: int) -> Array:
        """Displacements (3 waves, freedoms) of the inner circle."""
        orders, points = self._orders(harmonic), self._sector.border_points
        angle = np.arctan2(-points[:, 0], points[:, 1])
        waves = np.zeros((3 * len(orders), 3 * len(points)), dtype=complex)
        for place, order in enumerate(orders):
            for axis in range(3):
                waves[3 * place + axis, axis::3] = np.exp(1j * order * angle)
        return waves
