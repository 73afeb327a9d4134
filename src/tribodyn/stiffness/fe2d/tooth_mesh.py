"""Finite element mesh of one tooth with its part of the body, graded towards the loaded flank."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.errors import InputError
from tribodyn.gear.tooth_form import ToothForm
from tribodyn.types import Array, Index


@dataclass(frozen=True, eq=False)
class SectorMesh:
    """One sector of a ring that repeats itself, all lengths in one unit of choice."""

    count: int  #: how often the sector is repeated around the ring
    nodes: Array  #: coordinates, the middle of the sector on +y
    elements: Index  #: nodes of each element, first local direction outermost
    right_cut: Index
    left_cut: Index
    fixed: Index  #: nodes that cannot move
    tooth: Index
    #: place of the nodes of the loaded flank as length along it from the base circle, falling; of a
    #: ring, whose tip is nearest to the base circle, negative
    flank_length: Array
    outline: Index  #: nodes of the free boundary from the right cut over the tip to the left cut

    @property
    def sign(self) -> int:
        """1, or -1 of a ring, whose teeth point inwards."""
        tip, foot = np.hypot(*self.nodes[self.tooth[0, [0, -1]]].T)
        return 1 if tip > foot else -1

    def tooth_elements(self, rows: slice = slice(None)) -> Index:
        """Elements of the tooth, or of some rows of its nodes from the tip to the foot."""
        return grid_elements(self.tooth[:: self.sign, rows])


def grid_elements(grid: Index) -> Index:
    """Nine-node elements of a rectangular grid of nodes."""
    parts = [
        grid[i : grid.shape[0] - 2 + i : 2, j : grid.shape[1] - 2 + j : 2].ravel()
        for i in range(3)
        for j in range(3)
    ]
    return np.stack(parts, axis=1)


#: Points of the table from length to parameter of the fillet.
_TABLE = 2001
#: Steepness [rad] of the fillet over the circle where the tooth begins and the body ends.
_FOOT_STEEPNESS = math.radians(45.0)


def _cartesian(radius: Array, angle: Array) -> Array:
    return np.stack([radius * np.sin(angle), radius * np.cos(angle)], axis=-1)


class ToothSide:
    """Half of the outline of a tooth with its axis on +y, all lengths in modules."""

    def __init__(self, form: ToothForm) -> None:
        self.form, self.sign = form, form.sign
        module = form.normal_module
        self.base_radius = form.base_radius / module
        self.root_radius = form.root_radius / module
        self.tip_radius = form.tip_radius / module
        self.pitch_angle = math.pi / abs(form.teeth)
        self.tip_length = self._involute_length(form.tip_radius)
        self.form_length = self._involute_length(form.form_radius)

    def _involute_length(self, radius: float) -> float:
        base = self.form.base_radius
        roll = self.form.roll_angle(max(radius, base))
        return 0.5 * self.sign * self.base_radius * roll * roll

    @cached_property
    def _fillet(self) -> tuple[Array, Array, int]:
        """Parameter and length of the fillet from the form circle down, and index of the foot."""
        angle = np.linspace(self.form.form_normal_angle, 0.5 * math.pi, _TABLE)
        places = self._fillet_at(angle)
        step = np.hypot(*np.diff(places, axis=0).T)
        length = np.concatenate([[0.0], np.cumsum(step)])
        radius = np.hypot(*places.T)
        middle = 0.5 * (places[1:] + places[:-1])
        outward = self.sign * middle / np.hypot(*middle.T)[:, None]
        fall = -np.einsum("ix,ix->i", np.diff(places, axis=0), outward)
        along = np.einsum(
            "ix,ix->i", np.diff(places, axis=0), outward[:, ::-1] * [self.sign, -self.sign]
        )
        flat = (np.arctan2(fall, along) < _FOOT_STEEPNESS) & (self.sign * np.diff(radius) <= 0.0)
        steep = np.flatnonzero(~flat)
        foot = min(int(steep[-1]) + 1 if steep.size else 0, int(0.9 * _TABLE))
        return angle, length, foot

    def _fillet_at(self, angle: Array) -> Array:
        curve = self.form.trochoid
        radius = curve.radius(angle) / self.form.normal_module
        return _cartesian(radius, curve.half_tooth_angle(angle))

    @property
    def foot_length(self) -> float:
        """Length of the fillet from the form circle to the foot of the tooth."""
        _, length, foot = self._fillet
        return float(length[foot])

    def flank_points(self, length: Array) -> Array:
        """Points from the tip to the foot."""
        angle, fillet_length, _ = self._fillet
        on_fillet = length < self.form_length
        along = np.abs(np.where(on_fillet, self.form_length, length))
        roll = np.sqrt(2.0 * along / self.base_radius)
        radius = self.base_radius * np.hypot(1.0, roll)
        turn = self.form.base_half_angle - self.sign * (roll - np.arctan(roll))
        flank = _cartesian(radius, turn)
        below = np.interp(self.form_length - length, fillet_length, angle)
        return np.where(on_fillet[..., None], self._fillet_at(below), flank)

    def root_points(self, share: Array) -> Array:
        """Points of the lower fillet and the root land."""
        angle, length, foot = self._fillet
        begin = float(self.form.trochoid.half_tooth_angle(0.5 * math.pi))
        land = max(self.root_radius * (self.pitch_angle - begin), 0.0)
        fillet_length = length[-1] - length[foot]
        along = share * (land + fillet_length)
        on_fillet = self._fillet_at(np.interp(length[-1] - (along - land), length, angle))
        turn = self.pitch_angle - np.minimum(along, land) / self.root_radius
        on_land = _cartesian(np.full_like(turn, self.root_radius), turn)
        points = np.where((along < land)[..., None], on_land, on_fillet)
        # the cut between two teeth is exactly a radius
        ends = _cartesian(np.hypot(*points.T).T, np.full(points.shape[:-1], self.pitch_angle))
        return np.where((share == 0.0)[..., None], ends, points)


#: Least thickness of the rim under the root circle [modules].
_THINNEST_RIM = 0.1


@dataclass(frozen=True)
class MeshSize:
    """Sizes of the elements over the module.

    Parameters
    ----------
    flank : float [-]
        Size along and across the loaded flank.
    largest : float [-]
        Largest size in tooth and root.
    growth : float [-]
        Ratio of neighbouring elements away from the flank.
    body_growth : float [-]
        Growth of the radial size per depth under the root.
    body_ratio : float
        Largest radial size over the radius.
    root : int
        Least number of elements over half a root.
    """

    flank: float = 0.05
    largest: float = 0.09
    growth: float = 1.3
    body_growth: float = 0.3
    body_ratio: float = 0.17
    root: int = 3

    def refined(self, factor: float) -> MeshSize:
        """Mesh with smaller elements everywhere.

        Parameters
        ----------
        factor : float
            By how much smaller.
        """
        return MeshSize(
            self.flank / factor,
            self.largest / factor,
            self.growth ** (1.0 / factor),
            self.body_growth / factor,
            self.body_ratio / factor,
            self.root,
        )


def _graded(length: float, first: float, largest: float, growth: float) -> Array:
    """Edges from 0 to ``length`` of elements that grow from ``first`` up to ``largest``."""
    edges, step = [0.0], first
    while edges[-1] < length:
        edges.append(edges[-1] + step)
        step = min(step * growth, largest)
    if len(edges) > 2 and length - edges[-2] < 0.5 * (edges[-1] - edges[-2]):
        edges.pop()
    return np.array(edges) * (length / edges[-1])


def _even(length: float, size: float, least: int = 1) -> Array:
    return np.linspace(0.0, length, max(least, math.ceil(length / size)) + 1)


def with_middles(edges: Array) -> Array:
    """Edges with the middles between them."""
    full = np.empty(2 * edges.size - 1)
    full[::2] = edges
    full[1::2] = 0.5 * (edges[1:] + edges[:-1])
    return full


def tooth_mesh(
    form: ToothForm,
    bore_radius: float,
    size: MeshSize | None = None,
    refined: tuple[float, float] | None = None,
) -> SectorMesh:
    """Mesh of the sector of one tooth; ``refined``: a place of the flank and a size there."""
    size = size or MeshSize()
    side = ToothSide(form)
    bore = bore_radius / form.normal_module
    _check_rim(form, bore_radius)
    first = refined[1] if refined else size.flank
    across = with_middles(_across(side, size, first))
    edges = _graded_edges(side, size, *refined) if refined else _flank_edges(side, size)
    lengths, lowest = with_middles(edges), float(edges[-2] - edges[-1]) if refined else math.inf
    tooth = _tooth_points(side, lengths, across)
    root = side.root_points(with_middles(_root_shares(side, size, lowest)))
    top = np.concatenate([root[:-1], tooth[:, -1], (root * [-1.0, 1.0])[-2::-1]])
    body = _body_points(top, with_middles(_body_levels(side, bore, size, lowest)), bore)
    return numbered_sector(abs(form.teeth), form.sign, tooth, body, lengths)


def _check_rim(form: ToothForm, bore_radius: float) -> None:
    rim = form.sign * (form.root_radius - bore_radius)
    if rim < _THINNEST_RIM * form.normal_module:
        name, change = ("rim", "larger") if form.sign < 0 else ("bore", "smaller")
        raise InputError(
            f"the {name} of {2e3 * bore_radius:.4g} mm leaves a rim of {rim * 1e3:.3g} mm",
            where=f"{name}_diameter",
            why=f"The finite element model needs {_THINNEST_RIM:g} modules, "
            f"{_THINNEST_RIM * form.normal_module * 1e3:.3g} mm",
            remedy=f"Give a {change} {name}",
        )


def _across(side: ToothSide, size: MeshSize, first: float) -> Array:
    """Shares of the thickness, from the loaded flank (0) to the other (1)."""
    middle = side.flank_points(np.array(0.5 * (side.tip_length + side.form_length)))
    thickness = 2.0 * float(middle[0])
    return _graded(thickness, first, size.largest, size.growth) / thickness


def _flank_edges(side: ToothSide, size: MeshSize) -> Array:
    """Lengths along the flank from the tip to the foot, falling."""
    flank = side.tip_length - _even(side.tip_length - side.form_length, size.flank, 8)
    fillet = _graded(side.foot_length, size.flank, size.largest, size.growth)
    return np.concatenate([flank[:-1], side.form_length - fillet])


def _graded_edges(side: ToothSide, size: MeshSize, place: float, first: float) -> Array:
    """The same with elements that grow from a size at a place."""
    foot = side.form_length - side.foot_length
    above = _graded(side.tip_length - place, first, size.flank, size.growth)
    below = _graded(place - foot, first, size.largest, size.growth) if place > foot else np.zeros(1)
    return np.concatenate([place + above[:0:-1], place - below])


def _root_shares(side: ToothSide, size: MeshSize, last: float) -> Array:
    """Shares of the root from the cut (0) to the foot (1), where elements have a size at most."""
    points = side.root_points(np.linspace(0.0, 1.0, 65))
    length = float(np.hypot(*np.diff(points, axis=0).T).sum())
    if last < size.largest:
        return 1.0 - _graded(length, last, size.largest, size.growth)[::-1] / length
    return _even(1.0, size.largest / length, size.root)


def _tooth_points(side: ToothSide, lengths: Array, across: Array) -> Array:
    """Transfinite interpolation between both flanks, tip arc and foot arc, shape (a, b, 2)."""
    right = side.flank_points(lengths)
    left = right * [-1.0, 1.0]
    u = across[:, None, None]
    v = ((lengths[0] - lengths) / (lengths[0] - lengths[-1]))[None, :, None]
    tip, foot = (_arc(right[end], across)[:, None] for end in (0, -1))
    straight = (1.0 - u) * right[None] + u * left[None]
    corners = (1.0 - v) * straight[:, :1] + v * straight[:, -1:]
    return np.asarray(straight + (1.0 - v) * tip + v * foot - corners)


def _arc(begin: Array, share: Array) -> Array:
    """Arc around the centre from a point to its mirror image."""
    angle = math.atan2(begin[0], begin[1]) * (1.0 - 2.0 * share)
    return np.asarray(np.hypot(*begin) * np.stack([np.sin(angle), np.cos(angle)], axis=-1))


def _body_levels(side: ToothSide, bore: float, size: MeshSize, first: float) -> Array:
    """Shares of the depth from the root (0) to the bore (1), of elements that grow from a size."""
    depths, thickness = [0.0], side.sign * (side.root_radius - bore)
    while depths[-1] < thickness:
        radius = side.root_radius - side.sign * depths[-1]
        step = min(size.largest + size.body_growth * depths[-1], size.body_ratio * radius)
        first *= size.growth
        step = min(step, first)
        depths.append(depths[-1] + step)
    if len(depths) > 4 and depths[-1] - thickness > 0.5 * (depths[-1] - depths[-2]):
        depths.pop()
    if len(depths) < 4:
        depths = list(np.linspace(0.0, depths[-1], 4))
    return np.array(depths) / depths[-1]


def _body_points(top: Array, levels: Array, bore: float) -> Array:
    """Columns from the top edge to the bore in polar coordinates, shape (columns, levels, 2)."""
    radius, angle = np.hypot(*top.T)[:, None], np.arctan2(*top.T)[:, None]
    radii = radius + (bore - radius) * levels
    return _cartesian(radii, angle)


def numbered_sector(count: int, sign: int, tooth: Array, body: Array, lengths: Array) -> SectorMesh:
    """Join the two grids: the lowest row of the tooth is a part of the top row of the body."""
    side_columns = (body.shape[0] - tooth.shape[0]) // 2
    under = np.arange(body.shape[0] * body.shape[1]).reshape(body.shape[:2])
    upper = under.size + np.arange(tooth.shape[0] * (tooth.shape[1] - 1))
    foot = under[side_columns : side_columns + tooth.shape[0], :1]
    grid = np.concatenate([upper.reshape(tooth.shape[0], -1), foot], axis=1)
    outline = np.concatenate(
        [
            under[:side_columns, 0],
            grid[0, ::-1],
            grid[1:-1, 0],
            grid[-1],
            under[side_columns + tooth.shape[0] :, 0],
        ]
    )
    # anticlockwise elements; the tip of a ring is inside
    around = slice(None, None, sign)
    return SectorMesh(
        count=count,
        nodes=np.concatenate([body.reshape(-1, 2), tooth[:, :-1].reshape(-1, 2)]),
        elements=np.concatenate([grid_elements(under[around]), grid_elements(grid[around])]),
        right_cut=under[0, :-1],
        left_cut=under[-1, :-1],
        fixed=under[:, -1],
        tooth=grid,
        flank_length=lengths,
        outline=outline,
    )
