"""Which friction coefficient follows from measured torque losses?

The no-load run is subtracted; the uncertainty of the measured torque goes through to the
coefficient.

Read on: losses
"""

import numpy as np

from tribodyn.losses import PowerLossTable, friction_from_power_loss

table = PowerLossTable(
    speed=np.full(4, 146.6),  # rad/s
    torque=[5.0, 50.0, 150.0, 300.0],  # N*m
    torque_loss=[1.0, 1.4, 4.1, 11.8],  # N*m
    gear_loss_factor=0.3031,
    torque_loss_uncertainty=0.1,  # N*m
)
friction = friction_from_power_loss(table)
print(friction)
friction.plot().write_html("friction_from_losses.html")
