"""A running hypoid pair: kinematics, displaced gears, load, pressure, friction and film."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.ehl.mixed_contact import REGIME_LIMITS
from tribodyn.plot.gear.hypoid import flank_rows, outline, pattern
from tribodyn.plot.theme.colors import (
    FILLS,
    HEAT,
    INK,
    MUTED,
    PAIR_COLORS,
    PINION,
    TOTAL,
    WHEEL,
    translucent,
)
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.theme.panels import Panel, Row, from_zero, stack, stack_rows
from tribodyn.plot.theme.style import Trace, between, heat, line, marked, over_map
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.gear import HypoidKinematics, Misalignment, MisalignmentStudy
    from tribodyn.mesh import HypoidFriction, HypoidLoadedContact


def _over_line(place: Array, values: Array, name: str, color: str, unit: str) -> list[Trace]:
    """Mean over each contact line with a band from minimum to maximum."""
    least, mean, most = (f(values, axis=1) for f in (np.nanmin, np.nanmean, np.nanmax))
    fill = FILLS.get(color, translucent(color, 0.12))
    band = between(place, least, most, name, fill, showlegend=False)
    return [*band, line(place, mean, name, color, unit=unit)]


@drawing(
    heading="Kinematics of the flanks",
    of="HypoidKinematics",
    made_by="Call tribodyn.gear.hypoid_kinematics(contact, pinion_speed) and its plot method.",
)
def hypoid_kinematics(motion: HypoidKinematics) -> Sketch:
    """Draw speeds, slide-to-roll ratio and radius of the gap over the rotation of the wheel.

    Mean over the contact line with a band from minimum to maximum, over the rotation of the wheel.
    The flanks of a hypoid pair also slide along the tooth, so that the sliding speed never reaches
    zero.
    """
    place = np.degrees(motion.rotation)
    speed = display_unit("sliding_speed")
    rolling = [
        *_over_line(place, motion.pinion_rolling_speed, "pinion rolls", PINION, speed),
        *_over_line(place, motion.wheel_rolling_speed, "wheel rolls", WHEEL, speed),
    ]
    sliding = [
        *_over_line(place, motion.sliding_speed, "sliding", TOTAL, speed),
        *_over_line(place, motion.entrainment_speed, "entrainment", "#009E73", speed),
    ]
    ratio = _over_line(place, motion.slide_to_roll_ratio, "slide to roll", TOTAL, "")
    gap = _over_line(place, 1e3 * motion.equivalent_radius, "radius", TOTAL, "mm")
    panels = [
        Panel(axis_label("sliding_speed", "Speed"), sliding),
        Panel(axis_label("sliding_speed", "Rolling speed"), rolling),
        Panel("Slide to roll ratio", ratio),
        Panel("Radius of the gap [mm]", gap),
    ]
    low, high = (float(f(motion.sliding_speed)) for f in (np.nanmin, np.nanmax))
    title = (
        f"The flanks slide at {significant(low)} to {significant(high)} {speed} with the pinion at "
        f"{significant(displayed('speed', motion.pinion_speed), 4)} rpm"
    )
    return stack(title, "Rotation of the wheel [°]", panels)


_COLORS = (PINION, WHEEL, *PAIR_COLORS, INK)
#: Letter of each displacement, unit and factor from SI.
_LETTERS = {
    "offset": ("V", "µm", 1e6),
    "pinion_axial": ("H", "µm", 1e6),
    "wheel_axial": ("J", "µm", 1e6),
    "shaft_angle": ("α", "arcmin", 60.0 * math.degrees(1.0)),
}


def _label(misalignment: Misalignment) -> str:
    parts = [
        f"{letter} {getattr(misalignment, name) * factor:+.3g} {unit}"
        for name, (letter, unit, factor) in _LETTERS.items()
        if getattr(misalignment, name)
    ]
    return ", ".join(parts) or "nominal"


@drawing(
    heading="Contact with displaced gears",
    of="MisalignmentStudy",
    made_by="Call tribodyn.gear.misalignment_study.",
)
def hypoid_misalignment(study: MisalignmentStudy) -> Sketch:
    """Draw patterns on the flank and the transmission error of each case.

    Flank of the wheel with the marked pattern and the mean place of the contact for each
    displacement: V of the offset, H of the pinion and J of the wheel along their axes, α of the
    shaft angle. Below, the transmission error of the running pair without load.
    """
    flank: list[Trace] = [outline(study.contacts[0])]
    errors: list[Trace] = []
    for number, contact in enumerate(study.contacts):
        color, label = _COLORS[number % len(_COLORS)], _label(contact.misalignment)
        flank.append(pattern(contact, label, color))
        x, y = 1e3 * study.along[number], 1e3 * study.across[number]
        more: Trace = {"unit": "mm", "showlegend": False}
        flank.append(marked([x], [y], label, color, 9, "cross", **more))
        turn, error = np.degrees(contact.rotation), 1e6 * contact.angular_transmission_error
        leads = contact.leads
        more["unit"], ahead = "µrad", error[leads] - error[leads].max()
        errors.append(line(turn[leads], ahead, label, color, **more))
    rows = flank_rows(flank, Panel("Wheel ahead [µrad]", errors))
    ends = f"{1e6 * study.peak_to_peak.min():.3g}", f"{1e6 * study.peak_to_peak.max():.3g}"
    side = study.contacts[0].flanks.side
    title = f"Transmission error of {' to '.join(dict.fromkeys(ends))} µrad on the {side} flank"
    return stack_rows(title, rows, {"hovermode": "closest"})


#: Points of a map along and across the flank.
_GRID = (90, 45)
#: Interpolated fraction of loaded cells above which a point belongs to the contact pattern.
_PATTERN = 0.5
_ALONG = "Along the pitch cone of the wheel, towards the heel [mm]"
_MADE_BY = "Call tribodyn.mesh.hypoid_loaded_contact."


def _outline(loaded: HypoidLoadedContact) -> Trace:
    """Ends of all contact lines in the order of contact: the common flank of both gears."""
    touch = loaded.cells.in_contact.T
    ends = []
    for cells in (loaded.along, loaded.across):
        first, last = np.swapaxes(cells, 0, 1)[touch][:, [0, -1]].swapaxes(0, 1)
        ends.append(1e3 * np.concatenate([first, last[::-1], first[:1]]))
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
    return over_map(heat, levels, 1.5, "regimes")


@drawing(
    heading="Pressure on the flank",
    of=("HypoidLoadedContact", "Result.hypoid_friction.loaded"),
    made_by=_MADE_BY,
)
def hypoid_pressure(loaded: HypoidLoadedContact) -> Sketch:
    """Draw the pressure over the flank: the contact pattern under load.

    Flank of the wheel: maximum Hertzian pressure of every cell while its pair passes through the
    mesh. Blank areas never carry load; the dashed line is the common flank.
    """
    traces = _flank(loaded, 1e-9 * loaded.hertz_pressure, "pressure", "GPa", (0.5, 1.0))
    title = (
        f"Up to {loaded.maximum_pressure * 1e-9:.3g} GPa on the {loaded.cells.flanks.side} flank "
        f"under {loaded.pinion_torque:.4g} N·m"
    )
    to_scale = {"scaleanchor": "x", "constrain": "domain"}
    panel = Panel("Across, towards the tip [mm]", traces, to_scale, height=1.6)
    return stack_rows(title, [Row(_ALONG, panel)], {"hovermode": "closest"})


@drawing(
    heading="Load sharing and transmission error",
    of=("HypoidLoadedContact", "Result.hypoid_friction.loaded"),
    made_by=_MADE_BY,
)
def hypoid_load(loaded: HypoidLoadedContact) -> Sketch:
    """Draw load shares, transmission error and stiffness over the mesh cycle.

    Over one mesh cycle: the share of the torque of each pair, the lag of the wheel with and without
    load, and the mesh stiffness on the line of action.
    """
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
    regime = "boundary" if most < low else "mixed" if most < high else "full film"
    regimes = f"its values of {least:.3g} to {most:.3g} are {regime} lubrication everywhere."
    if limits:
        regimes = (
            f"lines at {' and '.join(limits)} separate lubrication regimes (boundary below "
            f"{low:g}, full film from {high:g}, mixed in between)."
        )
    return f"{flank} the film over the composite roughness; {regimes} {blank}"


@drawing(
    heading="Friction and film on the flank",
    caption=_friction_caption,
    of=("HypoidFriction", "Result.hypoid_friction"),
    made_by="Call tribodyn.mesh.hypoid_friction.",
)
def hypoid_friction(friction: HypoidFriction) -> Sketch:
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
