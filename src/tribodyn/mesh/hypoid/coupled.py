"""Cells of a hypoid pair that move one another through the teeth of both gears.

The structure of the teeth is compliant between nodes of the contact lines, with straight lines
between them; each cell compresses its own contact on top of that.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.contact.hertz import dry_half_width
from tribodyn.errors import ComputationError
from tribodyn.gear import Material
from tribodyn.mesh.hypoid.cells import CellSprings, ClosedCells, ContactCells, closed_cells
from tribodyn.progress import SILENT, Progress
from tribodyn.stiffness.fe3d.bevel import FlankInfluence, hypoid_influence
from tribodyn.types import Array

#: Nodes of each contact line.
_NODES = 13
#: Load over the mean one below which the compression under it no longer grows with the logarithm.
_FAINT = 1e-2
#: Steps of Newton's method and of the local compression, what they leave, and what is refused.
_STEPS, _LOCAL_STEPS, _CLOSE, _REFUSED = 60, 12, 1e-13, 1e-9
#: Change of the forces over the largest one at which the local compression has settled.
_SETTLED = 1e-6
#: Least compression of both flanks over its factor, at the tips, where the teeth are thin, and the
#: share of the load that may be on cells that would have less.
_LEAST, _WIDE_SHARE = 1.5, 0.05


@dataclass(frozen=True, eq=False)
class LineCompliance:
    """Compliance of the teeth of both gears along the contact lines of all phases."""

    structure: Array  #: (p, n, n) between the nodes of all pairs of a phase [m/N]
    hats: Array  #: (cells + 1, nodes) displacement of the ends of the cells per that of the nodes
    layer: Array  #: (2, lines, cells) depth below which the structure of both gears is compliant
    material: Material

    def local_springs(self, cells: ContactCells, load_per_width: Array) -> CellSprings:
        """Springs of the local compression of both flanks under loads per length."""
        local, _ = self._local(cells, load_per_width)
        return CellSprings(1.0 / local)

    def local_tangent(self, cells: ContactCells, load_per_width: Array) -> Array:
        """Slope of the load per length over the local compression."""
        local, factor = self._local(cells, load_per_width)
        return np.asarray(1.0 / (local - 0.5 * factor))

    def _local(self, cells: ContactCells, load_per_width: Array) -> tuple[Array, float]:
        """Local compression per load per length (Weber and Banaschek), and its factor."""
        nu = self.material.poissons_ratio
        load = np.maximum(load_per_width, max(_FAINT * float(load_per_width.mean()), 1.0))
        curvature = np.maximum(cells.curvature.tensor[..., 1, 1], 1e-3)
        modulus = effective_modulus(self.material, self.material)
        half_width = dry_half_width(load, 1.0 / curvature, modulus)
        factor = 2.0 * (1.0 - nu**2) / (np.pi * self.material.youngs_modulus)
        bracket = np.log(2.0 * self.layer / half_width) - nu / (2.0 * (1.0 - nu))
        total = bracket.sum(axis=0)
        share = load_per_width * cells.length
        if share[total < _LEAST].sum() > _WIDE_SHARE * share.sum():
            widest = 2e3 * float(half_width[share > 0.0].max())
            raise ComputationError(
                f"the contact is up to {widest:.3g} mm wide",
                why="The compression under the load is that of a contact narrow against the tooth",
                remedy='Reduce the torque, or set stiffness_model = "line"',
            )
        return factor * np.maximum(total, _LEAST), 2.0 * factor


class CoupledLoad(NamedTuple):
    """Cells in balance."""

    lag: Array  #: of the wheel (p,) [rad]
    closed: ClosedCells
    torque: Array  #: on the wheel (p,)
    rate: Array  #: its slope by the lag
    springs: CellSprings  #: local compression, or what replaces it


def line_compliance(
    cells: ContactCells, material: Material, progress: Progress = SILENT
) -> LineCompliance:
    """Compliance of the teeth by finite elements along all contact lines."""
    wheel, pinion = (
        hypoid_influence(cells.flanks, gear, material, progress=progress)
        for gear in ("wheel", "pinion")
    )
    count = cells.length.shape[1]
    edges = np.linspace(0.0, count, _NODES)
    hats = np.stack([np.interp(np.arange(count + 1), edges, row) for row in np.eye(_NODES)], axis=1)
    blank, sense = cells.flanks.blank, cells.flanks.conjugate.sense
    axis, position = cells.flanks.conjugate.axes.axis, cells.touch.contact.pinion.position
    axial = position @ axis
    radius = np.linalg.norm(position - axial[..., None] * axis, axis=-1)
    unit = pinion.module
    on_pinion = pinion.cone.places(radius / unit, (axial + blank.pitch_apex_pinion) / unit)
    on_wheel = np.moveaxis(cells.touch.places, -1, 0)
    total: Array | float = 0.0
    layers = []
    for gear, places, ahead in (
        (wheel, on_wheel, -sense * wheel.sense),
        (pinion, [unit * each for each in on_pinion], sense * pinion.sense),
    ):
        weights = gear.weights(*(_at_nodes(each, edges).ravel() for each in places))
        total = total + _between_pairs(cells, gear, weights, int(ahead))
        at_cells = gear.weights(*(each.ravel() for each in places)) @ gear.layer
        layers.append(at_cells.reshape(cells.length.shape))
    return LineCompliance(np.asarray(total), hats, np.stack(layers), material)


def _at_nodes(values: Array, edges: Array) -> Array:
    """Values of the centres of the cells (lines, cells) at places counted in cells."""
    place = edges - 0.5
    before = np.clip(place.astype(int), 0, values.shape[1] - 2)
    step = values[:, before + 1] - values[:, before]
    return np.asarray(values[:, before] + step * (place - before))


def _between_pairs(cells: ContactCells, gear: FlankInfluence, weights: Array, ahead: int) -> Array:
    """Compliance (p, n, n) of one gear; pair ``j`` is ``(j - i) ahead`` teeth before pair ``i``."""
    phases, pairs = cells.in_contact.shape
    weights = weights.reshape(len(cells.row), _NODES, -1)
    line = np.full((phases, pairs), -1)
    line[cells.in_contact] = np.arange(len(cells.row))
    total = np.zeros((phases, pairs, _NODES, pairs, _NODES))
    for neighbour in range(1 - pairs, pairs):
        table = gear.compliance(neighbour * ahead)
        moved = weights @ table
        for loaded in range(pairs):
            displaced = loaded + neighbour
            if not 0 <= displaced < pairs:
                continue
            some = np.flatnonzero((line[:, loaded] >= 0) & (line[:, displaced] >= 0))
            by = np.swapaxes(weights[line[some, loaded]], 1, 2)
            total[some, displaced, :, loaded] = moved[line[some, displaced]] @ by
    return total.reshape(phases, pairs * _NODES, -1)


class _Balance:
    """Newton's method for the displacements of the nodes, and for the lag under a torque."""

    def __init__(self, cells: ContactCells, compliance: LineCompliance) -> None:
        self._cells, self._compliance = cells, compliance
        self._pairs = cells.in_contact.shape[1]
        self.nodes = np.zeros((cells.phase.size, self._pairs * _NODES))

    def solve(self, springs: CellSprings, lag: Array, wheel_torque: Array | None) -> CoupledLoad:
        """Balance of all phases; at the lag where there is no torque."""
        cells, structure = self._cells, self._compliance.structure
        for _ in range(_STEPS):
            lines = self.nodes.reshape(*cells.in_contact.shape, _NODES)[cells.in_contact]
            closed = closed_cells(cells, springs, lag, lines @ self._compliance.hats.T)
            shapes = self._shapes(closed)
            load = self._at_nodes(shapes, closed.force[:, None])[0]
            torque = cells.summed((closed.force * cells.touch.lever).sum(axis=1))
            error = self.nodes - np.einsum("pij,pj->pi", structure, load)
            step, turned, pull, rate = self._slopes(closed, shapes, closed.spring, error)
            left = np.abs(error).max(initial=0.0) / max(np.abs(self.nodes).max(initial=0.0), 1e-12)
            if wheel_torque is not None:
                left = max(left, float(np.max(np.abs(torque - wheel_torque) / wheel_torque)))
            if left < _CLOSE:
                break
            change = np.zeros(lag.shape)
            if wheel_torque is not None:
                missing = wheel_torque - torque + np.einsum("pi,pi->p", pull, step)
                change = missing / rate
                lag = lag + change
            self.nodes = self.nodes + step + turned * change[:, None]
        if not left < _REFUSED:
            raise ComputationError(
                f"the loads of the cells are in balance within {left:.2g} only",
                why="The teeth of this pair yield too differently along their contact lines",
                remedy='Change the torque or the ease-off, or set stiffness_model = "line"',
            )
        return CoupledLoad(lag, closed, torque, rate, springs)

    def tangent(self, load: CoupledLoad, share: Array) -> CoupledLoad:
        """The same load with the slope of springs that are softer in their tangent by a share."""
        closed, still = load.closed, np.zeros(self.nodes.shape)
        *_, rate = self._slopes(closed, self._shapes(closed), closed.spring * share, still)
        return load._replace(rate=rate)

    def _slopes(
        self, closed: ClosedCells, shapes: Array, spring: Array, error: Array
    ) -> tuple[Array, ...]:
        """Change of the nodes that ends their error, and per lag; slope of the torque by both."""
        cells, structure = self._cells, self._compliance.structure
        arm = cells.touch.lever
        pull, push = self._at_nodes(shapes, np.stack([spring * arm, spring * closed.lever], axis=1))
        system = np.eye(error.shape[1]) + structure @ self._block(shapes, spring)
        right = np.stack([-error, np.einsum("pij,pj->pi", structure, push)], axis=-1)
        step, turned = np.moveaxis(np.linalg.solve(system, right), -1, 0)
        rate = cells.summed((spring * closed.lever * arm).sum(axis=1))
        return step, turned, pull, rate - np.einsum("pi,pi->p", pull, turned)

    def _at_nodes(self, shapes: Array, values: Array) -> Array:
        """Sums (k, p, n) at the nodes of values (lines, k, cells) of the closed parts."""
        sums = np.swapaxes(values @ shapes, 0, 1)
        return np.stack([self._cells.spread(each).reshape(self.nodes.shape) for each in sums])

    def _shapes(self, closed: ClosedCells) -> Array:
        """Displacement of the closed parts of the cells per that of the nodes of their line."""
        hats = self._compliance.hats
        return np.asarray(hats[:-1] + closed.middle[..., None] * (hats[1:] - hats[:-1]))

    def _block(self, shapes: Array, spring: Array) -> Array:
        """Stiffness (p, n, n) of the cells between the nodes; pairs act on themselves only."""
        lines = np.swapaxes(shapes * spring[..., None], 1, 2) @ shapes
        phases, pairs = self._cells.in_contact.shape
        total = np.zeros((phases, pairs, _NODES, pairs, _NODES))
        row, pair = np.nonzero(self._cells.in_contact)
        total[row, pair, :, pair] = lines
        return total.reshape(phases, pairs * _NODES, -1)


def coupled_load(
    cells: ContactCells,
    compliance: LineCompliance,
    lag: Array,
    force: Array,
    *,
    wheel_torque: Array | None = None,
    springs: CellSprings | None = None,
) -> CoupledLoad:
    """Balance of all phases under a torque, or at a lag; springs replace the local compression."""
    balance = _Balance(cells, compliance)
    if springs is not None:
        return balance.solve(springs, lag, wheel_torque)
    for _ in range(_LOCAL_STEPS):
        local = compliance.local_springs(cells, force / cells.length)
        load = balance.solve(local, lag, wheel_torque)
        change = np.abs(load.closed.force - force).max(initial=0.0)
        lag, force = load.lag, load.closed.force
        if change <= _SETTLED * force.max(initial=0.0):
            break
    tangent = compliance.local_tangent(cells, force / cells.length)
    return balance.tangent(load, tangent / local.stiffness)
