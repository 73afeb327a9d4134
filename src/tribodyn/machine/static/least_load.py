"""Rolling bearings that carry less than the weight of their shaft: their stiffness under it."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.machine.bearing import HELD
from tribodyn.machine.machine import Machine
from tribodyn.machine.rolling.element_ring import RollingElementBearing
from tribodyn.machine.shaft import Shaft
from tribodyn.types import Array

#: Standard gravity [m/s^2].
_GRAVITY = 9.80665
#: Radial stiffness over that under the weight below which a bearing without load is loose.
_LOOSE = 1e-2


def _mass(shaft: Shaft) -> float:
    """Mass of the sections of a shaft and of the body that turns with it [kg]."""
    volume = 0.0
    for section in shaft.sections:
        for (first, last), sign in zip(
            zip(section.diameters(0.0), section.diameters(1.0), strict=True), (1, -1), strict=True
        ):
            area = math.pi / 12.0 * (first**2 + first * last + last**2)
            volume += sign * area * section.length
    return shaft.mass + shaft.material.density * volume


def weight_share(machine: Machine, bearing: str) -> float:
    """Share of a bearing in the weight of its shaft with its gears [N]."""
    shaft = machine.bearings[bearing].shaft
    gears = [n for n, gear in machine.gears.items() if gear.shaft == shaft]
    mass = _mass(machine.shafts[shaft]) + sum(machine.gear_bodies[n].mass for n in gears)
    return _GRAVITY * mass / sum(b.shaft == shaft for b in machine.bearings.values())


def stiffness_under(rolling: RollingElementBearing, force: float) -> Array:
    """Stiffness (6, 6) under a radial force, the mean over its directions along y and z."""
    from scipy.optimize import brentq

    stiffness = np.zeros((6, 6))
    for axis in (1, 2):
        for sign in (1.0, -1.0):
            way = np.zeros(5)
            way[axis] = sign

            def excess(size: float, way: Array = way) -> float:
                return float(rolling.response(size * way)[1] @ way) - force

            far = 1e-6
            while excess(far) < 0.0:
                far *= 2.0
            size = brentq(excess, 0.0, far, xtol=1e-15, rtol=1e-12)
            stiffness[np.ix_(HELD, HELD)] += 0.25 * rolling.response(size * way)[2]
    return stiffness


def least_stiffness(machine: Machine, bearing: str, load: Array) -> tuple[Array, float] | None:
    """Stiffness of a rolling bearing under its share of the weight, and that share [N]."""
    # None of a bearing that carries more, or that is held by its preload.
    rolling = machine.bearings[bearing].rolling
    weight = weight_share(machine, bearing)
    if rolling is None or not weight > 0.0 or float(np.linalg.norm(load[:3])) >= weight:
        return None
    least = stiffness_under(rolling, weight)
    at_rest = rolling.response(np.zeros(5))[2]
    if at_rest[1, 1] + at_rest[2, 2] > _LOOSE * (least[1, 1] + least[2, 2]):
        return None
    return least, weight
