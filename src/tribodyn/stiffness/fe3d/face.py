"""Functions over the face width: cubic B-splines, closer together towards both free ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.arrays.splines import bspline_slopes, bspline_values, clamped_knots
from tribodyn.types import Array


@dataclass(frozen=True)
class FaceSize:
    """Sizes of the elements over the face width over the module."""

    end: float = 0.5  #: size at a free end
    largest: float = 1.4  #: largest size on a face of up to ``least_count`` of them
    growth: float = 1.5  #: ratio of neighbouring elements
    least_count: int = 14  #: elements of the largest size on longer faces

    def breaks(self, width: float) -> Array:
        """Ends of the elements from 0 to ``width``, both in modules."""
        edges, step = [0.0], self.end
        largest = max(self.largest, width / self.least_count)
        while edges[-1] < 0.5 * width:
            edges.append(edges[-1] + step)
            step = min(step * self.growth, largest)
        half = np.array(edges) * (0.5 * width / edges[-1])
        return np.concatenate([half[:-1], width - half[::-1]])


@dataclass(frozen=True, eq=False)
class FaceBasis:
    """Splines over the face and the integrals of their products, lengths in modules."""

    knots: Array
    mass: Array  #: integrals of ``value value``
    slope: Array  #: integrals of ``value slope``
    bending: Array  #: integrals of ``slope slope``

    @property
    def count(self) -> int:
        """Number of functions."""
        return len(self.mass)


def face_basis(breaks: Array) -> FaceBasis:
    """Splines on breakpoints."""
    knots = clamped_knots(breaks)
    place, weight = np.polynomial.legendre.leggauss(4)
    half = 0.5 * np.diff(breaks)
    points = (0.5 * (breaks[1:] + breaks[:-1])[:, None] + half[:, None] * place).ravel()
    weights = (half[:, None] * weight).ravel()
    value, slope = bspline_values(knots, points), bspline_slopes(knots, points)
    weighted = value.T * weights
    return FaceBasis(knots, weighted @ value, weighted @ slope, (slope.T * weights) @ slope)
