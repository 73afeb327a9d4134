"""Stiffness of oil film and teeth in series over the roll angle, for torques and speeds."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.events import event_lines
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.loaded_life import pair_letters, roll_label
from tribodyn.plot.style import Panel, line, stack
from tribodyn.plot.torques import torque_colors, torque_texts

#: Panels: column, quantity and words.
_PANELS = (
    ("film_stiffness", "film_stiffness", "Oil film K<sub>o</sub>"),
    ("tooth_stiffness", "tooth_stiffness", "Teeth K<sub>m</sub>"),
    ("pair_stiffness", "pair_stiffness", "Both in series K"),
)
#: Values that differ by more than this factor are drawn over a logarithmic axis.
_WIDE = 20.0
_DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")


def _missing(result: Any) -> str:
    if hasattr(result, "film_mesh_stiffness"):
        return ""
    return (
        "This figure shows the stiffness of teeth and film over torque and speed. Call "
        "tribodyn.comprehensive_stiffness(case) and its plot method."
    )


def _looks(study: Any) -> list[tuple[int, int, str, str, str]]:
    """Indices of torque and speed with name, colour and dash of each curve."""
    torques = torque_texts(study.pinion_torque)
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


def _panel(study: Any, number: int, looks: list[tuple[int, int, str, str, str]]) -> Panel:
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


def _caption(study: Any) -> str:
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
    caption=_caption,
    needs=_missing,
)
def comprehensive_stiffness(study: Any) -> Any:
    """Draw the stiffness of film, teeth and both in series over the roll angle.

    Parameters
    ----------
    study : ComprehensiveStiffness
        What :func:`tribodyn.comprehensive_stiffness` returns.

    Returns
    -------
    plotly.graph_objects.Figure
        A curve for each torque and speed: colours for torques and dashes for speeds, or colours
        for the speeds of a single torque.
    """
    pair, looks = study.gear_pair, _looks(study)
    with_film = float(np.mean(study.mean_mesh_stiffness))
    teeth = float(np.mean(study.mean_tooth_stiffness))
    layout = event_lines(pair_letters(pair))
    layout["xaxis"] = {"range": displayed("roll_angle", study.roll_angle[[0, -1]]).tolist()}
    figure = stack(
        f"The film lowers the mean mesh stiffness from {rounded('mesh_stiffness', teeth)} to "
        f"{rounded('mesh_stiffness', with_film)}",
        roll_label(pair),
        [_panel(study, number, looks) for number in range(len(_PANELS))],
        layout,
    )
    words = "Pinion torque" if len(study.pinion_torque) > 1 else "Pinion speed"
    both = len(study.pinion_torque) > 1 and len(study.pinion_speed) > 1
    title = {"text": f"{words}, speed" if both else words, "font": {"size": 13}}
    return figure.update_layout(legend={"title": title})
