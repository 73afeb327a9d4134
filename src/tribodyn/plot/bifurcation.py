"""Bifurcation diagram: the motion once per mesh cycle over a parameter, rms, exponent."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.labels import axis_label, displayed, readable
from tribodyn.plot.style import MUTED, PINION, WHEEL, Panel, line, stack
from tribodyn.units import convert

_COLORS = {"up": PINION, "down": WHEEL, "independent": PINION}
_WORDS = {"up": "upwards", "down": "downwards", "independent": "from rest"}
#: What a point that is not physics looks like.
_STEP_LIMITED = "#b8c0c8"
_PERIODS = 16
#: Difference of two motions over the largest rms from which they count as two.
_APART = 0.05
#: Part of the motions up to which those that the step made are told last.
_FEW = 0.05


def _missing(result: Any) -> str:
    if hasattr(result, "refined_period"):
        return ""
    return (
        "This figure shows motions over a parameter. Call "
        'tribodyn.bifurcation(case, over="operation.speed", between=("400 rpm", "3500 rpm")) and '
        "its plot method."
    )


def _scale(found: Any) -> tuple[float, str]:
    """Factor and unit in which lengths below a tenth of a millimetre are drawn."""
    largest = float(np.nanmax(np.abs(found.section), initial=0.0))
    return (1e6, "µm") if largest < 1e-3 else (1.0, "m")


def _parameter(found: Any) -> tuple[Any, str]:
    """Values of the parameter as engineers read them, and their label."""
    name = found.parameter_name.rpartition(".")[2]
    if name in QUANTITIES and QUANTITIES[name].unit == found.parameter_unit:
        return displayed(name, found.parameter), axis_label(name)
    words, unit = name.replace("_", " ").capitalize(), found.parameter_unit
    if unit in ("", "-"):
        return found.parameter, words
    kind = name.rpartition("_")[2]
    alike = [each.display_unit for each in QUANTITIES.values()
             if each.unit == unit and each.name.rpartition("_")[2] == kind]  # fmt: skip
    shown = alike[0] if alike else unit
    factor = convert(1.0, unit, shown) if alike else 1.0
    return found.parameter * factor, f"{words} [{readable(shown)}]"


def _section(found: Any, parameter: Any, factor: float, unit: str) -> list[dict[str, Any]]:
    """Points of every branch; those that a long step made are grey."""
    traces = []
    for number, branch in enumerate(found.branches):
        limited = found.verdict[number] == "step-limited"
        for grey in (True, False):
            chosen = limited if grey else ~limited
            if not chosen.any():
                continue
            rows = found.section[number][chosen]
            name = "step-limited, not physics" if grey else _WORDS[branch]
            color = _STEP_LIMITED if grey else _COLORS[branch]
            x = np.repeat(parameter[chosen], rows.shape[1])
            trace = line(x, factor * rows.ravel(), name, color, unit=unit)
            # Of two motions at one place both are seen: small points lie on large ones.
            size = 5 if branch != "down" else 3
            traces.append({**trace, "mode": "markers", "marker": {"size": size, "color": color}})
    return traces


def _curves(found: Any, parameter: Any, values: Any, unit: str) -> list[dict[str, Any]]:
    return [
        {
            **line(
                parameter, values[number], _WORDS[branch], _COLORS[branch], unit=unit,
                dash="dot" if branch == "down" else "solid", width=1.6,
            ),
            "showlegend": False,
        }
        for number, branch in enumerate(found.branches)
    ]  # fmt: skip


def _two_motions(found: Any, parameter: Any, label: str) -> str:
    """Where the motion depends on the direction of the sweep."""
    if not {"up", "down"} <= set(found.branches):
        return ""
    up, down = (found.rms[found.branches.index(name)] for name in ("up", "down"))
    apart = np.abs(up - down) > _APART * np.nanmax(found.rms, initial=0.0)
    if not apart.any():
        return ""
    unit = label.rpartition("[")[2].rstrip("]") if "[" in label else ""
    low, high = (f"{edge(parameter[apart]):.4g} {unit}".rstrip() for edge in (np.min, np.max))
    return f"Two motions are possible from {low} to {high}"


def _title(found: Any, parameter: Any, label: str) -> str:
    count, lost = found.verdict.size, int(found.ran_away.sum())
    done = found.finished & (found.verdict != "step-limited") & ~found.ran_away
    limited = found.verdicts().get("step-limited", 0)
    if limited > _FEW * count:
        return f"{limited} of {count} motions are made by the step, not by physics"
    wild = int(np.count_nonzero((found.period == 0) & done))
    longest = int(np.max(found.period, where=done, initial=0))
    two = _two_motions(found, parameter, label)
    parts = [two] if two else []
    if wild:
        within = "" if two else f" within {_PERIODS} mesh cycles"
        parts.append(f"{wild} of {count} motions do not repeat{within}")
    elif longest > 1:
        parts.append(f"{'the' if two else 'The'} motion repeats after up to {longest} mesh cycles")
    if lost:
        verb = "grows" if lost == 1 else "grow"
        parts.insert(0, f"{lost} of {count} motions {verb} beyond all bounds")
    if not parts:
        parts.append("Every motion repeats after one mesh cycle")
    if limited:
        parts.append(f"{limited} of {count} made by the step")
    return "; ".join(parts[:2])  # what has no room shows in the picture


@drawing(
    "bifurcation",
    heading="Bifurcation diagram",
    caption="The compression of the mesh once per mesh cycle, at the same place of the cycle. One "
    "point means that the motion repeats with the mesh, two that it repeats every second cycle, a "
    "cloud that it does not repeat. Where the sweep upwards and the sweep downwards differ, two "
    "motions are possible. Grey points vanish with a shorter step: they are not physics.",
    needs=_missing,
)
def bifurcation(found: Any) -> Any:
    """Draw the section, the rms and, if it is there, the largest exponent over the parameter.

    Parameters
    ----------
    found : Bifurcation
        What :func:`tribodyn.bifurcation` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    factor, unit = _scale(found)
    parameter, label = _parameter(found)
    rms = _curves(found, parameter, factor * found.rms, unit)
    panels = [
        Panel(f"Section [{unit}]", _section(found, parameter, factor, unit), height=1.6),
        Panel(f"Rms [{unit}]", rms, {"rangemode": "tozero"}),
    ]
    if np.any(np.isfinite(found.largest_exponent)):
        zero = {**line(parameter[[0, -1]], [0.0, 0.0], "zero", MUTED), "showlegend": False}
        curves = [zero, *_curves(found, parameter, found.largest_exponent, "1/s")]
        panels.append(Panel("Largest exponent [1/s]", curves))
    return stack(_title(found, parameter, label), label, panels)
