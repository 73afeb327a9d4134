"""Axes of the shafts in space, and where each shaft begins along x."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tribodyn.errors import Problem
from tribodyn.machine.fields import display
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.directions import center_distance
from tribodyn.machine.graph.shaft_graph import ShaftGraph, listed
from tribodyn.machine.mesh import Mesh

#: Distance between axes of a loop that is rounding, in modules, and between mid faces [m].
_AXIS, _FACE = 0.02, 1e-5

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Placement:
    """Positions of shafts, gears and bearings in space; the input shaft begins at the origin.

    Parameters
    ----------
    shafts : mapping of str to (float, float, float)
        Where each shaft begins (x, y, z) [m]. The gears of a mesh have the same mid plane, which
        gives each shaft its place along x.
    gears : mapping of str to (float, float, float)
        Middle of each gear [m].
    bearings : mapping of str to (float, float, float)
        Middle of each bearing [m].
    """

    shafts: Mapping[str, Point]
    gears: Mapping[str, Point]
    bearings: Mapping[str, Point]


def on_axis(start: Point, position: float) -> Point:
    """Point at a position on a shaft that begins at ``start``."""
    return start[0] + position, start[1], start[2]


def shaft_starts(
    graph: ShaftGraph, gears: Mapping[str, Gear], meshes: Mapping[str, Mesh]
) -> dict[str, Point]:
    """Where each shaft begins in space, by the meshes of the tree."""

    def step(name: str, forward: bool, start: Point) -> Point:
        sign = 1.0 if forward else -1.0
        return tuple(s + sign * d for s, d in zip(start, _shift(meshes[name], gears), strict=True))  # type: ignore[return-value]

    return graph.propagate((0.0, 0.0, 0.0), step)


def _shift(mesh: Mesh, gears: Mapping[str, Gear]) -> Point:
    """From where the shaft of the first gear begins to where that of the second does."""
    first, second = (gears[gear] for gear in mesh.gears)
    distance = abs(center_distance(mesh, (first, second)))
    across = distance * math.cos(mesh.angle), distance * math.sin(mesh.angle)
    return (first.node_position - second.node_position, *across)


def placement_problems(
    graph: ShaftGraph, gears: Mapping[str, Gear], meshes: Mapping[str, Mesh]
) -> list[Problem]:
    """Loops of meshes whose axes or faces do not close."""
    starts = shaft_starts(graph, gears, meshes)
    problems = []
    for name in graph.loops:
        mesh = meshes[name]
        first, second = graph.edges[name]
        shift = np.array(_shift(mesh, gears))
        wanted = np.subtract(starts[second], starts[first])
        ring = {*graph.path(first), *graph.path(second)} - (
            {*graph.path(first)} & {*graph.path(second)}
        )
        others = listed(sorted(ring, key=list(graph.edges).index))
        if math.dist(wanted[1:], shift[1:]) > _AXIS * mesh.normal_module:
            distance, angle = math.hypot(*wanted[1:]), math.degrees(math.atan2(*wanted[:0:-1]))
            problems.append(
                Problem(
                    f"center_distance = {display(math.hypot(*shift[1:]), 'm')} and angle = "
                    f'{display(mesh.angle, "rad")} put the axis of shaft "{second}" '
                    f"{display(math.dist(wanted[1:], shift[1:]), 'm')} from where {others} put it",
                    f"meshes.{name}.center_distance",
                    "Each shaft has one axis",
                    f"Give center_distance {distance * 1e3:.6g} mm and angle {angle:.6g} deg, or "
                    "correct those of the other meshes",
                )
            )
        gap = abs(float(shift[0] - wanted[0]))
        if gap > _FACE:
            widths = [gears[gear].face_width for gear in mesh.gears]
            overlap, face = 0.5 * sum(widths) - gap, display(min(widths), "m")
            overlapping = f"overlap by {display(min(overlap, min(widths)), 'm')} of {face}"
            faces = overlapping if overlap > 0.0 else "do not overlap"
            problems.append(
                Problem(
                    f"gear {mesh.gears[1]} lies {display(gap, 'm')} along x from gear "
                    f"{mesh.gears[0]}, so that their faces {faces}",
                    f"gears.{mesh.gears[1]}.position",
                    f"The gears of {others} have common mid planes, and so have those of mesh "
                    f"{name}",
                    f"Move one of these gears by {display(gap, 'm')}",
                )
            )
    return problems
