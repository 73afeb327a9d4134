"""Shafts that nothing drives or holds, and parts that are not where they can be."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from tribodyn.errors import Problem
from tribodyn.machine.beam import carried_along
from tribodyn.machine.bearing import Bearing, held_by
from tribodyn.machine.fields import display
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.shaft_graph import ShaftGraph
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
    """Gears and bearings beside their shaft, and gears in one place."""
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
                what = f"position = {display(part.position, 'm')} is beside the shaft"
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
        if support[0, 0] <= 0.0 and abs(force := pushed.get(name, 0.0)) > 1e-6:
            yield Problem(
                f"no bearing holds the shaft along its axis, and its meshes push it with "
                f"{force:.6g} N",
                where,
                "axial_stiffness is 0 by default, and cylindrical roller bearings have none",
                "Give one of its bearings an axial_stiffness, or another type",
            )
