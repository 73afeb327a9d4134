"""Where along a flank compliances are tabulated."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.gear import SpurGear

__all__ = ["flank_nodes"]

#: A flank from the base circle itself begins at this part of its largest radius of curvature.
_LEAST_PART = 1e-3


def flank_nodes(gear: SpurGear, count: int = 30) -> NDArray[np.float64]:
    """Radii of curvature from the end of the fillet to the tip, closer together at both ends.

    Parameters
    ----------
    gear : SpurGear
        Gear whose flank is wanted.
    count : int
        Number of nodes, at least 4.

    Returns
    -------
    array (count,) [m]
        Increasing, all positive.

    Notes
    -----
    Extrema of a Chebyshev polynomial.

    Examples
    --------
    >>> gear = SpurGear(teeth=24, normal_module=4.5e-3, normal_pressure_angle=0.349066,
    ...     profile_shift_coefficient=0.0, tip_diameter=0.117, face_width=0.02)
    >>> nodes = flank_nodes(gear, 5)
    >>> print(", ".join(f"{node * 1e3:.3f} mm" for node in nodes))
    5.312 mm, 8.797 mm, 17.211 mm, 25.624 mm, 29.109 mm
    """
    low, high = (
        gear.base_radius * gear.roll_angle(radius) for radius in (gear.form_radius, gear.tip_radius)
    )
    low = max(low, _LEAST_PART * high)
    part = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, count)))
    nodes = low + (high - low) * part
    nodes[-1] = high
    return nodes
