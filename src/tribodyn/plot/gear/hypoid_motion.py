"""Kinematics of the flanks of a hypoid pair along their contact lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import FILLS, PINION, TOTAL, WHEEL, Trace, between, line, translucent
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.gear import HypoidKinematics


def _over_line(place: Array, values: Array, name: str, color: str, unit: str) -> list[Trace]:
    """Mean over each contact line with a band from minimum to maximum."""
    least, mean, most = (f(values, axis=1) for f in (np.nanmin, np.nanmean, np.nanmax))
    fill = FILLS.get(color, translucent(color, 0.12))
    band = between(place, least, most, name, fill, showlegend=False)
    return [*band, line(place, mean, name, color, unit=unit)]


@drawing(
    "hypoid_kinematics",
    heading="Kinematics of the flanks",
    caption="Mean over the contact line with a band from minimum to maximum, over the rotation of "
    "the wheel. The flanks of a hypoid pair also slide along the tooth, so that the sliding speed "
    "never reaches zero.",
    of="HypoidKinematics",
    made_by="Call tribodyn.gear.hypoid_kinematics(contact, pinion_speed) and its plot method.",
)
def hypoid_kinematics(motion: HypoidKinematics) -> Any:
    """Draw speeds, slide-to-roll ratio and radius of the gap over the rotation of the wheel."""
    place = np.degrees(motion.rotation)
    speed = display_unit("sliding_speed")
    rolling = [
        *_over_line(place, motion.pinion_rolling_speed, "pinion rolls", PINION, speed),
        *_over_line(place, motion.wheel_rolling_speed, "wheel rolls", WHEEL, speed),
    ]
    sliding = [
        *_over_line(place, motion.sliding_speed, "sliding", TOTAL, speed),
        *_over_line(place, motion.entrainment_speed, "entrainment", "#009E73", speed),
    ]
    ratio = _over_line(place, motion.slide_to_roll_ratio, "slide to roll", TOTAL, "")
    gap = _over_line(place, 1e3 * motion.equivalent_radius, "radius", TOTAL, "mm")
    panels = [
        Panel(axis_label("sliding_speed", "Speed"), sliding),
        Panel(axis_label("sliding_speed", "Rolling speed"), rolling),
        Panel("Slide to roll ratio", ratio),
        Panel("Radius of the gap [mm]", gap),
    ]
    low, high = (float(f(motion.sliding_speed)) for f in (np.nanmin, np.nanmax))
    title = (
        f"The flanks slide at {significant(low)} to {significant(high)} {speed} with the pinion at "
        f"{significant(float(displayed('speed', motion.pinion_speed)), 4)} rpm"
    )
    return stack(title, "Rotation of the wheel [°]", panels)
