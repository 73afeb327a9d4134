"""Mass and moments of inertia of both gears of a hypoid pair as truncated cones."""

from __future__ import annotations

import math

from tribodyn.gear.hypoid.blank import HypoidBlank
from tribodyn.gear.mass_properties import MassProperties


def cone_bodies(blank: HypoidBlank, density: float) -> dict[str, MassProperties]:
    """Mass and moments of inertia of both gears, about the middle of the cone."""
    properties = {}
    for gear in ("pinion", "wheel"):
        cone = getattr(blank, f"pitch_angle_{gear}")
        outer, inner = (getattr(blank, f"{end}_cone_distance_{gear}") for end in ("outer", "inner"))
        large, small = outer * math.sin(cone), inner * math.sin(cone)
        height = (outer - inner) * math.cos(cone)
        scale = math.pi * density * height
        mass = scale / 3.0 * (large**2 + large * small + small**2)
        polar = scale / 10.0 * sum(large**k * small ** (4 - k) for k in range(5))
        properties[gear] = MassProperties(mass, polar, 0.5 * polar + mass * height**2 / 12.0)
    return properties
