"""Bifurcation diagrams and branches of periodic orbits over a parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import (
    axis_label,
    displayed,
    readable,
    rounded,
    scaled,
    significant,
    unit_of,
)
from tribodyn.plot.theme.panels import Panel, from_zero, stack
from tribodyn.plot.theme.style import Trace, line, marked
from tribodyn.types import Array, Mask
from tribodyn.units import convert

if TYPE_CHECKING:
    from tribodyn.analysis import Bifurcation
    from tribodyn.dynamics import Branch

_COLORS = {"up": PINION, "down": WHEEL, "independent": PINION}
_WORDS = {"up": "upwards", "down": "downwards", "independent": "from rest"}
#: Colour of points that depend on the step of the time integration.
_STEP_LIMITED = "#b8c0c8"
_PERIODS = 16
#: Responses with a larger difference, relative to the largest rms, count as different.
_DIFFERENT = 0.05
#: Fraction of step-limited responses up to which the title mentions them last.
_MAX_LIMITED = 0.05
_UNSTABLE = PAIR_COLORS[3]
#: Kind of special point: label, colour and symbol.
_MARKS = {
    "fold": ("fold", PAIR_COLORS[1], "circle"),
    "period-doubling": ("period doubling", PAIR_COLORS[0], "diamond"),
    "neimark-sacker": ("Neimark-Sacker", PAIR_COLORS[2], "square"),
    "branch-point": ("branch point", TOTAL, "x"),
    "grazing": ("contact begins to open", MUTED, "triangle-down"),
}


def _scale(diagram: Bifurcation) -> tuple[float, str]:
    """Factor and unit of the section: µm below a millimetre, else m."""
    largest = float(np.nanmax(np.abs(diagram.section), initial=0.0))
    return (1e6, "µm") if largest < 1e-3 else (1.0, "m")


def _bifurcation_parameter(diagram: Bifurcation) -> tuple[Any, str]:
    """Values of the parameter in its display unit, and the axis label."""
    name = diagram.parameter_name.rpartition(".")[2]
    if name in QUANTITIES and QUANTITIES[name].unit == diagram.parameter_unit:
        return displayed(name, diagram.parameter), axis_label(name)
    label, unit = name.replace("_", " ").capitalize(), diagram.parameter_unit
    if unit in ("", "-"):
        return diagram.parameter, label
    kind = name.rpartition("_")[2]
    display_units = [
        each.display_unit
        for each in QUANTITIES.values()
        if each.unit == unit and each.name.rpartition("_")[2] == kind
    ]
    display_unit = display_units[0] if display_units else unit
    factor = convert(1.0, unit, display_unit) if display_units else 1.0
    return diagram.parameter * factor, f"{label} [{readable(display_unit)}]"


def _section(diagram: Bifurcation, parameter: Any, factor: float, unit: str) -> list[Trace]:
    """Points of every branch; step-limited points are grey."""
    traces = []
    for number, branch in enumerate(diagram.branches):
        limited = diagram.verdict[number] == "step-limited"
        for grey in (True, False):
            chosen = limited if grey else ~limited
            if not chosen.any():
                continue
            rows = diagram.section[number][chosen]
            name = "step-limited, not physical" if grey else _WORDS[branch]
            color = _STEP_LIMITED if grey else _COLORS[branch]
            x = np.repeat(parameter[chosen], rows.shape[1])
            # Small points on large ones show coinciding branches.
            marker = {"size": 5 if branch != "down" else 3, "color": color}
            more: Trace = {"unit": unit, "mode": "markers", "marker": marker}
            traces.append(line(x, factor * rows.ravel(), name, color, **more))
    return traces


def _curves(diagram: Bifurcation, parameter: object, values: Any, unit: str) -> list[Trace]:
    style: Trace = {"unit": unit, "width": 1.6, "showlegend": False}
    dashes = ["dot" if branch == "down" else "solid" for branch in diagram.branches]
    return [
        line(parameter, row, _WORDS[branch], _COLORS[branch], dash=dash, **style)
        for branch, row, dash in zip(diagram.branches, values, dashes, strict=True)
    ]


def _two_motions(diagram: Bifurcation, parameter: Any, label: str) -> str:
    """Parameter range in which the response depends on the direction of the sweep."""
    if not {"up", "down"} <= set(diagram.branches):
        return ""
    up, down = (diagram.rms[diagram.branches.index(name)] for name in ("up", "down"))
    different = np.abs(up - down) > _DIFFERENT * np.nanmax(diagram.rms, initial=0.0)
    if not different.any():
        return ""
    unit = label.rpartition("[")[2].rstrip("]") if "[" in label else ""
    low, high = (f"{edge(parameter[different]):.4g} {unit}".rstrip() for edge in (np.min, np.max))
    return f"Two responses coexist from {low} to {high}"


def _bifurcation_title(diagram: Bifurcation, parameter: object, label: str) -> str:
    count, lost = diagram.verdict.size, int(diagram.ran_away.sum())
    done = diagram.finished & (diagram.verdict != "step-limited") & ~diagram.ran_away
    limited = diagram.verdicts().get("step-limited", 0)
    if limited > _MAX_LIMITED * count:
        return f"{limited} of {count} responses depend on the time step and are not physical"
    wild = int(np.count_nonzero((diagram.period == 0) & done))
    longest = int(np.max(diagram.period, where=done, initial=0))
    coexisting = _two_motions(diagram, parameter, label)
    parts = [coexisting] if coexisting else []
    if wild:
        within = "" if coexisting else f" within {_PERIODS} mesh cycles"
        parts.append(f"{wild} of {count} responses are not periodic{within}")
    elif longest > 1:
        parts.append(f"{'periods' if coexisting else 'Periods'} of up to {longest} mesh cycles")
    if lost:
        verb = "grows" if lost == 1 else "grow"
        parts.insert(0, f"{lost} of {count} responses {verb} without bound")
    if not parts:
        parts.append("Every response has a period of one mesh cycle")
    if limited:
        parts.append(f"{limited} of {count} depend on the time step")
    return "; ".join(parts[:2])  # the plot shows the rest


def _bifurcation_caption(diagram: Bifurcation) -> str:
    caption = (
        "The compression of the mesh once per mesh cycle, at the same phase. One point is a period "
        "of one mesh cycle, two points are a period of two cycles, a cloud is a non-periodic "
        "response."
    )
    if {"up", "down"} <= set(diagram.branches):
        caption += " Where the upward and the downward sweep differ, two responses coexist."
    if diagram.verdicts().get("step-limited", 0):
        caption += " Grey points vanish with a shorter time step: they are not physical."
    return caption


def _branch_caption(branch: Branch) -> str:
    return (
        "Amplitude of the periodic orbit over the parameter."
        + " Dashed parts are unstable." * (not np.all(branch.stable))
        + " Where the branch turns back, the response jumps." * bool(branch.special("fold"))
        + " Below: the largest Floquet multiplier, the growth of a disturbance in one period."
    )


@drawing(
    heading="Bifurcation diagram",
    caption=_bifurcation_caption,
    of="Bifurcation",
    made_by='Call tribodyn.bifurcation(case, over="operation.speed", between=("400 '
    'rpm", "3500 rpm")) and its plot method.',
)
def bifurcation(diagram: Bifurcation) -> Sketch:
    """Draw the section, the rms and, if computed, the largest exponent over the parameter."""
    factor, unit = _scale(diagram)
    parameter, label = _bifurcation_parameter(diagram)
    rms = _curves(diagram, parameter, factor * diagram.rms, unit)
    panels = [
        Panel(f"Section [{unit}]", _section(diagram, parameter, factor, unit), height=1.6),
        from_zero(f"Rms [{unit}]", rms),
    ]
    if np.any(np.isfinite(diagram.largest_exponent)):
        zero = {**line(parameter[[0, -1]], [0.0, 0.0], "zero", MUTED), "showlegend": False}
        curves = [zero, *_curves(diagram, parameter, diagram.largest_exponent, "1/s")]
        panels.append(Panel("Largest exponent [1/s]", curves))
    return stack(_bifurcation_title(diagram, parameter, label), label, panels)


def _quantity_of(branch: Branch) -> str:
    """Quantity of the branch parameter, also for a key of a case; empty if there is none."""
    name = branch.name.rpartition(".")[2]
    return name if name in QUANTITIES else ""


def _branch_parameter(branch: Branch, values: object) -> Array:
    name = _quantity_of(branch)
    return displayed(name, values) if name else np.asarray(values, dtype=float)


def _signal(branch: Branch) -> tuple[Array, list[float], str]:
    """Rms of the first signal and at the special points in a display unit, and that unit."""
    factor, unit = scaled(branch.rms[:, 0], unit_of(branch.signals[0]))
    special = [float(factor * point.rms[0]) for point in branch.special_points]
    return factor * np.asarray(branch.rms[:, 0], dtype=float), special, unit


def _part(values: Array, keep: Mask) -> Array:
    """Mask values outside ``keep`` and its neighbours, so that adjacent parts connect."""
    neighbours = keep | np.roll(keep, 1) & (np.arange(keep.size) > 0)
    return np.where(neighbours, values, np.nan)


def _parts(branch: Branch, x: Array, y: Array, unit: str) -> list[Trace]:
    stable = np.asarray(branch.stable, dtype=bool)
    curves = [line(x, _part(y, stable), "stable", TOTAL, unit=unit)]
    if not stable.all():
        curves.append(line(x, _part(y, ~stable), "unstable", _UNSTABLE, unit=unit, dash="dash"))
    return curves


def _points(branch: Branch, values: list[float], unit: str, legend: bool) -> list[Trace]:
    traces = []
    for kind, (label, color, symbol) in _MARKS.items():
        indices = [n for n, point in enumerate(branch.special_points) if point.kind == kind]
        if not indices:
            continue
        x = _branch_parameter(branch, [branch.special_points[n].parameter for n in indices])
        y = [values[n] for n in indices]
        mark = marked(x, y, label, color, size=9, symbol=symbol, unit=unit)
        traces.append({**mark, "showlegend": legend})
    return traces


def _value_text(branch: Branch, value: float) -> str:
    name = _quantity_of(branch)
    return rounded(name, value, 4) if name else f"{branch.name} {significant(value, 4)}"


def _branch_title(branch: Branch) -> str:
    folds = [_value_text(branch, fold.parameter) for fold in branch.special("fold")]
    if len(folds) > 2:
        return f"The branch turns back {len(folds)} times"
    if folds:
        return f"The branch turns back at {' and '.join(folds)}"
    if np.all(branch.stable):
        low, high = (_value_text(branch, edge(branch.parameter)) for edge in (np.min, np.max))
        return f"The orbit is stable from {low} to {high}"
    lost = branch.parameter[int(np.argmin(branch.stable))]
    return f"The orbit is unstable at {_value_text(branch, float(lost))}"


@drawing(
    heading="Branch of periodic orbits",
    caption=_branch_caption,
    of="Branch",
    made_by="Call tribodyn.dynamics.continuation(...) and its plot method.",
)
def continuation(branch: Branch) -> Sketch:
    """Draw rms and largest multiplier of a branch over its parameter."""
    x = _branch_parameter(branch, branch.parameter)
    rms, special, unit = _signal(branch)
    largest = np.abs(branch.floquet_multipliers[:, 0])
    critical = [float(np.abs(p.floquet_multipliers[0])) for p in branch.special_points]
    name = _quantity_of(branch)
    ends = [float(x.min()), float(x.max())]
    limit = line(ends, [1.0, 1.0], "limit", MUTED, dash="dot", hoverinfo="skip")
    orbits = [*_parts(branch, x, rms, unit), *_points(branch, special, unit, True)]
    growth = [*_parts(branch, x, largest, ""), limit, *_points(branch, critical, "", False)]
    panels = [
        from_zero(f"Alternating rms of {branch.signals[0]} [{unit}]", orbits, 1.4),
        from_zero("Largest multiplier", growth),
    ]
    label = axis_label(name) if name else branch.name
    # A branch that turns back has several values at the same parameter.
    return stack(_branch_title(branch), label, panels, {"hovermode": "closest"})
