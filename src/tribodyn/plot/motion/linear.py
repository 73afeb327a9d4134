"""Natural modes, Campbell diagram and response to a harmonic error."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.theme.colors import INK, MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, translucent
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import Panel, curve, curves, event_lines, stack
from tribodyn.plot.theme.style import POWERS, Trace, bars, line, marked
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Campbell, ForcedResponse, NaturalModes

_COLORS = (PINION, WHEEL, *PAIR_COLORS, MUTED, TOTAL)
_HATCHES = ("", "/", "x", ".")
#: Springs with a smaller strain share in every mode are left out; the mesh does not excite a mode
#: with a smaller share of strain in it.
_LEAST = 1e-3
#: Colour of modes that no mesh excites, and distance of two numbers over the height of the axis.
_FAINT, _CLOSE = translucent(MUTED, 0.45), 0.02
NARROW = "\N{EN SPACE}"
#: Modes from which number and frequency are two lines.
_MANY = 8


def _bars(labels: list[str], shares: Trace) -> list[Trace]:
    visible = {name: part for name, part in shares.items() if np.max(part, initial=0.0) > _LEAST}
    return [
        bars(labels, 100.0 * np.asarray(share), name, _fill(number),
             f"%{{y:.1f}} % at %{{x}}<extra>{name}</extra>")
        for number, (name, share) in enumerate(visible.items())
    ]  # fmt: skip


def _fill(number: int) -> Trace:
    """Colour of bars; where there are more bars than colours, the next ones are hatched."""
    pattern = {"shape": _HATCHES[number // len(_COLORS) % len(_HATCHES)]}
    return {"color": _COLORS[number % len(_COLORS)], "pattern": pattern}


def _strained(modes: NaturalModes) -> Trace:
    """Strain share of each spring in the elastic modes; contacts of a mesh are added up."""
    share, springs = modes.strain_share[modes.rigid :], len(modes.elements) - modes.contacts
    strain = {name: share[:, column] for column, name in enumerate(modes.elements[:springs])}
    laws = np.unique(modes.linear.bundle)
    for number, law in enumerate(laws, 1):
        contacts = springs + np.flatnonzero(modes.linear.bundle == law)
        strain[f"mesh {number}" if laws.size > 1 else "mesh"] = share[:, contacts].sum(axis=1)
    return strain


@drawing(
    heading="Natural modes",
    of=("NaturalModes", "Result.natural_modes"),
    made_by="Call tribodyn.dynamics.natural_modes and its plot method.",
)
def mode_shapes(modes: NaturalModes) -> Sketch:
    """Draw the energy shares of all elastic modes.

    One bar per natural frequency. Top: kinetic energy of the bodies; bottom: strain energy of the
    springs. Transmission errors excite the modes with a high share of strain in the mesh.
    """
    first, unit = modes.rigid, display_unit("frequency")
    hertz = displayed("frequency", modes.frequency[first:])
    # Modes can have the same frequency: the mode number makes the labels unique.
    separator = ": " if len(hertz) < _MANY else "<br>"
    labels = [f"{first + k}{separator}{significant(v, 4)}" for k, v in enumerate(hertz)]
    moving = {body: share[first:] for body, share in modes.body_share().items()}
    strained = _strained(modes)
    share = modes.contact_share[first:]
    title = f"{len(labels)} natural frequencies"
    if share.size and modes.contacts:
        top = int(np.argmax(share))
        title = (
            f"The mesh has its largest share in mode {first + top}: {100 * share[top]:.0f} % of "
            f"the strain at {rounded('frequency', modes.frequency[first + top])}"
        )
    kinds = (("Kinetic", moving), ("Strain", strained))
    panels = [
        Panel(f"{kind} energy [%]", _bars(labels, shares), {"range": [0.0, 100.0]})
        for kind, shares in kinds
    ]
    names = {"type": "category", "tickangle": 0}
    layout = {"barmode": "stack", "xaxis": names, "hovermode": "closest"}
    return stack(title, f"Mode: natural frequency [{unit}]", panels, layout)


def _title(diagram: Campbell) -> str:
    if not diagram.resonances:
        return f"None of {len(diagram.orders)} mesh harmonics meets a natural frequency"
    worst = max(diagram.resonances, key=lambda met: met.contact_share / met.order)
    return (
        f"Harmonic {worst.order} meets {rounded('frequency', worst.frequency)}, "
        f"{100 * worst.contact_share:.0f} % mesh, at {rounded('speed', worst.speed)}"
    )


def natural_lines(
    speed: Any, frequency: Array, first: int, strained: Collection[int], top: float
) -> list[Trace]:
    """Natural frequencies [Hz] over speed: dark with a number where the excitation reaches them."""
    traces, unit = list[Trace](), display_unit("frequency")
    row, before = 0, -np.inf
    for column, values in enumerate(displayed("frequency", frequency).T):
        if values.min() > 1.05 * top:
            continue
        color, width = (INK, 1.6) if column in strained else (_FAINT, 1.0)
        trace = line(speed, values, f"mode {first + column}", color, unit=unit, width=width)
        if column in strained:
            # Numbers of close modes are printed next to each other.
            row = row + 1 if values[0] - before < _CLOSE * top else 0
            before = values[0]
            trace |= {"mode": "lines+text", "textposition": "top right", "textfont": {"size": 11}}
            trace["text"] = [f"{4 * row * NARROW}{first + column}"] + [""] * (len(speed) - 1)
        # One name: that modes coincide is no note.
        traces.append({**trace, "name": "natural mode", "showlegend": False})
    return traces


def crossing_dots(speed: object, hertz: object, share: Any, texts: Sequence[str]) -> Trace:
    """Dots where excitations meet modes, by the share of the mesh in the strain energy."""
    dots = marked(speed, hertz, "resonance", INK, 6)
    dots["marker"]["size"] = 5.0 + 9.0 * np.sqrt(share)
    hover = f"%{{customdata}}: %{{y:.5g}} {display_unit('frequency')} at %{{x:.5g}} "
    hover += f"{display_unit('speed')}<extra></extra>"
    return {**dots, "customdata": list(texts), "hovertemplate": hover}


def _rising(diagram: Campbell, speed: object, top: float) -> list[Trace]:
    """Lines of the mesh harmonics, labelled with their number at the upper end."""
    traces = []
    for order in diagram.orders:
        values = displayed("frequency", order * diagram.mesh_frequency)
        visible = np.flatnonzero(values <= 0.97 * top)
        texts = [""] * len(values)
        if visible.size:
            texts[visible[-1]] = str(order)
        name, unit = f"harmonic {order}", display_unit("frequency")
        style: Trace = {"width": 1.5, "mode": "lines+text", "textposition": "top left"}
        style["showlegend"] = False
        traces.append(line(speed, values, name, PINION, unit=unit, text=texts, **style))
    return traces


def _met(diagram: Campbell) -> list[Trace]:
    met = diagram.resonances
    if not met:
        return []
    speed = displayed("speed", np.array([each.speed for each in met]))
    hertz = displayed("frequency", np.array([each.frequency for each in met]))
    share = np.array([each.contact_share for each in met])
    texts = [f"harmonic {each.order}, mesh {100.0 * each.contact_share:.0f} %" for each in met]
    return [crossing_dots(speed, hertz, share, texts)]


@drawing(
    heading="Campbell diagram",
    of=("Campbell", "Result.campbell"),
    made_by="Call tribodyn.dynamics.campbell and its plot method.",
)
def campbell(diagram: Campbell) -> Sketch:
    """Draw natural frequencies and mesh harmonics over speed.

    Natural frequencies and the numbered mesh harmonics over the speed. Where a harmonic crosses a
    dark, numbered mode, the mesh can excite a resonance: the larger the dot, the higher the share
    of strain in the mesh. Light lines are modes that do not strain it. For a case the operating
    speed is marked, and the stiffness is taken at this speed and load.
    """
    speed = displayed("speed", diagram.speed)
    modes = float(np.max(displayed("frequency", diagram.frequency), initial=0.0))
    lines = float(np.max(displayed("frequency", max(diagram.orders) * diagram.mesh_frequency)))
    top = 1.1 * (min(modes, lines) or lines)
    share = np.mean(diagram.contact_share, axis=0)
    strained = set(np.flatnonzero(share > _LEAST).tolist())
    traces = natural_lines(speed, diagram.frequency, diagram.first_mode, strained, top)
    traces += [*_rising(diagram, speed, top), *_met(diagram)]
    now = diagram.operating_speed
    marks = [] if now is None else [("operation", float(displayed("speed", now)))]
    panel = Panel(axis_label("frequency"), traces, {"range": [0.0, top]}, height=1.8)
    layout = {"hovermode": "closest", **event_lines(marks)}
    return stack(_title(diagram), axis_label("speed"), [panel], layout)


@drawing(
    heading="Response to a harmonic error",
    of="ForcedResponse",
    made_by="Call tribodyn.dynamics.forced_response and its plot method.",
)
def forced_response(response: ForcedResponse) -> Sketch:
    """Draw amplitudes of mesh force, deflection and transmission error over frequency.

    Amplitudes over the frequency of the error. At low frequency the gears follow the error with
    little force; at high frequency the inertias stay at rest and the teeth deflect. In between lie
    the natural modes of the mesh.
    """
    x = displayed("frequency", response.frequency)
    force = np.abs(response.mesh_force)
    contact = response.contact[0]
    top = int(np.argmax(force))
    motions = (
        ("approach", "transmission_error", response.transmission_error, TOTAL, "solid"),
        ("compression", "deflection", response.deflection, PAIR_COLORS[0], "dash"),
    )
    amplitudes = [
        curve(quantity, x, np.abs(values[:, contact]), label, color, dash=dash)
        for label, quantity, values, color, dash in motions
    ]
    panels = [
        curves("mesh_force", "Mesh force", x, [("mesh force", force, TOTAL)], POWERS),
        Panel(axis_label("transmission_error", "Amplitude"), amplitudes, POWERS),
    ]
    title = (
        f"An error of {rounded('deflection', response.error)} causes up to "
        f"{rounded('mesh_force', force[top])} at "
        f"{rounded('frequency', response.frequency[top])}"
    )
    return stack(title, axis_label("frequency"), panels)
