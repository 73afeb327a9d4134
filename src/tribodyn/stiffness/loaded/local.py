"""Local compression of both flanks as the solver wants it: ``f (A - B ln f)`` per face width."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tribodyn.contact import effective_modulus
from tribodyn.gear import Material, SpurPair
from tribodyn.stiffness.load_point import load_point
from tribodyn.stiffness.loaded.places import ContactPlaces

__all__ = ["local_coefficients"]

FloatArray = NDArray[np.float64]


def local_coefficients(
    pair: SpurPair, material: Material, places: ContactPlaces
) -> tuple[FloatArray, float]:
    """Coefficients of the compression after Weber and Banaschek with its Hertzian half width.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position.
    material : Material
        Material of both gears.
    places : ContactPlaces
        Where the pairs touch.

    Returns
    -------
    tuple
        ``A`` of each contact (p, n) [m^2/N] for loads in N/m, and ``B`` [m^2/N].

    Notes
    -----
    ``sum over both bodies of 2 f (1 - nu^2)/(pi E) [ln(2 h/a) - nu/(2 (1 - nu))]`` with
    ``a^2 = 8 f R/(pi E')``. Source: :func:`tribodyn.stiffness.weber_banaschek_compression`.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> from tribodyn.stiffness.loaded.places import contact_places
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> A, B = local_coefficients(pair, Material(), contact_places(pair, [0.5], extended=False))
    >>> print(f"{1e6 * 1e5 * (A[0, 0] - B * math.log(1e5)):.3f} um")
    2.272 um
    """
    nu = material.poissons_ratio
    scale = 2.0 * (1.0 - nu**2) / (math.pi * material.youngs_modulus)
    radii = places.pinion_curvature_radius, places.wheel_curvature_radius
    reduced = radii[0] * radii[1] / (radii[0] + radii[1])
    square = 8.0 * reduced / (math.pi * effective_modulus(material, material))
    total = np.zeros(places.path.shape)
    for gear, radius in zip((pair.pinion, pair.wheel), radii, strict=True):
        depth = load_point(gear, radius).depth
        total += np.log(2.0 * depth) - 0.5 * np.log(square) - nu / (2.0 * (1.0 - nu))
    return scale * total, scale
