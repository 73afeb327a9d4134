"""Colours with fixed roles.

They are those of Okabe and Ito, which remain distinguishable under the common forms of colour
blindness; curves that share a panel differ in dash as well.
"""

from __future__ import annotations

INK = "#1f2933"
MUTED = "#6b7785"
GRID = "#e4e8ec"
#: Fixed roles, so that a colour means the same thing in every figure.
PINION = "#0072B2"
WHEEL = "#D55E00"
TOTAL = INK
PAIR_COLORS = ("#009E73", "#CC79A7", "#56B4E9", "#E69F00")
#: Colours of curves that have no role, in turn.
COLORS = (PINION, WHEEL, *PAIR_COLORS)
#: Colours of maps of values, from the smallest to the largest.
HEAT = [[0.0, "#f2f6fa"], [0.5, "#56B4E9"], [0.75, PINION], [1.0, WHEEL]]
#: Light fill that goes with a line colour.
FILLS = {PINION: "rgba(0, 114, 178, 0.14)", WHEEL: "rgba(213, 94, 0, 0.14)"}


def translucent(color: str, opacity: float) -> str:
    """Return a colour with an opacity between 0 and 1."""
    red, green, blue = (int(color[place : place + 2], 16) for place in (1, 3, 5))
    return f"rgba({red}, {green}, {blue}, {opacity})"
