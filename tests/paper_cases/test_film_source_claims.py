"""What the first source document says of its films (sections 2.1 and 2.2), each claim by itself.

The wheel of 24 teeth drives; at the pitch point one pair carries the load. Heights of the spike are
those of 16385 nodes: uniform grids of its own size miss a fifth of it.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from tribodyn.ehl import solve_line_contact
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
TORQUES = (50, 150, 300)
SPEEDS = (800, 1400, 1800, 3000)


@cache
def solved(torque, speed, *, of_the_source=False):
    load = torque / (50.7434e-3 * 20e-3)
    entrainment = speed * math.pi / 30.0 * 20.9552e-3
    options = {"domain": (-2.5, 1.5), "inlet": "zero"} if of_the_source else {}
    return solve_line_contact(load, 8e-3, entrainment, OIL, 2.2e11, nodes=16385, **options)


def figures(name, points, **options):
    return np.array([getattr(solved(*point, **options), name) for point in points])


OVER_TORQUE = [(torque, 1400) for torque in TORQUES]
OVER_SPEED = [(150, speed) for speed in SPEEDS]
