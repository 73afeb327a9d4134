"""Lubrication regimes: along the path of contact, and over torque and speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Need, drawing
from tribodyn.ehl.load_share import REGIME_LIMITS, REGIMES
from tribodyn.plot.film.path import Path
from tribodyn.plot.gear.path import sharing_words
from tribodyn.plot.look.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.look.panels import Panel, event_lines, stack
from tribodyn.plot.look.style import MUTED, PAIR_COLORS, TOTAL, WHEEL, figure, line
from tribodyn.plot.mesh.cycle import TABLE, roll_angle_label, roll_angle_positions
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import FilmOverOperation, MeshTable

_OIL, _METAL = PAIR_COLORS[2], WHEEL
#: Fills of the regimes, from boundary to full film.
_FILLS = ("#f9dfcc", "#fdf5e5", "#e1f1fb")
#: Film ratios that the axis shows at least.
_SHOWN = (0.1, 4.0)
_TICKS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100]
_has_ratio = Need(
    "film_ratio",
    "There is no film ratio: it needs an oil film and rough flanks. Choose film.model, for example "
    '"dowson-higginson", and give gears.pinion.roughness_ra and gears.wheel.roughness_ra.',
)
_LIMITS = (
    f"Below a film ratio of {REGIME_LIMITS[0]:g} asperities carry most of the load (boundary "
    f"lubrication), from {REGIME_LIMITS[1]:g} on hardly any of it (full film), in between both "
    "(mixed)."
)


def _caption(mesh: MeshTable) -> str:
    whose = (
        f'as the friction law "{mesh.friction_law}" has it'
        if mesh.asperity_friction_coefficient is not None
        else f'by the film ratio, because the friction law "{mesh.friction_law}" has none'
    )
    return (
        f"The least film of one tooth pair over the composite roughness. {_LIMITS} The load share "
        f"of the film is {whose}. {sharing_words(mesh.transverse_contact_ratio)}"
    )


@drawing(
    "lubrication",
    heading="Lubrication regime",
    caption=_caption,
    of=("MeshTable", "Result.mesh"),
    made_by=TABLE,
    missing=_has_ratio,
)
def lubrication(mesh: MeshTable) -> Any:
    """Draw film ratio, load share and the parts of the friction force over the roll angle.

    Parameters
    ----------
    mesh : MeshTable
        Contact of one mesh cycle with an oil film between rough flanks.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    path = Path(mesh)
    ratio, share = path.life("film_ratio"), path.life("film_load_share")
    low, high = min(_SHOWN[0], 0.8 * np.nanmin(ratio)), max(_SHOWN[1], 1.2 * np.nanmax(ratio))
    axis = {
        "type": "log",
        "range": [float(np.log10(low)), float(np.log10(high))],
        "tickvals": _TICKS,
    }
    shares = [
        line(path.angle, share, "oil film", _OIL),
        line(path.angle, 1.0 - share, "asperities", _METAL, dash="dash"),
    ]
    panels = [
        Panel(axis_label("film_ratio"), [line(path.angle, ratio, "film ratio", TOTAL)], axis),
        Panel("Part of the load", shares, {"range": [0.0, 1.02]}),
    ]
    if mesh.asperity_friction_coefficient is not None:
        panels.append(_friction(path))
    marks = event_lines(roll_angle_positions(mesh).items())
    marks["shapes"] = [*_bands(low, high), *marks["shapes"]]
    marks["annotations"] += _names(low, high)
    return stack(_title(mesh, share), roll_angle_label(mesh), panels, marks)


def _title(mesh: MeshTable, share: Array) -> str:
    """Regimes that the pair meets, and the least share of its film."""
    regime = np.asarray(mesh.lubrication_regime)
    met = [REGIMES[int(number)] for number in np.unique(regime[np.isfinite(regime)])]
    words = " and ".join(met)
    least = significant(100.0 * float(np.nanmin(share)))
    return f"{words[0].upper()}{words[1:]} lubrication: the oil film carries at least {least} %"


def _friction(path: Path) -> Panel:
    """Friction force of a pair, and the part of it that asperities cause."""
    unit = display_unit("friction_force")
    force = path.life("normal_force") * path.life("sliding_direction")
    whole, metal = (
        displayed("friction_force", path.life(name) * force)
        for name in ("friction_coefficient", "asperity_friction_coefficient")
    )
    curves = [
        line(path.angle, whole, "both", TOTAL, unit=unit),
        line(path.angle, whole - metal, "oil film", _OIL, unit=unit),
        line(path.angle, metal, "asperities", _METAL, unit=unit, dash="dash"),
    ]
    return Panel(axis_label("friction_force"), curves, {"zeroline": True})


def _edges(low: float, high: float) -> list[tuple[float, float]]:
    """Film ratios between which each regime is shown."""
    inner = np.clip(REGIME_LIMITS, low, high).tolist()
    return [(low, inner[0]), (inner[0], inner[1]), (inner[1], high)]


def _bands(low: float, high: float) -> list[dict[str, Any]]:
    """Fill the regimes behind the first panel."""
    place = {"type": "rect", "xref": "paper", "x0": 0, "x1": 1, "yref": "y", "layer": "below"}
    return [
        {**place, "y0": bottom, "y1": top, "fillcolor": fill, "line": {"width": 0}}
        for (bottom, top), fill in zip(_edges(low, high), _FILLS, strict=True)
    ]


def _names(low: float, high: float) -> list[dict[str, Any]]:
    """Name the regimes beside the first panel."""
    common = {"xref": "paper", "x": 1.01, "xanchor": "left", "yref": "y", "showarrow": False}
    return [
        {**common, "y": 0.5 * float(np.log10(bottom) + np.log10(top)), "text": name}
        | {"font": {"size": 12, "color": MUTED}}
        for (bottom, top), name in zip(_edges(low, high), REGIMES, strict=True)
    ]


@drawing(
    "lubrication_map",
    heading="Lubrication regime over speed and torque",
    caption="The least film ratio that a tooth pair meets on its way, over speed and torque of the "
    f"pinion. {_LIMITS}",
    of="FilmOverOperation",
    made_by="Call tribodyn.film_over_operation(case, torque=..., speed=...) with several of both.",
    missing=lambda found: (
        _has_ratio(found)
        or (
            ""
            if min(found.pinion_torque.size, found.pinion_speed.size) > 1
            else "A map needs several torques and several speeds."
        )
    ),
)
def lubrication_map(found: FilmOverOperation) -> Any:
    """Draw the lubrication regime over speed and torque.

    Parameters
    ----------
    found : FilmOverOperation
        What :func:`tribodyn.film_over_operation` returns, for several torques and speeds.

    Returns
    -------
    plotly.graph_objects.Figure
    """
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
        for name, fill, (sign, limit, words) in zip(REGIMES, _FILLS, regimes, strict=True)
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
