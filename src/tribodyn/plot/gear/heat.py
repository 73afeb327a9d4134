"""Heat balance of a gearbox: power loss and dissipated heat over the temperature."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.theme.labels import axis_label, engineering, significant
from tribodyn.plot.theme.panels import from_zero, stack
from tribodyn.plot.theme.style import PAIR_COLORS, PINION, TOTAL, WHEEL, line, marked
from tribodyn.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from tribodyn.study.heat_balance import HeatBalance


@drawing(
    "heat_balance",
    heading="Heat balance",
    caption=lambda balance: (
        "The loss at every computed temperature, and the straight line of the heat dissipated to "
        "the surroundings. "
        + (
            "Gears and oil settle at the temperature at which they intersect."
            if balance.gear_temperature is None
            else "The oil settles at the temperature at which they intersect; the gears are warmer "
            "by the loss of their teeth over the heat transfer to the oil."
        )
    ),
    of="HeatBalance",
    made_by="Use Result.heat of a case with lubricant.heat_transfer.",
)
def heat_balance(balance: HeatBalance) -> Any:
    """Draw power loss and dissipated heat over the temperature of gears and oil."""
    order = np.argsort(balance.temperature, kind="stable")
    celsius = balance.temperature - ZERO_CELSIUS
    ambient = balance.ambient_temperature - ZERO_CELSIUS
    top = max(float(celsius.max()), ambient + 1.0)
    ends = np.array([ambient, top + 0.1 * (top - ambient)])
    given_off = balance.heat_transfer * (ends - ambient)
    loss = line(celsius[order], balance.power_loss[order], "loss of the gearbox", WHEEL, unit="W",
                mode="lines+markers")  # fmt: skip
    state = marked(celsius[-1:], balance.power_loss[-1:], "balance", TOTAL, size=11, unit="W",
                   symbol="circle-open")  # fmt: skip
    number, unit = engineering(float(balance.power_loss[-1]), "W", 4)
    settled = f"Gears and oil settle at {significant(float(celsius[-1]), 4)} °C"
    label, gears = "Temperature of gears and oil", []
    if balance.gear_temperature is not None and balance.gear_power_loss is not None:
        label = "Temperature of the oil, and of the gears for the loss of their teeth"
        warm = balance.gear_temperature - ZERO_CELSIUS
        settled = (
            f"The oil settles at {significant(float(celsius[-1]), 4)} °C, the gears at "
            f"{significant(float(warm[-1]), 4)} °C,"
        )
        rising = np.argsort(warm, kind="stable")
        teeth, color = balance.gear_power_loss, PAIR_COLORS[0]
        rise, name = np.array([celsius[-1], warm[-1]]), "heat from the gears to the oil"
        gears = [
            line(warm[rising], teeth[rising], "loss of the teeth", color, unit="W"),
            line(rise, np.array([0.0, teeth[-1]]), name, color, unit="W", dash="dash"),
        ]
    dissipated = line(ends, given_off, "dissipated heat", PINION, unit="W", dash="dash")
    panel = from_zero(axis_label("power", "Power"), [loss, dissipated, state, *gears], 1.4)
    title = f"{settled} with a loss of {number} {unit}"
    return stack(title, axis_label("temperature", label), [panel], {"hovermode": "closest"})
