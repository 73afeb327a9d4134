"""The planetary stage of Lin and Parker, and its printed natural frequencies."""

from __future__ import annotations

from typing import Any

import numpy as np

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
