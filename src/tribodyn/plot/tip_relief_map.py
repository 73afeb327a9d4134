"""The search for a tip relief: the objective over amount and length, and what it brings."""

from __future__ import annotations

from typing import Any

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.loaded_life import mesh_marks, whole_cycles
from tribodyn.plot.separate import Row, separate
from tribodyn.plot.style import INK, MUTED, TOTAL, WHEEL, Panel, line
from tribodyn.plot.torques import torque_colors, torque_names

_QUANTITY = "static_transmission_error"
_CYCLES = 2
#: From little to much transmission error.
_SCALE = [[0.0, "#f7fbff"], [0.5, "#c6dbef"], [1.0, "#6baed6"]]
#: Part of the height of the figure that the colour bar takes, and its middle.
_BAR = {"len": 0.34, "y": 1.0, "yanchor": "top", "thickness": 14, "x": 1.01, "xanchor": "left"}


def _missing(result: Any) -> str:
    if hasattr(result, "map_objective"):
        return ""
    return (
        "This figure shows the search for a tip relief. Call tribodyn.optimize_tip_relief(case) "
        "and its plot method."
    )


def _map(study: Any) -> Row:
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


def _swings(study: Any) -> Row:
    """Peak-to-peak value over the torque, without and with the relief."""
    unit, torque = display_unit(_QUANTITY), displayed("torque", study.torque)
    mode = {"mode": "lines+markers", "marker": {"size": 6}}
    traces = [
        {**line(torque, displayed(_QUANTITY, swing), name, color, unit=unit, dash=dash), **mode}
        for name, color, dash, swing in (
            ("without", MUTED, "dash", study.peak_to_peak_before),
            ("with relief", WHEEL, "solid", study.peak_to_peak_after),
        )
    ]
    return Row(
        axis_label("torque", "Torque on the pinion"),
        Panel(axis_label(_QUANTITY, "Peak to peak"), traces, {"rangemode": "tozero"}, 0.8),
    )


def _courses(study: Any) -> Row:
    """Transmission error over two mesh cycles, without and with the relief, at both ends."""
    unit, names = display_unit(_QUANTITY), torque_names(study)
    ends = sorted({0, study.torque.size - 1})
    traces = []
    for number, color in zip(ends, torque_colors(len(ends)), strict=True):
        for words, dash, course in (
            ("without", "dash", study.transmission_error_before),
            ("with", "solid", study.transmission_error_after),
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


def _caption(study: Any) -> str:
    kind = "largest" if study.objective_kind == "largest" else "mean"
    words = (
        f"The map shows the {kind} peak-to-peak transmission error over the torques for each "
        f"{study.shape} tip relief, and the star the best one. Below, what it brings at each "
        "torque and over the mesh cycle."
    )
    if study.on_edge:
        return f"{words} The best lies at the edge of the range that was searched: widen it."
    return words


@drawing("tip_relief_map", heading="Search for a tip relief", caption=_caption, needs=_missing)
def tip_relief_map(study: Any) -> Any:
    """Draw the objective over amount and length, and the transmission error before and after.

    Parameters
    ----------
    study : TipReliefOptimum
        What :func:`tribodyn.optimize_tip_relief` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    amount = rounded("tip_relief", study.amount)
    length = rounded("tip_relief_length", study.length)
    before, after = (
        rounded(_QUANTITY, value) for value in (study.objective_before, study.objective)
    )
    made = separate(
        f"A tip relief of {amount} over {length} lowers the swing from {before} to {after}",
        [_map(study), _swings(study), _courses(study)],
    )
    return made.update_layout(hovermode="closest")
