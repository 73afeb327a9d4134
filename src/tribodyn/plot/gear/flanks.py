"""Flanks: their modifications and deviations, and lines of contact that move over them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.contact import path_of_contact
from tribodyn.drawing import Sketch, drawing
from tribodyn.gear import (
    default_relief_length,
    flank_gap,
    flank_ranges,
    lead_gap,
    profile_gap,
    tooth_outline,
    tooth_positions,
)
from tribodyn.plot.mesh.cycle import PAIRS, RUN
from tribodyn.plot.theme.colors import INK, MUTED, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import Panel, Row, curve, stack_rows
from tribodyn.plot.theme.path import pair_letters, roll_angle_of, roll_label
from tribodyn.plot.theme.style import ABOVE, Trace, animated, bars, figure, player
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.gear import CylindricalPair, SpurPair

#: Points of a tooth, sections over the face, and phases of the mesh cycle.
_OUTLINE_POINTS, _SECTIONS, _FRAMES = 61, 15, 24
#: Duration of a frame [ms].
_DURATION = 120
#: Sense of the helix: a right-hand tooth turns ahead along the axis.
_SENSES = {"right": 1.0, "left": -1.0}


def _in_space(pair: CylindricalPair, face: Array, radius: Array, angle: Array) -> Array:
    """Points [mm] along the axis and across it, for angles in the section at mid face."""
    gear, pairs = pair.pinion, path_of_contact(pair).pairs
    twist = _SENSES[pair.hand] * face * math.tan(gear.helix_angle) / gear.reference_radius
    # The middle one of the teeth in contact points upwards.
    turned = angle + twist + math.pi * (0.5 - (pairs - 1) / gear.teeth)
    along, radius = np.broadcast_arrays(face, radius)
    return np.asarray(1e3 * np.array([along, radius * np.cos(turned), radius * np.sin(turned)]))


def _flank_angle(pair: CylindricalPair, tooth: int, radius: Array) -> Array:
    """Angle of a point on the flank that touches: the front of a driving pinion's tooth."""
    gear, contact = pair.pinion, path_of_contact(pair)
    half = [gear.half_tooth_angle(max(float(r), gear.base_radius)) for r in radius]
    return 2.0 * math.pi * tooth / gear.teeth + contact.direction * np.array(half)


def line_points(pair: CylindricalPair, phase: float) -> list[Array]:
    """Points of each line of contact on the flanks of the pinion [mm], shape (3, points)."""
    contact, width = path_of_contact(pair), pair.common_face_width
    tangent, lines = math.tan(pair.base_helix_angle), []
    for tooth in range(contact.pairs):
        travel, ends = (phase + tooth) * pair.base_pitch, np.array([0.0, width])
        if tangent > 0.0:
            ends = np.clip(ends, (travel - contact.length) / tangent, travel / tangent)
        if ends[1] > ends[0] and travel - ends[1] * tangent < contact.length:
            entry = np.linspace(ends[0], ends[1], _SECTIONS)
            path = contact.A + contact.direction * (travel - entry * tangent)
            radius = np.hypot(pair.pinion.base_radius, path)
            face = _SENSES[pair.hand] * (0.5 * width - entry)
            lines.append(_in_space(pair, face, radius, _flank_angle(pair, tooth, radius)))
    return lines


def _tooth(pair: CylindricalPair, tooth: int) -> Trace:
    """Skin of a tooth over the common face."""
    half = 0.5 * pair.common_face_width
    x, y = tooth_outline(pair.pinion, _OUTLINE_POINTS)
    face = np.linspace(-half, half, _SECTIONS)[:, None]
    angle = 2.0 * math.pi * tooth / pair.pinion.teeth + np.arctan2(-x, y)
    points = _in_space(pair, face, np.hypot(x, y), angle)
    color = [[0.0, PINION], [1.0, PINION]]
    light = {"ambient": 0.75, "diffuse": 0.5, "specular": 0.05}
    style = {"showscale": False, "colorscale": color, "opacity": 0.7, "lighting": light}
    skin = dict(zip("xyz", points, strict=True))
    return {"type": "surface", **skin, **style, "hoverinfo": "skip"}


def _lines_in_space(lines: list[Array], name: str, color: str, width: float) -> Trace:
    """Curves in space as one trace, with gaps between them."""
    gap = np.full((3, 1), np.nan)
    points = np.hstack([part for curve in lines for part in (curve, gap)] or [gap])
    style = {"name": name, "line": {"color": color, "width": width}, "hoverinfo": "name"}
    return {"type": "scatter3d", "mode": "lines", **dict(zip("xyz", points, strict=True)), **style}


