"""Power flow of a back-to-back rig: what its motor brings up, and where it goes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tribodyn.errors import InputError
from tribodyn.losses.gearbox import PARTS, GearboxLosses
from tribodyn.record import Labels, Record, fact, quantity, record
from tribodyn.types import Array

_SAME = 1e-9  # relative difference of torques and speeds that count as one


@record
class RigPowerFlow(Record):
    """Losses of both gearboxes of a closed power loop; made by :func:`rig_power_flow`.

    Parameters
    ----------
    gearbox : tuple of str
        ``"test"`` and ``"slave"``.
    part : tuple of str
        Names of the parts, those of :class:`GearboxLosses`.
    loss : array (2, parts) [W]
        Power that each part of each gearbox loses.
    circulating_power : float [W]
        Power that goes round in the loop.

    Examples
    --------
    >>> RigPowerFlow(("test", "slave"), ("gear",), np.array([[200.0], [150.0]]), 22e3).motor_power
    350.0
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {"motor_power": Labels(())}

    gearbox: tuple[str, ...] = quantity("gearbox", unit="1", axis=True)
    part: tuple[str, ...] = quantity("part", unit="1", axis=True)
    loss: Array = quantity("gearbox", "part", unit="W")
    circulating_power: float = fact()

    @property
    def motor_power(self) -> float:
        """All losses, which the motor brings up [W]."""
        return float(self.loss.sum())

    def __repr__(self) -> str:
        """One line."""
        powers = f"motor {self.motor_power:.5g} W for {self.circulating_power:.5g} W in the loop"
        return f"RigPowerFlow({powers})"


def rig_power_flow(test: GearboxLosses, slave: GearboxLosses) -> RigPowerFlow:
    """Power flow of a back-to-back rig at one torque and speed.

    Parameters
    ----------
    test, slave : GearboxLosses
        Both gearboxes, each at one torque and speed, the same for both.

    Raises
    ------
    InputError
        If they are of several points, or of different ones.

    Notes
    -----
    The losses are some per cent of the power in the loop, so that both gearboxes count as under
    the same torque. Source: power balance of the closed loop.

    Examples
    --------
    >>> one = np.array([1.0])
    >>> box = GearboxLosses(150.0 * one, 100.0 * one, *np.full((8, 1, 1), 10.0))
    >>> rig_power_flow(box, box)
    RigPowerFlow(motor 160 W for 15000 W in the loop)
    """
    points = [(box.transmitted_power, box.pinion_speed) for box in (test, slave)]
    single = all(power.size == 1 for power, _ in points)
    if not (
        single and np.ptp(np.log([[p.item(), n.item()] for p, n in points]), axis=0).max() < _SAME
    ):
        why = "A loop has one torque and one speed at a time, the same in both gearboxes"
        raise InputError(f"{test!r} and {slave!r}", "test, slave", why, "Give one point of both")
    loss = np.array([[float(getattr(box, part)[0, 0]) for part in PARTS] for box in (test, slave)])
    power = float(test.transmitted_power[0, 0])
    return RigPowerFlow(("test", "slave"), tuple(PARTS), loss, power)
