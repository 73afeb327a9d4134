"""Power losses of gears, bearings, seals and oil, and friction from measured losses.

| module | content |
| --- | --- |
| `bearings` | frictional moment of rolling bearings by the model of SKF; bearings of an FZG rig |
| `no_load` | radial shaft seals, churning in an oil bath, windage |
| `gearbox` | gear loss factor; all losses of a gear stage over torque and speed |
| `loss_table` | measured torque losses, read from a file or printed in a paper |
| `measured_loss` | friction from measured torque losses with its uncertainty; power flow of a rig |
"""

from tribodyn.arguments import guard
from tribodyn.losses.bearings import BEARINGS, BearingMoments, RollingBearing, bearing_moments
from tribodyn.losses.gearbox import (
    Gearbox,
    GearboxLosses,
    ShaftParts,
    gear_loss_factor,
    gearbox_losses,
    ohlendorf_loss_factor,
)
from tribodyn.losses.loss_table import PowerLossTable, power_loss_table, read_power_loss_table
from tribodyn.losses.measured_loss import (
    FrictionFromLoss,
    RigPowerFlow,
    friction_from_power_loss,
    rig_power_flow,
)
from tribodyn.losses.no_load import churning_loss, seal_loss, windage_loss

__all__ = [
    "BEARINGS",
    "BearingMoments",
    "FrictionFromLoss",
    "Gearbox",
    "GearboxLosses",
    "PowerLossTable",
    "RigPowerFlow",
    "RollingBearing",
    "ShaftParts",
    "bearing_moments",
    "churning_loss",
    "friction_from_power_loss",
    "gear_loss_factor",
    "gearbox_losses",
    "ohlendorf_loss_factor",
    "power_loss_table",
    "read_power_loss_table",
    "rig_power_flow",
    "seal_loss",
    "windage_loss",
]

guard(__name__)
