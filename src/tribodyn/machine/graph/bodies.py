"""Mass and inertia of gears: what is given, else those of a solid body around the shaft."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tribodyn.errors import Problem
from tribodyn.gear import MassProperties, section_moments
from tribodyn.gear.cylindrical_gear import RIM_COEFFICIENT
from tribodyn.gear.hypoid.blank import cone_bodies
from tribodyn.gear.mass_properties import Hole, body_properties, ring_section
from tribodyn.machine.fields import display
from tribodyn.machine.gear import Gear
from tribodyn.machine.mesh import Mesh
from tribodyn.machine.shaft import SAME_PLACE, Shaft

#: Root circle of a ring whose tooth form is not known, over its reference circle, in modules.
_DEDENDUM = 1.25

#: Mass and inertia of a gear, without its shaft.
GearBody = MassProperties


def gear_body(gear: Gear, mesh: Mesh | None, shaft: Shaft, number: int = 0) -> GearBody:
    """Body of the first or second gear of a mesh: prescribed values, else those of the solid."""
    # The toothed section, or a disc of the reference diameter, less the larger of shaft and bore;
    # bevel gears are truncated pitch cones.
    values = gear.mass, gear.moment_of_inertia, gear.transverse_moment_of_inertia
    if mesh is None or None not in values:
        return GearBody(*(value or 0.0 for value in values))
    if gear.mass is not None and _fills(gear, mesh, shaft):
        # A lumped disc: polar and transverse moments of inertia of any body of revolution whose
        # section is the same over its width.
        polar, transverse = gear.moment_of_inertia or 0.0, gear.transverse_moment_of_inertia
        disc = 0.5 * polar + gear.mass * gear.face_width**2 / 12.0
        return GearBody(gear.mass, polar, disc if transverse is None else transverse)
    if mesh.crossed is not None:
        solid = cone_bodies(mesh.crossed.blank, gear.density)["wheel" if number else "pinion"]
    else:
        section = _section(gear, mesh)
        holes = () if gear.is_ring else _holes(gear, shaft)
        solid = body_properties(section, gear.face_width, gear.density, holes)
    return solid.with_values(*values)


def _section(gear: Gear, mesh: Mesh) -> tuple[float, float]:
    """Area and polar moment of area of a gear without a bore [m^2, m^4]."""
    radius, form = 0.5 * abs(gear.teeth) * mesh.transverse_module, gear.form
    disc = math.pi * radius**2, 0.5 * math.pi * radius**4
    section = disc if form is None else section_moments(form)
    if not gear.is_ring:
        return section
    root = radius + _DEDENDUM * mesh.normal_module if form is None else form.root_radius
    rim = root + RIM_COEFFICIENT * mesh.normal_module
    return ring_section(section, rim if gear.rim_diameter is None else 0.5 * gear.rim_diameter)


def _net_area(gear: Gear, mesh: Mesh) -> float:
    """Area of the section less the bore [m^2]."""
    return _section(gear, mesh)[0] - 0.25 * math.pi * gear.bore_diameter**2


def _holes(gear: Gear, shaft: Shaft) -> list[Hole]:
    """What the shaft fills within the face, or the bore where that is larger."""
    low, high, bore = -0.5 * gear.face_width, 0.5 * gear.face_width, 0.5 * gear.bore_diameter
    holes, end = [], low
    for begin, last, *radii in _filled(gear, shaft):
        holes.append((end, begin, bore, bore))
        holes += _at_least(bore, (begin, last, radii[0], radii[1]))
        end = last
    return [hole for hole in (*holes, (end, high, bore, bore)) if hole[1] > hole[0]]


def _at_least(bore: float, hole: Hole) -> list[Hole]:
    """Cone widened to a bore; where it crosses the bore it is divided."""
    begin, end, first, last = hole
    if (first - bore) * (last - bore) >= 0.0:
        return [(begin, end, max(first, bore), max(last, bore))]
    middle = begin + (end - begin) * (bore - first) / (last - first)
    return [
        (begin, middle, max(first, bore), bore),
        (middle, end, bore, max(last, bore)),
    ]


def _filled(gear: Gear, shaft: Shaft) -> list[Hole]:
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
    """A gear in no mesh without a mass, and a bore, a rim or a shaft that leaves nothing of it."""
    if not meshes:
        if gear.mass is None:
            remedy = "Give its mass and moments of inertia, join it by a mesh, or remove it"
            why = "Without a module its size, and so its mass, is not known"
            return [Problem("the gear is in no mesh", f"gears.{name}", why, remedy)]
        return []
    if meshes[0].crossed is None and not _net_area(gear, meshes[0]) > 0.0:
        key = "rim_diameter" if gear.is_ring else "bore_diameter"
        what, where = f"{key} = {display(getattr(gear, key), 'm')}", f"gears.{name}.{key}"
        why = "Nothing is left between it and the teeth"
        return [Problem(what, where, why, f"{'Increase' if gear.is_ring else 'Reduce'} it")]
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