def _ends(pair: CylindricalPair, teeth: range) -> list[Array]:
    """Ends of the path of contact over the face, on each tooth."""
    half, curves = 0.5 * pair.common_face_width, []
    for path in pair.path_limits:
        radius = np.full(2 * _SECTIONS, math.hypot(pair.pinion.base_radius, path))
        face = np.linspace(-half, half, radius.size)
        curves += [
            _in_space(pair, face, radius, _flank_angle(pair, tooth, radius)) for tooth in teeth
        ]
    return curves


def _label(pair: CylindricalPair, phase: float) -> str:
    length = rounded("contact_line_length", pair.contact_line_length(phase))
    count = len(line_points(pair, phase))
    return f"Mesh phase {significant(phase, 2)}: {length} of contact on {count} tooth pairs"


def _straight(pair: CylindricalPair) -> str:
    """Reason why spur gears are not drawn."""
    if pair.helix_angle:
        return ""
    return "The lines of contact of spur gears lie straight along the face."


@drawing(heading="Lines of contact", of=PAIRS, missing=_straight, made_by=RUN)
def contact_lines(pair: CylindricalPair) -> Sketch:
    """Draw the flanks of the pinion in space with the moving lines of contact.

    Teeth of the pinion with the lines along which the wheel touches them. On a helical gear a line
    enters at a corner of the flank and leaves at the opposite one. The thin lines are the ends of
    the path of contact; the slider turns the gears through a mesh cycle.
    """
    teeth = range(-1, path_of_contact(pair).pairs + 1)
    phases = np.arange(_FRAMES) / _FRAMES
    moving = [
        _lines_in_space(line_points(pair, phase), "lines of contact", WHEEL, 9) for phase in phases
    ]
    still = [
        *(_tooth(pair, tooth) for tooth in teeth),
        _lines_in_space(_ends(pair, teeth), "ends of the path of contact", MUTED, 2),
    ]
    axes = {"xaxis": "Along the face [mm]", "yaxis": "y [mm]", "zaxis": "z [mm]"}
    side = -1.0 if pair.driver == "pinion" else 1.0
    slider = {"x": 0.16, "len": 0.84, "y": -0.02}
    labels = [_label(pair, float(phase)) for phase in phases]
    camera = {"eye": {"x": 0.95, "y": 1.75 * side, "z": 1.2}, "center": {"z": -0.15}}
    titles = {k: {"title": {"text": text, "font": {"color": INK}}} for k, text in axes.items()}
    layout = {
        "scene": {**titles, "aspectmode": "data", "camera": camera},
        "height": 640,
        "hovermode": "closest",
        "margin": {"l": 20, "r": 20, "t": 60, "b": 110},
        "legend": ABOVE,
        **player(labels, _DURATION, redraw=True, slider=slider, buttons=-0.04),
    }
    least, greatest = (
        rounded("contact_line_length", length)
        for length in (pair.least_contact_line_length, pair.greatest_contact_line_length)
    )
    title = f"{least} to {greatest} of contact lines over the mesh cycle"
    sketch = figure(title, [*still, moving[0]], layout)
    return animated(sketch, [[trace] for trace in moving], [len(still)])


#: Points along the profile and along the face.
_POINTS = 201
#: Further classes with a gear pair.
_OTHERS = ("PairCase", "HarrisMap", "TipReliefOptimum", "ComprehensiveStiffness")


def _perfect(pair: SpurPair) -> str:
    if pair.has_modification:
        return ""
    return (
        "The flanks are perfect involutes: neither gear has a modification or a deviation. "
        'Give one in [gears.pinion.modification], for example tip_relief = "10 um".'
    )


def _flank_gap_of_gear(pair: SpurPair, name: str, radius: Array, face: Array) -> Array:
    """Material removed from the flank of a gear at radii of curvature and face positions [m]."""
    gear = getattr(pair, name)
    flank = flank_ranges(pair)[0 if name == "pinion" else 1]
    gap = profile_gap(gear, radius, flank, default_relief_length(pair)) + lead_gap(gear, face)
    chart = gear.modification.profile_map
    if chart is not None:
        gap = gap - chart.at(np.abs(np.clip(radius, *flank)), face, base_radius=gear.base_radius)
    return np.asarray(gap)


def _curves(x: Array, parts: dict[str, Array]) -> list[Trace]:
    styles = {"pinion": (PINION, "solid"), "wheel": (WHEEL, "solid"), "both": (TOTAL, "dot")}
    return [
        curve("flank_gap", x, gap, name, styles[name][0], dash=styles[name][1])
        for name, gap in parts.items()
    ]


def _profile(pair: SpurPair) -> Row:
    age = np.linspace(0.0, pair.transverse_contact_ratio, _POINTS)
    angle = roll_angle_of(pair, age)
    driving = angle * pair.driving.base_radius
    driven = pair.line_of_action_length - driving
    radii = (driving, driven) if pair.driver == "pinion" else (driven, driving)
    face = np.zeros(1)
    parts = {
        name: _flank_gap_of_gear(pair, name, radius, face)
        for name, radius in zip(("pinion", "wheel"), radii, strict=True)
    }
    parts["both"] = flank_gap(pair, *radii)
    x = displayed("roll_angle", angle)
    return Row(
        roll_label(pair),
        Panel(axis_label("flank_gap", "Gap over the profile"), _curves(x, parts)),
        marks=pair_letters(pair),
    )


