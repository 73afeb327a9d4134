"""Time histories of a run: mesh force, transmission error, accelerations, bearing forces."""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.mesh.cycle import cycles, run_drawing
from tribodyn.plot.motion.motion import Motion, no_translation
from tribodyn.plot.signals.spectra import strongest_lines
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, translucent
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, quantity_label, rounded
from tribodyn.plot.theme.panels import Panel, Row, curves, from_zero, stack, stack_rows
from tribodyn.plot.theme.style import POWERS, line, stems
from tribodyn.study.pipeline import response_series

if TYPE_CHECKING:
    from tribodyn.faults import TurningMesh
    from tribodyn.study import PairResult
    from tribodyn.study.faults.motion import TurningMotion
    from tribodyn.study.faults.wear import Wear

#: Name and colour of each gear's curve.
GEARS = (("pinion", PINION), ("wheel", WHEEL))
#: Axis of the coordinate and its description.
DIRECTIONS = (("y", "along the line of action"), ("x", "across the line of action"))
#: Smallest relative shift of the mean force that the caption reports.
_SHIFTED = 1e-3
_ALONG = "along the line of action"
#: Characters of a line of a label, distance of two means over the swing from which each signal is
#: drawn about its mean, and swing of a force over its size from which its axis begins at zero.
_LINE, _APART, _SEEN = 26, 2.0, 0.1


def directions(result: PairResult) -> tuple[tuple[str, str], ...]:
    """Axes of a gear's coordinates and their descriptions, for planar and spatial models."""
    names = result.response.names
    in_space = "pinion_z" in names
    return tuple(response_series.directions_of(names).values()) if in_space else DIRECTIONS


def _along(result: PairResult) -> str:
    return dict(directions(result))["y"]


def wrapped_label(quantity: str, direction: str) -> str:
    """Label of a quantity with its direction below, in lines that fit next to a panel."""
    return "<br>".join([quantity_label(quantity), *wrap(direction, _LINE)])


def _means(result: PairResult, quantity: str, axis: str) -> tuple[float, ...]:
    """Means of a signal of both gears where it varies little about different ones; else none."""
    motion = Motion(result)
    signals = [motion.measured(motion.of_gear(quantity, gear, axis)) for gear, _ in GEARS]
    means = tuple(float(np.mean(signal)) for signal in signals)
    swing = max(float(np.ptp(signal)) for signal in signals)
    return means if abs(means[1] - means[0]) > _APART * swing else ()


def _motion_panels(result: PairResult, quantity: str) -> list[Panel]:
    """Panels with a signal of pinion and wheel, about its means where it varies little."""
    motion, panels = Motion(result), []
    for axis, direction in directions(result):
        means = _means(result, quantity, axis)
        label = wrapped_label(quantity, direction + ", without its mean" * bool(means))
        traces = []
        for (gear, color), mean in zip(GEARS, means or (0.0, 0.0), strict=True):
            values = motion.of_gear(quantity, gear, axis) - mean
            traces.append(motion.line(quantity, values, gear, color, width=1.5))
        size = float(displayed(quantity, max(map(abs, means), default=0.0)))
        panels.append(Panel(axis_label(quantity, label), traces, size=size))
    return panels


def _levels(result: PairResult, quantity: str) -> str:
    """Sentence on the means that the curves leave out."""
    levels = []
    for axis, direction in directions(result):
        if means := _means(result, quantity, axis):
            pinion, wheel = (rounded(quantity, mean) for mean in means)
            levels.append(f"{pinion} (pinion) and {wheel} (wheel) {direction}")
    return f"Means that the curves leave out: {'; '.join(levels)}. " if levels else ""


def _below_zero(result: PairResult) -> str:
    """Explain a negative mesh force, which the driving flanks cannot transmit."""
    fine = result.response.fine
    if np.min(response_series.mesh_force(fine)) >= 0.0:
        return ""
    if result.half_backlash == 0.0:
        return "Where it is negative, the flanks would separate, but the case has no backlash."
    touch = response_series.first_touch(result.system, fine)
    if np.any(response_series.compression(fine) < -touch):
        return "Where it is negative, the backlash is crossed and the back flanks touch."
    return "Where it is negative, the contact damping pulls just before the flanks separate."


