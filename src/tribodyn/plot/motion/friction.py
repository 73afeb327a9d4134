"""Effect of friction on the vibration over its coefficient, and published claims about it."""

from __future__ import annotations

from itertools import product
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.cases.papers.friction_claims import DRIVING, HELD
from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.theme.colors import INK, PAIR_COLORS, PINION, WHEEL
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import Trace, bars, figure, heat, line
from tribodyn.study.pipeline.summary_figures import in_a_sentence

if TYPE_CHECKING:
    from tribodyn.cases.papers.friction_claims import FrictionExperiment

_MADE = "Call tribodyn.friction_experiment(case) and its plot method."
_SYMBOLS, _DASHES = ("circle", "square", "diamond"), ("solid", "dash", "dot")
#: Panels of the effect: summary key and axis label.
_EFFECTS = (
    ("rms_mesh_force", "Mesh force, rms<br>change [%]"),
    ("peak_to_peak_dynamic_transmission_error", "Transmission error,<br>peak to peak, change [%]"),
    ("rms_bearing_force_loa_pinion", "Bearing force along,<br>alternating rms, change [%]"),
    ("rms_bearing_force_oloa_pinion", "Bearing force across,<br>alternating rms [N]"),
)
_HARMONICS, _HARMONIC = 5, "dynamic_transmission_error_harmonic_"
_VERDICTS = [[0.0, "#f6d5c8"], [1.0, "#c9e7d8"]]


def _title(experiment: FrictionExperiment) -> str:
    effects = []
    for driving, change in zip(DRIVING, 100.0 * experiment.change("rms_mesh_force"), strict=True):
        values = change[:, 1:]
        if not np.isfinite(values).any():
            continue
        low, high = np.nanmin(values), np.nanmax(values)
        does = "lowers" if high <= 0.0 else "raises" if low >= 0.0 else "changes"
        effects.append(f"{does} it where the {driving} ({low:+.2g} to {high:+.2g} %)")
    phrase = " and ".join(effects).replace(" it ", " the rms mesh force ", 1)
    return f"Friction {phrase}" if effects else "No steady state was computed"


def _curves(experiment: FrictionExperiment, name: str) -> list[Trace]:
    """One curve per setting over the mean friction coefficient of all laws."""
    absolute = name == _EFFECTS[-1][0]
    values = experiment[name] if absolute else 100.0 * experiment.change(name)
    hover = f"%{{text}}<br>%{{x:.3f}}: %{{y:.4g}} {'N' if absolute else '%'}"
    traces = []
    for (row, driving), (column, torque) in product(enumerate(DRIVING), enumerate(HELD)):
        mu = experiment["mean_friction_coefficient"][row, column]
        order, color, name = np.argsort(mu), (PINION, WHEEL)[row], f"{driving}, {torque}"
        traces.append(
            line(
                mu[order],
                values[row, column][order],
                name,
                color,
                dash=_DASHES[column],
                width=1.2,
                mode="lines+markers",
                text=[experiment.rubbing[k].name for k in order],
                marker={"symbol": _SYMBOLS[column], "size": 7, "color": color},
                hovertemplate=f"{hover}<extra>{name}</extra>",
            )
        )
    return traces


def _no_effect(experiment: FrictionExperiment) -> str:
    done = experiment.figures and np.isfinite(experiment.change(_EFFECTS[0][0])[..., 1:]).any()
    return "" if done else "No steady state with friction was computed."


def _no_claim(experiment: FrictionExperiment) -> str:
    judged = any(claim.holds is not None for claim in experiment.claims)
    return "" if judged else "No claim has all the steady states that it needs."


def _no_harmonics(experiment: FrictionExperiment) -> str:
    lack = _no_effect(experiment)
    column = experiment.axes[1].values.index(experiment.case.operation.torque_balance)
    if lack or np.isfinite(experiment.change(f"{_HARMONIC}1")[:, column, 1:]).any():
        return lack
    return "No steady state with friction was computed with the torque held as in the case."


