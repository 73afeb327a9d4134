"""One mesh cycle as places: where every tooth pair is at every knot, and whether it touches."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tribodyn.contact import Kinematics, PathOfContact, path_of_contact
from tribodyn.gear import SpurPair
from tribodyn.mesh.grid import PhaseGrid, phase_grid

__all__ = ["MeshCycle", "mesh_cycle"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """Places of all tooth pairs over one mesh cycle; made by :func:`mesh_cycle`.

    Parameters
    ----------
    contact : PathOfContact
        Path of contact of the pair.
    grid : PhaseGrid
        Knots on the mesh phase, twice at each event.
    path : array (n, pairs) [m]
        Distance of each contact from the pinion's base tangent point.
    in_contact : bool array (n, pairs)
        Whether the pair is in contact.
    """

    contact: PathOfContact
    grid: PhaseGrid
    path: FloatArray
    in_contact: NDArray[np.bool_]

    @cached_property
    def age(self) -> FloatArray:
        """Mesh cycles since the pair entered, of the touching pairs."""
        return np.asarray(self._aged(self.grid.phase))

    @cached_property
    def side(self) -> FloatArray:
        """Age in the middle of the segment of each knot: which side of an event is meant."""
        return np.asarray(self._aged(self.grid.middle))

    def _aged(self, phase: FloatArray) -> FloatArray:
        return (phase[:, None] + np.arange(self.path.shape[1]))[self.in_contact]

    @cached_property
    def sliding_direction(self) -> FloatArray:
        """Sign of the sliding speed of the touching pairs, never zero.

        A pair slides one way throughout a segment; at the pitch point itself it would be 0.
        """
        middle = self.contact.pair_paths(self.grid.middle)[0]
        return self.contact.sliding_direction(middle[self.in_contact])

    def named(self, knot: int, pair: int) -> str:
        """Name a tooth pair by its roll angle.

        Parameters
        ----------
        knot : int
            Row of the mesh table.
        pair : int
            Column of the mesh table.

        Returns
        -------
        str
        """
        gears, path = self.contact.pair, float(self.path[knot, pair])
        radius = path if self.contact.direction > 0 else gears.line_of_action_length - path
        return f"the tooth pair at the roll angle {radius / gears.driving.base_radius:.4f} rad"

    def motion(self, pinion_speed: float) -> Kinematics:
        """Curvatures and speeds of the touching pairs.

        Parameters
        ----------
        pinion_speed : float [rad/s]
            Speed of the pinion.

        Returns
        -------
        Kinematics
        """
        return self.contact.kinematics(self.path[self.in_contact], pinion_speed)


def mesh_cycle(pair: SpurPair, steps: int) -> MeshCycle:
    """Place all tooth pairs over one mesh cycle.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position.
    steps : int
        Wanted number of phase intervals, at least 16.

    Returns
    -------
    MeshCycle

    Raises
    ------
    InputError
        If there are too few steps.
    """
    contact = path_of_contact(pair)
    grid = phase_grid(contact.event_phases(), steps)
    middle, in_contact = contact.pair_paths(grid.middle)
    # Advance from the middle of the segment, so that both of its ends keep its pairs.
    path = middle + contact.direction * pair.base_pitch * (grid.phase - grid.middle)[:, None]
    return MeshCycle(contact, grid, path, in_contact)
