"""Whole turns of the gears: mesh, motion with its sidebands, and what the flanks lose."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.signals.lines import strongest_lines
from tribodyn.plot.theme.colors import PINION, TOTAL, WHEEL, translucent
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import Panel, Row, curves, stack, stack_rows
from tribodyn.plot.theme.style import POWERS, line, stems

if TYPE_CHECKING:
    from tribodyn.faults import TurningMesh
    from tribodyn.study.faults.motion import TurningMotion
    from tribodyn.study.faults.wear import Wear

#: Mesh harmonics of the spectrum, and points of a curve.
_HARMONICS, _POINTS = 4.5, 8000
#: Decades below the largest line that are shown.
_DECADES = 5.0

#: Depth over the greatest below which a place hardly wears.
_SPARED = 0.1


def _caption(motion: TurningMotion) -> str:
    turns = [
        f"{motion.cycles / teeth:g} turns of the {gear}"
        for gear, teeth in (("pinion", motion.pinion_teeth), ("wheel", motion.wheel_teeth))
    ]
    begin = f"All repeats after {motion.cycles} mesh cycles: {' and '.join(turns)}. Above"
    if motion.repeats_after > motion.cycles:
        begin = (
            f"All repeats after {motion.repeats_after} mesh cycles, of which {motion.cycles} are "
            f"shown: {' and '.join(turns)}. Above"
        )
    return (
        f"{begin}, the static transmission error under the mean load; in the middle, the mesh "
        "force; below, the order spectrum of the transmission error with dotted lines at the mesh "
        "harmonics. What differs "
        "from tooth to tooth makes the lines between them: sidebands at the distance of one order "
        "of the pinion, or of the wheel's turn."
    )


@drawing(
    heading="Motion over whole turns",
    caption=_caption,
    of=("TurningMotion", "Result.turns"),
    made_by="Give a case with [faults.NAME], run it, and read result.turning_motion.",
)
def turning_motion(motion: TurningMotion) -> Sketch:
    """Draw transmission error and mesh force over the turns, and the orders of the motion."""
    teeth = motion.pinion_teeth
    turns = motion.time * motion.rotation_frequency("pinion")
    step = -(-turns.size // _POINTS)
    force, unit = displayed("mesh_force", motion.mesh_force), display_unit("mesh_force")
    error_unit = display_unit("static_transmission_error")
    static = displayed("static_transmission_error", motion.at_rest)
    rest_turns = np.arange(static.size) * (motion.cycles / static.size / teeth)
    rest_step = -(-static.size // _POINTS)
    frequency, lines = motion.harmonics("transmission_error")
    order = frequency / motion.rotation_frequency("pinion")
    in_range = (order > 0.0) & (order <= _HARMONICS * teeth)
    place, size = strongest_lines(
        order[in_range], displayed("static_transmission_error", np.abs(lines[in_range]))
    )
    top = float(size.max())
    floor = top * 10.0**-_DECADES
    axis = {**POWERS, "range": [np.log10(floor), np.log10(top) + 0.3]}
    x_label = "Turns of the pinion since tooth 1 came into contact"
    mesh_orders = [(f"{n} x mesh", n * teeth) for n in range(1, int(_HARMONICS) + 1)]
    error_label = axis_label("static_transmission_error", "At rest")
    at_rest = line(rest_turns[::rest_step], static[::rest_step], "at rest", PINION, unit=error_unit)
    force_curve = line(turns[::step], force[::step], "mesh force", TOTAL, unit=unit, width=1.2)
    orders = line(*stems(place, size, floor), "orders", WHEEL, unit=error_unit, width=1.2)
    spectrum = Panel(axis_label("static_transmission_error", "In motion"), [orders], axis)
    rows = [
        Row(x_label, Panel(error_label, [at_rest])),
        Row(x_label, Panel(axis_label("mesh_force", "Mesh force"), [force_curve])),
        Row("Order of the pinion", spectrum, marks=mesh_orders),
    ]
    swing = rounded("mesh_force", np.ptp(motion.mesh_force))
    return stack_rows(f"The mesh force varies by {swing} over {motion.cycles} mesh cycles", rows)


@drawing(
    heading="Mesh over whole turns",
    caption="Static transmission error and tangent stiffness under the mean load over all mesh "
    "cycles after which the same teeth meet again. A deviation lifts the error of its tooth, a "
    "crack lowers the stiffness where its tooth carries. Where the face has slices, the last panel "
    "is the load along the face of the tooth pair that differs most, over its time in contact, and "
    "the median of all pairs.",
    of="TurningMesh",
    made_by="Call tribodyn.faults.turning_mesh(...) and its plot method.",
)
def turning_mesh(mesh: TurningMesh) -> Sketch:
    """Draw transmission error and stiffness over the mesh cycles, and the load along the face."""
    parts = (
        ("static_transmission_error", mesh.transmission_error, "Error at rest", PINION),
        ("mesh_stiffness_tangent", mesh.mesh_stiffness_tangent, "Stiffness", WHEEL),
    )
    rows = [
        Row("Mesh cycles", curves(quantity, name, mesh.phase, [(name.lower(), values, color)]))
        for quantity, values, name, color in parts
    ]
    if mesh.face_position.size > 1:
        rows.append(_load_along_face(mesh))
    swing = rounded("static_transmission_error", mesh.peak_to_peak_transmission_error)
    title = f"The transmission error varies by {swing} over {mesh.cycles} mesh cycles"
    return stack_rows(title, rows)


def _load_along_face(mesh: TurningMesh) -> Row:
    """Load of the tooth pair that differs most from the others along the face."""
    median = np.median(mesh.face_load, axis=0)
    pair = int(np.argmax(np.abs(mesh.face_load - median).max(axis=1)))
    place = 1e3 * mesh.face_position
    curves = [
        line(place, median, "median of all tooth pairs", TOTAL),
        line(place, mesh.face_load[pair], f"tooth pair {pair + 1}", PINION),
    ]
    return Row("From the middle of the face [mm]", Panel("Load over its mean", curves))


def _wear_caption(wear: Wear) -> str:
    depths = {"pinion": wear.depth_pinion[-1], "wheel": wear.depth_wheel[-1]}
    spared = [
        f"the {gear} at {wear.place[int(np.argmin(depth))]:.2g}"
        for gear, depth in depths.items()
        if depth.max() > 0.0 and depth.min() < _SPARED * depth.max()
    ]
    return (
        "Depth of wear over the used flank, from its lowest point (0) to the tip (1), after each "
        "step." + f" Least wears where the flanks slide least: {', '.join(spared)}." * bool(spared)
    )


@drawing(
    heading="Wear of the flanks",
    caption=_wear_caption,
    of="Wear",
    made_by="Call tribodyn.study.wear(...) and its plot method.",
)
def wear_depth(wear: Wear) -> Sketch:
    """Draw the depth of wear of both gears over the flank."""
    panels = []
    gears = (("Pinion", wear.depth_pinion, PINION), ("Wheel", wear.depth_wheel, WHEEL))
    for gear, depth, color in gears:
        steps = [
            (f"{wear.turns[step]:.3g} turns", depth[step],
             translucent(color, 0.25 + 0.75 * step / (len(depth) - 1)))
            for step in range(1, len(depth))
        ]  # fmt: skip
        panels.append(curves("wear_depth", gear, wear.place, steps))
    deepest = rounded("wear_depth", max(wear.depth_pinion.max(), wear.depth_wheel.max()))
    lost = f"up to {deepest}" if wear.depth_pinion.any() or wear.depth_wheel.any() else "nothing"
    title = f"The flanks lose {lost} in {wear.turns[-1]:.3g} turns of the pinion"
    return stack(title, "Place on the used flank", panels)
