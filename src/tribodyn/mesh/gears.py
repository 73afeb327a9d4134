"""The gears behind a mesh table, and how its force acts on them in a plane and in space.

Coordinates of a gear in space: ``x`` across the line of action in the direction of the surface
speeds, ``y`` along the line of action, ``z`` along the axes in the sense of the pinion's rotation,
the rotations about x and y, and the rotation about its axis, positive in its running sense.
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.contact.face_contacts import entry_delay
from tribodyn.contact.path import pitch_point_age
from tribodyn.errors import InputError, quiet
from tribodyn.gear import BasicRack, FlankModification, ProfileMap, SpurGear, SpurPair
from tribodyn.mesh.grid import PhaseGrid
from tribodyn.nomenclature import GEARS
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.mesh.columns import MeshColumns

#: Coordinates of a gear pair: across and along the line of action, and the angle of each gear.
COORDINATES = tuple(f"{gear}_{way}" for gear in GEARS for way in ("x", "y", "theta"))

#: The same of gears that move in space, each in a frame whose y axis is its own: theta is about y.
SPATIAL_COORDINATES = tuple(
    f"{gear}_{way}" for gear in GEARS for way in ("x", "y", "z", "theta_x", "theta", "theta_z")
)


def coordinates_of(count: int) -> tuple[str, ...]:
    """Names of this many coordinates."""
    return SPATIAL_COORDINATES if count == len(SPATIAL_COORDINATES) else COORDINATES


def plane_direction(driver: str, first: float, second: float) -> Array:
    """Change of the compression with each of the :data:`COORDINATES`, by both base radii."""
    sign = 1.0 if driver == GEARS[0] else -1.0
    return np.asarray(sign * np.array([0.0, 1.0, first, 0.0, -1.0, -second]))


def column_of(columns: Array, coordinate: str) -> Array:
    """What belongs to one coordinate."""
    return np.asarray(columns[..., coordinates_of(columns.shape[-1]).index(coordinate)])


def lever(direction: Array, coordinate: str, grid: PhaseGrid) -> float:
    """Lever of the normal force on a gear, over the cycle [m]."""
    column = column_of(direction, coordinate)
    return abs(float(column if column.ndim == 0 else grid.mean(column)))


class NoGears:
    """Placeholder for the gear pair in a mesh table of another program, which has none."""

    def __getattr__(self, name: str) -> NoReturn:
        """Answer every question about the gears with one sentence."""
        if name.startswith("__"):
            raise AttributeError(name)
        what = "this mesh table has no gear pair"
        why = "Another program made it, and such a table knows contacts, not gears"
        raise InputError(what, "MeshTable.gear_pair", why, "Use the columns of the table")

    def __repr__(self) -> str:
        """One line."""
        return "no gear pair"


#: Gears of a table, or :class:`NoGears` where there are none.
Gears = SpurPair


@dataclass(frozen=True)
class GearData:
    """The spur gears behind a mesh table; tables of other programs have none."""

    pair: SpurPair  #: both gears in their working position

    @property
    def direction(self) -> Array:
        """Change of the compression with each of the :data:`COORDINATES` [1 or m]."""
        first, second = (gear.base_radius for gear in self.pair.gears.values())
        return plane_direction(self.pair.driver, first, second)

    @cached_property
    def pitch_point_age(self) -> float | None:
        """Mesh cycles from entry to pitch point; None where that is outside of the contact."""
        contact = path_of_contact(self.pair)
        age = pitch_point_age(contact)
        return float(age) if 0.0 <= age < contact.contact_ratio else None

    def entry_delay(self, slices: int) -> Array:
        """Mesh cycles between the entry of a pair and that of each slice of the face (s,)."""
        return entry_delay(path_of_contact(self.pair), slices)

    def written(self) -> str:
        """The gears as text for a file."""
        return json.dumps(asdict(self.pair))


@lru_cache(maxsize=8)
def gear_data(pair: SpurPair) -> GearData:
    """What follows from a pair: the same object in the tables of a study."""
    return GearData(pair)


def read_pair(text: str) -> SpurPair:
    """Gears that :meth:`GearData.written` wrote."""
    values = json.loads(text)
    with quiet():
        # Whoever made the table has seen what there was to say about these gears.
        for name in GEARS:
            rack = BasicRack(**values[name].pop("rack"))
            modification = _read_modification(values[name].pop("modification", {}))
            values[name] = SpurGear(rack=rack, modification=modification, **values[name])
        return SpurPair(**values)


def _read_modification(values: Tree) -> FlankModification:
    """Modification of a gear; tables from before there were any have none."""
    chart = values.pop("profile_map", None)
    return FlankModification(profile_map=ProfileMap(**chart) if chart else None, **values)


def load_center(mesh: MeshColumns) -> tuple[Array, Array, Array]:
    """Centre of the load: transverse radii of curvature of both gears, face position (n,) [m]."""
    face = mesh.face_position
    on_face = np.zeros(mesh.path.shape) if face is None else np.broadcast_to(face, mesh.path.shape)
    columns = mesh.pinion_curvature_radius, mesh.wheel_curvature_radius, on_face
    first, second, middle = (mesh.by_share(column) for column in columns)
    return first, second, middle


def axial_ratio(mesh: MeshColumns) -> float:
    """Axial force on the wheel over the transverse force on it, driven by the pinion."""
    pair = mesh.gear_pair
    return (-1.0 if pair.hand == "right" else 1.0) * math.tan(pair.base_helix_angle)


def spatial_columns(mesh: MeshColumns) -> dict[str, Array]:
    """Direction and friction (n, 12) of a mesh over the coordinates of both gears."""
    # With the place r of the load from the axis of a gear, its force per transverse force is
    # n = s (0, 1, a) on the wheel and -n on the pinion, s = -1 where the wheel drives, and the
    # moments are r x n.
    first, second, face = load_center(mesh)
    sense = 1.0 if mesh.driver == "pinion" else -1.0
    lean, zero = axial_ratio(mesh), np.zeros(face.size)
    radii = mesh.base_radius_pinion, mesh.base_radius_wheel
    levers = [np.full(face.size, radius) for radius in radii]
    # The contact lies on one side of both axes of an internal pair.
    opposite = levers[1] * mesh.gear_pair.wheel.sign
    towards = sense * np.ones(face.size)
    direction = (
        *(zero, towards, lean * towards),
        *(face - sense * first * lean, -towards * lean * levers[0], towards * levers[0]),
        *(zero, -towards, -lean * towards),
        *(-face - sense * second * lean, -towards * lean * opposite, -towards * levers[1]),
    )
    across, couple = mesh.friction_sum, mesh.friction_couple
    turns = mesh.friction_moment_pinion, mesh.friction_moment_wheel
    friction = (
        *(across, zero, zero, zero, -couple, turns[0]),
        *(-across, zero, zero, zero, couple, -turns[1]),
    )
    return {"direction": np.stack(direction, axis=1), "friction": np.stack(friction, axis=1)}
