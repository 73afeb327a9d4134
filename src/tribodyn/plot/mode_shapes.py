"""Where the energy of each mode sits: bodies in motion, springs under strain."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import display_unit, displayed, rounded, significant
from tribodyn.plot.style import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, Panel, stack

_COLORS = (PINION, WHEEL, *PAIR_COLORS, MUTED, TOTAL)
_HATCHES = ("", "/", "x", ".")
#: Springs below this share in every mode are not drawn.
_LEAST = 1e-3


def _missing(result: Any) -> str:
    if hasattr(result, "strain_share"):
        return ""
    return (
        "This figure shows natural modes. Call tribodyn.dynamics.natural_modes and its plot method."
    )


def _bars(labels: list[str], shares: dict[str, Any]) -> list[dict[str, Any]]:
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


@drawing(
    "mode_shapes",
    heading="Natural modes",
    caption="One bar for each natural frequency. Above, which body moves; below, which spring "
    "is strained. A mode with much of its strain in the mesh answers to transmission errors.",
    needs=_missing,
)
def mode_shapes(modes: Any) -> Any:
    """Draw the energy shares of all elastic modes.

    Parameters
    ----------
    modes : NaturalModes
        What :func:`tribodyn.dynamics.natural_modes` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    first, unit = modes.rigid, display_unit("frequency")
    hertz = displayed("frequency", modes.frequency[first:])
    # Two modes can have one frequency: the number keeps their bars apart.
    labels = [f"{first + k}: {significant(float(value), 4)}" for k, value in enumerate(hertz)]
    moving = {body: share[first:] for body, share in modes.body_share().items()}
    strained = {
        name: modes.strain_share[first:, column] for column, name in enumerate(modes.elements)
    }
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
