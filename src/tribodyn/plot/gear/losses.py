"""Losses of a gearbox, its heat balance, power flow of a test rig, friction from losses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.losses.gearbox import PARTS
from tribodyn.plot.theme.colors import (
    GRID,
    INK,
    MUTED,
    PAIR_COLORS,
    PINION,
    TOTAL,
    WHEEL,
    translucent,
)
from tribodyn.plot.theme.labels import axis_label, displayed, engineering, significant
from tribodyn.plot.theme.panels import Panel, Row, from_zero, stack, stack_rows
from tribodyn.plot.theme.style import FONT, Trace, axis, contour, figure, line, marked, sankey
from tribodyn.types import Array
from tribodyn.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from tribodyn.losses import FrictionFromLoss, GearboxLosses, RigPowerFlow
    from tribodyn.study.heat_balance import HeatBalance

#: Colours from low to high efficiency.
_SCALE = [[0.0, "#fde0c5"], [0.5, "#f7fbff"], [1.0, "#6baed6"]]
#: Colours of the parts, in the order of PARTS: teeth, bearings, seals, oil.
_COLORS = (PINION, "#E69F00", "#F0C55C", "#F5DB9D", "#C98A00", "#CC79A7", "#009E73", "#56B4E9")
_SYMBOLS = ("circle", "square", "diamond", "triangle-up", "cross", "x")


def _watts(power: float) -> str:
    number, unit = engineering(power, "W", 4)
    return f"{number} {unit}"


def _percent(share: float) -> str:
    return f"{significant(100.0 * share, 3)} %"


def _efficiency(gearbox: GearboxLosses) -> Row:
    """Efficiency over torque and speed, or over the quantity that varies."""
    speed, torque = (displayed(n, getattr(gearbox, f"pinion_{n}")) for n in ("speed", "torque"))
    speed_label = axis_label("speed", "Speed of the pinion")
    torque_label = axis_label("torque", "Torque on the pinion")
    values = 100.0 * gearbox.efficiency
    if torque.size > 1 and speed.size > 1:
        hover = "%{x:.4g} rpm, %{y:.4g} N·m: %{z:.5g} %"
        surface = contour(speed, torque, values, _SCALE, hover, "%", 0.45)
        return Row(speed_label, Panel(torque_label, [surface], height=1.4))
    x, label = (torque, torque_label) if torque.size > 1 else (speed, speed_label)
    curve = line(x, values.ravel(), "efficiency", INK, unit="%", mode="lines+markers")
    return Row(label, Panel("Efficiency [%]", [curve]))


def _loss_parts(gearbox: GearboxLosses) -> Row:
    """Stacked parts of the loss over the speed at the largest torque, or over the torque."""
    over_speed = gearbox.pinion_speed.size > 1
    name = "speed" if over_speed else "torque"
    x = displayed(name, getattr(gearbox, f"pinion_{name}"))
    traces: list[Trace] = []
    for (part, text), color in zip(PARTS.items(), _COLORS, strict=True):
        power: Array = getattr(gearbox, part)
        values = power[-1] if over_speed else power[:, -1]
        if np.any(values):
            more: Trace = {"unit": "W", "width": 1.0, "stackgroup": "loss", "fillcolor": color}
            traces.append(line(x, values, text, color, **more))
    torque = f"{displayed('torque', gearbox.pinion_torque)[-1]:.4g} N·m"
    label = axis_label(name, "Speed of the pinion" if over_speed else "Torque on the pinion")
    text = f"Loss under {torque} [W]" if over_speed else "Loss [W]"
    return Row(label, from_zero(text, traces, 1.2), {"range": [x.min(), x.max()]})


def _bars(gearbox: GearboxLosses) -> Sketch:
    """Bars of the loss parts at a single operating point."""
    powers = {part: float(getattr(gearbox, part).item()) for part in PARTS}
    parts = zip(PARTS.items(), _COLORS, strict=True)
    rows = [(label, powers[part], color) for (part, label), color in parts if powers[part]]
    names, power, colors = zip(*rows[::-1], strict=True) if rows else ((), (), ())
    bar = {"type": "bar", "orientation": "h", "y": names, "x": power, "marker": {"color": colors}}
    bar |= {"text": [_watts(value) for value in power], "hoverinfo": "skip"}
    title = f"Efficiency {_percent(gearbox.efficiency.item())}, loss {_watts(gearbox.total.item())}"
    x_axis = axis(axis_label("power", "Loss"), rangemode="tozero")
    layout = {"height": 160 + 40 * len(rows), "hovermode": False, "xaxis": x_axis}
    return figure(title, [bar], layout)


def _caption(gearbox: GearboxLosses) -> str:
    if gearbox.total.size == 1:
        return "Parts of the loss at the operating point."
    caption = "Above, the efficiency with all losses of the case; below, the parts of the loss"
    if gearbox.pinion_speed.size > 1 < gearbox.pinion_torque.size:
        caption += " over the speed, under the largest torque"
    if not any(np.any(getattr(gearbox, part)) for part in PARTS if part != "gear"):
        return f"{caption}. Only the loss of the teeth is computed."
    idle = [part for part in ("seal", "churning", "windage") if np.any(getattr(gearbox, part))]
    if not idle:
        return f"{caption}, stacked."
    return f"{caption}, stacked. Losses of seals and oil do not grow with the torque."


@drawing(
    heading="Losses and efficiency",
    caption=_caption,
    of="GearboxLosses",
    made_by="Call tribodyn.loss_map(case) and its plot method.",
)
def losses(gearbox: GearboxLosses) -> Sketch:
    """Draw the efficiency over torque and speed, and the parts of the loss."""
    if gearbox.total.size == 1:
        return _bars(gearbox)
    counted = [label for part, label in PARTS.items() if np.any(getattr(gearbox, part))]
    of = "teeth alone" if counted == ["teeth"] else "gearbox"
    least, most = _percent(gearbox.efficiency.min()), _percent(gearbox.efficiency.max())
    rows = [_efficiency(gearbox), _loss_parts(gearbox)]
    return stack_rows(f"Efficiency of the {of}: {least} to {most}", rows)


#: Sinks of the power flow: name, loss parts, colour.
_SINKS = (
    ("Teeth", ("gear",), PINION),
    ("Bearings", tuple(part for part in PARTS if part.startswith("bearing")), "#E69F00"),
    ("Shaft seals", ("seal",), "#CC79A7"),
    ("Oil", ("churning", "windage"), "#009E73"),
)


@drawing(
    heading="Power flow of the rig",
    of="RigPowerFlow",
    made_by="Call tribodyn.rig_power_flow(case) and its plot method.",
)
def power_flow(rig: RigPowerFlow) -> Sketch:
    """Draw the power of the motor as a Sankey diagram.

    Power of the motor from left to right: first to the two gearboxes, then to the loss mechanisms.
    The power that circulates in the loop is many times larger and is not shown.
    """
    place = {part: number for number, part in enumerate(rig.part)}
    columns = ([place[part] for part in parts] for _, parts, _ in _SINKS)
    lost = np.array([rig.loss[:, chosen].sum(axis=1) for chosen in columns])
    names = ["Motor", "Test gearbox", "Slave gearbox", *(name for name, _, _ in _SINKS)]
    power = [rig.motor_power, *rig.loss.sum(axis=1), *lost.sum(axis=1)]
    colors = [INK, MUTED, MUTED, *(color for _, _, color in _SINKS)]
    links = [(0, 1 + box, power[1 + box], GRID) for box in (0, 1)]
    links += [
        (1 + box, 3 + sink, lost[sink, box], translucent(colors[3 + sink], 0.35))
        for sink in range(len(_SINKS))
        for box in (0, 1)
        if lost[sink, box] > 0.0
    ]
    labels = [
        f"{name}<br>{_watts(p)} ({_percent(p / rig.motor_power)})"
        for name, p in zip(names, power, strict=True)
    ]
    nodes = sorted({end for source, target, *_ in links for end in (source, target)})
    flows = [(nodes.index(source), nodes.index(target), *flow) for source, target, *flow in links]
    label, color = ([each[k] for k in nodes] for each in (labels, colors))
    style: Trace = {"pad": 34, "thickness": 16, "line": {"width": 0}}
    trace = sankey(flows, "%{value:.5g} W", "%{label}", label=label, color=color, **style)
    trace["textfont"] = {"size": 13, "color": INK, "family": FONT}
    title = (
        f"The motor supplies {_watts(rig.motor_power)}; "
        f"{_watts(rig.circulating_power)} circulate in the loop"
    )
    return figure(title, [trace], {"height": 460, "margin": {"l": 24, "r": 24, "t": 74, "b": 24}})


@drawing(
    heading="Friction from measured losses",
    of="FrictionFromLoss",
    made_by="Call tribodyn.losses.friction_from_power_loss(table) and its plot method.",
)
def friction_from_loss(measured: FrictionFromLoss) -> Sketch:
    """Draw friction coefficients with error bars over the torque, one curve per speed.

    Friction coefficients with their 95 % confidence intervals. The small difference of two losses
    makes them wide at low torque; open markers are points that are not sound.
    """
    turns = np.round(displayed("speed", measured.speed), 1)
    torque, traces = displayed("torque", measured.torque), []
    sound = np.array([verdict == "sound" for verdict in measured.verdict])
    speeds = np.unique(turns)
    for number, speed in enumerate(speeds):
        rows = np.flatnonzero(turns == speed)
        rows = rows[np.argsort(torque[rows], kind="stable")]
        color = (PINION, WHEEL, *PAIR_COLORS)[number % 6]
        mu, symbol = measured.friction_coefficient[rows], _SYMBOLS[number % len(_SYMBOLS)]
        shapes = [symbol if good else f"{symbol}-open" for good in sound[rows]]
        reach = measured.high[rows] - mu
        traces.append(line(
            torque[rows], mu, f"{speed:g} rpm", color, width=1.2, mode="lines+markers",
            customdata=[measured.verdict[row] for row in rows],
            marker={"size": 9, "symbol": shapes, "color": color},
            error_y={"type": "data", "array": reach, "color": color, "thickness": 1.4, "width": 5},
            hovertemplate=f"{speed:g} rpm: %{{y:.4g}}, %{{customdata}}<extra></extra>",
        ))  # fmt: skip
    good = int(sound.sum())
    panel = Panel(axis_label("friction_coefficient", "Friction coefficient"), traces, height=1.8)
    label = axis_label("torque", "Torque")
    return stack(f"{good} of {sound.size} points are sound", label, [panel])


@drawing(
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
def heat_balance(balance: HeatBalance) -> Sketch:
    """Draw power loss and dissipated heat over the temperature of gears and oil."""
    order = np.argsort(balance.temperature, kind="stable")
    celsius = balance.temperature - ZERO_CELSIUS
    ambient = balance.ambient_temperature - ZERO_CELSIUS
    top = max(float(celsius.max()), ambient + 1.0)
    ends = np.array([ambient, top + 0.1 * (top - ambient)])
    given_off = balance.heat_transfer * (ends - ambient)
    style: Trace = {"unit": "W", "mode": "lines+markers"}
    loss = line(celsius[order], balance.power_loss[order], "loss of the gearbox", WHEEL, **style)
    balanced = (celsius[-1:], balance.power_loss[-1:], "balance")
    state = marked(*balanced, TOTAL, 11, "circle-open", unit="W")
    number, unit = engineering(float(balance.power_loss[-1]), "W", 4)
    settled = f"Gears and oil settle at {significant(celsius[-1], 4)} °C"
    label, gears = "Temperature of gears and oil", []
    if balance.gear_temperature is not None and balance.gear_power_loss is not None:
        label = "Temperature of the oil, and of the gears for the loss of their teeth"
        warm = balance.gear_temperature - ZERO_CELSIUS
        settled = (
            f"The oil settles at {significant(celsius[-1], 4)} °C, the gears at "
            f"{significant(warm[-1], 4)} °C,"
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
