"""The loaded tooth contact of one mesh, ready to be asked: compliances, gaps, widths of slices."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from tribodyn.errors import ComputationError, Problem
from tribodyn.stiffness.loaded.places import FAR, ContactPlaces
from tribodyn.stiffness.loaded.structure import Compliance
from tribodyn.types import Array

_STATUS = {
    1: ("the loads of the tooth pairs do not settle", "Check the load and the deviations"),
    2: (
        "the contact of the flanks is as wide as the teeth are thick",
        "Lower the load; the formula of the local compression holds for a narrow contact",
    ),
}


class Equilibrium(NamedTuple):
    """What the mesh does under given loads.

    Parameters
    ----------
    approach : array (t, p) [m]
        Approach of the gears along the line of action.
    load : array (t, p, s, n) [N/m]
        Load per face width of each pair in each slice.
    tangent : array (t, p) [N/m]
        Slope of the force over the approach.
    """

    approach: Array
    load: Array
    tangent: Array


@dataclass(frozen=True, eq=False)
class ContactProblem:
    """Compliances and gaps of all tooth pairs at some phases.

    Parameters
    ----------
    places : ContactPlaces
        Where the pairs may touch.
    compliance : Compliance
        Of the teeth.
    gaps : array (p, s, n) [m]
        Separation of each pair in each slice without load.
    widths : array (s,) [m]
        Face widths of the slices.
    """

    places: ContactPlaces
    compliance: Compliance
    gaps: Array
    widths: Array

    def with_film(self, film_stiffness: Array) -> ContactProblem:
        """Put an oil film in series with each pair.

        Parameters
        ----------
        film_stiffness : array (p, n) [N/m]
            Stiffness of the film of each pair over the whole face width; infinite without film.

        Returns
        -------
        ContactProblem
        """
        structure = self.compliance.structure.copy()
        pairs = np.arange(structure.shape[1])
        structure[:, pairs, pairs] += self.widths.sum() / film_stiffness
        return replace(self, compliance=replace(self.compliance, structure=structure))

    @property
    def least_gap(self) -> Array:
        """Approach at which the first pair touches (p,) [m]."""
        return np.asarray(self.gaps.min(axis=(1, 2)))

    def at_loads(self, totals: Array) -> Equilibrium:
        """Solve for total normal forces.

        Parameters
        ----------
        totals : array (t,) [N]
            Normal forces of all pairs together, positive; solved fastest in increasing order.

        Returns
        -------
        Equilibrium

        Raises
        ------
        ComputationError
            If a load is beyond what the formula of the local compression covers.
        """
        from tribodyn.stiffness.loaded.kernel import solve_loads

        phases, slices, pairs = self.gaps.shape
        found = Equilibrium(
            np.empty((totals.size, phases)),
            np.empty((totals.size, phases, slices, pairs)),
            np.empty((totals.size, phases)),
        )
        _told(solve_loads(*self._arguments, self.widths, np.asarray(totals, dtype=float), *found))
        return found

    def at_approach(self, approach: Array) -> tuple[Array, Array]:
        """Force and tangent stiffness at given approaches.

        Parameters
        ----------
        approach : array (d, p) [m]
            Approaches at each phase.

        Returns
        -------
        tuple of array (d, p)
            Total force [N] and its slope [N/m]; zero below the smallest gap.

        Raises
        ------
        ComputationError
            As :meth:`at_loads`.
        """
        from tribodyn.stiffness.loaded.kernel import solve_deflections

        total, tangent = np.empty(approach.shape), np.empty(approach.shape)
        asked = np.ascontiguousarray(approach, dtype=float)
        _told(solve_deflections(*self._arguments, self.widths, asked, total, tangent))
        return total, tangent

    def tangent_at(self, load_per_width: Array) -> Array:
        """Tangent stiffness of a single slice under given loads of its pairs.

        Parameters
        ----------
        load_per_width : array (p, n) [N/m]
            Loads; pairs without load are apart.

        Returns
        -------
        array (p,) [N/m]
        """
        parts, carries = self.compliance, load_per_width > 0.0
        logarithm = np.log(np.where(carries, load_per_width, 1.0))
        local = parts.local - parts.logarithm * (1.0 + logarithm)
        pairs = np.arange(carries.shape[1])
        both = carries[:, :, None] & carries[:, None, :]
        slope = np.where(both, parts.structure, 0.0)
        slope[:, pairs, pairs] += np.where(carries, local, 1.0)
        rates = np.linalg.solve(slope, carries[..., None].astype(float))[..., 0]
        return np.asarray(self.widths.sum() * (rates * carries).sum(axis=1))

    def pickups(self, most: Array) -> Array:
        """Approach at which each pair begins to carry.

        Parameters
        ----------
        most : array (p,) [m]
            Largest approach of interest.

        Returns
        -------
        array (p, n) [m]
            At most ``most``. Only for a single slice: with several, a pair begins gradually.

        Raises
        ------
        ComputationError
            As :meth:`at_loads`.
        """
        from tribodyn.stiffness.loaded.kernel import pickups

        found = np.empty(self.compliance.local.shape)
        _told(pickups(*self._arguments, np.ascontiguousarray(most), found))
        return found

    @property
    def _arguments(self) -> tuple[Array, Array, float, Array]:
        parts = self.compliance
        return parts.structure, parts.local, parts.logarithm, np.minimum(self.gaps, FAR)


def _told(status: int) -> None:
    if status:
        what, remedy = _STATUS[status]
        raise ComputationError(Problem(what, "loaded tooth contact", "", remedy))
