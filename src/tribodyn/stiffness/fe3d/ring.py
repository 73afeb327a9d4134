"""The ring of all teeth with its face width, harmonic by harmonic around the axis."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from tribodyn.arrays.bspline import bspline_values, interpolation_knots
from tribodyn.progress import SILENT, Progress
from tribodyn.stiffness.fe3d.annulus import annulus_radii, annulus_stiffness
from tribodyn.stiffness.fe3d.condense import eliminated
from tribodyn.stiffness.fe3d.sector import Sector
from tribodyn.types import Array, Index

#: Harmonics that are all solved; beyond, the next one is so much larger, and those between
#: follow by a spline over the logarithm.
_ALL, _RATIO = 8, 1.25
#: First radial size of the ring [modules].
_RING_SIZE = 0.4


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


class Ring:
    """Ring of equal sectors that is held along its inner circle."""

    def __init__(self, sector: Sector) -> None:
        self._sector = sector
        self._stiffness = sector.condensed()
        sizes = [sector.flank.size, *(3 * nodes.size for nodes in sector.border)]
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
        sector, face = self._sector, self._sector.face.count
        turn = self._turn(harmonic)
        size = turn.shape[1]
        half = np.tensordot(np.conj(turn.T), self._stiffness, 1)
        stiffness = np.ascontiguousarray((half.transpose(0, 1, 3, 2) @ turn).transpose(0, 1, 3, 2))
        first = self._right.stop - self._right.start
        for place, order in enumerate(self._orders(harmonic)):
            radii = annulus_radii(sector.held, sector.interface, order, _RING_SIZE)
            ring = annulus_stiffness(radii, order, sector.twist, sector.stress, sector.face)
            rows = slice(first + 3 * place, first + 3 * place + 3)
            share = 2.0 * np.pi / sector.count
            stiffness[rows, :, rows, :] += share * ring.reshape(3, face, 3, face)
        loaded = self._flank.stop
        below = (size - loaded) * face
        inverse = np.linalg.inv(eliminated(stiffness.reshape(size * face, -1), below))
        # the load is a unit vector in the section only
        square = 1.0 + (sector.twist * sector.base_radius) ** 2
        compliance = 0.5 * square * (inverse + np.conj(inverse.T))
        return np.asarray(compliance.reshape(loaded, face, loaded, face))

    def _orders(self, harmonic: int) -> list[int]:
        """Waves around the axis on the inner circle."""
        sector = self._sector
        if not sector.on_ring:
            return []
        waves = range(-sector.size.waves, sector.size.waves + 1)
        return [harmonic + wave * sector.count for wave in waves]

    def _turn(self, harmonic: int) -> Array:
        """Retained freedoms per cut, waves on the inner circle, and flank."""
        sector, orders = self._sector, self._orders(harmonic)
        cut = self._right.stop - self._right.start
        below = cut + 3 * len(orders)
        turn = np.zeros((self._inner.stop, below + self._flank.stop), dtype=complex)
        turn[self._flank, below:] = np.eye(self._flank.stop)
        turn[self._right, :cut] = np.eye(cut)
        turn[self._left, :cut] = np.exp(2j * np.pi * harmonic / sector.count) * np.eye(cut)
        points = sector.mesh.nodes[sector.border[2]]
        angle = np.arctan2(-points[:, 0], points[:, 1])
        for place, order in enumerate(orders):
            for axis in range(3):
                rows = slice(self._inner.start + axis, self._inner.stop, 3)
                turn[rows, cut + 3 * place + axis] = np.exp(1j * order * angle)
        return turn
