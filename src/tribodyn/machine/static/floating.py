"""Rolling bearings whose ring slides along its seat, so that they take no axial force."""

from __future__ import annotations

import numpy as np

from tribodyn.machine.rolling.element_ring import RollingElementBearing
from tribodyn.types import Array

#: Reach of the first search for the place without axial force, in diameters of an element.
_REACH = 1e-4


def seated(bearing: RollingElementBearing, displacement: Array) -> Array:
    """Displacement (5,) of the ring after it has slid to where it takes no axial force."""
    from scipy.optimize import brentq

    position = displacement.copy()

    def force(axial: float) -> float:
        position[0] = axial
        return float(bearing.response(position)[1][0])

    first, reach = force(0.0), _REACH * bearing.element_diameter
    # Contacts only press: the axial force rises with the axial displacement.
    while first * force(-float(np.copysign(reach, first))) > 0.0:
        reach *= 2.0
    end = -float(np.copysign(reach, first))
    position[0] = brentq(force, 0.0, end, xtol=1e-18, rtol=1e-14) if first else 0.0
    return position


def floating_response(
    bearing: RollingElementBearing, displacement: Array
) -> tuple[float, Array, Array]:
    """Energy, load (5,) and stiffness (5, 5), as of a response, without axial force."""
    energy, load, stiffness = bearing.response(seated(bearing, displacement))
    if (axial := stiffness[0, 0]) > 0.0:
        stiffness = stiffness - np.outer(stiffness[0], stiffness[0]) / axial
    load[0], stiffness[0], stiffness[:, 0] = 0.0, 0.0, 0.0
    return energy, load, stiffness
