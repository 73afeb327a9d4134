"""Values on a phase grid as a function of any phase that never leaves the range of its knots."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tribodyn.mesh.grid import PhaseGrid
from tribodyn.types import Array


@dataclass(frozen=True, eq=False)
class MonotonePhaseFunction:
    """Monotone piecewise cubic in each segment between two events.

    For quantities that have corners at phases which are no events: a cubic through four knots
    would swing there, and a stiffness of zero would swing below zero.

    Parameters
    ----------
    grid : PhaseGrid
        The knots.
    values : array (n, ...)
        Values at the knots, in any unit.

    Notes
    -----
    Source: Fritsch and Carlson (1980), SIAM J. Numer. Anal. 17, 238-246.

    Examples
    --------
    >>> from tribodyn.mesh import phase_grid
    >>> grid = phase_grid((0.0,), 16)
    >>> corner = MonotonePhaseFunction(grid, np.maximum(grid.phase - 0.5, 0.0))
    >>> float(corner(0.49)), float(corner(0.9375))
    (0.0, 0.4375)
    """

    grid: PhaseGrid
    values: Array

    @cached_property
    def _pieces(self) -> list[Any]:
        from scipy.interpolate import PchipInterpolator

        return [
            PchipInterpolator(self.grid.phase[part], self.values[part], axis=0)
            for part in self.grid.segments
        ]

    def __call__(self, phase: Array | float) -> Array:
        """Interpolate.

        Parameters
        ----------
        phase : float or array
            Mesh phase, taken modulo one. Exactly on an event the value after it is returned.

        Returns
        -------
        array
            Shape of ``phase`` followed by the further shape of the values.
        """
        folded = np.mod(np.asarray(phase, dtype=float), 1.0)
        segment = np.searchsorted(np.array(self.grid.event_phases), folded, side="right") - 1
        found = np.empty(folded.shape + self.values.shape[1:])
        for number, piece in enumerate(self._pieces):
            here = segment == number
            if np.any(here):
                found[here] = piece(folded[here])
        return found
