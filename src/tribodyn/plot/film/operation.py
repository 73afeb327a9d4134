"""Least film over the speed, a curve for each torque; lubrication regime over both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Need, drawing
from tribodyn.ehl.load_share import REGIME_LIMITS, REGIMES
from tribodyn.plot.film.lubrication import FILLS, LIMITS_IN_WORDS, has_ratio
from tribodyn.plot.look.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.look.panels import Panel, stack
from tribodyn.plot.look.style import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, Trace, figure, line

if TYPE_CHECKING:
    from tribodyn.mesh import FilmOverOperation

_COLORS = (PINION, WHEEL, *PAIR_COLORS, TOTAL)
_DASHES = ("solid", "dash", "dot")

_has_film = Need("central_film minimum_film", "The film model gives no film thickness.")


@drawing(
    "film_over_operation",
    heading="Oil film over speed and torque",
    caption="The least film that a tooth pair meets on its way, over the speed for each torque. "
    "Below, its ratio to the composite roughness: below one asperities touch.",
    missing=_has_film,
    of="FilmOverOperation",
    made_by="Call tribodyn.film_over_operation(case, torque=..., speed=...) and its plot method.",
)
def film_over_operation(found: FilmOverOperation) -> Any:
    """Draw the least film over the speed, a curve for each torque."""
    known = found.minimum_film if found.minimum_film is not None else found.central_film
    film = np.nanmin(np.asarray(known), axis=2)
    row, column = np.unravel_index(int(np.argmin(film)), film.shape)
    title = (
        f"The oil film is thinnest with {rounded('film_thickness', float(film.min()))} at "
        f"{rounded('torque', float(found.pinion_torque[row]))} and "
        f"{rounded('pinion_speed', float(found.pinion_speed[column]))} of the pinion"
    )
    panels = [
        Panel(
            axis_label("film_thickness"),
            _curves(found, film, "film_thickness"),
            {"rangemode": "tozero"},
            height=1.4,
        )
    ]
    if found.film_ratio is not None:
        ratio = np.nanmin(found.film_ratio, axis=2)
        curves = _curves(found, ratio, "film_ratio")
        panels.append(Panel(axis_label("film_ratio"), curves, {"rangemode": "tozero"}))
    return stack(title, axis_label("pinion_speed"), panels)


def _curves(found: FilmOverOperation, values: Any, quantity: str) -> list[Trace]:
    speed, unit = displayed("pinion_speed", found.pinion_speed), display_unit(quantity)
    drawn = []
    for number, torque in enumerate(found.pinion_torque):
        color, dash = _COLORS[number % len(_COLORS)], _DASHES[number // len(_COLORS) % 3]
        name = rounded("torque", float(torque))
        curve = line(speed, displayed(quantity, values[number]), name, color, unit=unit, dash=dash)
        drawn.append({**curve, "mode": "lines+markers"})
    return drawn


def _no_map(found: FilmOverOperation) -> str:
    several = min(found.pinion_torque.size, found.pinion_speed.size) > 1
    return has_ratio(found) or ("" if several else "A map needs several torques and speeds.")


@drawing(
    "lubrication_map",
    heading="Lubrication regime over speed and torque",
    caption="The least film ratio that a tooth pair meets on its way, over speed and torque of the "
    f"pinion. {LIMITS_IN_WORDS}",
    of="FilmOverOperation",
    made_by="Call tribodyn.film_over_operation(case, torque=..., speed=...) with several of both.",
    missing=_no_map,
)
def lubrication_map(found: FilmOverOperation) -> Any:
    """Draw the lubrication regime over speed and torque."""
    ratio = np.nanmin(np.asarray(found.film_ratio), axis=2)
    turn, pull = display_unit("pinion_speed"), display_unit("torque")
    low, high = REGIME_LIMITS
    common = {
        "type": "contour",
        "x": displayed("pinion_speed", found.pinion_speed),
        "y": displayed("torque", found.pinion_torque),
        "z": ratio,
        "showscale": False,
        "hovertemplate": f"%{{x:.4g}} {turn}, %{{y:.4g}} {pull}: film ratio %{{z:.3g}}"
        "<extra></extra>",
    }
    # What a constraint excludes is filled.
    regimes: list[tuple[str, Any, str]] = [
        (">", low, f"below {low:g}"),
        ("][", [low, high], f"{low:g} to {high:g}"),
        ("<", high, f"from {high:g} on"),
    ]
    filled = [
        {
            **common,
            "contours": {"type": "constraint", "operation": sign, "value": limit},
            "fillcolor": fill,
            "line": {"width": 1.5, "color": TOTAL},
            "name": f"{name}, {words}",
            "showlegend": True,
        }
        for name, fill, (sign, limit, words) in zip(REGIMES, FILLS, regimes, strict=True)
    ]
    levels = {
        **common,
        "contours": {"coloring": "none", "showlabels": True, "labelfont": {"size": 11}},
        "ncontours": 12,
        "line": {"width": 0.8, "color": MUTED},
        "showlegend": False,
    }
    least, most = significant(float(ratio.min())), significant(float(ratio.max()))
    return figure(
        f"The least film ratio is {least} to {most} over these speeds and torques",
        [*filled, levels],
        {
            "xaxis": {"title": {"text": axis_label("pinion_speed")}},
            "yaxis": {"title": {"text": axis_label("torque", "Torque of the pinion")}},
            "hovermode": "closest",
            "height": 460,
        },
    )
