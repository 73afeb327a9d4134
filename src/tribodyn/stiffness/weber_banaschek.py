"""Local compression of the flanks at the contact, after Weber and Banaschek."""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from tribodyn.errors import ComputationError, Problem, require_positive
from tribodyn.gear import Material
from tribodyn.types import Array

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
    bracket = np.log(2.0 * depth / half_width) - nu / (2.0 * (1.0 - nu))
    if np.any(bracket <= 0.0):
        raise ComputationError(
            Problem(
                what=f"contact half width {np.max(half_width) * 1e3:.4g} mm against a depth of "
                f"{np.min(depth) * 1e3:.4g} mm",
                where="Weber-Banaschek compression",
                why="The formula holds for a half width much smaller than the depth",
                remedy="Lower the load",
            )
        )
    modulus = material.youngs_modulus / (1.0 - nu**2)
    compression: Number = 2.0 * load_per_width / (np.pi * modulus) * bracket
    return compression
