"""The planetary stage of Lin and Parker, and its printed natural frequencies."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tribodyn.dynamics import Response, System, clearance_motion
from tribodyn.machine.planetary.double_planets import Directions
from tribodyn.machine.planetary.plane_model import Pins
from tribodyn.types import ByName

ALPHA = float(np.radians(24.6))
LIN_PARKER: dict[str, Any] = {
    "carrier_mass": 5.43,
    "carrier_inertia": 6.29,
    "ring_mass": 2.35,
    "ring_inertia": 3.00,
    "sun_mass": 0.40,
    "sun_inertia": 0.39,
    "planet_mass": 0.66,
    "planet_inertia": 0.61,
    "sun_mesh_stiffness": 5e8,
    "ring_mesh_stiffness": 5e8,
    "pin_stiffness": 1e8,
    "carrier_support": 1e8,
    "ring_support": 1e8,
    "sun_support": 1e8,
    "ring_torsional_support": 1e9,
    "sun_pressure_angle": ALPHA,
    "ring_pressure_angle": ALPHA,
}
#: Frequencies by type for 3 and 4 planets [Hz].
FREQUENCIES = {
    3: {
        "rotational": [0.0, 1475.75, 1930.35, 2658.32, 7462.80, 11775.27],
        "translational": [743.16, 1102.42, 1896.02, 2276.38, 6986.30, 9647.91],
        "planet": [],
    },
    4: {
        "rotational": [0.0, 1536.54, 1970.59, 2625.65, 7773.55, 13071.11],
        "translational": [727.27, 1091.16, 1892.82, 2342.50, 7189.95, 10437.56],
        "planet": [1808.18, 5963.76, 6981.71],
    },
}


def pins_of(data: ByName) -> Pins:
    """Pins of the arguments of a plane model."""
    count, double = int(data["planets"]), data.get("double_planets")
    alpha = data["sun_pressure_angle"], data["ring_pressure_angle"]
    axes = Directions(data["phases"].angles, *alpha, double)
    stiffness, ahead = (
        np.broadcast_to(data[name], (count,)) for name in ("pin_stiffness", "pin_errors")
    )
    return Pins(axes, stiffness, ahead, float(data.get("pin_clearance", 0.0)))


def motion_in_clearance(system: System, data: ByName, frequency: float, **search: Any) -> Response:
    """Periodic motion of a stage with the exact law of its pins."""
    pins = pins_of(data)
    matrix, load = pins.springs(pins.axes.forces(float(data["force_per_planet"])))
    free = replace(
        system,
        stiffness=np.asarray(system.stiffness) - matrix,
        force=np.asarray(system.force) - load,
    )
    return clearance_motion(free, pins.supports(), frequency, **search)
