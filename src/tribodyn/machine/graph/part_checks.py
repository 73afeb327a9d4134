"""What cannot run: shafts that nothing drives or holds, misplaced parts, gears that do not mesh."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from tribodyn.errors import Problem
from tribodyn.machine.beam import carried_along
from tribodyn.machine.bearing import Bearing, axial_way, held_by
from tribodyn.machine.fields import display
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.directions import center_distance, reference_center_distance
from tribodyn.machine.graph.mobility import ShaftGraph
from tribodyn.machine.mesh import Mesh
from tribodyn.machine.shaft import SAME_PLACE, Shaft


def drive_problems(
    graph: ShaftGraph, shafts: Mapping[str, Shaft], output: str
) -> Iterator[Problem]:
    """Shafts that no mesh joins to the input, and an output that cannot be one."""
    connected = {graph.root, *(graph.edges[mesh][forward] for mesh, forward in graph.tree)}
    names = ", ".join(name for name in shafts if name in connected)
    if output == graph.root:
        yield Problem(
            f'output = "{output}" is the input too',
            "operation.output",
            "Power enters by one shaft, and leaves by another one through a mesh",
            "Name another shaft",
        )
    for name in shafts:
        if name in connected:
            continue
        why = f'The meshes join the input "{graph.root}" to: {names}'
        remedy = "Add a mesh that joins it, or remove the shaft with its parts"
        if name == output:
            what = f'no mesh joins the output "{output}" to the input "{graph.root}"'
            yield Problem(what, "operation.output", why, remedy)
        yield Problem("nothing drives this shaft", f"shafts.{name}", why, remedy)


def place_problems(
    shafts: Mapping[str, Shaft], gears: Mapping[str, Gear], bearings: Mapping[str, Bearing]
) -> Iterator[Problem]:
    """Gears and bearings off their shaft, and gears that overlap."""
    for group, parts in (("gears", gears), ("bearings", bearings)):
        for name, part in parts.items():
            shaft = shafts[part.shaft]
            if shaft.is_rigid:
                continue
            where = f"{group}.{name}.position"
            reach = f'Shaft "{part.shaft}" reaches from 0 to {display(shaft.length, "m")}'
            if part.position is None:
                remedy = "Give the position of its mid face"
                yield Problem("the position is missing", where, reach, remedy)
            elif not -SAME_PLACE <= part.position <= shaft.length + SAME_PLACE:
                what = f"position = {display(part.position, 'm')} is off the shaft"
                yield Problem(what, where, reach, "Give a position on it, or a longer shaft")
    for first, second in combinations(gears, 2):
        low, high = gears[first], gears[second]
        if low.shaft != high.shaft or low.position is None or high.position is None:
            continue
        faces = 0.5 * (low.face_width + high.face_width)
        overlap = faces - abs(low.position - high.position)
        if overlap > SAME_PLACE and low.is_ring == high.is_ring:
            yield Problem(
                f"position = {display(high.position, 'm')}: gears {first} and {second} are in one "
                f"place, their faces overlap by {display(overlap, 'm')}",
                f"gears.{second}.position",
                f"{first} is at {display(low.position, 'm')} with a face of "
                f"{display(low.face_width, 'm')}, {second} has {display(high.face_width, 'm')}",
                f"Place them at least {display(faces, 'm')} apart",
            )


def support_problems(
    shafts: Mapping[str, Shaft], bearings: Mapping[str, Bearing], pushed: Mapping[str, float]
) -> Iterator[Problem]:
    """Shafts with sections that can move away; ``pushed``: axial forces of meshes [N]."""
    for name, shaft in shafts.items():
        if shaft.is_rigid:
            continue
        where = f"shafts.{name}"
        supports = [bearing for bearing in bearings.values() if bearing.shaft == name]
        if not supports:
            meshed = "Its meshes would push it away"
            why = meshed if name in pushed else "Nothing holds it against moving and tilting"
            remedy = f'Add a bearing with shaft = "{name}", or leave out its sections'
            yield Problem("the shaft has no bearing", where, why, remedy)
            continue
        arms = [(bearing, carried_along(bearing.position)) for bearing in supports]
        support = sum((arm.T @ held_by(bearing) @ arm for bearing, arm in arms), np.zeros((6, 6)))
        lateral = support[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])]
        length = np.array([1.0, 1.0, shaft.length, shaft.length])
        scaled = lateral / np.outer(length, length)
        if np.linalg.eigvalsh(scaled)[0] < 1e-9 * np.abs(scaled).max():
            positions = sorted({bearing.position for bearing in supports})
            places = ", ".join(dict.fromkeys(display(position, "m") for position in positions))
            yield Problem(
                f"its bearings, at {places}, do not hold the shaft against moving across its axis "
                "or tilting",
                where,
                "It needs radial stiffness in y and z at two places, or tilting stiffness",
                "Add a bearing, or give tilting_stiffness",
            )
        force = pushed.get(name, 0.0)
        ways = {axial_way(bearing) for bearing in supports if held_by(bearing)[0, 0] > 0.0}
        if len(ways) == 1 and (way := ways.pop()) and way * force <= 1e-6:
            sign = "+x" if way > 0 else "-x"
            yield Problem(
                f"its bearings hold the shaft against forces along {sign} only, and its meshes "
                f"push it with {force:.6g} N along x",
                where,
                "Bearings with a contact angle carry one direction, and push the shaft the other "
                "way under their radial load",
                "Turn one of them by its direction (1 or -1), or add a bearing that holds it",
            )
        if support[0, 0] <= 0.0 and abs(force) > 1e-6:
            yield Problem(
                f"no bearing holds the shaft along its axis, and its meshes push it with "
                f"{force:.6g} N",
                where,
                "axial_stiffness is 0 by default, and cylindrical roller bearings have none",
                "Give one of its bearings an axial_stiffness, or another type",
            )


#: Properties of the rack that all meshes of one gear share, with unit.
_RACK = {"normal_module": "m", "helix_angle": "rad", "pressure_angle": "rad"}


def mesh_problems(gears: Mapping[str, Gear], meshes: Mapping[str, Mesh]) -> Iterator[Problem]:
    """Problems of single meshes, and of meshes with a common gear."""
    pairs: dict[frozenset[str], str] = {}
    racks: dict[str, str] = {}
    for name, mesh in meshes.items():
        where = f"meshes.{name}.gears"
        first, second = (gears[gear] for gear in mesh.gears)
        if first.shaft == second.shaft:
            yield Problem(
                f'both gears are on shaft "{first.shaft}"',
                where,
                "The gears of a mesh turn with different speeds",
                "Put one of them on another shaft",
            )
        elif (other := pairs.setdefault(frozenset(mesh.gears), name)) != name:
            why, remedy = "Two gears have one mesh", "Remove one of the two meshes"
            yield Problem(f"mesh {other} has the same gears", where, why, remedy)
        elif mesh.crossed is not None:
            yield from _crossed_problems(name, mesh, gears)
        elif first.teeth + second.teeth == 0 or (first.is_ring and second.is_ring):
            yield _no_pair(name, mesh, (first, second), "Two rings, or equal gears, cannot mesh")
        elif (first.is_ring or second.is_ring) and first.teeth + second.teeth > 0:
            yield _no_pair(name, mesh, (first, second), "A ring has more teeth than its gear")
        else:
            yield from _reach(name, mesh, (first, second))
        for gear in mesh.gears:
            if (other := racks.setdefault(gear, name)) == name:
                continue
            if mesh.crossed or meshes[other].crossed:
                why = "A bevel gear has one mesh"
                remedy = "Give each mesh its gears"
                yield Problem(f"gear {gear} is in mesh {other} too", where, why, remedy)
            else:
                yield from _rack_problems(gear, gears, (other, meshes[other]), (name, mesh))


def _crossed_problems(name: str, mesh: Mesh, gears: Mapping[str, Gear]) -> Iterator[Problem]:
    """Gears of a hypoid mesh that are not those of its blank."""
    blank = mesh.crossed.blank if mesh.crossed else None
    for gear, role in zip(mesh.gears, ("pinion", "wheel"), strict=True):
        teeth = getattr(blank, f"teeth_{role}")
        if gears[gear].teeth != teeth:
            what = f"gear {gear} has {gears[gear].teeth} teeth"
            why = f"The {role} of the blank has {teeth}; the first gear is the pinion"
            yield Problem(what, f"meshes.{name}.gears", why, "Correct order or numbers of teeth")


def _no_pair(name: str, mesh: Mesh, gears: tuple[Gear, Gear], why: str) -> Problem:
    teeth = " and ".join(f"{n} {g.teeth}" for n, g in zip(mesh.gears, gears, strict=True))
    remedy = "Correct the numbers of teeth; those of a ring are negative"
    return Problem(f"the numbers of teeth are {teeth}", f"meshes.{name}.gears", why, remedy)


def _reach(name: str, mesh: Mesh, gears: tuple[Gear, Gear]) -> Iterator[Problem]:
    """Centre distances at which the teeth do not engage."""
    reference = abs(reference_center_distance(mesh, gears))
    distance = abs(center_distance(mesh, gears))
    base = reference * math.cos(mesh.transverse_pressure_angle)
    addenda = 2.0 * mesh.normal_module
    internal = gears[0].teeth + gears[1].teeth < 0
    where = f"meshes.{name}.center_distance"
    what = f"center_distance = {display(mesh.center_distance or 0.0, 'm')}"
    remedy = f"Without profile shift it is {display(reference, 'm')}"
    if mesh.center_distance is not None and mesh.center_distance < 0.0 and not internal:
        why = "Only internal gears have a negative centre distance"
        yield Problem(what, where, why, remedy)
    elif distance <= base:
        why = f"The base circles of {' and '.join(mesh.gears)} need more than {display(base, 'm')}"
        yield Problem(what, where, why, remedy)
    elif abs(distance - reference) >= addenda:
        bounds = (reference - addenda if internal else base), reference + addenda
        yield Problem(
            f"{what}: gears {mesh.gears[0]} and {mesh.gears[1]} do not reach each other",
            where,
            f"The addenda of their teeth meet between {display(bounds[0], 'm')} and "
            f"{display(bounds[1], 'm')}",
            remedy,
        )


def _rack_problems(
    gear: str,
    gears: Mapping[str, Gear],
    first: tuple[str, Mesh],
    second: tuple[str, Mesh],
) -> Iterator[Problem]:
    """Differences of the rack or the hand between two meshes of one gear."""
    for key, unit in _RACK.items():
        values = [getattr(mesh, key) for _, mesh in (first, second)]
        if abs(values[0] - values[1]) > 1e-9 * abs(values[0]):
            yield Problem(
                f"{key} = {display(values[1], unit)}, and mesh {first[0]} has "
                f"{display(values[0], unit)}",
                f"meshes.{second[0]}.{key}",
                f"Both meshes have the gear {gear}, whose teeth have one {key.replace('_', ' ')}",
                "Give both meshes the same value",
            )
    hands = [gear_hand(gear, gears, mesh) for _, mesh in (first, second)]
    if hands[0] != hands[1] and second[1].helix_angle > 0.0:
        yield Problem(
            f'hand = "{second[1].hand}" makes gear {gear} a {hands[1]}-hand gear, and mesh '
            f"{first[0]} makes it a {hands[0]}-hand one",
            f"meshes.{second[0]}.hand",
            "It is that of the first gear; external gears have opposite hands, internal ones equal",
            f"Change the hand of mesh {second[0]}, or that of mesh {first[0]}",
        )


def gear_hand(gear: str, gears: Mapping[str, Gear], mesh: Mesh) -> str:
    """Hand of one of the gears of a mesh."""
    internal = any(gears[name].is_ring for name in mesh.gears)
    if gear == mesh.gears[0] or internal:
        return mesh.hand
    return "left" if mesh.hand == "right" else "right"
