"""Contacts of a mesh over the coordinates of its two gears, whatever holds them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from tribodyn.dynamics.equations.system import Contact
from tribodyn.dynamics.structure.force_law import MeshForce, carried
from tribodyn.dynamics.structure.gear_pair import (
    SPUR6_NAMES,
    Driver,
    gear_contact,
    pair_of,
    tooth_contact,
)
from tribodyn.dynamics.structure.helical12 import HELICAL12_NAMES, direction_in_space
from tribodyn.dynamics.structure.hypoid14 import HYPOID14_NAMES, directions_of_crossed_axes

if TYPE_CHECKING:
    from tribodyn.mesh import MeshFunctions

#: Where the gears of a mesh move: in their plane, in space, or in space on crossed axes.
Axes = Literal["plane", "space", "crossed"]


def pair_contacts(
    mesh: MeshFunctions,
    axes: Axes,
    *,
    base_radius: tuple[float, float],
    driver: Driver,
    mesh_force: MeshForce,
    **contact: Any,
) -> tuple[tuple[str, ...], tuple[Contact, ...]]:
    """Names of the coordinates of both gears, and the contacts of their teeth over them."""
    names: tuple[str, ...]
    if axes == "plane":
        names, radii = SPUR6_NAMES, pair_of("base_radius", base_radius, "m")
        of_teeth = gear_contact(mesh, names, base_radius=radii, driver=driver, **contact)
    elif axes == "space":
        names = HELICAL12_NAMES
        entries = direction_in_space(mesh), mesh.spatial_friction
        of_teeth = tooth_contact(mesh, *entries, **contact)
    else:
        names = HYPOID14_NAMES[1:-1]
        of_teeth = tooth_contact(mesh, *directions_of_crossed_axes(mesh), **contact)
    return names, carried(of_teeth, mesh, mesh_force)
