"""Lubrication regime of a tooth pair, over speed and torque, and of rough line contacts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Need, Sketch, drawing
from tribodyn.ehl.mixed_contact import REGIME_LIMITS, REGIMES
from tribodyn.plot.film.path import Path, gaps_sentence
from tribodyn.plot.mesh.cycle import roll_angle_positions, sharing_under_load, table_drawing
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import FROM_ZERO, ZERO, Panel, curves, event_lines, stack
from tribodyn.plot.theme.path import roll_label
from tribodyn.plot.theme.style import Trace, axis, line, note, plane_figure
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.ehl import MixedLineContact
    from tribodyn.mesh import FilmOverOperation, MeshTable

_OIL, _METAL = PAIR_COLORS[2], WHEEL
#: Fills of the regimes, from boundary to full film.
FILLS = ("#f9dfcc", "#fdf5e5", "#e1f1fb")
#: Least range of the axis of the film ratio.
_RATIO_RANGE = (0.1, 4.0)
RATIO_TICKS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100]
has_ratio = Need(
    "film_ratio",
    "There is no film ratio: it needs an oil film and rough flanks. Choose film.model, for example "
    '"dowson-higginson", and give gears.pinion.roughness_ra and gears.wheel.roughness_ra.',
)
REGIME_SENTENCE = (
    f"Below a film ratio of {REGIME_LIMITS[0]:g} asperities carry most of the load (boundary "
    f"lubrication), from {REGIME_LIMITS[1]:g} on hardly any of it (full film), in between both "
    "(mixed)."
)


def _caption(mesh: MeshTable) -> str:
    law = f'the friction law "{mesh.friction_law}"'
    whose = f"estimated from the film ratio: {law} has none"
    if mesh.asperity_friction_coefficient is not None:
        whose = f"that of {law}"
    return (
        f"The minimum film of a tooth pair over the composite roughness. {REGIME_SENTENCE} The "
        f"load share of the film is {whose}. {sharing_under_load(mesh)}{gaps_sentence(mesh)}"
    )


def _missing(mesh: MeshTable) -> str:
    if mesh.film_ratio is None or mesh.film_load_share is not None:
        return has_ratio(mesh)
    return "This mesh table has no load share of the film (column film_load_share)."


@table_drawing(heading="Lubrication regime", caption=_caption, missing=_missing)
def lubrication(mesh: MeshTable) -> Sketch:
    """Draw film ratio, load share and the parts of the friction force over the roll angle."""
    path = Path(mesh)
    ratio, share = path.under_load("film_ratio"), path.under_load("film_load_share")
    low = min(_RATIO_RANGE[0], 0.8 * np.nanmin(ratio))
    high = max(_RATIO_RANGE[1], 1.2 * np.nanmax(ratio))
    ends = [float(np.log10(low)), float(np.log10(high))]
    ratios = {"type": "log", "range": ends, "tickvals": RATIO_TICKS}
    shares = [
        line(path.angle, share, "oil film", _OIL),
        line(path.angle, 1.0 - share, "asperities", _METAL, dash="dash"),
    ]
    panels = [
        Panel(axis_label("film_ratio"), [line(path.angle, ratio, "film ratio", TOTAL)], ratios),
        Panel("Share of the load", shares, {"range": [0.0, 1.02]}),
    ]
    if mesh.asperity_friction_coefficient is not None:
        panels.append(_friction(path))
    marks = event_lines(roll_angle_positions(mesh).items())
    marks["shapes"] = [*_bands(low, high), *marks["shapes"]]
    marks["annotations"] += _names(low, high)
    return stack(_title(mesh, share), roll_label(mesh.gear_pair), panels, marks)


def _title(mesh: MeshTable, share: Array) -> str:
    """Lubrication regimes of the pair, and the least load share of its film."""
    regime = np.asarray(mesh.lubrication_regime)
    regimes = [REGIMES[int(number)] for number in np.unique(regime[np.isfinite(regime)])]
    names = " and ".join(regimes)
    least = significant(100.0 * float(np.nanmin(share)))
    return f"{names[0].upper()}{names[1:]} lubrication: the oil film carries at least {least} %"


def _friction(path: Path) -> Panel:
    """Friction force of a pair with its film and asperity parts."""
    force = path.life("normal_force") * path.life("sliding_direction")
    total = path.under_load("friction_coefficient") * force
    asperities = path.under_load("asperity_friction_coefficient") * force
    rows = (
        ("total", total, TOTAL),
        ("oil film", total - asperities, _OIL),
        ("asperities", asperities, _METAL, "dash"),
    )
    return curves("friction_force", None, path.angle, rows, ZERO)


def _edges(low: float, high: float) -> list[tuple[float, float]]:
    """Lower and upper film ratio of each regime within the axis."""
    inner = np.clip(REGIME_LIMITS, low, high).tolist()
    return [(low, inner[0]), (inner[0], inner[1]), (inner[1], high)]


def _bands(low: float, high: float) -> list[Trace]:
    """Fill the regimes behind the first panel."""
    place = {"type": "rect", "xref": "paper", "x0": 0, "x1": 1, "yref": "y", "layer": "below"}
    return [
        {**place, "y0": bottom, "y1": top, "fillcolor": fill, "line": {"width": 0}}
        for (bottom, top), fill in zip(_edges(low, high), FILLS, strict=True)
    ]


def _names(low: float, high: float) -> list[Trace]:
    """Label the regimes at the right end of the first panel."""
    common = {"xref": "paper", "xanchor": "right", "yref": "y"}
    style = Trace(color=MUTED, bgcolor="rgba(255, 255, 255, 0.6)", **common)
    return [
        note(0.995, 0.5 * float(np.log10(bottom) + np.log10(top)), name, **style)
        for (bottom, top), name in zip(_edges(low, high), REGIMES, strict=True)
    ]


_COLORS = (PINION, WHEEL, *PAIR_COLORS, TOTAL)
_DASHES = ("solid", "dash", "dot")


def _where(films: FilmOverOperation) -> str:
    return "along the path of contact" if films.face_position is None else "over the flank"


_has_film = Need("central_film minimum_film", "The film model gives no film thickness.")


@drawing(
    heading="Oil film over speed and torque",
    caption=lambda films: (
        f"The {'least central' if films.minimum_film is None else 'minimum'} film {_where(films)}, "
        "over the speed for each torque."
        + " Below, its ratio to the composite roughness: asperities touch below a ratio of 1."
        * (films.film_ratio is not None)
    ),
    missing=_has_film,
    of="FilmOverOperation",
    made_by="Call tribodyn.film_over_operation(case, torque=..., speed=...) and its plot method.",
)
def film_over_operation(films: FilmOverOperation) -> Sketch:
    """Draw the minimum film over the speed, one curve per torque."""
    least_films = films.minimum_film if films.minimum_film is not None else films.central_film
    film = np.nanmin(np.asarray(least_films), axis=2)
    row, column = np.unravel_index(int(np.argmin(film)), film.shape)
    title = (
        f"The oil film is thinnest with {rounded('film_thickness', film.min())} at "
        f"{rounded('torque', films.pinion_torque[row])} and "
        f"{rounded('pinion_speed', films.pinion_speed[column])} of the pinion"
    )
    panels = [_over_speed(films, film, "film_thickness", 1.4)]
    if films.film_ratio is not None:
        panels.append(_over_speed(films, np.nanmin(films.film_ratio, axis=2), "film_ratio"))
    return stack(title, axis_label("pinion_speed"), panels)


def _over_speed(films: FilmOverOperation, values: Any, quantity: str, height: float = 1.0) -> Panel:
    rows = [
        (rounded("torque", torque), values[number], _COLORS[number % len(_COLORS)],
         _DASHES[number // len(_COLORS) % 3])
        for number, torque in enumerate(films.pinion_torque)
    ]  # fmt: skip
    speed = displayed("pinion_speed", films.pinion_speed)
    return curves(quantity, None, speed, rows, FROM_ZERO, height, mode="lines+markers")


def _no_map(films: FilmOverOperation) -> str:
    several = min(films.pinion_torque.size, films.pinion_speed.size) > 1
    return has_ratio(films) or ("" if several else "A map needs several torques and speeds.")


@drawing(
    heading="Lubrication regime over speed and torque",
    caption=lambda films: (
        f"The least film ratio {_where(films)}, over speed and torque of the "
        f"pinion. {REGIME_SENTENCE}"
    ),
    of="FilmOverOperation",
    made_by="Call tribodyn.film_over_operation(case, torque=..., speed=...) with several of both.",
    missing=_no_map,
)
def lubrication_map(films: FilmOverOperation) -> Sketch:
    """Draw the lubrication regime over speed and torque."""
    ratio = np.nanmin(np.asarray(films.film_ratio), axis=2)
    turn, pull = display_unit("pinion_speed"), display_unit("torque")
    low, high = REGIME_LIMITS
    common = {
        "type": "contour",
        "x": displayed("pinion_speed", films.pinion_speed),
        "y": displayed("torque", films.pinion_torque),
        "z": ratio,
        "showscale": False,
        "hovertemplate": f"%{{x:.4g}} {turn}, %{{y:.4g}} {pull}: film ratio %{{z:.3g}}"
        "<extra></extra>",
    }
    # Plotly fills the region that a constraint excludes.
    regimes: list[tuple[str, Any, str]] = [
        (">", low, f"below {low:g}"),
        ("][", [low, high], f"{low:g} to {high:g}"),
        ("<", high, f"from {high:g} on"),
    ]
    edge: Trace = {"line": {"width": 1.5, "color": TOTAL}, "showlegend": True}
    filled = [
        {**common, **edge, "fillcolor": fill, "name": f"{name}, {range_text}",
         "contours": {"type": "constraint", "operation": sign, "value": limit}}
        for name, fill, (sign, limit, range_text) in zip(REGIMES, FILLS, regimes, strict=True)
    ]  # fmt: skip
    labels = {"coloring": "none", "showlabels": True, "labelfont": {"size": 11}}
    levels = {**common, "contours": labels, "ncontours": 12, "showlegend": False}
    levels["line"] = {"width": 0.8, "color": MUTED}
    least, most = significant(ratio.min()), significant(ratio.max())
    title = f"The least film ratio is {least} to {most} over these speeds and torques"
    x, y = axis(axis_label("pinion_speed")), axis(axis_label("torque", "Torque of the pinion"))
    return plane_figure(title, [*filled, levels], x, y, height=460)


@drawing(
    heading="Film and asperities",
    caption=f"Contacts over their film ratio. {REGIME_SENTENCE} The gap is the mean distance "
    "of the rough flanks; where asperities carry load, it is wider than the film of smooth flanks "
    "under the same load, because the oil carries less load.",
    of="MixedLineContact",
    made_by="Call tribodyn.ehl.mixed_line_contact(...) and its plot method.",
)
def mixed_line_contact(contact: MixedLineContact) -> Sketch:
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
    low, high = (significant(f(share)) for f in (np.min, np.max))
    carried = f"{low} %" if low == high else f"{low} to {high} %"
    log = {"type": "log", "tickvals": RATIO_TICKS}
    layout = {"xaxis": log} if place[0] > 0.0 and place[-1] > 4.0 * place[0] else {}
    return stack(f"The oil film carries {carried} of the load", "Film ratio", panels, layout)
