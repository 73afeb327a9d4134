"""Rough line contacts in mixed lubrication: film and asperities share the load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.film.lubrication import RATIO_TICKS, REGIME_SENTENCE
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.theme.panels import Panel, from_zero, stack
from tribodyn.plot.theme.style import MUTED, PAIR_COLORS, TOTAL, WHEEL, Trace, line

if TYPE_CHECKING:
    from tribodyn.ehl import MixedLineContact


@drawing(
    "mixed_line_contact",
    heading="Film and asperities",
    caption=f"Contacts over their film ratio. {REGIME_SENTENCE} The gap is the mean distance "
    "of the rough flanks; where asperities carry load, it is wider than the film of smooth flanks "
    "under the same load, because the oil carries less load.",
    of="MixedLineContact",
    made_by="Call tribodyn.ehl.mixed_line_contact(...) and its plot method.",
)
def mixed_line_contact(contact: MixedLineContact) -> Any:
    """Draw load shares, gap and pressures over the film ratio."""
    ratio = np.ravel(contact.film_ratio)
    order = np.argsort(ratio, kind="stable")
    place = ratio[order]

    def curve(values: Any, name: str, color: str, unit: str, dash: str = "solid") -> Trace:
        points = line(place, np.ravel(values)[order], name, color, unit=unit, dash=dash)
        return {**points, "mode": "lines+markers"}

    share = contact.film_load_share
    film, pressure = display_unit("film_thickness"), display_unit("hertz_pressure")
    panels = [
        Panel(
            "Share of the load [%]",
            [
                curve(100.0 * share, "oil film", PAIR_COLORS[2], "%"),
                curve(100.0 * (1.0 - share), "asperities", WHEEL, "%", "dash"),
            ],
            {"range": [-2.0, 102.0]},
        ),
        from_zero(
            axis_label("film_thickness", "Thickness"),
            [
                curve(displayed("film_thickness", contact.gap), "gap of rough flanks", TOTAL, film),
                curve(
                    displayed("film_thickness", contact.smooth_film),
                    "film of smooth flanks",
                    MUTED,
                    film,
                    "dash",
                ),
            ],
        ),
        from_zero(
            axis_label("hertz_pressure", "Pressure"),
            [
                curve(
                    displayed("hertz_pressure", contact.hertz_pressure),
                    "maximum, dry smooth contact",
                    MUTED,
                    pressure,
                    "dash",
                ),
                curve(
                    displayed("hertz_pressure", contact.asperity_pressure),
                    "mean of the asperities",
                    WHEEL,
                    pressure,
                ),
            ],
        ),
    ]
    low, high = (significant(100.0 * float(f(share))) for f in (np.min, np.max))
    carried = f"{low} %" if low == high else f"{low} to {high} %"
    log = {"type": "log", "tickvals": RATIO_TICKS}
    layout = {"xaxis": log} if place[0] > 0.0 and place[-1] > 4.0 * place[0] else {}
    return stack(f"The oil film carries {carried} of the load", "Film ratio", panels, layout)
