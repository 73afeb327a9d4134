"""Losses of an FZG rig: power flow from the motor, and friction coefficients from measured losses.

The test gearbox has bearings NJ 406, the slave gearbox QJ 308, both the same gears, seals and oil.
A simulated test measures the torque loss of the test gearbox at four torques, with 0.05 N*m of
scatter and three repeats, and friction is derived from it. The run at 5 N*m counts as no-load run
although its teeth rub too: this lowers the coefficient by 5/50 at 50 N*m and by 5/300 at 300 N*m.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td
from tribodyn.losses import PowerLossTable, friction_from_power_loss, gear_loss_factor

warnings.simplefilter("ignore", td.ModelWarning)  # the thin tip and the undercut of this pair
case = td.load_case("fzg-roughness").replace(
    {
        "friction.law": "constant",
        "friction.coefficient": 0.05,
        "operation.torque": "150 N*m",
        "operation.speed": "1400 rpm",
        "losses.oil_volume": "1.2 l",
        "losses.wheel.immersion": "30 mm",
        **{f"losses.{gear}.bearing": "NJ 406" for gear in ("pinion", "wheel")},
        **{f"losses.{gear}.seal_diameter": "30 mm" for gear in ("pinion", "wheel")},
    }
)
slave = case.replace({f"losses.{gear}.bearing": "QJ 308" for gear in ("pinion", "wheel")})
flow = td.rig_power_flow(case, slave)
print(f"motor {flow.motor_power:.1f} W, in the loop {flow.circulating_power:.0f} W")
for part, (test, other) in zip(flow.part, flow.loss.T, strict=True):
    print(f"{part:16} {test:8.2f} W {other:8.2f} W")

torques = np.array([5.0, 50.0, 150.0, 300.0])
losses = td.loss_map(case, torque=torques, speed="1400 rpm")
torque_loss = losses.total[:, 0] / losses.pinion_speed  # of the test gearbox, at the pinion
factor = gear_loss_factor(case.gear_pair)
bearings = losses.total[:, 0] - losses.gear[:, 0]
more = (bearings - bearings[0]) / losses.pinion_speed  # additional bearing loss under load
scatter = 0.05 * np.random.default_rng(0).standard_normal(12)
table = PowerLossTable(
    speed=np.full(12, losses.pinion_speed[0]),
    torque=np.repeat(torques, 3),
    torque_loss=np.repeat(torque_loss, 3) + scatter,
    other_loss=np.repeat(more, 3),
    gear_loss_factor=factor,
)
friction = friction_from_power_loss(table)
print("torque [N*m]   friction   low      high    verdict")
for row in zip(
    friction.torque, friction.friction_coefficient, friction.low, friction.high, strict=True
):
    print("{:8g} {:14.4f} {:8.4f} {:8.4f}".format(*row))
print(*dict.fromkeys(friction.verdict), sep="; ")

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
td.loss_map(case).plot().write_html(folder / "losses.html")
flow.plot().write_html(folder / "power-flow.html")
friction.plot().write_html(folder / "friction-from-loss.html")
print(f"figures in {folder.resolve()}:")
print("friction-from-loss.html losses.html power-flow.html")
