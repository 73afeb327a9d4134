"""How do I use my own masses, stiffnesses and mesh?

A `System` is matrices, loads and contacts; the same engine runs it.

Read on: dynamics, nonlinear
"""

import numpy as np

from tribodyn.dynamics import Contact, System, speed_sweep

mesh = Contact(
    direction=[1.0, -1.0],
    stiffness=lambda phase: 2.5e8 * (1.0 + 0.2 * np.cos(2.0 * np.pi * phase)),  # N/m
    damping=900.0,  # N*s/m
    gap=50e-6,  # m, half of the backlash
)
system = System(
    np.diag([0.5, 0.8]), np.diag([200.0, 0.0]), np.diag([1e7, 0.0]), [2e3, -2e3], [mesh]
)
sweep = speed_sweep(system, np.linspace(1000.0, 6000.0, 60))  # mesh frequency [Hz]
print(sweep)
sweep.plot().write_html("own_structure.html")
