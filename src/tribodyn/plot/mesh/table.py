"""Static mesh: stiffness, load sharing, transmission error and force law."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch
from tribodyn.plot.mesh.cycle import (
    CYCLES,
    between,
    closed,
    closed_life,
    cycles,
    mesh_events,
    pair_life,
    pair_lives,
    sharing_under_load,
    stiffness_jump,
    table_drawing,
)
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, TOTAL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import Panel, Row, curve, event_lines, from_zero, stack, stack_rows
from tribodyn.plot.theme.path import corner_shades, pair_letters, roll_angle_of, roll_label
from tribodyn.plot.theme.style import Trace, bars, dots, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable

_PAIR = "one tooth pair"
#: Margin of the axis before A and after E [mesh cycles].
_MARGIN = 0.12
#: Least step of the stiffness over its mean that counts as a jump.
_STEP = 0.01
#: Least fraction of the total force that counts as load on a tip corner.
_LOADED = 1e-6
_QUANTITY = "static_transmission_error"
#: Number of mesh harmonics.
_ORDERS = 8
_COLORS = (TOTAL, *PAIR_COLORS)
#: Points of a curve, and its range in multiples of the working deflection.
_POINTS, _BEYOND = 241, 1.3


def _stiffness_caption(mesh: MeshTable) -> str:
    mean, jump = mesh.mean_mesh_stiffness, stiffness_jump(mesh)
    swing = float(np.ptp(mesh.mesh_stiffness))

    def amount(value: float) -> str:
        return f"{rounded('mesh_stiffness', value)} ({100.0 * value / mean:.3g} % of its mean)"

    if jump > _STEP * mean:
        events = "at an event" if mesh.gears is None else "where a tooth pair enters or leaves"
        change = (
            f"The stiffness jumps by up to {amount(jump)} {events}. Jumps excite the vibration: "
            "the higher they are, the stronger the vibration."
        )
    elif swing > _STEP * mean:
        change = (
            f"The stiffness has no jump: pairs take over the load gradually. It varies by "
            f"{amount(swing)}, which excites the vibration."
        )
    else:
        change = f"The stiffness is constant over the mesh cycle to within {amount(swing)}."
    pairs = "The coloured curves are the single tooth pairs that add up to the total."
    if np.any(mesh.corner_share > _LOADED):
        pairs = (
            "The coloured curves are the single tooth pairs between A and E; tip corners that "
            "carry before A or after E count in the total."
        )
    return f"{change} {sharing_under_load(mesh, ends=True)} {pairs}"


@table_drawing(heading="Mesh stiffness", caption=_stiffness_caption)
def mesh_stiffness(mesh: MeshTable) -> Sketch:
    """Draw the stiffness of the tooth pairs and their sum."""
    total = cycles(mesh.phase, mesh.mesh_stiffness)
    traces = [curve("mesh_stiffness", *total, "all pairs", TOTAL)]
    for number, (at, pair) in enumerate(pair_lives(mesh, "stiffness")):
        name, color = f"tooth pair {number + 1}", PAIR_COLORS[number % len(PAIR_COLORS)]
        traces.append(curve("pair_stiffness", at, pair, name, color, dash="dash"))
    least, greatest = (rounded("mesh_stiffness", f(mesh.mesh_stiffness)) for f in (np.min, np.max))
    title = f"The mesh stiffness varies between {least} and {greatest}"
    panel = from_zero(axis_label("mesh_stiffness"), traces, height=1.3)
    layout = {**event_lines(mesh_events(mesh)), "xaxis": {"range": [0, CYCLES]}}
    return stack(title, axis_label("mesh_phase", "Mesh cycles"), [panel], layout)


def _pairs(mesh: MeshTable, ends: tuple[float, float]) -> list[tuple[str, Array, Array]]:
    """Stiffness of the pair between A and E and of its neighbours: (name, age, stiffness)."""
    age, stiffness = closed_life(mesh, "stiffness")
    curves = []
    for shift in range(-len(mesh.path[0]), len(mesh.path[0]) + 1):
        inside = (age + shift >= ends[0]) & (age + shift <= ends[1])
        if np.count_nonzero(inside) > 1:
            name = _PAIR if shift == 0 else "its neighbours"
            curves.append((name, age[inside] + shift, stiffness[inside]))
    return sorted(curves, key=lambda each: each[0] != _PAIR)


@table_drawing(heading="Stiffness over the roll angle")
def static_stiffness(mesh: MeshTable) -> Sketch:
    """Draw secant and tangent stiffness of the mesh and the parts of the tooth pairs.

    The secant stiffness is the load over the total deflection, the tangent stiffness applies to
    small vibration about the load. The curve of a tooth pair is its part of the secant stiffness.
    """
    pair, ends = mesh.gear_pair, (-_MARGIN, mesh.transverse_contact_ratio + _MARGIN)

    def over_angle(age: Array, values: Array, name: str, color: str, **style: object) -> Trace:
        x = displayed("roll_angle", roll_angle_of(pair, age))
        return curve("mesh_stiffness", x, values, name, color, **style)

    traces = [
        over_angle(*between(mesh.phase, values, ends), f"all pairs, {kind}", TOTAL, dash=dash)
        for kind, values, dash in (
            ("secant", mesh.mesh_stiffness, "solid"),
            ("tangent", mesh.mesh_stiffness_tangent, "dot"),
        )
    ]
    named: set[str] = set()
    for name, age, stiffness in _pairs(mesh, ends):
        style: Trace = {"dash": "dash", "showlegend": name not in named}
        color = PAIR_COLORS[0] if name == _PAIR else MUTED
        traces.append(over_angle(age, stiffness, name, color, **style))
        named.add(name)
    means = (mesh.mean_mesh_stiffness, mesh.mean_mesh_stiffness_tangent)
    secant, tangent = (rounded("mesh_stiffness", mean) for mean in means)
    x = displayed("roll_angle", roll_angle_of(pair, np.array(ends)))
    title = f"The mean stiffness is {secant} as a secant and {tangent} as a tangent"
    panel = from_zero(axis_label("mesh_stiffness"), traces, 1.5)
    layout = {**event_lines(pair_letters(pair)), "xaxis": {"range": x.tolist()}}
    return stack(title, roll_label(pair), [panel], layout)


def life_with_corners(mesh: MeshTable) -> tuple[Array, Array]:
    """Load share of a tooth pair over its age, with tip corners before A and after E."""
    age, share = pair_life(mesh, "load_share")
    ratio = mesh.transverse_contact_ratio
    before, after = mesh.corner_share.T
    coming = before > _LOADED
    exit_age = mesh.phase + np.ceil(ratio - mesh.phase - 1e-9)
    # The grid point at E has both sides of the event.
    order = np.argsort(exit_age, kind="stable")
    order = order[after[order] > _LOADED]
    return (
        np.concatenate((mesh.phase[coming] - 1.0, age, exit_age[order])),
        np.concatenate((before[coming], share, after[order])),
    )


def _caption(mesh: MeshTable) -> str:
    caption = "Share of the load of a tooth pair from its entry to its exit. "
    caption += sharing_under_load(mesh, ends=True)
    if np.any(mesh.corner_share > _LOADED):
        return f"{caption} Teeth bend under load: in the grey ranges a tip corner carries load."
    return caption


@table_drawing(heading="Load sharing", caption=_caption)
def load_sharing(mesh: MeshTable) -> Sketch:
    """Draw the load on one tooth pair over the roll angle of the driving gear."""
    pair = mesh.gear_pair
    age, share = closed(*life_with_corners(mesh))
    x = displayed("roll_angle", roll_angle_of(pair, age))
    newton = display_unit("normal_force")
    hover = f"%{{y:.4g}} (%{{customdata:.4g}} {newton})<extra>load share</extra>"
    force = displayed("normal_force", share * mesh.total_normal_force)
    trace = line(x, share, "load share", TOTAL, customdata=force, hovertemplate=hover)
    layout = event_lines(pair_letters(pair))
    for kind, shades in corner_shades(pair, float(age[0]), float(age[-1])).items():
        layout[kind] = [*shades, *layout[kind]]
    most = float(np.max(share)) * mesh.total_normal_force
    title = (
        f"A tooth pair carries up to {rounded('normal_force', most)}, "
        f"{100.0 * float(np.max(share)):.3g} % of the load"
    )
    panel = Panel("Load share of a pair", [trace], {"range": [0.0, 1.05]}, 1.3)
    return stack(title, roll_label(pair), [panel], layout)


def _transmission_error_row(mesh: MeshTable, error: Array, mean: float) -> Row:
    """Row with the transmission error over the mesh cycles and its mean."""
    ends, style = np.array([0.0, CYCLES]), Trace(dash="dash", width=1.2)
    curves = [
        curve(_QUANTITY, *cycles(mesh.phase, error), "under load", TOTAL),
        curve(_QUANTITY, ends, [mean] * 2, "mean", MUTED, **style),
    ]
    panel = Panel(axis_label(_QUANTITY, "Transmission error"), curves)
    label = axis_label("mesh_phase", "Mesh cycles")
    return Row(label, panel, {"range": [0, CYCLES]}, mesh_events(mesh))


def _bars(mesh: MeshTable, error: Array) -> Row:
    """Row with the amplitudes of the mesh harmonics."""
    heights = displayed(_QUANTITY, mesh.grid._harmonics(error, _ORDERS))
    hover = f"%{{y:.4g}} {display_unit(_QUANTITY)}<extra>harmonic %{{x}}</extra>"
    amplitudes = bars(np.arange(1, _ORDERS + 1), heights, "amplitude", TOTAL, hover, width=0.35)
    panel = from_zero(axis_label(_QUANTITY, "Amplitude"), [amplitudes], 0.7)
    axis = {"dtick": 1, "range": [0.4, _ORDERS + 0.6], "showgrid": False}
    return Row("Mesh harmonic", panel, axis)


def _error_caption(contact: Any) -> str:
    mesh: MeshTable = getattr(contact, "mesh", contact)
    caption = (
        "Lag of the driven gear on the line of action when the gears turn very slowly under load, "
        "relative to perfect rigid flanks: deflection plus the transmission error without load. "
        "Its variation excites vibration; the bars show the amplitudes at the harmonics of the "
        "mesh frequency."
    )
    teeth = mesh.tooth_transmission_error
    if teeth is None:
        return caption
    mean, total = (float(mesh.grid.mean(e)) for e in (teeth, mesh.transmission_error_at_rest))
    return (
        f"{caption} The mean approach of the teeth alone is {rounded(_QUANTITY, mean)}; the oil "
        f"film in series changes it by {rounded(_QUANTITY, total - mean)}."
    )


@table_drawing(
    heading="Static transmission error", caption=_error_caption, of=("MeshTable", "Result")
)
def static_transmission_error(contact: Any) -> Sketch:
    """Draw the static transmission error over two mesh cycles, and its mesh harmonics."""
    mesh: MeshTable = getattr(contact, "mesh", contact)
    error: Array = (
        mesh.transmission_error_at_rest
        if mesh is contact
        else contact.transmission_error_at_rest()  # with the error that the case prescribes
    )
    mean, swing = float(mesh.grid.mean(error)), float(np.ptp(error))
    return stack_rows(
        f"The static transmission error has a mean of {rounded(_QUANTITY, mean)} and varies by "
        f"{rounded(_QUANTITY, swing)}",
        [_transmission_error_row(mesh, error, mean), _bars(mesh, error)],
    )


def _phases(mesh: MeshTable) -> list[tuple[str, float]]:
    """Labelled phases between the events and just before them, with the number of pairs."""
    events = sorted({0.0, mesh.transverse_contact_ratio % 1.0, 1.0})
    phases = []
    for start, stop in pairwise(events):
        if stop - start > 1e-6:
            middle = 0.5 * (start + stop)
            pairs = int(np.count_nonzero(mesh.at("in_contact", middle)))
            label = "1 pair" if pairs == 1 else f"{pairs} pairs"
            # A tip corner may carry load shortly before the event.
            for phase in (middle, stop - 0.05 * (stop - start)):
                phases.append((f"phase {significant(phase, 2)}: {label}", phase))
    return phases


def _law_caption(mesh: MeshTable) -> str:
    shape = "The curves stiffen where flanks flatten and where a further pair makes contact."
    if mesh.ramp_deflection.shape[1] == 1:
        shape = "Straight lines: the stiffness does not depend on the load."
    return (
        f"Force over the approach of the gears at several mesh phases. {shape} The markers are "
        "the working load. The flanks are separated to the left of the foot of a curve."
    )


@table_drawing(heading="Force law of the mesh", caption=_law_caption)
def force_law(mesh: MeshTable) -> Sketch:
    """Draw the force on the mesh over its deflection for several mesh phases."""
    law, load = mesh.force_law, mesh.total_normal_force
    chosen = _phases(mesh)
    working = np.array([float(law.deflection(phase, load)) for _, phase in chosen])
    touch = np.array([float(law.first_touch(phase)) for _, phase in chosen])
    first, last = float(touch.min()), float(working.max())
    reach = last - first
    deflection = np.linspace(first - 0.08 * reach, first + _BEYOND * reach, _POINTS)
    newton, x = display_unit("normal_force"), displayed("deflection", deflection)
    colors = [_COLORS[number % len(_COLORS)] for number in range(len(chosen))]
    traces = [
        curve("normal_force", x, law.force(phase, deflection), label, color,
              dash="solid" if number % 2 == 0 else "dash")
        for number, ((label, phase), color) in enumerate(zip(chosen, colors, strict=True))
    ]  # fmt: skip
    level: Trace = {"dash": "dot", "width": 1}
    traces.append(curve("normal_force", x[[0, -1]], [load] * 2, "working load", MUTED, **level))
    hover = f"%{{y:.4g}} {newton} at %{{x:.4g}} {display_unit('deflection')}"
    at = displayed("deflection", working), np.full(working.size, displayed("normal_force", load))
    more: Trace = {"showlegend": False, "hovertemplate": f"{hover}<extra>working load</extra>"}
    marks = dots(*at, "deflection under it", {"color": colors, "size": 9}, **more)
    low, high = (rounded("deflection", at(working)) for at in (np.min, np.max))
    title = f"The working load of {rounded('normal_force', load)} deflects the mesh by"
    panel = from_zero(axis_label("normal_force"), [*traces, marks], 1.6)
    label = axis_label("deflection", "Approach along the line of action")
    return stack(f"{title} {low} to {high}", label, [panel], {"hovermode": "closest"})
