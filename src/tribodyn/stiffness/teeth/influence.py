"""What a load on one tooth of a gear does there and at its other teeth: the structure of one gear.

The local compression of the flank under the load is not part of it: it depends on the load and
on the mating flank, and belongs to the pair.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.arrays.splines import spline
from tribodyn.errors import Argument, InputError
from tribodyn.types import Array

#: Distance beyond the end nodes, over their span, that is rounding and not a place off the flank.
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False, repr=False)
class GearInfluence:
    """Compliances of one gear per unit face width, tabulated over its flank.

    Displacements are along the inward normal of the flank where they are seen, loads along that
    of the flank where they act. The neighbour ``+n`` is the n-th tooth on the side of the loaded
    tooth where a contact at the same time has a larger radius of curvature.

    Parameters
    ----------
    curvature_radius : array (K,) [m]
        Radii of curvature of the involute at the nodes, increasing.
    self_compliance : array (K,) [m^2/N]
        Displacement at the loaded place without the local compression.
    cross_compliance : array (N, K, K) [m^2/N]
        ``[n - 1, i, j]``: load at node ``i``, displacement at node ``j`` of the neighbour ``+n``.

    Raises
    ------
    InputError
        If the shapes disagree, the nodes do not increase, or a self compliance is not positive.

    Notes
    -----
    Between the nodes cubic splines. The neighbour ``-n`` follows from the reciprocal theorem of
    Betti and Maxwell.

    Examples
    --------
    >>> rho = np.linspace(0.01, 0.02, 5)
    >>> tooth = GearInfluence(rho, 1e-11 * (1.0 + rho), np.zeros((1, 5, 5)))
    >>> print(f"{float(tooth.at(0.015)) * 1e6:.6e} mm^2/N", float(tooth.between(0.015, 0.018, 1)))
    1.015000e-05 mm^2/N 0.0
    """

    curvature_radius: Array
    self_compliance: Array
    cross_compliance: Array

    def __post_init__(self) -> None:
        nodes = self.curvature_radius.size
        shapes = self.self_compliance.shape, self.cross_compliance.shape[1:]
        if shapes != ((nodes,), (nodes, nodes)) or nodes < 4:
            raise _unusable(
                f"{nodes} nodes with compliances of the shapes {shapes[0]}, {shapes[1]}"
            )
        if np.any(np.diff(self.curvature_radius) <= 0.0):
            raise _unusable("radii of curvature that do not increase")
        if not np.all(self.self_compliance > 0.0):
            raise _unusable("a self compliance that is not positive")
        if not np.all(np.isfinite(self.cross_compliance)):
            raise _unusable("a cross compliance that is not finite")

    @property
    def neighbours(self) -> int:
        """Number of neighbours on each side that are known; those beyond do not move."""
        return int(self.cross_compliance.shape[0])

    @cached_property
    def _self(self) -> Callable[[Array], Array]:
        return spline(self.curvature_radius, self.self_compliance)

    @cached_property
    def _weights(self) -> Callable[[Array], Array]:
        """Weights (..., nodes) of the values at the nodes in their spline at a place."""
        return spline(self.curvature_radius, np.eye(self.curvature_radius.size))

    def at(self, curvature_radius: Array | float) -> Array:
        """Compliance at the loaded place.

        Parameters
        ----------
        curvature_radius : float or array [m]
            Where the load acts, within the nodes.

        Returns
        -------
        array [m^2/N]
            Shape of the argument.

        Raises
        ------
        InputError
            If a place lies beyond the nodes.
        """
        return np.asarray(self._self(self._inside(curvature_radius)))

    @with_old_names
    def between(
        self, loaded_radius: Array | float, displaced_radius: Array | float, neighbour: int
    ) -> Array:
        """Displacement of another tooth per load.

        Parameters
        ----------
        loaded_radius : float or array [m]
            Radius of curvature where the load acts.
        displaced_radius : float or array [m]
            Radius of curvature at the displaced place, of the same shape.
        neighbour : int
            How many teeth on, counted to the side of the larger radii; not zero.

        Returns
        -------
        array [m^2/N]
            Zero for a neighbour further than is known.

        Raises
        ------
        InputError
            If a place lies beyond the nodes, or the neighbour is the loaded tooth.
        """
        if neighbour == 0:
            why = "The displacement of the loaded tooth has a local part"
            remedy = "Use the self compliance, and add the compression of the contact"
            raise InputError("neighbour = 0", Argument("neighbour"), why, remedy)
        first, second = self._inside(loaded_radius), self._inside(displaced_radius)
        if abs(neighbour) > self.neighbours:
            return np.zeros(np.broadcast_shapes(first.shape, second.shape))
        if neighbour < 0:
            first, second = second, first
        loaded = self._weights(first) @ self.cross_compliance[abs(neighbour) - 1]
        return np.asarray((loaded * self._weights(second)).sum(axis=-1))

    def _inside(self, curvature_radius: Array | float) -> Array:
        """Bring rounding back to the nodes, and refuse what lies beyond them."""
        places = np.asarray(curvature_radius, dtype=float)
        low, high = self.curvature_radius[[0, -1]]
        slack = _ROUNDING * (high - low)
        if places.size and (places.min() < low - slack or places.max() > high + slack):
            raise InputError(
                f"radius of curvature {places.min() * 1e3:.6g} to {places.max() * 1e3:.6g} mm",
                where=Argument("curvature_radius"),
                why=f"The compliance is known from {low * 1e3:.6g} to {high * 1e3:.6g} mm, "
                "from the end of the fillet to the tip",
                remedy="Load the tooth on its involute",
            )
        return np.asarray(np.clip(places, low, high))

    def __repr__(self) -> str:
        """One line with the range and the stiffest and softest place."""
        low, high = self.curvature_radius[[0, -1]] * 1e3
        least, most = self.self_compliance.min() * 1e6, self.self_compliance.max() * 1e6
        return (
            f"GearInfluence({self.curvature_radius.size} nodes from {low:.4g} to {high:.4g} mm, "
            f"{least:.4g} to {most:.4g} mm^2/N, {self.neighbours} neighbours)"
        )


def _unusable(what: str) -> InputError:
    return InputError(
        what,
        where="GearInfluence",
        why="It needs at least four increasing nodes, positive self compliances and one "
        "finite table of nodes by nodes for each neighbour",
        remedy="Check the provider of the compliances",
    )
