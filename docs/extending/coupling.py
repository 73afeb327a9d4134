"""A coupling with data of its own: a rubber spider, whose damping follows from its loss."""

import math

from tribodyn.machine import COUPLINGS, Coupling
from tribodyn.model import REQUIRED, number


@COUPLINGS.define(
    "spider",
    source="Data sheet of the maker",
    meaning="rubber spider between two hubs, by its nominal torque",
    options={
        "nominal_torque": number(
            REQUIRED, 1.0, 1e6, "spiders of the data sheet", unit="N*m", meaning="nominal torque"
        ),
        "stiffness_factor": number(
            25.0, 5.0, 100.0, "hardness from 80 to 98 Shore A", unit="1/rad",
            meaning="stiffness over the nominal torque",
        ),
        "relative_damping": number(
            0.8, 0.0, 2.0, "rubber", meaning="energy lost in a cycle over that stored at its peak"
        ),
        "frequency": number(
            REQUIRED, 0.1, 1e5, "of the vibration", unit="Hz", meaning="where the damping holds"
        ),
    },
)  # fmt: skip
def spider(shafts, *, nominal_torque, stiffness_factor, relative_damping, frequency):
    """Coupling of the names of two shafts."""
    stiffness = stiffness_factor * nominal_torque
    damping = relative_damping * stiffness / (2.0 * math.pi) / (2.0 * math.pi * frequency)
    return Coupling(shafts, stiffness, damping)
