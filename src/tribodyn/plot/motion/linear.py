"""Natural modes, Campbell diagram and response to a harmonic error."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.theme.curves import curve, curves, points
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import Panel, event_lines, stack
from tribodyn.plot.theme.style import (
    MUTED,
    PAIR_COLORS,
    PINION,
    TOTAL,
    WHEEL,
    Trace,
    bars,
    line,
    translucent,
)

if TYPE_CHECKING:
    from tribodyn.dynamics import Campbell, ForcedResponse, NaturalModes

_COLORS = (PINION, WHEEL, *PAIR_COLORS, MUTED, TOTAL)
_HATCHES = ("", "/", "x", ".")
#: Springs with a smaller strain share in every mode are left out; the mesh does not excite a mode
#: with a smaller share of strain in it.
_LEAST = 1e-3
#: Widths of the curve of a mode without and with all of its strain in the mesh [px].
_THIN, _THICK = 1.0, 4.0


def _bars(labels: list[str], shares: dict[str, Any]) -> list[Trace]:
    visible = {name: part for name, part in shares.items() if np.max(part, initial=0.0) > _LEAST}
    return [
        bars(labels, 100.0 * np.asarray(share), name, _fill(number),
             f"%{{y:.1f}} % at %{{x}}<extra>{name}</extra>")
        for number, (name, share) in enumerate(visible.items())
    ]  # fmt: skip


def _fill(number: int) -> dict[str, Any]:
    """Colour of bars; where there are more bars than colours, the next ones are hatched."""
    pattern = {"shape": _HATCHES[number // len(_COLORS) % len(_HATCHES)]}
    return {"color": _COLORS[number % len(_COLORS)], "pattern": pattern}


def _strained(modes: NaturalModes) -> dict[str, Any]:
    """Strain share of each spring in the elastic modes; contacts of a mesh are added up."""
    share, springs = modes.strain_share[modes.rigid :], len(modes.elements) - modes.contacts
    strain = {name: share[:, column] for column, name in enumerate(modes.elements[:springs])}
    laws = np.unique(modes.linear.bundle)
    for number, law in enumerate(laws, 1):
        contacts = springs + np.flatnonzero(modes.linear.bundle == law)
        strain[f"mesh {number}" if laws.size > 1 else "mesh"] = share[:, contacts].sum(axis=1)
    return strain


@drawing(
    "mode_shapes",
    heading="Natural modes",
    caption="One bar per natural frequency. Top: kinetic energy of the bodies; bottom: strain "
    "energy of the springs. Transmission errors excite the modes with a high share of strain in "
    "the mesh.",
    of=("NaturalModes", "Result.natural_modes"),
    made_by="Call tribodyn.dynamics.natural_modes and its plot method.",
)
def mode_shapes(modes: NaturalModes) -> Any:
    """Draw the energy shares of all elastic modes."""
    first, unit = modes.rigid, display_unit("frequency")
    hertz = displayed("frequency", modes.frequency[first:])
    # Modes can have the same frequency: the mode number makes the labels unique.
    labels = [f"{first + k}: {significant(float(value), 4)}" for k, value in enumerate(hertz)]
    moving = {body: share[first:] for body, share in modes.body_share().items()}
    strained = _strained(modes)
    share = modes.contact_share[first:]
    if share.size and modes.contacts:
        top = int(np.argmax(share))
        title = (
            f"The mesh has its largest share in mode {first + top}: {100 * share[top]:.0f} % of "
            f"the strain at {rounded('frequency', float(modes.frequency[first + top]))}"
        )
    else:
        title = f"{len(labels)} natural frequencies"
    kinds = (("Kinetic", moving), ("Strain", strained))
    panels = [
        Panel(f"{kind} energy [%]", _bars(labels, shares), {"range": [0.0, 100.0]})
        for kind, shares in kinds
    ]
    layout = {"barmode": "stack", "xaxis": {"type": "category"}, "hovermode": "closest"}
    return stack(title, f"Mode: natural frequency [{unit}]", panels, layout)


def _title(diagram: Campbell) -> str:
    if not diagram.resonances:
        return f"None of {len(diagram.orders)} mesh harmonics meets a natural frequency"
    worst = max(diagram.resonances, key=lambda met: met.contact_share / met.order)
    return (
        f"Harmonic {worst.order} meets {rounded('frequency', worst.frequency)}, "
        f"{100 * worst.contact_share:.0f} % mesh, at {rounded('speed', worst.speed)}"
    )


def _modes(diagram: Campbell, speed: Any, top: float) -> list[Trace]:
    """Lines of the modes; those above the plotted range have no legend entry."""
    traces = []
    for column in range(diagram.frequency.shape[1]):
        share = float(np.mean(diagram.contact_share[:, column]))
        name = f"mode {diagram.first_mode + column}"
        color = PAIR_COLORS[column % len(PAIR_COLORS)]
        values = diagram.frequency[:, column]
        width = _THIN + (_THICK - _THIN) * share
        color = color if share > _LEAST else translucent(MUTED, 0.45)  # the mesh cannot excite it
        in_key = bool(np.min(displayed("frequency", values)) <= top and share > _LEAST)
        style: Trace = {"width": width, "showlegend": in_key}
        traces.append(curve("frequency", speed, values, name, color, **style))
    return traces


def _rising(diagram: Campbell, speed: Any, top: float) -> list[Trace]:
    """Lines of the mesh harmonics, labelled with their number at the upper end."""
    traces = []
    for order in diagram.orders:
        values = displayed("frequency", order * diagram.mesh_frequency)
        visible = np.flatnonzero(values <= 0.97 * top)
        texts = [""] * len(values)
        if visible.size:
            texts[visible[-1]] = str(order)
        name, unit = f"harmonic {order}", display_unit("frequency")
        style: Trace = {
            "dash": "dash",
            "width": 1.0,
            "mode": "lines+text",
            "textposition": "top left",
        }
        traces.append(line(speed, values, name, MUTED, unit=unit, text=texts, **style))
    return traces


def _met(diagram: Campbell) -> list[Trace]:
    if not diagram.resonances:
        return []
    met = diagram.resonances
    hover = f"harmonic %{{customdata[0]}}, %{{y:.5g}} {display_unit('frequency')}, mesh "
    dots = points(
        "frequency", displayed("speed", np.array([each.speed for each in met])),
        np.array([each.frequency for each in met]), "resonance", WHEEL, size=6.0, symbol="circle",
        customdata=[[each.order, 100.0 * each.contact_share] for each in met],
        hovertemplate=f"{hover}%{{customdata[1]:.0f}} %<extra>resonance</extra>",
    )  # fmt: skip
    size = 6.0 + 10.0 * np.array([each.contact_share for each in met])
    return [{**dots, "marker": {"color": WHEEL, "size": size}}]


@drawing(
    "campbell",
    heading="Campbell diagram",
    caption="Natural frequencies and mesh harmonics over the speed. Where two lines cross, the "
    "mesh can excite a resonance; the thicker the line of a mode and the larger the dot, the "
    "higher the share of strain in the mesh. Light lines are modes that do not strain it. For a "
    "case the operating speed is marked, and the stiffness is taken at this speed and load.",
    of=("Campbell", "Result.campbell"),
    made_by="Call tribodyn.dynamics.campbell and its plot method.",
)
def campbell(diagram: Campbell) -> Any:
    """Draw natural frequencies and mesh harmonics over speed."""
    speed = displayed("speed", diagram.speed)
    modes = float(np.max(displayed("frequency", diagram.frequency), initial=0.0))
    lines = float(np.max(displayed("frequency", max(diagram.orders) * diagram.mesh_frequency)))
    top = 1.1 * (min(modes, lines) or lines)
    axis = {"range": [0.0, top]}
    traces = [*_modes(diagram, speed, top), *_rising(diagram, speed, top), *_met(diagram)]
    now = diagram.operating_speed
    marks = [] if now is None else [("operation", float(displayed("speed", now)))]
    panel = Panel(axis_label("frequency"), traces, axis, height=1.8)
    layout = {"hovermode": "closest", **event_lines(marks)}
    return stack(_title(diagram), axis_label("speed"), [panel], layout)


@drawing(
    "forced_response",
    heading="Response to a harmonic error",
    caption="Amplitudes over the frequency of the error. At low frequency the gears follow the "
    "error with little force; at high frequency the inertias stay at rest and the teeth deflect. "
    "In between lie the natural modes of the mesh.",
    of="ForcedResponse",
    made_by="Call tribodyn.dynamics.forced_response and its plot method.",
)
def forced_response(response: ForcedResponse) -> Any:
    """Draw amplitudes of mesh force, deflection and transmission error over frequency."""
    x = displayed("frequency", response.frequency)
    force = np.abs(response.mesh_force)
    contact = response.contact[0]
    top = int(np.argmax(force))
    logarithmic = {"type": "log", "exponentformat": "power"}
    motions = (
        ("approach", "transmission_error", response.transmission_error, TOTAL, "solid"),
        ("compression", "deflection", response.deflection, PAIR_COLORS[0], "dash"),
    )
    amplitudes = [
        curve(quantity, x, np.abs(values[:, contact]), label, color, dash=dash)
        for label, quantity, values, color, dash in motions
    ]
    panels = [
        curves("mesh_force", "Mesh force", x, [("mesh force", force, TOTAL)], logarithmic),
        Panel(axis_label("transmission_error", "Amplitude"), amplitudes, logarithmic),
    ]
    title = (
        f"An error of {rounded('deflection', float(response.error))} causes up to "
        f"{rounded('mesh_force', float(force[top]))} at "
        f"{rounded('frequency', float(response.frequency[top]))}"
    )
    return stack(title, axis_label("frequency"), panels)
