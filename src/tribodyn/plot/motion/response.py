"""Computed response of a structure: contact forces, compressions, coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import readable, scaled, significant, unit_of
from tribodyn.plot.theme.panels import Panel, extremes, stack
from tribodyn.plot.theme.style import Trace, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import AdaptiveSolution, Response

_COLORS = (PINION, WHEEL, *PAIR_COLORS, TOTAL, MUTED)
#: Most curves of a panel, and most points of a curve.
_CURVES, _POINTS = 8, 4000


def _panel(quantity: str, unit: str, time: Array, columns: dict[str, Array]) -> list[Panel]:
    """Panel with the columns of one quantity over the time; empty without columns."""
    chosen = dict(list(columns.items())[:_CURVES])
    if not chosen:
        return []
    factor, display_unit = scaled(np.stack(list(chosen.values())), unit)
    curves: list[Trace] = []
    for color, (name, values) in zip(_COLORS, chosen.items(), strict=False):
        at, style = extremes(values, _POINTS), Trace(unit=readable(display_unit), width=1.4)
        label = name.replace("_", " ")
        curves.append(line(time[at], factor * values[at], label, color, **style))
    left_out = len(columns) - len(chosen)
    more = f"<br>(and {left_out} more)" if left_out else ""
    return [Panel(f"{quantity} [{readable(display_unit)}]{more}", curves)]


def _coordinates(names: tuple[str, ...], values: Array, kind: str) -> dict[str, Array]:
    """Columns of translations, or of rotations."""
    return {n: values[:, k] for k, n in enumerate(names) if unit_of(n) == kind}


def _milliseconds(time: Array) -> tuple[Array, str]:
    return (1e3 * time, "Time [ms]") if time[-1] < 1.0 else (time, "Time [s]")


@drawing(
    heading="Response of the structure",
    caption="Force and compression of every contact, and the accelerations of the coordinates. The "
    "force is zero where the contact is lost: there the compression lies within the backlash.",
    of="Response",
    made_by="Call tribodyn.dynamics.simulate or steady_state and its plot method.",
)
def response(motion: Response) -> Sketch:
    """Draw contact forces, compressions and accelerations over the time."""
    time, label = _milliseconds(motion.time)
    force = motion.contact_force
    contacts = [f"contact {number + 1}" for number in range(force.shape[1])]

    def by_contact(values: Array) -> dict[str, Array]:
        return {name: values[:, k] for k, name in enumerate(contacts)}

    names = tuple(motion.names)
    panels = [
        *_panel("Contact force", "N", time, by_contact(force)),
        *_panel("Compression", "m", time, by_contact(motion.deflection)),
        *_panel("Acceleration", "m/s^2", time, _coordinates(names, motion.acceleration, "m")),
        *_panel("Angular acceleration", "rad/s^2", time,
                _coordinates(names, motion.acceleration, "rad")),
    ]  # fmt: skip
    kind = "Steady motion" if motion.floquet_multipliers.size else "Transient"
    cycles = "1 mesh cycle" if motion.periods == 1 else f"{motion.periods} mesh cycles"
    title = f"{kind} over {cycles} at {significant(motion.mesh_frequency)} Hz"
    if force.size:
        ends = (significant(force.min()), significant(force.max()))
        title += f": contact force {ends[0]} to {ends[1]} N"
    return stack(title, label, panels)


@drawing(
    heading="Adaptive time integration",
    caption="Positions at the ends of the accepted steps, and the length of every "
    "step: steps are short where a contact changes its side and at mesh events.",
    of="AdaptiveSolution",
    made_by="Call tribodyn.dynamics.solve_adaptive and its plot method.",
)
def adaptive_solution(solution: AdaptiveSolution) -> Sketch:
    """Draw positions and step lengths over the time."""
    time, label = _milliseconds(solution.time)
    names = tuple(solution.names)
    steps = np.diff(solution.time, prepend=solution.time[0])
    steps[0] = steps[1] if steps.size > 1 else 0.0
    panels = [
        *_panel("Position", "m", time, _coordinates(names, solution.position, "m")),
        *_panel("Rotation", "rad", time, _coordinates(names, solution.position, "rad")),
        *_panel("Step", "s", time, {"step": steps}),
    ]
    title = (
        f"{solution.steps} steps at a relative tolerance of {solution.rtol:.1g}, "
        f"{solution.rejections} repeated, {solution.crossings} changes of side"
    )
    return stack(title, label, panels)
