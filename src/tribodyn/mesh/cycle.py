"""One mesh cycle as places: where every tooth pair is at every knot, and whether it touches."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.contact import Kinematics, PathOfContact, path_of_contact
from tribodyn.gear import SpurPair
from tribodyn.mesh.grid import PhaseGrid, phase_grid
from tribodyn.types import Array, Mask


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """Places of all tooth pairs over one mesh cycle; made by :func:`mesh_cycle`."""

    contact: PathOfContact  #: path of contact of the pair
    grid: PhaseGrid  #: knots on the mesh phase, twice at each event
    path: Array  #: distance of each contact from the pinion's base tangent point [m]
    in_contact: Mask  #: whether the pair is in contact

    @cached_property
    def age(self) -> Array:
        """Mesh cycles since the pair entered, of the touching pairs."""
        return np.asarray(self._aged(self.grid.phase))

    @cached_property
    def side(self) -> Array:
        """Age in the middle of the segment of each knot: which side of an event is meant."""
        return np.asarray(self._aged(self.grid.middle))

    def _aged(self, phase: Array) -> Array:
        return (phase[:, None] + np.arange(self.path.shape[1]))[self.in_contact]

    @cached_property
    def sliding_direction(self) -> Array:
        """Sign of the sliding speed of the touching pairs, never zero."""
        middle = self.contact.pair_paths(self.grid.middle)[0]
        return self.contact.sliding_direction(middle[self.in_contact])

    def named(self, knot: int, pair: int) -> str:
        """Name a tooth pair by its roll angle."""
        gears, path = self.contact.pair, float(self.path[knot, pair])
        radius = path if self.contact.direction > 0 else gears.line_of_action_length - path
        return f"the tooth pair at the roll angle {radius / gears.driving.base_radius:.4f} rad"

    def motion(self, pinion_speed: float) -> Kinematics:
        """Curvatures and speeds of the touching pairs."""
        return self.contact.kinematics(self.path[self.in_contact], pinion_speed)


def mesh_cycle(pair: SpurPair, steps: int) -> MeshCycle:
    """Place all tooth pairs over one mesh cycle."""
    contact = path_of_contact(pair)
    grid = phase_grid(contact.event_phases(), steps)
    middle, in_contact = contact.pair_paths(grid.middle)
    # Advance from the middle of the segment, so that both of its ends keep its pairs.
    path = middle + contact.direction * pair.base_pitch * (grid.phase - grid.middle)[:, None]
    return MeshCycle(contact, grid, path, in_contact)
