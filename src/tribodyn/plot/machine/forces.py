"""Forces of meshes and on bearings over a period of the clock."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.machine.orders import COLORS
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import ROUNDING, Panel, stack
from tribodyn.plot.theme.style import line

if TYPE_CHECKING:
    from tribodyn.study.machine.motion import MachineMotion

#: Most samples of a period that are drawn.
_SAMPLES = 30_000


@drawing(
    "machine_forces",
    heading="Forces over a period",
    caption="Above, the force of each mesh along its line of action; below, the radial force on "
    "each bearing. The period is the shortest after which all meshes repeat.",
    of=("MachineMotion", "MachineResult.motion"),
    made_by="Run a case with shafts: tribodyn.run.",
)
def machine_forces(motion: MachineMotion) -> Any:
    """Draw mesh forces and radial bearing forces over one period of the clock."""
    shown = slice(_SAMPLES)
    clock = motion.clock[shown]

    def panel(quantity: str, label: str, names: Any, values: Any) -> Panel:
        unit = display_unit(quantity)
        traces = [
            line(
                clock,
                displayed(quantity, values[shown, i]),
                name,
                COLORS[i % len(COLORS)],
                unit=unit,
            )
            for i, name in enumerate(names)
        ]
        return Panel(axis_label(quantity, label), traces)

    panels = [panel("mesh_force", "Mesh force", motion.mesh, motion.mesh_force)]
    if motion.bearing:
        panels.append(
            panel("bearing_force", "Radial bearing force", motion.bearing, motion.radial_force)
        )
    swing, mean = np.ptp(motion.mesh_force, axis=0), motion.mean(motion.mesh_force)
    worst = int(np.argmax(swing))
    title = (
        f"The force of mesh {motion.mesh[worst]} varies most: "
        f"{rounded('mesh_force', float(swing[worst]))} peak to peak about a mean of "
        f"{rounded('mesh_force', float(mean[worst]))}"
    )
    if swing[worst] <= ROUNDING * np.abs(mean).max():
        title = "No mesh force varies"
    milliseconds = 1e3 / motion.frequency
    part = f", its first {100.0 * clock[-1]:.2g} %" if motion.clock.size > _SAMPLES else ""
    return stack(title, f"Phase of the clock, 1 = {milliseconds:.4g} ms{part}", panels)