def _force_caption(result: PairResult) -> str:
    motion = Motion(result)
    lost = result.summary().get("contact_loss_share", 0.0) > 0.0
    sentences = (
        "The dynamic force between the gears, compared with the static force that the torque alone "
        "causes.",
        "Where the curve is zero, the flanks have lost contact." if lost else "",
        _mean_shift(result, motion) if motion.periodic else "",
        _below_zero(result),
        motion.settling(motion.mesh_force),
    )
    return " ".join(filter(None, sentences))


def _mean_shift(result: PairResult, motion: Motion) -> str:
    """Sentence on the shift of the mean force from the static force by friction."""
    mean = float(result.response.fine.weight @ motion.mesh_force)
    shift = mean / result.mesh.total_normal_force - 1.0
    if abs(shift) < _SHIFTED or not np.any(result.mesh.friction_coefficient):
        return ""
    return (
        f"Its mean is {100.0 * abs(shift):.2g} % {'above' if shift > 0.0 else 'below'} the static "
        "force, because friction carries a part of the torque."
    )


@run_drawing(heading="Mesh force", caption=_force_caption)
def mesh_force(result: PairResult) -> Sketch:
    """Draw the dynamic and the static mesh force."""
    motion = Motion(result)
    force = motion.mesh_force
    static = np.full_like(force, result.mesh.total_normal_force)
    traces = [
        motion.line("mesh_force", force, "dynamic", TOTAL),
        motion.line("mesh_force", static, "static", MUTED, dash="dash"),
    ]
    ends = [float(f(motion.measured(force))) for f in (np.min, np.max)]
    low, high = (rounded("mesh_force", end) for end in ends)
    # A force that varies little is drawn to its own scale.
    panel = from_zero if ends[1] - ends[0] > _SEEN * ends[1] else Panel
    panels = [panel(axis_label("mesh_force"), traces, height=1.3)]
    return motion.figure(f"The mesh force varies between {low} and {high}", panels)


def _friction_caption(result: PairResult) -> str:
    split = "film_friction_force" in response_series.friction_forces(result, result.response.fine)
    parts = (
        "The parts of the oil films and of the asperities add up to the total."
        if split
        else f'The friction law "{result.mesh.friction_law}" does not separate films from '
        'asperities; "mixed", "mixed-ehl" and "mixed-solved" do.'
    )
    return (
        "Friction of all tooth pairs across the line of action, each pair with its direction of "
        f"sliding; it follows the dynamic mesh force. {parts}"
    )


@run_drawing(
    heading="Friction force",
    caption=_friction_caption,
    missing=lambda result: (
        "" if np.any(result.mesh.friction_coefficient) else 'friction.law is "none".'
    ),
)
def friction_force(result: PairResult) -> Sketch:
    """Draw the friction force of all tooth pairs and its film and asperity parts."""
    motion = Motion(result)
    forces = response_series.friction_forces(result, result.response.fine)
    parts = (
        ("friction_force", "total", TOTAL),
        ("film_friction_force", "oil films", PAIR_COLORS[2]),
        ("asperity_friction_force", "asperities", WHEEL),
    )
    traces = [
        motion.line("friction_force", forces[name][0], label, color)
        for name, label, color in parts
        if name in forces
    ]
    force = motion.measured(forces["friction_force"][0])
    low, high = (rounded("friction_force", f(force)) for f in (np.min, np.max))
    panel = Panel(axis_label("friction_force"), traces, {"zeroline": True}, height=1.3)
    return motion.figure(f"The friction force ranges from {low} to {high}", [panel])


def _error_caption(result: PairResult) -> str:
    motion = Motion(result)
    lag = "Lag of the driven gear behind its ideal position, measured on the line of action."
    dashed = "The dashed curve is the lag at a very low speed"
    if not motion.periodic:
        return f"{lag} {motion.settling(motion.transmission_error)}"
    if not np.any(result.mesh.friction_coefficient):
        return f"{lag} {dashed}; what the dynamics add to it is vibration."
    return (
        f"{lag} {dashed} without friction. The variation about it is vibration; an offset of the "
        "mean is due to friction, which carries a part of the torque."
    )


