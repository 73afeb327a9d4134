"""Natural modes, where mesh harmonics meet them, and the response to a harmonic error."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.look.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.look.panels import Panel, event_lines, stack
from tribodyn.plot.look.style import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, Trace, line

if TYPE_CHECKING:
    from tribodyn.dynamics import Campbell, ForcedResponse, NaturalModes

_COLORS = (PINION, WHEEL, *PAIR_COLORS, MUTED, TOTAL)
_HATCHES = ("", "/", "x", ".")
#: Springs below this share in every mode are not drawn.
_LEAST = 1e-3
#: Widths of the curve of a mode without and with all of its strain in the mesh [px].
_THIN, _THICK = 1.0, 4.0


def _bars(labels: list[str], shares: dict[str, Any]) -> list[Trace]:
    seen = {name: share for name, share in shares.items() if np.max(share, initial=0.0) > _LEAST}
    return [
        {
            "type": "bar",
            "x": labels,
            "y": 100.0 * np.asarray(share),
            "name": name,
            "marker": {
                "color": _COLORS[number % len(_COLORS)],
                # more bars than colours: the next ones are hatched
                "pattern": {"shape": _HATCHES[number // len(_COLORS) % len(_HATCHES)]},
            },
            "hovertemplate": f"%{{y:.1f}} % at %{{x}}<extra>{name}</extra>",
        }
        for number, (name, share) in enumerate(seen.items())
    ]


def _strained(modes: NaturalModes) -> dict[str, Any]:
    """Strain of each spring in the elastic modes; contacts of one force law are one mesh."""
    share, springs = modes.strain_share[modes.rigid :], len(modes.elements) - modes.contacts
    found = {name: share[:, column] for column, name in enumerate(modes.elements[:springs])}
    laws = np.unique(modes.linear.bundle)
    for number, law in enumerate(laws, 1):
        members = springs + np.flatnonzero(modes.linear.bundle == law)
        found[f"mesh {number}" if laws.size > 1 else "mesh"] = share[:, members].sum(axis=1)
    return found


@drawing(
    "mode_shapes",
    heading="Natural modes",
    caption="One bar for each natural frequency. Above, which body moves; below, which spring "
    "is strained. A mode with much of its strain in the mesh answers to transmission errors.",
    of=("NaturalModes", "Result.natural_modes"),
    made_by="Call tribodyn.dynamics.natural_modes and its plot method.",
)
def mode_shapes(modes: NaturalModes) -> Any:
    """Draw the energy shares of all elastic modes."""
    first, unit = modes.rigid, display_unit("frequency")
    hertz = displayed("frequency", modes.frequency[first:])
    # Two modes can have one frequency: the number keeps their bars apart.
    labels = [f"{first + k}: {significant(float(value), 4)}" for k, value in enumerate(hertz)]
    moving = {body: share[first:] for body, share in modes.body_share().items()}
    strained = _strained(modes)
    share = modes.contact_share[first:]
    if share.size and modes.contacts:
        top = int(np.argmax(share))
        title = (
            f"The mesh has most in mode {first + top}: {100 * share[top]:.0f} % of the strain at "
            f"{rounded('frequency', float(modes.frequency[first + top]))}"
        )
    else:
        title = f"{len(labels)} natural frequencies"
    axis = {"range": [0.0, 100.0]}
    return stack(
        title,
        f"Mode: natural frequency [{unit}]",
        [
            Panel("Kinetic energy [%]", _bars(labels, moving), axis),
            Panel("Strain energy [%]", _bars(labels, strained), axis),
        ],
        {"barmode": "stack", "xaxis": {"type": "category"}, "hovermode": "closest"},
    )


def _title(diagram: Campbell) -> str:
    if not diagram.resonances:
        return f"None of {len(diagram.orders)} mesh harmonics meets a natural frequency"
    worst = max(diagram.resonances, key=lambda met: met.contact_share / met.order)
    return (
        f"Harmonic {worst.order} meets {rounded('frequency', worst.frequency)}, "
        f"{100 * worst.contact_share:.0f} % mesh, at {rounded('speed', worst.speed)}"
    )


def _modes(diagram: Campbell, speed: Any, top: float) -> list[Trace]:
    """Lines of the modes; those wholly above the picture have no place in its legend."""
    unit, traces = display_unit("frequency"), []
    for column in range(diagram.frequency.shape[1]):
        share = float(np.mean(diagram.contact_share[:, column]))
        name = f"mode {diagram.first_mode + column}"
        color = PAIR_COLORS[column % len(PAIR_COLORS)]
        values = displayed("frequency", diagram.frequency[:, column])
        width = _THIN + (_THICK - _THIN) * share
        trace = line(speed, values, name, color, unit=unit, width=width)
        traces.append({**trace, "showlegend": bool(np.min(values) <= top)})
    return traces


def _rising(diagram: Campbell, speed: Any, top: float) -> list[Trace]:
    """Lines of the mesh harmonics, each with its number where it leaves the picture."""
    traces = []
    for order in diagram.orders:
        values = displayed("frequency", order * diagram.mesh_frequency)
        seen = np.flatnonzero(values <= 0.97 * top)
        words = [""] * len(values)
        if seen.size:
            words[seen[-1]] = str(order)
        name, unit = f"harmonic {order}", display_unit("frequency")
        rising = line(speed, values, name, MUTED, unit=unit, dash="dash", width=1.0)
        traces.append({**rising, "mode": "lines+text", "text": words, "textposition": "top left"})
    return traces


def _met(diagram: Campbell) -> list[Trace]:
    if not diagram.resonances:
        return []
    met = diagram.resonances
    facts = [[each.order, 100.0 * each.contact_share] for each in met]
    return [
        {
            "type": "scatter",
            "mode": "markers",
            "x": displayed("speed", np.array([each.speed for each in met])),
            "y": displayed("frequency", np.array([each.frequency for each in met])),
            "name": "resonance",
            "marker": {
                "color": WHEEL,
                "size": 6.0 + 10.0 * np.array([each.contact_share for each in met]),
            },
            "customdata": facts,
            "hovertemplate": "harmonic %{customdata[0]}, %{y:.5g} "
            f"{display_unit('frequency')}, mesh %{{customdata[1]:.0f}} %"
            "<extra>resonance</extra>",
        }
    ]


@drawing(
    "campbell",
    heading="Campbell diagram",
    caption="Natural frequencies across, mesh harmonics rising with speed. Where two lines cross "
    "the mesh can drive a resonance; the thicker the line of a mode and the larger the dot, the "
    "more of the strain sits in the mesh. Of a case the operating speed is marked, and the "
    "stiffness is that at this speed and load.",
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
    marks = [] if now is None else [("now", float(displayed("speed", now)))]
    return stack(
        _title(diagram),
        axis_label("speed"),
        [Panel(axis_label("frequency"), traces, axis, height=1.8)],
        {"hovermode": "closest", **event_lines(marks)},
    )


@drawing(
    "forced_response",
    heading="Response to a harmonic error",
    caption="Amplitudes over the frequency of the error. Slow errors turn the gears and press "
    "little; fast ones leave the inertias at rest and are taken up by the teeth; between "
    "them stand the natural modes of the mesh.",
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
    motions = [
        line(
            x,
            displayed(name, np.abs(values[:, contact])),
            words,
            color,
            unit=display_unit(name),
            dash=dash,
        )
        for name, values, words, color, dash in (
            ("transmission_error", response.transmission_error, "approach", TOTAL, "solid"),
            ("deflection", response.deflection, "compression", PAIR_COLORS[0], "dash"),
        )
    ]
    forces = [
        line(
            x, displayed("mesh_force", force), "mesh force", TOTAL, unit=display_unit("mesh_force")
        )
    ]
    error = rounded("deflection", float(response.error))
    return stack(
        f"An error of {error} makes {rounded('mesh_force', float(force[top]))} at "
        f"{rounded('frequency', float(response.frequency[top]))}",
        axis_label("frequency"),
        [
            Panel(axis_label("mesh_force", "Mesh force"), forces, logarithmic),
            Panel(axis_label("transmission_error", "Amplitude"), motions, logarithmic),
        ],
    )
