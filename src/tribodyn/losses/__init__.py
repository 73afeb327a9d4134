"""Power losses of gears, bearings, seals and oil, and friction from measured losses.

| module | what it answers |
| --- | --- |
| `gear_loss` | sliding work over transmitted work, by integration and by Ohlendorf |
| `bearings` | frictional moment of rolling bearings by the model of SKF; bearings of an FZG rig |
| `no_load` | radial shaft seals, churning in an oil bath, windage |
| `measured_loss` | friction coefficient and its uncertainty from measured torque losses |
"""

from tribodyn.losses.bearings import BEARINGS, BearingMoments, RollingBearing, bearing_moments
from tribodyn.losses.gear_loss import gear_loss_factor, ohlendorf_loss_factor
from tribodyn.losses.measured_loss import (
    FrictionFromLoss,
    PowerLossTable,
    friction_from_power_loss,
    read_power_loss_table,
)
from tribodyn.losses.no_load import churning_loss, seal_loss, windage_loss

__all__ = [
    "BEARINGS",
    "BearingMoments",
    "FrictionFromLoss",
    "PowerLossTable",
    "RollingBearing",
    "bearing_moments",
    "churning_loss",
    "friction_from_power_loss",
    "gear_loss_factor",
    "ohlendorf_loss_factor",
    "read_power_loss_table",
    "seal_loss",
    "windage_loss",
]
