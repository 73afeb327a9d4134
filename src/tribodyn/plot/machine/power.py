"""Flow of power through a machine, from shaft to shaft."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.theme.colors import COLORS, MUTED, translucent
from tribodyn.plot.theme.labels import rounded
from tribodyn.plot.theme.style import figure, sankey

if TYPE_CHECKING:
    from tribodyn.machine import Machine, PowerFlow
    from tribodyn.study.machine.result import MachineResult


@drawing(
    heading="Flow of power",
    caption="From the input through shafts and meshes to the output; the width is the power. What "
    "the friction of computed teeth takes away leaves at each mesh.",
    of="MachineResult",
    made_by="Run a case with shafts: tribodyn.run.",
)
def machine_power(result: MachineResult) -> Sketch:
    """Draw the power that flows through shafts and meshes, and what is lost."""
    machine, lost = result.machine, result.operation.friction_power
    run, flow, figures = machine.operation, result.operation.power_flow, result.operation.figures
    names = [f"shaft {name}" for name in machine.shafts]
    names += [f"mesh {name}" for name in machine.meshes] + ["input", "output", "friction"]
    links: list[tuple[str, str, float, str]] = []
    power = figures["machine.input_power"]
    leaving = power - sum(lost.values())
    start, end = (run.input, run.output)[:: 1 if run.torque >= 0.0 else -1]
    links.append(("input", f"shaft {start}", power, MUTED))
    for place, name in enumerate(machine.meshes):
        color = COLORS[place % len(COLORS)]
        for shaft, gain in gains(machine, flow, name).items():
            if gain < 0.0:
                links.append((f"shaft {shaft}", f"mesh {name}", -gain, color))
            elif gain > 0.0:
                links.append((f"mesh {name}", f"shaft {shaft}", gain, color))
        if friction := lost.get(name):
            links.append((f"mesh {name}", "friction", friction, color))
    for name, torque in flow.couplings.items():
        ends = machine.couplings[name].shafts
        passing = torque * flow.shafts[ends[0]].speed
        giving, taking = ends if passing > 0.0 else ends[::-1]
        links.append((f"shaft {giving}", f"shaft {taking}", abs(passing), MUTED))
    links.append((f"shaft {end}", "output", leaving, MUTED))
    number = {name: place for place, name in enumerate(names)}
    trace = sankey(
        [(number[a], number[b], value, translucent(color, 0.45)) for a, b, value, color in links],
        "%{source.label} to %{target.label}: %{value:.6g} W",
        "%{label}: %{value:.6g} W",
        label=names, color=MUTED, pad=18, thickness=14,
    )  # fmt: skip
    share = figures.get("machine.efficiency", 1.0)
    efficiency = f", efficiency {100.0 * share:.4g} %" if share < 1.0 else ""
    title = f"{rounded('power', power)} in, {rounded('power', leaving)} out{efficiency}"
    return figure(title, [trace], {"height": 360, "hovermode": "closest"})


def gains(machine: Machine, flow: PowerFlow, name: str) -> dict[str, float]:
    """Power that a mesh gives to its shafts and to its carrier; negative where it takes it."""
    mesh, (first, second) = machine.meshes[name], flow.meshes[name].torque
    shafts = [machine.gears[gear].shaft for gear in mesh.gears]
    torques = dict(zip(shafts, (-first, second), strict=True))
    if mesh.carrier:
        torques[mesh.carrier] = first - second
    return {shaft: torque * flow.shafts[shaft].speed for shaft, torque in torques.items()}
