"""Influence of loads over the flank of a hypoid or spiral bevel gear, from finite elements."""

from __future__ import annotations

import hashlib
from dataclasses import astuple, dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tribodyn.compiled import announce
from tribodyn.gear import HypoidFlanks, Material
from tribodyn.interrupt import single_blas_thread
from tribodyn.progress import SILENT, Progress
from tribodyn.stiffness.fe2d.provider import digest_of, looked_up
from tribodyn.stiffness.fe2d.ring import quadratic_shapes
from tribodyn.stiffness.fe3d.bevel_sector import BevelSector, BevelSize
from tribodyn.stiffness.fe3d.bevel_tooth import BevelTooth, Cone, gear_cone
from tribodyn.stiffness.fe3d.ring import Ring, solved_harmonics
from tribodyn.types import Array

#: Neighbours on each side that move with a loaded tooth.
_NEIGHBOURS = 2


class UnitFlankCompliances(NamedTuple):
    """Compliances for a Young's modulus of one, lengths in mean normal modules."""

    along: Array  #: (stations,) places along the pitch cone of the gear
    up: Array  #: (stations, rows) places up the pitch cone
    layer: Array  #: (stations, rows) depth of the points whose displacement is taken
    compliance: Array  #: [neighbour, displaced node, loaded node]


