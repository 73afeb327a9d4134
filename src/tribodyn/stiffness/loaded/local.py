"""Local compression of both flanks as the solver wants it: ``f (A - B ln f)`` per face width."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.gear import Material, SpurPair
from tribodyn.stiffness.load_point import load_point
from tribodyn.stiffness.loaded.places import ContactPlaces
from tribodyn.types import Array


def local_coefficients(
    pair: SpurPair, material: Material, places: ContactPlaces
) -> tuple[Array, float]:
    """Coefficients of the compression after Weber and Banaschek with its Hertzian half width."""
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
