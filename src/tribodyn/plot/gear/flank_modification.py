"""Modifications and deviations of the flanks: profile, lead, pitch, run-out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.gear import (
    default_relief_length,
    flank_gap,
    flank_ranges,
    lead_gap,
    profile_gap,
    tooth_positions,
)
from tribodyn.plot.mesh.cycle import PAIRS, RUN
from tribodyn.plot.theme.colors import PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import Panel, Row, curve, stack_rows
from tribodyn.plot.theme.path import pair_letters, roll_angle_of, roll_label
from tribodyn.plot.theme.style import Trace, bars
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.gear import SpurPair

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