def node_weights(place: Array, elements: int) -> Array:
    """Weights (n, 2 elements + 1) of nodes at places counted in nodes, quadratic per element."""
    place = np.clip(place, 0.0, 2.0 * elements)
    first = np.minimum(place // 2, elements - 1).astype(int)
    values, _ = quadratic_shapes(place - 2 * first - 1)
    weights = np.zeros((place.size, 2 * elements + 1))
    np.put_along_axis(weights, 2 * first[:, None] + np.arange(3), values, axis=1)
    return weights


def _grid_weights(place: Array, row: Array, shape: tuple[int, int]) -> Array:
    """Weights (n, nodes) of the nodes of a flank at places counted in stations and rows."""
    stations, rows = (
        node_weights(each, (size - 1) // 2) for each, size in zip((place, row), shape, strict=True)
    )
    return np.asarray((stations[:, :, None] * rows[:, None, :]).reshape(place.size, -1))


@dataclass(frozen=True, eq=False)
class FlankInfluence:
    """Structural compliance of the teeth of one gear between places of their flanks.

    Parameters
    ----------
    cone : Cone
        Cones of the gear.
    unit : UnitFlankCompliances
        Compliances for a Young's modulus of one.
    sense : float
        1 where teeth follow one another in the sense of the axis of the gear, else -1.
    module, youngs_modulus : float [m], [Pa]
        Mean normal module and Young's modulus.
    """

    cone: Cone
    unit: UnitFlankCompliances
    sense: float
    module: float
    youngs_modulus: float

    def weights(self, along: Array, up: Array) -> Array:
        """Weights of the nodes at places of the pitch cone of the gear.

        Parameters
        ----------
        along, up : (n,) array [m]
            Places along the cone and up from it.

        Returns
        -------
        (n, nodes) array
        """
        unit, along, up = self.unit, along / self.module, up / self.module
        shape, stations = unit.up.shape, np.arange(unit.along.size, dtype=float)
        place = np.interp(along, unit.along, stations)
        tip = np.interp(along, unit.along, unit.up[:, 0])
        low = np.interp(along, unit.along, unit.up[:, -1])
        return _grid_weights(place, (tip - up) / (tip - low) * (shape[1] - 1), shape)

    def compliance(self, neighbour: int) -> Array:
        """Displacement of the nodes of a tooth per load on those of another.

        Parameters
        ----------
        neighbour : int
            Teeth by which the displaced one is ahead in the sense.

        Returns
        -------
        (nodes, nodes) array [m/N]
        """
        steps = self.unit.compliance
        if abs(neighbour) >= len(steps):
            return np.zeros(steps.shape[1:])
        chosen = steps[neighbour] if neighbour >= 0 else steps[-neighbour].T
        return np.asarray(chosen / (self.youngs_modulus * self.module))

    @cached_property
    def layer(self) -> Array:
        """Depth of the points whose displacement is taken (nodes,) [m]."""
        return np.asarray(self.unit.layer.ravel() * self.module)


@single_blas_thread()
def unit_flank_compliances(
    sector: BevelSector, neighbours: int = _NEIGHBOURS, progress: Progress = SILENT
) -> UnitFlankCompliances:
    """Compliances of a gear whose body is held below its root."""
    progress.start(f"compliance of the {sector.tooth.gear}", solved_harmonics(sector.count).size)
    neighbours = max(min(neighbours, (sector.count - 1) // 2), 1)
    count = sector.flank.size
    table = Ring(sector).flank_compliances(np.arange(neighbours + 1), progress=progress)
    progress.finish()
    below = _below(sector) @ table[:, count:, 0, :count, 0]
    # A flank has the same influence on another place as that place on it.
    below[0] = 0.5 * (below[0] + below[0].T)
    return UnitFlankCompliances(sector.along, sector.up, sector.layer, np.ascontiguousarray(below))


def _below(sector: BevelSector) -> Array:
    """Weights (nodes, nodes) of the layer's nodes right below the nodes of the flank."""
    points = sector.mesh[1].reshape(-1, 3)
    flank, bottom = points[sector.flank], points[sector.bottom]
    normal, offset = sector.normals, bottom - flank
    aside = offset - np.sum(offset * normal, axis=-1, keepdims=True) * normal
    steps = np.stack([np.gradient(flank, axis=k, edge_order=2) for k in (0, 1)], axis=-1)
    back = np.swapaxes(steps, -1, -2)
    shift = -np.linalg.solve(back @ steps, back @ aside[..., None])[..., 0]
    shape = sector.flank.shape
    grid = np.moveaxis(np.indices(shape, dtype=float), 0, -1) + shift
    return _grid_weights(grid[..., 0].ravel(), grid[..., 1].ravel(), (shape[0], shape[1]))


#: Folders, relative to this one, and modules on which the numbers depend.
_SOURCES = (
    (".", "bevel bevel_sector bevel_tooth ring sections"),
    ("../fe2d", "ring tooth_mesh"),
    ("../../gear/hypoid", "conjugate ease_off envelope wheel_flanks"),
)


def hypoid_influence(
    flanks: HypoidFlanks,
    gear: str,
    material: Material,
    *,
    cache: bool = True,
    size: BevelSize | None = None,
    progress: Progress = SILENT,
) -> FlankInfluence:
    """Influence of loads over the loaded flank of a hypoid gear from finite elements of its ring.

    Parameters
    ----------
    flanks : HypoidFlanks
        The flanks of the loaded side.
    gear : str
        ``"pinion"`` or ``"wheel"``.
    material : Material
        Its material.
    cache : bool
        Whether the result is read from and stored in the folder of
        :func:`tribodyn.stiffness.fe2d.provider.cache_folder`.
    size : BevelSize, optional
        Numbers of the elements.
    progress : Progress
        Receiver of the progress.

    Returns
    -------
    FlankInfluence

    Raises
    ------
    ComputationError
        If tooth and body do not fit into a mesh.

    Notes
    -----
    Hexahedra with 27 nodes between both generated flanks, arcs as fillets, end faces across the
    pitch cone and a body below the root cone whose bottom is held; all teeth, reduced to one by the
    discrete Fourier transform around the axis. Loads act on the flank, displacements are those
    along its normal at a depth below it. The compression between that depth and the surface belongs
    to the contact: across a line ``2 (1 - nu^2)/(pi E) [ln(2h/a) - nu/(2(1 - nu))]`` per load per
    length, with the depth ``h`` and the half width ``a``. Source: Weber and Banaschek (1953);
    Vijayakar (1991), the split at a depth below the surface.

    Examples
    --------
    >>> import tribodyn as td
    >>> flanks = td.load_case("hypoid-mixed-ehl").hypoid_flanks
    >>> hypoid_influence(flanks, "pinion", Material()).compliance(0).shape  # doctest: +SKIP
    (153, 153)
    """
    blank, size = flanks.blank, size or BevelSize()
    tooth = BevelTooth(flanks, gear)
    sector = BevelSector(tooth, material.poissons_ratio, size)
    unit = (_unit if cache else unit_flank_compliances)(sector, progress=progress)
    module, modulus = blank.mean_normal_module, material.youngs_modulus
    return FlankInfluence(gear_cone(flanks, gear), unit, tooth.sense, module, modulus)


def _unit(sector: BevelSector, progress: Progress) -> UnitFlankCompliances:
    flanks, gear = sector.tooth.flanks, sector.tooth.gear
    eased = flanks.ease_off if gear == "pinion" else None  # the pinion bears all of it
    key = (astuple(flanks.blank), gear, flanks.side, eased, sector.poissons_ratio)
    text = repr((key, astuple(sector.size), digest_of(__file__, _SOURCES)))

    def compute() -> UnitFlankCompliances:
        announce(f"computing the compliance of the {gear} by finite elements, once, 10 seconds")
        return unit_flank_compliances(sector, progress=progress)

    name = hashlib.sha256(text.encode()).hexdigest()

    def fits(unit: UnitFlankCompliances) -> bool:
        return unit.compliance.shape[1:] == (unit.layer.size, unit.layer.size)

    return looked_up(UnitFlankCompliances, name, compute, fits, "fe3d")
