"""Mass and inertia of gears: what is given, else those of a solid body around the shaft."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tribodyn.errors import Problem
from tribodyn.gear.hypoid.bodies import cone_bodies
from tribodyn.machine.fields import display
from tribodyn.machine.gear import Gear
from tribodyn.machine.mesh import Mesh
from tribodyn.machine.section import STEEL
from tribodyn.machine.shaft import SAME_PLACE, Shaft

#: Outer over reference diameter of a ring, in modules: the root, and a rim of 3.75 modules.
_RIM = 10.0
#: Gauss-Legendre points; exact for the fourth power of a linear radius.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True)
class GearBody:
    """Mass and inertia of a gear, without its shaft.

    Parameters
    ----------
    mass : float
        Mass [kg].
    moment_of_inertia : float
        Polar moment of inertia [kg*m^2].
    transverse_moment_of_inertia : float
        Moment of inertia about an axis in the mid plane [kg*m^2].

    Notes
    -----
    What is not prescribed is that of a steel cylinder of the reference diameter, less what the
    shaft fills; a ring reaches from its reference diameter to ten modules beyond, and bevel gears
    are truncated pitch cones. A prescribed mass scales the moments of inertia of the solid; of a
    gear that is not larger than its shaft the transverse one is ``J / 2 + m b^2 / 12``.
    """

    mass: float
    moment_of_inertia: float
    transverse_moment_of_inertia: float


def gear_body(gear: Gear, mesh: Mesh | None, shaft: Shaft, number: int = 0) -> GearBody:
    """Body of the first or second gear of a mesh: prescribed values, else those of the solid."""
    values = gear.mass, gear.moment_of_inertia, gear.transverse_moment_of_inertia
    if mesh is None or None not in values:
        return GearBody(*(value or 0.0 for value in values))
    if gear.mass is not None and _fills(gear, mesh, shaft):
        # A lumped disc: polar and transverse moments of inertia of any body of revolution whose
        # section is the same over its width.
        polar, transverse = gear.moment_of_inertia or 0.0, gear.transverse_moment_of_inertia
        disc = 0.5 * polar + gear.mass * gear.face_width**2 / 12.0
        return GearBody(gear.mass, polar, disc if transverse is None else transverse)
    solid = _solid(gear, mesh, shaft, number)
    scale = 1.0 if gear.mass is None else gear.mass / solid[0]
    mass, polar, transverse = (
        factor * computed if value is None else value
        for value, computed, factor in zip(values, solid, (1.0, scale, scale), strict=True)
    )
    return GearBody(mass, polar, transverse)


def _solid(gear: Gear, mesh: Mesh, shaft: Shaft, number: int) -> tuple[float, float, float]:
    """Mass and moments of inertia of the solid body."""
    if mesh.crossed is not None:
        cones = cone_bodies(mesh.crossed.blank, STEEL.density)
        return cones["wheel" if number else "pinion"]
    radius = 0.5 * abs(gear.teeth) * mesh.transverse_module
    half = 0.5 * gear.face_width
    outer = radius + (0.5 * _RIM * mesh.normal_module if gear.is_ring else 0.0)
    hollow = [(-half, half, radius, radius)] if gear.is_ring else _filled(gear, shaft)
    mass, polar, transverse = (
        2.0 * half * math.pi * outer**2,
        math.pi * half * outer**4,
        math.pi * half * outer**4 / 2.0 + math.pi * outer**2 * 2.0 * half**3 / 3.0,
    )
    for start, end, first, last in hollow:
        x = 0.5 * (start + end) + 0.5 * (end - start) * _NODES
        weight = 0.5 * (end - start) * _WEIGHTS * math.pi
        r = first + (last - first) * (x - start) / (end - start)
        mass -= float(weight @ r**2)
        polar -= float(weight @ r**4) / 2.0
        transverse -= float(weight @ (r**4 / 4.0 + x**2 * r**2))
    return STEEL.density * mass, STEEL.density * polar, STEEL.density * transverse


def _filled(gear: Gear, shaft: Shaft) -> list[tuple[float, float, float, float]]:
    """Parts of the shaft within the face: begin, end from mid face, and radii there."""
    pieces = []
    low, high = -0.5 * gear.face_width, 0.5 * gear.face_width
    for start, section in zip(shaft.ends, shaft.sections, strict=False):
        begin = max(low, start - gear.node_position)
        end = min(high, start + section.length - gear.node_position)
        if end - begin > SAME_PLACE:
            at = [(x + gear.node_position - start) / section.length for x in (begin, end)]
            radii = [0.5 * section.diameters(fraction)[0] for fraction in at]
            pieces.append((begin, end, radii[0], radii[1]))
    return pieces


def _largest_diameter(gear: Gear, shaft: Shaft) -> float:
    """Largest diameter of the shaft within the face [m]."""
    return 2.0 * max((max(piece[2:]) for piece in _filled(gear, shaft)), default=0.0)


def _fills(gear: Gear, mesh: Mesh, shaft: Shaft) -> bool:
    """Whether the shaft reaches the reference diameter within the face of an external gear."""
    if gear.is_ring or mesh.crossed is not None:
        return False
    return _largest_diameter(gear, shaft) >= gear.teeth * mesh.transverse_module


def body_problems(name: str, gear: Gear, meshes: Sequence[Mesh], shaft: Shaft) -> list[Problem]:
    """A shaft that is thicker than its gear, and a gear in no mesh without a mass."""
    if not meshes:
        if gear.mass is None:
            remedy = "Give its mass and moments of inertia, join it by a mesh, or remove it"
            why = "Without a module its size, and so its mass, is not known"
            return [Problem("the gear is in no mesh", f"gears.{name}", why, remedy)]
        return []
    has_teeth = any(mesh.stiffness is None or mesh.contacts for mesh in meshes)
    is_solid = gear.mass is None or gear.moment_of_inertia is None
    if not _fills(gear, meshes[0], shaft) or not (has_teeth or is_solid):
        return []
    largest = _largest_diameter(gear, shaft)
    diameter = gear.teeth * meshes[0].transverse_module
    return [
        Problem(
            f"the shaft has a diameter of {display(largest, 'm')} within the face of the gear",
            f"gears.{name}.position",
            f"It is not smaller than the reference diameter, {display(diameter, 'm')}",
            f'Move the gear, give shaft "{gear.shaft}" a smaller section there, or give mass and '
            "moment_of_inertia of the gear and the stiffness of its mesh",
        )
    ]
