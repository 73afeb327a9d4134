"""What friction does to a running pair: its effect over the coefficient, and claims judged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.look.panels import Panel, stack
from tribodyn.plot.look.style import INK, PAIR_COLORS, PINION, WHEEL, Trace, figure, line
from tribodyn.study.pipeline.words import in_a_sentence
from tribodyn.study.studies.friction_claims import DRIVING, HELD

if TYPE_CHECKING:
    from tribodyn.study.studies.friction_claims import FrictionExperiment

_MADE = "Call tribodyn.friction_experiment(case) and its plot method."
_SYMBOLS, _DASHES = ("circle", "square", "diamond"), ("solid", "dash", "dot")
#: Panels of the effect: figure of the summary and label.
_EFFECTS = (
    ("rms_mesh_force", "Mesh force, rms<br>change [%]"),
    ("peak_to_peak_dynamic_transmission_error", "Transmission error,<br>peak to peak, change [%]"),
    ("rms_bearing_force_loa_pinion", "Bearing force along,<br>alternating rms, change [%]"),
    ("rms_bearing_force_oloa_pinion", "Bearing force across,<br>alternating rms [N]"),
)
_HARMONICS, _HARMONIC = 5, "dynamic_transmission_error_harmonic_"
_VERDICTS = [[0.0, "#f6d5c8"], [1.0, "#c9e7d8"]]


def _title(found: FrictionExperiment) -> str:
    told = []
    for driving, change in zip(DRIVING, 100.0 * found.change("rms_mesh_force"), strict=True):
        values = change[:, 1:]
        if not np.isfinite(values).any():
            continue
        low, high = np.nanmin(values), np.nanmax(values)
        does = "lowers" if high <= 0.0 else "raises" if low >= 0.0 else "changes"
        told.append(f"{does} it where the {driving} ({low:+.2g} to {high:+.2g} %)")
    words = " and ".join(told).replace(" it ", " the rms mesh force ", 1)
    return f"Friction {words}" if told else "No steady state was computed"


def _curves(found: FrictionExperiment, name: str) -> list[Trace]:
    """One curve for each setting, over the mean coefficient of whatever law."""
    absolute = name == _EFFECTS[-1][0]
    values = found[name] if absolute else 100.0 * found.change(name)
    traces = []
    for row, driving in enumerate(DRIVING):
        for column, held in enumerate(HELD):
            mu = found["mean_friction_coefficient"][row, column]
            order = np.argsort(mu)
            color = (PINION, WHEEL)[row]
            curve = line(
                mu[order],
                values[row, column][order],
                f"{driving}, {held}",
                color,
                dash=_DASHES[column],
                width=1.2,
            )
            text = [found.rubbing[k].name for k in order]
            hover = f"%{{text}}<br>%{{x:.3f}}: %{{y:.4g}} {'N' if absolute else '%'}"
            marker = {"symbol": _SYMBOLS[column], "size": 7, "color": color}
            traces.append(
                {
                    **curve,
                    "mode": "lines+markers",
                    "text": text,
                    "marker": marker,
                    "hovertemplate": f"{hover}<extra>{curve['name']}</extra>",
                }
            )
    return traces


def _no_effect(found: FrictionExperiment) -> str:
    done = found.figures and np.isfinite(found.change(_EFFECTS[0][0])[..., 1:]).any()
    return "" if done else "No steady state with friction was computed."


def _no_claim(found: FrictionExperiment) -> str:
    known = any(claim.holds is not None for claim in found.claims)
    return "" if known else "Not one claim has all the steady states that it needs."


def _no_harmonics(found: FrictionExperiment) -> str:
    lack = _no_effect(found)
    column = found.axes[1].values.index(found.case.operation.torque_balance)
    if lack or np.isfinite(found.change(f"{_HARMONIC}1")[:, column, 1:]).any():
        return lack
    return "No steady state with friction was computed with the torque held as in the case."


@drawing(
    "friction_effect",
    heading="What friction changes",
    caption="Every point is a steady state; whatever the law, the mean coefficient tells the "
    "effect. Which gear drives, and which torque is held while friction acts, decide over its "
    "sign; only across the line of action does friction excite by itself.",
    missing=_no_effect,
    of="FrictionExperiment",
    made_by=_MADE,
)
def friction_effect(found: FrictionExperiment) -> Any:
    """Draw the effect of friction on forces and transmission error over its mean coefficient."""
    panels = [
        Panel(label, [{**t, "showlegend": number == 0} for t in _curves(found, name)])
        for number, (name, label) in enumerate(_EFFECTS)
        if name in found.figures
    ]
    return stack(_title(found), "Mean friction coefficient", panels, {"hovermode": "closest"})


@drawing(
    "friction_claims",
    heading="Five published claims",
    caption="Green: the claim holds under these assumptions. The table says what was printed, what "
    "this pair does, and why.",
    missing=_no_claim,
    of="FrictionExperiment",
    made_by=_MADE,
)
def friction_claims(found: FrictionExperiment) -> Any:
    """Draw which claim holds under which assumption."""
    known = [
        (claim.statement, claim.holds.ravel()) for claim in found.claims if claim.holds is not None
    ]
    holds = np.array([each for _, each in known]).reshape(len(known), -1)
    settings = [f"{d}<br>{h.replace(' torque', '<br>torque')}" for d in DRIVING for h in HELD]
    heat = {
        "type": "heatmap", "x": settings, "z": holds.astype(float), "zmin": 0.0, "zmax": 1.0,
        "y": [_broken(statement) for statement, _ in known], "showscale": False, "xgap": 3,
        "ygap": 3, "colorscale": _VERDICTS, "text": np.where(holds, "holds", "fails"),
        "texttemplate": "%{text}", "textfont": {"color": INK},
        "hovertemplate": "%{y}<br>%{x}: %{text}<extra></extra>",
    }  # fmt: skip
    whole = int(holds.all(axis=1).sum())
    part = int(holds.any(axis=1).sum()) - whole
    title = f"Claims that hold everywhere: {whole} of {len(known)}; in some settings only: {part}"
    axes = {"yaxis": {"autorange": "reversed"}, "xaxis": {"side": "top"}}
    margin = {"t": 150, "l": 70, "r": 24, "b": 30}
    return figure(
        title,
        [heat],
        {"height": 190 + 56 * len(known), "margin": margin, **axes, "hovermode": "closest"},
    )


@drawing(
    "friction_harmonics",
    heading="Harmonics of the transmission error",
    caption="Change of the first harmonics by each law, at the roughness of the case or the "
    "nearest one, with the torque held as in the case.",
    missing=_no_harmonics,
    of="FrictionExperiment",
    made_by=_MADE,
)
def friction_harmonics(found: FrictionExperiment) -> Any:
    """Draw how friction changes the harmonics of the dynamic transmission error."""
    names = [f"{_HARMONIC}{k}" for k in range(1, _HARMONICS + 1)]
    change = 100.0 * np.array([found.change(name) for name in names])
    column = found.axes[1].values.index(found.case.operation.torque_balance)
    drawn = found.nearest()
    colors, panels = (PINION, WHEEL, *PAIR_COLORS), []
    for row, driving in enumerate(DRIVING):
        bars = [
            {
                "type": "bar",
                "x": list(range(1, _HARMONICS + 1)),
                "y": change[:, row, column, k],
                "name": found.rubbing[k].name,
                "marker": {"color": colors[n % len(colors)]},
                "showlegend": row == 0,
                "hovertemplate": "%{y:.3g} %",
            }
            for n, k in enumerate(drawn)
        ]
        panels.append(Panel(f"Change, the<br>{driving} [%]", bars))
    part = change[:, :, column, drawn]
    order, driver, place = np.unravel_index(int(np.nanargmax(np.abs(part))), part.shape)
    title = (
        f"The {in_a_sentence(names[order])} changes most: {part[order, driver, place]:+.3g} % "
        f"({DRIVING[driver]}, {found.rubbing[drawn[int(place)]].name})"
    )
    return stack(title, "Mesh harmonic", panels, {"hovermode": "closest", "barmode": "group"})


def _broken(words: str) -> str:
    from textwrap import wrap

    return "<br>".join(wrap(words, 44))