def _lead(pair: SpurPair) -> Row:
    half = 0.5 * pair.common_face_width
    face = np.linspace(-half, half, _POINTS)
    middle = np.array([0.5 * (flank.lowest + flank.highest) for flank in flank_ranges(pair)])
    parts = {
        name: _flank_gap_of_gear(pair, name, middle[number : number + 1], face)
        for number, name in enumerate(("pinion", "wheel"))
    }
    total = flank_gap(pair, middle[0], middle[1], face)
    parts = {name: gap - gap[_POINTS // 2] for name, gap in {**parts, "both": total}.items()}
    x = displayed("face_position", face)
    return Row(
        axis_label("face_position", "Position along the face from its middle"),
        Panel(axis_label("flank_gap", "Gap over the face"), _curves(x, parts), height=0.8),
    )


def _pitch(pair: SpurPair) -> Row:
    unit, traces = display_unit("cumulative_pitch_deviation"), list[Trace]()
    for name, color in (("pinion", PINION), ("wheel", WHEEL)):
        gear = getattr(pair, name)
        if gear.modification.changes_pitch:
            places = displayed("cumulative_pitch_deviation", tooth_positions(gear))
            hover = f"%{{y:.4g}} {unit}<extra>{name}, tooth %{{x}}</extra>"
            teeth = np.arange(abs(gear.teeth))
            traces.append(bars(teeth, places, name, color, hover, showlegend=True))
    label = axis_label("cumulative_pitch_deviation", "Cumulative pitch")
    return Row("Tooth", Panel(label, traces, height=0.8), {"showgrid": False})


def _run_out(pair: SpurPair) -> Row:
    turn, traces = np.linspace(0.0, 2.0 * np.pi, _POINTS), []
    for name, color in (("pinion", PINION), ("wheel", WHEEL)):
        modification = getattr(pair, name).modification
        if modification.run_out:
            gap = -0.5 * modification.run_out * np.cos(turn - modification.run_out_phase)
            x = displayed("angle", turn)
            traces.append(curve("flank_gap", x, gap, name, color, showlegend=True))
    return Row(
        axis_label("angle", "Rotation of each gear"),
        Panel(axis_label("flank_gap", "Gap from run-out"), traces, height=0.8),
        {"dtick": 90, "range": [0, 360]},
    )


def _caption(pair: SpurPair) -> str:
    rows = (
        (pair.has_profile_modification, "The profile is shown at the middle of the face."),
        (pair.has_lead_modification, "The lead is shown at the middle of the profile, relative to "
         "the middle of the face."),
        (pair.has_pitch_deviation, "Bars are the places of the teeth along the pitch circle."),
        (pair.has_run_out, "Run-out moves all flanks of a gear once per turn."),
    )  # fmt: skip
    first = (
        "Gap of the flanks where perfect involutes would touch: material is removed where the "
        "curves are above zero."
    )
    return " ".join([first, *(text for deviates, text in rows if deviates)])


@drawing(
    heading="Flank modifications",
    caption=_caption,
    missing=_perfect,
    of=(*PAIRS, *(f"{name}.gear_pair" for name in _OTHERS)),
    made_by=RUN,
)
def flank_modification(pair: SpurPair) -> Sketch:
    """Draw the modifications and deviations of both flanks."""
    rows = [
        make(pair)
        for deviates, make in (
            (pair.has_profile_modification, _profile),
            (pair.has_lead_modification, _lead),
            (pair.has_pitch_deviation, _pitch),
            (pair.has_run_out, _run_out),
        )
        if deviates
    ]
    return stack_rows(_title(pair), rows)


def _title(pair: SpurPair) -> str:
    """Title: the largest gap over profile and face, else the pitch deviation or run-out."""
    low, high = pair.path_limits
    path = np.linspace(low, high, _POINTS)[:, None]
    half = 0.5 * pair.common_face_width
    gap = flank_gap(pair, path, pair.line_of_action_length - path, np.linspace(-half, half, 41))
    if np.any(gap):
        most = float(np.max(gap))
        return f"Gap of the unloaded flanks of up to {rounded('flank_gap', most)}"
    swing = max(float(np.ptp(tooth_positions(gear))) for gear in (pair.pinion, pair.wheel))
    if swing:
        return f"Cumulative pitch deviation of up to {rounded('flank_gap', swing)}"
    run_out = max(gear.modification.run_out for gear in (pair.pinion, pair.wheel))
    return f"Run-out of the toothing of {rounded('run_out', run_out)}"
