"""Contact patterns and transmission error of a hypoid pair with displaced gears."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.gear.hypoid import outline, pattern
from tribodyn.plot.theme.panels import Panel, Row, stack_rows
from tribodyn.plot.theme.style import INK, PAIR_COLORS, PINION, WHEEL, Trace, line, marked

if TYPE_CHECKING:
    from tribodyn.gear import Misalignment, MisalignmentStudy

_COLORS = (PINION, WHEEL, *PAIR_COLORS, INK)
#: Letter of each displacement, unit and factor from SI.
_LETTERS = {
    "offset": ("V", "µm", 1e6),
    "pinion_axial": ("H", "µm", 1e6),
    "wheel_axial": ("J", "µm", 1e6),
    "shaft_angle": ("α", "arcmin", 60.0 * math.degrees(1.0)),
}


def _label(misalignment: Misalignment) -> str:
    parts = [
        f"{letter} {getattr(misalignment, name) * factor:+.3g} {unit}"
        for name, (letter, unit, factor) in _LETTERS.items()
        if getattr(misalignment, name)
    ]
    return ", ".join(parts) or "nominal"


@drawing(
    "hypoid_misalignment",
    heading="Contact with displaced gears",
    caption="Flank of the wheel with the marked pattern and the mean place of the contact for each "
    "displacement: V of the offset, H of the pinion and J of the wheel along their axes, α of the "
    "shaft angle. Below, the transmission error of the running pair without load.",
    of="MisalignmentStudy",
    made_by="Call tribodyn.gear.misalignment_study.",
)
def hypoid_misalignment(study: MisalignmentStudy) -> Any:
    """Draw patterns on the flank and the transmission error of each case."""
    flank: list[Trace] = [outline(study.contacts[0])]
    errors: list[Trace] = []
    for number, contact in enumerate(study.contacts):
        color, label = _COLORS[number % len(_COLORS)], _label(contact.misalignment)
        flank.append(pattern(contact, label, color))
        x, y = 1e3 * study.along[number], 1e3 * study.across[number]
        more: Trace = {"unit": "mm", "showlegend": False}
        flank.append(marked([x], [y], label, color, size=9, symbol="cross", **more))
        turn, error = np.degrees(contact.rotation), 1e6 * contact.angular_transmission_error
        leads = contact.leads
        more["unit"], ahead = "µrad", error[leads] - error[leads].max()
        errors.append(line(turn[leads], ahead, label, color, **more))
    rows = [
        Row(
            "Along the pitch cone of the wheel, towards the heel [mm]",
            Panel("Across, towards the tip [mm]", flank, {"scaleanchor": "x"}, height=1.4),
        ),
        Row("Rotation of the wheel from the calculation point [°]",
            Panel("Wheel ahead [µrad]", errors)),
    ]  # fmt: skip
    ends = f"{1e6 * study.peak_to_peak.min():.3g}", f"{1e6 * study.peak_to_peak.max():.3g}"
    side = study.contacts[0].flanks.side
    title = f"Transmission error of {' to '.join(dict.fromkeys(ends))} µrad on the {side} flank"
    return stack_rows(title, rows, {"hovermode": "closest"})
