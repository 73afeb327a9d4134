"""Types of rolling bearings by the name that a case file gives them."""

from __future__ import annotations

from tribodyn.machine.rolling.ball_bearing import AngularContactBallBearing, DeepGrooveBallBearing
from tribodyn.machine.rolling.element_ring import RollingElementBearing
from tribodyn.machine.rolling.roller_bearing import CylindricalRollerBearing, TaperedRollerBearing
from tribodyn.model import Registry

#: Types of rolling bearings: classes by name.
ROLLING_BEARINGS: Registry[type[RollingElementBearing]] = Registry(
    "type of rolling bearing", "tribodyn.rolling_bearing"
)
for _name, _type in (
    ("deep-groove", DeepGrooveBallBearing),
    ("angular-contact", AngularContactBallBearing),
    ("cylindrical-roller", CylindricalRollerBearing),
    ("tapered-roller", TaperedRollerBearing),
):
    ROLLING_BEARINGS.register(_name)(_type)
