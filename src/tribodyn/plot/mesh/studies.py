"""Static studies: Harris map, tip relief, lead, stiffness with oil film, coupling."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Need, Sketch, drawing
from tribodyn.plot.mesh.loaded_contact import in_legend, torque_colors, torque_names, whole_cycles
from tribodyn.plot.theme.colors import COLORS, MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, listed, rounded
from tribodyn.plot.theme.panels import (
    FROM_ZERO,
    Panel,
    Row,
    curve,
    curves,
    event_lines,
    from_zero,
    stack,
    stack_rows,
)
from tribodyn.plot.theme.path import mesh_marks, pair_letters, roll_label
from tribodyn.plot.theme.style import POWERS, Trace, contour, line, marked
from tribodyn.types import Array, Mask

if TYPE_CHECKING:
    from tribodyn.mesh import ComprehensiveStiffness
    from tribodyn.stiffness import HarrisMap, LeadOptimum, TipReliefOptimum
    from tribodyn.study.coupling import Coupling

_QUANTITY = "static_transmission_error"
#: Dashes of the mesh harmonics; most curves of the transmission error.
_HARMONICS = ("dash", "dot", "dashdot")
_MOST_CURVES = 25
_CYCLES = 2
#: Colours from small to large transmission error.
_SCALE = [[0.0, "#f7fbff"], [0.5, "#c6dbef"], [1.0, "#6baed6"]]
#: Panels: column, quantity and label.
_PANELS = (
    ("film_stiffness", "film_stiffness", "Oil film K<sub>o</sub>"),
    ("tooth_stiffness", "tooth_stiffness", "Teeth K<sub>m</sub>"),
    ("pair_stiffness", "pair_stiffness", "In series K"),
)
#: Ratio of the largest to the smallest value from which the axis is logarithmic.
_WIDE = 20.0
_DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")


def _curves(study: HarrisMap) -> Row:
    """Row with the transmission error over the mesh cycles, one curve per torque."""
    cycles, rigid = 2 if study.mesh_cycles == 1 else 1, study.unloaded_transmission_error
    phases, errors = study.curves()

    def over_cycles(values: Array, at: Array, name: str, color: str, **style: object) -> Trace:
        x, y = whole_cycles(at, values, study.mesh_cycles, cycles)
        return curve(_QUANTITY, x, y, name, color, **style)

    traces = []
    if np.any(rigid):
        traces.append(over_cycles(rigid, study.phase, "no load", MUTED, dash="dash", width=1.2))
    count = study.torque.size
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_CURVES)).round().astype(int))
    labels, colors = torque_names(study.torque), torque_colors(count)
    for number, visible in zip(chosen[::-1], in_legend(chosen.size)[::-1], strict=True):
        style: Trace = {"width": 1.6, "showlegend": visible}
        label, color = labels[number], colors[number]
        traces.append(over_cycles(errors[number], phases, label, color, **style))
    return Row(
        axis_label("mesh_phase", "Mesh cycles"),
        Panel(axis_label(_QUANTITY, "Transmission error"), traces, height=1.5),
        {"range": [0, cycles * study.mesh_cycles]},
        _cycle_marks(study, cycles),
    )


def _cycle_marks(study: HarrisMap, cycles: int) -> list[tuple[str, float]]:
    """Marks where pairs enter and leave; for hypoid pairs the starts of the mesh cycles."""
    if study.mesh_cycles > 1:
        return []
    if study.gear_pair is None:
        return [("pair enters", float(cycle)) for cycle in range(cycles + 1)]
    return mesh_marks(study.gear_pair, cycles)


def _harris_swings(study: HarrisMap) -> Row:
    """Row with peak-to-peak value and mesh harmonics over the torque."""
    torque, swing = displayed("torque", study.torque), study.peak_to_peak_transmission_error
    rows = [("peak to peak", swing, TOTAL, "solid")]
    rows += [
        (f"harmonic {number + 1}", study.harmonics[:, number], PAIR_COLORS[number], dash)
        for number, dash in enumerate(_HARMONICS[: study.harmonics.shape[1]])
    ]
    style: Trace = {"mode": "lines+markers", "marker": {"size": 5}}
    panel = curves(_QUANTITY, "Variation, amplitude", torque, rows, FROM_ZERO, 1.2, **style)
    quietest = float(displayed("torque", study.quietest_torque))
    inside = study.torque.min() < study.quietest_torque < study.torque.max()
    marks = [("least", quietest)] if inside else ()
    return Row(axis_label("torque", "Torque on the pinion"), panel, FROM_ZERO, marks)


def _harris_caption(study: HarrisMap) -> str:
    caption = (
        "Above, the static transmission error for ascending torques; below, its peak-to-peak "
        "value and mesh harmonics."
    )
    least, ends = study.quietest_torque, (study.torque.min(), study.torque.max())
    if study.torque.size == 1:
        return caption
    end = f"{'least' if least == ends[0] else 'greatest'} of these torques"
    if ends[0] < least < ends[1]:
        end = "torque that the modification suits"
    return f"{caption} The variation is smallest at the {end}."


@drawing(
    heading="Transmission error over torque",
    caption=_harris_caption,
    of="HarrisMap",
    made_by="Call tribodyn.harris_map(case) and its plot method.",
)
def harris_map(study: HarrisMap) -> Sketch:
    """Draw the transmission error per torque, its peak to peak and harmonics over torque."""
    swings = study.peak_to_peak_transmission_error
    least = rounded(_QUANTITY, np.min(swings))
    quietest = torque_names(study.torque)[int(np.argmin(swings))]
    return stack_rows(
        f"Least variation of the transmission error: {least} at {quietest}",
        [_curves(study), _harris_swings(study)],
    )


def _map(study: TipReliefOptimum) -> Row:
    """Row with the objective over amount and length and a marker at the optimum."""
    unit = display_unit(_QUANTITY)
    micro, milli = display_unit("tip_relief"), display_unit("tip_relief_length")
    place = f"%{{x:.4g}} {micro} over %{{y:.4g}} {milli}"
    amount = displayed("tip_relief", study.map_amount)
    length = displayed("tip_relief_length", study.map_length)
    swing, hover = displayed(_QUANTITY, study.map_objective.T), f"{place}: %{{z:.4g}} {unit}"
    surface = contour(amount, length, swing, _SCALE, hover, unit, 0.34) | {"name": "peak to peak"}
    x, y = displayed("tip_relief", [study.amount]), displayed("tip_relief_length", [study.length])
    optimum = marked(x, y, "optimum", WHEEL, 15, "star", showlegend=False)
    optimum["marker"]["line"] = {"color": "white", "width": 1}
    optimum |= {"mode": "markers+text", "text": ["optimum"], "textposition": "top center"}
    optimum |= {"textfont": {"color": TOTAL}, "hovertemplate": f"{place}<extra>optimum</extra>"}
    return Row(
        axis_label("tip_relief", "Amount of the tip relief"),
        Panel(axis_label("tip_relief_length", "Its length"), [surface, optimum], height=1.6),
        {"range": amount[[0, -1]].tolist()},
    )


def _present(study: TipReliefOptimum) -> str:
    """Label of the initial pair, which may have a relief on either gear."""
    pair = study.gear_pair
    reliefs = (pair.pinion.modification.tip_relief, pair.wheel.modification.tip_relief)
    return "before" if any(reliefs) else "without relief"


def _relief_swings(study: TipReliefOptimum) -> Row:
    """Row with the peak-to-peak value over the torque, before and with the best relief."""
    rows = (
        (_present(study), study.peak_to_peak_before, MUTED, "dash"),
        ("with the best relief", study.peak_to_peak_after, WHEEL, "solid"),
    )
    torque, style = displayed("torque", study.torque), Trace(mode="lines+markers")
    panel = curves(_QUANTITY, "Peak to peak", torque, rows, FROM_ZERO, 0.8, **style,
                   marker={"size": 6})  # fmt: skip
    return Row(axis_label("torque", "Torque on the pinion"), panel)


def _relief_time_histories(study: TipReliefOptimum) -> Row:
    """Row with the transmission error with and without relief at the extreme torques."""
    names, ends = torque_names(study.torque), sorted({0, study.torque.size - 1})
    traces = []
    for number, color in zip(ends, torque_colors(len(ends)), strict=True):
        for state, dash, error in (
            (_present(study), "dash", study.transmission_error_before),
            ("with the best relief", "solid", study.transmission_error_after),
        ):
            over = whole_cycles(study.phase, error[number], 1, _CYCLES)
            traces.append(curve(_QUANTITY, *over, f"{names[number]}, {state}", color, dash=dash))
    return Row(
        axis_label("mesh_phase", "Mesh cycles"),
        Panel(axis_label(_QUANTITY, "Transmission error"), traces),
        {"range": [0, _CYCLES]},
        mesh_marks(study.gear_pair, _CYCLES),
    )


def _relief_caption(study: TipReliefOptimum) -> str:
    kind = "largest" if study.objective_kind == "largest" else "mean"
    caption = (
        f"The map shows the {kind} peak-to-peak transmission error over the torques for each "
        f"{study.shape} tip relief, the star the optimum. Below, its effect at each "
        "torque and over the mesh cycle."
    )
    if study.on_edge:
        return f"{caption} The optimum is at the edge of the search range: widen the range."
    return caption


@drawing(
    heading="Tip relief optimization",
    caption=_relief_caption,
    of="TipReliefOptimum",
    made_by="Call tribodyn.optimize_tip_relief(case) and its plot method.",
)
def tip_relief_map(study: TipReliefOptimum) -> Sketch:
    """Draw the objective over amount and length, and the transmission error before and after."""
    amount = rounded("tip_relief", study.amount)
    length = rounded("tip_relief_length", study.length)
    values = (study.objective_before, study.objective)
    before, after = (rounded(_QUANTITY, value) for value in values)
    effect = f"lowers the variation from {before} to {after}"
    if not study.objective < study.objective_before:
        effect = f"does not lower the variation of {before}"
    return stack_rows(
        f"A tip relief of {amount} over {length} {effect}",
        [_map(study), _relief_swings(study), _relief_time_histories(study)],
        {"hovermode": "closest"},
    )


def _curve_styles(study: ComprehensiveStiffness) -> list[tuple[int, int, str, str, str]]:
    """Indices of torque and speed with name, colour and dash of each curve."""
    torques = torque_names(study.pinion_torque)
    speeds = [rounded("speed", value) for value in study.pinion_speed]
    by_speed = len(torques) == 1
    colors = torque_colors(len(speeds) if by_speed else len(torques))
    styles = []
    for t, torque in enumerate(torques):
        for s, speed in enumerate(speeds):
            names = [torque] * (len(torques) > 1) + [speed] * (len(speeds) > 1)
            dash = "solid" if by_speed else _DASHES[s % len(_DASHES)]
            styles.append((t, s, ", ".join(names) or torque, colors[s if by_speed else t], dash))
    return styles


def _panel(
    study: ComprehensiveStiffness, number: int, styles: list[tuple[int, int, str, str, str]]
) -> Panel:
    column, quantity, label = _PANELS[number]
    chosen, slices = _middle_of_face(study)
    angle = displayed("roll_angle", study.roll_angle[chosen])
    values, in_key = slices * getattr(study, column)[..., chosen], number == 0 and len(styles) > 1
    traces = [  # one legend for all panels, next to the first
        curve(quantity, angle, values[t, s], name, color, dash=dash, legendgroup=name,
              showlegend=in_key)
        for t, s, name, color, dash in styles
    ]  # fmt: skip
    sizes = displayed(quantity, values)
    sizes = sizes[np.isfinite(sizes) & (sizes > 0.0)]
    wide = sizes.size > 0 and float(sizes.max()) > _WIDE * float(sizes.min())
    return Panel(axis_label(quantity, label), traces, {"type": "log"} if wide else {})


def _middle_of_face(study: ComprehensiveStiffness) -> tuple[Mask, int]:
    """Places in the middle of the face, and the number of slices of the face."""
    face = study.face_position
    if face is None:
        return np.ones(study.path.size, dtype=bool), 1
    positions = np.unique(face)
    return np.asarray(face == positions[positions.size // 2]), positions.size


def _series_caption(study: ComprehensiveStiffness) -> str:
    caption = (
        "Stiffness of a tooth pair from A to E: of its oil film, of its teeth, and of both in "
        "series. The softer of the two dominates."
    )
    if study.face_position is not None:
        caption += " Values of the slice in the middle of the face, as if all of the face were so."
    if study.kind == "seed":
        return f"{caption} Total stiffnesses of film and teeth are combined, as in the source."
    return caption


@drawing(
    heading="Stiffness of teeth and film",
    caption=_series_caption,
    of="ComprehensiveStiffness",
    made_by="Call tribodyn.comprehensive_stiffness(case) and its plot method.",
)
def comprehensive_stiffness(study: ComprehensiveStiffness) -> Sketch:
    """Draw the stiffness of film, teeth and both in series over the roll angle."""
    pair, styles = study.gear_pair, _curve_styles(study)
    with_film = float(np.mean(study.mean_mesh_stiffness))
    teeth = float(np.mean(study.mean_tooth_stiffness))
    legend_title = "Pinion torque" if len(study.pinion_torque) > 1 else "Pinion speed"
    over_both = len(study.pinion_torque) > 1 and len(study.pinion_speed) > 1
    title = {"text": f"{legend_title}, speed" if over_both else legend_title, "font": {"size": 13}}
    layout = event_lines(pair_letters(pair))
    layout["xaxis"] = {"range": displayed("roll_angle", study.roll_angle[[0, -1]]).tolist()}
    figure = stack(
        f"The film lowers the mean mesh stiffness from {rounded('mesh_stiffness', teeth)} to "
        f"{rounded('mesh_stiffness', with_film)}",
        roll_label(pair),
        [_panel(study, number, styles) for number in range(len(_PANELS))],
        layout,
    )
    figure.layout["legend"] |= {"title": title}
    return figure


_WORDS = {
    "load_change": "load",
    "share_change": "load share",
    "film_change": "film",
    "friction_change": "friction coefficient",
    "stiffness_change": "stiffness",
    "oil_change": "viscosity",
}


@drawing(
    heading="Coupling of load, film and friction",
    missing=Need("iteration", "Set solver.coupling to iterate load, film and friction."),
    of=("Coupling", "Result.coupling"),
    made_by='Set solver.coupling = "static" or "dynamic".',
)
def coupling(coupled: Coupling) -> Sketch:
    """Draw the change of each quantity per iteration, and the converged load.

    Above: change from one iteration to the next; a straight descent is a contracting iteration, and
    its slope shows the strength of the coupling. Below: the force of all pairs relative to the
    force of the torque alone, consistent with film, friction and stiffness.
    """
    curves, changed = [], list[str]()
    for (name, label), color in zip(_WORDS.items(), (TOTAL, *COLORS), strict=False):
        change = getattr(coupled, name)
        if not change.any():
            continue
        changed.append(label)
        positive = np.where(change > 0.0, change, np.nan)
        curves.append({**line(coupled.iteration, positive, label, color), "mode": "lines+markers"})
    ends = [float(coupled.iteration[0]), float(coupled.iteration[-1])]
    curves.append(line(ends, [coupled.tolerance] * 2, "tolerance", MUTED, dash="dot", width=1.2))
    powers = {**POWERS, "dtick": 2}
    load = line(coupled.phase, coupled.loading, "load", PINION)
    passes, over = coupled.iteration.size, coupled.loading
    changing = listed(changed) or "all"
    title = (
        f"{changing[:1].upper()}{changing[1:]} converge after {passes} "
        f"iteration{'s' * (passes > 1)}; the mesh force is {over.min():.3g} to {over.max():.3g} "
        "times that of the torque"
    )
    rows = [
        Row("Iteration", Panel("Change", curves, powers), {"dtick": 1}),
        Row("Mesh phase", Panel("Force over that<br>of the torque", [load])),
    ]
    return stack_rows(title, rows)


@drawing(
    heading="Load over the face",
    of="LeadOptimum",
    made_by="Call tribodyn.stiffness.optimize_lead and the plot method of its result.",
)
def lead_optimum(study: LeadOptimum) -> Sketch:
    """Draw the load over the face before and after the modification, a colour for each torque.

    Load of each slice of the face over the mesh cycle, over the mean of all slices: 1 everywhere is
    even. The greatest value is the face load factor. Dotted: the pair as it was given.
    """
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
