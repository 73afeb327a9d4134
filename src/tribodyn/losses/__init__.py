"""Power losses of gears, bearings, seals and oil, and friction from measured losses.

| module | content |
| --- | --- |
| `bearings` | frictional moment of rolling bearings by the model of SKF; bearings of an FZG rig |
| `no_load` | radial shaft seals, churning in an oil bath, windage |
| `gearbox` | gear loss factor; all losses of a gear stage over torque and speed |
| `loss_table` | measured torque losses, read from a file or printed in a paper |
| `measured_loss` | friction from measured torque losses with its uncertainty; power flow of a rig |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
