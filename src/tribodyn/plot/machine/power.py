"""Flow of power through a machine, from shaft to shaft."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.drawing import drawing
from tribodyn.plot.machine.orders import COLORS
from tribodyn.plot.theme.labels import rounded
from tribodyn.plot.theme.style import MUTED, figure, translucent

if TYPE_CHECKING:
    from tribodyn.machine import Machine
    from tribodyn.study.machine.result import MachineResult


@drawing(
    "machine_power",
    heading="Flow of power",
    caption="From the input through shafts and meshes to the output; the width is the power. What "
    "the friction of computed teeth takes away leaves at each mesh.",
    of="MachineResult",
    made_by="Run a case with shafts: tribodyn.run.",
)
def machine_power(result: MachineResult) -> Any:
    """Draw the power that flows through shafts and meshes, and what is lost."""
    machine, tables = result.machine, result.operation.tables
    run = machine.operation
    drives = run.torque * run.speed >= 0.0
    names = [f"shaft {name}" for name in machine.shafts]
    names += [f"mesh {name}" for name in machine.meshes] + ["input", "output", "friction"]
    number = {name: place for place, name in enumerate(names)}
    links: list[tuple[str, str, float, str]] = []
    power = abs(run.torque * run.speed)
    start, end = (run.input, run.output) if drives else (run.output, run.input)
    links.append(("input", f"shaft {start}", power, MUTED))
    lost = 0.0
    for place, name in enumerate(machine.meshes):
        color = COLORS[place % len(COLORS)]
        friction = tables[name].mean_friction_power if name in tables else 0.0
        gains = _gains(machine, name)
        entering = sum(gain for gain in gains.values() if gain > 0.0)
        for shaft, gain in gains.items():
            if gain < 0.0:
                links.append((f"shaft {shaft}", f"mesh {name}", -gain, color))
            elif gain > 0.0:
                rest = gain * (1.0 - friction / entering)
                links.append((f"mesh {name}", f"shaft {shaft}", rest, color))
        if friction:
            links.append((f"mesh {name}", "friction", friction, color))
        lost += friction
    links.append((f"shaft {end}", "output", power - lost, MUTED))
    trace = {
        "type": "sankey",
        "arrangement": "snap",
        "node": {
            "label": names,
            "color": MUTED,
            "pad": 18,
            "thickness": 14,
            "hovertemplate": "%{label}: %{value:.6g} W<extra></extra>",
        },
        "link": {
            "source": [number[source] for source, *_ in links],
            "target": [number[target] for _, target, *_ in links],
            "value": [value for *_, value, _ in links],
            "color": [translucent(color, 0.45) for *_, color in links],
            "hovertemplate": "%{source.label} to %{target.label}: %{value:.6g} W<extra></extra>",
        },
    }
    efficiency = f", efficiency {100.0 * (1.0 - lost / power):.4g} %" if lost and power else ""
    title = f"{rounded('power', power)} in, {rounded('power', power - lost)} out{efficiency}"
    return figure(title, [trace], {"height": 360, "hovermode": "closest"})


def _gains(machine: Machine, name: str) -> dict[str, float]:
    """Power that a mesh gives to its shafts and to its carrier; negative where it takes it."""
    flow, mesh = machine.kinematics, machine.meshes[name]
    first, second = flow.meshes[name].torque
    shafts = [machine.gears[gear].shaft for gear in mesh.gears]
    torques = dict(zip(shafts, (-first, second), strict=True))
    if mesh.carrier:
        torques[mesh.carrier] = first - second
    return {shaft: torque * flow.shafts[shaft].speed for shaft, torque in torques.items()}
