"""Kinematic frequencies of the parts of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tribodyn.drawing import drawing
from tribodyn.plot.machine.orders import COLORS
from tribodyn.plot.theme.style import figure, marked

if TYPE_CHECKING:
    from tribodyn.study.frequencies import KinematicFrequencies


@drawing(
    "kinematic_frequencies",
    heading="Frequencies of the parts",
    caption="Each mark is a frequency at which a part repeats: turns of shafts (f), gear meshes "
    "(GMF) with sidebands, hunting teeth (HTF), assembly phases (APF), defects of bearings (BPFO, "
    "BPFI, BSF, FTF), passing planets (PPF) and damaged teeth of a stage (TF).",
    of="KinematicFrequencies",
    made_by="Take those of a case: tribodyn.kinematic_frequencies.",
)
def kinematic_frequencies(lines: KinematicFrequencies) -> Any:
    """Draw the frequencies of the parts, one row for each."""
    rows = list(dict.fromkeys(lines.part))
    traces = []
    for number, part in enumerate(rows):
        mine = [k for k, name in enumerate(lines.part) if name == part]
        color = COLORS[number % len(COLORS)]
        trace = marked(
            lines.frequency[mine], [part] * len(mine), part, color, size=8, symbol="line-ns-open"
        )
        labels = [lines.symbol[k] for k in mine]
        words = [f"{lines.symbol[k]}, {lines.meaning[k]}" for k in mine]
        hover = "%{x:.6g} Hz: %{customdata}<extra></extra>"
        first = {float(lines.frequency[k]): k for k in reversed(mine)}
        alone = [first[float(lines.frequency[k])] == k for k in mine]
        shown = [
            "" if "GMF " in label or not own else label
            for label, own in zip(labels, alone, strict=True)
        ]
        trace |= {"mode": "markers+text", "text": shown, "textposition": "top center",
                  "customdata": words, "hovertemplate": hover, "showlegend": False}  # fmt: skip
        traces.append(trace)
    layout = {
        "height": 160 + 52 * len(rows),
        "hovermode": "closest",
        "xaxis": {"type": "log", "title": {"text": "Frequency [Hz]"}},
        "yaxis": {"autorange": "reversed", "type": "category"},
    }
    return figure(f"{len(rows)} parts, input at {lines.input_frequency:.4g} Hz", traces, layout)
