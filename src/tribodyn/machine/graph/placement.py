"""Axes of the shafts in space, and where each shaft begins along x."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from tribodyn.errors import Problem
from tribodyn.machine.beam import carried_across
from tribodyn.machine.bearing import Bearing
from tribodyn.machine.fields import display
from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.directions import center_distance
from tribodyn.machine.graph.mobility import ShaftGraph, listed
from tribodyn.machine.mesh import Mesh
from tribodyn.types import Array

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
    axes : mapping of str to (3, 3) array
        Directions x, y, z of the coordinates of each shaft, as columns, in those of the input
        shaft [1]; other than the unit matrix behind a mesh of crossed axes.
    """

    shafts: Mapping[str, Point]
    gears: Mapping[str, Point]
    bearings: Mapping[str, Point]
    axes: Mapping[str, Array] = field(default_factory=dict)


class Pose(NamedTuple):
    """Where a shaft begins, and its axes as columns."""

    start: Point
    axes: Array

    def on_axis(self, position: float) -> Point:
        """Point at a position on the shaft."""
        return _point(np.add(self.start, position * self.axes[:, 0]))


def carrier_axes(
    gears: Mapping[str, Gear], meshes: Mapping[str, Mesh], bearings: Mapping[str, Bearing]
) -> dict[str, tuple[str, str, float]]:
    """Shaft with the axis of each carrier, the carrier, and its distance along x [m], by key."""
    axes: dict[str, tuple[str, str, float]] = {}
    latest_first = reversed([*bearings.values()])
    pins: dict[tuple[str | None, str], Bearing] = {
        (b.carrier, b.shaft): b for b in latest_first if b.carrier
    }
    for mesh in meshes.values():
        for central, planet in (mesh.gears, mesh.gears[::-1]):
            inner, outer = gears[central], gears[planet]
            pin = pins.get((mesh.carrier, outer.shaft))
            if pin is None or mesh.carrier is None or (mesh.carrier, inner.shaft) in pins:
                continue
            along = inner.node_position - outer.node_position
            along += pin.position - pin.carrier_position
            axes.setdefault(f"shafts.{mesh.carrier}", (inner.shaft, mesh.carrier, along))
    return axes


def pin_lever(place: Placement, bearing: Bearing) -> Array:
    """Displacement of the pin of a bearing per displacement of its carrier (6, 6)."""
    carrier = bearing.carrier or ""
    between = np.subtract(place.shafts[bearing.shaft], place.shafts[carrier])
    _, y, z = (between @ place.axes[carrier]).tolist()
    return carried_across(y, z)


def shaft_poses(
    graph: ShaftGraph,
    gears: Mapping[str, Gear],
    meshes: Mapping[str, Mesh],
    lengths: Mapping[str, float],
) -> dict[str, Pose]:
    """How each shaft lies in space, by the tree; lengths are those of couplings and carriers."""

    def step(name: str, forward: bool, pose: Pose) -> Pose:
        shift, turn = _step(name, gears, meshes, lengths)
        axes = pose.axes @ (turn if forward else turn.T)
        sign, frame = (1.0, pose.axes) if forward else (-1.0, axes)
        return Pose(_point(np.add(pose.start, sign * (frame @ shift))), axes)

    return graph.propagate(Pose((0.0, 0.0, 0.0), np.eye(3)), step)


def _point(values: Array) -> Point:
    x, y, z = values.tolist()
    return x, y, z


def _step(
    name: str,
    gears: Mapping[str, Gear],
    meshes: Mapping[str, Mesh],
    lengths: Mapping[str, float],
) -> tuple[Array, Array]:
    """From the beginning of the first shaft to that of the second, and its axes as columns."""
    if name in lengths:  # a coupling behind the first shaft, or a carrier on its axis
        return np.array([lengths[name], 0.0, 0.0]), np.eye(3)
    mesh = meshes[name]
    pair = mesh.crossing
    if pair is None:
        return np.array(_shift(mesh, gears)), np.eye(3)
    first, second = (gears[gear].node_position for gear in mesh.gears)
    return first * np.eye(3)[0] + pair.shift - second * pair.turn[:, 0], pair.turn


def _shift(mesh: Mesh, gears: Mapping[str, Gear]) -> Point:
    """The same of parallel shafts."""
    first, second = (gears[gear] for gear in mesh.gears)
    distance = abs(center_distance(mesh, (first, second)))
    across = distance * math.cos(mesh.angle), distance * math.sin(mesh.angle)
    return (first.node_position - second.node_position, *across)


def placement_problems(
    graph: ShaftGraph,
    gears: Mapping[str, Gear],
    meshes: Mapping[str, Mesh],
    lengths: Mapping[str, float],
) -> list[Problem]:
    """Loops of meshes whose axes or faces do not close."""
    poses = shaft_poses(graph, gears, meshes, lengths)
    problems = []
    for name in graph.loops:
        first, second = graph.edges[name]
        shift, turn = _step(name, gears, meshes, lengths)
        frame = poses[first].axes
        wanted = np.subtract(poses[second].start, poses[first].start) @ frame
        if not np.allclose(frame @ turn, poses[second].axes, atol=1e-6) or (
            (name not in meshes or meshes[name].crossing) and math.dist(wanted, shift) > _FACE
        ):
            kind = "meshes." if name in meshes else "" if "." in name else "couplings."
            what = f'it puts shaft "{second}" in another place than the other meshes of its loop'
            remedy = "Correct positions, angles and apex sides, or remove it"
            problems.append(Problem(what, f"{kind}{name}", "Each shaft has one axis", remedy))
            continue
        mesh = meshes[name]
        ring = {*graph.path(first), *graph.path(second)} - (
            {*graph.path(first)} & {*graph.path(second)}
        )
        others = listed(sorted(ring & {*meshes}, key=list(graph.edges).index))
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
