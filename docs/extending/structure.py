"""A structure with an option of its own: both gears turn, a spring holds the wheel."""

from dataclasses import replace

import numpy as np

from tribodyn.dynamics import STRUCTURES, torsional
from tribodyn.model import REQUIRED, number


@STRUCTURES.define(
    "held-wheel",
    meaning="both gears turn about fixed axes, a spring and a damper hold the wheel",
    options={
        "holding_stiffness": number(
            REQUIRED, 1.0, 1e9, "guards against a wrong unit", of="shaft_stiffness"
        ),
        "holding_damping": number(0.5, 0.0, 1e6, "guards against a wrong unit", of="shaft_damping"),
    },
)
def held_wheel(gears, *, holding_stiffness, holding_damping):
    """Build the structure from its gears."""
    free = torsional(
        gears.mesh,
        moment_of_inertia=gears.moment_of_inertia,
        base_radius=gears.base_radius,
        torque=gears.torque,
        **gears.contact,
    )
    holder = np.diag([0.0, 1.0])
    return replace(
        free,
        stiffness=holding_stiffness * holder,
        damping=holding_damping * holder,
        balance=None,  # The spring carries what friction takes: no torque needs balancing.
    )
