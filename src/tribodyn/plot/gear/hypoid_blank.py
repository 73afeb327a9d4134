"""Sections of both blanks of a hypoid pair in their axial planes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.look.panels import Panel, Row, stack_rows
from tribodyn.plot.look.style import FILLS, MUTED, PINION, WHEEL, Trace, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.gear import HypoidBlank


def _section(blank: HypoidBlank, gear: str, cone: str) -> Array:
    """Places along the axis and radii of toe and heel on a cone, cut across the pitch cone."""
    pitch = getattr(blank, f"pitch_angle_{gear}")
    angle, apex = getattr(blank, f"{cone}_angle_{gear}"), getattr(blank, f"{cone}_apex_{gear}")
    points = []
    for end in ("inner", "outer"):
        distance = getattr(blank, f"{end}_cone_distance_{gear}")
        place = distance * math.cos(pitch) - getattr(blank, f"pitch_apex_{gear}")
        radius = distance * math.sin(pitch)
        step = (place + apex) * math.sin(angle) - radius * math.cos(angle)
        step /= math.cos(angle - pitch)
        points.append((place - step * math.sin(pitch), radius + step * math.cos(pitch)))
    return 1e3 * np.array(points).T


def _panel(blank: HypoidBlank, gear: str, color: str) -> Row:
    tip, root, pitch = (_section(blank, gear, cone) for cone in ("face", "root", "pitch"))
    outline = np.hstack([tip, root[:, ::-1], tip[:, :1]])
    hand = blank.hand_pinion
    hand = hand if gear == "pinion" else {"left": "right", "right": "left"}[hand]
    tooth: Trace = line(outline[0], outline[1], f"{gear}, {hand}-handed", color, unit="mm")
    tooth |= {"fill": "toself", "fillcolor": FILLS[color]}
    mean = 0.5e3 * getattr(blank, f"mean_pitch_diameter_{gear}")
    place = 1e3 * getattr(blank, f"calculation_point_{gear}")
    traces = [
        tooth,
        line(pitch[0], pitch[1], "pitch cone", MUTED, unit="mm", dash="dash"),
        line([place], [mean], "calculation point", color, unit="mm") | {"mode": "markers"},
    ]
    label = f"Place along the axis of the {gear} from the crossing point [mm]"
    return Row(label, Panel("Radius [mm]", traces), {"scaleanchor": "y"})


@drawing(
    "hypoid_blank",
    heading="Blanks",
    caption="Sections of the teeth in the axial plane of each gear: tip, root and pitch cone from "
    "toe to heel, to scale. The tip of one gear keeps its clearance from the root of the other.",
    of="HypoidBlank",
    made_by="tribodyn.gear.hypoid_blank makes one.",
)
def hypoid_blank(blank: HypoidBlank) -> Any:
    """Draw the sections of both blanks."""
    rows = [_panel(blank, "pinion", PINION), _panel(blank, "wheel", WHEEL)]
    rows[1].axis["scaleanchor"] = "y2"
    title = (
        f"{blank.teeth_pinion} teeth against {blank.teeth_wheel}, offset "
        f"{blank.offset * 1e3:g} mm: spiral angles "
        f"{math.degrees(blank.mean_spiral_angle_pinion):.1f}° and "
        f"{math.degrees(blank.mean_spiral_angle_wheel):.1f}°"
    )
    return stack_rows(title, rows, {"hovermode": "closest"})
