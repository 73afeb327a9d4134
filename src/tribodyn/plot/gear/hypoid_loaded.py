"""A hypoid pair under load: pressure, friction and film on the flank, load sharing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.ehl.load_share import REGIME_LIMITS
from tribodyn.plot.theme.panels import Panel, Row, from_zero, stack, stack_rows
from tribodyn.plot.theme.style import HEAT, INK, MUTED, PAIR_COLORS, TOTAL, WHEEL, Trace, heat, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import HypoidFriction, HypoidLoadedContact

#: Points of a map along and across the flank.
_GRID = (90, 45)
#: Interpolated fraction of loaded cells above which a point belongs to the contact pattern.
_PATTERN = 0.5
_ALONG = "Along the pitch cone of the wheel, towards the heel [mm]"
_MADE_BY = "Call tribodyn.mesh.hypoid_loaded_contact."


def _outline(loaded: HypoidLoadedContact) -> Trace:
    """Ends of all contact lines in the order of contact: the common flank of both gears."""
    touch = loaded.cells.in_contact.T
    ends = [
        1e3 * np.concatenate([first, last[::-1], first[:1]])
        for first, last in (
            (cells[touch][:, 0], cells[touch][:, -1])
            for cells in (np.swapaxes(each, 0, 1) for each in (loaded.along, loaded.across))
        )
    ]
    quiet: Trace = {"showlegend": False, "hoverinfo": "skip", "hovertemplate": None}
    return line(ends[0], ends[1], "common flank", MUTED, dash="dash", **quiet)


def _flank(
    loaded: HypoidLoadedContact, values: Array, name: str, unit: str, bar: tuple[float, float]
) -> list[Trace]:
    """Map of values of the loaded cells; ``bar`` is centre and length of the colour bar."""
    from scipy.interpolate import griddata

    touch = loaded.cells.in_contact
    places = 1e3 * np.stack([loaded.along[touch].ravel(), loaded.across[touch].ravel()], axis=-1)
    carries = loaded.cell_force[touch].ravel() > 0.0
    pattern = places[carries]
    x, y = (
        np.linspace(low, high, count)
        for low, high, count in zip(pattern.min(0), pattern.max(0), _GRID, strict=True)
    )
    grid = tuple(np.meshgrid(x, y))
    field = griddata(pattern, values[touch].ravel()[carries], grid)
    if not carries.all():  # no interpolation across unloaded cells
        part = griddata(places, carries.astype(float), grid)
        field = np.where(part > _PATTERN, field, np.nan)
    scale = {"title": {"text": unit}, "thickness": 14, "y": bar[0], "len": bar[1]}
    hover = f"along %{{x:.3g}} mm, across %{{y:.3g}} mm: %{{z:.3g}} {unit}"
    more: Trace = {"name": name, "colorbar": scale, "hoverongaps": False}
    return [heat(x, y, field, HEAT, hover, **more), _outline(loaded)]


def _regimes(heat: Trace) -> Trace:
    """Lines between the lubrication regimes on a map of the film ratio."""
    low, high = REGIME_LIMITS
    levels = {"start": low, "end": high, "size": high - low, "coloring": "none", "showlabels": True}
    return {
        **{name: heat[name] for name in ("x", "y", "z")},
        "type": "contour",
        "contours": levels,
        "line": {"color": INK, "width": 1.5},
        "showscale": False,
        "showlegend": False,
        "hoverinfo": "skip",
        "name": "regimes",
    }


def _across() -> dict[str, Any]:
    return {"scaleanchor": "x", "constrain": "domain"}


@drawing(
    "hypoid_pressure",
    heading="Pressure on the flank",
    caption="Flank of the wheel: maximum Hertzian pressure of every cell while its pair passes "
    "through the mesh. Blank areas never carry load; the dashed line is the common flank.",
    of=("HypoidLoadedContact", "Result.hypoid_friction.loaded"),
    made_by=_MADE_BY,
)
def hypoid_pressure(loaded: HypoidLoadedContact) -> Any:
    """Draw the pressure over the flank: the contact pattern under load."""
    traces = _flank(loaded, 1e-9 * loaded.hertz_pressure, "pressure", "GPa", (0.5, 1.0))
    title = (
        f"Up to {loaded.maximum_pressure * 1e-9:.3g} GPa on the {loaded.cells.flanks.side} flank "
        f"under {loaded.pinion_torque:.4g} N·m"
    )
    panel = Panel("Across, towards the tip [mm]", traces, _across(), height=1.6)
    return stack_rows(title, [Row(_ALONG, panel)], {"hovermode": "closest"})


@drawing(
    "hypoid_load",
    heading="Load sharing and transmission error",
    caption="Over one mesh cycle: the share of the torque of each pair, the lag of the wheel "
    "with and without load, and the mesh stiffness on the line of action.",
    of=("HypoidLoadedContact", "Result.hypoid_friction.loaded"),
    made_by=_MADE_BY,
)
def hypoid_load(loaded: HypoidLoadedContact) -> Any:
    """Draw load shares, transmission error and stiffness over the mesh cycle."""
    phase, count = loaded.phase, loaded.load_share.shape[1]
    shares = [
        line(phase, 100.0 * loaded.load_share[:, i], f"pair {i + 1}", PAIR_COLORS[i % 4], unit="%")
        for i in range(count)
    ]
    free, lag = 1e6 * loaded.unloaded_transmission_error, 1e6 * loaded.loaded_transmission_error
    errors = [
        line(phase, free - free.mean(), "without load", MUTED, unit="µm", dash="dash"),
        line(phase, lag - lag.mean(), "under load", WHEEL, unit="µm"),
    ]
    stiffness = line(phase, 1e-6 * loaded.mesh_stiffness, "mesh", TOTAL, unit="N/µm")
    panels = [
        from_zero("Share of the torque [%]", shares),
        Panel("Lag about its mean [µm]", errors),
        from_zero("Stiffness [N/µm]", [stiffness]),
    ]
    title = (
        f"Transmission error of {np.ptp(lag):.3g} µm under {loaded.pinion_torque:.4g} N·m, "
        f"{np.ptp(free):.3g} µm without load"
    )
    return stack(title, "Mesh cycle", panels)


def _friction_caption(friction: HypoidFriction) -> str:
    flank = "Flank of the wheel: friction coefficient of every cell, and"
    blank = "Cells that never carry load are blank."
    if friction.composite_roughness == 0.0:
        return f"{flank} the film. {blank}"
    low, high = REGIME_LIMITS
    ratio = friction.film_ratio[friction.loaded.cell_force > 0.0]
    least, most = float(ratio.min()), float(ratio.max())
    limits = [f"{limit:g}" for limit in (low, high) if least < limit < most]
    if limits:
        regimes = (
            f"lines at {' and '.join(limits)} separate lubrication regimes (boundary below "
            f"{low:g}, full film from {high:g}, mixed in between)."
        )
    else:
        regime = "boundary" if most < low else "mixed" if most < high else "full film"
        regimes = f"its values of {least:.3g} to {most:.3g} are {regime} lubrication everywhere."
    return f"{flank} the film over the composite roughness; {regimes} {blank}"


@drawing(
    "hypoid_friction",
    heading="Friction and film on the flank",
    caption=_friction_caption,
    of=("HypoidFriction", "Result.hypoid_friction"),
    made_by="Call tribodyn.mesh.hypoid_friction.",
)
def hypoid_friction(friction: HypoidFriction) -> Any:
    """Draw friction coefficient and film ratio over the flank."""
    loaded, ratio = friction.loaded, np.minimum(friction.film_ratio, 1e3)
    maps = [
        ("friction coefficient", "", friction.friction_coefficient, (0.79, 0.42)),
        ("film ratio", "", ratio, (0.21, 0.42)),
    ]
    if friction.composite_roughness == 0.0:  # the film ratio of smooth flanks is infinite
        maps[1] = ("film", "µm", 1e6 * friction.minimum_film, maps[1][3])
    traces = [_flank(loaded, values, name, unit, bar) for name, unit, values, bar in maps]
    if friction.composite_roughness > 0.0:
        traces[1].append(_regimes(traces[1][0]))
    rows = [
        Row(_ALONG, Panel(f"Across [mm], {each[0]}", flank_traces, {}, height=1.4))
        for each, flank_traces in zip(maps, traces, strict=True)
    ]
    film = f"film ratio from {friction.minimum_film_ratio:.3g}"
    if friction.composite_roughness == 0.0:
        loads = loaded.cell_force > 0.0
        film = f"film from {1e6 * friction.minimum_film[loads].min():.3g} µm"
    title = (
        f"Mean friction coefficient {friction.mean_friction_coefficient:.3g} at "
        f"{friction.pinion_speed * 30.0 / np.pi:.4g} rpm, {film}"
    )
    return stack_rows(title, rows, {"hovermode": "closest"})