@drawing(
    heading="What friction changes", missing=_no_effect, of="FrictionExperiment", made_by=_MADE
)
def friction_effect(experiment: FrictionExperiment) -> Sketch:
    """Draw the effect of friction on forces and transmission error over its mean coefficient.

    Every point is a steady state. The mean coefficient determines the size of the effect for every
    friction law; the driving gear and the torque that is held constant determine its sign. Friction
    alone excites vibration only across the line of action.
    """
    panels = [
        Panel(label, [{**t, "showlegend": number == 0} for t in _curves(experiment, name)])
        for number, (name, label) in enumerate(_EFFECTS)
        if name in experiment.figures
    ]
    return stack(_title(experiment), "Mean friction coefficient", panels, {"hovermode": "closest"})


@drawing(heading="Five published claims", missing=_no_claim, of="FrictionExperiment", made_by=_MADE)
def friction_claims(experiment: FrictionExperiment) -> Sketch:
    """Draw for each published claim the assumptions under which it holds.

    Green: the claim holds under these assumptions. The table lists the printed statement, the
    result for this pair, and the reason.
    """
    judged = [
        (claim.statement, claim.holds.ravel())
        for claim in experiment.claims
        if claim.holds is not None
    ]
    holds = np.array([each for _, each in judged]).reshape(len(judged), -1)
    settings = [f"{d}<br>{h.replace(' torque', '<br>torque')}" for d in DRIVING for h in HELD]
    statements = ["<br>".join(wrap(statement, 44)) for statement, _ in judged]
    verdicts = heat(
        settings, statements, holds.astype(float), _VERDICTS, "%{y}<br>%{x}: %{text}", zmin=0.0,
        zmax=1.0, showscale=False, xgap=3, ygap=3, text=np.where(holds, "holds", "fails"),
        texttemplate="%{text}", textfont={"color": INK},
    )  # fmt: skip
    everywhere = int(holds.all(axis=1).sum())
    somewhere = int(holds.any(axis=1).sum()) - everywhere
    title = f"Claims that always hold: {everywhere} of {len(judged)}; in some settings: {somewhere}"
    axes = {"yaxis": {"autorange": "reversed"}, "xaxis": {"side": "top"}}
    margin = {"t": 150, "l": 70, "r": 24, "b": 30}
    layout = {"height": 190 + 56 * len(judged), "margin": margin, "hovermode": "closest"}
    return figure(title, [verdicts], {**layout, **axes})


@drawing(
    heading="Harmonics of the transmission error",
    missing=_no_harmonics,
    of="FrictionExperiment",
    made_by=_MADE,
)
def friction_harmonics(experiment: FrictionExperiment) -> Sketch:
    """Draw how friction changes the harmonics of the dynamic transmission error.

    Change of the first harmonics by each law, at the roughness of the case or the nearest one, with
    the torque held as in the case.
    """
    names = [f"{_HARMONIC}{k}" for k in range(1, _HARMONICS + 1)]
    change = 100.0 * np.array([experiment.change(name) for name in names])
    column = experiment.axes[1].values.index(experiment.case.operation.torque_balance)
    variants = experiment.nearest()
    colors, panels = (PINION, WHEEL, *PAIR_COLORS), []
    for row, driving in enumerate(DRIVING):
        groups = [
            bars(list(range(1, _HARMONICS + 1)), change[:, row, column, k],
                 experiment.rubbing[k].name, colors[n % len(colors)], "%{y:.3g} %",
                 showlegend=row == 0)
            for n, k in enumerate(variants)
        ]  # fmt: skip
        panels.append(Panel(f"Change, the<br>{driving} [%]", groups))
    part = change[:, :, column, variants]
    order, driver, place = np.unravel_index(int(np.nanargmax(np.abs(part))), part.shape)
    title = (
        f"The {in_a_sentence(names[order])} changes most: {part[order, driver, place]:+.3g} % "
        f"({DRIVING[driver]}, {experiment.rubbing[variants[int(place)]].name})"
    )
    return stack(title, "Mesh harmonic", panels, {"hovermode": "closest", "barmode": "group"})
