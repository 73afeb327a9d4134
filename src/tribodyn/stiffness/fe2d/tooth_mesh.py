"""Mesh of the sector of one tooth: graded towards the loaded flank, running down to the bore."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.gear.tooth_form import ToothForm
from tribodyn.stiffness.fe2d.sector_mesh import SectorMesh, grid_elements
from tribodyn.stiffness.fe2d.tooth_side import ToothSide
from tribodyn.types import Array

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
    """

    flank: float = 0.05
    largest: float = 0.09
    growth: float = 1.3
    body_growth: float = 0.3
    body_ratio: float = 0.17

    def refined(self, factor: float) -> MeshSize:
        """Mesh with smaller elements everywhere.

        Parameters
        ----------
        factor : float
            By how much smaller.

        Returns
        -------
        MeshSize
        """
        return MeshSize(
            self.flank / factor,
            self.largest / factor,
            self.growth ** (1.0 / factor),
            self.body_growth / factor,
            self.body_ratio / factor,
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


def _with_middles(edges: Array) -> Array:
    full = np.empty(2 * edges.size - 1)
    full[::2] = edges
    full[1::2] = 0.5 * (edges[1:] + edges[:-1])
    return full


def tooth_mesh(form: ToothForm, bore_radius: float, size: MeshSize | None = None) -> SectorMesh:
    """Mesh of the sector of one tooth."""
    size = size or MeshSize()
    side = ToothSide(form)
    bore = bore_radius / form.normal_module
    _check_rim(form, bore_radius)
    across = _with_middles(_across(side, size))
    lengths = _with_middles(_flank_edges(side, size))
    tooth = _tooth_points(side, lengths, across)
    root = side.root_points(_with_middles(_even(1.0, _root_share(side, size), 3)))
    top = np.concatenate([root[:-1], tooth[:, -1], (root * [-1.0, 1.0])[-2::-1]])
    body = _body_points(top, _with_middles(_body_levels(side, bore, size)), bore)
    return _numbered(form.teeth, tooth, body, root.shape[0] - 1, lengths)


def _check_rim(form: ToothForm, bore_radius: float) -> None:
    rim = form.root_radius - bore_radius
    if rim < _THINNEST_RIM * form.normal_module:
        raise InputError(
            Problem(
                what=f"the bore of {2e3 * bore_radius:.4g} mm leaves a rim of {rim * 1e3:.3g} mm "
                "under the root circle",
                where="bore_diameter",
                why=f"The finite element model needs {_THINNEST_RIM:g} modules, "
                f"{_THINNEST_RIM * form.normal_module * 1e3:.3g} mm",
                remedy="Give a smaller bore",
            )
        )


def _across(side: ToothSide, size: MeshSize) -> Array:
    """Shares of the thickness, from the loaded flank (0) to the other (1)."""
    middle = side.flank_points(np.array(0.5 * (side.tip_length + side.form_length)))
    thickness = 2.0 * float(middle[0])
    return _graded(thickness, size.flank, size.largest, size.growth) / thickness


def _flank_edges(side: ToothSide, size: MeshSize) -> Array:
    """Lengths along the flank from the tip to the foot, falling."""
    flank = side.tip_length - _even(side.tip_length - side.form_length, size.flank, 8)
    fillet = _graded(side.foot_length, size.flank, size.largest, size.growth)
    return np.concatenate([flank[:-1], side.form_length - fillet])


def _root_share(side: ToothSide, size: MeshSize) -> float:
    points = side.root_points(np.linspace(0.0, 1.0, 65))
    return size.largest / float(np.hypot(*np.diff(points, axis=0).T).sum())


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


def _body_levels(side: ToothSide, bore: float, size: MeshSize) -> Array:
    """Shares of the depth from the root (0) to the bore (1)."""
    radii = [side.root_radius]
    while radii[-1] > bore:
        depth = side.root_radius - radii[-1]
        step = min(size.largest + size.body_growth * depth, size.body_ratio * radii[-1])
        radii.append(radii[-1] - step)
    if len(radii) > 4 and bore - radii[-1] > 0.5 * (radii[-2] - radii[-1]):
        radii.pop()
    while len(radii) < 4:
        radii = list(np.linspace(radii[0], radii[-1], 4))
    depths = radii[0] - np.array(radii)
    return np.asarray(depths / depths[-1])


def _body_points(top: Array, levels: Array, bore: float) -> Array:
    """Columns from the top edge to the bore in polar coordinates, shape (columns, levels, 2)."""
    radius, angle = np.hypot(*top.T)[:, None], np.arctan2(*top.T)[:, None]
    radii = radius + (bore - radius) * levels
    return np.stack([radii * np.sin(angle), radii * np.cos(angle)], axis=-1)


def _numbered(
    count: int, tooth: Array, body: Array, side_columns: int, lengths: Array
) -> SectorMesh:
    """Join the two grids: the lowest row of the tooth is a part of the top row of the body."""
    under = np.arange(body.shape[0] * body.shape[1]).reshape(body.shape[:2])
    own = under.size + np.arange(tooth.shape[0] * (tooth.shape[1] - 1))
    foot = under[side_columns : side_columns + tooth.shape[0], :1]
    grid = np.concatenate([own.reshape(tooth.shape[0], -1), foot], axis=1)
    outline = np.concatenate(
        [
            under[:side_columns, 0],
            grid[0, ::-1],
            grid[1:-1, 0],
            grid[-1],
            under[side_columns + tooth.shape[0] :, 0],
        ]
    )
    return SectorMesh(
        count=count,
        nodes=np.concatenate([body.reshape(-1, 2), tooth[:, :-1].reshape(-1, 2)]),
        elements=np.concatenate([grid_elements(under), grid_elements(grid)]),
        right_cut=under[0, :-1],
        left_cut=under[-1, :-1],
        held=under[:, -1],
        tooth=grid,
        flank_length=lengths,
        outline=outline,
    )
