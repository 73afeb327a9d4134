"""Stress below a line contact with traction, plane strain: closed forms of Hertz and Flamant.

Pressure ``p_0 sqrt(1 - x^2/a^2)`` and traction ``mu p`` along +x, z inwards. With
``A = a^2 - x^2 + z^2``, ``R = sqrt(A^2 + 4 x^2 z^2)``, ``m = sqrt((R + A)/2)``,
``n = sgn(x) sqrt((R - A)/2)`` and ``D = m^2 + n^2``:
``s_x = -p_0/a [m (1 + (z^2 + n^2)/D) - 2 z]``, ``s_z = -p_0/a m (1 - (z^2 + n^2)/D)``,
``t = -p_0/a n (m^2 - z^2)/D``; traction adds ``mu p_0/a [n (2 - (z^2 - m^2)/D) - 2 x]`` to s_x,
mu t to s_z and mu s_x to t. A solved pressure acts in strips of constant pressure.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between
from tribodyn.types import Array

#: Places of a passing contact.
_PASSED = 81


class LineContactStress(NamedTuple):
    """Stress below a line contact over its greatest pressure; made by :func:`line_contact_stress`.

    Parameters
    ----------
    along, across, depthwise : array
        s_x along the motion, s_y along the line and s_z inwards, over p_0 (dimensionless).
    shear : array
        tau_xz over p_0 (dimensionless).
    """

    along: Array
    across: Array
    depthwise: Array
    shear: Array

    @property
    def greatest_shear(self) -> Array:
        """Greatest shear stress in the plane of motion over p_0."""
        return np.asarray(np.hypot(0.5 * (self.along - self.depthwise), self.shear))

    @property
    def mises(self) -> Array:
        """Equivalent stress of von Mises over p_0."""
        x, y, z = self.along, self.across, self.depthwise
        squares = (x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2
        return np.asarray(np.sqrt(0.5 * squares + 3.0 * self.shear**2))


def line_contact_stress(
    position: ArrayLike, depth: ArrayLike, friction: float = 0.0, poissons_ratio: float = 0.3
) -> LineContactStress:
    """Stress below a line contact with traction.

    Parameters
    ----------
    position : float or array
        x over the half width a, pure number.
    depth : float or array
        z over the half width a, pure number of at least 0.
    friction : float
        Friction coefficient of the traction along +x, a pure number.
    poissons_ratio : float
        Poisson's ratio.

    Returns
    -------
    LineContactStress

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    Source: Johnson, Contact Mechanics, 1985, sections 4.2 and 7.1. Without friction the greatest
    shear is 0.3003 p_0 at a depth of 0.786 a.

    Examples
    --------
    >>> round(float(line_contact_stress(0.0, 0.786).greatest_shear), 4)
    0.3003
    """
    require_between("position", position, -1e6, 1e6)
    require_between("depth", depth, 0.0, 1e6)
    require_between("friction", friction, -2.0, 2.0)
    require_between("poissons_ratio", poissons_ratio, 0.0, 0.5)
    x, z = np.broadcast_arrays(np.asarray(position, dtype=float), np.asarray(depth, dtype=float))
    level = 1.0 - x**2 + z**2
    root = np.hypot(level, 2.0 * x * z)
    m = np.sqrt(np.maximum(0.5 * (root + level), 0.0))
    n = np.sign(x) * np.sqrt(np.maximum(0.5 * (root - level), 0.0))
    total = np.maximum(m**2 + n**2, 1e-300)
    share = (z**2 + n**2) / total
    along, inwards = -(m * (1.0 + share) - 2.0 * z), -m * (1.0 - share)
    shear = -n * (m**2 - z**2) / total
    traction = n * (2.0 - (z**2 - m**2) / total) - 2.0 * x
    s_x, s_z = along + friction * traction, inwards + friction * shear
    return LineContactStress(s_x, poissons_ratio * (s_x + s_z), s_z, shear + friction * along)


def pressed_stress(
    position: Array, depth: Array, place: Array, pressure: Array, friction: float = 0.0
) -> tuple[Array, Array, Array]:
    """s_x, s_z and tau_xz [Pa] below strips of constant pressure [Pa] around evenly spaced places.

    Source: Johnson, Contact Mechanics, 1985, section 2.5.
    """
    step = place[1] - place[0]
    edges = np.append(place, place[-1] + step) - 0.5 * step
    offset, z = position[..., None] - edges, np.broadcast_to(depth, position.shape)[..., None]
    angle, distance = np.arctan2(z, offset), np.hypot(z, offset)
    of_edges = angle, 0.5 * np.sin(2.0 * angle), 0.5 * np.cos(2.0 * angle), np.log(distance)
    turn, sine, cosine, log = (np.diff(each) @ pressure / np.pi for each in of_edges)
    along, shear = -turn - sine, cosine
    s_x = along + friction * (2.0 * log - cosine)
    return s_x, -turn + sine + friction * shear, shear + friction * along


class SubsurfaceExposure(NamedTuple):
    """Stress over strength below a contact; made by :func:`subsurface_exposure`.

    Parameters
    ----------
    depth : array [m]
        Below the surface.
    shear : array [Pa]
        Greatest shear stress at each depth while the contact passes.
    exposure : array
        Shear stress over 0.4 HV in N/mm2, pure numbers.
    """

    depth: Array
    shear: Array
    exposure: Array

    @property
    def greatest(self) -> tuple[float, float]:
        """Greatest exposure and its depth [m]."""
        at = int(np.argmax(self.exposure))
        return float(self.exposure[at]), float(self.depth[at])


def subsurface_exposure(
    depth: ArrayLike,
    hardness: ArrayLike,
    *,
    pressure: ArrayLike,
    width: ArrayLike,
    residual_stress: ArrayLike = 0.0,
    friction: float = 0.0,
    poissons_ratio: float = 0.3,
    material_factor: float = 1.0,
) -> SubsurfaceExposure:
    """Shear stress below a line contact over the strength that the hardness gives.

    Parameters
    ----------
    depth : array
        Depths below the surface [m], above 0.
    hardness : array
        HV at these depths, pure number.
    pressure : float or array
        Greatest Hertzian pressure, or a solved pressure at evenly spaced places [Pa].
    width : float or array
        Half width of the Hertzian contact, or these places [m].
    residual_stress : float or array
        Along the surface at these depths, compression negative [Pa].
    friction : float
        Friction coefficient of the traction, pure number.
    poissons_ratio : float
        Poisson's ratio.
    material_factor : float
        Factor of the strength, pure number.

    Returns
    -------
    SubsurfaceExposure

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    Half the greatest difference of the principal stresses, the residual stress added along and
    across the surface, over ``0.4 HV K`` N/mm2. It compares depths and designs; it is of no
    standard, and no limit of it is known.

    Examples
    --------
    >>> exposed = subsurface_exposure([0.1e-3, 0.2e-3, 0.4e-3], [700.0, 650.0, 450.0],
    ...     pressure=1.5e9, width=0.25e-3)
    >>> round(exposed.greatest[0], 3), exposed.greatest[1]
    (2.027, 0.0004)
    """
    depths = np.atleast_1d(np.asarray(depth, dtype=float))
    require_between("depth", depths, 1e-9, 1.0, "m")
    require_between("hardness", hardness, 50.0, 1200.0)
    require_between("residual_stress", residual_stress, -3e9, 3e9, "Pa")
    require_between("material_factor", material_factor, 0.1, 10.0)
    stated = pressure, width, residual_stress
    pressures, places, residual = (np.atleast_1d(np.asarray(v, dtype=float)) for v in stated)
    if pressures.size == 1:
        half = float(places[0])
        x = half * np.linspace(-2.0, 2.0, _PASSED)
        unit = line_contact_stress(x[:, None] / half, depths / half, friction, poissons_ratio)
        s_x, s_z, shear = (float(pressures[0]) * part for part in (unit[0], unit[2], unit[3]))
    else:
        x = np.linspace(places[0], places[-1], 2 * _PASSED)
        grid, below = np.meshgrid(x, depths, indexing="ij")
        s_x, s_z, shear = pressed_stress(grid, below, places, pressures, friction)
    s_y = poissons_ratio * (s_x + s_z) + residual
    s_x = s_x + residual
    middle, radius = 0.5 * (s_x + s_z), np.hypot(0.5 * (s_x - s_z), shear)
    across = 0.5 * (np.abs(middle - s_y) + radius)
    greatest = np.maximum(radius, across).max(axis=0)
    strength = 0.4e6 * material_factor * np.asarray(hardness, dtype=float)
    return SubsurfaceExposure(depths, greatest, np.asarray(greatest / strength))
