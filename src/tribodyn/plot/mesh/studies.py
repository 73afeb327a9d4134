"""Studies of the mesh at rest: Harris map, search for a tip relief, stiffness with oil film."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Need, drawing
from tribodyn.plot.gear.path import mesh_marks, pair_letters, roll_label
from tribodyn.plot.look.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.look.panels import Panel, Row, event_lines, stack, stack_rows
from tribodyn.plot.look.style import INK, MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, line
from tribodyn.plot.mesh.loaded_contact import named, torque_colors, torque_names, whole_cycles
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import ComprehensiveStiffness
    from tribodyn.stiffness import HarrisMap, TipReliefOptimum
    from tribodyn.study.pipeline.computed import Coupling


_QUANTITY = "static_transmission_error"
#: Mesh harmonics drawn, each with a dash of its own; curves of the transmission error.
_HARMONICS = ("dash", "dot", "dashdot")
_MOST_CURVES = 25
_CYCLES = 2
#: From little to much transmission error.
_SCALE = [[0.0, "#f7fbff"], [0.5, "#c6dbef"], [1.0, "#6baed6"]]
#: Part of the height of the figure that the colour bar takes, and its middle.
_BAR = {"len": 0.34, "y": 1.0, "yanchor": "top", "thickness": 14, "x": 1.01, "xanchor": "left"}
#: Panels: column, quantity and words.
_PANELS = (
    ("film_stiffness", "film_stiffness", "Oil film K<sub>o</sub>"),
    ("tooth_stiffness", "tooth_stiffness", "Teeth K<sub>m</sub>"),
    ("pair_stiffness", "pair_stiffness", "Both in series K"),
)
#: Values that differ by more than this factor are drawn over a logarithmic axis.
_WIDE = 20.0
_DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")


def _curves(study: HarrisMap) -> Row:
    """Transmission error over the mesh cycles, one curve for each torque."""
    unit, cycles = display_unit(_QUANTITY), 2 if study.mesh_cycles == 1 else 1
    rigid = study.unloaded_transmission_error

    phases, errors = study.curves()

    def over(values: Array, at: Array) -> tuple[Array, Array]:
        return whole_cycles(at, displayed(_QUANTITY, values), study.mesh_cycles, cycles)

    traces = []
    if np.any(rigid):
        phase, shown = over(rigid, study.phase)
        traces.append(line(phase, shown, "no load", MUTED, unit=unit, dash="dash", width=1.2))
    count = study.torque.size
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_CURVES)).round().astype(int))
    labels, looks = torque_names(study.torque), torque_colors(count)
    for number, known in zip(chosen[::-1], named(chosen.size)[::-1], strict=True):
        trace = line(
            *over(errors[number], phases),
            labels[number],
            looks[number],
            unit=unit,
            width=1.6,
        )
        traces.append({**trace, "showlegend": known})
    return Row(
        axis_label("mesh_phase", "Mesh cycles"),
        Panel(axis_label(_QUANTITY, "Transmission error"), traces, height=1.5),
        {"range": [0, cycles * study.mesh_cycles]},
        _cycle_marks(study, cycles),
    )


def _cycle_marks(study: HarrisMap, cycles: int) -> list[tuple[str, float]]:
    """Marks of pairs that enter and leave; of hypoid pairs the beginnings of the mesh cycles."""
    if study.mesh_cycles > 1:
        return []
    if study.gear_pair is None:
        return [("pair enters", float(cycle)) for cycle in range(cycles + 1)]
    return mesh_marks(study.gear_pair, cycles)


def _harris_swings(study: HarrisMap) -> Row:
    """Peak-to-peak value and mesh harmonics over the torque."""
    unit, torque = display_unit(_QUANTITY), displayed("torque", study.torque)
    mode = {"mode": "lines+markers", "marker": {"size": 5}}
    swing = displayed(_QUANTITY, study.peak_to_peak_transmission_error)
    traces = [{**line(torque, swing, "peak to peak", TOTAL, unit=unit), **mode}]
    for number, dash in enumerate(_HARMONICS[: study.harmonics.shape[1]]):
        amplitude = displayed(_QUANTITY, study.harmonics[:, number])
        name, color = f"harmonic {number + 1}", PAIR_COLORS[number]
        traces.append({**line(torque, amplitude, name, color, unit=unit, dash=dash), **mode})
    quietest = float(displayed("torque", study.quietest_torque))
    inside = study.torque.min() < study.quietest_torque < study.torque.max()
    return Row(
        axis_label("torque", "Torque on the pinion"),
        Panel(axis_label(_QUANTITY, "Variation, amplitude"), traces, {"rangemode": "tozero"}, 1.2),
        {"rangemode": "tozero"},
        [("least", quietest)] if inside else (),
    )


def _harris_caption(study: HarrisMap) -> str:
    words = (
        "Above, the transmission error of the mesh at rest under rising torque; below, how far it "
        "varies and how much of that falls on each mesh harmonic."
    )
    least, ends = study.quietest_torque, (study.torque.min(), study.torque.max())
    if ends[0] < least < ends[1]:
        return f"{words} These flanks are quietest at the torque for which their shape is right."
    if study.torque.size == 1:
        return words
    end = "least" if least == ends[0] else "greatest"
    return f"{words} The least variation is at the {end} of these torques: no other one is best."


@drawing(
    "harris_map",
    heading="Transmission error over torque",
    caption=_harris_caption,
    of="HarrisMap",
    made_by="Call tribodyn.harris_map(case) and its plot method.",
)
def harris_map(study: HarrisMap) -> Any:
    """Draw the transmission error for each torque; its peak to peak and harmonics over torque."""
    swings = study.peak_to_peak_transmission_error
    least = rounded(_QUANTITY, float(np.min(swings)))
    quietest = torque_names(study.torque)[int(np.argmin(swings))]
    return stack_rows(
        f"Quietest at {quietest}: there the transmission error varies by {least}",
        [_curves(study), _harris_swings(study)],
    )


def _map(study: TipReliefOptimum) -> Row:
    """Objective over amount and length, with a mark at the optimum."""
    unit = display_unit(_QUANTITY)
    micro, milli = display_unit("tip_relief"), display_unit("tip_relief_length")
    hover = f"%{{x:.4g}} {micro} over %{{y:.4g}} {milli}: %{{z:.4g}} {unit}<extra></extra>"
    surface = {
        "type": "contour",
        "x": displayed("tip_relief", study.map_amount),
        "y": displayed("tip_relief_length", study.map_length),
        "z": displayed(_QUANTITY, study.map_objective.T),
        "colorscale": _SCALE,
        "ncontours": 16,
        "contours": {"showlabels": True, "labelfont": {"size": 10, "color": INK}},
        "line": {"width": 0.6, "color": MUTED},
        "colorbar": {**_BAR, "title": {"text": f"[{unit}]"}},
        "name": "peak to peak",
        "hovertemplate": hover,
        "showlegend": False,
    }
    optimum = {
        "type": "scatter",
        "mode": "markers+text",
        "x": [float(displayed("tip_relief", study.amount))],
        "y": [float(displayed("tip_relief_length", study.length))],
        "marker": {
            "symbol": "star",
            "size": 15,
            "color": WHEEL,
            "line": {"color": "white", "width": 1},
        },
        "text": ["optimum"],
        "textposition": "top center",
        "textfont": {"color": TOTAL},
        "name": "optimum",
        "hovertemplate": f"%{{x:.4g}} {micro} over %{{y:.4g}} {milli}<extra>optimum</extra>",
        "showlegend": False,
    }
    return Row(
        axis_label("tip_relief", "Amount of the tip relief"),
        Panel(axis_label("tip_relief_length", "Its length"), [surface, optimum], height=1.6),
        {"range": displayed("tip_relief", study.map_amount[[0, -1]]).tolist()},
    )


def _present(study: TipReliefOptimum) -> str:
    """Name of the pair before the search: it may have a relief already, on either gear."""
    pair = study.gear_pair
    reliefs = (pair.pinion.modification.tip_relief, pair.wheel.modification.tip_relief)
    return "before" if any(reliefs) else "without relief"


def _relief_swings(study: TipReliefOptimum) -> Row:
    """Peak-to-peak value over the torque, before the search and with its relief."""
    unit, torque = display_unit(_QUANTITY), displayed("torque", study.torque)
    mode = {"mode": "lines+markers", "marker": {"size": 6}}
    traces = [
        {**line(torque, displayed(_QUANTITY, swing), name, color, unit=unit, dash=dash), **mode}
        for name, color, dash, swing in (
            (_present(study), MUTED, "dash", study.peak_to_peak_before),
            ("with the best relief", WHEEL, "solid", study.peak_to_peak_after),
        )
    ]
    return Row(
        axis_label("torque", "Torque on the pinion"),
        Panel(axis_label(_QUANTITY, "Peak to peak"), traces, {"rangemode": "tozero"}, 0.8),
    )


def _courses(study: TipReliefOptimum) -> Row:
    """Transmission error over two mesh cycles, before and with the best relief, at both ends."""
    unit, names = display_unit(_QUANTITY), torque_names(study.torque)
    ends = sorted({0, study.torque.size - 1})
    traces = []
    for number, color in zip(ends, torque_colors(len(ends)), strict=True):
        for words, dash, course in (
            (_present(study), "dash", study.transmission_error_before),
            ("with the best relief", "solid", study.transmission_error_after),
        ):
            shown = displayed(_QUANTITY, course[number])
            curve = whole_cycles(study.phase, shown, 1, _CYCLES)
            traces.append(line(*curve, f"{names[number]}, {words}", color, unit=unit, dash=dash))
    return Row(
        axis_label("mesh_phase", "Mesh cycles"),
        Panel(axis_label(_QUANTITY, "Transmission error"), traces),
        {"range": [0, _CYCLES]},
        mesh_marks(study.gear_pair, _CYCLES),
    )


def _relief_caption(study: TipReliefOptimum) -> str:
    kind = "largest" if study.objective_kind == "largest" else "mean"
    words = (
        f"The map shows the {kind} peak-to-peak transmission error over the torques for each "
        f"{study.shape} tip relief, and the star the best one. Below, what it brings at each "
        "torque and over the mesh cycle."
    )
    if study.on_edge:
        return f"{words} The best lies at the edge of the range that was searched: widen it."
    return words


@drawing(
    "tip_relief_map",
    heading="Search for a tip relief",
    caption=_relief_caption,
    of="TipReliefOptimum",
    made_by="Call tribodyn.optimize_tip_relief(case) and its plot method.",
)
def tip_relief_map(study: TipReliefOptimum) -> Any:
    """Draw the objective over amount and length, and the transmission error before and after."""
    amount = rounded("tip_relief", study.amount)
    length = rounded("tip_relief_length", study.length)
    before, after = (
        rounded(_QUANTITY, value) for value in (study.objective_before, study.objective)
    )
    return stack_rows(
        f"A tip relief of {amount} over {length} lowers the variation from {before} to {after}",
        [_map(study), _relief_swings(study), _courses(study)],
        {"hovermode": "closest"},
    )


def _looks(study: ComprehensiveStiffness) -> list[tuple[int, int, str, str, str]]:
    """Indices of torque and speed with name, colour and dash of each curve."""
    torques = torque_names(study.pinion_torque)
    speeds = [rounded("speed", float(value)) for value in study.pinion_speed]
    by_speed = len(torques) == 1
    colors = torque_colors(len(speeds) if by_speed else len(torques))
    found = []
    for t, torque in enumerate(torques):
        for s, speed in enumerate(speeds):
            names = [torque] * (len(torques) > 1) + [speed] * (len(speeds) > 1)
            dash = "solid" if by_speed else _DASHES[s % len(_DASHES)]
            found.append((t, s, ", ".join(names) or torque, colors[s if by_speed else t], dash))
    return found


def _panel(
    study: ComprehensiveStiffness, number: int, looks: list[tuple[int, int, str, str, str]]
) -> Panel:
    column, quantity, words = _PANELS[number]
    unit, angle = display_unit(quantity), displayed("roll_angle", study.roll_angle)
    values, traces = getattr(study, column), []
    for t, s, name, color, dash in looks:
        shown = displayed(quantity, values[t, s])
        trace = line(angle, shown, name, color, unit=unit, dash=dash)
        # One legend for all panels, beside the first.
        more = {"legendgroup": name, "showlegend": number == 0 and len(looks) > 1}
        traces.append({**trace, **more})
    sizes = displayed(quantity, getattr(study, column))
    sizes = sizes[np.isfinite(sizes) & (sizes > 0.0)]
    wide = sizes.size > 0 and float(sizes.max()) > _WIDE * float(sizes.min())
    return Panel(axis_label(quantity, words), traces, {"type": "log"} if wide else {})


def _series_caption(study: ComprehensiveStiffness) -> str:
    words = (
        "Stiffness of one tooth pair from A to E: of its oil film, of its teeth, and of both in "
        "series. The softer of the two rules the pair."
    )
    if study.kind == "seed":
        return f"{words} Film and teeth are put together as totals, as the source prints them."
    return words


@drawing(
    "comprehensive_stiffness",
    heading="Stiffness of teeth and film",
    caption=_series_caption,
    of="ComprehensiveStiffness",
    made_by="Call tribodyn.comprehensive_stiffness(case) and its plot method.",
)
def comprehensive_stiffness(study: ComprehensiveStiffness) -> Any:
    """Draw the stiffness of film, teeth and both in series over the roll angle."""
    pair, looks = study.gear_pair, _looks(study)
    with_film = float(np.mean(study.mean_mesh_stiffness))
    teeth = float(np.mean(study.mean_tooth_stiffness))
    words = "Pinion torque" if len(study.pinion_torque) > 1 else "Pinion speed"
    both = len(study.pinion_torque) > 1 and len(study.pinion_speed) > 1
    title = {"text": f"{words}, speed" if both else words, "font": {"size": 13}}
    layout = event_lines(pair_letters(pair))
    layout["xaxis"] = {"range": displayed("roll_angle", study.roll_angle[[0, -1]]).tolist()}
    figure = stack(
        f"The film lowers the mean mesh stiffness from {rounded('mesh_stiffness', teeth)} to "
        f"{rounded('mesh_stiffness', with_film)}",
        roll_label(pair),
        [_panel(study, number, looks) for number in range(len(_PANELS))],
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
    "coupling",
    heading="Load, film and friction agree",
    caption="Above: change from one pass to the next; a straight fall is a coupling that "
    "contracts, and its slope says how strongly one acts on the other. Below: the force of "
    "all pairs over that of the torque alone, to which film, friction and stiffness belong.",
    missing=Need(
        "iteration", "Set solver.coupling, and load, film and friction are made to agree."
    ),
    of=("Coupling", "Result.coupling"),
    made_by='Set solver.coupling = "static" or "dynamic".',
)
def coupling(found: Coupling) -> Any:
    """Draw the change of each quantity per pass, and the load that was found."""
    curves = []
    for (name, words), color in zip(
        _WORDS.items(), (TOTAL, PINION, WHEEL, *PAIR_COLORS), strict=False
    ):
        change = getattr(found, name)
        if not change.any():
            continue
        shown = np.where(change > 0.0, change, np.nan)
        curves.append({**line(found.iteration, shown, words, color), "mode": "lines+markers"})
    ends = [float(found.iteration[0]), float(found.iteration[-1])]
    curves.append(line(ends, [found.tolerance] * 2, "tolerance", MUTED, dash="dot", width=1.2))
    powers = {"type": "log", "exponentformat": "power", "dtick": 2}
    load = line(found.phase, found.loading, "load", PINION)
    passes, over = found.iteration.size, found.loading
    title = (
        f"Load, film, friction and stiffness agree after {passes} pass{'es' * (passes > 1)}; the "
        f"teeth carry {over.min():.3g} to {over.max():.3g} times the force of the torque"
    )
    rows = [
        Row("Pass", Panel("Change", curves, powers), {"dtick": 1}),
        Row("Mesh phase", Panel("Force over that<br>of the torque", [load])),
    ]
    return stack_rows(title, rows)
