"""What a load on one tooth of a gear does there and at its other teeth; Weber and Banaschek.

The local compression of the flank under the load is not part of it: it depends on the load and
on the mating flank, and belongs to the pair.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.arrays.splines import spline
from tribodyn.contact import effective_modulus
from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    require_between,
    require_positive,
)
from tribodyn.gear import Material, SpurGear
from tribodyn.stiffness.teeth.tooth_bending import (
    beam_to_axis,
    flank_nodes,
    load_point,
    tooth_section,
)
from tribodyn.stiffness.teeth.tooth_compliance import check_reference
from tribodyn.types import Array

#: Distance beyond the end nodes, over their span, that is rounding and not a place off the flank.
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False, repr=False)
class GearInfluence:
    """Compliances of one gear per unit face width, tabulated over its flank.

    Displacements are along the inward normal of the flank where they are seen, loads along that
    of the flank where they act. The neighbour ``+n`` is the n-th tooth on the side of the loaded
    tooth where a contact at the same time has a larger radius of curvature.

    Parameters
    ----------
    curvature_radius : array (K,) [m]
        Radii of curvature of the involute at the nodes, increasing.
    self_compliance : array (K,) [m^2/N]
        Displacement at the loaded place without the local compression.
    cross_compliance : array (N, K, K) [m^2/N]
        ``[n - 1, i, j]``: load at node ``i``, displacement at node ``j`` of the neighbour ``+n``.

    Raises
    ------
    InputError
        If the shapes disagree, the nodes do not increase, or a self compliance is not positive.

    Notes
    -----
    Between the nodes cubic splines. The neighbour ``-n`` follows from the reciprocal theorem of
    Betti and Maxwell.

    Examples
    --------
    >>> rho = np.linspace(0.01, 0.02, 5)
    >>> tooth = GearInfluence(rho, 1e-11 * (1.0 + rho), np.zeros((1, 5, 5)))
    >>> print(f"{float(tooth.at(0.015)) * 1e6:.6e} mm^2/N", float(tooth.between(0.015, 0.018, 1)))
    1.015000e-05 mm^2/N 0.0
    """

    curvature_radius: Array
    self_compliance: Array
    cross_compliance: Array

    def __post_init__(self) -> None:
        nodes = self.curvature_radius.size
        shapes = self.self_compliance.shape, self.cross_compliance.shape[1:]
        if shapes != ((nodes,), (nodes, nodes)) or nodes < 4:
            raise _unusable(
                f"{nodes} nodes with compliances of the shapes {shapes[0]}, {shapes[1]}"
            )
        if np.any(np.diff(self.curvature_radius) <= 0.0):
            raise _unusable("radii of curvature that do not increase")
        if not np.all(self.self_compliance > 0.0):
            raise _unusable("a self compliance that is not positive")
        if not np.all(np.isfinite(self.cross_compliance)):
            raise _unusable("a cross compliance that is not finite")

    @property
    def neighbours(self) -> int:
        """Number of neighbours on each side that are known; those beyond do not move."""
        return int(self.cross_compliance.shape[0])

    @cached_property
    def _self(self) -> Callable[[Array], Array]:
        return spline(self.curvature_radius, self.self_compliance)

    @cached_property
    def _weights(self) -> Callable[[Array], Array]:
        """Weights (..., nodes) of the values at the nodes in their spline at a place."""
        return spline(self.curvature_radius, np.eye(self.curvature_radius.size))

    def at(self, curvature_radius: Array | float) -> Array:
        """Compliance at the loaded place.

        Parameters
        ----------
        curvature_radius : float or array [m]
            Where the load acts, within the nodes.

        Returns
        -------
        array [m^2/N]
            Shape of the argument.

        Raises
        ------
        InputError
            If a place lies beyond the nodes.
        """
        return np.asarray(self._self(self._inside(curvature_radius)))

    @with_old_names
    def between(
        self, loaded_radius: Array | float, displaced_radius: Array | float, neighbour: int
    ) -> Array:
        """Displacement of another tooth per load.

        Parameters
        ----------
        loaded_radius : float or array [m]
            Radius of curvature where the load acts.
        displaced_radius : float or array [m]
            Radius of curvature at the displaced place, of the same shape.
        neighbour : int
            How many teeth on, counted to the side of the larger radii; not zero.

        Returns
        -------
        array [m^2/N]
            Zero for a neighbour further than is known.

        Raises
        ------
        InputError
            If a place lies beyond the nodes, or the neighbour is the loaded tooth.
        """
        if neighbour == 0:
            why = "The displacement of the loaded tooth has a local part"
            remedy = "Use the self compliance, and add the compression of the contact"
            raise InputError("neighbour = 0", Argument("neighbour"), why, remedy)
        first, second = np.broadcast_arrays(loaded_radius, displaced_radius)
        return self._coupled(self._weights_at(first), self._weights_at(second), neighbour)

    def _weights_at(self, curvature_radius: Array | float) -> Array:
        """Weights (..., nodes) of the values at the nodes at places within them."""
        return self._weights(self._inside(curvature_radius))

    def _coupled(self, loaded: Array, displaced: Array, neighbour: int) -> Array:
        """As between, of places by their weights."""
        if abs(neighbour) > self.neighbours:
            return np.zeros(loaded.shape[:-1])
        first, second = (loaded, displaced) if neighbour > 0 else (displaced, loaded)
        return np.asarray(((first @ self.cross_compliance[abs(neighbour) - 1]) * second).sum(-1))

    def _inside(self, curvature_radius: Array | float) -> Array:
        """Bring rounding back to the nodes, and refuse what lies beyond them."""
        places = np.asarray(curvature_radius, dtype=float)
        low, high = self.curvature_radius[[0, -1]]
        slack = _ROUNDING * (high - low)
        if places.size and (places.min() < low - slack or places.max() > high + slack):
            raise InputError(
                f"radius of curvature {places.min() * 1e3:.6g} to {places.max() * 1e3:.6g} mm",
                where=Argument("curvature_radius"),
                why=f"The compliance is known from {low * 1e3:.6g} to {high * 1e3:.6g} mm, "
                "from the end of the fillet to the tip",
                remedy="Load the tooth on its involute",
            )
        return np.asarray(np.clip(places, low, high))

    def __repr__(self) -> str:
        """One line with the range and the stiffest and softest place."""
        low, high = self.curvature_radius[[0, -1]] * 1e3
        least, most = self.self_compliance.min() * 1e6, self.self_compliance.max() * 1e6
        return (
            f"GearInfluence({self.curvature_radius.size} nodes from {low:.4g} to {high:.4g} mm, "
            f"{least:.4g} to {most:.4g} mm^2/N, {self.neighbours} neighbours)"
        )


def _unusable(what: str) -> InputError:
    return InputError(
        what,
        where="GearInfluence",
        why="It needs at least four increasing nodes, positive self compliances and one "
        "finite table of nodes by nodes for each neighbour",
        remedy="Check the provider of the compliances",
    )


Number = TypeVar("Number", float, Array)


def weber_banaschek_compression(
    load_per_width: Number, half_width: Number, depth: Number, material: Material
) -> Number:
    """Compression of one body between the contact and the tooth centreline.

    ``2 w (1 - nu^2) / (pi E) [ln(2 h / a) - nu / (2 (1 - nu))]``. It is not proportional to the
    load, because the half width ``a`` of the contact grows with its square root.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Normal load per face width.
    half_width : float or array [m]
        Hertzian half width of the contact under that load.
    depth : float or array [m]
        Distance from the contact to the tooth centreline along the load.
    material : Material
        Material of the body.

    Returns
    -------
    float or array [m]

    Raises
    ------
    InputError
        If an argument is not positive.
    ComputationError
        If the contact is so wide that the formula gives no positive compression.

    Notes
    -----
    Valid for ``a`` much smaller than ``h``; plane strain. Source: Weber and Banaschek (1953),
    Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten Raedern, Vieweg.

    Examples
    --------
    >>> from tribodyn.gear import Material
    >>> compression = weber_banaschek_compression(1e5, 6e-5, 3e-3, Material())
    >>> print(f"{compression * 1e6:.4f} um")
    1.2348 um
    """
    for name, value, unit in (
        ("load_per_width", load_per_width, "N/m"),
        ("half_width", half_width, "m"),
        ("depth", depth, "m"),
    ):
        require_positive(name, value, unit)
    nu = material.poissons_ratio
    bracket = np.log(2.0) + np.log(depth) - np.log(half_width) - nu / (2.0 * (1.0 - nu))
    if np.any(bracket <= 0.0):
        raise ComputationError(
            f"contact half width {np.max(half_width) * 1e3:.4g} mm against a depth of "
            f"{np.min(depth) * 1e3:.4g} mm",
            where="Weber-Banaschek compression",
            why="The formula holds for a half width much smaller than the depth",
            remedy="Lower the load",
        )
    modulus = material.youngs_modulus / (1.0 - nu**2)
    compression: Number = 2.0 * load_per_width / (np.pi * modulus) * bracket
    return compression


def local_terms(
    gears: tuple[SpurGear, SpurGear], radii: tuple[Array, Array], material: Material
) -> tuple[Array, float]:
    """Terms ``L`` (2, ...) and factor ``B`` of both compressions ``B f (L - ln(f)/2)`` under Hertz.

    The half width of the contact of two flanks with these radii of curvature goes with the root
    of the load per width ``f``. Source: :func:`weber_banaschek_compression`; Hertz (1881).
    """
    nu = material.poissons_ratio
    reduced = radii[0] * radii[1] / (radii[0] + radii[1])
    square = 8.0 * reduced / (np.pi * effective_modulus(material, material))
    depths = np.stack([load_point(g, np.abs(r)).depth for g, r in zip(gears, radii, strict=True)])
    terms = np.log(2.0 * depths) - 0.5 * np.log(square) - nu / (2.0 * (1.0 - nu))
    return terms, 2.0 * (1.0 - nu**2) / (np.pi * material.youngs_modulus)


def half_plane_compliance(
    load_angle: Array | float, load_height: Array | float, foot_width: float, material: Material
) -> Array:
    """Compliance of the half plane under a tooth, per unit face width [m^2/N].

    ``cos^2(a) (1 - nu^2) / E [18/pi (u/s)^2 + 2 (1 - 2 nu)/(1 - nu) u/s
    + 4.8/pi (1 + (1 - nu)/2.4 tan^2 a)]`` with the angle ``a`` [rad] between the load and the
    normal of the tooth axis, the height ``u`` [m] above the foot at which the load crosses that
    axis, and the thickness ``s`` [m] of the tooth at its foot.

    Plane strain. The deflection of a half plane under a force is unbounded; the last term omits
    what the body does far from the tooth. Weber (1949) has 5.2, 1.0, 1.4 and 0.294 for the
    coefficients at a Poisson's ratio of 0.3, here 5.73, 1.14, 1.53 and 0.292. Source: Weber and
    Banaschek (1953), Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten Raedern,
    Vieweg.

    >>> compliance = half_plane_compliance(0.3, 5e-3, 8e-3, Material())
    >>> print(f"{float(compliance) * 1e6:.4g} mm^2/N")
    1.824e-05 mm^2/N
    """
    require_positive("foot_width", foot_width, "m")
    nu = material.poissons_ratio
    ratio = np.asarray(load_height, dtype=float) / foot_width
    tilt = np.tan(load_angle) ** 2
    bracket = (
        18.0 / math.pi * ratio**2
        + 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * ratio
        + 4.8 / math.pi * (1.0 + (1.0 - nu) / 2.4 * tilt)
    )
    modulus = material.youngs_modulus / (1.0 - nu**2)
    return np.asarray(np.cos(load_angle) ** 2 / modulus * bracket)


def weber_influence(
    gear: SpurGear, material: Material, *, reference: str = "rim", nodes: int = 30
) -> GearInfluence:
    """Influence of one gear by the energy method on a half plane, without neighbours.

    Plane strain, bending, shear and axial compression from the foot of the tooth, where the
    fillet meets the root circle, up to the place where the load crosses the tooth axis, and the
    half plane under the foot. The gear body beyond the neighbourhood of the tooth is rigid, which
    makes the method the stiffest of all; a half plane has no bore, so that ``reference`` is
    ``"rim"``. Source: Weber (1949), The deformation of loaded gears and the effect on their
    load-carrying capacity, DSIR report 3; Weber and Banaschek (1953).

    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02)
    >>> weber_influence(gear, Material()).neighbours
    0
    """
    check_reference(reference)
    if reference != "rim":
        why = "Its foundation is a half plane, which has no bore"
        remedy = 'Choose reference = "rim", or a model with a gear body: "fe2d", "analytic"'
        raise InputError(f'reference = "{reference}"', "stiffness model weber", why, remedy)
    require_between("nodes", nodes, 4, 1000)
    section = tooth_section(gear)
    foot_height, foot_half_width = section.foot
    radii = flank_nodes(gear, nodes)
    load = load_point(gear, radii)
    tooth = beam_to_axis(section, load, material)
    widening = 1.0 - material.poissons_ratio**2
    self_compliance = (
        widening * (tooth.bending + tooth.axial)
        + tooth.shear
        + half_plane_compliance(
            load.load_angle, load.axis_height - foot_height, 2.0 * foot_half_width, material
        )
    )
    return GearInfluence(radii, self_compliance, np.zeros((0, nodes, nodes)))
