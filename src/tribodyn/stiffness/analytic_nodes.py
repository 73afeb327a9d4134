"""Where along a flank compliances are tabulated."""

from __future__ import annotations

import numpy as np

from tribodyn.gear import SpurGear
from tribodyn.types import Array

#: A flank from the base circle itself begins at this part of its largest radius of curvature.
_LEAST_PART = 1e-3


def flank_nodes(gear: SpurGear, count: int = 30) -> Array:
    """Radii of curvature from the end of the fillet to the tip, closer together at both ends."""
    low, high = (
        gear.base_radius * gear.roll_angle(radius) for radius in (gear.form_radius, gear.tip_radius)
    )
    low = max(low, _LEAST_PART * high)
    part = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, count)))
    nodes = low + (high - low) * part
    nodes[-1] = high
    return nodes