@run_drawing(heading="Transmission error", caption=_error_caption)
def transmission_error(result: PairResult) -> Sketch:
    """Draw the dynamic transmission error and, for a steady state, the quasi-static one."""
    motion, unit = Motion(result), display_unit("dynamic_transmission_error")
    moving = motion.transmission_error
    traces = [motion.line("dynamic_transmission_error", moving, "dynamic", TOTAL)]
    if motion.periodic:
        mesh = result.mesh
        static = displayed("transmission_error", result.transmission_error_at_rest())
        phase, error = cycles(mesh.phase, static, motion.shown)
        traces.append(line(phase, error, "quasi-static", MUTED, unit=unit, dash="dash"))
    swing = rounded("dynamic_transmission_error", np.ptp(motion.measured(moving)))
    panel = Panel(axis_label("dynamic_transmission_error"), traces, height=1.3)
    return motion.figure(f"The transmission error varies by {swing} peak to peak", [panel])


def _settling(result: PairResult, quantity: str) -> str:
    motion = Motion(result)
    return motion.settling(motion.of_gear(quantity, "pinion", "y"))


def _shake_caption(result: PairResult) -> str:
    planar = "The mesh force acts along the line of action; across it only friction acts" + (
        ". " if np.any(result.mesh.friction_coefficient) else ", and this case has none. "
    )
    sentences = (
        "Vibration of the two gear centres. ",
        planar if _along(result) == _ALONG else "",
        _settling(result, "acceleration"),
    )
    return "".join(sentences).rstrip()


@run_drawing(heading="Accelerations", caption=_shake_caption, missing=no_translation)
def acceleration(result: PairResult) -> Sketch:
    """Draw the accelerations of the gear centres."""
    motion = Motion(result)
    strongest = np.max(np.abs(motion.measured(motion.of_gear("acceleration", "pinion", "y"))))
    peak = rounded("acceleration", strongest)
    title = f"The pinion accelerates with up to {peak} {_along(result)}"
    return motion.figure(title, _motion_panels(result, "acceleration"))


def _bearing_caption(result: PairResult) -> str:
    planar = "Along the line of action the bearings carry the mesh force, across it the friction. "
    return (
        "The mean force loads the bearings; the variation about it excites the housing. "
        + _levels(result, "bearing_force")
        + (planar if _along(result) == _ALONG else "")
        + _settling(result, "bearing_force")
    ).rstrip()


@run_drawing(heading="Bearing forces", caption=_bearing_caption, missing=no_translation)
def bearing_force(result: PairResult) -> Sketch:
    """Draw the forces of both gears on their bearings."""
    motion = Motion(result)
    swing = np.ptp(motion.measured(motion.of_gear("bearing_force", "pinion", "y")))
    title = (
        f"The force on the pinion's bearing varies by {rounded('bearing_force', swing)} peak to "
        f"peak {_along(result)}"
    )
    return motion.figure(title, _motion_panels(result, "bearing_force"))


def _in_a_plane(result: PairResult) -> str:
    if "pinion_z" in result.response.names:
        return ""
    return "The tooth forces of these gears lie in a plane, along one line of action."


@run_drawing(heading="Mesh force in space", missing=_in_a_plane)
def tooth_force(result: PairResult) -> Sketch:
    """Draw the three components of the tooth force.

    Force of the teeth on the wheel, friction included, in the axes of the pinion: x along the
    common perpendicular of the two axes, y along the pinion axis, z normal to x and y.
    """
    motion, fine = Motion(result), result.response.fine
    components = response_series.tooth_force(
        result, response_series.one_sided_phase(fine), motion.mesh_force
    )
    values = np.zeros((fine.phase.size, 3)) if components is None else components
    panels = []
    for axis, color, component in zip("xyz", (PINION, WHEEL, TOTAL), values.T, strict=True):
        curve = motion.line("mesh_force", component, axis, color, width=1.5)
        panels.append(Panel(axis_label("mesh_force", wrapped_label("mesh_force", axis)), [curve]))
    means = [rounded("mesh_force", fine.weight @ component) for component in values.T]
    title = f"The mean tooth force is {means[0]}, {means[1]} and {means[2]}"
    return motion.figure(title, panels)


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
    of="TurningMesh",
    made_by="Call tribodyn.faults.turning_mesh(...) and its plot method.",
)
def turning_mesh(mesh: TurningMesh) -> Sketch:
    """Draw transmission error and stiffness over the mesh cycles, and the load along the face.

    Static transmission error and tangent stiffness under the mean load over all mesh cycles after
    which the same teeth meet again. A deviation lifts the error of its tooth, a crack lowers the
    stiffness where its tooth carries. Where the face has slices, the last panel is the load along
    the face of the tooth pair that differs most, over its time in contact, and the median of all
    pairs.
    """
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
