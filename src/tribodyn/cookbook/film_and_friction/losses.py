"""What are the losses and the efficiency of the gearbox?

Gear, bearing, seal and oil losses over torque and speed.

Read on: losses
"""

import tribodyn as td

case = td.load_case("fzg-roughness").replace({
    "friction.law": "schlenk",
    "losses.pinion.bearing": "NJ 406", "losses.wheel.bearing": "NJ 406",
    "losses.pinion.seal_diameter": "30 mm", "losses.wheel.seal_diameter": "30 mm",
    "losses.wheel.immersion": "30 mm", "losses.oil_volume": "1.2 l",
})  # fmt: skip
losses = td.loss_map(case, torque=["50 N*m", "300 N*m"], speed=["400 rpm", "1400 rpm", "3000 rpm"])
print(losses)
losses.plot().write_html("losses.html")
