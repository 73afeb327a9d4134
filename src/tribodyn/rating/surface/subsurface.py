"""Stress below a line contact with traction, plane strain: closed forms of Hertz and Flamant.

Pressure ``p_0 sqrt(1 - x^2/a^2)`` and traction ``mu p`` along +x, z inwards. With
``A = a^2 - x^2 + z^2``, ``R = sqrt(A^2 + 4 x^2 z^2)``, ``m = sqrt((R + A)/2)``,
``n = sgn(x) sqrt((R - A)/2)`` and ``D = m^2 + n^2``:
``s_x = -p_0/a [m (1 + (z^2 + n^2)/D) - 2 z]``, ``s_z = -p_0/a m (1 - (z^2 + n^2)/D)``,
``t = -p_0/a n (m^2 - z^2)/D``; traction adds ``mu p_0/a [n (2 - (z^2 - m^2)/D) - 2 x]`` to s_x,
mu t to s_z and mu s_x to t.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between
from tribodyn.types import Array


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
