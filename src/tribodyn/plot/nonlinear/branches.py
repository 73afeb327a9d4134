"""Motions over a parameter: bifurcation diagrams and branches of periodic motions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.look.labels import (
    axis_label,
    displayed,
    readable,
    rounded,
    scaled,
    significant,
    unit_of,
)
from tribodyn.plot.look.panels import Panel, stack
from tribodyn.plot.look.style import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, Trace, line, marked
from tribodyn.types import Array, Mask
from tribodyn.units import convert

if TYPE_CHECKING:
    from tribodyn.analysis import Bifurcation
    from tribodyn.dynamics import Branch

_COLORS = {"up": PINION, "down": WHEEL, "independent": PINION}
_WORDS = {"up": "upwards", "down": "downwards", "independent": "from rest"}
#: What a point that is not physics looks like.
_STEP_LIMITED = "#b8c0c8"
_PERIODS = 16
#: Difference of two motions over the largest rms from which they count as two.
_APART = 0.05
#: Part of the motions up to which those that the step made are told last.
_FEW = 0.05
_UNSTABLE = PAIR_COLORS[3]
#: Kind of special point: words, colour and symbol.
_MARKS = {
    "fold": ("fold", PAIR_COLORS[1], "circle"),
    "period-doubling": ("period doubling", PAIR_COLORS[0], "diamond"),
    "neimark-sacker": ("Neimark-Sacker", PAIR_COLORS[2], "square"),
    "branch-point": ("branch point", TOTAL, "x"),
    "grazing": ("contact begins to open", MUTED, "triangle-down"),
}


def _scale(diagram: Bifurcation) -> tuple[float, str]:
    """Factor and unit in which lengths below a tenth of a millimetre are drawn."""
    largest = float(np.nanmax(np.abs(diagram.section), initial=0.0))
    return (1e6, "µm") if largest < 1e-3 else (1.0, "m")


def _bifurcation_parameter(diagram: Bifurcation) -> tuple[Any, str]:
    """Values of the parameter as engineers read them, and their label."""
    name = diagram.parameter_name.rpartition(".")[2]
    if name in QUANTITIES and QUANTITIES[name].unit == diagram.parameter_unit:
        return displayed(name, diagram.parameter), axis_label(name)
    words, unit = name.replace("_", " ").capitalize(), diagram.parameter_unit
    if unit in ("", "-"):
        return diagram.parameter, words
    kind = name.rpartition("_")[2]
    alike = [
        each.display_unit
        for each in QUANTITIES.values()
        if each.unit == unit and each.name.rpartition("_")[2] == kind
    ]
    shown = alike[0] if alike else unit
    factor = convert(1.0, unit, shown) if alike else 1.0
    return diagram.parameter * factor, f"{words} [{readable(shown)}]"


def _section(diagram: Bifurcation, parameter: Any, factor: float, unit: str) -> list[Trace]:
    """Points of every branch; those that a long step made are grey."""
    traces = []
    for number, branch in enumerate(diagram.branches):
        limited = diagram.verdict[number] == "step-limited"
        for grey in (True, False):
            chosen = limited if grey else ~limited
            if not chosen.any():
                continue
            rows = diagram.section[number][chosen]
            name = "step-limited, not physics" if grey else _WORDS[branch]
            color = _STEP_LIMITED if grey else _COLORS[branch]
            x = np.repeat(parameter[chosen], rows.shape[1])
            trace = line(x, factor * rows.ravel(), name, color, unit=unit)
            # Of two motions at one place both are seen: small points lie on large ones.
            size = 5 if branch != "down" else 3
            traces.append({**trace, "mode": "markers", "marker": {"size": size, "color": color}})
    return traces


def _curves(diagram: Bifurcation, parameter: Any, values: Any, unit: str) -> list[Trace]:
    return [
        {
            **line(
                parameter,
                values[number],
                _WORDS[branch],
                _COLORS[branch],
                unit=unit,
                dash="dot" if branch == "down" else "solid",
                width=1.6,
            ),
            "showlegend": False,
        }
        for number, branch in enumerate(diagram.branches)
    ]


def _two_motions(diagram: Bifurcation, parameter: Any, label: str) -> str:
    """Where the motion depends on the direction of the sweep."""
    if not {"up", "down"} <= set(diagram.branches):
        return ""
    up, down = (diagram.rms[diagram.branches.index(name)] for name in ("up", "down"))
    apart = np.abs(up - down) > _APART * np.nanmax(diagram.rms, initial=0.0)
    if not apart.any():
        return ""
    unit = label.rpartition("[")[2].rstrip("]") if "[" in label else ""
    low, high = (f"{edge(parameter[apart]):.4g} {unit}".rstrip() for edge in (np.min, np.max))
    return f"Two motions are possible from {low} to {high}"


def _bifurcation_title(diagram: Bifurcation, parameter: Any, label: str) -> str:
    count, lost = diagram.verdict.size, int(diagram.ran_away.sum())
    done = diagram.finished & (diagram.verdict != "step-limited") & ~diagram.ran_away
    limited = diagram.verdicts().get("step-limited", 0)
    if limited > _FEW * count:
        return f"{limited} of {count} motions are made by the step, not by physics"
    wild = int(np.count_nonzero((diagram.period == 0) & done))
    longest = int(np.max(diagram.period, where=done, initial=0))
    two = _two_motions(diagram, parameter, label)
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
    of="Bifurcation",
    made_by='Call tribodyn.bifurcation(case, over="operation.speed", between=("400 '
    'rpm", "3500 rpm")) and its plot method.',
)
def bifurcation(diagram: Bifurcation) -> Any:
    """Draw the section, the rms and, if it is there, the largest exponent over the parameter."""
    factor, unit = _scale(diagram)
    parameter, label = _bifurcation_parameter(diagram)
    rms = _curves(diagram, parameter, factor * diagram.rms, unit)
    panels = [
        Panel(f"Section [{unit}]", _section(diagram, parameter, factor, unit), height=1.6),
        Panel(f"Rms [{unit}]", rms, {"rangemode": "tozero"}),
    ]
    if np.any(np.isfinite(diagram.largest_exponent)):
        zero = {**line(parameter[[0, -1]], [0.0, 0.0], "zero", MUTED), "showlegend": False}
        curves = [zero, *_curves(diagram, parameter, diagram.largest_exponent, "1/s")]
        panels.append(Panel("Largest exponent [1/s]", curves))
    return stack(_bifurcation_title(diagram, parameter, label), label, panels)


def _quantity_of(branch: Branch) -> str:
    """Quantity that a branch goes over, also where it is a key of a case; empty if it has none."""
    name = branch.name.rpartition(".")[2]
    return name if name in QUANTITIES else ""


def _branch_parameter(branch: Branch, values: Any) -> Array:
    name = _quantity_of(branch)
    return displayed(name, values) if name else np.asarray(values, dtype=float)


def _signal(branch: Branch) -> tuple[Array, list[float], str]:
    """Rms of the first signal and at the special points as they are drawn, and their unit."""
    factor, unit = scaled(branch.rms[:, 0], unit_of(branch.signals[0]))
    special = [float(factor * point.rms[0]) for point in branch.special_points]
    return factor * np.asarray(branch.rms[:, 0], dtype=float), special, unit


def _part(values: Array, keep: Mask) -> Array:
    """Values of the points kept and of their neighbours, so that the parts meet."""
    near = keep | np.roll(keep, 1) & (np.arange(keep.size) > 0)
    return np.where(near, values, np.nan)


def _parts(branch: Branch, x: Array, y: Array, unit: str) -> list[Trace]:
    stable = np.asarray(branch.stable, dtype=bool)
    drawn = [line(x, _part(y, stable), "stable", TOTAL, unit=unit)]
    if not stable.all():
        drawn.append(line(x, _part(y, ~stable), "unstable", _UNSTABLE, unit=unit, dash="dash"))
    return drawn


def _points(branch: Branch, values: list[float], unit: str, legend: bool) -> list[Trace]:
    drawn = []
    for kind, (words, color, symbol) in _MARKS.items():
        own = [n for n, point in enumerate(branch.special_points) if point.kind == kind]
        if not own:
            continue
        x = _branch_parameter(branch, [branch.special_points[n].parameter for n in own])
        y = [values[n] for n in own]
        mark = marked(x, y, words, color, size=9, symbol=symbol, unit=unit)
        drawn.append({**mark, "showlegend": legend})
    return drawn


def _told(branch: Branch, value: float) -> str:
    name = _quantity_of(branch)
    return rounded(name, value, 4) if name else f"{branch.name} {significant(value, 4)}"


def _branch_title(branch: Branch) -> str:
    folds = [_told(branch, fold.parameter) for fold in branch.special("fold")]
    if len(folds) > 2:
        return f"The branch turns back {len(folds)} times"
    if folds:
        return f"The branch turns back at {' and '.join(folds)}"
    if np.all(branch.stable):
        low, high = (_told(branch, edge(branch.parameter)) for edge in (np.min, np.max))
        return f"The motion is stable from {low} to {high}"
    lost = branch.parameter[int(np.argmin(branch.stable))]
    return f"The motion is not stable at {_told(branch, float(lost))}"


@drawing(
    "continuation",
    heading="Branch of periodic motions",
    caption="How strong the periodic motion is over the parameter. Dashed parts exist but are "
    "left at the slightest disturbance. Where the branch turns back, the motion jumps. Below: the "
    "largest Floquet multiplier, by which a disturbance grows in one period.",
    of="Branch",
    made_by="Call tribodyn.dynamics.continuation(...) and its plot method.",
)
def continuation(branch: Branch) -> Any:
    """Draw rms and largest multiplier of a branch over its parameter."""
    x = _branch_parameter(branch, branch.parameter)
    rms, special, unit = _signal(branch)
    largest = np.abs(branch.floquet_multipliers[:, 0])
    critical = [float(np.abs(p.floquet_multipliers[0])) for p in branch.special_points]
    name = _quantity_of(branch)
    ends = [float(x.min()), float(x.max())]
    return stack(
        _branch_title(branch),
        axis_label(name) if name else branch.name,
        [
            Panel(
                f"Alternating rms of {branch.signals[0]} [{unit}]",
                [*_parts(branch, x, rms, unit), *_points(branch, special, unit, True)],
                {"rangemode": "tozero"},
                1.4,
            ),
            Panel(
                "Largest multiplier",
                [
                    *_parts(branch, x, largest, ""),
                    {**line(ends, [1.0, 1.0], "limit", MUTED, dash="dot"), "hoverinfo": "skip"},
                    *_points(branch, critical, "", False),
                ],
                {"rangemode": "tozero"},
            ),
        ],
        # A branch that turns back has several values at one place: each is told by itself.
        {"hovermode": "closest"},
    )
