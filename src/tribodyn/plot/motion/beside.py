"""Motions of several results over each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.drawing import drawing
from tribodyn.plot.look.labels import axis_label, display_unit
from tribodyn.plot.look.panels import Panel, stack
from tribodyn.plot.look.style import PAIR_COLORS, PINION, TOTAL, WHEEL, line
from tribodyn.plot.motion.motion import Motion

if TYPE_CHECKING:
    from tribodyn.study import ResultComparison

_COLORS = (TOTAL, PINION, WHEEL, *PAIR_COLORS)
_DASHES = ("solid", "dash", "dot")


def _unlike(found: ResultComparison) -> str:
    """Say why the motions share no axis."""
    if len({Motion(each).label for each in found.results}) == 1:
        return ""
    return "Steady motions and motions over time share no axis: compare those of one kind"


@drawing(
    "result_comparison",
    heading="Results beside each other",
    caption="Transmission error and mesh force of each result; what differs in their cases stands "
    "in the table of the comparison.",
    missing=_unlike,
    of="ResultComparison",
    made_by="tribodyn.compare_results",
)
def result_comparison(found: ResultComparison) -> Any:
    """Draw transmission error and mesh force of all results over each other."""
    motions = [Motion(each) for each in found.results]
    panels: list[Panel] = []
    for quantity, name in (
        ("dynamic_transmission_error", "transmission_error"),
        ("mesh_force", "mesh_force"),
    ):
        traces = [
            line(
                *motion.curve(quantity, getattr(motion, name)),
                title,
                _COLORS[i % len(_COLORS)],
                unit=display_unit(quantity),
                width=1.8,
                dash=_DASHES[i // len(_COLORS)],
            )
            for i, (motion, title) in enumerate(zip(motions, found.names, strict=True))
        ]
        shown = [{**trace, "showlegend": not panels} for trace in traces]
        panels.append(Panel(axis_label(quantity), shown))
    changed = ", ".join(found.values) or "nothing"
    layout = motions[0].layout()
    if any(each.case.gears != found.results[0].case.gears for each in found.results):
        # Pairs of other gears enter and leave elsewhere.
        layout = {k: v for k, v in layout.items() if k not in ("shapes", "annotations")}
    return stack(f"What changes: {changed}", motions[0].label, panels, layout)
