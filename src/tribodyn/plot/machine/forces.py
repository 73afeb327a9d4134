"""Alternating forces of meshes and on bearings over a period of the clock."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.machine.orders import COLORS
from tribodyn.plot.theme.labels import display_unit, displayed, rounded
from tribodyn.plot.theme.panels import ROUNDING, Panel, stack
from tribodyn.plot.theme.style import line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study.machine.motion import MachineMotion

#: Most samples of a period, most meshes and most bearings that are drawn, height of a panel.
_SAMPLES, _PARTS, _HEIGHT = 30_000, 8, 0.42


def _caption(motion: MachineMotion) -> str:
    drawn = (("meshes", motion.mesh), ("bearings", motion.bearing))
    left_out = [
        f"{len(names) - _PARTS} of {len(names)} {kind}"
        for kind, names in drawn
        if len(names) > _PARTS
    ]
    rest = f" Left out: {' and '.join(left_out)} with smaller variations." if left_out else ""
    bearings = ", and the radial force on each bearing" if motion.bearing else ""
    return (
        f"Force of each mesh along its line of action{bearings}, without its mean, each to its own "
        "scale; those that vary most come first. " + _period(motion) + rest
    )


def _period(motion: MachineMotion) -> str:
    if motion.phase_turns is None:
        return "The period is the shortest after which all meshes repeat."
    return (
        "The meshes have no common period: the record comes near all positions that they take to "
        "each other."
    )


def _panels(
    motion: MachineMotion, quantity: str, names: Sequence[str], force: Array
) -> list[Panel]:
    """Alternating force of each part to its own scale, the largest swing first."""
    unit, mean, swing = display_unit(quantity), motion.mean(force), np.ptp(force, axis=0)
    kind = "Mesh" if quantity == "mesh_force" else "Bearing"
    panels = []
    for i in np.argsort(-swing, kind="stable")[:_PARTS]:
        values = displayed(quantity, force[:_SAMPLES, i] - mean[i])
        level = rounded(quantity, float(mean[i]))
        varies = swing[i] > ROUNDING * np.abs(mean).max()
        size = rounded(quantity, float(swing[i]))
        trace = line(motion.clock[:_SAMPLES], values, names[i], COLORS[i % len(COLORS)], unit=unit)
        note = f"{kind} {names[i]}: " + (
            f"{size} peak to peak about {level}" if varies else f"constant, {level}"
        )
        panels.append(
            Panel(
                f"[{unit}]",
                [trace],
                {"nticks": 4, "zeroline": True},
                _HEIGHT,
                float(displayed(quantity, np.abs(mean).max())),
                note,
            )
        )
    return panels


@drawing(
    "machine_forces",
    heading="Forces over a period",
    caption=_caption,
    of=("MachineMotion", "MachineResult.motion"),
    made_by="Run a case with shafts: tribodyn.run.",
)
def machine_forces(motion: MachineMotion) -> Any:
    """Draw the alternating forces of meshes and on bearings over one period of the clock."""
    panels = [
        *_panels(motion, "mesh_force", motion.mesh, motion.mesh_force),
        *_panels(motion, "bearing_force", motion.bearing, motion.radial_force),
    ]
    swing, mean = np.ptp(motion.mesh_force, axis=0), motion.mean(motion.mesh_force)
    worst = int(np.argmax(swing))
    title = (
        f"The force of mesh {motion.mesh[worst]} varies most: "
        f"{rounded('mesh_force', float(swing[worst]))} peak to peak about a mean of "
        f"{rounded('mesh_force', float(mean[worst]))}"
    )
    if swing[worst] <= ROUNDING * np.abs(mean).max():
        title = "No mesh force varies"
    part = f", its first {motion.clock[_SAMPLES]:.2%}" if motion.clock.size > _SAMPLES else ""
    name = "Phase of the clock" if motion.phase_turns is None else "Part of the record"
    label = f"{name}, 1 = {1e3 / motion.frequency:.4g} ms{part}"
    return stack(title, label, panels)
