"""Rough line contacts in mixed lubrication: film and asperities share the load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.film.lubrication import RATIO_TICKS, REGIME_SENTENCE
from tribodyn.plot.theme.curves import FROM_ZERO, curves
from tribodyn.plot.theme.labels import significant
from tribodyn.plot.theme.panels import Panel, stack
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
    place, share = ratio[order], 100.0 * np.ravel(contact.film_load_share)[order]
    mode: Trace = {"mode": "lines+markers"}

    def pair(quantity: str, label: str, *rows: tuple[str, Any, str, str]) -> Panel:
        sorted_rows = [(name, np.ravel(each)[order], *style) for name, each, *style in rows]
        return curves(quantity, label, place, sorted_rows, FROM_ZERO, **mode)

    shares = [
        line(place, share, "oil film", PAIR_COLORS[2], unit="%", **mode),
        line(place, 100.0 - share, "asperities", WHEEL, unit="%", dash="dash", **mode),
    ]
    panels = [
        Panel("Share of the load [%]", shares, {"range": [-2.0, 102.0]}),
        pair("film_thickness", "Thickness",
             ("gap of rough flanks", contact.gap, TOTAL, "solid"),
             ("film of smooth flanks", contact.smooth_film, MUTED, "dash")),
        pair("hertz_pressure", "Pressure",
             ("maximum, dry smooth contact", contact.hertz_pressure, MUTED, "dash"),
             ("mean of the asperities", contact.asperity_pressure, WHEEL, "solid")),
    ]  # fmt: skip
    low, high = (significant(float(f(share))) for f in (np.min, np.max))
    carried = f"{low} %" if low == high else f"{low} to {high} %"
    log = {"type": "log", "tickvals": RATIO_TICKS}
    layout = {"xaxis": log} if place[0] > 0.0 and place[-1] > 4.0 * place[0] else {}
    return stack(f"The oil film carries {carried} of the load", "Film ratio", panels, layout)
