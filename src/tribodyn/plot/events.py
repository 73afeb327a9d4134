"""Dotted lines through all panels of a figure, each with a short name on top."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

from tribodyn.plot.style import MUTED

#: Width of a character relative to the axis on a narrow screen, and height of a level [px].
_CHARACTER, _LEVEL = 0.015, 14


def event_lines(places: Iterable[tuple[str, float]], share: float = 1.0) -> dict[str, Any]:
    """Mark positions on the horizontal axis."""
    joined: dict[float, list[str]] = {}
    for name, x in places:
        joined.setdefault(round(float(x), 9), []).append(name)
    common = {"yref": "paper", "xref": "x"}
    shapes = [
        {
            "type": "line",
            "x0": x,
            "x1": x,
            "y0": 0,
            "y1": 1,
            "layer": "below",
            "line": {"color": MUTED, "width": 1, "dash": "dot"},
            **common,
        }
        for x in joined
    ]
    names = {x: ", ".join(joined[x]) for x in sorted(joined)}
    notes = [
        {
            "x": x,
            "y": 1,
            "yanchor": "bottom",
            "yshift": _LEVEL * level,
            "text": names[x],
            "showarrow": False,
            "font": {"size": 12, "color": MUTED},
            **common,
        }
        for x, level in zip(names, _levels(names, share), strict=True)
    ]
    return {"shapes": shapes, "annotations": notes}


def _levels(names: dict[float, str], share: float) -> list[int]:
    """Raise a name by one level where it would run into its left neighbour."""
    span = (max(names, default=0.0) - min(names, default=0.0)) / share
    levels = [0] * bool(names)
    for (left, first), (right, second) in pairwise(names.items()):
        needed = _CHARACTER * (1 + 0.5 * (len(first) + len(second))) * span
        levels.append(0 if right - left > needed or levels[-1] else 1)
    return levels
