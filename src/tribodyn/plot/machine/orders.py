"""Order spectra of a machine, each line in the colour of the mesh that excites it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.machine.side_view import joined_names
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.theme.panels import ROUNDING, from_zero, stack
from tribodyn.plot.theme.style import INK, PAIR_COLORS, PINION, WHEEL, Trace, marked, stems
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study.machine.motion import MachineMotion

#: Colours of the meshes; lines of several meshes at once are black.
COLORS = (PINION, WHEEL, *PAIR_COLORS)
_HARMONICS = 10


def _lines(motion: MachineMotion, quantity: str, amplitudes: Array) -> list[Trace]:
    """Lines at the orders of the meshes: one trace for each mesh, and one for common orders."""
    orders = motion.mesh_orders(_HARMONICS)
    groups: dict[str, list[int]] = {name: [] for name in motion.mesh}
    groups["several meshes"] = []
    labels = {}
    for place, meshes in enumerate(orders.values()):
        group = meshes[0][0] if len(meshes) == 1 else "several meshes"
        groups[group].append(place)
        labels[place] = ", ".join(f"{name} harmonic {number}" for name, number in meshes)
    exact = [motion.line_frequency(meshes) for meshes in orders.values()]
    hertz = displayed("frequency", np.array(exact))
    values, unit = displayed(quantity, amplitudes), display_unit(quantity)
    traces = []
    for number, (name, places) in enumerate(groups.items()):
        if not places:
            continue
        color = INK if name == "several meshes" else COLORS[number % len(COLORS)]
        x, y = hertz[places], values[places]
        upright = {"type": "scatter", "mode": "lines", "hoverinfo": "skip", "showlegend": False}
        ends = dict(zip("xy", stems(x, y), strict=True))
        traces.append({**upright, **ends, "line": {"color": color, "width": 2}})
        facts = [labels[place] for place in places]
        top = marked(x, y, name, color, size=6, symbol="circle", customdata=facts)
        hover = f"%{{y:.4g}} {unit} at %{{x:.6g}} {display_unit('frequency')}, "
        traces.append({**top, "hovertemplate": f"{hover}%{{customdata}}<extra></extra>"})
    return traces


def _total(motion: MachineMotion, signal: Array) -> Array:
    """Amplitudes over all directions and parts at the orders of the meshes."""
    waves = np.abs(motion.harmonics(signal, np.array(list(motion.mesh_orders(_HARMONICS)))))
    return np.asarray(np.sqrt((waves**2).reshape(len(waves), -1).sum(axis=1)))


def _caption(motion: MachineMotion) -> str:
    kinds = [
        kind for kind, names in (("bearings", motion.bearing), ("housing", motion.node)) if names
    ]
    below = (
        f" Below, what reaches {' and '.join(kinds)}: the root of the sum of the squares over all "
        "of them and over all directions."
    )
    return (
        "Amplitudes at the mesh harmonics: the alternating forces of the meshes."
        + below * bool(kinds)
        + " The colour names the mesh whose harmonic lies at that frequency."
        * (len(motion.mesh) > 1)
    )


@drawing(
    "machine_orders",
    heading="Which mesh causes which line",
    caption=_caption,
    of=("MachineMotion", "MachineResult.motion"),
    made_by="Run a case with shafts: tribodyn.run.",
)
def machine_orders(motion: MachineMotion) -> Any:
    """Draw the lines of mesh forces, bearing forces and housing accelerations."""
    signals = [
        ("mesh_force", "Mesh forces", motion.mesh_force),
        ("bearing_force", "Bearing forces", motion.bearing_force[..., :3]),
        ("acceleration", "Housing", motion.acceleration),
    ]
    rows = [
        (q, label, _above_rounding(_total(motion, signal), signal))
        for q, label, signal in signals
        if signal.shape[1]
    ]
    panels = [
        from_zero(axis_label(quantity, label), _lines(motion, quantity, values))
        for quantity, label, values in rows
    ]
    quantity, label, values = rows[-1]
    orders = motion.mesh_orders(_HARMONICS)
    top = int(np.argmax(values))
    meshes = list(orders.values())[top]
    harmonics: dict[int, list[str]] = {}
    for name, number in meshes:
        harmonics.setdefault(number, []).append(name)
    cause = " and ".join(
        f"harmonic {number} of mesh {joined_names(names)}" for number, names in harmonics.items()
    )
    title = (
        f"{label}: the largest line, {rounded(quantity, float(values[top]))}, is {cause} at "
        f"{rounded('frequency', motion.line_frequency(meshes))}"
    )
    if not values[top]:
        title = f"{label}: no line at a mesh harmonic"
    return stack(title, axis_label("frequency"), panels, {"hovermode": "closest"})


def _above_rounding(amplitudes: Array, signal: Array) -> Array:
    """Amplitudes of a signal without those that are rounding of its size."""
    return np.where(amplitudes > ROUNDING * np.abs(signal).max(), amplitudes, 0.0)
