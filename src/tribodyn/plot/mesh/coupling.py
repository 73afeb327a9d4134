"""How load, film, friction and stiffness of a case came to agree."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Need, drawing
from tribodyn.plot.look.panels import Panel, Row, stack_rows
from tribodyn.plot.look.style import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, line

if TYPE_CHECKING:
    from tribodyn.study.pipeline.computed import Coupling

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
