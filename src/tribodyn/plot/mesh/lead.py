"""Load over the face before and after a search of crowning and slope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.drawing import drawing
from tribodyn.plot.mesh.loaded_contact import torque_colors, torque_names
from tribodyn.plot.theme.labels import axis_label, displayed, rounded
from tribodyn.plot.theme.panels import from_zero, stack
from tribodyn.plot.theme.style import Trace, line

if TYPE_CHECKING:
    from tribodyn.stiffness import LeadOptimum


@drawing(
    "lead_optimum",
    heading="Load over the face",
    caption="Load of each slice of the face over the mesh cycle, over the mean of all slices: 1 "
    "everywhere is even. The greatest value is the face load factor. Dotted: the pair as it was "
    "given.",
    of="LeadOptimum",
    made_by="Call tribodyn.stiffness.optimize_lead and the plot method of its result.",
)
def lead_optimum(study: LeadOptimum) -> Any:
    """Draw the load over the face before and after the modification, a colour for each torque."""
    place, traces = displayed("face_position", study.face_position), []
    colors, names = torque_colors(study.torque.size), torque_names(study.torque)
    for t, (color, name) in enumerate(zip(colors, names, strict=True)):
        traces.append(line(place, study.face_load_after[t], name, color))
        style: Trace = {"dash": "dot", "showlegend": False}
        traces.append(line(place, study.face_load_before[t], f"{name}, before", color, **style))
    crowning, slope = (rounded(name, getattr(study, name)) for name in ("crowning", "lead_slope"))
    first, last = (
        float(factors.max())
        for factors in (study.face_load_factor_before, study.face_load_factor_after)
    )
    title = f"Crowning of {crowning} and a lead slope of {slope}"
    if last < first:
        title += f" lower the greatest face load factor from {first:.4g} to {last:.4g}"
    else:
        title += f" do not lower the greatest face load factor of {first:.4g}"
    label = axis_label("face_position", "Position along the face from its middle")
    return stack(title, label, [from_zero("Load over its mean", traces, 1.6)])
